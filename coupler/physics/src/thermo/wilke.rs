//! Wilke 1950, and Mason and Saxena 1958.

use calcine_numerics::Lanes;

/// Interaction of the species of a mixture of dilute gases in its viscosity and conductivity.
///
/// μ = Σ_i x_i μ_i/Σ_j x_j Φ_ij,  κ = Σ_i x_i κ_i/Σ_j x_j Φ_ij, over mole fractions x,
/// Φ_ij = (1 + (μ_i/μ_j)^½ (M_j/M_i)^¼)²/√(8 (1 + M_i/M_j))
///
/// Mason and Saxena's factor 1.065 before Φ_ij (i ≠ j) is taken as one, as is usual since: the
/// conductivity's interaction is then that of the viscosity.
///
/// Validity: viscosity of non-polar mixtures within 1 to 2 %, with hydrogen within 10 %;
/// conductivity within some 5 %.
///
/// Sources: Wilke, J. Chem. Phys. 18 (1950) 517, doi 10.1063/1.1747673; Mason and Saxena,
/// Phys. Fluids 1 (1958) 361, doi 10.1063/1.1724352; Poling, Prausnitz and O'Connell, The Properties of
/// Gases and Liquids (2001), sections 9-5-2 and 10-6-2.
#[derive(Clone, Debug, PartialEq)]
pub struct Wilke {
    /// How many species there are.
    count: usize,
    /// (M_j/M_i)^¼, row i.
    mass_ratios: Vec<f64>,
    /// 1/√(8 (1 + M_i/M_j)), row i.
    scales: Vec<f64>,
}

impl Wilke {
    /// The parts that depend on the molar masses alone (any unit).
    pub fn new(molar_masses: &[f64]) -> Self {
        let pairs = || {
            molar_masses
                .iter()
                .flat_map(|m_i| molar_masses.iter().map(move |m_j| (m_i, m_j)))
        };
        Self {
            count: molar_masses.len(),
            mass_ratios: pairs()
                .map(|(m_i, m_j)| (m_j / m_i).sqrt().sqrt())
                .collect(),
            scales: pairs()
                .map(|(m_i, m_j)| 1.0 / (8.0 * (1.0 + m_i / m_j)).sqrt())
                .collect(),
        }
    }

    /// Weights w_i = x_i/Σ_j x_j Φ_ij, such that μ = Σ w_i μ_i and κ = Σ w_i κ_i; `amounts` are the x
    /// in any scale, `roots` the √μ_i. Allocates nothing.
    pub fn weights(&self, amounts: &[f64], roots: &[f64], weights: &mut [f64]) {
        for (i, weight) in weights.iter_mut().enumerate().take(self.count) {
            if amounts[i] == 0.0 {
                *weight = 0.0;
                continue;
            }
            let row = i * self.count..(i + 1) * self.count;
            let masses = &self.mass_ratios[row.clone()];
            let scales = &self.scales[row];
            let mut sum = 0.0;
            for j in 0..self.count {
                let one = 1.0 + roots[i] / roots[j] * masses[j];
                sum += amounts[j] * one * one * scales[j];
            }
            *weight = amounts[i] / sum;
        }
    }

    /// μ = Σ w_i μ_i of lanes, from amounts in any scale and the μ_i with their √μ_i.
    #[inline(always)]
    pub fn lanes<const N: usize>(
        &self,
        amounts: &[Lanes<N>],
        (values, roots): (&[Lanes<N>], &[Lanes<N>]),
    ) -> Lanes<N> {
        let mut all = Lanes::default();
        for i in 0..amounts.len() {
            let mut sum = Lanes::default();
            for j in 0..amounts.len() {
                let place = i * self.count + j;
                let one = roots[i] / roots[j] * self.mass_ratios[place] + 1.0;
                sum += amounts[j] * one * one * self.scales[place];
            }
            all += amounts[i] / sum * values[i];
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn viscosity(fractions: &[f64], viscosities: &[f64], molar_masses: &[f64]) -> f64 {
        let roots: Vec<f64> = viscosities.iter().map(|mu| mu.sqrt()).collect();
        let mut weights = vec![0.0; fractions.len()];
        Wilke::new(molar_masses).weights(fractions, &roots, &mut weights);
        weights.iter().zip(viscosities).map(|(w, mu)| w * mu).sum()
    }

    #[test]
    fn meets_the_worked_example_of_bird_stewart_and_lightfoot() {
        // Transport Phenomena, example 1.4-2: CO2, O2, N2 at 1 atm and 293 K, 1.714e-4 g/cm/s.
        let mu = viscosity(
            &[0.133, 0.039, 0.828],
            &[1462e-8, 2031e-8, 1754e-8],
            &[44.01, 32.00, 28.02],
        );
        assert!((mu / 1714e-8 - 1.0).abs() < 5e-4, "{mu:e}");
    }

    #[test]
    fn agrees_with_an_independent_evaluation_for_unlike_gases() {
        // 70 % H2, 30 % CO2 with 9e-6 and 15e-6 Pa s in Python.
        let mu = viscosity(&[0.7, 0.3], &[9e-6, 15e-6], &[2.016, 44.009]);
        assert!((mu / 1.478275769677468e-5 - 1.0).abs() < 1e-12, "{mu:e}");
    }

    #[test]
    fn a_pure_gas_and_a_mixture_of_equals_keep_their_viscosity() {
        for fractions in [[1.0, 0.0, 0.0], [0.2, 0.3, 0.5]] {
            let mu = viscosity(&fractions, &[2e-5; 3], &[30.0; 3]);
            assert!((mu / 2e-5 - 1.0).abs() < 1e-15);
        }
        assert_eq!(viscosity(&[0.0, 1.0], &[2e-5, 1e-5], &[30.0, 2.0]), 1e-5);
    }
}
