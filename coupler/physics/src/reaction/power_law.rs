//! Rates by powers of concentrations.

use calcine_numerics::Number;

use super::arrhenius::{self, ACTIVATION_ENERGY, Arrhenius, EXPONENT};
use super::rate_law::RateLaw;
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter, LawTable, LawValues};

/// Its entry in a case file.
pub static LAW: LawEntry<RateLaw> = LawEntry {
    name: "power-law",
    summary: "In the whole particle, by powers of concentrations.",
    source: "docs/theory.md, RXN-1",
    parameters: &[],
    tables: &[RATE],
    make: |values| Box::new(made(values)),
};

const RATE: LawTable = LawTable {
    name: "rate",
    required: true,
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.",
    example: "{ factor = 3e4, activation_energy = \"60 kJ/mol\", orders = { Fe = 1, O2 = 1 } }",
    by_name: None,
    parameters: &[FACTOR, EXPONENT, ACTIVATION_ENERGY],
    tables: &[ORDERS, IN_SERIES],
};

const FACTOR: LawParameter = LawParameter {
    name: "factor",
    dimension: Dimension::NONE,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "A number in mol, m and s, of the rate in mol/m^3/s by concentrations in mol/m^3.",
    example: "3e4",
};

const ORDERS: LawTable = LawTable {
    name: "orders",
    required: true,
    meaning: "Order of each gas and solid; a negative one only of a gas that is always there.",
    example: "{ Fe = 1, O2 = 1 }",
    by_name: Some(Dimension::NONE),
    parameters: &[],
    tables: &[],
};

const IN_SERIES: LawTable = LawTable {
    name: "in_series",
    required: false,
    meaning: "A second rate constant in series, 1/k = 1/k1 + 1/k2, such as that of diffusion in pores.",
    example: "{ factor = 0.2, activation_energy = \"18 kJ/mol\" }",
    by_name: None,
    parameters: &[
        LawParameter {
            meaning: "As that of the first.",
            example: "0.2",
            ..FACTOR
        },
        EXPONENT,
        ACTIVATION_ENERGY,
    ],
    tables: &[],
};

/// From the values of its keys, in the order in which they are declared.
fn made(values: &LawValues) -> RateLaw {
    let rate = values.table(0).cloned().unwrap_or_default();
    let orders = rate.table(0).cloned().unwrap_or_default();
    RateLaw::PowerLaw {
        rate_constant: Arrhenius::from_values(&rate),
        in_series: rate.table(1).map(|slow| Arrhenius::from_values(slow)),
        orders: orders.by_name,
    }
}

/// Rate of a reaction in the volume of a particle in mol/m³/s,
///
/// r = k(T) Π c_i^n_i,
///
/// with the concentrations c of the solids in the particle (mol per m³ of the particle) and of gases at
/// its surface (mol/m³), each to its order. An order of zero is allowed (a factor of one, as long as the reactant is
/// there), a negative one only of a species that is always there.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLaw {
    /// k in (mol/m³)^(1 − Σ n)/s.
    pub rate_constant: Arrhenius,
    /// A second step in series with it, in the same unit.
    pub in_series: Option<Arrhenius>,
    /// Order of each solid, by its index.
    pub solids: Vec<(usize, f64)>,
    /// Order of each gas, by its index.
    pub gases: Vec<(usize, f64)>,
}

impl PowerLaw {
    /// The rate in mol/m³/s, but for the factor of one gas (by its index), which comes with its order.
    pub fn without<N: Number>(
        &self,
        key: Option<usize>,
        temperature: N,
        solid: impl Fn(usize) -> N,
        gas: impl Fn(usize) -> N,
    ) -> (N, f64) {
        let mut rate =
            arrhenius::in_series(&self.rate_constant, self.in_series.as_ref(), temperature);
        let mut order = 0.0;
        for &(s, n) in &self.solids {
            rate = rate * power(solid(s), n);
        }
        for &(g, n) in &self.gases {
            if Some(g) == key {
                order = n;
            } else {
                rate = rate * power(gas(g), n);
            }
        }
        (rate, order)
    }
}

/// c^n; nothing reacts of what is not there.
pub fn power<N: Number>(concentration: N, order: f64) -> N {
    let c = concentration.value();
    if order == 0.0 {
        N::constant(1.0)
    } else if order == 1.0 {
        concentration.positive()
    } else if c <= 0.0 {
        N::constant(0.0)
    } else {
        let value = c.powf(order);
        concentration.through(value, order * value / c)
    }
}

