//! All values over process time of a case, with their keys.

use calcine_coupler::setup::{GasPatch, InletFlow, Schedule, WallHeat};
use calcine_coupler::time::Ticks;

use super::model::Case;
use super::units::short;

/// Keys and times in s of all schedules with more than one entry.
fn times(case: &Case) -> Vec<(String, Vec<f64>)> {
    let mut all: Vec<(String, Vec<f64>)> = Vec::new();
    let mut add = |key: String, times: Vec<f64>| {
        if times.len() > 1 {
            all.push((key, times));
        }
    };
    let of = |schedule: &Schedule| -> Vec<f64> { schedule.0.iter().map(|entry| entry.0).collect() };
    for (name, patch) in &case.gas.patches {
        let key = |word: &str| format!("gas.patch.{name}.{word}");
        match patch {
            GasPatch::Inlet { flow, .. } => match flow {
                InletFlow::SuperficialVelocity(one) => {
                    add(key("inlet.superficial_velocity"), of(one));
                }
                InletFlow::MassFlow(one) => add(key("inlet.mass_flow"), of(one)),
            },
            GasPatch::Outlet { pressure, .. } => add(key("outlet.pressure"), of(pressure)),
            GasPatch::Opening { pressure, .. } => add(key("opening.pressure"), of(pressure)),
            GasPatch::Wall { heat, .. } => match heat {
                WallHeat::Temperature(one) => add(key("wall.heat.temperature"), of(one)),
                WallHeat::Along(along) => {
                    for (_, one) in &along.stations {
                        add(key("wall.heat.along.stations"), of(one));
                    }
                }
                WallHeat::Flux(one) => add(key("wall.heat.flux"), of(one)),
                WallHeat::Convective {
                    coefficient,
                    ambient,
                } => {
                    add(key("wall.heat.coefficient"), of(coefficient));
                    add(key("wall.heat.ambient"), of(ambient));
                }
                WallHeat::Adiabatic => {}
            },
            GasPatch::Symmetry | GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge => {}
        }
        let table = match patch {
            GasPatch::Inlet { .. } => "inlet",
            GasPatch::Opening { .. } => "opening",
            _ => "outlet.backflow",
        };
        if let Some((temperature, composition)) = patch.entering() {
            add(key(&format!("{table}.temperature")), of(temperature));
            let dated = composition.map(|one| one.0.iter().map(|entry| entry.0).collect());
            add(
                key(&format!("{table}.composition")),
                dated.unwrap_or_default(),
            );
        }
    }
    let walls = case.walls.iter().zip(&case.wall_temperatures);
    for (wall, temperature) in walls {
        if let Some(temperature) = temperature {
            add(format!("walls.{}.temperature", wall.name), of(temperature));
        }
    }
    for body in &case.bodies {
        if let Some(radiation) = &body.radiation {
            let key = format!("bodies.{}.radiation.surroundings", body.name);
            add(key, of(&radiation.surroundings));
        }
    }
    for population in &case.particles {
        if let Some(temperature) = &population.prescribed_temperature {
            let key = format!("particles.{}.prescribed_temperature", population.name);
            add(key, of(temperature));
        }
    }
    let surroundings = case.laws.radiation.as_ref();
    if let Some(one) = surroundings.and_then(|one| one.surroundings.as_ref()) {
        add("laws.radiation.surroundings".into(), of(one));
    }
    all
}

/// Where windows that follow the gas end because a value over time follows another line from there on, and begin anew as the
/// shortest ones: where a ramp begins that is shorter than the longest window, after a course that is not. Ascending.
pub fn breaks(case: &Case) -> [Vec<Ticks>; 2] {
    let (mut breaks, mut jumps) = (Vec::new(), Vec::new());
    let window = case.time.motion_window.seconds();
    for (_, times) in times(case) {
        for (place, &time) in times.iter().enumerate() {
            let within = time > 0.0 && time < case.time.end.seconds();
            let Some(at) = Ticks::from_seconds(time).ok().filter(|_| within) else {
                continue;
            };
            let longest = window * case.time.acceleration.at(at).0;
            let before = place.checked_sub(1).map(|one| time - times[one]);
            let after = times.get(place + 1).map(|next| next - time);
            if after.is_some_and(|after| after < longest)
                && before.is_none_or(|before| before >= longest)
            {
                jumps.push(at);
            }
            breaks.push(at);
        }
    }
    for list in [&mut breaks, &mut jumps] {
        list.sort_unstable();
        list.dedup();
    }
    [breaks, jumps]
}

/// Warnings about schedules that begin before the run or after its end.
pub(super) fn cautions(case: &Case) -> Vec<String> {
    let end = case.time.end.seconds();
    let odd = times(case).into_iter().filter_map(|(key, times)| {
        let first = times[0];
        if first < 0.0 {
            return Some(format!(
                "`{key}` begins at {} s, before the run, whose time begins at 0 s: write times of the run",
                short(first)
            ));
        }
        (first >= end).then(|| {
            format!(
                "`{key}` begins at {} s, but the run ends at {} s: it has its first value all the time; raise `time.end`, or write \
                 earlier times",
                short(first),
                short(end)
            )
        })
    });
    odd.collect()
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    #[test]
    fn windows_end_at_the_entries_of_schedules_and_begin_anew_at_steep_ramps() {
        let ramps = "[[\"0 s\", \"300 K\"], [\"10 s\", \"300 K\"], [\"10.01 s\", \"400 K\"], \
                     [\"20 s\", \"500 K\"], [\"9000 s\", \"500 K\"]]";
        let set = [
            format!("gas.patch.bottom.inlet.temperature={ramps}"),
            "time.motion_window={ min = \"1 ms\", max = \"1 s\", error = 1e-3 }".to_owned(),
            "time.acceleration=2".to_owned(),
        ];
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join("tests/inputs/good/two-populations.toml");
        let case = crate::case::read(&path, &set).unwrap();
        let [breaks, jumps] = super::breaks(&case)
            .map(|list| list.iter().map(|time| time.seconds()).collect::<Vec<f64>>());
        assert_eq!(breaks, [10.0, 10.01, 20.0]);
        assert_eq!(jumps, [10.0]);
    }

    #[test]
    fn a_schedule_that_begins_before_the_run_or_after_its_end_is_told() {
        let set = |from: &str, to: &str| {
            format!(
                "gas.patch.bottom.inlet.temperature=[[\"{from}\", \"400 K\"], [\"{to}\", \"410 K\"]]"
            )
        };
        assert!(said("two-populations", &[&set("0 s", "900 s")]).is_empty());
        let text = one("two-populations", &[&set("600 s", "900 s")]);
        assert!(
            text.starts_with(
                "`gas.patch.bottom.inlet.temperature` begins at 600 s, but the run ends at 600 s"
            ),
            "{text}"
        );
        let text = one("two-populations", &[&set("-5 s", "900 s")]);
        assert!(text.contains("begins at -5 s, before the run"), "{text}");
    }
}
