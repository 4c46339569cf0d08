//! Which streams connect which units.

use std::collections::BTreeSet;
use std::ops::Range;

use super::order::{UnitBlock, order};
use crate::measured_place::MeasuredPlace;
use crate::{PlantError, ProcessUnit, StreamLayout};

/// A stream: from a unit's outlet to a unit's inlet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Connection {
    /// Name of the stream.
    pub name: String,
    /// Unit and port that it leaves.
    pub from: (String, String),
    /// Unit and port that it enters.
    pub to: (String, String),
}

impl Connection {
    /// A stream between two ports.
    pub fn new(name: &str, from: (&str, &str), to: (&str, &str)) -> Self {
        let own = |(unit, port): (&str, &str)| (unit.to_owned(), port.to_owned());
        Self {
            name: name.to_owned(),
            from: own(from),
            to: own(to),
        }
    }
}

/// A unit in its plant.
pub struct PlantUnit {
    /// Name.
    pub name: String,
    pub(super) unit: Box<dyn ProcessUnit>,
    /// Its unknowns among those of the plant.
    pub(super) state: Range<usize>,
    /// Streams that enter, port by port; streams that leave follow one another.
    pub(super) inlets: Vec<usize>,
    pub(super) outlets: Range<usize>,
    /// Its signals among those of the plant, and those that it takes.
    pub(super) signals: Range<usize>,
    pub(super) heard: Vec<Range<usize>>,
    /// What it measures.
    pub(super) watched: Option<WatchedPlace>,
}

/// Where a unit measures: a stream, or what another unit holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WatchedPlace {
    Stream(usize),
    Unit(usize),
}

/// A plant: units, streams between their ports, and the order in which they are computed.
pub struct Plant {
    pub(super) layout: StreamLayout,
    pub(super) units: Vec<PlantUnit>,
    pub(super) names: Vec<String>,
    pub(super) blocks: Vec<UnitBlock>,
    pub(super) unknowns: usize,
    /// Unit that each stream leaves, and that it enters.
    pub(super) ends: Vec<(usize, usize)>,
}

