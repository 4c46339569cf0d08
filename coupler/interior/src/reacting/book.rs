//! Limits of what an exchange with the gas may turn over, so that nothing is used that is not there.

use super::Reacting;

impl Reacting {
    /// Rates of each channel over the mass fraction of its key gas, in mol/s: slopes, and what goes off.
    pub fn lines(&self) -> (&[f64], &[f64]) {
        (&self.lines[0], &self.lines[1])
    }

    /// Lowers rates of all channels (mol/s, channel by channel within each particle) to what a window of a span in s
    /// can have: no solid is used beyond what is there and what is made of it. Inner reactions are limited alike.
    pub(super) fn limit_all(&mut self, rates: &mut [f64], span: f64) {
        let channels = self.channels.len();
        for p in 0..self.count() {
            self.limit_one(p, &mut rates[p * channels..(p + 1) * channels], span);
        }
    }

    fn limit_one(&mut self, p: usize, rates: &mut [f64], span: f64) {
        let (solids, count) = (self.chemistry.solids.len(), self.chemistry.reactions.len());
        let extents = &mut self.extents[p * count..(p + 1) * count];
        for (reaction, rate) in self.reaction_of.iter().zip(&*rates) {
            extents[*reaction] = rate * span;
        }
        let held = &self.committed.amount[p * solids..(p + 1) * solids];
        let all: f64 = held.iter().sum();
        let reactions = &self.chemistry.reactions;
        for _ in 0..4 * count {
            let mut within = true;
            for (s, held) in held.iter().enumerate() {
                let (mut made, mut used) = (0.0, 0.0);
                for (extent, reaction) in extents.iter().zip(reactions) {
                    for &(_, n) in reaction.solids.iter().filter(|one| one.0 == s) {
                        let change = n * *extent;
                        if change > 0.0 {
                            made += change;
                        } else {
                            used -= change;
                        }
                    }
                }
                let there = held.max(0.0) + made;
                if used <= there * (1.0 + 1e-12) + 1e-14 * all {
                    continue;
                }
                within = false;
                for (extent, reaction) in extents.iter_mut().zip(reactions) {
                    let uses = |one: &(usize, f64)| one.0 == s && one.1 * *extent < 0.0;
                    if reaction.solids.iter().any(uses) {
                        *extent *= there / used;
                    }
                }
            }
            if within {
                break;
            }
        }
        for (reaction, rate) in self.reaction_of.iter().zip(rates) {
            let asked = *rate * span;
            if asked != 0.0 && extents[*reaction] != asked {
                *rate *= extents[*reaction] / asked;
            }
        }
    }
}
