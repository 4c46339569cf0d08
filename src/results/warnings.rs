//! What a run leaves outside the ranges of its laws, or unconverged, summed over its windows.

use std::collections::BTreeMap;
use std::fmt;

use calcine_coupler::findings::{Finding, FindingPlace};
use serde::{Deserialize, Serialize};

use super::files::number;

/// Warnings of a run by the names of their kinds.
pub type Warnings = BTreeMap<String, WarningSummary>;

/// All windows with one kind of finding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarningSummary {
    /// What it is, in words.
    pub message: String,
    /// Committed windows with it.
    pub windows: u64,
    /// Cells, particles or iterations with it, summed over these windows.
    pub count: u64,
    /// The worst value.
    #[serde(deserialize_with = "number")]
    pub worst: f64,
    /// The end of the range, or the tolerance, that it is beyond; `null` where only the solver knows it.
    pub limit: Option<f64>,
    /// Unit of both.
    pub unit: String,
    /// Where the worst value is.
    pub place: WarningPlace,
    /// Process time of the worst value in s.
    pub at_s: f64,
    /// Process time of the first window with it in s.
    pub first_s: f64,
}

/// Where a value is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WarningPlace {
    /// In the whole run.
    Run,
    /// In the cell with its centre here, in m.
    Cell([f64; 3]),
    /// At the particle of this id.
    Particle(u64),
    /// At the particle of this id, which left the gas mesh with its centre here, in m.
    Left {
        /// Its id.
        id: u64,
        /// Its centre.
        at: [f64; 3],
    },
}

impl From<FindingPlace> for WarningPlace {
    fn from(place: FindingPlace) -> Self {
        match place {
            FindingPlace::Run => Self::Run,
            FindingPlace::Cell(centre) => Self::Cell(centre.into()),
            FindingPlace::Particle(id) => Self::Particle(id),
            FindingPlace::Left { id, at } => Self::Left { id, at: at.into() },
        }
    }
}

impl fmt::Display for WarningPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Run => Ok(()),
            Self::Cell([x, y, z]) => {
                let [x, y, z] = [x, y, z].map(|one| short(*one));
                write!(f, " in the cell at ({x}, {y}, {z}) m")
            }
            Self::Particle(id) => write!(f, " at particle {id}"),
            Self::Left { id, at } => {
                let [x, y, z] = at.map(short);
                write!(f, " of particle {id} at ({x}, {y}, {z}) m")
            }
        }
    }
}

impl WarningSummary {
    fn new(finding: &Finding, time: f64) -> Self {
        Self {
            message: finding.kind.words().to_owned(),
            windows: 0,
            count: 0,
            worst: finding.value,
            limit: finding.limit,
            unit: finding.kind.unit().to_owned(),
            place: finding.place.into(),
            at_s: time,
            first_s: time,
        }
    }

    fn distance(&self) -> f64 {
        (self.worst - self.limit.unwrap_or_default()).abs()
    }

    /// What it is, the worst value and where that is.
    pub fn sentence(&self) -> String {
        let unit = match self.unit.as_str() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let limit = self.limit.map(|limit| {
            let told = short(limit);
            match told == short(self.worst) {
                true => format!(" ({} beyond it)", short(self.worst - limit)),
                false => format!(" (limit {told}{unit})"),
            }
        });
        format!(
            "{}: {}{unit}{}{} at {} s",
            self.message,
            short(self.worst),
            limit.unwrap_or_default(),
            self.place,
            short(self.at_s),
        )
    }
}

/// Adds what a window that ends at a process time in s leaves. The result is the sentences of what is there for the first
/// time.
pub(super) fn add(warnings: &mut Warnings, findings: &[Finding], time: f64) -> Vec<String> {
    let mut first = Vec::new();
    for finding in findings {
        let found = WarningSummary::new(finding, time);
        let name = finding.kind.name();
        if !warnings.contains_key(name) {
            first.push(found.sentence());
        }
        let sum = warnings
            .entry(name.to_owned())
            .or_insert_with(|| found.clone());
        if found.distance() > sum.distance() {
            *sum = WarningSummary {
                windows: sum.windows,
                count: sum.count,
                first_s: sum.first_s,
                ..found
            };
        }
        sum.windows += 1;
        sum.count += finding.count;
    }
    first
}

/// A number of four figures.
fn short(value: f64) -> String {
    let size = value.abs();
    if value != 0.0 && !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - size.max(1e-3).log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::findings::FindingKind;

    fn hot(value: f64, count: u64, id: u64) -> Finding {
        Finding {
            kind: FindingKind::ParticleTemperature,
            count,
            value,
            limit: Some(1600.0),
            place: FindingPlace::Particle(id),
        }
    }

    #[test]
    fn windows_and_values_add_up_and_the_worst_one_keeps_its_place_and_time() {
        let mut warnings = Warnings::new();
        let first = add(&mut warnings, &[hot(1700.0, 3, 4)], 0.5);
        assert_eq!(first.len(), 1);
        assert!(first[0].ends_with(": 1700 K (limit 1600 K) at particle 4 at 0.5 s"));
        assert!(add(&mut warnings, &[hot(1900.0, 2, 8)], 1.0).is_empty());
        assert!(add(&mut warnings, &[hot(1650.0, 1, 9)], 1.5).is_empty());
        let sum = &warnings["particle_temperature"];
        assert_eq!((sum.windows, sum.count), (3, 6));
        assert_eq!((sum.worst, sum.at_s, sum.first_s), (1900.0, 1.0, 0.5));
        assert_eq!(sum.place, WarningPlace::Particle(8));
    }

    #[test]
    fn they_read_back_as_written_and_nan_as_null() {
        let mut warnings = Warnings::new();
        let unsolved = Finding::unconverged(FindingKind::NetworkSolver, f64::NAN, None);
        add(&mut warnings, &[hot(1700.0, 3, 4), unsolved], 0.5);
        let text = serde_json::to_string(&warnings).unwrap();
        let back: Warnings = serde_json::from_str(&text).unwrap();
        assert!(back["network_solver"].worst.is_nan());
        assert_eq!(
            back["particle_temperature"],
            warnings["particle_temperature"]
        );
    }

    #[test]
    fn numbers_have_four_figures() {
        let texts = [7000.0, 0.012345, 1e-12, 0.0, -0.25, 123456.0].map(short);
        assert_eq!(
            texts,
            ["7000", "0.01235", "1.000e-12", "0", "-0.25", "123456"]
        );
    }
}
