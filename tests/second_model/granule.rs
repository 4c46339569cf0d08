//! A wet granule: a core and a wet skin, each of one temperature, and water that leaves by two channels, from the
//! surface and bound. A model of particles that nothing but this test knows.

use calcine_coupler::interior::{
    At, Bodies, Channel, ColumnKind, ColumnRole, GasLines, Inventory, ModelError, NetworkHeat,
    Newcomer, ParticleModel, Ragged, StateColumn, SurfaceLine, Surroundings, TEMPERATURE, Tally,
    Transfer, without,
};
use calcine_coupler::physics::thermo::{Element, Mixture, Species};

/// Specific heats of dry solid and of water in J/kg/K, and a heat of evaporation at 298.15 K in J/kg, low so that
/// granules dry within a test.
const DRY_HEAT: f64 = 900.0;
const WATER_HEAT: f64 = 4180.0;
const LATENT: f64 = 5e4;
/// Conductance between core and skin in W/K.
const INSIDE: f64 = 0.02;
/// Shares of a fresh granule: water at the surface, bound water.
const SURFACE: f64 = 0.02;
const BOUND: f64 = 0.9;
/// Rates over the mass fraction in kg/s: of the surface by the mass fraction below that of saturation, of the rest.
const FAST: f64 = 4e-6;
const SLOW: f64 = 3e-5;
const SATURATED: f64 = 0.6;
/// Share of the fresh mass below which a granule is used up.
const LEAST: f64 = 0.12;
const REFERENCE: f64 = 298.15;

/// State of one granule.
#[derive(Clone, Debug, Default, PartialEq)]
struct State {
    /// Core and skin in K; one temperature once the skin is dry.
    layers: Vec<f64>,
    /// Water at the surface and bound in kg.
    water: [f64; 2],
    /// Dry solid in kg, and the mass with which it came.
    dry: f64,
    fresh: f64,
    /// Windows in which it has been.
    age: u64,
}

impl State {
    fn mass(&self) -> f64 {
        self.dry + self.water[0] + self.water[1]
    }

    /// Heat capacities of core and skin in J/K. The core has the bound water.
    fn capacities(&self) -> [f64; 2] {
        [
            0.8 * self.dry * DRY_HEAT + self.water[1] * WATER_HEAT,
            0.2 * self.dry * DRY_HEAT + self.water[0] * WATER_HEAT,
        ]
    }

    fn core(&self) -> f64 {
        self.layers[0]
    }

    fn skin(&self) -> f64 {
        self.layers[self.layers.len() - 1]
    }

    /// Energy in J, counted as the gas counts water: from the elements on, with the liquid's heat of evaporation off.
    fn energy(&self, formation: f64) -> f64 {
        let [core, skin] = self.capacities();
        let warm = core * (self.core() - REFERENCE) + skin * (self.skin() - REFERENCE);
        warm + (self.water[0] + self.water[1]) * (formation - LATENT)
    }
}

/// Wet granules.
#[derive(Debug)]
pub struct Granules {
    columns: Vec<StateColumn>,
    channels: Vec<Channel>,
    gas: Mixture,
    shrinks: bool,
    committed: Vec<State>,
    now: Vec<State>,
    bodies: [[Vec<f64>; 3]; 2],
    /// Heat in W that evaporation took in the last attempt.
    cooled: Vec<f64>,
}

impl Granules {
    /// Of a gas whose first species is water vapour.
    pub fn new(gas: Mixture, shrinks: bool) -> Self {
        let species = gas.names().len();
        let channel = |name: &str| {
            let mut mass = vec![0.0; species];
            mass[0] = 1.0;
            Channel {
                name: name.to_owned(),
                key: Some(0),
                mass,
            }
        };
        let private = |name: &str| {
            StateColumn::shown(name, "kg", "of a granule").with_role(ColumnRole::Private)
        };
        Self {
            columns: vec![
                StateColumn::shown("layer_temperature", "K", "core and skin").ragged(),
                StateColumn::shown("surface_water", "kg", "water at the surface"),
                private("bound_water"),
                private("dry_mass"),
                private("fresh_mass"),
                StateColumn::shown("age", "1", "windows so far")
                    .with_role(ColumnRole::Private)
                    .counts(),
            ],
            channels: vec![channel("surface water"), channel("bound water")],
            gas,
            shrinks,
            committed: Vec::new(),
            now: Vec::new(),
            bodies: Default::default(),
            cooled: Vec::new(),
        }
    }

