//! Native particles through the program: a projectile with drag, a turning drum, a hopper; the drum with LIGGGHTS
//! too, whose host `cargo xtask test` builds. Longer ones: `cargo xtask validate`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::hopper;
use crate::support::program::{self, shipped};
use crate::support::schiller_naumann::Sphere;

/// The series of a native run with settings.
fn run(name: &str, set: &[&str]) -> Series {
    let out = tempfile::tempdir().unwrap();
    program::run(&shipped(name), out.path(), &[], set);
    Series::read(out.path()).unwrap()
}

/// Velocity and height in m/s and m of a bead of 0.1 mm in air of 300 K that was thrown upwards and aside, by
/// Runge's and Kutta's method: m v' = (m − ρV) g − 3πμd (1 + 0.15 Re^0.687) v (Schiller and Naumann).
fn projectile(mut velocity: [f64; 2], mut height: f64, time: f64) -> ([f64; 2], f64) {
    let bead = Sphere::in_air(1e-4, 2500.0);
    let mass = bead.volume() * bead.density;
    let change = |v: [f64; 2]| {
        let drag = bead.resistance(v[0].hypot(v[1])) / mass;
        [
            -drag * v[0],
            -drag * v[1] - 9.81 * (1.0 - bead.fluid / bead.density),
        ]
    };
    let steps = 20_000;
    let step = time / f64::from(steps);
    let ahead = |v: [f64; 2], k: [f64; 2], by: f64| [v[0] + by * k[0], v[1] + by * k[1]];
    for _ in 0..steps {
        let k1 = change(velocity);
        let k2 = change(ahead(velocity, k1, 0.5 * step));
        let k3 = change(ahead(velocity, k2, 0.5 * step));
        let k4 = change(ahead(velocity, k3, step));
        let mean = |i: usize| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
        let next = ahead(velocity, [mean(0), mean(1)], step);
        height += step * (0.5 * (velocity[1] + next[1]));
        velocity = next;
    }
    (velocity, height)
}

/// A bead that bounces on a patch of a mesh of files and on a plane in its place: the same heights.
#[test]
fn patches_of_a_mesh_of_files_are_walls() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/own-mesh-packed.toml");
    let bead = "particles.beads.place={ grid = { first = \"4 3 8 mm\", spacing = \"5 5 5 mm\", counts = [1, 1, 1] } }";
    let far = "particles.grains.place={ grid = { first = \"-5 -5 0.5 mm\", spacing = \"5 5 5 mm\", counts = [1, 1, 1] } }";
    let heights = |wall: &str| {
        let out = tempfile::tempdir().unwrap();
        let wall = format!("walls[0]={{ name = \"floor\", material = \"glass\", {wall} }}");
        program::run(&case, out.path(), &[], &["gas.held=true", bead, far, &wall]);
        let series = Series::read(out.path()).unwrap();
        series.column("quantities.mean_height").to_vec()
    };
    let patch = heights("patches = [\"bottom\"]");
    let plane = heights("plane = { point = \"0 0 0 m\", normal = \"0 0 1\" }");
    let lowest = patch.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(patch.last().unwrap() > &lowest, "it bounces: {patch:?}");
    for (patch, plane) in patch.iter().zip(&plane) {
        assert!((patch - plane).abs() < 1e-9, "{patch} {plane}");
    }
}

/// A bead of a file that falls without touching: its velocity at the start is that of the file. The step is longer than the
/// contacts allow, which `long_step` turns into a warning.
#[test]
fn a_bead_of_a_file_starts_with_its_velocity_and_a_long_step_is_warned_of() {
    let case =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/springs-and-gates.toml");
    let out = tempfile::tempdir().unwrap();
    let set = ["time.end=0.02 s", "motion.motion_step=500 us"];
    program::run(&case, out.path(), &[], &set);
    let series = Series::read(out.path()).unwrap();
    let height = series.column("quantities.height");
    let time = 0.02;
    let fallen = 0.29 - 0.2 * time - 0.5 * 9.81 * time * time;
    let last = height.last().unwrap();
    // The drag of air on 2 mm of glass is a thousandth of its weight.
    assert!((last - fallen).abs() < 2e-5, "{last} {fallen}");
    let summary = Summary::read(out.path()).unwrap();
    let told = |words: &str| summary.case_warnings.iter().any(|one| one.contains(words));
    assert!(
        told("% of the shortest impact"),
        "{:?}",
        summary.case_warnings
    );
    let short = program::command(
        &case,
        &out.path().join("refused"),
        &[],
        &["motion.motion_step=500 us", "motion.long_step=false"],
    )
    .output()
    .unwrap();
    let text = String::from_utf8_lossy(&short.stderr);
    assert!(text.contains("motion.long_step = true"), "{text}");
}

