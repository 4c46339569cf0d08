//! Thermally thin particles: one temperature each.

use calcine_physics::solid::HeatCapacity;

use crate::network::{HeatNetwork, Neighbours, NetworkSurroundings};
use crate::{Newcomer, ParticleModel, without};

/// Particles of uniform temperature: m dh(T)/dτ = Q, h the enthalpy of the material. Good for Biot
/// numbers below about 0.1.
#[derive(Debug)]
pub struct Thin {
    /// Mass of each particle in kg.
    mass: Vec<f64>,
    /// Index into `materials` of each particle.
    material: Vec<usize>,
    materials: Vec<HeatCapacity>,
    /// m c at the committed temperatures in J/K.
    heat_capacity: Vec<f64>,
    committed: Vec<f64>,
    temperature: Vec<f64>,
    /// Start of the exchange with the gas where particles conduct, in K.
    start: Vec<f64>,
    network: Option<HeatNetwork>,
}

impl Thin {
    /// Particles of masses in kg, each of one of the materials, at start temperatures in K; conduction
    /// between them through a network, or none.
    pub fn new(
        mass: Vec<f64>,
        material: Vec<usize>,
        materials: Vec<HeatCapacity>,
        temperature: Vec<f64>,
        network: Option<HeatNetwork>,
    ) -> Self {
        debug_assert!(mass.len() == temperature.len() && mass.len() == material.len());
        let mut thin = Self {
            heat_capacity: vec![0.0; mass.len()],
            mass,
            material,
            materials,
            committed: temperature.clone(),
            start: temperature.clone(),
            temperature,
            network,
        };
        thin.update_heat_capacity();
        thin
    }

    /// Particles of constant heat capacities m c in J/K at start temperatures in K.
    pub fn of_heat_capacity(heat_capacity: Vec<f64>, temperature: Vec<f64>) -> Self {
        let material = vec![0; heat_capacity.len()];
        let unit = vec![HeatCapacity::constant(1.0)];
        Self::new(heat_capacity, material, unit, temperature, None)
    }

    fn update_heat_capacity(&mut self) {
        for (p, capacity) in self.heat_capacity.iter_mut().enumerate() {
            *capacity = self.mass[p] * self.materials[self.material[p]].at(self.committed[p]);
        }
    }

    fn start_over(&mut self) {
        self.start.copy_from_slice(&self.committed);
        if let Some(network) = &mut self.network {
            network.heat.fill(0.0);
            network.reservoir_heat.fill(0.0);
        }
    }
}

impl ParticleModel for Thin {
    fn temperature(&self) -> &[f64] {
        &self.temperature
    }

    fn committed_temperature(&self) -> &[f64] {
        &self.committed
    }

    fn conducts(&self) -> bool {
        self.network.is_some()
    }

    fn set_neighbours(&mut self, neighbours: &Neighbours<'_>) {
        if let Some(network) = &mut self.network {
            network.set_neighbours(neighbours);
        }
    }

    fn conduct(&mut self, surroundings: &NetworkSurroundings<'_>, span: f64) {
        let Some(network) = self.network.as_mut().filter(|network| !network.is_empty()) else {
            return;
        };
        let (mass, material, materials) = (&self.mass, &self.material, &self.materials);
        let (heat_capacity, committed) = (&self.heat_capacity, &self.committed);
        let capacity = |p: usize, kelvin: f64| {
            let law = &materials[material[p]];
            let rise = kelvin - committed[p];
            let secant = if law.is_constant() || rise.abs() < SECANT * kelvin {
                heat_capacity[p]
            } else {
                mass[p] * (law.enthalpy(kelvin) - law.enthalpy(committed[p])) / rise
            };
            secant / span
        };
        network.solve(capacity, committed, surroundings);
        self.start.clear();
        for (p, heat) in network.heat.iter().enumerate() {
            self.start.push(moved(
                &materials[material[p]],
                committed[p],
                heat * span,
                mass[p],
                heat_capacity[p],
            ));
        }
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
        for ((k, &ha), &mc) in out.iter_mut().zip(conductance).zip(&self.heat_capacity) {
            *k = ha / (1.0 + ha * span / mc);
        }
    }

    fn advance(&mut self, heat: &[f64], span: f64) {
        for (p, temperature) in self.temperature.iter_mut().enumerate() {
            let conducted = self.network.as_ref().map_or(0.0, |network| network.heat[p]);
            let gained = (heat[p] + conducted) * span;
            *temperature = moved(
                &self.materials[self.material[p]],
                self.committed[p],
                gained,
                self.mass[p],
                self.heat_capacity[p],
            );
        }
    }

    fn commit(&mut self) {
        self.committed.copy_from_slice(&self.temperature);
        self.update_heat_capacity();
        self.start_over();
    }