    fn formation(&self) -> f64 {
        self.gas.species()[0].formation_enthalpy()
    }

    fn measure(&mut self) {
        for (states, of) in [&self.committed, &self.now]
            .into_iter()
            .zip(&mut self.bodies)
        {
            *of = Default::default();
            for state in states {
                of[0].push(state.skin());
                of[1].push(state.mass());
                // Of 1500 kg/m³ at any time.
                if self.shrinks {
                    let volume = state.mass() / 1500.0;
                    of[2].push((0.75 * volume / std::f64::consts::PI).cbrt());
                }
            }
        }
    }

    fn begin(&mut self) {
        self.now.clone_from(&self.committed);
        self.cooled = vec![0.0; self.committed.len()];
        self.measure();
    }

    /// Line of the skin without the network: what it takes of one kelvin, and its drive in W.
    fn skin(&self, p: usize, gas: [f64; 2], span: f64) -> (f64, f64) {
        let state = &self.committed[p];
        let [core, skin] = state.capacities().map(|capacity| capacity / span);
        let through = INSIDE * core / (core + INSIDE);
        let drive = skin * state.skin() + through * state.core() - self.cooled[p];
        (skin + through + gas[0], drive + gas[0] * gas[1])
    }
}

fn add_water(all: &mut Inventory, species: &Species, mass: f64) {
    for ((sum, atoms), element) in all
        .elements
        .iter_mut()
        .zip(species.atoms())
        .zip(Element::ALL)
    {
        if *atoms > 0.0 {
            sum.add(mass * atoms * element.molar_mass() / species.molar_mass());
        }
    }
}

