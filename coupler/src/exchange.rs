//! The exchange between gas and particles: stored once, the other side derived (docs/theory.md,
//! CON-4, TSM-9, DRG-1).
//!
//! A particle p that spans cells with the weights W_cp exchanges with each by that cell's own
//! temperature, W_cp h A (T_p' − T_c), so that no cell is driven beyond its neighbours and the particle
//! (a share W_cp of the particle's total would take heat from cells that have none to give). T_p' is
//! the particle's own new temperature; it is eliminated (TSM-9), with K_p = h A/(1 + h A Δτ/(m c)) and
//! T̄_p = Σ_c W_cp T_c:
//!
//! T_p' = (K_p T_p + (h A − K_p) T̄_p)/(h A),   Q_p = Σ_c W_cp h A (T_c − T_p') = K_p (T̄_p − T_p).
//!
//! T̄_p couples the particle's cells to each other. The gas gets the majorised form: a diagonal implicitly,
//! the rest at the last iterate (superscript k), with g_p = h A − K_p, at most K_p/2:
//!
//! R_c = Σ_p W_cp [K_p (T_p − T_c) + g_p (T̄_p^k − T_c^k)].
//!
//! Its sum over cells is −Σ_p Q_p whatever the iterate, because W is a partition of unity; iterating
//! only moves heat between the cells of one particle, and contracts at least twofold. (g_p reaches its
//! bound where h A Δτ/(m c) > ½: the particle's total stays exact, its cells are drawn together a
//! little less than they would be.) What the gas reports beyond R_c (a solver's tolerance, an enthalpy that
//! is not linear in T) is credited to the particles of the cell by their share W_cp K_p/H_c,
//! H_c = Σ_p W_cp K_p. Drag acts cell by cell too, W_cp K_A (v/AF − u_c); the velocity of particles
//! is given over a window, so that it does not couple its cells (for stiff drag K_A is what
//! `CouplingCoefficients::relax` makes of it).
//!
//! Momentum is exchanged by model A or B (docs/theory.md, DRG-1, [`crate::momentum_model`]): the coefficients
//! here are those that the model makes of the laws' K_A, and `push` adds what else the gas does to a
//! particle, −V_p Σ_c W_cp ∇p or the weight of what it displaces.

use calcine_numerics::parallel::{self, fill};
use calcine_physics::Vec3;

use crate::closures::CouplingCoefficients;
use crate::momentum_model::MomentumModel;
use crate::part::{
    CellExchange, CellReceived, DRAG_COEFFICIENT, GAS_VELOCITY, GasFields, ParticleFields,
    ParticlePush,
};
use crate::smoother::Operator;

/// How well the attempts of a window placed what they exchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExchangeConvergence {
    /// Attempts of the window, those included after which it was cut.
    pub attempts: u32,
    /// How often the window was cut before it was committed.
    pub cuts: u32,
    /// Share of the heat that the last attempt left in the wrong cells of a particle.
    pub misplaced: f64,
    /// False where the attempts ended at their limit with more misplaced than tolerated.
    pub settled: bool,
}

/// What does not change between the attempts of a window.
#[derive(Clone, Copy, Debug)]
pub struct ExchangeInputs<'a> {
    /// The operator W.
    pub operator: &'a Operator,
    /// The particles at the start of the window.
    pub particles: ParticleFields<'a>,
    /// Coefficients of drag and heat.
    pub coefficients: &'a CouplingCoefficients,
    /// The acceleration factor.
    pub acceleration: f64,
}

/// Difference of temperatures in K whose heat is none at all for the convergence of attempts: a bed in equilibrium
/// with its gas exchanges what round-off and the gas' own tolerance leave.
const FAINT: f64 = 1e-3;

/// The exchange of one window, with its scratch memory.
#[derive(Debug, Default)]
pub struct Exchange {
    /// What the gas is told.
    pub cells: CellExchange,
    /// Mean heat flow into each particle over the window in W.
    pub heat: Vec<f64>,
    /// Mean drag on each particle over the window in N, pressure force excluded.
    pub drag: Vec<Vec3>,
    /// K_p in W/K, set by the interior before `linearise`.
    pub conductance: Vec<f64>,
    /// Velocity in m/s of the gas that each particle sees, as the drag on it has it.
    gas_velocity: Vec<Vec3>,
    iterate: Iterate,
    scalar: Vec<f64>,
    vector: Vec<Vec3>,
    cell_scalar: Vec<f64>,
    cell_vector: Vec<Vec3>,
}

/// The gas at the last iterate, in cells and as the particles see it.
#[derive(Debug, Default)]
struct Iterate {
    temperature: Vec<f64>,
    sampled_temperature: Vec<f64>,
    /// Σ_p W_cp g_p of each cell in W/K.
    coupling_coefficient: Vec<f64>,
}

