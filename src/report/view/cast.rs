//! The particles of a run at the times that a view may show.

use std::collections::BTreeMap;
use std::path::Path;

use crate::report::bed_columns::columns;
use crate::report::cells::{Point, all_points};
use crate::report::colour::Range;
use crate::report::number::span;
use crate::report::section::radii;
use crate::report::spread::spread;
use crate::results::ResultsError;
use crate::results::read::{self, Arrays};

/// Snapshots at most.
const SNAPSHOTS: usize = 60;
/// Particles of all of them together at most; a page holds fewer.
const PARTICLES: usize = 400_000;
/// Columns at most, the first of these and then by their names.
const COLUMNS: usize = 16;
const FIRST: [&str; 5] = ["temperature", "conversion", "speed", "diameter", "mass"];

/// The particles at one time.
pub(super) struct Moment {
    /// Process time in words.
    pub time: String,
    /// Centres in m.
    pub centres: Vec<Point>,
    /// Radii in m; of parcels those of spheres of all their volume.
    pub radii: Vec<f64>,
    /// Values of the columns, in their order; NaN where a particle has none.
    pub values: Vec<Vec<f64>>,
}

/// What colours the particles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ViewColumn {
    /// Name of the column.
    pub name: String,
    /// Label of its scale.
    pub label: String,
    /// Ends of its scale.
    pub range: Range,
}

/// The particles over time.
pub(super) struct Cast {
    /// At each time.
    pub moments: Vec<Moment>,
    /// What colours them, in the order in which columns are left out last.
    pub columns: Vec<ViewColumn>,
}

impl Cast {
    /// Reads evenly spaced snapshots, the first and the last among them; `None` where there are no particles.
    pub fn read(directory: &Path) -> Result<Option<Self>, ResultsError> {
        let all = read::collection(directory, "particles.pvd")?;
        let Some((_, last)) = all.last() else {
            return Ok(None);
        };
        let most = count(&read::arrays(last)?).max(count(&read::arrays(&all[0].1)?));
        let room = (PARTICLES / most.max(1)).clamp(2, SNAPSHOTS);
        let [_, units] = read::units(directory);
        let mut found = Vec::new();
        for number in spread(all.len(), room) {
            let (time, file) = &all[number];
            found.push((*time, read::arrays(file)?));
        }
        let cast = Self::of(&found, &units);
        Ok((cast.moments.iter().any(|moment| !moment.centres.is_empty())).then_some(cast))
    }

    /// That of snapshots with their process times in s.
    pub fn of(snapshots: &[(f64, Arrays)], units: &BTreeMap<String, String>) -> Self {
        let mut columns_of = Vec::new();
        let mut named: BTreeMap<String, ViewColumn> = BTreeMap::new();
        for (_, bed) in snapshots {
            let own = columns(bed, count(bed), units);
            for column in &own {
                let Some(range) = Range::of(column.values.iter().copied()) else {
                    continue;
                };
                let entry = named.entry(column.name.clone());
                let entry = entry.or_insert_with(|| ViewColumn {
                    name: column.name.clone(),
                    label: column.label.clone(),
                    range,
                });
                entry.range = entry.range.with(range);
            }
            columns_of.push(own);
        }
        let place = |column: &ViewColumn| {
            let first = FIRST.iter().position(|name| *name == column.name);
            (first.unwrap_or(FIRST.len()), column.name.clone())
        };
        let mut kept: Vec<ViewColumn> = named.into_values().collect();
        kept.sort_by_key(place);
        // What is the same everywhere shows nothing; where all is, one of them fills the scale.
        let varies = |column: &ViewColumn| column.range.high > column.range.low;
        if kept.iter().any(varies) {
            kept.retain(varies);
        } else {
            kept.truncate(1);
        }
        kept.truncate(COLUMNS);
        let moments = snapshots.iter().zip(columns_of).map(|((time, bed), own)| {
            let values = kept.iter().map(|column| {
                let found = own.iter().find(|other| other.name == column.name);
                found.map_or(vec![f64::NAN; count(bed)], |found| found.values.clone())
            });
            Moment {
                time: span(*time),
                centres: all_points(bed),
                radii: radii(bed),
                values: values.collect(),
            }
        });
        Self {
            moments: moments.collect(),
            columns: kept,
        }
    }

    /// The range of a column by its name.
    pub fn range(&self, name: &str) -> Option<Range> {
        let column = self.columns.iter().find(|column| column.name == name);
        column.map(|column| column.range)
    }
}

fn count(bed: &Arrays) -> usize {
    bed.get("points").map_or(0, |array| array.values.len() / 3)
}
