//! How far the time splitting and the laws of a case are from what they are meant for, population by population.

use std::f64::consts::PI;

use calcine_coupler::interior::reacting::Reaction;
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::numbers::VoidFraction;
use calcine_coupler::physics::radiation::STEFAN_BOLTZMANN;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::{GasPatch, InletFlow};
use calcine_coupler::time::GasStorage;

use super::model::{Case, Inside, MotionSpec, Population};
use super::ranges;
use super::units::short3;

/// Above this, a number of the time splitting gets a warning (docs/theory.md, TSM-6, TSM-8).
pub(super) const WARNING: f64 = 0.1;

/// Largest error of implicit Euler steps after a jump in shares of it, over the step times the rate: 1/(2 e) (docs/theory.md, TSM-8).
pub(super) const STEP_ERROR: f64 = 0.184;

/// Largest error of steps by mean temperatures after a jump in shares of it, over the square of the step times the rate: 1/(12 e), of a
/// particle between neighbours that stay (docs/theory.md, TSM-8).
const MEAN_STEP_ERROR: f64 = 0.031;

/// Largest error in shares of a difference to what a particle radiates or conducts to, of a window times the rate.
pub(super) fn network_error(times_rate: f64) -> f64 {
    (MEAN_STEP_ERROR * times_rate * times_rate).min(STEP_ERROR * times_rate)
}

/// Growth of the drag coefficient from rest to the terminal velocity above which it is told of.
const GROWN: f64 = 1.5;

/// Velocity in m/s up to which terminal velocities are looked for.
const FASTEST: f64 = 1e4;

/// Coefficient 4 emissivity sigma T^3 in W/(m² K) of a population that radiates and may change its temperature, at the hottest of its own,
/// the gas', the surroundings' and the walls' temperatures at the start.
fn radiation(case: &Case, population: &Population) -> Option<f64> {
    let spec = case.laws.radiation.as_ref()?;
    let emissivity = case.materials[population.material].emissivity?;
    if population.prescribed_temperature.is_some() {
        return None;
    }
    let around = spec.surroundings.as_ref().map(|one| one.at(0.0));
    let walls = case
        .wall_temperatures
        .iter()
        .flatten()
        .map(|one| one.at(0.0));
    let others = case.particles.iter().map(|one| one.temperature);
    let all = others
        .chain(around)
        .chain(walls)
        .chain([case.gas.temperature]);
    let hottest = all.fold(0.0, f64::max);
    Some(4.0 * emissivity * STEFAN_BOLTZMANN * hottest.powi(3))
}

/// Numbers of one population in the gas at the start.
pub(super) struct Splitting<'a> {
    population: &'a Population,
    /// R, gas heat stored over solid heat stored times AF.
    ratio: f64,
    /// Error of process storage in shares of the span of temperatures.
    error: f64,
    /// Window over the time of radiation to black surroundings, at the hottest that the case states; `None` where there is none.
    radiation: Option<f64>,
    /// True where contacts conduct, which may be faster than radiation.
    conducts: bool,
    /// Window over the drag's own time, where there is drag.
    drag: Option<f64>,
    /// Drag coefficient at the terminal velocity over that at rest, and the window over m/K there; `None` where nothing falls.
    fall: Option<[f64; 2]>,
    /// Biot number h (d/6)/k of the film against the inside, where the material states its conductivity.
    biot: Option<f64>,
    /// True where particles have shells.
    resolved: bool,
    local: LocalGas,
    /// Mean diameter in m.
    diameter: f64,
}