#[test]
fn a_bead_that_is_thrown_follows_its_curve_through_still_air() {
    let end = 0.2;
    let error = |window: &str| {
        let series = run(
            "settling-sphere",
            &[
                "particles[0].velocity=0.12 0 0.5 m/s",
                "particles[0].place.grid.first=4 10 150 mm",
                "time.end=0.2 s",
                "output.series_every=0.2 s",
                window,
            ],
        );
        let last = |name: &str| *series.column(name).last().unwrap();
        let (velocity, height) = projectile([0.12, 0.5], 0.15, end);
        let speed = velocity[0].hypot(velocity[1]);
        let off = [
            last("quantities.speed") / speed - 1.0,
            (last("quantities.height") - height) / 0.02,
        ];
        println!("{window}: {off:?}");
        off
    };
    let (coarse, fine) = (
        error("time.motion_window=0.8 ms"),
        error("time.motion_window=0.2 ms"),
    );
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        // Drag is of the window's start: first order in its length.
        assert!(coarse.abs() < 8e-3 && fine.abs() < 2e-3, "{coarse} {fine}");
    }
}

/// Mean of the drum's angle in degrees over its last second.
fn slope(series: &Series) -> (f64, f64) {
    let end = *series.column("process_time").last().unwrap();
    let times = series.column("process_time").iter();
    let all = times.zip(series.column("quantities.surface_angle"));
    let late: Vec<f64> = all
        .filter(|(time, _)| **time > end - 1.0)
        .map(|(_, angle)| angle.to_degrees())
        .collect();
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    let widest = late.iter().map(|angle| (angle - mean).abs());
    (mean, widest.fold(0.0, f64::max))
}

#[test]
fn a_drum_carries_its_bed_the_higher_the_rougher_it_is() {
    let (rough, swing) = slope(&run("rotating-drum", &["time.end=2 s"]));
    let set = ["time.end=2 s", "contacts[0].friction=0.15"];
    let (smooth, _) = slope(&run("rotating-drum", &set));
    println!("friction 0.5: {rough} degrees, within {swing}; 0.15: {smooth} degrees");
    assert!(
        (30.0..40.0).contains(&rough) && swing < 6.0,
        "{rough} {swing}"
    );
    assert!((10.0..rough - 5.0).contains(&smooth), "{smooth}");
}

#[test]
fn a_drum_has_one_slope_in_native_particles_and_in_liggghts() {
    let out = tempfile::tempdir().unwrap();
    let pairings = "native+native,native+liggghts";
    let comparison = program::compare(
        &shipped("rotating-drum"),
        out.path(),
        pairings,
        &["time.end=2 s"],
    );
    let all = comparison["quantities"].as_array().unwrap();
    let angle = all
        .iter()
        .find(|one| one["name"] == "surface_angle")
        .unwrap();
    let most = angle["largest"]["difference"]
        .as_f64()
        .unwrap()
        .to_degrees();
    println!("largest difference of means over a second: {most} degrees");
    assert!(most < 1.5, "{most} degrees");
}

/// Each of two holes by Beverloo's equation with the bulk density of its own bed: C within what is published for spheres and one
/// standard deviation of the number that runs out in 0.15 s, some 140 and 400 (counted as if each came by itself).
#[test]
fn a_hopper_runs_out_at_the_rate_of_beverloo() {
    let constant = |hole: f64| {
        let radius = format!("walls[1].cone.from_radius={:e} m", 0.5 * hole);
        let out = tempfile::tempdir().unwrap();
        let set = [
            &radius,
            "time.end=0.3 s",
            // Two thirds as many beads, half as heavy a computation.
            "particles[0].place.region.to=95 mm",
        ];
        program::run(&shipped("hopper"), out.path(), &[], &set);
        let series = Series::read(out.path()).unwrap();
        let times = series.column("process_time");
        let gone = series.column("ledger.particle_mass_throughput");
        let at = |time: f64| {
            let row = times.iter().position(|t| *t >= time - 1e-9).unwrap();
            gone[row]
        };
        let (rate, bulk) = ((at(0.3) - at(0.15)) / 0.15, hopper::bulk(out.path()));
        let found = rate / hopper::scale(bulk, hole);
        let scatter = hopper::scatter(0.15 * rate);
        println!("{hole} m: {rate} kg/s, bulk density {bulk} kg/m³, C = {found} ± {scatter:.3}");
        (found, scatter)
    };
    let [narrow, wide] = [0.022, 0.030].map(constant);
    for one in [narrow, wide] {
        assert!(hopper::is_published(one), "{one:?}");
    }
    let apart = narrow.0 / wide.0 - 1.0;
    assert!(
        apart.abs() < 1.5 * narrow.1.hypot(wide.1),
        "{narrow:?} {wide:?}"
    );
}
