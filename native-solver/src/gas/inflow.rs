//! Species and heat at inlets (docs/theory.md, BND-1).
//!
//! Through an inlet of a given flux nothing but the stated gas at the stated flow enters,
//!
//! ṁ Y_f − G (Y_P − Y_f) = ṁ Y_in,   ṁ c_p T_f − Λ (T_P − T_f) = ṁ c_p T_in,
//!
//! G and Λ the conductances of the half cell behind the face: what enters needs neither of them, and the value at the
//! face, which gradients take, is the mean of the stated and the cell's, (ṁ Y_in + G Y_P)/(ṁ + G). Through an inlet
//! of given values species diffuse and heat is conducted beside the flow.

use super::attempt::AttemptFrame;
use super::boundary::{BoundaryGas, FaceCondition};
use crate::numerics::operators::conductance;

/// Diffusive conductance of the gas between an inlet face and its cell in kg/s.
fn diffusive(frame: &AttemptFrame<'_>, index: usize, gas: &BoundaryGas) -> f64 {
    let face = &frame.grid.faces[index];
    let laminar = frame.void_fraction[face.owner] * gas.viscosity / frame.schmidt;
    conductance(face, laminar + frame.species_eddies_at(index))
}

/// Thermal conductance of the gas between an inlet face and its cell in W/K.
fn thermal(frame: &AttemptFrame<'_>, index: usize, gas: &BoundaryGas) -> f64 {
    let face = &frame.grid.faces[index];
    let laminar = frame.void_fraction[face.owner] * gas.conductivity;
    let eddies = gas.heat_capacity * frame.heat_eddies_at(index);
    conductance(face, laminar + eddies)
}

/// Conductance for species in kg/s of a boundary face: of an inlet of given values; zero elsewhere.
#[inline]
pub fn diffusion(frame: &AttemptFrame<'_>, index: usize) -> f64 {
    match *frame.boundary.at(index) {
        FaceCondition::Inlet {
            gas,
            diffuses: true,
            ..
        } => diffusive(frame, index, &gas),
        _ => 0.0,
    }
}

/// Thermal conductance in W/K of an inlet face: of one of given values; zero of others.
#[inline]
pub fn conduction(frame: &AttemptFrame<'_>, index: usize, gas: &BoundaryGas) -> f64 {
    match *frame.boundary.at(index) {
        FaceCondition::Inlet { diffuses: true, .. } => thermal(frame, index, gas),
        _ => 0.0,
    }
}

/// Share of a flow in what a face's value is the mean of: of a flow and the cell's gas at a conductance.
fn share(flow: f64, conductance: f64) -> f64 {
    if flow > 0.0 {
        flow / (flow + conductance)
    } else {
        0.0
    }
}

/// Mass fraction at an inlet face, given that of its cell: that of a gas that is stated there, or a mean; `None` at other faces.
#[inline]
pub fn face_fraction(frame: &AttemptFrame<'_>, index: usize, k: usize, inner: f64) -> Option<f64> {
    let (
        Some(stated),
        FaceCondition::Inlet {
            mass_flux,
            gas,
            diffuses,
            ..
        },
    ) = (frame.boundary.composition(index), *frame.boundary.at(index))
    else {
        return None;
    };
    if diffuses {
        return Some(stated[k]);
    }
    let flow = mass_flux * frame.grid.faces[index].area;
    Some(inner + share(flow, diffusive(frame, index, &gas)) * (stated[k] - inner))
}

/// Temperature or enthalpy at an inlet face, given that of its cell and, by `stated`, that of the stated gas; `None` at
/// other faces.
#[inline]
pub fn face_heat(
    frame: &AttemptFrame<'_>,
    index: usize,
    inner: f64,
    stated: impl Fn(&BoundaryGas) -> f64,
) -> Option<f64> {
    let FaceCondition::Inlet {
        mass_flux,
        gas,
        diffuses,
        ..
    } = *frame.boundary.at(index)
    else {
        return None;
    };
    if diffuses {
        return Some(stated(&gas));
    }
    let flow = mass_flux * frame.grid.faces[index].area * gas.heat_capacity;
    Some(inner + share(flow, thermal(frame, index, &gas)) * (stated(&gas) - inner))
}
