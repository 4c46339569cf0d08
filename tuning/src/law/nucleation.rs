use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::conversion::KineticLaw;

/// Nucleation and growth of Avrami and Erofeev, α = 1 − exp(−x^n): f = n (1 − α) [−ln(1 − α)]^(1 − 1/n). `A1` is first order.
///
/// Source: Avrami, J. Chem. Phys. 7 (1939) 1103, doi 10.1063/1.1750380.
#[derive(Clone, Copy, Debug)]
struct Avrami {
    name: &'static str,
    exponent: f64,
}

impl KineticLaw for Avrami {
    fn name(&self) -> &'static str {
        self.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        let n = self.exponent;
        if x == 0.0 {
            return match n {
                1.0 => [0.0, 1.0, -1.0],
                2.0 => [0.0, 0.0, 2.0],
                _ => [0.0; 3],
            };
        }
        let power = x.powf(n);
        let left = (-power).exp();
        let slope = n * power / x * left;
        // No power of a large x times an underflowed rest.
        let curvature = match left == 0.0 {
            true => 0.0,
            false => slope / x * (n - 1.0 - n * power),
        };
        [
            -(-power).exp_m1(),
            if left == 0.0 { 0.0 } else { slope },
            curvature,
        ]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        (-(-conversion).ln_1p()).powf(1.0 / self.exponent)
    }
}

/// Exponent 2, `A2`.
pub static AVRAMI_2: LawEntry<dyn KineticLaw> = LawEntry {
    name: "A2",
    summary: "Nucleation and growth, n = 2: f = 2 (1 - a) [-ln(1 - a)]^(1/2).",
    source: "Avrami, J. Chem. Phys. 7 (1939) 1103, doi 10.1063/1.1750380",
    parameters: &[],
    tables: &[],
    make: |_| {
        Box::new(Avrami {
            name: "A2",
            exponent: 2.0,
        })
    },
};

/// Exponent 3, `A3`.
pub static AVRAMI_3: LawEntry<dyn KineticLaw> = LawEntry {
    name: "A3",
    summary: "Nucleation and growth, n = 3: f = 3 (1 - a) [-ln(1 - a)]^(2/3).",
    source: "Avrami, J. Chem. Phys. 7 (1939) 1103, doi 10.1063/1.1750380",
    parameters: &[],
    tables: &[],
    make: |_| {
        Box::new(Avrami {
            name: "A3",
            exponent: 3.0,
        })
    },
};

/// Any exponent, `An`.
pub static AVRAMI: LawEntry<dyn KineticLaw> = LawEntry {
    name: "An",
    summary: "Nucleation and growth with any exponent n: f = n (1 - a) [-ln(1 - a)]^(1 - 1/n).",
    source: "Avrami, J. Chem. Phys. 7 (1939) 1103, doi 10.1063/1.1750380",
    parameters: &[LawParameter {
        name: "exponent",
        dimension: Dimension::NONE,
        bound: Bound::Between(0.5, 6.0),
        default: Some(1.5),
        needed_with: None,
        meaning: "Exponent n.",
        example: "1.5",
    }],
    tables: &[],
    make: |values| {
        Box::new(Avrami {
            name: "An",
            exponent: values[0],
        })
    },
};

#[cfg(test)]
mod tests {
    use crate::law::default_law;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 1 − e^(−0.49) and 2·0.7·e^(−0.49); f(α) = 2 (1 − α) √(−ln(1 − α)) is the same number.
        let [alpha, slope, _] = default_law("A2").unwrap().at(0.7);
        assert!((alpha - 0.387_373_605_815_583_5).abs() < 1e-14);
        assert!((slope - 0.857_676_951_858_183).abs() < 1e-14);
        let differential = 2.0 * (1.0 - alpha) * (-(1.0 - alpha).ln()).sqrt();
        assert!((slope - differential).abs() < 1e-14);
    }
}
