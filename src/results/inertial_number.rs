//! How far a bed that moves accelerated is from quasi-static (docs/theory.md, TSM-7): its inertial number.

use calcine_coupler::contacts;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::observer::CommittedState;
use calcine_coupler::physics::inertial_number::inertial_number;
use calcine_coupler::physics::{Vec3, sphere};
use serde::{Deserialize, Serialize};

/// Above this the motion of a bed depends on its pace (docs/theory.md, TSM-7).
pub const QUASI_STATIC: f64 = 1e-2;

/// Inertial number of the bed in motion time: the mean over all pairs of particles that touch. The shear
/// rate of a pair is its relative velocity across the line of centres over their distance; the pressure is
/// the weight of all particles from its lower one up, less what the gas lifts of it, over the mean
/// cross-section of the mesh; gravity along periodic directions presses nothing. Zero where none touch.
pub(super) fn of_bed(moment: &CommittedState<'_>, gravity: Vec3) -> f64 {
    let bed = moment.particles;
    let periodicity = moment.mesh.periodicity();
    let mut gravity = gravity;
    for (axis, span) in periodicity.axes.iter().enumerate() {
        if span.is_some() {
            gravity[axis] = 0.0;
        }
    }
    let Some(up) = (-gravity).try_normalize(0.0) else {
        return f64::NAN;
    };
    let force = |p: usize| {
        moment
            .particle_gas
            .force
            .get(p)
            .copied()
            .unwrap_or_default()
    };
    let height = |p: usize| bed.position[p].dot(&up);
    let mut order: Vec<usize> = (0..bed.len()).collect();
    order.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
    let area = cross_section(moment.mesh, up);
    let (mut above, mut pressure) = (0.0, vec![0.0; bed.len()]);
    for p in order {
        above -= (bed.mass[p] * gravity + force(p)).dot(&up);
        pressure[p] = above / area;
    }
    let touching = contacts::touching(periodicity, bed.radius, bed.position, 0.0);
    if touching.is_empty() {
        return 0.0;
    }
    let number = |[a, b]: [usize; 2]| {
        let apart = periodicity.shortest(bed.position[b] - bed.position[a]);
        let distance = apart.norm();
        let relative = bed.velocity[b] - bed.velocity[a];
        let along = relative.dot(&apart) / (distance * distance) * apart;
        let shear_rate = (relative - along).norm() / distance;
        let volume = sphere::volume(bed.radius[a]) + sphere::volume(bed.radius[b]);
        let density = (bed.mass[a] + bed.mass[b]) / volume;
        let lower = if height(a) < height(b) { a } else { b };
        let diameter = bed.radius[a] + bed.radius[b];
        inertial_number(shear_rate, diameter, density, pressure[lower])
    };
    let sum: f64 = touching.iter().map(|touch| number(touch.particles)).sum();
    sum / touching.len() as f64
}

/// Volume of the mesh over its extent in a direction, in m².
fn cross_section(mesh: &Mesh, up: Vec3) -> f64 {
    let heights = mesh.topology().points.iter().map(|point| point.dot(&up));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    mesh.cell_volume().iter().sum::<f64>() / (high - low)
}

/// The inertial number over the rows of the series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InertialNumberStatistics {
    /// Rows with a window behind them.
    pub rows: u64,
    /// Mean.
    #[serde(deserialize_with = "super::files::number")]
    pub inertial_number_mean: f64,
    /// Largest.
    #[serde(deserialize_with = "super::files::number")]
    pub inertial_number_largest: f64,
}

impl InertialNumberStatistics {
    /// Adds a row.
    pub(super) fn add(&mut self, number: f64) {
        self.rows += 1;
        self.inertial_number_mean += (number - self.inertial_number_mean) / self.rows as f64;
        self.inertial_number_largest = self.inertial_number_largest.max(number);
    }

    /// What to say of a bed that is not quasi-static; `None` where it is.
    pub fn warning(&self) -> Option<String> {
        let mean = self.inertial_number_mean;
        let quasi_static = mean <= QUASI_STATIC;
        (!quasi_static).then(|| {
            format!(
                "the inertial number of the bed is {mean:.2e} in the mean, above {QUASI_STATIC:e}: it is \
                 moved too fast to move as it would at its own pace; lower `time.acceleration`"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_largest_are_over_the_rows_and_a_fast_bed_is_warned_of() {
        let mut pace = InertialNumberStatistics::default();
        for number in [1e-3, 4e-3, 1e-3] {
            pace.add(number);
        }
        assert!((pace.inertial_number_mean - 2e-3).abs() < 1e-15);
        assert_eq!((pace.rows, pace.inertial_number_largest), (3, 4e-3));
        assert!(pace.warning().is_none());
        pace.add(0.5);
        assert!(pace.warning().unwrap().contains("`time.acceleration`"));
        // Where nothing presses the bed together there is no end of it.
        pace.add(f64::INFINITY);
        assert!(pace.warning().is_some());
    }
}