impl Exchange {
    fn resize(&mut self, cells: usize, particles: usize) {
        self.cells.drag_coefficient.resize(cells, 0.0);
        self.cells.drag_source.resize(cells, Vec3::zeros());
        self.cells.heat_coefficient.resize(cells, 0.0);
        self.cells.heat_source.resize(cells, 0.0);
        self.cell_scalar.resize(cells, 0.0);
        self.cell_vector.resize(cells, Vec3::zeros());
        self.heat.resize(particles, 0.0);
        self.drag.resize(particles, Vec3::zeros());
        self.scalar.resize(particles, 0.0);
        self.vector.resize(particles, Vec3::zeros());
        self.iterate.sampled_temperature.resize(particles, 0.0);
        self.iterate.coupling_coefficient.resize(cells, 0.0);
    }

    /// Begins the attempts with one set of laws: looks at the gas and spreads the drag, which no
    /// attempt changes.
    pub fn begin(&mut self, inputs: &ExchangeInputs<'_>, gas: &GasFields<'_>) {
        let operator = inputs.operator;
        self.resize(operator.cells(), operator.particles());
        self.iterate.temperature.clear();
        self.iterate.temperature.extend_from_slice(gas.temperature);
        operator.sample(gas.temperature, &mut self.iterate.sampled_temperature);

        let coefficients = inputs.coefficients;
        operator.spread(&coefficients.drag, &mut self.cells.drag_coefficient);
        fill(&mut self.vector, |p| {
            let velocity = inputs.particles.velocity[p];
            coefficients.drag_source(p, velocity, inputs.acceleration)
        });
        operator.spread_vectors(&self.vector, &mut self.cells.drag_source);
    }

    /// Takes from the gas, over a window of a motion span in s, the impulse of drag in N s that each cell owes from the
    /// window before; after [`Exchange::begin`].
    pub fn repay(&mut self, owed: &[Vec3], span: f64) {
        for (source, owed) in self.cells.drag_source.iter_mut().zip(owed) {
            *source -= owed / span;
        }
    }

    /// The gas temperature that each particle sees at the last iterate in K.
    pub fn sampled_temperature(&self) -> &[f64] {
        &self.iterate.sampled_temperature
    }

    /// Fills what the gas is told of heat, linearised about the last iterate. The exchange starts
    /// from these particle temperatures in K.
    pub fn linearise(&mut self, inputs: &ExchangeInputs<'_>, temperature: &[f64]) {
        let (operator, iterate) = (inputs.operator, &mut self.iterate);
        // K_p, g_p and the source side by side: three components cost little more than one.
        fill(&mut self.vector, |p| {
            let own = self.conductance[p];
            let coupling_coefficient =
                coupling_coefficient(inputs.coefficients.conductance[p], own);
            let seen = iterate.sampled_temperature[p];
            let source = own * temperature[p] + coupling_coefficient * seen;
            Vec3::new(own, coupling_coefficient, source)
        });
        operator.spread_vectors(&self.vector, &mut self.cell_vector);
        let sums = &self.cell_vector;
        fill(&mut self.cells.heat_coefficient, |c| sums[c].x);
        fill(&mut iterate.coupling_coefficient, |c| sums[c].y);
        let kelvin = &iterate.temperature;
        fill(&mut self.cells.heat_source, |c| {
            sums[c].z - sums[c].y * kelvin[c]
        });
    }

    /// Gives each particle the heat that the gas reports, takes the gas as the next iterate, and
    /// returns how far the attempt is from the exact coupling of the cells that a particle spans:
    /// the misplaced heat, as a share of all heat that was exchanged. The particle temperatures are
    /// those of `linearise`. Of the heat that the gas received, `carried` in W came with gas that particles
    /// set free and take.
    pub fn credit_heat(
        &mut self,
        inputs: &ExchangeInputs<'_>,
        temperature: &[f64],
        gas: &GasFields<'_>,
        received: &CellReceived,
        carried: &[f64],
    ) -> f64 {
        let (operator, coefficients) = (inputs.operator, inputs.coefficients);
        let exchange = &self.cells;
        // T_c − δ_c/H_c, with δ_c what the gas reports beyond R_c, and T_c side by side.
        fill(&mut self.cell_vector, |c| {
            let (own, coefficient) = (gas.temperature[c], exchange.heat_coefficient[c]);
            let apart = carried.get(c).copied().unwrap_or(0.0);
            let told = exchange.heat_source[c] - coefficient * own;
            let beyond = received.heat[c] - apart - told;
            let credited = own - ratio(beyond, coefficient);
            Vec3::new(credited, own, 0.0)
        });
        operator.sample_vectors(&self.cell_vector, &mut self.vector);
        let (seen, conductance, iterate) = (&self.vector, &self.conductance, &mut self.iterate);
        fill(&mut self.heat, |p| {
            conductance[p] * (seen[p].x - temperature[p])
        });
        let sampled = &mut iterate.sampled_temperature;
        parallel::update_both(&mut self.scalar, sampled, |p, drawn, sampled| {
            let before = std::mem::replace(sampled, seen[p].y);
            *drawn = coupling_coefficient(coefficients.conductance[p], conductance[p])
                * (*sampled - before);
        });
        operator.spread(&self.scalar, &mut self.cell_scalar);
        let drawn = &self.cell_scalar;
        let [misplaced, exchanged] = parallel::sums(operator.cells(), |c| {
            let change = gas.temperature[c] - iterate.temperature[c];
            let misplaced = iterate.coupling_coefficient[c] * change - drawn[c];
            [misplaced.abs(), received.heat[c].abs()]
        });
        iterate.temperature.copy_from_slice(gas.temperature);
        let faint = FAINT * parallel::sum(conductance.len(), |p| conductance[p]);
        share(misplaced, exchanged.max(faint))
    }

