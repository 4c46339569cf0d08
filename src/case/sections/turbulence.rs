//! `[gas.turbulence]`, and the eddies of gas that flows in.

use calcine_coupler::setup::{InletTurbulence, Turbulence};

use crate::case::model::Output;
use crate::case::table::TableReader;
use crate::case::units::Dimension;

/// Turbulent Prandtl number of shear flows near walls: Kays 1994, doi 10.1115/1.2911398.
const PRANDTL: f64 = 0.85;
/// Turbulent Schmidt number of jets and shear layers: 0.7 to 0.9, Tominaga and Stathopoulos 2007, doi
/// 10.1016/j.atmosenv.2007.06.054.
const SCHMIDT: f64 = 0.7;
/// Eddies of gas that flows in, as an example.
const EXAMPLE: &str = "{ intensity = 0.05, length_scale = \"5 mm\" }";

/// Laminar where the table is not there; `None` where it is wrong.
pub(super) fn turbulence(section: &TableReader<'_>) -> Option<Turbulence> {
    let Some(table) = section.table("turbulence") else {
        return (!section.has("turbulence")).then_some(Turbulence::Laminar);
    };
    let laminar = table.required_choice("model", &[("laminar", true), ("k-epsilon", false)]);
    let initial = table.table("initial");
    let prandtl = table.positive("prandtl", Dimension::NONE);
    let schmidt = table.positive("schmidt", Dimension::NONE);
    let start = initial.and_then(|initial| {
        let energy = initial.required_positive("energy", Dimension::ENERGY_OF_MASS);
        let length_scale = initial.required_positive("length_scale", Dimension::LENGTH);
        initial.finish();
        Some((energy?, length_scale?))
    });
    table.finish();
    if laminar? {
        return Some(Turbulence::Laminar);
    }
    if !table.has("initial") {
        let example = "{ energy = \"0.01 m^2/s^2\", length_scale = \"5 mm\" }";
        table.missing("initial", example);
    }
    let (energy, length_scale) = start?;
    Some(Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl: prandtl.unwrap_or(PRANDTL),
        schmidt: schmidt.unwrap_or(SCHMIDT),
    })
}

/// `turbulence` of an inlet: there where the gas is turbulent, and only there; nothing is asked where it is not
/// known whether it is.
pub(super) fn of_inlet(
    table: &TableReader<'_>,
    turbulent: Option<bool>,
) -> Option<Option<InletTurbulence>> {
    let Some(given) = table.table("turbulence") else {
        if turbulent == Some(true) && !table.has("turbulence") {
            table.missing("turbulence", EXAMPLE);
        }
        return (turbulent != Some(true) && !table.has("turbulence")).then_some(None);
    };
    let intensity = given.required_positive("intensity", Dimension::NONE);
    let length_scale = given.required_positive("length_scale", Dimension::LENGTH);
    given.finish();
    if turbulent == Some(false) {
        let help = "write `model = \"k-epsilon\"` in [gas.turbulence], or remove it";
        table.fail("turbulence", "stands in an inlet of a laminar gas", help);
        return None;
    }
    Some(Some(InletTurbulence {
        intensity: intensity?,
        length_scale: length_scale?,
    }))
}

/// Only a turbulent gas that is not held has eddies to write.
pub(super) fn fits(root: &TableReader<'_>, turbulence: &Turbulence, held: bool, output: &Output) {
    let Some(section) = root.table("gas") else {
        return;
    };
    if held && !turbulence.is_laminar() {
        let help = "remove [gas.turbulence], or `held`";
        section.fail("turbulence", "stands beside `held`", help);
    }
    let asked = output.gas.iter().any(|name| name == "turbulence");
    if asked
        && turbulence.is_laminar()
        && let Some(output) = root.table("output")
    {
        let help = "write `model = \"k-epsilon\"` in [gas.turbulence], or leave it out";
        output.fail("gas", "names \"turbulence\" of a laminar gas", help);
    }
}
