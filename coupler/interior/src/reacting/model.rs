//! Particles that react as the coordinator sees them.

use super::Reacting;
use crate::network::{Neighbours, NetworkSurroundings};
use crate::{Newcomer, ParticleModel, without};

impl ParticleModel for Reacting {
    fn temperature(&self) -> &[f64] {
        &self.now.temperature
    }

    fn committed_temperature(&self) -> &[f64] {
        &self.committed.temperature
    }

    fn reacting(&mut self) -> Option<&mut Reacting> {
        Some(self)
    }

    fn reactions(&self) -> Option<&Reacting> {
        Some(self)
    }

    fn conducts(&self) -> bool {
        self.network.is_some()
    }

    fn set_neighbours(&mut self, neighbours: &Neighbours<'_>) {
        if let Some(network) = &mut self.network {
            network.set_neighbours(neighbours);
        }
    }

    /// The heat of the last attempt's reactions counts as if it had come before.
    fn conduct(&mut self, surroundings: &NetworkSurroundings<'_>, span: f64) {
        let Some(network) = self.network.as_mut().filter(|network| !network.is_empty()) else {
            return;
        };
        let count = self.chemistry.reactions.len();
        let warmed = |p: usize| {
            let extents = &self.extents[p * count..(p + 1) * count];
            let heats = extents.iter().zip(&self.chemistry.heat);
            let heat: f64 = heats.map(|(extent, heat)| -extent * heat).sum();
            self.committed.temperature[p] + (heat + self.carried[p] * span) / self.capacity[p]
        };
        let old: Vec<f64> = (0..self.capacity.len()).map(warmed).collect();
        network.solve(|p, _| self.capacity[p] / span, &old, surroundings);
    }

    fn reservoir_heat(&self) -> &[f64] {
        self.network
            .as_ref()
            .map_or(&[], |network| &network.reservoir_heat)
    }

    fn start_temperature(&self) -> &[f64] {
        &self.start
    }

    fn eliminated(&self, conductance: &[f64], span: f64, out: &mut [f64]) {
        let pairs = conductance.iter().zip(&self.capacity);
        for ((k, (&ha, &mc)), own) in out.iter_mut().zip(pairs).zip(&self.conductance) {
            *k = if *own > 0.0 {
                *own
            } else {
                ha / (1.0 + ha * span / mc)
            };
        }
    }

    fn advance(&mut self, heat: &[f64], span: f64) {
        let chemistry = &self.chemistry;
        let (solids, count) = (chemistry.solids.len(), chemistry.reactions.len());
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for p in 0..self.material.len() {
            let held = &self.committed.amount[p * solids..(p + 1) * solids];
            let amounts = &mut self.now.amount[p * solids..(p + 1) * solids];
            amounts.copy_from_slice(held);
            let extents = &self.extents[p * count..(p + 1) * count];
            let mut released = 0.0;
            for ((extent, reaction), heat) in extents
                .iter()
                .zip(&chemistry.reactions)
                .zip(&chemistry.heat)
            {
                for &(s, n) in &reaction.solids {
                    amounts[s] += n * extent;
                }
                released -= extent * heat;
                magnitude += (extent * heat).abs();
            }
            let conducted = self.network.as_ref().map_or(0.0, |network| network.heat[p]);
            let gained = (heat[p] + conducted + self.carried[p]) * span + released;
            let before = chemistry.enthalpy(held, self.committed.temperature[p]);
            self.now.temperature[p] = chemistry.temperature(amounts, before + gained, self.end[p]);
            sum -= released;
        }
        self.released = (sum, magnitude);
    }

    fn commit(&mut self) {
        self.committed.clone_from(&self.now);
        self.begin();
    }

