//! The partially stirred reactor (docs/theory.md, COR-16): eddies mix a share of a cell finely enough to react.

use calcine_coupler::gas_chemistry::{Combustion, ReactingGas};
use calcine_coupler::physics::kinetics::pasr;

use super::attempt::AttemptFrame;

/// Time in s in which the eddies of the window's start mix a cell's gas; 0 by laminar rates, and in a bed at which eddies
/// end, whose pores count as mixed.
pub fn mixing_time(frame: &AttemptFrame<'_>, gas: &ReactingGas, cell: usize) -> f64 {
    let Combustion::Pasr { mixing_constant } = gas.combustion else {
        return 0.0;
    };
    let void_fraction = frame.void_fraction[cell];
    let old = frame.old;
    let eddies = &old.turbulence;
    if eddies.is_laminar() || !frame.turbulence.reaches(void_fraction) {
        return 0.0;
    }
    let (pressure, temperature) = (old.base_pressure, old.temperature[cell]);
    let fractions = old.composition_of(cell, frame.species());
    let density = frame.properties.density(pressure, temperature, fractions);
    let viscosity =
        frame.properties.viscosity(temperature, fractions) + eddies.viscosity[cell] / void_fraction;
    pasr::mixing_time(
        mixing_constant,
        viscosity,
        density,
        eddies.dissipation[cell],
    )
}
