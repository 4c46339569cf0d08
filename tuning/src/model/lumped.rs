use calcine_numerics::rosenbrock::{IntegrationAccuracy, MOST_STEPS, SystemDerivatives};
use calcine_numerics::{DenseMatrix, Rosenbrock, RosenbrockTableau, StiffSystem};
use calcine_physics::dimension::Dimension;

use super::reaction::{ReactionSet, RunningReaction};
use super::{HeatingRun, ModelParameter, PreparedSample, SampleModel, SampleResponse};
use crate::{TemperatureProgramme, TuningError};

/// Stefan–Boltzmann constant in W/m²/K⁴ (CODATA 2018).
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Temperature at which reaction enthalpies are stated in K.
const REFERENCE: f64 = 298.15;
/// Errors of a step that count as none: temperatures in K, reduced times.
const TEMPERATURE_ERROR: f64 = 1e-5;
const REDUCED_ERROR: f64 = 1e-9;
/// Error of a step relative to each value.
const RELATIVE_ERROR: f64 = 1e-7;

/// What the lumped model takes as constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LumpedSettings {
    /// True: the heat capacity follows the composition of the sample; false: it stays that of the fresh sample, as in
    /// the paper.
    pub heat_capacity_of_composition: bool,
    /// True: the reaction enthalpy follows the temperature by Kirchhoff's law; false: it stays that at 298.15 K.
    pub enthalpy_of_temperature: bool,
}

/// Name, dimension and default of each number of the lumped model but those of its reactions; requirements U-1.
pub const LUMPED_PARAMETERS: [(&str, Dimension, f64, &str); 10] = [
    (
        "contact_transfer",
        Dimension::HEAT_TRANSFER,
        100.0,
        "Heat transfer coefficient h2 between crucible and sample.",
    ),
    (
        "gas_transfer",
        Dimension::HEAT_TRANSFER,
        20.0,
        "Heat transfer coefficient h1 between gas and crucible.",
    ),
    (
        "emissivity",
        Dimension::NONE,
        0.15,
        "Emissivity of the crucible.",
    ),
    (
        "crucible_mass",
        Dimension::MASS,
        200e-6,
        "Mass of the crucible.",
    ),
    (
        "crucible_heat_capacity",
        Dimension::HEAT_CAPACITY,
        140.0,
        "Specific heat capacity of the crucible.",
    ),
    (
        "outer_area",
        Dimension([2, 0, 0, 0, 0]),
        8.48e-5,
        "Outer area of the crucible, side and bottom.",
    ),
    (
        "contact_area",
        Dimension([2, 0, 0, 0, 0]),
        2.827e-5,
        "Area between crucible and sample.",
    ),
    (
        "sample_heat_capacity",
        Dimension::HEAT_CAPACITY,
        1000.0,
        "Specific heat capacity of the fresh sample.",
    ),
    (
        "product_heat_capacity",
        Dimension::HEAT_CAPACITY,
        900.0,
        "Specific heat capacity of the solid product.",
    ),
    (
        "released_heat_capacity",
        Dimension::HEAT_CAPACITY,
        1150.0,
        "Specific heat capacity of the gas that is released.",
    ),
];

/// A sample in a crucible in a furnace, two temperatures and a conversion (docs/theory.md, TUN-1):
///
/// c_w m_w T_w′ = A_c h₁ (T_g − T_w) + A_c σ ε (T_g⁴ − T_w⁴) + h₂ A_b (T_s − T_w)
/// c_s m_s T_s′ = h₂ A_b (T_w − T_s) − m_s Σ s α′ ΔH
/// x′ = A exp(−E/(R T_s)), α = law(x)
///
/// with m_s the mass at the start, s the share of the reactant and ΔH > 0 taken up. For first order α′ = k C, C = 1 − α.
///
/// Source: Copertaro et al., Engineering Journal 20(5) (2016) 187, doi 10.4186/ej.2016.20.5.187, eqs. 21 to 25, with the
/// signs of eqs. 22 and 23 corrected.
#[derive(Clone, Debug)]
pub struct LumpedModel {
    settings: LumpedSettings,
    reactions: ReactionSet,
    parameters: Vec<ModelParameter>,
}

impl LumpedModel {
    /// With these reactions; its other numbers have the values of [`LUMPED_PARAMETERS`] until they are changed.
    pub fn new(settings: LumpedSettings, reactions: ReactionSet) -> Self {
        let own = LUMPED_PARAMETERS.iter();
        let own =
            own.map(|&(name, dimension, value, _)| ModelParameter::new(name, dimension, value));
        let mut parameters: Vec<ModelParameter> = own.collect();
        parameters.extend(reactions.parameters());
        Self {
            settings,
            reactions,
            parameters,
        }
    }

    /// Changes a number by its name; false where it has none of that name.
    pub fn set(&mut self, name: &str, value: f64) -> bool {
        let found = self.parameters.iter_mut().find(|one| one.name == name);
        found.map(|one| one.value = value).is_some()
    }
}

