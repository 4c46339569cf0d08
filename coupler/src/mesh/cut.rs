//! Bodies cut out of a mesh, such as crucibles and baffles: cells in a zone are taken out, and the gas is left the faces that
//! bound them as a patch.

use super::zone::Zone;
use super::{Mesh, MeshError, Patch, Topology};

/// A body that is taken out of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Name of the patch of its surface; cuts of one name make one patch.
    pub name: String,
    /// Cells whose centres lie here are taken out,
    pub zone: Zone,
    /// but for those whose centres lie here: the inside of a cup.
    pub hollow: Option<Zone>,
}

impl Cut {
    fn holds(&self, mesh: &Mesh, cell: usize) -> bool {
        let centre = mesh.cell_centre()[cell];
        let hollow = self.hollow.is_some_and(|zone| zone.holds(centre));
        self.zone.holds(centre) && !hollow
    }
}

/// Takes bodies out of a mesh; their patches follow all others. Cells and faces that stay keep their order. A cell in several cuts belongs to the
/// first.
pub fn cut(mesh: &Mesh, cuts: &[Cut]) -> Result<Mesh, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    let mut names: Vec<&str> = Vec::new();
    for (index, cut) in cuts.iter().enumerate() {
        let name = cut.name.as_str();
        if mesh.patch(name).is_some() {
            return wrong(format!(
                "the cut {index} is called {name}, as a side of the mesh is; name it otherwise"
            ));
        }
        if !(0..mesh.cells()).any(|cell| cut.holds(mesh, cell)) {
            return wrong(format!(
                "the cut {index}, {name}, holds no centre of a cell; enlarge it, move it, or make the cells about it smaller"
            ));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let body = |cell: usize| {
        let first = cuts.iter().find(|cut| cut.holds(mesh, cell));
        first.and_then(|cut| names.iter().position(|name| *name == cut.name))
    };
    let bodies: Vec<Option<usize>> = (0..mesh.cells()).map(body).collect();
    let made = Mesh::new(without(mesh, &bodies, &names)?)?;
    let Some(apart) = made.pieces().into_iter().nth(1) else {
        return Ok(made);
    };
    let at = apart.centre;
    wrong(format!(
        "the cuts part the gas: that in the cell at ({:.4}, {:.4}, {:.4}) m has no way to the first cell; leave a way between \
         them, or cut this part out too",
        at.x, at.y, at.z
    ))
}

/// The mesh of the cells that belong to no body; bodies by the place of their names.
fn without(mesh: &Mesh, bodies: &[Option<usize>], names: &[&str]) -> Result<Topology, MeshError> {
    let base = mesh.topology();
    let mut number = vec![u32::MAX; bodies.len()];
    let mut kept = 0;
    for (cell, body) in bodies.iter().enumerate() {
        if body.is_none() {
            number[cell] = kept;
            kept += 1;
        }
    }
    if kept == 0 {
        return Err(MeshError::Inconsistent(
            "the cuts take out all cells; make them smaller".into(),
        ));
    }
    let mut made = Builder::new(base);
    let internal = mesh.internal_faces();
    let sides = |face: usize| [base.owner[face], base.neighbour[face]].map(|cell| cell as usize);
    for face in 0..internal {
        let [owner, neighbour] = sides(face);
        if let (None, None) = (bodies[owner], bodies[neighbour]) {
            made.add(face, false, number[owner]);
            made.topology.neighbour.push(number[neighbour]);
        }
    }
    for patch in &base.patches {
        let start = made.faces();
        for face in patch.faces() {
            let owner = base.owner[face] as usize;
            if bodies[owner].is_none() {
                made.add(face, false, number[owner]);
            }
        }
        if made.faces() == start && patch.count > 0 {
            return Err(MeshError::Inconsistent(format!(
                "the cuts take out all cells at the patch {}; make them smaller",
                patch.name
            )));
        }
        made.end_patch(&patch.name, start);
    }
    for (place, name) in names.iter().enumerate() {
        let start = made.faces();
        for face in 0..internal {
            let [owner, neighbour] = sides(face);
            match (bodies[owner], bodies[neighbour]) {
                (None, Some(body)) if body == place => made.add(face, false, number[owner]),
                (Some(body), None) if body == place => made.add(face, true, number[neighbour]),
                _ => {}
            }
        }
        if made.faces() == start {
            return Err(MeshError::Inconsistent(format!(
                "the cut {name} has no surface of its own: cuts before it hold its cells, or it touches no gas; move one of them"
            )));
        }
        made.end_patch(name, start);
    }
    Ok(made.finish())
}

/// A topology of some of the faces of another one.
struct Builder<'a> {
    base: &'a Topology,
    topology: Topology,
}

