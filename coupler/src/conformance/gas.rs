//! The laws of a gas, in a column of eleven cells through which air rises and heats a bed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_physics::Vec3;
use calcine_physics::gas::GasProperties;

use super::{LawError, LawOutcome, holds, is_refused, same, supervisor, window};
use crate::error::{FailureKind, PartError};
use crate::mesh::block::{BoxSpec, box_mesh};
use crate::mesh::{Mesh, MeshError};
use crate::part::{Balance, Bed, CellExchange, CellReceived, Convergence, Gas, PatchFlow};
use crate::setup::{Convection, GasControls, GasPatch, GasSetup, Schedule, WallHeat, WallVelocity};
use crate::supervisor::Supervisor;
use crate::time::GasStorage;

/// Cells of the column, one on the other.
pub const CELLS: usize = 11;
/// Side of a cell in m.
pub const SIDE: f64 = 0.01;
/// Superficial velocity at the bottom in m/s.
pub const SPEED: f64 = 0.5;
/// Temperature at the start, and of the bed, in K.
pub const COLD: f64 = 300.0;
/// Temperature of the gas that flows in, in K.
pub const WARM: f64 = 350.0;
/// Pressure at the top in Pa.
pub const PRESSURE: f64 = 101_325.0;

/// Length of a window in s: motion and process time.
const SPAN: [f64; 2] = [1e-3, 5e-3];

/// Makes the gas of a setup on a mesh, anew or from the folder of a checkpoint.
pub type MakeGas<'a> = dyn FnMut(&GasSetup, &Arc<Mesh>, Option<&Path>, &mut Supervisor) -> Result<Box<dyn Gas>, PartError>
    + 'a;

/// A gas and how well it must do.
pub struct GasUnderTest<'a> {
    /// Makes one.
    pub make: &'a mut MakeGas<'a>,
    /// A folder for checkpoints.
    pub scratch: &'a Path,
    /// What balances may leave open, relative to their terms.
    pub closure: f64,
    /// How far what is received may be from the told line at the fields that are shown, relative: an enthalpy
    /// equation that is linearised within its last iteration is a little off.
    pub told: f64,
}

type Law = fn(&mut Column<'_, '_>) -> Result<(), LawError>;

/// The laws by their names.
const LAWS: &[(&str, Law)] = &[
    ("fields_have_a_finite_value_for_every_cell", sized_fields),
    (
        "what_is_received_is_what_was_told_at_the_new_fields",
        received_as_told,
    ),
    ("balances_close_and_hold_what_was_received", balances_close),
    (
        "an_attempt_starts_from_the_last_commit_bit_for_bit",
        attempts_repeat,
    ),
    (
        "a_commit_changes_nothing_that_is_shown",
        commit_keeps_fields,
    ),
    (
        "a_run_goes_on_alike_after_a_checkpoint_and_from_it",
        goes_on_alike,
    ),
    (
        "an_attempt_that_is_not_committed_leaves_no_trace_in_a_checkpoint",
        checkpoint_is_of_the_commit,
    ),
    ("a_bed_without_pores_is_refused", refuses_no_pores),
    ("lists_of_another_length_are_refused", refuses_other_lengths),
    (
        "finishing_what_was_not_started_is_refused",
        refuses_unstarted,
    ),
    (
        "cooling_below_zero_ends_as_divergence_with_the_place",
        diverges_with_place,
    ),
    (
        "a_gas_that_is_dropped_within_an_attempt_ends",
        ends_when_dropped,
    ),
];

/// Runs all laws.
pub fn run(under_test: &mut GasUnderTest<'_>) -> Result<Vec<LawOutcome>, MeshError> {
    let mesh = Arc::new(mesh()?);
    let mut outcomes = Vec::new();
    for (number, &(name, law)) in LAWS.iter().enumerate() {
        let mut column = Column {
            mesh: Arc::clone(&mesh),
            setup: setup(&mesh),
            folder: under_test.scratch.join(format!("law-{number}")),
            supervisor: supervisor(),
            received: CellReceived::default(),
            under_test: &mut *under_test,
        };
        let result = law(&mut column);
        outcomes.push(LawOutcome { law: name, result });
    }
    Ok(outcomes)
}

/// The column: patches `bottom`, `top` and `side`.
pub fn mesh() -> Result<Mesh, MeshError> {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(SIDE, SIDE, SIDE * CELLS as f64),
        cells: [1, 1, CELLS],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
}

