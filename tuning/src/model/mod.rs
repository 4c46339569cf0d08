//! Models of a sample that is heated: what follows from their parameters.

mod kinetic;
mod lumped;
mod reaction;

pub use kinetic::KineticModel;
pub use lumped::{LUMPED_PARAMETERS, LumpedModel, LumpedSettings};
pub use reaction::{ModelParameter, ReactionSet, SampleReaction};

use crate::{TemperatureProgramme, TuningError};

/// What a sample goes through.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatingRun {
    /// Temperature of the furnace, or of the sample where the model has none of its own.
    pub programme: TemperatureProgramme,
    /// Mass of the sample at the start in kg.
    pub sample_mass: f64,
    /// Times at which the response is wanted in s, in ascending order from the programme's start on.
    pub times: Vec<f64>,
}

/// What a sample does, at the times of its [`HeatingRun`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampleResponse {
    /// Temperature of the sample in K.
    pub temperature: Vec<f64>,
    /// Mass of the sample relative to that at the start.
    pub mass: Vec<f64>,
    /// Rate at which that falls in 1/s.
    pub loss_rate: Vec<f64>,
}

impl SampleResponse {
    fn clear(&mut self) {
        self.temperature.clear();
        self.mass.clear();
        self.loss_rate.clear();
    }
}

/// A model of one sample, whose numbers can be tuned.
pub trait SampleModel: Send + Sync {
    /// The numbers that it has, in the order of `values`.
    fn parameters(&self) -> &[ModelParameter];

    /// A copy that is ready for one run; what does not depend on the numbers is prepared.
    fn prepare(&self, run: &HeatingRun) -> Box<dyn PreparedSample>;
}

/// A model for one run.
pub trait PreparedSample: Send + Sync {
    /// The response with these numbers, in SI and in the order of [`SampleModel::parameters`].
    fn respond(&self, values: &[f64], out: &mut SampleResponse) -> Result<(), TuningError>;
}