impl SampleModel for LumpedModel {
    fn parameters(&self) -> &[ModelParameter] {
        &self.parameters
    }

    fn prepare(&self, run: &HeatingRun) -> Box<dyn PreparedSample> {
        Box::new(PreparedLumped {
            settings: self.settings,
            reactions: self.reactions.clone(),
            run: run.clone(),
        })
    }
}

struct PreparedLumped {
    settings: LumpedSettings,
    reactions: ReactionSet,
    run: HeatingRun,
}

impl PreparedSample for PreparedLumped {
    fn respond(&self, values: &[f64], out: &mut SampleResponse) -> Result<(), TuningError> {
        let (own, of_reactions) = values.split_at(LUMPED_PARAMETERS.len());
        let &[
            contact,
            gas,
            emissivity,
            mass,
            capacity,
            outer,
            area,
            fresh,
            product,
            released,
        ] = own
        else {
            let cause = format!(
                "{} numbers in place of {}",
                own.len(),
                LUMPED_PARAMETERS.len()
            );
            return Err(TuningError::Model(cause));
        };
        let (reactions, _) = self.reactions.with(of_reactions);
        let mut system = LumpedSystem {
            programme: &self.run.programme,
            convection: outer * gas,
            radiation: outer * STEFAN_BOLTZMANN * emissivity,
            contact: contact * area,
            crucible: mass * capacity,
            sample: self.run.sample_mass,
            fresh,
            products: reactions
                .iter()
                .map(|one| match self.settings.heat_capacity_of_composition {
                    // Change of the sample's heat capacity over the conversion in J/kg/K.
                    true => (one.reactant - one.loss) * product - one.reactant * fresh,
                    false => 0.0,
                })
                .collect(),
            kirchhoff: reactions
                .iter()
                .map(|one| match self.settings.enthalpy_of_temperature {
                    // Per kg of reactant in J/kg/K.
                    true => {
                        let gas = one.loss / one.reactant;
                        (1.0 - gas) * product + gas * released - fresh
                    }
                    false => 0.0,
                })
                .collect(),
            reactions,
            trace: Trace::default(),
        };
        system.run(&self.run.times, out)
    }
}

/// Unknowns: T_w, T_s, the time, then the reduced time of each reaction.
struct LumpedSystem<'a> {
    programme: &'a TemperatureProgramme,
    convection: f64,
    radiation: f64,
    contact: f64,
    crucible: f64,
    sample: f64,
    fresh: f64,
    products: Vec<f64>,
    kirchhoff: Vec<f64>,
    reactions: Vec<RunningReaction>,
    trace: Trace,
}

/// Unknowns with their rates at the end of each step: what the response is interpolated from.
#[derive(Default)]
struct Trace {
    unknowns: Vec<f64>,
    rates: Vec<f64>,
}

const WALL: usize = 0;
const SAMPLE: usize = 1;
const TIME: usize = 2;
const FIRST: usize = 3;

impl LumpedSystem<'_> {
    /// Heat capacity of the sample relative to its mass at the start.
    fn capacity(&self, y: &[f64]) -> f64 {
        let changes = self.products.iter().zip(&self.reactions).zip(&y[FIRST..]);
        let changes = changes.map(|((change, one), &x)| match *change {
            0.0 => 0.0,
            change => change * one.law.conversion(x.max(0.0)),
        });
        self.fresh + changes.sum::<f64>()
    }

    fn run(&mut self, times: &[f64], out: &mut SampleResponse) -> Result<(), TuningError> {
        let (knots, temperatures) = self.programme.points();
        let width = FIRST + self.reactions.len();
        let mut y = vec![0.0; width];
        (y[WALL], y[SAMPLE], y[TIME]) = (temperatures[0], temperatures[0], knots[0]);
        let mut absolute = vec![REDUCED_ERROR; width];
        (absolute[WALL], absolute[SAMPLE], absolute[TIME]) =
            (TEMPERATURE_ERROR, TEMPERATURE_ERROR, f64::INFINITY);
        let accuracy = IntegrationAccuracy {
            relative: RELATIVE_ERROR,
            absolute: &absolute,
            steps: MOST_STEPS,
        };
        let end = times.last().copied().unwrap_or(knots[0]);
        let mut method = Rosenbrock::new(&RosenbrockTableau::RODAS4, DenseMatrix::new(width));
        // The programme bends at its knots: no step goes over one.
        let inner = knots.iter().copied().skip(1).filter(|&knot| knot < end);
        for stop in inner.chain([end]) {
            let span = stop - y[TIME];
            if span > 0.0 {
                method
                    .integrate(self, &mut y, span, accuracy)
                    .map_err(|stall| TuningError::Model(stall.to_string()))?;
                y[TIME] = stop;
            }
        }
        let mut rates = vec![0.0; width];
        self.rates(&y, &mut rates);
        self.trace.unknowns.extend_from_slice(&y);
        self.trace.rates.extend_from_slice(&rates);
        self.sample_at(times, width, out);
        Ok(())
    }

    /// Cubic interpolation between the ends of the steps.
    fn sample_at(&self, times: &[f64], width: usize, out: &mut SampleResponse) {
        out.clear();
        let Trace { unknowns, rates } = &self.trace;
        let count = unknowns.len() / width;
        let mut step = 0;
        for &time in times {
            while step + 2 < count && unknowns[(step + 1) * width + TIME] < time {
                step += 1;
            }
            let to = (step + 1).min(count - 1);
            let (a, b) = (&unknowns[step * width..], &unknowns[to * width..]);
            let (da, db) = (&rates[step * width..], &rates[to * width..]);
            let h = b[TIME] - a[TIME];
            let s = if h > 0.0 {
                ((time - a[TIME]) / h).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let (s2, s3) = (s * s, s * s * s);
            let basis = [
                2.0 * s3 - 3.0 * s2 + 1.0,
                s3 - 2.0 * s2 + s,
                3.0 * s2 - 2.0 * s3,
                s3 - s2,
            ];
            let value = |k: usize| {
                basis[0] * a[k] + basis[1] * h * da[k] + basis[2] * b[k] + basis[3] * h * db[k]
            };
            let temperature = value(SAMPLE);
            let (mut mass, mut rate) = (1.0, 0.0);
            for (k, one) in self.reactions.iter().enumerate() {
                let [conversion, slope, _] = one.law.at(value(FIRST + k).max(0.0));
                mass -= one.loss * conversion;
                rate += one.loss * slope * one.factor * (-one.theta / temperature).exp();
            }
            out.temperature.push(temperature);
            out.mass.push(mass);
            out.loss_rate.push(rate);
        }
    }
}

