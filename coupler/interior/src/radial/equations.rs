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

use calcine_numerics::Dual;
use calcine_physics::film::bernoulli;
use calcine_physics::gas::GAS_CONSTANT;

use super::physics::RadialPhysics;
use super::rates::ShellState;
use super::transport::Outside;
use super::workspace::RadialWorkspace;

/// Where entries of the block-tridiagonal matrix stand: row of blocks, its neighbour (0 inside, 1 itself, 2 outside), row, column.
fn at(block: usize, (row, side): (usize, usize), i: usize, j: usize) -> usize {
    ((3 * row + side) * block + i) * block + j
}

impl RadialPhysics {
    /// Fills enthalpies and heat capacities at the iterate.
    pub fn properties(&self, ws: &mut RadialWorkspace) {
        let (n, s, g) = (ws.shells, ws.solids, ws.gases);
        for shell in 0..n {
            let kelvin = ws.now.temperature[shell];
            for (k, solid) in self.chemistry.solids.iter().enumerate() {
                let molar = solid.molar_mass();
                ws.solid_enthalpy[shell * s + k] =
                    solid.formation_enthalpy() + molar * solid.enthalpy(kelvin);
                ws.solid_capacity[shell * s + k] = molar * solid.heat_capacity(kelvin);
            }
        }
        let Some(gas) = &self.chemistry.gas else {
            return;
        };
        for node in 0..=n {
            let kelvin = ws.now.temperature[node];
            for (k, one) in gas.species().iter().enumerate() {
                let molar = self.gas_mass[k];
                ws.gas_enthalpy[node * g + k] =
                    self.gas_formation[k] + molar * one.enthalpy(kelvin);
                ws.gas_capacity[node * g + k] = molar * one.heat_capacity(kelvin);
            }
        }
    }

    /// Fills flows at the iterate with the coefficients as they are held.
    pub fn flows(&self, outside: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        for face in 0..n {
            let ends = face_pressures(face, ws);
            let mut enthalpy = ws.held.conductance[face]
                * (ws.now.temperature[face] - ws.now.temperature[face + 1]);
            let share = if face + 1 == n {
                0.0
            } else {
                ws.held.heat_share[face]
            };
            for k in 0..g {
                let mut flow = 0.0;
                for j in 0..g {
                    flow += ws.held.diffusion[(face * g + k) * g + j]
                        * (ws.now.pressure[face * g + j] - ws.now.pressure[(face + 1) * g + j]);
                }
                flow += carried(face, k, ends, ws)[0];
                ws.flows.gas[face * g + k] = flow;
                let own = ws.gas_enthalpy[face * g + k];
                let next = ws.gas_enthalpy[(face + 1) * g + k];
                enthalpy += flow * (share * own + (1.0 - share) * next);
            }
            ws.flows.enthalpy[face] = enthalpy;
        }
        let beyond = outside.around.pressure;
        let pressure: f64 = ws.now.pressure[n * g..].iter().sum();
        let net = ws.held.opening * (pressure - beyond);
        for k in 0..g {
            let own = ws.held.film[k];
            let number = net / own;
            let fraction = ws.now.pressure[n * g + k] / beyond;
            let gas = outside.around.fractions[k];
            ws.flows.film[k] = own * (bernoulli(-number) * fraction - bernoulli(number) * gas);
        }
    }

    /// Fills matrix and right side at the iterate, of a stage whose flows count over `length` in s.
    pub fn assemble(&self, outside: &Outside<'_>, length: f64, ws: &mut RadialWorkspace) {
        let n = ws.shells;
        ws.entries.fill(0.0);
        ws.right.fill(0.0);
        self.properties(ws);
        self.flows(outside, ws);
        for shell in 0..n {
            self.shell(shell, ws);
        }
        for face in 0..n {
            self.pass(face, length, ws);
        }
        self.surface(outside, ws);
    }

