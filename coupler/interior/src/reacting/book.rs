//! What an exchange with the gas turned over, booked so that nothing is used that is not there.

use super::Reacting;

/// What the exchange with the gas came to for all particles.
#[derive(Clone, Copy, Debug)]
pub struct ExchangeTotals<'a> {
    /// Mean rate of each channel of each particle in mol/s, limited.
    pub rates: &'a [f64],
    /// Sensible heat in W that the exchanged gases bring into each particle.
    pub carried: &'a [f64],
}

impl Reacting {
    /// Rates of each channel over the mass fraction of its key gas, in mol/s: slopes, and what goes off.
    pub fn lines(&self) -> (&[f64], &[f64]) {
        (&self.lines[0], &self.lines[1])
    }

    /// Temperature in K at which gases leave each particle: where the last integration ended.
    pub fn end_temperature(&self) -> &[f64] {
        &self.end
    }

    /// Shares of the rates of all channels (mol/s, channel by channel within each particle) that a window of
    /// a span in s can have: no solid is used beyond what is there and what is made of it. Inner reactions are
    /// limited alike.
    pub fn limit(&mut self, rates: &[f64], span: f64, shares: &mut Vec<f64>) {
        let channels = self.channels.len();
        shares.clear();
        shares.resize(rates.len(), 1.0);
        for p in 0..self.count() {
            let own = p * channels..(p + 1) * channels;
            self.limit_one(p, &rates[own.clone()], span, &mut shares[own]);
        }
    }

    fn limit_one(&mut self, p: usize, rates: &[f64], span: f64, shares: &mut [f64]) {
        let (solids, count) = (self.chemistry.solids.len(), self.chemistry.reactions.len());
        let extents = &mut self.extents[p * count..(p + 1) * count];
        for (channel, rate) in self.channels.iter().zip(rates) {
            extents[channel.reaction] = rate * span;
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
        for ((channel, rate), share) in self.channels.iter().zip(rates).zip(shares) {
            *share = if *rate == 0.0 {
                1.0
            } else {
                extents[channel.reaction] / (rate * span)
            };
        }
    }

    /// Takes up what the gas and the particles exchanged in the attempt over a span in s.
    pub fn book(&mut self, booking: &ExchangeTotals<'_>, span: f64) {
        let (count, channels) = (self.chemistry.reactions.len(), self.channels.len());
        for p in 0..self.count() {
            for (c, channel) in self.channels.iter().enumerate() {
                let rate = booking.rates[p * channels + c];
                self.extents[p * count + channel.reaction] = rate * span;
            }
        }
        self.carried.copy_from_slice(booking.carried);
    }
}
