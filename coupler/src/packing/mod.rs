//! Packed beds to start from: random packings by geometry alone, and regular stackings.

mod random;
pub mod regular;
mod relax;

use std::f64::consts::{FRAC_PI_4, PI};

use calcine_physics::Vec3;
use thiserror::Error;

use random::SplitMix64;

/// Most spheres of one packing.
const MOST: usize = 10_000_000;

/// Spheres at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Packing {
    /// Centres in m.
    pub centres: Vec<Vec3>,
    /// Diameters in m.
    pub diameters: Vec<f64>,
    /// Height of the filled space above its bottom, in m.
    pub height: f64,
}

impl Packing {
    /// Volume of all spheres in m³.
    pub fn volume(&self) -> f64 {
        self.diameters.iter().copied().map(sphere).sum()
    }
}

/// Diameters of the spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// One diameter in m.
    Equal(f64),
    /// Diameters in m, each with its share of the number of spheres.
    Mixture(Vec<(f64, f64)>),
    /// Uniform distribution by number between two diameters in m.
    Between(f64, f64),
}

/// How far a container is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fill {
    /// Up to a height in m; the number follows from the solid fraction.
    Height(f64),
    /// With a number of spheres; the height follows from the solid fraction.
    Number(usize),
}

/// A random packing. The filled space has a flat bottom and top, which spheres touch from inside.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomSpec {
    /// Diameters of the spheres.
    pub sizes: Sizes,
    /// Extent of the filled space.
    pub fill: Fill,
    /// Volume of spheres over the filled space, layers at the walls included.
    pub solid_fraction: f64,
    /// Equal seeds give equal packings, bit for bit.
    pub seed: u64,
}

/// A packing that cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PackingError {
    /// A number that has no meaning.
    #[error("the packing's {what} is {value}; it needs {need}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value in SI units.
        value: f64,
        /// What it may be.
        need: &'static str,
    },
    /// Spheres that overlap still.
    #[error(
        "{count} spheres cannot be packed at a solid fraction of {target}: {reached:.4} was reached \
         without overlap; lower the solid fraction"
    )]
    Fraction {
        /// Number of spheres.
        count: usize,
        /// Wanted solid fraction.
        target: f64,
        /// Solid fraction with the spheres shrunk until none overlap.
        reached: f64,
    },
}

/// Horizontal section of the filled space.
#[derive(Clone, Copy, Debug)]
enum Section {
    Disc { diameter: f64 },
    Rectangle { size: [f64; 2] },
}

/// The filled space: `origin` is the centre of a disc's bottom, or a box's lowest corner, in m.
#[derive(Clone, Copy, Debug)]
struct Container {
    origin: Vec3,
    section: Section,
    height: f64,
}

impl Container {
    fn area(&self) -> f64 {
        match self.section {
            Section::Disc { diameter } => FRAC_PI_4 * diameter * diameter,
            Section::Rectangle { size } => size[0] * size[1],
        }
    }

    /// Width of the narrowest extent in m.
    fn width(&self) -> f64 {
        let across = match self.section {
            Section::Disc { diameter } => diameter,
            Section::Rectangle { size } => size[0].min(size[1]),
        };
        across.min(self.height)
    }

    /// Lowest corner and edges of the box around it, in m.
    fn bounds(&self) -> (Vec3, Vec3) {
        match self.section {
            Section::Disc { diameter } => (
                self.origin - Vec3::new(0.5 * diameter, 0.5 * diameter, 0.0),
                Vec3::new(diameter, diameter, self.height),
            ),
            Section::Rectangle { size } => (self.origin, Vec3::new(size[0], size[1], self.height)),
        }
    }

