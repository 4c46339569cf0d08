//! Quantities of interest: how each is measured at a moment, and its verdict.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::models::ParticleColumn;
use calcine_coupler::observer::CommittedState;
use calcine_coupler::physics::Vec3;
use serde::{Deserialize, Serialize};

use super::ResultsError;
use super::passages::{self, OutflowTrail};
use super::probe::Site;
use super::snapshot::SOLIDS;
use super::summary::{QuantityResult, Verdict};
use crate::case::model::{
    Case, Expect, GasPlace, Measure, ParticlePlace, Quantity, Statistic, ToleranceBand, belongs,
};

/// The largest distance from a value that a band allows, in the value's unit.
pub fn allowance(band: ToleranceBand, value: f64) -> f64 {
    match band {
        ToleranceBand::Relative(share) => share * value.abs(),
        ToleranceBand::Absolute(distance) => distance,
    }
}

/// A statistic over values; NaN where there are none, the sum 0.
pub(crate) fn statistic(statistic: Statistic, values: &[f64]) -> f64 {
    weighted(statistic, values.iter().map(|value| (*value, 1.0)))
}

/// A statistic over pairs of value and weight; NaN where there are none, the sum 0.
fn weighted(which: Statistic, pairs: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let values = || pairs.clone().map(|pair| pair.0);
    let sum = || {
        pairs
            .clone()
            .map(|(value, weight)| value * weight)
            .sum::<f64>()
    };
    let total = || pairs.clone().map(|pair| pair.1).sum::<f64>();
    match which {
        // Values without a flow count by their weights.
        Statistic::Mean | Statistic::MassFlowMean => sum() / total(),
        Statistic::Min => values().fold(f64::NAN, f64::min),
        Statistic::Max => values().fold(f64::NAN, f64::max),
        // That of no values is −0.
        Statistic::Sum => sum() + 0.0,
        Statistic::Deviation => {
            let mean = sum() / total();
            let off = pairs
                .clone()
                .map(|(value, weight)| weight * (value - mean).powi(2));
            (off.sum::<f64>() / total()).sqrt()
        }
    }
}

/// What a measure looks at beside the moment.
#[derive(Clone, Copy)]
pub(super) struct RunSoFar<'a> {
    /// The case.
    pub case: &'a Case,
    /// Where its probes are.
    pub sites: &'a [Site],
    /// What left through outlets before.
    pub outflow: &'a OutflowTrail,
}

/// The column of the mass with which a particle came.
const FIRST_MASS: &str = "first_mass";

