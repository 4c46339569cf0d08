//! Parcels that meet each other by the averages of the mesh: the stress of the solid, damping and isotropy.
#![allow(clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::conformance::manufactured::CellShape;
use calcine_coupler::conformance::manufactured::meshes::shaped_box;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::parcels::{ParcelCollisions, ParcelMotion, ParcelPacking};
use calcine_coupler::part::{DRAG_COEFFICIENT, GAS_VELOCITY, Part, ParticlePush, Particles};
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};
use calcine_coupler::physics::{Vec3, sphere};

use crate::common::named_box;
use crate::grains::scatter;
use crate::parcel_beds::{ParcelBed, motion, setup};

const STRESS: HarrisCrighton = HarrisCrighton {
    pressure: 10.0,
    exponent: 2.0,
    floor: 1e-7,
    close_packing: 0.6,
};
/// So stiff that a bed is packed closely under its own weight.
const STIFF: HarrisCrighton = HarrisCrighton {
    pressure: 1.0,
    ..STRESS
};
const SIDES: [&str; 6] = ["west", "east", "south", "north", "bottom", "top"];

/// A box that repeats itself along all axes.
fn endless(size: f64, cells: usize) -> Arc<Mesh> {
    let mesh = named_box([size; 3], [cells; 3], SIDES);
    let pairs = [["west", "east"], ["south", "north"], ["bottom", "top"]];
    let pairs = pairs.map(|pair| pair.map(String::from));
    Arc::new(Mesh::clone(&mesh).with_periodic(&pairs).unwrap())
}

/// Parcels anywhere in a box with any velocities, of a solid fraction altogether.
fn cloud(
    mesh: &Arc<Mesh>,
    rules: ParcelMotion,
    (count, fraction): (usize, f64),
    velocity: impl Fn(&mut dyn FnMut() -> f64) -> Vec3,
) -> ParcelBed {
    let [low, high] = mesh.bounds();
    let mut next = scatter(17);
    let parcels: Vec<(Vec3, Vec3)> = (0..count)
        .map(|_| {
            let share = Vec3::new(next(), next(), next());
            (
                low + (high - low).component_mul(&share),
                velocity(&mut next),
            )
        })
        .collect();
    let radius = 0.5e-3;
    let volume: f64 = mesh.cell_volume().iter().sum();
    let weight = fraction * volume / (count as f64 * sphere::volume(radius));
    ParcelBed::new(mesh, &setup(rules, &parcels, radius, weight))
}

fn isotropic(next: &mut dyn FnMut() -> f64) -> Vec3 {
    Vec3::new(next(), next(), next()).add_scalar(-0.5)
}

fn collisions(restitution: f64, damping: bool, isotropy: bool) -> ParcelCollisions {
    ParcelCollisions {
        times: CollisionTimes {
            restitution,
            close_packing: STRESS.close_packing,
        },
        damping,
        isotropy,
        seed: 4,
    }
}

#[test]
fn what_is_on_the_mesh_is_what_parcels_have() {
    for shape in [CellShape::Hexahedra(0.2), CellShape::Polyhedra(0.2)] {
        let mesh = Arc::new(shaped_box(shape, 4, |place| place).unwrap());
        let bed = cloud(&mesh, motion(&mesh, 1.0, 0.0), (400_000, 0.3), isotropic);
        let fraction = bed.parcels.solid_fraction();
        // Even but for the noise of some thousand parcels a cell.
        let most = fraction
            .iter()
            .map(|one| (one / 0.3 - 1.0).abs())
            .fold(0.0, f64::max);
        println!("{shape:?}: {most}");
        assert!(most < 0.1, "{most}");
    }
}

#[test]
fn stress_damping_and_isotropy_keep_the_momentum_where_there_are_no_walls() {
    let mesh = endless(0.1, 5);
    let explicit = ParcelPacking::Explicit {
        stress: STRESS,
        restitution: 0.9,
    };
    for (packing, kept) in [(ParcelPacking::Implicit(STRESS), true), (explicit, false)] {
        let mut rules = motion(&mesh, 1.0, 0.0);
        rules.packing = packing;
        rules.collisions = collisions(0.8, true, true);
        let mut bed = cloud(&mesh, rules, (4000, 0.5), isotropic);
        let before = bed.momentum();
        let fields = bed.parcels.fields();
        let size: f64 = (0..4000)
            .map(|row| fields.row_mass(row) * fields.velocity[row].norm())
            .sum();
        let mut support = Vec3::zeros();
        for _ in 0..5 {
            bed.run(1, 2e-3);
            support += bed.received.support.unwrap();
        }
        let off = bed.momentum() - before;
        println!("{off} {support} of {size}");
        assert!((off - support).norm() < 1e-13 * size, "{off}");
        if kept {
            assert!(off.norm() < 1e-13 * size, "{off}");
        }
    }
}

