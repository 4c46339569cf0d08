//! Particles at the start below which no wall keeps them in the gas mesh.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::motion::{Contacts, LostParticles, WallShape};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;

use super::model::Case;
use super::span;
use super::units::shown;

/// Particles that are looked at, evenly among all.
const LOOKED_AT: usize = 64;
/// Places along a fall at which outlets are looked for.
const PLACES: usize = 200;

/// Warns of a particle under which no wall lies, where it falls out of the mesh within the run.
pub(super) fn out_of_the_mesh(
    case: &Case,
    mesh: &Mesh,
    setup: &ParticleSetup,
    contacts: &Contacts,
) -> Option<String> {
    let gravity = contacts.gravity.norm();
    let down = contacts.gravity.try_normalize(0.0)?;
    let periodic = contacts.periodicity.axes.iter().enumerate();
    if contacts.lost == LostParticles::TakeOut
        || periodic
            .clone()
            .any(|(axis, span)| span.is_some() && down[axis] != 0.0)
    {
        return None;
    }
    let free = |row: &usize| !contacts.held[setup.population[*row] as usize];
    let rows: Vec<usize> = (0..setup.id.len()).filter(free).collect();
    let step = rows.len().div_ceil(LOOKED_AT).max(1);
    let open = |row: &usize| {
        let from = setup.position[*row];
        !contacts
            .walls
            .iter()
            .any(|wall| stops(&wall.shape, from, down))
    };
    let mut unkept = rows.into_iter().step_by(step).filter(open).peekable();
    unkept.peek()?;
    let locator = Locator::new(mesh);
    let [low, high] = mesh.bounds();
    let across = (high - low).norm();
    let end = span::motion_time(&case.time, [0.0, case.time.end.seconds()]);
    let row = unkept.find(|&row| {
        let centre = setup.position[row];
        let along = |share: f64| centre + share * across * down;
        let places = (0..=PLACES).map(|k| along(k as f64 / PLACES as f64));
        let mut depth = 0;
        for place in places.take_while(|place| locator.cell_at(*place).is_some()) {
            if case.outlets.iter().any(|outlet| outlet.zone.holds(place)) {
                return false;
            }
            depth += 1;
        }
        let fall = f64::from(depth) / PLACES as f64 * across;
        (2.0 * fall / gravity).sqrt() < end
    })?;
    let [x, y, z] = [0, 1, 2].map(|axis| shown(setup.position[row][axis]));
    Some(format!(
        "no wall lies below particle {} of `{}` at ({x}, {y}, {z}) m: where the gas does not carry it, it falls out of the mesh, which ends the \
         run; add a wall (`walls.patches` takes patches of the mesh), an outlet, or motion.lost = \"take-out\"",
        setup.id[row], case.particles[setup.population[row] as usize].name
    ))
}

/// True where a wall is met on the way from a place along a direction.
fn stops(shape: &WallShape, from: Vec3, along: Vec3) -> bool {
    match shape {
        WallShape::Plane { normal, .. } => along.dot(normal) < 0.0,
        WallShape::Cylinder { axis, .. } => along.cross(axis).norm() > 1e-6,
        WallShape::Cone { ends, radii } => {
            let axis = ends[1] - ends[0];
            let length = axis.norm();
            let axis = axis / length;
            if along.cross(&axis).norm() > 1e-6 {
                return true;
            }
            // Along the axis: the wall is met where the cone becomes narrower than the way is off its axis.
            let at = (from - ends[0]).dot(&axis);
            let off = (from - ends[0] - at * axis).norm();
            let ahead = usize::from(along.dot(&axis) > 0.0);
            off > radii[ahead]
        }
        WallShape::Mesh { triangles } => triangles.iter().any(|one| crosses(one, from, along)),
    }
}

/// True where a ray meets a triangle, its edges included (Möller and Trumbore, J. Graphics Tools 2 (1997) 21).
fn crosses(corners: &[Vec3; 3], from: Vec3, along: Vec3) -> bool {
    const EDGE: f64 = 1e-9;
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let p = along.cross(&e2);
    let determinant = e1.dot(&p);
    if determinant.abs() <= f64::MIN_POSITIVE {
        return false;
    }
    let t = from - corners[0];
    let u = t.dot(&p) / determinant;
    let q = t.cross(&e1);
    let v = along.dot(&q) / determinant;
    let distance = e2.dot(&q) / determinant;
    u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE && distance >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_what_lies_ahead_of_it() {
        let down = -Vec3::z();
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let triangle = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0)];
        assert!(crosses(&triangle, at(0.2, 0.2, 1.0), down));
        assert!(crosses(&triangle, at(0.5, 0.5, 1.0), down), "at an edge");
        assert!(!crosses(&triangle, at(0.6, 0.6, 1.0), down));
        assert!(!crosses(&triangle, at(0.2, 0.2, -1.0), down), "behind");
        let cone = WallShape::Cone {
            ends: [at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0)],
            radii: [0.1, 0.5],
        };
        assert!(stops(&cone, at(0.3, 0.0, 0.9), down));
        assert!(!stops(&cone, at(0.05, 0.0, 0.9), down), "through the hole");
    }
}
