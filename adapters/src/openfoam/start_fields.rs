//! Cell values that the gas of a generated OpenFOAM case starts from, where they are not uniform: those of a
//! time directory that OpenFOAM wrote on the same mesh.

use std::fmt::Write;
use std::path::Path;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::polymesh;
use calcine_coupler::setup::GasStart;

use super::names::NAME;

/// The fields that a time directory holds; the others start as the case says.
#[derive(Clone, Debug, Default)]
pub struct StartFields {
    fields: Vec<(String, usize, Vec<f64>)>,
}

impl StartFields {
    /// Reads temperature `T`, absolute pressure `p`, superficial velocity `U` and mass fractions, as far as
    /// they are there. A directory without any of them is refused.
    pub fn read(directory: &Path, species: &[String], cells: usize) -> Result<Self, PartError> {
        let mut fields = Vec::new();
        let known = [("T", 1), ("p", 1), ("U", 3)];
        let species = species.iter().map(|name| (name.as_str(), 1));
        for (name, components) in known.into_iter().chain(species) {
            let file = directory.join(name);
            if !file.is_file() {
                continue;
            }
            let values = polymesh::internal_field(&file, components, cells);
            let values = values.map_err(|error| {
                let message = format!("the field {name} to start from cannot be read");
                PartError::new(NAME, FailureKind::NotStarted, message).caused_by(error)
            })?;
            fields.push((name.to_owned(), components, values));
        }
        if fields.is_empty() {
            let message = format!(
                "{} holds none of the fields T, p, U to start from: name a time directory that \
                 OpenFOAM wrote (uncompressed)",
                directory.display()
            );
            return Err(PartError::new(NAME, FailureKind::NotStarted, message));
        }
        Ok(Self { fields })
    }

    /// The fields of a gas of another solver on the same mesh.
    pub fn of(gas: &GasStart, species: &[String]) -> Self {
        let flat = gas.velocity.iter().flatten().copied().collect();
        let mut fields = vec![
            ("T".to_owned(), 1, gas.temperature.clone()),
            ("p".to_owned(), 1, gas.pressure.clone()),
            ("U".to_owned(), 3, flat),
        ];
        for (k, name) in species.iter().enumerate() {
            let own = gas.composition.iter().skip(k).step_by(species.len());
            fields.push((name.clone(), 1, own.copied().collect()));
        }
        Self { fields }
    }

    /// The text of a field with these values, if there are any, in place of its uniform start.
    pub fn applied(&self, name: &str, text: String) -> String {
        let Some((_, components, values)) = self.fields.iter().find(|field| field.0 == name) else {
            return text;
        };
        let key = "internalField";
        let Some((before, rest)) = text.split_once(key) else {
            return text;
        };
        let Some((_, after)) = rest.split_once(';') else {
            return text;
        };
        let kind = if *components == 1 { "scalar" } else { "vector" };
        let count = values.len() / components;
        let mut result = format!("{before}{key}   nonuniform List<{kind}>\n{count}\n(\n");
        for item in values.chunks(*components) {
            // Writing into a String cannot fail.
            let _ = match item {
                [value] => writeln!(result, "{value:e}"),
                item => {
                    let words: Vec<_> = item.iter().map(|x| format!("{x:e}")).collect();
                    writeln!(result, "({})", words.join(" "))
                }
            };
        }
        result + ");" + after
    }
}
