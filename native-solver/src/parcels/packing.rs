//! The stress of the solid on the mesh (docs/theory.md, MPC-2, MPC-3).
//!
//! Implicit, by default: with α* after the flight, the solid fraction at the end of the step obeys
//!
//! V (α(τ) − α*) = Δt² Σ_f φ_f A_f (τ_N − τ_P)/(ρ_f d_f),
//!
//! with the share φ that drag leaves of what a force adds to velocities in a step, solved for the stress τ, whose α(τ) stays below close packing. It is concave and the matrix of the faces is an M-matrix, so
//! that Newton's method rises to the solution from below. The volume that passes each face moves the parcels, once more with more stress where that leaves a cell above close packing, the impulse
//! −Δt (τ_N − τ_P) A_f n of each face is shared by the masses at both its sides.

use std::ops::{Add, Mul};
use std::sync::Arc;

use calcine_coupler::mapping::linear::{CornerValues, LinearWeights, Weighable};
use calcine_coupler::mesh::tetrahedra::{Barycentric, TetPlace};
use calcine_coupler::numerics::parallel;
use calcine_coupler::parcels::ParcelPacking;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::parcels::HarrisCrighton;
use rayon::prelude::*;

use super::error::ParcelError;
use super::step::{FlyingParcel, PIECE};
use super::stress::StressCurve;
use super::stress_system::StressSystem;
use super::tetrahedra::Tetrahedra;
use crate::numerics::grid::{Face, MeshGraph};

/// Newton's iterations at most; far from the solution each doubles the stress.
const ITERATIONS: u32 = 80;
/// Share of its residual that each leaves of its linear equations.
const SOLVED: f64 = 1e-6;
/// Residual of a cell as a solid fraction at which they end.
const RESIDUAL: f64 = 1e-9;
/// Σ cos² of the directions to the neighbours of a cell against one direction, above which they tell how the stress changes along it.
const FACING: f64 = 0.01;
/// Times at most that the stress is solved for in a step; one is the rule.
const ROUNDS: u32 = 30;
/// Rounds without a gain after which the best is taken.
const PATIENCE: u32 = 3;
/// What is missing of the solid fraction that was solved for counts so many times in the next round, as linear weights spread over
/// several cells what passes a face.
const MISSED: f64 = 2.0;
/// Share of the distance between two centres that a parcel is moved by the stress in a step at most.
const FARTHEST: f64 = 0.5;

/// Real particles of all rows in m³ and kg.
#[derive(Clone, Copy, Debug)]
pub struct RowAmounts<'a> {
    /// Solid volumes.
    pub volume: &'a [f64],
    /// Masses.
    pub mass: &'a [f64],
}

/// What belongs to each cell.
#[derive(Clone, Debug, Default)]
pub struct CellSolid {
    /// Solid fraction.
    pub fraction: Vec<f64>,
    /// Mass in kg.
    pub mass: Vec<f64>,
    /// The same times the share φ₁ that drag leaves of what a force adds to velocities in the step.
    pub yielding: Vec<f64>,
    /// Momentum in N s.
    pub momentum: Vec<Vec3>,
}

/// What of parcels belongs to a corner or a cell.
#[derive(Clone, Copy)]
struct Belonging {
    volume: f64,
    mass: f64,
    yielding: f64,
    momentum: Vec3,
}

impl Add for Belonging {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            volume: self.volume + other.volume,
            mass: self.mass + other.mass,
            yielding: self.yielding + other.yielding,
            momentum: self.momentum + other.momentum,
        }
    }
}

impl Mul<f64> for Belonging {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            volume: self.volume * factor,
            mass: self.mass * factor,
            yielding: self.yielding * factor,
            momentum: self.momentum * factor,
        }
    }
}

impl Weighable for Belonging {
    const NONE: Self = Self {
        volume: 0.0,
        mass: 0.0,
        yielding: 0.0,
        momentum: Vec3::NONE,
    };
}

/// What acted in a step.
#[derive(Clone, Debug, Default)]
pub struct PackingAction {
    /// The impulse in N s that walls gave all parcels.
    pub impulse: Vec3,
    /// The stress in Pa by which velocities were changed; of a firm bed alone.
    pub stress: Vec<f64>,
}

