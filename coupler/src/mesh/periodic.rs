//! Pairs of patches through which the domain repeats itself: face by face, what leaves through one comes in through its
//! partner.

use calcine_physics::Vec3;
use thiserror::Error;

use super::{Mesh, MeshError};
pub use crate::periodicity::PeriodicFace;
use crate::periodicity::{PeriodicSpan, Periodicity};

/// A face and its partner may be off by this share of the face's extent, as OpenFOAM's `matchTolerance` has it.
const MATCH: f64 = 1e-4;
/// Sine of the angle by which a face may lean against its plane.
const LEAN: f64 = 1e-6;

/// A cell beyond a face, and where it lies as seen through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellBeyond {
    /// The cell.
    pub cell: usize,
    /// What has to be added to the cell's coordinates, in m, to have it beside the face: zero but across a periodic plane.
    pub shift: Vec3,
}

/// Patches that cannot be a periodic pair.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PeriodicError {
    /// A patch that the mesh does not have.
    #[error("the mesh has no patch `{patch}` for the partner of `{other}`")]
    NoPatch {
        /// The patch.
        patch: String,
        /// The one that names it.
        other: String,
    },
    /// Numbers of faces that differ.
    #[error("periodic patch `{patch}` has {faces} faces, its partner `{partner}` has {others}")]
    Counts {
        /// The patch.
        patch: String,
        /// Its faces.
        faces: usize,
        /// The other patch.
        partner: String,
        /// Its faces.
        others: usize,
    },
    /// A face that is not normal to the axis of the pair.
    #[error(
        "face {face} of periodic patch `{patch}` at ({}, {}, {}) m leans by {angle:.3} degrees against the plane normal to {axis}",
        at.x, at.y, at.z
    )]
    Leans {
        /// The patch.
        patch: String,
        /// The face.
        face: usize,
        /// Its centre in m.
        at: Vec3,
        /// Angle in degrees.
        angle: f64,
        /// Name of the axis.
        axis: char,
    },
    /// A face that is off the plane of its patch.
    #[error(
        "face {face} of periodic patch `{patch}` lies at {axis} = {at} m, the end of the mesh at {plane} m"
    )]
    OffPlane {
        /// The patch.
        patch: String,
        /// The face.
        face: usize,
        /// Name of the axis.
        axis: char,
        /// Its coordinate in m.
        at: f64,
        /// That of the plane in m.
        plane: f64,
    },
    /// Two patches on the same side of the domain.
    #[error("periodic patches `{patch}` and `{partner}` do not face each other along an axis")]
    SameSide {
        /// The patch.
        patch: String,
        /// The other patch.
        partner: String,
    },
    /// A face without a partner.
    #[error(
        "face {face} of periodic patch `{patch}` at ({}, {}, {}) m has no partner in `{partner}`: the nearest face there is off by \
         {distance} m",
        at.x, at.y, at.z
    )]
    Unmatched {
        /// The patch.
        patch: String,
        /// The face.
        face: usize,
        /// Its centre in m.
        at: Vec3,
        /// The other patch.
        partner: String,
        /// Distance in m of the nearest face there after the translation.
        distance: f64,
    },
    /// A second pair along an axis.
    #[error("periodic patches `{patch}` and `{partner}`: direction {axis} is periodic already")]
    Twice {
        /// The patch.
        patch: String,
        /// The other patch.
        partner: String,
        /// Name of the axis.
        axis: char,
    },
    /// A cell with both faces of a pair.
    #[error(
        "cell {cell} reaches from periodic patch `{patch}` to its partner `{partner}`: there is one cell across"
    )]
    OneCell {
        /// The cell.
        cell: usize,
        /// The patch.
        patch: String,
        /// The other patch.
        partner: String,
    },
    /// The mesh with the partners' faces in order cannot be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The name of an axis.
pub fn axis_name(axis: usize) -> char {
    ['x', 'y', 'z'][axis.min(2)]
}