/// A column of 200 mm with a suspension, in a gas that stands still and drags such that a parcel falls with 0.1 m/s (1 − α)^3.
struct Settling {
    bed: ParcelBed,
    time: f64,
}

const HEIGHT: f64 = 0.2;
const FALL: f64 = 0.1;
const POWER: i32 = 3;

impl Settling {
    fn new(fraction: f64, levels: usize) -> Self {
        let mesh = named_box([0.01, 0.01, HEIGHT], [1, 1, 50], SIDES);
        let mut rules = motion(&mesh, 0.0, 0.0);
        rules.gravity = Vec3::z() * -9.81;
        rules.courant = 0.5;
        rules.packing = ParcelPacking::Implicit(STIFF);
        let across = 3;
        let mut parcels = Vec::new();
        for k in 0..levels {
            for j in 0..across {
                for i in 0..across {
                    let at = |k: usize, of: usize, size: f64| (k as f64 + 0.5) / of as f64 * size;
                    let place = Vec3::new(
                        at(i, across, 0.01),
                        at(j, across, 0.01),
                        at(k, levels, HEIGHT),
                    );
                    parcels.push((place, Vec3::zeros()));
                }
            }
        }
        let radius = 0.1e-3;
        let volume = 0.01 * 0.01 * HEIGHT;
        let weight = fraction * volume / (parcels.len() as f64 * sphere::volume(radius));
        let bed = ParcelBed::new(&mesh, &setup(rules, &parcels, radius, weight));
        Self { bed, time: 0.0 }
    }

    fn window(&mut self, span: f64) {
        let fraction = self.bed.parcels.solid_fraction();
        let cells = self.bed.parcels.cells();
        let fields = self.bed.parcels.fields();
        let mut push = ParticlePush {
            force: vec![Vec3::zeros(); fields.len()],
            ..ParticlePush::default()
        };
        let drag = |row: usize| {
            let void: f64 = 1.0 - fraction[cells[row]];
            fields.mass[row] * 9.81 / (FALL * void.powi(POWER))
        };
        let drag = (0..fields.len()).map(drag).collect();
        let still = vec![0.0; 3 * fields.len()];
        push.columns.set(DRAG_COEFFICIENT, 1, drag);
        push.columns.set(GAS_VELOCITY, 3, still);
        self.bed.window(span, &push);
        self.time += span;
    }

    /// Heights of the front of the bed, and of the top of what still falls.
    fn fronts(&self, start: f64) -> [f64; 2] {
        let profile = self.bed.parcels.solid_fraction();
        let cell = HEIGHT / profile.len() as f64;
        // Where the profile falls through a fraction, from below or from above, between the centres of layers.
        let down = |level: f64| {
            let above = profile.iter().rposition(|one| *one > level).unwrap();
            let next = profile.get(above + 1).copied().unwrap_or(0.0);
            let share = (profile[above] - level) / (profile[above] - next);
            (above as f64 + 0.5 + share) * cell
        };
        [
            down(0.5 * (start + STRESS.close_packing)),
            down(0.5 * start),
        ]
    }
}

