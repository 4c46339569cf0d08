//! `gas.species` and `[gas.species_data]`: species that are built in, and those that a file brings.

use std::path::{Path, PathBuf};

use calcine_coupler::physics::thermo::{LennardJones, Mixture, Species, fuller};

use super::common::existing;
use crate::case::table::TableReader;
use crate::mechanism::{self, MechanismError, Molecule, Thermo};

/// What the case says of the transport of a species; the rest is by its file.
struct ParsedReaction {
    name: String,
    diameter: Option<f64>,
    well_depth: Option<f64>,
    diffusion_volume: Option<f64>,
}

/// A file of thermodynamics, and what the case says beside it.
struct Data<'a> {
    table: TableReader<'a>,
    paths: Vec<PathBuf>,
    thermo: Vec<Thermo>,
    molecules: Vec<Molecule>,
    stated: Vec<ParsedReaction>,
}

/// The mixture of `gas.species`, and the files that it is from.
pub(super) fn mixture(
    section: &TableReader<'_>,
    names: &[String],
    folder: &Path,
) -> Option<(Mixture, Vec<PathBuf>)> {
    let data = match section.table("species_data") {
        Some(table) => Some(data(table, names, folder)?),
        None => None,
    };
    let refuse = |error: &dyn std::fmt::Display, help: &str| {
        section.fail("species", format!("makes no mixture: {error}"), help);
    };
    let mut species = Vec::new();
    for name in names {
        match (Species::built_in(name), &data) {
            (Ok(own), _) => species.push(own),
            (Err(_), Some(data)) => species.push(of_file(section, data, name)?),
            (Err(error), None) => {
                let help =
                    "name built-in species, or state `gas.species_data` with a file of the others";
                refuse(&error, help);
                return None;
            }
        }
    }
    match Mixture::of(species) {
        Ok(mixture) => Some((mixture, data.map(|data| data.paths).unwrap_or_default())),
        Err(error) => {
            refuse(&error, "write at least one species, each once");
            None
        }
    }
}

fn data<'a>(table: TableReader<'a>, names: &[String], folder: &Path) -> Option<Data<'a>> {
    let path = existing(&table, "thermo", folder);
    let mut stated = Vec::new();
    if let Some(transport) = table.table("transport") {
        for (name, own) in transport.named() {
            if !names.contains(&name) {
                let help = "remove it, or add the species to `gas.species`";
                transport.fail(&name, "is no species of the gas", help);
            }
            stated.push(ParsedReaction {
                name,
                diameter: own.number("diameter"),
                well_depth: own.number("well_depth"),
                diffusion_volume: own.number("diffusion_volume"),
            });
            own.finish();
        }
    }
    let transport = match table.has("transport_file") {
        true => Some(existing(&table, "transport_file", folder)?),
        false => None,
    };
    table.finish();
    let path = path?;
    let help = "a file of Cantera (.yaml) or of CHEMKIN's thermodynamics is read";
    let thermo = mechanism::read_thermo(&path);
    let thermo = thermo.map_err(|error| unread(&table, "thermo", &error, help));
    let help = "CHEMKIN's transport data has a line of a name and six numbers for each species";
    let molecules = match &transport {
        Some(path) => mechanism::read_transport(path)
            .map_err(|error| unread(&table, "transport_file", &error, help)),
        None => Ok(Vec::new()),
    };
    Some(Data {
        thermo: thermo.ok()?,
        molecules: molecules.ok()?,
        table,
        paths: [path].into_iter().chain(transport).collect(),
        stated,
    })
}

/// Refuses a file.
fn unread(table: &TableReader<'_>, key: &str, error: &MechanismError, help: &str) {
    let line = error
        .line
        .map_or(String::new(), |line| format!(" in line {line}"));
    table.fail(key, format!("cannot be read{line}: {}", error.what), help);
}

/// A species that is not built in.
fn of_file(section: &TableReader<'_>, data: &Data<'_>, name: &str) -> Option<Species> {
    let Some(thermo) = data.thermo.iter().find(|one| one.name == name) else {
        let known: Vec<&str> = Species::built_in_names().collect();
        let rule = format!(
            "names {name}, which is not built in and not in the file of `gas.species_data` (or has elements that Calcine \
             does not have)"
        );
        let help = format!("built in are {}", known.join(", "));
        section.fail("species", rule, help);
        return None;
    };
    let simple = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
    if !(name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(simple)) {
        let rule = format!("names {name}, which is no name of letters, digits, _ and -");
        let help = "rename it in a copy of the file: names stand in columns of results and in OpenFOAM's files";
        section.fail("species", rule, help);
        return None;
    }
    let stated = data.stated.iter().find(|one| one.name == name);
    let molecule = data.molecules.iter().find(|one| one.name == name);
    let file = molecule.map(|one| one.potential).or(thermo.potential);
    let diameter = stated.and_then(|one| one.diameter);
    let well_depth = stated.and_then(|one| one.well_depth);
    let potential = (
        diameter.or(file.map(|one| one.diameter)),
        well_depth.or(file.map(|one| one.well_depth)),
    );
    let (Some(diameter), Some(well_depth)) = potential else {
        let state = format!(
            "state them, for example transport = {{ {name} = {{ diameter = \"4.3e-10 m\", well_depth = \"250 K\" }} }}"
        );
        let mut others = data.molecules.iter().map(|one| one.name.as_str());
        let alike = others.find(|other| other.eq_ignore_ascii_case(name));
        match data.molecules.is_empty() {
            true => {
                let rule = format!(
                    "brings {name} without the diameter and the well depth of its molecules"
                );
                data.table.fail("thermo", rule, state);
            }
            false => {
                let rule =
                    format!("has no line of {name}, nor has the file of `thermo` its molecules");
                let help = match alike {
                    Some(other) => format!(
                        "it has {other}: names agree in upper and lower case too; rename it in a copy of the file"
                    ),
                    None => state,
                };
                data.table.fail("transport_file", rule, help);
            }
        }
        return None;
    };
    let volume = stated.and_then(|one| one.diffusion_volume);
    let Some(volume) = volume.or_else(|| fuller::volume_of(&thermo.atoms)) else {
        let rule = format!("brings {name}, for whose atoms no diffusion volume is tabulated");
        let help =
            format!("state transport = {{ {name} = {{ diffusion_volume = 30 }} }}, or as it is");
        data.table.fail("thermo", rule, help);
        return None;
    };
    let potential = LennardJones {
        diameter,
        well_depth,
    };
    match Species::of_molecules(name, thermo.atoms, thermo.polynomial, potential, volume) {
        Ok(species) => Some(species),
        Err(error) => {
            let help = "correct the file";
            data.table
                .fail("thermo", format!("is refused: {error}"), help);
            None
        }
    }
}
