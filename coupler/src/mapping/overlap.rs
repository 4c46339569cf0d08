//! Exact overlap of a ball and a polyhedron.

use std::f64::consts::PI;

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
///
/// The solid angles of all faces of a convex cell sum to 4π where the centre lies inside and to none outside, so
/// that there only the faces count that the ball cuts, each by h/3 · area(F ∩ D) − R³/3 · Ω(F ∩ D), once for both
/// of its cells.
#[derive(Clone, Debug)]
pub(super) struct Overlap {
    /// Largest distance in m of each face's points from its centre, and of each cell's from its own.
    face_reach: Vec<f64>,
    cell_reach: Vec<f64>,
    /// Cells of plane faces, behind each of which all their points lie.
    convex: Vec<bool>,
}

/// How a cell's share of a ball is found.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// All of the cell lies in the ball.
    Whole,
    /// By the faces that the ball cuts, and the ball's centre inside the cell or not.
    Cut { inside: bool },
    /// By the cones over all faces.
    Cones,
}

/// Below this height of the centre over a face, as a share of the radius, its side is not certain.
const GRAZING: f64 = 1e-10;

impl Overlap {
    pub fn new(locator: &Locator<'_>) -> Self {
        let mesh = locator.mesh();
        let points = |face: usize| {
            let indices = mesh.face_points(face).iter();
            indices.map(|&point| mesh.topology().points[point as usize])
        };
        let farthest = |from: Vec3, points: &mut dyn Iterator<Item = Vec3>| {
            points.map(|p| (p - from).norm()).fold(0.0, f64::max)
        };
        let corners = |cell: usize| {
            let faces = mesh.faces_of(cell).iter();
            faces.flat_map(|&face| points(face as usize))
        };
        // Points to the precision at which a face counts as plane.
        let behind = |cell: usize, face: usize| {
            let (normal, centre) = (locator.normal(face), mesh.face_centre()[face]);
            let outwards = locator.side(cell, face) * normal;
            corners(cell).all(|p| outwards.dot(&(p - centre)) <= 1e-9 * (p - centre).norm())
        };
        let convex = |cell: usize| {
            let faces = mesh.faces_of(cell).iter().map(|&face| face as usize);
            faces
                .into_iter()
                .all(|face| locator.warp(face) == 0.0 && behind(cell, face))
        };
        Self {
            face_reach: (0..mesh.faces())
                .map(|face| farthest(mesh.face_centre()[face], &mut points(face)))
                .collect(),
            cell_reach: (0..mesh.cells())
                .map(|cell| farthest(mesh.cell_centre()[cell], &mut corners(cell)))
                .collect(),
            convex: (0..mesh.cells()).map(convex).collect(),
        }
    }

    /// Volumes in m³ that the ball shares with cells, which ascend, to round-off of the ball's own volume.
    pub fn volumes(
        &self,
        locator: &Locator<'_>,
        cells: &[u32],
        centre: Vec3,
        radius: f64,
    ) -> Vec<f64> {
        let mesh = locator.mesh();
        let ways: Vec<Way> = cells
            .iter()
            .map(|&cell| self.way(locator, cell as usize, centre, radius))
            .collect();
        let mut volumes = vec![0.0; cells.len()];
        for (place, &cell) in cells.iter().enumerate() {
            let cell = cell as usize;
            let faces = mesh.faces_of(cell).iter().map(|&face| face as usize);
            match ways[place] {
                Way::Whole => volumes[place] = mesh.cell_volume()[cell],
                Way::Cones => {
                    let cone =
                        |face| locator.side(cell, face) * cone(locator, face, centre, radius);
                    volumes[place] = faces.map(cone).sum();
                }
                Way::Cut { inside } => {
                    if inside {
                        volumes[place] += 4.0 / 3.0 * PI * radius.powi(3);
                    }
                    for face in faces {
                        let plane = Plane::of(locator, face, centre, radius);
                        if plane.disc <= 0.0 {
                            continue;
                        }
                        let other = mesh.across(cell, face).and_then(|other| {
                            let place = cells.binary_search(&(other as u32)).ok()?;
                            matches!(ways[place], Way::Cut { .. }).then_some(place)
                        });
                        // The first of its two cells finds what it takes for both.
                        if other.is_some_and(|other| other < place) {
                            continue;
                        }
                        let within = self.within(mesh, face, centre, &plane);
                        let within = locator.side(cell, face) * within;
                        volumes[place] += within;
                        if let Some(other) = other {
                            volumes[other] -= within;
                        }
                    }
                }
            }
        }
        volumes
    }

