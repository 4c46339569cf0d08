//! The words of a case file that stand for a choice, each with what it means to the program: the declarations of
//! keys and the readers take them from here.

pub(super) use calcine_adapters::openfoam::stock::StockSolver;
pub(super) use calcine_coupler::momentum_model::MomentumModel;
pub(super) use calcine_coupler::motion::LostParticles;
pub(super) use calcine_coupler::packing::Share;
use calcine_coupler::packing::regular::Lattice;
pub(super) use calcine_coupler::physics::film::{FilmTemperature, StefanFlow};
pub(super) use calcine_coupler::setup::{Convection, InletScalars, TimeScheme, WallVelocity};
pub(super) use calcine_coupler::time::GasStorage;
pub(super) use calcine_coupler::window_drag::WindowDrag;

use calcine_tuning::DifferenceForm;

use crate::tuning::curves::Delimiter;

pub(super) use super::model::{
    Discharged, ForcePart, Inside, MappingSpec, MotionKind, MotionSpec, Passing, Statistic,
};

/// A choice between words.
pub(super) trait CaseWord: Copy + 'static {
    /// All words with what they mean.
    const ALL: &'static [(&'static str, Self)];
}

/// `model.type` of a tuning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TunedModel {
    /// A sample in a crucible.
    Lumped,
    /// A sample of a known temperature.
    Kinetic,
}

/// `model.heat_capacity` of a tuning: true where it follows the composition.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleCapacity(pub bool);

/// `model.reaction_heat` of a tuning: true where it follows the temperature.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReactionHeat(pub bool);

/// `parameters.scale` of a tuning: true of a logarithmic one.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParameterScale(pub bool);

/// `targets.delimiter` of a tuning.
#[derive(Clone, Copy, Debug)]
pub(super) struct DelimiterName(pub Delimiter);

/// `targets.decimal` of a tuning: true of a comma.
#[derive(Clone, Copy, Debug)]
pub(super) struct DecimalName(pub bool);

/// `method.differences` of a tuning.
#[derive(Clone, Copy, Debug)]
pub(super) struct DifferenceName(pub DifferenceForm);

/// `method.algorithm` of a tuning: true of evolution.
#[derive(Clone, Copy, Debug)]
pub(super) struct TuningAlgorithm(pub bool);

macro_rules! case_words {
    ($($(#[$doc:meta])* $type:ty { $($word:literal => $value:expr),* $(,)? })*) => {
        $($(#[$doc])* impl CaseWord for $type {
            const ALL: &'static [(&'static str, Self)] = &[$(($word, $value)),*];
        })*
    };
}

pub(super) use case_words;

/// `gas.chemistry.model`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CombustionModel {
    /// A cell is mixed.
    Laminar,
    /// Only what turbulence mixes reacts.
    Pasr,
}

/// `gas.turbulence.model`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TurbulenceModel {
    /// Standard k-epsilon.
    KEpsilon,
    /// None.
    Laminar,
}

/// `laws.conduction.area`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AreaName {
    /// The computed overlap.
    Overlap,
    /// That of the real materials under the computed force.
    Force,
    /// That of the real materials under one force.
    Load,
}

/// `laws.mass_transfer.diffusivity`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FilmDiffusivityName {
    /// Mixture-averaged.
    Fuller,
    /// By `gas.schmidt`.
    Schmidt,
}

/// `laws.radiation.inside`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InsideName {
    /// One temperature.
    Isothermal,
    /// Less radiation where spheres conduct badly.
    SinghKaviany,
}

/// `particles.place.packing`: a stacking, or at random.
#[derive(Clone, Copy, Debug)]
pub(super) struct PackingName(pub Option<Lattice>);

/// The word `adiabatic`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Adiabatic;

/// The word `closed`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closed;

/// `motion.parcels.packing`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PackingScheme {
    /// The solid fraction at the end of the step is solved for.
    Implicit,
    /// The gradient of the stress at its start, limited as Snider does.
    Explicit,
    /// No stress.
    None,
}

/// A field of the gas whose difference between patches is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct DifferenceField(pub &'static str);

/// A field of the gas that is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct GasField(pub &'static str);

/// A field of particles that is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParticleField(pub &'static str);

