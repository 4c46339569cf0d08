//! What conducts and lets pass: coefficients between the nodes of a particle (docs/theory.md, XDP-3 to XDP-6).

use calcine_physics::film::{StefanFlow, bernoulli};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::pores::dusty_gas::MOST_GASES;
use calcine_physics::pores::{DustyGas, PorousConductivity, knudsen};

use super::physics::{PAIR_PRESSURE, PAIR_TEMPERATURE, RadialPhysics};
use super::workspace::RadialWorkspace;
use crate::reacting::passage::ParticleSurroundings;

/// How much better than the outermost shell the film lets pass what flows by pressure: its pressure drops by nothing that shows.
const OPENING: f64 = 1e4;

/// What acts on a particle from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside<'a> {
    /// The gas about it.
    pub around: ParticleSurroundings<'a>,
    /// h A in W/K at the start.
    pub conductance: f64,
    /// Heat from contacts and radiation, and what is owed, in W.
    pub heat: f64,
}

impl RadialPhysics {
    /// Finds volumes, geometry, and all coefficients at the iterate. False where the solids leave no room for pores, or a
    /// coefficient is not finite.
    pub fn coefficients(&self, outside: &Outside<'_>, ws: &mut RadialWorkspace) -> bool {
        if !self.measure(ws) {
            return false;
        }
        let (n, g) = (ws.shells, ws.gases);
        let mut fractions = [0.0; MOST_GASES];
        for node in 0..=n {
            let shell = node.min(n - 1);
            let porosity = ws.held.pores[shell] / ws.held.volume[shell];
            let kelvin = ws.now.temperature[node];
            let gas = match (&self.solid.conduction, &self.chemistry.gas) {
                (PorousConductivity::Parallel { .. }, Some(mixture)) => {
                    let own = &ws.now.pressure[node * g..(node + 1) * g];
                    self.mass_fractions(own, &mut fractions);
                    mixture.conductivity(kelvin, &fractions[..g])
                }
                _ => 0.0,
            };
            let law = &self.solid.conduction;
            ws.held.conductivity[node] = law.of(&self.solid.conductivity, gas, porosity, kelvin);
        }
        let mut finite = true;
        for face in 0..n {
            finite &= self.face(face, ws);
        }
        self.film(outside, ws);
        finite
    }

    /// Volumes of shells and pores, and where the shells lie; false where there is no room for pores.
    pub fn measure(&self, ws: &mut RadialWorkspace) -> bool {
        let s = ws.solids;
        let share = |shell: usize| match ws.shells == self.shares.len() {
            true => self.shares[shell],
            false => 1.0,
        };
        let mut room = true;
        for shell in 0..ws.shells {
            let amounts = &ws.now.amount[shell * s..(shell + 1) * s];
            let volume = self.volume(amounts, ws.first_volume[shell], share(shell));
            ws.held.volume[shell] = volume;
            ws.held.pores[shell] = volume - self.filled(amounts);
            room &= ws.held.pores[shell] > 0.0 || ws.gases == 0;
        }
        let RadialWorkspace { held, .. } = ws;
        held.geometry.measure(&held.volume);
        room
    }

    /// Mass fractions of gases of these partial pressures in Pa.
    fn mass_fractions(&self, pressures: &[f64], out: &mut [f64; MOST_GASES]) {
        let mut all = 0.0;
        for ((out, p), mass) in out.iter_mut().zip(pressures).zip(&self.gas_mass) {
            *out = p.max(0.0) * mass;
            all += *out;
        }
        out.iter_mut().take(pressures.len()).for_each(|y| *y /= all);
    }

