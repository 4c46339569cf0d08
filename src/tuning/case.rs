//! A case of the kind "tuning", checked.

use std::path::PathBuf;

use calcine_coupler::physics::law::LawEntry;
use calcine_tuning::law::KineticLaw;
use calcine_tuning::model::{
    KineticModel, LumpedModel, LumpedSettings, ReactionSet, SampleModel, SampleReaction,
};
use calcine_tuning::{DifferenceForm, ParameterSpace, TargetCurve, TunedParameter};

use super::curves::MassAtStart;

/// A tuning as its file states it.
#[derive(Clone, Debug)]
pub struct TuningCase {
    /// Name, from the file's.
    pub name: String,
    /// Title for people.
    pub title: String,
    /// SHA-256 of all values and of the files that are named.
    pub hash: String,
    /// The file.
    pub path: PathBuf,
    /// Files of curves that it names.
    pub files: Vec<PathBuf>,
    /// Its text with `--set` applied.
    pub effective: String,
    /// What `--set` changed, in words.
    pub changes: Vec<String>,
    /// What is tuned.
    pub model: SampleSpec,
    /// The parameters.
    pub parameters: Vec<TunedParameter>,
    /// The curves that are fitted.
    pub targets: Vec<TargetCurve>,
    /// Curves that the tuned model is compared with.
    pub kept_back: Vec<TargetCurve>,
    /// What the masses of each curve are relative to, where it has any.
    pub starts: Vec<Option<MassAtStart>>,
    /// Share of the sample that a conversion of one takes away: as stated, else that of the curves.
    pub loss: f64,
    /// How it is tuned.
    pub method: MethodSpec,
    /// How well the parameters are known.
    pub intervals: IntervalSpec,
    /// What is to be told before it begins.
    pub warnings: Vec<String>,
}

/// A model of a sample.
#[derive(Clone, Debug)]
pub struct SampleSpec {
    /// Settings and numbers of the crucible; `None` of a sample that has the temperature of the target.
    pub crucible: Option<(LumpedSettings, Vec<(&'static str, f64)>)>,
    /// The reactions, each with the law that it is compared by first.
    pub reactions: Vec<SampleReaction>,
    /// Laws that the reaction is compared with, and numbers of each; one of several reactions.
    pub laws: Vec<LawCandidate>,
}

/// A law with the values of its numbers.
#[derive(Clone, Debug)]
pub struct LawCandidate {
    /// The law.
    pub law: &'static LawEntry<dyn KineticLaw>,
    /// Values of its numbers where they are not tuned.
    pub numbers: Vec<f64>,
}

impl SampleSpec {
    /// The reactions with one of the laws.
    pub fn reactions_with(&self, candidate: &LawCandidate) -> Vec<SampleReaction> {
        let mut reactions = self.reactions.clone();
        if let [only] = &mut reactions[..] {
            only.law = candidate.law;
            only.law_numbers.clone_from(&candidate.numbers);
        }
        reactions
    }

    /// The model with one of the laws.
    pub fn model(&self, candidate: &LawCandidate) -> Box<dyn SampleModel> {
        let reactions = ReactionSet::new(self.reactions_with(candidate));
        match &self.crucible {
            None => Box::new(KineticModel::new(reactions)),
            Some((settings, numbers)) => {
                let mut model = LumpedModel::new(*settings, reactions);
                for (name, value) in numbers {
                    model.set(name, *value);
                }
                Box::new(model)
            }
        }
    }
}

/// How parameters are searched for.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodSpec {
    /// True: NSGA-II; false: least squares alone.
    pub evolution: bool,
    /// Size of its population.
    pub population: usize,
    /// Its generations.
    pub generations: usize,
    /// Seed of all that is drawn.
    pub seed: u64,
    /// Sets that least squares tries first.
    pub samples: usize,
    /// How many it follows.
    pub starts: usize,
    /// How differences count.
    pub differences: DifferenceForm,
    /// Objective that chooses; `None`: all, by their likelihood.
    pub choose: Option<String>,
    /// Whether the point that evolution found is fitted further.
    pub polish: bool,
}

/// How intervals are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalSpec {
    /// Probability with which they hold the true value.
    pub level: f64,
    /// Whether profiles are followed.
    pub profile: bool,
    /// Sets of data that are drawn anew.
    pub bootstrap: usize,
}

impl TuningCase {
    /// The parameters that a model has, as a space; those of other laws are left out.
    pub fn space_of(
        &self,
        model: &dyn SampleModel,
    ) -> Result<ParameterSpace, calcine_tuning::TuningError> {
        let has = |one: &&TunedParameter| model.parameters().iter().any(|own| own.name == one.name);
        ParameterSpace::new(self.parameters.iter().filter(has).cloned().collect())
    }
}
