//! What moves the solids of a granulator between size classes.

use calcine_physics::sphere::volume_of_diameter;

use crate::population::{
    GrowthLaw, GrowthScheme, SizeFluxes, SizeProcess, UniformGrowth, dyssol_growth,
};
use crate::{PlantError, StreamLayout};

/// The fastest mode of limited fluxes between classes, in passages of a class per second.
const LIMITED: f64 = 3.0;

/// Spray that dries before it hits a particle, and dust that particles wear off.
#[derive(Clone, Debug, PartialEq)]
pub struct Overspray {
    /// Share K_os of the sprayed solids that becomes dust.
    pub share: f64,
    /// Share of all dust that stays in the bed as nuclei; the other leaves with the exhaust gas.
    pub returned: f64,
    /// Shares of the mass of dust by size class.
    pub sizes: Vec<f64>,
}

/// Flows of solids through a granulator.
pub(super) struct Turnover {
    /// Solids deposited on particles, by compound, and their sum, in kg/s.
    pub(super) deposit: Vec<f64>,
    pub(super) deposited: f64,
    /// Dust by compound in kg/s: overspray.
    pub(super) dust: Vec<f64>,
    /// Solids that come to stay: fed, deposited and returned, less what wears off, in kg/s.
    pub(super) enters: f64,
    /// Solids that leave as product in kg/s.
    pub(super) product: f64,
    /// Worn off by size class, attribute and compound in kg/s; empty without wear.
    pub(super) worn: Vec<f64>,
}

/// What moves the solids of a bed between size classes: laws, and what is prepared of them.
pub(super) struct BedSizes {
    /// Density of granules in kg/m³.
    pub(super) density: f64,
    pub(super) law: Box<dyn GrowthLaw>,
    pub(super) scheme: GrowthScheme,
    pub(super) overspray: Overspray,
    /// Rate of attrition in m/s.
    pub(super) wear: f64,
    pub(super) processes: Vec<Box<dyn SizeProcess>>,
    fluxes: Option<SizeFluxes>,
    /// Mass in kg of a particle of each class.
    particle: Vec<f64>,
    /// Relative growth at the face above each class but the last.
    growth: Vec<f64>,
}

impl BedSizes {
    /// Uniform growth by van Leer's scheme, and nothing else.
    pub(super) fn new(density: f64) -> Self {
        Self {
            density,
            law: Box::new(UniformGrowth),
            scheme: GrowthScheme::VanLeer,
            overspray: Overspray {
                share: 0.0,
                returned: 0.0,
                sizes: Vec::new(),
            },
            wear: 0.0,
            processes: Vec::new(),
            fluxes: None,
            particle: Vec::new(),
            growth: Vec::new(),
        }
    }

    /// Looks at the numbers and prepares what does not change. `place` is what errors name.
    pub(super) fn prepare(&mut self, layout: &StreamLayout, place: &str) -> Result<(), PlantError> {
        let classes = layout.grid().classes();
        if self.overspray.sizes.is_empty() {
            self.overspray.sizes = vec![0.0; classes];
            self.overspray.sizes[0] = 1.0;
        }
        let refuse = |quantity, value, allowed| PlantError::Value {
            place: place.to_owned(),
            quantity,
            value,
            allowed,
        };
        let own = self.overspray.sizes.len();
        let dust: f64 = self.overspray.sizes.iter().sum();
        let inside = |x: f64| (0.0..=1.0).contains(&x);
        let (share, returned) = (self.overspray.share, self.overspray.returned);
        let (some, part) = ("it is above zero", "it is 0 to 1");
        for (good, quantity, value, allowed) in [
            (
                own == classes,
                "classes of the dust",
                own as f64,
                "as many as the plant's",
            ),
            (self.density > 0.0, "density in kg/m³", self.density, some),
            (
                self.wear >= 0.0,
                "rate of attrition in m/s",
                self.wear,
                "it is not negative",
            ),
            (inside(share), "overspray", share, part),
            (inside(returned), "share of dust", returned, part),
            (
                (dust - 1.0).abs() < 1e-9,
                "sum of the dust's sizes",
                dust,
                "it is 1",
            ),
        ] {
            if !(good && value.is_finite()) {
                return Err(refuse(quantity, value, allowed));
            }
        }
        let mass = |d: &f64| self.density * volume_of_diameter(*d);
        self.particle = layout.grid().diameters().iter().map(mass).collect();
        let faces = layout.grid().edges()[1..classes].iter();
        self.growth = faces.map(|d| self.law.relative(*d)).collect();
        if let Some(bad) = self.growth.iter().find(|g| !(g.is_finite() && **g >= 0.0)) {
            return Err(refuse(
                "relative growth",
                *bad,
                "it is finite and not negative",
            ));
        }
        self.fluxes = Some(SizeFluxes::new(layout.grid(), self.scheme));
        for process in &mut self.processes {
            process.prepare(layout.grid(), &self.particle, place)?;
        }
        Ok(())
    }

