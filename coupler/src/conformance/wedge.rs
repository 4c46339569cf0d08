//! A slice of a round pipe, for gases with axisymmetric flows.

use calcine_physics::Vec3;

use crate::mesh::{Mesh, MeshError, Patch, Topology};

/// A slice of a pipe along z, of a radius and a length in m, cells along radius and length, and an angle in degrees between its
/// sides, symmetric about y = 0. Its patches are `wall`, `front` (low y), `back`, `bottom` and `top`. Points lie at x = r, so
/// that areas and volumes are those of the round pipe times the tangent of the half angle.
pub fn pipe_slice(
    radius: f64,
    length: f64,
    [across, along]: [usize; 2],
    angle: f64,
) -> Result<Mesh, MeshError> {
    let tangent = (0.5 * angle).to_radians().tan();
    let level = 1 + 2 * across;
    let mut topology = Topology {
        face_offsets: vec![0],
        ..Topology::default()
    };
    for k in 0..=along {
        let z = length * k as f64 / along as f64;
        topology.points.push(Vec3::new(0.0, 0.0, z));
        for i in 1..=across {
            let r = radius * i as f64 / across as f64;
            topology.points.push(Vec3::new(r, -tangent * r, z));
            topology.points.push(Vec3::new(r, tangent * r, z));
        }
    }
    let id = |i: usize, k: usize| i + across * k;
    // Points at radius i on the side of low (0) or high (1) y; on the axis they are one.
    let point = |i: usize, side: usize, k: usize| match i {
        0 => (k * level) as u32,
        _ => (k * level + 2 * i - 1 + side) as u32,
    };
    let arc = |i: usize, k: usize| {
        [
            point(i, 0, k),
            point(i, 1, k),
            point(i, 1, k + 1),
            point(i, 0, k + 1),
        ]
    };
    // Seen from above, counter-clockwise.
    let lid = |i: usize, k: usize| {
        [
            point(i, 0, k),
            point(i + 1, 0, k),
            point(i + 1, 1, k),
            point(i, 1, k),
        ]
    };
    let side = |i: usize, side: usize, k: usize| {
        [
            point(i, side, k),
            point(i + 1, side, k),
            point(i + 1, side, k + 1),
            point(i, side, k + 1),
        ]
    };
    let mut push = |mut corners: Vec<u32>, owner: usize, other: Option<usize>| {
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        topology.face_points.extend(corners);
        topology
            .face_offsets
            .push(topology.face_points.len() as u32);
        topology.owner.push(owner as u32);
        topology.neighbour.extend(other.map(|cell| cell as u32));
    };
    for k in 0..along {
        for i in 0..across {
            if i + 1 < across {
                push(arc(i + 1, k).into(), id(i, k), Some(id(i + 1, k)));
            }
            if k + 1 < along {
                push(lid(i, k + 1).into(), id(i, k), Some(id(i, k + 1)));
            }
        }
    }
    let reversed = |corners: [u32; 4]| corners.into_iter().rev().collect::<Vec<u32>>();
    for k in 0..along {
        push(arc(across, k).into(), id(across - 1, k), None);
    }
    for high in [false, true] {
        for k in 0..along {
            for i in 0..across {
                let corners = side(i, usize::from(high), k);
                let corners = if high {
                    reversed(corners)
                } else {
                    corners.into()
                };
                push(corners, id(i, k), None);
            }
        }
    }
    for i in 0..across {
        push(reversed(lid(i, 0)), id(i, 0), None);
    }
    for i in 0..across {
        push(lid(i, along).into(), id(i, along - 1), None);
    }
    let mut start = topology.neighbour.len();
    for (name, count) in [
        ("wall", along),
        ("front", across * along),
        ("back", across * along),
        ("bottom", across),
        ("top", across),
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
