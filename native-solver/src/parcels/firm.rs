//! The stress of a firm bed (docs/theory.md, NSP-1): what keeps packed cells from being compressed by the velocities of the solid, and
//! no more.
//!
//! It is Δt² Σ_f φ_f A_f (τ_P − τ_N)/(ρ_f d_f) ≥ what flows into the cell, τ ≥ 0, one of both an equation: a linear complementarity
//! problem, solved by primal and dual active sets (Hintermüller, Ito and Kunisch 2002, doi 10.1137/S1052623401383558).

use calcine_coupler::physics::parcels::HarrisCrighton;

use super::packing::{CellSolid, Packer};

/// Times at most that cells which push are chosen anew.
const ACTIVE_SETS: u32 = 30;
/// Share of their residual that linear equations leave.
const SOLVED: f64 = 1e-8;
/// A cell is packed where parcels are moved apart by a stress above this share of its law's constant.
const PACKED: f64 = 0.01;

impl Packer {
    /// The stress in Pa of a firm bed over a step in s; `stress` is that which moves parcels apart, `conductance` that of faces
    /// between cells in m³/Pa.
    pub(super) fn firm_stress(
        &mut self,
        law: &HarrisCrighton,
        (stress, solid, conductance): (&[f64], &CellSolid, &[f64]),
        time: f64,
    ) -> Vec<f64> {
        let inflow = self.inflow(solid, time);
        let packed: Vec<bool> = stress
            .iter()
            .map(|one| *one > PACKED * law.pressure)
            .collect();
        let mut active = packed.clone();
        let mut found = vec![0.0; stress.len()];
        for _ in 0..ACTIVE_SETS {
            self.solve_active(&active, (&inflow, conductance), &mut found);
            let mut changed = false;
            let mut next = active.clone();
            for (cell, pushes) in next.iter_mut().enumerate() {
                *pushes = packed[cell]
                    && match active[cell] {
                        true => found[cell] > 0.0,
                        false => inflow[cell] + self.pushed(cell, conductance, &found) > 0.0,
                    };
                changed |= *pushes != active[cell];
            }
            active = next;
            if !changed {
                break;
            }
        }
        found.iter_mut().for_each(|one| *one = one.max(0.0));
        found
    }

    /// What flows into each cell in a step, in m³ of solid.
    fn inflow(&self, solid: &CellSolid, time: f64) -> Vec<f64> {
        let mut inflow = vec![0.0; solid.mass.len()];
        for face in &self.grid.faces[..self.grid.internal] {
            let (own, other) = (face.owner, face.neighbour);
            let mass = solid.mass[own] + solid.mass[other];
            if mass > 0.0 {
                let mean = (solid.momentum[own] + solid.momentum[other]) / mass;
                let speed = mean.dot(&face.normal);
                let from = if speed > 0.0 { own } else { other };
                let volume = time * face.area * speed * solid.fraction[from];
                inflow[own] -= volume;
                inflow[other] += volume;
            }
        }
        inflow
    }

    /// What the stress of its neighbours pushes into a cell, in m³.
    fn pushed(&self, cell: usize, conductance: &[f64], stress: &[f64]) -> f64 {
        let links = self.grid.links(cell).iter();
        links
            .filter(|link| !link.is_boundary())
            .map(|link| conductance[link.face as usize] * stress[link.other as usize])
            .sum()
    }

    /// Solves for the stress of cells that push; there is none in the others.
    fn solve_active(
        &mut self,
        active: &[bool],
        (inflow, conductance): (&[f64], &[f64]),
        found: &mut [f64],
    ) {
        for (found, active) in found.iter_mut().zip(active) {
            if !active {
                *found = 0.0;
            }
        }
        let cells = active.iter().zip(inflow);
        let right: Vec<f64> = cells
            .map(|(active, inflow)| if *active { *inflow } else { 0.0 })
            .collect();
        let stored = |cell: usize| active[cell].then_some(0.0);
        self.system
            .solve(conductance, stored, (&right, found), SOLVED);
    }
}
