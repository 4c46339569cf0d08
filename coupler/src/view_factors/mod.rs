//! Who sees whom: view factors between particles, to walls and to the surroundings, with what stands in
//! between (docs/theory.md, COR-11, THP-5).
//!
//! Rays leave each particle by a quasi-random sequence over its surface and the cosine law. For a pair the
//! view factor with nothing between is known (COR-11); rays only say what share of it is left. With n the rays
//! of i whose line meets j, and m those that meet j first,
//!
//! A F_ij = A_i F(COR-11) (m_ij + m_ji)/(n_ij + n_ji),
//!
//! so that an open view has no error of sampling at all. So near pairs are found; those farther than three
//! radii, whose factors are small, get the mean of the shares of rays of both. Either way both directions are
//! one number: reciprocity is exact.
//!
//! What a grey particle does not absorb it reflects where it was hit, by the cosine law, and the ray goes on:
//! areas are of what one emits and the other absorbs after any number of reflections. (With one radiosity for
//! the whole of a sphere grey beds would be as good as black ones: what comes in at the front would go on from
//! the back.) Walls without a temperature, and the share of a grey wall's radiation that it does not absorb,
//! reflect as mirrors do: a bed between adiabatic walls goes on in its image. Last, all is scaled,
//! symmetrically, until what each particle emits arrives somewhere ([`balance`]).

mod balance;
mod law;
mod ray;
mod trace;
mod tree;
mod wall;

use std::f64::consts::PI;

use calcine_interior::ExchangeAreas;
use calcine_physics::law::LawEntry;
use calcine_physics::radiation::{SphereTable, sphere_to_sphere, visibility, wall_visibility};
use calcine_physics::{Vec3, sphere};
use nalgebra::Matrix3;
use rayon::prelude::*;

use crate::contacts::pairs_around;
use crate::packing::random::SplitMix64;
pub use law::{RADIATION_LAWS, RadiationLaw};
pub use ray::RayHit;
use trace::{SphereGrid, meets};
pub use wall::WallSurface;

/// How views are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewFactors {
    /// By rays.
    Rays {
        /// Rays a particle.
        rays: usize,
        /// Particles see each other up to this distance of centres, in largest diameters.
        range: f64,
    },
    /// By the mean share of an open view that is left over a distance in random beds.
    Distance {
        /// Particles see each other up to this distance of centres, in largest diameters.
        range: f64,
    },
    /// Of particles within a distance, each by its share of their surface.
    Neighbours {
        /// Particles see each other up to this distance of centres, in largest diameters.
        range: f64,
    },
}

impl ViewFactors {
    /// Distance of centres, in largest diameters, up to which particles see each other.
    pub fn range(&self) -> f64 {
        match *self {
            Self::Rays { range, .. } | Self::Distance { range } | Self::Neighbours { range } => {
                range
            }
        }
    }

    /// What the law declares.
    pub fn law(&self) -> &'static LawEntry<RadiationLaw> {
        match self {
            Self::Rays { .. } => &law::RAYS,
            Self::Distance { .. } => &law::DISTANCE,
            Self::Neighbours { .. } => &law::NEIGHBOURS,
        }
    }
}

/// A wall, as radiation meets it.
#[derive(Clone, Debug)]
pub struct RadiationWall {
    /// Its shape.
    pub surface: WallSurface,
    /// The reservoir that it is and its emissivity; `None` for a wall that reflects everything.
    pub absorbs: Option<(usize, f64)>,
}

/// Particles and what is around them.
#[derive(Clone, Copy, Debug)]
pub struct RadiationScene<'a> {
    /// Radii in m.
    pub radii: &'a [f64],
    /// Centres in m.
    pub centres: &'a [Vec3],
    /// Emissivities.
    pub emissivity: &'a [f64],
    /// Walls.
    pub walls: &'a [RadiationWall],
    /// Number of the reservoirs that are walls.
    pub reservoirs: usize,
    /// The reservoir that is beyond; `None`: nothing leaves.
    pub beyond: Option<usize>,
}

/// What one particle's rays meet.
#[derive(Debug, Default)]
struct Rays {
    /// Near particle, rays whose line meets it, rays that meet it first.
    direct: Vec<(u32, u32, u32)>,
    /// Other particle, and what it absorbs from afar or after reflections, as shares of all.
    others: Vec<(u32, f64)>,
    /// Share of all rays that come back.
    own: f64,
    /// Share of all rays that each reservoir takes.
    reservoirs: Vec<f64>,
}

