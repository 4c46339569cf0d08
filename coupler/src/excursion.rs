//! Values outside a range: how many, and the one that is farthest outside.

use calcine_physics::flow_range::FlowRange;
use calcine_physics::local::LocalGas;
use rayon::prelude::*;

/// Values that one thread takes at a time.
const CHUNK: usize = 8192;

/// Values of one quantity that lie outside a range. The same on any number of threads where parts are added in the
/// order of their places: of values equally far outside, the first one stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excursion {
    /// How many.
    pub count: u64,
    /// The value farthest outside.
    pub value: f64,
    /// The end of the range that it is beyond.
    pub limit: f64,
    /// Its place in the list of values.
    pub place: usize,
}

impl Excursion {
    /// Counts a value where it is below the lowest or not up to the highest that the range holds; NaN is outside.
    #[inline]
    pub fn look(&mut self, place: usize, value: f64, (lowest, highest): (f64, f64)) {
        if value < lowest {
            self.note(place, value, lowest);
        } else if value > highest || value.is_nan() {
            self.note(place, value, highest);
        }
    }

    #[cold]
    fn note(&mut self, place: usize, value: f64, limit: f64) {
        self.add(&Self {
            count: 1,
            value,
            limit,
            place,
        });
    }

    /// Adds those of later places.
    pub fn add(&mut self, later: &Self) {
        let count = self.count + later.count;
        let farther = later.distance() > self.distance();
        if later.count > 0 && (self.count == 0 || farther || later.value.is_nan()) {
            *self = *later;
        }
        self.count = count;
    }

    /// Keeps the worst value of both, and the larger of both numbers: of values looked at again and again, the most at once.
    pub fn keep_worst(&mut self, other: &Self) {
        let count = self.count.max(other.count);
        self.add(other);
        self.count = count;
    }

    /// How far outside the worst value is.
    fn distance(&self) -> f64 {
        (self.value - self.limit).abs()
    }

    /// Those among a list of values.
    pub fn of(values: &[f64], range: (f64, f64)) -> Self {
        let parts: Vec<Self> = values
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, values)| {
                let mut found = Self::default();
                for (row, value) in values.iter().enumerate() {
                    found.look(chunk * CHUNK + row, *value, range);
                }
                found
            })
            .collect();
        let mut found = Self::default();
        parts.iter().for_each(|part| found.add(part));
        found
    }
}

/// Where the flow at particles is outside the range that a correlation was published for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowExcursion {
    /// Of the void fraction.
    pub void_fraction: Excursion,
    /// Of the Reynolds number.
    pub reynolds: Excursion,
}

/// Where laws were evaluated outside the ranges that their sources state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawExcursions {
    /// Drag.
    pub drag: FlowExcursion,
    /// Heat transfer.
    pub heat_transfer: FlowExcursion,
    /// Mass transfer; none where no particle reacts.
    pub mass_transfer: FlowExcursion,
}

impl FlowExcursion {
    /// Counts the particle of a row and a diameter in m where the gas that it sees is outside a range.
    #[inline]
    pub fn look(&mut self, range: &FlowRange, row: usize, gas: &LocalGas, diameter: f64) {
        let voids = gas.void_fraction.value();
        self.void_fraction.look(row, voids, range.void_fraction);
        if gas.viscosity == 0.0 {
            return; // a vacuum
        }
        let reynolds = range.reynolds_of(gas, diameter);
        self.reynolds.look(row, reynolds, range.reynolds);
    }

    /// Adds those of later particles.
    pub fn add(&mut self, later: &Self) {
        self.void_fraction.add(&later.void_fraction);
        self.reynolds.add(&later.reynolds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_value_and_its_first_place_are_found_on_any_number_of_threads() {
        let mut values = vec![0.5; 3 * CHUNK];
        values[7] = -0.25;
        values[CHUNK + 1] = 1.75;
        values[2 * CHUNK + 2] = -0.75;
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let found = pool
                .build()
                .unwrap()
                .install(|| Excursion::of(&values, (0.0, 1.0)));
            let (place, value) = (CHUNK + 1, 1.75);
            let wanted = Excursion {
                count: 3,
                value,
                limit: 1.0,
                place,
            };
            assert_eq!(found, wanted);
        }
    }

    #[test]
    fn the_ends_of_a_range_are_inside_and_nan_is_outside() {
        let mut found = Excursion::default();
        found.look(0, 0.0, (0.0, 1.0));
        found.look(1, 1.0, (0.0, 1.0));
        assert_eq!(found.count, 0);
        found.look(2, f64::NAN, (0.0, 1.0));
        found.look(3, 5.0, (0.0, 1.0));
        assert_eq!((found.count, found.place), (2, 2));
    }
}
