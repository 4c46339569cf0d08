//! Texts of the dictionaries and fields of a generated OpenFOAM case.

use std::fmt::Write;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{
    AxialTemperature, Convection, GasControls, GasPatch, GasSetup, InletFlow, InletScalars,
    PatchGas, Schedule, TimeScheme, Turbulence, WallHeat, WallVelocity,
};
use calcine_wire::Catalogue;

use super::decompose;
use super::foam_file::{field, fixed, header, table, turning, vector, zero_gradient};
use super::species;
use super::stock::StockSolver;

// Writing into a String cannot fail, so the results of write! below carry nothing.

/// `system/controlDict`, after what it includes. The coordinator drives time, so that none of its times
/// matters.
pub fn control(program: &str, include: &str) -> String {
    header("dictionary", "controlDict")
        + include
        + &format!("application     {program};\n")
        + "startFrom       startTime;\nstartTime       0;\n\
           stopAt          endTime;\nendTime         1;\ndeltaT          1;\n\
           writeControl    timeStep;\nwriteInterval   1;\nwriteFormat     binary;\n\
           writePrecision  17;\nwriteCompression off;\ntimeFormat      general;\n\
           timePrecision   6;\nrunTimeModifiable no;\n"
}

/// `system/decomposeParDict`: cells go where a list says.
pub fn decompose(ranks: u32) -> String {
    let list = decompose::DATA;
    header("dictionary", "decomposeParDict")
        + &format!(
            "numberOfSubdomains {ranks};\nmethod          manual;\n\
             manualCoeffs {{ dataFile \"{list}\"; }}\n"
        )
}

/// A list of labels in `constant/`.
pub fn labels(name: &str, values: &[u32]) -> String {
    let mut text = header("labelList", name) + &format!("{}\n(\n", values.len());
    for value in values {
        let _ = writeln!(text, "{value}");
    }
    text + ")\n"
}

/// `constant/thermophysicalProperties`: an ideal gas with constant heat capacity and Sutherland
/// transport, a fluid of constant properties, or a mixture of species.
pub fn thermophysical(setup: &GasSetup, solver: StockSolver) -> String {
    // buoyantPimpleFoam asks for a model of the density.
    let psi = if solver == StockSolver::BuoyantPimpleFoam {
        "heRhoThermo"
    } else {
        "hePsiThermo"
    };
    if let (StockSolver::ReactingFoam, GasModel::Perfect(gas)) = (solver, &setup.properties) {
        return super::stock::one_species(&setup.mixture, gas);
    }
    let (kinds, numbers) = match &setup.properties {
        GasModel::Perfect(gas) => (
            [psi, "sutherland", "perfectGas"],
            [
                ("molWeight", gas.molar_mass * 1e3),
                ("Cp", gas.heat_capacity),
                ("As", gas.sutherland_coefficient),
                ("Ts", gas.sutherland_temperature),
            ]
            .map(|(key, value)| (key, format!("{value:e}"))),
        ),
        GasModel::Constant(gas) => (
            ["heRhoThermo", "const", "rhoConst"],
            [
                // The equation of state does not look at it.
                ("molWeight", 28.96),
                ("Cp", gas.heat_capacity),
                ("mu", gas.viscosity),
                ("Pr", gas.viscosity * gas.heat_capacity / gas.conductivity),
            ]
            .map(|(key, value)| (key, format!("{value:e}"))),
        ),
        GasModel::Mixture(mixture) => return species::thermophysical(&setup.mixture, mixture),
    };
    let [kind, transport, state] = kinds;
    let [weight, capacity, first, second] = numbers.map(|(key, value)| format!("{key} {value};"));
    let density = match &setup.properties {
        GasModel::Constant(gas) => format!("    equationOfState {{ rho {:e}; }}\n", gas.density),
        GasModel::Perfect(_) | GasModel::Mixture(_) => String::new(),
    };
    header("dictionary", "thermophysicalProperties")
        + &format!(
            "// {}\nthermoType\n{{\n    type            {kind};\n    \
                 mixture         pureMixture;\n    transport       {transport};\n    \
                 thermo          hConst;\n    equationOfState {state};\n    \
                 specie          specie;\n    energy          sensibleEnthalpy;\n}}\n\nmixture\n\
                 {{\n    specie {{ {weight} }}\n    thermodynamics {{ {capacity} Hf 0; }}\n    \
                 transport {{ {first} {second} }}\n{density}}}\n",
            setup.mixture
        )
}

/// `constant/g`, for OpenFOAM's own tools; the solver reads it in `calcineGas`.
pub fn gravity(setup: &GasSetup) -> String {
    header("uniformDimensionedVectorField", "g")
        + &format!(
            "dimensions      [0 1 -2 0 0 0 0];\nvalue           {};\n",
            vector(setup.gravity)
        )
}

