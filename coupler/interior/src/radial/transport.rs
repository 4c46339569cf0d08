//! What conducts and lets pass: coefficients between the nodes of a particle (docs/theory.md, XDP-3 to XDP-6).

use calcine_physics::film::{FilmCoefficient, FilmTheory, StefanFlow, bernoulli};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::pores::dusty_gas::MOST_GASES;
use calcine_physics::pores::{DustyGas, PorousConductivity, knudsen};

use super::physics::{PAIR_PRESSURE, PAIR_TEMPERATURE, RadialPhysics};
use super::side_by_side::{LANES, Wide};
use super::workspace::RadialWorkspace;
use crate::model::SurfaceNetwork;

/// How much better than the outermost shell the film lets pass what flows by pressure: its pressure drops by nothing that shows.
const OPENING: f64 = 1e4;

/// What acts on a particle from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside<'a> {
    /// Temperature in K and pressure in Pa of the gas about it.
    pub temperature: f64,
    pub pressure: f64,
    /// Its mole fractions.
    pub fractions: [f64; MOST_GASES],
    /// Mass transfer coefficient of each gas about a particle of the radius in m, and how transfer is computed.
    pub film: &'a [FilmCoefficient],
    pub theory: FilmTheory,
    pub radius: f64,
    /// h A in W/K at the start.
    pub conductance: f64,
    /// Heat in W that does not follow the surface: what is owed, and what contacts and radiation bring where they are not told.
    pub heat: f64,
    /// Contacts and views, which follow the surface.
    pub beside: SurfaceNetwork,
    /// True where the network asks how the mean temperature of the surface follows its heat.
    pub networked: bool,
}

/// What acts on the particle of each lane.
pub(super) type OutsideLanes<'a> = [Option<Outside<'a>>; LANES];

/// Takes a value in the lanes of a mask, which are one there and zero elsewhere.
#[inline(always)]
fn renew(mask: Wide, old: &mut Wide, new: Wide) {
    *old = mask.if_positive(new, *old);
}

impl RadialPhysics {
    /// Finds the coefficients at the iterate in the lanes that take them anew, of shells as they are measured.
    #[inline(always)]
    pub fn coefficients<const G: usize>(
        &self,
        outside: &OutsideLanes<'_>,
        ws: &mut RadialWorkspace,
    ) {
        let n = ws.shells;
        let g = if G == ANY { ws.gases } else { G };
        let mask = ws.updating;
        ws.broken = Wide::default();
        for shell in 0..n {
            ws.held.porosity[shell] = ws.held.pores[shell] / ws.held.volume[shell];
        }
        let law = &self.solid.conduction;
        let everywhere = match law {
            PorousConductivity::Stated => self.solid.conductivity.everywhere(),
            PorousConductivity::Parallel { .. } => None,
        };
        for node in 0..=n {
            if let Some(value) = everywhere {
                renew(mask, &mut ws.held.conductivity[node], Wide::all(value));
                continue;
            }
            let kelvin = ws.now.temperature[node];
            let porosity = ws.held.porosity[node.min(n - 1)];
            let mut found = Wide::default();
            for lane in 0..LANES {
                if mask[lane] == 0.0 {
                    continue;
                }
                let gas = match (law, &self.chemistry.gas) {
                    (PorousConductivity::Parallel { .. }, Some(mixture)) => {
                        let own = &ws.now.pressure[node * g..(node + 1) * g];
                        let fractions = self.mass_fractions(own, lane);
                        mixture.conductivity(kelvin[lane], &fractions[..g])
                    }
                    (PorousConductivity::Parallel { .. }, None) => {
                        let standing = self.solid.standing_gas.as_ref();
                        standing.map_or(0.0, |gas| gas.conductivity(kelvin[lane]))
                    }
                    (PorousConductivity::Stated, _) => 0.0,
                };
                let material = &self.solid.conductivity;
                found[lane] = law.of(material, gas, porosity[lane], kelvin[lane]);
            }
            renew(mask, &mut ws.held.conductivity[node], found);
        }
        for face in 0..n {
            self.face::<G>(face, ws);
        }
        for (lane, outside) in outside.iter().enumerate() {
            if let Some(outside) = outside
                && mask[lane] > 0.0
            {
                self.film(lane, outside, ws);
            }
        }
    }

    /// Volumes of shells and pores, and where the shells lie; the least volume of pores.
    #[inline(always)]
    pub fn measure(&self, ws: &mut RadialWorkspace) {
        let s = ws.solids;
        ws.room = Wide::all(1.0);
        for shell in 0..ws.shells {
            let amounts = &ws.now.amount[shell * s..(shell + 1) * s];
            let mut filled = Wide::default();
            for (own, amount) in self.true_volume.iter().zip(amounts) {
                filled += *amount * *own;
            }
            let mut volume = ws.first_volume[shell];
            if let Some(each) = &self.bulk_volume {
                volume = Wide::default();
                for (own, amount) in each.iter().zip(amounts) {
                    volume += *amount * *own;
                }
                volume = volume.max(Wide::all(self.share(shell, ws) * self.least_volume));
            }
            ws.held.volume[shell] = volume;
            ws.held.pores[shell] = volume - filled;
            ws.room = ws.room.min(ws.held.pores[shell]);
        }
        if ws.gases == 0 {
            ws.room = Wide::all(1.0);
        }
        if ws.taken_up || self.bulk_volume.is_some() {
            ws.held.geometry.measure(&ws.held.volume);
            ws.taken_up = false;
        }
    }

