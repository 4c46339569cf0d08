//! Texts of the dictionaries and fields of a generated OpenFOAM case.

use std::fmt::Write;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasPatch, GasSetup, Schedule, WallHeat};

/// The header of an OpenFOAM file.
fn header(class: &str, object: &str) -> String {
    format!(
        "// Written by Calcine.\nFoamFile\n{{\n    version     2.0;\n    format      ascii;\n    \
         class       {class};\n    object      {object};\n}}\n\n"
    )
}

// Numbers are written with `e`, which prints the shortest digits that read back to the same bits.
// Writing into a String cannot fail, so the results of write! below carry nothing.

fn vector(v: Vec3) -> String {
    format!("({:e} {:e} {:e})", v.x, v.y, v.z)
}

fn table(schedule: &Schedule) -> String {
    let entries = schedule.0.iter();
    let entries: Vec<_> = entries.map(|(t, v)| format!("({t:e} {v:e})")).collect();
    format!("({})", entries.join(" "))
}

/// `system/controlDict`. The coordinator drives time, so that none of its times matters.
pub fn control() -> String {
    header("dictionary", "controlDict")
        + "application     calcineGasFoam;\nstartFrom       startTime;\nstartTime       0;\n\
           stopAt          endTime;\nendTime         1;\ndeltaT          1;\n\
           writeControl    timeStep;\nwriteInterval   1;\nwriteFormat     binary;\n\
           writePrecision  8;\nwriteCompression off;\ntimeFormat      general;\n\
           timePrecision   6;\nrunTimeModifiable no;\n"
}

/// `constant/thermophysicalProperties`: ideal gas, constant heat capacity, Sutherland transport.
pub fn thermophysical(setup: &GasSetup) -> String {
    let gas = &setup.properties;
    header("dictionary", "thermophysicalProperties")
        + &format!(
            "// {}\nthermoType\n{{\n    type            hePsiThermo;\n    \
             mixture         pureMixture;\n    transport       sutherland;\n    \
             thermo          hConst;\n    equationOfState perfectGas;\n    \
             specie          specie;\n    energy          sensibleEnthalpy;\n}}\n\nmixture\n{{\n    \
             specie\n    {{\n        molWeight   {:e};\n    }}\n    thermodynamics\n    {{\n        \
             Cp          {:e};\n        Hf          0;\n    }}\n    transport\n    {{\n        \
             As          {:e};\n        Ts          {:e};\n    }}\n}}\n",
            setup.mixture,
            gas.molar_mass * 1e3,
            gas.heat_capacity,
            gas.sutherland_coefficient,
            gas.sutherland_temperature
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
pub fn calcine(setup: &GasSetup, case_hash: &str) -> String {
    let controls = &setup.controls;
    let mut text = header("dictionary", "calcineGas");
    let _ = write!(
        text,
        "caseHash        \"{case_hash}\";\n\
         // Reference pressure of the low-Mach gas in Pa; gravity in m/s^2.\n\
         pRef            {:e};\ngravity         {};\n\
         // Seconds of wall time between lines of the log; 0: a line for each attempt.\n\
         logInterval     1;\n\ncontrols\n{{\n    outerIterations     {};\n    \
         pressureCorrections {};\n    outerTolerance      {:e};\n    linearTolerance     {:e};\n}}\n\n\
         // Tables over process time: (s m/s) and (s K).\npatches\n{{\n",
        setup.pressure,
        vector(setup.gravity),
        controls.outer_iterations,
        controls.pressure_corrections,
        controls.outer_tolerance,
        controls.linear_tolerance
    );
    for (name, condition) in &setup.patches {
        match condition {
            GasPatch::Inlet {
                superficial_velocity,
                temperature,
            } => {
                let _ = writeln!(
                    text,
                    "    {name}\n    {{\n        superficialVelocity {};\n        \
                     temperature         {};\n    }}",
                    table(superficial_velocity),
                    table(temperature)
                );
            }
            GasPatch::Wall {
                heat: WallHeat::Temperature(temperature),
                ..
            } => {
                let _ = writeln!(
                    text,
                    "    {name}\n    {{\n        temperature         {};\n    }}",
                    table(temperature)
                );
            }
            GasPatch::Outlet { .. } | GasPatch::Wall { .. } => {}
        }
    }
    text + "}\n"
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

/// A field of `0/` with a boundary condition for each patch.
fn field(
    (class, name, dimensions, start): (&str, &str, &str, &str),
    setup: &GasSetup,
    condition: impl Fn(&GasPatch) -> String,
) -> String {
    let mut text = header(class, name);
    let _ = write!(
        text,
        "dimensions      {dimensions};\n\ninternalField   uniform {start};\n\nboundaryField\n{{\n"
    );
    for (patch, kind) in &setup.patches {
        let condition = condition(kind);
        let _ = writeln!(text, "    {patch}\n    {{\n        {condition}\n    }}");
    }
    text + "}\n"
}

fn fixed(value: &str) -> String {
    format!("type            fixedValue;\n        value           uniform {value};")
}

fn zero_gradient() -> String {
    "type            zeroGradient;".into()
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
        GasPatch::Outlet { .. } => zero_gradient(),
        GasPatch::Wall { no_slip: true, .. } => "type            noSlip;".into(),
        GasPatch::Wall { no_slip: false, .. } => "type            slip;".into(),
    })
}

/// `0/T`; values of tables at their first time.
pub fn temperature(setup: &GasSetup) -> String {
    let start = format!("{:e}", setup.temperature);
    let about = ("volScalarField", "T", "[0 0 0 1 0 0 0]", &*start);
    let first = |schedule: &Schedule| fixed(&format!("{:e}", schedule.at(0.0)));
    field(about, setup, |patch| match patch {
        GasPatch::Inlet { temperature, .. } => first(temperature),
        GasPatch::Outlet { .. } => zero_gradient(),
        GasPatch::Wall { heat, .. } => match heat {
            WallHeat::Adiabatic => zero_gradient(),
            WallHeat::Temperature(temperature) => first(temperature),
        },
    })
}

/// `0/p`, absolute.
pub fn pressure(setup: &GasSetup) -> String {
    let start = format!("{:e}", setup.pressure);
    let about = ("volScalarField", "p", "[1 -1 -2 0 0 0 0]", &*start);
    field(about, setup, |patch| match patch {
        GasPatch::Outlet { pressure } => fixed(&format!("{pressure:e}")),
        GasPatch::Inlet { .. } | GasPatch::Wall { .. } => zero_gradient(),
    })
}
