//! Walls that LIGGGHTS does not have as such, as triangles: cylinders and cones become prisms and frustums of
//! many sides, planes that lie across the axes or move become the polygon in which they cut the domain.

use std::f64::consts::PI;

use calcine_coupler::motion::{Contacts, Wall, WallMotion, WallShape};
use calcine_coupler::physics::Vec3;

/// Largest distance of a facet from the round surface, in radii of the smallest sphere.
pub const DEVIATION: f64 = 2e-4;
/// Most and fewest sides of a round wall.
const SIDES: [f64; 2] = [180.0, 1440.0];
/// A facet is at most so many times as long as it is wide; LIGGGHTS refuses slivers.
const SLENDER: f64 = 20.0;
/// How far beyond the domain's faces walls reach, as a share of its diagonal.
const MARGIN: f64 = 0.005;

/// Whether a surface moves within itself, so that its triangles may stay while only its speed acts.
pub fn within_itself(wall: &Wall) -> bool {
    let along = |a: &Vec3, b: &Vec3| a.cross(b).norm() <= 1e-9 * a.norm() * b.norm();
    match (&wall.shape, &wall.motion) {
        (_, WallMotion::Still) | (WallShape::Mesh { .. }, _) => false,
        (WallShape::Plane { normal, .. }, WallMotion::Translating(velocity)) => {
            velocity.dot(normal).abs() <= 1e-9 * velocity.norm()
        }
        (WallShape::Cylinder { axis, .. }, WallMotion::Translating(velocity)) => {
            along(axis, velocity)
        }
        (WallShape::Cone { .. }, WallMotion::Translating(_))
        | (
            _,
            WallMotion::Scheduled { .. }
            | WallMotion::Oscillating { .. }
            | WallMotion::Servo { .. },
        ) => false,
        (
            shape,
            WallMotion::Rotating {
                point,
                angular_velocity,
            },
        ) => match shape {
            WallShape::Plane { normal, .. } => along(normal, angular_velocity),
            WallShape::Cylinder {
                point: on_axis,
                axis,
                ..
            } => along(axis, angular_velocity) && along(axis, &(on_axis - point)),
            WallShape::Cone { ends, .. } => {
                let axis = ends[1] - ends[0];
                along(&axis, angular_velocity) && along(&axis, &(ends[0] - point))
            }
            WallShape::Mesh { .. } => false,
        },
    }
}

/// True where LIGGGHTS has the wall itself: planes across an axis and cylinders along one, at rest.
pub fn is_primitive(wall: &Wall) -> bool {
    let along = |direction: &Vec3| direction.iter().any(|value| value.abs() == 1.0);
    wall.motion == WallMotion::Still
        && match &wall.shape {
            WallShape::Plane { normal, .. } => along(normal),
            WallShape::Cylinder { axis, .. } => along(axis),
            WallShape::Cone { .. } | WallShape::Mesh { .. } => false,
        }
}

/// The triangles of a wall that LIGGGHTS does not have itself; `radius` is that of the smallest sphere in m.
pub fn of(wall: &Wall, contacts: &Contacts, radius: f64) -> Vec<[Vec3; 3]> {
    let (low, high) = contacts.bounds;
    let beyond = MARGIN * (high - low).norm();
    // Along periodic directions a wall ends at the planes, where its image goes on.
    let margin = Vec3::from_fn(|axis, _| match contacts.periodicity.axes[axis] {
        Some(_) => 0.0,
        None => beyond,
    });
    let bounds = (low - margin, high + margin);
    match &wall.shape {
        WallShape::Mesh { triangles } => triangles.clone(),
        WallShape::Plane { point, normal } => polygon(*point, *normal, bounds),
        WallShape::Cylinder {
            point,
            axis,
            radius: across,
        } => {
            let corners = (0..8).map(|k| corner(bounds, k));
            let heights: Vec<f64> = corners.map(|at| (at - point).dot(axis)).collect();
            let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let most = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let ends = [least, most].map(|height| point + height * axis);
            frustum(ends, [*across; 2], radius)
        }
        WallShape::Cone { ends, radii } => frustum(*ends, *radii, radius),
    }
}

fn corner((low, high): (Vec3, Vec3), k: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| {
        if k >> axis & 1 == 0 {
            low[axis]
        } else {
            high[axis]
        }
    })
}

