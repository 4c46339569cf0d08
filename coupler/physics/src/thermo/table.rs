//! The figures of the built-in species.
//!
//! Heat capacities: McBride, Gordon and Reno, Coefficients for Calculating Thermodynamic and Transport
//! Properties of Individual Species, NASA TM-4513 (1993), 200 to 6000 K; the record's own reference
//! stands with each species. GRI-Mech 3.0 has the same lower ranges for all but N2 and Ar, which it
//! takes from 300 K on only; its upper ranges end at 3500 K.
//!
//! Viscosities: A and S of Sutherland's formula are ours, fitted by least squares of the relative
//! deviation at 61 temperatures in geometric order from 300 to 1500 K to Chapman and Enskog's viscosity
//! 2.6693e-6 √(M T)/(σ² Ω), M in g/mol, σ in Å, with Neufeld's collision integral Ω(T k/ε) (J. Chem.
//! Phys. 57 (1972) 1100, doi 10.1063/1.1678363) and the σ, ε/k of GRI-Mech 3.0's transport data, which
//! stand with each species. For H2O, which is polar: to the dilute-gas limit of IAPWS R12-08, from 350
//! to 1500 K. The fit's largest deviation stands behind.
//!
//! Diffusion volumes: Poling, Prausnitz and O'Connell, The Properties of Gases and Liquids (2001),
//! table 11-1; for CH4 the sum of its atoms, 15.9 + 4 · 2.31.

use super::{Element, Nasa7, Sutherland};

/// What is known of a species.
pub struct SpeciesRecord {
    pub name: &'static str,
    pub atoms: &'static [(Element, f64)],
    pub polynomial: Nasa7,
    pub viscosity: Sutherland,
    pub diffusion_volume: f64,
}

const fn polynomial(low: [f64; 7], high: [f64; 7]) -> Nasa7 {
    Nasa7::checked([200.0, 1000.0, 6000.0], low, high)
}

const fn sutherland(coefficient: f64, temperature: f64) -> Sutherland {
    Sutherland {
        coefficient,
        temperature,
    }
}

/// Coefficients a₁ to a₇ of argon, in both ranges.
const ARGON: [f64; 7] = [2.5, 0.0, 0.0, 0.0, 0.0, -745.375, 4.37967491];