/// Air that rises through it.
pub fn setup(mesh: &Mesh) -> GasSetup {
    let condition = |name: &str| match name {
        "bottom" => GasPatch::inlet(Schedule::constant(SPEED), Schedule::constant(WARM)),
        "top" => GasPatch::outlet(Schedule::constant(PRESSURE)),
        _ => GasPatch::Wall {
            velocity: WallVelocity::Slip,
            heat: WallHeat::Adiabatic,
        },
    };
    let patches = mesh.patches().iter();
    GasSetup {
        mixture: "air".into(),
        properties: GasProperties::air().into(),
        schmidt: 1.0,
        chemistry: Default::default(),
        composition: Vec::new(),
        storage: GasStorage::Process,
        temperature: COLD,
        pressure: PRESSURE,
        velocity: Vec3::new(0.0, 0.0, SPEED),
        gravity: Vec3::zeros(),
        pressure_gradient: Vec3::zeros(),
        turbulence: Default::default(),
        momentum: Default::default(),
        patches: patches
            .map(|patch| (patch.name.clone(), condition(&patch.name)))
            .collect(),
        controls: GasControls {
            outer_iterations: 100,
            convection: Convection::Upwind,
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 16,
            outer_tolerance: 1e-11,
            linear_tolerance: Some(1e-13),
        },
    }
}

/// A bed in all cells but the last.
fn bed() -> Bed {
    let mut void_fraction = vec![0.5; CELLS];
    void_fraction[CELLS - 1] = 1.0;
    Bed { void_fraction }
}

/// Held particles of a temperature in K, which differ from cell to cell in how much they exchange.
fn exchange(temperature: f64) -> CellExchange {
    let share = |cell: usize| {
        if cell + 1 < CELLS {
            1.0 + 0.1 * cell as f64
        } else {
            0.0
        }
    };
    let cells = 0..CELLS;
    CellExchange {
        drag_coefficient: cells.clone().map(|cell| 2e-4 * share(cell)).collect(),
        drag_source: vec![Vec3::zeros(); CELLS],
        heat_coefficient: cells.clone().map(|cell| 0.02 * share(cell)).collect(),
        heat_source: cells.map(|cell| 0.02 * share(cell) * temperature).collect(),
        ..CellExchange::default()
    }
}

/// The fixture of a law.
struct Column<'a, 'b> {
    under_test: &'a mut GasUnderTest<'b>,
    mesh: Arc<Mesh>,
    setup: GasSetup,
    folder: PathBuf,
    supervisor: Supervisor,
    received: CellReceived,
}

impl Column<'_, '_> {
    fn make(&mut self, from: Option<&Path>) -> Result<Box<dyn Gas>, LawError> {
        let make = &mut self.under_test.make;
        Ok(make(&self.setup, &self.mesh, from, &mut self.supervisor)?)
    }

    fn attempt(
        &mut self,
        gas: &mut dyn Gas,
        index: u64,
        exchange: &CellExchange,
    ) -> Result<Convergence, LawError> {
        let window = window(index, SPAN[0], SPAN[1])?;
        gas.start(&window, &bed(), exchange)?;
        Ok(gas.finish(&self.supervisor, &mut self.received)?)
    }

    /// Attempts and commits windows of numbers, past heat that gets colder from window to window.
    fn advance(
        &mut self,
        gas: &mut dyn Gas,
        windows: std::ops::Range<u64>,
    ) -> Result<(), LawError> {
        for index in windows {
            self.attempt(gas, index, &exchange(COLD - index as f64))?;
            gas.commit()?;
        }
        Ok(())
    }

    /// A folder for a checkpoint, empty.
    fn checkpoint(&self, name: &str) -> Result<PathBuf, LawError> {
        let folder = self.folder.join(name);
        std::fs::create_dir_all(&folder)?;
        Ok(folder)
    }

