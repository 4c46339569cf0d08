//! Particles that react: one temperature and the amounts of their solids each.
//!
//! Over a window a particle follows, with the gas about it held,
//!
//! dn_s/dτ = Σ_j ν_sj r_j,   C dT/dτ = h A (T_gas − T) + Q + Σ_j r_j q_j,
//!
//! with Q what it conducts and q_j the heat of reaction j at the temperatures at hand (docs/theory.md, RXN-1,
//! 2, as amounts). What comes of it is given to the exchange with the gas as lines: the rate of a
//! heterogeneous reaction over the mass fraction of its key gas, the heat flow over the gas temperature. What
//! the gas then says is booked, and the temperature follows from the enthalpies of what is there, so
//! that elements and energy close whatever the lines were.

pub mod attempt;
mod book;
mod bound_water;
pub mod chemistry;
mod columns;
mod drying;
mod film_balance;
pub mod layers;
mod measure;
mod model;
pub mod passage;
pub mod rates;
pub mod reaction;
mod shared_film;
mod shared_rates;
pub mod size;
mod step;
mod surface;

pub use attempt::ParticleAccuracy;
pub use chemistry::SolidChemistry;
pub use layers::LayersError;
pub use reaction::{LayerDiffusivity, Rate, Reaction};
pub use size::SizeChange;
pub use step::ReactError;

use crate::column::StateColumn;
use crate::model::Channel;

/// Particles of one material that react.
#[derive(Debug)]
pub struct Reacting {
    chemistry: SolidChemistry,
    columns: Vec<StateColumn>,
    channels: Vec<Channel>,
    /// Place of each channel among the reactions.
    reaction_of: Vec<usize>,
    /// Amounts in mol of each solid in a kilogram as it comes in.
    composition: Vec<f64>,
    /// How the particles take up room.
    size: SizeChange,
    /// Amounts in mol, solid by solid within each particle.
    committed: Amounts,
    now: Amounts,
    /// Masses in kg and radii in m of both; radii are empty where they stay.
    bodies: [Measures; 2],
    /// Start of the exchange with the gas in K, and its conductance in W/K.
    start: Vec<f64>,
    conductance: Vec<f64>,
    /// Temperature in K at the end of the last integration.
    end: Vec<f64>,
    /// Slope, offset and local slope of each channel of each particle, as in [`crate::model::GasLines`].
    lines: [Vec<f64>; 3],
    /// What each reaction of each particle turns over in the window, in mol.
    extents: Vec<f64>,
    /// Sensible heat in W that exchanged gases bring in.
    carried: Vec<f64>,
    capacity: Vec<f64>,
    /// What the last attempt of the window came to, row by row; empty before the first.
    results: Vec<f64>,
    accuracy: ParticleAccuracy,
    /// Share of its first mass below which a particle is used up.
    used_up: f64,
}

/// Masses and radii that follow from amounts.
#[derive(Clone, Debug, Default, PartialEq)]
struct Measures {
    mass: Vec<f64>,
    radius: Vec<f64>,
}

/// What a particle is made of, and how hot it is.
#[derive(Clone, Debug, Default, PartialEq)]
struct Amounts {
    /// In mol, solid by solid within each particle.
    amount: Vec<f64>,
    /// In K.
    temperature: Vec<f64>,
    /// Mass in kg with which each particle came.
    first_mass: Vec<f64>,
    /// Heat in J that windows brought each particle beyond what its temperature shows. It is given in the next one, or booked
    /// with what is left of a particle that is used up.
    owed: Vec<f64>,
}

impl Reacting {
    /// No particles yet, of a material that is at first made of these mass fractions of the chemistry's solids.
    pub fn new(chemistry: SolidChemistry, fractions: &[f64]) -> Self {
        let parts = chemistry.solids.iter().zip(fractions);
        let composition = parts
            .map(|(solid, share)| share / solid.molar_mass())
            .collect();
        let (channels, reaction_of) = channels(&chemistry);
        Self {
            columns: columns::columns(&chemistry),
            chemistry,
            channels,
            reaction_of,
            composition,
            size: SizeChange::Constant,
            committed: Amounts::default(),
            now: Amounts::default(),
            bodies: Default::default(),
            start: Vec::new(),
            conductance: Vec::new(),
            end: Vec::new(),
            lines: Default::default(),
            extents: Vec::new(),
            carried: Vec::new(),
            capacity: Vec::new(),
            results: Vec::new(),
            accuracy: ParticleAccuracy::default(),
            used_up: 0.0,
        }
    }

    /// The same particles, integrated with another accuracy.
    pub fn with_accuracy(mut self, accuracy: ParticleAccuracy) -> Self {
        self.accuracy = accuracy;
        self
    }

    /// The reactions.
    pub fn chemistry(&self) -> &SolidChemistry {
        &self.chemistry
    }

    /// Amounts in mol at the last commit, solid by solid within each particle.
    pub fn amounts(&self) -> &[f64] {
        &self.committed.amount
    }

    fn count(&self) -> usize {
        self.committed.temperature.len()
    }

    /// True where so little mass in kg is left of a particle that it is used up.
    fn is_used_up(&self, row: usize, mass: f64) -> bool {
        mass <= self.used_up * self.committed.first_mass[row]
    }

    /// Everything as at the last commit.
    fn begin(&mut self) {
        let (count, reactions) = (self.count(), self.chemistry.reactions.len());
        self.results.clear();
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
        self.now.clone_from(&self.committed);
        self.measure(1);
        let [attempted, committed] = &mut self.bodies;
        attempted.clone_from(committed);
    }
}

/// The reactions that exchange gas, and where they stand among all.
fn channels(chemistry: &SolidChemistry) -> (Vec<Channel>, Vec<usize>) {
    let Some(gas) = &chemistry.gas else {
        return (Vec::new(), Vec::new());
    };
    let reactions = chemistry.reactions.iter().enumerate();
    reactions
        .filter_map(|(reaction, one)| {
            let key = chemistry.key(reaction)?;
            let mut mass = vec![0.0; gas.names().len()];
            for &(g, n) in &one.gases {
                mass[g] += n * gas.species()[g].molar_mass();
            }
            let channel = Channel {
                name: one.name.clone(),
                key: Some(key),
                mass,
            };
            Some((channel, reaction))
        })
        .unzip()
}

#[cfg(test)]
mod tests;
