//! What left through outlets so far, and how long it had been there.

use crate::checkpoint::{StateFile, StateFileError};

/// Numbers that [`OutletTotals`] has of what left.
const NUMBERS: usize = 5;

/// What of a population left through an outlet so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutletTotals {
    /// Index of the outlet.
    pub outlet: usize,
    /// Index of the population.
    pub population: u32,
    /// Number of real particles.
    pub particles: f64,
    /// Their mass in kg.
    pub mass: f64,
    /// Mass in kg of those that feeds brought in this run: when others came is not known.
    pub fed_mass: f64,
    /// Sum over these of the mass times the process time since they came, in kg s.
    pub age: f64,
    /// The same of the mass times the square of that time, in kg s².
    pub age_squared: f64,
}

/// When particles came, and what left through each outlet.
#[derive(Clone, Debug, Default)]
pub struct Outflows {
    outlets: usize,
    /// An entry for each population that left through an outlet, in the order in which the first of it did.
    totals: Vec<OutletTotals>,
    /// Ids from this one on came at this process time in s, up to the next entry; ascending.
    arrivals: Vec<(u64, f64)>,
}

/// A particle that leaves.
#[derive(Clone, Copy, Debug)]
pub struct Leaving {
    /// Its id.
    pub id: u64,
    /// Index of its population.
    pub population: u32,
    /// Number of real particles that it stands for.
    pub weight: f64,
    /// Mass in kg of all of them.
    pub mass: f64,
}

impl OutletTotals {
    /// The numbers of what left in one order.
    pub fn numbers(&self) -> [f64; NUMBERS] {
        [
            self.particles,
            self.mass,
            self.fed_mass,
            self.age,
            self.age_squared,
        ]
    }

    /// The same with other numbers.
    #[must_use]
    pub fn with_numbers(
        self,
        [particles, mass, fed_mass, age, age_squared]: [f64; NUMBERS],
    ) -> Self {
        Self {
            particles,
            mass,
            fed_mass,
            age,
            age_squared,
            ..self
        }
    }

    /// Mean over the mass of the process time in s since feeds brought what left; NaN where they brought none of it.
    pub fn mean_age(&self) -> f64 {
        self.age / self.fed_mass
    }

    /// Standard deviation over the mass of that time in s.
    pub fn age_deviation(&self) -> f64 {
        let variance = self.age_squared / self.fed_mass - self.mean_age().powi(2);
        match variance < 0.0 {
            // The round-off of equal times.
            true => 0.0,
            false => variance.sqrt(),
        }
    }
}

impl Outflows {
    /// Of so many outlets, through which nothing has left.
    pub fn new(outlets: usize) -> Self {
        Self {
            outlets,
            totals: Vec::new(),
            arrivals: Vec::new(),
        }
    }

    /// What of each population left through each outlet.
    pub fn totals(&self) -> &[OutletTotals] {
        &self.totals
    }

    /// Particles of this id and above came at a process time in s.
    pub fn came(&mut self, first: u64, time: f64) {
        // Without outlets nobody asks.
        if self.outlets > 0 {
            self.arrivals.push((first, time));
        }
    }

    /// A particle leaves through an outlet at a process time in s.
    pub fn went(&mut self, outlet: usize, particle: Leaving, time: f64) {
        let came = self.arrival(particle.id);
        let population = particle.population;
        let mut own = self.totals.iter();
        let place = own.position(|one| (one.outlet, one.population) == (outlet, population));
        let place = place.unwrap_or(self.totals.len());
        if place == self.totals.len() {
            self.totals.push(OutletTotals {
                outlet,
                population,
                ..OutletTotals::default()
            });
        }
        let totals = &mut self.totals[place];
        totals.particles += particle.weight;
        totals.mass += particle.mass;
        if let Some(came) = came {
            totals.fed_mass += particle.mass;
            totals.age += particle.mass * (time - came);
            totals.age_squared += particle.mass * (time - came).powi(2);
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
        let places = self.totals.iter();
        let places = places.flat_map(|one| [one.outlet as u64, u64::from(one.population)]);
        state.set_u64s("outlet_places", &places.collect::<Vec<_>>());
        let totals = self.totals.iter().flat_map(OutletTotals::numbers);
        state.set_f64s("outlet_totals", &totals.collect::<Vec<_>>());
        let (ids, times): (Vec<u64>, Vec<f64>) = self.arrivals.iter().copied().unzip();
        state.set_u64s("arrival_ids", &ids);
        state.set_f64s("arrival_times", &times);
    }

    /// Takes it up again.
    pub fn restore(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        let places = state.u64s("outlet_places")?.as_chunks::<2>().0;
        let named = places.iter().map(|&[outlet, _]| outlet as usize + 1);
        let named = named.max().unwrap_or(0);
        if named > self.outlets {
            return Err(StateFileError::Length {
                name: "outlets".into(),
                found: named,
                expected: self.outlets,
            });
        }
        let numbers = state.f64s_of("outlet_totals", NUMBERS * places.len())?;
        let numbers = numbers.as_chunks::<NUMBERS>().0;
        let totals = places.iter().zip(numbers);
        self.totals = totals
            .map(|(&[outlet, population], &numbers)| {
                let place = OutletTotals {
                    outlet: usize::try_from(outlet).unwrap_or(usize::MAX),
                    population: u32::try_from(population).unwrap_or(u32::MAX),
                    ..OutletTotals::default()
                };
                place.with_numbers(numbers)
            })
            .collect();
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
            population: u32::from(id == 12),
            weight: 2.0,
            mass: 3.0,
        };
        flows.came(10, 1.0);
        flows.came(12, 4.0);
        flows.went(0, leaving(9), 5.0);
        flows.went(1, leaving(11), 5.0);
        flows.went(1, leaving(12), 6.0);
        flows.went(1, leaving(11), 6.0);
        let [first, second, tracer] = flows.totals() else {
            panic!()
        };
        assert_eq!(first.numbers(), [2.0, 3.0, 0.0, 0.0, 0.0]);
        assert!(first.mean_age().is_nan() && first.age_deviation().is_nan());
        assert_eq!(second.numbers(), [4.0, 6.0, 6.0, 27.0, 3.0 * 41.0]);
        assert_eq!((second.outlet, second.population), (1, 0));
        assert_eq!((second.mean_age(), second.age_deviation()), (4.5, 0.5));
        assert_eq!(tracer.numbers(), [2.0, 3.0, 3.0, 6.0, 12.0]);
        assert_eq!((tracer.outlet, tracer.population), (1, 1));
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
