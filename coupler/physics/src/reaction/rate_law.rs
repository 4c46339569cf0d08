//! Which law the rate of a reaction of particles follows.

/// Where in a particle a reaction takes place, and what its rate goes by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateLaw {
    /// At the surface of a core, see [`super::shrinking_core`].
    ShrinkingCore,
    /// In the whole particle, see [`super::power_law`].
    PowerLaw,
}