/// Refuses patches that the mesh lacks.
pub(super) fn check(quantity: &Quantity, mesh: &Mesh) -> Result<(), ResultsError> {
    let patches: &[String] = match &quantity.measure {
        Measure::Difference { patches, .. } => patches,
        Measure::Gas {
            over: GasPlace::Patch(patch),
            ..
        }
        | Measure::Flow { patch, .. }
        | Measure::Force { patch, .. } => std::slice::from_ref(patch),
        _ => return Ok(()),
    };
    match patches.iter().find(|name| mesh.patch(name).is_none()) {
        None => Ok(()),
        Some(patch) => Err(ResultsError::NoPatch {
            quantity: quantity.name.clone(),
            patch: patch.clone(),
            patches: mesh
                .patches()
                .iter()
                .map(|patch| patch.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        }),
    }
}

/// The quantity at a moment, in its unit; NaN where it does not exist: a particle that is gone, a
/// pressure before the first window, when none is solved yet.
pub(super) fn evaluate(quantity: &Quantity, moment: &CommittedState<'_>, run: RunSoFar<'_>) -> f64 {
    let RunSoFar { case, sites, .. } = run;
    match &quantity.measure {
        Measure::Difference { field, .. } | Measure::Gas { field, .. }
            if field == "pressure" && moment.windows == 0 =>
        {
            f64::NAN
        }
        Measure::Difference { field, patches } => {
            let of = (field.as_str(), None);
            let mean = |patch| weighted(Statistic::Mean, on_patch(moment, of, patch).into_iter());
            mean(&patches[0]) - mean(&patches[1])
        }
        Measure::Gas {
            field,
            over: GasPlace::Patch(patch),
            statistic: Statistic::MassFlowMean,
        } => {
            let of = (field.as_str(), quantity.column);
            let by_area = weighted(Statistic::Mean, on_patch(moment, of, patch).into_iter());
            passages::flow_mean(moment, &case.gas.properties, patch, of, by_area)
        }
        Measure::Gas {
            field,
            over,
            statistic: which,
        } => {
            let of = (field.as_str(), quantity.column);
            let values = match over {
                GasPlace::Everywhere => in_cells(moment, of),
                GasPlace::Patch(patch) => on_patch(moment, of, patch),
                GasPlace::Probe(probe) => {
                    let cells = site(sites, probe).map_or(&[][..], |site| &site.cells);
                    let inside = cells.iter().flatten();
                    inside
                        .map(|&cell| (in_cell(moment, of, cell), 1.0))
                        .collect()
                }
            };
            weighted(*which, values.into_iter())
        }
        Measure::Particles {
            field,
            over,
            statistic: which,
        } => {
            let of = (field.as_str(), quantity.column);
            let values = of_particles(case, moment, of);
            let shares = shares(case, moment, of);
            let (bed, all) = (moment.particles, &values[..]);
            let pair = |(row, &value): (usize, &f64)| {
                let share = shares.get(row).copied().unwrap_or(1.0);
                (value, bed.weight_of(row) * share)
            };
            let values: Vec<(f64, f64)> = match over {
                ParticlePlace::Among { populations, zone } => {
                    let counts = |row: usize| {
                        let own = bed.population.get(row);
                        populations
                            .as_ref()
                            .is_none_or(|all| own.is_some_and(|own| all.contains(own)))
                            && zone.is_none_or(|zone| zone.holds(bed.position[row]))
                            // A particle that came without a solid has no conversion of it.
                            && shares.get(row).is_none_or(|share| *share > 0.0)
                    };
                    let rows = all.iter().enumerate();
                    rows.filter(|(row, _)| counts(*row)).map(pair).collect()
                }
                ParticlePlace::Probe(probe) => {
                    let places = site(sites, probe)
                        .map_or(Vec::new(), |site| site.particles(bed.position, bed.radius));
                    let found = places.into_iter().flatten();
                    found
                        .filter_map(|place| Some(pair((place, all.get(place)?))))
                        .collect()
                }
            };
            weighted(*which, values.into_iter())
        }
        Measure::WallHeat { wall } => {
            let warm = moment.reservoirs.iter().zip(moment.reservoir_heat);
            let own = warm.filter(|(name, _)| belongs(name, wall));
            own.map(|(_, heat)| heat).sum()
        }
        Measure::Flow { what, patch } => passages::flow(moment, *what, patch, quantity.column),
        Measure::Force { part, patch, along } => {
            passages::force(moment, *part, patch, along, case.gas.pressure)
        }
        Measure::Discharge {
            what,
            outlet,
            population,
            over,
        } => passages::discharge(moment, run.outflow, *what, (*outlet, *population), *over),
        Measure::Body { body } => {
            let bodies = moment.bodies;
            let own = bodies.names().zip(bodies.temperature());
            own.filter(|(name, _)| name == body)
                .map(|(_, kelvin)| kelvin)
                .sum()
        }
        Measure::Particle { field, number } => number
            .checked_sub(1)
            .and_then(|place| {
                of_particles(case, moment, (field, quantity.column))
                    .get(place)
                    .copied()
            })
            .unwrap_or(f64::NAN),
        Measure::SurfaceAngle { point, axis, down } => {
            let bed = moment.particles;
            let masses: Vec<f64> = (0..bed.len()).map(|row| bed.row_mass(row)).collect();
            surface_angle(bed.position, &masses, point, axis, down)
        }
    }
}

/// Mass in kg with which each particle came of a solid; zero of a material without a composition.
fn first_amounts(case: &Case, moment: &CommittedState<'_>, solid: Option<usize>) -> Vec<f64> {
    let first = moment.models.named(FIRST_MASS);
    let first = first
        .and_then(|column| column.scalars())
        .unwrap_or_default();
    let bed = moment.particles;
    let of_row = |row: usize| {
        let population = case.particles.get(*bed.population.get(row)? as usize)?;
        let share = case.chemistry.compositions.get(population.material)?;
        let share = share.get(solid?)?;
        Some(share * first.get(row)?)
    };
    let amounts = (0..bed.len()).map(|row| of_row(row).filter(|mass| mass.is_finite()));
    amounts.map(|mass| mass.unwrap_or(0.0)).collect()
}

/// Share of a solid by which rounding alone may tell it from what it came with.
const UNREACTED: f64 = 8.0 * f64::EPSILON;

/// How much each particle counts beside its weight: for conversions what it came with of the solid, else all alike.
fn shares(case: &Case, moment: &CommittedState<'_>, (field, solid): Field<'_>) -> Vec<f64> {
    match field {
        "conversion" => first_amounts(case, moment, solid),
        _ => Vec::new(),
    }
}

/// A field of all particles; speeds are those of process time.
fn of_particles(case: &Case, moment: &CommittedState<'_>, (field, column): Field<'_>) -> Vec<f64> {
    let bed = moment.particles;
    let acceleration = match moment.window {
        Some(window) => window.acceleration(),
        None => case.time.acceleration.at(moment.clocks.process).0,
    };
    let speeds = |rates: &[Vec3]| {
        rates
            .iter()
            .map(|rate| rate.norm() / acceleration)
            .collect::<Vec<_>>()
    };
    let along = |axis: usize| bed.position.iter().map(|centre| centre[axis]).collect();
    match field {
        "speed" => speeds(bed.velocity),
        "angular_speed" => speeds(bed.angular_velocity),
        "kinetic_energy" => {
            let (flight, spin) = (speeds(bed.velocity), speeds(bed.angular_velocity));
            let energy = |row: usize| {
                // Of a solid sphere; 0 where a solver has no spin.
                let inertia = 0.4 * bed.radius[row].powi(2);
                let spin = spin.get(row).copied().unwrap_or(0.0);
                0.5 * moment.particle_mass[row] * (flight[row].powi(2) + inertia * spin.powi(2))
            };
            (0..bed.len()).map(energy).collect()
        }
        "count" => vec![1.0; bed.len()],
        "x" => along(0),
        "y" => along(1),
        "height" | "z" => along(2),
        "mass" => moment.particle_mass.to_vec(),
        "diameter" => bed.radius.iter().map(|radius| 2.0 * radius).collect(),
        "mass_fraction" => {
            let solids = moment.models.shown(SOLIDS);
            let of = column.and_then(|k| solids.get(k));
            of.and_then(ParticleColumn::scalars).unwrap_or_default()
        }
        "conversion" => {
            let first = first_amounts(case, moment, column);
            let left = of_particles(case, moment, ("mass_fraction", column));
            let rows = first.iter().enumerate();
            // NaN of a particle that came without the solid.
            rows.map(|(row, first)| {
                let left = left.get(row).copied().unwrap_or(f64::NAN);
                1.0 - left * moment.particle_mass[row] / first
            })
            .map(|share| match share.is_finite() {
                // The round-off of what has not reacted.
                true if share.abs() < UNREACTED => 0.0,
                true => share,
                false => f64::NAN,
            })
            .collect()
        }
        "mean_temperature" | "centre_temperature" => {
            inside(moment, field, moment.particle_temperature.to_vec())
        }
        "shell_count" => inside(moment, field, vec![1.0; bed.len()]),
        _ => moment.particle_temperature.to_vec(),
    }
}

/// A column of particles with shells, and what holds of those without.
fn inside(moment: &CommittedState<'_>, name: &str, mut thin: Vec<f64>) -> Vec<f64> {
    let column = moment.models.named(name);
    let found = column.and_then(|column| column.scalars());
    for (value, own) in thin.iter_mut().zip(found.unwrap_or_default()) {
        if !own.is_nan() {
            *value = own;
        }
    }
    thin
}

/// By how many rad the centre of mass has turned about an axis from straight below; NaN without particles.
fn surface_angle(position: &[Vec3], mass: &[f64], point: &Vec3, axis: &Vec3, down: &Vec3) -> f64 {
    let moment: Vec3 = position
        .iter()
        .zip(mass)
        .map(|(x, m)| *m * (x - point))
        .sum();
    if position.is_empty() {
        return f64::NAN;
    }
    axis.dot(&down.cross(&moment))
        .atan2(down.dot(&moment) - axis.dot(down) * axis.dot(&moment))
}

fn site<'s>(sites: &'s [Site], name: &str) -> Option<&'s Site> {
    sites.iter().find(|site| site.probe.name == name)
}

