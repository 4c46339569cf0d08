//! Exact overlap of a sphere and a polyhedron.

use std::ops::{Deref, Range};

use calcine_physics::{Vec3, sphere};

use super::disc::{Plane, Point};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;

/// Volumes that a sphere shares with the cells of a mesh.
///
/// The cell is the signed sum of the cones from the sphere's centre to its faces. At the height h
/// over a plane face F, with the disc D of radius ρ = √(R² − h²) that the sphere cuts from the plane,
/// cone ∩ sphere = h/3 · area(F ∩ D) + R³/3 · Ω(F ∖ D), Ω the solid angle. Both are sums over the
/// edges of F of what the triangle (foot of the centre, edge) has. Faces that are not plane are
/// taken as triangles around the mean of their points, as for cell volumes.
///
/// The solid angles of all faces of a convex cell sum to 4π where the centre lies inside and to none outside, so
/// that there only the faces count that the sphere cuts, each by h/3 · area(F ∩ D) − R³/3 · Ω(F ∩ D), once for both
/// of its cells.
#[derive(Clone, Debug)]
pub(super) struct Overlap {
    faces: Vec<Face>,
    /// Corners of all plane faces, each in its face's axes from its centre.
    corners: Vec<Point>,
    /// Largest distance in m of each cell's points from its centre.
    reach: Vec<f64>,
    /// Cells of plane faces, behind each of which all their points lie.
    convex: Vec<bool>,
}

/// What a plane face is to spheres, in one piece of memory.
#[derive(Clone, Debug)]
pub(super) struct Face {
    centre: Vec3,
    /// Unit normal, out of the owner, and two axes of the plane.
    axes: Axes,
    /// Largest distance in m of its points from its centre.
    reach: f64,
    /// Its corners among all; none of a face that is not plane.
    corners: Range<u32>,
}

/// A plane's unit normal and two axes in it, right-handed.
#[derive(Clone, Copy, Debug)]
struct Axes {
    normal: Vec3,
    along: [Vec3; 2],
}

impl Axes {
    fn of(normal: Vec3) -> Self {
        // Across the axis that the normal has least of.
        let first = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
        Self {
            normal,
            along: [first, normal.cross(&first)],
        }
    }

    fn in_plane(&self, place: Vec3) -> Point {
        Point::new(self.along[0].dot(&place), self.along[1].dot(&place))
    }
}

/// How a cell's share of a sphere is found.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// All of the cell lies in the sphere.
    Whole,
    /// By the faces that the sphere cuts, and the sphere's centre inside the cell or not.
    Cut { inside: bool },
    /// By the cones over all faces.
    Cones,
}

/// Memory that one sphere leaves to the next.
#[derive(Default)]
pub(super) struct Scratch {
    ways: Vec<Way>,
    volumes: Vec<f64>,
}

/// Below this height of the centre over a face, as a share of the radius, cones are used: next to a corner the
/// solid angle in the disc is known to round-off of the coordinates over this height.
pub(super) const GRAZING: f64 = 1e-3;

