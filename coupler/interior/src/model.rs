//! The seam behind which the inside of particles is computed.
//!
//! A model owns the state of the particles of one material, in rows of its own. The coordinator maps the rows of a run to
//! models, owns the network of contacts and radiation over all of them, and exchanges their heat and gas. It knows
//! of a model only what this trait says.
//!
//! One attempt at a window, always from the last commit:
//!
//! 1. [`ParticleModel::surface`]: what the particle takes from the network, as a line over its surface temperature.
//!    The network is solved with these lines; where they bend, it asks again at the temperatures it found.
//! 2. [`ParticleModel::respond`]: with the network's heat given, what the particle exchanges with the gas, as lines. A
//!    model that takes steps of its own within the span follows what its surface is beside instead, and says the means
//!    of its surface ([`ParticleModel::surface_mean`]), from which that heat is booked.
//! 3. The gas takes the lines; 1 and 2 are repeated with the gas of the last attempt until both agree.
//! 4. [`ParticleModel::limit`]: what the gas made of the channels, limited to what the particle holds. The gas takes
//!    that once more as fixed sources.
//! 5. [`ParticleModel::settle`]: what was exchanged is booked, whatever the lines were: mass, elements and energy close.

use calcine_physics::film::{FilmCoefficient, FilmTheory};
use calcine_physics::radiation::STEFAN_BOLTZMANN;
use calcine_physics::thermo::Element;

use crate::column::{Ragged, StateColumn};
use crate::error::ModelError;

/// The gas about particles, and what they exchange with it; one value a row where nothing else is said.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Temperature of the gas that each sees in K.
    pub temperature: &'a [f64],
    /// Its pressure in Pa; empty where no model of the run has channels.
    pub pressure: &'a [f64],
    /// Its mass fractions, species by species within each row; empty for a single gas.
    pub composition: &'a [f64],
    /// Conductance h A to it in W/K.
    pub conductance: &'a [f64],
    /// Mass transfer coefficients over the temperature of the film, species by species within each row; empty where no
    /// model has channels.
    pub film: &'a [FilmCoefficient],
    /// How transfer through films is computed.
    pub theory: FilmTheory,
    /// Radii at the start of the window in m.
    pub radius: &'a [f64],
    /// Process time at the end of the span in s.
    pub end: f64,
}

/// What a particle takes from the network over its surface temperature T: Q = k (T − T_free), the gas beside it and all
/// that happens inside over the span eliminated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceLine {
    /// k in W/K, positive; infinite where heat does not move the temperature.
    pub conductance: f64,
    /// T_free in K: the surface temperature without a network.
    pub temperature: f64,
    /// What of k is heat that is stored over the span, in W/K, where T is the temperature at its end: the network then finds
    /// the mean from that at its start. Zero where T is the mean, or is not moved.
    pub stored: f64,
}

/// Heat from the network into a particle over a span.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NetworkHeat {
    /// Its mean in W, as the network found it.
    pub mean: f64,
    /// What the surface is beside meanwhile, for models that follow it by steps of their own; `None` of a heat that does not
    /// follow the surface.
    pub beside: Option<SurfaceNetwork>,
}

impl NetworkHeat {
    /// A heat in W that does not follow the surface.
    pub fn constant(mean: f64) -> Self {
        Self { mean, beside: None }
    }
}

/// Contacts and views of a surface, with what is beyond them at its mean over a span: the heat into a surface of the
/// temperature T is Σ G_j (T_j − T) + σ Σ S_j (T_j⁴ − T⁴).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceNetwork {
    /// Σ G_j in W/K.
    pub conductance: f64,
    /// Σ G_j T_j in W.
    pub conducted: f64,
    /// Σ S_j in m², of what is emitted and absorbed.
    pub area: f64,
    /// Σ S_j T_j⁴ in m² K⁴.
    pub seen: f64,
}

impl SurfaceNetwork {
    /// Heat in W into a surface of the temperature in K, and of its fourth power in K⁴: of both at a time, or of their means.
    pub fn heat(&self, temperature: f64, fourth_power: f64) -> f64 {
        self.conducted - self.conductance * temperature
            + STEFAN_BOLTZMANN * (self.seen - self.area * fourth_power)
    }

    /// By how much that falls with the temperature in K, in W/K.
    pub fn slope(&self, temperature: f64) -> f64 {
        self.conductance + 4.0 * STEFAN_BOLTZMANN * self.area * temperature.powi(3)
    }
}

/// Means over the span of the last attempt of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceMean {
    /// Of its temperature, in K.
    pub temperature: f64,
    /// Of the fourth power of that, in K⁴.
    pub fourth_power: f64,
}

impl SurfaceLine {
    /// That of a surface whose temperature in K heat does not move.
    pub fn prescribed(temperature: f64) -> Self {
        Self {
            conductance: f64::INFINITY,
            temperature,
            stored: 0.0,
        }
    }

