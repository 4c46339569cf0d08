//! Populations over size classes: growth, aggregation, breakage.

mod aggregation;
mod breakage;
mod breakage_laws;
mod dyssol;
mod fragments;
mod growth;
mod growth_law;
mod kernels;
mod power_fragments;

pub use aggregation::Aggregation;
pub use breakage::ParticleBreakage;
pub use breakage_laws::BREAKAGE_LAWS;
pub use dyssol::dyssol_growth;
pub use fragments::{BreakageLaw, RandomBinary};
pub use growth::{GrowthScheme, SizeFluxes};
pub use growth_law::{GrowthLaw, LinearGrowth, TabulatedGrowth, UniformGrowth};
pub use kernels::{
    AGGREGATION_LAWS, AggregationKernel, BrownianKernel, ConstantKernel, EquipartitionKernel,
    KapurKernel, ProductKernel, SettlingKernel, ShearKernel, SumKernel, TabulatedKernel,
};
pub use power_fragments::PowerBreakage;

/// Something that moves the solids of a bed between size classes and conserves them.
pub trait SizeProcess: Send + Sync {
    /// Looks at the numbers and prepares what does not change, for size classes whose particles have these masses in kg.
    fn prepare(
        &mut self,
        grid: &crate::SizeGrid,
        particle: &[f64],
        place: &str,
    ) -> Result<(), crate::PlantError>;

    /// Adds its rates in kg/s to those of the masses in kg: size classes of `inner` numbers each.
    fn add(&self, inner: usize, masses: &[f64], rates: &mut [f64]);

    /// A bound of how fast small deviations of the masses fade, in 1/s.
    fn fastest(&self, inner: usize, masses: &[f64]) -> f64;

    /// Degree of homogeneity of a kernel by which a finite mass becomes infinitely large in finite time: above 1.
    fn gels(&self) -> Option<f64> {
        None
    }
}
