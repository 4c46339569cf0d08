//! How much memory a case needs, estimated before anything of it is built.

use std::fs;

use calcine_coupler::setup::Turbulence;
use calcine_coupler::view_factors::ViewFactors;
use thiserror::Error;

use super::model::{Case, MeshSpec, PlacementSpec, Population, RandomAmount};
use calcine_coupler::physics::sphere;

/// Bytes that coordinator and native gas hold per cell, and per frozen particle, about; measured as the growth of
/// resident memory, rounded up: the heated bed on 14 700, 66 760 and 134 792 cells.
const BYTES: [f64; 2] = [5100.0, 500.0];
/// Bytes of a species in a cell, about: the purged bed with 3 and 7 species on 82 944 cells, the latter with reactions. Eddies have
/// two scalars more.
const BYTES_A_SCALAR: f64 = 150.0;
/// Bytes of a particle's contacts and motion, about: the settled beds of `native-solver/benches/particles.rs`.
const BYTES_FREE: f64 = 1000.0;

/// A case larger than this machine.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "the case needs about {} ({cells:.3e} cells, {particles:.3e} particles), but this machine has \
     {}; use fewer cells or particles, or a larger machine",
    shown(*.needed), shown(*.there)
)]
pub struct TooLarge {
    /// Cells, without refined zones.
    pub cells: f64,
    /// Particles.
    pub particles: f64,
    /// Bytes needed.
    pub needed: f64,
    /// Bytes of this machine.
    pub there: f64,
}

/// Bytes of a pair of particles that see each other, about: its exchange area in the list of views and in the
/// network, its bond, its entries in the matrix. Measured as above, on `cases/bed-conductivity.toml`.
const BYTES_A_VIEW: f64 = 100.0;
/// Pairs a particle that rays find at most, about: dense beds hide the others, however far rays reach (measured
/// there: 45 with 1024 rays, 58 with 8192).
const IN_SIGHT: f64 = 60.0;
/// Solid fraction of a bed of which the case file does not know any.
const DENSE: f64 = 0.6;

/// Bytes that so many cells and particles of a case need.
pub fn memory(case: &Case, cells: f64, particles: f64) -> f64 {
    let eddies = match case.gas.turbulence {
        Turbulence::Laminar => 0,
        Turbulence::KEpsilon { .. } => 2,
    };
    let cell = BYTES[0] + BYTES_A_SCALAR * (case.gas.composition.len() + eddies) as f64;
    let free = case.motion.as_ref().map_or(0.0, |_| BYTES_FREE);
    cells * cell + particles * (BYTES[1] + free + BYTES_A_VIEW * views(case))
}

/// Pairs that see each other by radiation, for each particle: half of those whose centres lie within the range,
/// which is in largest diameters; zero where nothing radiates.
fn views(case: &Case) -> f64 {
    let Some(radiation) = &case.laws.radiation else {
        return 0.0;
    };
    let range = radiation.view_factors.range();
    let solid = case.particles.iter();
    let solid = solid.filter_map(|one| Some(random(one)?.solid_fraction));
    let solid = solid.reduce(f64::max);
    let diameters = case.particles.iter();
    let largest = diameters
        .clone()
        .map(|one| one.sizes.largest())
        .fold(0.0, f64::max);
    let means = diameters.filter_map(|one| one.sizes.mean().ok());
    let mean = means.fold(f64::INFINITY, f64::min).min(largest);
    // 4/3 π (range d_max)³ times the solid fraction, over π/6 d³; each pair once.
    let within = 0.5 * 8.0 * solid.unwrap_or(DENSE) * (range * largest / mean).powi(3);
    match radiation.view_factors {
        ViewFactors::Rays { .. } => within.min(IN_SIGHT),
        ViewFactors::Distance { .. } | ViewFactors::Neighbours { .. } => within,
    }
}

/// An error where the case needs more memory than this machine has. Refined zones, and meshes and
/// beds that are read from files, are not counted.
pub fn fits(case: &Case) -> Result<(), TooLarge> {
    let cells = cells(&case.mesh);
    let particles = particles(case);
    let needed = memory(case, cells, particles);
    match installed() {
        Some(there) if needed > there => Err(TooLarge {
            cells,
            particles,
            needed,
            there,
        }),
        _ => Ok(()),
    }
}

/// Cells before refinement; zero where only a file knows.
fn cells(mesh: &MeshSpec) -> f64 {
    match mesh {
        MeshSpec::Box { cells, .. } => cells.iter().map(|&count| count as f64).product(),
        // An O-grid: the core's square, and four sides of a ring about it.
        MeshSpec::Cylinder { cells, .. } => {
            let ring = (cells[0] / 4).max(1) as f64;
            let core = cells[0] as f64 - 2.0 * ring;
            (core * core + 4.0 * core * ring) * cells[1] as f64
        }
        MeshSpec::PolyMesh(_) => 0.0,
    }
}

