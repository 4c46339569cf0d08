//! From populations to particles.

use std::path::Path;

use calcine_coupler::packing::regular::{regular_in_box, regular_in_cylinder};
use calcine_coupler::packing::{Fill, RandomSpec, random_in_box, random_in_cylinder};
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::time::Ticks;

use super::bed::{self, Choice, Entry};
use super::model::{
    Case, MeshSpec, MotionSpec, PackingSection, PlacementSpec, Population, RandomAmount,
};
use super::other_density;
use super::overlap;
use super::place_error::PlaceError;
use super::units::{short, shown};

/// Particles at the start of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialParticles {
    /// What every backend starts from.
    pub setup: ParticleSetup,
    /// Temperatures in K.
    pub temperature: Vec<f64>,
    /// What their files state that does not count.
    pub notes: Vec<String>,
}

/// The particles of all populations, ids from 1 in the order of the file; on a grid x runs fastest,
/// in files of particles their own ids give the order. Places are within the periodic planes, by their images.
pub fn particles(case: &Case, periodicity: &Periodicity) -> Result<InitialParticles, PlaceError> {
    let mut placed = InitialParticles::default();
    let setup = &mut placed.setup;
    for (index, population) in (0u32..).zip(&case.particles) {
        let density = case.materials[population.material].density;
        let (factor, _) = case.time.acceleration.at(Ticks::ZERO);
        let velocity = factor * population.velocity;
        let spheres =
            spheres(case, population, periodicity, &mut placed.notes).map_err(|cause| {
                PlaceError::Population {
                    index: index as usize,
                    cause: Box::new(cause),
                }
            })?;
        for sphere in spheres {
            setup.id.push(setup.id.len() as u64 + 1);
            setup.population.push(index);
            setup.position.push(sphere.centre);
            setup.radius.push(0.5 * sphere.diameter);
            setup.density.push(density);
            let own = sphere.velocity.map(|own| factor * own);
            setup.velocity.push(own.unwrap_or(velocity));
            setup.angular_velocity.push(factor * sphere.spin);
            setup.weight.push(sphere.weight);
            placed.temperature.push(sphere.temperature);
        }
    }
    if setup.id.is_empty() && !case.particles.is_empty() {
        let names = case.particles.iter();
        let names = names.map(|one| match &one.place {
            PlacementSpec::File { path, .. } => format!("\"{}\" ({})", one.name, path.display()),
            _ => format!("\"{}\"", one.name),
        });
        return Err(PlaceError::Empty {
            names: names.collect(),
        });
    }
    if setup
        .velocity
        .iter()
        .all(|velocity| *velocity == Vec3::zeros())
    {
        setup.velocity.clear();
    }
    if setup
        .angular_velocity
        .iter()
        .all(|spin| *spin == Vec3::zeros())
    {
        setup.angular_velocity.clear();
    }
    // Parcels, and what stands for many, may lie in each other.
    let free = |one: &Population| one.motion != MotionSpec::Parcels;
    let mut solid: Vec<bool> = case.particles.iter().map(free).collect();
    for (population, weight) in setup.population.iter().zip(&setup.weight) {
        solid[*population as usize] &= *weight == 1.0;
    }
    if setup.weight.iter().all(|weight| *weight == 1.0) {
        setup.weight.clear();
    }
    match overlap::first(setup, periodicity, &solid) {
        None => Ok(placed),
        Some(found) => Err(PlaceError::Overlap {
            ids: found.pair.map(|index| setup.id[index]),
            names: found.pair.map(|index| {
                let population = setup.population[index] as usize;
                case.particles[population].name.clone()
            }),
            distance: found.distance,
            radii: found.radii,
        }),
    }
}

/// One particle.
struct Sphere {
    centre: Vec3,
    diameter: f64,
    temperature: f64,
    /// Velocity in m/s of process time, where it has one of its own.
    velocity: Option<Vec3>,
    /// Angular velocity in rad/s of process time.
    spin: Vec3,
    /// Statistical weight.
    weight: f64,
}