/// Distance of centres over the largest radius up to which pairs count as near.
const NEAR: f64 = 3.0;
/// The share of a ray below which what it meets takes the rest.
const FAINT: f64 = 1e-4;
/// Reflections at most.
const REFLECTIONS: usize = 1000;

/// View factors of all particles.
pub fn views(scene: &RadiationScene<'_>, view_factors: ViewFactors) -> ExchangeAreas {
    let count = scene.centres.len();
    let whole = scene.radii.iter().map(|&r| sphere::surface(r));
    let surface: Vec<f64> = match view_factors {
        ViewFactors::Distance { .. } => whole.collect(),
        _ => whole.zip(scene.emissivity).map(|(a, e)| a * e).collect(),
    };
    let largest = scene.radii.iter().copied().fold(0.0, f64::max);
    let reach = 2.0 * largest * view_factors.range();
    let open = Open::new(scene.radii);
    let mut made = ExchangeAreas {
        own: vec![0.0; count],
        radiosity: matches!(view_factors, ViewFactors::Distance { .. }),
        surface,
        ..ExchangeAreas::default()
    };
    match view_factors {
        ViewFactors::Rays { rays, .. } => {
            let grid = SphereGrid::new(scene.radii, scene.centres);
            let mut near: Vec<Vec<u32>> = vec![Vec::new(); count];
            for [a, b] in pairs_around(scene.radii, scene.centres, reach.min(NEAR * largest)) {
                near[a as usize].push(b);
                near[b as usize].push(a);
            }
            near.par_iter_mut().for_each(|list| list.sort_unstable());
            let seen: Vec<Rays> = (0..count)
                .into_par_iter()
                .map(|p| look(scene, &grid, p, &near[p], rays, reach))
                .collect();
            collect(scene, &open, &seen, &mut made);
        }
        ViewFactors::Distance { .. } => by_distance(scene, &open, reach, &mut made),
        ViewFactors::Neighbours { .. } => by_neighbours(scene, reach, &mut made),
    }
    balance::balance(&mut made);
    made
}

/// Open views of pairs, from a table where all radii are equal.
struct Open {
    table: Option<SphereTable>,
}

impl Open {
    fn new(radii: &[f64]) -> Self {
        let equal = radii.windows(2).all(|pair| pair[0] == pair[1]);
        Self {
            table: equal.then(SphereTable::new),
        }
    }

    /// Exchange area in m² of two particles with nothing between.
    fn area(&self, scene: &RadiationScene<'_>, a: usize, b: usize) -> f64 {
        let (first, second) = (scene.radii[a], scene.radii[b]);
        let distance = (scene.centres[b] - scene.centres[a]).norm();
        let factor = match &self.table {
            Some(table) => table.at(distance / first),
            None => sphere_to_sphere(first, second, distance),
        };
        sphere::surface(first) * factor
    }
}

/// The rays of one particle.
fn look(
    scene: &RadiationScene<'_>,
    grid: &SphereGrid<'_>,
    p: usize,
    near: &[u32],
    rays: usize,
    reach: f64,
) -> Rays {
    let (radius, centre) = (scene.radii[p], scene.centres[p]);
    let around: Vec<(Vec3, f64)> = near
        .iter()
        .map(|&q| (scene.centres[q as usize] - centre, scene.radii[q as usize]))
        .collect();
    let mut direct: Vec<(u32, u32, u32)> = near.iter().map(|&q| (q, 0, 0)).collect();
    let slots = scene.reservoirs.max(scene.beyond.map_or(0, |k| k + 1));
    let mut seen = Rays {
        reservoirs: vec![0.0; slots],
        ..Rays::default()
    };
    let share = 1.0 / rays as f64;
    let mut points = Sequence::new(p);
    let mut random = SplitMix64(p as u64 ^ 0x5bd1_e995);
    for _ in 0..rays {
        let (normal, way) = points.next();
        let start = radius * normal;
        for ((towards, other), counted) in around.iter().zip(&mut direct) {
            counted.1 += u32::from(meets(towards - start, *other, way).is_some());
        }
        let ray = Ray {
            from: p,
            origin: centre + start,
            way,
            share,
        };
        follow(scene, grid, ray, reach, &mut random, &mut direct, &mut seen);
    }
    seen.others.sort_by_key(|one| one.0);
    seen.others.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    // Thousands of rays have been counted in it.
    seen.others.shrink_to_fit();
    seen.direct = direct;
    seen
}