impl Mesh {
    /// The mesh with pairs of its patches joined. Faces and points of a pair's second patch are put into the order of their
    /// partners, as OpenFOAM's `cyclic` wants them.
    pub fn with_periodic(self, pairs: &[[String; 2]]) -> Result<Self, PeriodicError> {
        if pairs.is_empty() {
            return Ok(self);
        }
        let mut periodicity = Periodicity::default();
        let mut joined = Vec::new();
        let mut topology = self.topology.clone();
        for pair in pairs {
            let found = self.join(pair, &mut periodicity)?;
            self.reorder(&found, &mut topology);
            joined.push(found);
        }
        let mut mesh = Self::new(topology)?;
        for found in &joined {
            // Each partner stands now where the first of them stood, in the order of the faces.
            let first = found.iter().map(|pair| pair.partner).min().unwrap_or(0);
            let ordered = found.iter().enumerate().map(|(place, pair)| {
                let face = pair.face;
                let partner = first + place;
                let forwards = pair.translation.sum() > 0.0;
                PeriodicFace {
                    face: if forwards { face } else { partner },
                    partner: if forwards { partner } else { face },
                    translation: pair.translation.abs(),
                }
            });
            mesh.periodic_faces.extend(ordered);
        }
        mesh.periodicity = periodicity;
        mesh.pair_of = vec![u32::MAX; mesh.faces() - mesh.internal_faces()];
        for (index, pair) in mesh.periodic_faces.iter().enumerate() {
            for face in [pair.face, pair.partner] {
                mesh.pair_of[face - mesh.topology.neighbour.len()] = index as u32;
            }
        }
        Ok(mesh)
    }

    /// Periodic directions; none unless patches were joined.
    pub fn periodicity(&self) -> &Periodicity {
        &self.periodicity
    }

    /// Pairs of periodic faces, each once.
    pub fn periodic_faces(&self) -> &[PeriodicFace] {
        &self.periodic_faces
    }

    /// The pair to which a face belongs: its index in `periodic_faces`.
    #[inline]
    pub fn periodic_pair(&self, face: usize) -> Option<usize> {
        let boundary = face.checked_sub(self.topology.neighbour.len())?;
        let pair = *self.pair_of.get(boundary)?;
        (pair != u32::MAX).then_some(pair as usize)
    }

    /// The partner of a periodic patch.
    pub fn partner(&self, patch: &super::Patch) -> Option<&super::Patch> {
        if patch.count == 0 {
            return None;
        }
        let pair = &self.periodic_faces[self.periodic_pair(patch.start)?];
        let other = if pair.face == patch.start {
            pair.partner
        } else {
            pair.face
        };
        let mut patches = self.topology.patches.iter();
        patches.find(|patch| patch.faces().contains(&other))
    }

    /// The cell on the other side of a face, across periodic planes too.
    #[inline]
    pub fn beyond(&self, cell: usize, face: usize) -> Option<CellBeyond> {
        if let Some(cell) = self.across(cell, face) {
            let shift = Vec3::zeros();
            return Some(CellBeyond { cell, shift });
        }
        let pair = &self.periodic_faces[self.periodic_pair(face)?];
        let (other, shift) = match face == pair.face {
            true => (pair.partner, -pair.translation),
            false => (pair.face, pair.translation),
        };
        let cell = self.topology.owner[other] as usize;
        Some(CellBeyond { cell, shift })
    }

