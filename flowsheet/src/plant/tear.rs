//! What makes the next guess of a recycle's tear streams.

use calcine_numerics::Anderson;

use super::topology::Plant;
use crate::sums::{sum, sum_of_sizes};

/// What a round has to leave of the residual of the round before, for flows to be all that the recycle depends on.
const GOOD: f64 = 1e-2;

/// The iteration of tear streams x ← g(x).
///
/// What goes round a bed mostly depends on one number, the flow that comes back: its residual shrinks by one ratio r in a
/// way round, and x + (g(x) − x)/(1 − r) is the solution. Recycles for which that does not do go on by Anderson's method.
///
/// Source: Aitken's process for vectors, after Smith, Ford and Sidi, SIAM Rev. 29 (1987) 199, doi 10.1137/1029042.
#[derive(Clone, Debug, Default)]
pub(super) struct TearIteration {
    /// What became of the last guess.
    pub(super) plain: Vec<f64>,
    residual: Vec<f64>,
    /// Sum of the residual's flows, and of their sizes, the time before.
    last: Option<[f64; 2]>,
    /// 1/(1 − r) once it is known.
    gain: Option<f64>,
    general: bool,
    anderson: Anderson,
}

impl TearIteration {
    /// Forgets everything.
    pub(super) fn restart(&mut self) {
        self.last = None;
        self.gain = None;
        self.general = false;
        self.anderson.clear();
    }

    /// The next guess, in place of what became of `x`.
    pub(super) fn next(&mut self, plant: &Plant, x: &mut [f64], new: &mut [f64]) {
        self.plain.clear();
        self.plain.extend_from_slice(new);
        if self.general {
            plant.weigh_heat(x, true);
            plant.weigh_heat(new, true);
            self.anderson.accelerate(x, new);
            plant.weigh_heat(new, false);
            return;
        }
        self.residual.clear();
        let pairs = new.iter().zip(&*x);
        self.residual.extend(pairs.map(|(new, x)| new - x));
        let width = plant.layout.width();
        let now = self
            .residual
            .chunks_exact(width)
            .fold([0.0; 2], |[flow, size], own| {
                let masses = &own[..width - 1];
                [flow + sum(masses), size + sum_of_sizes(masses)]
            });
        let Some(before) = self.last.replace(now) else {
            return;
        };
        match self.gain {
            None => {
                let ratio = now[0] / before[0];
                if ratio.is_finite() && ratio < 1.0 {
                    self.gain = Some(1.0 / (1.0 - ratio));
                }
            }
            Some(_) if now[1] > GOOD * before[1] => self.gain = None,
            Some(_) => {}
        }
        let Some(gain) = self.gain else {
            self.general = true;
            return;
        };
        for (new, residual) in new.iter_mut().zip(&self.residual) {
            *new += (gain - 1.0) * residual;
        }
    }
}
