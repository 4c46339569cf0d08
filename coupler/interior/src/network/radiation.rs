//! Views as bonds whose conductance follows temperature.

use std::f64::consts::PI;

use calcine_numerics::parallel::fill;
use calcine_physics::radiation::linear;
use calcine_physics::sphere;

use super::ExchangeAreas;
use crate::without;

/// Exchange areas between surfaces, and emissivities.
#[derive(Debug, Default)]
pub(super) struct Radiation {
    views: ExchangeAreas,
    emissivity: Vec<f64>,
    /// Share of the exchange of each particle that it can pass on through its inside; empty for all.
    share: Vec<f64>,
    /// True where some surface is not black, so that each has a radiosity of its own.
    grey: bool,
}

impl Radiation {
    /// Views and the emissivity of each particle.
    pub fn new(views: &ExchangeAreas, emissivity: Vec<f64>) -> Self {
        Self {
            views: views.clone(),
            grey: views.radiosity && emissivity.iter().any(|e| *e < 1.0),
            emissivity,
            share: Vec::new(),
        }
    }

    /// The views.
    pub fn views(&self) -> &ExchangeAreas {
        &self.views
    }

    /// Takes up the share that each particle, of a diameter in m, can pass on.
    pub fn limit(&mut self, share: impl Fn(usize, f64) -> f64) {
        let views = &self.views;
        let diameter = |p: usize| {
            let absorbs = if views.radiosity {
                1.0
            } else {
                self.emissivity[p]
            };
            (views.surface[p] / (absorbs * PI)).sqrt()
        };
        self.share = (0..views.surface.len())
            .map(|p| share(p, diameter(p)))
            .collect();
    }

    /// Drops the views of particles that go, by their rows in ascending order, and takes in those that come,
    /// each of a radius in m and an emissivity, which see only themselves.
    pub fn change(&mut self, gone: &[usize], come: &[(f64, f64)]) {
        if self.is_empty() {
            *self = Self::default();
            return;
        }
        let views = &mut self.views;
        // Where each row comes to, if it stays.
        let mut next = 0;
        let to: Vec<Option<usize>> = (0..views.surface.len())
            .map(|row| {
                let stays = gone.binary_search(&row).is_err();
                let place = stays.then_some(next);
                next += usize::from(stays);
                place
            })
            .collect();
        views.pairs.retain_mut(|(rows, _)| {
            let moved = rows.map(|row| to[row]);
            *rows = moved.map(Option::unwrap_or_default);
            moved.iter().all(Option::is_some)
        });
        views.reservoirs.retain_mut(|([row, _], _)| {
            let moved = to[*row];
            *row = moved.unwrap_or_default();
            moved.is_some()
        });
        without(&mut views.own, gone);
        without(&mut views.surface, gone);
        without(&mut self.emissivity, gone);
        for &(radius, emissivity) in come {
            let absorbs = if views.radiosity { 1.0 } else { emissivity };
            let surface = sphere::surface(radius) * absorbs;
            views.own.push(surface);
            views.surface.push(surface);
            self.emissivity.push(emissivity);
        }
        self.grey = views.radiosity && self.emissivity.iter().any(|e| *e < 1.0);
        self.share.clear();
    }

    fn of(&self, particle: usize) -> f64 {
        self.share.get(particle).copied().unwrap_or(1.0)
    }

    /// True where nothing radiates.
    pub fn is_empty(&self) -> bool {
        self.views.pairs.is_empty() && self.views.reservoirs.is_empty()
    }

    /// Number of nodes that radiosities add.
    pub fn radiosities(&self) -> usize {
        if self.grey && !self.is_empty() {
            self.emissivity.len()
        } else {
            0
        }
    }

    /// Pairs of particles that exchange radiation, with their area in m²: that of what is emitted and absorbed, or of radiosities.
    pub fn pairs(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let pairs = self.views.pairs.iter();
        pairs.map(|&([i, j], area)| ([i, j], (self.of(i) * self.of(j)).sqrt() * area))
    }

    /// The same of particles and reservoirs.
    pub fn links(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let links = self.views.reservoirs.iter();
        links.map(|&([i, reservoir], area)| ([i, reservoir], self.of(i) * area))
    }

    /// A e/(1 − e) in m² between a surface and its radiosity.
    pub fn own(&self, particle: usize) -> f64 {
        let e = self.emissivity[particle];
        let factor = match e < 1.0 {
            true => (e / (1.0 - e)).min(BLACK),
            false => BLACK,
        };
        self.views.surface[particle] * factor
    }

    /// Appends the bonds and links to reservoirs of an iterate: temperatures of all nodes and of reservoirs in K.
    ///
    /// A black surface in a bed with grey ones keeps its radiosity node: its own bond is then so strong, 1e6
    /// of its surface, that both are one.
    pub fn linearise(
        &self,
        kelvin: &[f64],
        reservoirs: &[f64],
        bonds: &mut Vec<([usize; 2], f64)>,
        reservoir_links: &mut Vec<([usize; 2], f64)>,
    ) {
        let shift = self.radiosities();
        let solid = bonds.len();
        bonds.resize(solid + self.views.pairs.len(), ([0; 2], 0.0));
        fill(&mut bonds[solid..], |pair| {
            let ([i, j], area) = self.views.pairs[pair];
            let ends = [i + shift, j + shift];
            let left = (self.of(i) * self.of(j)).sqrt();
            (ends, left * area * linear(kelvin[ends[0]], kelvin[ends[1]]))
        });
        for ([i, reservoir], area) in self.links() {
            let node = i + shift;
            let h = linear(kelvin[node], reservoirs[reservoir]);
            reservoir_links.push(([node, reservoir], area * h));
        }
        for i in 0..shift {
            let h = linear(kelvin[i], kelvin[i + shift]);
            bonds.push(([i, i + shift], self.own(i) * h));
        }
    }
}

/// e/(1 − e) above which a surface counts as black.
const BLACK: f64 = 1e6;
