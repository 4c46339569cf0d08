//! The ledger: every window's mass, momentum and energy, summed over the run (docs/theory.md, CON-2).

use calcine_physics::Vec3;

use crate::flows::WindowFlows;

/// Name of the line that is no error: see [`Ledger::storage_clock`].
pub const STORAGE_CLOCK: &str = "storage_clock";

/// Name of the line that is no error either: see [`Ledger::drag_carry`].
pub const DRAG_CARRY: &str = "drag_carry";

/// Name of the line that is no error either: see [`Ledger::prescribed_heat`].
pub const PRESCRIBED_HEAT: &str = "prescribed_heat";

/// Of what all lines of a unit move, the share below which a line does not take part, as of what all elements move: what the
/// balances may leave open.
const TAKES_PART: f64 = 1e-10;

/// One line: the sum of |Σ terms| over the windows, against the sum of Σ|terms|.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BalanceLine {
    /// Signed sum over the windows of what did not close.
    pub drift: f64,
    /// Sum over the windows of |Σ terms|.
    pub error: f64,
    /// Sum over the windows of Σ |terms|.
    pub throughput: f64,
}

impl BalanceLine {
    /// Books one window: `sum` of the signed terms, `magnitude` the sum of their magnitudes.
    pub fn book(&mut self, sum: f64, magnitude: f64) {
        self.drift += sum;
        self.error += sum.abs();
        self.throughput += magnitude;
    }

    /// The error relative to the throughput; zero where nothing moved.
    pub fn relative_error(&self) -> f64 {
        if self.throughput > 0.0 {
            self.error / self.throughput
        } else {
            self.error
        }
    }
}

/// What particles carried in or out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CarriedInventory {
    /// Number of particles of the computation, whatever number of real ones each stands for; all else is of the real ones.
    pub particles: u64,
    /// Their mass in kg.
    pub mass: f64,
    /// Their energy in J, as their models count it: of particles that exchange mass with the gas from the elements on.
    pub enthalpy: f64,
    /// Their momentum in kg m/s of motion time.
    pub momentum: Vec3,
}

impl CarriedInventory {
    /// Adds one particle.
    pub fn add(&mut self, mass: f64, enthalpy: f64, velocity: Vec3) {
        self.particles += 1;
        self.mass += mass;
        self.enthalpy += enthalpy;
        self.momentum += mass * velocity;
    }

    /// Adds what others carried.
    pub fn add_all(&mut self, other: &Self) {
        self.particles += other.particles;
        self.mass += other.mass;
        self.enthalpy += other.enthalpy;
        self.momentum += other.momentum;
    }

    /// The numbers in one order, for a checkpoint.
    pub fn numbers(&self) -> [f64; 6] {
        let [x, y, z] = self.momentum.into();
        [self.particles as f64, self.mass, self.enthalpy, x, y, z]
    }

    /// From these numbers.
    pub fn from_numbers([particles, mass, enthalpy, x, y, z]: [f64; 6]) -> Self {
        Self {
            particles: particles as u64,
            mass,
            enthalpy,
            momentum: Vec3::new(x, y, z),
        }
    }
}

/// The ledger of a run. Gas amounts count in process time: where the gas stores over the motion
/// span (`accelerated`), what it stored counts AF times (docs/theory.md, TSM-4).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Gas mass in kg; where none passes the boundary, relative to what circulates within.
    pub mass: BalanceLine,
    /// Gas and particle energy together, in J.
    pub energy: BalanceLine,
    /// What one side gave against what the other took, in J.
    pub energy_exchange: BalanceLine,
    /// The impulse of drag on the gas against that on the particles, in N s, with what the gas owes at the end of a window
    /// and at its start.
    pub momentum_exchange: BalanceLine,
    /// The impulse in N s of drag that followed the particles (docs/theory.md, DRG-3) and that the gas gives a window late:
    /// no error. `drift` is what it owes at the end of the last window. `None` where drag is constant over windows.
    pub drag_carry: Option<BalanceLine>,
    /// The heat in J that something outside gave particles of a prescribed temperature (docs/theory.md, BND-1): no error, but
    /// a term of `energy`, of whose throughput it is a share. `drift` is its sum. `None` where no temperature is prescribed.
    pub prescribed_heat: Option<BalanceLine>,
    /// What bodies that store heat hold, in J, against what gas, particles and surroundings gave them (docs/theory.md, BOD-1).
    /// `None` where there is none.
    pub body_energy: Option<BalanceLine>,
    /// The gas' own momentum balance (residual of pressure and momentum solves), in N s.
    pub gas_momentum: BalanceLine,
    /// The momentum of that balance that two clocks make, Σ u (1 − 1/AF) Δ(ε ρ V) (docs/theory.md, TSM-8), in N s: no
    /// error, but what the balance would leave open without it.
    pub storage_clock: BalanceLine,
    /// Particle mass in kg: what the particles hold against what feeds and outlets moved.
    pub particle_mass: BalanceLine,
    /// Momentum of the particles that move, in N s: its change against what the gas, gravity, walls, held
    /// particles, feeds and outlets gave, where the solver counts the impulse of walls.
    pub particle_momentum: BalanceLine,
    /// What feeds brought and outlets took so far.
    pub fed_and_discharged: [CarriedInventory; 2],
    /// What was left so far of particles that were used up, burnt for example, and taken out.
    pub used_up: CarriedInventory,
    /// What particles carried so far that left the mesh and were taken out.
    pub lost: CarriedInventory,
    /// Mass of each element of a gas mixture in kg, by its symbol.
    pub elements: Vec<(String, BalanceLine)>,
    /// What passed in the last window; nothing before the first of a process.
    pub flows: WindowFlows,
}

