//! The tables: all runs, and the processor time of each solver at equal error.

use super::case::{ErrorCase, Resolution};
use super::field::MeanField;
use super::front::{Front, Point, TimeAt, levels};
use crate::measure::Cost;
use crate::table::{Table, short};

/// What one run gave.
#[derive(Clone, Debug)]
pub struct ErrorRow {
    pub solver: String,
    pub resolution: Resolution,
    /// Threads or ranks.
    pub cores: usize,
    pub cost: Cost,
    /// Processor time in s of the gas' phases, where Calcine tells it.
    pub gas: Option<f64>,
    /// Outer and linear iterations of a window, where Calcine tells them.
    pub iterations: Option<[f64; 2]>,
    /// Fields on the coarsest mesh, where it came to its end.
    pub fields: Option<Vec<MeanField>>,
    /// Relative errors, one a quantity.
    pub errors: Vec<f64>,
}

/// What stands above the tables.
pub fn head() -> String {
    "# Error against processor time of gases\n\n\
     Processor time: user and system of the whole process and those it started, by `getrusage`; `of the gas`: that of the \
     gas' phases by Calcine's summary. Errors: root mean square over cells, of means over the cells of the coarsest mesh, \
     relative to the reference. `loose`: `outer_tolerance = 1e-4`, `linear_tolerance = 1e-8`; `two stages`: \
     `time_scheme = \"sdirk2\"`. Times at equal error are \
     interpolated in logarithms along each solver's best runs on one core; in brackets multiples of OpenFOAM's own solver; \
     `≤`: its cheapest run is more accurate.\n"
        .to_owned()
}

/// The tables of a case.
pub fn tables(case: &ErrorCase, reference: &[MeanField], rows: &[ErrorRow]) -> String {
    let mut text = format!("\n## {}\n\n{}", case.name, runs(case, rows));
    for at in 0..case.quantities.len() {
        let table = equal_errors(case, rows, at);
        text += &format!("\n{table}");
    }
    let distances: Vec<String> = solvers(rows)
        .into_iter()
        .filter_map(|solver| {
            let own = own_limit(rows, solver)?;
            let errors = case.errors(&own, reference).into_iter().map(percent);
            Some(format!(
                "{solver} {}",
                errors.collect::<Vec<_>>().join(", ")
            ))
        })
        .collect();
    if !distances.is_empty() {
        text += "\nWhat a solver's own runs converge to (its two finest meshes, first order in the step, second in the cell) \
                 differs from the reference by: ";
        text += &distances.join("; ");
        text += ".\n";
    }
    text
}

/// Names of the solvers in the order of their first rows.
fn solvers(rows: &[ErrorRow]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.solver.as_str()) {
            names.push(&row.solver);
        }
    }
    names
}

/// What the runs of a solver converge to: those on its two finest meshes without the errors of their steps, of first order and
/// known from two runs on one mesh, and then without those of their cells, of second order. Where this differs from the
/// reference, so much of the errors is not known.
fn own_limit(rows: &[ErrorRow], solver: &str) -> Option<Vec<MeanField>> {
    let done = |row: &&ErrorRow| row.solver == solver && row.cores == 1 && row.fields.is_some();
    let mut own: Vec<&ErrorRow> = rows.iter().filter(done).collect();
    own.sort_by(|one, other| {
        let (one, other) = (one.resolution, other.resolution);
        other
            .factor
            .cmp(&one.factor)
            .then(one.step.total_cmp(&other.step))
    });
    let fine = own.first()?;
    let coarse = own
        .iter()
        .find(|row| row.resolution.factor < fine.resolution.factor)?;
    let pair = own
        .windows(2)
        .find(|pair| pair[0].resolution.factor == pair[1].resolution.factor)?;
    let (short, long) = (pair[0], pair[1]);
    let apart = long.resolution.step - short.resolution.step;
    let limit = |at: usize| {
        let field = |row: &ErrorRow| row.fields.as_ref()?.get(at).cloned();
        let (brief, late) = (field(short)?, field(long)?);
        let without_step = |row: &ErrorRow| {
            let share = row.resolution.step / apart;
            Some(MeanField::sum(&[
                (1.0, &field(row)?),
                (share, &brief),
                (-share, &late),
            ]))
        };
        let ratio = fine.resolution.factor as f64 / coarse.resolution.factor as f64;
        let weight = 1.0 / (ratio * ratio - 1.0);
        let terms = [
            (1.0 + weight, &without_step(fine)?),
            (-weight, &without_step(coarse)?),
        ];
        Some(MeanField::sum(&terms))
    };
    (0..fine.errors.len()).map(limit).collect()
}

