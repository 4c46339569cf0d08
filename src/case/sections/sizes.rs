//! `particles.diameter`: one diameter, or a distribution.

use calcine_coupler::packing::{Shape, Share, Sizes};
use toml_edit::Value;

use crate::case::table::TableReader;
use crate::case::units::{Dimension, shown};

const EXAMPLE: &str = "for example { normal = { mean = \"4 mm\", deviation = \"0.4 mm\", \
                       min = \"3 mm\", max = \"5 mm\" }, share = \"number\", seed = 1 }";

/// Diameters, and the seed by which they are drawn.
pub(super) fn sizes(population: &TableReader<'_>) -> Option<(Sizes, u64)> {
    if !population.is_table("diameter") {
        let one = population.number("diameter")?;
        return Some((Sizes::Equal(one), 0));
    }
    let table = population.table("diameter")?;
    let share = table.choice("share");
    let seed = table.whole("seed");
    let made = match table.exactly_one() {
        Some("table") => parts(&table)
            .map(|parts| (parts, share))
            .and_then(|(parts, share)| {
                Some(Sizes::Mixture {
                    parts,
                    share: share?,
                })
            }),
        Some(kind) => range(&table, kind, share),
        None => None,
    };
    table.finish();
    let sizes = made?;
    if let Err(error) = sizes.mean() {
        table.fail_whole(&format!("is no distribution: {error}"), EXAMPLE);
        return None;
    }
    Some((sizes, seed?))
}

fn range(table: &TableReader<'_>, kind: &str, share: Option<Share>) -> Option<Sizes> {
    let range = table.table(kind)?;
    let shape = match kind {
        "normal" => {
            let mean = range.number("mean");
            let deviation = range.number("deviation");
            mean.zip(deviation)
                .map(|(mean, deviation)| Shape::Normal { mean, deviation })
        }
        "log_normal" => {
            let median = range.number("median");
            let deviation = range.number("deviation");
            median
                .zip(deviation)
                .map(|(median, deviation)| Shape::LogNormal { median, deviation })
        }
        _ => Some(Shape::Uniform),
    };
    let min = range.number("min");
    let max = range.number("max");
    range.finish();
    if let (Some(least), Some(most)) = (min, max)
        && least >= most
    {
        let rule = format!(
            "is {} m, not below `max` of {} m",
            shown(least),
            shown(most)
        );
        range.fail(
            "min",
            rule,
            "write the smaller diameter as min, the larger one as max",
        );
        return None;
    }
    Some(Sizes::Range {
        shape: shape?,
        min: min?,
        max: max?,
        share: share?,
    })
}

/// Pairs of a diameter and its share.
fn parts(table: &TableReader<'_>) -> Option<Vec<(f64, f64)>> {
    let pairs = table.raw("table")?.as_array();
    let Some(pairs) = pairs.filter(|pairs| !pairs.is_empty()) else {
        let help = "for example [[\"4 mm\", 0.3], [\"6 mm\", 0.7]]";
        table.fail("table", "needs pairs of diameter and share", help);
        return None;
    };
    let pair = |pair: &Value| {
        let pair = pair.as_array().filter(|pair| pair.len() == 2);
        let Some((diameter, share)) = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?)))
        else {
            let help = "for example [[\"4 mm\", 0.3], [\"6 mm\", 0.7]]";
            table.fail("table", "needs pairs of diameter and share", help);
            return None;
        };
        let diameter = table.value("table", diameter, Dimension::LENGTH);
        let share = table.value("table", share, Dimension::NONE);
        Some((diameter?, share?))
    };
    pairs.iter().map(pair).collect()
}
