//! Fuller, Schettler and Giddings 1966.

use super::Element;

/// The part A in m² Pa/s/K^1.75 of the diffusivity D = A T^1.75/p of two gases that depends on the
/// pair alone; molar masses M in kg/mol, diffusion volumes v as tabulated.
///
/// D = 0.00143 T^1.75/(p M_ab^½ (v_a^⅓ + v_b^⅓)²) in cm²/s, with p in bar and
/// M_ab = 2/(1/M_a + 1/M_b) in g/mol.
///
/// Conversion: cm²/s to m²/s, bar to Pa, kg/mol to g/mol.
///
/// Validity: dilute gases, on average within 4 %; T from 200 to 1100 K is what it was fitted to.
///
/// Source: Fuller, Schettler and Giddings, Ind. Eng. Chem. 58 (1966) 18, doi 10.1021/ie50677a007;
/// in the form and with the volumes of Poling, Prausnitz and O'Connell, The Properties of Gases and
/// Liquids (2001), equation 11-4.4 and table 11-1.
pub fn pair_coefficient(molar_masses: [f64; 2], volumes: [f64; 2]) -> f64 {
    let [m_a, m_b] = molar_masses.map(|m| 1e3 * m);
    let [v_a, v_b] = volumes;
    let m_ab = 2.0 / (1.0 / m_a + 1.0 / m_b);
    let in_bar_and_cm2 = 0.00143 / (m_ab.sqrt() * (v_a.cbrt() + v_b.cbrt()).powi(2));
    in_bar_and_cm2 * 1e5 * 1e-4
}

/// Diffusion volumes of atoms in molecules, by symbol: those of the same book's table 11-1.
const ATOMS: [(Element, f64); 5] = [
    (Element::C, 15.9),
    (Element::H, 2.31),
    (Element::O, 6.11),
    (Element::N, 4.54),
    (Element::S, 22.9),
];

/// Diffusion volume of a molecule of these atoms, in the order of [`Element::ALL`]: the sum of theirs; `None` where the
/// table lacks one. It takes off 18.3 for each aromatic ring, of which atoms do not tell.
pub fn volume_of(atoms: &[f64; Element::COUNT]) -> Option<f64> {
    let mut sum = 0.0;
    for (element, count) in Element::ALL.into_iter().zip(atoms) {
        if *count > 0.0 {
            let own = ATOMS.iter().find(|(one, _)| *one == element)?;
            sum += count * own.1;
        }
    }
    Some(sum)
}

/// T^1.75/p in K^1.75/Pa, the part of the diffusivity that all pairs share.
pub fn state_factor(pressure: f64, temperature: f64) -> f64 {
    // T^1.75 = T √T √√T: no general power.
    let root = temperature.sqrt();
    temperature * root * root.sqrt() / pressure
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // Nitrogen and hydrogen at 500 K and 2 bar in Python.
        let pair = pair_coefficient([28.014e-3, 2.016e-3], [18.5, 6.12]);
        let d = pair * state_factor(2e5, 500.0);
        assert!((d / 9.737621034878057e-5 - 1.0).abs() < 1e-12, "{d:e}");
    }

    #[test]
    fn volumes_of_atoms_add_up_where_all_are_tabulated() {
        // Methane's volume of the table of species is such a sum; ethene by hand: 2 · 15.9 + 4 · 2.31.
        let methane = crate::thermo::Species::built_in("CH4").unwrap();
        assert_eq!(volume_of(methane.atoms()), Some(methane.diffusion_volume()));
        let mut ethene = [0.0; Element::COUNT];
        ethene[Element::C as usize] = 2.0;
        ethene[Element::H as usize] = 4.0;
        assert!((volume_of(&ethene).unwrap() - 41.04).abs() < 1e-12);
        ethene[Element::Fe as usize] = 1.0;
        assert_eq!(volume_of(&ethene), None);
    }

    #[test]
    fn the_order_of_the_pair_does_not_matter() {
        let one = pair_coefficient([28e-3, 2e-3], [18.5, 6.12]);
        assert_eq!(one, pair_coefficient([2e-3, 28e-3], [6.12, 18.5]));
    }

    #[test]
    fn measured_diffusivities_are_met_within_5_percent() {
        // CRC Handbook of Chemistry and Physics, "Diffusion in gases", at 101325 Pa, in cm²/s.
        let (ar, n2, ch4, h2) = (
            (39.95, 16.2),
            (28.014, 18.5),
            (16.043, 25.14),
            (2.016, 6.12),
        );
        for (a, b, t, measured) in [
            (ar, n2, 293.15, 0.190),
            (ar, n2, 673.15, 0.815),
            (ch4, n2, 293.15, 0.208),
            (ch4, n2, 673.15, 0.890),
            (ch4, h2, 293.15, 0.708),
            (ch4, h2, 673.15, 3.070),
        ] {
            let pair = pair_coefficient([a.0 * 1e-3, b.0 * 1e-3], [a.1, b.1]);
            let d = 1e4 * pair * state_factor(101_325.0, t);
            assert!((d / measured - 1.0).abs() < 0.05, "{t}: {d} for {measured}");
        }
    }
}
