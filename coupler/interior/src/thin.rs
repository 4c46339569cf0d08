//! Thermally thin particles: one temperature each.

use calcine_physics::solid::HeatCapacity;

use crate::column::{ColumnRole, Ragged, StateColumn};
use crate::error::ModelError;
use crate::model::{
    At, Bodies, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    Surroundings, Tally, Transfer,
};
use crate::without;

/// Name of the column of temperatures, which newcomers of every model bring.
pub const TEMPERATURE: &str = "temperature";

/// Particles of uniform temperature: m dh(T)/dτ = Q, h the enthalpy of the material. Good for Biot
/// numbers below about 0.1.
#[derive(Debug)]
pub struct Thin {
    law: HeatCapacity,
    columns: [StateColumn; 2],
    /// Mass of each particle in kg.
    mass: Vec<f64>,
    /// m c at the committed temperatures in J/K.
    heat_capacity: Vec<f64>,
    committed: Vec<f64>,
    temperature: Vec<f64>,
}

impl Thin {
    /// No particles yet, of a material with this law.
    pub fn new(law: HeatCapacity) -> Self {
        let mass = StateColumn::shown("mass", "kg", "mass of the particle");
        Self {
            law,
            columns: [
                StateColumn::shown(TEMPERATURE, "K", "temperature of the particle"),
                mass.with_role(ColumnRole::Private),
            ],
            mass: Vec::new(),
            heat_capacity: Vec::new(),
            committed: Vec::new(),
            temperature: Vec::new(),
        }
    }

    fn begin(&mut self) {
        self.temperature.clone_from(&self.committed);
        self.heat_capacity.clear();
        let pairs = self.mass.iter().zip(&self.committed);
        self.heat_capacity
            .extend(pairs.map(|(mass, kelvin)| mass * self.law.at(*kelvin)));
    }

    /// Mean heat capacity in J/K of a particle between its committed and another temperature in K.
    fn secant(&self, row: usize, kelvin: f64) -> f64 {
        let before = self.committed[row];
        let rise = kelvin - before;
        if self.law.is_constant() || rise.abs() < SECANT * kelvin {
            self.heat_capacity[row]
        } else {
            self.mass[row] * (self.law.enthalpy(kelvin) - self.law.enthalpy(before)) / rise
        }
    }

    /// The temperature in K to which a particle comes from the last commit with an energy in J.
    fn moved(&self, row: usize, energy: f64) -> f64 {
        let start = self.committed[row];
        if self.law.is_constant() {
            start + energy / self.heat_capacity[row]
        } else {
            self.law
                .temperature(self.law.enthalpy(start) + energy / self.mass[row])
        }
    }

    /// Gives all particles a temperature in K, as an attempt does.
    pub(crate) fn set_attempt(&mut self, kelvin: f64) {
        self.temperature.fill(kelvin);
    }
}

impl ParticleModel for Thin {
    fn columns(&self) -> &[StateColumn] {
        &self.columns
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        let values = if column == 0 {
            &self.committed
        } else {
            &self.mass
        };
        *out = Ragged::scalars(values.clone());
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        let rows = self.mass.len();
        for ((column, values), to) in self
            .columns
            .iter()
            .zip(from)
            .zip([&mut self.committed, &mut self.mass])
        {
            to.copy_from_slice(values.to_scalars(&column.name, rows)?);
        }
        self.begin();
        Ok(())
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        Bodies {
            temperature: match at {
                At::Commit => &self.committed,
                At::Attempt => &self.temperature,
            },
            mass: &[],
            radius: &[],
        }
    }