/// A ray on its way.
struct Ray {
    /// The particle that it leaves.
    from: usize,
    origin: Vec3,
    way: Vec3,
    /// Its share of what the particle emits.
    share: f64,
}

/// Follows a ray to where it is absorbed, by way of mirrors and grey surfaces.
fn follow(
    scene: &RadiationScene<'_>,
    grid: &SphereGrid<'_>,
    mut ray: Ray,
    reach: f64,
    random: &mut SplitMix64,
    direct: &mut [(u32, u32, u32)],
    seen: &mut Rays,
) {
    let (from, faint) = (ray.from, FAINT * ray.share);
    let (mut but, mut first) = (Some(from), true);
    // How far the ray has come, in a space in which mirrors are windows.
    let (mut away, mut unfold) = (Vec3::zeros(), Matrix3::identity());
    for _ in 0..REFLECTIONS {
        let wall = nearest_wall(scene, ray.origin, ray.way);
        let until = wall.map_or(f64::INFINITY, |(_, hit)| hit.distance);
        if let Some((distance, q)) = grid.first(ray.origin, ray.way, until, but) {
            away += distance * (unfold * ray.way);
            let rest = ray.share * (1.0 - scene.emissivity[q]);
            let kept = if rest < faint { 0.0 } else { rest };
            let absorbed = ray.share - kept;
            let near = direct.binary_search_by_key(&(q as u32), |one| one.0);
            match near {
                Ok(k) if first => direct[k].2 += 1,
                _ if q == from => seen.own += absorbed,
                _ if away.norm() <= reach => seen.others.push((q as u32, absorbed)),
                // What lies farther than the range is left out, and made up for by the balance.
                _ => return,
            }
            if kept == 0.0 {
                return;
            }
            ray.share = kept;
            ray.origin += distance * ray.way;
            let normal = (ray.origin - scene.centres[q]) / scene.radii[q];
            ray.way = lambert(normal, random);
            (but, first) = (Some(q), false);
            continue;
        }
        let Some((mirror, hit)) = wall else {
            if let Some(slot) = scene.beyond.and_then(|k| seen.reservoirs.get_mut(k)) {
                *slot += ray.share;
            }
            return;
        };
        if let Some((reservoir, emissivity)) = mirror.absorbs {
            let rest = ray.share * (1.0 - emissivity);
            let kept = if rest < faint { 0.0 } else { rest };
            seen.reservoirs[reservoir] += ray.share - kept;
            ray.share = kept;
            if kept == 0.0 {
                return;
            }
        }
        away += hit.distance * (unfold * ray.way);
        unfold -= 2.0 * (unfold * hit.normal) * hit.normal.transpose();
        ray.origin += hit.distance * ray.way;
        ray.way -= 2.0 * ray.way.dot(&hit.normal) * hit.normal;
        (but, first) = (None, false);
    }
}

/// A direction by the cosine law about a normal: the normal and a random unit vector.
fn lambert(normal: Vec3, random: &mut SplitMix64) -> Vec3 {
    let (z, turn) = (2.0 * random.unit() - 1.0, 2.0 * PI * random.unit());
    let across = (1.0 - z * z).max(0.0).sqrt();
    let sum = normal + Vec3::new(across * turn.cos(), across * turn.sin(), z);
    sum.try_normalize(1e-9).unwrap_or(normal)
}

fn nearest_wall<'w>(
    scene: &RadiationScene<'w>,
    origin: Vec3,
    way: Vec3,
) -> Option<(&'w RadiationWall, RayHit)> {
    let hits = scene
        .walls
        .iter()
        .filter_map(|wall| Some((wall, wall.surface.hit(origin, way)?)));
    hits.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))
}

