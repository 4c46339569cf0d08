//! What the equations of the species moved, and what their solver left of them. The content of a cell is what flows, particles and
//! reactions brought it, m Y and a remainder: the residual of the linear solve times the span, which the next window begins with.
//! So each species and each element closes to round-off, however small a part of the gas it is.

use calcine_coupler::part::Balance;

use super::SpeciesEquations;
use crate::gas::attempt::AttemptFrame;
use crate::gas::boundary::of_all;
use crate::gas::state::GasState;
use crate::numerics::parallel::{fill, sums, update};

impl SpeciesEquations {
    /// Flow of a species into the domain through a boundary face in kg/s.
    fn inflow(&self, frame: &AttemptFrame<'_>, now: &GasState, k: usize, index: usize) -> f64 {
        let inner = self.fractions[k][frame.grid.faces[index].owner];
        let flux = now.flux[index];
        match frame.boundary.composition(index) {
            Some(composition) => {
                let carried = if flux < 0.0 { composition[k] } else { inner };
                self.diffusion[index] * (composition[k] - inner)
                    - flux * carried
                    - self.explicit[k][index]
            }
            None => -flux * inner,
        }
    }

    /// Notes the flows through the boundary.
    pub(super) fn record(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let of = |k| {
            let inflow = |face| self.inflow(frame, now, k, face);
            frame.boundary.flows_by_patch(inflow)
        };
        self.patches = (0..frame.species()).map(of).collect();
    }

    /// Gives each cell what flows, particles and reactions brought it beyond m Y, so that the content of a cell is what came and
    /// went to round-off, however close the equations are solved. The last species gets what the others leave.
    pub fn carry_remainder(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) {
        let species = frame.species();
        if species == 0 {
            return;
        }
        let own = !frame.exchange.species.is_none();
        fill(&mut now.remainder, |_| 0.0);
        for k in 0..species - 1 {
            if own || k == 0 {
                self.assemble(frame, now, k);
            }
            self.fill_source(frame, now, k);
            let (matrix, fractions) = (&self.matrix, &self.fractions[k]);
            update(&mut self.source, |cell, rate| {
                *rate -= matrix.row_times(cell, fractions);
            });
            let left = &self.source;
            let last = species - 1;
            update(&mut now.remainder, |place, remainder| {
                let brought = frame.storage_span * left[place / species];
                match place % species {
                    own if own == k => *remainder = brought,
                    own if own == last => *remainder -= brought,
                    _ => {}
                }
            });
        }
    }

    /// The balance of each species over the window, in kg.
    pub fn balances(&self, frame: &AttemptFrame<'_>, now: &GasState, balances: &mut Vec<Balance>) {
        let species = frame.species();
        balances.clear();
        for k in 0..species {
            let [stored, stored_magnitude] = sums(now.mass.len(), |cell| {
                let place = cell * species + k;
                let stored = now.content(cell, place) - frame.old.content(cell, place);
                [stored, stored.abs()]
            });
            let [inflow, magnitude] = of_all(&self.patches[k]);
            let given = &frame.exchange.species;
            let exchanged = match given.is_none() {
                true => 0.0,
                false => sums(now.mass.len(), |cell| {
                    let at = cell * species + k;
                    [given.source[at] - given.coefficient[at] * now.composition[at]]
                })[0],
            };
            let [made, made_magnitude] = match self.reactions.is_none() {
                true => [0.0; 2],
                false => sums(now.mass.len(), |cell| {
                    let made = self.reactions.gain(cell * species + k);
                    [made, made.abs()]
                }),
            };
            balances.push(Balance {
                source: made * frame.storage_span,
                source_magnitude: made_magnitude * frame.storage_span,
                exchange: exchanged * frame.storage_span,
                stored,
                stored_magnitude,
                boundary: inflow * frame.storage_span,
                boundary_magnitude: magnitude * frame.storage_span,
                ..Balance::default()
            });
        }
    }
}
