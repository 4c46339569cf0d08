//! A kernel by points.

use calcine_physics::sphere::radius_of;

use super::aggregation_kernel::AggregationKernel;
use crate::PlantError;

/// β by a symmetric table over the diameters of both particles, bilinear between its points and constant beyond: measured, or
/// computed at another scale.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedKernel {
    diameters: Vec<f64>,
    rates: Vec<f64>,
}

impl TabulatedKernel {
    /// Rising diameters in m, and β in 1/s of each pair, row by row. `place` is what an error names.
    pub fn new(diameters: Vec<f64>, rates: Vec<f64>, place: &str) -> Result<Self, PlantError> {
        let refuse = |quantity, value, allowed| {
            Err(PlantError::Value {
                place: place.to_owned(),
                quantity,
                value,
                allowed,
            })
        };
        let count = diameters.len();
        if count == 0 {
            let quantity = "number of diameters of the kernel table";
            return refuse(quantity, 0.0, "give one at least");
        }
        if rates.len() != count * count {
            let value = rates.len() as f64;
            let allowed = "one for each pair of diameters, row by row";
            return refuse("number of rates of the kernel table", value, allowed);
        }
        let bad = |x: &&f64| !(x.is_finite() && **x >= 0.0);
        if let Some(d) = diameters.iter().find(bad) {
            let allowed = "it is finite and not negative";
            return refuse("diameter of the kernel table in m", *d, allowed);
        }
        if let Some(pair) = diameters.windows(2).find(|pair| pair[1] <= pair[0]) {
            return refuse(
                "diameter of the kernel table in m",
                pair[1],
                "diameters rise",
            );
        }
        if let Some(rate) = rates.iter().find(bad) {
            let allowed = "it is finite and not negative";
            return refuse("rate of the kernel table in 1/s", *rate, allowed);
        }
        for row in 0..count {
            for column in 0..row {
                let (one, other) = (rates[row * count + column], rates[column * count + row]);
                if (one - other).abs() > 1e-9 * one.max(other) {
                    let allowed = "that of the same pair in the other order, as two particles meet each other";
                    return refuse("rate of the kernel table in 1/s", one, allowed);
                }
            }
        }
        Ok(Self { diameters, rates })
    }

    /// The point below a diameter, and how far it is to the next, 0 to 1.
    fn place(&self, d: f64) -> (usize, f64) {
        let above = self.diameters.partition_point(|point| *point <= d);
        if above == 0 {
            return (0, 0.0);
        }
        match self.diameters.get(above) {
            Some(next) => {
                let low = self.diameters[above - 1];
                (above - 1, (d - low) / (next - low))
            }
            None => (above - 1, 0.0),
        }
    }
}

impl AggregationKernel for TabulatedKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        let count = self.diameters.len();
        let [(i, x), (j, y)] = [u, v].map(|volume| self.place(2.0 * radius_of(volume)));
        let [k, l] = [i, j].map(|low| (low + 1).min(count - 1));
        let at = |row: usize, column: usize| self.rates[row * count + column];
        let (below, above) = (
            at(i, j) + (at(i, l) - at(i, j)) * y,
            at(k, j) + (at(k, l) - at(k, j)) * y,
        );
        below + (above - below) * x
    }
}

#[cfg(test)]
mod tests {
    use calcine_physics::sphere::volume_of_diameter;

    use super::*;

    #[test]
    fn a_bilinear_kernel_is_kept_and_held_beyond_the_table() {
        let points = vec![1e-3, 2e-3, 4e-3];
        let law = |a: f64, b: f64| 1.0 + 1e3 * (a + b) + 1e6 * a * b;
        let rates = points
            .iter()
            .flat_map(|a| points.iter().map(|b| law(*a, *b)));
        let table = TabulatedKernel::new(points.clone(), rates.collect(), "test").unwrap();
        let rate = |a: f64, b: f64| table.rate(volume_of_diameter(a), volume_of_diameter(b));
        for (a, b) in [(1e-3, 1e-3), (1.2e-3, 3.1e-3), (3.9e-3, 1.1e-3)] {
            assert!((rate(a, b) / law(a, b) - 1.0).abs() < 1e-12, "{a} {b}");
        }
        assert!((rate(0.1e-3, 9e-3) / law(1e-3, 4e-3) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn tables_that_are_not_symmetric_finite_or_complete_are_refused() {
        let made = |rates: [f64; 4]| TabulatedKernel::new(vec![1e-3, 2e-3], rates.to_vec(), "bed");
        assert!(made([1.0, 2.0, 2.0, 1.0]).is_ok());
        assert!(made([1.0, 2.0, 3.0, 1.0]).is_err());
        assert!(made([1.0, f64::NAN, f64::NAN, 1.0]).is_err());
        assert!(TabulatedKernel::new(vec![1e-3], vec![1.0, 2.0], "bed").is_err());
        assert!(TabulatedKernel::new(vec![2e-3, 1e-3], vec![1.0; 4], "bed").is_err());
    }
}