fn spheres(
    case: &Case,
    population: &Population,
    periodicity: &Periodicity,
    notes: &mut Vec<String>,
) -> Result<Vec<Sphere>, PlaceError> {
    let failed = |cause| PlaceError::Packing {
        name: population.name.clone(),
        cause,
    };
    let draw = |count| {
        let sizes = &population.sizes;
        sizes.sample(count, population.size_seed).map_err(failed)
    };
    let all = |centres: Vec<Vec3>, diameters: Vec<f64>| -> Vec<Sphere> {
        let pairs = centres.into_iter().zip(diameters);
        pairs
            .map(|(centre, diameter)| Sphere {
                centre,
                diameter,
                temperature: population.temperature,
                velocity: None,
                spin: Vec3::zeros(),
                weight: population.weight,
            })
            .collect()
    };
    match &population.place {
        PlacementSpec::Grid {
            first,
            spacing,
            counts,
        } => {
            let mut centres = grid(first, spacing, *counts);
            for centre in &mut centres {
                *centre = periodicity.wrap(*centre);
            }
            for (number, centre) in (1..).zip(&centres) {
                if let Some(fact) = outside(&case.mesh, centre) {
                    let what = format!("{fact}; {MOVE}");
                    let place = format!("population \"{}\", particle {number}", population.name);
                    return Err(PlaceError::File { place, what });
                }
            }
            let diameters = draw(centres.len())?;
            Ok(all(centres, diameters))
        }
        PlacementSpec::Random {
            space,
            amount,
            seed,
        } => {
            let height = space.height;
            let spec = RandomSpec {
                sizes: population.sizes.clone(),
                fill: match *amount {
                    RandomAmount::SolidFraction(solid_fraction) => Fill::Height {
                        height,
                        solid_fraction,
                    },
                    RandomAmount::Number(number) => Fill::NumberToHeight { number, height },
                },
                seed: *seed,
                size_seed: population.size_seed,
                periodicity: *periodicity,
            };
            let packing = match space.section {
                PackingSection::Rectangle(size) => random_in_box(space.origin, size, &spec),
                PackingSection::Disc(diameter) => random_in_cylinder(space.origin, diameter, &spec),
            };
            let packing = packing.map_err(failed)?;
            Ok(all(packing.centres, packing.diameters))
        }
        PlacementSpec::Regular { lattice, space } => {
            let (grain, height) = (population.sizes.largest(), space.height);
            let packing = match space.section {
                PackingSection::Rectangle([x, y]) => {
                    regular_in_box(space.origin, [x, y, height], grain, *lattice)
                }
                PackingSection::Disc(diameter) => {
                    regular_in_cylinder(space.origin, [diameter, height], grain, *lattice)
                }
            };
            let packing = packing.map_err(failed)?;
            Ok(all(packing.centres, packing.diameters))
        }
        PlacementSpec::File {
            path,
            timestep,
            kind,
        } => {
            let choice = Choice {
                timestep: *timestep,
                kind: *kind,
            };
            let entries = bed::read(path, choice)?;
            let diameters = draw(entries.len())?;
            // What is held has no velocity, whatever it had where the file was written.
            let moves = population.motion != MotionSpec::Frozen;
            let mut made = Vec::with_capacity(entries.len());
            let sized = entries.iter().zip(&diameters);
            notes.extend(other_density::told(case, population, path, sized));
            notes.extend(in_celsius(case, population, path, &entries));
            for (entry, drawn) in entries.into_iter().zip(diameters) {
                let centre = periodicity.wrap(entry.centre);
                if let Some(fact) = outside(&case.mesh, &centre) {
                    let what = match in_millimetres(&case.mesh, &centre) {
                        true => format!("{fact}; {MILLIMETRES}"),
                        false => format!("{fact}; {MOVE}"),
                    };
                    let place = format!("{}, {}", path.display(), entry.row);
                    return Err(PlaceError::File { place, what });
                }
                let weight = entry.weight.unwrap_or(population.weight);
                if let Some(what) = weight_alone(case, population, weight) {
                    let place = format!("{}, {}", path.display(), entry.row);
                    return Err(PlaceError::File { place, what });
                }
                made.push(Sphere {
                    centre,
                    diameter: entry.diameter.unwrap_or(drawn),
                    temperature: entry
                        .temperature
                        .filter(|_| population.prescribed_temperature.is_none())
                        .unwrap_or(population.temperature),
                    velocity: entry.velocity.filter(|_| moves),
                    spin: entry.spin.filter(|_| moves).unwrap_or_default(),
                    weight,
                });
            }
            Ok(made)
        }
    }
}