impl<'a> Splitting<'a> {
    /// Of a population at a mean void fraction; `None` where it has no size.
    pub(super) fn of(case: &Case, population: &'a Population, eps: f64) -> Option<Self> {
        let material = &case.materials[population.material];
        let gas = &case.gas.properties;
        let solid_capacity = material.heat_capacity.at(case.gas.temperature);
        let factor = case.time.acceleration.largest();
        let window = case.time.motion_window.seconds();
        let composition = &case.gas.composition;
        let density = gas.density(case.gas.pressure, case.gas.temperature, composition);
        let capacity = gas.heat_capacity(case.gas.temperature, composition);
        let solid = (1.0 - eps) * material.density * solid_capacity;
        let local = local(case, eps, density)?;
        let d = population.sizes.mean().ok()?;
        let nusselt = case.laws.heat_transfer.make().nusselt(&local, d);
        let volume = sphere::volume_of_diameter(d);
        let rate =
            nusselt * local.conductivity * PI * d / (material.density * volume * solid_capacity);
        let conductivity = material.conductivity.as_ref();
        let conductivity = conductivity.map(|law| law.at(case.gas.temperature));
        let prescribed = population.prescribed_temperature.is_some();
        let biot = conductivity.filter(|_| !prescribed && nusselt > 0.0);
        let biot = biot.map(|inside| nusselt * local.conductivity / (6.0 * inside));
        let weight = (material.density - density).abs() * volume * case.gas.gravity.norm();
        let fall = (weight > 0.0 && !case.laws.drag.is_none()).then(|| {
            let [at_rest, falling] = drag_at_rest_and_falling(case, &local, (d, weight));
            [
                falling / at_rest,
                window * falling / (material.density * volume),
            ]
        });
        let drag = (!case.laws.drag.is_none()).then(|| {
            let coefficient = case.laws.drag.make().coefficient(&local, d);
            window * coefficient / (material.density * volume)
        });
        Some(Self {
            population,
            ratio: factor * eps * density * capacity / solid,
            // docs/theory.md, TSM-8.
            error: STEP_ERROR * rate * factor * window,
            radiation: radiation(case, population).map(|h| {
                let area = PI * d * d;
                let heat = material.density * volume * solid_capacity;
                h * area / heat * factor * window
            }),
            conducts: case.laws.conducts(),
            drag,
            fall,
            biot,
            resolved: material.inside != Inside::Thin,
            local,
            diameter: d,
        })
    }

    /// Lines of `check`.
    pub(super) fn lines(&self, case: &Case) -> Vec<String> {
        let above = |value: f64| match value > WARNING {
            true => "   above 0.1",
            false => "",
        };
        let matters = match case.time.storage {
            GasStorage::Accelerated => above(self.ratio),
            GasStorage::Process => " (matters with `accelerated` storage)",
        };
        let mut lines = vec![
            format!(
                "R, gas heat stored over solid heat stored times AF   {:.4}{matters}",
                self.ratio
            ),
            // Shells follow the gas by steps of their own within the window.
            match self.resolved {
                true => format!(
                    "hA AF dt/(m c), window over the time of the film     {:.2e}",
                    self.error / STEP_ERROR
                ),
                false => format!(
                    "0.18 hA AF dt/(m c), error of process storage       {:.2e}{}",
                    self.error,
                    above(self.error)
                ),
            },
        ];
        // Shells radiate by steps of their own, to what they see at its mean over the window.
        lines.extend(self.radiation.map(|times_rate| match self.resolved {
            true => {
                format!("h_r A AF dt/(m c), window over the time of radiation {times_rate:.2e}")
            }
            // Particles that hold each other by fast contacts follow what they radiate to together, by implicit steps.
            false if self.conducts => {
                let error = STEP_ERROR * times_rate;
                format!(
                    "0.18 h_r A AF dt/(m c), error of radiation           {error:.2e}{}",
                    above(error)
                )
            }
            false => {
                let error = network_error(times_rate);
                format!(
                    "0.03 (h_r A AF dt/(m c))^2, error of radiation       {error:.2e}{}",
                    above(error)
                )
            }
        }));
        lines.extend(
            ranges::of(case, &self.local, self.diameter)
                .iter()
                .map(|one| one.line()),
        );
        lines.extend(self.biot.map(|biot| match self.resolved {
            true => format!("Biot number h d/(6 k) of particles with shells       {biot:.2e}"),
            false => format!(
                "Biot number h d/(6 k) of particles without gradients {biot:.2e}{}",
                above(biot)
            ),
        }));
        lines.extend(self.drag.map(|share| {
            format!("window over the drag's time m/K                      {share:.2e}")
        }));
        lines
    }

