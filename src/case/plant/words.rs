//! The words of a plant's case that stand for a choice.

use calcine_flowsheet::Integrator;
use calcine_flowsheet::population::GrowthScheme;

use crate::case::words::{CaseWord, case_words};

/// `method.recycles`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum RecycleMethod {
    /// Closed at every evaluation.
    Monolithic,
    /// Waveform relaxation.
    Waveform,
}

/// `method.integrator`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) struct PlantIntegrator(pub Integrator);

/// `method.waveform.acceleration`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum TearMethod {
    /// Anderson.
    Anderson,
    /// Wegstein.
    Wegstein,
}

/// How a schedule runs between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum InBetween {
    /// In straight lines.
    Line,
    /// In steps.
    Step,
}

/// `units.granulator.heat`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum HeatOfBed {
    /// The temperature is held.
    Held,
    /// It follows from the balance.
    Balanced,
}

/// `units.granulator.scheme`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) struct SchemeOfGrowth(pub GrowthScheme);

/// What is measured of a stream or of what a unit holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantField {
    /// Mass, or mass flow.
    Mass,
    /// Solids.
    Solids,
    /// A compound in all phases.
    Compound,
    /// Solids of a class of an attribute.
    Class,
    /// Their mean diameter by mass.
    ClassMeanDiameter,
    /// Liquids per solids.
    Moisture,
    /// Temperature.
    Temperature,
    /// Mean diameter by mass.
    MeanDiameter,
    /// Diameters below which 10, 50 and 90 % of the mass lie.
    Quantile(u8),
    /// Output of a controller.
    Output,
}

/// `tuning.state`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantTunedState {
    /// The run at the times of the measurements.
    Run,
    /// The steady state.
    Steady,
}

/// What a quantity takes of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverTime {
    /// The last value.
    Last,
    /// The mean.
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The largest less the smallest.
    Span,
    /// The period of an oscillation.
    Period,
}

/// What is measured of a steady state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SteadyField {
    /// Growth rate of the dominant mode.
    GrowthRate,
    /// Its period.
    Period,
    /// Distance of the end of the run.
    Distance,
}

/// What is measured of a limit of stability.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitField {
    /// The value of the key.
    Value,
    /// The period.
    Period,
}

/// `steady.from`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SteadyFrom {
    /// The end of the run.
    End,
    /// Its start.
    Start,
}

case_words! {
    RecycleMethod {
        "monolithic" => RecycleMethod::Monolithic,
        "waveform" => RecycleMethod::Waveform,
    }
    PlantIntegrator {
        "explicit" => PlantIntegrator(Integrator::Explicit),
        "stabilised" => PlantIntegrator(Integrator::Stabilised),
        "stiff" => PlantIntegrator(Integrator::Stiff),
    }
    TearMethod {
        "anderson" => TearMethod::Anderson,
        "wegstein" => TearMethod::Wegstein,
    }
    InBetween { "line" => InBetween::Line, "step" => InBetween::Step }
    HeatOfBed { "held" => HeatOfBed::Held, "balanced" => HeatOfBed::Balanced }
    SchemeOfGrowth {
        "van-leer" => SchemeOfGrowth(GrowthScheme::VanLeer),
        "koren" => SchemeOfGrowth(GrowthScheme::Koren),
        "upwind" => SchemeOfGrowth(GrowthScheme::Upwind),
        "dyssol" => SchemeOfGrowth(GrowthScheme::Dyssol),
    }
    PlantField {
        "mass_flow" => PlantField::Mass,
        "solid_flow" => PlantField::Solids,
        "compound" => PlantField::Compound,
        "class" => PlantField::Class,
        "class_mean_diameter" => PlantField::ClassMeanDiameter,
        "moisture" => PlantField::Moisture,
        "temperature" => PlantField::Temperature,
        "mean_diameter" => PlantField::MeanDiameter,
        "d10" => PlantField::Quantile(10),
        "d50" => PlantField::Quantile(50),
        "d90" => PlantField::Quantile(90),
        "output" => PlantField::Output,
    }
    PlantTunedState { "run" => PlantTunedState::Run, "steady" => PlantTunedState::Steady }
    OverTime {
        "last" => OverTime::Last,
        "mean" => OverTime::Mean,
        "min" => OverTime::Min,
        "max" => OverTime::Max,
        "span" => OverTime::Span,
        "period" => OverTime::Period,
    }
    SteadyField {
        "growth_rate" => SteadyField::GrowthRate,
        "period" => SteadyField::Period,
        "distance" => SteadyField::Distance,
    }
    LimitField { "value" => LimitField::Value, "period" => LimitField::Period }
    SteadyFrom { "end" => SteadyFrom::End, "start" => SteadyFrom::Start }
}
