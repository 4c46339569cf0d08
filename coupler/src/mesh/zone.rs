//! Parts of space by which cells are chosen.

use calcine_physics::Vec3;

use super::Mesh;

/// A part of space; its surface belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Zone {
    /// A box along the axes.
    Box {
        /// Corner with the smallest coordinates in m.
        low: Vec3,
        /// Corner with the largest coordinates in m.
        high: Vec3,
    },
    /// A cylinder of any direction.
    Cylinder {
        /// Centre of one end in m.
        from: Vec3,
        /// Centre of the other end in m.
        to: Vec3,
        /// Radius in m.
        radius: f64,
    },
}

impl Zone {
    /// Whether a point (m) lies in it.
    pub fn holds(&self, point: Vec3) -> bool {
        match *self {
            Self::Box { low, high } => {
                (0..3).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis])
            }
            Self::Cylinder { from, to, radius } => {
                let axis = to - from;
                let along = (point - from).dot(&axis) / axis.norm_squared();
                let off = point - (from + along * axis);
                (0.0..=1.0).contains(&along) && off.norm_squared() <= radius * radius
            }
        }
    }

    /// Whether the straight line between two points (m) meets it.
    pub fn meets(&self, [from, to]: [Vec3; 2]) -> bool {
        let way = to - from;
        let within = match *self {
            Self::Box { low, high } => (0..3)
                .map(|axis| between(from[axis], way[axis], [low[axis], high[axis]]))
                .try_fold([0.0, 1.0], common),
            Self::Cylinder {
                from: end,
                to: other,
                radius,
            } => {
                let length = (other - end).norm();
                let axis = (other - end) / length;
                let [along, step] = [from - end, way].map(|one| one.dot(&axis));
                let [off, aside] = [from - end - along * axis, way - step * axis];
                let ends = between(along, step, [0.0, length]);
                common([0.0, 1.0], ends)
                    .and_then(|span| common(span, in_circle(off, aside, radius)))
            }
        };
        within.is_some()
    }

    /// Corners in m of the smallest box along the axes that holds it.
    pub fn bounds(&self) -> [Vec3; 2] {
        match *self {
            Self::Box { low, high } => [low, high],
            Self::Cylinder { from, to, radius } => {
                let axis = (to - from).normalize();
                let across = axis.map(|one| radius * (1.0 - one * one).max(0.0).sqrt());
                [from.inf(&to) - across, from.sup(&to) + across]
            }
        }
    }

    /// Marks the cells whose centres lie in one of several zones.
    pub fn cells(zones: &[Zone], mesh: &Mesh) -> Vec<bool> {
        let centres = mesh.cell_centre().iter();
        centres
            .map(|&centre| zones.iter().any(|zone| zone.holds(centre)))
            .collect()
    }
}

/// Nowhere on a line.
const NOWHERE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Everywhere on a line.
const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The values t, from the first to the last, for which start + t step lies between two bounds.
fn between(start: f64, step: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    if step == 0.0 {
        return if (low..=high).contains(&start) {
            EVERYWHERE
        } else {
            NOWHERE
        };
    }
    let [a, b] = [low, high].map(|bound| (bound - start) / step);
    [a.min(b), a.max(b)]
}

/// The values t for which |off + t aside| is at most a radius.
fn in_circle(off: Vec3, aside: Vec3, radius: f64) -> [f64; 2] {
    let square = aside.norm_squared();
    let lacks = radius * radius - off.norm_squared();
    if square == 0.0 {
        return if lacks >= 0.0 { EVERYWHERE } else { NOWHERE };
    }
    let half = off.dot(&aside) / square;
    let below = half * half + lacks / square;
    if below < 0.0 {
        return NOWHERE;
    }
    [-half - below.sqrt(), -half + below.sqrt()]
}

/// What two spans of a line have in common.
fn common([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Option<[f64; 2]> {
    let [low, high] = [a.max(c), b.min(d)];
    (low <= high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanted_cylinder_holds_what_is_near_its_axis_between_its_ends() {
        let zone = Zone::Cylinder {
            from: Vec3::new(1.0, 1.0, 0.0),
            to: Vec3::new(4.0, 5.0, 0.0),
            radius: 0.5,
        };
        assert!(zone.holds(Vec3::new(2.5, 3.0, 0.4)));
        assert!(zone.holds(Vec3::new(2.5 - 0.36, 3.0 + 0.27, 0.0)));
        assert!(!zone.holds(Vec3::new(2.5, 3.0, 0.6)));
        assert!(!zone.holds(Vec3::new(0.9, 0.9, 0.0)));
        let [low, high] = zone.bounds();
        assert!((low - Vec3::new(0.6, 0.7, -0.5)).norm() < 1e-15, "{low}");
        assert!((high - Vec3::new(4.4, 5.3, 0.5)).norm() < 1e-15, "{high}");
    }

    #[test]
    fn lines_meet_zones_between_their_ends_alone() {
        let point = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let box_ = Zone::Box {
            low: point(0.0, 0.0, 0.0),
            high: point(1.0, 1.0, 0.1),
        };
        let pipe = Zone::Cylinder {
            from: point(0.5, 0.5, 0.0),
            to: point(0.5, 0.5, 0.1),
            radius: 0.5,
        };
        for zone in [box_, pipe] {
            // Straight through, along a face, from inside, and a point.
            assert!(zone.meets([point(0.5, 0.5, 1.0), point(0.5, 0.5, -1.0)]));
            assert!(zone.meets([point(0.5, 0.5, 0.1), point(2.0, 0.5, 0.1)]));
            assert!(zone.meets([point(0.5, 0.4, 0.05), point(9.0, 9.0, 9.0)]));
            assert!(zone.meets([point(0.5, 0.4, 0.05); 2]));
            // Not so far, beside it, and past its edge.
            assert!(!zone.meets([point(0.5, 0.5, 1.0), point(0.5, 0.5, 0.11)]));
            assert!(!zone.meets([point(1.2, 0.5, 1.0), point(1.2, 0.5, -1.0)]));
            assert!(!zone.meets([point(0.9, 0.5, 0.3), point(1.4, 0.5, -0.1)]));
            assert!(!zone.meets([point(0.5, 0.5, 0.2); 2]));
        }
        // A corner of the box that the pipe does not fill.
        let corner = [point(0.05, 0.05, 1.0), point(0.05, 0.05, -1.0)];
        assert!(box_.meets(corner) && !pipe.meets(corner));
    }
}
