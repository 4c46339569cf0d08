//! The time series: columns that stay the same over a run, and `series.csv`.

use std::path::Path;

use calcine_coupler::observer::CommittedState;
use calcine_coupler::step_error::StepError;
use calcine_coupler::time::Window;

use super::marked::{FileMark, MarkedFile};
use super::quantities::{RunSoFar, evaluate, statistic};
use super::{ResultsError, SERIES, inertial_number, sheet};
use crate::case::model::{Case, MotionKind, MotionSpec, Statistic};

/// Up to so many particles each has a column of its own; beyond, the series holds statistics.
pub(super) const TRACKED_PARTICLES: usize = 1000;

/// A column of the series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    /// Group, empty or one of `quantities`, `ledger`, `gas`, `particles`, `step`.
    pub group: &'static str,
    /// Name inside the group.
    pub name: String,
    /// Unit, `1` for pure numbers.
    pub unit: String,
    /// What it is, in a sentence.
    pub description: String,
}

impl Column {
    fn new(group: &'static str, name: &str, unit: &str, description: &str) -> Self {
        Self {
            group,
            name: name.into(),
            unit: unit.into(),
            description: description.into(),
        }
    }

    /// The name with its group, as in the head of `series.csv`.
    pub fn full_name(&self) -> String {
        if self.group.is_empty() {
            self.name.clone()
        } else {
            format!("{}.{}", self.group, self.name)
        }
    }
}

/// What is told of the step of a window; NaN before there is any.
const STEPS: [(&str, &str, &str); 5] = [
    ("motion_window", "s", "length of the window in motion time"),
    (
        "velocity_error",
        "1",
        "estimated error of the window's step in the velocity, as a share of its largest root mean square",
    ),
    (
        "temperature_error",
        "1",
        "estimated error of the window's step in the gas temperature, as a share of it",
    ),
    (
        "composition_error",
        "1",
        "estimated error of the window's step in the mass fraction of which it is largest",
    ),
    (
        "courant",
        "1",
        "largest Courant number at the end of the window, over its motion time",
    ),
];

/// The columns of a case, particles apart.
pub(super) fn columns(case: &Case, moment: &CommittedState<'_>) -> Vec<Column> {
    let mut list = vec![
        Column::new("", "process_time", "s", "process (real) time"),
        Column::new("", "motion_time", "s", "motion time"),
        Column::new("", "acceleration", "1", "acceleration factor of the window"),
        Column::new("", "windows", "1", "windows committed"),
    ];
    for quantity in &case.quantities {
        let text = "quantity of interest, as the case measures it";
        list.push(Column::new(
            "quantities",
            &quantity.name,
            quantity.unit,
            text,
        ));
    }
    for name in ["mean", "min", "max"] {
        let text = format!("{name} of all particle temperatures");
        list.push(Column::new(
            "particles",
            &format!("temperature_{name}"),
            "K",
            &text,
        ));
    }
    for name in ["min", "max"] {
        let text = format!("{name} of all gas temperatures");
        list.push(Column::new(
            "gas",
            &format!("temperature_{name}"),
            "K",
            &text,
        ));
    }
    if accelerated(case) {
        let text = "inertial number of the bed in motion time, mean over its contacts";
        list.push(Column::new("particles", "inertial_number", "1", text));
    }
    list.push(Column::new(
        "gas",
        "outer_iterations",
        "1",
        "outer iterations of the window",
    ));
    list.push(Column::new(
        "gas",
        "linear_iterations",
        "1",
        "linear iterations of the window",
    ));
    list.push(Column::new(
        "gas",
        "residual",
        "1",
        "largest scaled residual of the window",
    ));
    list.push(Column::new(
        "gas",
        "volume_residual",
        "1",
        "largest mismatch of continuity and equation of state of the window",
    ));
    for (name, unit, description) in STEPS {
        list.push(Column::new("step", name, unit, description));
    }
    let elements = moment.ledger.elements.iter();
    let elements = elements.map(|(name, _)| (format!("element_{name}"), "kg"));
    let lines = moment.ledger.lines().into_iter();
    for (name, unit) in lines
        .map(|(name, unit, _)| (name.to_owned(), unit))
        .chain(elements)
    {
        let text = "error over throughput since the start";
        list.push(Column::new(
            "ledger",
            &format!("{name}_relative_error"),
            "1",
            text,
        ));
        let text = "signed sum of what did not close since the start";
        list.push(Column::new("ledger", &format!("{name}_drift"), unit, text));
        let text = "sum of what moved since the start";
        list.push(Column::new(
            "ledger",
            &format!("{name}_throughput"),
            unit,
            text,
        ));
    }
    list
}

/// True where free particles move faster than they would at their own pace.
pub(super) fn accelerated(case: &Case) -> bool {
    let kind = case.motion.as_ref().map(|motion| motion.kind);
    let moves = case
        .particles
        .iter()
        .any(|one| one.motion == MotionSpec::Free);
    moves && kind == Some(MotionKind::Accelerated)
}

