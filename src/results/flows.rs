//! What passed into and out of gas and particles over a run, way by way.

use std::collections::BTreeMap;

use calcine_coupler::flows::{TwoWayFlow, WindowFlows};
use serde::{Deserialize, Serialize};

/// What went one way and the other over the run, both positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlowAmount {
    /// Into the balance.
    pub inward: f64,
    /// Out of it.
    pub outward: f64,
}

impl FlowAmount {
    fn add(&mut self, flow: TwoWayFlow) {
        self.inward += flow.inward;
        self.outward += flow.outward;
    }
}

/// The amounts of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlowSummary {
    /// Process time over which they are summed, in s.
    pub over_s: f64,
    /// Gas mass in kg: `boundary`, `reservoir`, `sources`, `particles`, `storage`.
    pub mass_kg: BTreeMap<String, FlowAmount>,
    /// Energy of gas and particles in J: `boundary`, `reservoir`, `sources`, `walls`, `prescribed_heat`, `radiated`,
    /// `particles`, `gas_storage`, `body_storage`.
    pub energy_j: BTreeMap<String, FlowAmount>,
    /// Mass in kg of each species of a gas mixture through the boundary.
    pub species_kg: BTreeMap<String, FlowAmount>,
}

impl FlowSummary {
    /// Adds a window of so many s of process time.
    pub(super) fn add(&mut self, flows: &WindowFlows, species: &[String], span: f64) {
        self.over_s += span;
        for (to, from) in [
            (&mut self.mass_kg, &flows.mass),
            (&mut self.energy_j, &flows.energy),
        ] {
            for (name, flow) in from {
                to.entry((*name).to_owned()).or_default().add(*flow);
            }
        }
        for (name, flow) in species.iter().zip(&flows.species) {
            self.species_kg.entry(name.clone()).or_default().add(*flow);
        }
    }
}
