//! A bed of 537 light spheres that air spouts from the bottom of a cone of 50 degrees, on a mesh of one block (38 degrees of
//! non-orthogonality), in both gases with native particles: means over the second half of pressure drop, mean height and height of the
//! fountain. Single collisions decide where each sphere goes.

use std::fs;
use std::path::Path;

use crate::blocks::{Block, disc, even};
use crate::run_with;

/// How far means of the two gases may be apart, as a share.
const BAND: f64 = 0.1;

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/spouted-bed.toml");
    let case = folder.path().join("case.toml");
    fs::copy(source, &case).unwrap();
    let slope = 25_f64.to_radians().tan();
    let block = Block {
        levels: [8, 8, 20].map(even),
        patches: ["side", "side", "side", "side", "bottom", "top"],
        hole: None,
        shape: &|[x, y, z]| {
            let height = 0.08 * z;
            let radius = 0.008 + height * slope;
            let [x, y] = disc(2.0 * x - 1.0, 2.0 * y - 1.0);
            [radius * x, radius * y, height]
        },
    };
    block.write(folder.path());
    let names = ["pressure_drop", "mean_height", "fountain"];
    let means = ["native", "openfoam"].map(|gas| {
        let (_, series) = run_with(&case, folder.path(), gas, &[], &["--gas", gas]);
        let means = names.map(|name| {
            let column = series.column(&format!("quantities.{name}"));
            let late = &column[column.len() / 2..];
            late.iter().sum::<f64>() / late.len() as f64
        });
        let [drop, height, fountain] = means;
        println!(
            "  {gas}: {drop:.1} Pa, mean height {:.2} mm, fountain {:.2} mm",
            1e3 * height,
            1e3 * fountain
        );
        means
    });
    for (k, name) in names.iter().enumerate() {
        let share = means[1][k] / means[0][k];
        assert!((share - 1.0).abs() < BAND, "{name}: {share}");
    }
}