impl ParticleModel for Granules {
    fn columns(&self) -> &[StateColumn] {
        &self.columns
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        out.reset(self.columns[column].kind);
        for state in &self.committed {
            match column {
                0 => out.push_reals(&state.layers),
                1 | 2 => out.push_reals(&[state.water[column - 1]]),
                3 => out.push_reals(&[state.dry]),
                4 => out.push_reals(&[state.fresh]),
                _ => out.push_counts(&[state.age]),
            }
        }
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        let rows = self.committed.len();
        assert!(from[0].rows() == rows && from[5].kind() == ColumnKind::Count);
        let scalars = |column: usize| from[column].to_scalars(&self.columns[column].name, rows);
        for p in 0..rows {
            self.committed[p] = State {
                layers: from[0].reals(p).to_vec(),
                water: [scalars(1)?[p], scalars(2)?[p]],
                dry: scalars(3)?[p],
                fresh: scalars(4)?[p],
                age: from[5].counts(p)[0],
            };
        }
        self.begin();
        Ok(())
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        let of = &self.bodies[usize::from(at == At::Attempt)];
        Bodies {
            temperature: &of[0],
            mass: &of[1],
            radius: &of[2],
        }
    }

    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn elements(&self) -> Vec<Element> {
        vec![Element::H, Element::O]
    }

    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        _at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        for (p, line) in out.iter_mut().enumerate() {
            let gas = [around.conductance[p], around.temperature[p]];
            let (conductance, drive) = self.skin(p, gas, span);
            *line = SurfaceLine {
                conductance,
                temperature: drive / conductance,
                stored: 0.0,
            };
        }
        Ok(())
    }

    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        for (p, given) in network.iter().enumerate() {
            let ha = around.conductance[p];
            let (own, drive) = self.skin(p, [0.0, 0.0], span);
            out.conductance[p] = ha * own / (own + ha);
            out.temperature[p] = (drive + given.mean) / own;
            out.released[p] = self.committed[p].skin();
            let state = &self.committed[p];
            let wet = f64::from(state.water[0] > 0.0);
            // Bound water leaves where the surface is dry.
            for (c, slope) in [wet * FAST, (1.0 - wet) * SLOW].into_iter().enumerate() {
                out.slope[2 * p + c] = -slope;
                out.offset[2 * p + c] = -slope * SATURATED;
                out.local_slope[2 * p + c] = -slope;
            }
        }
        Ok(())
    }

    fn limit(&mut self, rates: &mut [f64], span: f64) {
        for (state, rates) in self.committed.iter().zip(rates.chunks_exact_mut(2)) {
            for (rate, held) in rates.iter_mut().zip(state.water) {
                *rate = rate.min(held / span);
            }
        }
    }

    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        let formation = self.formation();
        for p in 0..self.committed.len() {
            let before = &self.committed[p];
            let rates = &took.rates[2 * p..2 * p + 2];
            let gone = (rates[0] + rates[1]) * span;
            let mut now = before.clone();
            for (held, rate) in now.water.iter_mut().zip(rates) {
                *held = (*held - rate * span).max(0.0);
            }
            let gained = (took.heat[p] + took.network[p] + took.carried[p]) * span;
            let energy = before.energy(formation) + gained - gone * formation;
            // What is above the reference: both layers share it by an implicit step between them.
            let water = now.water[0] + now.water[1];
            let warm = energy - water * (formation - LATENT);
            let [core, skin] = now.capacities();
            now.age += 1;
            if now.water[0] == 0.0 {
                now.layers = vec![REFERENCE + warm / (core + skin)];
            } else {
                let pull = span * INSIDE;
                let start = core * (before.core() - REFERENCE);
                let total = warm;
                // core·c + skin·s = total and core·c − start = pull (s − c), for c and s above the reference.
                let c = (start + pull * total / skin) / (core + pull + pull * core / skin);
                now.layers = vec![REFERENCE + c, REFERENCE + (total - core * c) / skin];
            }
            self.cooled[p] = (rates[0] + rates[1]) * LATENT;
            self.now[p] = now;
        }
        self.measure();
        Ok(())
    }

    fn changed(&self, rows: &[usize]) -> Inventory {
        let (mut all, formation) = (Inventory::default(), self.formation());
        for (now, before) in rows
            .iter()
            .map(|&row| (&self.now[row], &self.committed[row]))
        {
            let water: f64 = (0..2).map(|k| now.water[k] - before.water[k]).sum();
            all.mass.add(water);
            add_water(&mut all, &self.gas.species()[0], water);
            let sum = now.energy(formation) - before.energy(formation);
            all.energy += Tally {
                sum,
                magnitude: (sum - water * formation).abs() + (water * LATENT).abs(),
            };
        }
        all
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        let mut all = Inventory::default();
        for state in rows.iter().map(|&row| &self.committed[row]) {
            all.mass.add(state.mass());
            add_water(&mut all, &self.gas.species()[0], state.water.iter().sum());
            all.energy.add(state.energy(self.formation()));
        }
        all
    }

    fn commit(&mut self) -> Vec<usize> {
        self.committed.clone_from(&self.now);
        self.begin();
        let spent = |state: &State| state.mass() < LEAST * state.fresh;
        let rows = self.committed.iter().enumerate();
        rows.filter(|(_, state)| spent(state))
            .map(|(p, _)| p)
            .collect()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        without(&mut self.committed, gone);
        for one in new {
            one.only(&[TEMPERATURE])?;
            let kelvin = one.scalar(TEMPERATURE)?;
            self.committed.push(State {
                layers: vec![kelvin; 2],
                water: [SURFACE * one.mass, BOUND * one.mass],
                dry: (1.0 - SURFACE - BOUND) * one.mass,
                fresh: one.mass,
                age: 0,
            });
        }
        self.begin();
        Ok(())
    }
}
