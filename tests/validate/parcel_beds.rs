//! Beds of parcels by Calcine and by OpenFOAM's cloud, with both gases: how high they stand and where the solid is, beside each other and
//! beside the equilibrium of weight, drag and stress. `cases/parcel-bed.toml` with a stress that OpenFOAM's implicit packing bears.

use std::path::Path;

use calcine::results::read::{Series, arrays, collection};

use crate::{run_with, shipped};

/// Largest difference of mean heights, as a share of them.
const HEIGHT: f64 = 0.02;
/// Largest difference of a layer's solid fraction, as a share of the fullest layer's, in a bed that floats.
const PROFILE: f64 = 0.05;
/// The same in a bed that has settled: OpenFOAM's boils and has no sharp surface (docs/verification.md).
const SETTLED: f64 = 0.3;
/// Cells of a layer of the shipped mesh.
const LAYER: usize = 12;
/// Layers of the shipped mesh, and the height of one in m.
const LAYERS: usize = 20;
const LAYER_HEIGHT: f64 = 9e-3;
/// Area of the shipped bed in m², and the volume of a bead in m³.
const AREA: f64 = 54e-3 * 18e-3;
const BEAD: f64 = 0.87e-3 * 0.87e-3 * 0.87e-3 * std::f64::consts::PI / 6.0;
/// Largest difference of the native bed at rest from the equilibrium: of its mean height, as a share, and of a layer, as a share of
/// the fullest, as linear weights sharpen or spread its surface by half a cell.
const AT_REST: [f64; 2] = [0.01, 0.08];

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

/// The bed of beads at rest whose stress P_s α²/(α_cp − α) carries what gas of a superficial velocity in m/s leaves of its weight: mean
/// height in m, and solid fraction of each layer. `solid` is its volume in m³ on a m², `pressure` P_s.
fn at_rest(pressure: f64, solid: f64, velocity: f64) -> (f64, Vec<f64>) {
    let fraction = |stress: f64| {
        // P α²/(α_cp − α) = τ is a quadratic equation of α.
        let half = 0.5 * stress / pressure;
        (half * half + 2.0 * half * 0.6).sqrt() - half
    };
    let step = 2e-6;
    let (mut stress, mut held, mut depth) = (1e-6, 0.0, 0.0);
    let mut downwards = Vec::new();
    while held < solid {
        let fall = |stress: f64| (load(fraction(stress), velocity) * step).max(0.0);
        let middle = stress + 0.5 * fall(stress);
        let alpha = fraction(middle);
        stress += fall(middle);
        held += alpha * step;
        depth += step;
        downwards.push(alpha);
    }
    let mut layers = vec![0.0; LAYERS];
    let mut moment = 0.0;
    for (number, alpha) in downwards.iter().enumerate() {
        let height = depth - (number as f64 + 0.5) * step;
        moment += alpha * height * step;
        if let Some(layer) = layers.get_mut((height / LAYER_HEIGHT) as usize) {
            *layer += alpha * step / LAYER_HEIGHT;
        }
    }
    (moment / held, layers)
}

/// The same bed as OpenFOAM's implicit packing has it: the stress of a face is the mean of dτ/dα of both cells times the difference of α, with
/// α of a cell by the parcels in it.
fn by_slopes_at_faces(pressure: f64, solid: f64, velocity: f64) -> Vec<f64> {
    let slope = |alpha: f64| {
        let gap = (0.6 - alpha).max(1e-2 * (1.0 - alpha));
        pressure * alpha * alpha / gap * (2.0 / alpha + 1.0 / gap)
    };
    // Of a layer above one of α, which rises as that does.
    let above = |below: f64| {
        let left = |alpha: f64| {
            let face = 0.5 * (slope(below) + slope(alpha)) * (below - alpha) / LAYER_HEIGHT;
            face - load(0.5 * (below + alpha), velocity)
        };
        let (mut low, mut high) = (1e-4, below);
        if left(low) < 0.0 {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match left(middle) > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        Some(low)
    };
    let column = |floor: f64| -> Vec<f64> {
        std::iter::successors(Some(floor), |below| above(*below))
            .take(LAYERS)
            .collect()
    };
    let held = |floor: f64| column(floor).iter().sum::<f64>() * LAYER_HEIGHT;
    let (mut low, mut high) = (0.1, 0.5999);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match held(middle) < solid {
            true => low = middle,
            false => high = middle,
        }
    }
    let mut layers = column(low);
    layers.resize(LAYERS, 0.0);
    layers
}

