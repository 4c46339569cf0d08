//! Parcels on their ways through meshes of any cells, and their impacts on walls.
#![allow(clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::conformance::manufactured::CellShape;
use calcine_coupler::conformance::manufactured::meshes::shaped_box;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::cylinder::{CylinderSpec, cylinder_mesh};
use calcine_coupler::mesh::grading::uniform;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::mesh::refine::{Refinement, refine};
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::motion::WallMotion;
use calcine_coupler::part::{
    DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, Part, ParticlePush, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_native::parcels::{Tetrahedra, WayEnd};

use crate::common::named_box;
use crate::grains::scatter;
use crate::parcel_beds::{ParcelBed, motion, setup};

/// A box of these cells.
fn shaped(shape: CellShape, cells: usize) -> Arc<Mesh> {
    Arc::new(shaped_box(shape, cells, |place| place).unwrap())
}

fn plain(size: [f64; 3], cells: [usize; 3]) -> Arc<Mesh> {
    named_box(
        size,
        cells,
        ["west", "east", "south", "north", "bottom", "top"],
    )
}

fn cylinder() -> Arc<Mesh> {
    let mesh = cylinder_mesh(&CylinderSpec {
        origin: Vec3::zeros(),
        diameter: 0.2,
        length: 0.3,
        cells_across: 9,
        along: uniform(6),
        patches: ["side", "bottom", "top"].map(String::from),
    });
    Arc::new(mesh.unwrap())
}

/// A box with a finer part.
fn refined() -> Arc<Mesh> {
    let zone = Zone::Box {
        low: Vec3::new(0.2, 0.0, 0.3),
        high: Vec3::new(0.7, 0.5, 0.8),
    };
    let coarse = plain([1.0, 1.0, 1.0], [6, 6, 6]);
    Arc::new(refine(&coarse, &[Refinement { zone, levels: 2 }]).unwrap())
}

fn meshes() -> Vec<(&'static str, Arc<Mesh>)> {
    vec![
        ("box", plain([1.0, 0.5, 1.0], [5, 3, 4])),
        ("refined", refined()),
        ("cylinder", cylinder()),
        ("warped hexahedra", shaped(CellShape::Hexahedra(0.3), 6)),
        ("tetrahedra", shaped(CellShape::Tetrahedra(0.2), 4)),
        ("polyhedra", shaped(CellShape::Polyhedra(0.2), 4)),
    ]
}

/// A place within the box about a mesh.
fn somewhere(mesh: &Mesh, next: &mut impl FnMut() -> f64) -> Vec3 {
    let [low, high] = mesh.bounds();
    let share = Vec3::new(next(), next(), next());
    low + (high - low).component_mul(&share)
}

#[test]
fn a_way_ends_where_it_should_in_the_cell_that_holds_its_end() {
    for (name, mesh) in meshes() {
        let tetrahedra = Tetrahedra::new(Arc::clone(&mesh)).unwrap();
        let locator = Locator::new(Arc::clone(&mesh));
        let mut next = scatter(5);
        let (mut ways, mut differ) = (0, 0);
        while ways < 4000 {
            let (from, to) = (somewhere(&mesh, &mut next), somewhere(&mesh, &mut next));
            let (Some(start), Some(cell)) = (tetrahedra.locate(from), locator.cell_at(to)) else {
                continue;
            };
            let (mut place, mut at) = (start, from);
            let end = tetrahedra.take(&mut place, &mut at, to - from);
            if name == "cylinder" && end != WayEnd::Arrived {
                // Its outline is convex, but for round-off.
                panic!("{name}: {from} to {to}: {end:?}");
            }
            assert_eq!(end, WayEnd::Arrived, "{name}: {from} to {to}");
            assert!((at - to).norm() < 1e-15, "{name}: {from} to {to}: {at}");
            // Cells with warped faces meet along other triangles than those of the locator.
            differ += u32::from(place.cell as usize != cell);
            ways += 1;
        }
        println!("{name}: {differ} of {ways} ends in another cell");
        assert!(differ <= 20, "{name}: {differ}");
        let map = |place| tetrahedra.map(place);
        let from = mesh.cell_centre()[0];
        let place = tetrahedra.locate(from).unwrap();
        assert!(map(place).determinant > 0.0);
    }
}

#[test]
fn ways_through_corners_edges_and_centres_are_not_lost() {
    let cells = [4, 4, 4];
    let mesh = plain([1.0, 1.0, 1.0], cells);
    let tetrahedra = Tetrahedra::new(Arc::clone(&mesh)).unwrap();
    let at = |i: usize| {
        let share = |k: usize| k as f64 / 8.0;
        Vec3::new(share(i % 9), share(i / 9 % 9), share(i / 81))
    };
    // From every eighth to every other one: along faces, edges and through points, from and to them.
    let mut next = scatter(3);
    for i in 0..729 {
        for _ in 0..12 {
            let j = (next() * 729.0) as usize;
            let (from, to) = (at(i), at(j));
            let Some(mut place) = tetrahedra.locate(from) else {
                panic!("{from} is not found");
            };
            let mut here = from;
            let mut way = to - from;
            // Along a wall it may be at it: what is left of the way goes on.
            for _ in 0..64 {
                match tetrahedra.take(&mut place, &mut here, way) {
                    WayEnd::Arrived => break,
                    WayEnd::Wall { share, normal, .. } => {
                        way *= 1.0 - share;
                        way -= way.dot(&normal).max(0.0) * normal;
                    }
                }
            }
            assert!((here - to).norm() < 1e-6, "{from} to {to}: {here}");
        }
    }
}

#[test]
fn parcels_fly_for_long_in_any_mesh_and_are_within_it_afterwards() {
    for (name, mesh) in meshes() {
        let mut next = scatter(11);
        let mut parcels = Vec::new();
        let locator = Locator::new(Arc::clone(&mesh));
        while parcels.len() < 200 {
            let place = somewhere(&mesh, &mut next);
            let velocity = Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5);
            if locator.cell_at(place).is_some() {
                parcels.push((place, velocity.normalize()));
            }
        }
        let mut bed = ParcelBed::new(&mesh, &setup(motion(&mesh, 1.0, 0.0), &parcels, 1e-3, 10.0));
        let before = bed.momentum();
        let mut support = Vec3::zeros();
        for _ in 0..20 {
            bed.run(1, 0.5);
            support += bed.received.support.unwrap();
        }
        let fields = bed.parcels.fields();
        for row in 0..200 {
            let speed = fields.velocity[row].norm();
            assert!((speed - 1.0).abs() < 1e-12, "{name}: {speed}");
            assert!(
                locator.cell_at(fields.position[row]).is_some(),
                "{name}: {row}"
            );
        }
        let off = bed.momentum() - before - support;
        let mass: f64 = (0..200).map(|row| fields.row_mass(row)).sum();
        assert!(off.norm() < 1e-13 * mass, "{name}: {off}");
    }
}

