//! What all dictionaries and fields of OpenFOAM are written with.
//!
//! Numbers are written with `e`, which prints the shortest digits that read back to the same bits.

use std::fmt::Write;

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasPatch, GasSetup, Schedule};

/// The header of an OpenFOAM file.
pub(super) fn header(class: &str, object: &str) -> String {
    format!(
        "// Written by Calcine.\nFoamFile\n{{\n    version     2.0;\n    format      ascii;\n    \
         class       {class};\n    object      {object};\n}}\n\n"
    )
}

pub(super) fn vector(v: Vec3) -> String {
    format!("({:e} {:e} {:e})", v.x, v.y, v.z)
}

pub(super) fn table(schedule: &Schedule) -> String {
    let entries = schedule.0.iter();
    let entries: Vec<_> = entries.map(|(t, v)| format!("({t:e} {v:e})")).collect();
    format!("({})", entries.join(" "))
}

/// A field of `0/` with a boundary condition for each patch; of periodic ones and the sides of plane and axisymmetric flows the
/// mesh says it all.
pub(super) fn field(
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
        let condition = match kind {
            GasPatch::Periodic { .. } => "type            cyclic;".to_owned(),
            GasPatch::Empty => "type            empty;".to_owned(),
            GasPatch::Wedge => "type            wedge;".to_owned(),
            kind => condition(kind),
        };
        let _ = writeln!(text, "    {patch}\n    {{\n        {condition}\n    }}");
    }
    text + "}\n"
}

pub(super) fn fixed(value: &str) -> String {
    format!("type            fixedValue;\n        value           uniform {value};")
}

pub(super) fn zero_gradient() -> String {
    "type            zeroGradient;".into()
}

/// OpenFOAM's condition of a wall that turns about an axis: ω × r without its part along the normal.
pub fn turning(point: Vec3, angular_velocity: Vec3) -> String {
    let speed = angular_velocity.norm();
    let axis = if speed > 0.0 {
        angular_velocity / speed
    } else {
        Vec3::z()
    };
    format!(
        "type            rotatingWallVelocity;\n        origin          {};\n        axis            {};\n        omega           constant {speed:e};",
        vector(point),
        vector(axis)
    )
}
