//! Walls: moving ones drag, and the edges of triangles count once.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use calcine_coupler::motion::{Contacts, WallMotion, WallShape};
use calcine_coupler::part::Particles;
use calcine_coupler::physics::Vec3;

use crate::grains::*;

const RADIUS: f64 = 1e-3;

fn heavy(step: f64) -> Contacts {
    let mut contacts = contacts(step);
    contacts.gravity = Vec3::z() * -9.81;
    contacts
}

/// A floor of squares of a size, each cut into two triangles, from −size·half to size·half.
fn tiles(half: i32, size: f64) -> WallShape {
    let corner = |i: i32, j: i32| Vec3::new(f64::from(i), f64::from(j), 0.0) * size;
    let mut triangles = Vec::new();
    for i in -half..half {
        for j in -half..half {
            let [a, b, c, d] = [
                corner(i, j),
                corner(i + 1, j),
                corner(i, j + 1),
                corner(i + 1, j + 1),
            ];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    WallShape::Mesh { triangles }
}

#[test]
fn faces_edges_and_corners_of_a_mesh_carry_a_sphere_as_one_plane_does() {
    let rest = |shape: WallShape, x: f64, y: f64| {
        let mut contacts = heavy(1e-5);
        contacts.walls = vec![wall(shape)];
        let mut bed = Bed::new(
            contacts,
            &[sphere(1, Vec3::new(x, y, RADIUS), Vec3::zeros(), RADIUS)],
        );
        bed.run(5000);
        bed.place(0)
    };
    let flat = WallShape::Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
    };
    let plane = rest(flat, 0.0, 0.0).z;
    // In a face, on an edge, at a corner of six, and where all triangles are smaller than the contact.
    for (size, x, y) in [
        (0.01, 0.003, 0.002),
        (0.01, 0.004, 0.0),
        (0.01, 0.004, 1e-12),
        (0.01, 0.005, 0.005),
        (0.01, 0.0, 0.0),
        (2e-5, 3e-6, 4e-6),
    ] {
        let found = rest(tiles(3, size), x, y);
        assert!(
            (found.z - plane).abs() < 1e-6 * (RADIUS - plane),
            "{size} {x} {y}: {found}"
        );
        assert!(
            (found.x - x).abs() < 1e-12 && (found.y - y).abs() < 1e-12,
            "{found}"
        );
    }
}

#[test]
fn a_sphere_rolls_across_triangles_as_over_a_plane() {
    let speed = |shape: WallShape| {
        let mut contacts = heavy(1e-5);
        contacts.walls = vec![wall(shape)];
        let start = Vec3::new(-0.01, 3e-4, RADIUS);
        let mut bed = Bed::new(
            contacts,
            &[sphere(1, start, Vec3::new(0.2, 0.03, 0.0), RADIUS)],
        );
        bed.run(8000);
        (bed.place(0), bed.velocity(0), bed.spin(0))
    };
    let flat = WallShape::Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
    };
    let (plane, mesh) = (speed(flat), speed(tiles(10, 0.0023)));
    assert!((plane.0 - mesh.0).norm() < 1e-8, "{} {}", plane.0, mesh.0);
    assert!((plane.1 - mesh.1).norm() < 1e-6 && (plane.2 - mesh.2).norm() < 1e-3);
}

#[test]
fn a_groove_of_two_faces_carries_a_sphere_on_both_and_a_ridge_throws_it_once() {
    let roof = |slope: f64| {
        let y = 0.02;
        let at = |x: f64, y: f64| Vec3::new(x, y, slope * x.abs());
        let mut triangles = Vec::new();
        for x in [-0.02, 0.02] {
            triangles.push([at(0.0, -y), at(x, -y), at(x, y)]);
            triangles.push([at(0.0, -y), at(x, y), at(0.0, y)]);
        }
        wall(WallShape::Mesh { triangles })
    };
    let mut contacts = heavy(1e-5);
    contacts.pairs[0].friction = 0.0;
    contacts.walls = vec![roof(1.0)];
    let touch = 2f64.sqrt() * RADIUS;
    let mut bed = Bed::new(
        contacts.clone(),
        &[sphere(1, Vec3::z() * touch, Vec3::zeros(), RADIUS)],
    );
    bed.run(20_000);
    // Each face carries the weight over √2.
    let weight = bed.particles.fields().mass[0] * 9.81;
    let stiffness = 4.0 / 3.0 * (1e7 / 1.875) * RADIUS.sqrt();
    let overlap = (weight / 2f64.sqrt() / stiffness).powf(2.0 / 3.0);
    let wanted = 2f64.sqrt() * (RADIUS - overlap);
    assert!(
        (bed.place(0).z - wanted).abs() < 1e-5 * overlap,
        "{}",
        bed.place(0).z - wanted
    );
    // On the ridge the elastic rebound is that from one plane: the same speed, the same time.
    contacts.pairs[0].restitution = 1.0;
    contacts.gravity = Vec3::zeros();
    contacts.step = 1e-6;
    contacts.walls = vec![roof(-1.0)];
    let falls = sphere(1, Vec3::z() * RADIUS, Vec3::z() * -0.5, RADIUS);
    let mut ridge = Bed::new(contacts.clone(), &[falls]);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    let mut flat = Bed::new(contacts, &[falls]);
    ridge.run(100);
    flat.run(100);
    assert!((ridge.place(0) - flat.place(0)).norm() < 1e-12);
}