/// Both directions of each pair become one exchange area.
fn collect(scene: &RadiationScene<'_>, open: &Open, seen: &[Rays], made: &mut ExchangeAreas) {
    let surface = &made.surface;
    let mut pairs: Vec<([u32; 2], f64)> = Vec::new();
    for (p, rays) in seen.iter().enumerate() {
        for &(q, crossing, first) in rays.direct.iter().filter(|one| one.0 as usize > p) {
            let other = &seen[q as usize].direct;
            let back = other.binary_search_by_key(&(p as u32), |one| one.0);
            let (n, m) = back.map_or((0, 0), |k| (other[k].1, other[k].2));
            if first + m > 0 {
                let left = f64::from(first + m) / f64::from(crossing + n);
                let black = left * open.area(scene, p, q as usize);
                let area = black * scene.emissivity[p] * scene.emissivity[q as usize];
                pairs.push(([p as u32, q], area));
            }
        }
        made.own[p] = rays.own * surface[p];
        for &(q, share) in &rays.others {
            let (a, b) = (p.min(q as usize), p.max(q as usize));
            pairs.push(([a as u32, b as u32], 0.5 * share * surface[p]));
        }
        let takes = rays.reservoirs.iter().enumerate();
        let taken = takes.filter(|(_, share)| **share > 0.0);
        made.reservoirs
            .extend(taken.map(|(k, share)| ([p, k], share * surface[p])));
    }
    pairs.sort_by_key(|one| one.0);
    pairs.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    let wide = |[a, b]: [u32; 2]| [a as usize, b as usize];
    made.pairs = pairs
        .into_iter()
        .map(|(ends, area)| (wide(ends), area))
        .collect();
}

/// Views by the distance alone; walls within reach take what a plane at their distance would.
fn by_distance(scene: &RadiationScene<'_>, open: &Open, reach: f64, made: &mut ExchangeAreas) {
    let pairs = pairs_around(scene.radii, scene.centres, reach);
    let pair = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        let mean = 0.5 * (scene.radii[a] + scene.radii[b]);
        let distance = (scene.centres[b] - scene.centres[a]).norm();
        ([a, b], open.area(scene, a, b) * visibility(distance / mean))
    };
    made.pairs = pairs.par_iter().map(pair).collect();
    for (p, centre) in scene.centres.iter().enumerate() {
        for wall in scene.walls {
            let Some((reservoir, emissivity)) = wall.absorbs else {
                continue;
            };
            let distance = wall.surface.distance(*centre, reach);
            if distance <= reach {
                let left = wall_visibility(distance / scene.radii[p]);
                let area = 0.5 * emissivity * left * made.surface[p];
                made.reservoirs.push(([p, reservoir], area));
            }
        }
    }
}

/// Views of all particles within reach, each by its share of the surface there; walls and surroundings are not seen.
fn by_neighbours(scene: &RadiationScene<'_>, reach: f64, made: &mut ExchangeAreas) {
    let pairs = pairs_around(scene.radii, scene.centres, reach);
    let surface = &made.surface;
    let mut around = vec![0.0; surface.len()];
    for &[a, b] in &pairs {
        let (a, b) = (a as usize, b as usize);
        around[a] += surface[b];
        around[b] += surface[a];
    }
    let pair = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        let mean = 0.5 * (around[a] + around[b]);
        ([a, b], surface[a] * surface[b] / mean)
    };
    made.pairs = pairs.iter().map(pair).collect();
}

/// Points of a sphere and directions from there, evenly spread in all four dimensions: the additive
/// recurrence of Roberts (2018, "The unreasonable effectiveness of quasirandom sequences") with powers of the
/// root of x⁵ = x + 1, shifted for each particle.
struct Sequence {
    place: [f64; 4],
}

const STEPS: [f64; 4] = [
    0.856_674_883_854_502_9,
    0.733_891_856_627_125_6,
    0.628_706_721_040_004_8,
    0.538_597_256_766_614_4,
];

impl Sequence {
    fn new(particle: usize) -> Self {
        let mut random = SplitMix64(particle as u64);
        Self {
            place: [0; 4].map(|_: u8| random.unit()),
        }
    }

    /// A unit normal of the sphere, and a unit vector by the cosine law about it.
    fn next(&mut self) -> (Vec3, Vec3) {
        for (place, step) in self.place.iter_mut().zip(STEPS) {
            *place = (*place + step).fract();
        }
        let [height, turn, out, spin] = self.place;
        let z = 1.0 - 2.0 * height;
        let across = (1.0 - z * z).max(0.0).sqrt();
        let (sine, cosine) = (2.0 * PI * turn).sin_cos();
        let normal = Vec3::new(across * cosine, across * sine, z);
        // Tangents along the meridian and the circle of latitude.
        let along = Vec3::new(-sine, cosine, 0.0);
        let up = Vec3::new(-z * cosine, -z * sine, across);
        let (b, a) = (2.0 * PI * spin).sin_cos();
        let tilt = out.sqrt();
        let way = (1.0 - out).max(0.0).sqrt() * normal + tilt * (a * along + b * up);
        (normal, way)
    }
}

#[cfg(test)]
mod tests;
