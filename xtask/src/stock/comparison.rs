//! A table of runs that compute the same, each to two ends: what lies between them is the cost, so that start, mesh and
//! results do not count.

use crate::measure::Cost;
use crate::steps::{Stop, TaskResult, step};
use crate::table::{Table, short};

/// What a run gave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    pub cost: Cost,
    /// Times in s with the figure that all runs are compared by.
    pub samples: Vec<(f64, f64)>,
}

/// A program with what it is told.
pub struct Contestant<'a> {
    pub name: String,
    /// Its step, as people write it.
    pub step: &'static str,
    /// Runs it to a time in s.
    pub run: Box<dyn Fn(f64) -> TaskResult<Run> + 'a>,
}

impl<'a> Contestant<'a> {
    pub fn new(
        name: impl Into<String>,
        step: &'static str,
        run: impl Fn(f64) -> TaskResult<Run> + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            step,
            run: Box::new(run),
        }
    }
}

/// What is measured of all contestants.
pub struct StockComparison {
    /// Heads of the first column and of the last, the mean figure between the ends.
    pub title: &'static str,
    pub figure: &'static str,
    /// Ends of the shorter and of the longer run in s.
    pub ends: [f64; 2],
}

impl StockComparison {
    /// Runs all contestants; the first is what the others are compared with.
    pub fn table(&self, contestants: &[Contestant<'_>]) -> TaskResult<Table> {
        let first = contestants.first().map_or("", |first| &first.name);
        let over = format!("over {first}'s");
        let mut table = Table::new([
            self.title,
            "step",
            "processor time per simulated second",
            &over,
            "memory, MB",
            self.figure,
        ]);
        let mut stock = None;
        for contestant in contestants {
            let to = |end: f64| {
                let what = format!("{}, steps of {}, {end} s", contestant.name, contestant.step);
                step(&what, || (contestant.run)(end))
            };
            let runs = [to(self.ends[0])?, to(self.ends[1])?];
            let row = self.row(contestant, &runs, &mut stock)?;
            table.add(row);
        }
        Ok(table)
    }

    fn row(
        &self,
        contestant: &Contestant<'_>,
        [before, whole]: &[Run; 2],
        stock: &mut Option<f64>,
    ) -> TaskResult<[String; 6]> {
        let [from, to] = self.ends;
        let each = (whole.cost.processor - before.cost.processor) / (to - from);
        let figure = mean_after(&whole.samples, from)
            .ok_or_else(|| Stop(format!("{}: no figures after {from} s", contestant.name)))?;
        let stock = *stock.get_or_insert(each);
        Ok([
            contestant.name.clone(),
            contestant.step.to_owned(),
            format!("{}s", short(each)),
            ratio(each / stock),
            format!("{:.0}", whole.cost.memory / 1e6),
            match figure.abs() < 10.0 {
                true => format!("{figure:.5}"),
                false => format!("{figure:.1}"),
            },
        ])
    }
}

/// A ratio with two digits that say something.
fn ratio(number: f64) -> String {
    let digits = if number.abs() < 0.1 { 3 } else { 2 };
    format!("{number:.digits$}")
}

/// Mean of the samples after a time.
fn mean_after(samples: &[(f64, f64)], time: f64) -> Option<f64> {
    let later = samples.iter().filter(|(at, _)| *at > time * (1.0 + 1e-9));
    let figures: Vec<f64> = later.map(|(_, figure)| *figure).collect();
    let count = figures.len() as f64;
    (!figures.is_empty()).then(|| figures.iter().sum::<f64>() / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_both_runs_have_does_not_count() {
        let comparison = StockComparison {
            title: "bed",
            figure: "drop, Pa",
            ends: [1.0, 3.0],
        };
        // Four seconds for the start and two for each second.
        let run = |end: f64| {
            Ok(Run {
                cost: Cost {
                    processor: 4.0 + 2.0 * end,
                    wall: 0.0,
                    memory: 1e6,
                },
                samples: vec![(1.0, 9.0), (2.0, 4.0), (3.0, 5.0)],
            })
        };
        let half = |end: f64| {
            let mut all = run(end)?;
            all.cost.processor /= 2.0;
            Ok(all)
        };
        let contestants = [
            Contestant::new("stock", "1 ms", run),
            Contestant::new("native", "2 ms", half),
        ];
        let text = comparison.table(&contestants).unwrap().to_string();
        let row = |name: &str| {
            let line = text.lines().find(|line| line.starts_with(name)).unwrap();
            let cells = line.trim_matches('|').split('|');
            cells.map(|cell| cell.trim().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(
            row("| stock"),
            ["stock", "1 ms", "2.00 s", "1.00", "1", "4.50000"]
        );
        assert_eq!(
            row("| native"),
            ["native", "2 ms", "1.00 s", "0.50", "1", "4.50000"]
        );
        assert!(text.contains("over stock's"), "{text}");
    }

    #[test]
    fn small_ratios_have_digits_too() {
        assert_eq!([1.0, 0.128, 0.0193].map(ratio), ["1.00", "0.13", "0.019"]);
    }

    #[test]
    fn a_run_without_figures_in_its_measured_part_is_refused() {
        assert_eq!(mean_after(&[(1.0, 9.0)], 1.0), None);
        assert_eq!(mean_after(&[(1.0, 9.0), (1.5, 4.0)], 1.0), Some(4.0));
    }
}
