//! Aggregation by a kernel that a bed of the plant returns.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::population::{Aggregation, SizeProcess, TabulatedKernel};
use crate::{PlantError, SizeGrid};

/// The last table, and aggregation by it for a bed of 1 kg.
type LastTable = Option<(Vec<f64>, Aggregation)>;

/// Aggregation in a granulator by the collisions that a coupled bed counts.
///
/// The bed returns K = Z M/(N N') of each pair of diameters in kg/s: Z pairs collide in a second among N and N' particles
/// (counted once; of one diameter N²/2 pairs) of a bed of mass M. A granulator of mass m whose particles collide as often at
/// the same solid fraction, and stick with a probability ψ, has β = ψ K/m.
pub struct BedKernel {
    /// Name of the bed.
    pub bed: String,
    /// ψ.
    pub efficiency: f64,
    grid: Option<(SizeGrid, Vec<f64>, String)>,
    made: Mutex<LastTable>,
}

impl BedKernel {
    /// Aggregation by the kernel of a bed.
    pub fn new(bed: String, efficiency: f64) -> Self {
        Self {
            bed,
            efficiency,
            grid: None,
            made: Mutex::new(None),
        }
    }

    pub(super) fn prepare(
        &mut self,
        grid: &SizeGrid,
        particle: &[f64],
        place: &str,
    ) -> Result<(), PlantError> {
        if !(0.0..=1.0).contains(&self.efficiency) {
            return Err(PlantError::Value {
                place: place.to_owned(),
                quantity: "efficiency of collisions",
                value: self.efficiency,
                allowed: "it is 0 to 1",
            });
        }
        self.grid = Some((grid.clone(), particle.to_vec(), place.to_owned()));
        Ok(())
    }

    /// Aggregation by a table, made where it is another than the last one.
    fn by(&self, table: &[f64]) -> Result<MutexGuard<'_, LastTable>, PlantError> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let same = made.as_ref().is_some_and(|(own, _)| own == table);
        if let (false, Some((grid, particle, place))) = (same, &self.grid) {
            // n diameters and n² rates.
            let count = ((1.0 + 4.0 * table.len() as f64).sqrt() - 1.0) / 2.0;
            let (diameters, rates) = table.split_at(count.round() as usize);
            let rates = rates.iter().map(|rate| self.efficiency * rate).collect();
            let kernel = TabulatedKernel::new(diameters.to_vec(), rates, place)?;
            let mut aggregation = Aggregation::new(Box::new(kernel));
            aggregation.prepare(grid, particle, place)?;
            *made = Some((table.to_vec(), aggregation));
        }
        Ok(made)
    }

    /// Adds the rates in kg/s of masses in kg.
    pub(super) fn add(
        &self,
        table: &[f64],
        inner: usize,
        masses: &[f64],
        rates: &mut [f64],
    ) -> Result<(), PlantError> {
        let mass: f64 = masses.iter().sum();
        let made = self.by(table)?;
        if let Some((_, aggregation)) = &*made {
            let mut own = vec![0.0; masses.len()];
            aggregation.add(inner, masses, &mut own);
            rates.iter_mut().zip(&own).for_each(|(r, o)| *r += o / mass);
        }
        Ok(())
    }

    /// A bound of how fast small deviations of the masses fade, in 1/s.
    pub(super) fn fastest(&self, table: &[f64], inner: usize, masses: &[f64]) -> f64 {
        let mass: f64 = masses.iter().sum();
        let Ok(made) = self.by(table) else { return 0.0 };
        made.as_ref()
            .map_or(0.0, |(_, a)| a.fastest(inner, masses) / mass)
    }
}
