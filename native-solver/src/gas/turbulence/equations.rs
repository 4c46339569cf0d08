//! The equations of ε_t and k over a window, one after the other. Implicit Euler; convection upwind whatever that
//! of the other fields is; what is destroyed is linear in the new value, what is made explicit.
//!
//! What particles make of eddies in a bed is stiff, and k and ε_t are solved one after the other: steps are then divided, so that
//! none is longer than half of the time of the eddies that the particles drive to, and end where nothing changes any more.
//!
//! k and ε_t stay positive without being bounded: what is made, inflow and the old value are not negative, the
//! matrices are M-matrices, and where skewed cells take more by diffusion along faces than they get, that is
//! a sink in proportion to the new value (Patankar 1980, Numerical Heat Transfer and Fluid Flow, section 7.2-2). So
//! no solution is below what a cell would have if nothing came from its neighbours; the linear solver's rounding
//! is cut there, and only there.

use calcine_coupler::extreme::larger;
use calcine_coupler::part::EddyExchange;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::turbulence::{Turbulence, is_free};
use nalgebra::Matrix3;

use super::super::failure::{GasFailure, Place};
use super::eddies::Eddies;
use super::update_viscosity;
use super::wall::{self, WallFace, WallLaw, wall_faces};
use crate::gas::boundary::{Boundaries, FaceCondition};
use crate::gas::state::GasState;
use crate::numerics::grid::{CellFace, MeshGraph};
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, displacement, gradients, outflow};
use crate::numerics::parallel::{fill, largest, update};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// Longest part of a step over the time k/ε_t of the eddies that particles drive to.
const PART: f64 = 0.5;
/// Relative change of k and ε_t in a part of a step below which they are steady, and the rest of the step changes nothing.
const STEADY: f64 = 1e-8;

/// What a step of the eddies looks at, beside the state that it advances.
#[derive(Clone, Copy, Debug)]
pub struct TurbulenceStep<'a> {
    /// Faces and links.
    pub grid: &'a MeshGraph,
    /// Boundary values.
    pub boundary: &'a Boundaries,
    /// Properties of the gas.
    pub gas: &'a GasModel,
    /// Void fraction × viscosity of each cell in Pa s, that of the eddies at hand included.
    pub viscosity: &'a [f64],
    /// ∂u_i/∂x_j of each cell in 1/s.
    pub gradients: &'a [Matrix3<f64>],
    /// Where they reach.
    pub turbulence: &'a Turbulence,
    /// What particles make of them; empty where they end at the bed.
    pub particles: &'a EddyExchange,
    /// Motion span Δt in s.
    pub span: f64,
    /// Tolerance of the linear solver, relative to the terms of its equation.
    pub tolerance: f64,
    /// Its iterations at most.
    pub iterations: u32,
}

/// The two equations and their scratch memory.
#[derive(Debug)]
pub struct KEpsilonEquations {
    model: KEpsilon,
    law: WallLaw,
    walls: Vec<WallFace>,
    matrix: Matrix,
    preconditioner: Incomplete,
    /// Largest relative residual of a solve of the last step that ended above its tolerance.
    unsolved: Option<f64>,
    source: Vec<f64>,
    /// Void fraction × viscosity of each cell in Pa s, that of the eddies at hand included.
    viscosity: Vec<f64>,
    /// M/Δt of each cell in kg/s.
    inertia: Vec<f64>,
    /// P of each cell in 1/s²; zero in a bed at which eddies end.
    strain: Vec<f64>,
    /// ∇·u of each cell in 1/s.
    divergence: Vec<f64>,
    /// ε_t of cells at walls in m²/s³; zero elsewhere.
    at_wall: Vec<f64>,
    /// k that is made in each cell in W.
    made: Vec<f64>,
    /// Diffusive conductance of each face in kg/s.
    diffusion: Vec<f64>,
    /// What diffusion along faces brings to each cell.
    along: Vec<f64>,
    gradients: Vec<Vec3>,
    faces: Vec<f64>,
}

