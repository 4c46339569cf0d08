//! Meshes of plane and axisymmetric flows: one cell between two sides, through which nothing passes.

use calcine_physics::Vec3;
use thiserror::Error;

use super::Mesh;
use super::periodic::axis_name;

/// Sine of the angle by which a face may lean against its plane.
const LEAN: f64 = 1e-6;
/// Largest angle in degrees between the sides of a wedge: beyond, a plane across is no arc.
const WIDEST: f64 = 15.0;

/// Sides that are not those of a plane or axisymmetric flow.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FlatError {
    /// A face of an empty patch that is not normal to a coordinate axis.
    #[error("face {face} of the empty patch `{patch}` at ({}, {}, {}) m is not normal to a coordinate axis", at.x, at.y, at.z)]
    Leans {
        /// The patch.
        patch: String,
        /// The face.
        face: usize,
        /// Its centre in m.
        at: Vec3,
    },
    /// A cell that does not reach from one side to the other.
    #[error(
        "cell {cell} at ({}, {}, {}) m has {faces} faces on the {kind} patches: a cell must reach from one side to the other, one cell across",
        at.x, at.y, at.z
    )]
    Across {
        /// The cell.
        cell: usize,
        /// Its centre in m.
        at: Vec3,
        /// Its faces on the sides.
        faces: usize,
        /// `empty` or `wedge`.
        kind: &'static str,
    },
    /// Other than two wedges.
    #[error("{count} patches are wedges: an axisymmetric flow has two")]
    Sides {
        /// How many there are.
        count: usize,
    },
    /// Two sides that do not form a wedge.
    #[error("the wedge patches `{patch}` and `{other}` {fault}")]
    NoWedge {
        /// The patch.
        patch: String,
        /// The other patch.
        other: String,
        /// What is wrong.
        fault: String,
    },
}

/// The slice that two wedges cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgeSlice {
    /// Index of the coordinate axis about which the flow is symmetric.
    pub axis: usize,
    /// Angle between the sides in degrees.
    pub angle: f64,
}

impl Mesh {
    /// The axis along which nothing flows between the empty patches; `None` where there are none.
    pub fn empty_axis(&self, patches: &[String]) -> Result<Option<usize>, FlatError> {
        let mut found = None;
        for name in patches {
            let Some(patch) = self.patch(name) else {
                continue;
            };
            for face in patch.faces() {
                let area = self.face_area[face];
                let axis = *found.get_or_insert(area.iamax());
                let mut across = area;
                across[axis] = 0.0;
                if across.norm() > LEAN * area.norm() {
                    return Err(FlatError::Leans {
                        patch: name.clone(),
                        face,
                        at: self.face_centre[face],
                    });
                }
            }
        }
        if found.is_some() {
            self.check_across(patches, "empty")?;
        }
        Ok(found)
    }

    /// The slice between two wedge patches; `None` where there are none.
    pub fn wedge_slice(&self, patches: &[String]) -> Result<Option<WedgeSlice>, FlatError> {
        let [patch, other] = match patches {
            [] => return Ok(None),
            [patch, other] => [patch, other],
            _ => {
                let count = patches.len();
                return Err(FlatError::Sides { count });
            }
        };
        let wrong = |fault: String| FlatError::NoWedge {
            patch: patch.clone(),
            other: other.clone(),
            fault,
        };
        let mut normals = [Vec3::zeros(); 2];
        for (name, normal) in [patch, other].into_iter().zip(&mut normals) {
            let faces = self.patch(name).into_iter().flat_map(super::Patch::faces);
            let sum: Vec3 = faces.clone().map(|face| self.face_area[face]).sum();
            *normal = sum.normalize();
            let leans = |face: &usize| {
                self.face_area[*face].cross(normal).norm() > LEAN * self.face_area[*face].norm()
            };
            if let Some(face) = faces.clone().find(leans) {
                let at = self.face_centre[face];
                return Err(wrong(format!(
                    "are not flat: face {face} of `{name}` at ({}, {}, {}) m leans against the others",
                    at.x, at.y, at.z
                )));
            }
        }
        let line = normals[0].cross(&normals[1]);
        // The normals of two sides that enclose the angle α make one of 180° − α.
        let angle = line.norm().atan2(-normals[0].dot(&normals[1])).to_degrees();
        if angle < 1e-3 {
            return Err(wrong(
                "are parallel: a slice between two parallel planes is `empty`".to_owned(),
            ));
        }
        if angle > WIDEST {
            return Err(wrong(format!(
                "enclose {angle:.3} degrees, more than {WIDEST}: mesh a thinner slice, 5 degrees for example"
            )));
        }
        let line = line.normalize();
        let axis = line.iamax();
        let middle = (normals[0] - normals[1]).normalize();
        if line[axis].abs() < 1.0 - LEAN || middle[middle.iamax()].abs() < 1.0 - LEAN {
            return Err(wrong(format!(
                "do not lie symmetrically about a coordinate plane: they meet along ({:.4}, {:.4}, {:.4}), and their middle plane has the \
                 normal ({:.4}, {:.4}, {:.4}); turn the mesh",
                line.x, line.y, line.z, middle.x, middle.y, middle.z
            )));
        }
        // Both planes pass through the axis of coordinates, as OpenFOAM has it.
        let reach = self.bounds().map(|corner| corner.norm());
        let reach = reach[0].max(reach[1]);
        for (name, normal) in [patch, other].into_iter().zip(&normals) {
            let face = self.patch(name).map_or(0, |patch| patch.start);
            let mut at = self.face_centre[face];
            at[axis] = 0.0;
            let off = at.dot(normal).abs();
            if off > LEAN * reach {
                return Err(wrong(format!(
                    "do not meet in the {} axis: the plane of `{name}` passes it at {off} m",
                    axis_name(axis)
                )));
            }
        }
        self.check_across(patches, "wedge")?;
        Ok(Some(WedgeSlice { axis, angle }))
    }