    fn stored_change(&self) -> (f64, f64) {
        let solids = self.chemistry.solids.len();
        (0..self.material.len()).fold(self.released, |(sum, magnitude), p| {
            let own = p * solids..(p + 1) * solids;
            let of = |state: &super::Amounts| {
                let amounts = &state.amount[own.clone()];
                self.chemistry.enthalpy(amounts, state.temperature[p])
            };
            let change = of(&self.now) - of(&self.committed);
            (sum + change, magnitude + change.abs())
        })
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer]) {
        let solids = self.chemistry.solids.len();
        let rows: Vec<usize> = gone
            .iter()
            .flat_map(|row| row * solids..(row + 1) * solids)
            .collect();
        without(&mut self.committed.amount, &rows);
        without(&mut self.committed.temperature, gone);
        without(&mut self.material, gone);
        for one in new {
            let made = self.composition[one.material].iter();
            self.committed.amount.extend(made.map(|n| n * one.mass));
            self.committed.temperature.push(one.temperature);
            self.material.push(one.material);
        }
        self.now.clone_from(&self.committed);
        if let Some(network) = &mut self.network {
            network.change(gone, new);
        }
        self.begin();
    }

    fn enthalpy(&self, row: usize) -> f64 {
        let solids = self.chemistry.solids.len();
        let amounts = &self.committed.amount[row * solids..(row + 1) * solids];
        self.chemistry
            .enthalpy(amounts, self.committed.temperature[row])
    }

    fn restore(&mut self, temperature: &[f64]) {
        self.committed.temperature.copy_from_slice(temperature);
        self.now.temperature.copy_from_slice(temperature);
        self.begin();
    }
}

impl Reacting {
    /// Change of each particle's mass in kg in the last attempt, and change of the mass of each element in all of
    /// them, with the sum of magnitudes: in the order of [`calcine_physics::thermo::Element::ALL`].
    pub fn mass_changes(&self) -> (f64, Vec<[f64; 2]>) {
        use calcine_physics::thermo::Element;
        let chemistry = &self.chemistry;
        let solids = chemistry.solids.len();
        let mut elements = vec![[0.0; 2]; Element::COUNT];
        let mut mass = 0.0;
        let pairs = self.now.amount.iter().zip(&self.committed.amount);
        for (k, (now, before)) in pairs.enumerate() {
            let change = now - before;
            let solid = &chemistry.solids[k % solids];
            mass += solid.molar_mass() * change;
            for ((sum, atoms), element) in elements.iter_mut().zip(solid.atoms()).zip(Element::ALL)
            {
                let part = atoms * element.molar_mass() * change;
                sum[0] += part;
                sum[1] += part.abs();
            }
        }
        (mass, elements)
    }

    /// Mass in kg of each element that particles of these rows hold at the last commit, in the order of
    /// [`calcine_physics::thermo::Element::ALL`].
    pub fn elements(&self, rows: impl Iterator<Item = usize>) -> Vec<f64> {
        let solids = self.chemistry.solids.len();
        let mut held = vec![0.0; solids];
        for row in rows {
            let amounts = &self.committed.amount[row * solids..(row + 1) * solids];
            for (sum, n) in held.iter_mut().zip(amounts) {
                *sum += n;
            }
        }
        self.elements_of(&held)
    }

    /// The same of particles as they come in.
    pub fn elements_brought(&self, new: &[Newcomer]) -> Vec<f64> {
        let mut brought = vec![0.0; self.chemistry.solids.len()];
        for one in new {
            for (sum, n) in brought.iter_mut().zip(&self.composition[one.material]) {
                *sum += n * one.mass;
            }
        }
        self.elements_of(&brought)
    }

    fn elements_of(&self, amounts: &[f64]) -> Vec<f64> {
        use calcine_physics::thermo::Element;
        let atoms = |element: &Element| -> f64 {
            let parts = self.chemistry.solids.iter().zip(amounts);
            parts
                .map(|(solid, n)| n * solid.atoms()[*element as usize])
                .sum()
        };
        let masses = Element::ALL.iter().map(|one| atoms(one) * one.molar_mass());
        masses.collect()
    }

    /// Mass in kg of each particle at the last commit.
    pub fn masses(&self, out: &mut Vec<f64>) {
        let solids = self.chemistry.solids.len();
        out.clear();
        let particles = self.committed.amount.chunks_exact(solids);
        out.extend(particles.map(|amounts| self.chemistry.mass(amounts)));
    }
}
