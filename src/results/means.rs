//! Time means of fields in the cells of the gas, and how far they fluctuate about these: accumulated over an interval of process time,
//! each window by what of it lies in the interval, with the fields at its end.
//!
//! W' = W + w,   m' = m + w/W' (x − m),   S' = S + w (x − m)(x − m'):  mean m, root mean square √(S/W)
//!
//! (West 1979, doi 10.1145/359146.359153). Particles count in the cell that holds their centre, each with its mass.

use std::path::Path;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::observer::CommittedState;
use calcine_coupler::physics::Vec3;
use calcine_coupler::time::Ticks;

use super::ResultsError;
use super::snapshot::{self, Field, Values};
use crate::case::model::MeanSpec;

/// Name of the state in a checkpoint directory.
const STATE: &str = "means.state";

/// A field, or a quantity of particles, whose values are averaged.
#[derive(Clone, Debug)]
struct MeanField {
    name: String,
    unit: &'static str,
    description: String,
    /// 1 or 3.
    components: usize,
}

/// Weighted means and sums of squares about them; one weight for all values of a cell.
#[derive(Clone, Debug, Default)]
struct Accumulated {
    /// Sum of the weights of each cell.
    weight: Vec<f64>,
    /// Mean of each value, cell by cell.
    mean: Vec<f64>,
    /// Weighted sum of squares of each about the mean.
    squares: Vec<f64>,
}

impl Accumulated {
    fn new(cells: usize, values: usize) -> Self {
        Self {
            weight: vec![0.0; cells],
            mean: vec![0.0; cells * values],
            squares: vec![0.0; cells * values],
        }
    }

    /// Adds values of a cell with a weight.
    fn add(&mut self, cell: usize, weight: f64, values: &[f64]) {
        self.weight[cell] += weight;
        let share = weight / self.weight[cell];
        let place = cell * values.len();
        let means = self.mean[place..].iter_mut();
        let all = means.zip(&mut self.squares[place..]).zip(values);
        for ((mean, squares), value) in all {
            let off = value - *mean;
            *mean += share * off;
            *squares += weight * off * (value - *mean);
        }
    }
}

/// Means of fields over an interval.
#[derive(Debug)]
pub(super) struct FieldMeans {
    spec: MeanSpec,
    gas: Vec<MeanField>,
    particles: Vec<MeanField>,
    of_gas: Accumulated,
    of_particles: Accumulated,
    /// Process time of the interval that has passed, in ps.
    passed: i64,
    locator: Option<Locator<Box<Mesh>>>,
}

/// The values of a field with the names of its numbers, for a file.
struct MadeField {
    name: String,
    unit: &'static str,
    description: String,
    values: MadeValues,
}

enum MadeValues {
    Scalar(Vec<f64>),
    Vector(Vec<Vec3>),
}

impl MadeField {
    fn field(&self) -> Field<'_> {
        Field {
            name: &self.name,
            unit: self.unit,
            description: &self.description,
            values: match &self.values {
                MadeValues::Scalar(list) => Values::Scalar(list),
                MadeValues::Vector(list) => Values::Vector(list),
            },
        }
    }
}

/// Quantities of particles that are averaged.
fn particle_fields(spec: &MeanSpec) -> Vec<MeanField> {
    let known = [
        ("temperature", "K", 1, "temperature of the particles"),
        (
            "velocity",
            "m/s",
            3,
            "velocity of the particles in motion time",
        ),
    ];
    let asked = known
        .into_iter()
        .filter(|one| spec.particles.iter().any(|name| name == one.0));
    let made = asked.map(|(name, unit, components, description)| MeanField {
        name: format!("particle_{name}"),
        unit,
        description: description.into(),
        components,
    });
    made.collect()
}