/// Solves for the stress on a mesh and has it act.
#[derive(Debug)]
pub struct Packer {
    pub(super) grid: Arc<MeshGraph>,
    weights: LinearWeights,
    /// Face of the grid of each face of the mesh, and 1 where both have their normals out of the face's owner, else −1.
    grid_face: Vec<(u32, f64)>,
    /// Face of the mesh of each face of the grid.
    mesh_face: Vec<u32>,
    pub(super) system: StressSystem,
    /// Mean velocity of the solid in m/s at the corners where the step begins, for the explicit stress.
    mean: Option<CornerValues<Vec3>>,
}

impl Packer {
    /// The packing of a mesh.
    pub fn new(tetrahedra: &Tetrahedra) -> Self {
        let mesh = tetrahedra.mesh();
        let grid = Arc::new(MeshGraph::new(mesh));
        let mut grid_face = vec![(0, 1.0); mesh.faces()];
        let mut mesh_face = vec![0; grid.faces.len()];
        for cell in 0..mesh.cells() {
            for (&face, link) in mesh.faces_of(cell).iter().zip(grid.links(cell)) {
                let side = mesh.side(cell, face as usize);
                grid_face[face as usize] = (link.face, link.sign * side);
                mesh_face[link.face as usize] = face;
            }
        }
        Self {
            weights: LinearWeights::new(mesh),
            system: StressSystem::new(&grid),
            grid_face,
            mesh_face,
            grid,
            mean: None,
        }
    }

    /// How parcels belong to cells.
    pub fn weights(&self) -> &LinearWeights {
        &self.weights
    }

    /// Cells and faces.
    pub fn grid(&self) -> &MeshGraph {
        &self.grid
    }

    /// Face of the mesh of a face of the grid.
    pub fn face_of_mesh(&self, face: usize) -> usize {
        self.mesh_face[face] as usize
    }

    /// The stress at a wall in Pa, as the wall carries it.
    pub fn stress_at_wall(&self, stress: &[f64], cell: usize, face: usize) -> f64 {
        stress[cell] + self.risen(stress, cell, &self.grid.faces[face])
    }

    /// What belongs to each cell.
    pub fn solid(
        &self,
        tetrahedra: &Tetrahedra,
        parcels: &[FlyingParcel],
        amounts: RowAmounts<'_>,
    ) -> CellSolid {
        let all = self.belonging(tetrahedra, parcels, |row| {
            let (parcel, mass) = (&parcels[row], amounts.mass[row]);
            Belonging {
                volume: amounts.volume[row],
                mass,
                yielding: parcel.yielding * mass,
                momentum: mass * parcel.velocity,
            }
        });
        let fractions = all.iter().zip(self.weights.volume());
        CellSolid {
            fraction: fractions.map(|(one, whole)| one.volume / whole).collect(),
            mass: all.iter().map(|one| one.mass).collect(),
            yielding: all.iter().map(|one| one.yielding).collect(),
            momentum: all.iter().map(|one| one.momentum).collect(),
        }
    }

    /// The solid fraction of each cell alone.
    pub fn fraction(
        &self,
        tetrahedra: &Tetrahedra,
        parcels: &[FlyingParcel],
        volume: &[f64],
    ) -> Vec<f64> {
        let all = self.belonging(tetrahedra, parcels, |row| volume[row]);
        let fractions = all.iter().zip(self.weights.volume());
        fractions.map(|(solid, whole)| solid / whole).collect()
    }

    /// What belongs to each cell of what each parcel has.
    fn belonging<T: Weighable>(
        &self,
        tetrahedra: &Tetrahedra,
        parcels: &[FlyingParcel],
        value: impl Fn(usize) -> T,
    ) -> Vec<T> {
        let (weights, mesh) = (&self.weights, tetrahedra.mesh());
        let mut corners: CornerValues<T> = weights.corners(mesh);
        for (row, parcel) in parcels.iter().enumerate() {
            let share = tetrahedra.map(parcel.place).of(parcel.position);
            weights.add(mesh, &mut corners, (parcel.place, share), value(row));
        }
        weights.gather(mesh, &corners)
    }

