//! What collisions do to the velocities of parcels beside the stress: damping and isotropy (docs/theory.md, MPC-4). Momentum is
//! kept in each cell.

use std::f64::consts::TAU;

use calcine_coupler::parcels::ParcelCollisions;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::parcels::collisions::{LocalSolid, damped_share, redrawn_share};
use calcine_coupler::physics::sphere;

use super::packing::RowAmounts;
use super::step::FlyingParcel;

/// Averages of a cell over the parcels in it.
#[derive(Clone, Copy, Debug, Default)]
struct CellMotion {
    /// Mass in kg.
    mass: f64,
    /// Mean velocity ū in m/s.
    mean: Vec3,
    /// Σ m |u − ū|² in J.
    energy: f64,
    /// Number of real particles.
    particles: f64,
    /// Their surface in m².
    surface: f64,
    /// Their volume in m³.
    volume: f64,
    /// Σ of 3/4 α/r³ (r_p + r)² |u_p − ū| over the particles, without α/r³.
    meetings: f64,
}

/// Rows that collide, and a step of theirs.
#[derive(Clone, Copy, Debug)]
pub struct CollisionStep<'a> {
    /// What collisions do.
    pub collisions: &'a ParcelCollisions,
    /// Ids of the rows.
    pub id: &'a [u64],
    /// Radii in m.
    pub radius: &'a [f64],
    /// Real particles of each row.
    pub weight: &'a [f64],
    /// Volumes and masses of the rows.
    pub amounts: RowAmounts<'a>,
    /// Number of the step, for draws.
    pub number: u64,
    /// Its length in s.
    pub time: f64,
}

impl CollisionStep<'_> {
    /// Relaxes velocities to the means of their cells; elastic collisions do not.
    pub fn damp(&self, parcels: &mut [FlyingParcel], fraction: &[f64]) {
        if self.collisions.times.restitution >= 1.0 {
            return;
        }
        let cells = self.cells(parcels, fraction.len());
        let share = |cell: usize| {
            let Some(local) = cells[cell].local(fraction[cell]) else {
                return 0.0;
            };
            damped_share(self.time * self.collisions.times.damping(&local))
        };
        let shares: Vec<f64> = (0..cells.len()).map(share).collect();
        for parcel in parcels {
            let cell = parcel.place.cell as usize;
            parcel.velocity += shares[cell] * (cells[cell].mean - parcel.velocity);
        }
    }

    /// Draws velocities anew, and scales all of a cell so that momentum and energy are kept.
    pub fn redraw(&self, parcels: &mut [FlyingParcel], fraction: &[f64]) {
        let before = self.cells(parcels, fraction.len());
        for (row, parcel) in parcels.iter_mut().enumerate() {
            let cell = parcel.place.cell as usize;
            let Some(local) = before[cell].local(fraction[cell]) else {
                continue;
            };
            let share = redrawn_share(self.time * self.collisions.times.isotropy(&local));
            let mut draw = Draws::new(self.collisions.seed, self.number, self.id[row]);
            if draw.uniform() < share {
                let deviation = local.fluctuation / 3.0_f64.sqrt();
                parcel.velocity = before[cell].mean + deviation * draw.gaussian();
            }
        }
        let after = self.cells(parcels, fraction.len());
        for parcel in parcels {
            let cell = parcel.place.cell as usize;
            let (old, new) = (&before[cell], &after[cell]);
            let scale = if new.energy > 0.0 {
                (old.energy / new.energy).sqrt()
            } else {
                1.0
            };
            parcel.velocity = old.mean + scale * (parcel.velocity - new.mean);
        }
    }

    fn cells(&self, parcels: &[FlyingParcel], count: usize) -> Vec<CellMotion> {
        let mut cells = vec![CellMotion::default(); count];
        for (row, parcel) in parcels.iter().enumerate() {
            let cell = &mut cells[parcel.place.cell as usize];
            let (radius, weight) = (self.radius[row], self.weight[row]);
            cell.mass += self.amounts.mass[row];
            cell.mean += self.amounts.mass[row] * parcel.velocity;
            cell.particles += weight;
            cell.surface += weight * sphere::surface(radius);
            cell.volume += self.amounts.volume[row];
        }
        for cell in &mut cells {
            if cell.mass > 0.0 {
                cell.mean /= cell.mass;
            }
        }
        for (row, parcel) in parcels.iter().enumerate() {
            let cell = &mut cells[parcel.place.cell as usize];
            let slip = parcel.velocity - cell.mean;
            cell.energy += self.amounts.mass[row] * slip.norm_squared();
            let reach = self.radius[row] + cell.sauter();
            cell.meetings += self.weight[row] * 0.75 * reach * reach * slip.norm();
        }
        cells
    }
}

impl CellMotion {
    /// Sauter's mean radius in m.
    fn sauter(&self) -> f64 {
        3.0 * self.volume / self.surface
    }

    /// What the laws need to know of a cell; `None` where all move alike, so that nothing meets.
    fn local(&self, solid_fraction: f64) -> Option<LocalSolid> {
        if self.energy <= 0.0 {
            return None;
        }
        let radius = self.sauter();
        Some(LocalSolid {
            solid_fraction,
            fluctuation: (self.energy / self.mass).sqrt(),
            sauter_radius: radius,
            collision_frequency: solid_fraction / radius.powi(3) * self.meetings / self.particles,
        })
    }
}

/// Draws that depend on seed, step and id alone: a run that resumes draws the same, on any number of threads.
pub(super) struct Draws(u64);

impl Draws {
    pub(super) fn new(seed: u64, step: u64, id: u64) -> Self {
        Self(mixed(mixed(mixed(seed) ^ step) ^ id))
    }

    /// SplitMix64 (Steele, Lea and Flood 2014, doi 10.1145/2660193.2660195).
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mixed(self.0)
    }

    /// Between 0 and 1, neither of them.
    pub(super) fn uniform(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// Three independent numbers of standard normal distribution (Box and Muller).
    fn gaussian(&mut self) -> Vec3 {
        let mut pair = || {
            let radius = (-2.0 * self.uniform().ln()).sqrt();
            let (sine, cosine) = (TAU * self.uniform()).sin_cos();
            [radius * sine, radius * cosine]
        };
        let ([x, y], [z, _]) = (pair(), pair());
        Vec3::new(x, y, z)
    }
}

fn mixed(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    value ^ (value >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_normal_and_depend_on_each_of_seed_step_and_id() {
        let (mut mean, mut square) = (Vec3::zeros(), Vec3::zeros());
        let count = 40_000;
        for id in 0..count {
            let one = Draws::new(7, 3, id).gaussian();
            mean += one;
            square += one.component_mul(&one);
        }
        // Three standard errors: 3/√n, and √2 times it.
        assert!((mean / count as f64).amax() < 0.015, "{mean}");
        assert!(
            (square / count as f64).add_scalar(-1.0).amax() < 0.0213,
            "{square}"
        );
        let first = |seed, step, id| Draws::new(seed, step, id).uniform();
        for other in [first(8, 3, 5), first(7, 4, 5), first(7, 3, 6)] {
            assert_ne!(first(7, 3, 5), other);
        }
    }
}
