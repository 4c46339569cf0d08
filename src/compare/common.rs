//! Particles that all runs have.

use std::collections::BTreeSet;

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
