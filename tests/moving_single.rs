//! One particle that moves in LIGGGHTS: verification against the drag law's own terminal velocity.
//! LIGGGHTS takes part: `cargo xtask test` builds its host.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::moving::{case, refused, run};
use crate::support::schiller_naumann::Sphere;

/// The bead of cases/settling-sphere.toml.
fn bead() -> Sphere {
    Sphere::in_air(1e-4, 2500.0)
}

#[test]
fn a_bead_settles_at_the_terminal_velocity_of_the_law_where_the_gas_is_held() {
    let directory = tempfile::tempdir().unwrap();
    run(&case("settling-sphere"), directory.path(), &[]);
    let series = Series::read(directory.path()).unwrap();
    let speed = *series.column("quantities.speed").last().unwrap();
    let expected = bead().terminal();
    println!("terminal velocity {speed} m/s, by the law {expected} m/s");
    // After 0.4 s, seven of its own times of 57 ms, e^-7 = 9e-4 is left of the way to it.
    let left = 1.0 - speed / expected;
    assert!((0.0..2e-3).contains(&left), "{speed} {expected}");
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
    let expected = bead().terminal();
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
    println!(
        "two-way: {speed} m/s against {} m/s of the law",
        bead().terminal()
    );
    // The cells are 100 diameters wide, h: air pulled by 3πμdv within one moves by some 3πμdv/(2πμh) = 1.5 % of the speed at
    // the most, and always to the faster side; below, what is left of the way to the terminal velocity.
    let over = speed / bead().terminal() - 1.0;
    assert!((-2e-3..0.015).contains(&over), "{speed}");
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
