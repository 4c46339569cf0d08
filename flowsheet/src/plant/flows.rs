//! Streams at a time, recycles included.

use super::order::UnitBlock;
use super::tear::TearIteration;
use super::topology::{Plant, WatchedPlace};
use super::waveform::Waveform;
use crate::sums::{sum, sum_of_differences, sum_of_sizes};
use crate::{PlantError, UnitView};

/// What a tear stream may differ from itself after one way round, relative to its flow.
pub const LOOP_CLOSURE: f64 = 1e-13;
/// Most ways round.
const MOST_ROUNDS: usize = 150;
/// Most that may go round a recycle, relative to what enters it.
const MOST_FLOW: f64 = 1e9;
/// Enthalpies among the numbers of a tear stream count in MW, so that they weigh as masses do.
const ENTHALPY_WEIGHT: f64 = 1e-6;

/// Streams, and memory to compute them. Tear streams begin where they were.
#[derive(Clone, Debug, Default)]
pub struct FlowWorkspace {
    /// All streams, one after the other.
    pub streams: Vec<f64>,
    /// Difference of each tear stream from itself, relative to its flow, in the order of [`Plant::tears`].
    pub closures: Vec<f64>,
    /// Ways round the recycles, all in all.
    pub rounds: usize,
    made: Vec<f64>,
    /// Signals of all units.
    pub(super) signals: Vec<f64>,
    /// Tear streams of a recycle, what they become, and the iteration between them.
    torn: Vec<f64>,
    new: Vec<f64>,
    iteration: TearIteration,
    /// Tear streams that are given, and what they became.
    pub(super) given: Option<Waveform>,
    pub(super) became: Vec<f64>,
}

impl FlowWorkspace {
    /// Streams at rest.
    pub fn new(plant: &Plant) -> Self {
        Self {
            streams: vec![0.0; plant.names.len() * plant.layout.width()],
            ..Self::default()
        }
    }

    /// One stream.
    pub fn stream(&self, plant: &Plant, index: usize) -> &[f64] {
        let width = plant.layout.width();
        &self.streams[index * width..(index + 1) * width]
    }
}

/// A span of time that is integrated: where it is, and where it ends.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Time in s.
    pub time: f64,
    /// End of the span in s.
    pub end: f64,
}

