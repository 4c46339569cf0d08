//! The equations of a stage: what is left of the balances of shells and surface at an iterate, and their derivatives
//! (docs/theory.md, XDP-1 to XDP-6, XDP-18).
//!
//! With the base b of a stage and the length a of its step, each shell has
//!
//! p_g V_p/(R T) − b_g − Σ_j ν_gj ξ_j + a (N_g,out − N_g,in) = 0,   ξ_j − a r_j(T, p, n) = 0,   n_s = b_s + Σ_j ν_sj ξ_j,
//! H(T, n_s, n_g) − b_H + a (E_out − E_in) = 0,   E = Q + Σ_g N_g h_g.
//!
//! The extents ξ are eliminated shell by shell from the linear equations of an iteration, not by themselves: however fast a reaction,
//! n and what drives it both move, as a product that is small. The balance of enthalpy less those of the gases times their enthalpies is
//! one of heat: c_p ∂T, the heat of reaction, and what differs in temperature.

use calcine_numerics::linear::eliminate;
use calcine_numerics::{Dual, Number};
use calcine_physics::film::bernoulli;
use calcine_physics::gas::GAS_CONSTANT;

use super::instant::{ReactingEnthalpies, ShellStores};
use super::physics::RadialPhysics;
use super::rates::ShellState;
use super::side_by_side::Wide;
use super::transport::{ANY, Outside, OutsideLanes};
use super::workspace::RadialWorkspace;

/// Where entries of the block-tridiagonal matrix stand: row of blocks, its neighbour (0 inside, 1 itself, 2 outside), row, column.
#[inline(always)]
fn at(block: usize, (row, side): (usize, usize), i: usize, j: usize) -> usize {
    ((3 * row + side) * block + i) * block + j
}

impl RadialPhysics {
    /// Fills enthalpies and heat capacities at the iterate.
    #[inline(always)]
    pub fn properties<const G: usize>(&self, ws: &mut RadialWorkspace) {
        let (n, s) = (ws.shells, ws.solids);
        let g = if G == ANY { ws.gases } else { G };
        for shell in 0..n {
            let kelvin = ws.now.temperature[shell];
            for (k, solid) in self.chemistry.solids.iter().enumerate() {
                [
                    ws.solid_capacity[shell * s + k],
                    ws.solid_enthalpy[shell * s + k],
                ] = solid.molar_lanes(kelvin);
            }
        }
        let gases = self
            .chemistry
            .gas
            .as_ref()
            .map_or(&[][..], |gas| gas.species());
        for node in 0..=n {
            let kelvin = ws.now.temperature[node];
            for (k, one) in gases.iter().enumerate().take(g) {
                [ws.gas_capacity[node * g + k], ws.gas_enthalpy[node * g + k]] =
                    one.polynomial().lanes(kelvin);
            }
        }
        if ws.fresh.any(|fresh| fresh > 0.0) {
            self.start_enthalpy(ws);
        }
    }

    /// Enthalpies of shells at the start, which is the iterate, in the lanes where they are not known.
    #[inline(always)]
    fn start_enthalpy(&self, ws: &mut RadialWorkspace) {
        let (s, g) = (ws.solids, ws.gases);
        for shell in 0..ws.shells {
            let mut sum = Wide::default();
            for k in shell * s..(shell + 1) * s {
                sum += ws.start.amount[k] * ws.solid_enthalpy[k];
            }
            for k in shell * g..(shell + 1) * g {
                sum += ws.start_gas[k] * ws.gas_enthalpy[k];
            }
            for own in [&mut ws.start_enthalpy[shell], &mut ws.base.enthalpy[shell]] {
                *own = ws.fresh.if_positive(sum, *own);
            }
        }
        ws.fresh = Wide::default();
    }

    /// Fills matrix and right side at the iterate, of stages whose flows count over `ws.length`.
    #[inline(always)]
    pub fn assemble<const G: usize>(&self, outside: &OutsideLanes<'_>, ws: &mut RadialWorkspace) {
        let n = ws.shells;
        ws.entries.fill(Wide::default());
        ws.right.fill(Wide::default());
        for shell in 0..n {
            self.shell::<G>(shell, ws);
        }
        for face in 0..n {
            self.pass::<G>(face, ws);
        }
        for (lane, outside) in outside.iter().enumerate() {
            if let Some(outside) = outside {
                self.surface(lane, outside, ws);
            }
        }
    }

