//! Exact overlap of a ball and a polyhedron.

use calcine_physics::Vec3;

use crate::mesh::Mesh;
use crate::mesh::locate::Locator;

/// Volumes that a ball shares with the cells of a mesh.
///
/// The cell is the signed sum of the cones from the ball's centre to its faces. At the height h
/// over a plane face F, with the disc D of radius ρ = √(R² − h²) that the ball cuts from the plane,
/// cone ∩ ball = h/3 · area(F ∩ D) + R³/3 · Ω(F ∖ D), Ω the solid angle. Both are sums over the
/// edges of F of what the triangle (foot of the centre, edge) has. Faces that are not plane are
/// taken as triangles around the mean of their points, as for cell volumes.
#[derive(Clone, Debug)]
pub(super) struct Overlap {
    plane: Vec<bool>,
}

impl Overlap {
    pub fn new(locator: &Locator<'_>) -> Self {
        let faces = 0..locator.mesh().faces();
        Self {
            plane: faces.map(|face| locator.warp(face) == 0.0).collect(),
        }
    }

    /// Volume in m³ that the ball shares with a cell, to round-off of the ball's own volume.
    pub fn volume(&self, mesh: &Mesh, cell: usize, centre: Vec3, radius: f64) -> f64 {
        let mut volume = 0.0;
        for &face in mesh.faces_of(cell) {
            let face = face as usize;
            let outward = if mesh.owner()[face] as usize == cell {
                1.0
            } else {
                -1.0
            };
            volume += outward * self.cone(mesh, face, centre, radius);
        }
        volume
    }

    /// Signed volume of ball ∩ cone over one face, positive where the face's normal points away.
    fn cone(&self, mesh: &Mesh, face: usize, centre: Vec3, radius: f64) -> f64 {
        let points = mesh.face_points(face);
        let count = points.len();
        let at = |i: usize| mesh.topology().points[points[i % count] as usize] - centre;
        if self.plane[face] {
            let normal = mesh.face_area()[face].normalize();
            let height = normal.dot(&(mesh.face_centre()[face] - centre));
            let plane = Plane::new(normal, height, radius);
            return plane.cone((0..count).map(|i| plane.edge(at(i), at(i + 1))));
        }
        let middle = (0..count).map(at).sum::<Vec3>() / count as f64;
        let triangle = |i: usize| {
            let corners = [middle, at(i), at(i + 1)];
            let area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            if area.norm() == 0.0 {
                return 0.0;
            }
            let normal = area.normalize();
            let plane = Plane::new(normal, normal.dot(&middle), radius);
            plane.cone((0..3).map(|k| plane.edge(corners[k], corners[(k + 1) % 3])))
        };
        (0..count).map(triangle).sum()
    }
}

/// A plane seen from the ball's centre.
struct Plane {
    normal: Vec3,
    /// Signed height h of the plane over the centre in m.
    height: f64,
    radius: f64,
    /// ρ² in m²; not positive where the ball does not reach the plane.
    disc: f64,
}

/// What the triangle (foot, edge) has inside the disc and outside.
struct Part {
    /// Area in m² inside.
    area: f64,
    /// Solid angle outside.
    angle: f64,
}

impl Plane {
    fn new(normal: Vec3, height: f64, radius: f64) -> Self {
        Self {
            normal,
            height,
            radius,
            disc: (radius - height) * (radius + height),
        }
    }

    fn cone(&self, parts: impl Iterator<Item = Part>) -> f64 {
        let (mut area, mut angle) = (0.0, 0.0);
        for part in parts {
            area += part.area;
            angle += part.angle;
        }
        self.height * area / 3.0 + self.height.signum() * self.radius.powi(3) * angle / 3.0
    }

