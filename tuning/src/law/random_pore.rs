use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::conversion::KineticLaw;

/// Random pores with the structural parameter ψ, f = (1 − α) √(1 − ψ ln(1 − α)): α = 1 − exp(−x (1 + ψ x/4)). With ψ = 0 it is
/// first order.
///
/// Source: Bhatia and Perlmutter, AIChE J. 26 (1980) 379, doi 10.1002/aic.690260308.
#[derive(Clone, Copy, Debug)]
struct RandomPore {
    structure: f64,
}

impl KineticLaw for RandomPore {
    fn name(&self) -> &'static str {
        RANDOM_PORE.name
    }

    fn at(&self, x: f64) -> [f64; 3] {
        let psi = self.structure;
        let exponent = x * (1.0 + 0.25 * psi * x);
        let left = (-exponent).exp();
        if left == 0.0 {
            return [1.0, 0.0, 0.0];
        }
        let steep = 1.0 + 0.5 * psi * x;
        [
            -(-exponent).exp_m1(),
            steep * left,
            (0.5 * psi - steep * steep) * left,
        ]
    }

    fn reduced_time(&self, conversion: f64) -> f64 {
        // The root of x + ψ x²/4 = L without cancellation as ψ goes to zero.
        let logarithm = -(-conversion).ln_1p();
        2.0 * logarithm / (1.0 + (1.0 + self.structure * logarithm).sqrt())
    }
}

/// Random pores, `RPM`.
pub static RANDOM_PORE: LawEntry<dyn KineticLaw> = LawEntry {
    name: "RPM",
    summary: "Random pores: f = (1 - a) (1 - psi ln(1 - a))^(1/2).",
    source: "Bhatia and Perlmutter, AIChE J. 26 (1980) 379, doi 10.1002/aic.690260308",
    parameters: &[LawParameter {
        name: "structure",
        dimension: Dimension::NONE,
        bound: Bound::Between(0.0, 1000.0),
        default: Some(3.0),
        needed_with: None,
        meaning: "Structural parameter psi = 4 pi L (1 - porosity)/S^2 of the pores at the start.",
        example: "3",
    }],
    tables: &[],
    make: |values| {
        Box::new(RandomPore {
            structure: values[0],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation_and_its_differential_form() {
        // ψ = 3, x = 0.4: 1 − e^(−0.52); the slope is 1.6 e^(−0.52).
        let [alpha, slope, _] = RandomPore { structure: 3.0 }.at(0.4);
        assert!((alpha - 0.405_479_452_029_8).abs() < 1e-12, "{alpha}");
        let differential = (1.0 - alpha) * (1.0 - 3.0 * (1.0 - alpha).ln()).sqrt();
        assert!((slope - differential).abs() < 1e-14);
    }
}
