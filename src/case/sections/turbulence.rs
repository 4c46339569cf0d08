//! `[gas.turbulence]`, and the eddies of gas that flows in.

use calcine_coupler::setup::{InletTurbulence, Turbulence};

use crate::case::model::Output;
use crate::case::table::TableReader;
use crate::case::words::TurbulenceModel;

/// Laminar where the table is not there; `None` where it is wrong.
pub(super) fn turbulence(section: &TableReader<'_>) -> Option<Turbulence> {
    let Some(table) = section.table("turbulence") else {
        return (!section.has("turbulence")).then_some(Turbulence::Laminar);
    };
    let model: Option<TurbulenceModel> = table.choice("model");
    let initial = table.table("initial");
    let prandtl = table.number("prandtl");
    let schmidt = table.number("schmidt");
    let iterations = table.small_whole("iterations");
    let start = initial.and_then(|initial| {
        let energy = initial.number("energy");
        let length_scale = initial.number("length_scale");
        initial.finish();
        Some((energy?, length_scale?))
    });
    table.finish();
    if model? == TurbulenceModel::Laminar {
        return Some(Turbulence::Laminar);
    }
    table.need("initial");
    let (energy, length_scale) = start?;
    Some(Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl: prandtl?,
        schmidt: schmidt?,
        iterations: iterations?,
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
            table.missing("turbulence");
        }
        return (turbulent != Some(true) && !table.has("turbulence")).then_some(None);
    };
    let intensity = given.number("intensity");
    let length_scale = given.number("length_scale");
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