/// All runs.
fn runs(case: &ErrorCase, rows: &[ErrorRow]) -> Table {
    let errors: Vec<String> = case
        .quantities
        .iter()
        .map(|quantity| format!("error of {}", quantity.name))
        .collect();
    let mut head = [
        "solver",
        "cells",
        "step",
        "threads or ranks",
        "processor time",
        "of the gas",
        "wall time",
        "outer and linear iterations a window",
    ]
    .map(str::to_owned)
    .to_vec();
    head.extend(errors);
    head.push("peak memory per cell".to_owned());
    let mut table = Table::of(head);
    for row in rows {
        let [nx, ny] = case.cells(row.resolution);
        let mut cells = vec![
            row.solver.clone(),
            format!("{nx} × {ny}"),
            format!("{}s", short(row.resolution.step)),
            row.cores.to_string(),
            format!("{}s", short(row.cost.processor)),
            row.gas
                .map_or_else(String::new, |time| format!("{}s", short(time))),
            format!("{}s", short(row.cost.wall)),
            row.iterations.map_or_else(String::new, |[outer, linear]| {
                format!("{outer:.1}, {linear:.0}")
            }),
        ];
        cells.extend(row.errors.iter().map(|error| percent(*error)));
        cells.push(format!("{}B", short(row.cost.memory / (nx * ny) as f64)));
        table.add_row(cells);
    }
    table
}

fn percent(error: f64) -> String {
    if error.is_nan() {
        return "diverged".to_owned();
    }
    let digits = (1.0 - (100.0 * error).log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{:.digits$} %", 100.0 * error)
}

/// Processor times at equal errors of a quantity on one core, in s and as multiples of the stock solver's.
fn equal_errors(case: &ErrorCase, rows: &[ErrorRow], quantity: usize) -> Table {
    let solvers = solvers(rows);
    let front = |solver: &&str| {
        let of = rows
            .iter()
            .filter(|row| row.solver == *solver && row.cores == 1);
        let points = of.map(|row| Point {
            error: row.errors[quantity],
            time: row.cost.processor,
        });
        Front::new(&points.collect::<Vec<_>>())
    };
    let fronts: Vec<Front> = solvers.iter().map(front).collect();
    let stock = solvers.iter().position(|solver| *solver == case.stock);
    let name = case.quantities[quantity].name;
    let mut head = vec![format!("time at an error of {name}")];
    head.extend(solvers.iter().map(|solver| (*solver).to_owned()));
    let mut table = Table::of(head);
    let ends = fronts.iter().filter_map(Front::errors);
    let range = ends.reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)));
    let Some((smallest, largest)) = range else {
        return table;
    };
    for level in levels(smallest, largest) {
        let times: Vec<Option<TimeAt>> = fronts.iter().map(|front| front.time(level)).collect();
        let of_stock = stock.and_then(|stock| times[stock]);
        let mut cells = vec![percent(level)];
        cells.extend(times.iter().map(|time| shown(*time, of_stock)));
        table.add_row(cells);
    }
    table
}

/// A time, and how many times that of the stock solver it is where both are interpolated.
fn shown(time: Option<TimeAt>, stock: Option<TimeAt>) -> String {
    match (time, stock) {
        (None, _) => "–".to_owned(),
        (Some(TimeAt::AtMost(time)), _) => format!("≤ {}s", short(time)),
        (Some(TimeAt::Equal(time)), Some(TimeAt::Equal(stock))) => {
            format!("{}s ({:.2})", short(time), time / stock)
        }
        (Some(TimeAt::Equal(time)), Some(TimeAt::AtMost(stock))) => {
            format!("{}s (≥ {:.2})", short(time), time / stock)
        }
        (Some(TimeAt::Equal(time)), None) => format!("{}s", short(time)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::at;
    use super::*;

    fn row(solver: &str, factor: usize, milliseconds: f64, value: f64) -> ErrorRow {
        ErrorRow {
            solver: solver.to_owned(),
            resolution: at(factor, milliseconds),
            cores: 1,
            cost: Cost::default(),
            gas: None,
            iterations: None,
            fields: MeanField::new([1, 1], vec![value]).map(|field| vec![field]),
            errors: vec![0.0],
        }
    }

    #[test]
    fn errors_of_second_order_in_the_cell_and_first_in_the_step_are_extrapolated() {
        let value = |factor: usize, step: f64| 1.0 + 2.0 / (factor * factor) as f64 + 0.3 * step;
        let runs = [(1, 4.0), (2, 4.0), (2, 2.0), (3, 2.0)];
        let rows = runs.map(|(factor, step)| row("native", factor, step, value(factor, step)));
        let limit = own_limit(&rows, "native").unwrap();
        assert!((limit[0].values[0] - 1.0).abs() < 1e-12, "{limit:?}");
        assert!(own_limit(&rows[..2], "native").is_none());
        assert!(own_limit(&rows, "icoFoam").is_none());
    }

    #[test]
    fn times_are_shown_as_multiples_of_the_stock_solver_s() {
        let (equal, most) = (Some(TimeAt::Equal(2.0)), Some(TimeAt::AtMost(4.0)));
        assert_eq!(shown(equal, Some(TimeAt::Equal(4.0))), "2.00 s (0.50)");
        assert_eq!(shown(equal, most), "2.00 s (≥ 0.50)");
        assert_eq!(shown(most, equal), "≤ 4.00 s");
        assert_eq!(shown(equal, None), "2.00 s");
        assert_eq!(shown(None, equal), "–");
    }

    #[test]
    fn errors_have_two_digits_and_runs_without_end_none() {
        assert_eq!(percent(0.0123), "1.2 %");
        assert_eq!(percent(0.33), "33 %");
        assert_eq!(percent(0.00058), "0.058 %");
        assert_eq!(percent(f64::NAN), "diverged");
    }
}
