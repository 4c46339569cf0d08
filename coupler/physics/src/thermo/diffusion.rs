//! Mixture-averaged diffusion.

use super::{Species, fuller};

/// Diffusivities D_k of the species of a mixture of ideal gases such that j_k = −ρ D_k ∇Y_k.
///
/// 1/D_k = Σ_{j≠k} x_j/D_kj + x_k/Σ_{j≠k} Y_j · Σ_{j≠k} Y_j/D_kj
///
/// with mole fractions x, mass fractions Y and the pairs' D_kj by [`fuller`]. The fluxes of this form
/// do not add up to zero of themselves; the solver takes their sum off in proportion to Y.
///
/// A pure gas has no limit of its own: there D_k is the self-diffusivity D_kk.
///
/// Validity: dilute gases; exact for two species, where it is D_12, and for traces.
///
/// Source: Kee, Coltrin and Glarborg, Chemically Reacting Flow (2003), equation 12.178,
/// doi 10.1002/0471461296; after Curtiss and Hirschfelder, J. Chem. Phys. 17 (1949) 550,
/// doi 10.1063/1.1747319.
#[derive(Clone, Debug, PartialEq)]
pub struct MixtureAveraged {
    /// 1/A of each pair, row by row; the diffusivity is A T^1.75/p.
    resistances: Vec<f64>,
    /// How many species there are.
    count: usize,
}

impl MixtureAveraged {
    /// The pairs of these species.
    pub fn new(species: &[Species]) -> Self {
        let pair = |one: &Species, other: &Species| {
            fuller::pair_coefficient(
                [one.molar_mass(), other.molar_mass()],
                [one.diffusion_volume(), other.diffusion_volume()],
            )
        };
        let rows = species.iter();
        Self {
            resistances: rows
                .flat_map(|one| species.iter().map(move |other| 1.0 / pair(one, other)))
                .collect(),
            count: species.len(),
        }
    }

    /// Diffusivity in m²/s of a pair of species at a pressure in Pa and a temperature in K.
    pub fn pair(&self, one: usize, other: usize, pressure: f64, temperature: f64) -> f64 {
        fuller::state_factor(pressure, temperature) / self.resistances[one * self.count + other]
    }

    /// Diffusivities in m²/s of all species; mole and mass fractions sum to one. Allocates nothing.
    pub fn diffusivities(
        &self,
        pressure: f64,
        temperature: f64,
        mole_fractions: &[f64],
        mass_fractions: &[f64],
        diffusivities: &mut [f64],
    ) {
        let factor = fuller::state_factor(pressure, temperature);
        for (k, diffusivity) in diffusivities.iter_mut().enumerate().take(self.count) {
            let row = &self.resistances[k * self.count..(k + 1) * self.count];
            let (mut by_moles, mut by_mass, mut others) = (0.0, 0.0, 0.0);
            for j in (0..self.count).filter(|j| *j != k) {
                by_moles += mole_fractions[j] * row[j];
                by_mass += mass_fractions[j] * row[j];
                others += mass_fractions[j];
            }
            let resistance = by_moles + mole_fractions[k] * by_mass / others;
            *diffusivity = if others > 0.0 {
                factor / resistance
            } else {
                factor / row[k]
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn species(names: &[&str]) -> Vec<Species> {
        names
            .iter()
            .map(|name| Species::built_in(name).unwrap())
            .collect()
    }

    fn averaged(names: &[&str], mole_fractions: &[f64]) -> Vec<f64> {
        let species = species(names);
        let masses = species.iter().zip(mole_fractions);
        let masses: Vec<f64> = masses.map(|(s, x)| s.molar_mass() * x).collect();
        let total: f64 = masses.iter().sum();
        let mass_fractions: Vec<f64> = masses.iter().map(|m| m / total).collect();
        let mut out = vec![0.0; names.len()];
        let law = MixtureAveraged::new(&species);
        law.diffusivities(1e5, 400.0, mole_fractions, &mass_fractions, &mut out);
        out
    }

    #[test]
    fn every_species_diffuses_in_nitrogen_as_an_independent_evaluation_has_it() {
        // Fuller's formula in Python at 300 K and 1 bar.
        for (name, expected) in [
            ("O2", 2.108370102666e-05),
            ("Ar", 2.012064511280e-05),
            ("CO2", 1.660872615949e-05),
            ("H2O", 2.639268432921e-05),
            ("CO", 2.107377716071e-05),
            ("H2", 7.966132994268e-05),
            ("CH4", 2.203368558444e-05),
        ] {
            let d = MixtureAveraged::new(&species(&["N2", name])).pair(1, 0, 1e5, 300.0);
            assert!((d / expected - 1.0).abs() < 1e-11, "{name}: {d:e}");
        }
    }

    #[test]
    fn two_gases_have_the_diffusivity_of_the_pair_in_any_proportion() {
        let pair = MixtureAveraged::new(&species(&["H2", "CO2"])).pair(0, 1, 1e5, 400.0);
        for x in [1e-12, 0.3, 0.9, 1.0 - 1e-12] {
            for d in averaged(&["H2", "CO2"], &[x, 1.0 - x]) {
                assert!((d / pair - 1.0).abs() < 1e-12, "{x}: {d} {pair}");
            }
        }
    }

    #[test]
    fn a_trace_diffuses_as_blanc_s_law_has_it() {
        // 1/D = Σ x_j/D_kj.
        let names = ["H2O", "N2", "CO2"];
        let law = MixtureAveraged::new(&species(&names));
        let d = averaged(&names, &[0.0, 0.6, 0.4])[0];
        let blanc = 0.6 / law.pair(0, 1, 1e5, 400.0) + 0.4 / law.pair(0, 2, 1e5, 400.0);
        assert!((d * blanc - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_pure_gas_diffuses_in_itself() {
        let law = MixtureAveraged::new(&species(&["N2", "O2"]));
        let d = averaged(&["N2", "O2"], &[1.0, 0.0]);
        assert!((d[0] / law.pair(0, 0, 1e5, 400.0) - 1.0).abs() < 1e-15);
        assert!((d[1] / law.pair(0, 1, 1e5, 400.0) - 1.0).abs() < 1e-15);
    }
}
