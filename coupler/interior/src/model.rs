//! The trait behind which particles are thermally thin or resolved along the radius.

/// Inside of all particles. An attempt always starts from the last commit.
pub trait ParticleModel: Send {
    /// Surface temperature of each particle in K after the last attempt.
    fn temperature(&self) -> &[f64];

    /// Surface temperature of each particle in K at the last commit.
    fn committed_temperature(&self) -> &[f64];

    /// Conductances with the particles' own new temperatures eliminated (requirements TSM-9):
    /// from h A in W/K over a process span in s to K, such that K (T_gas − T_committed) is the
    /// heat flow of the implicit step.
    fn eliminated(&self, conductance: &[f64], span: f64, out: &mut [f64]);

    /// One attempt over a process span in s, with the mean heat flow into each particle in W.
    fn advance(&mut self, heat: &[f64], span: f64);

    /// Takes the last attempt as the new start.
    fn commit(&mut self);

    /// Energy stored by the last attempt in J: the sum over particles, and the sum of magnitudes.
    fn stored_change(&self) -> (f64, f64);

    /// Takes up temperatures in K from a checkpoint, as committed.
    fn restore(&mut self, temperature: &[f64]);
}
