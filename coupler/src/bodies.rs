//! Bodies of one temperature each that store heat, such as crucibles and baskets (docs/theory.md, BOD-1).
//!
//! A body of mass m and enthalpy h(T) exchanges heat with the gas at the patches that are its surface, with particles that touch or
//! see walls of it, and by radiation with surroundings of temperature T_s:
//!
//! m [h(T') − h(T)] = Δτ [Q_gas + Q_walls + e σ A (T_s⁴ − T'⁴)],   Q_gas = Σ_f K_f (T_c − T'),
//!
//! with T_c of the cell at a face f and K_f = A_f/(1/α + d_f/(ε λ)): the film of the wall, where one is stated, and half a cell of
//! gas in series, as at a wall of a stated temperature. The gas is told K_f and T', so that no gas solver knows of bodies. In an
//! attempt T' is that of the gas of the last one, and of the particles that go with it: bodies are nodes of the network of heat
//! between particles. Whatever the attempts leave, the body takes exactly the heat that the gas and the network gave it.

use calcine_interior::SurfaceLine;
use calcine_numerics::Anderson;
use calcine_physics::gas_model::GasModel;
use calcine_physics::radiation::STEFAN_BOLTZMANN;
use calcine_physics::solid::HeatCapacity;

use crate::checkpoint::{StateFile, StateFileError};
use crate::mesh::Mesh;
use crate::part::{Bed, CellExchange, GasFields};
use crate::setup::Schedule;

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatBody {
    /// Its name.
    pub name: String,
    /// Its mass in kg.
    pub mass: f64,
    /// Its specific heat capacity.
    pub heat_capacity: HeatCapacity,
    /// Its temperature in K at the start.
    pub temperature: f64,
    /// Patches of the mesh that are its surface.
    pub patches: Vec<BodyPatch>,
    /// Radiation to surroundings; `None`: none.
    pub radiation: Option<BodyRadiation>,
}

impl HeatBody {
    /// Area in m² of its surface to the gas, and the conductance in W/K to gas of a conductivity in W/m/K in the cells beside it, no
    /// particle being there.
    pub fn surface(&self, mesh: &Mesh, conductivity: f64) -> [f64; 2] {
        let faces = faces_of(self, mesh);
        let area = faces.iter().map(|face| face.area).sum();
        let each = faces.iter().map(|face| face.conductance(conductivity));
        [area, each.sum()]
    }
}

/// A patch that is the surface of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPatch {
    /// Its name.
    pub name: String,
    /// Coefficient in W/m²/K of a film between surface and gas; `None`: gas conducts up to the surface.
    pub film: Option<f64>,
}

/// Radiation of a body to surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyRadiation {
    /// Area in m².
    pub area: f64,
    /// Emissivity of the exchange.
    pub emissivity: f64,
    /// Temperature in K of the surroundings over process time in s.
    pub surroundings: Schedule,
}

/// A face between a body and a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BodyFace {
    cell: usize,
    /// Area in m².
    area: f64,
    /// Distance in m of the cell's centre from the plane of the face.
    distance: f64,
    film: Option<f64>,
}

impl BodyFace {
    /// K_f in W/K: the film and half a cell of gas of a conductivity in W/m/K in series.
    fn conductance(&self, conductivity: f64) -> f64 {
        self.area / (self.distance / conductivity + self.film.map_or(0.0, f64::recip))
    }
}

/// The heat that bodies took in an attempt, for the ledger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyBalance {
    /// Change of what they hold in J.
    pub stored: f64,
    /// Sum of its magnitudes.
    pub stored_magnitude: f64,
    /// Heat in J from surroundings.
    pub radiated: f64,
    /// Sum of its magnitudes.
    pub radiated_magnitude: f64,
    /// Heat in J from the gas.
    pub from_gas: f64,
    /// Sum of its magnitudes.
    pub from_gas_magnitude: f64,
    /// Heat in J from particles at walls of bodies.
    pub from_walls: f64,
    /// Sum of its magnitudes.
    pub from_walls_magnitude: f64,
}

/// All bodies of a run.
#[derive(Debug, Default)]
pub struct HeatBodies {
    bodies: Vec<HeatBody>,
    faces: Vec<Vec<BodyFace>>,
    /// Conductance in W/K of each face over the window.
    conductance: Vec<Vec<f64>>,
    /// Temperatures in K at the last commit.
    committed: Vec<f64>,
    /// Temperatures that the attempt is told, and those that came of it.
    told: Vec<f64>,
    made: Vec<f64>,
    /// Σ K_f in W/K and Σ K_f T_c in W of the gas that was seen last.
    gives: Vec<f64>,
    warms: Vec<f64>,
    /// Heat in W from particles in the attempt.
    from_walls: Vec<f64>,
    acceleration: Anderson,
    balance: BodyBalance,
}

