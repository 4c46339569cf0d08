//! Expectations of quantities against the time of a run.

use super::model::Case;
use super::units::shown;

/// A warning for each quantity whose value is expected after the end of the run, where it cannot pass.
pub fn beyond_the_end(case: &Case) -> Vec<String> {
    let end = case.time.end.seconds();
    let late = case.quantities.iter();
    let late = late.filter_map(|one| Some((&one.name, one.expected_after(end)?)));
    late.map(|(name, at)| {
        format!(
            "`{name}` is expected to have its value at {} s, but the run ends at {} s, so that it fails: raise \
             `time.end`, or lower `expect.at`",
            shown(at),
            shown(end)
        )
    })
    .collect()
}
