//! Impacts of parcels on walls.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::WallMotion;
use calcine_coupler::parcels::{ParcelImpact, ParcelMotion, ParcelWall};
use calcine_coupler::physics::Vec3;

use super::error::ParcelError;

/// The wall of each boundary face.
#[derive(Clone, Debug)]
pub struct WallFaces {
    walls: Vec<ParcelWall>,
    /// Index of the wall of each boundary face; `u32::MAX` of periodic ones.
    of_face: Vec<u32>,
    internal: usize,
}

impl WallFaces {
    /// The walls of a motion on the faces of a mesh; each patch that is not periodic needs one.
    pub fn new(mesh: &Mesh, motion: &ParcelMotion) -> Result<Self, ParcelError> {
        let internal = mesh.internal_faces();
        let mut of_face = vec![u32::MAX; mesh.faces() - internal];
        for (index, wall) in motion.walls.iter().enumerate() {
            let patch = mesh.patch(&wall.patch);
            let Some(patch) = patch.filter(|patch| mesh.partner(patch).is_none()) else {
                let patch = wall.patch.clone();
                return Err(ParcelError::NoPatch { patch });
            };
            if !matches!(
                wall.motion,
                WallMotion::Still | WallMotion::Translating(_) | WallMotion::Rotating { .. }
            ) {
                let patch = wall.patch.clone();
                return Err(ParcelError::WallMoves { patch });
            }
            for face in patch.faces() {
                of_face[face - internal] = index as u32;
            }
        }
        for patch in mesh.patches() {
            let first = patch.faces().next();
            let bare = first.is_some_and(|face| of_face[face - internal] == u32::MAX);
            if bare && mesh.partner(patch).is_none() {
                let patch = patch.name.clone();
                return Err(ParcelError::NoWall { patch });
            }
        }
        Ok(Self {
            walls: motion.walls.clone(),
            of_face,
            internal,
        })
    }

    /// The coefficient of friction of a boundary face with a population.
    pub fn friction(&self, face: usize, population: usize) -> f64 {
        let wall = &self.walls[self.of_face[face - self.internal] as usize];
        wall.impact[population].friction
    }

    /// The impact of a population on a boundary face at a place: its properties, and the wall's velocity along itself.
    pub fn at(
        &self,
        face: usize,
        population: u32,
        place: Vec3,
        normal: Vec3,
    ) -> (ParcelImpact, Vec3) {
        let wall = &self.walls[self.of_face[face - self.internal] as usize];
        let along = self.velocity(face, place, normal);
        (wall.impact[population as usize], along)
    }

    /// The velocity of the wall of a boundary face at a place along itself, in m/s.
    pub fn velocity(&self, face: usize, place: Vec3, normal: Vec3) -> Vec3 {
        let wall = &self.walls[self.of_face[face - self.internal] as usize];
        let velocity = moving(&wall.motion, place);
        velocity - velocity.dot(&normal) * normal
    }
}

/// The velocity in m/s of a body that moves with a wall, at a place in m.
pub fn moving(motion: &WallMotion, place: Vec3) -> Vec3 {
    match motion {
        WallMotion::Translating(velocity) => *velocity,
        WallMotion::Rotating {
            point,
            angular_velocity,
        } => angular_velocity.cross(&(place - point)),
        _ => Vec3::zeros(),
    }
}

/// The velocity after an impact on a wall with the unit normal n out of the domain, in m/s: that along n is reversed times the
/// restitution, and friction takes from the slip along the wall at most μ times the change along n. A parcel does not spin.
pub fn rebound(velocity: Vec3, normal: Vec3, impact: ParcelImpact, wall: Vec3) -> Vec3 {
    let slip = velocity - wall;
    let towards = slip.dot(&normal);
    if towards <= 0.0 {
        return velocity;
    }
    let change = (1.0 + impact.restitution) * towards;
    let along = slip - towards * normal;
    let speed = along.norm();
    let lost = (impact.friction * change).min(speed);
    let rubbed = if speed > 0.0 {
        lost / speed * along
    } else {
        Vec3::zeros()
    };
    velocity - change * normal - rubbed
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: Vec3 = Vec3::new(0.0, 0.0, -1.0);

    fn impact(restitution: f64, friction: f64) -> ParcelImpact {
        ParcelImpact {
            restitution,
            friction,
        }
    }

    #[test]
    fn an_impact_reverses_the_normal_velocity_and_friction_is_limited_by_it() {
        let fast = Vec3::new(3.0, 0.0, -1.0);
        let after = rebound(fast, FLOOR, impact(0.6, 0.25), Vec3::zeros());
        assert!((after - Vec3::new(2.6, 0.0, 0.6)).norm() < 1e-15);
        let slow = Vec3::new(0.1, -0.1, -1.0);
        let after = rebound(slow, FLOOR, impact(0.6, 0.25), Vec3::zeros());
        assert!((after - Vec3::new(0.0, 0.0, 0.6)).norm() < 1e-15);
    }

    #[test]
    fn a_wall_that_moves_carries_along_and_one_that_is_left_does_nothing() {
        let belt = Vec3::new(2.0, 0.0, 0.0);
        let after = rebound(Vec3::new(0.0, 0.0, -1.0), FLOOR, impact(0.0, 0.5), belt);
        assert!((after - Vec3::new(0.5, 0.0, 0.0)).norm() < 1e-15);
        let leaving = Vec3::new(0.0, 0.0, 1.0);
        assert_eq!(rebound(leaving, FLOOR, impact(0.5, 0.5), belt), leaving);
    }
}
