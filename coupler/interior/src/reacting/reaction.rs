//! A reaction of what particles hold, and the law by which it goes.

use calcine_physics::law::LawEntry;
pub use calcine_physics::reaction::LayerDiffusivity;
use calcine_physics::reaction::{
    Arrhenius, Conversion, Devolatilisation, Equilibrium, Evaporation, GrainSurface, PowerLaw,
    RateLaw, conversion, power_law, shrinking_core, wet_entries,
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

impl Reaction {
    /// Solids whose amounts a reaction of gases alone follows.
    pub fn catalysts(&self) -> impl Iterator<Item = usize> {
        let alone = self.solids.is_empty();
        self.rate.followed_solids().filter(move |_| alone)
    }

    /// The gas and the solid between which a reaction dries a particle.
    pub(super) fn vapour_and_water(&self) -> Option<(usize, usize)> {
        let (gas, solid) = (self.gases.first()?, self.solids.first()?);
        Some((gas.0, solid.0))
    }
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
    /// In the whole of a porous solid, by what is left of it; of particles with shells alone.
    Conversion {
        /// k in (mol/m³)^(−Σ n)/s.
        rate_constant: Arrhenius,
        /// f(w).
        conversion: Conversion,
        /// Order of each gas, by its index.
        gases: Vec<(usize, f64)>,
    },
    /// At the surface of grains, by what the pressure of a gas lacks of its equilibrium; of particles with shells alone.
    Grains {
        /// k in mol/m²/s/Pa.
        rate_constant: Arrhenius,
        /// The grains.
        grains: GrainSurface,
    },
    /// From the wet surface of a particle.
    Evaporation(Evaporation),
    /// In the whole of a particle, by what is left of a solid that it came with.
    Devolatilisation(Devolatilisation),
}

impl Rate {
    /// What the law declares.
    pub fn law(&self) -> &'static LawEntry<RateLaw> {
        match self {
            Self::Power(_) => &power_law::LAW,
            Self::Core { .. } => &shrinking_core::LAW,
            Self::Grains { .. } => &conversion::EQUILIBRIUM_PRESSURE,
            Self::Evaporation(law) if law.isotherm => &wet_entries::WOOD_DRYING,
            Self::Evaporation(_) => &wet_entries::EVAPORATION,
            Self::Devolatilisation(_) => &wet_entries::DEVOLATILISATION,
            Self::Conversion { conversion, .. } => match conversion {
                Conversion::FirstOrder(_) => &conversion::FIRST_ORDER,
                Conversion::ContractingArea(_) => &conversion::CONTRACTING_AREA,
                Conversion::ContractingVolume(_) => &conversion::CONTRACTING_VOLUME,
                Conversion::Nucleation(_) => &conversion::NUCLEATION,
                Conversion::RandomPore(_) => &conversion::RANDOM_PORE,
            },
        }
    }

    /// Solids that it follows by an order above zero.
    pub fn followed_solids(&self) -> impl Iterator<Item = usize> {
        let orders = match self {
            Self::Power(law) => &law.solids[..],
            _ => &[],
        };
        orders.iter().filter(|one| one.1 > 0.0).map(|one| one.0)
    }

    /// True where only thin particles know the law: it has layers, a wet surface or the start of a particle.
    pub fn needs_thin(&self) -> bool {
        matches!(
            self,
            Self::Core { .. } | Self::Evaporation(_) | Self::Devolatilisation(_)
        )
    }

    /// True where only particles with shells know the law: it needs the pores.
    pub fn needs_shells(&self) -> bool {
        matches!(self, Self::Conversion { .. } | Self::Grains { .. })
    }
}