/// One of the two scalars, as its equation sees it.
struct Scalar<'a, S> {
    /// σ.
    prandtl: f64,
    /// Values before.
    old: &'a [f64],
    /// Value on an inlet's face.
    inlet: fn([f64; 2]) -> f64,
    /// What is made in a cell, and the coefficient of what is destroyed, both per time.
    rates: S,
    /// The value of a cell that is given.
    given: &'a [f64],
}

impl KEpsilonEquations {
    /// Empty equations on a matrix's graph.
    pub fn new(matrix: Matrix, boundary: &Boundaries) -> Self {
        let grid = matrix.grid().clone();
        let (cells, faces) = (grid.cells(), grid.faces.len());
        let zeros = || vec![0.0; cells];
        Self {
            model: KEpsilon::STANDARD,
            law: WallLaw::new(),
            walls: wall_faces(&grid, boundary),
            matrix,
            preconditioner: Incomplete::default(),
            unsolved: None,
            source: zeros(),
            viscosity: zeros(),
            inertia: zeros(),
            strain: zeros(),
            divergence: zeros(),
            at_wall: zeros(),
            made: zeros(),
            diffusion: vec![0.0; faces],
            along: zeros(),
            gradients: vec![Vec3::zeros(); cells],
            faces: vec![0.0; faces],
        }
    }

    /// Largest relative residual of the last step's solves that ended above their tolerance.
    pub fn unsolved(&self) -> Option<f64> {
        self.unsolved
    }

    /// Advances k, ε_t and the eddy viscosities of a state by the step; what diverged otherwise.
    pub fn advance(
        &mut self,
        step: &TurbulenceStep<'_>,
        krylov: &mut Krylov,
        now: &mut GasState,
    ) -> Result<(), GasFailure> {
        self.unsolved = None;
        self.viscosity.clear();
        self.viscosity.extend_from_slice(step.viscosity);
        let parts = self.parts(step);
        for left in (1..=parts).rev() {
            let change = self.advance_part(step, (parts, left), krylov, now)?;
            if change <= STEADY {
                break;
            }
        }
        Ok(())
    }

    /// Into how many parts a step is divided.
    fn parts(&self, step: &TurbulenceStep<'_>) -> u32 {
        let made = step.particles;
        // ε∞/k∞, or b.
        let rate = |cell: usize| match made.energy[cell] > 0.0 {
            true => made.dissipation[cell] / (self.model.destruction * made.energy[cell]),
            false => made.growth[cell],
        };
        let fastest = (0..made.energy.len()).map(rate).fold(0.0, f64::max);
        (step.span * fastest / PART).ceil().max(1.0) as u32
    }

    /// Advances them by a part of the step, so many of which are left with this one; the largest relative change of k or ε_t.
    fn advance_part(
        &mut self,
        step: &TurbulenceStep<'_>,
        (parts, left): (u32, u32),
        krylov: &mut Krylov,
        now: &mut GasState,
    ) -> Result<f64, GasFailure> {
        self.measure(step, (parts, left), now);
        let mut eddies = std::mem::take(&mut now.turbulence);
        let dissipation = self.dissipation(step, krylov, now, &eddies);
        let energy = self.energy(step, krylov, now, &eddies, &dissipation);
        let change = |old: &[f64], new: &[f64]| {
            largest(old.len(), |cell| (new[cell] / old[cell] - 1.0).abs()).1
        };
        let change = larger(
            change(&eddies.energy, &energy),
            change(&eddies.dissipation, &dissipation),
        );
        (eddies.energy, eddies.dissipation) = (energy, dissipation);
        let before = eddies.viscosity.clone();
        now.turbulence = eddies;
        update_viscosity(step.grid, step.boundary, step.gas, step.turbulence, now);
        let after = &now.turbulence.viscosity;
        update(&mut self.viscosity, |cell, sum| {
            *sum += after[cell] - before[cell];
        });
        check(step.grid, &now.turbulence)?;
        Ok(change)
    }

