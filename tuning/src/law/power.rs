use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::conversion::KineticLaw;

/// Power law of nucleation, α = x^n up to x = 1: f = n α^(1 − 1/n).
///
/// Source: Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a, table 1.
#[derive(Clone, Copy, Debug)]
struct PowerLawOfNuclei {
    exponent: f64,
}

impl KineticLaw for PowerLawOfNuclei {
    fn name(&self) -> &'static str {
        POWER_LAW.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        let n = self.exponent;
        if x >= 1.0 {
            return [1.0, 0.0, 0.0];
        }
        if x == 0.0 {
            return [
                0.0,
                if n == 1.0 { 1.0 } else { 0.0 },
                if n == 2.0 { 2.0 } else { 0.0 },
            ];
        }
        let power = x.powf(n);
        [power, n * power / x, n * (n - 1.0) * power / (x * x)]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        conversion.powf(1.0 / self.exponent)
    }
}

/// Power law, `Pn`.
pub static POWER_LAW: LawEntry<dyn KineticLaw> = LawEntry {
    name: "Pn",
    summary: "Power law of nucleation: f = n a^(1 - 1/n).",
    source: "Khawam and Flanagan, J. Phys. Chem. B 110 (2006) 17315, doi 10.1021/jp062746a",
    parameters: &[LawParameter {
        name: "exponent",
        dimension: Dimension::NONE,
        bound: Bound::Between(0.5, 6.0),
        default: Some(2.0),
        needed_with: None,
        meaning: "Exponent n.",
        example: "2",
    }],
    tables: &[],
    make: |values| {
        Box::new(PowerLawOfNuclei {
            exponent: values[0],
        })
    },
};

#[cfg(test)]
mod tests {
    use crate::law::default_law;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // n = 2: 0.3², 2·0.3.
        let law = default_law("Pn").unwrap();
        let [alpha, slope, curvature] = law.at(0.3);
        assert!((alpha - 0.09).abs() < 1e-15 && (slope - 0.6).abs() < 1e-15);
        assert!((curvature - 2.0).abs() < 1e-13);
        assert_eq!(law.at(1.0), [1.0, 0.0, 0.0]);
    }
}