/// A field by its name, and which species it is of.
type Field<'a> = (&'a str, Option<usize>);

/// A gas field in a cell.
fn in_cell(moment: &CommittedState<'_>, (field, column): Field<'_>, cell: usize) -> f64 {
    let gas = moment.gas;
    match field {
        "pressure" => gas.pressure[cell],
        "temperature" => gas.temperature[cell],
        "density" => gas.density[cell],
        "speed" => gas.velocity[cell].norm(),
        "void_fraction" => moment.bed.void_fraction[cell],
        "mass_fraction" => {
            let species = gas.composition.len() / gas.temperature.len().max(1);
            let at = cell * species + column.unwrap_or(0);
            gas.composition.get(at).copied().unwrap_or(f64::NAN)
        }
        _ => f64::NAN,
    }
}

/// A gas field in all cells, each with its volume of gas in m³.
fn in_cells(moment: &CommittedState<'_>, field: Field<'_>) -> Vec<(f64, f64)> {
    let volumes = moment.mesh.cell_volume().iter().enumerate();
    volumes
        .map(|(cell, volume)| {
            let gas = volume * moment.bed.void_fraction[cell];
            (in_cell(moment, field, cell), gas)
        })
        .collect()
}

/// A gas field on the faces of a patch, each with its area in m²: the pressure is carried from the
/// cell to the face centre with the cell's gradient, p_f = p_c + ∇p·(x_f − x_c); others are the
/// cell's.
fn on_patch(moment: &CommittedState<'_>, field: Field<'_>, patch: &str) -> Vec<(f64, f64)> {
    let mesh = moment.mesh;
    let Some(patch) = mesh.patch(patch) else {
        return Vec::new();
    };
    let on_face = |face: usize| {
        let cell = mesh.owner()[face] as usize;
        let mut value = in_cell(moment, field, cell);
        if field.0 == "pressure" {
            let arm = mesh.face_centre()[face] - mesh.cell_centre()[cell];
            value += moment.gas.pressure_gradient[cell].dot(&arm);
        }
        (value, mesh.face_area()[face].norm())
    };
    patch.faces().map(on_face).collect()
}

