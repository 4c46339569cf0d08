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
    /// Of the places; equal seeds give equal packings, bit for bit.
    pub seed: u64,
    /// Of the diameters, where they differ.
    pub size_seed: u64,
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
    let diameters = draw(spec, container.area() * height)?;
    let volume: f64 = diameters
        .iter()
        .copied()
        .map(sphere::volume_of_diameter)
        .sum();
    if let Fill::Number(_) = spec.fill {
        container.height = volume / (spec.solid_fraction * container.area());
    }
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
    match spec.fill {
        Fill::Height(height) => positive("height", height),
        Fill::Number(count) => positive("number of spheres", count as f64),
    }
}

/// Diameters in m of all spheres: as many as asked for, or as come nearest to the solid volume.
fn draw(spec: &RandomSpec, space: f64) -> Result<Vec<f64>, PackingError> {
    let (mut sampler, wanted) = (
        spec.sizes.sampler(spec.size_seed)?,
        spec.solid_fraction * space,
    );
    let (mut diameters, mut volume) = (Vec::new(), 0.0);
    loop {
        let diameter = sampler.draw();
        let done = match spec.fill {
            Fill::Number(count) => diameters.len() == count,
            Fill::Height(_) => volume + 0.5 * sphere::volume_of_diameter(diameter) > wanted,
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