/// Weight in air less drag (Gidaspow: Ergun in a dense bed, else Wen and Yu) of the case's beads in N/m³.
fn load(alpha: f64, velocity: f64) -> f64 {
    let (void, d, density, viscosity) = (1.0 - alpha, 0.87e-3, 1.2, 1.8e-5);
    let drag = if void < 0.8 {
        150.0 * alpha * alpha * viscosity * velocity / (void.powi(3) * d * d)
            + 1.75 * alpha * density * velocity * velocity / (void.powi(3) * d)
    } else {
        let reynolds = density * velocity * d / viscosity;
        let standard = 24.0 / reynolds * (1.0 + 0.15 * reynolds.powf(0.687));
        0.75 * standard * alpha * density * velocity * velocity / (d * void) * void.powf(-2.65)
    };
    9.81 * alpha * (860.0 - density) - drag
}

/// A bed as it is found.
struct Found {
    /// Mean height of the parcels in m, mean from 0.5 s on.
    height: f64,
    /// Mean height at a tenth, three, five, eight and ten tenths of the run in m.
    falling: Vec<f64>,
    /// Mean solid fraction of each layer from 0.5 s on, as the gas sees it.
    profile: Vec<f64>,
    /// The same by the parcels whose centres lie in the layer.
    counted: Vec<f64>,
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
            counted: counted(out),
        }
    }

    /// Differences of the height, and of the layer that differs most.
    fn apart(&self, other: &Self) -> [f64; 2] {
        let worst = worst_layer(&self.profile, &other.profile);
        [other.height / self.height - 1.0, worst]
    }
}

/// Solid fraction of each layer by the parcels whose centres lie in it, mean of the snapshots from 0.5 s on.
fn counted(out: &Path) -> Vec<f64> {
    let files = collection(out, "particles.pvd").unwrap();
    let late: Vec<_> = files.iter().filter(|(time, _)| *time > 0.5).collect();
    let mut layers = vec![0.0; LAYERS];
    for (_, path) in &late {
        let arrays = arrays(path).unwrap();
        let places = arrays["points"].values.chunks(3);
        for (place, weight) in places.zip(&arrays["weight"].values) {
            let layer = (place[2] / LAYER_HEIGHT) as usize;
            layers[layer.min(LAYERS - 1)] += weight * BEAD / (AREA * LAYER_HEIGHT);
        }
    }
    layers.iter_mut().for_each(|one| *one /= late.len() as f64);
    layers
}

/// The largest difference of a layer, as a share of the fullest of the first.
fn worst_layer(one: &[f64], other: &[f64]) -> f64 {
    let fullest = one.iter().copied().fold(0.0, f64::max);
    let layers = one.iter().zip(other);
    layers.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max) / fullest
}

/// A bed that is computed.
struct BedCase {
    name: &'static str,
    /// Weight of the parcels, P_s in Pa and superficial velocity in m/s of one that comes to rest; none of one that floats.
    rest: Option<(f64, f64, f64)>,
    /// Largest difference of a layer between both solvers.
    layer: f64,
    set: &'static [&'static str],
}

const BEDS: [BedCase; 5] = [
    BedCase {
        name: "settling of 0.1",
        rest: Some((7.83, 10.0, 0.05)),
        layer: SETTLED,
        set: &SETTLING,
    },
    BedCase {
        name: "settling of 0.15",
        rest: Some((11.74, 10.0, 0.05)),
        layer: SETTLED,
        set: &SETTLING,
    },
    BedCase {
        name: "settling of 0.2",
        rest: Some((15.66, 10.0, 0.05)),
        layer: SETTLED,
        set: &SETTLING,
    },
    BedCase {
        name: "settling of 0.2, P_s = 100 Pa",
        rest: Some((15.66, 100.0, 0.05)),
        layer: SETTLED,
        set: &SETTLING,
    },
    BedCase {
        name: "floating at 0.4 m/s",
        rest: None,
        layer: PROFILE,
        set: &FLOATING,
    },
];