/// Two directions across a third.
fn across(direction: &Vec3) -> [Vec3; 2] {
    let helper = if direction.x.abs() < 0.5 {
        Vec3::x()
    } else {
        Vec3::y()
    };
    let first = direction.cross(&helper).normalize();
    [first, direction.cross(&first).normalize()]
}

/// The polygon in which a plane cuts a box, cut into triangles: a large square, clipped by each side of the box.
fn polygon(point: Vec3, normal: Vec3, (low, high): (Vec3, Vec3)) -> Vec<[Vec3; 3]> {
    let middle = 0.5 * (low + high);
    let centre = middle - (middle - point).dot(&normal) * normal;
    let reach = 2.0 * (high - low).norm();
    let [u, v] = across(&normal).map(|direction| direction * reach);
    let mut corners = vec![centre + u, centre + v, centre - u, centre - v];
    for axis in 0..3 {
        for (side, limit) in [(1.0, high[axis]), (-1.0, -low[axis])] {
            corners = clipped(&corners, |at| side * at[axis] - limit);
        }
    }
    let Some((&first, rest)) = corners.split_first() else {
        return Vec::new();
    };
    let fan = rest.windows(2).map(|pair| [first, pair[0], pair[1]]);
    fan.filter(|triangle| area(triangle) > 0.0).collect()
}

/// What of a polygon has no positive distance (Sutherland and Hodgman).
fn clipped(corners: &[Vec3], distance: impl Fn(&Vec3) -> f64) -> Vec<Vec3> {
    let mut kept = Vec::new();
    for (k, here) in corners.iter().enumerate() {
        let next = &corners[(k + 1) % corners.len()];
        let (a, b) = (distance(here), distance(next));
        if a <= 0.0 {
            kept.push(*here);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            kept.push(here + a / (a - b) * (next - here));
        }
    }
    kept
}

fn area([a, b, c]: &[Vec3; 3]) -> f64 {
    0.5 * (b - a).cross(&(c - a)).norm()
}

/// Sides of a round wall of a radius in m: the sagitta of a chord, R (1 − cos(π/n)), is shared by inside and outside.
fn sides(radius: f64, smallest: f64) -> usize {
    let sagitta = (2.0 * DEVIATION * smallest / radius).min(1.0);
    let sides = (PI / (1.0 - sagitta).acos()).ceil();
    sides.clamp(SIDES[0], SIDES[1]) as usize
}

/// By how many degrees neighbouring facets of a round wall are turned against each other; none for flat ones.
pub fn bend(wall: &Wall, smallest: f64) -> Option<f64> {
    let radius = match &wall.shape {
        WallShape::Cylinder { radius, .. } => *radius,
        WallShape::Cone { radii, .. } => radii[0].max(radii[1]),
        WallShape::Plane { .. } | WallShape::Mesh { .. } => return None,
    };
    Some(360.0 / sides(radius, smallest) as f64)
}

