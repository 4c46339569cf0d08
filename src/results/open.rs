//! What a run leaves open at its end: balances, and feeds that found no room.

use calcine_coupler::findings::{Finding, FindingKind};
use calcine_coupler::observer::CommittedState;

/// Energy in J that moves a kg of particles and gas below which none does.
const STILL: f64 = 1e-6;

/// Share of what feeds should bring that may wait at the end of a run.
const WAITING: f64 = 0.02;

/// Relative error above which a balance is open.
const OPEN: f64 = 1e-3;

/// The worse of the balances of mass and energy where it is open by more than round-off and solvers leave.
pub(super) fn open_balance(moment: &CommittedState<'_>) -> Option<Finding> {
    let ledger = moment.ledger;
    // Where nothing moves there is round-off alone.
    let moves = || {
        let particles = moment.particles;
        let of_particles = (0..particles.len()).map(|row| particles.row_mass(row));
        let cells = moment.gas.density.iter().zip(moment.mesh.cell_volume());
        let of_gas = cells
            .zip(&moment.bed.void_fraction)
            .map(|((density, volume), pores)| density * pores * volume);
        let mass = of_particles.sum::<f64>() + of_gas.sum::<f64>();
        ledger.energy.throughput > STILL * mass
    };
    let mut worst = ledger.mass.relative_error();
    let energy = ledger.energy.relative_error();
    if energy > worst.max(OPEN) && moves() {
        worst = energy;
    }
    (worst > OPEN).then(|| Finding::unconverged(FindingKind::OpenBalance, worst, Some(OPEN)))
}

/// What feeds should have brought and found no room for.
pub(super) fn feeds_wait(moment: &CommittedState<'_>) -> Option<Finding> {
    let [fed, _] = &moment.ledger.fed_and_discharged;
    let missing = moment.waiting / (fed.mass + moment.waiting);
    (missing > WAITING)
        .then(|| Finding::unconverged(FindingKind::FeedsWait, missing, Some(WAITING)))
}
