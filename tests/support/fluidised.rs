//! What a fluidised bed must show: the pressure drop of a bed on a flow that decreases in steps, against its
//! buoyant weight and against the drag law, evaluated apart from the program for the void fraction and the slip
//! that each particle sees.

#![allow(clippy::unwrap_used, clippy::print_stdout, dead_code)]

use std::f64::consts::PI;
use std::path::Path;

use calcine::assembly::PreparedCase;
use calcine::case::read;
use calcine::results::read::Series;
use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};

/// The bed of cases/fluidised-bed.toml in SI.
const DIAMETER: f64 = 2e-3;
const SOLID: f64 = 2500.0;
const WATER: f64 = 998.0;
const VISCOSITY: f64 = 1e-3;
const GRAVITY: f64 = 9.81;
const AREA: f64 = 0.016 * 0.016;

/// A flow that is held: what is looked at lies between two process times in s.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    pub from: f64,
    pub to: f64,
    /// Superficial velocity in m/s.
    pub speed: f64,
}

/// What came out.
pub struct Found {
    /// Mean pressure drop of each flow that fluidises, over the buoyant weight.
    pub plateau: Vec<f64>,
    /// Pressure drop of each flow that leaves the bed packed, over that of the drag law with what each
    /// particle sees.
    pub packed: Vec<f64>,
    /// Where the line through the packed drops meets the weight, in m/s.
    pub crossing: f64,
    /// Where the drag law does, with the void fraction that each particle sees in the loosest packed bed.
    pub by_particles: f64,
    /// Where Ergun's equation does, with the void fraction of that bed: of twice its mean height.
    pub by_bed: f64,
}

/// Drag coefficient K_A of Ergun in kg/s: V_p μ/d² (150 (1 − ε)/ε + 1.75 Re), Re of the interstitial slip.
fn ergun(pores: f64, slip: f64) -> f64 {
    let scale = PI / 6.0 * DIAMETER.powi(3) * VISCOSITY / (DIAMETER * DIAMETER);
    scale * (150.0 * (1.0 - pores) / pores + 1.75 * WATER * slip * DIAMETER / VISCOSITY)
}

/// Ergun's pressure gradient in Pa/m at a superficial velocity.
fn ergun_of_bed(pores: f64, speed: f64) -> f64 {
    let (solid, cube) = (1.0 - pores, pores.powi(3));
    150.0 * solid * solid * VISCOSITY * speed / (cube * DIAMETER * DIAMETER)
        + 1.75 * solid * WATER * speed * speed / (cube * DIAMETER)
}

/// Pressure drop in Pa of a bed at rest in a column one cell wide: Σ over cells of F/(ε A), F = Σ_p W K_A u
/// what the cell's gas gives its particles, u = U/ε.
fn drop_by_particles(operator: &Operator, speed: f64) -> f64 {
    let pores: Vec<f64> = operator.solid_fraction().iter().map(|a| 1.0 - a).collect();
    let velocity: Vec<f64> = pores.iter().map(|pores| speed / pores).collect();
    let mut seen = [
        vec![0.0; operator.particles()],
        vec![0.0; operator.particles()],
    ];
    operator.sample(&pores, &mut seen[0]);
    operator.sample(&velocity, &mut seen[1]);
    let pairs = seen[0].iter().zip(&seen[1]);
    let drag: Vec<f64> = pairs.map(|(pores, slip)| ergun(*pores, *slip)).collect();
    let mut cells = vec![0.0; operator.cells()];
    operator.spread(&drag, &mut cells);
    let layers = cells.iter().zip(&velocity).zip(&pores);
    layers.map(|((k, u), pores)| k * u / pores).sum::<f64>() / AREA
}

