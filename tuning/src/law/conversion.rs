/// How far a solid has reacted as a function of reduced time.
pub trait KineticLaw: Send + Sync + std::fmt::Debug {
    /// Its name in case files.
    fn name(&self) -> &'static str;

    /// α(x) with its first two derivatives at the reduced time x ≥ 0. The first derivative is the differential form
    /// f(α) = dα/dx. Beyond the end of a law that ends, α is one and the derivatives are zero. A derivative that is
    /// infinite at x = 0 is given as zero there.
    fn at(&self, x: f64) -> [f64; 3];

    /// α(x) alone.
    fn conversion(&self, x: f64) -> f64 {
        self.at(x)[0]
    }

    /// The integral form g(α) = x for 0 ≤ α < 1.
    fn reduced_time(&self, conversion: f64) -> f64;
}