/// True where free particles are held in a window.
pub(super) fn held(case: &Case, window: &Window) -> bool {
    let motion = case.motion.as_ref();
    motion.is_some_and(|motion| motion.held.at(window.start.process).0)
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// Values in the order of the columns.
    pub values: Vec<f64>,
    /// Temperatures in K of the tracked particles; NaN where one is gone.
    pub particles: Vec<f64>,
}

/// The row of a moment, in the order of [`columns`].
pub(super) fn row(
    moment: &CommittedState<'_>,
    acceleration: f64,
    tracked: &[u64],
    run: RunSoFar<'_>,
) -> Row {
    let case = run.case;
    let mut values = vec![
        moment.clocks.process.seconds(),
        moment.clocks.motion.seconds(),
        acceleration,
        moment.windows as f64,
    ];
    values.extend(
        case.quantities
            .iter()
            .map(|quantity| evaluate(quantity, moment, run)),
    );
    for which in [Statistic::Mean, Statistic::Min, Statistic::Max] {
        values.push(statistic(which, moment.particle_temperature));
    }
    for which in [Statistic::Min, Statistic::Max] {
        values.push(statistic(which, moment.gas.temperature));
    }
    if accelerated(case) {
        values.push(inertial_number::of_bed(moment, case.gas.gravity));
    }
    values.push(f64::from(moment.convergence.outer_iterations));
    values.push(f64::from(moment.convergence.linear_iterations));
    values.push(moment.convergence.residual);
    values.push(moment.convergence.volume_residual);
    let error = |of: fn(&StepError) -> f64| moment.step_error.map_or(f64::NAN, of);
    values.extend([
        moment
            .window
            .map_or(f64::NAN, |window| window.span.motion.seconds()),
        error(|error| error.velocity),
        error(|error| error.temperature),
        error(|error| error.composition),
        moment.courant.unwrap_or(f64::NAN),
    ]);
    let ledger = moment.ledger;
    let lines = ledger.lines().into_iter();
    let lines = lines.map(|(_, unit, line)| (ledger.relative_error_in(unit, &line), line));
    let elements = ledger.elements.iter();
    let elements = elements.map(|(_, line)| (ledger.relative_error_of(line), *line));
    for (relative_error, line) in lines.chain(elements) {
        values.extend([relative_error, line.drift, line.throughput]);
    }
    let temperature = |id: &u64| {
        let place = moment.particles.id.binary_search(id).ok()?;
        moment.particle_temperature.get(place).copied()
    };
    let particles = tracked
        .iter()
        .map(|id| temperature(id).unwrap_or(f64::NAN))
        .collect();
    // The same NaN as the file reads back to.
    for value in values.iter_mut().filter(|value| value.is_nan()) {
        *value = f64::NAN;
    }
    Row { values, particles }
}

/// The file `series.csv`.
pub(super) struct Table(MarkedFile);

impl Table {
    /// Begins the file with its head.
    pub fn create(
        directory: &Path,
        columns: &[Column],
        tracked: &[u64],
    ) -> Result<Self, ResultsError> {
        let mut file = MarkedFile::create(directory.join(SERIES))?;
        let head = head(file.path(), columns, tracked)?;
        file.write(&head)?;
        Ok(Self(file))
    }

    /// Goes on with a file whose head is the same.
    pub fn resume(
        directory: &Path,
        columns: &[Column],
        tracked: &[u64],
    ) -> Result<Self, ResultsError> {
        let path = directory.join(SERIES);
        let text = super::files::read(&path)?;
        if !text.as_bytes().starts_with(&head(&path, columns, tracked)?) {
            return Err(ResultsError::content(
                &path,
                "its columns are not this case's",
            ));
        }
        MarkedFile::resume(path, &text).map(Self)
    }

    /// Flushes the file to the disk; gives how far it is.
    pub fn mark(&mut self) -> Result<FileMark, ResultsError> {
        self.0.mark()
    }

    /// Appends a row; numbers are written so that they read back to the same bits.
    pub fn append(&mut self, row: &Row) -> Result<(), ResultsError> {
        let values = row.values.iter().chain(&row.particles);
        let words: Vec<String> = values.map(|&value| sheet::number(value)).collect();
        let line = sheet::line(self.0.path(), &words)?;
        self.0.write(&line)
    }

    /// Hands what is buffered to the operating system.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        self.0.flush()
    }
}

/// The first line.
fn head(path: &Path, columns: &[Column], tracked: &[u64]) -> Result<Vec<u8>, ResultsError> {
    let mut names: Vec<String> = columns
        .iter()
        .map(|column| format!("{} [{}]", column.full_name(), column.unit))
        .collect();
    names.extend(
        tracked
            .iter()
            .map(|id| format!("particle_temperature.{id} [K]")),
    );
    sheet::line(path, &names)
}
