//! `[laws]`: each is stated, none has a default.

use calcine_coupler::physics::law::LawChoice;
use calcine_coupler::physics::turbulence::BedEddies;

use super::heat;
use crate::case::model::Laws;
use crate::case::table::TableReader;

/// `bed_eddies` is what `[gas.turbulence]` chose.
pub(super) fn read(
    root: &TableReader<'_>,
    bed_eddies: Option<LawChoice<dyn BedEddies>>,
) -> Option<Laws> {
    let section = root.table("laws")?;
    let known = section.laws();
    let drag = section.law("drag", &known.drag).map(|(law, table)| {
        let momentum = table.choice("model").unwrap_or_default();
        table.finish();
        (law, momentum)
    });
    let heat_transfer = section.plain_law("heat_transfer", &known.heat_transfer);
    let mass_transfer = section.optional_law("mass_transfer", &known.heat_transfer);
    let conduction = heat::conduction(&section);
    let radiation = heat::radiation(&section);
    section.finish();
    let (drag, momentum) = drag?;
    Some(Laws {
        drag: drag?,
        momentum,
        heat_transfer: heat_transfer?,
        conduction: conduction?,
        radiation: radiation?,
        mass_transfer: mass_transfer?,
        bed_eddies: bed_eddies?,
    })
}
