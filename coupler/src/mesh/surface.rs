//! Boundary faces as triangles, for walls that particles meet.

use calcine_physics::Vec3;

use super::{Mesh, Patch};

/// Distance from a face's plane, over the face's width, up to which the face is plane: round-off of written points.
const PLANE: f64 = 1e-6;
/// Area of a triangle, over the square of its longest edge, below which it has none.
const FLAT: f64 = 1e-9;

/// Triangles (corners in m) that cover the faces of a patch: plane convex quadrilaterals by two, other polygons by a fan about
/// their centres, which is how the gas measures their areas.
pub fn triangles(mesh: &Mesh, patch: &Patch) -> Vec<[Vec3; 3]> {
    let points = &mesh.topology().points;
    let mut all = Vec::new();
    for face in patch.faces() {
        let corners: Vec<Vec3> = mesh
            .face_points(face)
            .iter()
            .map(|&at| points[at as usize])
            .collect();
        match corners[..] {
            [a, b, c] => all.push([a, b, c]),
            [a, b, c, d] if is_plane_and_convex([a, b, c, d]) => {
                all.extend([[a, b, c], [a, c, d]]);
            }
            _ => {
                let centre = mesh.face_centre()[face];
                let edges = corners.iter().zip(corners.iter().cycle().skip(1));
                all.extend(edges.map(|(&from, &to)| [centre, from, to]));
            }
        }
    }
    all.retain(has_area);
    all
}

fn is_plane_and_convex([a, b, c, d]: [Vec3; 4]) -> bool {
    let (first, second) = ((b - a).cross(&(c - a)), (c - a).cross(&(d - a)));
    let (other, last) = ((b - a).cross(&(d - a)), (c - b).cross(&(d - b)));
    let width = (c - a).norm().max((d - b).norm());
    let convex = first.dot(&second) > 0.0 && other.dot(&last) > 0.0;
    convex && (d - a).dot(&first).abs() <= PLANE * width * first.norm()
}

fn has_area(corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() > FLAT * longest * longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cylinder::{CylinderSpec, cylinder_mesh};
    use crate::mesh::grading::uniform;

    /// By the divergence theorem the triangles of all patches enclose the cells' volume.
    #[test]
    fn triangles_of_all_patches_enclose_the_mesh() {
        let mesh = cylinder_mesh(&CylinderSpec {
            origin: Vec3::new(0.1, 0.2, 0.3),
            diameter: 0.05,
            length: 0.2,
            cells_across: 7,
            along: uniform(4),
            patches: ["side", "bottom", "top"].map(String::from),
        })
        .unwrap();
        let all: Vec<[Vec3; 3]> = mesh
            .patches()
            .iter()
            .flat_map(|patch| triangles(&mesh, patch))
            .collect();
        let volume: f64 = all.iter().map(|[a, b, c]| a.dot(&b.cross(c)) / 6.0).sum();
        let cells: f64 = mesh.cell_volume().iter().sum();
        assert!((volume / cells - 1.0).abs() < 1e-12, "{volume} of {cells}");
    }

    #[test]
    fn quadrilaterals_that_are_not_plane_or_not_convex_are_known() {
        let square = |height: f64, inward: f64| {
            [
                Vec3::zeros(),
                Vec3::new(1.0, 0.0, 0.0),
                Vec3::new(1.0 - inward, 1.0 - inward, height),
                Vec3::new(0.0, 1.0, 0.0),
            ]
        };
        assert!(is_plane_and_convex(square(0.0, 0.0)));
        assert!(!is_plane_and_convex(square(0.01, 0.0)));
        assert!(!is_plane_and_convex(square(0.0, 0.7)));
    }
}
