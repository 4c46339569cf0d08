//! Strouhal number of a square cylinder across a stream at a Reynolds number of 100: Sohankar, Norberg and Davidson 1998
//! (doi 10.1002/(SICI)1097-0363(19980115)26:1<39::AID-FLD623>3.0.CO;2-P) computed 0.146 at a blockage of 5 %. Central convection, two
//! stages a window; cells and windows shrink together, and what has second order in both is extrapolated. The blockage is varied on the coarser
//! mesh.

use std::fs;
use std::path::Path;

use crate::blocks::{Block, growing};
use crate::run_with;

/// Side of the square in m; the stream has 1 m/s.
const SIDE: f64 = 0.01;
/// Time in sides over the speed.
const END: f64 = 120.0;
/// From which on periods are counted.
const DEVELOPED: f64 = 60.0;
/// Published at a blockage of 5 %.
const PUBLISHED: f64 = 0.146;

pub fn run() {
    // Cells along the square's side, the channel's width in sides, window in sides over the speed.
    let [coarse, fine] =
        [(6, 0.12), (9, 0.08)].map(|(cells, window)| strouhal("native", cells, 20.0, window));
    let found = fine + (fine - coarse) / (1.5_f64.powi(2) - 1.0);
    println!(
        "  extrapolated {found:.4}, off the published {PUBLISHED} by {:.1} %",
        100.0 * (found / PUBLISHED - 1.0)
    );
    let foam = strouhal("openfoam", 6, 20.0, 0.12);
    strouhal("native", 6, 10.0, 0.12);
    assert!((found / PUBLISHED - 1.0).abs() < 0.02, "{found}");
    assert!((foam / coarse - 1.0).abs() < 0.01, "{foam} {coarse}");
}

/// The Strouhal number that a gas finds.
fn strouhal(gas: &str, cells: u32, width: f64, window: f64) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/square-cylinder.toml");
    let case = folder.path().join("case.toml");
    fs::copy(source, &case).unwrap();
    let cell = 1.0 / f64::from(cells);
    let depth = cell * SIDE;
    let block = Block {
        levels: [
            growing([-8.5, 20.5], [-1.5, 3.5], cell, 1.1),
            growing([-0.5 * width, 0.5 * width], [-1.5, 1.5], cell, 1.1),
            vec![0.0, depth],
        ],
        patches: ["inlet", "outlet", "far", "far", "side", "side"],
        hole: Some(("square", &|at| at[0].abs() < 0.5 && at[1].abs() < 0.5)),
        shape: &|[x, y, z]| [SIDE * x, SIDE * y, z],
    };
    let mesh = block.write(folder.path());
    let set = [
        format!("time.motion_window={} ms", window * SIDE * 1e3),
        format!("time.end={} ms", END * SIDE * 1e3),
        format!("output.every={} ms", END * SIDE * 1e3),
        format!("output.series_every={} ms", window * SIDE * 1e3),
        format!(
            "probes[0].point={} {} {} m",
            2.5 * SIDE,
            0.5 * SIDE,
            0.5 * depth
        ),
        format!(
            "particles[0].place.grid.first={} {} {} m",
            0.703 * SIDE,
            0.603 * SIDE,
            0.5 * depth
        ),
    ];
    let (_, series) = run_with(&case, folder.path(), "out", &set, &["--gas", gas]);
    let speed = series.column("quantities.wake");
    let time: Vec<f64> = series
        .column("process_time")
        .iter()
        .map(|t| t / SIDE)
        .collect();
    let first = time.partition_point(|&t| t < DEVELOPED);
    let mean = speed[first..].iter().sum::<f64>() / (speed.len() - first) as f64;
    let rising: Vec<f64> = (first..speed.len() - 1)
        .filter(|&k| speed[k] < mean && speed[k + 1] >= mean)
        .map(|k| time[k] + (time[k + 1] - time[k]) * (mean - speed[k]) / (speed[k + 1] - speed[k]))
        .collect();
    let periods = rising.len() - 1;
    let found = periods as f64 / (rising[periods] - rising[0]);
    println!(
        "  {gas}, {} cells, {cells} along the side, blockage {:.1} %, windows of {window}: Strouhal number {found:.4} over {periods} periods",
        mesh.cells(),
        100.0 / width
    );
    found
}
