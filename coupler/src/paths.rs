//! Ways of heat beside the gas: which walls and surroundings particles exchange heat with, what they touch
//! and whom they see. The same for every backend of the particles, from their places alone.

use calcine_interior::{ExchangeAreas, Neighbours};

use crate::contacts::{touching, touching_walls};
use crate::motion::WallShape;
use crate::part::ParticleFields;
use crate::periodicity::Periodicity;
use crate::setup::Schedule;
use crate::view_factors::{RadiationScene, RadiationWall, ViewFactors, WallSurface, views};

/// Name of the surroundings among the reservoirs.
pub const SURROUNDINGS: &str = "surroundings";

/// A wall that particles exchange heat with, or that reflects their radiation.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatWall {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: WallShape,
    /// Its temperature in K over process time in s; `None` for an adiabatic wall, which is a mirror.
    pub temperature: Option<Schedule>,
    /// The body that it is of, by its place, whose temperature it has in place of that.
    pub body: Option<usize>,
    /// Its emissivity.
    pub emissivity: f64,
}

/// What a case says of heat between particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathsSetup {
    /// Walls.
    pub walls: Vec<HeatWall>,
    /// Emissivity of each population.
    pub emissivity: Vec<f64>,
    /// The widest gap in m between particles of these radii in m, and to walls, that conducts, over the largest
    /// radius in m.
    pub gap: f64,
    /// How particles see each other; `None`: they do not radiate.
    pub view_factors: Option<ViewFactors>,
    /// Temperature in K of what is seen beyond all walls, over process time in s; `None`: nothing leaves.
    pub surroundings: Option<Schedule>,
    /// Views of moving particles hold for so much process time in s.
    pub refresh: f64,
}

/// Walls ready to be asked, and the views that hold.
#[derive(Debug, Default)]
pub struct Paths {
    setup: PathsSetup,
    /// Directions in which the domain repeats itself.
    periodicity: Periodicity,
    mirrors: Vec<RadiationWall>,
    names: Vec<String>,
    /// The body that each reservoir is of.
    bodies: Vec<Option<usize>>,
    /// Process time in s at which views were found last.
    seen_at: Option<f64>,
    /// Temperatures of the reservoirs in K.
    kelvin: Vec<f64>,
}

impl Paths {
    /// Walls that have a temperature are the first reservoirs, in their order; the surroundings are the last.
    pub fn new(setup: PathsSetup, periodicity: Periodicity) -> Self {
        let mut reservoirs = 0..;
        let warm = || setup.walls.iter().filter(|wall| wall.temperature.is_some());
        let beyond = setup.surroundings.as_ref();
        let mirror = |wall: &HeatWall| RadiationWall {
            surface: WallSurface::new(&wall.shape),
            absorbs: wall
                .temperature
                .as_ref()
                .and_then(|_| reservoirs.next())
                .map(|k| (k, wall.emissivity)),
        };
        Self {
            mirrors: setup.walls.iter().map(mirror).collect(),
            bodies: warm()
                .map(|wall| wall.body)
                .chain(beyond.map(|_| None))
                .collect(),
            names: warm()
                .map(|wall| wall.name.clone())
                .chain(beyond.map(|_| SURROUNDINGS.to_owned()))
                .collect(),
            seen_at: None,
            kelvin: Vec::new(),
            periodicity,
            setup,
        }
    }

    /// Names of the reservoirs.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The body that each reservoir is of, by its place; `None` of those with a temperature of their own.
    pub fn bodies(&self) -> &[Option<usize>] {
        &self.bodies
    }

    /// Process time in s at which the views that hold were found; `None` before.
    pub fn seen_at(&self) -> Option<f64> {
        self.seen_at
    }

    /// Takes up when the views that hold were found.
    pub fn restore_seen_at(&mut self, time: Option<f64>) {
        self.seen_at = time;
    }

