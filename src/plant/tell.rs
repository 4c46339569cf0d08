//! What `check` says of a plant, and what `run` says at its end.

use std::fmt::Write as _;

use calcine_flowsheet::{Plant, PlantRun};

use super::error::PlantRunError;
use super::measure::field;
use super::summary::{PlantMode, PlantSummary, PlantTuningSummary};
use crate::case::plant::{PlantCase, PlantField};
use crate::case::units::{short, short3};
use crate::simulation::SimulationError;
use crate::valid::ValidCase;

/// The plant of a case as text: sizes, method, recycles, units with their streams at the start.
pub fn plant_check(case: &PlantCase) -> Result<String, PlantRunError> {
    let plant = &case.plant;
    let layout = plant.layout();
    let grid = layout.grid();
    let (from, to) = grid.range();
    let mut text = format!("{} ({})\n", case.title, case.path.display());
    for change in &case.changes {
        let _ = writeln!(text, "  set            {change}");
    }
    let rows = (case.end / case.row_every).ceil();
    let _ = writeln!(
        text,
        "  time           {} s, {rows} rows of the series, one each {} s",
        short(case.end),
        short(case.row_every)
    );
    let _ = writeln!(
        text,
        "  method         recycles {}, integrator {}, tolerance {:e}",
        case.method.recycles(),
        case.method.integrator(),
        case.method.tolerance
    );
    let _ = writeln!(
        text,
        "  sizes          {} classes from {} mm to {} mm",
        grid.classes(),
        short(1e3 * from),
        short(1e3 * to)
    );
    let compounds: Vec<&str> = layout.compounds().iter().map(|c| c.name.as_str()).collect();
    let _ = writeln!(text, "  compounds      {}", compounds.join(", "));
    for attribute in layout.attributes() {
        let _ = writeln!(
            text,
            "  attribute      {}, {} classes",
            attribute.name, attribute.classes
        );
    }
    let _ = writeln!(
        text,
        "  unknowns       {} in {} units; {} streams of {} numbers",
        plant.unknowns(),
        plant.units().len(),
        plant.streams().len(),
        layout.width()
    );
    let tears = plant.tears();
    let _ = match tears[..] {
        [] => writeln!(text, "  recycles       none that closes at once"),
        _ => writeln!(
            text,
            "  recycles       torn at {}",
            tears
                .iter()
                .map(|tear| format!("\"{tear}\""))
                .collect::<Vec<_>>()
                .join(", ")
        ),
    };
    for bed in &case.beds {
        let own = ValidCase::open(&bed.case, &[]).map_err(SimulationError::from)?;
        let all = &own.prepared.particles;
        let mass = all.radius.iter().zip(&all.density).enumerate();
        let mass = mass.map(|(row, (radius, density))| {
            let weight = all.weight.get(row).copied().unwrap_or(1.0);
            weight * calcine_coupler::physics::sphere::mass(*radius, *density)
        });
        let feeds: Vec<&str> = bed.feeds.iter().map(|feed| feed.name.as_str()).collect();
        let _ = writeln!(
            text,
            "  bed            \"{}\": {} particles, {} kg, of {}, fed by {}; exchanged each {} s",
            bed.unit,
            all.id.len(),
            short3(mass.sum()),
            bed.case.display(),
            feeds.join(", "),
            short(bed.interval)
        );
    }
    if let Some(spec) = &case.continuation {
        let _ = writeln!(
            text,
            "  continuation   {} values of {}",
            spec.values.len(),
            spec.keys.join(", ")
        );
    }
    // Recycles are closed at the start, as a run does: what does not converge is told here.
    let run = PlantRun::new(plant, case.method.integrator, case.method.tolerance)?;
    let _ = writeln!(
        text,
        "  flowsheet at the start, in the order of computation (* torn stream):"
    );
    let order: Vec<usize> = plant
        .order()
        .flat_map(|(units, _)| units.to_vec())
        .collect();
    for unit in order {
        draw_unit(&mut text, case, &run, plant, unit, &tears);
    }
    Ok(text)
}

fn draw_unit(
    text: &mut String,
    case: &PlantCase,
    run: &PlantRun<'_>,
    plant: &Plant,
    unit: usize,
    tears: &[&str],
) {
    let own = &plant.units()[unit];
    let [_, outlets] = own.ports();
    let mut head = format!("    [{}] {}", own.name, case.kinds[unit]);
    // What a bed holds is known once it is made.
    if plant.holds(unit) && case.kinds[unit] != "bed" {
        let held = run.held_by(unit);
        let mass = plant.layout().mass_flow(&held);
        let _ = write!(head, ", holds {} kg", short(mass));
        let d = field(plant.layout(), &held, PlantField::Quantile(50), None);
        if d.is_finite() {
            let _ = write!(head, ", d50 {} mm", short3(1e3 * d));
        }
    }
    let _ = writeln!(text, "{head}");
    for (port, stream) in outlets.iter().zip(own.leaving()) {
        let name = &plant.streams()[stream];
        let to = plant.ends_of(stream).1;
        let entered = &plant.units()[to];
        let [inlets, _] = entered.ports();
        let place = entered.entering().iter().position(|own| *own == stream);
        let inlet = place.map_or("", |place| inlets[place].as_str());
        let star = if tears.contains(&name.as_str()) {
            "*"
        } else {
            ""
        };
        let state = run.stream(stream);
        let mut flow = format!("{} kg/s", short3(plant.layout().mass_flow(state)));
        let d = field(plant.layout(), state, PlantField::Quantile(50), None);
        if d.is_finite() {
            let _ = write!(flow, ", d50 {} mm", short3(1e3 * d));
        }
        let _ = writeln!(
            text,
            "      {port} --{name}{star}--> [{}] {inlet}   ({flow})",
            entered.name
        );
    }
}

