//! Numbers of a case that are far from those that things have.

use calcine_coupler::interior::reacting::Rate;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::film::FilmDiffusivity;
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::setup::{GasPatch, ParticleSetup};

use super::model::Case;
use super::span;
use super::units::short3;

/// Diffusivities in m²/s that gases have, in pores as in the open.
const DIFFUSIVITY: [f64; 2] = [1e-8, 1e-1];
/// Heat capacities in J/kg/K between which all solids are at the temperatures of beds: that of lead is 129, of lithium 3580, of
/// water 4190.
const HEAT_CAPACITY: [f64; 2] = [50.0, 1e4];
/// Densities in kg/m³ that particles have: from foams to osmium.
const DENSITY: [f64; 2] = [10.0, 22_600.0];
/// Largest order of a reaction that is likely meant.
const HIGHEST_ORDER: f64 = 5.0;
/// Largest gravity in m/s² that is likely meant.
const LARGEST_GRAVITY: f64 = 100.0;
/// Windows that no run makes.
const MANY_WINDOWS: i64 = 1_000_000_000;

/// Warnings, in a fixed order.
pub(super) fn all(case: &Case) -> Vec<String> {
    let mut all = windows(case);
    all.extend(gravity(case));
    all.extend(diffusivities(case));
    all.extend(densities(case));
    all.extend(heat_capacities(case));
    all.extend(orders(case));
    all.extend(built_in(case));
    all.extend(prescribed(case));
    all
}

/// Eddies that the flow through pores makes to grow over a fraction of a particle: cells do not resolve it.
pub(super) fn pores(case: &Case) -> Option<String> {
    (case.laws.bed_eddies.entry().name == "pedras-de-lemos").then(|| {
        "`gas.turbulence.bed`: eddies by pedras-de-lemos grow over √K/(c_k ε), about a third of a diameter, which cells that are as wide as \
         particles do not resolve: the finer the cells, the more eddies the bed has; compare meshes, or take nakayama-kuwahara"
            .to_owned()
    })
}

fn windows(case: &Case) -> Vec<String> {
    // A process step is settled with the mesh.
    let settled =
        case.time.process_step.is_none() || span::is_accelerated(&case.time, [0.0, f64::MAX]);
    let windows = span::windows(&case.time);
    let many = (settled && windows > MANY_WINDOWS).then(|| {
        format!(
            "the run makes {:.1e} windows, which no machine does in a year: check `time.end`, and the window or the step",
            windows as f64
        )
    });
    many.into_iter().collect()
}

fn gravity(case: &Case) -> Vec<String> {
    let gravity = case.gas.gravity;
    let size = gravity.norm();
    let mut all = Vec::new();
    if size > LARGEST_GRAVITY {
        all.push(format!(
            "`gas.gravity` is {} m/s^2 strong, that of the Earth 9.81 m/s^2: check its unit",
            short3(size)
        ));
    }
    if size > 0.0 && gravity.z > 0.5 * size {
        all.push(format!(
            "`gas.gravity` points up, {} m/s^2 along z: write it with a minus if z points up",
            short3(gravity.z)
        ));
    }
    let mut openings = case
        .gas
        .patches
        .iter()
        .filter(|(_, patch)| matches!(patch, GasPatch::Opening { .. }));
    if let Some((name, _)) = openings.next().filter(|_| size == 0.0) {
        all.push(format!(
            "`gas.patch.{name}` is an opening, and there is no gravity: no buoyancy drives gas through it; state `gas.gravity`, for \
             example \"0 0 -9.81 m/s^2\""
        ));
    }
    all
}

