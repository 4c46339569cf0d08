//! Fields of a snapshot: the columns that the case asks for, with unit and description.

use calcine_coupler::interior::{ColumnKind, ColumnShape, ColumnValues, Ragged};
use calcine_coupler::models::ParticleColumn;
use calcine_coupler::observer::CommittedState;
use calcine_coupler::physics::Vec3;

use super::ResultsError;
use crate::case::model::Output;

/// Values of a field, one per cell or particle.
#[derive(Clone, Copy, Debug)]
pub(super) enum Values<'a> {
    /// One number each.
    Scalar(&'a [f64]),
    /// One number each, one column of a table of so many columns held row by row.
    Column {
        /// The table.
        table: &'a [f64],
        /// The column.
        column: usize,
        /// How many columns it has.
        columns: usize,
    },
    /// Three components each.
    Vector(&'a [Vec3]),
    /// Whole numbers.
    Whole(&'a [u64]),
    /// Small whole numbers.
    Small(&'a [u32]),
    /// Any number each.
    Ragged(&'a Ragged),
}

impl Values<'_> {
    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Values::Scalar(list) => list.len(),
            Values::Column { table, columns, .. } => table.len() / columns,
            Values::Vector(list) => list.len(),
            Values::Whole(list) => list.len(),
            Values::Small(list) => list.len(),
            Values::Ragged(rows) => rows.rows(),
        }
    }

    /// The numbers of a column of a table.
    pub fn column(table: &[f64], column: usize, columns: usize) -> Vec<f64> {
        table
            .iter()
            .skip(column)
            .step_by(columns)
            .copied()
            .collect()
    }
}

/// A field of a snapshot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field<'a> {
    /// Name as in the case file.
    pub name: &'a str,
    /// Unit, `1` for pure numbers.
    pub unit: &'static str,
    /// What it is.
    pub description: &'a str,
    /// The values.
    pub values: Values<'a>,
}

const fn field<'a>(
    name: &'a str,
    unit: &'static str,
    description: &'a str,
    values: Values<'a>,
) -> Field<'a> {
    Field {
        name,
        unit,
        description,
        values,
    }
}

/// The name by which a case file asks for the mass fractions of all species.
pub(super) const MASS_FRACTIONS: &str = "mass_fractions";
/// The name by which a case file asks for the eddies.
pub(super) const TURBULENCE: &str = "turbulence";
/// The same of the solids of particles.
pub(super) const SOLIDS: &str = "solids";
/// The name by which a case file asks for all columns that the models of particles show.
pub(super) const INSIDE: &str = "inside";

/// The gas fields that the case asks for, one value a cell.
pub(super) fn gas<'a>(
    output: &Output,
    species: &'a [String],
    moment: &CommittedState<'a>,
) -> Result<Vec<Field<'a>>, ResultsError> {
    let fields = gas_fields(&output.gas, species, moment);
    of_length(fields, moment.mesh.cells(), "gas")
}

/// Those of these names, of whatever lengths, in a fixed order; mass fractions go by the names of the species.
pub(super) fn gas_fields<'a>(
    asked: &[String],
    species: &'a [String],
    moment: &CommittedState<'a>,
) -> Vec<Field<'a>> {
    use Values::{Scalar, Vector};
    let gas = moment.gas;
    let all = [
        field(
            "temperature",
            "K",
            "gas temperature",
            Scalar(gas.temperature),
        ),
        field(
            "velocity",
            "m/s",
            "interstitial gas velocity",
            Vector(gas.velocity),
        ),
        field("pressure", "Pa", "absolute pressure", Scalar(gas.pressure)),
        field(
            "density",
            "kg/m^3",
            "density of the gas itself",
            Scalar(gas.density),
        ),
        field(
            "void_fraction",
            "1",
            "void fraction that the gas saw in the last window",
            Scalar(&moment.bed.void_fraction),
        ),
    ];
    let mut fields = chosen(&all, asked);
    if asked.iter().any(|name| name == MASS_FRACTIONS) {
        fields.extend(species.iter().enumerate().map(|(column, name)| {
            let values = Values::Column {
                table: gas.composition,
                column,
                columns: species.len(),
            };
            field(name, "1", "mass fraction of this species", values)
        }));
    }
    if asked.iter().any(|name| name == TURBULENCE) {
        let eddies = gas.turbulence;
        for (name, unit, description, values) in [
            (
                "turbulent_energy",
                "m^2/s^2",
                "kinetic energy k of eddies",
                eddies.energy,
            ),
            (
                "dissipation",
                "m^2/s^3",
                "dissipation of the energy of eddies",
                eddies.dissipation,
            ),
            (
                "eddy_viscosity",
                "Pa s",
                "void fraction times the viscosity of eddies, zero in a bed at which they end",
                eddies.viscosity,
            ),
        ] {
            fields.push(field(name, unit, description, Scalar(values)));
        }
    }
    fields
}