    /// Share of a shell in the volume.
    fn share(&self, shell: usize, ws: &RadialWorkspace) -> f64 {
        match ws.shells == self.shares.len() {
            true => self.shares[shell],
            false => 1.0,
        }
    }

    /// Volume of a shell and of its pores in m³ in a lane.
    pub fn volumes(&self, shell: usize, lane: usize, ws: &RadialWorkspace) -> [f64; 2] {
        let s = ws.solids;
        let mut amounts = [0.0; super::physics::MOST_SOLIDS];
        for (own, all) in amounts.iter_mut().zip(&ws.now.amount[shell * s..]).take(s) {
            *own = all[lane];
        }
        let first = ws.first_volume[shell][lane];
        let volume = self.volume(&amounts[..s], first, self.share(shell, ws));
        [volume, volume - self.filled(&amounts[..s])]
    }

    /// Mass fractions of the gases of a lane, of these partial pressures in Pa.
    fn mass_fractions(&self, pressures: &[Wide], lane: usize) -> [f64; MOST_GASES] {
        let (mut out, mut all) = ([0.0; MOST_GASES], 0.0);
        for ((out, p), mass) in out.iter_mut().zip(pressures).zip(&self.gas_mass) {
            *out = p[lane].max(0.0) * mass;
            all += *out;
        }
        out.map(|share| share / all)
    }