    /// That of a particle of one temperature, with an implicit step: it stores `stored` = C/Δτ in W/K from the temperature
    /// `from` in K, and exchanges `conductance` in W/K with gas of the temperature `gas` in K.
    pub fn of_one_temperature(stored: f64, from: f64, conductance: f64, gas: f64) -> Self {
        let all = stored + conductance;
        Self {
            conductance: all,
            temperature: from + conductance * (gas - from) / all,
            stored,
        }
    }
}

/// A way by which mass passes between particle and gas.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What it is, for messages.
    pub name: String,
    /// The gas over whose mass fraction its rate is linearised; `None` for a rate that does not follow the gas.
    pub key: Option<usize>,
    /// Mass in kg that a unit (a mole, for a reaction) makes (+) or takes (−) of each gas.
    pub mass: Vec<f64>,
}

/// What particles exchange with the gas, as lines over the gas that they see.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GasLines {
    /// K in W/K, of the heat Q = K (T_gas − T_start) into each particle.
    pub conductance: Vec<f64>,
    /// T_start in K.
    pub temperature: Vec<f64>,
    /// b of the rate b Y − a of each channel in units/s, channel by channel within each row; Y the mass fraction of
    /// its key gas.
    pub slope: Vec<f64>,
    /// a in units/s, likewise.
    pub offset: Vec<f64>,
    /// β in units/s, likewise: how the rate at a part of the surface follows the gas there, with the particle as a whole
    /// as it went, of the sign of b. A particle that spans several cells exchanges b Ȳ − a + β (Y_c − Ȳ) in the cell c,
    /// Ȳ what it sees of all of them. Without depletion and heating inside over the span it is b.
    pub local_slope: Vec<f64>,
    /// Temperature in K with which gas leaves each particle.
    pub released: Vec<f64>,
}

impl GasLines {
    /// Makes room for so many rows and channels, all zero.
    pub fn reset(&mut self, rows: usize, channels: usize) {
        for list in [
            &mut self.conductance,
            &mut self.temperature,
            &mut self.released,
        ] {
            list.clear();
            list.resize(rows, 0.0);
        }
        for list in [&mut self.slope, &mut self.offset, &mut self.local_slope] {
            list.clear();
            list.resize(rows * channels, 0.0);
        }
    }
}

/// What passed between particles and all else over an attempt; means over the span.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// Heat from the gas into each particle in W, that of exchanged mass apart.
    pub heat: &'a [f64],
    /// Heat from the network into each particle in W.
    pub network: &'a [f64],
    /// Sensible enthalpy that exchanged gas carries into each particle in W.
    pub carried: &'a [f64],
    /// Rate of each channel in units/s, channel by channel within each row.
    pub rates: &'a [f64],
}

/// Which state of the particles is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// The last commit.
    Commit,
    /// The last attempt.
    Attempt,
}

/// What others see of particles.
#[derive(Clone, Copy, Debug)]
pub struct Bodies<'a> {
    /// Surface temperature in K.
    pub temperature: &'a [f64],
    /// Mass in kg; empty where masses stay as the solver of the motion has them.
    pub mass: &'a [f64],
    /// Radius in m; empty where radii stay as the solver of the motion has them.
    pub radius: &'a [f64],
}

/// A sum over rows, and the sum of magnitudes to which its error is relative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Signed sum.
    pub sum: f64,
    /// Sum of magnitudes.
    pub magnitude: f64,
}

impl Tally {
    /// Adds a value with its own magnitude.
    pub fn add(&mut self, value: f64) {
        self.sum += value;
        self.magnitude += value.abs();
    }
}

impl std::ops::Mul<f64> for Tally {
    type Output = Self;

    /// That of so many; a number above zero.
    fn mul(self, count: f64) -> Self {
        Self {
            sum: count * self.sum,
            magnitude: count * self.magnitude,
        }
    }
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.sum += other.sum;
        self.magnitude += other.magnitude;
    }
}

/// Conserved quantities of particles, or changes of them. Energies count from the elements in their standard states where
/// a model exchanges mass with the gas (the gas' formation reference), so that what passes between both drops out.
#[derive(Clone, Debug, PartialEq)]
pub struct Inventory {
    /// Mass in kg.
    pub mass: Tally,
    /// Energy in J. The magnitude of a change is that of sensible and reaction heat.
    pub energy: Tally,
    /// Mass of each element in kg, in the order of [`Element::ALL`]; zero for particles whose elements do not count.
    pub elements: Vec<Tally>,
}

impl Default for Inventory {
    fn default() -> Self {
        Self {
            mass: Tally::default(),
            energy: Tally::default(),
            elements: vec![Tally::default(); Element::COUNT],
        }
    }
}

impl std::ops::AddAssign<&Inventory> for Inventory {
    fn add_assign(&mut self, other: &Self) {
        self.add_times(1.0, other);
    }
}

