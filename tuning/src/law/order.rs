use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::conversion::KineticLaw;

/// Reaction of order n in what is left, f = (1 − α)^n: 1 − α = (1 + (n − 1) x)^(−1/(n − 1)), which is e^(−x) at n = 1. Below
/// n = 1 it ends at x = 1/(1 − n).
///
/// Source: Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a, table 1.
#[derive(Clone, Copy, Debug)]
struct ReactionOrder {
    name: &'static str,
    order: f64,
}

/// Below this |(n − 1) x| the logarithm is that of its series, exact to round-off.
const SERIES: f64 = 1e-6;

impl KineticLaw for ReactionOrder {
    fn name(&self) -> &'static str {
        self.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        let excess = self.order - 1.0;
        let z = excess * x;
        if z <= -1.0 {
            return [1.0, 0.0, 0.0];
        }
        let logarithm = if z.abs() < SERIES {
            x * (1.0 - z * (0.5 - z / 3.0))
        } else {
            z.ln_1p() / excess
        };
        let left = (-logarithm).exp();
        let slope = left / (1.0 + z);
        [
            -(-logarithm).exp_m1(),
            slope,
            -self.order * slope / (1.0 + z),
        ]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        let (excess, logarithm) = (self.order - 1.0, -(-conversion).ln_1p());
        if (excess * logarithm).abs() < SERIES {
            logarithm * (1.0 + 0.5 * excess * logarithm)
        } else {
            (excess * logarithm).exp_m1() / excess
        }
    }
}

/// First order, `F1`; the first law of Avrami and Erofeev is the same.
pub static FIRST_ORDER: LawEntry<dyn KineticLaw> = LawEntry {
    name: "F1",
    summary: "First order: f = 1 - a.",
    source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
    parameters: &[],
    tables: &[],
    make: |_| {
        Box::new(ReactionOrder {
            name: "F1",
            order: 1.0,
        })
    },
};

/// Order n, `Fn`.
pub static REACTION_ORDER: LawEntry<dyn KineticLaw> = LawEntry {
    name: "Fn",
    summary: "Order n: f = (1 - a)^n.",
    source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
    parameters: &[LawParameter {
        name: "order",
        dimension: Dimension::NONE,
        bound: Bound::Between(0.0, 5.0),
        default: Some(1.5),
        needed_with: None,
        meaning: "Order n.",
        example: "1.5",
    }],
    tables: &[],
    make: |values| {
        Box::new(ReactionOrder {
            name: "Fn",
            order: values[0],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_independent_evaluations() {
        let of = |order| ReactionOrder { name: "Fn", order };
        // 1 − e^(−0.7); 1 − 1/√(1 + 2·0.7) of order 3; 1 − (1 − 0.35)² of order ½, whose end is x = 2.
        assert!((of(1.0).conversion(0.7) - 0.503_414_696_208_590_5).abs() < 1e-15);
        assert!((of(3.0).conversion(0.7) - 0.354_502_775_632_097_2).abs() < 1e-14);
        assert!((of(0.5).conversion(0.7) - 0.5775).abs() < 1e-14);
        assert_eq!(of(0.5).conversion(2.0), 1.0);
    }

    #[test]
    fn orders_next_to_one_tend_to_first_order() {
        let near = ReactionOrder {
            name: "Fn",
            order: 1.0 + 1e-7,
        };
        assert!((near.conversion(0.7) - 0.503_414_696_208_590_5).abs() < 1e-7);
    }
}
