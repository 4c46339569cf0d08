//! Thin particles of a prescribed temperature: a boundary condition of the gas, and of the particles they touch and see.

use calcine_physics::points::linear;
use calcine_physics::solid::HeatCapacity;

use crate::column::{Ragged, StateColumn};
use crate::error::ModelError;
use crate::model::{
    At, Bodies, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    Surroundings, Tally, Transfer,
};
use crate::thin::Thin;

/// Particles of uniform temperature that is given over process time, whatever they take or give: at the end of a window
/// they have that of its end, and within it they exchange heat at that temperature, as walls of a prescribed temperature
/// do. What they do not get from gas, contacts and radiation, something outside gives them:
///
/// E = m (h(T) − h(T_before)) − (Q_gas + Q_network) Δτ, in J per window.
#[derive(Debug)]
pub struct PrescribedTemperature {
    thin: Thin,
    /// Times in s with temperatures in K.
    points: Vec<(f64, f64)>,
    /// Temperature at the end of the window of the attempt in K.
    target: f64,
    /// E of each particle in the last attempt, in J.
    supplied: Vec<f64>,
}

impl PrescribedTemperature {
    /// No particles yet, of a material with this heat capacity, and of temperatures in K at process times in s, linear
    /// between them and constant outside.
    pub fn new(law: HeatCapacity, points: Vec<(f64, f64)>) -> Self {
        Self {
            thin: Thin::new(law),
            target: f64::NAN,
            supplied: Vec::new(),
            points,
        }
    }

    fn set_target(&mut self, around: &Surroundings<'_>) {
        self.target = linear(&self.points, around.end);
    }

    fn begin(&mut self) {
        let rows = self.thin.bodies(At::Commit).temperature.len();
        self.supplied.clear();
        self.supplied.resize(rows, 0.0);
    }
}

impl ParticleModel for PrescribedTemperature {
    fn columns(&self) -> &[StateColumn] {
        self.thin.columns()
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        self.thin.read(column, out);
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        self.thin.load(from)?;
        self.begin();
        Ok(())
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        self.thin.bodies(at)
    }

    fn temperature_range(&self) -> (f64, f64) {
        self.thin.temperature_range()
    }