impl Inventory {
    /// Adds as many times what another holds.
    pub fn add_times(&mut self, count: f64, other: &Self) {
        self.mass += other.mass * count;
        self.energy += other.energy * count;
        for (sum, other) in self.elements.iter_mut().zip(&other.elements) {
            *sum += *other * count;
        }
    }
}

/// A particle that comes in. What its state does not say is as the model's material has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newcomer<'a> {
    /// Its id.
    pub id: u64,
    /// Its mass in kg.
    pub mass: f64,
    /// Its radius in m.
    pub radius: f64,
    /// Values of columns by name. Every model takes a `temperature` in K, the same throughout the particle.
    pub state: &'a [(&'a str, &'a [f64])],
}

impl Newcomer<'_> {
    /// The one value of a column that must be there.
    pub fn scalar(&self, column: &str) -> Result<f64, ModelError> {
        let found = self.state.iter().find(|(name, _)| *name == column);
        match found {
            Some((_, [value])) => Ok(*value),
            other => Err(ModelError::Column {
                column: column.to_owned(),
                found: other.map_or_else(
                    || "nothing".to_owned(),
                    |(_, values)| format!("{} values", values.len()),
                ),
                expected: format!("one value for the new particle {}", self.id),
            }),
        }
    }

    /// An error where the state names a column beside these.
    pub fn only(&self, known: &[&str]) -> Result<(), ModelError> {
        let strange = self.state.iter().find(|(name, _)| !known.contains(name));
        match strange {
            None => Ok(()),
            Some((name, values)) => Err(ModelError::Column {
                column: (*name).to_owned(),
                found: format!("{} values for the new particle {}", values.len(), self.id),
                expected: format!("no other columns than {}", known.join(", ")),
            }),
        }
    }
}

/// Inside of the particles of one material. Values are per real particle; an attempt always starts from the last commit.
/// A model begins without particles: they come by [`ParticleModel::change`], and from a checkpoint by
/// [`ParticleModel::load`] after that. Rows are in ascending id.
///
/// Results may not depend on the number of threads that a model uses.
pub trait ParticleModel: Send + Sync {
    /// Columns of its state; the same over the whole run.
    fn columns(&self) -> &[StateColumn];

    /// The committed values of a column, by its place in [`ParticleModel::columns`].
    fn read(&self, column: usize, out: &mut Ragged);

    /// Takes up committed values of all its columns, of which those that are no state are empty.
    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError>;

    /// What others see of the particles.
    fn bodies(&self, at: At) -> Bodies<'_>;

    /// Ways of mass between particles and gas; the same over the whole run.
    fn channels(&self) -> &[Channel] {
        &[]
    }

    /// Elements that its inventories count.
    fn elements(&self) -> Vec<Element> {
        Vec::new()
    }

    /// Lowest and highest temperature in K for which the properties of its material are given. It is computed beyond
    /// them all the same; a run counts and reports where it is.
    fn temperature_range(&self) -> (f64, f64) {
        (0.0, f64::INFINITY)
    }

    /// Fills the line of each particle over a span in s about the surface temperatures `at` in K. It may be called
    /// several times before `respond`, and changes nothing that shows.
    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError>;

    /// Fills what each particle exchanges with the gas over a span in s, with the network's heat into each given; `out` has
    /// room for all rows and channels.
    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError>;

    /// Means of the surface of a row in the last attempt, of models that follow what it is beside by steps of their own; `None`
    /// of those that take the network's mean heat.
    fn surface_mean(&self, row: usize) -> Option<SurfaceMean> {
        let _ = row;
        None
    }

    /// Lowers rates of channels in units/s, channel by channel within each row, to what the particles hold over a
    /// span in s.
    fn limit(&mut self, rates: &mut [f64], span: f64) {
        let _ = (rates, span);
    }

    /// Ends the attempt with what passed over a span in s.
    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError>;

    /// What the last attempt changed since the last commit in these rows, as differences row by row.
    fn changed(&self, rows: &[usize]) -> Inventory;

    /// True where something outside of the computation may give its particles heat; the same over the whole run.
    fn prescribes(&self) -> bool {
        false
    }

    /// Heat in J that something outside of the computation gave these rows in the last attempt, as where their temperature
    /// is prescribed, row by row.
    fn supplied(&self, rows: &[usize]) -> Tally {
        let _ = rows;
        Tally::default()
    }

    /// What these rows hold at the last commit.
    fn held(&self, rows: &[usize]) -> Inventory;

    /// Forgets the attempts since the last commit: what follows is what would follow from a checkpoint of it.
    fn begin_again(&mut self) {}

    /// Takes the last attempt as the new start. Returns the rows, ascending, of particles that are used up: the
    /// coordinator books what is left of them and takes them out by `change`.
    fn commit(&mut self) -> Vec<usize>;

    /// Takes particles out, by their rows in ascending order, and puts new ones behind the others; after a commit.
    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError>;
}
