//! The partially stirred reactor: turbulence mixes only a part of a cell finely enough to react.

/// Time in s in which turbulence mixes down to the molecules,
///
/// t_k = C_mix √(μ_eff/(ρ ε_t)),
///
/// from the constant C_mix (1 in OpenFOAM), the effective viscosity in Pa s, the density in kg/m³ and the dissipation
/// ε_t in m²/s³ (docs/theory.md, COR-16). Gas without dissipation is not mixed: the time is infinite; gas without viscosity
/// counts as mixed.
///
/// Source: Nordin, Complex chemistry modeling of diesel spray combustion, thesis, Chalmers (2001); Kärrholm, thesis, Chalmers (2008).
pub fn mixing_time(c_mix: f64, mu_eff: f64, rho: f64, eps_t: f64) -> f64 {
    if mu_eff <= 0.0 || c_mix <= 0.0 {
        0.0
    } else if eps_t <= 0.0 {
        f64::INFINITY
    } else {
        c_mix * (mu_eff / (rho * eps_t)).sqrt()
    }
}

/// Share of the cell that reacts, κ = t_c/(t_c + t_k), from the chemical and the mixing time in s: the rates of the
/// reactions are to be multiplied by it. κ = 1 where mixing is at once, or where nothing reacts.
pub fn reacting_fraction(t_chem: f64, t_mix: f64) -> f64 {
    if t_mix <= 0.0 || t_chem.is_infinite() {
        1.0
    } else {
        // Without the sum, which may overflow.
        1.0 / (1.0 + t_mix / t_chem)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinetics::{Mechanism, MixtureState};
    use crate::thermo::Mixture;

    #[test]
    fn instant_mixing_lets_everything_react_and_none_lets_nothing() {
        assert_eq!(reacting_fraction(1e-3, 0.0), 1.0);
        assert_eq!(reacting_fraction(f64::INFINITY, 1.0), 1.0);
        assert_eq!(reacting_fraction(1e-3, f64::INFINITY), 0.0);
        assert_eq!(mixing_time(1.0, 1e-3, 1.0, 0.0), f64::INFINITY);
        assert_eq!(mixing_time(1.0, 0.0, 1.0, 0.0), 0.0);
    }

    #[test]
    fn the_fraction_agrees_with_an_independent_evaluation() {
        // t_k = 0.5 √(4e-4/(0.4 · 250)) = 1e-3; κ = 3e-3/(3e-3 + 1e-3).
        let t_mix = mixing_time(0.5, 4e-4, 0.4, 250.0);
        assert!((t_mix / 1e-3 - 1.0).abs() < 1e-14);
        assert!((reacting_fraction(3e-3, t_mix) - 0.75).abs() < 1e-14);
    }

    #[test]
    fn the_chemical_time_is_four_total_concentrations_over_what_the_right_sides_gain() {
        let gas = Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap();
        let jl4 = Mechanism::jones_lindstedt(&gas).unwrap();
        let fractions = [0.03, 0.15, 0.02, 0.005, 0.05, 0.05, 0.695];
        let state = MixtureState {
            pressure: 101_325.0,
            temperature: 1600.0,
            fractions: &fractions,
        };
        let made: f64 = jl4
            .progress(state)
            .iter()
            .zip([3.0, 4.0, 1.0, 2.0])
            .map(|((forth, _), n)| n * forth)
            .sum();
        let total = 101_325.0 / (crate::gas::GAS_CONSTANT * 1600.0);
        let time = jl4.chemical_time(state);
        assert!((time / (4.0 * total / made) - 1.0).abs() < 1e-12);
        let inert = MixtureState {
            fractions: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            ..state
        };
        assert_eq!(jl4.chemical_time(inert), f64::INFINITY);
    }
}
