//! How far the cells of a mesh are from boxes, and how far gas passes through them in a step.

use calcine_physics::Vec3;

use super::{Mesh, Patch};

/// A value and the cell in which it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InCell {
    /// The value.
    pub value: f64,
    /// Index of the cell.
    pub cell: usize,
    /// The cell's centre in m.
    pub centre: Vec3,
}

/// Angles and skewness of faces, as OpenFOAM's `checkMesh` measures them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshQuality {
    /// Largest angle in degrees between a face's normal and the line between the centres of its cells (non-orthogonality);
    /// in the face's owner.
    pub angle: InCell,
    /// The angle in degrees whose cosine is the mean of these angles' cosines, over the internal faces.
    pub average_angle: f64,
    /// Largest distance from the centre of an internal face to where that line meets the face, over the face's own reach in that
    /// direction (at least a fifth of the line); in the face's owner.
    pub skewness: InCell,
    /// The same of the faces of the boundary, with the line from the cell's centre normal to the face (at least two fifths of it).
    pub boundary_skewness: InCell,
    /// Largest ratio of the distances from the centres of two neighbours to the plane of their face; in the thinner of them.
    pub thickness_ratio: InCell,
}

/// Cells that faces join, and which no face joins to others.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPiece {
    /// Number of its cells.
    pub cells: usize,
    /// Centre of the first of them in m.
    pub centre: Vec3,
    /// Indices of the patches that its cells have faces on, in the order of the mesh.
    pub patches: Vec<usize>,
}

impl Mesh {
    /// Angles and skewness of the faces; `None` for a mesh of one cell.
    pub fn quality(&self) -> Option<MeshQuality> {
        let internal = self.internal_faces();
        let angles = (0..internal).map(|face| self.angle(face));
        let cosines: f64 = angles.clone().map(|one| one.to_radians().cos()).sum();
        let average = (cosines / internal as f64).min(1.0).acos().to_degrees();
        Some(MeshQuality {
            angle: self.largest(0, angles)?,
            average_angle: average,
            skewness: self.largest(0, (0..internal).map(|face| self.skewness(face)))?,
            boundary_skewness: self.largest(
                internal,
                (internal..self.faces()).map(|face| self.skewness(face)),
            )?,
            thickness_ratio: self.thickness_ratio()?,
        })
    }

    /// The pieces of a mesh in the order of their first cells; periodic planes join as faces do.
    pub fn pieces(&self) -> Vec<MeshPiece> {
        const NONE: usize = usize::MAX;
        let mut piece_of = vec![NONE; self.cells];
        let (mut pieces, mut open) = (Vec::new(), Vec::new());
        for first in 0..self.cells {
            if piece_of[first] != NONE {
                continue;
            }
            let own = pieces.len();
            piece_of[first] = own;
            open.push(first);
            let mut cells = 0;
            while let Some(cell) = open.pop() {
                cells += 1;
                let faces = self.faces_of(cell).iter();
                let beyond = faces.filter_map(|&face| self.beyond(cell, face as usize));
                for other in beyond.map(|beyond| beyond.cell) {
                    if piece_of[other] == NONE {
                        piece_of[other] = own;
                        open.push(other);
                    }
                }
            }
            let centre = self.cell_centre[first];
            pieces.push(MeshPiece {
                cells,
                centre,
                patches: Vec::new(),
            });
        }
        for (patch, faces) in self.patches().iter().map(Patch::faces).enumerate() {
            for face in faces {
                let piece = &mut pieces[piece_of[self.owner()[face] as usize]];
                if piece.patches.last() != Some(&patch) {
                    piece.patches.push(patch);
                }
            }
        }
        pieces
    }

    /// The largest Courant number that gas of these velocities in m/s has over a step in s: Δt Σ |u·S|/(2 V), twice the
    /// volume that leaves a cell of divergence-free flow; one velocity a cell. `None` where one is not finite.
    pub fn courant(&self, velocity: &[Vec3], step: f64) -> Option<InCell> {
        let number = |cell: usize| {
            let through = |face: &u32| velocity[cell].dot(&self.face_area[*face as usize]).abs();
            let sum: f64 = self.faces_of(cell).iter().map(through).sum();
            0.5 * step * sum / self.cell_volume[cell]
        };
        let numbers: Vec<f64> = (0..self.cells.min(velocity.len())).map(number).collect();
        if numbers.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let largest = (0..numbers.len()).max_by(|&a, &b| numbers[a].total_cmp(&numbers[b]))?;
        Some(self.in_cell(largest, numbers[largest]))
    }

    /// The first of the largest of values of faces, the first of which is `from`.
    fn largest(&self, from: usize, of_faces: impl Iterator<Item = f64>) -> Option<InCell> {
        // Of faces that are alike but for round-off, the first.
        const MORE: f64 = 1.0 + 1e-9;
        let (face, value) = of_faces.enumerate().reduce(|a, b| match b.1 > MORE * a.1 {
            true => b,
            false => a,
        })?;
        Some(self.in_cell(self.topology.owner[from + face] as usize, value))
    }

    fn in_cell(&self, cell: usize, value: f64) -> InCell {
        InCell {
            value,
            cell,
            centre: self.cell_centre[cell],
        }
    }

    /// From an internal face's owner to its neighbour.
    fn between(&self, face: usize) -> Vec3 {
        let [owner, neighbour] = [self.topology.owner[face], self.topology.neighbour[face]];
        self.cell_centre[neighbour as usize] - self.cell_centre[owner as usize]
    }

