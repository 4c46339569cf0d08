use calcine_physics::dimension::Dimension;
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::law::{LawEntry, LawValues};

use crate::law::KineticLaw;

/// A number of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelParameter {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value in SI where it is not tuned.
    pub value: f64,
    /// True where it is a positive number that a search takes by its logarithm.
    pub logarithmic: bool,
}

impl ModelParameter {
    /// A number with its value in SI.
    pub fn new(name: impl Into<String>, dimension: Dimension, value: f64) -> Self {
        Self {
            name: name.into(),
            dimension,
            value,
            logarithmic: false,
        }
    }

    /// The same, searched by its logarithm.
    #[must_use]
    pub fn logarithmic(self) -> Self {
        Self {
            logarithmic: true,
            ..self
        }
    }
}

/// One reaction of a sample: x′ = k(T), k = A exp(−E/(R T)), α = law(x).
#[derive(Clone, Debug)]
pub struct SampleReaction {
    /// Its name; empty where it is the only one.
    pub name: String,
    /// Its kinetic law.
    pub law: &'static LawEntry<dyn KineticLaw>,
    /// Values of the law's own numbers.
    pub law_numbers: Vec<f64>,
    /// A in 1/s.
    pub pre_exponential: f64,
    /// E in J/mol.
    pub activation_energy: f64,
    /// Share of the sample's mass at the start that is its reactant.
    pub reactant: f64,
    /// Share of the reactant's mass that goes into the gas.
    pub mass_loss: f64,
    /// Heat that it takes up at 298.15 K in J per kg of reactant.
    pub enthalpy: f64,
}

impl SampleReaction {
    /// Name of one of its numbers among those of the model: of several reactions each is preceded by that of the reaction and a dot.
    pub fn number_name(&self, own: &str) -> String {
        match self.name.is_empty() {
            true => own.to_owned(),
            false => format!("{}.{own}", self.name),
        }
    }
}

/// Numbers of a reaction that come before those of its law.
const OWN: usize = 5;

/// Reactions side by side, each by its own reactant.
#[derive(Clone, Debug)]
pub struct ReactionSet {
    reactions: Vec<SampleReaction>,
}

/// A reaction with its numbers.
#[derive(Debug)]
pub(super) struct RunningReaction {
    /// Its law.
    pub law: Box<dyn KineticLaw>,
    /// A in 1/s.
    pub factor: f64,
    /// E/R in K.
    pub theta: f64,
    /// Share of the sample that is its reactant.
    pub reactant: f64,
    /// Share of the sample that it can take away.
    pub loss: f64,
    /// J per kg of reactant at 298.15 K.
    pub enthalpy: f64,
}

impl ReactionSet {
    /// From its reactions, one or more.
    pub fn new(reactions: Vec<SampleReaction>) -> Self {
        Self { reactions }
    }

    /// The reactions.
    pub fn reactions(&self) -> &[SampleReaction] {
        &self.reactions
    }

    /// Their numbers: A, E, reactant, mass loss, enthalpy and those of the law, reaction by reaction. With several
    /// reactions each name is preceded by that of the reaction and a dot.
    pub fn parameters(&self) -> Vec<ModelParameter> {
        let mut all = Vec::new();
        for reaction in &self.reactions {
            let plain = |own: &str, dimension, value| {
                ModelParameter::new(reaction.number_name(own), dimension, value)
            };
            all.push(
                plain(
                    "pre_exponential",
                    Dimension::ANGULAR_VELOCITY,
                    reaction.pre_exponential,
                )
                .logarithmic(),
            );
            all.push(plain(
                "activation_energy",
                Dimension::MOLAR_ENERGY,
                reaction.activation_energy,
            ));
            all.push(plain("reactant", Dimension::NONE, reaction.reactant));
            all.push(plain("mass_loss", Dimension::NONE, reaction.mass_loss));
            all.push(plain(
                "reaction_enthalpy",
                Dimension::ENERGY_OF_MASS,
                reaction.enthalpy,
            ));
            let of_law = reaction.law.parameters.iter().zip(&reaction.law_numbers);
            all.extend(of_law.map(|(one, &value)| plain(one.name, one.dimension, value)));
        }
        all
    }

    /// The reactions with their numbers, and how many numbers that were.
    pub(super) fn with(&self, values: &[f64]) -> (Vec<RunningReaction>, usize) {
        let mut from = 0;
        let running = self.reactions.iter().map(|reaction| {
            let entry = reaction.law;
            let to = from + OWN + entry.parameters.len();
            let own = &values[from..to];
            from = to;
            RunningReaction {
                law: (entry.make)(&LawValues::from(own[OWN..].to_vec())),
                factor: own[0],
                theta: own[1] / GAS_CONSTANT,
                reactant: own[2],
                loss: own[2] * own[3],
                enthalpy: own[4],
            }
        });
        (running.collect(), from)
    }
}