    /// Finds each face's partner.
    fn join(
        &self,
        [patch, partner]: &[String; 2],
        periodicity: &mut Periodicity,
    ) -> Result<Vec<PeriodicFace>, PeriodicError> {
        let faces = |name: &String, other: &String| {
            let found = self.patch(name).filter(|patch| patch.count > 0);
            found
                .map(super::Patch::faces)
                .ok_or_else(|| PeriodicError::NoPatch {
                    patch: name.clone(),
                    other: other.clone(),
                })
        };
        let (own, others) = (faces(patch, partner)?, faces(partner, patch)?);
        if own.len() != others.len() {
            return Err(PeriodicError::Counts {
                patch: patch.clone(),
                faces: own.len(),
                partner: partner.clone(),
                others: others.len(),
            });
        }
        let axis = self.face_area[own.start].iamax();
        let bounds = self.bounds();
        let plane = |face: usize| usize::from(self.face_area[face][axis] > 0.0);
        let side = plane(own.start);
        if plane(others.start) == side {
            return Err(PeriodicError::SameSide {
                patch: patch.clone(),
                partner: partner.clone(),
            });
        }
        for (name, faces, side) in [
            (patch, own.clone(), side),
            (partner, others.clone(), 1 - side),
        ] {
            for face in faces {
                self.check_plane(name, face, axis, bounds[side][axis])?;
            }
        }
        if periodicity.axes[axis].is_some() {
            return Err(PeriodicError::Twice {
                patch: patch.clone(),
                partner: partner.clone(),
                axis: axis_name(axis),
            });
        }
        let (low, high) = (bounds[0][axis], bounds[1][axis]);
        periodicity.axes[axis] = Some(PeriodicSpan { low, high });
        let mut translation = Vec3::zeros();
        translation[axis] = bounds[1 - side][axis] - bounds[side][axis];
        let candidates = Candidates::new(self, others.clone(), axis);
        let mut taken = vec![false; others.len()];
        own.map(|face| {
            let place = self.face_centre[face] + translation;
            let reach = MATCH * self.face_area[face].norm().sqrt();
            let found = candidates.nearest(self, place, reach);
            let free = found.filter(|&other| {
                !std::mem::replace(&mut taken[other - others.start], true)
                    && (self.face_area[face] + self.face_area[other]).norm()
                        <= MATCH * self.face_area[face].norm()
            });
            let Some(other) = free else {
                let off = |other: usize| (self.face_centre[other] - place).norm();
                return Err(PeriodicError::Unmatched {
                    patch: patch.clone(),
                    face,
                    at: self.face_centre[face],
                    partner: partner.clone(),
                    distance: others.clone().map(off).fold(f64::INFINITY, f64::min),
                });
            };
            if self.topology.owner[face] == self.topology.owner[other] {
                return Err(PeriodicError::OneCell {
                    cell: self.topology.owner[face] as usize,
                    patch: patch.clone(),
                    partner: partner.clone(),
                });
            }
            Ok(PeriodicFace {
                face,
                partner: other,
                translation,
            })
        })
        .collect()
    }

    /// A face of a periodic patch is normal to the axis and lies at the end of the mesh.
    fn check_plane(
        &self,
        patch: &str,
        face: usize,
        axis: usize,
        plane: f64,
    ) -> Result<(), PeriodicError> {
        let (area, centre) = (self.face_area[face], self.face_centre[face]);
        let mut across = area;
        across[axis] = 0.0;
        if across.norm() > LEAN * area.norm() {
            return Err(PeriodicError::Leans {
                patch: patch.to_owned(),
                face,
                at: centre,
                angle: across.norm().atan2(area[axis].abs()).to_degrees(),
                axis: axis_name(axis),
            });
        }
        if (centre[axis] - plane).abs() > MATCH * area.norm().sqrt() {
            return Err(PeriodicError::OffPlane {
                patch: patch.to_owned(),
                face,
                axis: axis_name(axis),
                at: centre[axis],
                plane,
            });
        }
        Ok(())
    }

