//! What is likely not meant about the steps of the gas.

use calcine_coupler::setup::TimeScheme;

use super::model::Case;

/// Two stages that no window has.
pub(super) fn all(case: &Case) -> Vec<String> {
    if case.gas.controls.time_scheme == TimeScheme::ImplicitEuler {
        return Vec::new();
    }
    let steps = case.time.acceleration.steps();
    let split = steps.iter().all(|(_, factor)| *factor != 1.0);
    let why = if case.gas.chemistry.reacting().is_some() {
        "the gas reacts with itself"
    } else if case.chemistry.exchanges() {
        "particles give and take gas"
    } else if split {
        "its acceleration is never 1"
    } else {
        return Vec::new();
    };
    vec![format!(
        "`gas.controls.time_scheme` is \"sdirk2\", but {why}: every window is stepped by implicit Euler, so leave it out"
    )]
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    #[test]
    fn two_stages_without_effect_are_told_with_the_reason() {
        let scheme = "gas.controls.time_scheme=sdirk2";
        assert!(said("open-box", &[scheme]).is_empty());
        let split = one("open-box", &[scheme, "time.acceleration=20"]);
        assert!(split.contains("never 1"), "{split}");
        assert!(one("flame", &[scheme]).contains("reacts with itself"));
        assert!(one("reactions", &[scheme]).contains("give and take gas"));
    }
}