    fn stored_change(&self) -> (f64, f64) {
        let change = |p: usize| {
            let law = &self.materials[self.material[p]];
            if law.is_constant() {
                self.heat_capacity[p] * (self.temperature[p] - self.committed[p])
            } else {
                let before = law.enthalpy(self.committed[p]);
                self.mass[p] * (law.enthalpy(self.temperature[p]) - before)
            }
        };
        (0..self.temperature.len()).fold((0.0, 0.0), |(sum, magnitude), p| {
            (sum + change(p), magnitude + change(p).abs())
        })
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer]) {
        without(&mut self.mass, gone);
        without(&mut self.material, gone);
        without(&mut self.committed, gone);
        self.mass.extend(new.iter().map(|one| one.mass));
        self.material.extend(new.iter().map(|one| one.material));
        self.committed.extend(new.iter().map(|one| one.temperature));
        self.temperature.clone_from(&self.committed);
        self.start.clone_from(&self.committed);
        self.heat_capacity.resize(self.mass.len(), 0.0);
        if let Some(network) = &mut self.network {
            network.change(gone, new);
        }
        self.update_heat_capacity();
        self.start_over();
    }

    fn enthalpy(&self, row: usize) -> f64 {
        let law = &self.materials[self.material[row]];
        self.mass[row] * law.enthalpy(self.committed[row])
    }

    fn restore(&mut self, temperature: &[f64]) {
        self.committed.copy_from_slice(temperature);
        self.temperature.copy_from_slice(temperature);
        self.update_heat_capacity();
        self.start_over();
    }
}

/// Below this share of the temperature a rise gives no secant of the enthalpy, and c_p stands for it.
const SECANT: f64 = 1e-6;

/// The temperature in K to which a particle of a mass in kg, and of a heat capacity in J/K at the start, comes
/// with an energy in J.
fn moved(law: &HeatCapacity, start: f64, energy: f64, mass: f64, heat_capacity: f64) -> f64 {
    if law.is_constant() {
        start + energy / heat_capacity
    } else {
        law.temperature(law.enthalpy(start) + energy / mass)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{HeatLaws, NeighbourPair, plain};
    use calcine_physics::conduction::BatchelorObrien;

    #[test]
    fn the_eliminated_conductance_gives_the_implicit_step() {
        let mut thin = Thin::of_heat_capacity(vec![2.0], vec![300.0]);
        let (ha, span, gas) = (0.5, 8.0, 400.0);
        let mut k = [0.0];
        thin.eliminated(&[ha], span, &mut k);
        thin.advance(&[k[0] * (gas - 300.0)], span);
        // m c (T − 300) = hA Δτ (400 − T): T = (600 + 1600)/6
        assert!((thin.temperature()[0] - 2200.0 / 6.0).abs() < 1e-12);
        assert!((thin.stored_change().0 - 2.0 * (2200.0 / 6.0 - 300.0)).abs() < 1e-10);
        assert_eq!(thin.committed_temperature(), [300.0]);
    }

    #[test]
    fn an_attempt_starts_from_the_last_commit() {
        let mut thin = Thin::of_heat_capacity(vec![1.0], vec![300.0]);
        thin.advance(&[5.0], 1.0);
        thin.advance(&[7.0], 1.0);
        assert_eq!(thin.temperature(), [307.0]);
        thin.commit();
        thin.advance(&[1.0], 1.0);
        assert_eq!(thin.temperature(), [308.0]);
        thin.restore(&[301.0]);
        assert_eq!(
            (thin.temperature()[0], thin.committed_temperature()[0]),
            (301.0, 301.0)
        );
    }

    #[test]
    fn a_heat_capacity_that_follows_temperature_stores_exactly_what_came() {
        // c = 500 + (T − 300): from 300 to 400 K takes 550 · 100 J/kg.
        let law = HeatCapacity::table(vec![(300.0, 500.0), (600.0, 800.0)]);
        let mut thin = Thin::new(vec![2.0], vec![0], vec![law], vec![300.0], None);
        thin.advance(&[1100.0], 100.0);
        assert!((thin.temperature()[0] - 400.0).abs() < 1e-10);
        assert!((thin.stored_change().0 - 110_000.0).abs() < 1e-6);
        thin.commit();
        let mut k = [0.0];
        thin.eliminated(&[1e12], 1.0, &mut k);
        assert!((k[0] / (2.0 * 600.0) - 1.0).abs() < 1e-8, "m c at 400 K");
    }

    #[test]
    fn touching_particles_in_still_gas_relax_to_their_common_temperature() {
        let laws = HeatLaws::contacts(Box::new(BatchelorObrien));
        let network = HeatNetwork::new(laws, vec![plain(50.0)], vec![0; 2], Vec::new());
        let unit = vec![HeatCapacity::constant(1.0)];
        let mut thin = Thin::new(
            vec![1.0, 3.0],
            vec![0, 0],
            unit,
            vec![300.0, 400.0],
            Some(network),
        );
        thin.set_neighbours(&Neighbours {
            pairs: &[NeighbourPair {
                particles: [0, 1],
                radius: [5e-3; 2],
                overlap: 1e-6,
            }],
            walls: &[],
            views: None,
        });
        let still = NetworkSurroundings {
            conductance: &[0.0; 2],
            temperature: &[0.0; 2],
            gas_conductivity: &[0.026; 2],
            reservoirs: &[],
        };
        // exp(−G t (1/C₁ + 1/C₂)), G = 5e-3: 1000 implicit steps of 0.1 s are within 1e-3 of it.
        for _ in 0..1000 {
            thin.conduct(&still, 0.1);
            thin.advance(&[0.0; 2], 0.1);
            assert!(thin.stored_change().0.abs() < 1e-12);
            thin.commit();
        }
        let left = (thin.temperature()[1] - thin.temperature()[0]) / 100.0;
        let exact = (-5e-3_f64 * 100.0 * (1.0 + 1.0 / 3.0)).exp();
        assert!((left / exact - 1.0).abs() < 1e-3, "{left} {exact}");
    }
}
