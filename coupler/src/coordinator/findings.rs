//! Stage: what a window that is about to be committed leaves outside the range of a law, or unconverged.

use super::CoupledRun;
use crate::contacts;
use crate::excursion::Excursion;
use crate::findings::{Finding, FindingKind, FindingPlace};
use crate::part::{DEEP_CONTACT, Gas as _};
use calcine_interior::NetworkOutcome;

/// Round-off of mass and void fractions.
const ROUND_OFF: f64 = 1e-9;
/// Mach number up to which density differs by less than 5 % from that of gas at rest, (1 + (γ − 1)/2 Ma²)^(−1/(γ − 1)).
const LOW_MACH: f64 = 0.3;

impl CoupledRun {
    /// Gathers all findings of the window, in the order of their kinds.
    pub(super) fn gather_findings(&mut self) {
        let mut found = self.out_of_range();
        found.extend(self.unconverged());
        self.findings = found;
    }

    /// Gas, bed and particles outside the ranges of properties and laws.
    fn out_of_range(&self) -> Vec<Finding> {
        let (gas, laws) = (self.parts.gas.fields(), &self.laws);
        let id = self.parts.particles.fields().id;
        let centre = self.mesh.cell_centre();
        let cell = |cell: usize| FindingPlace::Cell(centre[cell]);
        let particle = |row: usize| FindingPlace::Particle(id[row]);
        let species = (gas.composition.len() / gas.temperature.len().max(1)).max(1);
        let temperatures = laws.closures.gas.temperature_range();
        let hot = Excursion::of(gas.temperature, temperatures);
        let shares = Excursion::of(gas.composition, (-ROUND_OFF, 1.0 + ROUND_OFF));
        let voids = &self.bed.mapped.bed.void_fraction;
        let voids = Excursion::of(voids, (f64::MIN_POSITIVE, 1.0 + ROUND_OFF));
        let solids = self.interior.models.temperature_excursion();
        let mut found = vec![
            Finding::outside(FindingKind::GasTemperature, &hot, cell),
            Finding::outside(FindingKind::MassFraction, &shares, |k| cell(k / species)),
            Finding::outside(FindingKind::MachNumber, &self.mach_numbers(), cell),
            Finding::outside(FindingKind::VoidFraction, &voids, cell),
            Finding::outside(FindingKind::ParticleTemperature, &solids, particle),
        ];
        let outside = &laws.coefficients.outside;
        for (flow, [voids, reynolds]) in [
            (
                &outside.drag,
                [FindingKind::DragVoidFraction, FindingKind::DragReynolds],
            ),
            (
                &outside.heat_transfer,
                [
                    FindingKind::HeatTransferVoidFraction,
                    FindingKind::HeatTransferReynolds,
                ],
            ),
            (
                &outside.mass_transfer,
                [
                    FindingKind::MassTransferVoidFraction,
                    FindingKind::MassTransferReynolds,
                ],
            ),
        ] {
            found.push(Finding::outside(voids, &flow.void_fraction, particle));
            found.push(Finding::outside(reynolds, &flow.reynolds, particle));
        }
        found.push(Finding::outside(
            FindingKind::DeepContacts,
            &self.deep_contacts(),
            particle,
        ));
        found.push(self.parts.gas.backflow().map(|back| Finding {
            kind: FindingKind::Backflow,
            count: back.faces,
            value: back.velocity,
            limit: Some(0.0),
            place: cell(back.cell),
        }));
        found.into_iter().flatten().collect()
    }

    /// Contacts that are pressed in farther than their law holds, by rows: as the solver of the particles saw them in its
    /// steps, or else those of two particles at the end of the window.
    fn deep_contacts(&self) -> Excursion {
        let mut found = Excursion::default();
        let free = &self.motion.free;
        if let Some(seen) = self.motion.received.deep_contacts {
            return seen;
        }
        let particles = self.parts.particles.fields();
        if particles.has_weights() || !free.contains(&true) {
            return found;
        }
        let places = (particles.radius, particles.position);
        for touch in contacts::touching(self.mesh.periodicity(), places.0, places.1, 0.0) {
            let ([a, b], [one, other]) = (touch.particles, touch.radius);
            if free[a] || free[b] {
                let smaller = if other < one { b } else { a };
                found.look(smaller, touch.overlap / one.min(other), (0.0, DEEP_CONTACT));
            }
        }
        found
    }

    /// Cells whose gas is faster than the low-Mach form holds.
    fn mach_numbers(&self) -> Excursion {
        let (gas, model) = (self.parts.gas.fields(), &self.laws.closures.gas);
        let species = gas.composition.len() / gas.temperature.len().max(1);
        let mut found = Excursion::default();
        for (cell, (velocity, temperature)) in gas.velocity.iter().zip(gas.temperature).enumerate()
        {
            let composition = &gas.composition[cell * species..][..species];
            let Some(sound) = model.sound_speed(*temperature, composition) else {
                break;
            };
            found.look(cell, velocity.norm() / sound, (0.0, LOW_MACH));
        }
        found
    }

    /// Iterations that ended at their limits.
    fn unconverged(&mut self) -> Vec<Finding> {
        let mut found = Vec::new();
        let id = self.parts.particles.fields().id;
        let (gas, agreement) = (&self.exchange.convergence, &self.exchange.agreement);
        if !gas.converged {
            // A solver of the user's own may measure its residual otherwise.
            let (kind, tolerance) = (FindingKind::GasIterations, self.plan.gas_tolerance);
            let limit = (gas.residual > tolerance).then_some(tolerance);
            found.push(Finding::unconverged(kind, gas.residual, limit));
        }
        if let Some(residual) = self.parts.gas.turbulence_residual() {
            let kind = FindingKind::TurbulenceSolver;
            found.push(Finding::unconverged(kind, residual, None));
        }
        if !agreement.settled {
            let (kind, limit) = (FindingKind::ExchangeAttempts, self.plan.exchange_tolerance);
            found.push(Finding::unconverged(kind, agreement.misplaced, Some(limit)));
        }
        match self.interior.network_outcome {
            NetworkOutcome::Settled => {}
            NetworkOutcome::Unsettled { change, row } => found.push(Finding {
                place: FindingPlace::Particle(id[row]),
                ..Finding::unconverged(FindingKind::NetworkIterations, change, None)
            }),
            NetworkOutcome::Unsolved { residual } => {
                let kind = FindingKind::NetworkSolver;
                found.push(Finding::unconverged(kind, residual, None));
            }
        }
        let views = self.interior.take_imbalance();
        if views.rows > 0 {
            found.push(Finding {
                count: views.rows as u64,
                place: id
                    .get(views.row)
                    .map_or(FindingPlace::Run, |id| FindingPlace::Particle(*id)),
                ..Finding::unconverged(FindingKind::ViewFactors, views.worst, None)
            });
        }
        found
    }
}
