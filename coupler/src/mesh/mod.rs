//! Finite-volume meshes of general polyhedra, numbered as in an OpenFOAM polyMesh: internal faces
//! first, then each patch's; a face's normal points from owner to neighbour, or out of the domain.

pub mod block;
pub mod cut;
pub mod cylinder;
mod extrude;
pub mod flat;
pub mod grading;
pub mod locate;
pub mod openings;
pub mod periodic;
pub mod polymesh;
pub mod quality;
pub mod refine;
pub mod surface;
pub mod tetrahedra;
pub mod zone;

use calcine_physics::Vec3;
use thiserror::Error;

use crate::periodicity::{PeriodicFace, Periodicity};

/// A named set of boundary faces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Name as case files use it.
    pub name: String,
    /// Index of its first face.
    pub start: usize,
    /// Number of its faces.
    pub count: usize,
}

impl Patch {
    /// Indices of the patch's faces.
    pub fn faces(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.count
    }
}

/// Points and connectivity, as in the files of a polyMesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// Points in m.
    pub points: Vec<Vec3>,
    /// Where each face's points begin in `face_points`; one more entry than faces.
    pub face_offsets: Vec<u32>,
    /// Point indices of all faces, one face after the other.
    pub face_points: Vec<u32>,
    /// Owner cell of each face.
    pub owner: Vec<u32>,
    /// Neighbour cell of each internal face.
    pub neighbour: Vec<u32>,
    /// Patches, in the order of their faces.
    pub patches: Vec<Patch>,
}

/// A mesh that cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    /// Lists whose lengths or indices contradict each other.
    #[error("the mesh is inconsistent: {0}")]
    Inconsistent(String),
    /// A cell without positive volume.
    #[error(
        "cell {cell} about ({:.6}, {:.6}, {:.6}) m has a volume of {volume} m^3; look there for points that are \
         out of place or faces that point inwards (`checkMesh` lists them)", at.x, at.y, at.z
    )]
    Volume {
        /// Index of the cell.
        cell: usize,
        /// Mean of the centres of its faces in m.
        at: Vec3,
        /// Its volume in m³.
        volume: f64,
    },
    /// A cell whose faces do not close.
    #[error(
        "cell {cell} about ({:.6}, {:.6}, {:.6}) m is open: its face areas sum to {gap} m^2; look there for a face that is missing, doubled or \
         turned around (`checkMesh` lists such cells)", at.x, at.y, at.z
    )]
    Open {
        /// Index of the cell.
        cell: usize,
        /// Mean of the centres of its faces in m.
        at: Vec3,
        /// Magnitude of the sum of its face area vectors in m².
        gap: f64,
    },
}

/// A mesh with its geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    topology: Topology,
    cells: usize,
    cell_volume: Vec<f64>,
    cell_centre: Vec<Vec3>,
    face_area: Vec<Vec3>,
    face_centre: Vec<Vec3>,
    cell_face_offsets: Vec<u32>,
    cell_faces: Vec<u32>,
    periodicity: Periodicity,
    periodic_faces: Vec<PeriodicFace>,
    /// Index into `periodic_faces` of each boundary face, `u32::MAX` of others; empty where nothing is periodic.
    pair_of: Vec<u32>,
}