/// Concentration c in mol/m³ at a surface to which a film brings m (b − c) and of which r cⁿ is used, both in
/// mol/s: m (b − c) = r cⁿ with b the bulk concentration in mol/m³. By Newton's method on a function that is monotone;
/// closed for n = 0 and 1.
pub fn at_surface<N: Number>(bulk: N, film: N, rate: N, order: f64) -> N {
    let bulk = bulk.positive();
    if rate.value() <= 0.0 || film.value().is_infinite() {
        return bulk;
    }
    if order == 1.0 {
        return bulk * film / (film + rate);
    }
    if bulk.value() <= 0.0 {
        return bulk;
    }
    if order == 0.0 {
        return (bulk - rate / film).positive();
    }
    let c = balance(bulk.value(), film.value(), rate.value(), order);
    if c <= 0.0 {
        return N::constant(0.0);
    }
    // One more of Newton's steps, by the slope at the root, has the root's derivatives.
    let used = power(N::constant(c), order) * rate;
    let slope = film.value() + order * used.value() / c;
    N::constant(c) + (film * (bulk - N::constant(c)) - used).times(1.0 / slope)
}

/// The concentration for any order, zero where there is none: Newton's method for its logarithm on ln((m c + r cⁿ)/(m b)), whose slope
/// lies between one and n, so that it finds concentrations many powers of ten below that of the bulk.
fn balance(bulk: f64, film: f64, rate: f64, order: f64) -> f64 {
    let mut c = bulk;
    for _ in 0..200 {
        let (passed, used) = (film * c, rate * power(c, order));
        let both = passed + used;
        let slope = (passed + order * used) / both;
        if slope <= 0.0 {
            return 0.0;
        }
        let change = (both / (film * bulk)).ln() / slope;
        c *= (-change).exp();
        // Its error is squared with each step.
        if change.abs() <= 1e-8 {
            break;
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_the_product_of_its_powers() {
        let law = PowerLaw {
            rate_constant: Arrhenius {
                factor: 2.0,
                exponent: 0.0,
                activation_energy: 0.0,
            },
            in_series: None,
            solids: vec![(0, 2.0)],
            gases: vec![(1, 0.5), (2, 1.0)],
        };
        let (rate, order) = law.without(Some(1), 300.0, |_| 3.0, |_| 5.0);
        assert_eq!((rate, order), (2.0 * 9.0 * 5.0, 0.5));
        assert_eq!(law.without(None, 300.0, |_| 0.0, |_| 5.0).0, 0.0);
    }

    #[test]
    fn the_film_brings_what_the_surface_uses_for_any_order() {
        for order in [0.0, 0.3, 0.5, 1.0, 1.7, 2.0] {
            for rate in [1e-6, 1e-3, 1.0, 1e3] {
                let c = at_surface(4.0, 0.02, rate, order);
                let brought = 0.02 * (4.0 - c);
                if c > 0.0 {
                    let used = rate * power(c, order);
                    assert!((brought / used - 1.0).abs() < 1e-9, "{order} {rate} {c}");
                } else {
                    assert!(order == 0.0 && rate >= brought);
                }
            }
        }
    }

    #[test]
    fn a_reaction_of_any_order_and_rate_uses_what_the_film_brings() {
        for order in [0.1, 0.5, 0.9, 1.3, 2.0, 3.0] {
            for rate in [1e6, 1e12, 1e18] {
                let c = at_surface(4.0, 0.02, rate, order);
                let used = rate * power(c, order);
                let brought = 0.02 * (4.0 - c);
                assert!(
                    (used / brought - 1.0).abs() < 1e-12,
                    "{order} {rate:e}: {c:e}"
                );
            }
        }
    }

    #[test]
    fn derivatives_of_the_surface_s_concentration_are_difference_quotients() {
        use calcine_numerics::Dual;
        for order in [0.0, 0.4, 1.0, 1.7] {
            let dual = at_surface(
                Dual::<3>::along(4.0, 0),
                Dual::along(0.02, 1),
                Dual::along(0.03, 2),
                order,
            );
            let of = |x: [f64; 3]| at_surface(x[0], x[1], x[2], order);
            for (k, slope) in dual.slope.iter().enumerate() {
                let mut x = [4.0, 0.02, 0.03];
                let h = 1e-5 * x[k];
                x[k] += h;
                let above = of(x);
                x[k] -= 2.0 * h;
                let quotient = (above - of(x)) / (2.0 * h);
                assert!((slope - quotient).abs() < 1e-6 * (1.0 + quotient.abs()));
            }
        }
    }

    #[test]
    fn a_fast_film_leaves_the_bulk_s_concentration_and_a_fast_reaction_nothing() {
        assert!((at_surface(4.0, 1e12, 1.0, 0.5) - 4.0).abs() < 1e-10);
        assert!(at_surface(4.0, 1.0, 1e12, 1.0) < 1e-11);
        assert_eq!(at_surface(4.0, f64::INFINITY, 1.0, 1.0), 4.0);
        assert_eq!(at_surface(0.0, 1.0, 1.0, 0.5), 0.0);
    }
}