#[test]
fn a_way_across_periodic_planes_is_the_same_as_in_one_piece() {
    let mesh = plain([0.6, 0.5, 0.4], [3, 3, 4]);
    let pairs = [["west", "east"], ["bottom", "top"]].map(|pair| pair.map(String::from));
    let mesh = Arc::new(Mesh::clone(&mesh).with_periodic(&pairs).unwrap());
    let tetrahedra = Tetrahedra::new(Arc::clone(&mesh)).unwrap();
    let locator = Locator::new(Arc::clone(&mesh));
    let mut next = scatter(9);
    for _ in 0..500 {
        let from = somewhere(&mesh, &mut next);
        let to = somewhere(&mesh, &mut next);
        let periods = Vec3::new(
            (next() * 7.0).floor() - 3.0,
            0.0,
            (next() * 7.0).floor() - 3.0,
        );
        let beyond = to + periods.component_mul(&Vec3::new(0.6, 0.0, 0.4));
        let (mut place, mut at) = (tetrahedra.locate(from).unwrap(), from);
        assert_eq!(
            tetrahedra.take(&mut place, &mut at, beyond - from),
            WayEnd::Arrived
        );
        assert!((at - to).norm() < 1e-14, "{at} {to}");
        assert_eq!(Some(place.cell as usize), locator.cell_at(to));
    }
}