    /// What velocity and walls do to both: P, ∇·u, and the values of cells at walls.
    fn measure(&mut self, step: &TurbulenceStep<'_>, (parts, left): (u32, u32), now: &GasState) {
        let grid = step.grid;
        let (mass, flux) = (&now.mass, &now.flux);
        let span = step.span / f64::from(parts);
        fill(&mut self.inertia, |cell| {
            mass[cell] / span + f64::from(left) * outflow(grid, flux, cell)
        });
        fill(&mut self.strain, |cell| {
            if step.turbulence.reaches(now.void_fraction[cell]) {
                strain(&step.gradients[cell])
            } else {
                0.0
            }
        });
        fill(&mut self.divergence, |cell| {
            divergence(grid, step.boundary, now, cell)
        });
        let Eddies {
            energy,
            viscosity,
            boundary,
            ..
        } = &now.turbulence;
        let strain = &self.strain;
        fill(&mut self.made, |cell| {
            viscosity[cell] * strain[cell] * grid.volume[cell]
        });
        // The eddies in the pores of a bed are those of its particles, at walls too.
        let by_wall =
            |cell: usize| is_free(now.void_fraction[cell]) || !step.turbulence.is_in_bed();
        for wall in &self.walls {
            self.at_wall[wall.cell] = 0.0;
            if by_wall(wall.cell) {
                self.made[wall.cell] = 0.0;
            }
        }
        for wall in self.walls.iter().filter(|wall| by_wall(wall.cell)) {
            let &WallFace { face, cell, share } = wall;
            let distance = grid.faces[face].distance();
            self.at_wall[cell] += share * self.law.dissipation(energy[cell], distance);
            let FaceCondition::Wall {
                sticks: Some(velocity),
                ..
            } = *step.boundary.at(face)
            else {
                continue;
            };
            if is_free(now.void_fraction[cell]) {
                let laminar = wall::viscosity(step.boundary, step.gas, now, face, cell);
                let stress = (laminar + boundary[face - grid.internal])
                    * (now.velocity[cell] - velocity).norm()
                    / distance;
                let shear = self.law.shear(energy[cell], distance);
                self.made[cell] += share * stress * shear * grid.volume[cell];
            }
        }
    }

    fn dissipation(
        &mut self,
        step: &TurbulenceStep<'_>,
        krylov: &mut Krylov,
        now: &GasState,
        eddies: &Eddies,
    ) -> Vec<f64> {
        let model = self.model;
        let (strain, divergence) = (
            std::mem::take(&mut self.strain),
            std::mem::take(&mut self.divergence),
        );
        let given = std::mem::take(&mut self.at_wall);
        let Eddies {
            energy,
            dissipation: old,
            ..
        } = eddies;
        let expansion = 2.0 / 3.0 * model.production;
        let particles = |cell: usize| match step.particles.dissipation.get(cell) {
            Some(made) => made + model.destruction * step.particles.growth[cell] * old[cell],
            None => 0.0,
        };
        let rates = |cell: usize| {
            let mass = now.mass[cell];
            let made = model.production * model.viscosity * energy[cell] * strain[cell];
            let squeezed = expansion * (-divergence[cell]).max(0.0) * old[cell];
            let destroyed = model.destruction * old[cell] / energy[cell]
                + expansion * divergence[cell].max(0.0);
            [mass * (made + squeezed + particles(cell)), mass * destroyed]
        };
        let scalar = Scalar {
            prandtl: model.dissipation_prandtl,
            old,
            inlet: |[_, dissipation]| dissipation,
            rates,
            given: &given,
        };
        let new = self.solve(step, krylov, now, eddies, &scalar);
        (self.strain, self.divergence, self.at_wall) = (strain, divergence, given);
        new
    }

