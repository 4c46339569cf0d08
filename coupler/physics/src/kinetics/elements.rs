//! Mass fractions without negative ones, and with the elements that they must have.

use crate::thermo::{Element, Mixture};

/// Most passes of the correction; each leaves the square of what it found.
const MOST_PASSES: usize = 8;
/// Pivot, of a matrix with a unit diagonal, below which a row is a combination of earlier ones.
const DEPENDENT: f64 = 1e-13;
/// What an element may be off by at the end, as a share of the total mass.
const KEPT: f64 = 1e-15;

/// Mass of each element in a unit mass of each species.
///
/// An integration keeps the elements to round-off, as they are linear in the mass fractions, but leaves fractions of
/// −1e-12 where a species ends. [`Elements::restore`] sets these to zero and gives the elements back what that took, by
/// the correction Y_i λ·a_i, which is smallest in Σ (δY_i)²/Y_i: species that are not there stay away, and none becomes
/// negative.
#[derive(Clone, Debug)]
pub struct Elements {
    /// For each element that is there, its share of each species.
    rows: Vec<Vec<f64>>,
}

impl Elements {
    /// Those of a mixture.
    pub fn new(mixture: &Mixture) -> Self {
        Self {
            rows: mixture.elements().into_iter().map(|(_, row)| row).collect(),
        }
    }

    /// Number of elements.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Mass fractions of the elements.
    pub fn of(&self, fractions: &[f64]) -> [f64; Element::COUNT] {
        let mut masses = [0.0; Element::COUNT];
        for (mass, row) in masses.iter_mut().zip(&self.rows) {
            *mass = row.iter().zip(fractions).map(|(a, y)| a * y).sum();
        }
        masses
    }

    /// Makes the fractions non-negative with these masses of elements. What is left, if anything, is of elements
    /// that no species there can give back; the largest share is the result.
    pub fn restore(&self, masses: &[f64; Element::COUNT], fractions: &mut [f64]) -> f64 {
        fractions.iter_mut().for_each(|y| *y = y.max(0.0));
        let count = self.rows.len();
        let mut left = f64::INFINITY;
        for _ in 0..MOST_PASSES {
            let found = self.of(fractions);
            let mut lack = [0.0; Element::COUNT];
            for e in 0..count {
                lack[e] = masses[e] - found[e];
            }
            let worst = lack.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
            if worst <= KEPT || worst >= left {
                return worst;
            }
            left = worst;
            let multipliers = self.multipliers(fractions, &lack);
            for (k, y) in fractions.iter_mut().enumerate() {
                let rows = self.rows.iter().zip(&multipliers);
                let change: f64 = rows.map(|(row, l)| row[k] * l).sum();
                *y *= (1.0 + change).max(0.0);
            }
        }
        left
    }

    /// λ of (Σ_i Y_i a_ei a_fi) λ_f = lack_e, by Cholesky's factors of the matrix scaled to a unit diagonal.
    fn multipliers(
        &self,
        fractions: &[f64],
        lack: &[f64; Element::COUNT],
    ) -> [f64; Element::COUNT] {
        let count = self.rows.len();
        let entry = |e: usize, f: usize| -> f64 {
            let pairs = self.rows[e].iter().zip(&self.rows[f]).zip(fractions);
            pairs.map(|((a, b), y)| a * b * y).sum()
        };
        let mut scale = [0.0; Element::COUNT];
        for (e, s) in scale.iter_mut().enumerate().take(count) {
            let diagonal = entry(e, e);
            *s = if diagonal > 0.0 {
                1.0 / diagonal.sqrt()
            } else {
                0.0
            };
        }
        let mut factor = [[0.0; Element::COUNT]; Element::COUNT];
        let mut solved = [0.0; Element::COUNT];
        for e in 0..count {
            if scale[e] == 0.0 {
                continue;
            }
            for f in 0..=e {
                let known: f64 = (0..f).map(|g| factor[e][g] * factor[f][g]).sum();
                let rest = scale[e] * scale[f] * entry(e, f) - known;
                if f == e {
                    factor[e][e] = if rest > DEPENDENT { rest.sqrt() } else { 0.0 };
                } else if factor[f][f] > 0.0 {
                    factor[e][f] = rest / factor[f][f];
                }
            }
            if factor[e][e] > 0.0 {
                let known: f64 = (0..e).map(|g| factor[e][g] * solved[g]).sum();
                solved[e] = (scale[e] * lack[e] - known) / factor[e][e];
            }
        }
        let mut multipliers = [0.0; Element::COUNT];
        for e in (0..count).rev() {
            if factor[e][e] > 0.0 {
                let known: f64 = (e + 1..count).map(|g| factor[g][e] * multipliers[g]).sum();
                multipliers[e] = (solved[e] - known) / factor[e][e];
            }
        }
        for (l, s) in multipliers.iter_mut().zip(scale) {
            *l *= s;
        }
        multipliers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gas() -> Mixture {
        Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap()
    }

    #[test]
    fn negative_fractions_go_and_the_elements_stay() {
        let elements = Elements::new(&gas());
        let raw = [-3e-11, 0.02, 1e-3, -2e-12, 0.1, 0.14, 0.739 + 3.2e-11];
        let masses = elements.of(&raw);
        let mut fractions = raw;
        let left = elements.restore(&masses, &mut fractions);
        assert!(left < 1e-15, "{left:e}");
        for (new, old) in fractions.iter().zip(raw) {
            assert!(*new >= 0.0 && (new - old).abs() < 1e-9);
        }
        assert_eq!(fractions[0], 0.0);
        let found = elements.of(&fractions);
        for (found, expected) in found.iter().zip(masses) {
            assert!((found - expected).abs() <= 1e-15);
        }
    }

    #[test]
    fn what_is_already_right_is_left_to_the_bit() {
        let elements = Elements::new(&gas());
        let raw = [0.05, 0.2, 0.0, 0.0, 0.0, 0.0, 0.75];
        let mut fractions = raw;
        elements.restore(&elements.of(&raw), &mut fractions);
        assert_eq!(fractions, raw);
    }

    #[test]
    fn elements_that_one_species_alone_has_are_no_obstacle() {
        // Only methane: carbon and hydrogen are in one proportion.
        let elements = Elements::new(&gas());
        let mut fractions = [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5];
        let mut masses = elements.of(&fractions);
        masses.iter_mut().for_each(|mass| *mass *= 1.0 + 1e-10);
        let left = elements.restore(&masses, &mut fractions);
        assert!(left < 1e-15, "{left:e}");
    }
}
