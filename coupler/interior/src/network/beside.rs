//! What the surfaces of particles are beside, and the heat that passed by their means (docs/theory.md, THP-4).
//!
//! A particle that follows the network by steps of its own sees what is beyond its contacts and views at its mean over the span, and
//! its own surface as it goes. Then heat is booked by the means of both, which is what it took where the others came to what they were
//! taken to be.

use std::mem;

use super::HeatNetwork;
use crate::model::{NetworkHeat, SurfaceMean, SurfaceNetwork};

/// Difference in K between surfaces whose heat counts as none.
const FAINT: f64 = 1e-3;

impl HeatNetwork {
    /// What each particle is told of its heat over a span, after it is solved.
    pub fn told(&self, out: &mut Vec<NetworkHeat>) {
        let count = self.heat.len();
        let work = &self.work;
        out.clear();
        out.extend(self.heat.iter().map(|&mean| NetworkHeat {
            mean,
            beside: Some(SurfaceNetwork::default()),
        }));
        let mut add = |row: usize, part: SurfaceNetwork| {
            let own = out[row].beside.get_or_insert_default();
            own.conductance += part.conductance;
            own.conducted += part.conducted;
            own.area += part.area;
            own.seen += part.seen;
        };
        let touch = |conductance: f64, other: f64| SurfaceNetwork {
            conductance,
            conducted: conductance * other,
            ..Default::default()
        };
        let see = |area: f64, other: f64| SurfaceNetwork {
            area,
            seen: area * other.powi(4),
            ..Default::default()
        };
        for &([i, j], g) in &work.bonds[..work.solid] {
            add(i, touch(g, work.temperature[j]));
            add(j, touch(g, work.temperature[i]));
        }
        for &([i, reservoir], g) in &work.reservoir_links[..work.walled] {
            add(i, touch(g, work.reservoirs[reservoir]));
        }
        let shift = work.nodes - count;
        for ([i, j], area) in self.radiation.pairs() {
            add(i, see(area, work.seen[j + shift]));
            add(j, see(area, work.seen[i + shift]));
        }
        for ([i, reservoir], area) in self.radiation.links() {
            add(i, see(area, work.reservoirs[reservoir]));
        }
        if shift > 0 {
            // The radiosity, which stores nothing, is eliminated.
            for (row, told) in out.iter_mut().enumerate() {
                let own = told.beside.get_or_insert_default();
                let share = self.radiation.own(row);
                let share = share / (share + own.area);
                own.area *= share;
                own.seen *= share;
            }
        }
    }

    /// Books the heat anew by the means of the surfaces of those particles that followed what they were `told`. The result is how much
    /// of it they did not take, as a share of all.
    pub fn book_means(&mut self, means: &[Option<SurfaceMean>], told: &[NetworkHeat]) -> f64 {
        if means.iter().all(Option::is_none) {
            return 0.0;
        }
        let count = self.heat.len();
        let Self {
            work,
            radiation,
            heat,
            reservoir_heat,
            warmer,
            ..
        } = self;
        warmer.clear();
        warmer.resize(count, 0.0);
        let shift = work.nodes - count;
        // Temperatures of surfaces, and fourth powers where they radiate, by means where there are some.
        let (mut kelvin, mut shines) = (mem::take(&mut work.kelvin), mem::take(&mut work.shines));
        kelvin.clear();
        kelvin.extend_from_slice(&work.temperature[..count]);
        shines.clear();
        let seen = work.seen[shift..shift + count].iter();
        shines.extend(seen.map(|kelvin| kelvin.powi(4)));
        for (row, mean) in means.iter().enumerate() {
            let (Some(mean), Some(beside)) = (mean, told[row].beside) else {
                continue;
            };
            kelvin[row] = mean.temperature;
            warmer[row] = mean.fourth_power.powf(0.25) - mean.temperature;
            shines[row] = mean.fourth_power;
            if shift > 0 && beside.area > 0.0 {
                // Of what the surface emits and of what it reflects: A e/(1 − e) to its own, the rest to what it sees.
                let through = beside.area / radiation.own(row);
                shines[row] += through * (beside.seen / beside.area - mean.fourth_power);
            }
        }
        heat.fill(0.0);
        reservoir_heat.fill(0.0);
        let mut all = 0.0;
        let mut pass = |[i, j]: [usize; 2], flow: f64| {
            heat[i] += flow;
            heat[j] -= flow;
            all += flow.abs();
        };
        for &(pair, g) in &work.bonds[..work.solid] {
            pass(pair, g * (kelvin[pair[1]] - kelvin[pair[0]]));
        }
        let sigma = calcine_physics::radiation::STEFAN_BOLTZMANN;
        for (pair, area) in radiation.pairs() {
            pass(pair, sigma * area * (shines[pair[1]] - shines[pair[0]]));
        }
        let contacts = work.reservoir_links[..work.walled].iter();
        let contacts = contacts.map(|&([row, reservoir], g)| {
            let flow = g * (work.reservoirs[reservoir] - kelvin[row]);
            ([row, reservoir], flow)
        });
        let views = radiation.links().map(|([row, reservoir], area)| {
            let beyond = work.reservoirs[reservoir].powi(4);
            ([row, reservoir], sigma * area * (beyond - shines[row]))
        });
        for ([row, reservoir], flow) in contacts.chain(views) {
            heat[row] += flow;
            reservoir_heat[reservoir] += flow;
            all += flow.abs();
        }
        (work.kelvin, work.shines) = (kelvin, shines);
        let mut apart = 0.0;
        for (row, mean) in means.iter().enumerate() {
            if let (Some(mean), Some(beside)) = (mean, told[row].beside) {
                let took = beside.heat(mean.temperature, mean.fourth_power);
                apart += (heat[row] - took).abs();
                all += FAINT * beside.slope(mean.temperature);
            }
        }
        if all > 0.0 { apart / all } else { 0.0 }
    }
}