impl StiffSystem for LumpedSystem<'_> {
    fn unknowns(&self) -> usize {
        FIRST + self.reactions.len()
    }

    fn follows_tangent(&self) -> bool {
        false
    }

    fn rates(&mut self, y: &[f64], out: &mut [f64]) {
        let (wall, sample) = (y[WALL], y[SAMPLE]);
        let (gas, _) = self.programme.at(y[TIME]);
        let contact = self.contact * (wall - sample);
        let warmed = self.convection * (gas - wall) + self.radiation * (gas.powi(4) - wall.powi(4));
        let mut taken = 0.0;
        for (k, one) in self.reactions.iter().enumerate() {
            let constant = one.factor * (-one.theta / sample).exp();
            let [_, slope, _] = one.law.at(y[FIRST + k].max(0.0));
            let enthalpy = one.enthalpy + self.kirchhoff[k] * (sample - REFERENCE);
            taken += one.reactant * slope * constant * enthalpy;
            out[FIRST + k] = constant;
        }
        out[WALL] = (warmed - contact) / self.crucible;
        out[SAMPLE] = (contact / self.sample - taken) / self.capacity(y);
        out[TIME] = 1.0;
    }

    fn differentiate(&mut self, y: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives) {
        self.rates(y, out);
        self.trace.unknowns.extend_from_slice(y);
        self.trace.rates.extend_from_slice(out);
        let width = self.unknowns();
        let (wall, sample) = (y[WALL], y[SAMPLE]);
        // The slope within the segment that the step goes into.
        let (gas, heating) = self.programme.at(y[TIME]);
        let capacity = self.capacity(y);
        let jacobian = &mut derivatives.jacobian;
        let mut set =
            |row: usize, column: usize, value: f64| jacobian[row * width + column] = value;
        let outer = self.convection + 4.0 * self.radiation * wall.powi(3);
        set(WALL, WALL, -(outer + self.contact) / self.crucible);
        set(WALL, SAMPLE, self.contact / self.crucible);
        let driven = self.convection + 4.0 * self.radiation * gas.powi(3);
        set(WALL, TIME, driven * heating / self.crucible);
        set(SAMPLE, WALL, self.contact / self.sample / capacity);
        let mut own = self.contact / self.sample;
        for (k, one) in self.reactions.iter().enumerate() {
            let constant = one.factor * (-one.theta / sample).exp();
            let steep = constant * one.theta / (sample * sample);
            let [_, slope, curvature] = one.law.at(y[FIRST + k].max(0.0));
            let enthalpy = one.enthalpy + self.kirchhoff[k] * (sample - REFERENCE);
            own += one.reactant * slope * (steep * enthalpy + constant * self.kirchhoff[k]);
            let taken = one.reactant * curvature * constant * enthalpy;
            let stored = out[SAMPLE] * self.products[k] * slope;
            set(SAMPLE, FIRST + k, -(taken + stored) / capacity);
            set(FIRST + k, SAMPLE, steep);
        }
        set(SAMPLE, SAMPLE, -own / capacity);
    }
}
