//! How the bed of a case is packed, against the threshold of the smoother.

use super::model::Case;
use super::units::short3;

/// Solid fraction by which a packing may exceed the threshold before the smoother is said to spread it: packings vary by as
/// much from place to place.
const BEYOND: f64 = 0.01;

/// How the bed of a case is packed at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BedPacking {
    /// Mean void fraction that the particles see, smoothed.
    pub void_fraction: f64,
    /// Solid fraction of the packing itself: the median over the bed of that within two mean diameters.
    pub solid_fraction: f64,
    /// Share of the solid volume that the smoother moves out of cells above its threshold.
    pub moved_share: f64,
}

impl BedPacking {
    /// Without particles.
    pub const NONE: Self = Self {
        void_fraction: 1.0,
        solid_fraction: 0.0,
        moved_share: 0.0,
    };

    /// A warning where the smoother spreads the packing itself.
    pub(super) fn warning(&self, case: &Case) -> Option<String> {
        let most = case.coupling.max_solid_fraction;
        let spread = self.solid_fraction > most + BEYOND && self.moved_share > 0.0;
        spread.then(|| {
            format!(
                "the bed is packed to a solid fraction of {}, denser than `coupling.smoother.max_solid_fraction` of {most}: the smoother \
                 moves {} % of the solid and spreads the bed, whose pressure drop falls; raise the threshold above the packing, to 0.64 \
                 for spheres poured at random",
                short3(self.solid_fraction),
                short3(100.0 * self.moved_share)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    #[test]
    fn a_packing_denser_than_the_threshold_of_the_smoother_is_told() {
        let told = |most: &str| {
            let set = format!("coupling.smoother.max_solid_fraction={most}");
            let all = warned("../../../cases/packed-column", &[&set]);
            all.into_iter()
                .find(|one| one.starts_with("the bed is packed"))
        };
        assert_eq!(told("0.64"), None);
        let text = told("0.405").unwrap();
        assert!(text.contains("of 0.405: the smoother moves "), "{text}");
    }
}
