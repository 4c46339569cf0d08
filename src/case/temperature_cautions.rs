//! Temperatures that a case states outside the data of what has them.

use calcine_coupler::interior::reacting::Rate;
use calcine_coupler::physics::moisture::antoine::boiling_temperature;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::setup::{GasPatch, WallHeat};

use super::model::{Case, PlacementSpec, Population};
use super::units::{short3, shown};

/// Temperatures in K beyond which one is likely in another unit, or a slip.
const USUAL: [f64; 2] = [50.0, 5000.0];

/// A temperature that the case states: its key, and the lowest and highest value in K.
struct Stated {
    key: String,
    low: f64,
    high: f64,
}

impl Stated {
    fn new(key: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for value in values {
            (low, high) = (low.min(value), high.max(value));
        }
        Self {
            key: key.into(),
            low,
            high,
        }
    }

    /// The end that is outside a range, if one is.
    fn outside(&self, range: (f64, f64)) -> Option<f64> {
        let mut ends = [self.low, self.high].into_iter();
        ends.rfind(|value| *value < range.0 || *value > range.1)
    }
}

/// Warnings, in a fixed order.
pub(super) fn all(case: &Case) -> Vec<String> {
    let gas = match case.gas.properties.is_vacuum() {
        true => Vec::new(),
        false => of_gas(case),
    };
    let mut all = Vec::new();
    let range = case.gas.properties.temperature_range();
    let data = format!("the species of the gas end at {} K", ends(range));
    all.extend(outside(&gas, range, &data));
    let mut unusual = gas;
    for population in &case.particles {
        let own = of_population(case, population);
        let (range, what) = data_of(case, population.material);
        let data = format!("{what} end at {} K", ends(range));
        all.extend(outside(&own, range, &data));
        unusual.extend(own);
    }
    all.extend(case.particles.iter().filter_map(|one| boils(case, one)));
    unusual.extend(of_walls(case));
    all.extend(strange(&unusual));
    all
}

/// A warning of strange temperatures that files give particles, one value in K for each with its population.
pub(super) fn of_files(case: &Case, population: &[u32], temperature: &[f64]) -> Option<String> {
    let stated: Vec<Stated> = case
        .particles
        .iter()
        .enumerate()
        .filter(|(_, one)| matches!(one.place, PlacementSpec::File { .. }))
        .filter(|(_, one)| one.prescribed_temperature.is_none())
        .filter_map(|(index, one)| {
            let rows = population.iter().zip(temperature);
            let own = rows.filter(|(population, _)| **population as usize == index);
            let values: Vec<f64> = own.map(|(_, value)| *value).collect();
            let other = values.iter().any(|value| *value != one.temperature);
            let key = format!("particles.{}.place.file", one.name);
            other.then(|| Stated::new(key, values))
        })
        .collect();
    strange(&stated)
}

fn ends((low, high): (f64, f64)) -> String {
    format!("{} and {}", shown(low), shown(high))
}

/// One warning for all temperatures outside a range of data.
fn outside(stated: &[Stated], range: (f64, f64), data: &str) -> Option<String> {
    let list = listed(stated, range)?;
    Some(format!(
        "{list}: data of {data}, beyond which the heat capacity stays what it is; state data that reach so far, or check the unit"
    ))
}

/// One warning for temperatures that nothing has.
fn strange(stated: &[Stated]) -> Option<String> {
    let list = listed(stated, (USUAL[0], USUAL[1]))?;
    Some(format!(
        "{list}: below {} K or above {} K; write the unit that is meant, K or degC",
        USUAL[0], USUAL[1]
    ))
}

/// Those outside a range, with their values.
fn listed(stated: &[Stated], range: (f64, f64)) -> Option<String> {
    let found = stated.iter().filter_map(|one| {
        let value = one.outside(range)?;
        Some(format!("`{}` is {} K", one.key, shown(value)))
    });
    let found: Vec<String> = found.collect();
    let more = found.len().saturating_sub(3);
    let shown = found.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
    match more {
        0 => (!shown.is_empty()).then_some(shown),
        _ => Some(format!("{shown} and {more} more")),
    }
}

/// Of the gas at the start, where it comes in and at walls.
fn of_gas(case: &Case) -> Vec<Stated> {
    let mut all = vec![Stated::new(
        "gas.initial.temperature",
        [case.gas.temperature],
    )];
    for (name, patch) in &case.gas.patches {
        if let GasPatch::Wall {
            heat: WallHeat::Along(along),
            ..
        } = patch
        {
            let stations = along.stations.iter();
            let values =
                stations.flat_map(|(_, over_time)| over_time.0.iter().map(|entry| entry.1));
            all.push(Stated::new(format!("gas.patch.{name}"), values));
        }
        let schedule = match patch {
            GasPatch::Wall {
                heat: WallHeat::Temperature(over_time),
                ..
            } => Some(over_time),
            GasPatch::Wall {
                heat: WallHeat::Convective { ambient, .. },
                ..
            } => Some(ambient),
            _ => patch.entering().map(|one| one.0),
        };
        let values = schedule.map(|over_time| over_time.0.iter().map(|entry| entry.1));
        all.extend(values.map(|values| Stated::new(format!("gas.patch.{name}"), values)));
    }
    all
}

