//! Pressure at faces through which gas passes freely (docs/theory.md, BND-1).
//!
//! At an outlet it is the stated one. Beyond an opening gas is at rest, with the pressure of its own weight,
//!
//! p_s = p + ρ_s g·(x − x₀),
//!
//! from the point x₀ that has the stated pressure p. Gas flows out against p_s; gas that flows in has the total pressure
//! p_s, p_f = p_s − ½ ρ_s u² with its interstitial velocity u = φ/(ρ_s ε A). By a mass flux φ this is a resistance in series
//! with the half cell behind the face, here linear about the last flux φ*: p_f = p* + s φ, s = |φ*|/(ρ_s ε² A²), p* = p_s +
//! ½ s |φ*|.

use super::attempt::AttemptFrame;
use super::boundary::FaceCondition;

/// Pressure at a face by the mass flux out of the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OuterPressure {
    /// p* in Pa, above the setup's pressure.
    pub pressure: f64,
    /// s in Pa s/kg.
    pub slope: f64,
}

/// p_s in Pa, and 1/(ρ_s ε² A²) in Pa s²/kg²; zero of an outlet.
fn surroundings(frame: &AttemptFrame<'_>, index: usize) -> Option<(f64, f64)> {
    let FaceCondition::Outlet {
        pressure,
        surroundings,
        ..
    } = *frame.boundary.at(index)
    else {
        return None;
    };
    let Some(still) = surroundings else {
        return Some((pressure, 0.0));
    };
    let face = &frame.grid.faces[index];
    let cell = frame.grid.centre[face.owner];
    let centre = cell + face.owner_distance * face.normal + face.owner_skew;
    let weight = still.density * frame.gravity.dot(&(centre - still.at));
    let pores = frame.void_fraction[face.owner] * face.area;
    Some((pressure + weight, 1.0 / (still.density * pores * pores)))
}

impl OuterPressure {
    /// About a mass flux in kg/s out of the domain; `None` where gas does not pass freely.
    pub fn about(frame: &AttemptFrame<'_>, index: usize, flux: f64) -> Option<Self> {
        let (still, resistance) = surroundings(frame, index)?;
        let slope = resistance * (-flux).max(0.0);
        Some(Self {
            pressure: still + 0.5 * slope * (-flux).max(0.0),
            slope,
        })
    }

    /// How far it is from the pressure at a mass flux in kg/s, in Pa.
    pub fn miss(&self, frame: &AttemptFrame<'_>, index: usize, flux: f64) -> f64 {
        let Some((still, resistance)) = surroundings(frame, index) else {
            return 0.0;
        };
        let inwards = (-flux).max(0.0);
        self.pressure + self.slope * flux - (still - 0.5 * resistance * inwards * inwards)
    }
}
