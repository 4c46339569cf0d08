//! The flow of a case against the ranges that the sources of its laws state.

use calcine_coupler::physics::flow_range::{FlowRange, ReynoldsBasis};
use calcine_coupler::physics::local::LocalGas;

use super::model::Case;
use super::units::{short, short3};

/// A number of a flow and the range that the source of a law states for it.
pub(super) struct StatedRange {
    /// What the law is of: `drag`.
    law: &'static str,
    /// What is in range or not.
    what: &'static str,
    value: f64,
    range: (f64, f64),
    /// The range in words.
    stated: String,
}

impl StatedRange {
    fn new(
        law: &'static str,
        what: &'static str,
        value: f64,
        range: (f64, f64),
        unstated: (f64, f64),
    ) -> Option<Self> {
        if range == unstated {
            return None;
        }
        let (low, high) = range;
        let stated = match (low > unstated.0, high < unstated.1) {
            (true, true) => format!("{} to {}", short(low), short(high)),
            (true, false) => format!("from {}", short(low)),
            _ => format!("up to {}", short(high)),
        };
        Some(Self {
            law,
            what,
            value,
            range,
            stated,
        })
    }

    fn is_outside(&self) -> bool {
        !(self.range.0..=self.range.1).contains(&self.value)
    }

    /// A line of `check`.
    pub(super) fn line(&self) -> String {
        let label = format!("{}, range of {}", self.what, self.law);
        let outside = match self.is_outside() {
            true => "   outside",
            false => "",
        };
        format!(
            "{label:<52} {} ({}){outside}",
            short3(self.value),
            self.stated
        )
    }

    /// A warning where the number is outside, of particles of this name.
    pub(super) fn warning(&self, name: &str) -> Option<String> {
        self.is_outside().then(|| {
            // One void fraction stands for all particles.
            let of = match self.what == VOID_FRACTION {
                true => String::new(),
                false => format!(" of `{name}`"),
            };
            format!(
                "{}{of} is {}, outside the range of the law of {} ({}): its source has not shown that it holds there; choose another \
                 law of `laws` if that matters",
                self.what,
                short3(self.value),
                self.law,
                self.stated
            )
        })
    }
}

const VOID_FRACTION: &str = "void fraction";

/// The numbers whose range a law of the case states, in this flow at a sphere of a diameter in m.
pub(super) fn of(case: &Case, flow: &LocalGas, diameter: f64) -> Vec<StatedRange> {
    let laws = &case.laws;
    let ranges = [
        ("drag", laws.drag.make().range().of_force(flow)),
        ("heat transfer", laws.heat_transfer.make().range()),
        ("mass transfer", laws.mass_transfer.make().range()),
    ];
    let numbers = ranges.iter().flat_map(|(law, range)| {
        let reynolds = match range.basis {
            ReynoldsBasis::Superficial => "Re of the superficial slip",
            ReynoldsBasis::Interstitial => "Re of the slip in the gaps",
        };
        let eps = flow.void_fraction.value();
        let (void_fraction, number) = (range.void_fraction, range.reynolds);
        [
            StatedRange::new(
                law,
                VOID_FRACTION,
                eps,
                void_fraction,
                FlowRange::UNSTATED.void_fraction,
            ),
            StatedRange::new(
                law,
                reynolds,
                range.reynolds_of(flow, diameter),
                number,
                FlowRange::UNSTATED.reynolds,
            ),
        ]
    });
    numbers.flatten().collect()
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
            let numbers = of(&case, &flow, 1.0);
            let own = numbers.iter().filter(|one| one.law == "drag");
            own.map(StatedRange::line).collect::<Vec<_>>()
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
                .any(|line| line.ends_with("(up to 200)   outside")),
            "{fast:?}"
        );
        assert!(
            fast.iter().any(|line| line.ends_with(" 0.5 (from 0.36)")),
            "{fast:?}"
        );
    }
}