    /// Puts partners into the order of their faces, and their points into the reverse of the faces', from the first on.
    fn reorder(&self, pairs: &[PeriodicFace], topology: &mut super::Topology) {
        let Some(first) = pairs.iter().map(|pair| pair.partner).min() else {
            return;
        };
        let mut points = Vec::new();
        let mut offsets = Vec::with_capacity(pairs.len());
        for (place, pair) in pairs.iter().enumerate() {
            let start = self.face_points(pair.face)[0] as usize;
            let start = self.topology.points[start] + pair.translation;
            let mut own = self.face_points(pair.partner).to_vec();
            let off = |point: &u32| (self.topology.points[*point as usize] - start).norm_squared();
            let nearest = (0..own.len()).min_by(|&a, &b| off(&own[a]).total_cmp(&off(&own[b])));
            own.rotate_left(nearest.unwrap_or(0));
            points.extend(own);
            offsets.push(points.len() as u32);
            topology.owner[first + place] = self.topology.owner[pair.partner];
        }
        let begin = self.topology.face_offsets[first];
        for (place, offset) in offsets.iter().enumerate() {
            topology.face_offsets[first + place + 1] = begin + offset;
        }
        let begin = begin as usize;
        topology.face_points[begin..begin + points.len()].copy_from_slice(&points);
    }
}

/// Faces of a plane by one of their coordinates within it.
struct Candidates {
    along: usize,
    sorted: Vec<usize>,
}

impl Candidates {
    fn new(mesh: &Mesh, faces: std::ops::Range<usize>, axis: usize) -> Self {
        let bounds = super::bounds(faces.clone().map(|face| mesh.face_centre[face]));
        let mut extent = bounds[1] - bounds[0];
        extent[axis] = -1.0;
        let along = extent.imax();
        let mut sorted: Vec<usize> = faces.collect();
        sorted.sort_by(|&a, &b| mesh.face_centre[a][along].total_cmp(&mesh.face_centre[b][along]));
        Self { along, sorted }
    }