/// The value of each quantity that its expectation speaks of, once it is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Captured {
    /// One (value, process time in s) per quantity, in the order of the case; a value that is not
    /// a number is `None`, as JSON has no other word for it.
    values: Vec<Option<(Option<f64>, f64)>>,
}

impl Captured {
    /// Nothing known yet of so many quantities.
    pub fn new(quantities: usize) -> Self {
        Self {
            values: vec![None; quantities],
        }
    }

    /// Takes the value of each quantity at the first moment at or after its time; a quantity
    /// without a time keeps its latest value where `latest` is set.
    pub fn take(&mut self, moment: &CommittedState<'_>, run: RunSoFar<'_>, latest: bool) {
        let time = moment.clocks.process.seconds();
        for (slot, quantity) in self.values.iter_mut().zip(&run.case.quantities) {
            let wanted = match expected_at(quantity) {
                Some(at) => slot.is_none() && time >= at,
                None => latest,
            };
            if wanted {
                let value = evaluate(quantity, moment, run);
                *slot = Some((Some(value).filter(|value| value.is_finite()), time));
            }
        }
    }

    /// True where some quantity's time has come and its value is still to be taken.
    pub fn is_due(&self, case: &Case, process_time: f64) -> bool {
        let mut pairs = self.values.iter().zip(&case.quantities);
        pairs.any(|(slot, quantity)| {
            slot.is_none() && expected_at(quantity).is_some_and(|at| process_time >= at)
        })
    }

