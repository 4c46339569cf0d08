//! Cases of a stock solver, which Calcine's fvOption `calcineSource` couples.

use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{GasPatch, GasSetup, InletFlow, Schedule, WallHeat, WallVelocity};

use super::dictionaries::{field, fixed, header, vector, zero_gradient};

/// Which program computes the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// Calcine's own, with the void fraction in every term.
    #[default]
    CalcineGasFoam,
    /// Debian's transient solver of buoyant compressible flow, with Calcine's sources.
    BuoyantPimpleFoam,
}

impl Solver {
    /// The name of the program.
    pub fn name(self) -> &'static str {
        match self {
            Self::CalcineGasFoam => super::SOLVER,
            Self::BuoyantPimpleFoam => "buoyantPimpleFoam",
        }
    }

    /// True for a program that is not Calcine's.
    pub fn is_stock(self) -> bool {
        self != Self::CalcineGasFoam
    }
}

/// What of a gas a stock solver cannot do, in words; `moving_clock`: process and motion time differ.
pub fn refusal(setup: &GasSetup, moving_clock: bool) -> Option<String> {
    if matches!(setup.properties, GasModel::Mixture(_)) {
        return Some("it carries no species (`gas.species`)".into());
    }
    for (name, patch) in &setup.patches {
        let schedules = match patch {
            GasPatch::Inlet {
                flow, temperature, ..
            } => {
                let (InletFlow::SuperficialVelocity(flow) | InletFlow::MassFlow(flow)) = flow;
                vec![flow, temperature]
            }
            GasPatch::Outlet { pressure } => {
                if pressure.0.len() > 1 {
                    return Some(format!(
                        "the pressure of the outlet `{name}` must be constant"
                    ));
                }
                Vec::new()
            }
            GasPatch::Wall { heat, .. } => match heat {
                WallHeat::Adiabatic => Vec::new(),
                WallHeat::Temperature(temperature) => vec![temperature],
                WallHeat::Flux(_) | WallHeat::Convective { .. } => {
                    return Some(format!(
                        "the wall `{name}` may be adiabatic or have a temperature only"
                    ));
                }
            },
            GasPatch::Symmetry => Vec::new(),
        };
        if moving_clock && schedules.iter().any(|schedule| schedule.0.len() > 1) {
            return Some(format!(
                "a value of the patch `{name}` changes with process time, and the solver's own time is \
                 motion time: with `time.acceleration` other than 1 it must be constant"
            ));
        }
    }
    None
}

/// A function of time of OpenFOAM, each value times a factor.
fn function(schedule: &Schedule, factor: f64) -> String {
    match schedule.0.as_slice() {
        [(_, value)] => format!("constant {:e}", factor * value),
        entries => {
            let rows: Vec<_> = entries
                .iter()
                .map(|(time, value)| format!("({time:e} {:e})", factor * value))
                .collect();
            format!("table ({})", rows.join(" "))
        }
    }
}

/// `system/controlDict`, after what it includes. The coordinator sets the time step and ends the run.
pub fn control(solver: Solver, include: &str, library: &str) -> String {
    header("dictionary", "controlDict")
        + include
        + &format!(
            "application     {};\nstartFrom       startTime;\nstartTime       0;\n\
             stopAt          endTime;\nendTime         1e9;\ndeltaT          1e-3;\n\
             adjustTimeStep  no;\nwriteControl    timeStep;\nwriteInterval   2000000000;\n\
             writeFormat     binary;\nwritePrecision  12;\nwriteCompression off;\n\
             timeFormat      general;\ntimePrecision   12;\nrunTimeModifiable no;\n\n\
             libs            (\"{library}\");\n\n\
             functions\n{{\n    calcine\n    {{\n        type calcineCoupling;\n    }}\n}}\n",
            solver.name()
        )
}

/// `constant/fvOptions`, after what it includes.
pub fn options(include: &str) -> String {
    header("dictionary", "fvOptions")
        + include
        + "calcine\n{\n    type            calcineSource;\n}\n"
}

/// `constant/turbulenceProperties` where no template brings its own.
pub fn laminar() -> String {
    header("dictionary", "turbulenceProperties") + "simulationType  laminar;\n"
}

/// `0/U`: superficial.
pub fn velocity(setup: &GasSetup) -> String {
    let start = vector(setup.velocity);
    let about = ("volVectorField", "U", "[0 1 -1 0 0 0 0]", &*start);
    let none = "\n        value           uniform (0 0 0);";
    field(about, setup, |patch| match patch {
        GasPatch::Inlet { flow, .. } => match flow {
            InletFlow::SuperficialVelocity(flow) => format!(
                "type            uniformNormalFixedValue;\n        uniformValue    {};{none}",
                function(flow, -1.0)
            ),
            InletFlow::MassFlow(flow) => format!(
                "type            flowRateInletVelocity;\n        massFlowRate    {};{none}",
                function(flow, 1.0)
            ),
        },
        GasPatch::Outlet { .. } => zero_gradient(),
        GasPatch::Symmetry => "type            slip;".into(),
        GasPatch::Wall { velocity, .. } => match velocity {
            WallVelocity::NoSlip => "type            noSlip;".into(),
            WallVelocity::Slip => "type            slip;".into(),
            WallVelocity::Moving(velocity) => fixed(&vector(*velocity)),
        },
    })
}

/// `0/T`.
pub fn temperature(setup: &GasSetup) -> String {
    let start = format!("{:e}", setup.temperature);
    let about = ("volScalarField", "T", "[0 0 0 1 0 0 0]", &*start);
    let driven = |schedule: &Schedule| {
        format!(
            "type            uniformFixedValue;\n        uniformValue    {};\n        \
             value           uniform {:e};",
            function(schedule, 1.0),
            schedule.at(0.0)
        )
    };
    field(about, setup, |patch| match patch {
        GasPatch::Inlet { temperature, .. }
        | GasPatch::Wall {
            heat: WallHeat::Temperature(temperature),
            ..
        } => driven(temperature),
        _ => zero_gradient(),
    })
}

/// `0/p` and `0/p_rgh`, absolute and without the hydrostatic part.
pub fn pressures(setup: &GasSetup) -> [(&'static str, String); 2] {
    let start = format!("{:e}", setup.pressure);
    let about = |name| ("volScalarField", name, "[1 -1 -2 0 0 0 0]", &*start);
    let given = format!("\n        value           uniform {start};");
    let absolute = field(about("p"), setup, |_| {
        format!("type            calculated;{given}")
    });
    let driving = field(about("p_rgh"), setup, |patch| match patch {
        GasPatch::Outlet { pressure } => format!(
            "type            prghPressure;\n        p               uniform {:e};{given}",
            pressure.at(0.0)
        ),
        _ => format!("type            fixedFluxPressure;{given}"),
    });
    [("0/p", absolute), ("0/p_rgh", driving)]
}