    /// The nearest place at which a sphere of this radius is inside.
    fn inside(&self, mut centre: Vec3, radius: f64) -> Vec3 {
        let low = self.origin.z + radius;
        centre.z = centre.z.min(self.origin.z + self.height - radius).max(low);
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
                for (axis, size) in size.into_iter().enumerate() {
                    let low = self.origin[axis] + radius;
                    let high = self.origin[axis] + size - radius;
                    centre[axis] = centre[axis].min(high).max(low);
                }
            }
        }
        centre
    }

    /// A place in it, uniformly distributed.
    fn place(&self, random: &mut SplitMix64, radius: f64) -> Vec3 {
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

/// A random packing in an upright cylinder; `origin` is the centre of its bottom, in m.
pub fn random_in_cylinder(
    origin: Vec3,
    diameter: f64,
    spec: &RandomSpec,
) -> Result<Packing, PackingError> {
    positive("cylinder diameter", diameter)?;
    fill(origin, Section::Disc { diameter }, spec)
}

/// A random packing in a box of a horizontal section `size`; `origin` is its lowest corner, in m.
pub fn random_in_box(
    origin: Vec3,
    size: [f64; 2],
    spec: &RandomSpec,
) -> Result<Packing, PackingError> {
    positive("box width", size[0])?;
    positive("box width", size[1])?;
    fill(origin, Section::Rectangle { size }, spec)
}

fn fill(origin: Vec3, section: Section, spec: &RandomSpec) -> Result<Packing, PackingError> {
    let mut random = SplitMix64(spec.seed);
    check(spec)?;
    let height = match spec.fill {
        Fill::Height(height) => height,
        Fill::Number(_) => f64::INFINITY,
    };
    let mut container = Container {
        origin,
        section,
        height,
    };
    let diameters = draw(spec, container.area() * height, &mut random)?;
    let volume: f64 = diameters.iter().copied().map(sphere).sum();
    if let Fill::Number(_) = spec.fill {
        container.height = volume / (spec.solid_fraction * container.area());
    }
    if diameters.iter().any(|&d| d > container.width()) {
        return Err(PackingError::Value {
            what: "narrowest width in m",
            value: container.width(),
            need: "at least the largest diameter",
        });
    }
    let radii: Vec<f64> = diameters.iter().map(|d| 0.5 * d).collect();
    let mut centres: Vec<Vec3> = radii
        .iter()
        .map(|&radius| container.place(&mut random, radius))
        .collect();
    let overlap = relax::relax(&container, &radii, &mut centres);
    if overlap > 0.0 {
        return Err(PackingError::Fraction {
            count: centres.len(),
            target: spec.solid_fraction,
            reached: volume / (container.area() * container.height) * (1.0 - overlap).powi(3),
        });
    }
    Ok(Packing {
        centres,
        diameters,
        height: container.height,
    })
}

fn check(spec: &RandomSpec) -> Result<(), PackingError> {
    if !(spec.solid_fraction > 0.0 && spec.solid_fraction < 0.75) {
        return Err(PackingError::Value {
            what: "solid fraction",
            value: spec.solid_fraction,
            need: "a number between 0 and 0.75",
        });
    }
    match &spec.sizes {
        Sizes::Equal(diameter) => positive("diameter", *diameter)?,
        Sizes::Between(low, high) => {
            positive("smallest diameter", *low)?;
            positive("range of diameters", high - low)?;
        }
        Sizes::Mixture(parts) => {
            positive("number of diameters", parts.len() as f64)?;
            for &(diameter, share) in parts {
                positive("diameter", diameter)?;
                positive("share of a diameter", share)?;
            }
        }
    }
    match spec.fill {
        Fill::Height(height) => positive("height", height),
        Fill::Number(count) => positive("number of spheres", count as f64),
    }
}

fn positive(what: &'static str, value: f64) -> Result<(), PackingError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    let need = "a number above 0";
    Err(PackingError::Value { what, value, need })
}

/// Diameters in m of all spheres: as many as asked for, or as come nearest to the solid volume.
fn draw(spec: &RandomSpec, space: f64, random: &mut SplitMix64) -> Result<Vec<f64>, PackingError> {
    let wanted = spec.solid_fraction * space;
    let (mut diameters, mut volume) = (Vec::new(), 0.0);
    loop {
        let diameter = spec.sizes.draw(random);
        let done = match spec.fill {
            Fill::Number(count) => diameters.len() == count,
            Fill::Height(_) => volume + 0.5 * sphere(diameter) > wanted,
        };
        if done {
            break;
        }
        if diameters.len() == MOST {
            return Err(PackingError::Value {
                what: "number of spheres",
                value: MOST as f64 + 1.0,
                need: "at most 1e7",
            });
        }
        volume += sphere(diameter);
        diameters.push(diameter);
    }
    Ok(diameters)
}

impl Sizes {
    fn draw(&self, random: &mut SplitMix64) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Between(low, high) => low + (high - low) * random.unit(),
            Self::Mixture(parts) => {
                let total: f64 = parts.iter().map(|part| part.1).sum();
                let mut left = total * random.unit();
                let mut drawn = 0.0;
                for &(diameter, share) in parts {
                    drawn = diameter;
                    if left < share {
                        break;
                    }
                    left -= share;
                }
                drawn
            }
        }
    }
}

/// Volume of a sphere in m³.
fn sphere(diameter: f64) -> f64 {
    PI / 6.0 * diameter.powi(3)
}