/// `constant/calcineGas`: what only calcineGasFoam reads.
pub fn calcine(setup: &GasSetup, case_hash: &str, catalogue: &Catalogue) -> String {
    let controls = &setup.controls;
    let mut text = header("dictionary", "calcineGas");
    let _ = write!(
        text,
        "caseHash        \"{case_hash}\";\n\
         // Reference pressure of the low-Mach gas in Pa; gravity in m/s^2.\n\
         pRef            {:e};\ngravity         {};\n\
         // Mean pressure gradient in Pa/m beside that of the pressure field.\npressureGradient {};\n\
         // How gas and particles share the pressure gradient: a or b.\nmomentumModel   {};\n\
         // Seconds of wall time between lines of the log; 0: a line for each attempt.\n\
         logInterval     1;\n\ncontrols\n{{\n    outerIterations     {};\n    \
         pressureCorrections {};\n    mostPressureCorrections {};\n    outerTolerance      {:e};\n    \
         linearTolerance     {:e};\n    \
         twoStages           {};\n}}\n\n\
         // Tables over process time in s: m/s, kg/s, K, Pa, W/m^2, W/m^2/K.\npatches\n{{\n",
        setup.pressure,
        vector(setup.gravity),
        vector(setup.pressure_gradient),
        setup.momentum.name(),
        controls.outer_iterations,
        controls.pressure_corrections,
        controls.most_pressure_corrections,
        controls.outer_tolerance,
        controls.linear_tolerance.unwrap_or(GasControls::CLOSE),
        controls.time_scheme == TimeScheme::Sdirk2
    );
    let names = setup.properties.species();
    for (name, condition) in &setup.patches {
        let entries = entries(condition, names);
        if !entries.is_empty() {
            let _ = writeln!(text, "    {name}\n    {{");
            for (key, value) in entries {
                // A dictionary ends without a semicolon.
                let end = if value.ends_with('}') { "" } else { ";" };
                let _ = writeln!(text, "        {key:<19} {value}{end}");
            }
            let _ = writeln!(text, "    }}");
        }
    }
    text += "}\n\n// Schmidt number of all species of a mixture.\n";
    let _ = writeln!(text, "schmidt         {:e};\n", setup.schmidt);
    if let Turbulence::KEpsilon { iterations, .. } = setup.turbulence {
        let _ = write!(
            text,
            "// The eddies go to Calcine with the state.\nsendsEddies     yes;\n// Iterations of the linear solvers of k and \
             epsilon at most.\nturbulenceIterations {iterations};\n\n"
        );
    }
    if tells_backflow(setup) {
        text += "// What comes back in through outlets goes to Calcine with the state.\ntellsBackflow   yes;\n\n";
    }
    text += "// Columns of the link to Calcine.\ncatalogue\n(\n";
    for column in catalogue.fields() {
        let _ = writeln!(text, "    \"{column}\"");
    }
    text + ");\n"
}

/// Whether gas may come back in through an outlet whose case does not state it.
pub fn tells_backflow(setup: &GasSetup) -> bool {
    let unstated = |patch: &GasPatch| matches!(patch, GasPatch::Outlet { backflow: None, .. });
    setup.patches.iter().any(|(_, patch)| unstated(patch))
}

/// What calcineGasFoam drives at a patch: keys and tables over process time.
fn entries(condition: &GasPatch, names: &[String]) -> Vec<(&'static str, String)> {
    match condition {
        GasPatch::Inlet {
            flow,
            temperature,
            composition,
            // OpenFOAM's own conditions: 0/k, 0/epsilon.
            turbulence: _,
            scalars,
        } => {
            let flow = match flow {
                InletFlow::SuperficialVelocity(flow) => ("superficialVelocity", table(flow)),
                InletFlow::MassFlow(flow) => ("massFlow", table(flow)),
            };
            let scalars = match scalars {
                InletScalars::Flux => "flux",
                InletScalars::Value => "value",
            };
            let mut entries = vec![
                flow,
                ("temperature", table(temperature)),
                ("scalars", scalars.into()),
            ];
            if let Some(composition) = composition {
                entries.push(("composition", species::tables(composition, names)));
            }
            entries
        }
        GasPatch::Outlet { pressure, backflow } => {
            let mut entries = vec![("pressure", table(pressure))];
            entries.extend(backflow.iter().flat_map(|gas| beyond(gas, names)));
            entries
        }
        GasPatch::Opening { pressure, at, gas } => {
            let mut entries = vec![("pressure", table(pressure)), ("pressureAt", vector(*at))];
            entries.extend(beyond(gas, names));
            entries
        }
        GasPatch::Symmetry | GasPatch::Empty | GasPatch::Wedge => vec![("closed", "true".into())],
        GasPatch::Periodic { .. } => Vec::new(),
        GasPatch::Wall { heat, .. } => {
            let mut entries = vec![("closed", "true".into())];
            match heat {
                WallHeat::Adiabatic => {}
                WallHeat::Temperature(temperature) => {
                    entries.push(("temperature", table(temperature)));
                }
                WallHeat::Along(along) => entries.push(("along", stations(along))),
                WallHeat::Flux(flux) => entries.push(("heatFlux", table(flux))),
                WallHeat::Convective {
                    coefficient,
                    ambient,
                } => {
                    entries.push(("coefficient", table(coefficient)));
                    entries.push(("ambient", table(ambient)));
                }
            }
            entries
        }
    }
}