fn diffusivities(case: &Case) -> Vec<String> {
    let mut stated: Vec<(String, f64)> = Vec::new();
    if let FilmDiffusivity::Stated(values) = &case.laws.film_diffusivity {
        for value in values.iter().flatten().map(|one| one.value) {
            if stated.iter().all(|(_, other)| *other != value) {
                stated.push(("laws.mass_transfer.diffusivity".into(), value));
            }
        }
    }
    for one in &case.chemistry.reactions {
        if let Rate::Core { diffusivity, .. } = &one.rate {
            let key = format!("reactions.{}.layer_diffusivity", one.name);
            stated.push((key, diffusivity.value));
        }
    }
    let odd = stated
        .into_iter()
        .filter(|(_, value)| *value < DIFFUSIVITY[0] || *value > DIFFUSIVITY[1]);
    odd.map(|(key, value)| {
        format!(
            "`{key}` is {value:e} m^2/s, but gases have {:e} to {:e} m^2/s, in pores as in the open: check its unit, 1 cm^2/s is 1e-4 m^2/s",
            DIFFUSIVITY[0], DIFFUSIVITY[1]
        )
    })
    .collect()
}

fn densities(case: &Case) -> Vec<String> {
    let materials = case.materials.iter();
    let odd = materials.filter(|one| !(DENSITY[0]..=DENSITY[1]).contains(&one.density));
    odd.map(|one| {
        format!(
            "`materials.{}.density` is {} kg/m^3, outside {} to {} kg/m^3, what solids have: check its unit, kg/m^3 and not g/cm^3",
            one.name,
            short3(one.density),
            DENSITY[0],
            DENSITY[1]
        )
    })
    .collect()
}

fn heat_capacities(case: &Case) -> Vec<String> {
    let ends = |(low, high): (f64, f64), at: &dyn Fn(f64) -> f64| {
        let high = if high.is_finite() { high } else { low };
        [at(low).min(at(high)), at(low).max(at(high))]
    };
    let materials = case.materials.iter();
    let materials = materials
        .filter(|one| one.composition.is_none())
        .map(|one| {
            let law: &HeatCapacity = &one.heat_capacity;
            let ends = ends(law.range(), &|kelvin| law.at(kelvin));
            (format!("materials.{}", one.name), ends)
        });
    let solids = case.chemistry.solids.iter();
    let solids = solids
        .filter(|solid| case.materials.iter().all(|one| one.name != solid.name()))
        .map(|solid| {
            let ends = ends(solid.range(), &|kelvin| solid.heat_capacity(kelvin));
            (format!("solids.{}", solid.name()), ends)
        });
    let odd = materials.chain(solids).filter_map(|(key, [least, most])| {
        let value = if least < HEAT_CAPACITY[0] {
            Some((least, "less"))
        } else {
            (most > HEAT_CAPACITY[1]).then_some((most, "more"))
        };
        value.map(|(value, than)| (key, value, than))
    });
    odd.map(|(key, value, than)| {
        format!(
            "`{key}.heat_capacity` is {} J/kg/K, {than} than any solid has: check its unit, J/kg/K and not J/mol/K or kJ/kg/K",
            short3(value)
        )
    })
    .collect()
}

fn orders(case: &Case) -> Vec<String> {
    let of_particles = case.chemistry.reactions.iter().filter_map(|one| {
        let Rate::Power(law) = &one.rate else {
            return None;
        };
        let orders = law.solids.iter().chain(&law.gases);
        let largest = orders.map(|(_, order)| *order).fold(0.0, f64::max);
        Some((one.name.as_str(), largest))
    });
    let reacting = case.gas.chemistry.reacting().into_iter();
    let of_gas = reacting.flat_map(|gas| gas.mechanism.steps()).map(|one| {
        let orders = one.orders.iter().map(|(_, order)| *order);
        (one.name.as_str(), orders.fold(0.0, f64::max))
    });
    let odd = of_particles
        .chain(of_gas)
        .filter(|(_, order)| *order > HIGHEST_ORDER);
    odd.map(|(name, order)| {
        format!(
            "`{name}` has an order of {order}, above {HIGHEST_ORDER}: its rate falls from any to none within little of a concentration; \
             check `orders`"
        )
    })
    .collect()
}