    /// What is stored in a shell, and its reactions.
    #[inline(always)]
    fn shell<const G: usize>(&self, shell: usize, ws: &mut RadialWorkspace) {
        let (s, r) = (ws.solids, ws.reactions);
        let g = if G == ANY { ws.gases } else { G };
        let block = 1 + g;
        self.eliminate::<G>(shell, ws);
        let kelvin = ws.now.temperature[shell];
        let over = kelvin.inverse();
        let per_pascal = ws.held.pores[shell] * over * (1.0 / GAS_CONSTANT);
        let own = (shell, 1);
        let mut enthalpy = -ws.base.enthalpy[shell];
        let mut capacity = Wide::default();
        for k in shell * s..(shell + 1) * s {
            enthalpy += ws.now.amount[k] * ws.solid_enthalpy[k];
            capacity += ws.now.amount[k] * ws.solid_capacity[k];
        }
        for k in 0..g {
            let mut made = ws.base.gas[shell * g + k];
            for j in 0..r {
                made += ws.now.extent[shell * r + j] * self.gas_moles[j * g + k];
            }
            let pressure = ws.now.pressure[shell * g + k];
            let stored = pressure * per_pascal;
            ws.right[shell * block + 1 + k] -= stored - made;
            enthalpy += made * ws.gas_enthalpy[shell * g + k];
            capacity += made * ws.gas_capacity[shell * g + k];
            ws.entries[at(block, own, 1 + k, 0)] -= stored * over;
            ws.entries[at(block, own, 1 + k, 1 + k)] += per_pascal;
        }
        ws.right[shell * block] -= enthalpy;
        ws.entries[at(block, own, 0, 0)] += capacity;
        for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
            let place = shell * r + j;
            let mut heat = Wide::default();
            for &(k, moles) in &reaction.solids {
                heat += ws.solid_enthalpy[shell * s + k] * moles;
            }
            for &(k, moles) in &reaction.gases {
                heat += ws.gas_enthalpy[shell * g + k] * moles;
            }
            let (rest, by_temperature) = (ws.extent_rest[place], ws.extent_by_temperature[place]);
            ws.right[shell * block] -= heat * rest;
            ws.entries[at(block, own, 0, 0)] += heat * by_temperature;
            for h in 0..g {
                let by = ws.extent_by_pressure[place * g + h];
                ws.entries[at(block, own, 0, 1 + h)] += heat * by;
            }
            let opens = over * (self.opens[j] / GAS_CONSTANT);
            for k in 0..g {
                let moles = self.gas_moles[j * g + k];
                let effect = ws.now.pressure[shell * g + k] * opens - Wide::all(moles);
                ws.right[shell * block + 1 + k] -= effect * rest;
                ws.entries[at(block, own, 1 + k, 0)] += effect * by_temperature;
                for h in 0..g {
                    let by = ws.extent_by_pressure[place * g + h];
                    ws.entries[at(block, own, 1 + k, 1 + h)] += effect * by;
                }
            }
        }
    }

    /// What a shell and its faces hold of gases and heat in a stage.
    #[inline(always)]
    fn stores<const G: usize>(&self, shell: usize, ws: &RadialWorkspace) -> ShellStores {
        let s = ws.solids;
        let g = if G == ANY { ws.gases } else { G };
        let per_pascal =
            ws.held.pores[shell] * ws.now.temperature[shell].inverse() * (1.0 / GAS_CONSTANT);
        let mut all = ShellStores::default();
        for (k, own) in all.gas.iter_mut().enumerate().take(g) {
            let mut passes = ws.held.diffusion[shell * g + k];
            if shell > 0 {
                passes += ws.held.diffusion[(shell - 1) * g + k];
            }
            *own = per_pascal + ws.length * passes;
        }
        for k in shell * s..(shell + 1) * s {
            all.heat += ws.now.amount[k] * ws.solid_capacity[k];
        }
        all.heat += ws.length * ws.held.conductance[shell];
        all
    }

    /// Takes the extents of a shell out of its linear equations: δξ = rest + (by T) δT + (by p) δp.
    #[inline(always)]
    fn eliminate<const G: usize>(&self, shell: usize, ws: &mut RadialWorkspace) {
        let (s, r) = (ws.solids, ws.reactions);
        let g = if G == ANY { ws.gases } else { G };
        let width = r + 2 + g;
        let weight = ws.base.weight[shell];
        let stores = self.stores::<G>(shell, ws);
        let state = ShellState {
            temperature: ws.now.temperature[shell],
            pressures: &ws.now.pressure[shell * g..(shell + 1) * g],
            amounts: &ws.now.amount[shell * s..(shell + 1) * s],
            first: &ws.unreacted[shell * s..(shell + 1) * s],
            volume: ws.held.volume[shell],
        };
        for j in 0..r {
            self.rate(j, &state, &mut ws.rate);
            let enthalpies = ReactingEnthalpies {
                solids: &ws.solid_enthalpy[shell * s..(shell + 1) * s],
                gases: &ws.gas_enthalpy[shell * g..(shell + 1) * g],
            };
            self.tame(j, &state, weight, (&stores, &enthalpies), &mut ws.rate);
            let row = &mut ws.small[j * width..(j + 1) * width];
            for (i, reaction) in self.chemistry.reactions.iter().enumerate() {
                let mut slope = Wide::default();
                for &(k, n) in &reaction.solids {
                    slope += ws.rate.by_amount[k] * n;
                }
                row[i] = -(weight * slope) + f64::from(u8::from(i == j));
            }
            row[r] = weight * ws.rate.value - ws.now.extent[shell * r + j];
            row[r + 1] = weight * ws.rate.by_temperature;
            for h in 0..g {
                row[r + 2 + h] = weight * ws.rate.by_pressure[h];
            }
        }
        eliminate(&mut ws.small[..r * width], r, width);
        for j in 0..r {
            let row = &ws.small[j * width..(j + 1) * width];
            let place = shell * r + j;
            ws.extent_rest[place] = row[r];
            ws.extent_by_temperature[place] = row[r + 1];
            for h in 0..g {
                ws.extent_by_pressure[place * g + h] = row[r + 2 + h];
            }
        }
    }

    /// What passes the outer face of a shell.
    #[inline(always)]
    fn pass<const G: usize>(&self, face: usize, ws: &mut RadialWorkspace) {
        let n = ws.shells;
        let g = if G == ANY { ws.gases } else { G };
        let block = 1 + g;
        let last = face + 1 == n;
        let inner = |side: usize, i, j| at(block, (face, side), i, j);
        let outer = |side: usize, i, j| at(block, (face + 1, side), i, j);
        let length = ws.length;
        // The surface stores nothing: its balance is of rates.
        let beyond = if last { Wide::all(1.0) } else { length };
        let conductance = ws.held.conductance[face];
        let heat = conductance * (ws.now.temperature[face] - ws.now.temperature[face + 1]);
        ws.right[face * block] -= length * heat;
        ws.right[(face + 1) * block] += beyond * heat;
        ws.entries[inner(1, 0, 0)] += length * conductance;
        ws.entries[inner(2, 0, 0)] -= length * conductance;
        ws.entries[outer(1, 0, 0)] += beyond * conductance;
        ws.entries[outer(0, 0, 0)] -= beyond * conductance;
        if g == 0 {
            return;
        }
        let through = FaceFlow::of::<G>(face, ws);
        let share = if last {
            Wide::default()
        } else {
            ws.held.heat_share[face]
        };
        let rest = -share + 1.0;
        for k in 0..g {
            let carried = through.carried::<G>(face, k, ws);
            let diffusion = ws.held.diffusion[face * g + k];
            let drop = ws.now.pressure[face * g + k] - ws.now.pressure[(face + 1) * g + k];
            let flow = diffusion * drop + carried.flow;
            ws.flows.gas[face * g + k] = flow;
            ws.right[face * block + 1 + k] -= length * flow;
            ws.right[(face + 1) * block + 1 + k] += beyond * flow;
            // What passes is of the enthalpy h = s h_i + (1 − s) h_o, of which h_i, and h_o, is in the balance of gas.
            let step = ws.gas_enthalpy[(face + 1) * g + k] - ws.gas_enthalpy[face * g + k];
            let (more, less) = (length * rest * step, -(length * share * step));
            ws.right[face * block] -= flow * more;
            let brings = [face, face + 1].map(|node| length * flow * ws.gas_capacity[node * g + k]);
            ws.entries[inner(1, 0, 0)] -= rest * brings[0];
            ws.entries[inner(2, 0, 0)] += rest * brings[1];
            if !last {
                ws.right[(face + 1) * block] += flow * less;
                ws.entries[outer(1, 0, 0)] += share * brings[1];
                ws.entries[outer(0, 0, 0)] -= share * brings[0];
            }
            for j in 0..g {
                let dragged = ws.held.drag[(face * g + k) * g + j] * carried.fraction;
                let (mut here, mut there) = (dragged + carried.by_here, carried.by_there - dragged);
                if j == k {
                    here += diffusion + carried.own_here;
                    there += carried.own_there - diffusion;
                }
                ws.entries[inner(1, 1 + k, 1 + j)] += length * here;
                ws.entries[inner(2, 1 + k, 1 + j)] += length * there;
                ws.entries[outer(0, 1 + k, 1 + j)] -= beyond * here;
                ws.entries[outer(1, 1 + k, 1 + j)] -= beyond * there;
                ws.entries[inner(1, 0, 1 + j)] += more * here;
                ws.entries[inner(2, 0, 1 + j)] += more * there;
                if !last {
                    ws.entries[outer(0, 0, 1 + j)] -= less * here;
                    ws.entries[outer(1, 0, 1 + j)] -= less * there;
                }
            }
        }
    }

    /// What passes from the surface of a lane through the film, and to it from contacts and radiation.
    fn surface(&self, lane: usize, outside: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        let block = 1 + g;
        let own = (n, 1);
        let film = ws.held.film_heat[lane];
        let kelvin = ws.now.temperature[n][lane];
        ws.right[n * block][lane] += film * (outside.temperature - kelvin) + outside.heat;
        ws.entries[at(block, own, 0, 0)][lane] += film;
        if ws.alone[lane] == 0.0 {
            let beside = &outside.beside;
            ws.right[n * block][lane] += beside.heat(kelvin, kelvin.powi(4));
            ws.entries[at(block, own, 0, 0)][lane] += beside.slope(kelvin);
        }
        let net = net_flow(lane, outside, ws);
        let opening = ws.held.opening[lane];
        for k in 0..g {
            let coefficient = ws.held.film[k][lane];
            let number = Dual::<1>::along(net / coefficient, 0);
            let fraction = ws.now.pressure[n * g + k][lane] / outside.pressure;
            let (away, back) = (bernoulli(-number), bernoulli(number));
            let gas = outside.fractions[k];
            let flow = away.times(fraction) - back.times(gas);
            ws.flows.film[k][lane] = coefficient * flow.value;
            ws.right[n * block + 1 + k][lane] -= coefficient * flow.value;
            // A c β ∂φ = L ∂p.
            for j in 0..g {
                ws.entries[at(block, own, 1 + k, 1 + j)][lane] += flow.slope[0] * opening;
            }
            ws.entries[at(block, own, 1 + k, 1 + k)][lane] +=
                coefficient * away.value / outside.pressure;
        }
    }
}

