//! Rates at which two particles aggregate.

/// Rate β at which two particles of volumes u, v in m³ aggregate, in 1/s (for a bed as a whole: the number of
/// aggregations in a second is ½ Σ Σ β N N).
pub trait AggregationKernel: Send + Sync {
    /// β(u, v) in 1/s.
    fn rate(&self, u: f64, v: f64) -> f64;
}

/// β = β₀.
#[derive(Clone, Copy, Debug)]
pub struct ConstantKernel {
    /// β₀ in 1/s.
    pub rate: f64,
}

impl AggregationKernel for ConstantKernel {
    fn rate(&self, _u: f64, _v: f64) -> f64 {
        self.rate
    }
}

/// β = β₀ (u + v).
#[derive(Clone, Copy, Debug)]
pub struct SumKernel {
    /// β₀ in 1/(s m³).
    pub rate: f64,
}

impl AggregationKernel for SumKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        self.rate * (u + v)
    }
}

/// β = β₀ u v. It gels: at N₀ v₀² β₀ t = ½ from an exponential distribution of mean v₀ the second moment is infinite.
#[derive(Clone, Copy, Debug)]
pub struct ProductKernel {
    /// β₀ in 1/(s m⁶).
    pub rate: f64,
}

impl AggregationKernel for ProductKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        self.rate * u * v
    }
}
