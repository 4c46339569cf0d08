//! Laws between and inside the phases.

use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::physics::conduction::{Conduction, GasGap};
use calcine_coupler::physics::drag::Drag;
use calcine_coupler::physics::film::{FilmDiffusivity, FilmTemperature, FilmTheory};
use calcine_coupler::physics::heat_transfer::HeatTransfer;
use calcine_coupler::physics::law::LawChoice;
use calcine_coupler::physics::turbulence::BedEddies;
use calcine_coupler::setup::Schedule;
use calcine_coupler::view_factors::ViewFactors;

/// Laws; each is stated in the case file, none has a default.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    /// Drag on a particle.
    pub drag: LawChoice<dyn Drag>,
    /// How gas and particles share their momentum.
    pub momentum: MomentumModel,
    /// Heat transfer between gas and particle.
    pub heat_transfer: LawChoice<dyn HeatTransfer>,
    /// At which temperature the properties of its gas are taken.
    pub heat_film: FilmTemperature,
    /// Heat conduction between particles.
    pub conduction: ConductionSpec,
    /// Mass transfer between gas and particles that react.
    pub mass_transfer: LawChoice<dyn HeatTransfer>,
    /// What the particles of a bed make of eddies, as `gas.turbulence.bed` states it.
    pub bed_eddies: LawChoice<dyn BedEddies>,
    /// How it is computed.
    pub film: FilmTheory,
    /// By which diffusivities.
    pub film_diffusivity: FilmDiffusivity,
    /// Radiation between particles; `None`: none.
    pub radiation: Option<RadiationSpec>,
}

impl Laws {
    /// True where heat passes contacts or gaps.
    pub fn conducts(&self) -> bool {
        !self.conduction.law.is_none() || !self.conduction.gap.is_none()
    }
}

/// How particles conduct heat to each other.
#[derive(Clone, Debug, PartialEq)]
pub struct ConductionSpec {
    /// Through contacts.
    pub law: LawChoice<dyn Conduction>,
    /// By which overlap.
    pub area: ConductionArea,
    /// Through the gas between surfaces.
    pub gap: LawChoice<dyn GasGap>,
}

/// The overlap by which contacts conduct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConductionArea {
    /// As it is.
    Overlap,
    /// That of the real materials under the computed force.
    Force,
    /// That of the real materials under one force.
    Load {
        /// The force in N.
        force: f64,
        /// The widest gap in m that counts as a contact.
        within: f64,
    },
}

/// How particles radiate.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiationSpec {
    /// How views are found.
    pub view_factors: ViewFactors,
    /// True where badly conducting spheres pass on less.
    pub inside: bool,
    /// Temperature in K of what is seen beyond all walls; `None`: nothing leaves.
    pub surroundings: Option<Schedule>,
    /// Views of moving particles hold for so much process time in s.
    pub refresh: f64,
}