impl Mesh {
    /// Checks the connectivity and computes the geometry: face centres as area-weighted triangle
    /// centres, cell centres as volume-weighted pyramid centres (as OpenFOAM does).
    pub fn new(topology: Topology) -> Result<Self, MeshError> {
        let cells = check(&topology)?;
        let faces = topology.owner.len();
        let (face_area, face_centre): (Vec<_>, Vec<_>) = (0..faces)
            .map(|face| face_geometry(&topology, face))
            .unzip();

        let mut counts = vec![0u32; cells + 1];
        for &cell in topology.owner.iter().chain(&topology.neighbour) {
            counts[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            counts[cell + 1] += counts[cell];
        }
        let mut next = counts.clone();
        let mut cell_faces = vec![0u32; topology.owner.len() + topology.neighbour.len()];
        for face in 0..faces {
            let sides = [
                Some(topology.owner[face]),
                topology.neighbour.get(face).copied(),
            ];
            for cell in sides.into_iter().flatten() {
                let slot = &mut next[cell as usize];
                cell_faces[*slot as usize] = face as u32;
                *slot += 1;
            }
        }
        let mut mesh = Self {
            topology,
            cells,
            cell_volume: vec![0.0; cells],
            cell_centre: vec![Vec3::zeros(); cells],
            face_area,
            face_centre,
            cell_face_offsets: counts,
            cell_faces,
            periodicity: Periodicity::default(),
            periodic_faces: Vec::new(),
            pair_of: Vec::new(),
        };
        mesh.measure_cells()?;
        Ok(mesh)
    }

    fn measure_cells(&mut self) -> Result<(), MeshError> {
        for cell in 0..self.cells {
            let faces = self.faces_of(cell);
            let estimate = faces
                .iter()
                .map(|&f| self.face_centre[f as usize])
                .sum::<Vec3>()
                / faces.len() as f64;
            let (mut volume, mut moment) = (0.0, Vec3::zeros());
            let (mut gap, mut area) = (Vec3::zeros(), 0.0);
            for &face in faces {
                let face = face as usize;
                let outward = self.outward(cell, face);
                let centre = self.face_centre[face];
                let pyramid = outward.dot(&(centre - estimate)) / 3.0;
                volume += pyramid;
                moment += pyramid * (0.75 * centre + 0.25 * estimate);
                gap += outward;
                area += outward.norm();
            }
            if volume.is_nan() || volume <= 0.0 {
                return Err(MeshError::Volume {
                    cell,
                    at: estimate,
                    volume,
                });
            }
            if gap.norm() > 1e-6 * area {
                return Err(MeshError::Open {
                    cell,
                    at: estimate,
                    gap: gap.norm(),
                });
            }
            self.cell_volume[cell] = volume;
            self.cell_centre[cell] = moment / volume;
        }
        Ok(())
    }

    /// Points and connectivity.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Number of faces, boundary included.
    pub fn faces(&self) -> usize {
        self.topology.owner.len()
    }

    /// Number of internal faces; they come first.
    pub fn internal_faces(&self) -> usize {
        self.topology.neighbour.len()
    }

    /// Owner cell of each face.
    pub fn owner(&self) -> &[u32] {
        &self.topology.owner
    }

    /// Neighbour cell of each internal face.
    pub fn neighbour(&self) -> &[u32] {
        &self.topology.neighbour
    }

    /// Patches, in the order of their faces.
    pub fn patches(&self) -> &[Patch] {
        &self.topology.patches
    }

    /// The patch of a name.
    pub fn patch(&self, name: &str) -> Option<&Patch> {
        self.topology
            .patches
            .iter()
            .find(|patch| patch.name == name)
    }

    /// Cell volumes in m³.
    pub fn cell_volume(&self) -> &[f64] {
        &self.cell_volume
    }

    /// Lowest and highest corner of the box about the mesh, in m.
    pub fn bounds(&self) -> [Vec3; 2] {
        bounds(self.topology.points.iter().copied())
    }

    /// Cell centres in m.
    pub fn cell_centre(&self) -> &[Vec3] {
        &self.cell_centre
    }

    /// Face area vectors in m², from owner to neighbour or out of the domain.
    pub fn face_area(&self) -> &[Vec3] {
        &self.face_area
    }

    /// Face centres in m.
    pub fn face_centre(&self) -> &[Vec3] {
        &self.face_centre
    }

    /// Point indices of a face, counter-clockwise seen against its normal's direction.
    pub fn face_points(&self, face: usize) -> &[u32] {
        points_of(&self.topology, face)
    }

    /// Faces of a cell.
    pub fn faces_of(&self, cell: usize) -> &[u32] {
        let range =
            self.cell_face_offsets[cell] as usize..self.cell_face_offsets[cell + 1] as usize;
        &self.cell_faces[range]
    }

    /// Area vector of a cell's face, out of the cell, in m².
    pub fn outward(&self, cell: usize, face: usize) -> Vec3 {
        self.side(cell, face) * self.face_area[face]
    }

    /// 1 where a face's normal points out of the cell, −1 where it points in.
    #[inline]
    pub fn side(&self, cell: usize, face: usize) -> f64 {
        if self.topology.owner[face] as usize == cell {
            1.0
        } else {
            -1.0
        }
    }

    /// The cell on the other side of a face, if the face is internal ([`Mesh::beyond`]: across periodic planes too).
    pub fn across(&self, cell: usize, face: usize) -> Option<usize> {
        let neighbour = *self.topology.neighbour.get(face)? as usize;
        Some(if neighbour == cell {
            self.topology.owner[face] as usize
        } else {
            neighbour
        })
    }
}

fn points_of(topology: &Topology, face: usize) -> &[u32] {
    let range = topology.face_offsets[face] as usize..topology.face_offsets[face + 1] as usize;
    &topology.face_points[range]
}

/// Lowest and highest corner of the box about points.
fn bounds(points: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    let infinity = Vec3::repeat(f64::INFINITY);
    points.fold([infinity, -infinity], |[lower, upper], point| {
        [lower.inf(&point), upper.sup(&point)]
    })
}

/// Area vector and centre of a face from triangles about the mean of its points, each with the magnitude of its area as its weight:
/// as OpenFOAM has them of warped faces, too.
fn face_geometry(topology: &Topology, face: usize) -> (Vec3, Vec3) {
    let indices = points_of(topology, face);
    let point = |i: usize| topology.points[indices[i % indices.len()] as usize];
    let middle = (0..indices.len()).map(point).sum::<Vec3>() / indices.len() as f64;
    let triangle_area = |i: usize| 0.5 * (point(i) - middle).cross(&(point(i + 1) - middle));
    let area = (0..indices.len()).map(triangle_area).sum::<Vec3>();
    let (mut weight, mut moment) = (0.0, Vec3::zeros());
    for i in 0..indices.len() {
        let share = triangle_area(i).norm();
        weight += share;
        moment += share * (point(i) + point(i + 1) + middle) / 3.0;
    }
    (area, moment / weight)
}

fn check(topology: &Topology) -> Result<usize, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    let faces = topology.owner.len();
    let internal = topology.neighbour.len();
    if topology.face_offsets.len() != faces + 1 {
        return wrong(format!(
            "{} faces, but {faces} owners",
            topology.face_offsets.len().max(1) - 1
        ));
    }
    if internal > faces {
        return wrong(format!("{internal} neighbours, but {faces} owners"));
    }
    let stored = topology.face_points.len();
    if topology.face_offsets.first() != Some(&0)
        || topology.face_offsets.last().copied() != u32::try_from(stored).ok()
        || topology
            .face_offsets
            .windows(2)
            .any(|pair| pair[1].checked_sub(pair[0]).is_none_or(|points| points < 3))
    {
        return wrong("each face needs at least three points".into());
    }
    if let Some(point) = topology
        .face_points
        .iter()
        .find(|&&p| p as usize >= topology.points.len())
    {
        return wrong(format!(
            "a face names point {point} of {}",
            topology.points.len()
        ));
    }
    if topology
        .points
        .iter()
        .any(|point| point.iter().any(|x| !x.is_finite()))
    {
        return wrong("a point's coordinate is not a finite number".into());
    }
    let mut next = internal;
    for (place, patch) in topology.patches.iter().enumerate() {
        if topology.patches[..place]
            .iter()
            .any(|other| other.name == patch.name)
        {
            return wrong(format!(
                "two patches have the name `{}`; rename one, since conditions are given by name",
                patch.name
            ));
        }
        if patch.start != next {
            return wrong(format!(
                "patch `{}` starts at face {}, not {next}",
                patch.name, patch.start
            ));
        }
        next = patch.start.saturating_add(patch.count);
    }
    if next != faces {
        return wrong(format!(
            "the patches end at face {next}, the mesh has {faces}"
        ));
    }
    let cells = topology
        .owner
        .iter()
        .chain(&topology.neighbour)
        .max()
        .map_or(0, |&c| c as usize + 1);
    if cells == 0 || cells > topology.owner.len() + internal {
        return wrong(format!("{cells} cells with {faces} faces"));
    }
    let mut used = vec![0u32; cells];
    for &cell in topology.owner.iter().chain(&topology.neighbour) {
        used[cell as usize] += 1;
    }
    if let Some(cell) = used.iter().position(|&count| count < 4) {
        return wrong(format!("cell {cell} has {} faces", used[cell]));
    }
    if let Some(face) = (0..internal).find(|&f| topology.owner[f] == topology.neighbour[f]) {
        return wrong(format!(
            "face {face} has cell {} on both sides",
            topology.owner[face]
        ));
    }
    Ok(cells)
}
