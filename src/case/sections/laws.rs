//! `[laws]`: each is stated, none has a default.

use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::physics::film::{FilmDiffusivity, FilmTemperature, FilmTheory, StefanFlow};
use calcine_coupler::physics::heat_transfer::HeatTransfer;
use calcine_coupler::physics::law::{LawChoice, NONE};
use calcine_coupler::physics::turbulence::BedEddies;

use super::common::gas_alone;
use super::film_diffusivity::{self, FilmGas};
use super::heat;
use crate::case::model::{ConductionArea, ConductionSpec, Laws};
use crate::case::table::TableReader;

/// `bed_eddies` is what `[gas.turbulence]` chose.
pub(super) fn read(
    root: &TableReader<'_>,
    bed_eddies: Option<LawChoice<dyn BedEddies>>,
    gas: Option<FilmGas<'_>>,
) -> Option<Laws> {
    if !root.has("laws") && gas_alone(root) {
        return none(root, bed_eddies?);
    }
    let section = root.table("laws")?;
    let known = section.laws();
    let drag = section.law("drag", &known.drag).map(|(law, table)| {
        let momentum = table.choice("model").unwrap_or_default();
        table.finish();
        (law, momentum)
    });
    let heat_transfer = section.law("heat_transfer", &known.heat_transfer);
    let heat_transfer = heat_transfer.map(|(law, table)| {
        let film = table.choice("film");
        table.finish();
        (law, film)
    });
    let mass_transfer = mass_transfer(&section, gas);
    let conduction = heat::conduction(&section);
    let radiation = heat::radiation(&section);
    section.finish();
    let (drag, momentum) = drag?;
    let (heat_transfer, heat_film) = heat_transfer?;
    let MassTransfer {
        law: mass_transfer,
        film,
        diffusivity: film_diffusivity,
    } = mass_transfer?;
    Some(Laws {
        drag: drag?,
        momentum,
        heat_transfer: heat_transfer?,
        // Heat and gas pass one film where particles react.
        heat_film: heat_film.unwrap_or(match mass_transfer.is_none() {
            true => FilmTemperature::Gas,
            false => film.temperature,
        }),
        conduction: conduction?,
        radiation: radiation?,
        bed_eddies: bed_eddies?,
        mass_transfer,
        film,
        film_diffusivity,
    })
}

/// Laws of a gas without particles: none of all.
fn none(root: &TableReader<'_>, bed_eddies: LawChoice<dyn BedEddies>) -> Option<Laws> {
    let known = root.laws();
    Some(Laws {
        drag: LawChoice::named(&known.drag, NONE, Vec::new())?,
        momentum: MomentumModel::default(),
        heat_transfer: LawChoice::named(&known.heat_transfer, NONE, Vec::new())?,
        heat_film: FilmTemperature::Gas,
        conduction: ConductionSpec {
            law: LawChoice::named(&known.conduction, NONE, Vec::new())?,
            area: ConductionArea::Overlap,
            gap: LawChoice::named(&known.gap, NONE, Vec::new())?,
        },
        radiation: None,
        bed_eddies,
        mass_transfer: LawChoice::named(&known.heat_transfer, NONE, Vec::new())?,
        film: FilmTheory {
            temperature: FilmTemperature::TwoThirds,
            stefan_flow: StefanFlow::Mass,
        },
        film_diffusivity: FilmDiffusivity::default(),
    })
}

/// `laws.mass_transfer`.
struct MassTransfer {
    law: LawChoice<dyn HeatTransfer>,
    film: FilmTheory,
    diffusivity: FilmDiffusivity,
}

/// `laws.mass_transfer`; without it none, and its film as by default.
fn mass_transfer(section: &TableReader<'_>, gas: Option<FilmGas<'_>>) -> Option<MassTransfer> {
    let known = &section.laws().heat_transfer;
    if !section.has("mass_transfer") {
        let film = FilmTheory {
            temperature: FilmTemperature::TwoThirds,
            stefan_flow: StefanFlow::Mass,
        };
        return Some(MassTransfer {
            law: section.optional_law("mass_transfer", known)?,
            film,
            diffusivity: FilmDiffusivity::default(),
        });
    }
    let (law, table) = section.law("mass_transfer", known)?;
    let (temperature, stefan_flow) = (table.choice("film"), table.choice("stefan_flow"));
    let diffusivity = film_diffusivity::read(&table, gas);
    table.finish();
    let film = FilmTheory {
        temperature: temperature?,
        stefan_flow: stefan_flow?,
    };
    Some(MassTransfer {
        law: law?,
        film,
        diffusivity: diffusivity?,
    })
}
