//! Materials.

use calcine_coupler::interior::radial::ShellGrid;
use calcine_coupler::interior::reacting::size::{
    CONSTANT_DENSITY, CONSTANT_DIAMETER, DENSITIES, SizeRule,
};
use calcine_coupler::physics::conduction::Conductivity;
use calcine_coupler::physics::law::LawEntry;
use calcine_coupler::physics::pores::{Permeability, PorousConductivity};
use calcine_coupler::physics::solid::HeatCapacity;

/// A solid material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialSpec {
    /// Name.
    pub name: String,
    /// Density in kg/m³.
    pub density: f64,
    /// Specific heat capacity over temperature; of a material with a composition that of its solids.
    pub heat_capacity: HeatCapacity,
    /// Mass fractions of all solids that there are; `None` where it is not said what it is made of.
    pub composition: Option<Vec<f64>>,
    /// How its particles take up room while they react.
    pub size: SizeLaw,
    /// What is inside of its particles.
    pub inside: Inside,
    /// How those with shells are computed.
    pub radial: RadialSpec,
    /// Share of its first mass below which a particle is used up.
    pub used_up: f64,
    /// Thermal conductivity over temperature.
    pub conductivity: Option<Conductivity>,
    /// Emissivity of its surface.
    pub emissivity: Option<f64>,
    /// Young's modulus in Pa, as contacts are computed.
    pub young: Option<f64>,
    /// Young's modulus in Pa of the real material, where the other one is softened.
    pub real_young: Option<f64>,
    /// Poisson's ratio.
    pub poisson: Option<f64>,
}

impl MaterialSpec {
    /// Density in kg/m³ of its solids at the start without pores, where it states what they are and their true densities.
    pub fn true_density(&self) -> Option<f64> {
        let composition = self.composition.as_ref()?;
        let held = composition.iter().enumerate().filter(|(_, y)| **y > 0.0);
        let volume = held.map(|(s, y)| {
            let density = self.radial.true_densities.get(s).copied().flatten();
            density.map(|density| y / density)
        });
        Some(1.0 / volume.sum::<Option<f64>>()?)
    }
}

/// What is inside of particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inside {
    /// One temperature, and amounts of solids.
    #[default]
    Thin,
    /// Shells.
    Radial,
    /// One shell, and all where it has to be.
    Auto,
}

/// How particles with shells are computed.
#[derive(Clone, Debug, PartialEq)]
pub struct RadialSpec {
    /// The shells.
    pub grid: ShellGrid,
    /// True density in kg/m³ of all solids that there are; `None` where it is not said.
    pub true_densities: Vec<Option<f64>>,
    /// Diameter of pores in m.
    pub pore_diameter: Option<f64>,
    /// Tortuosity.
    pub tortuosity: Option<f64>,
    /// Permeability.
    pub permeability: Option<Permeability>,
    /// How the material's conductivity is that of particles.
    pub conduction: PorousConductivity,
    /// Error of a step in K, and as a share of the solids.
    pub errors: [f64; 2],
    /// Difference in K, and of partial pressures over the pressure, from which on `auto` has shells.
    pub turns: [f64; 2],
}

/// How particles of a material take up room while they react.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SizeLaw {
    /// The diameter stays.
    #[default]
    Constant,
    /// The density stays.
    ConstantDensity {
        /// Radius in m below which none shrinks.
        least_radius: f64,
    },
    /// Each solid has its own density in the particle.
    Densities {
        /// In kg/m³, of all solids that there are; `None` where it is not said.
        densities: Vec<Option<f64>>,
        /// Radius in m below which none shrinks.
        least_radius: f64,
    },
}

impl SizeLaw {
    /// What the law declares.
    pub fn law(&self) -> &'static LawEntry<SizeRule> {
        match self {
            Self::Constant => &CONSTANT_DIAMETER,
            Self::ConstantDensity { .. } => &CONSTANT_DENSITY,
            Self::Densities { .. } => &DENSITIES,
        }
    }
}
