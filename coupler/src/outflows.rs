//! What left through outlets so far, and how long it had been there.

use crate::checkpoint::{StateFile, StateFileError};

/// What left through an outlet so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutletTotals {
    /// Number of real particles.
    pub particles: f64,
    /// Their mass in kg.
    pub mass: f64,
    /// Mass in kg of those that feeds brought in this run: when others came is not known.
    pub fed_mass: f64,
    /// Sum over these of the mass times the process time since they came, in kg s.
    pub age: f64,
}

/// When particles came, and what left through each outlet.
#[derive(Clone, Debug, Default)]
pub struct Outflows {
    totals: Vec<OutletTotals>,
    /// Ids from this one on came at this process time in s, up to the next entry; ascending.
    arrivals: Vec<(u64, f64)>,
}

/// A particle that leaves.
#[derive(Clone, Copy, Debug)]
pub struct Leaving {
    /// Its id.
    pub id: u64,
    /// Number of real particles that it stands for.
    pub weight: f64,
    /// Mass in kg of all of them.
    pub mass: f64,
}

impl OutletTotals {
    /// The numbers in one order.
    pub fn numbers(&self) -> [f64; 4] {
        [self.particles, self.mass, self.fed_mass, self.age]
    }

    /// From these numbers.
    pub fn from_numbers([particles, mass, fed_mass, age]: [f64; 4]) -> Self {
        Self {
            particles,
            mass,
            fed_mass,
            age,
        }
    }
}

impl Outflows {
    /// Of so many outlets, through which nothing has left.
    pub fn new(outlets: usize) -> Self {
        Self {
            totals: vec![OutletTotals::default(); outlets],
            arrivals: Vec::new(),
        }
    }

    /// What left through each outlet.
    pub fn totals(&self) -> &[OutletTotals] {
        &self.totals
    }

    /// Particles of this id and above came at a process time in s.
    pub fn came(&mut self, first: u64, time: f64) {
        // Without outlets nobody asks.
        if !self.totals.is_empty() {
            self.arrivals.push((first, time));
        }
    }

    /// A particle leaves through an outlet at a process time in s.
    pub fn went(&mut self, outlet: usize, particle: Leaving, time: f64) {
        let came = self.arrival(particle.id);
        let Some(totals) = self.totals.get_mut(outlet) else {
            return;
        };
        totals.particles += particle.weight;
        totals.mass += particle.mass;
        if let Some(came) = came {
            totals.fed_mass += particle.mass;
            totals.age += particle.mass * (time - came);
        }
    }

    /// When a particle came; none of one that no feed brought.
    fn arrival(&self, id: u64) -> Option<f64> {
        let next = self.arrivals.partition_point(|&(first, _)| first <= id);
        Some(self.arrivals.get(next.checked_sub(1)?)?.1)
    }

    /// Forgets when particles below an id came, as none is left.
    pub fn forget_below(&mut self, id: u64) {
        let next = self.arrivals.partition_point(|&(first, _)| first <= id);
        self.arrivals.drain(..next.saturating_sub(1));
    }

    /// Writes it.
    pub fn record(&self, state: &mut StateFile) {
        let totals = self.totals.iter().flat_map(OutletTotals::numbers);
        state.set_f64s("outlet_totals", &totals.collect::<Vec<_>>());
        let (ids, times): (Vec<u64>, Vec<f64>) = self.arrivals.iter().copied().unzip();
        state.set_u64s("arrival_ids", &ids);
        state.set_f64s("arrival_times", &times);
    }

    /// Takes it up again.
    pub fn restore(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        let numbers = state.f64s_of("outlet_totals", 4 * self.totals.len())?;
        let numbers = numbers.as_chunks::<4>().0.iter().copied();
        self.totals = numbers.map(OutletTotals::from_numbers).collect();
        let ids = state.u64s("arrival_ids")?;
        let times = state.f64s_of("arrival_times", ids.len())?;
        self.arrivals = ids.iter().copied().zip(times.iter().copied()).collect();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_of_feeds_have_their_age_and_those_of_the_start_have_none() {
        let mut flows = Outflows::new(2);
        let leaving = |id| Leaving {
            id,
            weight: 2.0,
            mass: 3.0,
        };
        flows.came(10, 1.0);
        flows.came(12, 4.0);
        flows.went(0, leaving(9), 5.0);
        flows.went(1, leaving(11), 5.0);
        flows.went(1, leaving(12), 6.0);
        let [first, second] = flows.totals() else {
            panic!()
        };
        assert_eq!(first.numbers(), [2.0, 3.0, 0.0, 0.0]);
        assert_eq!(second.numbers(), [4.0, 6.0, 6.0, 3.0 * 4.0 + 3.0 * 2.0]);
        flows.forget_below(12);
        assert_eq!(flows.arrivals, [(12, 4.0)]);
        assert_eq!(flows.arrival(13), Some(4.0));
        let mut state = StateFile::new();
        flows.record(&mut state);
        let mut again = Outflows::new(2);
        again.restore(&state).unwrap();
        assert_eq!(again.totals(), flows.totals());
        assert_eq!(again.arrivals, flows.arrivals);
        assert!(Outflows::new(1).restore(&state).is_err());
    }
}