impl Ledger {
    /// Lines by their stable names, those of elements apart; what is carried only where drag follows particles.
    pub fn lines(&self) -> Vec<(&'static str, &'static str, BalanceLine)> {
        let mut lines = vec![
            ("mass", "kg", self.mass),
            ("energy", "J", self.energy),
            ("energy_exchange", "J", self.energy_exchange),
            ("momentum", "N s", self.momentum_exchange),
            ("gas_momentum", "N s", self.gas_momentum),
            (STORAGE_CLOCK, "N s", self.storage_clock),
            ("particle_mass", "kg", self.particle_mass),
            ("particle_momentum", "N s", self.particle_momentum),
        ];
        lines.extend(self.body_energy.map(|line| ("body_energy", "J", line)));
        lines.extend(self.drag_carry.map(|line| (DRAG_CARRY, "N s", line)));
        lines.extend(
            self.prescribed_heat
                .map(|line| (PRESCRIBED_HEAT, "J", line)),
        );
        lines
    }

    /// The relative error of a line of a unit. One that does not take part, so that all it holds is round-off of what the others
    /// of its unit move, is measured against the largest of them.
    pub fn relative_error_in(&self, unit: &str, line: &BalanceLine) -> f64 {
        let all = self.lines().into_iter();
        let own = all.filter(|(_, other, _)| *other == unit);
        let largest = own.fold(0.0, |most: f64, (.., one)| most.max(one.throughput));
        match line.throughput < TAKES_PART * largest {
            true => line.error / largest,
            false => line.relative_error(),
        }
    }

    /// The relative error of an element's line. An element that does not take part, so that all its line holds is
    /// round-off of what the others move, is measured against what all elements move.
    pub fn relative_error_of(&self, element: &BalanceLine) -> f64 {
        let lines = self.elements.iter().map(|(_, line)| line.throughput);
        let all: f64 = lines.sum();
        match element.throughput < TAKES_PART * all {
            true => element.error / all,
            false => element.relative_error(),
        }
    }

    /// All lines in one order, elements and what is carried last, to be restored from a checkpoint.
    pub fn lines_mut(&mut self) -> Vec<&mut BalanceLine> {
        let mut lines = vec![
            &mut self.mass,
            &mut self.energy,
            &mut self.energy_exchange,
            &mut self.momentum_exchange,
            &mut self.gas_momentum,
            &mut self.storage_clock,
            &mut self.particle_mass,
            &mut self.particle_momentum,
        ];
        lines.extend(self.elements.iter_mut().map(|(_, line)| line));
        lines.extend(self.drag_carry.as_mut());
        lines.extend(self.prescribed_heat.as_mut());
        lines.extend(self.body_energy.as_mut());
        lines
    }

    /// All lines, in the order of `lines_mut`.
    pub fn all(&self) -> Vec<BalanceLine> {
        let mut ledger = self.clone();
        ledger.lines_mut().into_iter().map(|line| *line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_nothing_is_measured_against_those_of_its_unit() {
        let line = |error: f64, throughput: f64| BalanceLine {
            drift: error,
            error,
            throughput,
        };
        let ledger = Ledger {
            mass: line(1e-18, 2.0),
            energy: line(1e-9, 5.0),
            particle_mass: line(6e-32, 6e-32),
            ..Ledger::default()
        };
        assert_eq!(ledger.relative_error_in("kg", &ledger.particle_mass), 3e-32);
        assert_eq!(ledger.relative_error_in("kg", &ledger.mass), 5e-19);
        assert_eq!(ledger.relative_error_in("J", &ledger.energy), 2e-10);
        let trace = line(1e-6, 1e-6);
        assert_eq!(ledger.relative_error_in("kg", &trace), 1.0);
    }

    #[test]
    fn an_element_that_does_not_take_part_is_measured_against_those_that_do() {
        let line = |error: f64, throughput: f64| BalanceLine {
            drift: error,
            error,
            throughput,
        };
        let (carbon, aluminium, nothing) = (line(2e-16, 0.5), line(3e-18, 3e-18), line(0.0, 0.0));
        let ledger = Ledger {
            elements: vec![
                ("C".into(), carbon),
                ("Al".into(), aluminium),
                ("Fe".into(), nothing),
            ],
            ..Ledger::default()
        };
        assert_eq!(ledger.relative_error_of(&carbon), 4e-16);
        assert_eq!(ledger.relative_error_of(&aluminium), 6e-18);
        assert_eq!(ledger.relative_error_of(&nothing), 0.0);
        // A trace that takes part keeps its own scale.
        let trace = line(1e-6, 1e-6);
        assert_eq!(ledger.relative_error_of(&trace), 1.0);
    }
}
