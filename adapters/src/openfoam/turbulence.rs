//! OpenFOAM's k-epsilon model from the case's own keys.

use calcine_coupler::physics::turbulence::{KEpsilon, LogLaw};
use calcine_coupler::setup::{GasPatch, GasSetup, InletTurbulence, Turbulence, WallVelocity};
use calcine_coupler::turbulence::BED;

use super::foam_file::{field, header, zero_gradient};

/// Files of a turbulent gas, by their paths in the case; none for a laminar one. `options` is what
/// `constant/fvOptions` includes.
pub fn files(setup: &GasSetup, options: &str) -> Vec<(&'static str, String)> {
    let Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl,
        schmidt,
        in_bed,
        ..
    } = setup.turbulence
    else {
        return Vec::new();
    };
    let dissipation = KEpsilon::STANDARD.dissipation(energy, length_scale);
    vec![
        (
            "constant/turbulenceProperties",
            properties(prandtl, schmidt),
        ),
        (
            "constant/fvOptions",
            header("dictionary", "fvOptions")
                + options
                + &format!(
                    "// Eddies in the bed.\nbed\n{{\n    type             calcineBed;\n    \
                     maxSolidFraction {BED:e};\n    eddies           {};\n}}\n",
                    if in_bed { "yes" } else { "no" }
                ),
        ),
        ("0/k", self::energy(setup, energy)),
        ("0/epsilon", self::dissipation(setup, dissipation)),
        ("0/nut", viscosity(setup)),
        ("0/alphat", diffusivity(setup, prandtl)),
    ]
}

fn properties(prandtl: f64, schmidt: f64) -> String {
    let KEpsilon {
        viscosity,
        production,
        destruction,
        energy_prandtl,
        dissipation_prandtl,
    } = KEpsilon::STANDARD;
    header("dictionary", "turbulenceProperties")
        + &format!(
            "simulationType  RAS;\n\n// Turbulent Schmidt number of species.\nSct             {schmidt:e};\n\n\
             RAS\n{{\n    RASModel        kEpsilon;\n    turbulence      on;\n    printCoeffs     off;\n\n    \
             kEpsilonCoeffs\n    {{\n        Cmu         {viscosity:e};\n        \
             C1          {production:e};\n        C2          {destruction:e};\n        \
             sigmak      {energy_prandtl:e};\n        sigmaEps    {dissipation_prandtl:e};\n        \
             Prt         {prandtl:e};\n    }}\n}}\n"
        )
}

/// Gas sticks to the wall, so that it has a wall function.
fn sticks(patch: &GasPatch) -> bool {
    match patch {
        GasPatch::Wall { velocity, .. } => *velocity != WallVelocity::Slip,
        GasPatch::Inlet { .. }
        | GasPatch::Outlet { .. }
        | GasPatch::Opening { .. }
        | GasPatch::Symmetry
        | GasPatch::Periodic { .. }
        | GasPatch::Empty
        | GasPatch::Wedge => false,
    }
}

/// A condition of a type, with more entries and a first value.
fn condition(kind: &str, more: &str, value: f64) -> String {
    format!("type            {kind};\n{more}        value           uniform {value:e};")
}

/// What a wall function takes from the law of the wall.
fn law() -> String {
    let LogLaw { karman, roughness } = LogLaw::SMOOTH;
    format!("        kappa           {karman:e};\n        E               {roughness:e};\n")
}

fn inlet(patch: &GasPatch) -> Option<InletTurbulence> {
    match patch {
        GasPatch::Inlet { turbulence, .. } => *turbulence,
        GasPatch::Outlet { .. }
        | GasPatch::Opening { .. }
        | GasPatch::Wall { .. }
        | GasPatch::Symmetry
        | GasPatch::Periodic { .. }
        | GasPatch::Empty
        | GasPatch::Wedge => None,
    }
}

/// `0/k`.
fn energy(setup: &GasSetup, start: f64) -> String {
    let about = (
        "volScalarField",
        "k",
        "[0 2 -2 0 0 0 0]",
        &*format!("{start:e}"),
    );
    field(about, setup, |patch| {
        if let Some(InletTurbulence { intensity, .. }) = inlet(patch) {
            let more = format!("        intensity       {intensity:e};\n");
            condition("turbulentIntensityKineticEnergyInlet", &more, start)
        } else if sticks(patch) {
            condition("kqRWallFunction", "", start)
        } else {
            zero_gradient()
        }
    })
}

/// `0/epsilon`.
fn dissipation(setup: &GasSetup, start: f64) -> String {
    let about = (
        "volScalarField",
        "epsilon",
        "[0 2 -3 0 0 0 0]",
        &*format!("{start:e}"),
    );
    field(about, setup, |patch| {
        if let Some(InletTurbulence { length_scale, .. }) = inlet(patch) {
            let more = format!("        mixingLength    {length_scale:e};\n");
            condition("turbulentMixingLengthDissipationRateInlet", &more, start)
        } else if sticks(patch) {
            match setup.turbulence.is_in_bed() {
                true => {
                    let more = format!("        maxSolidFraction {BED:e};\n");
                    condition("calcineEpsilonWallFunction", &(more + &law()), start)
                }
                false => condition("epsilonWallFunction", &law(), start),
            }
        } else {
            zero_gradient()
        }
    })
}

/// `0/nut`.
fn viscosity(setup: &GasSetup) -> String {
    let about = ("volScalarField", "nut", "[0 2 -1 0 0 0 0]", "0");
    field(about, setup, |patch| match sticks(patch) {
        true => condition("nutkWallFunction", &law(), 0.0),
        false => condition("calculated", "", 0.0),
    })
}

/// `0/alphat`.
fn diffusivity(setup: &GasSetup, prandtl: f64) -> String {
    let about = ("volScalarField", "alphat", "[1 -1 -1 0 0 0 0]", "0");
    let number = format!("        Prt             {prandtl:e};\n");
    field(about, setup, |patch| match sticks(patch) {
        true => condition("compressible::alphatWallFunction", &number, 0.0),
        false => condition("calculated", "", 0.0),
    })
}
