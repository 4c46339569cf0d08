//! Cases of a stock solver, which Calcine's fvOption `calcineSource` couples.

use calcine_coupler::physics::gas::{GAS_CONSTANT, GasProperties};
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{
    GasPatch, GasSetup, InletFlow, InletScalars, Schedule, WallHeat, WallVelocity,
};

use super::foam_file::{field, fixed, header, turning, vector, zero_gradient};

/// Which program computes the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StockSolver {
    /// Calcine's own, with the void fraction in every term.
    #[default]
    CalcineGasFoam,
    /// Debian's transient solver of buoyant compressible flow, with Calcine's sources.
    BuoyantPimpleFoam,
    /// The same without gravity.
    RhoPimpleFoam,
    /// Debian's transient solver of reacting flow without gravity, here of one gas that does not react.
    ReactingFoam,
}

impl StockSolver {
    /// The name of the program.
    pub fn name(self) -> &'static str {
        match self {
            Self::CalcineGasFoam => super::names::SOLVER,
            Self::BuoyantPimpleFoam => "buoyantPimpleFoam",
            Self::RhoPimpleFoam => "rhoPimpleFoam",
            Self::ReactingFoam => "reactingFoam",
        }
    }

    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::CalcineGasFoam,
        Self::BuoyantPimpleFoam,
        Self::RhoPimpleFoam,
        Self::ReactingFoam,
    ];

    /// Schemes and linear solvers where no template brings its own.
    pub fn defaults(self) -> [(&'static str, &'static str); 2] {
        macro_rules! system {
            ($folder:literal) => {
                [
                    (
                        "system/fvSchemes",
                        include_str!(concat!("../../../of-cases/", $folder, "/system/fvSchemes")),
                    ),
                    (
                        "system/fvSolution",
                        include_str!(concat!("../../../of-cases/", $folder, "/system/fvSolution")),
                    ),
                ]
            };
        }
        match self {
            Self::CalcineGasFoam => system!("default"),
            Self::BuoyantPimpleFoam => system!("buoyantPimpleFoam"),
            Self::RhoPimpleFoam => system!("rhoPimpleFoam"),
            Self::ReactingFoam => system!("reactingFoam"),
        }
    }

    /// True where gravity acts in it.
    pub fn has_gravity(self) -> bool {
        matches!(self, Self::CalcineGasFoam | Self::BuoyantPimpleFoam)
    }

    /// True for a program that is not Calcine's.
    pub fn is_stock(self) -> bool {
        self != Self::CalcineGasFoam
    }
}