/// A ball that falls from a height in a box of a hundred cells.
fn thrown(restitution: f64, windows: usize, span: f64) -> (ParcelBed, f64) {
    let mesh = plain([0.1, 0.1, 1.0], [2, 2, 25]);
    let mut rules = motion(&mesh, restitution, 0.0);
    rules.gravity = Vec3::z() * -9.81;
    let start = [(Vec3::new(0.031, 0.047, 0.5), Vec3::zeros())];
    let mut bed = ParcelBed::new(&mesh, &setup(rules, &start, 1e-3, 1.0));
    let mut highest: f64 = 0.0;
    for _ in 0..windows {
        bed.run(1, span);
        if bed.parcels.fields().velocity[0].z > 0.0 {
            highest = highest.max(bed.parcels.fields().position[0].z);
        }
    }
    (bed, highest)
}

#[test]
fn a_throw_is_exact_for_any_number_of_steps() {
    for windows in [1, 7, 50] {
        let (bed, _) = thrown(1.0, windows, 0.3 / windows as f64);
        let fields = bed.parcels.fields();
        assert!((fields.position[0].z - (0.5 - 0.5 * 9.81 * 0.09)).abs() < 1e-11);
        assert!((fields.velocity[0].z + 9.81 * 0.3).abs() < 1e-11);
    }
    // Steps follow the window and the Courant number.
    assert!(thrown(1.0, 1, 0.3).0.parcels.steps() >= 11);
}

#[test]
fn a_ball_rebounds_to_the_square_of_its_restitution_and_comes_to_rest() {
    let heights = [2e-3, 1e-3, 5e-4].map(|span| thrown(0.8, (0.6 / span) as usize, span).1);
    let errors = heights.map(|height| (height / (0.64 * 0.5) - 1.0).abs());
    println!("{errors:?}");
    assert!(errors[2] < 2e-3, "{errors:?}");
    let (bed, _) = thrown(0.5, 3000, 1e-3);
    let fields = bed.parcels.fields();
    assert!(fields.position[0].z < 1e-9 && fields.velocity[0].norm() < 1e-12);
    // The floor carries its weight.
    let weight = fields.mass[0] * 9.81 * 1e-3;
    let carried = bed.received.support.unwrap().z;
    assert!((carried / weight - 1.0).abs() < 1e-12, "{carried} {weight}");
}

#[test]
fn friction_stops_a_parcel_that_slides_and_a_turning_wall_takes_it_along() {
    let mesh = plain([1.0, 0.1, 0.1], [20, 2, 2]);
    let mut rules = motion(&mesh, 0.0, 0.3);
    rules.gravity = Vec3::z() * -9.81;
    let slide = |rules: &calcine_coupler::parcels::ParcelMotion, seconds: f64| {
        let start = [(Vec3::new(0.1, 0.05, 0.0), Vec3::new(1.0, 0.0, 0.0))];
        let mut bed = ParcelBed::new(&mesh, &setup(rules.clone(), &start, 1e-3, 3.0));
        bed.run((seconds * 1e3) as usize, 1e-3);
        let fields = bed.parcels.fields();
        (fields.position[0].x - 0.1, fields.velocity[0].x)
    };
    // v²/(2 μ g), and on the way v − μ g t.
    let (way, speed) = slide(&rules, 0.2);
    assert!((speed - (1.0 - 0.3 * 9.81 * 0.2)).abs() < 1e-9, "{speed}");
    assert!(
        (way - (0.2 - 0.5 * 0.3 * 9.81 * 0.04)).abs() < 1e-6,
        "{way}"
    );
    let (way, speed) = slide(&rules, 0.5);
    assert!(
        (way / (0.5 / (0.3 * 9.81)) - 1.0).abs() < 2e-3 && speed.abs() < 1e-12,
        "{way}"
    );
    // On a belt it ends with the belt's velocity.
    for wall in &mut rules.walls {
        wall.motion = WallMotion::Translating(Vec3::new(0.4, 0.0, 0.0));
    }
    let (_, speed) = slide(&rules, 0.5);
    assert!((speed - 0.4).abs() < 1e-12, "{speed}");
}

