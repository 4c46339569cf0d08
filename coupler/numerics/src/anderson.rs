//! Fixed points, accelerated.

/// Anderson's acceleration of a fixed-point iteration x ← G(x).
///
/// With the residuals f_k = G(x_k) − x_k of the last iterates, the next one is
///
/// x_{k+1} = G(x_k) − (ΔX + ΔF) γ,   γ the least-squares solution of ΔF γ = f_k,
///
/// ΔX and ΔF being the differences of successive iterates and residuals: a quasi-Newton method whose secants are the
/// iteration's own history. Differences that earlier ones nearly span are left out. The products are sums in the order of
/// the values, so that bits do not depend on threads.
///
/// Sources: Anderson, J. ACM 12 (1965) 547, doi 10.1145/321296.321305; Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715,
/// doi 10.1137/10078356X; as quasi-Newton coupling: Degroote, Bathe and Vierendeels, Comput. Struct. 87 (2009) 793,
/// doi 10.1016/j.compstruc.2008.11.013.
#[derive(Clone, Debug, Default)]
pub struct Anderson {
    /// Iterate and residual of the last call; empty before the first.
    last: [Vec<f64>; 2],
    /// Differences, oldest first: of residuals, and of iterates and residuals together.
    history: Vec<[Vec<f64>; 2]>,
}

/// Most differences kept.
const DEPTH: usize = 5;
/// A difference of residuals of which less than this share is new is left out.
const NEW: f64 = 1e-4;

impl Anderson {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.history.clear();
        self.last.iter_mut().for_each(Vec::clear);
    }

    /// The next iterate, in place of what the iteration made of `x`.
    pub fn accelerate(&mut self, x: &[f64], made: &mut [f64]) {
        let residual: Vec<f64> = made.iter().zip(x).map(|(g, x)| g - x).collect();
        let [last_x, last_residual] = &mut self.last;
        if last_x.len() == x.len() {
            let change = difference(&residual, last_residual);
            let both = x.iter().zip(last_x.iter()).zip(&change);
            let both = both.map(|((x, before), f)| x - before + f).collect();
            if self.history.len() == DEPTH {
                self.history.remove(0);
            }
            self.history.push([change, both]);
        } else {
            self.history.clear();
        }
        last_x.clear();
        last_x.extend_from_slice(x);
        last_residual.clone_from(&residual);
        self.correct(residual, made);
    }

    /// Takes the least-squares combination off, newest difference first, by modified Gram–Schmidt.
    fn correct(&self, mut residual: Vec<f64>, made: &mut [f64]) {
        let mut basis: Vec<[Vec<f64>; 2]> = Vec::with_capacity(self.history.len());
        for pair in self.history.iter().rev() {
            let [mut change, mut both] = pair.clone();
            let size = norm(&change);
            for [known, known_both] in &basis {
                let share = dot(known, &change);
                subtract(&mut change, share, known);
                subtract(&mut both, share, known_both);
            }
            let left = norm(&change);
            if left <= NEW * size || !left.is_finite() {
                continue;
            }
            for list in [&mut change, &mut both] {
                list.iter_mut().for_each(|value| *value /= left);
            }
            let share = dot(&change, &residual);
            subtract(&mut residual, share, &change);
            subtract(made, share, &both);
            basis.push([change, both]);
        }
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn subtract(from: &mut [f64], share: f64, what: &[f64]) {
    from.iter_mut().zip(what).for_each(|(x, d)| *x -= share * d);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x ← A x + b with a matrix of spectral radius about 0.95, partly negative.
    fn linear(x: &[f64]) -> Vec<f64> {
        let eigen = [0.95, -0.8, 0.5, 0.3];
        let rotated = |x: &[f64], k: usize| x[k] + 0.3 * x[(k + 1) % 4];
        (0..4)
            .map(|k| eigen[k] * rotated(x, k) / 1.3 + k as f64 + 1.0)
            .collect()
    }

    fn steps(mut map: impl FnMut(&[f64]) -> Vec<f64>, accelerated: bool) -> usize {
        let mut method = Anderson::default();
        let mut x = vec![0.0; 4];
        for step in 1..500 {
            let mut made = map(&x);
            if norm(&difference(&made, &x)) < 1e-10 {
                return step;
            }
            if accelerated {
                method.accelerate(&x, &mut made);
            }
            x = made;
        }
        500
    }

    #[test]
    fn a_linear_iteration_of_four_unknowns_ends_after_as_many_differences() {
        assert!(steps(linear, true) <= 7, "{}", steps(linear, true));
        assert!(steps(linear, false) > 50, "{}", steps(linear, false));
    }

    #[test]
    fn an_iteration_that_diverges_by_itself_converges() {
        let map = |x: &[f64]| -> Vec<f64> {
            let pull = |k: usize| 1.0 - 1.6 * x[k] + 0.1 * x[(k + 1) % 4].sin();
            (0..4).map(pull).collect()
        };
        assert_eq!(steps(map, false), 500);
        assert!(steps(map, true) < 25, "{}", steps(map, true));
    }

    #[test]
    fn the_first_call_changes_nothing_nor_does_one_after_clear() {
        let mut method = Anderson::default();
        let (x, made) = ([1.0, 2.0], [1.5, 1.0]);
        for _ in 0..2 {
            let mut out = made;
            method.accelerate(&x, &mut out);
            assert_eq!(out, made);
            method.clear();
        }
    }

    #[test]
    fn an_iteration_that_stands_still_stays() {
        let mut method = Anderson::default();
        for _ in 0..4 {
            let mut made = [3.0, 4.0];
            method.accelerate(&[3.0, 4.0], &mut made);
            assert_eq!(made, [3.0, 4.0]);
        }
    }
}