#[test]
fn a_turning_cylinder_drags_a_sphere_along_until_it_slides_no_more() {
    let mut contacts = contacts(1e-5);
    let spin = 5.0;
    contacts.walls = vec![wall(WallShape::Cylinder {
        point: Vec3::zeros(),
        axis: Vec3::y(),
        radius: 0.02,
    })];
    contacts.walls[0].motion = WallMotion::Rotating {
        point: Vec3::zeros(),
        angular_velocity: Vec3::y() * spin,
    };
    // It lies at the bottom; the wall goes by at ω × r = 5 · 0.02 along −x.
    contacts.gravity = Vec3::z() * -9.81;
    let start = Vec3::z() * -(0.02 - RADIUS);
    let mut bed = Bed::new(contacts, &[sphere(1, start, Vec3::zeros(), RADIUS)]);
    bed.run(200);
    assert!(bed.velocity(0).x < 0.0, "{}", bed.velocity(0));
    bed.run(20_000);
    // It does not slide: the point that touches has the speed of the wall.
    let touch = bed.velocity(0) + bed.spin(0).cross(&(bed.place(0).normalize() * RADIUS));
    assert!((touch.norm() / 0.1 - 1.0).abs() < 0.02, "{touch}");
}

#[test]
fn a_floor_that_rises_by_a_schedule_lifts_a_sphere_and_then_holds_it() {
    let mut contacts = heavy(1e-5);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts.walls[0].motion = WallMotion::Scheduled {
        direction: Vec3::z(),
        distance: vec![(0.0, 0.0), (0.1, 0.01), (1.0, 0.01)],
    };
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::z() * RADIUS, Vec3::zeros(), RADIUS)],
    );
    bed.run(9_000);
    assert!((bed.velocity(0).z - 0.1).abs() < 1e-4);
    bed.run(41_000);
    let height = bed.place(0).z - (0.01 + RADIUS);
    assert!(height.abs() < 1e-5, "{height}");
    assert!(bed.velocity(0).norm() < 1e-4, "{}", bed.velocity(0));
}

#[test]
fn a_rising_floor_lifts_and_a_turning_mesh_drags_as_its_cylinder_does() {
    let mut contacts = heavy(1e-5);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts.walls[0].motion = WallMotion::Translating(Vec3::z() * 0.1);
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::z() * RADIUS, Vec3::zeros(), RADIUS)],
    );
    bed.run(20_000);
    assert!(
        (bed.place(0).z - (0.02 + RADIUS)).abs() < 1e-5,
        "{}",
        bed.place(0)
    );
    assert!((bed.velocity(0).z - 0.1).abs() < 1e-4);
    // A plate that turns about the upright axis carries what sticks to it round.
    let mut contacts = heavy(1e-5);
    contacts.pairs[0].friction = 0.9;
    contacts.walls = vec![wall(tiles(2, 0.02))];
    contacts.walls[0].motion = WallMotion::Rotating {
        point: Vec3::zeros(),
        angular_velocity: Vec3::z() * 3.0,
    };
    let mut mesh = Bed::new(
        contacts.clone(),
        &[sphere(
            1,
            Vec3::new(0.01, 0.0, RADIUS),
            Vec3::zeros(),
            RADIUS,
        )],
    );
    contacts.walls[0].shape = WallShape::Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
    };
    let mut flat = Bed::new(
        contacts,
        &[sphere(
            1,
            Vec3::new(0.01, 0.0, RADIUS),
            Vec3::zeros(),
            RADIUS,
        )],
    );
    mesh.run(20_000);
    flat.run(20_000);
    assert!(flat.velocity(0).norm() > 1e-3);
    assert!(
        (mesh.place(0) - flat.place(0)).norm() < 1e-7,
        "{} {}",
        mesh.place(0),
        flat.place(0)
    );
}

#[test]
fn a_cone_guides_a_sphere_to_its_hole_and_holds_one_that_is_larger() {
    let drop = |radius: f64| {
        let mut contacts = heavy(1e-5);
        contacts.walls = vec![wall(WallShape::Cone {
            ends: [Vec3::zeros(), Vec3::z() * 0.02],
            radii: [3e-3, 0.02],
        })];
        let mut bed = Bed::new(
            contacts,
            &[sphere(
                1,
                Vec3::new(0.01, 0.0, 0.025),
                Vec3::zeros(),
                radius,
            )],
        );
        bed.run(20_000);
        bed.place(0)
    };
    assert!(drop(2e-3).z < -0.01);
    let held = drop(5e-3);
    assert!(held.z > 0.0 && held.xy().norm() < 5e-3, "{held}");
}
