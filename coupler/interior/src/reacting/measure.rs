//! Masses and radii of particles that react.

use super::Reacting;
use super::size::SizeChange;

impl Reacting {
    /// The same particles with a law of size; without it diameters stay.
    pub fn with_size(mut self, size: SizeChange) -> Self {
        self.size = size;
        self
    }

    /// The same particles, which are used up where no more than this share of their first mass is left; without it, where
    /// nothing is left.
    pub fn with_used_up(mut self, share: f64) -> Self {
        self.used_up = share;
        self
    }

    pub(super) fn size(&self) -> &SizeChange {
        &self.size
    }

    /// Finds masses and radii: 0 of the last attempt, 1 of the last commit.
    pub(super) fn measure(&mut self, which: usize) {
        let state = [&self.now, &self.committed][which];
        let measures = &mut self.bodies[which];
        let particles = state.amount.chunks_exact(self.chemistry.solids.len());
        measures.mass.clear();
        measures.mass.extend(
            particles
                .clone()
                .map(|amounts| self.chemistry.mass(amounts)),
        );
        measures.radius.clear();
        if self.size != SizeChange::Constant {
            measures
                .radius
                .extend(particles.filter_map(|amounts| self.size.radius(amounts)));
        }
    }
}
