//! What does not change while particles are computed: laws, and figures that follow from them.

use calcine_physics::pores::dusty_gas::MOST_GASES;
use thiserror::Error;

use super::material::{PoreGas, PorousSolid, RadialNumerics};
use crate::reacting::{Rate, Reaction, SolidChemistry};

/// Why a material can have no shells.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RadialError {
    /// A law that has its own resistances inside.
    #[error(
        "{reaction} goes by shrinking-core, which has its own layers; particles with shells need a law of the whole particle"
    )]
    Core {
        /// The reaction.
        reaction: String,
    },
    /// A law of thin particles.
    #[error(
        "{reaction} goes by a law of thin particles: its water and volatiles have no place in shells"
    )]
    Thin {
        /// The reaction.
        reaction: String,
    },
    /// A pressure that lacks of an equilibrium of what.
    #[error(
        "{reaction} goes by equilibrium-pressure, which needs an equation with <=>, one solid on the left and one gas, on the right"
    )]
    Grains {
        /// The reaction.
        reaction: String,
    },
    /// No solid that is used up.
    #[error("{reaction} uses up no solid, by what is left of which its law could go")]
    Solid {
        /// The reaction.
        reaction: String,
    },
    /// A solid whose true density is not known, or no more than that of the particle.
    #[error(
        "the solids would fill {filled} of the particle: with their true densities they must leave room for pores"
    )]
    Porosity {
        /// Their share of the volume.
        filled: f64,
    },
    /// Too many gases.
    #[error("{count} gases, where pores hold {MOST_GASES} at most")]
    Gases {
        /// How many.
        count: usize,
    },
    /// Too many solids.
    #[error("{count} solids, where shells hold {MOST_SOLIDS} at most")]
    Solids {
        /// How many.
        count: usize,
    },
    /// Too few shells.
    #[error("{shells} shells: a profile needs 3 at least")]
    Shells {
        /// How many.
        shells: usize,
    },
}

/// Most solids of particles with shells.
pub(super) const MOST_SOLIDS: usize = 32;

/// Temperature and pressure of the tabulated diffusivities of pairs.
pub(super) const PAIR_TEMPERATURE: f64 = 1000.0;
pub(super) const PAIR_PRESSURE: f64 = 1e5;

/// The laws of a material's particles.
#[derive(Clone, Debug)]
pub(super) struct RadialPhysics {
    pub chemistry: SolidChemistry,
    pub solid: PorousSolid,
    pub numerics: RadialNumerics,
    pub pore_gas: PoreGas,
    /// Share of each shell in the volume.
    pub shares: Vec<f64>,
    /// Volume in m³/mol of each solid by itself, and with its pores (none where diameters stay).
    pub true_volume: Vec<f64>,
    pub bulk_volume: Option<Vec<f64>>,
    /// Least volume in m³ of a particle.
    pub least_volume: f64,
    /// Diffusivities of pairs in m²/s at [`PAIR_TEMPERATURE`] and [`PAIR_PRESSURE`], row by row.
    pub pairs: Vec<f64>,
    /// Molar masses of the gases in kg/mol.
    pub gas_mass: Vec<f64>,
    /// Enthalpies of formation in J/mol of the gases.
    pub gas_formation: Vec<f64>,
    /// By reaction the solid that is used up first.
    pub reactant: Vec<usize>,
    /// Moles of each solid that each reaction makes, reaction by reaction.
    pub solid_moles: Vec<f64>,
    /// Moles of each gas that each reaction makes, reaction by reaction, and the orders of the gases on its way back.
    pub gas_moles: Vec<f64>,
    pub behind: Vec<Vec<(usize, f64)>>,
    /// Gases that each reaction uses and does not follow.
    pub ends_with: Vec<Vec<usize>>,
    /// Moles of gases that each reaction makes, in all.
    pub net_gas: Vec<f64>,
    /// Change of the pores' volume in m³/mol of each reaction.
    pub opens: Vec<f64>,
}

