//! Pressure and mass flux. A half cell between a centre and a face is a resistance in series with
//! the next one: with the force F on the gas per χ V (everything but pressure; χ the share of ∇p that the
//! gas takes, ε by model A), the mobility b = ρ ε χ V/a of the cell and the distance d to the face, the superficial mass flux
//! per area G obeys
//!
//! p_f = p_P + d_P (F_P·n − G/b_P)  and  p_N = p_f + d_N (F_N·n − G/b_N),
//!
//! so G = (d_P F_P·n + d_N F_N·n + p_P − p_N)/(d_P/b_P + d_N/b_N): Rhie–Chow with a
//! distance-weighted harmonic mean. The slopes F·n − G/b of a cell's halves give its gradient, which the
//! momentum equation takes: Σ A d n (n·∇p) = Σ A d n (F·n − G/b), the sum over faces of Gauss' theorem with what
//! lies along the faces on the left side. Where centres are displaced along a face, pressures are carried there by another
//! gradient (`update_along`), a correction later. Gas at rest stays at rest whatever the void fraction does, and a bed's resistance is exact to its last half cell. The force of inertia at a face is taken from the
//! face's own old flux, so that a steady flow does not depend on the time step; what friction and
//! convection owe to the cell's own velocity in [`super::transport`]. Rhie and Chow 1983,
//! doi 10.2514/3.8284.
//!
//! Continuity, for each cell: Σ φ_f = −(ε ρ V − m_old)/Δτ, ρ from the equation of state. What a window leaves of it, the next one makes up
//! for. A mismatch of r in kg/s changes the velocity by r h/(ρ V), h = V^⅓, within Δt, for which the pressure gradient rises by r h/(V Δt):
//! in a short window by more than the flow takes, however small r is beside what the cell holds. So r is measured by what the flow's own
//! pressure gradients and its dynamic pressure ρ u²/h amount to as well.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::FaceCondition;
use super::friction::{self, WallFriction};
use super::momentum::Momentum;
use super::opening::OuterPressure;
use super::recovery::Recovery;
use super::state::GasState;
use super::tolerance::{ContinuityResidual, LinearTolerances};
use super::transport::FaceTransport;
use crate::numerics::amg::Multigrid;
use crate::numerics::grid::{Face, MeshGraph};
use crate::numerics::krylov::{Krylov, ROUND_OFF, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{displacement, outflow};
use crate::numerics::parallel::{fill, largest, sums};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// A correction need not be solved closer than this share of its initial residual: the next one
/// continues it, and continuity holds exactly whatever the pressure (`mass` follows the flux).
const CORRECTION: f64 = 1e-2;
/// By how much of the difference the gradient that carries pressures along faces follows the slopes of a correction. On tetrahedra and polyhedra
/// that lean by 45° one part of it overshoots to −1.02 times itself in each; with this share to −0.5 times.
const FOLLOWED: f64 = 0.75;
/// A mismatch of continuity may move pressure gradients by so many tolerances of their own.
const PRESSED: f64 = 100.0;
/// Gas that nothing moves: this share of what cells hold counts among the terms of continuity at least.
const STILL: f64 = 1e-5;
/// Iterations of a solve at most.
const ITERATIONS: u32 = 2000;
/// Up to this many cells the incomplete factorisation is used. There it was measured level with the multigrid, which takes half of its time
/// at 2500 cells in two dimensions and 40 % at 10 000; in three dimensions they are level up to 8000.
const SMALL: usize = 1000;

/// Incomplete factorisation for few cells and for chains of cells, multigrid for the others.
#[derive(Debug)]
enum Approximation {
    Small(Incomplete),
    Large(Multigrid),
}

impl Approximation {
    fn new(matrix: &Matrix) -> Self {
        let cells = matrix.diagonal().len();
        // Where no two neighbours of a cell come after it, the factorisation is exact.
        let later = |cell: usize| {
            let columns = matrix.row(cell).0;
            columns.len() - columns.partition_point(|&column| column as usize <= cell)
        };
        if cells <= SMALL || (0..cells).all(|cell| later(cell) <= 1) {
            Self::Small(Incomplete::default())
        } else {
            Self::Large(Multigrid::default())
        }
    }

    fn get(&mut self) -> &mut dyn Preconditioner {
        match self {
            Self::Small(incomplete) => incomplete,
            Self::Large(multigrid) => multigrid,
        }
    }
}

/// The pressure equation of an outer iteration.
#[derive(Debug)]
pub struct Pressure {
    matrix: Matrix,
    preconditioner: Approximation,
    /// h² = V^⅔ of each cell in m².
    section: Vec<f64>,
    /// ρ ε χ V/a of each cell in s.
    mobility: Vec<f64>,
    /// b along the normal of each face, of its owner and its neighbour, in s.
    along_normal: Vec<[f64; 2]>,
    /// F of each cell in N/m³.
    force: Vec<Vec3>,
    /// What inertia adds to the force on the half cells of each face's owner and neighbour, along
    /// the face's normal, in N/m³: the face's own old flux in place of the cell's.
    inertia: Vec<[f64; 2]>,
    /// What those halves lose by N of their cells' velocity along each face, in N/m³; empty where they lose nothing.
    across: Vec<[f64; 2]>,
    transport: FaceTransport,
    friction: WallFriction,
    /// Area/(d_P/b_P + d_N/b_N) of each face in m s; zero where the flux is given.
    conductance: Vec<f64>,
    /// The flux that the forces alone would drive through each face in kg/s; the flux itself
    /// where it is given.
    drive: Vec<f64>,
    source: Vec<f64>,
    /// Pressure at each face of the boundary, where gas passes freely.
    outer: Vec<Option<OuterPressure>>,
    recovery: Recovery,
    /// What the old mass flux per area has at each face beyond its cells', divided as the inertia; empty where cells do not need it.
    old_reach: Vec<[f64; 2]>,
    /// What Σ S (x_f − x_P)ᵀ/V of each cell lacks of the identity, as its faces are warped; empty where it lacks nothing.
    warp: Vec<Matrix3<f64>>,
    /// Σ p_f S/V of each cell in Pa/m, p_f from the cell's own half; empty where no centre is displaced along a face.
    along: Vec<Vec3>,
    /// What slopes of pressure in half cells have beyond F (`update_slopes`).
    slopes: Vec<[f64; 2]>,
    /// Corrections since the matrix was assembled.
    corrections: u32,
    /// True where a sequence of corrections is to follow friction and what transport does at faces.
    follows: bool,
    /// Memory for the next; after a correction, what carried pressures along faces in it.
    scratch: Vec<Vec3>,
    /// True from a correction on until something else changes what it left.
    corrected: bool,
}

impl Pressure {
    /// An empty equation on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        let (cells, faces) = (matrix.grid().cells(), matrix.grid().faces.len());
        let recovery = Recovery::new(matrix.grid(), Vec::new());
        let warp = warp(matrix.grid());
        Self {
            preconditioner: Approximation::new(&matrix),
            section: (matrix.grid().volume.iter())
                .map(|volume| volume.cbrt().powi(2))
                .collect(),
            matrix,
            mobility: vec![0.0; cells],
            along_normal: vec![[0.0; 2]; faces],
            force: vec![Vec3::zeros(); cells],
            inertia: vec![[0.0; 2]; faces],
            across: Vec::new(),
            transport: FaceTransport::new(cells, faces),
            friction: WallFriction::default(),
            conductance: vec![0.0; faces],
            drive: vec![0.0; faces],
            source: vec![0.0; cells],
            outer: Vec::new(),
            recovery,
            old_reach: Vec::new(),
            warp,
            along: Vec::new(),
            slopes: vec![[0.0; 2]; faces],
            corrections: 0,
            follows: false,
            scratch: Vec::new(),
            corrected: false,
        }
    }

    /// Drops what earlier attempts left, so that a repeated or resumed window takes the same path.
    pub fn forget(&mut self, frame: &AttemptFrame<'_>) {
        if let Approximation::Large(multigrid) = &mut self.preconditioner {
            multigrid.forget();
        }
        self.carry_by(frame, &frame.old.pressure_gradient);
    }

    /// Pressures are carried along faces by this gradient.
    pub fn carry_by(&mut self, frame: &AttemptFrame<'_>, gradient: &[Vec3]) {
        self.corrected = false;
        if !frame.grid.orthogonal {
            self.along.clear();
            self.along.extend_from_slice(gradient);
        }
    }

    /// The gradient in Pa/m that carries pressures along faces; empty where no centre is displaced along a face.
    pub fn along(&self) -> &[Vec3] {
        &self.along
    }

    /// The same, to change.
    pub fn along_mut(&mut self) -> &mut [Vec3] {
        self.corrected = false;
        &mut self.along
    }

    /// Takes up the state from which the frame steps.
    pub fn begin(&mut self, frame: &AttemptFrame<'_>) {
        let (grid, old) = (frame.grid, frame.old);
        if !self.recovery.has_wedges() && frame.boundary.has_wedges() {
            let wedge = (grid.internal..grid.faces.len())
                .map(|index| frame.boundary.is_wedge(index))
                .collect();
            self.recovery = Recovery::new(grid, wedge);
        }
        fill(&mut self.inertia, |index| {
            let face = &grid.faces[index];
            let half = |cell: usize| {
                let held = old.mass[cell] / grid.volume[cell];
                let difference =
                    old.flux[index] / face.area - held * old.velocity[cell].dot(&face.normal);
                difference / (frame.motion_span * frame.pressure_share[cell])
            };
            let neighbour = if index < grid.internal {
                half(face.neighbour)
            } else {
                0.0
            };
            [half(face.owner), neighbour]
        });
        self.old_reach.clear();
        if !grid.orthogonal {
            self.old_reach.resize(grid.faces.len(), [0.0; 2]);
            let reach = self.transport.old_reach(frame);
            fill(&mut self.old_reach, |index| {
                let face = &grid.faces[index];
                let per = |cell: usize| frame.motion_span * frame.pressure_share[cell];
                let [own, other] = reach[index];
                match index < grid.internal {
                    true => [own / per(face.owner), other / per(face.neighbour)],
                    false => [own / per(face.owner), 0.0],
                }
            });
        }
    }

    /// Assembles the matrix for the momentum equation and properties at hand, for so many corrections.
    pub fn assemble(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        momentum: &Momentum,
        corrections: u32,
        now: &GasState,
    ) {
        self.transport
            .update(frame, material, momentum, &self.recovery, now);
        self.corrections = 0;
        self.follows = corrections > friction::HELD;
        match self.follows {
            true => self.friction.release(),
            false => self.friction.begin(frame, momentum, &now.velocity),
        }
        let grid = frame.grid;
        fill(&mut self.mobility, |cell| {
            let pores = frame.void_fraction[cell];
            material.density[cell] * pores * frame.pressure_share[cell] * grid.volume[cell]
                / momentum.matrix.diagonal()[cell]
        });
        self.outer.resize(grid.faces.len() - grid.internal, None);
        fill(&mut self.outer, |face| {
            let index = grid.internal + face;
            OuterPressure::about(frame, index, now.flux[index])
        });
        let mut along_normal = std::mem::take(&mut self.along_normal);
        fill(&mut along_normal, |index| {
            let face = &grid.faces[index];
            let own = self.mobility_along(momentum, face.owner, face);
            let inside = index < grid.internal;
            let other = inside.then(|| self.mobility_along(momentum, face.neighbour, face));
            [own, other.unwrap_or(f64::INFINITY)]
        });
        self.along_normal = along_normal;
        let mut conductance = std::mem::take(&mut self.conductance);
        let outer = &self.outer;
        fill(&mut conductance, |index| {
            let face = &grid.faces[index];
            let [own, other] = self.along_normal[index];
            let resistance = face.owner_distance / own;
            if index < grid.internal {
                face.area / (resistance + face.neighbour_distance / other)
            } else if let Some(outer) = outer[index - grid.internal] {
                face.area / (resistance + face.area * outer.slope)
            } else {
                0.0
            }
        });
        self.conductance = conductance;
        let conductance = &self.conductance;
        let closed = frame.boundary.closed();
        self.matrix.assemble(|cell, diagonal, neighbours| {
            for link in grid.links(cell) {
                let weight = conductance[link.face as usize];
                *diagonal += weight;
                if !link.is_boundary() {
                    neighbours[link.slot as usize] -= weight;
                }
            }
            // In a closed domain the pressure of the first cell is the base pressure; no gas flows for
            // it, because the wanted outflows of all cells sum to what flows in.
            if closed && cell == 0 {
                *diagonal *= 2.0;
            }
        });
        self.preconditioner.get().expire();
    }

    /// One correction: new pressure, fluxes, pressure gradient and velocity; returns the linear
    /// iterations.
    pub fn correct(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        momentum: &Momentum,
        krylov: &mut Krylov,
        tolerance: &LinearTolerances,
        now: &mut GasState,
    ) -> u32 {
        let grid = frame.grid;
        if (grid.orthogonal || self.follows) && self.corrections > 0 {
            self.transport
                .update(frame, material, momentum, &self.recovery, now);
        }
        let (velocity, friction) = (&now.velocity, &self.friction);
        fill(&mut self.force, |cell| {
            let back = friction.given_back(grid, cell, &velocity[cell]);
            (momentum.without_pressure(cell, velocity) + back)
                / (frame.pressure_share[cell] * grid.volume[cell])
        });
        self.update_across(frame, momentum, velocity);
        self.update_drive(frame);

        let (drive, conductance, outer) = (&self.drive, &self.conductance, &self.outer);
        fill(&mut self.source, |cell| {
            let mut source = target(frame, material, now, cell) - outflow(grid, drive, cell);
            for link in grid.links(cell).iter().filter(|link| link.is_boundary()) {
                let index = link.face as usize;
                if let Some(outer) = outer[index - grid.internal] {
                    source += conductance[index] * outer.pressure;
                }
            }
            source
        });
        let target = SolveTolerance {
            absolute: tolerance.continuity,
            of_terms: tolerance.terms,
            relative: CORRECTION,
            iterations: ITERATIONS,
        };
        let solved = krylov.symmetric(
            &self.matrix,
            self.preconditioner.get(),
            &self.source,
            &mut now.pressure,
            target,
        );
        tracing::debug!("pressure: {} linear iterations", solved.iterations);
        self.update_flux(frame, now);
        self.corrections += 1;
        self.update_slopes(&now.flux);
        self.update_along(frame, momentum);
        self.update_velocity(frame, momentum, now);
        self.corrected = true;
        solved.iterations
    }

    /// By how much the velocity of the worst cell would change in m/s if fluxes and the mean of them took up what the last correction changed of two
    /// gradients: that which carries pressures along faces, and that of mass velocities, by which faces differ from cells. Zero where lines
    /// between centres are normal to faces. Neither momentum, whose pressure gradient is the one that leaves the mean, nor continuity sees it.
    pub fn unsettled(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        now: &GasState,
    ) -> f64 {
        let grid = frame.grid;
        if grid.orthogonal || !self.corrected {
            return 0.0;
        }
        self.transport.update_reach(frame, material, now);
        let (reach, last_reach) = (&self.transport.reach, &self.transport.last_reach);
        let (along, last_along) = (&self.along, &self.scratch);
        let mut missed = std::mem::take(&mut self.drive);
        fill(&mut missed, |index| {
            let face = &grid.faces[index];
            let moved = displacement(grid, face, along) - displacement(grid, face, last_along);
            self.conductance[index] * moved / face.area
        });
        let (_, worst) = largest(grid.cells(), |cell| {
            let part = |index: usize, side: usize| {
                missed[index] - (reach[index][side] - last_reach[index][side])
            };
            let held = material.density[cell] * frame.void_fraction[cell];
            self.recovery.vector(grid, cell, part).norm() / held
        });
        self.drive = missed;
        worst
    }

    /// Σ over openings of the flow in kg/s that the pressure there, linear in the flux, is off from that at the flux at
    /// hand.
    fn missed_at_openings(&self, frame: &AttemptFrame<'_>, now: &GasState) -> f64 {
        let internal = frame.grid.internal;
        let [missed] = sums(self.outer.len(), |face| {
            let index = internal + face;
            let miss =
                self.outer[face].map_or(0.0, |outer| outer.miss(frame, index, now.flux[index]));
            [self.conductance[index] * miss.abs()]
        });
        missed
    }

    /// Continuity with the fluxes at hand.
    pub fn residual(
        &self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        now: &GasState,
    ) -> ContinuityResidual {
        let grid = frame.grid;
        let [error, through, held, pressed] = sums(grid.cells(), |cell| {
            let (mut net, mut through) = (0.0, 0.0);
            for link in grid.links(cell) {
                let flux = now.flux[link.face as usize];
                net += link.sign * flux;
                through += 0.5 * flux.abs();
            }
            let held = frame.old.mass[cell] / frame.storage_span;
            let error = (target(frame, material, now, cell) - net).abs();
            let round_off = ROUND_OFF * (held + through);
            let error = if error <= round_off { 0.0 } else { error };
            let pushed = self.section[cell] * now.pressure_gradient[cell].norm();
            [error, through, held, pushed]
        });
        // ρ u² V Δt/h², of all cells by their means.
        let spans = frame.motion_span / frame.storage_span;
        let moved = pressed * frame.motion_span + spans * through * through / held;
        let terms = (through + held).min(frame.closer() * (PRESSED * moved + STILL * held));
        ContinuityResidual {
            share: (error + self.missed_at_openings(frame, now)) / terms,
            terms,
            renewals: through / held,
        }
    }

    /// b of a cell along a face's normal, in s: with what walls without friction add to the diagonal there.
    #[inline]
    fn mobility_along(&self, momentum: &Momentum, cell: usize, face: &Face) -> f64 {
        let mobility = self.mobility[cell];
        match momentum.normal.tensor(cell) {
            None => mobility,
            Some(_) => {
                let added = momentum.normal.along(cell, &face.normal);
                mobility / (1.0 + added / momentum.matrix.diagonal()[cell])
            }
        }
    }

    /// The force on the two halves at a face beyond that on their cells, along its normal, in N/m³.
    #[inline]
    fn beside(&self, index: usize) -> [f64; 2] {
        let [own, other] = self.inertia[index];
        match self.across.get(index) {
            None => [own, other],
            Some(across) => [own - across[0], other - across[1]],
        }
    }

    /// What the slope of pressure in the half cells of each face's owner and neighbour has along its normal beyond the cell's own force F,
    /// but for what the flux and the old one have there beyond the cell's by their gradients; in Pa/m.
    fn update_slopes(&mut self, flux: &[f64]) {
        let mut slopes = std::mem::take(&mut self.slopes);
        let (grid, reach, old) = (self.matrix.grid(), &self.transport.reach, &self.old_reach);
        fill(&mut slopes, |index| {
            let passing = flux[index] / grid.faces[index].area;
            let ([own, other], [b_own, b_other]) = (self.beside(index), self.along_normal[index]);
            match (reach.get(index), old.get(index)) {
                (Some(reach), Some(old)) => [
                    own - old[0] - (passing - reach[0]) / b_own,
                    other - old[1] - (passing - reach[1]) / b_other,
                ],
                _ => [own - passing / b_own, other - passing / b_other],
            }
        });
        self.slopes = slopes;
    }

    /// Force on the half cell of a face's owner along the face's normal, in N/m³.
    #[inline]
    fn owner_force(&self, face: &Face, index: usize) -> f64 {
        self.force[face.owner].dot(&face.normal) + self.beside(index)[0]
    }

    fn update_across(&mut self, frame: &AttemptFrame<'_>, momentum: &Momentum, velocity: &[Vec3]) {
        let grid = frame.grid;
        if momentum.normal.is_square() {
            self.across.clear();
            return;
        }
        self.across.resize(grid.faces.len(), [0.0; 2]);
        fill(&mut self.across, |index| {
            let face = &grid.faces[index];
            let half = |cell: usize| {
                let pull = momentum.normal.across(cell, &face.normal, &velocity[cell]);
                pull / (frame.pressure_share[cell] * grid.volume[cell])
            };
            let own = half(face.owner);
            let inside = index < grid.internal;
            [own, if inside { half(face.neighbour) } else { 0.0 }]
        });
    }

    /// What transport adds to the pressure difference between the cells of an internal face, in Pa.
    #[inline]
    fn transport_push(&self, face: &Face, index: usize) -> f64 {
        let [own, other] = self.transport.force[index];
        face.owner_distance * own + face.neighbour_distance * other
    }

    fn update_drive(&mut self, frame: &AttemptFrame<'_>) {
        let mut drive = std::mem::take(&mut self.drive);
        fill(&mut drive, |index| {
            let face = &frame.grid.faces[index];
            if index >= frame.grid.internal {
                match *frame.boundary.at(index) {
                    FaceCondition::Inlet { mass_flux, .. } => return -mass_flux * face.area,
                    FaceCondition::Wall { .. } => return 0.0,
                    FaceCondition::Outlet { .. } => {}
                }
            }
            let mut push = face.owner_distance * self.owner_force(face, index);
            if index < frame.grid.internal {
                let force = self.force[face.neighbour].dot(&face.normal) + self.beside(index)[1];
                push += face.neighbour_distance * force + self.transport_push(face, index);
            }
            self.conductance[index] * (push + displacement(frame.grid, face, &self.along))
        });
        self.drive = drive;
    }

    fn update_flux(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) {
        let grid = frame.grid;
        let outer = |index: usize, face: &Face, pressure: &[f64]| {
            if index < grid.internal {
                return pressure[face.neighbour];
            }
            self.outer[index - grid.internal].map_or(0.0, |outer| outer.pressure)
        };
        let pressure = &now.pressure;
        fill(&mut now.flux, |index| {
            let face = &grid.faces[index];
            let fall = pressure[face.owner] - outer(index, face, pressure);
            self.drive[index] + self.conductance[index] * fall
        });
    }

    /// The gradient by which pressures are carried along faces, from the values that each cell's half gives on its faces. It does not
    /// take up its own last value where cells repeat, and so settles at any skewness: the gradient that the velocities leave
    /// does, and grows from one correction to the next beyond 30° of shear.
    fn update_along(&mut self, frame: &AttemptFrame<'_>, momentum: &Momentum) {
        let grid = frame.grid;
        if grid.orthogonal {
            return;
        }
        let last = std::mem::take(&mut self.along);
        let mut next = std::mem::take(&mut self.scratch);
        next.resize(grid.cells(), Vec3::zeros());
        fill(&mut next, |cell| {
            let mut sum = Vec3::zeros();
            for link in grid.links(cell) {
                let index = link.face as usize;
                let face = &grid.faces[index];
                // To the face's plane along its normal by the half's slope, and along the face.
                let (side, out, miss) = if link.sign > 0.0 {
                    (0, face.owner_distance, face.owner_skew)
                } else {
                    (1, -face.neighbour_distance, -face.neighbour_skew)
                };
                let slope = match self.recovery.turns(grid, index) {
                    true => last[cell].dot(&face.normal),
                    false => self.force[cell].dot(&face.normal) + self.slopes[index][side],
                };
                let beyond = out * slope + miss.dot(&last[cell]);
                sum += (link.sign * face.area * beyond) * face.normal;
            }
            // The sum over warped faces of a pressure of this gradient is not the gradient.
            let warped = self.warp.get(cell).map(|warp| warp * last[cell]);
            let new = sum / grid.volume[cell] + warped.unwrap_or_default();
            let share = match self.corrections > 1 {
                true => FOLLOWED,
                false => friction::share_without(grid, momentum, cell).min(FOLLOWED),
            };
            last[cell] + share * (new - last[cell])
        });
        self.along = next;
        self.scratch = last;
    }

    /// The gradient that leaves each cell the mean of its fluxes as its velocity: without what transport
    /// adds, by which the pressures on the two sides of a face differ.
    fn update_velocity(&self, frame: &AttemptFrame<'_>, momentum: &Momentum, now: &mut GasState) {
        let grid = frame.grid;
        fill(&mut now.pressure_gradient, |cell| {
            let slope = |index: usize, side: usize| self.slopes[index][side];
            self.force[cell] + self.recovery.vector(grid, cell, slope)
        });
        let gradients = &now.pressure_gradient;
        fill(&mut now.velocity, |cell| {
            let share = frame.pressure_share[cell] * grid.volume[cell];
            let (diagonal, force) = (
                momentum.matrix.diagonal()[cell],
                self.force[cell] - gradients[cell],
            );
            match momentum.normal.tensor(cell) {
                None => share / diagonal * force,
                Some(tensor) if is_diagonal(tensor) => {
                    (share * force).component_div(&tensor.diagonal().add_scalar(diagonal))
                }
                Some(tensor) => match (tensor + Matrix3::identity() * diagonal).try_inverse() {
                    None => share / diagonal * force,
                    Some(inverse) => inverse * (share * force),
                },
            }
        });
    }
}