    fn temperature_range(&self) -> (f64, f64) {
        self.law.range()
    }

    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        for (p, line) in out.iter_mut().enumerate() {
            let stored = self.secant(p, at[p]) / span;
            let (gas, beside) = (around.conductance[p], around.temperature[p]);
            *line = SurfaceLine::of_one_temperature(stored, self.committed[p], gas, beside);
        }
        Ok(())
    }

    /// K = h A/(1 + h A Δτ/(m c)) (docs/theory.md, TSM-9), from the committed temperature moved by the network's heat.
    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        for (p, &ha) in around.conductance.iter().enumerate() {
            out.conductance[p] = ha / (1.0 + ha * span / self.heat_capacity[p]);
            let given = network[p].mean;
            out.temperature[p] = if given == 0.0 {
                self.committed[p]
            } else {
                self.moved(p, given * span)
            };
            out.released[p] = self.committed[p];
        }
        Ok(())
    }

    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        for p in 0..self.mass.len() {
            self.temperature[p] = self.moved(p, (took.heat[p] + took.network[p]) * span);
        }
        Ok(())
    }

    fn changed(&self, rows: &[usize]) -> Inventory {
        let mut energy = Tally::default();
        for &p in rows {
            let (now, before) = (&self.temperature[p], &self.committed[p]);
            energy.add(if self.law.is_constant() {
                self.heat_capacity[p] * (now - before)
            } else {
                self.mass[p] * (self.law.enthalpy(*now) - self.law.enthalpy(*before))
            });
        }
        Inventory {
            energy,
            ..Inventory::default()
        }
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        let mut all = Inventory::default();
        for &row in rows {
            all.mass.add(self.mass[row]);
            all.energy
                .add(self.mass[row] * self.law.enthalpy(self.committed[row]));
        }
        all
    }

    fn commit(&mut self) -> Vec<usize> {
        self.committed.copy_from_slice(&self.temperature);
        self.begin();
        Vec::new()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        without(&mut self.mass, gone);
        without(&mut self.committed, gone);
        for one in new {
            one.only(&[TEMPERATURE])?;
            self.committed.push(one.scalar(TEMPERATURE)?);
            self.mass.push(one.mass);
        }
        self.begin();
        Ok(())
    }
}