impl<'a> Builder<'a> {
    fn new(base: &'a Topology) -> Self {
        let topology = Topology {
            face_offsets: vec![0],
            ..Topology::default()
        };
        Self { base, topology }
    }

    fn faces(&self) -> usize {
        self.topology.owner.len()
    }

    /// Adds a face with an owner, turned over where that was its neighbour.
    fn add(&mut self, face: usize, turned: bool, owner: u32) {
        let points = super::points_of(self.base, face).iter().copied();
        let made = &mut self.topology;
        match turned {
            true => made.face_points.extend(points.rev()),
            false => made.face_points.extend(points),
        }
        made.face_offsets.push(made.face_points.len() as u32);
        made.owner.push(owner);
    }

    fn end_patch(&mut self, name: &str, start: usize) {
        self.topology.patches.push(Patch {
            name: name.into(),
            start,
            count: self.faces() - start,
        });
    }

    /// Leaves out points that no face has.
    fn finish(mut self) -> Topology {
        let made = &mut self.topology;
        let mut used = vec![false; self.base.points.len()];
        for &point in &made.face_points {
            used[point as usize] = true;
        }
        let mut number = vec![0; used.len()];
        for (point, _) in used.iter().enumerate().filter(|(_, used)| **used) {
            number[point] = made.points.len() as u32;
            made.points.push(self.base.points[point]);
        }
        for point in &mut made.face_points {
            *point = number[*point as usize];
        }
        self.topology
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::block::{BoxSpec, box_mesh};
    use crate::mesh::cylinder::{CylinderSpec, cylinder_mesh};
    use crate::mesh::grading::uniform;
    use calcine_physics::Vec3;

    fn duct() -> Mesh {
        box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(6.0, 6.0, 10.0),
            cells: [6, 6, 10],
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        })
        .unwrap()
    }

    fn zone(low: [f64; 3], high: [f64; 3]) -> Zone {
        Zone::Box {
            low: Vec3::from(low),
            high: Vec3::from(high),
        }
    }

    fn cup() -> Cut {
        Cut {
            name: "cup".into(),
            zone: zone([1.0, 1.0, 4.0], [5.0, 5.0, 7.0]),
            hollow: Some(zone([2.0, 2.0, 5.0], [4.0, 4.0, 8.0])),
        }
    }

    fn area(mesh: &Mesh, name: &str) -> f64 {
        let faces = mesh.patch(name).unwrap().faces();
        faces.map(|face| mesh.face_area()[face].norm()).sum()
    }

    #[test]
    fn a_cup_leaves_its_volume_out_and_has_its_surface_as_a_patch() {
        let (base, made) = (duct(), cut(&duct(), &[cup()]).unwrap());
        let volume = |mesh: &Mesh| mesh.cell_volume().iter().sum::<f64>();
        // 4 × 4 × 3 less the hollow of 2 × 2 × 2.
        assert!((volume(&base) - volume(&made) - 40.0).abs() < 1e-12);
        // Outside 4 × 4 × 3 without its lid's opening, inside four walls and a floor.
        let expected = 16.0 + 4.0 * 12.0 + (16.0 - 4.0) + 4.0 * 4.0 + 4.0;
        assert!((area(&made, "cup") - expected).abs() < 1e-12);
        let names: Vec<&str> = made.patches().iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["side", "bottom", "top", "cup"]);
        for side in ["side", "bottom", "top"] {
            assert_eq!(area(&made, side), area(&base, side));
        }
        // The surface closes: its area vectors add up to nothing.
        let faces = made.patch("cup").unwrap().faces();
        let sum: Vec3 = faces.map(|face| made.face_area()[face]).sum();
        assert!(sum.norm() < 1e-12);
        let order: Vec<[u32; 2]> = (0..made.internal_faces())
            .map(|face| [made.owner()[face], made.neighbour()[face]])
            .collect();
        assert!(order.is_sorted() && order.iter().all(|[one, other]| one < other));
    }

    #[test]
    fn a_cut_at_a_side_takes_its_faces_from_that_side() {
        let ledge = Cut {
            name: "ledge".into(),
            zone: zone([-1.0, -1.0, 3.0], [2.0, 7.0, 5.0]),
            hollow: None,
        };
        let made = cut(&duct(), &[ledge]).unwrap();
        assert!(
            (area(&duct(), "side") - area(&made, "side") - (6.0 + 2.0 * 2.0) * 2.0).abs() < 1e-12
        );
        assert!((area(&made, "ledge") - (6.0 * 2.0 + 2.0 * 12.0)).abs() < 1e-12);
    }

    #[test]
    fn a_cup_in_an_o_grid_is_as_round_as_its_cells() {
        let base = cylinder_mesh(&CylinderSpec {
            origin: Vec3::zeros(),
            diameter: 10.0,
            length: 20.0,
            cells_across: 12,
            along: uniform(40),
            patches: ["side", "bottom", "top"].map(String::from),
        })
        .unwrap();
        let round = |from: f64, to: f64, radius: f64| Zone::Cylinder {
            from: Vec3::new(0.0, 0.0, from),
            to: Vec3::new(0.0, 0.0, to),
            radius,
        };
        let cup = Cut {
            name: "cup".into(),
            zone: round(8.0, 11.5, 3.6),
            hollow: Some(round(8.5, 12.0, 2.9)),
        };
        let made = cut(&base, &[cup]).unwrap();
        // One layer of the ring, all about, and one of cells below.
        let [core, ring, high] = [36, 24, 7];
        assert_eq!(base.cells() - made.cells(), high * ring + core);
    }

    #[test]
    fn cuts_that_cannot_be_are_refused() {
        let refused = |cuts: &[Cut]| cut(&duct(), cuts).unwrap_err().to_string();
        let with = |name: &str, low: [f64; 3], high: [f64; 3]| Cut {
            name: name.into(),
            zone: zone(low, high),
            hollow: None,
        };
        let all = [[-1.0; 3], [11.0; 3]];
        let side = refused(&[with("side", [1.0; 3], [3.0; 3])]);
        assert!(side.contains("as a side of the mesh is"), "{side}");
        let nowhere = refused(&[with("pin", [1.6; 3], [1.9; 3])]);
        assert!(nowhere.contains("holds no centre of a cell"), "{nowhere}");
        let whole = refused(&[with("block", all[0], all[1])]);
        assert!(whole.contains("all cells"), "{whole}");
        let slab = refused(&[with("slab", [-1.0, -1.0, 3.0], [7.0, 7.0, 5.0])]);
        assert!(slab.contains("the cuts part the gas"), "{slab}");
        let lid = refused(&[with("lid", [-1.0, -1.0, 8.0], [7.0, 7.0, 11.0])]);
        assert!(lid.contains("at the patch top"), "{lid}");
        let covered = [
            with("one", [1.0; 3], [4.0; 3]),
            with("two", [2.0; 3], [3.0; 3]),
        ];
        let covered = refused(&covered);
        assert!(covered.contains("the cut two has no surface"), "{covered}");
    }
}
