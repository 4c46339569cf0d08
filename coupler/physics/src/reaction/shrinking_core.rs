//! Shrinking cores with any number of interfaces.

use calcine_numerics::Number;

use super::arrhenius::{ACTIVATION_ENERGY, Arrhenius, EXPONENT};
use super::layer_diffusivity::LayerDiffusivity;
use super::rate_law::RateLaw;
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter, LawTable, LawValues};
use crate::sphere;

/// Its entry in a case file.
pub static LAW: LawEntry<RateLaw> = LawEntry {
    name: "shrinking-core",
    summary: "At the surface of a core that shrinks, with gas film, layers and kinetics in series.",
    source: "Yagi and Kunii, 5th Symposium on Combustion (1955) 231, doi 10.1016/S0082-0784(55)80033-1; Spitzer, \
             Manning and Philbrook, Trans. Metall. Soc. AIME 236 (1966) 1715",
    parameters: &[],
    tables: &[RATE, LAYER_DIFFUSIVITY],
    make: |values| Box::new(made(values)),
};

const RATE: LawTable = LawTable {
    name: "rate",
    required: true,
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.",
    example: "{ factor = \"0.3 m/s\", activation_energy = \"70 kJ/mol\" }",
    by_name: None,
    parameters: &[
        LawParameter {
            name: "factor",
            dimension: Dimension::VELOCITY,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Of the rate by area of the interface and concentration of the gas.",
            example: "\"0.3 m/s\"",
        },
        EXPONENT,
        ACTIVATION_ENERGY,
    ],
    tables: &[],
};

const LAYER_DIFFUSIVITY: LawTable = LawTable {
    name: "layer_diffusivity",
    required: true,
    meaning: "Diffusivity of the gas in the pores of the layer that the reaction leaves, value (T/at)^exponent.",
    example: "{ value = \"1e-5 m^2/s\", at = \"1100 K\", exponent = 1.75 }",
    by_name: None,
    parameters: &[
        LawParameter {
            name: "value",
            dimension: Dimension::DIFFUSIVITY,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Its value.",
            example: "\"1e-5 m^2/s\"",
        },
        LawParameter {
            name: "at",
            dimension: Dimension::TEMPERATURE,
            bound: Bound::Positive,
            default: Some(1.0),
            needed_with: Some("exponent"),
            meaning: "The temperature of the value; required with an exponent.",
            example: "\"1100 K\"",
        },
        LawParameter {
            name: "exponent",
            dimension: Dimension::NONE,
            bound: Bound::Between(0.0, 4.0),
            default: Some(0.0),
            needed_with: None,
            meaning: "Exponent of the temperature, 0 to 4: kinetic theory has 1.5 to 2.",
            example: "1.75",
        },
    ],
    tables: &[],
};

/// From the values of its keys, in the order in which they are declared.
fn made(values: &LawValues) -> RateLaw {
    let rate = values.table(0).cloned().unwrap_or_default();
    let layer = values.table(1).cloned().unwrap_or_default();
    RateLaw::ShrinkingCore {
        rate_constant: Arrhenius::from_values(&rate),
        diffusivity: LayerDiffusivity {
            value: layer[0],
            at: layer[1],
            exponent: layer[2],
        },
    }
}

/// One interface of a particle whose layers react from the outside inwards, innermost first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface<N = f64> {
    /// Radius of the interface over that of the particle, 0 to 1.
    pub radius: N,
    /// Rate constant of the interface, both directions together, in m/s: the flux of the gas into an
    /// interface of concentration c is k (c − c*).
    pub rate_constant: N,
    /// Concentration c* of the gas in mol/m³ with which the interface is in equilibrium.
    pub equilibrium: N,
    /// Thickness of the layer outside the interface, up to the next one or to the surface, over the radius of the particle; in
    /// thin layers the difference of the radii has no digits.
    pub thickness: N,
    /// Effective diffusivity of the gas in that layer in m²/s.
    pub diffusivity: N,
}