    /// The outer face of a shell.
    #[inline(always)]
    fn face<const G: usize>(&self, face: usize, ws: &mut RadialWorkspace) {
        let g = if G == ANY { ws.gases } else { G };
        let last = ws.shells - 1;
        let mask = ws.updating;
        let RadialWorkspace {
            held,
            now,
            flows,
            gas_capacity,
            matrix,
            broken,
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
        renew(mask, &mut held.conductance[face], conductance);
        *broken += conductance * 0.0;
        let Some(mixture) = &self.chemistry.gas else {
            renew(mask, &mut held.heat_share[face], Wide::all(0.5));
            return;
        };
        let next = (face + 1).min(last);
        let kelvin = (now.temperature[face] + now.temperature[face + 1]) * 0.5;
        let (mut pressures, mut fractions) =
            ([Wide::default(); MOST_GASES], [Wide::default(); MOST_GASES]);
        let mut drops = [Wide::default(); MOST_GASES];
        let (mut pressure, mut drop) = (Wide::default(), Wide::default());
        for (k, mean) in pressures[..g].iter_mut().enumerate() {
            let ends = [now.pressure[face * g + k], now.pressure[(face + 1) * g + k]];
            *mean = ((ends[0] + ends[1]) * 0.5).positive();
            pressure += *mean;
            drops[k] = ends[0] - ends[1];
            drop += drops[k];
        }
        let over = pressure.inverse();
        let mut walls = [Wide::default(); MOST_GASES];
        let root = kelvin.sqrt();
        for k in 0..g {
            fractions[k] = pressures[k] * over;
            walls[k] = knudsen::lanes(self.solid.pore_diameter, root, self.gas_mass[k]);
        }
        // (T/T₀)^1.75.
        let warmer = kelvin * (1.0 / PAIR_TEMPERATURE);
        let half = warmer.sqrt();
        let scale = warmer * half * half.sqrt() * over * PAIR_PRESSURE;
        let matrix = &mut matrix[..g * g];
        let pair = |i: usize, j: usize| scale * self.pairs[i * g + j];
        let (fractions, walls) = (&fractions[..g], &walls[..g]);
        let mut own = [Wide::default(); MOST_GASES];
        DustyGas.fill(fractions, walls, pair, kelvin, matrix);
        DustyGas.part(fractions, walls, pair, kelvin, matrix, &mut own);
        let [here, there] = [held.porosity[face], held.porosity[next]];
        let paths = area / ((inside / here + beyond / there) * self.solid.tortuosity);
        for (k, entry) in matrix.iter_mut().enumerate() {
            *entry = *entry * paths;
            *broken += *entry * 0.0;
            renew(mask, &mut held.drag[face * g * g + k], *entry);
        }
        for (k, own) in own[..g].iter_mut().enumerate() {
            *own = *own * paths;
            *broken += *own * 0.0;
            renew(mask, &mut held.diffusion[face * g + k], *own);
        }
        let through = |porosity: Wide| porosity.map(|own| self.solid.permeability.of(own));
        let permeable = area / (inside / through(here) + beyond / through(there));
        let viscosity = mixture.viscosity_lanes(kelvin, &pressures[..g]);
        let flow = permeable / (viscosity * kelvin * GAS_CONSTANT);
        renew(mask, &mut held.flow[face], flow);
        *broken += flow * 0.0;
        // The lower one of both pressures: no flow then follows the pressure of its gas where it goes.
        let lower = pressure - drop.abs() * 0.5;
        let mut carried = Wide::default();
        for k in 0..g {
            let mut all = flow * drop * pressure;
            for (drag, drop) in matrix[k * g..(k + 1) * g].iter().zip(&drops) {
                all += *drag * *drop;
            }
            let number = all / (own[k] * lower);
            renew(mask, &mut held.share[face * g + k], inner_share(number));
            carried += flows.gas[face * g + k] * gas_capacity[face * g + k];
        }
        let share = inner_share(carried / conductance);
        renew(mask, &mut held.heat_share[face], share);
    }

    /// The film about the particle of a lane.
    fn film(&self, lane: usize, around: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        let RadialWorkspace {
            held,
            now,
            flows,
            gas_capacity,
            ..
        } = ws;
        let radius = held.geometry.radius()[lane];
        let shrinkage = if around.radius > 0.0 {
            radius / around.radius
        } else {
            1.0
        };
        let own = around.conductance * shrinkage;
        held.film_heat[lane] = own;
        if g == 0 {
            return;
        }
        let surface = now.temperature[n][lane];
        let kelvin = around.theory.temperature.of(surface, around.temperature);
        let moles = around.pressure / (GAS_CONSTANT * kelvin);
        let mut best: f64 = 0.0;
        let mut carried = 0.0;
        for k in 0..g {
            let coefficient = around.film[k].of(kelvin) / shrinkage;
            held.film[k][lane] = held.geometry.area[n - 1][lane] * moles * coefficient;
            let face = (n - 1) * g + k;
            let fraction = (now.pressure[n * g + k][lane] / around.pressure).clamp(0.0, 1.0);
            let drag = held.drag[face * g + k][lane];
            best = best.max(held.diffusion[face][lane] + fraction * drag);
            carried += flows.film[k][lane] * gas_capacity[n * g + k][lane];
        }
        held.opening[lane] = OPENING * (held.flow[n - 1][lane] * around.pressure + best);
        if around.theory.stefan_flow != StefanFlow::None && own > 0.0 {
            held.film_heat[lane] = own * bernoulli(carried / own);
        }
    }
}

/// Any number of gases, where what is compiled for a few is not.
pub(super) const ANY: usize = usize::MAX;

/// The share of the inner node in what passes a face by a flow outwards of this Péclet number x: that of the exact solution between
/// both nodes, half of still gas and all of a fast flow, 1/(1 − e⁻ˣ) − 1/x.
#[inline(always)]
fn inner_share(number: Wide) -> Wide {
    // Of small numbers the series of it, to x¹³.
    const SERIES: [f64; 7] = [
        1.0 / 74_724_249_600.0,
        -691.0 / 1_307_674_368_000.0,
        1.0 / 47_900_160.0,
        -1.0 / 1_209_600.0,
        1.0 / 30_240.0,
        -1.0 / 720.0,
        1.0 / 12.0,
    ];
    let square = number * number;
    let mut sum = Wide::all(SERIES[0]);
    for coefficient in &SERIES[1..] {
        sum = sum * square + *coefficient;
    }
    let near = number * sum + 0.5;
    if !number.any(|x| x.abs() >= 0.5) {
        return near;
    }
    let far = (-(-number).exp() + 1.0).inverse() - number.inverse();
    number.abs().if_below(Wide::all(0.5), near, far)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn still_gas_counts_both_nodes_and_a_fast_flow_where_it_comes_from() {
        let inner_share = |number: f64| inner_share(Wide::all(number))[0];
        assert!((inner_share(0.0) - 0.5).abs() < 1e-15);
        assert!((inner_share(1e-4) - inner_share(0.99e-4)).abs() < 1e-6);
        assert!((inner_share(200.0) - 1.0).abs() < 1e-2 && inner_share(-200.0) < 1e-2);
        assert!((inner_share(-1e4) - 1e-4).abs() < 1e-15);
        // 1/(1 − e^−2) − 1/2, and of 1/2 and −0.999, with 30 digits in Python.
        for (number, exact) in [
            (2.0, 0.656_517_642_749_665_6),
            (0.5, 0.541_494_082_536_797_9),
            (-0.999, 0.418_102_623_387_996_6),
        ] {
            let found = inner_share(number);
            assert!((found - exact).abs() < 2e-15, "{number}: {found}");
        }
        let [below, above] = [0.5 - 1e-15, 0.5 + 1e-15].map(inner_share);
        assert!((below - above).abs() < 1e-14, "{below} {above}");
    }
}