impl RadialPhysics {
    pub fn new(
        chemistry: SolidChemistry,
        solid: PorousSolid,
        pore_gas: PoreGas,
        numerics: RadialNumerics,
    ) -> Result<Self, RadialError> {
        if numerics.grid.shells < 3 {
            return Err(RadialError::Shells {
                shells: numerics.grid.shells,
            });
        }
        let mut reactant = Vec::new();
        for reaction in &chemistry.reactions {
            let name = || reaction.name.clone();
            let used = reaction.solids.iter().find(|one| one.1 < 0.0);
            match &reaction.rate {
                Rate::Core { .. } => return Err(RadialError::Core { reaction: name() }),
                Rate::Evaporation(_) | Rate::Devolatilisation(_) => {
                    return Err(RadialError::Thin { reaction: name() });
                }
                Rate::Grains { .. } => {
                    let reverse =
                        reaction.equilibrium != calcine_physics::reaction::Equilibrium::OneWay;
                    let one = matches!(&reaction.gases[..], [(_, n)] if *n > 0.0);
                    if !(one && reverse && used.is_some()) {
                        return Err(RadialError::Grains { reaction: name() });
                    }
                }
                Rate::Conversion { .. } if used.is_none() => {
                    return Err(RadialError::Solid { reaction: name() });
                }
                Rate::Conversion { .. } | Rate::Power(_) => {}
            }
            reactant.push(used.or(reaction.solids.first()).map_or(0, |one| one.0));
        }
        let gases = chemistry.gas.as_ref().map_or(0, |gas| gas.names().len());
        if gases > MOST_GASES {
            return Err(RadialError::Gases { count: gases });
        }
        if chemistry.solids.len() > MOST_SOLIDS {
            return Err(RadialError::Solids {
                count: chemistry.solids.len(),
            });
        }
        let (mut pairs, mut gas_mass, mut gas_formation) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(gas) = &chemistry.gas {
            for (i, one) in gas.species().iter().enumerate() {
                gas_mass.push(one.molar_mass());
                gas_formation.push(one.molar_mass() * one.formation_enthalpy());
                pairs.extend(
                    (0..gases)
                        .map(|j| gas.pair_diffusivity((i, j), PAIR_PRESSURE, PAIR_TEMPERATURE)),
                );
            }
        }
        let solids = chemistry.solids.iter().zip(&solid.true_densities);
        let true_volume: Vec<f64> = solids.map(|(s, rho)| s.molar_mass() / rho).collect();
        let bulk_volume = solid.size.volumes().map(<[f64]>::to_vec);
        let opens = chemistry.reactions.iter().map(|reaction| {
            let parts = reaction.solids.iter().map(|&(s, n)| {
                let bulk = bulk_volume.as_ref().map_or(0.0, |each| each[s]);
                n * (bulk - true_volume[s])
            });
            parts.sum()
        });
        let opens = opens.collect();
        let moles_of = |reaction: &Reaction, g: usize| -> f64 {
            let own = reaction.gases.iter().filter(|one| one.0 == g);
            own.map(|one| one.1).sum()
        };
        let (mut gas_moles, mut behind, mut ends_with) = (Vec::new(), Vec::new(), Vec::new());
        let mut solid_moles = vec![0.0; chemistry.reactions.len() * chemistry.solids.len()];
        for (j, reaction) in chemistry.reactions.iter().enumerate() {
            for &(k, moles) in &reaction.solids {
                solid_moles[j * chemistry.solids.len() + k] += moles;
            }
            gas_moles.extend((0..gases).map(|g| moles_of(reaction, g)));
            let orders = match &reaction.rate {
                Rate::Conversion { gases, .. } => &gases[..],
                Rate::Power(law) => &law.gases,
                _ => &[],
            };
            let order_of = |g: usize| -> f64 {
                let own = orders.iter().filter(|one| one.0 == g);
                own.map(|one| one.1).sum()
            };
            let ends = (0..gases).filter(|g| order_of(*g) == 0.0 && moles_of(reaction, *g) < 0.0);
            ends_with.push(ends.collect());
            let sums = (0..gases).map(|g| (g, order_of(g) + moles_of(reaction, g)));
            behind.push(sums.filter(|one| one.1 != 0.0).collect());
        }
        let net = |gases: &[(usize, f64)]| gases.iter().map(|one| one.1).sum();
        let net_gas = chemistry.reactions.iter().map(|one| net(&one.gases));
        Ok(Self {
            net_gas: net_gas.collect(),
            solid_moles,
            gas_moles,
            behind,
            ends_with,
            shares: numerics.grid.shares(),
            least_volume: match &solid.size {
                crate::reacting::SizeChange::Constant => 0.0,
                crate::reacting::SizeChange::Volumes { least_radius, .. } => {
                    calcine_physics::sphere::volume(*least_radius)
                }
            },
            chemistry,
            solid,
            numerics,
            pore_gas,
            true_volume,
            bulk_volume,
            pairs,
            gas_mass,
            gas_formation,
            reactant,
            opens,
        })
    }

    /// Number of solids.
    pub fn solids(&self) -> usize {
        self.chemistry.solids.len()
    }

    /// Number of gases.
    pub fn gases(&self) -> usize {
        self.gas_mass.len()
    }

    /// Number of reactions.
    pub fn reactions(&self) -> usize {
        self.chemistry.reactions.len()
    }

    /// Volume in m³ of a shell of these amounts in mol, which had `first` at the start; `share` of the particle's.
    pub fn volume(&self, amounts: &[f64], first: f64, share: f64) -> f64 {
        match &self.bulk_volume {
            None => first,
            Some(each) => {
                let parts = each.iter().zip(amounts).map(|(v, n)| v * n);
                parts.sum::<f64>().max(share * self.least_volume)
            }
        }
    }

    /// Volume in m³ that solids of these amounts in mol fill by themselves.
    pub fn filled(&self, amounts: &[f64]) -> f64 {
        self.true_volume
            .iter()
            .zip(amounts)
            .map(|(v, n)| v * n)
            .sum()
    }
}