    /// What is to be warned of.
    pub(super) fn warnings(&self, case: &Case) -> Vec<String> {
        let name = &self.population.name;
        let step = shorter(case);
        let mut all = Vec::new();
        if case.time.storage == GasStorage::Accelerated && self.ratio > WARNING {
            all.push(format!(
                "R of `{name}` is {}, above {WARNING}: with `accelerated` storage the gas stores that share of the heat of the solid, \
                 which delays it; lower `time.acceleration`, or write `gas_storage = \"process\"`",
                short3(self.ratio)
            ));
        }
        let error = Some(self.error).filter(|error| *error > WARNING && !self.resolved);
        all.extend(error.map(|error| {
            let way = match error > 1.0 {
                true => {
                    "its temperature takes that of the gas within a fraction of a window, so that its way there is not resolved"
                }
                false => {
                    "within a window its temperature comes so far towards that of the gas that the error is this share of their difference"
                }
            };
            format!(
                "0.18 hA AF dt/(m c) of `{name}` is {}, above {WARNING}: {way}; {step}",
                short3(error)
            )
        }));
        if let Some(biot) = self.biot.filter(|biot| *biot > WARNING && !self.resolved) {
            all.push(format!(
                "the Biot number h d/(6 k) of `{name}` is {}, above {WARNING}: real particles of this size are colder inside than at their \
                 surface. These have one temperature each and take up heat faster: {}",
                short3(biot),
                remedy(case, self.population.material)
            ));
        }
        all.extend(
            ranges::of(case, &self.local, self.diameter)
                .iter()
                .filter_map(|one| one.warning(name)),
        );
        let constant =
            self.population.motion != MotionSpec::Frozen && !case.coupling.window_drag.follows();
        if let Some(share) = self.drag.filter(|share| constant && *share > 1.0) {
            all.push(format!(
                "a window is {} times the time m/K in which drag takes particles of `{name}` along: shorten it, or write \
                 coupling.window_drag = \"following\"",
                short3(share)
            ));
        }
        let follows =
            self.population.motion != MotionSpec::Frozen && case.coupling.window_drag.follows();
        if let Some([grown, share]) = self
            .fall
            .filter(|[grown, share]| follows && *grown > GROWN && *share > WARNING)
        {
            all.push(format!(
                "the drag coefficient of `{name}` is {} times as large at the terminal velocity as at rest, but stays within a window as it \
                 was at its start (DRG-3), and a window is {} times m/K: what falls from rest is too fast at first; shorten \
                 `time.motion_window` where that matters",
                short3(grown),
                short3(share)
            ));
        }
        all
    }
}

/// What to do about windows that are long in process time.
pub(super) fn shorter(case: &Case) -> &'static str {
    match case.time.process_step {
        Some(_) => "shorten `time.process_step`",
        None => "lower `time.acceleration`, or shorten `time.motion_window`",
    }
}

/// What to do about particles of a material that are thin and should not be.
fn remedy(case: &Case, material: usize) -> String {
    let chemistry = &case.chemistry;
    let start = chemistry
        .compositions
        .get(material)
        .map_or(&[][..], |own| own);
    let consumed = |one: &&Reaction| {
        let held = |s: usize| start.get(s).is_some_and(|y| *y > 0.0);
        one.rate.needs_thin() && one.solids.iter().any(|&(s, n)| n < 0.0 && held(s))
    };
    match chemistry.reactions.iter().find(consumed) {
        None => "write `inside` = \"auto\" or \"radial\" of the material".into(),
        Some(one) => format!(
            "`{}` goes by {}, a law of thin particles; smaller ones, or `inside` = \"radial\" with a law of the whole particle, are \
             without that error",
            one.name,
            one.rate.law().name
        ),
    }
}

/// Drag coefficients in kg/s of a particle of a diameter (m) at rest in the gas, and at the velocity at which it carries a weight in N.
fn drag_at_rest_and_falling(
    case: &Case,
    local: &LocalGas,
    (diameter, weight): (f64, f64),
) -> [f64; 2] {
    let law = case.laws.drag.make();
    let at = |slip: f64| law.coefficient(&LocalGas { slip, ..*local }, diameter);
    let (mut low, mut high) = (0.0, 1.0);
    while at(high) * high < weight && high < FASTEST {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match at(middle) * middle < weight {
            true => low = middle,
            false => high = middle,
        }
    }
    [at(1e-6 * high), at(high)]
}

/// The gas at the start, at the fastest inlet's superficial velocity.
fn local(case: &Case, eps: f64, density: f64) -> Option<LocalGas> {
    let fastest = case
        .gas
        .patches
        .iter()
        .filter_map(|(_, patch)| match patch {
            GasPatch::Inlet {
                flow: InletFlow::SuperficialVelocity(velocity),
                ..
            } => Some(velocity.0.iter().map(|entry| entry.1).fold(0.0, f64::max)),
            _ => None,
        })
        .fold(case.gas.velocity.norm(), f64::max);
    let gas = &case.gas.properties;
    Some(LocalGas {
        void_fraction: VoidFraction::new(eps).ok()?,
        density,
        viscosity: gas.viscosity(case.gas.temperature, &case.gas.composition),
        conductivity: gas.conductivity(case.gas.temperature, &case.gas.composition),
        heat_capacity: gas.heat_capacity(case.gas.temperature, &case.gas.composition),
        slip: fastest / eps,
    })
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    #[test]
    fn particles_whose_inside_conducts_worse_than_their_film_are_told() {
        let told = |conductivity: &str| {
            let set = format!("materials.glass.conductivity={conductivity}");
            let all = warned("conducting-column", &[&set]);
            all.into_iter().find(|one| one.contains("Biot number"))
        };
        assert_eq!(told("400 W/m/K"), None);
        assert!(told("0.01 W/m/K").unwrap().contains("above 0.1"));
    }
}
