//! What measures may name.

use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::bodies::HeatBody;
use calcine_coupler::feeds::Outlet;
use calcine_coupler::motion::Wall;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::setup::{GasPatch, Schedule};

use super::common::patches;
use crate::case::model::{MaterialSpec, MeshSpec, Population, Probe};
use crate::case::table::TableReader;

/// What a measure may name.
pub(super) struct Known<'a> {
    pub mesh: Option<&'a MeshSpec>,
    pub populations: Option<&'a [Population]>,
    pub materials: &'a [MaterialSpec],
    pub probes: &'a [Probe],
    /// Walls, with the temperatures of those that have one.
    pub walls: &'a [(Wall, Option<Schedule>)],
    pub bodies: &'a [HeatBody],
    pub species: &'a [String],
    /// None where a reaction could not be read: what it would make is not known.
    pub solids: Option<&'a [SolidSpecies]>,
    /// Mass fractions of the solids that each material is made of.
    pub compositions: &'a [Vec<f64>],
    /// In m/s²; none where the gas could not be read.
    pub gravity: Option<Vec3>,
    /// Conditions of the gas.
    pub patches: &'a [(String, GasPatch)],
    /// True of a gas that stays as it is.
    pub held: bool,
    /// The program that computes the gas where that is OpenFOAM.
    pub solver: StockSolver,
    pub outlets: &'a [Outlet],
    /// True where particles come in.
    pub feeds: bool,
}

/// Refuses a patch that the mesh lacks, where the case itself knows them.
pub(super) fn check_patch(
    reader: &TableReader<'_>,
    key: &str,
    name: &str,
    mesh: Option<&MeshSpec>,
) {
    if let Some(known) = patches(mesh)
        && !known.contains(&name)
    {
        let rule = format!("names \"{name}\", which is not a patch of the mesh");
        reader.fail(key, rule, format!("the patches are {}", known.join(", ")));
    }
}

/// The name of a probe that there is.
pub(super) fn checked_probe(
    reader: &TableReader<'_>,
    name: &str,
    known: &Known<'_>,
) -> Option<String> {
    if known.probes.iter().any(|probe| probe.name == name) {
        return Some(name.into());
    }
    let names: Vec<&str> = known.probes.iter().map(|p| p.name.as_str()).collect();
    let help = match names[..] {
        [] => "the case has no [[probes]]".into(),
        _ => format!("the probes are {}", names.join(", ")),
    };
    reader.fail("probe", format!("is \"{name}\""), help);
    None
}
