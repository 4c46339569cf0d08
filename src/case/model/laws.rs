//! Laws between and inside the phases.

use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::setup::Schedule;
use calcine_coupler::view_factors::ViewFactors;

/// Laws; each is stated in the case file, none has a default.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    /// Drag on a particle.
    pub drag: DragLaw,
    /// How gas and particles share their momentum.
    pub momentum: MomentumModel,
    /// Heat transfer between gas and particle.
    pub heat_transfer: HeatLaw,
    /// Heat conduction between particles.
    pub conduction: ConductionSpec,
    /// Mass transfer between gas and particles that react.
    pub mass_transfer: HeatLaw,
    /// Radiation between particles; `None`: none.
    pub radiation: Option<RadiationSpec>,
}

impl Laws {
    /// True where heat passes contacts or gaps.
    pub fn conducts(&self) -> bool {
        self.conduction.law != ConductionLaw::None || self.conduction.gap != GapSpec::None
    }
}

/// How particles conduct heat to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductionSpec {
    /// Through contacts.
    pub law: ConductionLaw,
    /// By which overlap.
    pub area: ConductionArea,
    /// Through the gas between surfaces.
    pub gap: GapSpec,
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

/// Conduction through the gas between surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GapSpec {
    /// None.
    None,
    /// Rong and Horio 1999.
    RongHorio {
        /// Thickness of the film over the radius.
        lens: f64,
        /// Least width of a gap in m.
        least_width: f64,
    },
    /// Cheng, Yu and Zulli 1999.
    Cheng {
        /// Radius of the cones' base over the particle's.
        cone: f64,
        /// Widest gap over the radius.
        widest: f64,
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

/// Conduction laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConductionLaw {
    /// No conduction.
    None,
    /// Batchelor and O'Brien 1977 (requirements COR-17).
    BatchelorObrien,
    /// By the circle of intersection, as LIGGGHTS has it.
    Lens,
}

/// Drag laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DragLaw {
    /// No drag.
    None,
    /// Ergun below a void fraction of 0.8, Wen and Yu above (requirements COR-6).
    ErgunWenYu,
    /// Ergun 1952.
    Ergun,
    /// Wen and Yu 1966.
    WenYu,
    /// Ergun and Wen-Yu, blended.
    Gidaspow,
    /// Di Felice 1994.
    DiFelice,
    /// Koch and Hill 2001.
    KochHill,
    /// Beetstra, van der Hoef and Kuipers 2007.
    Beetstra,
}

/// Heat transfer laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeatLaw {
    /// No heat transfer.
    None,
    /// Gunn 1978 (requirements COR-3).
    Gunn,
    /// Ranz and Marshall (requirements COR-1).
    RanzMarshall,
    /// Wakao and Kaguei 1982 (requirements COR-2).
    Wakao,
    /// Gnielinski 1980 (requirements COR-4).
    Gnielinski,
}