/// The particle fields of a snapshot, one value a particle.
pub(super) fn particles<'a>(
    output: &Output,
    inside: &'a [ParticleColumn],
    moment: &CommittedState<'a>,
) -> Result<Vec<Field<'a>>, ResultsError> {
    let fields = particle_fields(output, inside, moment);
    of_length(fields, moment.particles.len(), "particle")
}

/// The same of whatever lengths: what every snapshot holds, then what the case asks for.
pub(super) fn particle_fields<'a>(
    output: &Output,
    inside: &'a [ParticleColumn],
    moment: &CommittedState<'a>,
) -> Vec<Field<'a>> {
    use Values::{Scalar, Small, Vector, Whole};
    let bed = moment.particles;
    let always = [
        field("id", "1", "particle id, never reused", Whole(bed.id)),
        field(
            "population",
            "1",
            "index of the population in the case",
            Small(bed.population),
        ),
        field("radius", "m", "particle radius", Scalar(bed.radius)),
    ];
    let all = [
        field(
            "temperature",
            "K",
            "particle temperature",
            Scalar(moment.particle_temperature),
        ),
        field(
            "velocity",
            "m/s",
            "particle velocity in motion time",
            Vector(bed.velocity),
        ),
        field(
            "heat",
            "W",
            "mean heat flow into the particle over the last window",
            Scalar(moment.particle_heat),
        ),
        field("mass", "kg", "particle mass", Scalar(moment.particle_mass)),
        field(
            "force",
            "N",
            "force of the gas on the particle over the last window",
            Vector(moment.particle_gas.force),
        ),
        field(
            "void_fraction",
            "1",
            "void fraction by which the laws of the particle were evaluated",
            Scalar(moment.particle_gas.void_fraction),
        ),
        field(
            "slip",
            "m/s",
            "speed of the gas relative to the particle by which its laws were evaluated",
            Scalar(moment.particle_gas.slip),
        ),
    ];
    let mut fields = always.to_vec();
    if bed.has_weights() {
        fields.push(field(
            "weight",
            "1",
            "statistical weight: number of real particles that each stands for",
            Scalar(bed.weight),
        ));
    }
    fields.extend(chosen(&all, &output.particles));
    for one in inside {
        let column = &one.column;
        let name = column.name.as_str();
        if fields.iter().all(|field| field.name != name) {
            let values = values(one);
            fields.push(field(name, column.unit, &column.description, values));
        }
    }
    fields
}

/// Columns inside particles that the case asks for: those of the solids, or all that are shown.
pub(super) fn inside(output: &Output, moment: &CommittedState<'_>) -> Vec<ParticleColumn> {
    let asks = |group: &str| output.particles.iter().any(|name| name == group);
    if asks(INSIDE) {
        moment.models.shown("")
    } else if asks(SOLIDS) {
        moment.models.shown(SOLIDS)
    } else {
        Vec::new()
    }
}

/// One number a particle of a column that has one, and one that each of them has.
fn values(of: &ParticleColumn) -> Values<'_> {
    let rows = &of.values;
    let ragged = of.column.shape == ColumnShape::Ragged;
    match rows.values() {
        _ if ragged || !rows.lengths().all(|length| length == 1) => Values::Ragged(rows),
        ColumnValues::Real(list) => Values::Scalar(list),
        ColumnValues::Count(list) => Values::Whole(list),
    }
}

/// Rows of any number of values as rows of as many as the longest has (one at least), filled up with what is no number; and
/// how many each has.
pub(super) fn padded(rows: &Ragged) -> (usize, Vec<f64>, Vec<u64>) {
    let width = rows.lengths().max().unwrap_or(0).max(1);
    let mut values = vec![f64::NAN; width * rows.rows()];
    for (row, to) in values.chunks_exact_mut(width).enumerate() {
        match rows.kind() {
            ColumnKind::Real => {
                let own = rows.reals(row);
                to[..own.len()].copy_from_slice(own);
            }
            ColumnKind::Count => {
                let own = rows.counts(row).iter();
                to.iter_mut().zip(own).for_each(|(to, n)| *to = *n as f64);
            }
        }
    }
    let lengths = rows.lengths().map(|length| length as u64).collect();
    (width, values, lengths)
}

/// Name of the array that says how many values each particle has in a column.
pub(crate) fn lengths_of(name: &str) -> String {
    format!("{name}.lengths")
}

fn chosen<'a>(all: &[Field<'a>], names: &[String]) -> Vec<Field<'a>> {
    let is_wanted = |field: &&Field<'a>| names.iter().any(|name| name == field.name);
    all.iter().filter(is_wanted).copied().collect()
}

fn of_length<'a>(
    fields: Vec<Field<'a>>,
    expected: usize,
    what: &str,
) -> Result<Vec<Field<'a>>, ResultsError> {
    match fields.iter().find(|field| field.values.len() != expected) {
        None => Ok(fields),
        Some(field) => Err(ResultsError::Length {
            list: format!("the {what} field `{}`", field.name),
            found: field.values.len(),
            expected,
        }),
    }
}
