//! From populations to particles.

use std::path::{Path, PathBuf};

use calcine_coupler::packing::{
    Fill, Packing, PackingError, RandomSpec, Sizes, random_in_box, random_in_cylinder,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use thiserror::Error;

use super::model::{Case, MeshSpec, Motion, Place};
use super::overlap;
use super::units::shown;

/// Particles that cannot be placed.
#[derive(Debug, Error)]
pub enum PlaceError {
    /// The file cannot be read.
    #[error("{path}: {cause}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// A line that does not hold what the header says.
    #[error("{path}, line {line}: {what}")]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// Two particles of different populations in the same space.
    #[error(
        "particle {} of \"{}\" and particle {} of \"{}\" overlap: their centres are {} m apart, their \
         radii add up to {} m; move one of the populations",
        .ids[0], .names[0], .ids[1], .names[1], shown(*.distance), shown(*.radii)
    )]
    Overlap {
        /// Their ids.
        ids: [u64; 2],
        /// Their populations.
        names: [String; 2],
        /// Distance of their centres in m.
        distance: f64,
        /// Sum of their radii in m.
        radii: f64,
    },
    /// A random packing that cannot be made.
    #[error("population \"{name}\": {cause}")]
    Packing {
        /// Name of the population.
        name: String,
        /// Why.
        cause: PackingError,
    },
    /// No particle at all.
    #[error("the case has no particles")]
    Empty,
}

/// A random packing between the walls of the mesh. A cylinder's outline is a polygon: the spheres keep
/// inside the circle that touches its sides.
fn random(mesh: &MeshSpec, spec: &RandomSpec) -> Result<Packing, PackingError> {
    match mesh {
        MeshSpec::Box { origin, size, .. } => random_in_box(*origin, [size.x, size.y], spec),
        MeshSpec::Cylinder {
            origin,
            diameter,
            cells,
            ..
        } => {
            let across = cells[0];
            let sides = 4 * (across - 2 * (across / 4).max(1));
            let inner = diameter * (std::f64::consts::PI / sides as f64).cos();
            random_in_cylinder(*origin, inner, spec)
        }
        MeshSpec::PolyMesh(_) => Err(PackingError::Value {
            what: "container",
            value: f64::NAN,
            need: "a box or a cylinder as mesh",
        }),
    }
}

/// The particles of all populations, ids from 1 in the order of the file; on a grid x runs fastest.
pub fn particles(case: &Case) -> Result<ParticleSetup, PlaceError> {
    let mut setup = ParticleSetup {
        frozen: case
            .particles
            .iter()
            .all(|population| population.motion == Motion::Frozen),
        ..ParticleSetup::default()
    };
    for (index, population) in (0u32..).zip(&case.particles) {
        let density = case.materials[population.material].density;
        let mut add = |position: Vec3, diameter: f64| {
            setup.id.push(setup.id.len() as u64 + 1);
            setup.population.push(index);
            setup.position.push(position);
            setup.radius.push(0.5 * diameter);
            setup.density.push(density);
        };
        match &population.place {
            Place::Grid {
                first,
                spacing,
                counts,
            } => {
                for k in 0..counts[2] {
                    for j in 0..counts[1] {
                        for i in 0..counts[0] {
                            let steps = Vec3::new(i as f64, j as f64, k as f64);
                            add(first + spacing.component_mul(&steps), population.diameter);
                        }
                    }
                }
            }
            Place::Random {
                height,
                solid_fraction,
                seed,
            } => {
                let spec = RandomSpec {
                    sizes: Sizes::Equal(population.diameter),
                    fill: Fill::Height(*height),
                    solid_fraction: *solid_fraction,
                    seed: *seed,
                };
                let packing = random(&case.mesh, &spec).map_err(|cause| PlaceError::Packing {
                    name: population.name.clone(),
                    cause,
                })?;
                for (position, diameter) in packing.centres.iter().zip(&packing.diameters) {
                    add(*position, *diameter);
                }
            }
            Place::File(path) => {
                for (line, position, diameter) in file(path)? {
                    inside(&case.mesh, path, line, &position)?;
                    add(position, diameter.unwrap_or(population.diameter));
                }
            }
        }
    }
    if setup.id.is_empty() {
        return Err(PlaceError::Empty);
    }
    match overlap::between_populations(&setup) {
        None => Ok(setup),
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

/// Refuses a centre outside a generated box.
fn inside(mesh: &MeshSpec, path: &Path, line: usize, centre: &Vec3) -> Result<(), PlaceError> {
    let MeshSpec::Box { origin, size, .. } = mesh else {
        return Ok(());
    };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (low, high) = (origin[axis], origin[axis] + size[axis]);
        if !(low..=high).contains(&centre[axis]) {
            return Err(PlaceError::Line {
                path: path.to_owned(),
                line,
                what: format!(
                    "the centre lies at {name} = {} m, but the mesh reaches from {} m to {} m; \
                     move the particle, or enlarge the mesh",
                    shown(centre[axis]),
                    shown(low),
                    shown(high)
                ),
            });
        }
    }
    Ok(())
}

/// CSV with the columns x, y, z in m, and optionally diameter in m, named in its first line.
fn file(path: &Path) -> Result<Vec<(usize, Vec3, Option<f64>)>, PlaceError> {
    let text = std::fs::read_to_string(path).map_err(|cause| PlaceError::Io {
        path: path.to_owned(),
        cause,
    })?;
    let wrong = |line: usize, what: String| PlaceError::Line {
        path: path.to_owned(),
        line,
        what,
    };
    let mut lines = text.lines().enumerate();
    let header: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| {
        line.split(',').map(str::trim).collect()
    });
    let column = |name: &str| header.iter().position(|head| *head == name);
    let (Some(x), Some(y), Some(z)) = (column("x"), column("y"), column("z")) else {
        return Err(wrong(
            1,
            format!(
                "the header is \"{}\", it needs x,y,z (in m)",
                header.join(",")
            ),
        ));
    };
    let diameter = column("diameter");
    let mut found = Vec::new();
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        let value = |column: usize| {
            let word = words.get(column).copied().unwrap_or("");
            word.parse::<f64>()
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| {
                    wrong(
                        number + 1,
                        format!("\"{word}\" in column {} is not a number", column + 1),
                    )
                })
        };
        let own = diameter.map(value).transpose()?;
        if own.is_some_and(|diameter| diameter <= 0.0) {
            return Err(wrong(number + 1, "the diameter is not above zero".into()));
        }
        let centre = Vec3::new(value(x)?, value(y)?, value(z)?);
        found.push((number + 1, centre, own));
    }
    Ok(found)
}
