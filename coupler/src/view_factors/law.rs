//! The laws of radiation that a case may choose.

use calcine_physics::law::{LawEntry, NONE};

/// How particles radiate to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadiationLaw {
    /// By view factors from rays.
    Rays,
    /// By view factors from the distance alone.
    Distance,
    /// Not at all.
    None,
}

/// View factors from rays.
pub static RAYS: LawEntry<RadiationLaw> = LawEntry {
    name: "view-factors",
    summary: "View factors by rays, with what stands between.",
    source: "docs/theory.md, THP-5",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(RadiationLaw::Rays),
};

/// View factors from the distance.
pub static DISTANCE: LawEntry<RadiationLaw> = LawEntry {
    name: "distance",
    summary: "View factors by the distance alone, fitted to rays in random beds of equal spheres.",
    source: "after Feng and Han, Int. J. Heat Mass Transf. 55 (2012) 6374, doi \
             10.1016/j.ijheatmasstransfer.2012.06.021",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(RadiationLaw::Distance),
};

/// No radiation.
static NO_RADIATION: LawEntry<RadiationLaw> = LawEntry {
    name: NONE,
    summary: "Particles do not radiate.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(RadiationLaw::None),
};

/// The laws of radiation that a case may choose.
pub static RADIATION_LAWS: &[&LawEntry<RadiationLaw>] = &[&RAYS, &DISTANCE, &NO_RADIATION];