impl Plant {
    /// A plant of named units and the streams between them; else all that is wrong.
    pub fn new(
        layout: StreamLayout,
        units: Vec<(String, Box<dyn ProcessUnit>)>,
        connections: &[Connection],
    ) -> Result<Self, Vec<PlantError>> {
        let mut wrong = Vec::new();
        let mut seen = BTreeSet::new();
        let mut made = Vec::new();
        let (mut unknowns, mut streams, mut signals) = (0, 0, 0);
        let mut ports = Vec::new();
        for (name, mut unit) in units {
            if !seen.insert(name.clone()) {
                wrong.push(PlantError::DuplicateUnit(name.clone()));
            }
            if let Err(error) = unit.prepare(&layout, &name) {
                wrong.push(error);
            }
            let (inlets, outlets) = (unit.inlets(), unit.outlets());
            let (state, out) = (unit.unknowns(&layout), outlets.len());
            let own = unit.signals().map_or(0, |(_, count)| count);
            made.push(PlantUnit {
                name,
                unit,
                state: unknowns..unknowns + state,
                inlets: Vec::new(),
                outlets: streams..streams + out,
                signals: signals..signals + own,
                heard: Vec::new(),
                watched: None,
            });
            ports.push((inlets, outlets));
            (unknowns, streams) = (unknowns + state, streams + out);
            signals += own;
        }
        Self::hear(&mut made, &mut wrong);
        let places = Self::connect(&mut made, &ports, connections, streams, &mut wrong);
        if wrong.is_empty() {
            let names: Vec<&str> = places.iter().map(|(name, ..)| name.as_str()).collect();
            Self::watch(&mut made, &names, &mut wrong);
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let ends: Vec<(usize, usize)> = places.iter().map(|(_, from, to)| (*from, *to)).collect();
        let direct: Vec<bool> = made.iter().map(|u| u.unit.passes_through()).collect();
        let blocks = order(made.len(), &ends, &direct, &[]);
        Ok(Self {
            layout,
            units: made,
            names: places.into_iter().map(|(name, ..)| name).collect(),
            blocks,
            unknowns,
            ends,
        })
    }

    /// The same plant with its recycles torn at these streams; refused where they are not enough, or not within one.
    pub fn torn_at(mut self, streams: &[&str]) -> Result<Self, PlantError> {
        let refuse = |stream: &str, why| {
            Err(PlantError::Tear {
                stream: stream.to_owned(),
                why,
            })
        };
        let mut chosen = Vec::new();
        for name in streams {
            match self.stream(name) {
                Some(stream) => chosen.push(stream),
                None => {
                    return Err(PlantError::UnknownStream(
                        (*name).to_owned(),
                        self.names.join(", "),
                    ));
                }
            }
        }
        let direct: Vec<bool> = self.units.iter().map(|u| u.unit.passes_through()).collect();
        self.blocks = order(self.units.len(), &self.ends, &direct, &chosen);
        let torn: Vec<usize> = self.blocks.iter().flat_map(|b| b.tears.clone()).collect();
        if let Some(stream) = chosen.iter().find(|stream| !torn.contains(stream)) {
            return refuse(
                &self.names[*stream],
                "no recycle needs to be torn there; leave it out",
            );
        }
        match torn.iter().find(|stream| !chosen.contains(stream)) {
            Some(stream) => refuse(
                &self.names[*stream],
                "its recycle is not opened by the streams that are named; name it, or another stream of the same recycle",
            ),
            None => Ok(self),
        }
    }

    /// Sets the units' inlets; name and ends of each stream.
    fn connect(
        units: &mut [PlantUnit],
        ports: &[(Vec<String>, Vec<String>)],
        connections: &[Connection],
        streams: usize,
        wrong: &mut Vec<PlantError>,
    ) -> Vec<(String, usize, usize)> {
        let names: Vec<String> = units.iter().map(|u| u.name.clone()).collect();
        let find = |unit: &str, port: &str, out: bool| {
            let Some(index) = names.iter().position(|name| name == unit) else {
                return Err(PlantError::UnknownUnit(unit.to_owned(), names.join(", ")));
            };
            let known = if out {
                &ports[index].1
            } else {
                &ports[index].0
            };
            let place = known.iter().position(|name| name == port);
            place
                .map(|place| (index, place))
                .ok_or_else(|| PlantError::UnknownPort {
                    unit: unit.to_owned(),
                    port: port.to_owned(),
                    ports: if known.is_empty() {
                        "none".into()
                    } else {
                        known.join(", ")
                    },
                })
        };
        let mut left: Vec<Option<(String, usize, usize)>> = vec![None; streams];
        let mut entered: Vec<Vec<Option<usize>>> = ports
            .iter()
            .map(|(inlets, _)| vec![None; inlets.len()])
            .collect();
        for connection in connections {
            let from = find(&connection.from.0, &connection.from.1, true);
            let to = find(&connection.to.0, &connection.to.1, false);
            let (from, to) = match (from, to) {
                (Ok(from), Ok(to)) => (from, to),
                (from, to) => {
                    wrong.extend(from.err());
                    wrong.extend(to.err());
                    continue;
                }
            };
            let stream = units[from.0].outlets.start + from.1;
            let twice = |(unit, port): &(String, String)| PlantError::TakenTwice {
                unit: unit.clone(),
                port: port.clone(),
            };
            if left[stream].is_some() {
                wrong.push(twice(&connection.from));
            }
            if entered[to.0][to.1].is_some() {
                wrong.push(twice(&connection.to));
            }
            left[stream] = Some((connection.name.clone(), from.0, to.0));
            entered[to.0][to.1] = Some(stream);
        }
        let unconnected = |unit: &str, port: &str| PlantError::Unconnected {
            unit: unit.to_owned(),
            port: port.to_owned(),
        };
        for (index, (inlets, outlets)) in ports.iter().enumerate() {
            for (port, stream) in inlets.iter().zip(&entered[index]) {
                match stream {
                    Some(stream) => units[index].inlets.push(*stream),
                    None => wrong.push(unconnected(&names[index], port)),
                }
            }
            for (port, place) in outlets.iter().zip(units[index].outlets.clone()) {
                if left[place].is_none() {
                    wrong.push(unconnected(&names[index], port));
                }
            }
        }
        left.into_iter().flatten().collect()
    }

    /// Finds the signals that units take from others.
    fn hear(units: &mut [PlantUnit], wrong: &mut Vec<PlantError>) {
        for index in 0..units.len() {
            let mut heard = Vec::new();
            for (from, wanted) in units[index].unit.listens_to() {
                let names = || {
                    let names = units.iter().map(|unit| unit.name.as_str());
                    names.collect::<Vec<_>>().join(", ")
                };
                match units.iter().find(|unit| unit.name == from) {
                    Some(other) => match other.unit.signals() {
                        Some((kind, _)) if kind == wanted => heard.push(other.signals.clone()),
                        _ => wrong.push(PlantError::Signals {
                            unit: units[index].name.clone(),
                            from,
                            wanted,
                        }),
                    },
                    None => wrong.push(PlantError::UnknownUnit(from.clone(), names())),
                }
            }
            units[index].heard = heard;
        }
    }

    /// Finds what units measure.
    fn watch(units: &mut [PlantUnit], streams: &[&str], wrong: &mut Vec<PlantError>) {
        let names: Vec<String> = units.iter().map(|unit| unit.name.clone()).collect();
        for unit in units {
            let Some(place) = unit.unit.watches() else {
                continue;
            };
            let found = match place {
                MeasuredPlace::Stream(name) => streams
                    .iter()
                    .position(|own| *own == name)
                    .map(WatchedPlace::Stream)
                    .ok_or_else(|| PlantError::UnknownStream(name.clone(), streams.join(", "))),
                MeasuredPlace::Unit(name) => names
                    .iter()
                    .position(|own| own == name)
                    .map(WatchedPlace::Unit)
                    .ok_or_else(|| PlantError::UnknownUnit(name.clone(), names.join(", "))),
            };
            match found {
                Ok(place) => unit.watched = Some(place),
                Err(error) => wrong.push(error),
            }
        }
    }

    /// Units that stand for beds that are computed elsewhere, by their places.
    pub fn coupled_beds(&self) -> Vec<usize> {
        let units = self.units.iter().enumerate();
        let beds = units.filter(|(_, unit)| unit.unit.coupling().is_some());
        beds.map(|(index, _)| index).collect()
    }

    /// An error where there is such a unit.
    pub(super) fn refuse_beds(&self, what: &'static str) -> Result<(), PlantError> {
        match self.coupled_beds().first() {
            Some(bed) => Err(PlantError::CoupledInTime {
                unit: self.units[*bed].name.clone(),
                what,
            }),
            None => Ok(()),
        }
    }

    /// What streams are made of.
    pub fn layout(&self) -> &StreamLayout {
        &self.layout
    }

    /// Units.
    pub fn units(&self) -> &[PlantUnit] {
        &self.units
    }

    /// Names of the streams.
    pub fn streams(&self) -> &[String] {
        &self.names
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Streams that recycles are torn at.
    pub fn tears(&self) -> Vec<&str> {
        let tears = self.blocks.iter().flat_map(|block| &block.tears);
        tears.map(|stream| self.names[*stream].as_str()).collect()
    }

    /// Index of a stream by its name.
    pub fn stream(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|own| own == name)
    }

    /// Index of a unit by its name.
    pub fn unit(&self, name: &str) -> Option<usize> {
        self.units.iter().position(|unit| unit.name == name)
    }

    /// The unknowns at the start.
    pub fn start(&self) -> Vec<f64> {
        let mut y = vec![0.0; self.unknowns];
        for unit in &self.units {
            unit.unit.start(&self.layout, &mut y[unit.state.clone()]);
        }
        y
    }

    /// Sizes of the unknowns, of which errors count as none in proportion to the tolerance.
    pub fn scales(&self) -> Vec<f64> {
        let mut scales = vec![1.0; self.unknowns];
        for unit in &self.units {
            unit.unit
                .scales(&self.layout, &mut scales[unit.state.clone()]);
        }
        scales
    }

    /// The first time after `time` at which something jumps.
    pub fn next_break(&self, time: f64) -> f64 {
        let breaks = self
            .units
            .iter()
            .filter_map(|unit| unit.unit.next_break(time));
        breaks.fold(f64::INFINITY, f64::min)
    }

    /// Puts back what the unknowns have to fulfil at any time.
    pub fn constrain(&self, y: &mut [f64]) {
        for unit in &self.units {
            unit.unit
                .constrain(&self.layout, &mut y[unit.state.clone()]);
        }
    }

    /// How many combinations of the unknowns never change.
    pub fn invariants(&self) -> usize {
        self.units.iter().map(|unit| unit.unit.invariants()).sum()
    }
}