impl FieldMeans {
    /// Of a run at its start or where it resumes.
    pub fn new(spec: &MeanSpec, species: &[String], moment: &CommittedState<'_>) -> Self {
        let cells = moment.mesh.cells();
        let gas = snapshot::gas_fields(&spec.gas, species, moment).into_iter();
        let gas: Vec<MeanField> = gas
            .map(|field| MeanField {
                name: field.name.into(),
                unit: field.unit,
                description: field.description.into(),
                components: match field.values {
                    Values::Vector(_) => 3,
                    _ => 1,
                },
            })
            .collect();
        let particles = particle_fields(spec);
        let width = |fields: &[MeanField]| fields.iter().map(|one| one.components).sum();
        Self {
            of_gas: Accumulated::new(cells, width(&gas)),
            of_particles: Accumulated::new(cells, width(&particles)),
            locator: (!spec.particles.is_empty())
                .then(|| Locator::new(Box::new(moment.mesh.clone()))),
            spec: spec.clone(),
            gas,
            particles,
            passed: 0,
        }
    }

    /// Adds a window.
    pub fn add(&mut self, species: &[String], moment: &CommittedState<'_>) {
        let Some(window) = moment.window else {
            return;
        };
        let end = moment.clocks.process.min(self.spec.to).count();
        let span = end - window.start.process.max(self.spec.from).count();
        if span <= 0 {
            return;
        }
        self.passed += span;
        let span = Ticks::new(span).seconds();
        let fields = snapshot::gas_fields(&self.spec.gas, species, moment);
        let mut values = Vec::new();
        for cell in 0..moment.mesh.cells() {
            values.clear();
            fields
                .iter()
                .for_each(|field| push(field, cell, &mut values));
            self.of_gas.add(cell, span, &values);
        }
        self.add_particles(span, moment);
    }

    fn add_particles(&mut self, span: f64, moment: &CommittedState<'_>) {
        let Some(locator) = &self.locator else {
            return;
        };
        let bed = moment.particles;
        let mut values = Vec::new();
        for (row, centre) in bed.position.iter().enumerate() {
            let Some(cell) = locator.cell_at(*centre) else {
                continue;
            };
            values.clear();
            for field in &self.particles {
                match field.components {
                    3 => values.extend(bed.velocity[row].iter()),
                    _ => values.push(moment.particle_temperature[row]),
                }
            }
            let mass = bed.weight_of(row) * moment.particle_mass[row];
            self.of_particles.add(cell, span * mass, &values);
        }
    }

    /// True where all of the interval has passed.
    pub fn is_over(&self, now: Ticks) -> bool {
        now >= self.spec.to
    }

    /// From and to which process time in s, and how much of it has passed.
    pub fn interval(&self) -> [f64; 3] {
        let of = |ticks: Ticks| ticks.seconds();
        [
            of(self.spec.from),
            of(self.spec.to),
            of(Ticks::new(self.passed)),
        ]
    }