/// Parcels in drag by a vortex, each with another coefficient.
fn stirred(weight: f64) -> ParcelBed {
    let mesh = shaped(CellShape::Hexahedra(0.2), 6);
    let mut rules = motion(&mesh, 0.7, 0.2);
    rules.gravity = Vec3::z() * -9.81;
    let mut next = scatter(2);
    let parcels: Vec<(Vec3, Vec3)> = (0..600)
        .map(|_| {
            (
                somewhere(&mesh, &mut next),
                Vec3::new(next(), next(), next()),
            )
        })
        .collect();
    ParcelBed::new(&mesh, &setup(rules, &parcels, 1e-3, weight))
}

fn stir(bed: &mut ParcelBed, windows: usize) {
    for _ in 0..windows {
        let fields = bed.parcels.fields();
        let gas = |place: &Vec3| [place.z - 0.5, 0.0, 0.5 - place.x];
        let mut push = ParticlePush {
            force: fields.mass.iter().map(|mass| *mass * Vec3::x()).collect(),
            ..ParticlePush::default()
        };
        let rate = |(row, mass): (usize, &f64)| mass * (row % 7) as f64;
        let drag = fields.mass.iter().enumerate().map(rate).collect();
        let gas = fields.position.iter().flat_map(gas).collect();
        push.columns.set(DRAG_COEFFICIENT, 1, drag);
        push.columns.set(GAS_VELOCITY, 3, gas);
        bed.window(0.02, &push);
    }
}

#[test]
fn what_forces_drag_gravity_and_walls_give_is_what_parcels_gain() {
    let mut bed = stirred(7.0);
    for _ in 0..10 {
        let before = bed.momentum();
        stir(&mut bed, 1);
        let fields = bed.parcels.fields();
        let mut given = bed.received.support.unwrap();
        let mut size = 0.0;
        for (row, impulse) in bed.received.impulse.iter().enumerate() {
            let weight = fields.row_mass(row) * 0.02 * -9.81 * Vec3::z();
            given += 7.0 * impulse + weight;
            size += 7.0 * impulse.norm() + weight.norm();
        }
        let off = bed.momentum() - before - given;
        assert!(off.norm() < 1e-13 * size, "{off} of {size}");
    }
}

#[test]
fn one_parcel_of_weight_seven_moves_as_seven_particles() {
    let (mut one, mut seven) = (stirred(1.0), stirred(7.0));
    for bed in [&mut one, &mut seven] {
        stir(bed, 10);
    }
    assert_eq!(one.bits(), seven.bits());
    assert_eq!(one.received.impulse, seven.received.impulse);
    let columns = [&one, &seven].map(|bed| {
        bed.received
            .columns
            .get(DRAG_IMPULSE, 3, 600)
            .unwrap()
            .to_vec()
    });
    assert_eq!(columns[0], columns[1]);
    let supports = [&one, &seven].map(|bed| bed.received.support.unwrap());
    assert!((7.0 * supports[0] - supports[1]).norm() < 1e-14 * supports[1].norm());
}

#[test]
fn a_run_goes_on_from_a_checkpoint_and_on_any_number_of_threads_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mut whole = stirred(7.0);
    stir(&mut whole, 5);
    whole.parcels.checkpoint(folder.path()).unwrap();
    let mut resumed = stirred(7.0);
    resumed.parcels.restore(folder.path()).unwrap();
    assert_eq!(resumed.bits(), whole.bits());
    stir(&mut whole, 5);
    stir(&mut resumed, 5);
    assert_eq!(resumed.bits(), whole.bits());
    assert_eq!(resumed.received, whole.received);
    assert_eq!(resumed.parcels.steps(), whole.parcels.steps());
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut alone = stirred(7.0);
        pool.install(|| stir(&mut alone, 10));
        assert_eq!(alone.bits(), whole.bits());
        assert_eq!(alone.received.support, whole.received.support);
    }
}
