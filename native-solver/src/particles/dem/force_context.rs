//! What an evaluation of forces looks at.

use super::rules::ContactRules;
use super::sphere::Spheres;
use super::walls::WallBody;

/// What an evaluation of all forces shares.
pub struct ForceContext<'a, L> {
    /// The contact law.
    pub law: &'a L,
    /// Constants and options.
    pub rules: &'a ContactRules,
    /// The particles.
    pub spheres: &'a Spheres,
    /// The walls where they are now.
    pub walls: &'a [WallBody],
    /// Time in s over which memories are brought up to date.
    pub step: f64,
    /// Number of this evaluation.
    pub stamp: u64,
}
