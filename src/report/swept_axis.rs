//! Values of a swept key as numbers along an axis, and short names of keys.

use crate::case::units;

/// Values along an axis.
#[derive(Debug, PartialEq)]
pub(super) struct SweptAxis {
    /// Of each run.
    pub values: Vec<f64>,
    /// Their unit; empty without one.
    pub unit: String,
}

/// The values as numbers, in the unit that all of them are written in, else in SI units; `None` where they are no
/// numbers.
pub(super) fn swept_axis(values: &[&str]) -> Option<SweptAxis> {
    let written: Option<Vec<(f64, &str)>> = values.iter().map(|text| written(text)).collect();
    let written = written?;
    let unit = written.first()?.1;
    if written.iter().all(|value| value.1 == unit) {
        return Some(SweptAxis {
            values: written.iter().map(|value| value.0).collect(),
            unit: unit.into(),
        });
    }
    let mut converted = Vec::new();
    let mut dimension = None;
    for text in values {
        let (numbers, own) = units::quantities(text).ok()?;
        let ([number], true) = (&numbers[..], *dimension.get_or_insert(own) == own) else {
            return None;
        };
        converted.push(*number);
    }
    Some(SweptAxis {
        values: converted,
        unit: dimension?.unit().to_owned(),
    })
}

/// One number and what stands behind it.
fn written(text: &str) -> Option<(f64, &str)> {
    let in_number = |c: char| c.is_ascii_digit() || ".+-eE".contains(c);
    let end = text.find(|c| !in_number(c)).unwrap_or(text.len());
    // "2 eV", "2e": the letter belongs to what follows.
    let number = text[..end].trim_end_matches(['e', 'E']);
    let rest = text[number.len()..].trim();
    let value = number
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())?;
    let more = rest.starts_with(|c: char| c.is_ascii_digit() || "+-.,".contains(c));
    (!more || rest.starts_with("1/")).then_some((value, rest))
}

/// The shortest ends of keys that tell them apart.
pub(super) fn labels(keys: &[&str]) -> Vec<String> {
    let label = |key: &&str| {
        let starts = key.rmatch_indices('.').map(|(dot, _)| &key[dot + 1..]);
        let same = |end: &str| {
            let alike = |other: &&&str| **other == end || other.ends_with(&format!(".{end}"));
            keys.iter().filter(alike).count() == 1
        };
        let mut ends = starts.chain([*key]);
        ends.find(|end| same(end)).unwrap_or(key).to_owned()
    };
    keys.iter().map(label).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_the_unit_that_they_are_written_in() {
        let axis = swept_axis(&["4 mm", "12.5mm"]).unwrap();
        assert_eq!((&axis.values[..], &axis.unit[..]), (&[4.0, 12.5][..], "mm"));
        let axis = swept_axis(&["4 mm", "1 cm"]).unwrap();
        assert_eq!(axis.unit, "m");
        assert!((axis.values[1] - 0.01).abs() < 1e-15);
        let axis = swept_axis(&["1", "5e1"]).unwrap();
        assert_eq!((&axis.values[..], &axis.unit[..]), (&[1.0, 50.0][..], ""));
        let axis = swept_axis(&["0.5 1/s", "2 1/s"]).unwrap();
        assert_eq!((&axis.values[..], &axis.unit[..]), (&[0.5, 2.0][..], "1/s"));
    }

    #[test]
    fn words_lists_and_mixed_dimensions_are_no_axis() {
        assert_eq!(swept_axis(&["ergun", "gidaspow"]), None);
        assert_eq!(swept_axis(&["1 1 2 mm", "1 1 3 mm"]), None);
        assert_eq!(swept_axis(&["4 mm", "4 s"]), None);
        assert_eq!(swept_axis(&["4 mm", "auto"]), None);
    }

    #[test]
    fn keys_are_named_by_their_shortest_ends_that_differ() {
        let keys = ["particles.a.diameter", "particles.b.diameter", "time.end"];
        assert_eq!(labels(&keys), ["a.diameter", "b.diameter", "end"]);
    }
}
