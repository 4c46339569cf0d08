//! What a committed window leaves outside a law's range, or unconverged. Nothing of it ends a run: it is counted, told
//! of once and written to the results.

use calcine_physics::Vec3;

use crate::excursion::Excursion;

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingKind {
    /// Temperature of gas for which the polynomials of its species are not given.
    GasTemperature,
    /// Mass fraction of gas below 0 or above 1.
    MassFraction,
    /// Gas so fast that its density follows its velocity.
    MachNumber,
    /// Void fraction of a cell that is not in (0, 1].
    VoidFraction,
    /// Temperature of particles for which the properties of their material are not given.
    ParticleTemperature,
    /// Void fraction outside the drag law's range.
    DragVoidFraction,
    /// Reynolds number outside the drag law's range.
    DragReynolds,
    /// Void fraction outside the range of the heat transfer law.
    HeatTransferVoidFraction,
    /// Reynolds number outside the range of the heat transfer law.
    HeatTransferReynolds,
    /// Void fraction outside the range of the mass transfer law.
    MassTransferVoidFraction,
    /// Reynolds number outside the range of the mass transfer law.
    MassTransferReynolds,
    /// Particles that left the mesh and were taken out.
    LostParticles,
    /// Contacts pressed in so far that their law is no contact of bodies any more.
    DeepContacts,
    /// Gas comes back in through an outlet, in the state of the cell behind.
    Backflow,
    /// The gas' outer loop ended at its limit.
    GasIterations,
    /// The equations of turbulence ended above their tolerance.
    TurbulenceSolver,
    /// The exchange between gas and particles ended at its limit of attempts.
    ExchangeAttempts,
    /// The iteration over radiation and surface lines of the heat between particles ended at its limit.
    NetworkIterations,
    /// The linear solver of the heat between particles ended at its limit.
    NetworkSolver,
    /// A run whose balance of mass or energy is open at its end.
    OpenBalance,
    /// Feeds that found no room for what they should have brought by the end of the run.
    FeedsWait,
    /// View factors of particles that do not add up to their surface.
    ViewFactors,
}

impl FindingKind {
    /// All kinds.
    pub const ALL: [Self; 22] = [
        Self::GasTemperature,
        Self::MassFraction,
        Self::MachNumber,
        Self::VoidFraction,
        Self::ParticleTemperature,
        Self::DragVoidFraction,
        Self::DragReynolds,
        Self::HeatTransferVoidFraction,
        Self::HeatTransferReynolds,
        Self::MassTransferVoidFraction,
        Self::MassTransferReynolds,
        Self::LostParticles,
        Self::DeepContacts,
        Self::Backflow,
        Self::GasIterations,
        Self::TurbulenceSolver,
        Self::ExchangeAttempts,
        Self::NetworkIterations,
        Self::NetworkSolver,
        Self::OpenBalance,
        Self::FeedsWait,
        Self::ViewFactors,
    ];