    fn error_of(
        &mut self,
        gas: &mut dyn Gas,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<PartError, LawError> {
        let window = window(0, SPAN[0], SPAN[1])?;
        let started = gas.start(&window, bed, exchange);
        let ended = started.and_then(|()| gas.finish(&self.supervisor, &mut self.received));
        match ended {
            Ok(_) => Err(LawError::Broken("it took it".into())),
            Err(error) => Ok(error),
        }
    }
}

/// All bits of what a gas shows.
fn bits(gas: &dyn Gas) -> Vec<u64> {
    let fields = gas.fields();
    let scalars = [fields.temperature, fields.pressure, fields.density];
    let vectors = [fields.velocity, fields.pressure_gradient];
    let vectors = vectors
        .into_iter()
        .flatten()
        .flat_map(|vector| vector.iter());
    let all = scalars.into_iter().flatten().chain(vectors);
    all.map(|value| value.to_bits()).collect()
}

/// All bits of what it received.
fn received_bits(received: &CellReceived) -> Vec<u64> {
    let vectors = received.drag.iter().flat_map(|vector| vector.iter());
    let balances = [&received.mass, &received.energy].into_iter();
    let balances = balances
        .chain(&received.momentum)
        .flat_map(|one| [one.stored, one.boundary, one.exchange, one.source]);
    let values = received.heat.iter().chain(vectors).copied();
    values.chain(balances).map(f64::to_bits).collect()
}

fn sized_fields(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    for index in 0..2 {
        let fields = gas.fields();
        let lengths = [
            fields.temperature.len(),
            fields.pressure.len(),
            fields.density.len(),
            fields.velocity.len(),
            fields.pressure_gradient.len(),
        ];
        holds(lengths == [CELLS; 5], || {
            format!("lengths {lengths:?} for {CELLS} cells")
        })?;
        holds(fields.composition.is_empty(), || {
            "a single gas has a composition".into()
        })?;
        let physical = (0..CELLS).all(|cell| {
            fields.temperature[cell] > 0.0
                && fields.density[cell] > 0.0
                && fields.pressure[cell].is_finite()
                && fields.velocity[cell].iter().all(|x| x.is_finite())
        });
        holds(physical, || "a field holds what no gas has".into())?;
        column.advance(&mut *gas, index..index + 1)?;
    }
    Ok(())
}

fn received_as_told(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    column.advance(&mut *gas, 0..2)?;
    let told = exchange(COLD - 40.0);
    let convergence = column.attempt(&mut *gas, 2, &told)?;
    holds(convergence.converged, || {
        "the attempt did not converge".into()
    })?;
    let (fields, received) = (gas.fields(), &column.received);
    for cell in 0..CELLS {
        let heat = told.heat_source[cell] - told.heat_coefficient[cell] * fields.temperature[cell];
        let drag = told.drag_source[cell] - told.drag_coefficient[cell] * fields.velocity[cell];
        let off = (received.heat[cell] - heat).abs() / told.heat_source[cell].abs().max(1e-30);
        let slip = (received.drag[cell] - drag).norm() / drag.norm().max(1e-12);
        holds(
            off <= column.under_test.told && slip <= column.under_test.told,
            || {
                format!(
                    "cell {cell} received {} W and {:?} N, told were {heat} W and {drag:?} N",
                    received.heat[cell], received.drag[cell]
                )
            },
        )?;
    }
    Ok(())
}

/// What a balance leaves open, relative to terms.
fn left(balance: &Balance, terms: f64) -> f64 {
    let open = balance.open();
    if terms == 0.0 {
        open.abs()
    } else {
        open.abs() / terms
    }
}

fn balances_close(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    for index in 0..3 {
        column.advance(&mut *gas, index..index + 1)?;
        let received = &column.received;
        // Momentum is a vector: where one component is all round-off, its size is that of the others.
        let [x, y, z] = &received.momentum;
        let momentum = [x, y, z].map(Balance::magnitude).iter().sum();
        let balances = [
            ("mass", &received.mass, received.mass.magnitude()),
            ("energy", &received.energy, received.energy.magnitude()),
            ("momentum x", x, momentum),
            ("momentum y", y, momentum),
            ("momentum z", z, momentum),
        ];
        for (name, balance, terms) in balances {
            let left = left(balance, terms);
            holds(left <= column.under_test.closure, || {
                format!("window {index}: {name} leaves {left:.1e} of its terms: {balance:?}")
            })?;
        }
        let heat = SPAN[1] * received.heat.iter().sum::<f64>();
        let drag = SPAN[0] * received.drag.iter().map(|drag| drag.z).sum::<f64>();
        for (name, sum, booked) in [
            ("heat", heat, received.energy.exchange),
            ("drag", drag, received.momentum[2].exchange),
        ] {
            holds((sum - booked).abs() <= 1e-12 * sum.abs(), || {
                format!(
                    "window {index}: the {name} of the cells adds up to {sum}, booked is {booked}"
                )
            })?;
        }
        holds(received.mass.boundary_magnitude > 0.0, || {
            "no gas flows".into()
        })?;
        patches_add_up(received)?;
    }
    Ok(())
}

/// What passes the patches, where the gas tells it, is what passes the boundary.
fn patches_add_up(received: &CellReceived) -> Result<(), LawError> {
    let patches = &received.patches;
    if patches.is_empty() {
        return Ok(());
    }
    let sum = |of: &dyn Fn(&PatchFlow) -> f64| patches.iter().map(of).sum::<f64>();
    for (k, balance) in received.species.iter().enumerate() {
        let flow = SPAN[1] * sum(&|one| one.species[k]);
        let off = (flow - balance.boundary).abs();
        holds(off <= 1e-12 * balance.boundary_magnitude, || {
            format!(
                "species {k} through the patches adds up to {flow} kg, through the boundary to {}",
                balance.boundary
            )
        })?;
    }
    let [x, y, z] = &received.momentum;
    let momentum = [x, y, z].map(|one| one.boundary_magnitude).iter().sum();
    for (name, flow, span, balance, size) in [
        ("mass", sum(&|one| one.mass), SPAN[1], &received.mass, 0.0),
        ("heat", sum(&|one| one.heat), SPAN[1], &received.energy, 0.0),
        ("momentum", sum(&|one| one.momentum.x), SPAN[0], x, momentum),
        ("momentum", sum(&|one| one.momentum.y), SPAN[0], y, momentum),
        ("momentum", sum(&|one| one.momentum.z), SPAN[0], z, momentum),
    ] {
        let size = balance.boundary_magnitude.max(size);
        holds(
            (span * flow - balance.boundary).abs() <= 1e-12 * size,
            || {
                format!(
                    "the {name} through the patches adds up to {}, that through the boundary is {}",
                    span * flow,
                    balance.boundary
                )
            },
        )?;
    }
    Ok(())
}

fn attempts_repeat(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    column.advance(&mut *gas, 0..2)?;
    column.attempt(&mut *gas, 2, &exchange(COLD))?;
    let (shown, received) = (bits(&*gas), received_bits(&column.received));
    column.attempt(&mut *gas, 2, &exchange(2.0 * COLD))?;
    holds(bits(&*gas) != shown, || {
        "another exchange changes nothing".into()
    })?;
    column.attempt(&mut *gas, 2, &exchange(COLD))?;
    same("the fields", &bits(&*gas), &shown)?;
    same(
        "what was received",
        &received_bits(&column.received),
        &received,
    )
}

fn commit_keeps_fields(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    column.attempt(&mut *gas, 0, &exchange(COLD))?;
    let shown = bits(&*gas);
    gas.commit()?;
    same("the fields", &bits(&*gas), &shown)
}

fn goes_on_alike(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let folder = column.checkpoint("at-3")?;
    let mut gas = column.make(None)?;
    column.advance(&mut *gas, 0..3)?;
    gas.checkpoint(&folder)?;
    let at_checkpoint = bits(&*gas);
    column.advance(&mut *gas, 3..5)?;
    let at_end = bits(&*gas);
    drop(gas);
    column.supervisor = supervisor();
    let mut resumed = column.make(Some(&folder))?;
    same(
        "the state that was taken up",
        &bits(&*resumed),
        &at_checkpoint,
    )?;
    column.advance(&mut *resumed, 3..5)?;
    same("two windows later", &bits(&*resumed), &at_end)?;
    resumed.finish_run(&column.supervisor)?;
    Ok(())
}

fn checkpoint_is_of_the_commit(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let (plain, after) = (column.checkpoint("plain")?, column.checkpoint("after")?);
    let mut gas = column.make(None)?;
    column.advance(&mut *gas, 0..2)?;
    gas.checkpoint(&plain)?;
    let committed = bits(&*gas);
    column.attempt(&mut *gas, 2, &exchange(2.0 * COLD))?;
    gas.checkpoint(&after)?;
    same("the fields", &bits(&*gas), &committed)
}

fn refuses_no_pores(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    let mut bed = bed();
    bed.void_fraction[4] = 0.0;
    let error = column.error_of(&mut *gas, &bed, &exchange(COLD))?;
    is_refused(&error, &[FailureKind::InvalidInput], "cell 4")
}

fn refuses_other_lengths(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    let mut short = exchange(COLD);
    short.heat_source.pop();
    let error = column.error_of(&mut *gas, &bed(), &short)?;
    is_refused(
        &error,
        &[FailureKind::InvalidInput, FailureKind::Protocol],
        "10 values for 11 cells",
    )
}

fn refuses_unstarted(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    match gas.finish(&column.supervisor, &mut column.received) {
        Ok(_) => Err(LawError::Broken("it finished".into())),
        Err(error) => is_refused(&error, &[FailureKind::Protocol], "without a start"),
    }
}

fn diverges_with_place(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    let mut told = exchange(COLD);
    told.heat_source[7] = -1e6;
    let error = column.error_of(&mut *gas, &bed(), &told)?;
    is_refused(
        &error,
        &[FailureKind::Diverged, FailureKind::NotFinite],
        "cell",
    )?;
    holds(error.window.is_some(), || {
        "the error does not name its window".into()
    })
}

fn ends_when_dropped(column: &mut Column<'_, '_>) -> Result<(), LawError> {
    let mut gas = column.make(None)?;
    gas.start(&window(0, SPAN[0], SPAN[1])?, &bed(), &exchange(COLD))?;
    drop(gas);
    Ok(())
}
