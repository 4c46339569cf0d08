//! A ring between two cylinders, for gases beside walls that turn.

use std::f64::consts::PI;

use calcine_physics::Vec3;

use crate::mesh::{Mesh, MeshError, Patch, Topology};
use crate::setup::{GasPatch, WallHeat, WallVelocity};

/// A wall that turns about z at a rate in rad/s.
pub fn turning(rate: f64) -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::Rotating {
            point: Vec3::new(0.0, 0.0, 7.0),
            angular_velocity: Vec3::new(0.0, 0.0, rate),
        },
        heat: WallHeat::Adiabatic,
    }
}

/// Conditions of the patches of a ring whose cylinders turn at rates in rad/s.
pub fn turning_ring([inner, outer]: [f64; 2]) -> [(&'static str, GasPatch); 4] {
    [
        ("inner", turning(inner)),
        ("outer", turning(outer)),
        ("bottom", GasPatch::Empty),
        ("top", GasPatch::Empty),
    ]
}

/// A ring about z between two radii in m, one cell of a length in m along z, with cells along the radius and around. Its patches are
/// `inner`, `outer`, `bottom` and `top`. Points lie on the circles.
pub fn annulus(
    [inner, outer]: [f64; 2],
    length: f64,
    [across, around]: [usize; 2],
) -> Result<Mesh, MeshError> {
    let mut topology = Topology {
        face_offsets: vec![0],
        ..Topology::default()
    };
    for z in [0.0, length] {
        for j in 0..around {
            let angle = 2.0 * PI * j as f64 / around as f64;
            for i in 0..=across {
                let r = inner + (outer - inner) * i as f64 / across as f64;
                let point = Vec3::new(r * angle.cos(), r * angle.sin(), z);
                topology.points.push(point);
            }
        }
    }
    let id = |i: usize, j: usize| i + across * j;
    let point =
        |i: usize, j: usize, k: usize| (i + (across + 1) * (j % around + around * k)) as u32;
    // Normals along the radius, around, and along z.
    let arc = |i: usize, j: usize| {
        [
            point(i, j, 0),
            point(i, j + 1, 0),
            point(i, j + 1, 1),
            point(i, j, 1),
        ]
    };
    let spoke = |i: usize, j: usize| {
        [
            point(i, j, 0),
            point(i, j, 1),
            point(i + 1, j, 1),
            point(i + 1, j, 0),
        ]
    };
    let lid = |i: usize, j: usize, k: usize| {
        [
            point(i, j, k),
            point(i + 1, j, k),
            point(i + 1, j + 1, k),
            point(i, j + 1, k),
        ]
    };
    let reversed = |mut corners: [u32; 4]| {
        corners.reverse();
        corners
    };
    let mut push = |corners: [u32; 4], owner: usize, other: Option<usize>| {
        topology.face_points.extend(corners);
        topology
            .face_offsets
            .push(topology.face_points.len() as u32);
        topology.owner.push(owner as u32);
        topology.neighbour.extend(other.map(|cell| cell as u32));
    };
    for j in 0..around {
        for i in 0..across {
            if i + 1 < across {
                push(arc(i + 1, j), id(i, j), Some(id(i + 1, j)));
            }
            if j + 1 < around {
                push(spoke(i, j + 1), id(i, j), Some(id(i, j + 1)));
            }
            if j == 0 {
                push(reversed(spoke(i, 0)), id(i, 0), Some(id(i, around - 1)));
            }
        }
    }
    for j in 0..around {
        push(reversed(arc(0, j)), id(0, j), None);
    }
    for j in 0..around {
        push(arc(across, j), id(across - 1, j), None);
    }
    for j in 0..around {
        for i in 0..across {
            push(reversed(lid(i, j, 0)), id(i, j), None);
        }
    }
    for j in 0..around {
        for i in 0..across {
            push(lid(i, j, 1), id(i, j), None);
        }
    }
    let mut start = topology.neighbour.len();
    let cells = across * around;
    for (name, count) in [
        ("inner", around),
        ("outer", around),
        ("bottom", cells),
        ("top", cells),
    ] {
        topology.patches.push(Patch {
            name: name.to_owned(),
            start,
            count,
        });
        start += count;
    }
    Mesh::new(topology)
}

/// How far a velocity in m/s at a place in m is from that of [`circular_couette`].
pub fn off_couette(radii: [f64; 2], rates: [f64; 2], place: Vec3, velocity: Vec3) -> f64 {
    let r = place.xy().norm();
    let around = Vec3::new(-place.y, place.x, 0.0) / r;
    (velocity - circular_couette(radii, rates, r) * around).norm()
}

/// Speed around in m/s at a radius in m between two long cylinders of radii in m that turn at rates in rad/s: u = A r + B/r
/// (Couette; Landau and Lifshitz, Fluid Mechanics, 1987, section 18).
fn circular_couette([inner, outer]: [f64; 2], [of_inner, of_outer]: [f64; 2], r: f64) -> f64 {
    let (a, b) = (inner * inner, outer * outer);
    let whole = (of_outer * b - of_inner * a) / (b - a);
    whole * r + (of_inner - of_outer) * a * b / (b - a) / r
}
