//! What is wrong with a plant, or stops its computation.

use calcine_physics::figures::Brief;
use thiserror::Error;

use crate::signal::SignalKind;

/// What is wrong with a plant, or stops its computation. Each says the fact, the number, the place and the remedy.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlantError {
    /// Edges of size classes that are not a grid.
    #[error("size grid: {0}; give rising edges of two classes or more, from 0 m or above")]
    Grid(String),
    /// A number outside of what a law or a unit allows.
    #[error("{place}: {quantity} is {value}; {allowed}")]
    Value {
        /// Unit or law.
        place: String,
        /// Which number.
        quantity: &'static str,
        /// The number, in SI.
        value: f64,
        /// What it may be.
        allowed: &'static str,
    },
    /// A distribution that does not fit its grid.
    #[error(
        "{place}: {share:.3e} of the distribution lies outside of the size grid, {from} m to {to} m; let the size classes begin at {low} m or below and end at {high} m or above"
    )]
    OutsideGrid {
        /// Unit or stream.
        place: String,
        /// Share of the mass.
        share: f64,
        /// First edge of the grid in m.
        from: f64,
        /// Last edge of the grid in m.
        to: f64,
        /// First edge in m that would do.
        low: f64,
        /// Last edge in m that would do.
        high: f64,
    },
    /// A normal distribution that no grid holds.
    #[error(
        "{place}: a normal distribution of mean {mean:.3e} m and standard deviation {deviation:.3e} m has {share:.3e} of its mass below 0 m, where no size class can be; lower the deviation to {most} m or less, or raise the mean"
    )]
    BelowZero {
        /// Unit or stream.
        place: String,
        /// Mean in m.
        mean: f64,
        /// Standard deviation in m.
        deviation: f64,
        /// Share of the mass below zero.
        share: f64,
        /// Largest deviation in m that would do.
        most: f64,
    },
    /// A mill whose power makes a product that its law cannot describe.
    #[error(
        "{place}: {power:.3e} W on {flow:.3e} kg/s mill to an x80 of {size:.3e} m, and of its normal distribution with the deviation {deviation:.3e} m {share:.3e} of the mass lies below 0 m, where no size class can be; lower the power or the deviation of the mill, or lead more solids into it"
    )]
    MilledTooFine {
        /// Unit.
        place: String,
        /// Power in W.
        power: f64,
        /// Solids that flow in, in kg/s.
        flow: f64,
        /// x₈₀ of the product in m.
        size: f64,
        /// Standard deviation of the product in m.
        deviation: f64,
        /// Share of the mass below zero.
        share: f64,
    },
    /// Particles that have come into the last class of the grid.
    #[error(
        "{place} at {time} s: {share:.3e} of the mass is in the last size class, beyond which nothing grows; let the size classes end above {to} m, or the plant take large particles out", time = Brief(*.time))]
    GrownBeyond {
        /// Unit.
        place: String,
        /// Time in s.
        time: f64,
        /// Share of the mass in the last class.
        share: f64,
        /// Last edge of the grid in m.
        to: f64,
    },
    /// Aggregation that has reached the end of the grid by a kernel that gels.
    #[error(
        "{place} at {time} s: {share:.3e} of the mass has grown into the last size class by a kernel of degree {degree:.3}, which gels: above degree 1 particles become infinitely large in finite time; end the run before, lower the kernel, take one of degree 1 or less, or let the size classes end far above what the kernel makes", time = Brief(*.time))]
    Gels {
        /// Unit.
        place: String,
        /// Time in s.
        time: f64,
        /// Share of the mass in the last class.
        share: f64,
        /// Degree of homogeneity of the kernel.
        degree: f64,
    },
    /// A balance of enthalpy that closes below absolute zero only.
    #[error(
        "{place} at {time} s comes to {temperature} K: what evaporates there takes more heat than there is; bring more or hotter gas, more heat, or less liquid", time = Brief(*.time), temperature = Brief(*.temperature))]
    Frozen {
        /// Stream or unit.
        place: String,
        /// Time in s.
        time: f64,
        /// Temperature in K.
        temperature: f64,
    },
    /// What is followed was to stop at this time in s.
    #[error("it was stopped at {time} s", time = Brief(*.0))]
    Interrupted(f64),
    /// Two units of one name.
    #[error("two units are named \"{0}\"; rename one of them")]
    DuplicateUnit(String),
    /// A unit that is not there.
    #[error("no unit is named \"{0}\"; the units are {1}")]
    UnknownUnit(String, String),
    /// A stream that is not there.
    #[error("no stream is named \"{0}\"; the streams are {1}")]
    UnknownStream(String, String),
    /// A stream that a recycle cannot be torn at.
    #[error("recycles torn at stream \"{stream}\": {why}")]
    Tear {
        /// Stream.
        stream: String,
        /// What is wrong with it, and what to do.
        why: &'static str,
    },
    /// A port that is not there.
    #[error("unit \"{unit}\" has no port \"{port}\"; its ports of that kind are {ports}")]
    UnknownPort {
        /// Unit.
        unit: String,
        /// Port asked for.
        port: String,
        /// Ports of that direction.
        ports: String,
    },
    /// A port without a stream.
    #[error("port \"{port}\" of unit \"{unit}\" is not connected; connect a stream to it")]
    Unconnected {
        /// Unit.
        unit: String,
        /// Port.
        port: String,
    },
    /// A port with two streams.
    #[error("port \"{port}\" of unit \"{unit}\" has two streams; put a mixer or a splitter there")]
    TakenTwice {
        /// Unit.
        unit: String,
        /// Port.
        port: String,
    },
    /// A mill without solids.
    #[error(
        "no solids flow into mill \"{unit}\" at {time} s, so that its power has nothing to act on; lower the screen's cut size, or take a mill without power (`constant`)", time = Brief(*.time))]
    IdleMill {
        /// Unit.
        unit: String,
        /// Time in s.
        time: f64,
    },
    /// A recycle that does not converge.
    #[error(
        "recycle through stream {stream} does not converge at {time} s after {iterations} iterations: {grows}; the recycle gains more than leaves the plant, check screens and splitters within it", time = Brief(*.time))]
    Recycle {
        /// Tear stream, as "unit.port -> unit.port".
        stream: String,
        /// Time in s.
        time: f64,
        /// Residual relative to the flow.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// What grew, or has the largest residual, in words.
        grows: String,
    },
    /// A unit that takes signals of one that gives none of these.
    #[error(
        "unit \"{unit}\" takes {wanted} from unit \"{from}\", which gives none; name a unit that does"
    )]
    Signals {
        /// Unit that takes them.
        unit: String,
        /// Unit that is asked.
        from: String,
        /// What it needs.
        wanted: SignalKind,
    },
    /// A bed that cannot be followed.
    #[error("bed \"{unit}\" at {time} s: {cause}", time = Brief(*.time))]
    Bed {
        /// Unit.
        unit: String,
        /// Time in s.
        time: f64,
        /// Why, with what to do.
        cause: String,
    },
    /// What a plant with a coupled bed does not have.
    #[error(
        "bed \"{unit}\" exchanges with the plant from time to time: {what}; put a granulator or a bunker in its place"
    )]
    CoupledInTime {
        /// Unit.
        unit: String,
        /// What cannot be.
        what: &'static str,
    },
    /// A number that is not finite.
    #[error(
        "{quantity} of {place} is not finite at {time} s; check the unit's parameters and its feeds", time = Brief(*.time))]
    NotFinite {
        /// Unit or stream.
        place: String,
        /// Which number.
        quantity: &'static str,
        /// Time in s.
        time: f64,
    },
    /// An integration that does not come to its end.
    #[error("the plant could not be followed beyond {reached} s: {cause}", reached = Brief(*.reached))]
    Steps {
        /// Time reached in s.
        reached: f64,
        /// Why.
        cause: &'static str,
    },
    /// Newton's iteration found no steady state.
    #[error(
        "no steady state was found: change of {residual:.3e} kg/s after {iterations} iterations; run the plant for longer first, or move the key in smaller steps"
    )]
    NoSteadyState {
        /// Largest rate of change in kg/s.
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
    /// Eigenvalues that were not found.
    #[error(
        "the modes of the steady state were not found: the QR algorithm did not converge; run the plant without `steady` to see whether it comes to rest"
    )]
    NoModes,
    /// A value of a key for which there is no plant.
    #[error("no plant has the value {value}: {cause}")]
    NoPlant {
        /// Value of the key.
        value: f64,
        /// Why.
        cause: String,
    },
}
