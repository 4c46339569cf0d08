//! The space that spheres fill.

use std::f64::consts::FRAC_PI_4;

use calcine_physics::Vec3;

use super::random::SplitMix64;
use crate::periodicity::Periodicity;

/// Round-off of lengths, as a share of them.
const ROUND_OFF: f64 = 1e-9;

/// Horizontal section of the filled space.
#[derive(Clone, Copy, Debug)]
pub(super) enum Section {
    Disc { diameter: f64 },
    Rectangle { size: [f64; 2] },
}

/// The filled space: `origin` is the centre of a disc's bottom, or a box's lowest corner, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Container {
    pub origin: Vec3,
    pub section: Section,
    pub height: f64,
    /// Directions in which it repeats itself from end to end: there spheres have no walls, but images.
    pub periodicity: Periodicity,
}

impl Section {
    /// In m².
    pub fn area(&self) -> f64 {
        match self {
            Self::Disc { diameter } => FRAC_PI_4 * diameter * diameter,
            Self::Rectangle { size } => size[0] * size[1],
        }
    }
}

impl Container {
    /// Width of the narrowest extent in m.
    pub fn width(&self) -> f64 {
        let across = match self.section {
            Section::Disc { diameter } => diameter,
            Section::Rectangle { size } => size[0].min(size[1]),
        };
        across.min(self.height)
    }

    /// Lowest corner and edges of the box around it, in m.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self.section {
            Section::Disc { diameter } => (
                self.origin - Vec3::new(0.5 * diameter, 0.5 * diameter, 0.0),
                Vec3::new(diameter, diameter, self.height),
            ),
            Section::Rectangle { size } => (self.origin, Vec3::new(size[0], size[1], self.height)),
        }
    }

    /// Of the periodic directions those along which the space reaches from plane to plane.
    pub fn spanned(self, periodicity: &Periodicity) -> Self {
        let (corner, size) = self.bounds();
        let mut spanned = *periodicity;
        for (axis, span) in spanned.axes.iter_mut().enumerate() {
            let along = axis == 2 || matches!(self.section, Section::Rectangle { .. });
            *span = span.filter(|span| {
                let off = (corner[axis] - span.low).abs() + (size[axis] - span.length()).abs();
                along && off <= ROUND_OFF * span.length()
            });
        }
        Self {
            periodicity: spanned,
            ..self
        }
    }

    /// The nearest place at which a sphere of this radius is inside.
    pub fn inside(&self, centre: Vec3, radius: f64) -> Vec3 {
        let mut centre = self.periodicity.wrap(centre);
        let has_walls = |axis: usize| self.periodicity.axes[axis].is_none();
        if has_walls(2) {
            let low = self.origin.z + radius;
            centre.z = centre.z.min(self.origin.z + self.height - radius).max(low);
        }
        match self.section {
            Section::Disc { diameter } => {
                let (x, y) = (centre.x - self.origin.x, centre.y - self.origin.y);
                let (reach, free) = (x.hypot(y), 0.5 * diameter - radius);
                if reach > free {
                    centre.x = self.origin.x + x * (free / reach);
                    centre.y = self.origin.y + y * (free / reach);
                }
            }
            Section::Rectangle { size } => {
                let walls = size.into_iter().enumerate();
                for (axis, size) in walls.filter(|(axis, _)| has_walls(*axis)) {
                    let low = self.origin[axis] + radius;
                    let high = self.origin[axis] + size - radius;
                    centre[axis] = centre[axis].min(high).max(low);
                }
            }
        }
        centre
    }

    /// A place in it, uniformly distributed.
    pub fn place(&self, random: &mut SplitMix64, radius: f64) -> Vec3 {
        let (corner, size) = self.bounds();
        loop {
            let unit = Vec3::new(random.unit(), random.unit(), random.unit());
            let place = corner + unit.component_mul(&size);
            if let Section::Disc { diameter } = self.section {
                let off = (place.x - self.origin.x).hypot(place.y - self.origin.y);
                if off > 0.5 * diameter {
                    continue;
                }
            }
            return self.inside(place, radius);
        }
    }
}