    /// The results by name; `over` where the run has reached its end.
    pub fn results(
        &self,
        case: &Case,
        over: bool,
    ) -> std::collections::BTreeMap<String, QuantityResult> {
        let pairs = case.quantities.iter().zip(&self.values);
        pairs
            .map(|(quantity, slot)| (quantity.name.clone(), result(quantity, *slot, over)))
            .collect()
    }
}

fn expected_at(quantity: &Quantity) -> Option<f64> {
    quantity.expect.and_then(|expect| expect.at)
}

fn result(quantity: &Quantity, slot: Option<(Option<f64>, f64)>, over: bool) -> QuantityResult {
    let band = quantity.expect.map(|Expect { value, within, .. }| {
        let distance = allowance(within, value);
        (value - distance, value + distance)
    });
    let known = over || (expected_at(quantity).is_some() && slot.is_some());
    let verdict = match (band, slot) {
        (None, _) => Verdict::None,
        (Some(_), _) if !known => Verdict::Running,
        (Some((low, high)), Some((Some(value), _))) if low <= value && value <= high => {
            Verdict::Pass
        }
        (Some(_), _) => Verdict::Fail,
    };
    QuantityResult {
        value: slot.and_then(|(value, _)| value),
        unit: quantity.unit.into(),
        at_s: slot.map(|(_, at)| at),
        band,
        expected_at_s: expected_at(quantity),
        verdict,
    }
}

/// The verdict of a finished run: `Fail` where one quantity fails, `Pass` where one passes and
/// none fails, `None` where nothing is expected.
pub(super) fn overall<'a>(results: impl Iterator<Item = &'a QuantityResult>) -> Verdict {
    results.fold(Verdict::None, |so_far, result| {
        match (so_far, result.verdict) {
            (Verdict::Fail, _) | (_, Verdict::Fail) => Verdict::Fail,
            (Verdict::Pass, _) | (_, Verdict::Pass) => Verdict::Pass,
            _ => Verdict::None,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_count_by_weights() {
        let pairs = [(1.0, 2.0), (4.0, 1.0), (-2.0, 1.0)];
        let of = |which| weighted(which, pairs.into_iter());
        assert_eq!(of(Statistic::Mean), 1.0);
        assert_eq!(of(Statistic::Sum), 4.0);
        // Squares of what is off: 0, 9, 9.
        assert_eq!(of(Statistic::Deviation), 4.5f64.sqrt());
        assert_eq!((of(Statistic::Min), of(Statistic::Max)), (-2.0, 4.0));
        let none = |which| weighted(which, std::iter::empty());
        assert_eq!(none(Statistic::Sum), 0.0);
        for which in [
            Statistic::Mean,
            Statistic::Min,
            Statistic::Max,
            Statistic::Deviation,
        ] {
            assert!(none(which).is_nan());
        }
    }

    #[test]
    fn a_bed_that_has_turned_by_an_angle_has_a_surface_of_that_slope() {
        // A heap below the axis at (1, 2, 3), turned about −y by 0.4 rad, and moved along the axis.
        let point = Vec3::new(1.0, 2.0, 3.0);
        let (sine, cosine) = 0.4f64.sin_cos();
        let places = [(-0.1, -0.5), (0.1, -0.5), (0.3, -0.2), (-0.3, -0.2)]
            .map(|(x, z)| point + Vec3::new(x * cosine - z * sine, 7.0, x * sine + z * cosine));
        let angle = |axis: Vec3, down: Vec3| {
            surface_angle(&places, &[1.0, 1.0, 3.0, 3.0], &point, &axis, &down)
        };
        assert!((angle(-Vec3::y(), -Vec3::z()) - 0.4).abs() < 1e-14);
        assert!((angle(Vec3::y(), -Vec3::z()) + 0.4).abs() < 1e-14);
        // What of gravity is along the axis does not matter.
        let slanted = Vec3::new(0.0, 0.6, -0.8);
        assert!((angle(-Vec3::y(), slanted) - 0.4).abs() < 1e-14);
        assert!(surface_angle(&[], &[], &point, &Vec3::y(), &-Vec3::z()).is_nan());
    }
}