    /// Before a flight: keeps the mean velocity of the solid, against which the explicit stress is limited. What gravity adds in the step is a
    /// slip against it, so that the stress can hold a bed up.
    pub fn begin(
        &mut self,
        packing: &ParcelPacking,
        tetrahedra: &Tetrahedra,
        (parcels, amounts): (&[FlyingParcel], RowAmounts<'_>),
    ) {
        if matches!(packing, ParcelPacking::Explicit { .. }) {
            let solid = self.solid(tetrahedra, parcels, amounts);
            let mean = solid.momentum.iter().zip(&solid.mass);
            let mean: Vec<Vec3> = mean.map(|(p, &m)| per_mass(*p, m)).collect();
            self.mean = Some(self.weights.spread(tetrahedra.mesh(), &mean));
        }
    }

    /// Has the stress act over a step in s; where the bed is firm, velocities change by the stress that keeps packed cells from being
    /// compressed in place of that which moves parcels apart.
    pub fn act(
        &mut self,
        (packing, firm): (&ParcelPacking, bool),
        tetrahedra: &Tetrahedra,
        (parcels, amounts): (&mut [FlyingParcel], RowAmounts<'_>),
        time: f64,
    ) -> Result<PackingAction, ParcelError> {
        match packing {
            ParcelPacking::None => Ok(PackingAction::default()),
            ParcelPacking::Implicit(law) => {
                self.implicit((law, firm), tetrahedra, (parcels, amounts), time)
            }
            ParcelPacking::Explicit {
                stress,
                restitution,
            } => {
                let solid = self.solid(tetrahedra, parcels, amounts);
                let of = |&fraction: &f64| stress.stress(fraction).0;
                let stress: Vec<f64> = solid.fraction.iter().map(of).collect();
                let changes = self.changes(&stress, &solid.mass, time);
                let changes = self.weights.spread(tetrahedra.mesh(), &changes);
                let Some(mean) = self.mean.take() else {
                    return Ok(PackingAction::default());
                };
                let mut given = Vec3::zeros();
                for (row, parcel) in parcels.iter_mut().enumerate() {
                    let share = tetrahedra.map(parcel.place).of(parcel.position);
                    let mesh = tetrahedra.mesh();
                    let at = |values| self.weights.at(mesh, values, (parcel.place, share));
                    let slip = at(&mean) - parcel.velocity;
                    let change = snider(parcel.yielding * at(&changes), slip, *restitution);
                    parcel.velocity += change;
                    given += amounts.mass[row] * change;
                }
                Ok(PackingAction {
                    impulse: given,
                    stress: if firm { stress } else { Vec::new() },
                })
            }
        }
    }

    fn implicit(
        &mut self,
        (law, firm): (&HarrisCrighton, bool),
        tetrahedra: &Tetrahedra,
        (parcels, amounts): (&mut [FlyingParcel], RowAmounts<'_>),
        time: f64,
    ) -> Result<PackingAction, ParcelError> {
        let solid = self.solid(tetrahedra, parcels, amounts);
        let density = |cell: usize| {
            let solids = solid.fraction[cell] * self.weights.volume()[cell];
            (solids > 0.0).then(|| solid.mass[cell] / solids)
        };
        // φ₁ Δt² A/(ρ d) of each face between two cells, in m³/Pa.
        let conductance: Vec<f64> = self.grid.faces[..self.grid.internal]
            .iter()
            .map(|face| {
                let density = match (density(face.owner), density(face.neighbour)) {
                    (Some(owner), Some(neighbour)) => 0.5 * (owner + neighbour),
                    (Some(one), None) | (None, Some(one)) => one,
                    (None, None) => return 0.0,
                };
                let mass = solid.mass[face.owner] + solid.mass[face.neighbour];
                let free = solid.yielding[face.owner] + solid.yielding[face.neighbour];
                free / mass * time * time * face.area / (density * face.distance())
            })
            .collect();
        let curve = StressCurve::new(law);
        let mesh = tetrahedra.mesh();
        let begun: Vec<FlyingParcel> = parcels.to_vec();
        let mut wanted = solid.fraction.clone();
        let mut action = PackingAction::default();
        let mut best = (f64::INFINITY, 0, Vec::new());
        for round in 1..=ROUNDS {
            let stress = match self.solve(law, &wanted, &conductance) {
                Err(_) if round > 1 => break,
                solved => solved?,
            };
            let changes = self.changes(&stress, &solid.mass, time);
            let changes = self.weights.spread(mesh, &changes);
            let passing = self.passing(&stress, &solid.fraction, &conductance, time);
            let packer = &*self;
            let felt: Vec<Vec3> = parcels
                .par_iter_mut()
                .zip(&begun)
                .with_min_len(PIECE)
                .map(|(parcel, begun)| {
                    (parcel.position, parcel.place) = (begun.position, begun.place);
                    let share = tetrahedra.map(parcel.place).of(parcel.position);
                    let change = packer.weights.at(mesh, &changes, (parcel.place, share));
                    let inner = parcel.yielding * change;
                    let way = packer.moved(tetrahedra, parcel.place, (share, inner), &passing);
                    parcel.shift(tetrahedra, time * way);
                    change
                })
                .collect();
            if round == 1 {
                let felt = match firm {
                    false => felt,
                    true => {
                        let firm = self.firm_stress(law, (&stress, &solid, &conductance), time);
                        let changes = self.changes(&firm, &solid.mass, time);
                        let changes = self.weights.spread(mesh, &changes);
                        action.stress = firm;
                        let at = |one: &FlyingParcel| {
                            let share = tetrahedra.map(one.place).of(one.position);
                            self.weights.at(mesh, &changes, (one.place, share))
                        };
                        begun.iter().map(at).collect()
                    }
                };
                for ((parcel, change), mass) in parcels.iter_mut().zip(felt).zip(amounts.mass) {
                    parcel.pushed(change);
                    action.impulse += *mass * change;
                }
            }
            let found = self.fraction(tetrahedra, parcels, amounts.volume);
            let fullest = found.iter().copied().fold(0.0, f64::max);
            if fullest <= law.close_packing {
                return Ok(action);
            }
            if fullest < best.0 {
                let places = parcels.iter().map(|one| (one.position, one.place));
                best = (fullest, round, places.collect());
            }
            if round - best.1 > PATIENCE {
                break;
            }
            for ((wanted, found), stress) in wanted.iter_mut().zip(&found).zip(&stress) {
                *wanted = (*wanted + MISSED * (found - curve.fraction(*stress).0)).max(0.0);
            }
        }
        for (parcel, (position, place)) in parcels.iter_mut().zip(best.2) {
            (parcel.position, parcel.place) = (position, place);
        }
        Ok(action)
    }

    /// Velocity in m/s with which the stress moves a parcel: along the normal of its tetrahedron's face it changes linearly from
    /// that of the mean towards that through the face, so that the volume passes which was solved for.
    fn moved(
        &self,
        tetrahedra: &Tetrahedra,
        place: TetPlace,
        (share, inner): (Barycentric, Vec3),
        passing: &[f64],
    ) -> Vec3 {
        let (cell, face) = (place.cell as usize, place.face as usize);
        let (index, side) = self.grid_face[face];
        let mesh = tetrahedra.mesh();
        let through = mesh.side(cell, face) * side * passing[index as usize];
        let normal = mesh.outward(cell, face).normalize();
        inner + (1.0 - share[0]) * (through - inner.dot(&normal)) * normal
    }

    /// The stress in Pa at the end of the step.
    fn solve(
        &mut self,
        law: &HarrisCrighton,
        fraction: &[f64],
        conductance: &[f64],
    ) -> Result<Vec<f64>, ParcelError> {
        let curve = StressCurve::new(law);
        let volume = self.weights.volume();
        let mut stress: Vec<f64> = fraction.iter().map(|&one| curve.first(one)).collect();
        let mut left = f64::INFINITY;
        let cells = fraction.len();
        let (mut residual, mut change) = (vec![0.0; cells], vec![0.0; cells]);
        for _ in 0..ITERATIONS {
            let grid = &self.grid;
            parallel::fill(&mut residual, |cell| {
                let mut sum = volume[cell] * (fraction[cell] - curve.fraction(stress[cell]).0);
                for link in grid.links(cell).iter().filter(|link| !link.is_boundary()) {
                    sum += conductance[link.face as usize]
                        * (stress[link.other as usize] - stress[cell]);
                }
                sum
            });
            let share = |cell: usize| (residual[cell] / volume[cell]).abs();
            let worst = parallel::largest(cells, share);
            left = worst.1;
            if left <= RESIDUAL || !left.is_finite() {
                break;
            }
            let stored = |cell: usize| Some(volume[cell] * curve.fraction(stress[cell]).1);
            change.fill(0.0);
            self.system
                .solve(conductance, stored, (&residual, &mut change), SOLVED);
            for (stress, change) in stress.iter_mut().zip(&change) {
                *stress += change;
            }
        }
        if left <= RESIDUAL {
            return Ok(stress);
        }
        Err(ParcelError::NotPacked {
            residual: left,
            iterations: ITERATIONS,
        })
    }

    /// What the stress adds to the velocity of each cell in m/s. A face gives its impulse to the masses at both sides alike; a
    /// wall carries what presses against it, by the stress extrapolated to it, and never pulls.
    fn changes(&self, stress: &[f64], mass: &[f64], time: f64) -> Vec<Vec3> {
        let grid = &self.grid;
        let mut changes = vec![Vec3::zeros(); mass.len()];
        parallel::fill(&mut changes, |cell| {
            let mut sum = Vec3::zeros();
            for link in grid.links(cell) {
                let face = &grid.faces[link.face as usize];
                let normal = link.sign * face.normal;
                if link.is_boundary() {
                    let more = self.risen(stress, cell, face);
                    sum -= per_mass(time * more * face.area * normal, mass[cell]);
                } else {
                    let other = link.other as usize;
                    let impulse = -time * (stress[other] - stress[cell]) * face.area * normal;
                    sum += per_mass(impulse, mass[cell] + mass[other]);
                }
            }
            sum
        });
        changes
    }

    /// By how much the stress at a wall is above that of its cell, in Pa.
    fn risen(&self, stress: &[f64], cell: usize, wall: &Face) -> f64 {
        (self.rise(stress, cell, wall.normal) * wall.owner_distance).max(0.0)
    }

    /// How fast the stress rises along a direction by the neighbours of a cell, in Pa/m (least squares).
    fn rise(&self, stress: &[f64], cell: usize, direction: Vec3) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        let links = self.grid.links(cell).iter();
        for link in links.filter(|link| !link.is_boundary()) {
            let line = link.sign * self.grid.between(link.face as usize);
            let along = line.dot(&direction);
            let weight = 1.0 / line.norm_squared();
            above += weight * along * (stress[link.other as usize] - stress[cell]);
            below += weight * along * along;
        }
        if below > FACING { above / below } else { 0.0 }
    }

    /// Velocity in m/s with which parcels pass each face of the grid because of the stress, out of its owner: the volume that
    /// passes over the solid fraction of the cell it comes from, at most half the distance between centres a step.
    fn passing(
        &self,
        stress: &[f64],
        fraction: &[f64],
        conductance: &[f64],
        time: f64,
    ) -> Vec<f64> {
        let mut passing = vec![0.0; self.grid.faces.len()];
        for (index, face) in self.grid.faces[..self.grid.internal].iter().enumerate() {
            // Of the solid, in m³ a step.
            let volume = conductance[index] * (stress[face.owner] - stress[face.neighbour]);
            let from = if volume > 0.0 {
                face.owner
            } else {
                face.neighbour
            };
            if fraction[from] > 0.0 {
                let farthest = FARTHEST * face.distance() / time;
                let speed = volume / (fraction[from] * face.area * time);
                passing[index] = speed.clamp(-farthest, farthest);
            }
        }
        passing
    }
}

/// A quantity over a mass; none where there is no mass.
fn per_mass(quantity: Vec3, mass: f64) -> Vec3 {
    if mass > 0.0 {
        quantity / mass
    } else {
        Vec3::zeros()
    }
}

/// Snider's limit of each component of a change of velocity: towards the mean velocity only, and by at most (1 + e) times the
/// difference from it (docs/theory.md, MPC-2).
fn snider(change: Vec3, slip: Vec3, restitution: f64) -> Vec3 {
    change.zip_map(&slip, |change, slip| {
        let most = (1.0 + restitution) * slip;
        if change > 0.0 {
            change.min(most.max(0.0))
        } else {
            change.max(most.min(0.0))
        }
    })
}
