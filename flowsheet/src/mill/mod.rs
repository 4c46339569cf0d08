//! Laws of mills: the distribution that comes out. One law a file.

mod bimodal;
mod bond;
mod bond_normal;
mod cone;
mod constant;

pub use bimodal::BondBimodal;
pub use bond::{BondLaw, BondLength};
pub use bond_normal::BondNormal;
pub use cone::ConeMill;
pub use constant::ConstantMill;

use calcine_physics::law::LawEntry;

use crate::{PlantError, SizeGrid, Transformation};

/// The laws of mills that a case may choose. A new one is a file beside these, declared above and listed here.
pub static MILL_LAWS: &[&LawEntry<dyn MillLaw>] = &[
    &bond_normal::LAW,
    &bond_normal::IN_MILLIMETRES,
    &bimodal::LAW,
    &bimodal::IN_MILLIMETRES,
    &cone::LAW,
    &constant::LAW,
];

/// What a mill makes of a distribution.
pub trait MillLaw: Send + Sync {
    /// Looks at the law's numbers and prepares what does not depend on the feed.
    fn prepare(&mut self, _grid: &SizeGrid, _place: &str) -> Result<(), PlantError> {
        Ok(())
    }

    /// The transformation of a feed with the masses `feed` of each class in kg/s. `place` is what an error names.
    fn transformation(
        &self,
        grid: &SizeGrid,
        feed: &[f64],
        place: &str,
    ) -> Result<Transformation, PlantError>;

    /// Power drawn in W, which heats what is milled.
    fn power(&self) -> f64 {
        0.0
    }

    /// True where it needs solids to act on.
    fn needs_feed(&self) -> bool {
        self.power() > 0.0
    }
}