#[test]
fn a_suspension_settles_with_both_fronts_of_kinematic_waves_into_a_bed_of_close_packing() {
    for start in [0.1, 0.15, 0.2] {
        let mut column = Settling::new(start, 150);
        let falls = FALL * (1.0 - start).powi(POWER);
        let rises = start * falls / (STRESS.close_packing - start);
        // Until the fronts are well apart from each other and from the ends.
        let until = 0.85 * HEIGHT / (falls + rises);
        let span = 8e-3;
        let windows = (until / span).round() as usize;
        for _ in 0..windows / 4 {
            column.window(span);
        }
        let first = column.fronts(start);
        let begin = column.time;
        for _ in windows / 4..windows {
            column.window(span);
        }
        let second = column.fronts(start);
        let seconds = column.time - begin;
        let speeds = [
            (second[0] - first[0]) / seconds,
            (first[1] - second[1]) / seconds,
        ];
        println!("{start}: fronts {speeds:?} of {rises} {falls}");
        let profile = column.bed.parcels.solid_fraction();
        println!("{profile:.3?}");
        assert!(
            (speeds[0] / rises - 1.0).abs() < 0.03,
            "{start}: {speeds:?} {rises}"
        );
        assert!(
            (speeds[1] / falls - 1.0).abs() < 0.03,
            "{start}: {speeds:?} {falls}"
        );
        let rest = (2.0 * HEIGHT / falls / span) as usize;
        for _ in 0..rest {
            column.window(span);
        }
        let profile = column.bed.parcels.solid_fraction();
        println!("{profile:.4?}");
        let most = column
            .bed
            .parcels
            .solid_fraction()
            .into_iter()
            .fold(0.0, f64::max);
        assert!(most <= STRESS.close_packing, "{start}: {most}");
        let full = (start / STRESS.close_packing * 50.0) as usize;
        for layer in &profile[1..full - 2] {
            assert!(
                (layer / STRESS.close_packing - 1.0).abs() < 0.01,
                "{start}: {layer}"
            );
        }
        let fastest = column
            .bed
            .parcels
            .fields()
            .velocity
            .iter()
            .map(Vec3::norm)
            .fold(0.0, f64::max);
        println!("fastest {fastest}, most {most}");
    }
}

#[test]
fn an_explicit_stress_carries_a_bed_at_rest_as_the_implicit_one_does() {
    let mesh = named_box([0.02, 0.02, 0.1], [4, 4, 20], SIDES);
    let explicit = ParcelPacking::Explicit {
        stress: STRESS,
        restitution: 0.9,
    };
    let heights = [ParcelPacking::Implicit(STRESS), explicit].map(|packing| {
        let mut rules = motion(&mesh, 0.5, 0.2);
        rules.gravity = Vec3::z() * -9.81;
        rules.packing = packing;
        rules.collisions = collisions(0.8, true, false);
        let mut bed = cloud(&mesh, rules, (6000, 0.2), |_| Vec3::zeros());
        let mut push = ParticlePush {
            force: vec![Vec3::zeros(); 6000],
            ..ParticlePush::default()
        };
        let coefficient = bed.parcels.fields().mass.iter().map(|mass| 20.0 * mass);
        push.columns.set(DRAG_COEFFICIENT, 1, coefficient.collect());
        push.columns.set(GAS_VELOCITY, 3, vec![0.0; 3 * 6000]);
        (0..500).for_each(|_| bed.window(1e-3, &push));
        let fraction = bed.parcels.solid_fraction();
        let most = fraction.into_iter().fold(0.0, f64::max);
        let places = bed.parcels.fields().position.iter();
        let height = places.map(|place| place.z).sum::<f64>() / 6000.0;
        println!("{:.2} mm, at most {most:.4}", 1e3 * height);
        (height, most)
    });
    let [(implicit, _), (explicit, most)] = heights;
    assert!((explicit / implicit - 1.0).abs() < 0.03, "{heights:?}");
    assert!(most < 1.03 * STRESS.close_packing, "{heights:?}");
}

/// Variance of the velocities along each axis in m²/s², and the mean speed about the mean.
fn spread(bed: &ParcelBed) -> (Vec3, f64) {
    let velocity = bed.parcels.fields().velocity;
    let count = velocity.len() as f64;
    let mean = velocity.iter().sum::<Vec3>() / count;
    let square = |one: &Vec3| (one - mean).component_mul(&(one - mean));
    let variance = velocity.iter().map(square).sum::<Vec3>() / count;
    let speed = velocity.iter().map(|one| (one - mean).norm()).sum::<f64>() / count;
    (variance, speed)
}

/// Σ |u|² in m²/s², which neither drawing anew nor elastic walls change.
fn energy(bed: &ParcelBed) -> f64 {
    let velocity = bed.parcels.fields().velocity.iter();
    velocity.map(Vec3::norm_squared).sum()
}