    /// Calls for the fields: the mean and the root mean square of each, and the mass of particles that a cell held.
    pub fn with_fields<T>(&self, mesh: &Mesh, take: impl FnOnce(&[Field<'_>]) -> T) -> T {
        let mut made = made(&self.gas, &self.of_gas);
        made.extend(made_of_particles(&self.particles, &self.of_particles));
        if self.locator.is_some() {
            let time = Ticks::new(self.passed).seconds();
            let held = self.of_particles.weight.iter().zip(mesh.cell_volume());
            made.push(MadeField {
                name: "particle_density_mean".into(),
                unit: "kg/m^3",
                description: "time mean of the mass of particles per volume of the cell that holds their centres".into(),
                values: MadeValues::Scalar(held.map(|(mass, volume)| mass / time / volume).collect()),
            });
        }
        let fields: Vec<Field<'_>> = made.iter().map(MadeField::field).collect();
        take(&fields)
    }

    /// Writes what has been accumulated into a checkpoint directory.
    pub fn save(&self, directory: &Path) -> Result<(), ResultsError> {
        let mut state = StateFile::new();
        state.set_u64s("passed", &[self.passed.cast_unsigned()]);
        for (name, of) in [("gas", &self.of_gas), ("particles", &self.of_particles)] {
            state.set_f64s(&format!("{name}.weight"), &of.weight);
            state.set_f64s(&format!("{name}.mean"), &of.mean);
            state.set_f64s(&format!("{name}.squares"), &of.squares);
        }
        let path = directory.join(STATE);
        let wrong = |error: calcine_coupler::checkpoint::StateFileError| {
            ResultsError::content(&path, error.to_string())
        };
        state.write(&path).map_err(wrong)
    }

    /// Takes it up again.
    pub fn restore(&mut self, directory: &Path) -> Result<(), ResultsError> {
        let path = directory.join(STATE);
        let wrong = |error: calcine_coupler::checkpoint::StateFileError| {
            ResultsError::content(&path, error.to_string())
        };
        let state = StateFile::read(&path).map_err(wrong)?;
        if let [passed] = *state.u64s("passed").map_err(wrong)? {
            self.passed = passed.cast_signed();
        }
        for (name, of) in [
            ("gas", &mut self.of_gas),
            ("particles", &mut self.of_particles),
        ] {
            for (list, values) in [
                ("weight", &mut of.weight),
                ("mean", &mut of.mean),
                ("squares", &mut of.squares),
            ] {
                let found = state.f64s_of(&format!("{name}.{list}"), values.len());
                values.copy_from_slice(found.map_err(wrong)?);
            }
        }
        Ok(())
    }
}

/// The numbers of a field in a cell.
fn push(field: &Field<'_>, cell: usize, to: &mut Vec<f64>) {
    match field.values {
        Values::Scalar(list) => to.push(list[cell]),
        Values::Column {
            table,
            column,
            columns,
        } => to.push(table[cell * columns + column]),
        Values::Vector(list) => to.extend(list[cell].iter()),
        // No field of the gas has whole or ragged values.
        Values::Whole(_) | Values::Small(_) | Values::Ragged(_) => {}
    }
}

/// Mean and root mean square of each field; NaN in cells that nothing was added to.
fn made(fields: &[MeanField], of: &Accumulated) -> Vec<MadeField> {
    let width: usize = fields.iter().map(|one| one.components).sum();
    let mut first = 0;
    let mut all = Vec::new();
    for field in fields {
        let value =
            |list: &[f64], cell: usize, component: usize| list[cell * width + first + component];
        let mean = |cell: usize, component: usize| match of.weight[cell] > 0.0 {
            true => value(&of.mean, cell, component),
            false => f64::NAN,
        };
        let spread = |cell: usize, component: usize| {
            (value(&of.squares, cell, component) / of.weight[cell]).sqrt()
        };
        let (name, what) = (&field.name, &field.description);
        all.push(MadeField {
            name: format!("{name}_mean"),
            unit: field.unit,
            description: format!("time mean of the {what}"),
            values: values(field.components, of.weight.len(), &mean),
        });
        all.push(MadeField {
            name: format!("{name}_rms"),
            unit: field.unit,
            description: format!(
                "root mean square of the fluctuation about the time mean of the {what}"
            ),
            values: values(field.components, of.weight.len(), &spread),
        });
        first += field.components;
    }
    all
}

/// The same of particles, whose means are over their mass too.
fn made_of_particles(fields: &[MeanField], of: &Accumulated) -> Vec<MadeField> {
    let mut all = made(fields, of);
    for one in &mut all {
        one.description += ", over the mass in the cell; NaN where none was";
    }
    all
}

fn values(components: usize, cells: usize, of: &dyn Fn(usize, usize) -> f64) -> MadeValues {
    match components {
        3 => MadeValues::Vector(
            (0..cells)
                .map(|cell| Vec3::from([0, 1, 2].map(|axis| of(cell, axis))))
                .collect(),
        ),
        _ => MadeValues::Scalar((0..cells).map(|cell| of(cell, 0)).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_squares_are_those_of_the_weighted_values() {
        let mut of = Accumulated::new(2, 1);
        for (weight, value) in [(1.0, 2.0), (3.0, 6.0), (0.5, 1.0)] {
            of.add(1, weight, &[value]);
        }
        // 20.5/4.5; squares about it: 1 · 6.5309, 3 · 2.0864, 0.5 · 12.6420.
        let mean: f64 = 20.5 / 4.5;
        assert!((of.mean[1] - mean).abs() < 1e-14);
        let squares =
            (2.0 - mean).powi(2) + 3.0 * (6.0 - mean).powi(2) + 0.5 * (1.0 - mean).powi(2);
        assert!((of.squares[1] - squares).abs() < 1e-13);
        assert_eq!((of.weight[0], of.mean[0]), (0.0, 0.0));
    }
}