    fn thickness_ratio(&self) -> Option<InCell> {
        let thickness = |cell: u32, face: usize| {
            let way = self.face_centre[face] - self.cell_centre[cell as usize];
            way.dot(&self.face_area[face]).abs()
        };
        let ratios = (0..self.internal_faces()).map(|face| {
            let cells = [self.topology.owner[face], self.topology.neighbour[face]];
            let [own, other] = cells.map(|cell| thickness(cell, face));
            (
                own.max(other) / own.min(other),
                cells[usize::from(other < own)],
            )
        });
        let (value, cell) = ratios.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(self.in_cell(cell as usize, value))
    }

    fn angle(&self, face: usize) -> f64 {
        let (area, line) = (self.face_area[face], self.between(face));
        // By the tangent: a cosine near one has no digits left.
        let across = area.cross(&line).norm();
        across.atan2(area.dot(&line)).to_degrees()
    }

    fn skewness(&self, face: usize) -> f64 {
        let area = self.face_area[face];
        let owner = self.cell_centre[self.topology.owner[face] as usize];
        let to_face = self.face_centre[face] - owner;
        let (line, least_reach) = match face < self.internal_faces() {
            true => (self.between(face), 0.2),
            false => (area.dot(&to_face) / area.norm_squared() * area, 0.4),
        };
        let off = to_face - area.dot(&to_face) / area.dot(&line) * line;
        let length = off.norm();
        if length == 0.0 {
            return 0.0;
        }
        let centre = self.face_centre[face];
        let reach = |point: &u32| {
            let point = self.topology.points[*point as usize] - centre;
            (off.dot(&point) / length).abs()
        };
        let points = self.face_points(face).iter();
        length / points.map(reach).fold(least_reach * line.norm(), f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::block::{BoxSpec, box_mesh};

    /// A box of 4 × 3 × 5 cells of 10 mm whose points are moved by `change`.
    fn moved(change: impl Fn(Vec3) -> Vec3) -> Mesh {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.04, 0.03, 0.05),
            cells: [4, 3, 5],
            patches: ["a", "b", "c", "d", "e", "f"].map(str::to_owned),
        };
        let mut topology = box_mesh(&spec).unwrap().topology().clone();
        for point in &mut topology.points {
            *point = change(*point);
        }
        Mesh::new(topology).unwrap()
    }

    #[test]
    fn cells_of_a_box_do_not_lean() {
        let quality = moved(|x| x).quality().unwrap();
        assert!(quality.angle.value < 1e-6, "{quality:?}");
        assert!(quality.average_angle < 1e-5, "{quality:?}");
        assert!(quality.skewness.value < 1e-12, "{quality:?}");
    }

    #[test]
    fn sheared_cells_lean_by_the_angle_of_the_shear() {
        for degrees in [1e-3_f64, 35.0, 65.0, 80.0] {
            let tangent = degrees.to_radians().tan();
            let quality = moved(|x| x + Vec3::new(tangent * x.z, 0.0, 0.0))
                .quality()
                .unwrap();
            let found = quality.angle.value;
            assert!((found - degrees).abs() < 1e-6, "{degrees}: {found}");
            // Of 3 × 3 × 5 and 4 × 2 × 5 faces upright and 4 × 3 × 4 lying ones those along y do not lean.
            let mean = (93.0 * degrees.to_radians().cos() + 40.0) / 133.0;
            let average = mean.acos().to_degrees();
            assert!(
                (quality.average_angle - average).abs() < 1e-6,
                "{quality:?}"
            );
            assert!(quality.skewness.value < 1e-9, "{quality:?}");
        }
    }

    #[test]
    fn a_point_pulled_aside_makes_its_faces_skew() {
        // One cell above another, whose common face is pulled by 4 mm along x: its centre lies 4 mm off the line between the
        // centres, moved by 0.9 mm or less themselves, and the face reaches 5 mm.
        let at = |x: f64, y: f64| (x - y).abs() < 1e-9;
        let mesh = moved(|x| match at(x.z, 0.02) {
            true => x + Vec3::new(4e-3, 0.0, 0.0),
            false => x,
        });
        let quality = mesh.quality().unwrap();
        let skew = quality.skewness;
        assert!(skew.value > 0.3 && skew.value < 0.8, "{quality:?}");
        assert!(
            at(skew.centre.z, 0.015) || skew.centre.z < 0.02,
            "{quality:?}"
        );
    }

    #[test]
    fn a_layer_that_is_thinner_than_the_ones_beside_it_is_found() {
        assert!((moved(|x| x).quality().unwrap().thickness_ratio.value - 1.0).abs() < 1e-9);
        // The layer from 20 to 30 mm becomes 0.1 mm thick.
        let mesh = moved(|x| {
            let above = if x.z > 0.025 { 9.9e-3 } else { 0.0 };
            Vec3::new(x.x, x.y, x.z - above)
        });
        let found = mesh.quality().unwrap().thickness_ratio;
        assert!((found.value - 100.0).abs() < 1e-6, "{found:?}");
        assert!((found.centre.z - 0.020_05).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn the_courant_number_is_the_share_of_a_cell_that_flow_along_an_axis_passes() {
        let mesh = moved(|x| x);
        let mut velocity = vec![Vec3::new(0.0, 0.0, 1.0); mesh.cells()];
        velocity[17] = Vec3::new(0.0, -3.0, 0.0);
        let found = mesh.courant(&velocity, 5e-3).unwrap();
        assert!(
            found.cell == 17 && (found.value - 1.5).abs() < 1e-12,
            "{found:?}"
        );
        velocity[3].x = f64::NAN;
        assert_eq!(mesh.courant(&velocity, 5e-3), None);
    }
}