/// Frequency of collisions in 1/s of equal spheres of 0.5 mm radius: 3/4 α/r³ (2 r)² ⟨|u − ū|⟩.
fn frequency(fraction: f64, speed: f64) -> f64 {
    3.0 * fraction / 0.5e-3 * speed
}

const CROWD: f64 = 0.2;
const GAP: f64 = 0.6 / (0.6 - CROWD);

/// Parcels that collide, all in one cell.
fn gas_of_parcels(
    rules: ParcelCollisions,
    count: usize,
    velocity: impl Fn(&mut dyn FnMut() -> f64) -> Vec3,
) -> ParcelBed {
    let mesh = named_box([1.0; 3], [1, 1, 1], SIDES);
    let mut motion = motion(&mesh, 1.0, 0.0);
    motion.collisions = rules;
    motion.most_steps = 1_000_000;
    cloud(&mesh, motion, (count, CROWD), velocity)
}

#[test]
fn velocities_are_damped_at_the_rate_of_the_law() {
    let e: f64 = 0.7;
    let mut bed = gas_of_parcels(collisions(e, true, false), 20_000, isotropic);
    let (before, mut speed) = spread(&bed);
    let factor = 8.0 * 2.0_f64.sqrt() / (3.0 * std::f64::consts::PI) * 0.25 * (1.0 - e * e) * GAP;
    let mut exponent = 0.0;
    for _ in 0..20 {
        let last = speed;
        bed.run(1, 5e-5);
        speed = spread(&bed).1;
        // By the mean frequency of the step.
        exponent += 5e-5 * factor * frequency(CROWD, 0.5 * (last + speed));
    }
    // Twice x/2 of the difference from the mean.
    let (after, _) = spread(&bed);
    let found = (before.sum() / after.sum()).ln();
    println!("damping {found} of {exponent}");
    assert!(
        exponent > 0.1 && (found / exponent - 1.0).abs() < 0.02,
        "{found} {exponent}"
    );
}

#[test]
fn velocities_become_isotropic_at_the_rate_of_the_law() {
    let e: f64 = 0.7;
    let along = |next: &mut dyn FnMut() -> f64| Vec3::x() * (next() - 0.5);
    let mut bed = gas_of_parcels(collisions(e, false, true), 200_000, along);
    let (before, mut speed) = spread(&bed);
    let start = energy(&bed);
    let factor =
        8.0 * 2.0_f64.sqrt() / (5.0 * std::f64::consts::PI) * 0.25 * (3.0 - e) * (1.0 + e) * GAP;
    let mut exponent = 0.0;
    for _ in 0..30 {
        let last = speed;
        bed.run(1, 1e-4);
        speed = spread(&bed).1;
        exponent += 1e-4 * factor * frequency(CROWD, 0.5 * (last + speed));
    }
    let (after, _) = spread(&bed);
    assert!((energy(&bed) / start - 1.0).abs() < 1e-10);
    let excess = |variance: Vec3| variance.x - variance.sum() / 3.0;
    let found = (excess(before) / excess(after)).ln();
    println!("isotropy {found} of {exponent}");
    assert!(
        exponent > 0.5 && (found / exponent - 1.0).abs() < 0.02,
        "{found} {exponent}"
    );
}

#[test]
fn parcels_that_meet_go_on_from_a_checkpoint_and_on_any_number_of_threads_to_the_same_bits() {
    let make = || {
        let mesh = named_box([0.1; 3], [4; 3], SIDES);
        let mut rules = motion(&mesh, 0.5, 0.2);
        rules.gravity = Vec3::z() * -9.81;
        rules.packing = ParcelPacking::Implicit(STRESS);
        rules.collisions = collisions(0.8, true, true);
        cloud(&mesh, rules, (3000, 0.4), isotropic)
    };
    let folder = tempfile::tempdir().unwrap();
    let (mut whole, mut resumed) = (make(), make());
    whole.run(5, 2e-3);
    whole.parcels.checkpoint(folder.path()).unwrap();
    resumed.parcels.restore(folder.path()).unwrap();
    whole.run(5, 2e-3);
    resumed.run(5, 2e-3);
    assert_eq!(whole.bits(), resumed.bits());
    assert_eq!(whole.received, resumed.received);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut alone = make();
        pool.install(|| alone.run(10, 2e-3));
        assert_eq!(alone.bits(), whole.bits());
    }
}