    /// Name in results, what it is in words, and the unit of its value.
    fn about(self) -> [&'static str; 3] {
        match self {
            Self::GasTemperature => [
                "gas_temperature",
                "gas outside the temperatures for which its polynomials are given",
                "K",
            ],
            Self::MassFraction => ["mass_fraction", "mass fractions outside 0 to 1", "1"],
            Self::MachNumber => [
                "mach_number",
                "gas so fast that its density follows its velocity, which low-Mach flow leaves out; Mach number",
                "1",
            ],
            Self::VoidFraction => ["void_fraction", "void fractions outside 0 to 1", "1"],
            Self::ParticleTemperature => [
                "particle_temperature",
                "particles outside the temperatures for which their material's properties are given",
                "K",
            ],
            Self::DragVoidFraction => [
                "drag.void_fraction",
                "void fractions outside the range that the drag law's source states",
                "1",
            ],
            Self::DragReynolds => [
                "drag.reynolds",
                "Reynolds numbers outside the range that the drag law's source states",
                "1",
            ],
            Self::HeatTransferVoidFraction => [
                "heat_transfer.void_fraction",
                "void fractions outside the range that the heat transfer law's source states",
                "1",
            ],
            Self::HeatTransferReynolds => [
                "heat_transfer.reynolds",
                "Reynolds numbers outside the range that the heat transfer law's source states",
                "1",
            ],
            Self::MassTransferVoidFraction => [
                "mass_transfer.void_fraction",
                "void fractions outside the range that the mass transfer law's source states",
                "1",
            ],
            Self::MassTransferReynolds => [
                "mass_transfer.reynolds",
                "Reynolds numbers outside the range that the mass transfer law's source states",
                "1",
            ],
            Self::LostParticles => [
                "lost_particles",
                "particles left the gas mesh and were taken out (motion.lost): no wall closes it there, a wall has a hole, or the \
                 step is too long for the contacts, see walls, step and overlap in `calcine check`; speed",
                "m/s",
            ],
            Self::DeepContacts => [
                "deep_contacts",
                "particles pressed into walls or each other farther than contact laws hold: raise `young` of their material (spring \
                 stiffnesses where the case states them) before they go through, see overlap and step in `calcine check`; overlap \
                 over the smaller radius",
                "1",
            ],
            Self::Backflow => [
                "backflow",
                "gas comes back in through an outlet in the state of the cell behind, as its `backflow` is not stated; \
                 superficial velocity",
                "m/s",
            ],
            Self::GasIterations => [
                "gas_iterations",
                "the gas' outer loop ended at its limit (gas.controls.outer_iterations) above gas.controls.outer_tolerance: \
                 raise the one, or shorten the windows (time.motion_window, or time.process_step where the case has it); \
                 residual",
                "1",
            ],
            Self::TurbulenceSolver => [
                "turbulence_solver",
                "the equations of k and epsilon ended above their tolerance; relative residual",
                "1",
            ],
            Self::ExchangeAttempts => [
                "exchange_attempts",
                "the exchange between gas and particles ended at its limit (coupling.exchange.attempts); share \
                 misplaced",
                "1",
            ],
            Self::NetworkIterations => [
                "network_iterations",
                "the iteration over radiation and surfaces of the heat between particles ended at its limit; relative \
                 change of temperature",
                "1",
            ],
            Self::NetworkSolver => [
                "network_solver",
                "the linear solver of the heat between particles ended at its limit; relative residual",
                "1",
            ],
            Self::OpenBalance => [
                "open_balance",
                "the balance of mass or energy is open at the end of the run (its ledger): the solver of the gas stopped far from its \
                 solution; tighten its tolerances and loops; relative error",
                "1",
            ],
            Self::FeedsWait => [
                "feeds_wait",
                "feeds brought less than `mass_rate` and `batch` state, as new particles found no room in their regions: make the regions \
                 larger, or the flow smaller; share that is missing at the end",
                "1",
            ],
            Self::ViewFactors => [
                "view_factors",
                "view factors do not add up to one, and what is missing counts as reflected; relative error",
                "1",
            ],
        }
    }

    /// Stable name in results.
    pub fn name(self) -> &'static str {
        self.about()[0]
    }

    /// What it is, in words.
    pub fn words(self) -> &'static str {
        self.about()[1]
    }

    /// Unit of its value.
    pub fn unit(self) -> &'static str {
        self.about()[2]
    }
}

/// Where something was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FindingPlace {
    /// In the whole run.
    Run,
    /// In the cell with its centre here, in m.
    Cell(Vec3),
    /// At the particle of this id.
    Particle(u64),
    /// At the particle of this id, which left the mesh here, in m.
    Left {
        /// Its id.
        id: u64,
        /// Its centre in m.
        at: Vec3,
    },
}

/// Something that a committed window leaves outside a range, or unconverged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// What.
    pub kind: FindingKind,
    /// Values outside the range in cells or at particles; 1 for an iteration.
    pub count: u64,
    /// The worst value.
    pub value: f64,
    /// The end of the range, or the tolerance, that it is beyond; `None` where only the solver knows it.
    pub limit: Option<f64>,
    /// Where the worst value is.
    pub place: FindingPlace,
}

impl Finding {
    /// Values outside a range, if there are any; `place` says where a place in their list is.
    pub fn outside(
        kind: FindingKind,
        found: &Excursion,
        place: impl FnOnce(usize) -> FindingPlace,
    ) -> Option<Self> {
        (found.count > 0).then(|| Self {
            kind,
            count: found.count,
            value: found.value,
            limit: Some(found.limit),
            place: place(found.place),
        })
    }

    /// An iteration that ended with a value.
    pub fn unconverged(kind: FindingKind, value: f64, limit: Option<f64>) -> Self {
        Self {
            kind,
            count: 1,
            value,
            limit,
            place: FindingPlace::Run,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_names_of_their_own_in_the_order_of_their_list() {
        let mut names: Vec<&str> = FindingKind::ALL.iter().map(|kind| kind.name()).collect();
        assert!(FindingKind::ALL.is_sorted());
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), FindingKind::ALL.len());
    }
}
