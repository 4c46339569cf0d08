//! What passed into and out of gas and particles over a run, way by way.

use std::collections::BTreeMap;

use calcine_coupler::flows::{TwoWayFlow, WindowFlows};
use calcine_coupler::mesh::Patch;
use calcine_coupler::part::PatchFlow;
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

/// What passed a patch of the gas mesh: where a window brings and takes, what it brings beyond that.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PatchAmounts {
    /// Name of the patch.
    pub patch: String,
    /// Gas mass in kg.
    pub mass_kg: FlowAmount,
    /// Heat in J: sensible enthalpy, zero at 298.15 K, that flows with the gas, and conduction.
    pub heat_j: FlowAmount,
    /// Mass in kg of each species of a gas mixture.
    pub species_kg: BTreeMap<String, FlowAmount>,
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
    /// What passed each patch, in the order of the mesh; empty of a gas that does not tell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub patches: Vec<PatchAmounts>,
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

    /// Adds what passed the patches of the mesh in a window of so many s of process time.
    pub(super) fn add_patches(
        &mut self,
        patches: &[Patch],
        flows: &[PatchFlow],
        species: &[String],
        span: f64,
    ) {
        if self.patches.is_empty() {
            let named = patches.iter().zip(flows).map(|(patch, _)| PatchAmounts {
                patch: patch.name.clone(),
                ..PatchAmounts::default()
            });
            self.patches.extend(named);
        }
        for (to, flow) in self.patches.iter_mut().zip(flows) {
            to.mass_kg.add(TwoWayFlow::of_net(span * flow.mass));
            to.heat_j.add(TwoWayFlow::of_net(span * flow.heat));
            for (name, flow) in species.iter().zip(&flow.species) {
                let amount = to.species_kg.entry(name.clone()).or_default();
                amount.add(TwoWayFlow::of_net(span * flow));
            }
        }
    }
}