/// What flows by pressure through the film in mol/s.
pub(super) fn net_flow(lane: usize, outside: &Outside<'_>, ws: &RadialWorkspace) -> f64 {
    let (n, g) = (ws.shells, ws.gases);
    let surface = ws.now.pressure[n * g..].iter();
    let pressure: f64 = surface.map(|own| own[lane]).sum();
    ws.held.opening[lane] * (pressure - outside.pressure)
}

/// A face through which gas flows by pressure: the pressures at both nodes in Pa, ones over them, and (p_i² − p_o²)/2.
pub(super) struct FaceFlow {
    ends: [Wide; 2],
    over: [Wide; 2],
    square: Wide,
}

/// What is carried of a gas through a face in mol/s, by the flow by pressure and by the drag of the other gases, and its mole fraction between
/// both nodes; its changes with the pressures of all gases alike inside and outside but for the drag's, and what comes on top with that of
/// its own.
pub(super) struct CarriedGas {
    pub flow: Wide,
    pub fraction: Wide,
    pub by_here: Wide,
    pub by_there: Wide,
    pub own_here: Wide,
    pub own_there: Wide,
}

impl FaceFlow {
    #[inline(always)]
    pub fn of<const G: usize>(face: usize, ws: &RadialWorkspace) -> Self {
        let g = if G == ANY { ws.gases } else { G };
        let mut ends = [Wide::default(); 2];
        for k in 0..g {
            ends[0] += ws.now.pressure[face * g + k];
            ends[1] += ws.now.pressure[(face + 1) * g + k];
        }
        Self {
            ends,
            over: ends.map(Wide::inverse),
            square: (ends[0] + ends[1]) * (ends[0] - ends[1]) * 0.5,
        }
    }