/// Axis, coordinates and a table each of the stations of a wall's temperature.
fn stations(along: &AxialTemperature) -> String {
    let positions: Vec<String> = along
        .stations
        .iter()
        .map(|(x, _)| format!("{x:e}"))
        .collect();
    let tables = along.stations.iter().enumerate();
    let tables: Vec<String> = tables
        .map(|(index, (_, over))| format!("station{index} {};", table(over)))
        .collect();
    format!(
        "{{ axis {}; positions ({}); {} }}",
        vector(along.axis),
        positions.join(" "),
        tables.join(" ")
    )
}

/// Keys and tables of gas beyond a patch.
fn beyond(gas: &PatchGas, names: &[String]) -> Vec<(&'static str, String)> {
    let mut entries = vec![("temperature", table(&gas.temperature))];
    if let Some(composition) = &gas.composition {
        entries.push(("composition", species::tables(composition, names)));
    }
    entries
}

/// The convection schemes of the case in a text of `system/fvSchemes` that has upwind ones.
pub fn schemes(text: &str, convection: Convection) -> String {
    let [velocity, enthalpy, fractions] = match convection {
        Convection::Upwind => return text.to_owned(),
        Convection::VanLeer => ["vanLeerV", "calcineVanLeer", "calcineVanLeer"].map(str::to_owned),
        Convection::Central(share) => {
            let central = format!("fixedBlended {share} calcineLinear upwind");
            [central.clone(), central, "calcineVanLeer".into()]
        }
        Convection::LimitedLinear(k) => [
            format!("limitedLinearV {k}"),
            format!("calcineLimitedLinear {k}"),
            "calcineVanLeer".into(),
        ],
    };
    [
        ("div(phi,U)     ", velocity),
        ("div(phi,h)     ", enthalpy),
        ("div(phi,Yi)    ", fractions),
    ]
    .iter()
    .fold(text.to_owned(), |text, (term, scheme)| {
        text.replace(
            &format!("{term} Gauss upwind;"),
            &format!("{term} Gauss {scheme};"),
        )
    })
}

/// `constant/calcineCells`: volumes and centres, which the solver compares with OpenFOAM's.
pub fn cells(mesh: &Mesh) -> String {
    let mut text = format!("{}\n(\n", mesh.cells());
    for volume in mesh.cell_volume() {
        let _ = writeln!(text, "{volume:e}");
    }
    let _ = writeln!(text, ")\n{}\n(", mesh.cells());
    for &centre in mesh.cell_centre() {
        let _ = writeln!(text, "{}", vector(centre));
    }
    text + ")\n"
}

/// `0/U`: superficial where the run starts; the solver sets inlets from the tables.
pub fn velocity(setup: &GasSetup) -> String {
    let about = (
        "volVectorField",
        "U",
        "[0 1 -1 0 0 0 0]",
        &*vector(setup.velocity),
    );
    field(about, setup, |patch| match patch {
        GasPatch::Inlet { .. } => fixed("(0 0 0)"),
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

/// `0/T`; values of tables at their first time.
pub fn temperature(setup: &GasSetup) -> String {
    let start = format!("{:e}", setup.temperature);
    let about = ("volScalarField", "T", "[0 0 0 1 0 0 0]", &*start);
    let first = |schedule: &Schedule| fixed(&format!("{:e}", schedule.at(0.0)));
    field(about, setup, |patch| match patch {
        GasPatch::Inlet { temperature, .. } => first(temperature),
        GasPatch::Outlet { .. }
        | GasPatch::Opening { .. }
        | GasPatch::Symmetry
        | GasPatch::Periodic { .. }
        | GasPatch::Empty
        | GasPatch::Wedge => zero_gradient(),
        // The solver adds heat fluxes and losses to its equation.
        GasPatch::Wall { heat, .. } => match heat {
            WallHeat::Temperature(temperature) => first(temperature),
            // The solver sets the faces one by one.
            WallHeat::Along(along) => first(&along.stations[0].1),
            WallHeat::Adiabatic | WallHeat::Flux(_) | WallHeat::Convective { .. } => {
                zero_gradient()
            }
        },
    })
}

/// `0/p`, absolute.
pub fn pressure(setup: &GasSetup) -> String {
    let start = format!("{:e}", setup.pressure);
    let about = ("volScalarField", "p", "[1 -1 -2 0 0 0 0]", &*start);
    field(about, setup, |patch| match patch {
        GasPatch::Outlet { pressure, .. } | GasPatch::Opening { pressure, .. } => {
            fixed(&format!("{:e}", pressure.at(0.0)))
        }
        GasPatch::Inlet { .. }
        | GasPatch::Wall { .. }
        | GasPatch::Symmetry
        | GasPatch::Periodic { .. }
        | GasPatch::Empty
        | GasPatch::Wedge => zero_gradient(),
    })
}
