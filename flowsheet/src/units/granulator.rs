//! A granulator.

use calcine_physics::sphere::volume_of_diameter;

use crate::distribution::OUTSIDE;
use crate::population::dyssol_growth;
use crate::population::{GrowthLaw, GrowthScheme, SizeFluxes, SizeProcess, UniformGrowth};
use crate::{PlantError, ProcessUnit, StreamLayout, UnitView};

/// How much a granulator holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BedLevel {
    /// What enters pushes out as much: the mass stays.
    Fixed,
    /// Mass divided by a residence time in s.
    Residence(f64),
    /// A controller in proportion: what enters, and the mass above the set point divided by a time.
    Controlled {
        /// Set point in kg.
        mass: f64,
        /// Time of the controller in s.
        time: f64,
    },
}

/// Where the temperature of a granulator comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BedHeat {
    /// It is held in K; the heat that this takes is a line of the ledger.
    Held(f64),
    /// It follows from what enters and evaporates; at the start it is this, in K.
    Balanced(f64),
}

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

/// A continuous granulator, well mixed: nuclei and recycle grow by what is sprayed on them.
///
/// Solids of the compounds that do not evaporate, sprayed as liquid or solid, are deposited on particles by the population
/// balance (docs/theory.md, PBM-1 to PBM-7); volatile liquids evaporate but for the moisture that the product keeps. Ports:
/// "feed", "spray", "gas" in; "product", "exhaust" out.
pub struct Granulator {
    density: f64,
    content: Vec<f64>,
    moisture: f64,
    level: BedLevel,
    heat: BedHeat,
    law: Box<dyn GrowthLaw>,
    scheme: GrowthScheme,
    overspray: Overspray,
    wear: f64,
    processes: Vec<Box<dyn SizeProcess>>,
    // Prepared.
    fluxes: Option<SizeFluxes>,
    particle: Vec<f64>,
    growth: Vec<f64>,
    held: f64,
}

const FEED: usize = 0;
const SPRAY: usize = 1;
const GAS: usize = 2;

/// Flows of solids through a granulator.
struct Turnover {
    /// Solids deposited on particles, by compound, and their sum, in kg/s.
    deposit: Vec<f64>,
    deposited: f64,
    /// Dust by compound in kg/s: overspray.
    dust: Vec<f64>,
    /// Solids that leave as product in kg/s.
    product: f64,
    /// Worn off by size class, attribute and compound in kg/s; empty without wear.
    worn: Vec<f64>,
}

impl Granulator {
    /// A granulator whose bed has the masses `content` in kg at the start (the solids of the plant's layout), of granules of a
    /// density in kg/m³, with uniform growth by van Leer's scheme, a fixed mass and a held temperature of 300 K.
    pub fn new(content: Vec<f64>, density: f64) -> Self {
        Self {
            density,
            content,
            moisture: 0.0,
            level: BedLevel::Fixed,
            heat: BedHeat::Held(300.0),
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
            held: 0.0,
        }
    }

    /// With volatile liquid of so many kg per kg of solids in bed and product.
    pub fn with_moisture(mut self, moisture: f64) -> Self {
        self.moisture = moisture;
        self
    }

    /// With another rule for the mass.
    pub fn with_level(mut self, level: BedLevel) -> Self {
        self.level = level;
        self
    }

    /// With another rule for the temperature.
    pub fn with_heat(mut self, heat: BedHeat) -> Self {
        self.heat = heat;
        self
    }

    /// With growth that depends on size.
    pub fn with_growth(mut self, law: Box<dyn GrowthLaw>) -> Self {
        self.law = law;
        self
    }

    /// With another scheme.
    pub fn with_scheme(mut self, scheme: GrowthScheme) -> Self {
        self.scheme = scheme;
        self
    }

    /// With dust.
    pub fn with_overspray(mut self, overspray: Overspray) -> Self {
        self.overspray = overspray;
        self
    }

    /// With attrition: every diameter shrinks at this rate in m/s, and what is worn off is dust.
    pub fn with_wear(mut self, rate: f64) -> Self {
        self.wear = rate;
        self
    }

    /// With aggregation, breakage, or any other process that moves solids between classes.
    pub fn with_process(mut self, process: Box<dyn SizeProcess>) -> Self {
        self.processes.push(process);
        self
    }

    fn refuse(name: &str, quantity: &'static str, value: f64, allowed: &'static str) -> PlantError {
        PlantError::Value {
            place: format!("granulator \"{name}\""),
            quantity,
            value,
            allowed,
        }
    }

