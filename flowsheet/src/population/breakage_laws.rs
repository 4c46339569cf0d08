//! The laws of breakage.

use calcine_physics::law::LawEntry;

use super::fragments::{BreakageLaw, RANDOM_BINARY};
use super::power_fragments::POWER;

/// The laws of breakage that a case may choose. A new one is declared and listed here.
pub static BREAKAGE_LAWS: &[&LawEntry<dyn BreakageLaw>] = &[&RANDOM_BINARY, &POWER];
