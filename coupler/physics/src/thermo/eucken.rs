//! The modified Eucken relation.

/// Thermal conductivity in W/m/K of a gas from its viscosity μ in Pa s, its isobaric heat capacity
/// c_p and its specific gas constant R_s, both in J/kg/K.
///
/// κ = μ c_v (1.32 + 1.77 R_s/c_v) = μ (1.32 (c_p − R_s) + 1.77 R_s) (docs/theory.md, COR-7).
///
/// Validity: non-polar gases within 8 %, mostly on the high side; exact for monatomic ones:
/// 1.32 + 1.77/1.5 = 2.5. Water vapour, whose internal energy travels slowly, comes out a third too
/// high at 600 K.
///
/// Source: Svehla, NASA TR R-132 (1962); Poling, Prausnitz and O'Connell, The Properties of Gases and
/// Liquids (2001), equation 10-3.3.
pub fn conductivity(viscosity: f64, heat_capacity: f64, gas_constant: f64) -> f64 {
    viscosity * (1.32 * (heat_capacity - gas_constant) + 1.77 * gas_constant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monatomic_gas_has_chapman_and_enskog_s_five_halves() {
        let gas_constant = 208.1;
        let kappa = conductivity(1.0, 2.5 * gas_constant, gas_constant);
        assert!((kappa / (2.5 * 1.5 * gas_constant) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python: 2e-5·(1000 − 300)·(1.32 + 1.77·300/700) = 0.0291.
        assert!((conductivity(2e-5, 1000.0, 300.0) / 0.0291 - 1.0).abs() < 1e-14);
    }
}
