//! `units.bed`.

use std::path::{Path, PathBuf};

use calcine_flowsheet::units::CoupledBedUnit;
use calcine_flowsheet::{BedCoupling, ProcessUnit, StreamLayout};

use super::granulator::quantities;
use crate::case::model::Case;
use crate::case::table::TableReader;
use crate::case::units::{Dimension, shown};

/// Most that heat capacities of a material and its compound may differ, relatively.
const ALIKE: f64 = 1e-9;

/// A bed of the plant.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantBedSpec {
    /// Name of the unit.
    pub unit: String,
    /// The bed's case file.
    pub case: PathBuf,
    /// SHA-256 of its values.
    pub hash: String,
    /// Time in s between two exchanges.
    pub interval: f64,
    /// Its feeds, in the order of its case.
    pub feeds: Vec<PlantBedFeed>,
    /// Compound of each of its populations.
    pub compounds: Vec<usize>,
    /// Diameters in m of its kernel.
    pub diameters: Vec<f64>,
    /// Share of the mean diameter within which pairs count.
    pub gap: f64,
}

/// A feed of a bed.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantBedFeed {
    /// Name.
    pub name: String,
    /// Population that it draws.
    pub population: usize,
    /// Compound that it takes from the plant.
    pub compound: usize,
    /// Size class that waits for it: that of its mean diameter.
    pub class: usize,
    /// Mean diameter in m.
    pub diameter: f64,
    /// Mass in kg of its largest particle.
    pub largest: f64,
}

/// The unit, and what its run needs. Without a folder the bed's case is not read: of results the flowsheet is known without.
pub(super) fn bed(
    own: &TableReader<'_>,
    name: &str,
    layout: &StreamLayout,
    folder: Option<&Path>,
) -> Option<(Box<dyn ProcessUnit>, PlantBedSpec)> {
    let (case, interval) = (own.text("case"), own.number("interval"));
    let (diameters, gap) = match own.has("kernel") {
        false => (Some(Vec::new()), Some(0.0)),
        true => own.table("kernel").map_or((None, None), |table| {
            let diameters = quantities(&table, "diameters", Dimension::LENGTH);
            let gap = table.number("gap");
            table.finish();
            let rises = |d: &Vec<f64>| {
                d.windows(2).all(|pair| pair[0] < pair[1]) && d.first().is_some_and(|d| *d > 0.0)
            };
            if diameters.as_ref().is_some_and(|d| !rises(d)) {
                let help = "give one diameter or more, above zero and rising";
                table.fail("diameters", "are no rising diameters", help);
            }
            (diameters.filter(rises), gap)
        }),
    };
    let mut spec = PlantBedSpec {
        unit: name.to_owned(),
        case: folder.unwrap_or(Path::new("")).join(case?),
        hash: String::new(),
        interval: interval?,
        feeds: Vec::new(),
        compounds: Vec::new(),
        diameters: diameters?,
        gap: gap?,
    };
    if folder.is_some() {
        match crate::case::read(&spec.case, &[]) {
            Ok(bed) => fits(own, layout, &bed, &mut spec)?,
            Err(errors) => {
                let first = errors.problems().first();
                let message = first.map_or(String::new(), |one| one.message.clone());
                let count = errors.problems().len();
                let more = match count {
                    0 | 1 => String::new(),
                    _ => format!(", and {} more", count - 1),
                };
                let rule = format!("cannot be used: {message}{more}");
                let help = "`calcine check` of that file shows all that is wrong with it";
                own.fail("case", rule, help);
                return None;
            }
        }
    }
    let unit = CoupledBedUnit {
        coupling: BedCoupling {
            interval: spec.interval,
            feeds: spec.feeds.len(),
            diameters: spec.diameters.clone(),
        },
    };
    Some((Box::new(unit), spec))
}