/// Solids of the case's own in the place of built-in ones.
fn built_in(case: &Case) -> Vec<String> {
    let own = case.chemistry.solids.iter().filter(|solid| {
        SolidSpecies::built_in(solid.name()).is_ok_and(|built_in| built_in != **solid)
    });
    own.map(|solid| {
        format!(
            "`solids.{0}` stands in the place of the built-in {0}, with data of its own: give it another name if both are meant",
            solid.name()
        )
    })
    .collect()
}

/// Particles that keep their temperature and give no heat to the gas.
fn prescribed(case: &Case) -> Option<String> {
    let mut held = case.particles.iter();
    let held = held.find(|one| one.prescribed_temperature.is_some())?;
    case.laws.heat_transfer.is_none().then(|| {
        format!(
            "`particles.{}` has a prescribed temperature, but `laws.heat_transfer` is none: it heats no gas; choose a law of heat \
             transfer if it should",
            held.name
        )
    })
}

/// Extents of the mesh over those of the bed, along every axis, from which its lengths are likely in another unit.
const WIDE: f64 = 100.0;
/// Particles from which on a bed has extents.
const BED: usize = 10;

/// A warning of a mesh that is far larger than its bed in every direction.
pub(super) fn wide_mesh(mesh: &Mesh, setup: &ParticleSetup) -> Option<String> {
    if setup.id.len() < BED {
        return None;
    }
    let (mut low, mut high) = (setup.position[0], setup.position[0]);
    for (centre, radius) in setup.position.iter().zip(&setup.radius) {
        low = low.inf(&centre.add_scalar(-radius));
        high = high.sup(&centre.add_scalar(*radius));
    }
    let [from, to] = mesh.bounds();
    let ratio = (to - from).component_div(&(high - low)).min();
    (ratio > WIDE).then(|| {
        format!(
            "the mesh is {} times as wide as its bed along every axis: check the units of its lengths; those of meshes in files are m",
            short3(ratio)
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    /// The warning about a case with a key set.
    fn told(case: &str, set: &str, words: &str) {
        let all = said(case, &[set]);
        assert!(all.iter().any(|one| one.contains(words)), "{set}: {all:?}");
    }

    #[test]
    fn numbers_far_from_what_things_have_are_told() {
        told(
            "calcining-box",
            "reactions.calcination.layer_diffusivity.value=15 m^2/s",
            "`reactions.calcination.layer_diffusivity` is 1.5e1 m^2/s",
        );
        told(
            "two-populations",
            "materials.glass.heat_capacity=0.84 J/kg/K",
            "`materials.glass.heat_capacity` is 0.84 J/kg/K, less",
        );
        told(
            "two-populations",
            "materials.glass.heat_capacity=840 kJ/kg/K",
            "`materials.glass.heat_capacity` is 840000 J/kg/K, more",
        );
        told(
            "reactions",
            "reactions.rust.rate.orders={ Fe = 1, O2 = 7 }",
            "`rust` has an order of 7",
        );
        told(
            "two-populations",
            "time.motion_window=1e-9 s",
            "1.2e10 windows",
        );
        told(
            "prescribed-temperature",
            "laws.heat_transfer.law=none",
            "it heats no gas",
        );
    }

    #[test]
    fn a_gravity_that_is_too_strong_or_points_up_is_told() {
        told("open-box", "gas.gravity=0 0 -981 m/s^2", "981 m/s^2 strong");
        told("open-box", "gas.gravity=0 0 9.81 m/s^2", "points up");
        let text = one("open-box", &["gas.gravity=0 0 0 m/s^2"]);
        assert!(text.contains("there is no gravity"), "{text}");
    }

    #[test]
    fn a_solid_in_the_place_of_a_built_in_one_is_told() {
        let solid = "solids.CaCO3={ formula = \"CaCO3\", formation_enthalpy = \"-1206.9 kJ/mol\", entropy = \"92.9 J/mol/K\", heat_capacity = \"1000 J/kg/K\" }";
        told(
            "calcining-box",
            solid,
            "stands in the place of the built-in CaCO3",
        );
    }
}