case_words! {
    TunedModel { "lumped" => TunedModel::Lumped, "kinetic" => TunedModel::Kinetic }
    SampleCapacity { "constant" => SampleCapacity(false), "composition" => SampleCapacity(true) }
    ReactionHeat { "constant" => ReactionHeat(false), "kirchhoff" => ReactionHeat(true) }
    ParameterScale { "linear" => ParameterScale(false), "logarithmic" => ParameterScale(true) }
    DelimiterName {
        "semicolon" => DelimiterName(Delimiter::Semicolon),
        "tab" => DelimiterName(Delimiter::Tab),
        "comma" => DelimiterName(Delimiter::Comma),
        "space" => DelimiterName(Delimiter::Space),
    }
    DecimalName { "point" => DecimalName(false), "comma" => DecimalName(true) }
    DifferenceName {
        "absolute" => DifferenceName(DifferenceForm::Absolute),
        "relative" => DifferenceName(DifferenceForm::Relative),
    }
    TuningAlgorithm { "least-squares" => TuningAlgorithm(false), "nsga2" => TuningAlgorithm(true) }
    GasStorage { "process" => GasStorage::Process, "accelerated" => GasStorage::Accelerated }
    MotionKind { "real-time" => MotionKind::RealTime, "accelerated" => MotionKind::Accelerated }
    LostParticles { "end" => LostParticles::End, "take-out" => LostParticles::TakeOut }
    CombustionModel { "laminar" => CombustionModel::Laminar, "pasr" => CombustionModel::Pasr }
    TurbulenceModel {
        "k-epsilon" => TurbulenceModel::KEpsilon,
        "laminar" => TurbulenceModel::Laminar,
    }
    Inside { "thin" => Inside::Thin, "radial" => Inside::Radial, "auto" => Inside::Auto }
    WallVelocity { "no-slip" => WallVelocity::NoSlip, "slip" => WallVelocity::Slip }
    Adiabatic { "adiabatic" => Adiabatic }
    Closed { "closed" => Closed }
    Convection {
        "van-leer" => Convection::VanLeer,
        "upwind" => Convection::Upwind,
        "central" => Convection::Central(1.0),
    }
    TimeScheme { "euler" => TimeScheme::ImplicitEuler, "sdirk2" => TimeScheme::Sdirk2 }
    InletScalars { "flux" => InletScalars::Flux, "value" => InletScalars::Value }
    Share { "number" => Share::Number, "mass" => Share::Mass }
    MotionSpec { "frozen" => MotionSpec::Frozen, "free" => MotionSpec::Free, "parcels" => MotionSpec::Parcels }
    PackingScheme {
        "implicit" => PackingScheme::Implicit,
        "explicit" => PackingScheme::Explicit,
        "none" => PackingScheme::None,
    }
    PackingName {
        "random" => PackingName(None),
        "simple-cubic" => PackingName(Some(Lattice::SimpleCubic)),
        "hexagonal" => PackingName(Some(Lattice::HexagonalClose)),
        "face-centred" => PackingName(Some(Lattice::FaceCentred)),
    }
    WindowDrag { "constant" => WindowDrag::Constant, "following" => WindowDrag::Following }
    MomentumModel { "a" => MomentumModel::A, "b" => MomentumModel::B }
    FilmTemperature {
        "two-thirds" => FilmTemperature::TwoThirds,
        "mean" => FilmTemperature::Mean,
        "gas" => FilmTemperature::Gas,
    }
    StefanFlow {
        "mass" => StefanFlow::Mass,
        "molar" => StefanFlow::Molar,
        "none" => StefanFlow::None,
    }
    AreaName {
        "overlap" => AreaName::Overlap,
        "force" => AreaName::Force,
        "load" => AreaName::Load,
    }
    FilmDiffusivityName {
        "fuller" => FilmDiffusivityName::Fuller,
        "schmidt" => FilmDiffusivityName::Schmidt,
    }
    InsideName {
        "isothermal" => InsideName::Isothermal,
        "singh-kaviany" => InsideName::SinghKaviany,
    }
    MappingSpec {
        "overlap" => MappingSpec::Overlap,
        "divided" => MappingSpec::Divided,
        "centroid" => MappingSpec::Centroid,
        "linear" => MappingSpec::Linear,
    }
    StockSolver {
        "calcineGasFoam" => StockSolver::CalcineGasFoam,
        "buoyantPimpleFoam" => StockSolver::BuoyantPimpleFoam,
        "rhoPimpleFoam" => StockSolver::RhoPimpleFoam,
        "reactingFoam" => StockSolver::ReactingFoam,
    }
    DifferenceField {
        "pressure" => DifferenceField("pressure"),
        "temperature" => DifferenceField("temperature"),
    }
    GasField {
        "temperature" => GasField("temperature"),
        "pressure" => GasField("pressure"),
        "density" => GasField("density"),
        "speed" => GasField("speed"),
        "void_fraction" => GasField("void_fraction"),
        "mass_fraction" => GasField("mass_fraction"),
    }
    ParticleField {
        "temperature" => ParticleField("temperature"),
        "speed" => ParticleField("speed"),
        "height" => ParticleField("height"),
        "x" => ParticleField("x"),
        "y" => ParticleField("y"),
        "z" => ParticleField("z"),
        "angular_speed" => ParticleField("angular_speed"),
        "kinetic_energy" => ParticleField("kinetic_energy"),
        "count" => ParticleField("count"),
        "mass" => ParticleField("mass"),
        "diameter" => ParticleField("diameter"),
        "mass_fraction" => ParticleField("mass_fraction"),
        "conversion" => ParticleField("conversion"),
        "mean_temperature" => ParticleField("mean_temperature"),
        "centre_temperature" => ParticleField("centre_temperature"),
        "shell_count" => ParticleField("shell_count"),
    }
    Passing { "heat" => Passing::Heat, "mass" => Passing::Mass, "species" => Passing::Species }
    ForcePart { "pressure" => ForcePart::Pressure, "viscous" => ForcePart::Viscous, "total" => ForcePart::Total }
    Discharged {
        "mass_flow" => Discharged::MassFlow,
        "mass" => Discharged::Mass,
        "count" => Discharged::Count,
        "residence_time" => Discharged::ResidenceTime,
        "residence_deviation" => Discharged::ResidenceDeviation,
    }
    Statistic { "mean" => Statistic::Mean, "min" => Statistic::Min, "max" => Statistic::Max, "sum" => Statistic::Sum, "deviation" => Statistic::Deviation, "mass-flow-mean" => Statistic::MassFlowMean }
}