    /// What is stored in a shell, and its reactions.
    fn shell(&self, shell: usize, ws: &mut RadialWorkspace) {
        let (s, g, r) = (ws.solids, ws.gases, ws.reactions);
        let block = 1 + g;
        self.eliminate(shell, ws);
        let kelvin = ws.now.temperature[shell];
        let per_pascal = ws.held.pores[shell] / (GAS_CONSTANT * kelvin);
        let own = (shell, 1);
        let amounts = &ws.now.amount[shell * s..(shell + 1) * s];
        let mut enthalpy = -ws.base.enthalpy[shell];
        let mut capacity = 0.0;
        for (k, n) in amounts.iter().enumerate() {
            enthalpy += n * ws.solid_enthalpy[shell * s + k];
            capacity += n * ws.solid_capacity[shell * s + k];
        }
        for k in 0..g {
            let mut made = ws.base.gas[shell * g + k];
            for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
                for &(_, moles) in reaction.gases.iter().filter(|one| one.0 == k) {
                    made += moles * ws.now.extent[shell * r + j];
                }
            }
            let pressure = ws.now.pressure[shell * g + k];
            let stored = pressure * per_pascal;
            ws.right[shell * block + 1 + k] -= stored - made;
            enthalpy += made * ws.gas_enthalpy[shell * g + k];
            capacity += made * ws.gas_capacity[shell * g + k];
            ws.entries[at(block, own, 1 + k, 0)] -= stored / kelvin;
            ws.entries[at(block, own, 1 + k, 1 + k)] += per_pascal;
        }
        ws.right[shell * block] -= enthalpy;
        ws.entries[at(block, own, 0, 0)] += capacity;
        for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
            let place = shell * r + j;
            let mut heat = 0.0;
            for &(k, moles) in &reaction.solids {
                heat += moles * ws.solid_enthalpy[shell * s + k];
            }
            for &(k, moles) in &reaction.gases {
                heat += moles * ws.gas_enthalpy[shell * g + k];
            }
            let (rest, by_temperature) = (ws.extent_rest[place], ws.extent_by_temperature[place]);
            let by_pressure = &ws.extent_by_pressure[place * g..(place + 1) * g];
            ws.right[shell * block] -= heat * rest;
            ws.entries[at(block, own, 0, 0)] += heat * by_temperature;
            for (h, by) in by_pressure.iter().enumerate() {
                ws.entries[at(block, own, 0, 1 + h)] += heat * by;
            }
            let opens = self.opens[j] / (GAS_CONSTANT * kelvin);
            for k in 0..g {
                let moles: f64 = reaction
                    .gases
                    .iter()
                    .filter(|one| one.0 == k)
                    .map(|one| one.1)
                    .sum();
                let effect = ws.now.pressure[shell * g + k] * opens - moles;
                if effect == 0.0 {
                    continue;
                }
                ws.right[shell * block + 1 + k] -= effect * rest;
                ws.entries[at(block, own, 1 + k, 0)] += effect * by_temperature;
                for (h, by) in by_pressure.iter().enumerate() {
                    ws.entries[at(block, own, 1 + k, 1 + h)] += effect * by;
                }
            }
        }
    }

    /// Takes the extents of a shell out of its linear equations: δξ = rest + (by T) δT + (by p) δp.
    fn eliminate(&self, shell: usize, ws: &mut RadialWorkspace) {
        let (s, g, r) = (ws.solids, ws.gases, ws.reactions);
        let width = r + 2 + g;
        let weight = ws.base.weight[shell];
        let state = ShellState {
            temperature: ws.now.temperature[shell],
            pressures: &ws.now.pressure[shell * g..(shell + 1) * g],
            amounts: &ws.now.amount[shell * s..(shell + 1) * s],
            first: &ws.unreacted[shell * s..(shell + 1) * s],
            volume: ws.held.volume[shell],
        };
        for j in 0..r {
            self.rate(j, &state, &mut ws.rate);
            let row = &mut ws.small[j * width..(j + 1) * width];
            for (i, reaction) in self.chemistry.reactions.iter().enumerate() {
                let slope: f64 = reaction
                    .solids
                    .iter()
                    .map(|&(k, n)| n * ws.rate.by_amount[k])
                    .sum();
                row[i] = f64::from(u8::from(i == j)) - weight * slope;
            }
            row[r] = weight * ws.rate.value - ws.now.extent[shell * r + j];
            row[r + 1] = weight * ws.rate.by_temperature;
            for h in 0..g {
                row[r + 2 + h] = weight * ws.rate.by_pressure[h];
            }
        }
        reduce(&mut ws.small[..r * width], r, width);
        for j in 0..r {
            let row = &ws.small[j * width..(j + 1) * width];
            let place = shell * r + j;
            ws.extent_rest[place] = row[r];
            ws.extent_by_temperature[place] = row[r + 1];
            ws.extent_by_pressure[place * g..(place + 1) * g].copy_from_slice(&row[r + 2..]);
        }
    }

    /// What passes the outer face of a shell.
    fn pass(&self, face: usize, length: f64, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        let block = 1 + g;
        let last = face + 1 == n;
        let inner = |side: usize, i, j| at(block, (face, side), i, j);
        let outer = |side: usize, i, j| at(block, (face + 1, side), i, j);
        // The surface stores nothing: its balance is of rates.
        let beyond = if last { 1.0 } else { length };
        let conductance = ws.held.conductance[face];
        let heat = conductance * (ws.now.temperature[face] - ws.now.temperature[face + 1]);
        ws.right[face * block] -= length * heat;
        ws.right[(face + 1) * block] += beyond * heat;
        ws.entries[inner(1, 0, 0)] += length * conductance;
        ws.entries[inner(2, 0, 0)] -= length * conductance;
        ws.entries[outer(1, 0, 0)] += beyond * conductance;
        ws.entries[outer(0, 0, 0)] -= beyond * conductance;
        let ends = face_pressures(face, ws);
        let share = if last { 0.0 } else { ws.held.heat_share[face] };
        for k in 0..g {
            let flow = ws.flows.gas[face * g + k];
            ws.right[face * block + 1 + k] -= length * flow;
            ws.right[(face + 1) * block + 1 + k] += beyond * flow;
            // What passes is of the enthalpy h = s h_i + (1 − s) h_o, of which h_i, and h_o, is in the balance of gas.
            let step = ws.gas_enthalpy[(face + 1) * g + k] - ws.gas_enthalpy[face * g + k];
            let (more, less) = ((1.0 - share) * step, -share * step);
            ws.right[face * block] -= length * flow * more;
            ws.entries[inner(1, 0, 0)] -=
                length * flow * (1.0 - share) * ws.gas_capacity[face * g + k];
            ws.entries[inner(2, 0, 0)] +=
                length * flow * (1.0 - share) * ws.gas_capacity[(face + 1) * g + k];
            if !last {
                ws.right[(face + 1) * block] += length * flow * less;
                ws.entries[outer(1, 0, 0)] +=
                    length * flow * share * ws.gas_capacity[(face + 1) * g + k];
                ws.entries[outer(0, 0, 0)] -= length * flow * share * ws.gas_capacity[face * g + k];
            }
            let [_, by_here, by_there, own_here, own_there] = carried(face, k, ends, ws);
            for j in 0..g {
                let diffusive = ws.held.diffusion[(face * g + k) * g + j];
                let own = f64::from(u8::from(j == k));
                let here = diffusive + by_here + own * own_here;
                let there = -diffusive + by_there + own * own_there;
                ws.entries[inner(1, 1 + k, 1 + j)] += length * here;
                ws.entries[inner(2, 1 + k, 1 + j)] += length * there;
                ws.entries[outer(0, 1 + k, 1 + j)] -= beyond * here;
                ws.entries[outer(1, 1 + k, 1 + j)] -= beyond * there;
                ws.entries[inner(1, 0, 1 + j)] += length * more * here;
                ws.entries[inner(2, 0, 1 + j)] += length * more * there;
                if !last {
                    ws.entries[outer(0, 0, 1 + j)] -= length * less * here;
                    ws.entries[outer(1, 0, 1 + j)] -= length * less * there;
                }
            }
        }
    }

    /// What passes from the surface through the film, and to it from contacts and radiation.
    fn surface(&self, outside: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        let block = 1 + g;
        let own = (n, 1);
        let film = ws.held.film_heat;
        let received = film * (outside.around.temperature - ws.now.temperature[n]) + outside.heat;
        ws.right[n * block] += received;
        ws.entries[at(block, own, 0, 0)] += film;
        let beyond = outside.around.pressure;
        let pressure: f64 = ws.now.pressure[n * g..(n + 1) * g].iter().sum();
        let net = ws.held.opening * (pressure - beyond);
        for k in 0..g {
            ws.right[n * block + 1 + k] -= ws.flows.film[k];
            let number = Dual::<1>::along(net / ws.held.film[k], 0);
            let fraction = ws.now.pressure[n * g + k] / beyond;
            let (away, back) = (bernoulli(-number), bernoulli(number));
            let gas = outside.around.fractions[k];
            // A c β ∂φ = L ∂p.
            let by_net = (away.slope[0] * fraction - back.slope[0] * gas) * ws.held.opening;
            for j in 0..g {
                ws.entries[at(block, own, 1 + k, 1 + j)] += by_net;
            }
            ws.entries[at(block, own, 1 + k, 1 + k)] += ws.held.film[k] * away.value / beyond;
        }
    }
}