/// A mode in words.
fn mode(mode: &PlantMode) -> String {
    let rate = format!("growth rate {:.4e} 1/s", mode.growth_rate_per_s);
    match mode.period_s {
        Some(period) => format!("{rate}, period {} s", short(period)),
        None => format!("{rate}, no oscillation"),
    }
}

/// The closing lines of a run: quantities, stability, the ledger, the time.
pub fn plant_closing(summary: &PlantSummary) -> String {
    let mut text = format!(
        "{}: {} s of the plant in {:.2} s, {} steps\n",
        summary.case.name,
        short(summary.time_s),
        summary.wall_time_s,
        summary.steps
    );
    for (name, quantity) in &summary.quantities {
        let (value, unit) = match quantity.value {
            Some(value) => (printed(value), quantity.unit.as_str()),
            None => ("none".to_owned(), ""),
        };
        let reason = quantity.reason(summary.time_s);
        let _ = writeln!(
            text,
            "  {name:24} {value:>16} {unit:8} {}{}",
            quantity.verdict.word(),
            reason.map(|words| format!(": {words}")).unwrap_or_default()
        );
    }
    if let Some(steady) = &summary.steady {
        let _ = writeln!(
            text,
            "  steady state             {} iterations; the end of the run is {:.2e} of the hold-up away",
            steady.iterations, steady.distance
        );
    }
    if let Some(why) = &summary.not_steady {
        let _ = writeln!(text, "  steady state             {why}");
    }
    if let Some(stability) = &summary.stability {
        let word = match stability.growth_rate_per_s {
            rate if rate < 0.0 => "stable",
            0.0 => "neutral, what is there stays",
            _ => "not stable",
        };
        let _ = writeln!(
            text,
            "  stability                {word}: {}",
            mode(stability)
        );
    }
    if let Some(states) = &summary.continuation {
        let unit = format!(" {}", states.unit);
        let unit = unit.trim_end();
        for point in &states.points {
            let _ = writeln!(
                text,
                "  at {:<21} {}",
                format!("{}{unit}", short(point.value)),
                mode(&point.mode)
            );
        }
        for limit in &states.limits {
            let _ = writeln!(
                text,
                "  limit of stability       {}{unit}, {}",
                short(limit.value),
                mode(&limit.mode)
            );
        }
        if states.limits.is_empty() {
            let _ = writeln!(text, "  limit of stability       none between these values");
        }
    }
    if let Some(tuning) = &summary.tuning {
        tuned(&mut text, tuning);
    }
    for line in summary.ledger.lines.iter().filter(|l| l.place == "plant") {
        let _ = writeln!(
            text,
            "  ledger {:17} {:>16.3e} relative error",
            line.what, line.relative_error
        );
    }
    let _ = writeln!(
        text,
        "  ledger {:17} {:>16.3e} largest of all units",
        "units", summary.ledger.largest_relative_error
    );
    for (stream, apart) in &summary.ledger.tears {
        let _ = writeln!(
            text,
            "  ledger {:17} {apart:>16.3e} largest difference from itself, relative to its flow",
            format!("tear {stream}")
        );
    }
    text.trim_end().to_owned()
}

/// The keys that were tuned, and how quantities depend on them.
fn tuned(text: &mut String, tuning: &PlantTuningSummary) {
    for one in &tuning.parameters {
        let ends = [0, 1].map(|end| match one.open[end] {
            true if one.interval[end] == one.bounds[end] => "bound".to_owned(),
            true => format!("{}, where trials fail", printed(one.interval[end])),
            false => printed(one.interval[end]),
        });
        let _ = writeln!(
            text,
            "  tuned {:18} {} {} ({} to {}, {:.0} %)",
            one.key,
            printed(one.value),
            one.unit,
            ends[0],
            ends[1],
            100.0 * tuning.level
        );
    }
    for (name, deviation) in &tuning.deviations {
        let _ = writeln!(
            text,
            "  fit of {name:17} {} standard deviations",
            short3(*deviation)
        );
    }
    for (one, other, by) in &tuning.correlated {
        let [one, other] =
            [one, other].map(|k| tuning.parameters.get(*k).map_or("", |p| p.key.as_str()));
        let _ = writeln!(
            text,
            "  {one} and {other} cannot be told apart: their errors go together by {by:.3}"
        );
    }
    if let Some(failure) = &tuning.failure {
        let _ = writeln!(
            text,
            "  {} of {} trials failed, as {failure}",
            tuning.failed, tuning.trials
        );
    }
    if let Some(cause) = &tuning.not_sensitive {
        let _ = writeln!(text, "  no derivatives beside what was found: {cause}");
    }
    for one in &tuning.sensitivities {
        for (key, slope) in tuning.parameters.iter().zip(&one.by) {
            let per = if key.unit.is_empty() { "1" } else { &key.unit };
            let _ = writeln!(
                text,
                "  d {} / d {}: {:.4e} {} per {per}",
                one.quantity, key.key, slope, one.unit
            );
        }
    }
}

/// A quantity as a terminal shows it.
pub(super) fn printed(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e9).contains(&value.abs());
    match plain {
        true => format!("{value:.6}"),
        false => format!("{value:.6e}"),
    }
}
