//! Particles that all runs have.

use std::collections::BTreeSet;

use crate::results::lengths_of;
use crate::results::read::{Array, Arrays};

/// Snapshots of particles reduced to those that all runs have, by their ids: the outlets of two runs need not have
/// taken the same ones by the same time.
pub(super) fn particles(all: Vec<Arrays>) -> Vec<Arrays> {
    let Some(first) = all.first().map(ids) else {
        return all;
    };
    if all.iter().all(|arrays| ids(arrays) == first) {
        return all;
    }
    let mut shared = first;
    for arrays in &all[1..] {
        let own = ids(arrays);
        shared.retain(|id| own.contains(id));
    }
    all.iter().map(|arrays| reduced(arrays, &shared)).collect()
}

/// Snapshots whose columns of rows of any length, such as those of shells, are as wide in all runs, filled up with what is no number.
/// A row that is not as long in all runs is nothing but that: its values have no counterparts.
pub(super) fn rows_alike(mut all: Vec<Arrays>) -> Vec<Arrays> {
    let names: Vec<String> = all.first().map_or(Vec::new(), |first| {
        let ragged = |name: &&String| first.contains_key(&lengths_of(name));
        first.keys().filter(ragged).cloned().collect()
    });
    for name in &names {
        let lengths = all
            .iter()
            .map(|one| Some(&one.get(&lengths_of(name))?.values));
        let Some(lengths) = lengths.collect::<Option<Vec<_>>>() else {
            continue;
        };
        let alike: Vec<bool> = (0..lengths[0].len())
            .map(|row| {
                lengths
                    .iter()
                    .all(|own| own.get(row) == Some(&lengths[0][row]))
            })
            .collect();
        let widths = all.iter().filter_map(|one| Some(one.get(name)?.components));
        let width = widths.max().unwrap_or(1);
        for array in all.iter_mut().filter_map(|one| one.get_mut(name)) {
            let mut wide = vec![f64::NAN; alike.len() * width];
            let rows = array.values.chunks(array.components.max(1));
            for ((to, own), alike) in wide.chunks_exact_mut(width).zip(rows).zip(&alike) {
                if *alike {
                    to[..own.len()].copy_from_slice(own);
                }
            }
            *array = Array {
                components: width,
                values: wide,
            };
        }
    }
    all
}

fn ids(arrays: &Arrays) -> BTreeSet<u64> {
    let values = arrays.get("id").map_or(&[][..], |array| &array.values);
    values.iter().map(|&id| id as u64).collect()
}

/// The rows of these particles of every array that has a row for each.
fn reduced(arrays: &Arrays, shared: &BTreeSet<u64>) -> Arrays {
    let values = arrays.get("id").map_or(&[][..], |array| &array.values);
    let keep: Vec<bool> = values
        .iter()
        .map(|&id| shared.contains(&(id as u64)))
        .collect();
    let rows = |array: &Array| {
        let width = array.components.max(1);
        if array.values.len() != keep.len() * width {
            return array.clone();
        }
        let kept = array.values.chunks(width).zip(&keep);
        Array {
            components: array.components,
            values: kept
                .filter(|(_, keep)| **keep)
                .flat_map(|(row, _)| row.iter().copied())
                .collect(),
        }
    };
    let all = arrays.iter();
    all.map(|(name, array)| (name.clone(), rows(array)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(ids: &[f64]) -> Arrays {
        let array = |components, values: Vec<f64>| Array { components, values };
        let velocity = ids.iter().flat_map(|id| [*id, 0.0, 10.0 * id]).collect();
        Arrays::from([
            ("id".to_owned(), array(1, ids.to_vec())),
            ("velocity".to_owned(), array(3, velocity)),
            ("offsets".to_owned(), array(1, vec![7.0])),
        ])
    }

    #[test]
    fn rows_of_another_length_have_no_counterparts() {
        let run = |width: usize, lengths: &[f64], values: &[f64]| {
            let array = |components, values: &[f64]| Array {
                components,
                values: values.to_vec(),
            };
            Arrays::from([
                ("shells.lengths".to_owned(), array(1, lengths)),
                ("shells".to_owned(), array(width, values)),
            ])
        };
        let none = f64::NAN;
        let found = rows_alike(vec![
            run(1, &[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]),
            run(2, &[1.0, 2.0, 1.0], &[4.0, none, 5.0, 6.0, 7.0, none]),
        ]);
        let held = |run: usize| -> Vec<Option<f64>> {
            let values = found[run]["shells"].values.iter();
            values.map(|x| (!x.is_nan()).then_some(*x)).collect()
        };
        assert!(found.iter().all(|one| one["shells"].components == 2));
        assert_eq!(held(0), [Some(1.0), None, None, None, Some(3.0), None]);
        assert_eq!(held(1), [Some(4.0), None, None, None, Some(7.0), None]);
        // What one run does not have at all is left as it is.
        let lacks = rows_alike(vec![run(1, &[1.0], &[1.0]), Arrays::new()]);
        assert_eq!(lacks[0]["shells"].values, [1.0]);
    }

    #[test]
    fn what_one_run_has_lost_is_not_compared_and_the_rest_by_id() {
        let found = particles(vec![run(&[1.0, 2.0, 4.0, 5.0]), run(&[2.0, 3.0, 5.0])]);
        for arrays in &found {
            assert_eq!(arrays["id"].values, [2.0, 5.0]);
            assert_eq!(arrays["velocity"].values, [2.0, 0.0, 20.0, 5.0, 0.0, 50.0]);
            assert_eq!(arrays["offsets"].values, [7.0]);
        }
        let same = vec![run(&[1.0, 2.0]), run(&[1.0, 2.0])];
        assert_eq!(particles(same.clone()), same);
        assert!(particles(Vec::new()).is_empty());
    }
}