/// Particles of stackings and random packings; files are not opened.
fn particles(case: &Case) -> f64 {
    let populations = case
        .particles
        .iter()
        .map(|population| match &population.place {
            PlacementSpec::Grid { counts, .. } => {
                counts.iter().map(|&count| count as f64).product()
            }
            PlacementSpec::Random { .. } => random(population).map_or(0.0, |one| one.number),
            PlacementSpec::Regular { .. } | PlacementSpec::File { .. } => 0.0,
        });
    populations.sum()
}

/// What a random packing holds, by spheres of the mean diameter.
struct RandomPacking {
    number: f64,
    solid_fraction: f64,
}

fn random(population: &Population) -> Option<RandomPacking> {
    let PlacementSpec::Random { space, amount, .. } = population.place else {
        return None;
    };
    let mean = population.sizes.mean().unwrap_or(f64::INFINITY);
    let most = space.section.area() * space.height / sphere::volume_of_diameter(mean);
    let (number, solid_fraction) = match amount {
        RandomAmount::SolidFraction(solid_fraction) => (most * solid_fraction, solid_fraction),
        RandomAmount::Number(number) => (number as f64, number as f64 / most),
    };
    Some(RandomPacking {
        number,
        solid_fraction,
    })
}

/// Memory of this machine in bytes; `None` where the system does not say.
fn installed() -> Option<f64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kilobytes)
}

/// An amount of memory with a unit that suits it.
pub fn shown(bytes: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB")];
    let unit = units.iter().find(|(size, _)| bytes >= *size);
    match unit {
        Some((size, name)) => format!("{:.1} {name}", bytes / size),
        None => "1 MB or less".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::mesh::cylinder::{CylinderSpec, cylinder_mesh};
    use calcine_coupler::mesh::grading::uniform;
    use calcine_coupler::physics::Vec3;

    #[test]
    fn an_o_grid_has_as_many_cells_as_estimated() {
        for across in [3, 4, 12, 17] {
            let spec = CylinderSpec {
                origin: Vec3::zeros(),
                diameter: 0.05,
                length: 0.1,
                cells_across: across,
                along: uniform(7),
                patches: ["side", "bottom", "top"].map(String::from),
            };
            let made = cylinder_mesh(&spec).unwrap().cells();
            let estimated = cells(&MeshSpec::Cylinder {
                origin: spec.origin,
                diameter: spec.diameter,
                length: spec.length,
                cells: [across, 7],
                grading: Vec::new(),
                refine: Vec::new(),
                cut: Vec::new(),
                openings: Vec::new(),
            });
            assert_eq!(estimated, made as f64, "{across} across");
        }
    }

    #[test]
    fn memory_is_shown_in_a_unit_that_suits_it() {
        let cold = shipped("packed-column");
        assert_eq!(shown(memory(&cold, 11.0, 10.0)), "1 MB or less");
        assert_eq!(shown(memory(&cold, 6e4, 1e3)), "306.5 MB");
        assert_eq!(shown(memory(&cold, 2e9, 0.0)), "10.2 TB");
        // Seven species and two scalars of eddies.
        let flames = shipped("shaft-furnace");
        let growth = memory(&flames, 1e6, 0.0) - memory(&cold, 1e6, 0.0);
        assert!((growth / (9e6 * BYTES_A_SCALAR) - 1.0).abs() < 1e-12);
        let free = memory(&flames, 0.0, 1.0) - BYTES_A_VIEW * views(&flames);
        assert!((free / (BYTES[1] + BYTES_FREE) - 1.0).abs() < 1e-12);
    }

    fn shipped(name: &str) -> Case {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        crate::case::read(&folder.join(format!("cases/{name}.toml")), &[]).unwrap()
    }

    #[test]
    fn particles_that_radiate_need_memory_for_whom_they_see() {
        let mut hot = shipped("bed-conductivity");
        let mut seen = |view_factors: ViewFactors| {
            hot.laws.radiation.as_mut().unwrap().view_factors = view_factors;
            views(&hot)
        };
        // 8 · 0.57 · 27 neighbours within three diameters, each pair once.
        let near = seen(ViewFactors::Distance { range: 3.0 });
        assert!((near - 61.56).abs() < 1e-9, "{near}");
        assert!((seen(ViewFactors::Distance { range: 6.0 }) / near - 8.0).abs() < 1e-12);
        let rays = |range: f64| ViewFactors::Rays { rays: 1000, range };
        assert_eq!(seen(rays(6.0)), IN_SIGHT);
        assert!((seen(rays(2.0)) - 18.24).abs() < 1e-9);
        let both = memory(&hot, 0.0, 1e6);
        assert!((both / (1e6 * (BYTES[1] + BYTES_A_VIEW * views(&hot))) - 1.0).abs() < 1e-12);
    }
}
