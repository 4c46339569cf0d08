//! Thermally thin particles: one temperature each.

use crate::ParticleModel;

/// Particles of uniform temperature: m c dT/dτ = Q. Good for Biot numbers below about 0.1.
#[derive(Clone, Debug, PartialEq)]
pub struct Thin {
    /// m c of each particle in J/K.
    heat_capacity: Vec<f64>,
    committed: Vec<f64>,
    temperature: Vec<f64>,
}

impl Thin {
    /// Particles of heat capacities m c in J/K at start temperatures in K.
    pub fn new(heat_capacity: Vec<f64>, temperature: Vec<f64>) -> Self {
        debug_assert_eq!(heat_capacity.len(), temperature.len());
        Self {
            heat_capacity,
            committed: temperature.clone(),
            temperature,
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

    fn eliminated(&self, conductance: &[f64], span: f64, out: &mut [f64]) {
        for ((k, &ha), &mc) in out.iter_mut().zip(conductance).zip(&self.heat_capacity) {
            *k = ha / (1.0 + ha * span / mc);
        }
    }

    fn advance(&mut self, heat: &[f64], span: f64) {
        let start = self.committed.iter().zip(&self.heat_capacity).zip(heat);
        for (temperature, ((committed, mc), q)) in self.temperature.iter_mut().zip(start) {
            *temperature = committed + q * span / mc;
        }
    }

    fn commit(&mut self) {
        self.committed.copy_from_slice(&self.temperature);
    }

    fn stored_change(&self) -> (f64, f64) {
        let change = |p: usize| self.heat_capacity[p] * (self.temperature[p] - self.committed[p]);
        (0..self.temperature.len()).fold((0.0, 0.0), |(sum, magnitude), p| {
            (sum + change(p), magnitude + change(p).abs())
        })
    }

    fn restore(&mut self, temperature: &[f64]) {
        self.committed.copy_from_slice(temperature);
        self.temperature.copy_from_slice(temperature);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eliminated_conductance_gives_the_implicit_step() {
        let mut thin = Thin::new(vec![2.0], vec![300.0]);
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
        let mut thin = Thin::new(vec![1.0], vec![300.0]);
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
}
