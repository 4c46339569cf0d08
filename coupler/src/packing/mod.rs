//! Packed beds to start from: random packings by geometry alone, and regular stackings.

mod container;
mod error;
pub(crate) mod random;
pub mod regular;
mod relax;
mod sizes;

use calcine_physics::{Vec3, sphere};

pub use error::PackingError;
pub use sizes::{Shape, Share, Sizes};

use container::{Container, Section};
use error::positive;
use random::SplitMix64;

use crate::periodicity::Periodicity;

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
        self.diameters
            .iter()
            .copied()
            .map(sphere::volume_of_diameter)
            .sum()
    }
}

/// How far a container is filled. Solid fractions are the volume of spheres over the filled space, layers at the walls
/// included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fill {
    /// Up to a height in m; the number follows from the solid fraction.
    Height {
        /// The height in m.
        height: f64,
        /// The solid fraction.
        solid_fraction: f64,
    },
    /// With a number of spheres; the height follows from the solid fraction.
    Number {
        /// Number of spheres.
        number: usize,
        /// The solid fraction.
        solid_fraction: f64,
    },
    /// With a number of spheres up to a height in m; the solid fraction follows.
    NumberToHeight {
        /// Number of spheres.
        number: usize,
        /// The height in m.
        height: f64,
    },
}

impl Fill {
    fn check(&self) -> Result<(), PackingError> {
        if let Self::Height { height, .. } | Self::NumberToHeight { height, .. } = *self {
            positive("height", height)?;
        }
        if let Self::Number { number, .. } | Self::NumberToHeight { number, .. } = *self {
            positive("number of spheres", number as f64)?;
        }
        match *self {
            Self::Height { solid_fraction, .. } | Self::Number { solid_fraction, .. } => {
                check_solid_fraction(solid_fraction)
            }
            Self::NumberToHeight { .. } => Ok(()),
        }
    }
}

fn check_solid_fraction(value: f64) -> Result<(), PackingError> {
    if value > 0.0 && value < 0.75 {
        return Ok(());
    }
    Err(PackingError::Value {
        what: "solid fraction",
        value,
        need: "a number between 0 and 0.75, by fewer or smaller spheres where their number is given",
    })
}

/// A random packing. The filled space has a flat bottom and top, which spheres touch from inside, and walls; not so where it
/// reaches from one periodic plane to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomSpec {
    /// Diameters of the spheres.
    pub sizes: Sizes,
    /// Extent of the filled space.
    pub fill: Fill,
    /// Of the places; equal seeds give equal packings, bit for bit.
    pub seed: u64,
    /// Of the diameters, where they differ.
    pub size_seed: u64,
    /// Directions in which the domain repeats itself.
    pub periodicity: Periodicity,
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
    spec.fill.check()?;
    let area = section.area();
    let diameters = draw(spec, area)?;
    let volume: f64 = diameters
        .iter()
        .copied()
        .map(sphere::volume_of_diameter)
        .sum();
    let (height, target) = match spec.fill {
        Fill::Height {
            height,
            solid_fraction,
        } => (height, solid_fraction),
        Fill::Number { solid_fraction, .. } => (volume / (solid_fraction * area), solid_fraction),
        Fill::NumberToHeight { height, .. } => (height, volume / (area * height)),
    };
    check_solid_fraction(target)?;
    let container = Container {
        origin,
        section,
        height,
        periodicity: Periodicity::default(),
    }
    .spanned(&spec.periodicity);
    let diameter = diameters.iter().copied().fold(0.0, f64::max);
    if diameter > container.width() {
        let width = container.width();
        return Err(PackingError::TooNarrow { diameter, width });
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
            target,
            reached: volume / (area * height) * (1.0 - overlap).powi(3),
        });
    }
    Ok(Packing {
        centres,
        diameters,
        height,
    })
}

/// Diameters in m of all spheres: as many as asked for, or as come nearest to the solid volume over a section of this
/// area in m².
fn draw(spec: &RandomSpec, area: f64) -> Result<Vec<f64>, PackingError> {
    let mut sampler = spec.sizes.sampler(spec.size_seed)?;
    let (mut diameters, mut volume) = (Vec::new(), 0.0);
    loop {
        let diameter = sampler.draw();
        let done = match spec.fill {
            Fill::Number { number, .. } | Fill::NumberToHeight { number, .. } => {
                diameters.len() == number
            }
            Fill::Height {
                height,
                solid_fraction,
            } => {
                let wanted = solid_fraction * (area * height);
                volume + 0.5 * sphere::volume_of_diameter(diameter) > wanted
            }
        };
        if done {
            break;
        }
        if diameters.len() == MOST {
            return Err(too_many(MOST as f64 + 1.0));
        }
        volume += sphere::volume_of_diameter(diameter);
        diameters.push(diameter);
    }
    Ok(diameters)
}

fn too_many(value: f64) -> PackingError {
    PackingError::Value {
        what: "number of spheres",
        value,
        need: "at most 1e7",
    }
}