    fn energy(
        &mut self,
        step: &TurbulenceStep<'_>,
        krylov: &mut Krylov,
        now: &GasState,
        eddies: &Eddies,
        dissipation: &[f64],
    ) -> Vec<f64> {
        let model = self.model;
        let (made, divergence) = (
            std::mem::take(&mut self.made),
            std::mem::take(&mut self.divergence),
        );
        let old = &eddies.energy;
        let particles = |cell: usize| match step.particles.energy.get(cell) {
            Some(made) => made + step.particles.growth[cell] * old[cell],
            None => 0.0,
        };
        let rates = |cell: usize| {
            let mass = now.mass[cell];
            let squeezed = 2.0 / 3.0 * (-divergence[cell]).max(0.0) * old[cell];
            let destroyed = dissipation[cell] / old[cell] + 2.0 / 3.0 * divergence[cell].max(0.0);
            [
                made[cell] + mass * (squeezed + particles(cell)),
                mass * destroyed,
            ]
        };
        let scalar = Scalar {
            prandtl: model.energy_prandtl,
            old,
            inlet: |[energy, _]| energy,
            rates,
            given: &[],
        };
        let new = self.solve(step, krylov, now, eddies, &scalar);
        (self.made, self.divergence) = (made, divergence);
        new
    }

    /// Solves the equation of a scalar; its new values.
    fn solve<S: Fn(usize) -> [f64; 2] + Sync>(
        &mut self,
        step: &TurbulenceStep<'_>,
        krylov: &mut Krylov,
        now: &GasState,
        eddies: &Eddies,
        scalar: &Scalar<'_, S>,
    ) -> Vec<f64> {
        let (grid, boundary) = (step.grid, step.boundary);
        let inlet = |index: usize| match *boundary.at(index) {
            FaceCondition::Inlet {
                superficial_velocity,
                ..
            } if superficial_velocity > 0.0 => {
                let pores = now.void_fraction[grid.faces[index].owner];
                Some((scalar.inlet)(boundary.eddies(index, pores)))
            }
            _ => None,
        };
        self.update_diffusion(step, now, eddies, scalar.prandtl);
        self.update_along(grid, scalar.old, inlet);
        let (inertia, diffusion, along) = (&self.inertia, &self.diffusion, &self.along);
        let given = |cell: usize| scalar.given.get(cell).is_some_and(|value| *value > 0.0);
        self.matrix.assemble(|cell, diagonal, neighbours| {
            *diagonal = inertia[cell];
            if given(cell) {
                return;
            }
            *diagonal += (scalar.rates)(cell)[1] + (-along[cell]).max(0.0) / scalar.old[cell];
            for link in grid.links(cell) {
                let index = link.face as usize;
                let weight = (-link.sign * now.flux[index]).max(0.0) + diffusion[index];
                if !link.is_boundary() {
                    neighbours[link.slot as usize] -= weight;
                    *diagonal += weight;
                } else if inlet(index).is_some() {
                    *diagonal += weight;
                }
            }
        });
        fill(&mut self.source, |cell| {
            if given(cell) {
                return inertia[cell] * scalar.given[cell];
            }
            let mut source =
                inertia[cell] * scalar.old[cell] + (scalar.rates)(cell)[0] + along[cell].max(0.0);
            for link in grid.links(cell).iter().filter(|link| link.is_boundary()) {
                let index = link.face as usize;
                if let Some(value) = inlet(index) {
                    let weight = (-link.sign * now.flux[index]).max(0.0) + diffusion[index];
                    source += weight * value;
                }
            }
            source
        });
        let target = SolveTolerance {
            absolute: 0.0,
            of_terms: step.tolerance,
            relative: 0.0,
            iterations: step.iterations,
        };
        let mut new = scalar.old.to_vec();
        self.preconditioner.expire();
        let Self {
            matrix,
            preconditioner,
            source,
            unsolved,
            ..
        } = self;
        let solved = krylov.general(matrix, preconditioner, source, &mut new, target);
        if !solved.converged {
            let residual = solved.residual / matrix.terms(&new, source);
            *unsolved = Some(unsolved.map_or(residual, |other| larger(other, residual)));
        }
        // Exactly solved none is lower: see above.
        let diagonal = matrix.diagonal();
        update(&mut new, |cell, value| {
            *value = value.max(source[cell] / diagonal[cell]);
        });
        new
    }