    /// The temperature in K at which a cell gave what the gas reports of the heat of its attempt; right after
    /// [`Exchange::credit_heat`].
    pub fn credited_temperature(&self, cell: usize) -> f64 {
        self.cell_vector[cell].x
    }

    /// Gives each particle the drag that the gas reports.
    pub fn credit_drag(
        &mut self,
        inputs: &ExchangeInputs<'_>,
        gas: &GasFields<'_>,
        received: &CellReceived,
    ) {
        let exchange = &self.cells;
        fill(&mut self.cell_vector, |c| {
            let (own, coefficient) = (gas.velocity[c], exchange.drag_coefficient[c]);
            let beyond = received.drag[c] - (exchange.drag_source[c] - coefficient * own);
            own - beyond.map(|beyond| ratio(beyond, coefficient))
        });
        let operator = inputs.operator;
        self.gas_velocity
            .resize(operator.particles(), Vec3::zeros());
        operator.sample_vectors(&self.cell_vector, &mut self.gas_velocity);
        let seen = &self.gas_velocity;
        fill(&mut self.drag, |p| {
            let slip = seen[p] - inputs.particles.velocity[p] / inputs.acceleration;
            inputs.coefficients.drag_at(p, slip)
        });
    }

    /// The force pushed to the particles: drag, and the force of pressure or buoyancy as the model has it
    /// (docs/theory.md, DRG-1), which alone goes to `pressure_force`. Gravity in m/s².
    pub fn push(
        &self,
        operator: &Operator,
        gas: &GasFields<'_>,
        solid_volume: &[f64],
        (model, gravity): (MomentumModel, Vec3),
        pressure_force: &mut Vec<Vec3>,
        push: &mut ParticlePush,
    ) {
        pressure_force.resize(operator.particles(), Vec3::zeros());
        let weights: Vec<Vec3>;
        let field = match model {
            MomentumModel::A => gas.pressure_gradient,
            MomentumModel::B => {
                weights = gas.density.iter().map(|rho| *rho * gravity).collect();
                &weights
            }
        };
        operator.sample_vectors(field, pressure_force);
        parallel::update(pressure_force, |p, force| {
            *force = model.pressure_force(solid_volume[p], *force, *force);
        });
        push.columns.clear();
        push.force.resize(operator.particles(), Vec3::zeros());
        fill(&mut push.force, |p| self.drag[p] + pressure_force[p]);
    }

    /// Has drag follow the particles as they move (docs/theory.md, DRG-3): in place of the mean of the window the solver
    /// gets coefficient and gas velocity, on the motion clock K/AF and AF u, beside the force of pressure or buoyancy.
    /// After [`Exchange::push`].
    pub fn follow(
        &self,
        coefficients: &CouplingCoefficients,
        acceleration: f64,
        pressure_force: &[Vec3],
        push: &mut ParticlePush,
    ) {
        push.force.copy_from_slice(pressure_force);
        let drag = coefficients.instantaneous_drag.iter();
        let coefficient = drag.map(|drag| drag / acceleration).collect();
        let velocity = self
            .gas_velocity
            .iter()
            .flat_map(|u| <[f64; 3]>::from(acceleration * u));
        push.columns.set(DRAG_COEFFICIENT, 1, coefficient);
        push.columns.set(GAS_VELOCITY, 3, velocity.collect());
    }
}

/// g_p: how strongly a particle draws its cells together, from h A and K_p, in W/K.
fn coupling_coefficient(conductance: f64, eliminated: f64) -> f64 {
    (conductance - eliminated).min(0.5 * eliminated)
}

/// What a cell took beyond what it was told, over its coefficient.
fn ratio(beyond: f64, coefficient: f64) -> f64 {
    if coefficient > 0.0 {
        beyond / coefficient
    } else {
        0.0
    }
}

fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 || whole < f64::MIN_POSITIVE {
        0.0
    } else {
        part / whole
    }
}