/// Difference of temperatures in K whose heat is none at all for the convergence of attempts.
const FAINT: f64 = 1e-3;
/// Share of what a body holds that round-off may give and take in a window.
const ROUND_OFF: f64 = 1e-12;
/// Newton's method for a body's balance: its error is of the second order, and the balance nearly linear.
const NEWTON_STEPS: usize = 50;

impl HeatBodies {
    /// Bodies at their temperatures of the start, on a mesh that has their patches.
    pub fn new(bodies: Vec<HeatBody>, mesh: &Mesh) -> Self {
        let temperature: Vec<f64> = bodies.iter().map(|body| body.temperature).collect();
        let faces: Vec<_> = bodies.iter().map(|body| faces_of(body, mesh)).collect();
        let count = bodies.len();
        Self {
            conductance: faces.iter().map(|own| vec![0.0; own.len()]).collect(),
            committed: temperature.clone(),
            told: temperature.clone(),
            made: temperature,
            gives: vec![0.0; count],
            warms: vec![0.0; count],
            from_walls: vec![0.0; count],
            acceleration: Anderson::default(),
            balance: BodyBalance::default(),
            faces,
            bodies,
        }
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Names of the bodies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    /// Temperatures in K of the last commit.
    pub fn temperature(&self) -> &[f64] {
        &self.committed
    }

    /// Temperatures in K that the attempt is told.
    pub fn told(&self) -> &[f64] {
        &self.told
    }

    /// Begins the attempts of a window: what conducts at the surfaces, by the gas as it is.
    pub fn begin(&mut self, gas: &GasFields<'_>, model: &GasModel, bed: &Bed) {
        self.acceleration.clear();
        let cells = gas.temperature.len().max(1);
        let species = gas.composition.len() / cells;
        for (faces, conductance) in self.faces.iter().zip(&mut self.conductance) {
            for (face, own) in faces.iter().zip(conductance) {
                let cell = face.cell;
                let composition = &gas.composition[cell * species..(cell + 1) * species];
                let conductivity = model.conductivity(gas.temperature[cell], composition);
                *own = face.conductance(bed.void_fraction[cell] * conductivity);
            }
        }
    }

    /// Adds to what the gas is told the heat from bodies of the temperatures of the attempt.
    pub fn tell(&self, cells: &mut CellExchange) {
        let parts = self.faces.iter().zip(&self.conductance).zip(&self.told);
        for ((faces, conductance), kelvin) in parts {
            for (face, own) in faces.iter().zip(conductance) {
                cells.heat_coefficient[face.cell] += own;
                cells.heat_source[face.cell] += own * kelvin;
            }
        }
    }

    /// Sees the gas about which the next attempt is, by the temperatures in K of its cells.
    pub fn look(&mut self, cell_temperature: &[f64]) {
        for (k, faces) in self.faces.iter().enumerate() {
            let pairs = || faces.iter().zip(&self.conductance[k]);
            self.gives[k] = pairs().map(|(_, own)| own).sum();
            self.warms[k] = pairs()
                .map(|(face, own)| own * cell_temperature[face.cell])
                .sum();
        }
    }

    /// What a body takes from particles over its temperature, about one in K, over a span in s that ends at a process time in
    /// s: Q = k (T − T_free), with the gas as it was seen.
    pub fn line(&self, body: usize, kelvin: f64, [span, end]: [f64; 2]) -> SurfaceLine {
        let own = &self.bodies[body];
        let heat = self.warms[body] - self.gives[body] * kelvin + own.radiated(kelvin, end);
        let stored = own.mass * own.difference(self.committed[body], kelvin) / span;
        let conductance = own.mass * own.heat_capacity.at(kelvin) / span
            + self.gives[body]
            + own.radiates_more(kelvin);
        SurfaceLine {
            conductance,
            temperature: kelvin + (heat - stored) / conductance,
            stored: 0.0,
        }
    }

    /// The temperatures of the next attempt in K as the network has them; without one, those beside the gas alone, over a span in
    /// s that ends at a process time in s.
    pub fn take(&mut self, network: Option<&[f64]>, [span, end]: [f64; 2]) {
        match network {
            Some(kelvin) => self.made.copy_from_slice(kelvin),
            None => {
                for (k, body) in self.bodies.iter().enumerate() {
                    let (told, gives) = (self.told[k], self.gives[k]);
                    let given = self.warms[k] - gives * told;
                    self.made[k] = body.end(self.committed[k], [given, gives], told, [span, end]);
                }
            }
        }
        self.told.copy_from_slice(&self.made);
    }

    /// The same, accelerated by the attempts of the window so far, where nothing else accelerates them; from the temperatures in
    /// K of the last attempt.
    pub fn accelerate(&mut self, before: &[f64]) {
        let mut next = self.made.clone();
        self.acceleration.accelerate(before, &mut next);
        for (told, kelvin) in self.told.iter_mut().zip(next) {
            // Where it is extrapolated beyond any temperature, what the attempt made stays.
            if kelvin.is_finite() && kelvin > 0.0 {
                *told = kelvin;
            }
        }
    }

    /// Takes the heat from the gas, whose cells gave that of these temperatures in K, over a span in s that ends at a
    /// process time in s, beside the heat in W from walls into particles, each wall with its body. The result is what the
    /// balances at the temperatures of the attempt leave open, as a share of all heat that bodies exchanged.
    pub fn credit(
        &mut self,
        cell_temperature: impl Fn(usize) -> f64,
        walls: impl Iterator<Item = (usize, f64)>,
        [span, end]: [f64; 2],
    ) -> f64 {
        self.from_walls.fill(0.0);
        for (body, heat) in walls {
            self.from_walls[body] -= heat;
        }
        self.balance = BodyBalance::default();
        let (mut apart, mut exchanged) = (0.0, 0.0);
        for (k, own) in self.bodies.iter().enumerate() {
            let (start, kelvin) = (self.committed[k], self.told[k]);
            let (mut from_gas, mut magnitude) = (0.0, 0.0);
            for (face, conductance) in self.faces[k].iter().zip(&self.conductance[k]) {
                let heat = conductance * (cell_temperature(face.cell) - kelvin);
                from_gas += heat;
                magnitude += heat.abs();
            }
            let given = from_gas + self.from_walls[k];
            let settled = own.end(start, [given, 0.0], kelvin, [span, end]);
            let stored = own.mass * own.difference(start, settled);
            let radiated = span * own.radiated(settled, end);
            self.made[k] = settled;
            self.balance.add(&BodyBalance {
                stored,
                stored_magnitude: stored.abs(),
                radiated,
                radiated_magnitude: radiated.abs(),
                from_gas: span * from_gas,
                from_gas_magnitude: span * magnitude,
                from_walls: span * self.from_walls[k],
                from_walls_magnitude: span * self.from_walls[k].abs(),
            });
            let holds = own.mass * own.difference(start, kelvin) / span;
            apart += (given + own.radiated(kelvin, end) - holds).abs();
            exchanged += magnitude + self.from_walls[k].abs() + radiated.abs() / span;
            exchanged += FAINT * self.gives[k];
            exchanged += ROUND_OFF * own.mass * own.difference(0.0, kelvin) / span;
        }
        if exchanged > 0.0 {
            apart / exchanged
        } else {
            0.0
        }
    }

    /// What the last attempt came to.
    pub fn balance(&self) -> &BodyBalance {
        &self.balance
    }

    /// Takes the last attempt as the new start.
    pub fn commit(&mut self) {
        self.committed.copy_from_slice(&self.made);
        self.begin_again();
    }

    /// Gives up the attempts since the last commit.
    pub fn begin_again(&mut self) {
        self.told.copy_from_slice(&self.committed);
        self.made.copy_from_slice(&self.committed);
    }

    /// Records the temperatures of the last commit, each body by its name.
    pub fn record(&self, state: &mut StateFile) {
        for (name, kelvin) in self.names().zip(&self.committed) {
            state.set_f64s(&column(name), &[*kelvin]);
        }
    }

    /// Takes up what [`HeatBodies::record`] wrote; an error where a body is missing.
    pub fn resume(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        for (body, kelvin) in self.bodies.iter().zip(&mut self.committed) {
            *kelvin = state.f64s_of(&column(&body.name), 1)?[0];
        }
        self.begin_again();
        Ok(())
    }

    /// The same from another run: bodies that it did not have begin with their own temperatures.
    pub fn take_over(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        let known: Vec<String> = state.names().map(str::to_owned).collect();
        for (body, kelvin) in self.bodies.iter().zip(&mut self.committed) {
            let name = column(&body.name);
            if known.contains(&name) {
                *kelvin = state.f64s_of(&name, 1)?[0];
            }
        }
        self.begin_again();
        Ok(())
    }
}

impl BodyBalance {
    fn add(&mut self, other: &Self) {
        self.stored += other.stored;
        self.stored_magnitude += other.stored_magnitude;
        self.radiated += other.radiated;
        self.radiated_magnitude += other.radiated_magnitude;
        self.from_gas += other.from_gas;
        self.from_gas_magnitude += other.from_gas_magnitude;
        self.from_walls += other.from_walls;
        self.from_walls_magnitude += other.from_walls_magnitude;
    }