    /// The contribution of an edge from `a` to `b`, both relative to the ball's centre.
    fn edge(&self, a: Vec3, b: Vec3) -> Part {
        let in_plane = |p: Vec3| p - self.normal * self.normal.dot(&p);
        let (a, b) = (in_plane(a), in_plane(b));
        let along = b - a;
        let (square, slope) = (along.norm_squared(), a.dot(&along));
        let root = slope * slope - square * (a.norm_squared() - self.disc);
        if self.disc <= 0.0 || square == 0.0 || root <= 0.0 {
            return self.beyond(a, b);
        }
        let enter = ((-slope - root.sqrt()) / square).clamp(0.0, 1.0);
        let leave = ((-slope + root.sqrt()) / square).clamp(0.0, 1.0);
        let (p, q) = (a + along * enter, a + along * leave);
        let (first, last) = (self.beyond(a, p), self.beyond(q, b));
        Part {
            area: first.area + 0.5 * self.turn(p, q) + last.area,
            angle: first.angle + last.angle,
        }
    }

    /// p × q along the normal.
    fn turn(&self, p: Vec3, q: Vec3) -> f64 {
        self.normal.dot(&p.cross(&q))
    }

    /// The triangle (foot, p, q) of an edge that lies outside the disc: the disc's sector of angle θ
    /// lies inside; outside is the triangle's solid angle (Van Oosterom and Strackee,
    /// doi:10.1109/TBME.1983.325207, with one corner at the foot) less the sector's θ (1 − h/R).
    fn beyond(&self, p: Vec3, q: Vec3) -> Part {
        let turn = self.turn(p, q);
        if turn == 0.0 {
            return Part {
                area: 0.0,
                angle: 0.0,
            };
        }
        let height = self.height.abs();
        let (far_p, far_q) = (height.hypot(p.norm()), height.hypot(q.norm()));
        let along = p.dot(&q);
        let denominator = far_p * far_q + height * (far_p + far_q) + height * height + along;
        let triangle = 2.0 * turn.atan2(denominator);
        if self.disc <= 0.0 {
            return Part {
                area: 0.0,
                angle: triangle,
            };
        }
        let sector = turn.atan2(along);
        Part {
            area: 0.5 * self.disc * sector,
            angle: triangle - sector * (1.0 - height / self.radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::mesh::Topology;
    use crate::mesh::block::{BoxSpec, box_mesh};

    /// 3 x 3 x 3 unit cells, their points moved by `shift`.
    fn moved(shift: impl Fn(Vec3) -> Vec3) -> Mesh {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::repeat(3.0),
            cells: [3; 3],
            patches: ["all"; 6].map(String::from),
        };
        let mut topology: Topology = box_mesh(&spec).unwrap().topology().clone();
        for point in &mut topology.points {
            *point += shift(*point);
        }
        Mesh::new(topology).unwrap()
    }

    fn warped() -> Mesh {
        moved(|p| {
            Vec3::new(
                (2.1 * p.y * p.z).sin(),
                (1.7 * p.x).cos(),
                (p.x * p.y).sin(),
            ) * 0.08
        })
    }

    fn volumes(mesh: &Mesh, centre: Vec3, radius: f64) -> Vec<f64> {
        let overlap = Overlap::new(&Locator::new(mesh));
        (0..mesh.cells())
            .map(|cell| overlap.volume(mesh, cell, centre, radius))
            .collect()
    }

    fn ball(radius: f64) -> f64 {
        4.0 / 3.0 * PI * radius.powi(3)
    }

    #[test]
    fn a_ball_over_a_face_is_cut_into_a_cap_and_the_rest() {
        let mesh = moved(|_| Vec3::zeros());
        let volumes = volumes(&mesh, Vec3::new(1.4, 1.5, 0.9), 0.3);
        // Cap of height 0.2: pi h^2 (3 R - h)/3.
        let cap = PI * 0.2 * 0.2 * (0.9 - 0.2) / 3.0;
        assert!((volumes[4] - (ball(0.3) - cap)).abs() < 1e-15);
        assert!((volumes[13] - cap).abs() < 1e-15);
    }

    #[test]
    fn a_ball_at_a_corner_has_an_octant_in_each_cell() {
        let mesh = moved(|_| Vec3::zeros());
        let volumes = volumes(&mesh, Vec3::new(1.0, 1.0, 1.0), 0.7);
        for cell in [0, 1, 3, 4, 9, 10, 12, 13] {
            assert!((volumes[cell] - ball(0.7) / 8.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_ball_within_a_cell_is_all_there_and_a_cell_within_a_ball_too() {
        let mesh = moved(|_| Vec3::zeros());
        let small = volumes(&mesh, Vec3::new(1.3, 1.6, 1.4), 0.2);
        assert!((small[13] - ball(0.2)).abs() < 1e-16);
        // Over the far cells the cones cancel to round-off of the ball.
        assert!(
            small
                .iter()
                .enumerate()
                .all(|(c, v)| c == 13 || v.abs() < 1e-16)
        );
        let large = volumes(&mesh, Vec3::new(1.4, 1.5, 1.6), 2.0);
        assert!((large[13] - 1.0).abs() < 1e-14, "{}", large[13]);
    }

    #[test]
    fn a_ball_at_an_edge_agrees_with_an_integral_over_columns() {
        let mesh = moved(|_| Vec3::zeros());
        let (centre, radius) = (Vec3::new(0.87, 1.13, 1.55), 0.83);
        let volumes = volumes(&mesh, centre, radius);
        // Cell (1, 1, 1): midpoint rule over x and y, exact lengths along z.
        let n = 1000;
        let mut integral = 0.0;
        for i in 0..n {
            for j in 0..n {
                let x = 1.0 + (i as f64 + 0.5) / n as f64 - centre.x;
                let y = 1.0 + (j as f64 + 0.5) / n as f64 - centre.y;
                let half = (radius * radius - x * x - y * y).max(0.0).sqrt();
                let (low, high) = ((centre.z - half).max(1.0), (centre.z + half).min(2.0));
                integral += (high - low).max(0.0) / (n * n) as f64;
            }
        }
        assert!(
            (volumes[13] - integral).abs() < 1e-6,
            "{} against {integral}",
            volumes[13]
        );
    }

    #[test]
    fn the_parts_of_a_ball_in_a_warped_mesh_sum_to_the_ball() {
        let mesh = warped();
        for (centre, radius) in [
            (Vec3::new(1.5, 1.4, 1.6), 1.2),
            (Vec3::new(1.1, 1.1, 1.0), 0.6),
            (mesh.topology().points[21], 0.5),
            (mesh.face_centre()[7], 0.3),
        ] {
            let total: f64 = volumes(&mesh, centre, radius).iter().sum();
            assert!((total / ball(radius) - 1.0).abs() < 1e-14, "{total}");
        }
    }

    #[test]
    fn the_parts_of_a_ball_in_a_warped_mesh_agree_with_counted_points() {
        let mesh = warped();
        let locator = Locator::new(&mesh);
        let (centre, radius) = (Vec3::new(1.45, 1.2, 1.7), 1.0);
        let exact = volumes(&mesh, centre, radius);
        let n = 60;
        let mut counted = vec![0.0; mesh.cells()];
        let step = 2.0 * radius / f64::from(n);
        for index in 0..n * n * n {
            let at = |i: i32| (f64::from(i) + 0.5) * step - radius;
            let from = Vec3::new(at(index % n), at(index / n % n), at(index / n / n));
            if from.norm() < radius {
                let cell = locator.cell_at(centre + from).unwrap();
                counted[cell] += step.powi(3);
            }
        }
        // 113,000 points in the ball; a grid counts a volume to about its surface / n^1.5.
        for (cell, (exact, counted)) in exact.iter().zip(&counted).enumerate() {
            assert!(
                (exact - counted).abs() < 3e-3,
                "{cell}: {exact} against {counted}"
            );
        }
    }
}
