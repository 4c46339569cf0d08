//! `[output]`.

use super::time::ticks;
use crate::case::model::Output;
use crate::case::table::TableReader;

/// Gas fields of the snapshots.
const GAS: [&str; 7] = [
    "temperature",
    "velocity",
    "pressure",
    "density",
    "void_fraction",
    "mass_fractions",
    "turbulence",
];
/// Particle fields of the snapshots.
const PARTICLES: [&str; 9] = [
    "temperature",
    "velocity",
    "heat",
    "force",
    "void_fraction",
    "slip",
    "mass",
    "solids",
    "inside",
];

pub(super) fn output(root: &TableReader<'_>) -> Option<Output> {
    let section = root.required_table("output", "[output] with every = \"30 s\"")?;
    let every = ticks(&section, "every", true);
    let series_every = ticks(&section, "series_every", false);
    let fields = |key: &str, known: &[&str]| {
        let names = section
            .texts(key)
            .unwrap_or_else(|| vec!["temperature".into()]);
        for name in &names {
            if !known.contains(&name.as_str()) {
                section.fail(
                    key,
                    format!("names \"{name}\""),
                    format!("known are {}", known.join(", ")),
                );
            }
        }
        names
    };
    let (gas, particles) = (fields("gas", &GAS), fields("particles", &PARTICLES));
    section.finish();
    Some(Output {
        every: every?,
        series_every,
        gas,
        particles,
    })
}