    /// The outer face of a shell.
    fn face(&self, face: usize, ws: &mut RadialWorkspace) -> bool {
        let g = ws.gases;
        let last = ws.shells - 1;
        let RadialWorkspace {
            held,
            now,
            flows,
            gas_capacity,
            ..
        } = ws;
        let geometry = &held.geometry;
        let (area, inside, beyond) = (
            geometry.area[face],
            geometry.outwards[face],
            geometry.beyond[face],
        );
        let [one, other] = [held.conductivity[face], held.conductivity[face + 1]];
        let conductance = area / (inside / one + beyond / other);
        held.conductance[face] = conductance;
        held.heat_share[face] = 0.5;
        let Some(mixture) = &self.chemistry.gas else {
            return conductance.is_finite();
        };
        let next = (face + 1).min(last);
        let kelvin = 0.5 * (now.temperature[face] + now.temperature[face + 1]);
        let (mut pressures, mut fractions) = ([0.0; MOST_GASES], [0.0; MOST_GASES]);
        let mut pressure = 0.0;
        let mut drop = 0.0;
        for (k, mean) in pressures.iter_mut().enumerate().take(g) {
            let ends = [now.pressure[face * g + k], now.pressure[(face + 1) * g + k]];
            *mean = (0.5 * (ends[0] + ends[1])).max(0.0);
            pressure += *mean;
            drop += ends[0] - ends[1];
        }
        for k in 0..g {
            fractions[k] = pressures[k] / pressure;
        }
        let mut walls = [0.0; MOST_GASES];
        for (wall, mass) in walls.iter_mut().zip(&self.gas_mass) {
            *wall = knudsen::diffusivity(self.solid.pore_diameter, kelvin, *mass);
        }
        let scale = (kelvin / PAIR_TEMPERATURE).powf(1.75) * PAIR_PRESSURE / pressure;
        let matrix = &mut held.diffusion[face * g * g..(face + 1) * g * g];
        let pair = |i: usize, j: usize| self.pairs[i * g + j] * scale;
        let made = DustyGas.fill(&fractions[..g], &walls[..g], pair, kelvin, matrix);
        let porosity = |shell: usize| held.pores[shell] / held.volume[shell];
        let [here, there] = [porosity(face), porosity(next)];
        let paths = area * 1.0 / (self.solid.tortuosity * (inside / here + beyond / there));
        matrix.iter_mut().for_each(|value| *value *= paths);
        let through = |porosity: f64| self.solid.permeability.of(porosity);
        let permeable = area / (inside / through(here) + beyond / through(there));
        self.mass_fractions(&pressures[..g], &mut fractions);
        let viscosity = mixture.viscosity(kelvin, &fractions[..g]);
        let flow = permeable / (viscosity * GAS_CONSTANT * kelvin);
        held.flow[face] = flow;
        let mut carried = 0.0;
        for k in 0..g {
            let number = flow * drop * pressure / matrix[k * g + k];
            held.share[face * g + k] = inner_share(number);
            carried += flows.gas[face * g + k] * gas_capacity[face * g + k];
        }
        held.heat_share[face] = inner_share(carried / conductance);
        made && (flow + paths + conductance).is_finite()
    }

    /// The film about the particle.
    fn film(&self, outside: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        let RadialWorkspace {
            held,
            now,
            flows,
            gas_capacity,
            ..
        } = ws;
        let around = &outside.around;
        let radius = held.geometry.radius();
        let shrinkage = if around.radius > 0.0 {
            radius / around.radius
        } else {
            1.0
        };
        let own = outside.conductance * shrinkage;
        held.film_heat = own;
        if g == 0 {
            return;
        }
        let surface = now.temperature[n];
        let kelvin = around.theory.temperature.of(surface, around.temperature);
        let moles = around.pressure / (GAS_CONSTANT * kelvin);
        let mut best: f64 = 0.0;
        let mut carried = 0.0;
        for k in 0..g {
            let coefficient = around.film[k].of(kelvin) / shrinkage;
            held.film[k] = held.geometry.area[n - 1] * moles * coefficient;
            best = best.max(held.diffusion[((n - 1) * g + k) * g + k]);
            carried += flows.film[k] * gas_capacity[n * g + k];
        }
        held.opening = OPENING * (held.flow[n - 1] * around.pressure + best);
        if around.theory.stefan_flow != StefanFlow::None && own > 0.0 {
            held.film_heat = own * bernoulli(carried / own);
        }
    }
}

/// The share of the inner node in what passes a face by a flow outwards of this Péclet number: that of the exact solution between
/// both nodes, half of still gas and all of a fast flow.
fn inner_share(number: f64) -> f64 {
    if number.abs() < 1e-4 {
        return 0.5 + number / 12.0;
    }
    (bernoulli(-number) - 1.0) / number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn still_gas_counts_both_nodes_and_a_fast_flow_where_it_comes_from() {
        assert!((inner_share(0.0) - 0.5).abs() < 1e-15);
        assert!((inner_share(1e-4) - inner_share(0.99e-4)).abs() < 1e-6);
        assert!((inner_share(200.0) - 1.0).abs() < 1e-2 && inner_share(-200.0) < 1e-2);
        // 1/(1 − e^−2) − 1/2 in Python.
        assert!((inner_share(2.0) - 0.656_517_642_749_665_6).abs() < 1e-14);
    }
}
