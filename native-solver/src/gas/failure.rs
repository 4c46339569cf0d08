//! How an attempt of the native gas fails.

use calcine_coupler::error::FailureKind;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::figures::Brief;
use calcine_coupler::physics::kinetics::KineticsError;
use thiserror::Error;

/// A cell with its centre in m, for messages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The cell.
    pub cell: usize,
    /// Its centre in m.
    pub centre: Vec3,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { cell, centre } = self;
        write!(
            f,
            "in cell {cell} at ({:.6}, {:.6}, {:.6}) m",
            centre.x, centre.y, centre.z
        )
    }
}

/// Why an attempt has no result.
#[derive(Debug, Error)]
pub enum GasFailure {
    /// A list of a wrong length.
    #[error("the {field} has {found} values for {cells} cells")]
    Length {
        /// Which list.
        field: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        cells: usize,
    },
    /// The exchange of species is not finite or not complete.
    #[error("the {field} of species has {found} values of {wanted}, {odd} among them")]
    Species {
        /// Which list.
        field: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        wanted: usize,
        /// A value that is not finite, or zero.
        odd: f64,
    },
    /// A void fraction that no bed has.
    #[error("a void fraction of {value} {place}; it must be in (0, 1]")]
    VoidFraction {
        /// The value.
        value: f64,
        /// Where.
        place: Place,
    },
    /// An exchange that is not finite, or with a negative coefficient.
    #[error(
        "an exchange of {drag_coefficient} kg/s, {drag_source} N, {heat_coefficient} W/K, {heat_source} W \
         {place}; coefficients must be finite and not negative", drag_coefficient = Brief(*.drag_coefficient), drag_source = Brief(*.drag_source), heat_coefficient = Brief(*.heat_coefficient), heat_source = Brief(*.heat_source))]
    Exchange {
        /// Drag coefficient in kg/s.
        drag_coefficient: f64,
        /// Magnitude of the drag's source in N.
        drag_source: f64,
        /// Heat coefficient in W/K.
        heat_coefficient: f64,
        /// Heat source in W.
        heat_source: f64,
        /// Where.
        place: Place,
    },
    /// Fields that are not finite.
    #[error(
        "diverged: fields that are not finite {place}; shorter windows may help (`time.motion_window`, or `time.process_step` \
         where the case has it)"
    )]
    NotFinite {
        /// Where.
        place: Place,
    },
    /// A value that no gas has.
    #[error(
        "diverged: {field} of {value} {unit} {place}; shorter windows may help (`time.motion_window`, or `time.process_step` \
         where the case has it)", value = Brief(*.value))]
    OutOfRange {
        /// What the value is.
        field: &'static str,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Where.
        place: Place,
    },
    /// Turbulence that is not positive.
    #[error(
        "diverged: turbulent energy of {energy} m^2/s^2 with a dissipation of {dissipation} m^2/s^3 {place}; \
         shorter windows may help (`time.motion_window`, or `time.process_step` where the case has it)", energy = Brief(*.energy), dissipation = Brief(*.dissipation))]
    Turbulence {
        /// k in m²/s².
        energy: f64,
        /// ε in m²/s³.
        dissipation: f64,
        /// Where.
        place: Place,
    },
    /// Reactions that cannot be integrated.
    #[error("the reactions of the gas {place}: {cause}")]
    Reactions {
        /// Where.
        place: Place,
        /// Why.
        cause: KineticsError,
    },
}

impl GasFailure {
    /// Its kind for the coordinator.
    pub fn kind(&self) -> FailureKind {
        match self {
            Self::Length { .. }
            | Self::Species { .. }
            | Self::VoidFraction { .. }
            | Self::Exchange { .. } => FailureKind::InvalidInput,
            Self::NotFinite { .. } => FailureKind::NotFinite,
            Self::OutOfRange { value, .. } if value.is_nan() => FailureKind::NotFinite,
            Self::OutOfRange { .. } | Self::Turbulence { .. } => FailureKind::Diverged,
            Self::Reactions { .. } => FailureKind::NotConverged,
        }
    }
}
