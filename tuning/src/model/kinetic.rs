use super::reaction::ReactionSet;
use super::{HeatingRun, ModelParameter, PreparedSample, SampleModel, SampleResponse};
use crate::TuningError;
use crate::programme::RateQuadrature;

/// A sample that has the temperature of its programme: reactions by kinetic laws, integrated exactly.
///
/// The reduced times are x = A ∫ exp(−E/(R T)) dt by quadrature over the programme, the conversions follow from the laws
/// (docs/theory.md, TUN-2 and TUN-3). No step is taken and nothing is stiff.
#[derive(Clone, Debug)]
pub struct KineticModel {
    reactions: ReactionSet,
    parameters: Vec<ModelParameter>,
}

impl KineticModel {
    /// Of these reactions.
    pub fn new(reactions: ReactionSet) -> Self {
        let parameters = reactions.parameters();
        Self {
            reactions,
            parameters,
        }
    }
}

impl SampleModel for KineticModel {
    fn parameters(&self) -> &[ModelParameter] {
        &self.parameters
    }

    fn prepare(&self, run: &HeatingRun) -> Box<dyn PreparedSample> {
        let temperature = run.times.iter().map(|&t| run.programme.at(t).0).collect();
        Box::new(PreparedKinetic {
            reactions: self.reactions.clone(),
            quadrature: RateQuadrature::new(&run.programme, &run.times),
            temperature,
        })
    }
}

struct PreparedKinetic {
    reactions: ReactionSet,
    quadrature: RateQuadrature,
    temperature: Vec<f64>,
}

impl PreparedSample for PreparedKinetic {
    fn respond(&self, values: &[f64], out: &mut SampleResponse) -> Result<(), TuningError> {
        out.clear();
        out.temperature.extend_from_slice(&self.temperature);
        out.mass.resize(self.temperature.len(), 1.0);
        out.loss_rate.resize(self.temperature.len(), 0.0);
        let mut reduced = Vec::with_capacity(self.temperature.len());
        for reaction in self.reactions.with(values).0 {
            self.quadrature.integrate(reaction.theta, &mut reduced);
            for (k, (x, temperature)) in reduced.iter().zip(&self.temperature).enumerate() {
                let [conversion, slope, _] = reaction.law.at(reaction.factor * x);
                let constant = reaction.factor * (-reaction.theta / temperature).exp();
                out.mass[k] -= reaction.loss * conversion;
                out.loss_rate[k] += reaction.loss * slope * constant;
            }
        }
        Ok(())
    }
}