    fn numbers(&self, layout: &StreamLayout, state: &[f64]) -> Vec<f64> {
        let classes = state[..layout.solids()].chunks_exact(layout.inner());
        let number = |(class, m): (&[f64], &f64)| class.iter().sum::<f64>() / m;
        classes.zip(&self.particle).map(number).collect()
    }

    /// Solids that enter as particles, all of them; what is sprayed does not count.
    fn feed(view: &UnitView<'_>) -> f64 {
        view.layout.solid_flow(view.inlet(FEED)) + view.layout.solid_flow(view.inlet(GAS))
    }

    fn turnover(&self, view: &UnitView<'_>) -> Turnover {
        let layout = view.layout;
        let compounds = layout.compounds();
        let spray = view.inlet(SPRAY);
        let mut sprayed = vec![0.0; compounds.len()];
        for cell in spray[..layout.solids()].chunks_exact(compounds.len()) {
            sprayed
                .iter_mut()
                .zip(cell)
                .for_each(|(s, flow)| *s += flow);
        }
        for (k, compound) in compounds.iter().enumerate() {
            if !compound.volatile {
                let inlets = view.all_inlets();
                sprayed[k] += inlets.map(|s| s[layout.liquid(k)]).sum::<f64>();
            }
        }
        let share = self.overspray.share;
        let dust: Vec<f64> = sprayed.iter().map(|flow| share * flow).collect();
        let deposit: Vec<f64> = sprayed.iter().zip(&dust).map(|(s, d)| s - d).collect();
        let deposited: f64 = deposit.iter().sum();
        let worn = self.worn(layout, view.state);
        let lost: f64 = worn.iter().sum();
        let returned = self.overspray.returned * (dust.iter().sum::<f64>() + lost);
        let enters = Self::feed(view) + deposited + returned - lost;
        let mass: f64 = view.state[..layout.solids()].iter().sum();
        let product = match self.level {
            BedLevel::Fixed => enters,
            BedLevel::Residence(time) => mass / time,
            BedLevel::Controlled { mass: set, time } => (enters + (mass - set) / time).max(0.0),
        };
        Turnover {
            deposit,
            deposited,
            dust,
            product,
            worn,
        }
    }

