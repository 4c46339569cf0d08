//! A granulator.

mod bed_kernel;
mod sizes;

pub use bed_kernel::BedKernel;
pub use sizes::Overspray;

use sizes::{BedSizes, Turnover};

use crate::distribution::OUTSIDE;
use crate::population::{GrowthLaw, GrowthScheme, SizeProcess};
use crate::sums::{add_in_turns, sum};
use crate::{PlantError, ProcessUnit, SignalKind, StreamLayout, UnitView};

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

/// A continuous granulator, well mixed: nuclei and recycle grow by what is sprayed on them.
///
/// Solids of the compounds that do not evaporate, sprayed as liquid or solid, are deposited on particles by the population
/// balance (docs/theory.md, PBM-1 to PBM-7); volatile liquids evaporate but for the moisture that the product keeps. Ports:
/// "feed", "spray", "gas" in; "product", "exhaust" out.
pub struct Granulator {
    sizes: BedSizes,
    content: Vec<f64>,
    moisture: f64,
    level: BedLevel,
    heat: BedHeat,
    /// Mass of the content in kg.
    held: f64,
    /// Aggregation by what a bed of the plant returns.
    bed_kernel: Option<BedKernel>,
}

/// Share of the mass in the last size class from which a kernel that gels is taken to have done so.
const GELLED: f64 = 1e-4;

const FEED: usize = 0;
const SPRAY: usize = 1;
const GAS: usize = 2;

impl Granulator {
    /// A granulator whose bed has the masses `content` in kg at the start (the solids of the plant's layout), of granules of a
    /// density in kg/m³, with uniform growth by van Leer's scheme, a fixed mass and a held temperature of 300 K.
    pub fn new(content: Vec<f64>, density: f64) -> Self {
        Self {
            sizes: BedSizes::new(density),
            content,
            moisture: 0.0,
            level: BedLevel::Fixed,
            heat: BedHeat::Held(300.0),
            held: 0.0,
            bed_kernel: None,
        }
    }

    /// With aggregation by the collisions that a bed of the plant counts.
    pub fn with_bed_kernel(mut self, kernel: BedKernel) -> Self {
        self.bed_kernel = Some(kernel);
        self
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
        self.sizes.law = law;
        self
    }

    /// With another scheme.
    pub fn with_scheme(mut self, scheme: GrowthScheme) -> Self {
        self.sizes.scheme = scheme;
        self
    }

    /// With dust.
    pub fn with_overspray(mut self, overspray: Overspray) -> Self {
        self.sizes.overspray = overspray;
        self
    }

    /// With attrition: every diameter shrinks at this rate in m/s, and what is worn off is dust.
    pub fn with_wear(mut self, rate: f64) -> Self {
        self.sizes.wear = rate;
        self
    }