    /// Mass in kg of a particle of each class.
    pub(super) fn particles(&self) -> &[f64] {
        &self.particle
    }

    /// Adds the rates of growth, attrition, returning dust, and all processes.
    pub(super) fn add(
        &self,
        layout: &StreamLayout,
        state: &[f64],
        turnover: &Turnover,
        births: &[f64],
        rates: &mut [f64],
    ) {
        self.grow(layout, state, turnover, births, rates);
        if self.wear > 0.0 {
            let inner = layout.inner();
            self.each_shrinking(layout, state, |class, flux, masses| {
                let sum: f64 = masses.iter().sum();
                for (part, mass) in masses.iter().enumerate() {
                    let number = flux * mass / sum;
                    rates[class * inner + part] -= number * self.particle[class];
                    rates[(class - 1) * inner + part] += number * self.particle[class - 1];
                }
            });
        }
        if self.overspray.returned > 0.0 {
            self.nuclei(layout, turnover, self.overspray.returned, rates);
        }
        for process in &self.processes {
            process.add(layout.inner(), &state[..layout.solids()], rates);
        }
    }

    fn numbers(&self, layout: &StreamLayout, state: &[f64]) -> Vec<f64> {
        if layout.inner() == 1 {
            let pairs = state.iter().zip(&self.particle);
            return pairs.map(|(mass, particle)| mass / particle).collect();
        }
        let classes = state[..layout.solids()].chunks_exact(layout.inner());
        let number = |(class, m): (&[f64], &f64)| class.iter().sum::<f64>() / m;
        classes.zip(&self.particle).map(number).collect()
    }

    /// What wears off in kg/s, by size class, attribute and compound.
    pub(super) fn worn(&self, layout: &StreamLayout, state: &[f64]) -> Vec<f64> {
        let mut worn = Vec::new();
        if self.wear == 0.0 {
            return worn;
        }
        worn.resize(layout.solids(), 0.0);
        let inner = layout.inner();
        self.each_shrinking(layout, state, |class, flux, masses| {
            let gap = self.particle[class] - self.particle[class - 1];
            let sum: f64 = masses.iter().sum();
            let out = &mut worn[class * inner..(class + 1) * inner];
            for (w, m) in out.iter_mut().zip(masses) {
                *w = flux * gap * m / sum;
            }
        });
        worn
    }

    /// Number flux in 1/s out of each class into the one below, where there is one.
    fn each_shrinking(
        &self,
        layout: &StreamLayout,
        state: &[f64],
        mut visit: impl FnMut(usize, f64, &[f64]),
    ) {
        let Some(fluxes) = &self.fluxes else { return };
        let numbers = self.numbers(layout, state);
        let mut faces = vec![0.0; numbers.len() - 1];
        fluxes.shrinking(&numbers, &mut faces);
        let inner = layout.inner();
        for (below, face) in faces.iter().enumerate() {
            let class = below + 1;
            let masses = &state[class * inner..(class + 1) * inner];
            if masses.iter().sum::<f64>() != 0.0 {
                visit(class, self.wear * face, masses);
            }
        }
    }

    /// Particles that come into each class in 1/s: fed by streams, and the dust that returns as nuclei.
    pub(super) fn births(
        &self,
        layout: &StreamLayout,
        streams: [&[f64]; 2],
        turnover: &Turnover,
    ) -> Vec<f64> {
        let mut births = self.numbers(layout, &streams[0][..layout.solids()]);
        // Gas seldom carries solids.
        if streams[1][..layout.solids()]
            .iter()
            .any(|flow| *flow != 0.0)
        {
            let carried = self.numbers(layout, &streams[1][..layout.solids()]);
            births.iter_mut().zip(carried).for_each(|(b, c)| *b += c);
        }
        if self.overspray.returned > 0.0 {
            let lost = turnover.dust.iter().sum::<f64>() + turnover.worn.iter().sum::<f64>();
            let nuclei = self.overspray.returned * lost;
            for ((birth, share), m) in births
                .iter_mut()
                .zip(&self.overspray.sizes)
                .zip(&self.particle)
            {
                *birth += nuclei * share / m;
            }
        }
        births
    }

    /// Number density times relative growth at the face above each class but the last, and what passes there gains per
    /// unit of growth, in kg/m.
    fn faces(
        &self,
        fluxes: &SizeFluxes,
        numbers: &[f64],
        turnover: &Turnover,
        births: &[f64],
    ) -> (Vec<f64>, f64) {
        let faces = numbers.len() - 1;
        let gains = || self.growth.iter().zip(self.particle.windows(2));
        // The speed of growth to first order, which does for the share of births within a class.
        let densities = fluxes.densities(numbers);
        let plain: f64 = densities
            .iter()
            .zip(gains())
            .map(|(n, (g, pair))| n * g * (pair[1] - pair[0]))
            .sum();
        let mut rises = vec![0.0; numbers.len()];
        if turnover.deposited > 0.0 {
            for ((rise, birth), g) in rises.iter_mut().zip(births).zip(&self.growth) {
                let growth = turnover.deposited / plain * g;
                *rise = if growth > 0.0 { birth / growth } else { 0.0 };
            }
        }
        let mut found = vec![0.0; faces];
        fluxes.growing(numbers, &rises, &mut found);
        let mut gain = 0.0;
        for (face, (g, pair)) in found.iter_mut().zip(gains()) {
            *face *= g;
            gain += *face * (pair[1] - pair[0]);
        }
        (found, gain)
    }

