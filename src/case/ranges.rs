//! The flow of a case against the ranges that the sources of its laws state.

use calcine_coupler::physics::flow_range::{FlowRange, ReynoldsBasis};
use calcine_coupler::physics::local::LocalGas;

use super::model::Case;
use super::units::short;

/// One line for each number whose range a law of the case states: its value in this flow at a sphere of a diameter in
/// m, the range, and a warning where it is outside.
pub(super) fn lines(case: &Case, flow: &LocalGas, diameter: f64) -> Vec<String> {
    let laws = &case.laws;
    let ranges = [
        ("drag", laws.drag.make().range()),
        ("heat transfer", laws.heat_transfer.make().range()),
        ("mass transfer", laws.mass_transfer.make().range()),
    ];
    let lines = ranges.iter().flat_map(|(law, range)| {
        let reynolds = match range.basis {
            ReynoldsBasis::Superficial => "Re of the superficial slip",
            ReynoldsBasis::Interstitial => "Re of the slip in the gaps",
        };
        let eps = flow.void_fraction.value();
        let (void_fraction, number) = (range.void_fraction, range.reynolds);
        [
            line(
                law,
                "void fraction",
                eps,
                void_fraction,
                FlowRange::UNSTATED.void_fraction,
            ),
            line(
                law,
                reynolds,
                range.reynolds_of(flow, diameter),
                number,
                FlowRange::UNSTATED.reynolds,
            ),
        ]
    });
    lines.flatten().collect()
}

fn line(
    law: &str,
    what: &str,
    value: f64,
    range: (f64, f64),
    unstated: (f64, f64),
) -> Option<String> {
    if range == unstated {
        return None;
    }
    let (low, high) = range;
    let stated = match (low > unstated.0, high < unstated.1) {
        (true, true) => format!("{} to {}", short(low), short(high)),
        (true, false) => format!("from {}", short(low)),
        _ => format!("up to {}", short(high)),
    };
    let warning = match (low..=high).contains(&value) {
        true => "",
        false => "   warning: outside",
    };
    let label = format!("{what}, range of {law}");
    Some(format!("{label:<52} {} ({stated}){warning}", short3(value)))
}

/// A computed number to three digits.
fn short3(number: f64) -> String {
    let rounded = format!("{number:.2e}").parse().unwrap_or(number);
    short(rounded)
}

#[cfg(test)]
mod tests {
    use calcine_coupler::physics::numbers::VoidFraction;

    use super::*;

    #[test]
    fn only_what_a_source_states_is_told_and_what_is_outside_is_marked() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let told = |law: &str, reynolds: f64| {
            let set = format!("laws.drag={{ law = \"{law}\" }}");
            let case = crate::case::read(&folder.join("cases/heated-bed.toml"), &[set]).unwrap();
            let flow = LocalGas {
                void_fraction: VoidFraction::new(0.5).unwrap(),
                density: 1.0,
                viscosity: 1.0,
                conductivity: 1.0,
                heat_capacity: 0.7,
                slip: reynolds,
            };
            let lines = lines(&case, &flow, 1.0);
            let own = lines
                .into_iter()
                .filter(|line| line.contains("range of drag"));
            own.collect::<Vec<_>>()
        };
        let ergun = told("ergun", 8.0);
        assert_eq!(ergun.len(), 1, "{ergun:?}");
        assert!(
            ergun[0].starts_with("void fraction, range of drag"),
            "{ergun:?}"
        );
        assert!(ergun[0].ends_with(" 0.5 (0.35 to 0.55)"), "{ergun:?}");
        let fast = told("koch-hill", 1e5);
        assert!(
            fast.iter()
                .any(|line| line.ends_with("(up to 200)   warning: outside")),
            "{fast:?}"
        );
        assert!(
            fast.iter().any(|line| line.ends_with(" 0.5 (from 0.36)")),
            "{fast:?}"
        );
    }
}