/// A warning of water that is above its boiling point when the run begins.
fn boils(case: &Case, population: &Population) -> Option<String> {
    let chemistry = &case.chemistry;
    let start = chemistry.compositions.get(population.material)?;
    let wet = chemistry.reactions.iter().any(|one| {
        matches!(one.rate, Rate::Evaporation(_))
            && one
                .solids
                .iter()
                .any(|&(s, n)| n < 0.0 && start.get(s).is_some_and(|y| *y > 0.0))
    });
    let boiling = boiling_temperature(case.gas.pressure);
    let begins = population.prescribed_temperature.is_none() && wet;
    (begins && population.temperature > boiling).then(|| {
        format!(
            "`particles.{}.temperature` is {} K, above the {} K at which its water boils: it flashes in the first window, which may not be \
             resolved; begin below, or shorten {}",
            population.name,
            shown(population.temperature),
            short3(boiling),
            match case.time.process_step {
                Some(_) => "`time.process_step`",
                None => "`time.motion_window`",
            }
        )
    })
}

/// Of walls and surroundings that particles conduct and radiate to.
fn of_walls(case: &Case) -> Vec<Stated> {
    let walls = case.walls.iter().zip(&case.wall_temperatures);
    let walls = walls.filter_map(|(wall, over_time)| {
        let values = over_time.as_ref()?.0.iter().map(|entry| entry.1);
        Some(Stated::new(
            format!("walls.{}.temperature", wall.name),
            values,
        ))
    });
    let radiation = case.laws.radiation.as_ref();
    let around = radiation.and_then(|one| one.surroundings.as_ref());
    let around = around.map(|over_time| {
        let values = over_time.0.iter().map(|entry| entry.1);
        Stated::new("laws.radiation.surroundings", values)
    });
    walls.chain(around).collect()
}

/// Of particles at the start, as prescribed, and as they are fed.
fn of_population(case: &Case, population: &Population) -> Vec<Stated> {
    let name = &population.name;
    let index = case.particles.iter().position(|one| one.name == *name);
    let mut all = match &population.prescribed_temperature {
        Some(over_time) => vec![Stated::new(
            format!("particles.{name}.prescribed_temperature"),
            over_time.0.iter().map(|entry| entry.1),
        )],
        None => vec![Stated::new(
            format!("particles.{name}.temperature"),
            [population.temperature],
        )],
    };
    let feeds = case
        .feeds
        .iter()
        .filter(|feed| Some(feed.population) == index);
    all.extend(feeds.map(|feed| {
        Stated::new(
            format!("feeds.{}.temperature", feed.name),
            [feed.temperature],
        )
    }));
    all
}

/// Where the data of a material hold, and whose they are.
fn data_of(case: &Case, material: usize) -> ((f64, f64), String) {
    let spec = &case.materials[material];
    let whole = (spec.heat_capacity.range(), format!("`{}`", spec.name));
    let Some(own) = case.chemistry.compositions.get(material) else {
        return whole;
    };
    let held = case.chemistry.solids.iter().zip(own);
    let held = held.filter(|(_, share)| **share > 0.0).map(|one| one.0);
    let narrowest = held.reduce(|one, other| {
        let width = |solid: &SolidSpecies| solid.range().1 - solid.range().0;
        if width(other) < width(one) {
            other
        } else {
            one
        }
    });
    narrowest.map_or(whole, |solid| {
        let what = format!("{} in `{}`", solid.name(), spec.name);
        (solid.range(), what)
    })
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    #[test]
    fn particles_hotter_than_the_data_of_their_solids_are_told() {
        let text = one("calcining-box", &["particles[0].temperature=3000 K"]);
        assert!(
            text.starts_with("`particles.stones.temperature` is 3000 K: data of CaCO3 in `limestone` end at 298.15 and 1200 K"),
            "{text}"
        );
        assert!(said("calcining-box", &["particles[0].temperature=1190 K"]).is_empty());
    }

    #[test]
    fn gas_hotter_than_its_species_is_told_wherever_it_is_stated() {
        let set =
            ["gas.patch.bottom.inlet.temperature=[[\"0 s\", \"900 K\"], [\"1 s\", \"6200 K\"]]"];
        let told = said("reactions", &set);
        assert!(
            told[0].starts_with(
                "`gas.patch.bottom` is 6200 K: data of the species of the gas end at 200 and 6000 K"
            ),
            "{told:?}"
        );
        assert!(told[1].contains("above 5000 K"), "{told:?}");
    }

    #[test]
    fn temperatures_that_nothing_has_are_told() {
        let text = one("closed-box", &["gas.initial.temperature=20 K"]);
        assert!(
            text.starts_with("`gas.initial.temperature` is 20 K: below 50 K or above 5000 K"),
            "{text}"
        );
    }
}