/// What is wrong with a row of a file that stands for several particles.
fn weight_alone(case: &Case, population: &Population, weight: f64) -> Option<String> {
    if weight == 1.0 {
        return None;
    }
    let what = if population.motion == MotionSpec::Free {
        "the particles are free, and what touches others stands for itself alone: write motion = \"parcels\" or \"frozen\""
    } else if case.laws.conducts() || case.laws.radiation.is_some() {
        "`laws.conduction` or `laws.radiation` exchanges heat between particles: write `none` for both laws"
    } else {
        return None;
    };
    Some(format!(
        "the weight is {}, but {what}, or leave out the column",
        short(weight)
    ))
}

fn grid(first: &Vec3, spacing: &Vec3, counts: [usize; 3]) -> Vec<Vec3> {
    let mut centres = Vec::with_capacity(counts.iter().product());
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let steps = Vec3::new(i as f64, j as f64, k as f64);
                centres.push(first + spacing.component_mul(&steps));
            }
        }
    }
    centres
}

/// Temperatures in K of files below this are looked at.
const COLD: f64 = 200.0;

/// A warning where the coldest particle of a file is nearer to the gas if its temperature is in degrees Celsius.
fn in_celsius(
    case: &Case,
    population: &Population,
    path: &Path,
    entries: &[Entry],
) -> Option<String> {
    let stated = entries
        .iter()
        .filter_map(|one| Some((one.row, one.temperature?)));
    let (row, coldest) = stated.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let gas = case.gas.temperature;
    let celsius = (coldest + 273.15 - gas).abs() < (coldest - gas).abs();
    (coldest < COLD && celsius).then(|| {
        format!(
            "`particles.{}.place.file`: {}, {row} has a temperature of {} K in a gas of {} K: temperatures of files are read in K; add \
             273.15 if they are in degrees Celsius",
            population.name,
            path.display(),
            short(coldest),
            short(gas)
        )
    })
}

/// What to do about a particle outside the mesh.
const MOVE: &str = "move the particle, or enlarge the mesh";

/// What to do about a file whose lengths are likely in mm.
const MILLIMETRES: &str =
    "divide the lengths of the file by 1000 if they are in mm: they are read in m";

/// True of a centre far outside a generated mesh that lies in it if its lengths are in mm.
fn in_millimetres(mesh: &MeshSpec, centre: &Vec3) -> bool {
    outside(mesh, &(0.1 * centre)).is_some() && outside(mesh, &(1e-3 * centre)).is_none()
}

/// What is wrong with a centre outside a generated mesh.
fn outside(mesh: &MeshSpec, centre: &Vec3) -> Option<String> {
    let beyond = |name: &str, value: f64, low: f64, high: f64| {
        (!(low..=high).contains(&value)).then(|| {
            format!(
                "the centre lies at {name} = {} m, but the mesh reaches from {} m to {} m",
                shown(value),
                shown(low),
                shown(high)
            )
        })
    };
    match mesh {
        MeshSpec::Box { origin, size, .. } => {
            ["x", "y", "z"]
                .into_iter()
                .enumerate()
                .find_map(|(axis, name)| {
                    beyond(name, centre[axis], origin[axis], origin[axis] + size[axis])
                })
        }
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            ..
        } => {
            let off = (centre - origin).xy().norm();
            beyond("z", centre.z, origin.z, origin.z + length)
                .or_else(|| beyond("distance from the axis", off, 0.0, 0.5 * diameter))
        }
        MeshSpec::PolyMesh(_) => None,
    }
}