    fn update_diffusion(
        &mut self,
        step: &TurbulenceStep<'_>,
        now: &GasState,
        eddies: &Eddies,
        prandtl: f64,
    ) {
        let grid = step.grid;
        // The eddies' share of the viscosity counts with 1/σ.
        let less = 1.0 - 1.0 / prandtl;
        let viscosity = &self.viscosity;
        let coefficient = |cell: usize| viscosity[cell] - less * eddies.viscosity[cell];
        fill(&mut self.diffusion, |index| {
            let face = &grid.faces[index];
            if index < grid.internal {
                let weight = face.owner_weight();
                let mean =
                    weight * coefficient(face.owner) + (1.0 - weight) * coefficient(face.neighbour);
                return conductance(face, mean);
            }
            match *step.boundary.at(index) {
                FaceCondition::Inlet { gas, .. } => {
                    let laminar = now.void_fraction[face.owner] * gas.viscosity;
                    let eddy = eddies.boundary[index - grid.internal] / prandtl;
                    conductance(face, laminar + eddy)
                }
                FaceCondition::Wall { .. } | FaceCondition::Outlet { .. } => 0.0,
            }
        });
    }

    /// What diffusion along skewed faces brings to each cell, from the old values.
    fn update_along(
        &mut self,
        grid: &MeshGraph,
        old: &[f64],
        inlet: impl Fn(usize) -> Option<f64> + Sync,
    ) {
        if grid.orthogonal {
            return;
        }
        let boundary = |index: usize, _: f64| inlet(index);
        gradients(grid, old, boundary, &mut self.gradients, &mut self.faces);
        let (gradients, diffusion) = (&self.gradients, &self.diffusion);
        fill(&mut self.along, |cell| {
            let one = |sum: f64, link: &CellFace| {
                let index = link.face as usize;
                if diffusion[index] == 0.0 {
                    return sum;
                }
                let face = &grid.faces[index];
                sum - link.sign * diffusion[index] * displacement(grid, face, gradients)
            };
            grid.links(cell).iter().fold(0.0, one)
        });
    }
}

/// ∇·u of a cell in 1/s, from the fluxes: gas that flows in has the velocity of the inlet, not the cell's density.
fn divergence(grid: &MeshGraph, boundary: &Boundaries, now: &GasState, cell: usize) -> f64 {
    let held = |cell: usize| now.mass[cell] / grid.volume[cell];
    let volume = |sum: f64, link: &CellFace| {
        let index = link.face as usize;
        let face = &grid.faces[index];
        if !link.is_boundary() {
            let weight = face.owner_weight();
            let density = weight * held(face.owner) + (1.0 - weight) * held(face.neighbour);
            return sum + link.sign * now.flux[index] / density;
        }
        match *boundary.at(index) {
            FaceCondition::Inlet {
                superficial_velocity,
                ..
            } => sum - superficial_velocity / now.void_fraction[cell] * face.area,
            _ => sum + link.sign * now.flux[index] / held(cell),
        }
    };
    grid.links(cell).iter().fold(0.0, volume) / grid.volume[cell]
}

/// P = ∇u : (∇u + ∇uᵀ − ⅔ ∇·u) in 1/s², zero or above.
#[inline]
fn strain(gradient: &Matrix3<f64>) -> f64 {
    let twice = gradient + gradient.transpose();
    let trace = gradient.trace();
    0.5 * twice.norm_squared() - 2.0 / 3.0 * trace * trace
}

