//! An empty duct of 60 × 10 × 100 mm whose cells lean, a prism that widens by 50 degrees, a round tube and cones, each of one block:
//! air of 1 m/s at Courant numbers of 1 and 5, in both gases, which agree within 1 % of the fastest cell.

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read;

use crate::blocks::{Block, disc, even, leaning};

/// Largest difference of a cell's velocity as a share of the fastest.
const BAND: f64 = 0.01;

type Shape = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// Name, cells, smallest height of a cell in m, length in m, and where points go.
fn meshes() -> Vec<(String, [usize; 3], f64, Shape)> {
    let mut all: Vec<(String, [usize; 3], f64, Shape)> = Vec::new();
    for degrees in [35.0, 45.0, 50.0, 55.0, 65.0, 70.0] {
        let shape = Box::new(leaning([0.06, 0.01, 0.1], degrees));
        all.push((
            format!("duct that leans by {degrees}"),
            [12, 2, 20],
            5e-3,
            shape,
        ));
    }
    let slope = 50_f64.to_radians().tan();
    let prism = move |[x, y, z]: [f64; 3]| {
        let height = 0.03 * z;
        [(x - 0.5) * (0.02 + 2.0 * height * slope), 0.01 * y, height]
    };
    all.push(("prism of 50".into(), [12, 2, 20], 1.5e-3, Box::new(prism)));
    let round = |radius: f64, slope: f64, length: f64| {
        move |[x, y, z]: [f64; 3]| {
            let height = length * z;
            let wide = radius + height * slope;
            let [x, y] = disc(2.0 * x - 1.0, 2.0 * y - 1.0);
            [wide * x, wide * y, height]
        }
    };
    all.push((
        "tube".into(),
        [12, 12, 20],
        5e-3,
        Box::new(round(0.025, 0.0, 0.1)),
    ));
    all.push((
        "cone of 25 from its axis".into(),
        [12, 12, 10],
        2e-3,
        Box::new(round(0.008, 25_f64.to_radians().tan(), 0.02)),
    ));
    all.push((
        "cone of 50 from its axis".into(),
        [12, 12, 10],
        2e-3,
        Box::new(round(0.008, slope, 0.02)),
    ));
    all
}

pub fn run() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/skewed-meshes.toml");
    let mut missed = Vec::new();
    for (name, cells, height, shape) in meshes() {
        let folder = tempfile::tempdir().unwrap();
        let case = folder.path().join("case.toml");
        fs::copy(&source, &case).unwrap();
        let block = Block {
            levels: cells.map(even),
            patches: ["side", "side", "side", "side", "bottom", "top"],
            hole: None,
            shape: &shape,
        };
        let mesh = block.write(folder.path());
        let quality = mesh.quality().unwrap();
        let place = shape([0.503, 0.503, 0.052]);
        println!(
            "  {name} degrees: non-orthogonality {:.1}, skewness {:.2}, {:.2} at walls",
            quality.angle.value, quality.skewness.value, quality.boundary_skewness.value
        );
        for courant in [1.0, 5.0] {
            let window = courant * height;
            let set = [
                format!("time.motion_window={window} s"),
                format!("time.end={} s", 200.0 * height),
                format!("output.every={} s", 200.0 * height),
                format!(
                    "particles[0].place.grid.first={} {} {} m",
                    place[0], place[1], place[2]
                ),
            ];
            let gases = ["native", "openfoam"];
            let found = gases.map(|gas| {
                let out = folder.path().join(format!("{gas}-{courant}"));
                flow(&case, &out, gas, &set)
            });
            let [Ok((native, first)), Ok((foam, second))] = &found else {
                for (gas, one) in gases.iter().zip(&found) {
                    if let Err(told) = one {
                        println!(
                            "    Courant number {courant}, {gas}: {}",
                            told.lines().next().unwrap_or("")
                        );
                    }
                }
                missed.push(format!("{name} at {courant}: diverged"));
                continue;
            };
            let size = |u: &[f64; 3]| u.iter().map(|x| x * x).sum::<f64>().sqrt();
            let fastest = native.iter().map(size).fold(0.0, f64::max);
            let apart = native.iter().zip(foam);
            let apart = apart.map(|(a, b)| size(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]]));
            let apart = apart.fold(0.0, f64::max) / fastest;
            println!(
                "    Courant number {courant}: fastest {fastest:.5} m/s, {:.3} % apart; {first} and {second} of {} windows open",
                100.0 * apart,
                (200.0 / courant) as u32
            );
            if apart > BAND {
                missed.push(format!("{name} at {courant}: {apart:.3}"));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// Velocities at the end, and how many windows ended at the outer loop's limit; what the program said where it failed.
fn flow(
    case: &Path,
    out: &Path,
    gas: &str,
    set: &[String],
) -> Result<(Vec<[f64; 3]>, u64), String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(["run", "--quiet", "--gas", gas]).arg(case);
    command.arg("--out").arg(out);
    for setting in set {
        command.args(["--set", setting]);
    }
    let output = command.output().unwrap();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let files = read::collection(out, "gas.pvd").unwrap();
    let arrays = read::arrays(&files.last().unwrap().1).unwrap();
    let velocity = arrays["velocity"].values.as_chunks::<3>().0.to_vec();
    let open = Summary::read(out).unwrap().warnings;
    let open = open.get("gas_iterations").map_or(0, |one| one.windows);
    Ok((velocity, open))
}