    fn way(&self, locator: &Locator<'_>, cell: usize, centre: Vec3, radius: f64) -> Way {
        if !self.convex[cell] {
            return Way::Cones;
        }
        let mesh = locator.mesh();
        if (mesh.cell_centre()[cell] - centre).norm() + self.cell_reach[cell] <= radius {
            return Way::Whole;
        }
        let mut inside = true;
        for &face in mesh.faces_of(cell) {
            let face = face as usize;
            let away = mesh.face_centre()[face] - centre;
            let height = locator.side(cell, face) * locator.normal(face).dot(&away);
            if height.abs() < GRAZING * radius {
                return Way::Cones;
            }
            inside &= height > 0.0;
        }
        Way::Cut { inside }
    }

    /// What a plane face takes of the ball: h/3 · area(F ∩ D) − sign(h) R³/3 · Ω(F ∩ D).
    fn within(&self, mesh: &Mesh, face: usize, centre: Vec3, plane: &Plane) -> f64 {
        let away = mesh.face_centre()[face] - centre;
        let from_foot = away.norm_squared() - plane.height * plane.height;
        let span = plane.disc.max(0.0).sqrt() + self.face_reach[face];
        if plane.disc <= 0.0 || from_foot >= span * span {
            return 0.0;
        }
        let points = mesh.face_points(face);
        let at = |i: usize| mesh.topology().points[points[i % points.len()] as usize] - centre;
        let parts = (0..points.len()).map(|i| plane.edge(at(i), at(i + 1), Plane::inside));
        plane.cone(parts, -1.0)
    }
}