/// What of a gas a stock solver cannot do, in words; `moving_clock`: process and motion time differ.
pub fn refusal(solver: StockSolver, setup: &GasSetup, moving_clock: bool) -> Option<String> {
    if !solver.has_gravity() && setup.gravity.norm() > 0.0 {
        return Some("it has no gravity (`gas.gravity`)".into());
    }
    if setup.pressure_gradient.norm() > 0.0 {
        return Some("it has no mean pressure gradient (`gas.pressure_gradient`)".into());
    }
    if solver != StockSolver::BuoyantPimpleFoam && matches!(setup.properties, GasModel::Constant(_))
    {
        return Some("its gas has a density that follows the pressure (`gas.mixture`)".into());
    }
    if matches!(setup.properties, GasModel::Mixture(_)) {
        return Some("it carries no species (`gas.species`)".into());
    }
    for (name, patch) in &setup.patches {
        let schedules = match patch {
            GasPatch::Inlet {
                scalars: InletScalars::Flux,
                ..
            } => {
                return Some(format!(
                    "it conducts heat through the inlet `{name}` beside the flow: write `scalars = \"value\"` there"
                ));
            }
            GasPatch::Inlet {
                flow, temperature, ..
            } => {
                let (InletFlow::SuperficialVelocity(flow) | InletFlow::MassFlow(flow)) = flow;
                vec![flow, temperature]
            }
            GasPatch::Opening { .. } => {
                return Some(format!(
                    "it has no openings (`gas.patch.{name}`): write an outlet"
                ));
            }
            GasPatch::Outlet {
                backflow: Some(_), ..
            } => {
                return Some(format!(
                    "gas that comes back in at the outlet `{name}` is that of the cell: leave out its `backflow`"
                ));
            }
            GasPatch::Outlet { pressure, .. } => {
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
                WallHeat::Along(_) | WallHeat::Flux(_) | WallHeat::Convective { .. } => {
                    return Some(format!(
                        "the wall `{name}` may be adiabatic or have one temperature only"
                    ));
                }
            },
            GasPatch::Symmetry | GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge => {
                Vec::new()
            }
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
pub fn control(solver: StockSolver, include: &str, library: &str) -> String {
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

/// Name of the one species of a gas that does not react.
const SPECIES: &str = "gas";

/// What reactingFoam reads beside the others: its one species, and that it does not react.
pub fn reacting(setup: &GasSetup) -> [(&'static str, String); 2] {
    let about = ("volScalarField", SPECIES, "[0 0 0 0 0 0 0]", "1");
    let fraction = field(about, setup, |patch| match patch {
        GasPatch::Inlet { .. } => fixed("1"),
        _ => zero_gradient(),
    });
    let none = header("dictionary", "combustionProperties") + "combustionModel none;\n";
    [("0/gas", fraction), ("constant/combustionProperties", none)]
}

/// `constant/thermophysicalProperties` of reactingFoam: an ideal gas of one species with a constant heat capacity
/// (as a polynomial of one term; this solver has no Sutherland's law beside a constant) and Sutherland's law.
pub fn one_species(name: &str, gas: &GasProperties) -> String {
    let coefficient = gas.heat_capacity * gas.molar_mass / GAS_CONSTANT;
    let polynomial = format!("({coefficient:e} 0 0 0 0 0 0)");
    header("dictionary", "thermophysicalProperties")
        + &format!(
            "// {name}\nthermoType\n{{\n    type            hePsiThermo;\n    mixture         \
             multiComponentMixture;\n    transport       sutherland;\n    thermo          janaf;\n    \
             equationOfState perfectGas;\n    specie          specie;\n    energy          \
             sensibleEnthalpy;\n}}\n\nspecies ({SPECIES});\ninertSpecie {SPECIES};\n\n{SPECIES}\n{{\n    \
             specie {{ molWeight {:e}; }}\n    thermodynamics\n    {{\n        Tlow 1; Tcommon 1000; \
             Thigh 10000;\n        lowCpCoeffs {polynomial};\n        highCpCoeffs {polynomial};\n    }}\n    \
             transport {{ As {:e}; Ts {:e}; }}\n}}\n",
            gas.molar_mass * 1e3,
            gas.sutherland_coefficient,
            gas.sutherland_temperature
        )
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
        GasPatch::Outlet { .. } | GasPatch::Opening { .. } => zero_gradient(),
        GasPatch::Symmetry | GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge => {
            "type            slip;".into()
        }
        GasPatch::Wall { velocity, .. } => match velocity {
            WallVelocity::NoSlip => "type            noSlip;".into(),
            WallVelocity::Slip => "type            slip;".into(),
            WallVelocity::Moving(velocity) => fixed(&vector(*velocity)),
            WallVelocity::Rotating {
                point,
                angular_velocity,
            } => turning(*point, *angular_velocity),
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

/// `0/p`, absolute, and, for a solver with gravity, `0/p_rgh` without the hydrostatic part.
pub fn pressures(solver: StockSolver, setup: &GasSetup) -> Vec<(&'static str, String)> {
    let start = format!("{:e}", setup.pressure);
    let about = |name| ("volScalarField", name, "[1 -1 -2 0 0 0 0]", &*start);
    if !solver.has_gravity() {
        let absolute = field(about("p"), setup, |patch| match patch {
            GasPatch::Outlet { pressure, .. } => fixed(&format!("{:e}", pressure.at(0.0))),
            _ => zero_gradient(),
        });
        return vec![("p", absolute)];
    }
    let given = format!("\n        value           uniform {start};");
    let absolute = field(about("p"), setup, |_| {
        format!("type            calculated;{given}")
    });
    let driving = field(about("p_rgh"), setup, |patch| match patch {
        GasPatch::Outlet { pressure, .. } => format!(
            "type            prghPressure;\n        p               uniform {:e};{given}",
            pressure.at(0.0)
        ),
        _ => format!("type            fixedFluxPressure;{given}"),
    });
    vec![("p", absolute), ("p_rgh", driving)]
}
