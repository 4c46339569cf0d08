//! Shrinking cores with any number of interfaces.

use std::f64::consts::PI;

/// One interface of a particle whose layers react from the outside inwards, innermost first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interface {
    /// Radius of the interface over that of the particle, 0 to 1.
    pub radius: f64,
    /// Rate constant of the interface, both directions together, in m/s: the flux of the gas into an
    /// interface of concentration c is k (c − c*).
    pub rate_constant: f64,
    /// Concentration c* of the gas in mol/m³ with which the interface is in equilibrium.
    pub equilibrium: f64,
    /// Effective diffusivity of the gas in m²/s in the layer outside the interface, up to the next one or
    /// to the surface.
    pub diffusivity: f64,
}

/// Flow of a gas into each interface of a sphere in mol/s, by film, layers and kinetics in series; layers
/// and interfaces are a ladder of resistances, each over the outer surface 4 π R²:
///
/// film 1/β, layer between the interfaces ξ < ξ' (in parts of R)  R (ξ' − ξ)/(D ξ ξ'), interface 1/(k ξ²).
///
/// What passes an interface's place but is not used there goes on inwards. The steady state of the gas in
/// the pores is assumed, and that the gas it is turned into diffuses back mole for mole, so that
/// concentrations of both sum to the same everywhere. An interface at the centre (ξ = 0) takes nothing.
///
/// Validity: dense layers or reaction much faster than diffusion in the reactant, so that interfaces are sharp; pores hold far less
/// gas than a layer's solid takes up.
///
/// Source: Yagi and Kunii, 5th Symposium on Combustion (1955) 231, doi 10.1016/S0082-0784(55)80033-1, for one
/// interface; Spitzer, Manning and Philbrook, Trans. Metall. Soc. AIME 236 (1966) 1715, and Tsay, Ray and
/// Szekely, AIChE J. 22 (1976) 1064, doi 10.1002/aic.690220617, for three.
pub fn flows(radius: f64, film: f64, bulk: f64, interfaces: &[Interface], flows: &mut [f64]) {
    let area = 4.0 * PI * radius * radius;
    // From the inside out: what lies within has the resistance z to the concentration e; `None` where
    // nothing there takes gas.
    let mut within: Option<(f64, f64)> = None;
    let count = interfaces.len();
    let mut sources = [(0.0, 0.0); MOST_INTERFACES];
    let layer = |i: usize| {
        let inner = interfaces[i].radius;
        let outer = interfaces.get(i + 1).map_or(1.0, |next| next.radius);
        if outer > inner {
            radius * (outer - inner) / (interfaces[i].diffusivity * inner * outer)
        } else {
            0.0
        }
    };
    for (i, one) in interfaces.iter().enumerate() {
        let taking = one.rate_constant * one.radius * one.radius;
        if taking > 0.0 {
            within = Some(match within {
                None => (1.0 / taking, one.equilibrium),
                Some((z, e)) => {
                    let both = 1.0 / z + taking;
                    (1.0 / both, (e / z + taking * one.equilibrium) / both)
                }
            });
        }
        if let Some((z, _)) = &mut within {
            // Without anything taken within, the layer carries nothing.
            *z += layer(i);
        }
        sources[i] = within.unwrap_or((f64::INFINITY, 0.0));
    }
    flows[..count].fill(0.0);
    let Some((z, e)) = within else { return };
    // From the outside in: concentrations at the interfaces, and what each takes of the flow.
    let mut flow = (bulk - e) / (z + 1.0 / film);
    let mut concentration = bulk - flow / film;
    for i in (0..count).rev() {
        if sources[i].0.is_infinite() {
            break;
        }
        concentration -= flow * layer(i);
        let one = &interfaces[i];
        let taken = one.rate_constant * one.radius * one.radius * (concentration - one.equilibrium);
        // The innermost takes what arrives: the difference would lose digits.
        let last = i == 0 || sources[i - 1].0.is_infinite();
        let taken = if last { flow } else { taken };
        flows[i] = area * taken;
        flow -= taken;
    }
}

/// Most interfaces of a particle.
pub const MOST_INTERFACES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    fn one(radius: f64) -> Interface {
        Interface {
            radius,
            rate_constant: 0.02,
            equilibrium: 1.0,
            diffusivity: 1e-5,
        }
    }

    fn of(interfaces: &[Interface]) -> Vec<f64> {
        let mut out = vec![f64::NAN; interfaces.len()];
        flows(5e-3, 0.05, 8.0, interfaces, &mut out);
        out
    }

    #[test]
    fn one_interface_is_film_layer_and_kinetics_in_series() {
        // 4 π R² 7/(1/0.05 + 5e-3/1e-5 (1/0.6 − 1) + 1/(0.02 · 0.36))
        let flow = of(&[one(0.6)])[0];
        let expected = 4.0 * PI * 25e-6 * 7.0 / (20.0 + 500.0 * (1.0 / 0.6 - 1.0) + 1.0 / 0.0072);
        assert!((flow / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn three_interfaces_agree_with_the_solution_of_their_linear_equations() {
        // Concentrations of the three interfaces by Gauss elimination in Python.
        let interfaces = [
            Interface {
                radius: 0.4,
                rate_constant: 0.03,
                equilibrium: 0.1,
                diffusivity: 2e-5,
            },
            Interface {
                radius: 0.6,
                rate_constant: 0.02,
                equilibrium: 2.0,
                diffusivity: 3e-5,
            },
            Interface {
                radius: 0.9,
                rate_constant: 0.01,
                equilibrium: 5.0,
                diffusivity: 4e-5,
            },
        ];
        let found = of(&interfaces);
        let expected = [
            3.124_120_470_397_266_3e-6,
            5.074_662_661_080_958e-6,
            4.224_012_694_101_549e-6,
        ];
        for (flow, expected) in found.iter().zip(expected) {
            assert!((flow / expected - 1.0).abs() < 1e-11, "{found:?}");
        }
    }

    #[test]
    fn a_core_that_is_gone_takes_nothing_and_hinders_nothing() {
        let two = of(&[one(0.0), one(0.6)]);
        assert_eq!(two[0], 0.0);
        assert_eq!(two[1], of(&[one(0.6)])[0]);
        assert_eq!(of(&[one(0.0)]), [0.0]);
    }

    #[test]
    fn interfaces_that_coincide_share_the_flow_by_their_rate_constants() {
        let alike = Interface {
            equilibrium: 1.0,
            ..one(1.0)
        };
        let flows = of(&[
            Interface {
                rate_constant: 0.01,
                ..alike
            },
            Interface {
                rate_constant: 0.03,
                ..alike
            },
        ]);
        assert!((flows[1] / flows[0] - 3.0).abs() < 1e-12);
        let sum = 4.0 * PI * 25e-6 * 7.0 / (20.0 + 1.0 / 0.04);
        assert!(((flows[0] + flows[1]) / sum - 1.0).abs() < 1e-13);
    }

    #[test]
    fn at_the_bulk_s_equilibrium_nothing_flows() {
        let still = Interface {
            equilibrium: 8.0,
            ..one(0.5)
        };
        assert!(of(&[still])[0].abs() < 1e-20);
    }
}
