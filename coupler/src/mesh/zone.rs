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
}