/// Whether a bed's case can be a unit of this plant: its feeds and compounds, or all that is in the way.
fn fits(
    own: &TableReader<'_>,
    layout: &StreamLayout,
    bed: &Case,
    spec: &mut PlantBedSpec,
) -> Option<()> {
    let mut good = true;
    let mut refuse = |rule: String, help: &str| {
        own.fail("case", rule, help);
        good = false;
    };
    if !layout.attributes().is_empty() {
        let rule = "is a bed, which does not know attributes of particles".into();
        refuse(rule, "remove `attributes`, or put a bunker in its place");
    }
    if bed.feeds.is_empty() {
        let rule = "names a bed without a feed".into();
        refuse(rule, "add [[feeds]] to it for what flows in");
    }
    if bed.outlets.is_empty() {
        let rule = "names a bed without an outlet".into();
        refuse(rule, "add [[outlets]] to it for what flows out");
    }
    if bed.time.checkpoint_every.is_some() || bed.time.checkpoint_wall.is_some() {
        let rule = "names a bed with `time.checkpoint`".into();
        refuse(
            rule,
            "remove that: its checkpoints go with those of the plant",
        );
    }
    if !bed.chemistry.reactions.is_empty() {
        let rule = "names a bed with reactions, whose solids change".into();
        refuse(
            rule,
            "remove `reactions` from it: solids of a plant's bed keep their mass",
        );
    }
    let names: Vec<&str> = layout.compounds().iter().map(|c| c.name.as_str()).collect();
    let mut compounds = Vec::new();
    for population in &bed.particles {
        let material = &bed.materials[population.material];
        let found = names.iter().position(|name| *name == material.name);
        let Some(compound) = found else {
            let rule = format!(
                "names a bed of the material \"{}\", which is no compound of this plant",
                material.name
            );
            let help = format!("give both one name: the compounds are {}", names.join(", "));
            refuse(rule, &help);
            continue;
        };
        compounds.push(compound);
        let heat = layout.compounds()[compound].solid_heat_capacity;
        let [cold, hot] = [200.0, 2000.0].map(|kelvin| material.heat_capacity.at(kelvin));
        if (cold - heat).abs() > ALIKE * heat || (hot - heat).abs() > ALIKE * heat {
            let rule = match cold == hot {
                true => format!(
                    "names a bed whose \"{}\" has a heat capacity of {} J/kg/K, here it has {} J/kg/K",
                    material.name,
                    shown(cold),
                    shown(heat)
                ),
                false => format!(
                    "names a bed whose \"{}\" has a heat capacity that depends on temperature",
                    material.name
                ),
            };
            refuse(rule, "give the material and the compound one heat capacity");
        }
        if population.prescribed_temperature.is_some() {
            let rule = format!(
                "names a bed whose particles \"{}\" have a prescribed temperature",
                population.name
            );
            refuse(
                rule,
                "remove `prescribed_temperature`: what is fed comes as warm as the plant has it",
            );
        }
        let grid = layout.grid();
        let (from, to) = grid.range();
        let (small, large) = (population.sizes.smallest(), population.sizes.largest());
        if small < from || large >= to {
            let rule = format!(
                "names a bed whose particles \"{}\" have {} m to {} m, beyond the size grid of {} m to {} m",
                population.name,
                shown(small),
                shown(large),
                shown(from),
                shown(to)
            );
            refuse(rule, "widen `sizes`");
        }
    }
    if !good || compounds.len() != bed.particles.len() {
        return None;
    }
    for feed in &bed.feeds {
        let population = &bed.particles[feed.population];
        let diameter = population
            .sizes
            .mean()
            .unwrap_or(population.sizes.largest());
        let edges = layout.grid().edges();
        let class = edges.partition_point(|edge| *edge <= diameter).max(1) - 1;
        let density = bed.materials[population.material].density;
        let radius = 0.5 * population.sizes.largest();
        let sphere = calcine_coupler::physics::sphere::mass(radius, density);
        let made = PlantBedFeed {
            name: feed.name.clone(),
            population: feed.population,
            compound: compounds[feed.population],
            class: class.min(layout.grid().classes() - 1),
            diameter,
            largest: population.weight * sphere,
        };
        if feed.batch > 0.0 {
            let rule = format!("names a bed whose feed \"{}\" has a batch", feed.name);
            own.fail(
                "case",
                rule,
                "remove `batch`: what it feeds comes from the plant",
            );
            good = false;
        }
        let same = |one: &PlantBedFeed| (one.compound, one.class) == (made.compound, made.class);
        if let Some(other) = spec.feeds.iter().find(|one| same(one)) {
            let rule = format!(
                "names a bed whose feeds \"{}\" and \"{}\" are of one compound and size class",
                other.name, made.name
            );
            own.fail(
                "case",
                rule,
                "give each a population of its own size, or remove one",
            );
            good = false;
        }
        spec.feeds.push(made);
    }
    spec.compounds = compounds;
    spec.hash.clone_from(&bed.hash);
    good.then_some(())
}