    /// What the balance of the bodies themselves leaves open in J, and the sum of the magnitudes of its terms.
    pub fn open(&self) -> [f64; 2] {
        let sum = self.stored - self.from_gas - self.from_walls - self.radiated;
        let terms = [
            self.stored_magnitude,
            self.from_gas_magnitude,
            self.from_walls_magnitude,
            self.radiated_magnitude,
        ];
        [sum, terms.into_iter().sum()]
    }
}

impl HeatBody {
    /// Difference of enthalpy in J/kg between two temperatures in K.
    fn difference(&self, from: f64, to: f64) -> f64 {
        self.heat_capacity.enthalpy(to) - self.heat_capacity.enthalpy(from)
    }

    /// Heat in W from the surroundings into the body of a temperature in K at a process time in s.
    fn radiated(&self, kelvin: f64, time: f64) -> f64 {
        self.radiation.as_ref().map_or(0.0, |one| {
            let beyond = one.surroundings.at(time);
            one.emissivity * STEFAN_BOLTZMANN * one.area * (beyond.powi(4) - kelvin.powi(4))
        })
    }

    /// By how much in W/K it radiates more above a temperature in K.
    fn radiates_more(&self, kelvin: f64) -> f64 {
        self.radiation.as_ref().map_or(0.0, |one| {
            4.0 * one.emissivity * STEFAN_BOLTZMANN * one.area * kelvin.powi(3)
        })
    }