    /// What wears off in kg/s, by size class, attribute and compound.
    fn worn(&self, layout: &StreamLayout, state: &[f64]) -> Vec<f64> {
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

    /// Adds growth: number passes from class to class, and the spray's mass with it.
    fn grow(&self, layout: &StreamLayout, state: &[f64], turnover: &Turnover, rates: &mut [f64]) {
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
        let mut faces = vec![0.0; numbers.len() - 1];
        fluxes.growing(&numbers, &mut faces);
        let gained = |class: usize| self.particle[class + 1] - self.particle[class];
        let weighted = faces.iter_mut().zip(&self.growth).enumerate();
        let gain: f64 = weighted
            .map(|(class, (face, g))| {
                *face *= g;
                *face * gained(class)
            })
            .sum();
        let speed = turnover.deposited / gain;
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
    fn nuclei(&self, layout: &StreamLayout, turnover: &Turnover, share: f64, out: &mut [f64]) {
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

    fn temperature(&self, layout: &StreamLayout, state: &[f64]) -> f64 {
        match self.heat {
            BedHeat::Held(temperature) => temperature,
            BedHeat::Balanced(start) => {
                let mut held = vec![0.0; layout.width()];
                self.held(layout, state, &mut held);
                layout.temperature(&held).unwrap_or(start)
            }
        }
    }

    /// The volatile liquid that solids of a mass bring with them, divided by the shares of what enters.
    fn moisture(&self, layout: &StreamLayout) -> Option<usize> {
        (0..layout.compounds().len()).find(|k| layout.compounds()[*k].volatile)
    }
}

impl ProcessUnit for Granulator {
    fn inlets(&self) -> Vec<String> {
        ["feed", "spray", "gas"].map(String::from).to_vec()
    }

    fn outlets(&self) -> Vec<String> {
        ["product", "exhaust"].map(String::from).to_vec()
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let classes = layout.grid().classes();
        if self.overspray.sizes.is_empty() {
            self.overspray.sizes = vec![0.0; classes];
            self.overspray.sizes[0] = 1.0;
        }
        if self.content.len() != layout.solids() || self.overspray.sizes.len() != classes {
            let value = self.content.len() as f64;
            let allowed = "bed and dust have the classes of the plant's layout";
            return Err(Self::refuse(name, "length of the content", value, allowed));
        }
        self.held = self.content.iter().sum();
        let dust: f64 = self.overspray.sizes.iter().sum();
        let above = "it is above zero";
        let share = "it is 0 to 1";
        let inside = |x: f64| (0.0..=1.0).contains(&x);
        for (good, quantity, value, allowed) in [
            (self.held > 0.0, "mass of the bed in kg", self.held, above),
            (self.density > 0.0, "density in kg/m³", self.density, above),
            (
                self.moisture >= 0.0,
                "moisture",
                self.moisture,
                "it is not negative",
            ),
            (
                self.wear >= 0.0,
                "rate of attrition in m/s",
                self.wear,
                "it is not negative",
            ),
            (
                inside(self.overspray.share),
                "overspray",
                self.overspray.share,
                share,
            ),
            (
                inside(self.overspray.returned),
                "share of dust",
                self.overspray.returned,
                share,
            ),
            (
                (dust - 1.0).abs() < 1e-9,
                "sum of the dust's sizes",
                dust,
                "it is 1",
            ),
        ] {
            if !(good && value.is_finite()) {
                return Err(Self::refuse(name, quantity, value, allowed));
            }
        }
        let mass = |d: &f64| self.density * volume_of_diameter(*d);
        self.particle = layout.grid().diameters().iter().map(mass).collect();
        let faces = layout.grid().edges()[1..classes].iter();
        self.growth = faces.map(|d| self.law.relative(*d)).collect();
        if let Some(bad) = self.growth.iter().find(|g| !(g.is_finite() && **g >= 0.0)) {
            return Err(Self::refuse(
                name,
                "relative growth",
                *bad,
                "it is finite and not negative",
            ));
        }
        self.fluxes = Some(SizeFluxes::new(layout.grid(), self.scheme));
        let place = format!("granulator \"{name}\"");
        for process in &mut self.processes {
            process.prepare(layout.grid(), &self.particle, &place)?;
        }
        Ok(())
    }

    fn unknowns(&self, layout: &StreamLayout) -> usize {
        layout.solids() + usize::from(matches!(self.heat, BedHeat::Balanced(_)))
    }

    fn start(&self, layout: &StreamLayout, state: &mut [f64]) {
        state[..layout.solids()].copy_from_slice(&self.content);
        if let BedHeat::Balanced(temperature) = self.heat {
            let mut held = vec![0.0; layout.width()];
            held[..layout.solids()].copy_from_slice(&self.content);
            if let Some(k) = self.moisture(layout) {
                held[layout.liquid(k)] = self.moisture * self.held;
            }
            layout.set_temperature(&mut held, temperature);
            state[layout.solids()] = held[layout.enthalpy()];
        }
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let turnover = self.turnover(view);
        let (product, exhaust) = out.split_at_mut(layout.width());
        let mass: f64 = view.state[..layout.solids()].iter().sum();
        let share = turnover.product / mass;
        let solids = product.iter_mut().zip(&view.state[..layout.solids()]);
        solids.for_each(|(p, held)| *p = share * held);
        self.nuclei(layout, &turnover, 1.0 - self.overspray.returned, exhaust);
        for (k, compound) in layout.compounds().iter().enumerate() {
            let vapour: f64 = view.all_inlets().map(|s| s[layout.vapour(k)]).sum();
            exhaust[layout.vapour(k)] = vapour;
            if compound.volatile {
                let liquid: f64 = view.all_inlets().map(|s| s[layout.liquid(k)]).sum();
                exhaust[layout.vapour(k)] += liquid;
            }
        }
        if let Some(k) = self.moisture(layout).filter(|_| self.moisture > 0.0) {
            // What the bed keeps as it gains mass counts too.
            let enters = Self::feed(view) + turnover.deposited;
            let stays = match self.level {
                BedLevel::Fixed => 0.0,
                _ => self.moisture * (enters - turnover.product),
            };
            let place = layout.liquid(k);
            product[place] = self.moisture * turnover.product;
            let evaporated = exhaust[layout.vapour(k)] - product[place] - stays;
            let brought: f64 = view.all_inlets().map(|s| s[place]).sum();
            if product[place] + stays > brought * (1.0 + 1e-9) {
                return Err(Self::refuse(
                    view.name,
                    "liquid for the product's moisture in kg/s",
                    brought,
                    "the moisture takes more than enters: lower `moisture`, or spray more liquid",
                ));
            }
            exhaust[layout.vapour(k)] = evaporated;
        }
        let temperature = self.temperature(layout, view.state);
        layout.set_temperature(product, temperature);
        layout.set_temperature(exhaust, temperature);
        Ok(())
    }

    fn rates(&self, view: &UnitView<'_>, out: &[f64], rates: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let turnover = self.turnover(view);
        let places = 0..layout.solids();
        let (feed, gas, product) = (view.inlet(FEED), view.inlet(GAS), &out[..layout.width()]);
        for place in places.clone() {
            rates[place] = feed[place] + gas[place] - product[place];
        }
        if self.scheme == GrowthScheme::Dyssol {
            // Divided by the mass at the start, whatever the scheme made of it.
            for place in places {
                let leaves = turnover.product * view.state[place] / self.held;
                rates[place] = feed[place] + gas[place] - leaves;
            }
        }
        self.grow(layout, view.state, &turnover, rates);
        if self.wear > 0.0 {
            let inner = layout.inner();
            self.each_shrinking(layout, view.state, |class, flux, masses| {
                let sum: f64 = masses.iter().sum();
                for (part, mass) in masses.iter().enumerate() {
                    let number = flux * mass / sum;
                    rates[class * inner + part] -= number * self.particle[class];
                    rates[(class - 1) * inner + part] += number * self.particle[class - 1];
                }
            });
        }
        if self.overspray.returned > 0.0 {
            self.nuclei(layout, &turnover, self.overspray.returned, rates);
        }
        for process in &self.processes {
            process.add(layout.inner(), &view.state[..layout.solids()], rates);
        }
        if matches!(self.heat, BedHeat::Balanced(_)) {
            let place = layout.enthalpy();
            let enters: f64 = view.all_inlets().map(|s| s[place]).sum();
            let leaves: f64 = out.chunks_exact(layout.width()).map(|s| s[place]).sum();
            rates[layout.solids()] = enters - leaves;
        }
        Ok(())
    }

    fn heat(&self, view: &UnitView<'_>, out: &[f64], rates: &[f64]) -> f64 {
        let BedHeat::Held(temperature) = self.heat else {
            return 0.0;
        };
        let layout = view.layout;
        let place = layout.enthalpy();
        let enters: f64 = view.all_inlets().map(|s| s[place]).sum();
        let leaves: f64 = out.chunks_exact(layout.width()).map(|s| s[place]).sum();
        // The bed's own change, as its mass changes.
        let mut change = vec![0.0; layout.width()];
        self.held(layout, rates, &mut change);
        layout.set_temperature(&mut change, temperature);
        change[place] + leaves - enters
    }

    fn held(&self, layout: &StreamLayout, state: &[f64], held: &mut [f64]) {
        let mut own = vec![0.0; layout.width()];
        own[..layout.solids()].copy_from_slice(&state[..layout.solids()]);
        if let Some(k) = self.moisture(layout) {
            let mass: f64 = state[..layout.solids()].iter().sum();
            own[layout.liquid(k)] = self.moisture * mass;
        }
        match self.heat {
            BedHeat::Held(temperature) => layout.set_temperature(&mut own, temperature),
            BedHeat::Balanced(_) => own[layout.enthalpy()] = state[layout.solids()],
        }
        held.iter_mut().zip(&own).for_each(|(h, o)| *h += o);
    }

    fn scales(&self, layout: &StreamLayout, scales: &mut [f64]) {
        scales.fill(self.held / layout.grid().classes() as f64);
        if let Some(enthalpy) = scales.get_mut(layout.solids()) {
            *enthalpy = self.held * 1e5;
        }
    }

    fn constrain(&self, layout: &StreamLayout, state: &mut [f64]) {
        if self.level == BedLevel::Fixed && self.scheme != GrowthScheme::Dyssol {
            let mass: f64 = state[..layout.solids()].iter().sum();
            let share = self.held / mass;
            state[..layout.solids()]
                .iter_mut()
                .for_each(|m| *m *= share);
        }
    }

    fn invariants(&self) -> usize {
        usize::from(self.level == BedLevel::Fixed && self.scheme != GrowthScheme::Dyssol)
    }

    fn verify(&self, view: &UnitView<'_>) -> Result<(), PlantError> {
        let layout = view.layout;
        let masses = layout.by_size(view.state);
        let all: f64 = masses.iter().sum();
        let last = masses[masses.len() - 1] / all;
        if last > OUTSIDE.sqrt() || !last.is_finite() {
            let (from, to) = layout.grid().range();
            return Err(PlantError::OutsideGrid {
                place: format!(
                    "granulator \"{}\" at {} s, last class",
                    view.name, view.time
                ),
                share: last,
                from,
                to,
            });
        }
        Ok(())
    }
}