    /// The face nearest to a place, if one lies within reach.
    fn nearest(&self, mesh: &Mesh, place: Vec3, reach: f64) -> Option<usize> {
        let coordinate = |&face: &usize| mesh.face_centre[face][self.along];
        let wanted = place[self.along];
        let first = self
            .sorted
            .partition_point(|face| coordinate(face) < wanted - reach);
        let near = self.sorted[first..].iter();
        let near = near.take_while(|face| coordinate(face) <= wanted + reach);
        let off = |&face: &usize| (mesh.face_centre[face] - place).norm();
        let found = near.copied().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        (off(&found) <= reach).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::block::{BoxSpec, box_mesh};

    fn block(cells: [usize; 3]) -> Mesh {
        let spec = BoxSpec {
            origin: Vec3::new(-0.01, 0.0, 0.0),
            size: Vec3::new(0.04, 0.03, 0.05),
            cells,
            patches: ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"].map(str::to_owned),
        };
        box_mesh(&spec).unwrap()
    }

    fn pair(a: &str, b: &str) -> [String; 2] {
        [a.to_owned(), b.to_owned()]
    }

    #[test]
    fn each_face_has_its_partner_across_the_domain_and_cells_their_neighbours() {
        let mesh = block([4, 3, 5])
            .with_periodic(&[pair("x-max", "x-min"), pair("z-min", "z-max")])
            .unwrap();
        let spans = mesh.periodicity().axes;
        assert_eq!(
            spans[0],
            Some(PeriodicSpan {
                low: -0.01,
                high: 0.03
            })
        );
        assert!(spans[1].is_none() && spans[2].is_some());
        assert_eq!(mesh.periodic_faces().len(), 15 + 12);
        for pair in mesh.periodic_faces() {
            let [face, partner] = [pair.face, pair.partner].map(|face| mesh.face_centre()[face]);
            assert!((face + pair.translation - partner).norm() < 1e-15);
            assert!(pair.translation.sum() > 0.0);
            let [low, high] = [pair.face, pair.partner].map(|face| mesh.owner()[face] as usize);
            let beyond = mesh.beyond(low, pair.face).unwrap();
            assert_eq!(beyond.cell, high);
            let line = mesh.cell_centre()[high] + beyond.shift - mesh.cell_centre()[low];
            // Beside each other, one cell apart: 10 mm along x and along z.
            assert!((line.norm() - 0.01).abs() < 1e-12, "{line}");
            assert_eq!(mesh.beyond(high, pair.partner).unwrap().cell, low);
        }
        assert!(mesh.beyond(0, mesh.patch("y-min").unwrap().start).is_none());
    }

    #[test]
    fn partners_are_put_into_the_order_of_their_faces() {
        let plain = block([4, 3, 5]);
        let mut topology = plain.topology().clone();
        let faces = plain.patch("x-max").unwrap().faces();
        // The faces of the partner from the last to the first, their points from another one on.
        for (face, from) in faces.clone().zip(faces.clone().rev()) {
            let begin = topology.face_offsets[face] as usize;
            let mut points = plain.face_points(from).to_vec();
            points.rotate_left(1 + face % 3);
            topology.face_points[begin..begin + 4].copy_from_slice(&points);
            topology.owner[face] = plain.owner()[from];
        }
        let mesh = Mesh::new(topology)
            .unwrap()
            .with_periodic(&[pair("x-min", "x-max")])
            .unwrap();
        let expected = plain.with_periodic(&[pair("x-min", "x-max")]).unwrap();
        assert_eq!(mesh, expected);
        let point = |face: usize, k: usize| {
            let points = mesh.face_points(face);
            mesh.topology().points[points[k % points.len()] as usize]
        };
        for pair in mesh.periodic_faces() {
            for k in 0..4 {
                let moved = point(pair.face, k) + pair.translation;
                assert!((moved - point(pair.partner, 4 - k)).norm() < 1e-15);
            }
        }
    }

    #[test]
    fn patches_that_do_not_repeat_are_refused_with_the_face_and_the_distance() {
        let plain = block([4, 3, 5]);
        let counts = plain
            .clone()
            .with_periodic(&[pair("x-min", "y-min")])
            .unwrap_err();
        assert!(
            matches!(
                counts,
                PeriodicError::Counts {
                    faces: 15,
                    others: 20,
                    ..
                }
            ),
            "{counts}"
        );
        let missing = plain
            .clone()
            .with_periodic(&[pair("x-min", "top")])
            .unwrap_err();
        assert!(missing.to_string().contains("no patch `top`"), "{missing}");
        let twice = [pair("x-min", "x-max"), pair("x-max", "x-min")];
        let twice = plain.clone().with_periodic(&twice).unwrap_err();
        assert!(
            matches!(twice, PeriodicError::Twice { axis: 'x', .. }),
            "{twice}"
        );
        let one = block([1, 3, 5])
            .with_periodic(&[pair("x-min", "x-max")])
            .unwrap_err();
        assert!(
            matches!(one, PeriodicError::OneCell { cell: 0, .. }),
            "{one}"
        );

        let moved = |change: &dyn Fn(&mut Vec3)| {
            let mut topology = plain.topology().clone();
            topology.points.iter_mut().for_each(change);
            let mesh = Mesh::new(topology).unwrap();
            mesh.with_periodic(&[pair("x-min", "x-max")]).unwrap_err()
        };
        let sheared = moved(&|point| point.x += 0.1 * point.z);
        assert!(
            matches!(sheared, PeriodicError::Leans { axis: 'x', .. }),
            "{sheared}"
        );
        // Layers between z = 0 and 50 mm at other heights on one side than on the other.
        let unmatched = moved(&|point| {
            let inside = point.z > 1e-9 && point.z < 0.05 - 1e-9;
            if inside && point.x > 0.03 - 1e-9 {
                point.z += 1e-3;
            }
        });
        let PeriodicError::Unmatched { distance, .. } = unmatched else {
            panic!("{unmatched}");
        };
        assert!((distance - 0.5e-3).abs() < 1e-9, "{distance}");
    }
}
