//! What a window leaves in gas, particles and ledger must be finite, and mass fractions those of a gas.

use super::CoupledRun;
use crate::finite::{Broken, NotFinite, NotFinitePlace, broken_gas, first_of, refusal};
use crate::part::Gas as _;
use crate::time::Window;

impl CoupledRun {
    /// Refuses a window that left a number that is not finite in the gas, the particles or the ledger, or a gas that cannot be.
    pub(super) fn check_finite(&self, window: &Window) -> Result<(), NotFinite> {
        let found = self
            .broken_gas()
            .or_else(|| self.broken_particle())
            .or_else(|| self.broken_line());
        found.map_or(Ok(()), |broken| Err(refusal(window, broken)))
    }

    fn broken_gas(&self) -> Option<Broken> {
        let species = self.laws.closures.gas.species();
        broken_gas(&self.parts.gas.fields(), species, self.mesh.cell_centre())
    }

    fn broken_particle(&self) -> Option<Broken> {
        let particles = self.parts.particles.fields();
        let scalars = first_of(&[
            ("the temperature", self.interior.models.temperature()),
            ("the mass", &self.interior.mass),
            ("the radius", particles.radius),
            ("the heat from the gas", &self.exchange.exchange.heat),
        ]);
        let vectors = || {
            first_of(&[
                ("the position", particles.position),
                ("the velocity", particles.velocity),
                ("the angular velocity", particles.angular_velocity),
            ])
        };
        let (name, row, value) = scalars.or_else(vectors)?;
        let place = NotFinitePlace::Particle {
            id: particles.id.get(row).copied().unwrap_or_default(),
            centre: particles.position.get(row).copied().unwrap_or_default(),
        };
        Some((name.to_owned(), place, value))
    }

    fn broken_line(&self) -> Option<Broken> {
        let lines = self.ledger.lines().into_iter();
        let lines = lines.map(|(name, _, line)| (name.to_owned(), line));
        let elements = self.ledger.elements.iter();
        let elements = elements.map(|(symbol, line)| (format!("elements.{symbol}"), *line));
        let found = lines.chain(elements).find_map(|(name, line)| {
            let numbers = [line.drift, line.error, line.throughput];
            let value = numbers.into_iter().find(|one| !one.is_finite())?;
            Some((name, value))
        });
        let (name, value) = found?;
        Some((
            format!("the balance `{name}`"),
            NotFinitePlace::Ledger,
            value,
        ))
    }
}