/// All built-in species.
pub static RECORDS: [SpeciesRecord; 8] = [
    SpeciesRecord {
        name: "N2",
        atoms: &[(Element::N, 2.0)],
        // TPIS 1978
        polynomial: polynomial(
            [
                3.53100528,
                -1.23660987e-4,
                -5.02999437e-7,
                2.43530612e-9,
                -1.40881235e-12,
                -1046.97628,
                2.96747468,
            ],
            [
                2.95257626,
                1.39690057e-3,
                -4.92631691e-7,
                7.86010367e-11,
                -4.60755321e-15,
                -923.948645,
                5.87189252,
            ],
        ),
        // σ = 3.621 Å, ε/k = 97.53 K; 1.8 %
        viscosity: sutherland(1.489e-6, 133.4),
        diffusion_volume: 18.5,
    },
    SpeciesRecord {
        name: "O2",
        atoms: &[(Element::O, 2.0)],
        // TPIS 1989
        polynomial: polynomial(
            [
                3.78245636,
                -2.99673415e-3,
                9.847302e-6,
                -9.68129508e-9,
                3.24372836e-12,
                -1063.94356,
                3.65767573,
            ],
            [
                3.66096083,
                6.56365523e-4,
                -1.41149485e-7,
                2.05797658e-11,
                -1.29913248e-15,
                -1215.97725,
                3.41536184,
            ],
        ),
        // σ = 3.458 Å, ε/k = 107.4 K; 1.7 %
        viscosity: sutherland(1.731e-6, 140.5),
        diffusion_volume: 16.3,
    },
    SpeciesRecord {
        name: "Ar",
        atoms: &[(Element::Ar, 1.0)],
        // NASA Lewis, June 1988
        polynomial: polynomial(ARGON, ARGON),
        // σ = 3.33 Å, ε/k = 136.5 K; 1.2 %
        viscosity: sutherland(2.05e-6, 164.1),
        diffusion_volume: 16.2,
    },
    SpeciesRecord {
        name: "CO2",
        atoms: &[(Element::C, 1.0), (Element::O, 2.0)],
        // NASA Lewis, July 1988
        polynomial: polynomial(
            [
                2.35677352,
                8.98459677e-3,
                -7.12356269e-6,
                2.45919022e-9,
                -1.43699548e-13,
                -4.83719697e4,
                9.90105222,
            ],
            [
                4.63659493,
                2.74131991e-3,
                -9.95828531e-7,
                1.60373011e-10,
                -9.16103468e-15,
                -4.90249341e4,
                -1.93534855,
            ],
        ),
        // σ = 3.763 Å, ε/k = 244 K; 0.4 %
        viscosity: sutherland(1.647e-6, 268.0),
        diffusion_volume: 26.9,
    },
    SpeciesRecord {
        name: "H2O",
        atoms: &[(Element::H, 2.0), (Element::O, 1.0)],
        // NASA Lewis, August 1989
        polynomial: polynomial(
            [
                4.19864056,
                -2.0364341e-3,
                6.52040211e-6,
                -5.48797062e-9,
                1.77197817e-12,
                -3.02937267e4,
                -0.849032208,
            ],
            [
                2.67703787,
                2.97318329e-3,
                -7.7376969e-7,
                9.44336689e-11,
                -4.26900959e-15,
                -2.98858938e4,
                6.88255571,
            ],
        ),
        // IAPWS R12-08; 2.0 %
        viscosity: sutherland(2.495e-6, 1101.0),
        diffusion_volume: 13.1,
    },
    SpeciesRecord {
        name: "CO",
        atoms: &[(Element::C, 1.0), (Element::O, 1.0)],
        // TPIS 1979
        polynomial: polynomial(
            [
                3.57953347,
                -6.1035368e-4,
                1.01681433e-6,
                9.07005884e-10,
                -9.04424499e-13,
                -1.4344086e4,
                3.50840928,
            ],
            [
                3.04848583,
                1.35172818e-3,
                -4.85794075e-7,
                7.88536486e-11,
                -4.69807489e-15,
                -1.42661171e4,
                6.0170979,
            ],
        ),
        // σ = 3.65 Å, ε/k = 98.1 K; 1.8 %
        viscosity: sutherland(1.465e-6, 133.8),
        diffusion_volume: 18.0,
    },
    SpeciesRecord {
        name: "H2",
        atoms: &[(Element::H, 2.0)],
        // TPIS 1978
        polynomial: polynomial(
            [
                2.34433112,
                7.98052075e-3,
                -1.9478151e-5,
                2.01572094e-8,
                -7.37611761e-12,
                -917.935173,
                0.683010238,
            ],
            [
                2.93286579,
                8.26607967e-4,
                -1.46402335e-7,
                1.54100359e-11,
                -6.88804432e-16,
                -813.065597,
                -1.02432887,
            ],
        ),
        // σ = 2.92 Å, ε/k = 38 K; 2.6 %
        viscosity: sutherland(6.909e-7, 108.9),
        diffusion_volume: 6.12,
    },
    SpeciesRecord {
        name: "CH4",
        atoms: &[(Element::C, 1.0), (Element::H, 4.0)],
        // NASA Lewis, August 1988
        polynomial: polynomial(
            [
                5.14987613,
                -0.0136709788,
                4.91800599e-5,
                -4.84743026e-8,
                1.66693956e-11,
                -1.02466476e4,
                -4.64130376,
            ],
            [
                1.63552643,
                0.0100842795,
                -3.36916254e-6,
                5.34958667e-10,
                -3.15518833e-14,
                -1.00056455e4,
                9.99313326,
            ],
        ),
        // σ = 3.746 Å, ε/k = 141.4 K; 1.2 %
        viscosity: sutherland(1.024e-6, 168.3),
        diffusion_volume: 25.14,
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermo::Species;

    /// Chapman and Enskog with Neufeld's collision integral, Pa s; M in g/mol, σ in Å.
    fn chapman_enskog(t: f64, molar_mass: f64, sigma: f64, depth: f64) -> f64 {
        let x = t / depth;
        let omega = 1.16145 * x.powf(-0.14874)
            + 0.52487 * (-0.7732 * x).exp()
            + 2.16178 * (-2.43787 * x).exp();
        2.6693e-6 * (molar_mass * t).sqrt() / (sigma * sigma * omega)
    }

    /// The dilute-gas limit of IAPWS R12-08 for water, Pa s.
    fn iapws(t: f64) -> f64 {
        let x = t / 647.096;
        let sum = 1.67752 + 2.20462 / x + 0.6366564 / (x * x) - 0.241605 / x.powi(3);
        1e-4 * x.sqrt() / sum
    }

    #[test]
    fn sutherland_s_viscosities_follow_kinetic_theory_as_closely_as_stated() {
        for (name, sigma, depth, worst) in [
            ("N2", 3.621, 97.53, 0.0185),
            ("O2", 3.458, 107.4, 0.017),
            ("CO2", 3.763, 244.0, 0.005),
            ("CO", 3.65, 98.1, 0.0185),
            ("H2", 2.92, 38.0, 0.026),
            ("CH4", 3.746, 141.4, 0.0125),
            ("Ar", 3.33, 136.5, 0.0125),
        ] {
            let gas = Species::built_in(name).unwrap();
            for k in 0..=60 {
                let t = 300.0 * 5f64.powf(f64::from(k) / 60.0);
                let theory = chapman_enskog(t, 1e3 * gas.molar_mass(), sigma, depth);
                let deviation = gas.viscosity(t) / theory - 1.0;
                assert!(deviation.abs() < worst, "{name} {t}: {deviation}");
            }
        }
        let water = Species::built_in("H2O").unwrap();
        for t in [350.0, 400.0, 500.0, 700.0, 1000.0, 1500.0] {
            let deviation = water.viscosity(t) / iapws(t) - 1.0;
            assert!(deviation.abs() < 0.02, "{t}: {deviation}");
        }
    }

    #[test]
    fn the_upper_ranges_start_at_the_enthalpy_at_which_the_lower_ones_end() {
        for record in &RECORDS {
            let h = |t| record.polynomial.enthalpy(t);
            let step = h(1000.0 * (1.0 + f64::EPSILON)) - h(1000.0);
            assert!(step.abs() < 1e-3, "{}: {step} J/mol", record.name);
            let joined = record.polynomial.joined();
            let step = joined.enthalpy(1000.0 * (1.0 + f64::EPSILON)) - joined.enthalpy(1000.0);
            assert!(step.abs() < 1e-9, "{}: {step} J/mol", record.name);
        }
    }

    #[test]
    fn sutherland_s_constants_are_where_the_fit_is_best() {
        // A 1 % nudge of A, or 10 % of S, raises the sum of squares: the constants are the fit's.
        let kinetic = [
            ("N2", 3.621, 97.53),
            ("O2", 3.458, 107.4),
            ("CO2", 3.763, 244.0),
            ("CO", 3.65, 98.1),
            ("H2", 2.92, 38.0),
            ("CH4", 3.746, 141.4),
            ("Ar", 3.33, 136.5),
        ];
        for (name, sigma, depth) in kinetic {
            let gas = Species::built_in(name).unwrap();
            let squares = |of_a: f64, of_s: f64| -> f64 {
                let law = sutherland(
                    of_a * gas.sutherland().coefficient,
                    of_s * gas.sutherland().temperature,
                );
                (0..=60)
                    .map(|k| 300.0 * 5f64.powf(f64::from(k) / 60.0))
                    .map(|t| {
                        let theory = chapman_enskog(t, 1e3 * gas.molar_mass(), sigma, depth);
                        (law.viscosity(t) / theory - 1.0).powi(2)
                    })
                    .sum()
            };
            let best = squares(1.0, 1.0);
            for (a, s) in [(0.995, 1.0), (1.005, 1.0), (1.0, 0.95), (1.0, 1.05)] {
                assert!(squares(a, s) > best, "{name} {a} {s}");
            }
        }
    }
}