/// Signed volume of ball ∩ cone over one face, positive where the face's normal points away.
fn cone(locator: &Locator<'_>, face: usize, centre: Vec3, radius: f64) -> f64 {
    let mesh = locator.mesh();
    let points = mesh.face_points(face);
    let count = points.len();
    let at = |i: usize| mesh.topology().points[points[i % count] as usize] - centre;
    if locator.warp(face) == 0.0 {
        let plane = Plane::of(locator, face, centre, radius);
        let parts = (0..count).map(|i| plane.edge(at(i), at(i + 1), Plane::outside));
        return plane.cone(parts, 1.0);
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
        let edge = |k: usize| plane.edge(corners[k], corners[(k + 1) % 3], Plane::outside);
        plane.cone((0..3).map(edge), 1.0)
    };
    (0..count).map(triangle).sum()
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

/// What the triangle (foot, edge) has of the disc.
#[derive(Default)]
struct Part {
    /// Area in m² inside.
    area: f64,
    /// Solid angle, of what lies inside or outside.
    angle: f64,
}

/// A stretch of an edge: its ends in the plane from the foot, and whether it lies in the disc.
struct Stretch {
    ends: [Vec3; 2],
    in_disc: bool,
}

impl Plane {
    /// That of a plane face.
    fn of(locator: &Locator<'_>, face: usize, centre: Vec3, radius: f64) -> Self {
        let normal = locator.normal(face);
        let height = normal.dot(&(locator.mesh().face_centre()[face] - centre));
        Self::new(normal, height, radius)
    }

    fn new(normal: Vec3, height: f64, radius: f64) -> Self {
        Self {
            normal,
            height,
            radius,
            disc: (radius - height) * (radius + height),
        }
    }

    /// The volume of areas and solid angles, the latter counted with a sign.
    fn cone(&self, parts: impl Iterator<Item = Part>, sign: f64) -> f64 {
        let (mut area, mut angle) = (0.0, 0.0);
        for part in parts {
            area += part.area;
            angle += part.angle;
        }
        let angle = sign * self.height.signum() * angle;
        self.height * area / 3.0 + self.radius.powi(3) * angle / 3.0
    }

    /// The contribution of an edge from `a` to `b`, both relative to the ball's centre, stretch by stretch.
    fn edge(&self, a: Vec3, b: Vec3, of: impl Fn(&Self, Stretch) -> Part) -> Part {
        let in_plane = |p: Vec3| p - self.normal * self.normal.dot(&p);
        let (a, b) = (in_plane(a), in_plane(b));
        let along = b - a;
        let (square, slope) = (along.norm_squared(), a.dot(&along));
        let root = slope * slope - square * (a.norm_squared() - self.disc);
        let stretch = |p: Vec3, q: Vec3, in_disc: bool| {
            let ends = [p, q];
            of(self, Stretch { ends, in_disc })
        };
        if self.disc <= 0.0 || square == 0.0 || root <= 0.0 {
            return stretch(a, b, false);
        }
        let enter = ((-slope - root.sqrt()) / square).clamp(0.0, 1.0);
        let leave = ((-slope + root.sqrt()) / square).clamp(0.0, 1.0);
        let (p, q) = (a + along * enter, a + along * leave);
        let mut sum = stretch(p, q, true);
        // An edge that ends in the disc has no stretch beyond it.
        for (from, to) in [
            (enter > 0.0).then_some((a, p)),
            (leave < 1.0).then_some((q, b)),
        ]
        .into_iter()
        .flatten()
        {
            let part = stretch(from, to, false);
            sum.area += part.area;
            sum.angle += part.angle;
        }
        sum
    }

    /// p × q along the normal.
    fn turn(&self, p: Vec3, q: Vec3) -> f64 {
        self.normal.dot(&p.cross(&q))
    }

    /// Solid angle of the triangle (foot, p, q). Van Oosterom and Strackee, doi:10.1109/TBME.1983.325207, with
    /// one corner at the foot.
    fn triangle(&self, [p, q]: [Vec3; 2], turn: f64) -> f64 {
        let height = self.height.abs();
        let far = |p: Vec3| (height * height + p.norm_squared()).sqrt();
        let (far_p, far_q) = (far(p), far(q));
        let denominator = far_p * far_q + height * (far_p + far_q) + height * height + p.dot(&q);
        2.0 * turn.atan2(denominator)
    }

    /// Area and solid angle of the disc's sector before a stretch beyond it: ρ²/2 · θ and θ (1 − h/R).
    fn sector(&self, [p, q]: [Vec3; 2], turn: f64) -> Part {
        let angle = turn.atan2(p.dot(&q));
        Part {
            area: 0.5 * self.disc * angle,
            angle: angle * (1.0 - self.height.abs() / self.radius),
        }
    }

    /// What the triangle (foot, stretch) has inside the disc.
    fn inside(&self, stretch: Stretch) -> Part {
        let ends = stretch.ends;
        let turn = self.turn(ends[0], ends[1]);
        if turn == 0.0 {
            return Part::default();
        }
        if stretch.in_disc {
            return Part {
                area: 0.5 * turn,
                angle: self.triangle(ends, turn),
            };
        }
        self.sector(ends, turn)
    }

    /// The area inside the disc, and the solid angle outside it.
    fn outside(&self, stretch: Stretch) -> Part {
        let [p, q] = stretch.ends;
        let whole = self.triangle([p, q], self.turn(p, q));
        let inside = if self.disc > 0.0 {
            self.inside(stretch)
        } else {
            Part::default()
        };
        Part {
            area: inside.area,
            angle: whole - inside.angle,
        }
    }
}

#[cfg(test)]
mod tests {
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
        let locator = Locator::new(mesh);
        let cells: Vec<u32> = (0..mesh.cells() as u32).collect();
        Overlap::new(&locator).volumes(&locator, &cells, centre, radius)
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