impl Plant {
    /// Runs `visit` on a unit's view.
    pub(super) fn view<'a>(
        &'a self,
        unit: usize,
        at: Moment,
        y: &'a [f64],
        [streams, signals]: [&'a [f64]; 2],
    ) -> UnitView<'a> {
        let own = &self.units[unit];
        UnitView {
            time: at.time,
            end: at.end,
            layout: &self.layout,
            name: &own.name,
            state: &y[own.state.clone()],
            streams,
            inlets: &own.inlets,
            signals,
            heard: &own.heard,
            measured: &[],
        }
    }

    /// The signals of all units, which follow from their unknowns.
    fn signal(&self, y: &[f64], signals: &mut Vec<f64>) {
        let count = self.units.last().map_or(0, |unit| unit.signals.end);
        signals.resize(count, 0.0);
        if count == 0 {
            return;
        }
        for unit in &self.units {
            let to = &mut signals[unit.signals.clone()];
            unit.unit.signal(&self.layout, &y[unit.state.clone()], to);
        }
    }

    /// All streams at a time, from the unknowns.
    pub(super) fn flows(
        &self,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
    ) -> Result<(), PlantError> {
        work.closures.clear();
        work.became.clear();
        self.signal(y, &mut work.signals);
        for block in &self.blocks {
            if block.tears.is_empty() {
                for unit in &block.units {
                    self.produce(*unit, at, y, work)?;
                    self.put(*unit, &[], work, &mut []);
                }
            } else {
                match work.given.take() {
                    None => self.close(block, at, y, work)?,
                    Some(wave) => {
                        let done = self.pass(block, &wave, at, y, work);
                        work.given = Some(wave);
                        done?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Goes once round a recycle whose tear streams are given.
    fn pass(
        &self,
        block: &UnitBlock,
        wave: &Waveform,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
    ) -> Result<(), PlantError> {
        let width = self.layout.width();
        let mut values = Vec::new();
        wave.at(at.time, &mut values);
        // Tear streams of the blocks before come first.
        let values = &values[work.became.len()..];
        for (tear, own) in block.tears.iter().zip(values.chunks_exact(width)) {
            work.streams[tear * width..(tear + 1) * width].copy_from_slice(own);
        }
        let mut new = vec![0.0; block.tears.len() * width];
        for unit in &block.units {
            self.produce(*unit, at, y, work)?;
            self.put(*unit, &block.tears, work, &mut new);
        }
        work.rounds += 1;
        work.became.extend_from_slice(&new);
        Ok(())
    }

    /// All tear streams as they are.
    pub(super) fn torn(&self, work: &FlowWorkspace) -> Vec<f64> {
        let tears = self.blocks.iter().flat_map(|block| &block.tears);
        tears
            .flat_map(|tear| work.stream(self, *tear).to_vec())
            .collect()
    }

    /// Lets enthalpies among tear streams weigh as masses do, or takes the weight off.
    pub(super) fn weigh_heat(&self, tears: &mut [f64], on: bool) {
        let factor = if on {
            ENTHALPY_WEIGHT
        } else {
            1.0 / ENTHALPY_WEIGHT
        };
        let (width, enthalpy) = (self.layout.width(), self.layout.enthalpy());
        let heats = tears.iter_mut().skip(enthalpy).step_by(width);
        heats.for_each(|heat| *heat *= factor);
    }

    /// What flows out of a unit, into `made`.
    fn produce(
        &self,
        unit: usize,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
    ) -> Result<(), PlantError> {
        let FlowWorkspace {
            streams,
            made,
            signals,
            ..
        } = work;
        made.clear();
        made.resize(self.units[unit].outlets.len() * self.layout.width(), 0.0);
        self.units[unit]
            .unit
            .produce(&self.view(unit, at, y, [streams, signals]), made)
    }

    /// Puts `made` in its place: tear streams among `new`, others among the streams.
    fn put(&self, unit: usize, tears: &[usize], work: &mut FlowWorkspace, new: &mut [f64]) {
        let width = self.layout.width();
        let FlowWorkspace { streams, made, .. } = work;
        for (own, stream) in made
            .chunks_exact(width)
            .zip(self.units[unit].outlets.clone())
        {
            match tears.iter().position(|tear| *tear == stream) {
                Some(place) => new[place * width..(place + 1) * width].copy_from_slice(own),
                None => streams[stream * width..(stream + 1) * width].copy_from_slice(own),
            }
        }
    }

    /// Goes round a recycle until its tear streams agree with themselves.
    fn close(
        &self,
        block: &UnitBlock,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
    ) -> Result<(), PlantError> {
        let mut x = std::mem::take(&mut work.torn);
        let mut new = std::mem::take(&mut work.new);
        let mut iteration = std::mem::take(&mut work.iteration);
        let done = self.go_round(block, at, y, work, &mut iteration, [&mut x, &mut new]);
        (work.torn, work.new, work.iteration) = (x, new, iteration);
        done
    }

    /// [`Self::close`] with memory for its vectors.
    fn go_round(
        &self,
        block: &UnitBlock,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
        iteration: &mut TearIteration,
        [x, new]: [&mut Vec<f64>; 2],
    ) -> Result<(), PlantError> {
        let width = self.layout.width();
        x.clear();
        for tear in &block.tears {
            x.extend_from_slice(&work.streams[tear * width..(tear + 1) * width]);
        }
        new.clear();
        new.resize(x.len(), 0.0);
        iteration.restart();
        let inflow = self.inflow(block, &work.streams);
        let first = sum_of_sizes(x);
        let mut closure = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            for unit in &block.units {
                self.produce(*unit, at, y, work)?;
                self.put(*unit, &block.tears, work, new);
            }
            work.rounds += 1;
            closure = self.difference(x, new);
            if !closure.is_finite() {
                let bad = new.iter().position(|flow| !flow.is_finite());
                return Err(PlantError::NotFinite {
                    place: format!(
                        "stream \"{}\"",
                        self.names[block.tears[bad.unwrap_or(0) / width]]
                    ),
                    quantity: "a flow",
                    time: at.time,
                });
            }
            // A flow beyond all bounds is closed relative to itself, not relative to what enters.
            let bounded = sum_of_sizes(x) < MOST_FLOW * inflow;
            if closure <= LOOP_CLOSURE && (bounded || inflow == 0.0) {
                self.differences(x, new, &mut work.closures);
                return Ok(());
            }
            iteration.next(self, x, new);
            if self.turns(new, &iteration.plain) {
                new.copy_from_slice(&iteration.plain);
            }
            for (tear, own) in block.tears.iter().zip(new.chunks_exact(width)) {
                work.streams[tear * width..(tear + 1) * width].copy_from_slice(own);
            }
            std::mem::swap(x, new);
        }
        if sum_of_sizes(new) < first && self.dies_out(block, at, y, work, new)? {
            let closed = block.tears.len();
            work.closures.extend(std::iter::repeat_n(0.0, closed));
            return Ok(());
        }
        Err(self.does_not_close(block, at.time, closure, inflow, [x, new]))
    }

    /// Whether a recycle without flow stays without flow. What goes round and nothing feeds gets smaller each time, by as much of
    /// itself: no residual is ever small relative to it.
    fn dies_out(
        &self,
        block: &UnitBlock,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
        new: &[f64],
    ) -> Result<bool, PlantError> {
        let width = self.layout.width();
        let mut made = vec![0.0; new.len()];
        let kept = work.streams.clone();
        for tear in &block.tears {
            work.streams[tear * width..(tear + 1) * width].fill(0.0);
        }
        for unit in &block.units {
            self.produce(*unit, at, y, work)?;
            self.put(*unit, &block.tears, work, &mut made);
        }
        let without = made.iter().all(|flow| *flow == 0.0);
        if !without {
            work.streams = kept;
        }
        Ok(without)
    }

    /// Whether a guess has flows that run backwards where those of a plain way round do not.
    pub(super) fn turns(&self, guess: &[f64], plain: &[f64]) -> bool {
        let width = self.layout.width();
        let least = |stream: &[f64]| {
            let masses = &stream[..width - 1];
            masses.iter().copied().fold(0.0, f64::min) / sum_of_sizes(masses)
        };
        let mut pairs = guess.chunks_exact(width).zip(plain.chunks_exact(width));
        pairs.any(|(guess, plain)| least(guess) < 2.0 * least(plain) - 1e-9)
    }

    /// Which stream, and what of it, does not agree with itself.
    fn does_not_close(
        &self,
        block: &UnitBlock,
        time: f64,
        residual: f64,
        inflow: f64,
        [x, new]: [&[f64]; 2],
    ) -> PlantError {
        let (width, enthalpy) = (self.layout.width(), self.layout.enthalpy());
        let names = block.tears.iter();
        let names = names.map(|tear| format!("\"{}\"", self.names[*tear]));
        let grows = (0..x.len()).max_by(|a, b| {
            let heat = |k: usize| k % width == enthalpy;
            let size = |k: usize| (new[k] - x[k]).abs() * if heat(k) { 1e-6 } else { 1.0 };
            size(*a).total_cmp(&size(*b))
        });
        PlantError::Recycle {
            stream: names.collect::<Vec<_>>().join(", "),
            time,
            residual,
            iterations: MOST_ROUNDS,
            grows: match self.grown(new, inflow) {
                Some(words) => words,
                None => format!(
                    "its residual is {residual:.3e} of its flow, largest in {}",
                    self.place_name(grows.unwrap_or(0) % width)
                ),
            },
        }
    }

    /// What grew beyond all bounds, where something did: the flow, and what most of it is.
    fn grown(&self, new: &[f64], inflow: f64) -> Option<String> {
        let (width, enthalpy) = (self.layout.width(), self.layout.enthalpy());
        let flow: f64 = new.chunks_exact(width).map(|s| sum(&s[..enthalpy])).sum();
        if sum_of_sizes(new) < 1e3 * inflow || inflow == 0.0 {
            return None;
        }
        let masses = new
            .iter()
            .enumerate()
            .filter(|(k, _)| k % width != enthalpy);
        let most = masses.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some(format!(
            "its flow grew to {flow:.3e} kg/s, most of it {}",
            self.place_name(most.0 % width)
        ))
    }

    /// Mass and weighted enthalpy that enter the units of a recycle from outside.
    fn inflow(&self, block: &UnitBlock, streams: &[f64]) -> f64 {
        let (width, enthalpy) = (self.layout.width(), self.layout.enthalpy());
        let enters =
            |(from, to): &(usize, usize)| block.units.contains(to) && !block.units.contains(from);
        let inside = self.ends.iter().zip(streams.chunks_exact(width));
        let flows = inside
            .filter(|(ends, _)| enters(ends))
            .map(|(_, stream)| sum(&stream[..enthalpy]) + stream[enthalpy].abs());
        flows.sum()
    }

    /// Largest difference of a tear stream from what it became.
    pub(super) fn difference(&self, x: &[f64], new: &[f64]) -> f64 {
        let width = self.layout.width();
        let pairs = x.chunks_exact(width).zip(new.chunks_exact(width));
        let each = pairs.map(|(x, new)| self.difference_of(x, new));
        // NaN counts as the largest.
        each.fold(0.0, |largest, own| {
            if own > largest || own.is_nan() {
                own
            } else {
                largest
            }
        })
    }

    /// Adds the difference of each tear stream from what it became to a list.
    pub(super) fn differences(&self, x: &[f64], new: &[f64], to: &mut Vec<f64>) {
        let width = self.layout.width();
        let pairs = x.chunks_exact(width).zip(new.chunks_exact(width));
        to.extend(pairs.map(|(x, new)| self.difference_of(x, new)));
    }

    /// Difference of a stream from what it became: of its mass flows together, or of its enthalpy relative to what its heat
    /// capacity carries over 100 K.
    fn difference_of(&self, x: &[f64], new: &[f64]) -> f64 {
        let enthalpy = self.layout.enthalpy();
        let apart = sum_of_differences(&x[..enthalpy], &new[..enthalpy]);
        let size = sum_of_sizes(&new[..enthalpy]);
        let (capacity, latent) = self.layout.heat_capacity(new);
        let heat = (new[enthalpy] - x[enthalpy]).abs();
        let carried = 100.0 * capacity + latent + new[enthalpy].abs();
        let mut largest = 0.0f64;
        for (apart, size) in [(apart, size), (heat, carried)] {
            if apart != 0.0 {
                let relative = apart / size;
                if relative > largest || relative.is_nan() {
                    largest = relative;
                }
            }
        }
        largest
    }

    /// What stands at a place of a stream, in words.
    fn place_name(&self, place: usize) -> String {
        let layout = &self.layout;
        let count = layout.compounds().len();
        if place == layout.enthalpy() {
            return "the enthalpy".into();
        }
        if place < layout.solids() {
            let d = layout.grid().diameters()[place / layout.inner()];
            return format!(
                "solid {} of {d:.4e} m",
                layout.compounds()[place % count].name
            );
        }
        let rest = place - layout.solids();
        let phase = if rest < count { "liquid" } else { "vapour" };
        format!("{phase} {}", layout.compounds()[rest % count].name)
    }

    /// Rates of the unknowns and of the totals ([`Plant::totals`]), with all streams.
    pub(super) fn rates(
        &self,
        at: Moment,
        y: &[f64],
        work: &mut FlowWorkspace,
        rates: &mut [f64],
    ) -> Result<(), PlantError> {
        self.flows(at, y, work)?;
        rates.fill(0.0);
        let width = self.layout.width();
        let (own, totals) = rates.split_at_mut(self.unknowns);
        let kinds = self.layout.compounds().len() + 1;
        let (of_streams, heats) = totals.split_at_mut(self.names.len() * kinds);
        for (index, unit) in self.units.iter().enumerate() {
            let mut view = self.view(index, at, y, [&work.streams, &work.signals]);
            let held;
            match unit.watched {
                Some(WatchedPlace::Stream(stream)) => view.measured = work.stream(self, stream),
                Some(WatchedPlace::Unit(other)) => {
                    held = self.held_by(other, y);
                    view.measured = &held;
                }
                None => {}
            }
            let out = &work.streams[unit.outlets.start * width..unit.outlets.end * width];
            unit.unit.rates(&view, out, &mut own[unit.state.clone()])?;
            heats[index] = unit.unit.heat(&view, out, &own[unit.state.clone()]);
        }
        let streams = work.streams.chunks_exact(width);
        for (stream, to) in streams.zip(of_streams.chunks_exact_mut(kinds)) {
            self.layout.kinds(stream, to);
        }
        Ok(())
    }

    /// A bound of how fast small deviations of the unknowns fade, in 1/s.
    pub(super) fn fastest(&self, at: Moment, y: &[f64], work: &FlowWorkspace) -> f64 {
        let width = self.layout.width();
        let each = self.units.iter().enumerate().map(|(index, unit)| {
            let out = &work.streams[unit.outlets.start * width..unit.outlets.end * width];
            unit.unit.fastest(
                &self.view(index, at, y, [&work.streams, &work.signals]),
                out,
            )
        });
        each.fold(0.0, f64::max)
    }

    /// Number of totals: of each stream the mass of each compound and the enthalpy, of each unit the heat.
    pub(super) fn totals(&self) -> usize {
        self.names.len() * (self.layout.compounds().len() + 1) + self.units.len()
    }

    /// Lets every unit look at its unknowns.
    pub(super) fn verify(
        &self,
        at: Moment,
        y: &[f64],
        work: &FlowWorkspace,
    ) -> Result<(), PlantError> {
        for (index, unit) in self.units.iter().enumerate() {
            let bad = y[unit.state.clone()].iter().any(|value| !value.is_finite());
            if bad {
                return Err(PlantError::NotFinite {
                    place: format!("unit \"{}\"", unit.name),
                    quantity: "an unknown",
                    time: at.time,
                });
            }
            let seen = [&work.streams[..], &work.signals];
            unit.unit.verify(&self.view(index, at, y, seen))?;
        }
        Ok(())
    }
}