    /// True where views are found anew if what particles meet is found at a process time in s.
    pub fn due(&self, time: f64) -> bool {
        self.seen_at
            .is_none_or(|at| time - at >= self.setup.refresh * (1.0 - 1e-9))
    }

    /// Temperatures of the reservoirs in K at a process time in s, with bodies of these temperatures in K; and the body that each is of.
    pub fn reservoirs(&mut self, time: f64, bodies: &[f64]) -> (&[f64], &[Option<usize>]) {
        let walls = self.setup.walls.iter();
        let schedules = walls.filter_map(|wall| wall.temperature.as_ref());
        self.kelvin.clear();
        self.kelvin.extend(
            schedules
                .chain(&self.setup.surroundings)
                .map(|one| one.at(time)),
        );
        for (kelvin, body) in self.kelvin.iter_mut().zip(&self.bodies) {
            if let Some(own) = body.and_then(|body| bodies.get(body)) {
                *kelvin = *own;
            }
        }
        (&self.kelvin, &self.bodies)
    }

    /// Finds what particles meet at a process time in s, and tells it.
    pub fn find_neighbours(
        &mut self,
        particles: &ParticleFields<'_>,
        time: f64,
        tell: impl FnOnce(&Neighbours<'_>),
    ) {
        let (radii, centres) = (particles.radius, particles.position);
        let gap = self.setup.gap;
        let touches = touching(&self.periodicity, radii, centres, gap);
        let absorbing = self.mirrors.iter().filter_map(|mirror| {
            let (reservoir, _) = mirror.absorbs?;
            Some((reservoir, &mirror.surface))
        });
        let walls = touching_walls(radii, centres, absorbing, gap);
        let due = self.due(time);
        let found: Option<ExchangeAreas> =
            self.setup.view_factors.filter(|_| due).map(|view_factors| {
                let reservoirs = self.mirrors.iter().filter(|m| m.absorbs.is_some()).count();
                let own = |k: &u32| self.setup.emissivity.get(*k as usize).copied();
                let emissivity = particles.population.iter().map(|k| own(k).unwrap_or(1.0));
                let scene = RadiationScene {
                    radii,
                    centres,
                    emissivity: &emissivity.collect::<Vec<f64>>(),
                    walls: &self.mirrors,
                    reservoirs,
                    beyond: self.setup.surroundings.as_ref().map(|_| reservoirs),
                };
                views(&scene, view_factors)
            });
        if found.is_some() {
            self.seen_at = Some(time);
        }
        tell(&Neighbours {
            pairs: &touches,
            walls: &walls,
            views: found.as_ref(),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodicity::PeriodicSpan;
    use calcine_physics::Vec3;

    #[test]
    fn what_touches_across_a_periodic_plane_is_found_as_within() {
        let span = PeriodicSpan {
            low: 0.0,
            high: 0.02,
        };
        let periodicity = Periodicity {
            axes: [Some(span), None, None],
        };
        let overlap = |x: f64| {
            let pair = [x, x + 1.9e-3].map(|x| periodicity.wrap(Vec3::new(x, 0.0, 1e-3)));
            let radii = [1e-3; 2];
            let fields = ParticleFields {
                id: &[1, 2],
                population: &[0, 0],
                position: &pair,
                velocity: &[],
                angular_velocity: &[],
                radius: &radii,
                mass: &[],
                weight: &[],
            };
            let mut paths = Paths::new(PathsSetup::default(), periodicity);
            let mut found = Vec::new();
            paths.find_neighbours(&fields, 0.0, |near| {
                found.extend(near.pairs.iter().map(|pair| (pair.particles, pair.overlap)));
            });
            found
        };
        let within = overlap(5e-3);
        assert_eq!(within.len(), 1);
        for x in [0.0192, 0.0185, 0.02, -1e-4] {
            let across = overlap(x);
            assert_eq!(across.len(), 1);
            assert_eq!(across[0].0, within[0].0);
            assert!((across[0].1 - within[0].1).abs() < 1e-16);
        }
    }
}
