//! Openings in the sides of a mesh, such as burners and nozzles: boundary faces in a zone become a patch of
//! their own.

use super::zone::Zone;
use super::{Mesh, MeshError, Patch, Topology};

/// A part of the boundary with a name of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Name of the patch; openings of one name make one patch.
    pub name: String,
    /// Boundary faces whose centres lie here belong to it.
    pub zone: Zone,
}

/// Makes patches of the openings, after all others; cells and internal faces keep their numbers. A face
/// in several openings belongs to the first.
pub fn open(mesh: &Mesh, openings: &[Opening]) -> Result<Mesh, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    let base = mesh.topology();
    let centres = mesh.face_centre();
    let mut names: Vec<&str> = Vec::new();
    for (index, opening) in openings.iter().enumerate() {
        let name = opening.name.as_str();
        if mesh.patch(name).is_some() {
            return wrong(format!(
                "the opening {index} is called {name}, as a side of the mesh is; name it otherwise"
            ));
        }
        let boundary = mesh.internal_faces()..mesh.faces();
        if !boundary
            .clone()
            .any(|face| opening.zone.holds(centres[face]))
        {
            return wrong(format!(
                "the opening {index}, {name}, holds no centre of a face of the boundary; enlarge it, move it, or \
                 refine the cells about it"
            ));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let own = |face: usize| {
        let found = openings.iter().find(|one| one.zone.holds(centres[face]));
        found.map(|one| one.name.as_str())
    };
    let boundary = || mesh.internal_faces()..mesh.faces();
    if let Some(name) = names
        .iter()
        .find(|name| !boundary().any(|face| own(face) == Some(**name)))
    {
        return wrong(format!(
            "the opening {name} has no face of its own: all that it holds lie in openings before it; move one of them"
        ));
    }
    let mut order: Vec<usize> = (0..mesh.internal_faces()).collect();
    let mut patches: Vec<Patch> = Vec::new();
    let mut add = |name: &str, faces: &mut dyn Iterator<Item = usize>| {
        let start = order.len();
        order.extend(faces);
        patches.push(Patch {
            name: name.into(),
            start,
            count: order.len() - start,
        });
    };
    for patch in &base.patches {
        add(
            &patch.name,
            &mut patch.faces().filter(|&face| own(face).is_none()),
        );
    }
    for name in names {
        let boundary = mesh.internal_faces()..mesh.faces();
        add(name, &mut boundary.filter(|&face| own(face) == Some(name)));
    }
    Mesh::new(reordered(base, &order, patches))
}

/// The same points and cells with faces in another order; internal ones must keep theirs.
fn reordered(base: &Topology, order: &[usize], patches: Vec<Patch>) -> Topology {
    let mut made = Topology {
        points: base.points.clone(),
        face_offsets: vec![0],
        owner: order.iter().map(|&face| base.owner[face]).collect(),
        neighbour: base.neighbour.clone(),
        patches,
        ..Topology::default()
    };
    for &face in order {
        let range = base.face_offsets[face] as usize..base.face_offsets[face + 1] as usize;
        made.face_points.extend_from_slice(&base.face_points[range]);
        made.face_offsets.push(made.face_points.len() as u32);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::block::{BoxSpec, box_mesh};
    use crate::mesh::refine::{Refinement, refine};
    use calcine_physics::Vec3;

    fn duct() -> Mesh {
        box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.12, 0.12, 0.4),
            cells: [6, 6, 20],
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        })
        .unwrap()
    }

    fn zone(x: [f64; 2], z: f64) -> Zone {
        Zone::Box {
            low: Vec3::new(x[0], 0.055, z - 0.005),
            high: Vec3::new(x[1], 0.065, z + 0.005),
        }
    }

    fn burner(x: [f64; 2]) -> Opening {
        Opening {
            name: "burners".into(),
            zone: zone(x, 0.2),
        }
    }

    #[test]
    fn two_openings_of_one_name_in_refined_cells_make_one_patch_of_their_area() {
        let base = duct();
        let around = |x: [f64; 2]| Refinement {
            zone: Zone::Box {
                low: Vec3::new(x[0], 0.04, 0.18),
                high: Vec3::new(x[1], 0.08, 0.22),
            },
            levels: 2,
        };
        let fine = refine(&base, &[around([0.0, 0.02]), around([0.1, 0.12])]).unwrap();
        let made = open(&fine, &[burner([-0.001, 0.001]), burner([0.119, 0.121])]).unwrap();
        let names: Vec<&str> = made.patches().iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["side", "bottom", "top", "burners"]);
        let area = |mesh: &Mesh, name: &str| -> f64 {
            let faces = mesh.patch(name).unwrap().faces();
            faces.map(|face| mesh.face_area()[face].norm()).sum()
        };
        // Four faces of 5 mm in each.
        assert_eq!(made.patch("burners").unwrap().count, 8);
        assert!((area(&made, "burners") - 2e-4).abs() < 1e-12);
        let sides = area(&made, "side") + area(&made, "burners");
        assert!((sides - area(&fine, "side")).abs() < 1e-12);
        assert_eq!(made.cell_centre(), fine.cell_centre());
        assert_eq!(made.neighbour(), fine.neighbour());
    }

    #[test]
    fn an_opening_that_others_cover_is_refused() {
        let lying = |name: &str, high: f64| Opening {
            name: name.into(),
            zone: Zone::Box {
                low: Vec3::new(-0.001, 0.04, 0.18),
                high: Vec3::new(0.001, 0.06, high),
            },
        };
        let (wide, covered) = (lying("slot", 0.26), lying("lance", 0.22));
        let error = open(&duct(), &[wide, covered]).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("the opening lance has no face of its own"),
            "{error}"
        );
    }

    #[test]
    fn an_opening_that_holds_nothing_or_has_the_name_of_a_side_is_refused() {
        let nowhere = open(&duct(), &[burner([0.05, 0.06])]).unwrap_err();
        assert!(nowhere.to_string().contains("holds no centre"), "{nowhere}");
        let mut side = burner([-0.001, 0.001]);
        side.name = "side".into();
        assert!(open(&duct(), &[side]).is_err());
    }
}
