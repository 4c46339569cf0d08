//! Beds of parcels by Calcine and by OpenFOAM's cloud, with both gases: how high they stand and where the solid is.
//! `cases/parcel-bed.toml` with a stress that OpenFOAM's implicit packing bears.

use std::path::Path;

use calcine::results::read::{Series, arrays};

use crate::{run_with, shipped};

/// Largest difference of mean heights, as a share of them.
const HEIGHT: f64 = 0.02;
/// Largest difference of a layer's solid fraction, as a share of the fullest layer's, in a bed that floats.
const PROFILE: f64 = 0.05;
/// The same in a bed that has settled: OpenFOAM's boils and has no sharp surface (docs/verification.md).
const SETTLED: f64 = 0.3;
/// Cells of a layer of the shipped mesh.
const LAYER: usize = 12;

/// What both particle solvers are given.
const BOTH: [&str; 2] = ["motion.parcels.pressure=10 Pa", "motion.parcels.floor=1e-2"];
/// Parcels all over the column, in gas that hardly moves.
const SETTLING: [&str; 4] = [
    "time.end=1 s",
    r#"output.means={ from = "0.5 s", to = "1 s", gas = ["void_fraction"] }"#,
    "particles[0].place.grid.counts=[18, 6, 60]",
    r#"gas.patch.bottom.inlet.superficial_velocity="0.05 m/s""#,
];

/// The bed of the case, for longer.
const FLOATING: [&str; 2] = [
    "time.end=3 s",
    r#"output.means={ from = "0.5 s", to = "3 s", gas = ["void_fraction"] }"#,
];

/// A bed as it is found.
struct Found {
    /// Mean height of the parcels in m, mean from 0.5 s on.
    height: f64,
    /// Mean height at a tenth, three, five, eight and ten tenths of the run in m.
    falling: Vec<f64>,
    /// Mean solid fraction of each layer from 0.5 s on.
    profile: Vec<f64>,
}

impl Found {
    fn read(out: &Path, series: &Series) -> Self {
        let times = series.column("process_time");
        let heights = series.column("quantities.mean_height");
        let all = times.iter().zip(heights);
        let late: Vec<f64> = all
            .filter(|(time, _)| **time > 0.5)
            .map(|(_, height)| *height)
            .collect();
        let at = |share: usize| heights[(heights.len() - 1) * share / 10];
        let means = arrays(&out.join("means.vtu")).unwrap();
        let void = &means["void_fraction_mean"].values;
        let layers = void.chunks(LAYER);
        Self {
            height: late.iter().sum::<f64>() / late.len() as f64,
            falling: [1, 3, 5, 8, 10].map(at).to_vec(),
            profile: layers
                .map(|layer| 1.0 - layer.iter().sum::<f64>() / layer.len() as f64)
                .collect(),
        }
    }

    /// Differences of the height, and of the layer that differs most.
    fn apart(&self, other: &Self) -> [f64; 2] {
        let fullest = self.profile.iter().copied().fold(0.0, f64::max);
        let layers = self.profile.iter().zip(&other.profile);
        let worst = layers.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
        [other.height / self.height - 1.0, worst / fullest]
    }
}

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let weights = [("0.1", 7.83), ("0.15", 11.74), ("0.2", 15.66)];
    let settling = weights.map(|(fraction, weight)| {
        let mut set: Vec<String> = SETTLING.map(str::to_owned).to_vec();
        set.push(format!("particles[0].weight={weight}"));
        (format!("settling of {fraction}"), set, SETTLED)
    });
    let floating = FLOATING.map(str::to_owned).to_vec();
    let floating = ("floating at 0.4 m/s".to_owned(), floating, PROFILE);
    println!("  | bed | gas | native, mm | OpenFOAM, mm | height | layer |");
    let mut missed = Vec::new();
    for (name, own, most) in settling.into_iter().chain([floating]) {
        for gas in ["native", "openfoam"] {
            let set: Vec<String> = BOTH
                .map(str::to_owned)
                .into_iter()
                .chain(own.clone())
                .collect();
            let found = ["native", "openfoam"].map(|particles| {
                let below = format!("{name} {gas} {particles}").replace([' ', '/'], "-");
                let words = ["--gas", gas, "--particles", particles];
                let (out, series) =
                    run_with(&shipped("parcel-bed"), folder.path(), &below, &set, &words);
                Found::read(&out, &series)
            });
            let [height, layer] = found[0].apart(&found[1]);
            println!(
                "  | {name} | {gas} | {:.2} | {:.2} | {:+.1} % | {:.1} % |",
                1e3 * found[0].height,
                1e3 * found[1].height,
                100.0 * height,
                100.0 * layer
            );
            for one in &found {
                println!("    heights on the way {:.4?} m", one.falling);
                println!("    {:.3?}", one.profile);
            }
            if height.abs() > HEIGHT || layer > most {
                missed.push(format!("{name}, {gas} gas"));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