    /// With aggregation, breakage, or any other process that moves solids between classes.
    pub fn with_process(mut self, process: Box<dyn SizeProcess>) -> Self {
        self.sizes.processes.push(process);
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

    /// Solids that enter as particles, all of them; what is sprayed does not count.
    fn feed(view: &UnitView<'_>) -> f64 {
        view.layout.solid_flow(view.inlet(FEED)) + view.layout.solid_flow(view.inlet(GAS))
    }

    fn turnover(&self, view: &UnitView<'_>) -> Turnover {
        let layout = view.layout;
        let compounds = layout.compounds();
        let spray = view.inlet(SPRAY);
        let mut sprayed = vec![0.0; compounds.len()];
        add_in_turns(&spray[..layout.solids()], &mut sprayed);
        for (k, compound) in compounds.iter().enumerate() {
            if !compound.volatile {
                let inlets = view.all_inlets();
                sprayed[k] += inlets.map(|s| s[layout.liquid(k)]).sum::<f64>();
            }
        }
        let share = self.sizes.overspray.share;
        let dust: Vec<f64> = sprayed.iter().map(|flow| share * flow).collect();
        let deposit: Vec<f64> = sprayed.iter().zip(&dust).map(|(s, d)| s - d).collect();
        let deposited: f64 = deposit.iter().sum();
        let worn = self.sizes.worn(layout, view.state);
        let lost: f64 = worn.iter().sum();
        let returned = self.sizes.overspray.returned * (dust.iter().sum::<f64>() + lost);
        let enters = Self::feed(view) + deposited + returned - lost;
        let mass = sum(&view.state[..layout.solids()]);
        let product = match self.level {
            BedLevel::Fixed => enters,
            BedLevel::Residence(time) => mass / time,
            BedLevel::Controlled { mass: set, time } => (enters + (mass - set) / time).max(0.0),
        };
        Turnover {
            deposit,
            deposited,
            dust,
            enters,
            product,
            worn,
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
        if self.content.len() != layout.solids() {
            let value = self.content.len() as f64;
            let allowed = "the bed has the classes of the plant's layout";
            return Err(Self::refuse(name, "length of the content", value, allowed));
        }
        self.held = self.content.iter().sum();
        if !(self.held > 0.0 && self.held.is_finite()) {
            let allowed = "it is above zero";
            return Err(Self::refuse(
                name,
                "mass of the bed in kg",
                self.held,
                allowed,
            ));
        }
        if !(self.moisture >= 0.0 && self.moisture.is_finite()) {
            let allowed = "it is finite and not negative";
            return Err(Self::refuse(name, "moisture", self.moisture, allowed));
        }
        let place = format!("granulator \"{name}\"");
        self.sizes.prepare(layout, &place)?;
        match &mut self.bed_kernel {
            Some(kernel) => kernel.prepare(layout.grid(), self.sizes.particles(), &place),
            None => Ok(()),
        }
    }

    fn listens_to(&self) -> Vec<(String, SignalKind)> {
        let kernel = self.bed_kernel.iter();
        kernel
            .map(|one| (one.bed.clone(), SignalKind::Kernel))
            .collect()
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
        let mass = sum(&view.state[..layout.solids()]);
        let share = turnover.product / mass;
        let solids = product.iter_mut().zip(&view.state[..layout.solids()]);
        solids.for_each(|(p, held)| *p = share * held);
        self.sizes.nuclei(
            layout,
            &turnover,
            1.0 - self.sizes.overspray.returned,
            exhaust,
        );
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
            let stays = match self.level {
                BedLevel::Fixed => 0.0,
                _ => self.moisture * (turnover.enters - turnover.product),
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
        if self.sizes.scheme == GrowthScheme::Dyssol {
            // Divided by the mass at the start, whatever the scheme made of it.
            for place in places {
                let leaves = turnover.product * view.state[place] / self.held;
                rates[place] = feed[place] + gas[place] - leaves;
            }
        }
        let births = self.sizes.births(layout, [feed, gas], &turnover);
        self.sizes
            .add(layout, view.state, &turnover, &births, rates);
        if let Some(kernel) = &self.bed_kernel {
            let masses = &view.state[..layout.solids()];
            let rates = &mut rates[..layout.solids()];
            kernel.add(view.signal(0), layout.inner(), masses, rates)?;
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
            let mass = sum(&state[..layout.solids()]);
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
        if self.level == BedLevel::Fixed && self.sizes.scheme != GrowthScheme::Dyssol {
            let mass: f64 = state[..layout.solids()].iter().sum();
            let share = self.held / mass;
            state[..layout.solids()]
                .iter_mut()
                .for_each(|m| *m *= share);
        }
    }

    fn fastest(&self, view: &UnitView<'_>, _out: &[f64]) -> f64 {
        let turnover = self.turnover(view);
        let mass = sum(&view.state[..view.layout.solids()]);
        let kernel = self.bed_kernel.as_ref().map_or(0.0, |kernel| {
            let masses = &view.state[..view.layout.solids()];
            kernel.fastest(view.signal(0), view.layout.inner(), masses)
        });
        let streams = [view.inlet(FEED), view.inlet(GAS)];
        let births = self.sizes.births(view.layout, streams, &turnover);
        let sizes = self
            .sizes
            .fastest(view.layout, view.state, &turnover, &births);
        kernel + turnover.product / mass + sizes
    }

    fn invariants(&self) -> usize {
        usize::from(self.level == BedLevel::Fixed && self.sizes.scheme != GrowthScheme::Dyssol)
    }

    fn verify(&self, view: &UnitView<'_>) -> Result<(), PlantError> {
        let layout = view.layout;
        let masses = layout.by_size(view.state);
        let all: f64 = masses.iter().sum();
        let last = masses[masses.len() - 1] / all;
        let gels = self.sizes.processes.iter().find_map(|p| p.gels());
        if let Some(degree) = gels.filter(|_| last > GELLED) {
            return Err(PlantError::Gels {
                place: format!("granulator \"{}\"", view.name),
                time: view.time,
                share: last,
                degree,
            });
        }
        if last > OUTSIDE.sqrt() || !last.is_finite() {
            return Err(PlantError::GrownBeyond {
                place: format!("granulator \"{}\"", view.name),
                time: view.time,
                share: last,
                to: layout.grid().range().1,
            });
        }
        Ok(())
    }
}