impl Overlap {
    pub fn new<M: Deref<Target = Mesh>>(locator: &Locator<M>) -> Self {
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
            let outwards = mesh.side(cell, face) * normal;
            corners(cell).all(|p| outwards.dot(&(p - centre)) <= 1e-9 * (p - centre).norm())
        };
        let convex = |cell: usize| {
            let faces = mesh.faces_of(cell).iter().map(|&face| face as usize);
            faces
                .into_iter()
                .all(|face| locator.warp(face) == 0.0 && behind(cell, face))
        };
        let mut all = Vec::new();
        let mut face = |face: usize| {
            let (centre, axes) = (mesh.face_centre()[face], Axes::of(locator.normal(face)));
            let first = all.len() as u32;
            if locator.warp(face) == 0.0 {
                all.extend(points(face).map(|p| axes.in_plane(p - centre)));
            }
            Face {
                centre,
                axes,
                reach: farthest(centre, &mut points(face)),
                corners: first..all.len() as u32,
            }
        };
        Self {
            faces: (0..mesh.faces()).map(&mut face).collect(),
            corners: all,
            reach: (0..mesh.cells())
                .map(|cell| farthest(mesh.cell_centre()[cell], &mut corners(cell)))
                .collect(),
            convex: (0..mesh.cells()).map(convex).collect(),
        }
    }

    /// Volumes in m³ that the sphere shares with cells, which ascend, to round-off of the sphere's own volume.
    pub fn volumes<'s>(
        &self,
        mesh: &Mesh,
        cells: &[u32],
        centre: Vec3,
        radius: f64,
        scratch: &'s mut Scratch,
    ) -> &'s [f64] {
        let Scratch { ways, volumes } = scratch;
        let way = |&cell: &u32| self.way(mesh, cell as usize, centre, radius);
        ways.clear();
        ways.extend(cells.iter().map(way));
        volumes.clear();
        volumes.resize(cells.len(), 0.0);
        for (place, &cell) in cells.iter().enumerate() {
            let cell = cell as usize;
            let faces = mesh.faces_of(cell).iter().map(|&face| face as usize);
            match ways[place] {
                Way::Whole => volumes[place] = mesh.cell_volume()[cell],
                Way::Cones => {
                    let cone = |face| mesh.side(cell, face) * self.cone(mesh, face, centre, radius);
                    volumes[place] = faces.map(cone).sum();
                }
                Way::Cut { inside } => {
                    if inside {
                        volumes[place] += sphere::volume(radius);
                    }
                    for index in faces {
                        let face = &self.faces[index];
                        let plane = face.plane(centre, radius);
                        if plane.disc() <= 0.0 {
                            continue;
                        }
                        let other = mesh.across(cell, index).and_then(|other| {
                            let place = cells.binary_search(&(other as u32)).ok()?;
                            matches!(ways[place], Way::Cut { .. }).then_some(place)
                        });
                        // The first of its two cells finds what it takes for both.
                        if other.is_some_and(|other| other < place) {
                            continue;
                        }
                        let within =
                            mesh.side(cell, index) * self.plane_within(face, centre, &plane);
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

    fn way(&self, mesh: &Mesh, cell: usize, centre: Vec3, radius: f64) -> Way {
        if !self.convex[cell] {
            return Way::Cones;
        }
        if self.holds_all(cell, (mesh.cell_centre()[cell] - centre).norm(), radius) {
            return Way::Whole;
        }
        let mut inside = true;
        for &index in mesh.faces_of(cell) {
            let height = self.faces[index as usize].height(centre);
            if height.abs() < GRAZING * radius {
                return Way::Cones;
            }
            inside &= mesh.side(cell, index as usize) * height > 0.0;
        }
        Way::Cut { inside }
    }

    /// What a plane face takes of the sphere: h/3 · area(F ∩ D) − sign(h) R³/3 · Ω(F ∩ D).
    fn plane_within(&self, face: &Face, centre: Vec3, plane: &Plane) -> f64 {
        let foot = face.foot(centre);
        let span = plane.disc().sqrt() + face.reach;
        if foot.norm_squared() >= span * span {
            return 0.0;
        }
        plane.inside(self.corners_of(face), foot)
    }

    /// The same for a plane at some height over the centre.
    pub fn within(&self, face: &Face, centre: Vec3, height: f64, radius: f64) -> f64 {
        self.plane_within(face, centre, &Plane::new(height, radius))
    }

    /// Whether all faces of a cell are plane and all its points lie behind each.
    pub fn is_convex(&self, cell: usize) -> bool {
        self.convex[cell]
    }

    /// Whether a sphere holds all of a cell, with its centre at some distance in m from the cell's.
    pub fn holds_all(&self, cell: usize, distance: f64, radius: f64) -> bool {
        distance + self.reach[cell] <= radius
    }

    pub fn face(&self, index: u32) -> &Face {
        &self.faces[index as usize]
    }

    /// Corners of a plane face in its axes from its centre, counter-clockwise about the normal.
    pub fn corners_of(&self, face: &Face) -> &[Point] {
        &self.corners[face.corners.start as usize..face.corners.end as usize]
    }

    /// Signed volume of sphere ∩ cone over one face, positive where the face's normal points away.
    fn cone(&self, mesh: &Mesh, index: usize, centre: Vec3, radius: f64) -> f64 {
        let face = &self.faces[index];
        let corners = self.corners_of(face);
        if !corners.is_empty() {
            let foot = face.foot(centre);
            let plane = face.plane(centre, radius);
            return plane.cone(corners, foot);
        }
        let points = mesh.face_points(index);
        let count = points.len();
        let at = |i: usize| mesh.topology().points[points[i % count] as usize] - centre;
        let middle = (0..count).map(at).sum::<Vec3>() / count as f64;
        let triangle = |i: usize| {
            let corners = [middle, at(i), at(i + 1)];
            let area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            if area.norm() == 0.0 {
                return 0.0;
            }
            let axes = Axes::of(area.normalize());
            let plane = Plane::new(axes.normal.dot(&middle), radius);
            let corners = corners.map(|corner| axes.in_plane(corner));
            plane.cone(&corners, Point::zeros())
        };
        (0..count).map(triangle).sum()
    }
}

impl Face {
    /// The foot of a place in the face's axes from its centre.
    pub fn foot(&self, place: Vec3) -> Point {
        self.axes.in_plane(place - self.centre)
    }

    /// Signed height in m of the face's plane over a place.
    fn height(&self, place: Vec3) -> f64 {
        self.axes.normal.dot(&(self.centre - place))
    }

    fn plane(&self, centre: Vec3, radius: f64) -> Plane {
        Plane::new(self.height(centre), radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;
    use crate::mesh::block::{BoxSpec, box_mesh};
    use std::f64::consts::PI;

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
        let overlap = Overlap::new(&locator);
        let mut scratch = Scratch::default();
        overlap
            .volumes(mesh, &cells, centre, radius, &mut scratch)
            .to_vec()
    }

    fn sphere(radius: f64) -> f64 {
        4.0 / 3.0 * PI * radius.powi(3)
    }

    #[test]
    fn a_ball_over_a_face_is_cut_into_a_cap_and_the_rest() {
        let mesh = moved(|_| Vec3::zeros());
        let volumes = volumes(&mesh, Vec3::new(1.4, 1.5, 0.9), 0.3);
        // Cap of height 0.2: pi h^2 (3 R - h)/3.
        let cap = PI * 0.2 * 0.2 * (0.9 - 0.2) / 3.0;
        assert!((volumes[4] - (sphere(0.3) - cap)).abs() < 1e-15);
        assert!((volumes[13] - cap).abs() < 1e-15);
    }

    #[test]
    fn a_ball_at_a_corner_has_an_octant_in_each_cell() {
        let mesh = moved(|_| Vec3::zeros());
        let volumes = volumes(&mesh, Vec3::new(1.0, 1.0, 1.0), 0.7);
        for cell in [0, 1, 3, 4, 9, 10, 12, 13] {
            assert!((volumes[cell] - sphere(0.7) / 8.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_ball_within_a_cell_is_all_there_and_a_cell_within_a_ball_too() {
        let mesh = moved(|_| Vec3::zeros());
        let small = volumes(&mesh, Vec3::new(1.3, 1.6, 1.4), 0.2);
        assert!((small[13] - sphere(0.2)).abs() < 1e-16);
        // Over the far cells the cones cancel to round-off of the sphere.
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
            assert!((total / sphere(radius) - 1.0).abs() < 1e-14, "{total}");
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
        // 113,000 points in the sphere; a grid counts a volume to about its surface / n^1.5.
        for (cell, (exact, counted)) in exact.iter().zip(&counted).enumerate() {
            assert!(
                (exact - counted).abs() < 3e-3,
                "{cell}: {exact} against {counted}"
            );
        }
    }
}