impl BedCase {
    fn settings(&self) -> Vec<String> {
        let both = ["motion.parcels.floor=1e-2", "output.every=50 ms"];
        let all = both.iter().chain(self.set);
        let mut set: Vec<String> = all.map(|&one| one.to_owned()).collect();
        let pressure = self.rest.map_or(10.0, |(_, pressure, _)| pressure);
        set.push(format!("motion.parcels.pressure={pressure} Pa"));
        let weight = self.rest.map(|(weight, ..)| weight);
        set.extend(weight.map(|weight| format!("particles[0].weight={weight}")));
        set
    }

    /// The bed by one solver of parcels.
    fn found(&self, folder: &Path, gas: &str, particles: &str) -> Found {
        let below = format!("{} {gas} {particles}", self.name).replace([' ', '/', ','], "-");
        let words = ["--gas", gas, "--particles", particles];
        let set = self.settings();
        let (out, series) = run_with(&shipped("parcel-bed"), folder, &below, &set, &words);
        Found::read(&out, &series)
    }

    /// Computes it by both with a gas, prints what is found, and says what misses.
    fn compare(&self, folder: &Path, gas: &str) -> Vec<String> {
        let found = ["native", "openfoam"].map(|particles| self.found(folder, gas, particles));
        let [height, layer] = found[0].apart(&found[1]);
        println!(
            "  | {} | {gas} | {:.2} | {:.2} | {:+.1} % | {:.1} % |",
            self.name,
            1e3 * found[0].height,
            1e3 * found[1].height,
            100.0 * height,
            100.0 * layer
        );
        let mut missed = Vec::new();
        if height.abs() > HEIGHT || layer > self.layer {
            missed.push(format!("{}, {gas} gas", self.name));
        }
        for (name, one) in ["native", "openfoam"].iter().zip(&found) {
            println!("    {name}: heights on the way {:.4?} m", one.falling);
            println!("    seen by the gas {:.3?}", one.profile);
            println!("    counted         {:.3?}", one.counted);
        }
        if let Some((weight, pressure, velocity)) = self.rest {
            let solid = 6480.0 * weight * BEAD / AREA;
            let (mean, layers) = at_rest(pressure, solid, velocity);
            println!("    at rest {:.2} mm, {layers:.3?}", 1e3 * mean);
            let slopes = by_slopes_at_faces(pressure, solid, velocity);
            let off = worst_layer(&slopes, &found[1].counted);
            println!(
                "    by slopes at faces {slopes:.3?}, OpenFOAM counted {:.1} %",
                100.0 * off
            );
            if off > PROFILE {
                missed.push(format!("{}, {gas} gas, OpenFOAM's own equation", self.name));
            }
            for (name, one) in ["native", "openfoam"].iter().zip(&found) {
                let (height, worst) = (one.height / mean - 1.0, worst_layer(&layers, &one.profile));
                println!(
                    "    {name} against rest: height {:+.1} %, layer seen {:.1} %, counted {:.1} %",
                    100.0 * height,
                    100.0 * worst,
                    100.0 * worst_layer(&layers, &one.counted)
                );
                if *name == "native" && (height.abs() > AT_REST[0] || worst > AT_REST[1]) {
                    missed.push(format!("{}, {gas} gas, native against rest", self.name));
                }
            }
        }
        missed
    }
}

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    println!("  | bed | gas | native, mm | OpenFOAM, mm | height | layer |");
    let missed: Vec<String> = BEDS
        .iter()
        .flat_map(|bed| ["native", "openfoam"].map(|gas| bed.compare(folder.path(), gas)))
        .flatten()
        .collect();
    assert!(missed.is_empty(), "{missed:?}");
}