    /// Temperature in K at the end of a span in s up to a process time in s: the heat Q in W is `given` at `told`, and falls
    /// by `gives` W/K above it.
    fn end(&self, start: f64, [given, gives]: [f64; 2], told: f64, [span, time]: [f64; 2]) -> f64 {
        let mut kelvin = told;
        for _ in 0..NEWTON_STEPS {
            let stored = self.mass * self.difference(start, kelvin) / span;
            let heat = given - gives * (kelvin - told) + self.radiated(kelvin, time);
            let slope = self.mass * self.heat_capacity.at(kelvin) / span
                + gives
                + self.radiates_more(kelvin);
            let step = (heat - stored) / slope;
            // A first step that leads below zero leads half the way there.
            kelvin = if kelvin + step > 0.0 {
                kelvin + step
            } else {
                0.5 * kelvin
            };
            if step.abs() <= f64::EPSILON * kelvin {
                break;
            }
        }
        kelvin
    }
}

/// Name of a body's temperature in a checkpoint.
fn column(name: &str) -> String {
    format!("body_temperature.{name}")
}

/// Faces of a body's patches.
fn faces_of(body: &HeatBody, mesh: &Mesh) -> Vec<BodyFace> {
    let patches = body.patches.iter();
    let faces = patches.filter_map(|one| Some((mesh.patch(&one.name)?, one.film)));
    let each = faces.flat_map(|(patch, film)| patch.faces().map(move |face| (face, film)));
    each.map(|(face, film)| {
        let cell = mesh.owner()[face] as usize;
        let vector = mesh.face_area()[face];
        let area = vector.norm();
        let way = mesh.face_centre()[face] - mesh.cell_centre()[cell];
        BodyFace {
            cell,
            area,
            distance: way.dot(&vector) / area,
            film,
        }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::block::{BoxSpec, box_mesh};
    use calcine_physics::Vec3;

    /// A body of 2 g and 500 J/kg/K at 300 K beside a cell of 10 mm.
    fn body(radiation: Option<BodyRadiation>) -> HeatBodies {
        let mesh = box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::repeat(0.01),
            cells: [1, 1, 1],
            patches: ["side", "side", "side", "side", "cup", "top"].map(String::from),
        })
        .unwrap();
        let one = HeatBody {
            name: "cup".into(),
            mass: 2e-3,
            heat_capacity: HeatCapacity::constant(500.0),
            temperature: 300.0,
            patches: vec![BodyPatch {
                name: "cup".into(),
                film: None,
            }],
            radiation,
        };
        HeatBodies::new(vec![one], &mesh)
    }

    fn begin(bodies: &mut HeatBodies) -> f64 {
        use calcine_physics::gas_model::ConstantGas;
        let gas = GasFields {
            temperature: &[400.0],
            pressure: &[1e5],
            density: &[1.0],
            composition: &[],
            velocity: &[Vec3::zeros()],
            pressure_gradient: &[Vec3::zeros()],
            turbulence: Default::default(),
        };
        let model = GasModel::Constant(ConstantGas {
            density: 1.0,
            heat_capacity: 1000.0,
            viscosity: 2e-5,
            conductivity: 0.03,
        });
        let bed = Bed {
            void_fraction: vec![0.5],
        };
        bodies.begin(&gas, &model, &bed);
        // A_f ε λ/d = 1e-4 · 0.5 · 0.03/5e-3.
        bodies.conductance[0][0]
    }

    #[test]
    fn the_surface_conducts_through_half_a_cell_of_gas_and_a_film_in_series() {
        let mut bodies = body(None);
        let bare = begin(&mut bodies);
        assert!((bare - 3e-4).abs() < 1e-18, "{bare}");
        bodies.faces[0][0].film = Some(3.0);
        let filmed = begin(&mut bodies);
        assert!((filmed - 1.5e-4).abs() < 1e-18, "{filmed}");
    }

    #[test]
    fn a_body_beside_gas_of_one_temperature_approaches_it_by_implicit_steps() {
        let mut bodies = body(None);
        let conductance = begin(&mut bodies);
        let (span, mut expected) = (1000.0, 300.0);
        let share = conductance * span / (2e-3 * 500.0);
        for _ in 0..3 {
            begin(&mut bodies);
            bodies.look(&[400.0]);
            bodies.take(None, [span, 0.0]);
            let off = bodies.credit(|_| 400.0, std::iter::empty(), [span, 0.0]);
            assert!(off < 1e-12, "{off}");
            bodies.commit();
            // (T' − T) = share (400 − T').
            expected = (expected + share * 400.0) / (1.0 + share);
            assert!((bodies.temperature()[0] - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn a_radiating_body_comes_to_where_it_gives_off_what_a_wall_gives_it() {
        let mut bodies = body(Some(BodyRadiation {
            area: 1e-4,
            emissivity: 0.5,
            surroundings: Schedule::constant(1000.0),
        }));
        begin(&mut bodies);
        bodies.conductance[0][0] = 0.0;
        // Over 1e12 s nothing is stored to speak of: e σ A (T⁴ − 1000⁴) = −(−2 W).
        let walls = || std::iter::once((0, -2.0));
        bodies.credit(|_| 400.0, walls(), [1e12, 0.0]);
        let expected = (1e12 + 2.0 / (0.5 * STEFAN_BOLTZMANN * 1e-4)).powf(0.25);
        let found = bodies.made[0];
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }

    #[test]
    fn round_off_about_a_body_in_equilibrium_leaves_nothing_open() {
        let mut bodies = body(None);
        begin(&mut bodies);
        bodies.conductance[0][0] = 0.0;
        bodies.gives[0] = 0.0;
        let mut off = |watt: f64| bodies.credit(|_| 300.0, std::iter::once((0, watt)), [10.0, 0.0]);
        // The body holds 300 J; 2e-14 W are a conductance of 0.1 W/K over the round-off of its temperature.
        assert!(off(2e-14) < 1e-3);
        assert!(off(1e-6) > 0.9);
    }

    #[test]
    fn what_a_body_stores_is_what_it_got_whatever_the_attempts_left() {
        let mut bodies = body(Some(BodyRadiation {
            area: 1e-4,
            emissivity: 0.5,
            surroundings: Schedule::constant(700.0),
        }));
        begin(&mut bodies);
        let off = bodies.credit(|_| 400.0, std::iter::once((0, 0.01)), [10.0, 0.0]);
        assert!(off > 1e-3);
        let balance = *bodies.balance();
        let stored = 2e-3 * 500.0 * (bodies.made[0] - 300.0);
        assert!((balance.stored - stored).abs() < 1e-12);
        assert_eq!(balance.from_walls, -0.1);
        let [open, _] = balance.open();
        assert!(open.abs() < 1e-13, "{balance:?}");
    }
}
