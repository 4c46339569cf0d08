//! The partially stirred reactor (docs/theory.md, COR-16): eddies mix a share of a cell finely enough to react.

use calcine_coupler::gas_chemistry::{Combustion, ReactingGas};
use calcine_coupler::physics::kinetics::{MixtureState, pasr};
use calcine_coupler::turbulence::is_free;

use super::attempt::AttemptFrame;

/// Share of a cell's gas that reacts, by the eddies of the window's start; 1 by laminar rates, and in the bed, which has
/// no eddies and whose pores mix.
pub fn reacting_share(
    frame: &AttemptFrame<'_>,
    gas: &ReactingGas,
    cell: usize,
    state: MixtureState<'_>,
) -> f64 {
    let Combustion::Pasr { mixing_constant } = gas.combustion else {
        return 1.0;
    };
    let void_fraction = frame.void_fraction[cell];
    let eddies = &frame.old.turbulence;
    if eddies.is_laminar() || !is_free(void_fraction) {
        return 1.0;
    }
    let MixtureState {
        pressure,
        temperature,
        fractions,
    } = state;
    let density = frame.properties.density(pressure, temperature, fractions);
    let viscosity =
        frame.properties.viscosity(temperature, fractions) + eddies.viscosity[cell] / void_fraction;
    let mixing = pasr::mixing_time(
        mixing_constant,
        viscosity,
        density,
        eddies.dissipation[cell],
    );
    let chemical = gas.mechanism.chemical_time(state);
    pasr::reacting_fraction(chemical, mixing)
}
