//! What the surfaces of particles are beside, and the heat that passed by their means (docs/theory.md, THP-4).
//!
//! A particle that follows the network by steps of its own sees what is beyond its contacts and views at its mean over the span, and
//! its own surface as it goes. Then heat is booked by the means of both, which is what it took where the others came to what they were
//! taken to be.

use super::HeatNetwork;
use crate::model::{NetworkHeat, SurfaceMean, SurfaceNetwork};

/// Difference in K between surfaces whose heat counts as none.
const FAINT: f64 = 1e-3;

impl HeatNetwork {
    /// What each particle is told of its heat over a span, after it is solved.
    pub fn told(&self, out: &mut Vec<NetworkHeat>) {
        let count = self.heat.len();
        let work = &self.work;
        let mut beside = vec![SurfaceNetwork::default(); count];
        for &([i, j], g) in &work.bonds[..work.solid] {
            for (own, other) in [(i, j), (j, i)] {
                beside[own].conductance += g;
                beside[own].conducted += g * work.temperature[other];
            }
        }
        for &([i, reservoir], g) in &work.reservoir_links[..work.walled] {
            beside[i].conductance += g;
            beside[i].conducted += g * work.reservoirs[reservoir];
        }
        let shift = work.nodes - count;
        for ([i, j], area) in self.radiation.pairs() {
            for (own, other) in [(i, j), (j, i)] {
                beside[own].area += area;
                beside[own].seen += area * work.seen[other + shift].powi(4);
            }
        }
        for ([i, reservoir], area) in self.radiation.links() {
            beside[i].area += area;
            beside[i].seen += area * work.reservoirs[reservoir].powi(4);
        }
        if shift > 0 {
            // The radiosity, which stores nothing, is eliminated.
            for (row, own) in beside.iter_mut().enumerate() {
                let share = self.radiation.own(row);
                let share = share / (share + own.area);
                own.area *= share;
                own.seen *= share;
            }
        }
        out.clear();
        let all = self.heat.iter().zip(beside);
        out.extend(all.map(|(mean, beside)| NetworkHeat {
            mean: *mean,
            beside: Some(beside),
        }));
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
        let mut kelvin = work.temperature[..count].to_vec();
        let mut shines: Vec<f64> = work.seen[shift..shift + count]
            .iter()
            .map(|kelvin| kelvin.powi(4))
            .collect();
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
