//! The laws of radiation that a case may choose.

use calcine_physics::law::{LawEntry, NONE};

/// How particles radiate to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadiationLaw {
    /// By view factors from rays.
    Rays,
    /// By view factors from the distance alone.
    Distance,
    /// Evenly over the surfaces of neighbours.
    Neighbours,
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

/// View factors by the surfaces of neighbours.
pub static NEIGHBOURS: LawEntry<RadiationLaw> = LawEntry {
    name: "neighbours",
    summary: "To all particles within the range by their share of the surface there, as XDEM has it; for comparison with it.",
    source: "Copertaro et al., Engineering Journal 20(5) (2016) 187, doi 10.4186/ej.2016.20.5.187, eq 17",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(RadiationLaw::Neighbours),
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
pub static RADIATION_LAWS: &[&LawEntry<RadiationLaw>] =
    &[&RAYS, &DISTANCE, &NEIGHBOURS, &NO_RADIATION];