impl<N: Number> Interface<N> {
    /// An interface at the centre, where nothing reacts.
    pub fn none() -> Self {
        let zero = N::constant(0.0);
        Self {
            radius: zero,
            rate_constant: zero,
            equilibrium: zero,
            thickness: zero,
            diffusivity: zero,
        }
    }
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
pub fn flows<N: Number>(radius: N, film: N, bulk: N, interfaces: &[Interface<N>], flows: &mut [N]) {
    let area = sphere::surface_of(radius);
    let count = interfaces.len();
    flows[..count].fill(N::constant(0.0));
    let layer = |i: usize| {
        let one = &interfaces[i];
        let outer = interfaces
            .get(i + 1)
            .map_or(N::constant(1.0), |next| next.radius);
        (one.thickness.value() > 0.0)
            .then(|| radius * one.thickness / (one.diffusivity * one.radius * outer))
    };
    // From the inside out: what lies within has the resistance z to the concentration e; `None` where
    // nothing there takes gas.
    let mut within: Option<(N, N)> = None;
    let mut branches = [None; MOST_INTERFACES];
    for (i, one) in interfaces.iter().enumerate() {
        let taking = one.rate_constant * one.radius * one.radius;
        if taking.value() > 0.0 {
            let (branch, joined) = join(taking, one.equilibrium, within);
            branches[i] = Some(branch);
            within = Some(joined);
        }
        if let (Some((z, _)), Some(resistance)) = (&mut within, layer(i)) {
            // Without anything taken within, the layer carries nothing.
            *z = *z + resistance;
        }
    }
    // From the outside in: what each interface takes of the flow that arrives.
    let Some((z, e)) = within else { return };
    let mut flow = (bulk - e) / (z + film.inverse());
    for (branch, out) in branches[..count].iter().zip(flows.iter_mut()).rev() {
        let Some(branch) = branch else {
            continue;
        };
        let taken = branch.drawn + branch.share * flow;
        *out = area * taken;
        if branch.innermost {
            break;
        }
        flow = flow - taken;
    }
}

/// How an interface shares a flow F with what lies within: it takes drawn + share · F.
#[derive(Clone, Copy)]
struct Branch<N> {
    share: N,
    drawn: N,
    innermost: bool,
}

/// An interface of conductance K and equilibrium c* beside what lies within, of resistance z to e; both together then are
/// one of resistance 1/(K + 1/z). With the concentration eliminated, the interface takes K ((e − c*)/z + F)/(K + 1/z): no
/// difference of concentrations loses digits, however large K is.
fn join<N: Number>(taking: N, rest: N, within: Option<(N, N)>) -> (Branch<N>, (N, N)) {
    let Some((z, e)) = within else {
        let branch = Branch {
            share: N::constant(1.0),
            drawn: N::constant(0.0),
            innermost: true,
        };
        return (branch, (taking.inverse(), rest));
    };
    let inner = z.inverse();
    let together = (inner + taking).inverse();
    let share = taking * together;
    let branch = Branch {
        share,
        drawn: share * (e - rest) * inner,
        innermost: false,
    };
    (branch, (together, e * inner * together + share * rest))
}

/// Most interfaces of a particle.
pub const MOST_INTERFACES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn one(radius: f64) -> Interface {
        Interface {
            radius,
            thickness: 1.0 - radius,
            rate_constant: 0.02,
            equilibrium: 1.0,
            diffusivity: 1e-5,
        }
    }

    fn of(interfaces: &[Interface]) -> Vec<f64> {
        let mut interfaces = interfaces.to_vec();
        for k in 1..interfaces.len() {
            interfaces[k - 1].thickness = interfaces[k].radius - interfaces[k - 1].radius;
        }
        let mut out = vec![f64::NAN; interfaces.len()];
        flows(5e-3, 0.05, 8.0, &interfaces, &mut out);
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
                thickness: 1.0 - 0.4,
                rate_constant: 0.03,
                equilibrium: 0.1,
                diffusivity: 2e-5,
            },
            Interface {
                radius: 0.6,
                thickness: 1.0 - 0.6,
                rate_constant: 0.02,
                equilibrium: 2.0,
                diffusivity: 3e-5,
            },
            Interface {
                radius: 0.9,
                thickness: 1.0 - 0.9,
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
    fn an_interface_that_is_infinitely_fast_leaves_what_lies_within_its_equilibrium() {
        // Within: (c* − e)/(R (ξ₂ − ξ₁)/(D ξ₁ ξ₂) + 1/(k ξ₁²)), whatever the fast one takes.
        let within = one(0.4);
        for rate_constant in [1e12, 1e20, 1e100] {
            let fast = Interface {
                rate_constant,
                equilibrium: 3.0,
                ..one(0.6)
            };
            let flows = of(&[within, fast]);
            let resistance = 5e-3 * 0.2 / (1e-5 * 0.4 * 0.6) + 1.0 / (0.02 * 0.16);
            let expected = 4.0 * PI * 25e-6 * 2.0 / resistance;
            assert!((flows[0] / expected - 1.0).abs() < 1e-9, "{rate_constant}");
            let outer = 5.0 / (20.0 + 500.0 * (1.0 / 0.6 - 1.0)) * 4.0 * PI * 25e-6;
            assert!(((flows[0] + flows[1]) / outer - 1.0).abs() < 1e-9);
        }
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