/// The speed in m/s at which an increasing function reaches a value.
fn reaches(value: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Centres in the snapshot nearest to a process time in s.
fn centres(out: &Path, time: f64) -> Vec<Vec3> {
    let file = hdf5::File::open(out.join("results.h5")).unwrap();
    let all = file.group("snapshots").unwrap().groups().unwrap();
    let at = |group: &hdf5::Group| -> f64 {
        let attribute = group.attr("process_time").unwrap();
        (attribute.read_scalar::<f64>().unwrap() - time).abs()
    };
    let nearest = all.iter().min_by(|a, b| at(a).total_cmp(&at(b))).unwrap();
    let centres = nearest.dataset("particles/position").unwrap();
    let centres = centres.read_raw::<f64>().unwrap();
    centres
        .chunks_exact(3)
        .map(Vec3::from_column_slice)
        .collect()
}

/// Looks at the results of a run of the case with settings: flows that fluidise it, then packed ones, from
/// the fastest on.
pub fn examine(case: &Path, set: &[String], out: &Path, moving: &[Hold], packed: &[Hold]) -> Found {
    let case = read(case, set).unwrap();
    let prepared = PreparedCase::new(&case).unwrap();
    let mesh: &Mesh = &prepared.mesh;
    let smoother = SmootherSettings {
        max_solid_fraction: case.coupling.max_solid_fraction,
        tolerance: case.coupling.smoother_tolerance,
        diffusion_length: case.coupling.diffusion_length,
    };
    let smoother = Smoother::new(mesh, smoother).unwrap();
    let height = mesh.cell_volume().iter().sum::<f64>() / AREA;
    let count = prepared.particles.id.len() as f64;
    let volume = PI / 6.0 * DIAMETER.powi(3);
    let weight = count * volume * (SOLID - WATER) * GRAVITY / AREA;

    let series = Series::read(out).unwrap();
    let times = series.column("process_time");
    let drops = series.column("quantities.pressure_drop");
    let mean = |hold: &Hold| {
        let rows = times.iter().zip(drops);
        let within = rows.filter(|(time, _)| (hold.from..=hold.to).contains(*time));
        let values: Vec<f64> = within.map(|(_, drop)| *drop).collect();
        values.iter().sum::<f64>() / values.len() as f64 - WATER * GRAVITY * height
    };
    let mut found = Found {
        plateau: Vec::new(),
        packed: Vec::new(),
        crossing: 0.0,
        by_particles: 0.0,
        by_bed: 0.0,
    };
    println!("  {count} beads, buoyant weight {weight:.2} Pa");
    for hold in moving {
        let share = mean(hold) / weight;
        println!("  {:4.1} mm/s: {share:.4} of the weight", 1e3 * hold.speed);
        found.plateau.push(share);
    }
    let mut points = Vec::new();
    for (row, hold) in packed.iter().enumerate() {
        let centres = centres(out, hold.to);
        let radii = vec![0.5 * DIAMETER; centres.len()];
        let solids = vec![volume; centres.len()];
        let weights = Mapper::new(mesh)
            .fill(Method::Overlap, &centres, &radii)
            .unwrap();
        let operator = smoother.operator(weights, &solids).unwrap();
        let (measured, law) = (mean(hold), drop_by_particles(&operator, hold.speed));
        let top = 2.0 * centres.iter().map(|centre| centre.z).sum::<f64>() / count;
        let pores = 1.0 - count * volume / (AREA * top);
        let plain = ergun_of_bed(pores, hold.speed) * top;
        println!(
            "  {:4.1} mm/s: {measured:.2} Pa, {:.4} of the law with what each particle sees, {:.4} of \
             Ergun at the bed's void fraction of {pores:.4}",
            1e3 * hold.speed,
            measured / law,
            measured / plain
        );
        found.packed.push(measured / law);
        points.push((hold.speed, measured));
        if row == 0 {
            found.by_particles = reaches(weight, |speed| drop_by_particles(&operator, speed));
            found.by_bed = reaches(weight, |speed| ergun_of_bed(pores, speed) * top);
        }
    }
    // Δp = a U + b U², by the straight line through Δp/U.
    let n = points.len() as f64;
    let x = points.iter().map(|point| point.0).sum::<f64>() / n;
    let y = points.iter().map(|point| point.1 / point.0).sum::<f64>() / n;
    let over: f64 = points.iter().map(|p| (p.0 - x) * (p.1 / p.0 - y)).sum();
    let slope = over / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    found.crossing = reaches(weight, |speed| speed * (y + slope * (speed - x)));
    println!(
        "  minimum fluidisation at {:.2} mm/s; the law with what each particle sees {:.2}, Ergun at the bed's \
         void fraction {:.2}",
        1e3 * found.crossing,
        1e3 * found.by_particles,
        1e3 * found.by_bed
    );
    found
}
