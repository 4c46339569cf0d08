//! All cases.

use super::case::ErrorCase;
use super::{cavity, five_species, heated_cavity, hot_duct, taylor_green};

pub const ALL: [&ErrorCase; 5] = [
    &cavity::CASE,
    &taylor_green::CASE,
    &heated_cavity::CASE,
    &hot_duct::CASE,
    &five_species::CASE,
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::LONGER;
    use super::super::case::{Reference, Resolution};
    use super::*;

    #[test]
    fn every_case_has_its_files_and_steps_that_end_at_its_end() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../of-cases/gas-error");
        for case in ALL {
            let folder = root.join(case.name);
            assert!(folder.join("case.toml").is_file(), "{}", case.name);
            let control = std::fs::read_to_string(folder.join("stock/system/controlDict")).unwrap();
            assert!(
                control.contains(&format!("application     {};", case.stock)),
                "{control}"
            );
            for run in case.runs.iter().chain(case.large) {
                for longer in [1.0, f64::from(LONGER)] {
                    let steps = case.end / (longer * run.step);
                    assert!(
                        (steps - steps.round()).abs() < 1e-9,
                        "{} {run:?} {longer}",
                        case.name
                    );
                }
            }
            if let Reference::Extrapolated(finest) = case.reference {
                assert_eq!(finest.factor % 2, 0);
                let finer = |run: &&Resolution| run.factor < finest.factor;
                assert_eq!(
                    case.runs.iter().filter(finer).count(),
                    case.runs.len(),
                    "{}",
                    case.name
                );
            }
        }
    }
}