    /// (F (p_i² − p_o²)/2 + Σ_k d_k Δp_k) x with the mole fraction x of a gas between both nodes.
    #[inline(always)]
    pub fn carried<const G: usize>(
        &self,
        face: usize,
        gas: usize,
        ws: &RadialWorkspace,
    ) -> CarriedGas {
        let g = if G == ANY { ws.gases } else { G };
        let weight = ws.held.share[face * g + gas];
        let rest = -weight + 1.0;
        let one = ws.now.pressure[face * g + gas] * self.over[0];
        let other = ws.now.pressure[(face + 1) * g + gas] * self.over[1];
        let fraction = weight * one + rest * other;
        let flow = ws.held.flow[face];
        let mut all = flow * self.square;
        for j in 0..g {
            let drop = ws.now.pressure[face * g + j] - ws.now.pressure[(face + 1) * g + j];
            all += ws.held.drag[(face * g + gas) * g + j] * drop;
        }
        let own_here = all * weight * self.over[0];
        let own_there = all * rest * self.over[1];
        CarriedGas {
            flow: all * fraction,
            fraction,
            by_here: flow * self.ends[0] * fraction - own_here * one,
            by_there: -(flow * self.ends[1] * fraction) - own_there * other,
            own_here,
            own_there,
        }
    }
}