/// Below this share of the temperature a rise gives no secant of the enthalpy, and c_p stands for it.
pub(crate) const SECANT: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::NetworkOutcome;
    use crate::network::{
        HeatLaws, HeatNetwork, NeighbourPair, Neighbours, NetworkBodies, NetworkSurroundings, plain,
    };
    use calcine_physics::conduction::BatchelorObrien;
    use calcine_physics::film::{FilmTemperature, FilmTheory, StefanFlow};

    /// What the last attempt changed in all particles.
    fn all_changed(thin: &Thin) -> Inventory {
        let rows: Vec<usize> = (0..thin.mass.len()).collect();
        thin.changed(&rows)
    }

    /// Particles of these masses in kg and temperatures in K, of a material of 1 J/kg/K.
    fn unit(particles: &[(f64, f64)]) -> Thin {
        of(HeatCapacity::constant(1.0), particles)
    }

    fn of(law: HeatCapacity, particles: &[(f64, f64)]) -> Thin {
        let mut thin = Thin::new(law);
        for (id, (mass, kelvin)) in (1..).zip(particles) {
            let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[*kelvin])];
            let one = Newcomer {
                id,
                mass: *mass,
                radius: 1e-3,
                state: &state,
            };
            thin.change(&[], &[one]).unwrap();
        }
        thin
    }

    fn around<'a>(temperature: &'a [f64], conductance: &'a [f64]) -> Surroundings<'a> {
        Surroundings {
            temperature,
            pressure: &[],
            composition: &[],
            conductance,
            film: &[],
            theory: FilmTheory {
                temperature: FilmTemperature::Gas,
                stefan_flow: StefanFlow::None,
            },
            radius: &[],
            end: 0.0,
        }
    }

    fn settle(thin: &mut Thin, heat: &[f64], network: &[f64], span: f64) {
        let took = Transfer {
            heat,
            network,
            carried: &[],
            rates: &[],
        };
        thin.settle(&took, span).unwrap();
    }

    #[test]
    fn the_lines_to_network_and_gas_give_the_implicit_step() {
        let mut thin = unit(&[(2.0, 300.0)]);
        let (around, span, mut lines) = (around(&[400.0], &[0.5]), 8.0, GasLines::default());
        // m c (T − 300) = hA Δτ (400 − T): T = (600 + 1600)/6
        let expected = 2200.0 / 6.0;
        let mut surface = [SurfaceLine::default()];
        thin.surface(&around, span, &[300.0], &mut surface).unwrap();
        assert!((surface[0].temperature - expected).abs() < 1e-12);
        assert!((surface[0].conductance - 0.75).abs() < 1e-15);
        lines.reset(1, 0);
        let alone = [NetworkHeat::default()];
        thin.respond(&around, span, &alone, &mut lines).unwrap();
        settle(
            &mut thin,
            &[lines.conductance[0] * (400.0 - lines.temperature[0])],
            &[0.0],
            span,
        );
        assert!((thin.bodies(At::Attempt).temperature[0] - expected).abs() < 1e-12);
        assert!((all_changed(&thin).energy.sum - 2.0 * (expected - 300.0)).abs() < 1e-10);
        assert_eq!(thin.bodies(At::Commit).temperature, [300.0]);
    }

    #[test]
    fn an_attempt_starts_from_the_last_commit() {
        let mut thin = unit(&[(1.0, 300.0)]);
        settle(&mut thin, &[5.0], &[0.0], 1.0);
        settle(&mut thin, &[3.0], &[4.0], 1.0);
        assert_eq!(thin.bodies(At::Attempt).temperature, [307.0]);
        assert!(thin.commit().is_empty());
        settle(&mut thin, &[1.0], &[0.0], 1.0);
        assert_eq!(thin.bodies(At::Attempt).temperature, [308.0]);
        let mass = || Ragged::scalars(vec![1.0]);
        let kelvin = Ragged::scalars(vec![301.0]);
        thin.load(&[kelvin, mass()]).unwrap();
        for at in [At::Commit, At::Attempt] {
            assert_eq!(thin.bodies(at).temperature, [301.0]);
        }
        let error = thin
            .load(&[Ragged::scalars(vec![1.0; 2]), mass()])
            .unwrap_err();
        assert!(error.to_string().contains("2 values"), "{error}");
    }

    #[test]
    fn a_heat_capacity_that_follows_temperature_stores_exactly_what_came() {
        // c = 500 + (T − 300): from 300 to 400 K takes 550 · 100 J/kg.
        let law = HeatCapacity::table(vec![(300.0, 500.0), (600.0, 800.0)]);
        let mut thin = of(law, &[(2.0, 300.0)]);
        let mut surface = [SurfaceLine::default()];
        let still = around(&[0.0], &[0.0]);
        thin.surface(&still, 10.0, &[400.0], &mut surface).unwrap();
        assert!(
            (surface[0].conductance - 2.0 * 550.0 / 10.0).abs() < 1e-9,
            "secant"
        );
        settle(&mut thin, &[1100.0], &[0.0], 100.0);
        assert!((thin.bodies(At::Attempt).temperature[0] - 400.0).abs() < 1e-10);
        assert!((all_changed(&thin).energy.sum - 110_000.0).abs() < 1e-6);
        thin.commit();
        let mut lines = GasLines::default();
        lines.reset(1, 0);
        let stiff = around(&[0.0], &[1e12]);
        let alone = [NetworkHeat::default()];
        thin.respond(&stiff, 1.0, &alone, &mut lines).unwrap();
        let expected = 2.0 * 600.0;
        assert!(
            (lines.conductance[0] / expected - 1.0).abs() < 1e-8,
            "m c at 400 K"
        );
    }

    #[test]
    fn touching_particles_in_still_gas_relax_to_their_common_temperature() {
        let laws = HeatLaws::contacts(Box::new(BatchelorObrien));
        let mut network = HeatNetwork::new(laws, vec![plain(50.0)], Vec::new());
        network.change(&[], &[(1e-3, 0), (1e-3, 0)]);
        let mut thin = unit(&[(1.0, 300.0), (3.0, 400.0)]);
        network.set_neighbours(&Neighbours {
            pairs: &[NeighbourPair {
                particles: [0, 1],
                radius: [5e-3; 2],
                overlap: 1e-6,
            }],
            walls: &[],
            views: None,
        });
        let beside = NetworkSurroundings {
            gas_conductivity: &[0.026; 2],
            reservoirs: &[],
            bodies: NetworkBodies::NONE,
        };
        // exp(−G t (1/C₁ + 1/C₂)), G = 5e-3: 1000 implicit steps of 0.1 s are within 1e-3 of it.
        for _ in 0..1000 {
            let still = around(&[0.0; 2], &[0.0; 2]);
            let start = thin.bodies(At::Commit).temperature.to_vec();
            let solved = network.solve(&start, &beside, |at, lines| {
                thin.surface(&still, 0.1, at, lines)
            });
            assert_eq!(solved.unwrap(), NetworkOutcome::Settled);
            settle(&mut thin, &[0.0; 2], &network.heat, 0.1);
            assert!(all_changed(&thin).energy.sum.abs() < 1e-12);
            thin.commit();
        }
        let kelvin = thin.bodies(At::Commit).temperature;
        let left = (kelvin[1] - kelvin[0]) / 100.0;
        let exact = (-5e-3_f64 * 100.0 * (1.0 + 1.0 / 3.0)).exp();
        assert!((left / exact - 1.0).abs() < 1e-3, "{left} {exact}");
    }
}
