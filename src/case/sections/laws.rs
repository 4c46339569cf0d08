//! `[laws]`: each is stated, none has a default.

use crate::case::model::{DragLaw, HeatLaw, Laws};
use crate::case::table::Reader;

pub(super) fn read(root: &Reader<'_>) -> Option<Laws> {
    let section = root.required_table("laws", "[laws] with drag = { law = \"ergun-wen-yu\" }")?;
    let drag = law(
        &section,
        "drag",
        &[
            ("ergun-wen-yu", DragLaw::ErgunWenYu),
            ("none", DragLaw::None),
        ],
    );
    let heats = [
        ("gunn", HeatLaw::Gunn),
        ("ranz-marshall", HeatLaw::RanzMarshall),
        ("none", HeatLaw::None),
    ];
    let heat_transfer = law(&section, "heat_transfer", &heats);
    // Stated in every case file; only "none" is computed so far.
    let conduction = law(&section, "conduction", &[("none", ())]);
    let radiation = law(&section, "radiation", &[("none", ())]);
    section.finish();
    conduction.and(radiation)?;
    Some(Laws {
        drag: drag?,
        heat_transfer: heat_transfer?,
    })
}

fn law<T: Copy>(section: &Reader<'_>, key: &str, choices: &[(&str, T)]) -> Option<T> {
    let example = choices.first().map_or("none", |(name, _)| name);
    let table = section.required_table(key, &format!("{key} = {{ law = \"{example}\" }}"))?;
    let law = table.required_choice("law", choices);
    table.finish();
    law
}
