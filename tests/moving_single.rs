//! One particle that moves in LIGGGHTS: verification against the drag law's own terminal velocity.
//! LIGGGHTS takes part: `cargo xtask test` builds its host.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/moving.rs"]
mod moving;

use calcine::results::Summary;
use calcine::results::read::Series;
use moving::{case, refused, run};

/// Terminal velocity in m/s of the bead of cases/settling-sphere.toml by Wen and Yu's law in the limit of a
/// lone sphere (Schiller and Naumann), evaluated apart by bisection: (m − ρV) g = 3πμd(1 + 0.15
/// Re^0.687) u with air of 28.96 g/mol at 300 K and 1 atm, and Sutherland's viscosity.
fn terminal() -> f64 {
    let (d, solid) = (1e-4, 2500.0);
    let density = 101_325.0 * 0.028_96 / (8.314_462_618 * 300.0);
    let viscosity = 1.716e-5 * (300.0f64 / 273.15).powf(1.5) * (273.15 + 110.4) / (300.0 + 110.4);
    let weight = std::f64::consts::PI / 6.0 * f64::powi(d, 3) * (solid - density) * 9.81;
    let drag = |u: f64| {
        let re = density * u * d / viscosity;
        3.0 * std::f64::consts::PI * viscosity * d * (1.0 + 0.15 * re.powf(0.687)) * u
    };
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if drag(middle) < weight {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn a_bead_settles_at_the_terminal_velocity_of_the_law_where_the_gas_is_held() {
    let directory = tempfile::tempdir().unwrap();
    run(&case("settling-sphere"), directory.path(), &[]);
    let series = Series::read(directory.path()).unwrap();
    let speed = *series.column("quantities.speed").last().unwrap();
    let expected = terminal();
    println!("terminal velocity {speed} m/s, by the law {expected} m/s");
    assert!((speed / expected - 1.0).abs() < 0.01, "{speed} {expected}");
    let summary = Summary::read(directory.path()).unwrap();
    assert!(summary.ledger.lines["momentum"].relative_error < 1e-12);
}

#[test]
fn windows_longer_than_the_beads_own_time_relax_without_overshoot() {
    let directory = tempfile::tempdir().unwrap();
    // m/K is 57 ms: a window of it and half of it more.
    let set = [
        "time.motion_window=80 ms",
        "time.end=0.48 s",
        "output.series_every=80 ms",
    ];
    run(&case("settling-sphere"), directory.path(), &set);
    let series = Series::read(directory.path()).unwrap();
    let speeds = series.column("quantities.speed");
    let expected = terminal();
    println!("{speeds:?} {expected}");
    assert!(
        speeds.iter().all(|speed| *speed < 1.02 * expected),
        "{speeds:?}"
    );
    assert!(
        (speeds.last().unwrap() / expected - 1.0).abs() < 0.02,
        "{speeds:?}"
    );
}

#[test]
fn a_bead_drags_the_air_of_its_cells_along_where_the_gas_is_solved() {
    let directory = tempfile::tempdir().unwrap();
    let set = ["gas.held=false"];
    run(&case("settling-sphere"), directory.path(), &set);
    let series = Series::read(directory.path()).unwrap();
    let speed = *series.column("quantities.speed").last().unwrap();
    println!("two-way: {speed} m/s against {} m/s of the law", terminal());
    // The cells are 100 diameters wide: the disturbance is small, and always to the faster side.
    assert!(
        speed > 0.99 * terminal() && speed < 1.1 * terminal(),
        "{speed}"
    );
    let summary = Summary::read(directory.path()).unwrap();
    for line in ["mass", "energy", "momentum"] {
        let error = summary.ledger.lines[line].relative_error;
        assert!(error < 1e-10, "{line} {error}");
    }
}

#[test]
fn what_liggghts_does_not_have_is_refused_with_the_reason() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    let set = ["motion.contact.law=spring-slider-dashpot"];
    let text = refused(&case("settling-sphere"), &out, &set);
    assert!(
        text.contains("has no contact law \"spring-slider-dashpot\""),
        "{text}"
    );
    let text = refused(
        &case("settling-sphere"),
        &out,
        &["motion.motion_step=10 us"],
    );
    assert!(
        text.contains("a surface wave crosses the smallest particle"),
        "{text}"
    );
}
