//! Which law the rate of a reaction of particles follows.

use super::arrhenius::Arrhenius;
use super::conversion::{Conversion, GrainSurface};
use super::devolatilisation::Devolatilisation;
use super::evaporation::Evaporation;
use super::layer_diffusivity::LayerDiffusivity;

/// Where in a particle a reaction takes place, and what its rate goes by, as a case states it.
#[derive(Clone, Debug, PartialEq)]
pub enum RateLaw {
    /// At the surface of a core, see [`super::shrinking_core`].
    ShrinkingCore {
        /// k in m/s, of the forward reaction, per area of the interface.
        rate_constant: Arrhenius,
        /// Of the gas in the layer that the reaction leaves.
        diffusivity: LayerDiffusivity,
    },
    /// In the whole particle, see [`super::power_law`].
    PowerLaw {
        /// k in (mol/m³)^(1 − Σ n)/s.
        rate_constant: Arrhenius,
        /// A second step in series with it, in the same unit.
        in_series: Option<Arrhenius>,
        /// Order of each gas and solid, by its name.
        orders: Vec<(String, f64)>,
    },
    /// In the whole of a porous solid, by what is left of it, see [`super::conversion`].
    Conversion {
        /// k in (mol/m³)^(−Σ n)/s.
        rate_constant: Arrhenius,
        /// f(w).
        conversion: Conversion,
        /// Order of each gas, by its name.
        orders: Vec<(String, f64)>,
    },
    /// At the surface of grains, by what the pressure of a gas lacks of its equilibrium.
    EquilibriumPressure {
        /// k in mol/m²/s/Pa.
        rate_constant: Arrhenius,
        /// The grains.
        grains: GrainSurface,
    },
    /// Water from a wet surface, see [`super::evaporation`].
    Evaporation(Evaporation),
    /// By the share of a solid that is left of the particle's start, see [`super::devolatilisation`].
    Devolatilisation(Devolatilisation),
}
