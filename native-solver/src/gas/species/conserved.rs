//! Elements before species. The iteration of reacting species (see [`crate::gas::chemistry`]) carries what diffuses upstream or
//! goes round from cell to cell only. But elements obey the equation of the species
//! without what reactions make, as all species diffuse alike. So they are solved first, over the whole window at once; the species
//! take them over, in proportion to what is there. What then has to be made of each, A Y − S, is the heat by which the enthalpy
//! follows. Where the equations are solved nothing of this changes anything.

use calcine_coupler::physics::kinetics::elements::Elements;
use calcine_coupler::physics::thermo::Element;

use super::{ITERATIONS, SpeciesEquations};
use crate::gas::attempt::{AttemptFrame, CellProperties};
use crate::gas::chemistry::ReactionSource;
use crate::gas::state::GasState;
use crate::gas::tolerance::ScalarTolerance;
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::parallel::{fill, update};
use crate::numerics::preconditioner::Preconditioner;

/// An element that a cell lacks by less than this share of its gas is there. Then even negative fractions stay, which corrections
/// of diffusion leave beside steep gradients on skewed meshes: cut and made again they would never settle.
const NO_LACK: f64 = 1e-9;

impl SpeciesEquations {
    /// Solves for the elements and gives them to the species; what is made of each species in kg/s, species by species within
    /// each cell, and the linear iterations. Nothing where particles exchange gases, each by a law of its own.
    pub fn conserve(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        krylov: &mut Krylov,
        (goal, share): (ScalarTolerance, f64),
        elements: &Elements,
        now: &mut GasState,
    ) -> Option<(Vec<f64>, u32)> {
        if !frame.exchange.species.is_none() {
            return None;
        }
        let (cells, species) = (frame.grid.cells(), frame.species());
        let mut sources = self.transport(frame, material, share, now);
        self.preconditioner.expire();
        let target = SolveTolerance {
            absolute: goal.absolute * self.throughput(frame, now, species - 1),
            of_terms: 0.0,
            relative: goal.relative,
            iterations: ITERATIONS,
        };
        let mut iterations = 0;
        let mut masses = vec![[0.0; Element::COUNT]; cells];
        let mut solution = vec![0.0; cells];
        let of = |values: &[f64]| -> Vec<_> {
            let cells = values.chunks_exact(species);
            cells.map(|one| elements.of(one)).collect()
        };
        let (given, there) = (of(&sources), of(&now.composition));
        for e in 0..elements.count() {
            fill(&mut self.source, |cell| given[cell][e]);
            fill(&mut solution, |cell| there[cell][e]);
            let solved = krylov.general(
                &self.matrix,
                &mut self.preconditioner,
                &self.source,
                &mut solution,
                target,
            );
            iterations += solved.iterations;
            masses
                .iter_mut()
                .zip(&solution)
                .for_each(|(m, z)| m[e] = *z);
        }
        let lacking = give(elements, &masses, now.composition.chunks_mut(species));
        if !lacking.is_empty() {
            iterations += self.bring(frame, krylov, target, (&sources, &lacking), now);
        }
        self.take(frame, now);
        let (matrix, fractions) = (&self.matrix, &self.fractions);
        update(&mut sources, |at, made| {
            *made = matrix.row_times(at / species, &fractions[at % species]) - *made;
        });
        Some((sources, iterations))
    }

    /// Gives cells the gas that would be there without reactions, from the equations with the right sides `sources` in kg/s; returns
    /// the linear iterations. It has the elements that are solved for, as its species obey the same equation.
    fn bring(
        &mut self,
        frame: &AttemptFrame<'_>,
        krylov: &mut Krylov,
        target: SolveTolerance,
        (sources, lacking): (&[f64], &[usize]),
        now: &mut GasState,
    ) -> u32 {
        let species = frame.species();
        let mut solution = vec![0.0; frame.grid.cells()];
        let mut iterations = 0;
        for k in 0..species {
            fill(&mut self.source, |cell| sources[cell * species + k]);
            fill(&mut solution, |cell| {
                frame.old.composition[cell * species + k]
            });
            let solved = krylov.general(
                &self.matrix,
                &mut self.preconditioner,
                &self.source,
                &mut solution,
                target,
            );
            iterations += solved.iterations;
            for &cell in lacking {
                now.composition[cell * species + k] = solution[cell].max(0.0);
            }
        }
        iterations
    }

    /// Assembles the equations without reactions; the right sides in kg/s, species by species within each cell. The matrix
    /// is that of the first species.
    pub fn transport(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        share: f64,
        now: &GasState,
    ) -> Vec<f64> {
        let (cells, species) = (frame.grid.cells(), frame.species());
        self.reactions = ReactionSource::default();
        self.update_diffusion(frame, material);
        self.assemble(frame, now, 0);
        self.update_explicit(frame, share, now);
        let mut sources = vec![0.0; cells * species];
        for k in 0..species {
            self.fill_source(frame, now, k);
            let own = &self.source;
            let given = sources.iter_mut().skip(k).step_by(species);
            given.zip(own).for_each(|(given, own)| *given = *own);
        }
        sources
    }

    /// Diffusive conductance of each face in kg/s, as last assembled.
    pub fn diffusion(&self) -> &[f64] {
        &self.diffusion
    }

    /// The matrix as last assembled.
    pub fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// Takes the fractions of a state over.
    pub fn take(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let species = frame.species();
        for (k, fractions) in self.fractions.iter_mut().enumerate() {
            fill(fractions, |cell| now.composition[cell * species + k]);
        }
        self.record(frame, now);
        self.update_carried(frame, now);
    }
}

/// Gives the species of each cell these masses of elements, in proportion to what is there; the cells whose species cannot have
/// them, as where gas of other elements comes in.
fn give<'a>(
    elements: &Elements,
    masses: &[[f64; Element::COUNT]],
    cells: impl Iterator<Item = &'a mut [f64]>,
) -> Vec<usize> {
    let mut lacking = Vec::new();
    for (cell, (fractions, masses)) in cells.zip(masses).enumerate() {
        let off = |fractions: &[f64], size: fn(f64) -> f64| {
            let found = elements.of(fractions);
            let pairs = found.iter().zip(masses);
            pairs.fold(0.0, |worst: f64, (found, mass)| {
                worst.max(size(mass - found))
            })
        };
        if off(fractions, f64::abs) < NO_LACK {
            continue;
        }
        elements.restore(masses, fractions);
        // Less than nothing of an element, which corrections of diffusion leave, no species can have.
        if off(fractions, |missing| missing) >= NO_LACK {
            lacking.push(cell);
        }
        // What is missing of an element that is there in traces is round-off of the others.
        let sum: f64 = fractions.iter().sum();
        fractions.iter_mut().for_each(|y| *y /= sum);
    }
    lacking
}
