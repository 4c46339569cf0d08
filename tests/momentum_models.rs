//! Models A and B of the momentum between gas and particles (docs/theory.md, DRG-1): the same force on every
//! particle of a uniform bed at rest, and the same terminal speed, by the native gas and by OpenFOAM's.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::program::{run_text, shipped};

const DIAMETER: f64 = 7.8e-3;

/// A duct that is filled with spheres from end to end, one to a cell: a solid fraction of 0.248 in each. Water
/// flows upwards through it.
fn bed(model: &str) -> String {
    format!(
        r#"
format = 1
title = "A uniform bed from end to end"
[time]
end = "2 s"
motion_window = "10 ms"
[mesh]
box = {{ size = "20 20 80 mm", cells = [2, 2, 8] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "water"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 0.1 m/s" }}
constant = {{ density = "998 kg/m^3", heat_capacity = "4.18 kJ/kg/K", viscosity = "1e-3 Pa s", conductivity = "0.6 W/m/K" }}
gravity = "0 0 -9.81 m/s^2"
controls = {{ linear_tolerance = 1e-13 }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "0.1 m/s", temperature = "300 K" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[[particles]]
name = "spheres"
material = "glass"
diameter = "{DIAMETER} m"
motion = "frozen"
temperature = "300 K"
place = {{ grid = {{ first = "5 5 5 mm", spacing = "10 10 10 mm", counts = [2, 2, 8] }} }}
[laws]
drag = {{ law = "gidaspow", model = "{model}" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "centroid"
smoother = {{ max_solid_fraction = 0.64, diffusion_length = "0 mm" }}
[output]
every = "2 s"
series_every = "0.1 s"
particles = ["force", "void_fraction", "slip"]
[[quantities]]
name = "pressure_drop"
measure = {{ difference = "pressure", patches = ["bottom", "top"] }}
"#
    )
}

/// Forces on the particles in N, upwards, in the last snapshot.
fn forces(out: &Path) -> Vec<f64> {
    let file = hdf5::File::open(out.join("results.h5")).unwrap();
    let force = file.dataset("snapshots/0001/particles/force").unwrap();
    let values = force.read_raw::<f64>().unwrap();
    values.chunks_exact(3).map(|force| force[2]).collect()
}

#[test]
fn every_particle_of_a_uniform_bed_is_pushed_alike_by_both_models() {
    let directory = tempfile::tempdir().unwrap();
    let runs: [(&str, &[&str]); 2] = [("native", &[]), ("openfoam", &["--gas", "openfoam"])];
    for (gas, arguments) in runs {
        let [a, b] = ["a", "b"].map(|model| {
            let name = format!("{gas}-{model}");
            run_text(directory.path(), &name, &bed(model), arguments)
        });
        let (pushed_a, pushed_b) = (forces(&a), forces(&b));
        // What holds up their volume of water, and drag: half as much.
        let volume = PI / 6.0 * DIAMETER.powi(3);
        assert!(
            pushed_a
                .iter()
                .all(|force| *force > 1.3 * volume * 998.0 * 9.81)
        );
        let apart = pushed_a
            .iter()
            .zip(&pushed_b)
            .map(|(a, b)| (a / b - 1.0).abs());
        let worst = apart.fold(0.0, f64::max);
        let drop = |out: &Path| {
            let series = Series::read(out).unwrap();
            *series.column("quantities.pressure_drop").last().unwrap()
        };
        let drops = [drop(&a), drop(&b)];
        println!("{gas}: forces {worst:.1e} apart, pressure drops {drops:?} Pa");
        assert!(worst < 1e-8, "{gas}: {worst}");
        assert!((drops[0] / drops[1] - 1.0).abs() < 1e-8, "{gas}: {drops:?}");
        for out in [&a, &b] {
            let summary = Summary::read(out).unwrap();
            let momentum = &summary.ledger.lines["momentum"];
            assert!(momentum.relative_error < 1e-12, "{momentum:?}");
            let gas = &summary.ledger.lines["gas_momentum"];
            assert!(gas.relative_error < 1e-6, "{gas:?}");
        }
    }
}

#[test]
fn a_bead_sinks_at_the_same_speed_by_both_models() {
    let directory = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(shipped("settling-sphere")).unwrap();
    let speed = |model: &str| {
        let model = format!("laws.drag.model={model}");
        let arguments = ["--set", "gas.held=false", "--set", &model];
        let out = run_text(directory.path(), model.trim(), &text, &arguments);
        *Series::read(&out)
            .unwrap()
            .column("quantities.speed")
            .last()
            .unwrap()
    };
    let (a, b) = (speed("a"), speed("b"));
    println!("terminal speed by A {a} m/s, by B {b} m/s");
    assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    assert!(a != b, "the key has no effect");
}