/// Refuses turbulence that is not positive and finite.
fn check(grid: &MeshGraph, eddies: &Eddies) -> Result<(), GasFailure> {
    let (cell, strangeness) = largest(grid.cells(), |cell| {
        let [k, rate] = [eddies.energy[cell], eddies.dissipation[cell]];
        if k > 0.0 && rate > 0.0 && (k + rate + eddies.viscosity[cell]).is_finite() {
            0.0
        } else {
            1.0
        }
    });
    if strangeness == 0.0 {
        return Ok(());
    }
    Err(GasFailure::Turbulence {
        energy: eddies.energy[cell],
        dissipation: eddies.dissipation[cell],
        place: Place {
            cell,
            centre: grid.centre[cell],
        },
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
    use calcine_coupler::physics::gas::GasProperties;
    use calcine_coupler::setup::{
        Convection, GasControls, GasPatch, GasSetup, InletTurbulence, Schedule, Turbulence,
        WallHeat, WallVelocity,
    };
    use calcine_coupler::time::GasStorage;

    use super::*;

    #[test]
    fn cold_gas_expands_where_it_flows_into_hot_gas() {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.1, 0.1, 0.2),
            cells: [1, 1, 2],
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        };
        let mesh = box_mesh(&spec).unwrap();
        let grid = Arc::new(MeshGraph::new(&mesh));
        let slip = GasPatch::Wall {
            velocity: WallVelocity::Slip,
            heat: WallHeat::Adiabatic,
        };
        let GasPatch::Inlet {
            flow, temperature, ..
        } = GasPatch::inlet(Schedule::constant(1.0), Schedule::constant(300.0))
        else {
            panic!("an inlet");
        };
        let inlet = GasPatch::Inlet {
            flow,
            temperature,
            composition: None,
            turbulence: Some(InletTurbulence {
                intensity: 0.1,
                length_scale: 0.01,
            }),
            scalars: Default::default(),
        };
        let outlet = GasPatch::outlet(Schedule::constant(101_325.0));
        let air = GasProperties {
            molar_mass: 0.028_96,
            heat_capacity: 1005.0,
            sutherland_coefficient: 1.4792e-6,
            sutherland_temperature: 116.0,
        };
        let patches = [("side", slip), ("bottom", inlet), ("top", outlet)];
        let setup = GasSetup {
            mixture: "air".into(),
            properties: GasModel::from(air),
            schmidt: 1.0,
            chemistry: Default::default(),
            storage: GasStorage::Process,
            temperature: 900.0,
            composition: Vec::new(),
            pressure: 101_325.0,
            velocity: Vec3::zeros(),
            gravity: Vec3::zeros(),
            pressure_gradient: Vec3::zeros(),
            momentum: Default::default(),
            turbulence: Turbulence::Laminar,
            patches: patches.map(|(name, patch)| (name.to_owned(), patch)).into(),
            controls: GasControls {
                outer_iterations: 1,
                convection: Convection::Upwind,
                pressure_corrections: 1,
                time_scheme: Default::default(),
                most_pressure_corrections: 16,
                outer_tolerance: 1e-9,
                linear_tolerance: Some(1e-12),
            },
        };
        let boundary = Boundaries::new(&mesh, &setup).unwrap();
        let cold = setup.properties.density(101_325.0, 300.0, &[]);
        // What flows in at 1 m/s leaves a cell three times as hot at 3 m/s: 2 m/s over 0.1 m.
        let flow = cold * 0.01;
        // Out of their owners: up between the cells and at the top, down at the bottom.
        let through = |face: usize| flow * grid.faces[face].normal.z;
        let now = GasState {
            mass: vec![cold / 3.0 * 1e-3; 2],
            void_fraction: vec![1.0; 2],
            flux: (0..grid.faces.len()).map(through).collect(),
            ..GasState::default()
        };
        let rates = [0, 1].map(|cell| divergence(&grid, &boundary, &now, cell));
        assert!((rates[0] - 20.0).abs() < 1e-9, "{rates:?}");
        assert!(rates[1].abs() < 1e-9, "{rates:?}");
    }

    #[test]
    fn shear_counts_once_expansion_not_at_all() {
        let shear = Matrix3::new(0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        assert!((strain(&shear) - 9.0).abs() < 1e-14);
        assert!(strain(&(2.0 * Matrix3::identity())).abs() < 1e-14);
        let rotation = shear - shear.transpose();
        assert_eq!(strain(&rotation), 0.0);
    }
}