    /// A bound of how fast small deviations between classes fade, in 1/s.
    pub(super) fn fastest(
        &self,
        layout: &StreamLayout,
        state: &[f64],
        turnover: &Turnover,
        births: &[f64],
    ) -> f64 {
        let Some(fluxes) = &self.fluxes else {
            return 0.0;
        };
        let numbers = self.numbers(layout, state);
        let (_, gain) = self.faces(fluxes, &numbers, turnover, births);
        let speed = if turnover.deposited == 0.0 {
            0.0
        } else {
            turnover.deposited / gain
        };
        let grid = layout.grid();
        let passed = self.growth.iter().enumerate();
        let passed = passed.map(|(class, g)| (speed * g + self.wear) / grid.width(class));
        let masses = &state[..layout.solids()];
        let processes = self.processes.iter();
        let processes: f64 = processes.map(|p| p.fastest(layout.inner(), masses)).sum();
        LIMITED * passed.fold(0.0, f64::max) + processes
    }

    /// Adds growth: number passes from class to class, and the spray's mass with it.
    fn grow(
        &self,
        layout: &StreamLayout,
        state: &[f64],
        turnover: &Turnover,
        births: &[f64],
        rates: &mut [f64],
    ) {
        let Some(fluxes) = &self.fluxes else { return };
        if turnover.deposited == 0.0 {
            return;
        }
        let (inner, compounds) = (layout.inner(), layout.compounds().len());
        let numbers = self.numbers(layout, state);
        if self.scheme == GrowthScheme::Dyssol {
            let masses = layout.by_size(state);
            let grown: f64 = masses
                .iter()
                .zip(layout.grid().diameters())
                .map(|(m, d)| m / d)
                .sum();
            let area = 6.0 / self.density * grown;
            let growth = 2.0 * turnover.deposited / (self.density * area);
            let mut made = vec![0.0; masses.len()];
            dyssol_growth(layout.grid(), growth, &masses, false, &mut made);
            for (class, rate) in made.iter().enumerate() {
                for part in 0..inner {
                    let share = turnover.deposit[part % compounds] / turnover.deposited;
                    rates[class * inner + part] += rate * share * compounds as f64 / inner as f64;
                }
            }
            return;
        }
        let (faces, gain) = self.faces(fluxes, &numbers, turnover, births);
        let speed = turnover.deposited / gain;
        let gained = |class: usize| self.particle[class + 1] - self.particle[class];
        if inner == 1 {
            for (class, face) in faces.iter().enumerate() {
                rates[class] -= speed * face * self.particle[class];
                rates[class + 1] += speed * face * self.particle[class + 1];
            }
            return;
        }
        for (class, face) in faces.iter().enumerate() {
            let flux = speed * face;
            let own = &state[class * inner..(class + 1) * inner];
            let sum: f64 = own.iter().sum();
            if flux == 0.0 || sum == 0.0 {
                continue;
            }
            let (moved, new) = (flux * self.particle[class] / sum, flux * gained(class));
            for (part, mass) in own.iter().enumerate() {
                rates[class * inner + part] -= moved * mass;
                rates[(class + 1) * inner + part] += moved * mass;
            }
            // New mass is of the spray's compounds and has the attributes of the particles it falls on.
            for (cell, masses) in own.chunks_exact(compounds).enumerate() {
                let share = masses.iter().sum::<f64>() / sum * new / turnover.deposited;
                for (k, deposit) in turnover.deposit.iter().enumerate() {
                    rates[(class + 1) * inner + cell * compounds + k] += share * deposit;
                }
            }
        }
    }

    /// Adds dust that stays to the bed.
    pub(super) fn nuclei(
        &self,
        layout: &StreamLayout,
        turnover: &Turnover,
        share: f64,
        out: &mut [f64],
    ) {
        if turnover.worn.is_empty() && turnover.dust.iter().all(|flow| *flow == 0.0) {
            return;
        }
        let (inner, compounds) = (layout.inner(), layout.compounds().len());
        let mut dust = turnover.dust.clone();
        for (place, worn) in turnover.worn.iter().enumerate() {
            dust[place % compounds] += worn;
        }
        // New particles have the first class of every attribute.
        for (class, size) in self.overspray.sizes.iter().enumerate() {
            for (k, flow) in dust.iter().enumerate() {
                out[class * inner + k] += share * size * flow;
            }
        }
    }
}
