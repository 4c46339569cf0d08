//! `[gas.turbulence]`, and the eddies of gas that flows in.

use calcine_coupler::physics::law::{LawChoice, NONE};
use calcine_coupler::physics::turbulence::BedEddies;
use calcine_coupler::setup::{InletTurbulence, Turbulence};

use crate::case::model::Output;
use crate::case::table::TableReader;
use crate::case::words::TurbulenceModel;

/// The eddies and what the particles of a bed make of them; laminar where the table is not there, `None` where it is wrong.
pub(super) fn turbulence(
    section: &TableReader<'_>,
) -> Option<(Turbulence, LawChoice<dyn BedEddies>)> {
    let known = &section.laws().bed_eddies;
    let Some(table) = section.table("turbulence") else {
        let none = LawChoice::named(known, NONE, Vec::new())?;
        return (!section.has("turbulence")).then_some((Turbulence::Laminar, none));
    };
    let model: Option<TurbulenceModel> = table.choice("model");
    let initial = table.table("initial");
    let prandtl = table.number("prandtl");
    let schmidt = table.number("schmidt");
    let iterations = table.small_whole("iterations");
    let bed = table.optional_law("bed", known);
    let stated = table.has("iterations");
    let start = initial.and_then(|initial| {
        let energy = initial.number("energy");
        let length_scale = initial.number("length_scale");
        initial.finish();
        Some((energy?, length_scale?))
    });
    table.finish();
    if model? == TurbulenceModel::Laminar {
        let bed = bed?;
        if !bed.is_none() {
            let help = "write model = \"k-epsilon\", or remove it";
            table.fail("bed", "states eddies of the bed of a laminar gas", help);
        }
        if stated {
            let help = "write model = \"k-epsilon\", or remove it";
            table.fail("iterations", "stands beside the laminar model", help);
        }
        return Some((Turbulence::Laminar, bed));
    }
    table.need("initial");
    let (energy, length_scale) = start?;
    let bed = bed?;
    let eddies = Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl: prandtl?,
        schmidt: schmidt?,
        iterations: iterations?,
        in_bed: !bed.is_none(),
    };
    Some((eddies, bed))
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
    let asks = |fields: &[String]| {
        turbulence.is_laminar() && fields.iter().any(|name| name == "turbulence")
    };
    let Some(section) = root.table("output") else {
        return;
    };
    let refuse = |table: &TableReader<'_>| {
        let help = "write `model = \"k-epsilon\"` in [gas.turbulence], or leave it out";
        table.fail("gas", "names \"turbulence\" of a laminar gas", help);
    };
    if asks(&output.gas) {
        refuse(&section);
    }
    if let Some(means) = &output.means
        && asks(&means.gas)
        && let Some(table) = section.table("means")
    {
        refuse(&table);
    }
}
