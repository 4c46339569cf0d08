//! From the first stage of a step to the second (docs/theory.md, XDP-18).

use super::attempt::{GAMMA, ONWARDS};
use super::physics::{MOST_SOLIDS, RadialPhysics};
use super::workspace::{RadialWorkspace, fill_lane};

/// Share of an amount of the first stage that the second one must begin with; below it the reactions of the shell go by the end of the step alone.
const BEGINS_WITH: f64 = 0.1;
/// Share of the solids of a shell that a step must turn over for it to count.
const COUNTS: f64 = 1e-6;
/// Share of a temperature and of a pressure by which the first guess of the second stage goes beyond the first stage at most.
const GUESS_WARMED: f64 = 0.05;
const GUESS_PRESSURE: f64 = 0.5;

impl RadialPhysics {
    /// The base of the second stage; how many shells go by the end of the step alone.
    pub(super) fn continue_base(
        &self,
        lane: usize,
        length: f64,
        ws: &mut RadialWorkspace,
    ) -> usize {
        let (s, g, r) = (ws.solids, ws.gases, ws.reactions);
        let mut fallen = 0;
        for shell in 0..ws.shells {
            ws.base.enthalpy[shell][lane] =
                ws.start_enthalpy[shell][lane] + ONWARDS * ws.warmed[shell][lane];
            let mut short = false;
            for k in shell * s..(shell + 1) * s {
                let (start, stage) = (ws.start.amount[k][lane], ws.first_stage.amount[k][lane]);
                let base = start + ONWARDS * (stage - start);
                ws.base.amount[k][lane] = base;
                short |= base < BEGINS_WITH * stage;
            }
            ws.base.weight[shell][lane] = if short { length } else { GAMMA * length };
            let moved = ws.turned[shell * r..(shell + 1) * r].iter();
            let unreacted = ws.unreacted[shell * s..(shell + 1) * s].iter();
            let all: f64 = unreacted.map(|own| own[lane]).sum();
            let reacts = moved.fold(0.0, |most: f64, x| most.max(x[lane].abs())) > COUNTS * all;
            fallen += usize::from(short && reacts);
            for place in shell * g..(shell + 1) * g {
                let start = ws.start_gas[place][lane];
                let mut made = ws.came[place][lane];
                if !short {
                    made = ws.now_gas[place][lane] - start;
                }
                ws.base.gas[place][lane] = start + ONWARDS * made;
            }
            if short {
                for k in shell * s..(shell + 1) * s {
                    ws.base.amount[k][lane] = ws.start.amount[k][lane];
                }
                fill_lane(&mut ws.turned[shell * r..(shell + 1) * r], lane, 0.0);
            }
        }
        fallen
    }

    /// A first guess of the second stage: temperatures and pressures of shells go on as they went, and reactions where that leaves what
    /// they use.
    pub(super) fn guess_onwards(&self, lane: usize, ws: &mut RadialWorkspace) {
        let (n, s, g, r) = (ws.shells, ws.solids, ws.gases, ws.reactions);
        let onwards = |start: f64, stage: f64, most: f64| {
            let most = most * stage.abs();
            stage + ((1.0 / GAMMA - 1.0) * (stage - start)).clamp(-most, most)
        };
        for shell in 0..n {
            let (start, now) = (&ws.start.temperature, &mut ws.now.temperature[shell][lane]);
            *now = onwards(start[shell][lane], *now, GUESS_WARMED);
            for k in shell * g..(shell + 1) * g {
                let (start, now) = (&ws.start.pressure, &mut ws.now.pressure[k][lane]);
                *now = onwards(start[k][lane], *now, GUESS_PRESSURE);
            }
            let turned = |j: usize| {
                // Where the reactions of a shell go by the end of the step alone, nothing is turned yet.
                ws.turned[shell * r + j][lane] / ONWARDS
            };
            let mut amounts = [0.0; MOST_SOLIDS];
            let mut leaves = true;
            for (k, amount) in amounts.iter_mut().enumerate().take(s) {
                let base = ws.base.amount[shell * s + k][lane];
                let change = (0..r).map(|j| self.solid_moles[j * s + k] * turned(j));
                *amount = base + change.sum::<f64>();
                leaves &= *amount >= BEGINS_WITH * base;
            }
            if leaves {
                for j in 0..r {
                    ws.now.extent[shell * r + j][lane] = turned(j);
                }
                for (k, amount) in amounts.iter().enumerate().take(s) {
                    ws.now.amount[shell * s + k][lane] = *amount;
                }
            }
        }
    }
}
