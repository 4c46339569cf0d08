//! The error of a step (docs/theory.md, XDP-18).
//!
//! It is the difference to the step of first order that the same stages give. What relaxes far faster than the step is long is next to
//! exact in the method, but not in that difference: there it is (1/γ − 1) of all that the step changed. Where temperatures differ by
//! more than their tolerance, the difference of what is conserved passes the equations of the second stage first, (I − γ h J)⁻¹,
//! which leaves what is slow as it is (Hosea and Shampine, Appl. Numer. Math. 20 (1996) 21, doi 10.1016/0168-9274(95)00115-8).

use super::attempt::GAMMA;
use super::physics::RadialPhysics;
use super::workspace::{RadialWorkspace, copy_lane};

impl RadialPhysics {
    /// How far a step is from that of first order by its own stages, over the tolerances: of the mean temperature, and of what reactions
    /// turned over.
    pub(super) fn errors(&self, lane: usize, ws: &RadialWorkspace) -> [f64; 2] {
        let (mut volume, mut off) = (0.0, 0.0);
        for shell in 0..ws.shells {
            let (start, now) = (
                ws.start.temperature[shell][lane],
                ws.now.temperature[shell][lane],
            );
            let stage = ws.first_stage.temperature[shell][lane];
            let own = ws.held.volume[shell][lane];
            volume += own;
            off += own * (now - start - (stage - start) / GAMMA).abs();
        }
        let mut turned: f64 = 0.0;
        let all: f64 = ws.unreacted.iter().map(|own| own[lane]).sum();
        let s = ws.solids;
        for k in 0..s {
            let mut sum = 0.0;
            for shell in 0..ws.shells {
                let place = shell * s + k;
                let (start, now) = (ws.start.amount[place][lane], ws.now.amount[place][lane]);
                sum += now - start - (ws.first_stage.amount[place][lane] - start) / GAMMA;
            }
            turned = turned.max(sum.abs());
        }
        let numerics = &self.numerics;
        [
            off / volume / numerics.temperature,
            turned / all / numerics.conversion,
        ]
    }

    /// Sets up a round of Newton's method about the solved second stage, of the length γ h in s by which its flows count, that begins
    /// with the difference to the step of first order on top. The solution is kept as `first_stage`.
    pub(super) fn send_error(&self, lane: usize, first: f64, ws: &mut RadialWorkspace) {
        let (n, g, r) = (ws.shells, ws.gases, ws.reactions);
        copy_lane(&mut ws.first_stage.temperature, &ws.now.temperature, lane);
        copy_lane(&mut ws.first_stage.pressure, &ws.now.pressure, lane);
        copy_lane(&mut ws.first_stage.amount, &ws.now.amount, lane);
        for shell in 0..n {
            // What the first stage changed is in the base of the second: (1 − γ)/γ of it.
            let start = ws.start_enthalpy[shell][lane];
            let first_order = (ws.base.enthalpy[shell][lane] - start) / (1.0 - GAMMA);
            ws.base.enthalpy[shell][lane] += ws.now_enthalpy[shell][lane] - start - first_order;
            // Where reactions go by the end of the step alone, there is no other step to compare them with.
            let alone = ws.base.weight[shell][lane] > first;
            for k in 0..g {
                let place = shell * g + k;
                let start = ws.start_gas[place][lane];
                let began = ws.base.gas[place][lane] - start;
                let changed = if alone {
                    began + ws.came[place][lane]
                } else {
                    ws.now_gas[place][lane] - start
                };
                ws.base.gas[place][lane] += changed - began / (1.0 - GAMMA);
            }
            for place in shell * r..(shell + 1) * r {
                let (all, second) = (ws.turned[place][lane], ws.now.extent[place][lane]);
                if !alone {
                    ws.now.extent[place][lane] -= all - (all - second) / (1.0 - GAMMA);
                }
            }
        }
    }

    /// The error of the mean temperature over its tolerance as that round found it; the solution is the iterate again.
    pub(super) fn smoothed_error(&self, lane: usize, ws: &mut RadialWorkspace) -> f64 {
        let block = 1 + ws.gases;
        let (mut volume, mut off) = (0.0, 0.0);
        for shell in 0..ws.shells {
            let own = ws.held.volume[shell][lane];
            volume += own;
            off += own * ws.right[shell * block][lane].abs();
        }
        copy_lane(&mut ws.now.temperature, &ws.first_stage.temperature, lane);
        copy_lane(&mut ws.now.pressure, &ws.first_stage.pressure, lane);
        copy_lane(&mut ws.now.amount, &ws.first_stage.amount, lane);
        off / volume / self.numerics.temperature
    }
}
