//! Derivatives of a plant's rates by differences.

use super::flows::{FlowWorkspace, Moment};
use super::topology::Plant;
use crate::PlantError;

impl Plant {
    /// ∂f/∂y row by row, by differences: one-sided from `rates`, or `central`.
    #[expect(
        clippy::too_many_arguments,
        reason = "place, scales and memory of a Jacobian"
    )]
    pub(super) fn jacobian(
        &self,
        at: Moment,
        y: &[f64],
        rates: &[f64],
        scales: &[f64],
        work: &mut FlowWorkspace,
        matrix: &mut Vec<f64>,
        central: bool,
    ) -> Result<(), PlantError> {
        let n = self.unknowns;
        matrix.clear();
        matrix.resize(n * n, 0.0);
        let mut place = y.to_vec();
        let (mut above, mut below) = (rates.to_vec(), rates.to_vec());
        let streams = work.streams.clone();
        let share = if central { 1e-5 } else { 1e-7 };
        for (column, (value, scale)) in y.iter().zip(scales).enumerate() {
            let step = share * (scale + value.abs());
            place[column] = value + step;
            let high = place[column];
            self.rates(at, &place, work, &mut above)?;
            work.streams.copy_from_slice(&streams);
            let mut low = *value;
            if central {
                place[column] = value - step;
                low = place[column];
                self.rates(at, &place, work, &mut below)?;
                work.streams.copy_from_slice(&streams);
            }
            place[column] = *value;
            let inverse = 1.0 / (high - low);
            for (row, (above, below)) in above[..n].iter().zip(&below).enumerate() {
                matrix[row * n + column] = (above - below) * inverse;
            }
        }
        Ok(())
    }
}
