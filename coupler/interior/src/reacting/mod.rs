//! Particles that react: one temperature and the amounts of their solids each.
//!
//! Over a window a particle follows, with the gas about it held,
//!
//! dn_s/dτ = Σ_j ν_sj r_j,   C dT/dτ = h A (T_gas − T) + Q + Σ_j r_j q_j,
//!
//! with Q what it conducts and q_j the heat of reaction j at the temperatures at hand (requirements RXN-1,
//! 2, as amounts). What comes of it is given to the exchange with the gas as lines: the rate of a
//! heterogeneous reaction over the mass fraction of its key gas, the heat flow over the gas temperature. What
//! the gas then says is booked, and the temperature follows from the enthalpies of what is there, so
//! that elements and energy close whatever the lines were.

mod book;
pub mod chemistry;
pub mod layers;
mod model;
pub mod ode;
pub mod size;
mod step;

pub use book::ExchangeTotals;
pub use chemistry::{Rate, Reaction, SolidChemistry};
pub use layers::{LayerDiffusivity, LayersError};
pub use size::SizeChange;
pub use step::{ReactError, Surroundings};

use crate::network::HeatNetwork;
use chemistry::Rates;
use ode::Rosenbrock;

/// A reaction that exchanges gas.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its place among the reactions.
    pub reaction: usize,
    /// The gas in whose mass fraction its rate is a line.
    pub key: usize,
    /// Mass in kg that a mole of it makes (+) or takes (−) of each gas.
    pub mass: Vec<f64>,
}

/// Particles that react, and the inert ones among them.
#[derive(Debug)]
pub struct Reacting {
    chemistry: SolidChemistry,
    channels: Vec<Channel>,
    /// Amounts in mol of each solid in a kilogram of each material.
    composition: Vec<Vec<f64>>,
    /// How the particles of each material take up room.
    sizes: Vec<SizeChange>,
    /// Index of the material of each particle.
    material: Vec<usize>,
    /// Amounts in mol, solid by solid within each particle.
    committed: Amounts,
    now: Amounts,
    /// Start of the exchange with the gas in K, and its conductance in W/K.
    start: Vec<f64>,
    conductance: Vec<f64>,
    /// Temperature in K at the end of the last integration.
    end: Vec<f64>,
    /// Rates of each channel of each particle: slope by mass fraction in mol/s, and what goes off it.
    lines: [Vec<f64>; 2],
    /// What each reaction of each particle turns over in the window, in mol.
    extents: Vec<f64>,
    /// Sensible heat in W that exchanged gases bring in.
    carried: Vec<f64>,
    /// Heat of what is booked, over the window: its sum and the sum of magnitudes in J.
    released: (f64, f64),
    network: Option<HeatNetwork>,
    capacity: Vec<f64>,
    scratch: Scratch,
}

/// What a particle is made of, and how hot it is.
#[derive(Clone, Debug, Default, PartialEq)]
struct Amounts {
    /// In mol, solid by solid within each particle.
    amount: Vec<f64>,
    /// In K.
    temperature: Vec<f64>,
}

#[derive(Debug, Default)]
struct Scratch {
    method: Rosenbrock,
    rates: Rates,
    amounts: Vec<f64>,
    fractions: Vec<f64>,
    state: Vec<f64>,
    tolerance: Vec<f64>,
}

impl Reacting {
    /// Particles of masses in kg, each of one of the materials (each the mass fractions of the chemistry's
    /// solids), at temperatures in K.
    pub fn new(
        chemistry: SolidChemistry,
        materials: &[Vec<f64>],
        mass: &[f64],
        material: Vec<usize>,
        temperature: Vec<f64>,
        network: Option<HeatNetwork>,
    ) -> Self {
        let moles = |fractions: &Vec<f64>| {
            let parts = chemistry.solids.iter().zip(fractions);
            parts
                .map(|(solid, share)| share / solid.molar_mass())
                .collect()
        };
        let composition: Vec<Vec<f64>> = materials.iter().map(moles).collect();
        let each = mass.iter().zip(&material);
        let amount = each.flat_map(|(mass, &m)| composition[m].iter().map(move |n| n * mass));
        let committed = Amounts {
            amount: amount.collect(),
            temperature,
        };
        let channels = channels(&chemistry);
        let mut made = Self {
            chemistry,
            channels,
            sizes: vec![SizeChange::Constant; composition.len()],
            composition,
            material,
            now: committed.clone(),
            committed,
            start: Vec::new(),
            conductance: Vec::new(),
            end: Vec::new(),
            lines: [Vec::new(), Vec::new()],
            extents: Vec::new(),
            carried: Vec::new(),
            released: (0.0, 0.0),
            network,
            capacity: Vec::new(),
            scratch: Scratch::default(),
        };
        made.begin();
        made
    }

    /// The reactions.
    pub fn chemistry(&self) -> &SolidChemistry {
        &self.chemistry
    }

    /// Those that exchange gas.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Amounts in mol at the last commit, solid by solid within each particle.
    pub fn amounts(&self) -> &[f64] {
        &self.committed.amount
    }

    /// Takes up amounts from a checkpoint, as committed.
    pub fn restore_amounts(&mut self, amounts: &[f64]) {
        self.committed.amount.copy_from_slice(amounts);
        self.now.amount.copy_from_slice(amounts);
        self.begin();
    }

    fn count(&self) -> usize {
        self.material.len()
    }

    /// Everything as at the last commit.
    fn begin(&mut self) {
        let (count, reactions) = (self.count(), self.chemistry.reactions.len());
        self.start.clone_from(&self.committed.temperature);
        self.end.clone_from(&self.committed.temperature);
        self.conductance.clear();
        self.conductance.resize(count, 0.0);
        self.carried.clear();
        self.carried.resize(count, 0.0);
        self.extents.clear();
        self.extents.resize(count * reactions, 0.0);
        for line in &mut self.lines {
            line.clear();
            line.resize(count * self.channels.len(), 0.0);
        }
        let solids = self.chemistry.solids.len();
        let capacity = |p: usize| {
            let amounts = &self.committed.amount[p * solids..(p + 1) * solids];
            self.chemistry
                .heat_capacity(amounts, self.committed.temperature[p])
        };
        self.capacity = (0..count).map(capacity).collect();
        self.released = (0.0, 0.0);
        if let Some(network) = &mut self.network {
            network.heat.fill(0.0);
            network.reservoir_heat.fill(0.0);
        }
    }
}

fn channels(chemistry: &SolidChemistry) -> Vec<Channel> {
    let Some(gas) = &chemistry.gas else {
        return Vec::new();
    };
    let reactions = chemistry.reactions.iter().enumerate();
    reactions
        .filter_map(|(reaction, one)| {
            let key = chemistry.key(reaction)?;
            let mut mass = vec![0.0; gas.names().len()];
            for &(g, n) in &one.gases {
                mass[g] += n * gas.species()[g].molar_mass();
            }
            Some(Channel {
                reaction,
                key,
                mass,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests;
