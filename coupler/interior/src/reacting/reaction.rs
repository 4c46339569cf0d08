//! A reaction of what particles hold, and the law by which it goes.

use calcine_numerics::Number;
use calcine_physics::law::LawEntry;
use calcine_physics::reaction::{
    Arrhenius, Equilibrium, PowerLaw, RateLaw, power_law, shrinking_core,
};

/// A reaction of solids, and of gases where it is heterogeneous.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaction {
    /// Its name.
    pub name: String,
    /// Each solid with the moles that one mole of the reaction makes (+) or uses up (−).
    pub solids: Vec<(usize, f64)>,
    /// The same of gases; empty for an inner reaction.
    pub gases: Vec<(usize, f64)>,
    /// By what law it goes.
    pub rate: Rate,
    /// How far it goes.
    pub equilibrium: Equilibrium,
}

/// Laws of rates.
#[derive(Clone, Debug, PartialEq)]
pub enum Rate {
    /// In the whole volume of a particle.
    Power(PowerLaw),
    /// At the surface of a core that shrinks.
    Core {
        /// k in m/s, of the forward reaction, per area of the interface.
        rate_constant: Arrhenius,
        /// Of the gas in the layer that the reaction leaves.
        diffusivity: LayerDiffusivity,
    },
}

impl Rate {
    /// What the law declares.
    pub fn law(&self) -> &'static LawEntry<RateLaw> {
        match self {
            Self::Power(_) => &power_law::LAW,
            Self::Core { .. } => &shrinking_core::LAW,
        }
    }
}

/// Diffusivity D (T/T₀)^n of a gas in the pores of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerDiffusivity {
    /// D in m²/s.
    pub value: f64,
    /// T₀ in K.
    pub at: f64,
    /// n.
    pub exponent: f64,
}

impl LayerDiffusivity {
    /// (T/T₀)^n at a temperature in K.
    pub fn growth<N: Number>(&self, temperature: N) -> N {
        if self.exponent == 0.0 {
            return N::constant(1.0);
        }
        let t = temperature.value();
        let value = (t / self.at).powf(self.exponent);
        temperature.through(value, self.exponent * value / t)
    }

    /// True where another diffusivity grows alike.
    pub fn grows_like(&self, other: &Self) -> bool {
        self.at == other.at && self.exponent == other.exponent
    }
}
