//! Probes and quantities of interest.

use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::physics::Vec3;
use calcine_coupler::time::Ticks;

/// Points at which fields are sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name.
    pub name: String,
    /// The points in m.
    pub points: Vec<Vec3>,
    /// Whether the gas is sampled.
    pub gas: bool,
    /// Whether the particles are.
    pub particles: bool,
}

/// A quantity of interest.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// How it is measured.
    pub measure: Measure,
    /// Which species of the gas, or solid, where the measure is of a mass fraction.
    pub column: Option<usize>,
    /// Unit as printed.
    pub unit: &'static str,
    /// Largest difference between pairings.
    pub agree: Option<ToleranceBand>,
    /// Process time in s from which `agree` holds.
    pub agree_from: f64,
    /// Process time in s over which values are averaged before pairings are compared; 0: not at all.
    pub agree_over: f64,
    /// Expected value.
    pub expect: Option<Expect>,
}

/// How a quantity is measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Measure {
    /// Area mean on the first patch minus that on the second, of a gas field.
    Difference {
        /// Field: `pressure` (Pa) or `temperature` (K).
        field: String,
        /// The two patches.
        patches: [String; 2],
    },
    /// Statistic of a gas field.
    Gas {
        /// Field: `temperature` (K), `pressure` (Pa), `density` (kg/m³), `speed` (m/s),
        /// `void_fraction`.
        field: String,
        /// Where.
        over: GasPlace,
        /// `mean`, `min` or `max`.
        statistic: Statistic,
    },
    /// Statistic over particles.
    Particles {
        /// Field: `temperature` (K), `count` (1), and others of the case file.
        field: String,
        /// Which.
        over: ParticlePlace,
        /// Statistic.
        statistic: Statistic,
    },
    /// Heat in W from a wall of a temperature, or from the surroundings, into the particles.
    WallHeat {
        /// Its name.
        wall: String,
    },
    /// Temperature in K of a body that stores heat.
    Body {
        /// Its name.
        body: String,
    },
    /// One particle, by its place in the order of ids, counted from 1.
    Particle {
        /// Field: `temperature` (K).
        field: String,
        /// Which one.
        number: usize,
    },
    /// What flows through a patch into the gas, a mean over the last window.
    Flow {
        /// What: W or kg/s.
        what: Passing,
        /// The patch.
        patch: String,
    },
    /// Force in N of the gas on a wall along a direction.
    Force {
        /// What of it.
        part: ForcePart,
        /// The patch.
        patch: String,
        /// Unit vector.
        along: Vec3,
    },
    /// Particles that left through outlets.
    Discharge {
        /// What of them.
        what: Discharged,
        /// Index of the outlet; all of them where none is named.
        outlet: Option<usize>,
        /// Index of the population; all of them where none is named.
        population: Option<usize>,
        /// Process time up to now that counts; all of the run where it is not stated.
        over: Option<Ticks>,
    },
    /// Angle in rad of the bed's surface in a drum: by which the centre of mass of all particles has turned
    /// about an axis from straight below it. A surface that is flat stands across the line from the axis to the
    /// centre of mass, so that this is its slope.
    SurfaceAngle {
        /// A point of the axis in m.
        point: Vec3,
        /// Unit vector along the axis.
        axis: Vec3,
        /// Unit vector along gravity.
        down: Vec3,
    },
}

/// What flows through a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passing {
    /// Sensible enthalpy, zero at 298.15 K, with conduction.
    Heat,
    /// Gas.
    Mass,
    /// A species of it.
    Species,
}

/// What of the force of the gas on a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForcePart {
    /// The pressure above that of `gas.pressure`.
    Pressure,
    /// Friction.
    Viscous,
    /// Both.
    Total,
}

/// What is told of particles that leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Discharged {
    /// Mass flow in kg/s.
    MassFlow,
    /// Mass in kg.
    Mass,
    /// Number.
    Count,
    /// Mean process time in s, over the mass, since feeds brought them.
    ResidenceTime,
    /// Standard deviation of that time, over the mass.
    ResidenceDeviation,
}

/// Where a statistic of the gas is taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GasPlace {
    /// In all cells; the mean is over the gas' volume.
    Everywhere,
    /// On a patch; the mean is over its area.
    Patch(String),
    /// At the points of a probe.
    Probe(String),
}

/// Of which particles a statistic is taken.
#[derive(Clone, Debug, PartialEq)]
pub enum ParticlePlace {
    /// Of those of populations, by their indices, whose centres lie in a zone; of all of them, and wherever they are, where nothing
    /// is stated.
    Among {
        /// The populations.
        populations: Option<Vec<u32>>,
        /// The zone.
        zone: Option<Zone>,
    },
    /// Of those at the points of a probe.
    Probe(String),
}

impl ParticlePlace {
    /// All particles.
    pub const EVERYWHERE: Self = Self::Among {
        populations: None,
        zone: None,
    };
}

/// Statistics; each particle counts by its weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// Arithmetic mean.
    Mean,
    /// Smallest.
    Min,
    /// Largest.
    Max,
    /// Sum.
    Sum,
    /// Standard deviation.
    Deviation,
    /// Mean weighted by the mass flow through a patch (mixing-cup mean).
    MassFlowMean,
}

/// A band around a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToleranceBand {
    /// Fraction of the value.
    Relative(f64),
    /// In the unit of the quantity.
    Absolute(f64),
}

impl Quantity {
    /// The process time in s for which a value is expected, where that is after the end of the run.
    pub fn expected_after(&self, end: f64) -> Option<f64> {
        let at = self.expect.and_then(|expect| expect.at);
        at.filter(|&at| at > end)
    }
}

/// An expected value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expect {
    /// Process time in s at which it holds; `None`: at the end.
    pub at: Option<f64>,
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The band.
    pub within: ToleranceBand,
}