/// A frustum of so many sides that no facet is farther from the round surface than it may be; half of each is
/// inside, half outside.
fn frustum(ends: [Vec3; 2], radii: [f64; 2], smallest: f64) -> Vec<[Vec3; 3]> {
    let widest = radii[0].max(radii[1]);
    let sides = sides(widest, smallest);
    let outward = 2.0 / (1.0 + (PI / sides as f64).cos());
    let axis = ends[1] - ends[0];
    let [u, v] = across(&axis.normalize());
    let slant = axis.norm().hypot(radii[1] - radii[0]);
    let width = 2.0 * PI * widest / sides as f64;
    let rings = (slant / (SLENDER * width)).ceil().max(1.0) as usize;
    let at = |ring: usize, side: usize| {
        let share = ring as f64 / rings as f64;
        let radius = outward * (radii[0] + share * (radii[1] - radii[0]));
        // Equal sides have equal bits: the last is the first.
        let angle = 2.0 * PI * (side % sides) as f64 / sides as f64;
        ends[0] + share * axis + radius * (angle.cos() * u + angle.sin() * v)
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for side in 0..sides {
            let [a, b] = [at(ring, side), at(ring, side + 1)];
            let [c, d] = [at(ring + 1, side), at(ring + 1, side + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    triangles.retain(|triangle| area(triangle) > 1e-12 * width * width);
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contacts() -> Contacts {
        Contacts {
            step: 1e-6,
            gravity: Vec3::zeros(),
            bounds: (Vec3::zeros(), Vec3::new(0.1, 0.2, 0.3)),
            lost: Default::default(),
            periodicity: Default::default(),
            materials: Vec::new(),
            material_of: Vec::new(),
            held: Vec::new(),
            law: calcine_coupler::motion::ContactLaw {
                force: calcine_coupler::motion::ContactForce::HertzMindlin,
                attractive_damping: true,
                rolling: Default::default(),
                cohesion: Default::default(),
            },
            pairs: Vec::new(),
            walls: Vec::new(),
        }
    }

    fn wall(shape: WallShape, motion: WallMotion) -> Wall {
        Wall {
            name: "wall".into(),
            material: 0,
            shape,
            motion,
        }
    }

    #[test]
    fn a_plane_becomes_the_polygon_in_which_it_cuts_the_domain() {
        let normal = Vec3::new(1.0, 0.0, 1.0).normalize();
        let point = Vec3::new(0.05, 0.1, 0.1);
        let plane = wall(WallShape::Plane { point, normal }, WallMotion::Still);
        let triangles = of(&plane, &contacts(), 1e-3);
        let on_it = triangles.iter().flatten();
        assert!(
            on_it
                .map(|at| (at - point).dot(&normal).abs())
                .fold(0.0, f64::max)
                < 1e-15
        );
        // It runs across the width at 45 degrees: √2 times the section's area, margins included.
        let margin = MARGIN * (0.01f64 + 0.04 + 0.09).sqrt();
        let sides = (0.1 + 2.0 * margin) * (0.2 + 2.0 * margin);
        let found: f64 = triangles.iter().map(area).sum();
        assert!(
            (found / (2f64.sqrt() * sides) - 1.0).abs() < 1e-12,
            "{found}"
        );
    }

    #[test]
    fn facets_of_round_walls_keep_within_their_distance() {
        let ends = [Vec3::new(0.05, 0.1, 0.02), Vec3::new(0.06, 0.12, 0.2)];
        let radii = [0.01, 0.04];
        let cone = wall(WallShape::Cone { ends, radii }, WallMotion::Still);
        let triangles = of(&cone, &contacts(), 1e-3);
        let axis = (ends[1] - ends[0]).normalize();
        let length = (ends[1] - ends[0]).norm();
        let mut worst = [0.0f64; 2];
        for [a, b, c] in &triangles {
            for at in [
                *a,
                *b,
                *c,
                (a + b) / 2.0,
                (b + c) / 2.0,
                (a + c) / 2.0,
                (a + b + c) / 3.0,
            ] {
                let height = (at - ends[0]).dot(&axis);
                let out = (at - ends[0] - height * axis).norm();
                let off = out - (0.01 + 0.03 * height / length);
                worst = [worst[0].max(off), worst[1].max(-off)];
            }
        }
        assert!(
            worst.iter().all(|off| (0.04e-6..0.2001e-6).contains(off)),
            "{worst:?}"
        );
        // The lateral area of a frustum is π (r₁ + r₂) s.
        let found: f64 = triangles.iter().map(area).sum();
        let wanted = PI * 0.05 * length.hypot(0.03);
        assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
    }

    #[test]
    fn what_turns_about_its_own_axis_moves_within_itself() {
        let drum = |axis: Vec3, point: Vec3| {
            let motion = WallMotion::Rotating {
                point,
                angular_velocity: Vec3::y() * 2.0,
            };
            let shape = WallShape::Cylinder {
                point: Vec3::zeros(),
                axis,
                radius: 0.05,
            };
            within_itself(&wall(shape, motion))
        };
        assert!(drum(Vec3::y(), Vec3::y() * 7.0));
        assert!(!drum(Vec3::y(), Vec3::x()));
        assert!(!drum(Vec3::x(), Vec3::zeros()));
        let belt = |velocity: Vec3| {
            let shape = WallShape::Plane {
                point: Vec3::zeros(),
                normal: Vec3::z(),
            };
            within_itself(&wall(shape, WallMotion::Translating(velocity)))
        };
        assert!(belt(Vec3::new(1.0, 2.0, 0.0)));
        assert!(!belt(Vec3::new(1.0, 2.0, 0.1)));
    }
}