    /// A surface whose temperature no heat moves.
    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        _span: f64,
        _at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        self.set_target(around);
        out.fill(SurfaceLine::prescribed(self.target));
        Ok(())
    }

    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        _span: f64,
        _network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        self.set_target(around);
        out.conductance.copy_from_slice(around.conductance);
        out.temperature.fill(self.target);
        out.released.fill(self.target);
        Ok(())
    }

    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        self.thin.set_attempt(self.target);
        for (p, supplied) in self.supplied.iter_mut().enumerate() {
            let stored = self.thin.changed(&[p]).energy.sum;
            *supplied = stored - (took.heat[p] + took.network[p]) * span;
        }
        Ok(())
    }

    fn changed(&self, rows: &[usize]) -> Inventory {
        self.thin.changed(rows)
    }

    fn prescribes(&self) -> bool {
        true
    }

    fn supplied(&self, rows: &[usize]) -> Tally {
        let mut energy = Tally::default();
        rows.iter().for_each(|&p| energy.add(self.supplied[p]));
        energy
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        self.thin.held(rows)
    }

    fn commit(&mut self) -> Vec<usize> {
        self.thin.commit()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        self.thin.change(gone, new)?;
        self.begin();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{
        HeatLaws, HeatNetwork, NeighbourPair, Neighbours, NetworkBodies, NetworkSurroundings, plain,
    };
    use crate::thin::TEMPERATURE;
    use calcine_physics::conduction::{BatchelorObrien, ContactArea, NoGap};
    use calcine_physics::film::{FilmTemperature, FilmTheory, StefanFlow};

    fn particles(masses: &[f64], points: &[(f64, f64)]) -> PrescribedTemperature {
        let law = HeatCapacity::table(vec![(300.0, 500.0), (600.0, 800.0)]);
        let mut made = PrescribedTemperature::new(law, points.to_vec());
        for (id, mass) in (1..).zip(masses) {
            let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[300.0])];
            let one = Newcomer {
                id,
                mass: *mass,
                radius: 1e-3,
                state: &state,
            };
            made.change(&[], &[one]).unwrap();
        }
        made
    }

    fn around<'a>(kelvin: &'a [f64], conductance: &'a [f64], end: f64) -> Surroundings<'a> {
        Surroundings {
            temperature: kelvin,
            pressure: &[],
            composition: &[],
            conductance,
            film: &[],
            theory: FilmTheory {
                temperature: FilmTemperature::Gas,
                stefan_flow: StefanFlow::None,
            },
            radius: &[],
            end,
        }
    }

    #[test]
    fn the_gas_exchanges_with_the_temperature_of_the_end_of_the_window_and_the_rest_is_supplied() {
        let mut held = particles(&[2.0], &[(0.0, 300.0), (10.0, 500.0)]);
        let (span, mut lines) = (5.0, GasLines::default());
        for (end, before, after) in [(5.0, 300.0, 400.0), (10.0, 400.0, 500.0)] {
            lines.reset(1, 0);
            let gas = around(&[900.0], &[0.25], end);
            held.respond(&gas, span, &[NetworkHeat::default()], &mut lines)
                .unwrap();
            assert_eq!((lines.conductance[0], lines.temperature[0]), (0.25, after));
            let (heat, network) = (0.25 * (900.0 - after), -3.0);
            let took = Transfer {
                heat: &[heat],
                network: &[network],
                carried: &[],
                rates: &[],
            };
            held.settle(&took, span).unwrap();
            // c = 500 + (T − 300) J/kg/K.
            let stored = 2.0 * (500.0 + 0.5 * (before + after) - 300.0) * (after - before);
            let changed = held.changed(&[0]).energy.sum;
            assert!((changed / stored - 1.0).abs() < 1e-12, "{changed} {stored}");
            let supplied = held.supplied(&[0]).sum;
            let expected = stored - (heat + network) * span;
            assert!((supplied - expected).abs() < 1e-9, "{supplied} {expected}");
            assert_eq!(held.bodies(At::Attempt).temperature, [after]);
            held.commit();
            assert_eq!(held.bodies(At::Commit).temperature, [after]);
        }
    }

    #[test]
    fn what_touches_a_particle_of_a_prescribed_temperature_takes_its_heat_from_outside() {
        // One at 450 K beside a thin one of 2 W/K of heat stored per span.
        let mut held = particles(&[1.0], &[(0.0, 450.0)]);
        let laws = HeatLaws {
            conduction: Box::new(BatchelorObrien),
            area: ContactArea::Overlap,
            gap: Box::new(NoGap),
            radiates: false,
            inside: false,
        };
        let mut network = HeatNetwork::new(laws, vec![plain(100.0)], Vec::new());
        network.change(&[], &[(1e-3, 0), (1e-3, 0)]);
        let pairs = [NeighbourPair {
            particles: [0, 1],
            radius: [1e-3; 2],
            overlap: 1e-5,
        }];
        network.set_neighbours(&Neighbours {
            pairs: &pairs,
            walls: &[],
            views: None,
        });
        let beside = NetworkSurroundings {
            gas_conductivity: &[0.0; 2],
            reservoirs: &[],
            bodies: NetworkBodies::NONE,
        };
        let gas = around(&[300.0], &[0.0], 1.0);
        let solved = network.solve(&[300.0, 300.0], &beside, |_, lines| {
            held.surface(&gas, 1.0, &[300.0], &mut lines[..1])?;
            lines[1] = SurfaceLine::of_one_temperature(2.0, 300.0, 0.0, 300.0);
            Ok::<(), ModelError>(())
        });
        assert_eq!(solved.unwrap(), crate::NetworkOutcome::Settled);
        // 2 k a of the contact, a = √(R/2 · δ), and 2 T' = G (450 − T) from 300 K on.
        let conductance = 2.0 * 100.0 * (0.5e-3_f64 * 1e-5).sqrt();
        let other = 450.0 - 150.0 * (-conductance / 2.0).exp();
        let flow = 2.0 * (other - 300.0);
        assert!((network.heat[1] / flow - 1.0).abs() < 1e-10);
        assert_eq!(network.heat[0], -network.heat[1]);
    }
}