/// True where a symmetric tensor has nothing beside its diagonal.
#[inline]
fn is_diagonal(tensor: &Matrix3<f64>) -> bool {
    tensor.m12 == 0.0 && tensor.m13 == 0.0 && tensor.m23 == 0.0
}

/// What Σ S (x_f − x_P)ᵀ/V of each cell lacks of the identity, which it is where faces are flat; nothing where all are.
fn warp(grid: &MeshGraph) -> Vec<Matrix3<f64>> {
    const FLAT: f64 = 1e-12;
    if grid.orthogonal {
        return Vec::new();
    }
    let mut lack = vec![Matrix3::zeros(); grid.cells()];
    fill(&mut lack, |cell| {
        let mut sum = Matrix3::zeros();
        for link in grid.links(cell) {
            let face = &grid.faces[link.face as usize];
            let to_face = if link.sign > 0.0 {
                face.owner_distance * face.normal + face.owner_skew
            } else {
                -face.neighbour_distance * face.normal - face.neighbour_skew
            };
            sum += (link.sign * face.area) * face.normal * to_face.transpose();
        }
        Matrix3::identity() - sum / grid.volume[cell]
    });
    if lack.iter().all(|one| one.norm() < FLAT) {
        lack.clear();
    }
    lack
}

/// The outflow that continuity asks of a cell in kg/s.
#[inline]
fn target(frame: &AttemptFrame<'_>, material: &CellProperties, now: &GasState, cell: usize) -> f64 {
    let mass = frame.void_fraction[cell] * material.density[cell] * frame.grid.volume[cell];
    (frame.old.mass[cell] - mass) / frame.storage_span + frame.mass_source(now, cell)
}

/// Continuity: what each cell holds after the window.
pub fn advance_mass(frame: &AttemptFrame<'_>, now: &mut GasState) {
    let mut mass = std::mem::take(&mut now.mass);
    fill(&mut mass, |cell| {
        let net = outflow(frame.grid, &now.flux, cell) - frame.mass_source(now, cell);
        frame.old.mass[cell] - frame.storage_span * net
    });
    now.mass = mass;
}
