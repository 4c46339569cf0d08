//! The beads without gas: LIGGGHTS by itself, and Calcine with its native particles and with LIGGGHTS.

use super::comparison::{Contestant, StockComparison};
use super::programs::{CalcineRun, liggghts};
use crate::steps::TaskResult;
use crate::table::Table;
use crate::workspace::Workspace;

/// Step of the contacts in s, as `falling-beads.toml` has it.
const STEP: f64 = 5e-6;

pub fn table(workspace: &Workspace) -> TaskResult<Table> {
    let calcine = |particles: &'static str| {
        Contestant::new(
            format!("Calcine, {particles} particles"),
            "5 µs",
            move |end| {
                let run = CalcineRun {
                    case: "falling-beads.toml",
                    pairing: ["native", particles],
                    settings: Vec::new(),
                    every: None,
                    quantity: "mean_height",
                };
                run.to(workspace, end)
            },
        )
    };
    let contestants = [
        Contestant::new("LIGGGHTS", "5 µs", |end| {
            liggghts(workspace, "in.falling", STEP, end)
        }),
        calcine("native"),
        calcine("liggghts"),
    ];
    let comparison = StockComparison {
        title: "24 750 beads that fall and settle",
        figure: "mean height, m",
        ends: [60e-3, 100e-3],
    };
    comparison.table(&contestants)
}
