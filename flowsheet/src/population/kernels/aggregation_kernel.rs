//! What a kernel of aggregation is.

/// Rate β at which two particles of volumes u, v in m³ aggregate, in 1/s (for a bed as a whole: the number of
/// aggregations in a second is ½ Σ Σ β N N).
pub trait AggregationKernel: Send + Sync {
    /// β(u, v) in 1/s.
    fn rate(&self, u: f64, v: f64) -> f64;
}