    /// Each cell has one face on either side.
    fn check_across(&self, patches: &[String], kind: &'static str) -> Result<(), FlatError> {
        let mut sides = vec![(0usize, Vec3::zeros()); self.cells];
        for patch in patches.iter().filter_map(|name| self.patch(name)) {
            for face in patch.faces() {
                let (faces, sum) = &mut sides[self.topology.owner[face] as usize];
                *faces += 1;
                *sum += self.face_area[face].normalize();
            }
        }
        // The normals of two sides that face each other cancel, but for the angle of a wedge.
        let apart = |(faces, sum): &(usize, Vec3)| *faces != 2 || sum.norm() > 0.5;
        match sides.iter().position(apart) {
            None => Ok(()),
            Some(cell) => Err(FlatError::Across {
                cell,
                at: self.cell_centre[cell],
                faces: sides[cell].0,
                kind,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::wedge::pipe_slice;
    use crate::mesh::block::{BoxSpec, box_mesh};

    fn block(cells: [usize; 3]) -> Mesh {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.04, 0.03, 0.01),
            cells,
            patches: ["a", "b", "c", "d", "front", "back"].map(str::to_owned),
        };
        box_mesh(&spec).unwrap()
    }

    fn names<const N: usize>(names: [&str; N]) -> [String; N] {
        names.map(str::to_owned)
    }

    #[test]
    fn a_plane_of_cells_is_empty_along_its_normal_and_two_layers_are_refused() {
        let sides = names(["front", "back"]);
        assert_eq!(block([4, 3, 1]).empty_axis(&sides).unwrap(), Some(2));
        assert_eq!(block([4, 3, 1]).empty_axis(&[]).unwrap(), None);
        let two = block([4, 3, 2]).empty_axis(&sides).unwrap_err();
        assert!(
            two.to_string().contains("has 1 faces on the empty patches"),
            "{two}"
        );
        let bent = block([4, 3, 1])
            .empty_axis(&names(["front", "a"]))
            .unwrap_err();
        assert!(matches!(bent, FlatError::Leans { .. }), "{bent}");
    }

    #[test]
    fn a_slice_of_a_pipe_is_a_wedge_and_other_pairs_are_told_why_not() {
        let mesh = pipe_slice(0.01, 0.02, [4, 3], 5.0).unwrap();
        let found = mesh
            .wedge_slice(&names(["front", "back"]))
            .unwrap()
            .unwrap();
        assert_eq!(found.axis, 2);
        assert!((found.angle - 5.0).abs() < 1e-9, "{found:?}");
        let parallel = block([4, 3, 1])
            .wedge_slice(&names(["front", "back"]))
            .unwrap_err();
        assert!(parallel.to_string().contains("are parallel"), "{parallel}");
        let wide = pipe_slice(0.01, 0.02, [4, 3], 30.0).unwrap();
        let wide = wide.wedge_slice(&names(["front", "back"])).unwrap_err();
        assert!(
            wide.to_string().contains("enclose 30.000 degrees"),
            "{wide}"
        );
        let mut turned = mesh.topology().clone();
        for point in &mut turned.points {
            *point = Vec3::new(
                0.8 * point.x - 0.6 * point.y,
                0.6 * point.x + 0.8 * point.y,
                point.z,
            );
        }
        let turned = Mesh::new(turned).unwrap();
        let turned = turned.wedge_slice(&names(["front", "back"])).unwrap_err();
        assert!(turned.to_string().contains("turn the mesh"), "{turned}");
        let one = mesh.wedge_slice(&names(["front"])).unwrap_err();
        assert_eq!(one, FlatError::Sides { count: 1 });
    }
}
