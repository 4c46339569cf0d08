//! `[laws]`: each is stated, none has a default.

use calcine_coupler::momentum_model::MomentumModel;

use super::heat;
use crate::case::model::{DragLaw, HeatLaw, Laws};
use crate::case::table::TableReader;

pub(super) fn read(root: &TableReader<'_>) -> Option<Laws> {
    let section = root.required_table("laws", "[laws] with drag = { law = \"ergun-wen-yu\" }")?;
    let drag = drag(&section);
    let heats = [
        ("gunn", HeatLaw::Gunn),
        ("ranz-marshall", HeatLaw::RanzMarshall),
        ("wakao", HeatLaw::Wakao),
        ("gnielinski", HeatLaw::Gnielinski),
        ("none", HeatLaw::None),
    ];
    let heat_transfer = law(&section, "heat_transfer", &heats);
    let mass_transfer = match section.has("mass_transfer") {
        true => law(&section, "mass_transfer", &heats),
        false => Some(HeatLaw::None),
    };
    let conduction = heat::conduction(&section);
    let radiation = heat::radiation(&section);
    section.finish();
    let (drag, momentum) = drag?;
    Some(Laws {
        drag,
        momentum,
        heat_transfer: heat_transfer?,
        conduction: conduction?,
        radiation: radiation?,
        mass_transfer: mass_transfer?,
    })
}

/// The drag law, and the model by which it is exchanged.
fn drag(section: &TableReader<'_>) -> Option<(DragLaw, MomentumModel)> {
    let laws = [
        ("ergun-wen-yu", DragLaw::ErgunWenYu),
        ("ergun", DragLaw::Ergun),
        ("wen-yu", DragLaw::WenYu),
        ("gidaspow", DragLaw::Gidaspow),
        ("di-felice", DragLaw::DiFelice),
        ("koch-hill", DragLaw::KochHill),
        ("beetstra", DragLaw::Beetstra),
        ("none", DragLaw::None),
    ];
    let table = section.required_table("drag", "drag = { law = \"ergun-wen-yu\" }")?;
    let law = table.required_choice("law", &laws);
    let models = [MomentumModel::A, MomentumModel::B].map(|model| (model.name(), model));
    let model = table.choice("model", &models).unwrap_or_default();
    table.finish();
    Some((law?, model))
}

fn law<T: Copy>(section: &TableReader<'_>, key: &str, choices: &[(&str, T)]) -> Option<T> {
    let example = choices.first().map_or("none", |(name, _)| name);
    let table = section.required_table(key, &format!("{key} = {{ law = \"{example}\" }}"))?;
    let law = table.required_choice("law", choices);
    table.finish();
    law
}
