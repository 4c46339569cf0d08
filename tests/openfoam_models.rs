//! OpenFOAM's own turbulence and radiation models in a coupled gas, from the templates of `of-cases`.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::agreement::cases;
use crate::support::program::run_text;

fn template(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("of-cases")
        .join(name)
}

/// Runs a case's text with an OpenFOAM gas; its results folder.
fn run(text: &str, folder: &Path, name: &str, more: &[&str]) -> PathBuf {
    run_text(folder, name, text, &[&["--gas", "openfoam"], more].concat())
}

fn last(out: &Path, column: &str) -> f64 {
    *Series::read(out).unwrap().column(column).last().unwrap()
}

fn ledger(out: &Path) {
    let summary = Summary::read(out).unwrap();
    for name in ["mass", "energy"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-10, "{name}: {error:.1e}");
    }
}

fn with(template: &Path) -> String {
    format!("openfoam.template={}", template.display())
}

/// The first cell's value of a field in the state that turbulence and radiation leave in a checkpoint.
fn kept(out: &Path, field: &str) -> f64 {
    let bytes = fs::read(out.join("checkpoint/gas/calcineModels")).unwrap();
    let needle = format!("\n{field}\n");
    let at = bytes
        .windows(needle.len())
        .position(|window| window == needle.as_bytes())
        .unwrap();
    let open = at + bytes[at..].iter().position(|byte| *byte == b'(').unwrap();
    f64::from_le_bytes(*bytes[open + 1..].first_chunk().unwrap())
}

#[test]
fn eddies_resist_the_flow_through_a_duct_and_the_ledger_closes() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path();
    let text = cases::duct("upwind")
        .replace(r#""0 s", "0.4 kg/h""#, r#""0 s", "6 kg/h""#)
        .replace("ergun-wen-yu", "none");
    let end = ["--set", "time.end=0.5 s"];
    let laminar = run(&text, folder, "laminar", &end);
    let eddies = with(&template("k-epsilon"));
    let turbulent = run(
        &text,
        folder,
        "turbulent",
        &[&end[..], &["--set", &eddies]].concat(),
    );
    ledger(&turbulent);
    let drop = |out: &Path| last(out, "quantities.pressure_drop");
    assert!(
        drop(&turbulent) > 1.02 * drop(&laminar),
        "{} {}",
        drop(&turbulent),
        drop(&laminar)
    );
}

#[test]
fn turbulence_in_still_air_decays_as_k_epsilon_says() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path();
    let own = folder.join("foam");
    for (name, start, dimensions) in [
        ("k", "1", "[0 2 -2 0 0 0 0]"),
        ("epsilon", "10", "[0 2 -3 0 0 0 0]"),
        ("nut", "0", "[0 2 -1 0 0 0 0]"),
        ("alphat", "0", "[1 -1 -1 0 0 0 0]"),
    ] {
        let file = own.join("0").join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        let kind = if name == "k" || name == "epsilon" {
            "zeroGradient"
        } else {
            "calculated"
        };
        let text = format!(
            "FoamFile {{ version 2.0; format ascii; class volScalarField; object {name}; }}\n\
             dimensions {dimensions};\ninternalField uniform {start};\n\
             boundaryField {{ \".*\" {{ type {kind}; value uniform {start}; }} }}\n"
        );
        fs::write(file, text).unwrap();
    }
    fs::create_dir_all(own.join("constant")).unwrap();
    fs::copy(
        template("k-epsilon").join("constant/turbulenceProperties"),
        own.join("constant/turbulenceProperties"),
    )
    .unwrap();
    let text = cases::heated_box("slip", "upwind")
        .replace("gravity = \"0 0 -9.81 m/s^2\"", "gravity = \"0 0 0 m/s^2\"")
        .replace("motion_window = \"10 ms\"", "motion_window = \"0.5 ms\"");
    let set = with(&own);
    let out = run(
        &text,
        folder,
        "decay",
        &["--set", "time.end=0.1 s", "--set", &set],
    );
    // k = k0 (1 + (C2 - 1) epsilon0 t/k0)^(-1/(C2 - 1)), C2 = 1.92 (Launder and Spalding).
    let exact = (1.0f64 + 0.92 * 10.0 * 0.1).powf(-1.0 / 0.92);
    let found = kept(&out, "k");
    // The model steps by implicit Euler, k with the rate of the step before: 0.5 ms of 10/s.
    assert!((found / exact - 1.0).abs() < 1e-2, "{found} {exact}");
}

#[test]
fn thin_hot_gas_radiates_to_cold_walls_as_much_as_it_emits() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path();
    let mut text = cases::heated_box("no-slip", "upwind");
    for (from, to) in [
        (
            r#"temperature = "300 K", pressure"#,
            r#"temperature = "1000 K", pressure"#,
        ),
        (
            r#"mixture = "air""#,
            r#"mixture = "grey gas"
constant = { density = "0.35 kg/m^3", heat_capacity = "1 kJ/kg/K", viscosity = "4e-5 Pa s", conductivity = "1e-6 W/m/K" }"#,
        ),
        (
            r#"heat = "adiabatic""#,
            r#"heat = { temperature = "300 K" }"#,
        ),
        (
            r#"heat = { coefficient = "20 W/m^2/K", ambient = "300 K" }"#,
            r#"heat = { temperature = "300 K" }"#,
        ),
        (r#"["0.5 s", "400 K"]"#, r#"["0.5 s", "300 K"]"#),
        (r#"law = "gunn""#, r#"law = "none""#),
        ("-9.81", "0"),
        (r#"motion_window = "10 ms""#, r#"motion_window = "0.5 ms""#),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let end = ["--set", "time.end=5 ms"];
    let dark = run(&text, folder, "dark", &end);
    let set = with(&template("p1-radiation"));
    let bright = run(
        &text,
        folder,
        "bright",
        &[&end[..], &["--set", &set]].concat(),
    );
    ledger(&bright);
    // 4 a sigma (T^4 - Tw^4) per volume of gas. What the box of side L = 2 cm holds back is
    // 2 a V/A = a L/3 = 0.3 % at its walls (Marshak), and the rate falls by 0.4 % as the gas cools.
    let (a, sigma) = (0.5, 5.670_374e-8);
    let rate = 4.0 * a * sigma * (1000.0f64.powi(4) - 300.0f64.powi(4)) / (0.35 * 1000.0);
    let hottest = |out: &Path| last(out, "gas.temperature_max");
    let found = (hottest(&dark) - hottest(&bright)) / 5e-3;
    assert!((found / rate - 1.0).abs() < 0.015, "{found} K/s {rate} K/s");
}