/// Pressures in Pa at both nodes of a face.
pub(super) fn face_pressures(face: usize, ws: &RadialWorkspace) -> [f64; 2] {
    let g = ws.gases;
    [face, face + 1].map(|node| ws.now.pressure[node * g..(node + 1) * g].iter().sum())
}

/// What of a gas flows through a face by the pressures at its ends, F (p_i² − p_o²)/2 x in mol/s with the mole fraction x between both;
/// its changes with the pressures of all gases alike inside and outside, and what comes on top with that of its own.
pub(super) fn carried(
    face: usize,
    gas: usize,
    [here, there]: [f64; 2],
    ws: &RadialWorkspace,
) -> [f64; 5] {
    let g = ws.gases;
    let weight = ws.held.share[face * g + gas];
    let one = ws.now.pressure[face * g + gas] / here;
    let other = ws.now.pressure[(face + 1) * g + gas] / there;
    let fraction = weight * one + (1.0 - weight) * other;
    let (flow, square) = (ws.held.flow[face], 0.5 * (here + there) * (here - there));
    let own_here = flow * square * weight / here;
    let own_there = flow * square * (1.0 - weight) / there;
    [
        flow * square * fraction,
        flow * here * fraction - own_here * one,
        -flow * there * fraction - own_there * other,
        own_here,
        own_there,
    ]
}

/// Brings the first `r` columns of `r` rows to one: Gauss and Jordan, with row pivots.
fn reduce(rows: &mut [f64], r: usize, width: usize) {
    for k in 0..r {
        let size = |row: usize| rows[row * width + k].abs();
        let best = (k..r).fold(
            k,
            |best, row| if size(row) > size(best) { row } else { best },
        );
        if best != k {
            for column in 0..width {
                rows.swap(k * width + column, best * width + column);
            }
        }
        let inverse = 1.0 / rows[k * width + k];
        for column in k..width {
            rows[k * width + column] *= inverse;
        }
        for row in (0..r).filter(|row| *row != k) {
            let share = rows[row * width + k];
            if share != 0.0 {
                for column in k..width {
                    rows[row * width + column] -= share * rows[k * width + column];
                }
            }
        }
    }
}
