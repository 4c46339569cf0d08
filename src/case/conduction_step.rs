//! How fast contacts conduct against the window: the error of steps between particles.

use calcine_coupler::contacts::touching;
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::conduction::SphereContact;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, ConductionArea};
use super::splitting::{WARNING, network_error, shorter};
use super::units::short3;

/// The particle that its contacts change fastest at the start.
pub(super) struct FastestContact {
    /// Its id.
    id: u64,
    /// Index of its population.
    population: usize,
    /// Error of steps in shares of the difference to its neighbours (docs/theory.md, TSM-8).
    error: f64,
}

impl FastestContact {
    /// Of the particles at the start, by their overlaps; `None` where none conducts through them.
    pub(super) fn of(
        case: &Case,
        setup: &ParticleSetup,
        periodicity: &Periodicity,
    ) -> Option<Self> {
        let spec = &case.laws.conduction;
        if spec.law.is_none() || spec.area != ConductionArea::Overlap {
            return None;
        }
        let law = spec.law.make();
        let material = |row: usize| {
            let population = &case.particles[setup.population[row] as usize];
            &case.materials[population.material]
        };
        let conductivity = |row: usize| {
            let start = case.particles[setup.population[row] as usize].temperature;
            Some(material(row).conductivity.as_ref()?.at(start))
        };
        let mut sums = vec![0.0; setup.id.len()];
        for touch in touching(periodicity, &setup.radius, &setup.position, 0.0) {
            let [a, b] = touch.particles;
            let (Some(one), Some(other)) = (conductivity(a), conductivity(b)) else {
                continue;
            };
            let conductance = law.conductance(&SphereContact {
                radius: touch.radius,
                overlap: touch.overlap,
                conductivity: [one, other],
            });
            sums[a] += conductance;
            sums[b] += conductance;
        }
        let span = case.time.acceleration.largest() * case.time.motion_window.seconds();
        let rate = |(row, sum): (usize, &f64)| {
            let population = &case.particles[setup.population[row] as usize];
            if population.prescribed_temperature.is_some() {
                return None;
            }
            let capacity = material(row).heat_capacity.at(population.temperature);
            let mass = sphere::mass(setup.radius[row], setup.density[row]);
            let error = network_error(sum / (mass * capacity) * span);
            (error > 0.0).then_some((row, error))
        };
        let rates = sums.iter().enumerate().filter_map(rate);
        let (row, error) = rates.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            id: setup.id[row],
            population: setup.population[row] as usize,
            error,
        })
    }

    /// Line of `check`.
    pub(super) fn line(&self) -> String {
        let above = match self.error > WARNING {
            true => "   above 0.1",
            false => "",
        };
        format!(
            "conduction     0.03 (sum(G) AF dt/(m c))^2, error through contacts, is {:.2e} at most{above}",
            self.error
        )
    }

    /// What is to be warned of.
    pub(super) fn warning(&self, case: &Case) -> Option<String> {
        (self.error > WARNING).then(|| {
            format!(
                "0.03 (sum(G) AF dt/(m c))^2 of particle {} of `{}` is {}, above {WARNING}: its contacts conduct so well that within a window its \
                 temperature comes that far towards those of its neighbours, with an error of about this share of their difference; {}",
                self.id,
                case.particles[self.population].name,
                short3(self.error),
                shorter(case)
            )
        })
    }
}
