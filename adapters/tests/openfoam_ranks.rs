//! calcineGasFoam on several ranks: the same gas as on one, balances that close, checkpoints that any
//! number of ranks can take up, and the death of each process.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout
)]

use std::path::Path;
use std::time::{Duration, Instant};

use calcine_coupler::error::FailureKind;
use calcine_coupler::part::{Balance, Bed, CellExchange, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasPatch, GasSetup, Schedule, WallHeat};
use rustix::process::{Pid, Signal, kill_process};

use crate::openfoam_support::{Duct, exchange_of_nothing, mesh, setup, stop};

/// Cells of the bed along x, y, z: two ranks lie above each other, four also side by side.
const DIVISION: [usize; 3] = [3, 3, 8];
const CELLS: usize = 3 * 3 * 8;

/// A number in [0, 1) that looks random.
fn noise(cell: usize, salt: u64) -> f64 {
    let mixed = (cell as u64 + 977 * salt).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 40) as f64 / (1u64 << 24) as f64
}

fn bed() -> Bed {
    Bed {
        void_fraction: (0..CELLS).map(|cell| 0.45 + 0.2 * noise(cell, 1)).collect(),
    }
}

/// Hot, irregular particles that hold the gas up.
fn heating() -> CellExchange {
    let mut exchange = exchange_of_nothing(CELLS);
    for cell in 0..CELLS {
        let heat = 1e-3 * (0.5 + noise(cell, 2));
        exchange.heat_coefficient[cell] = heat;
        exchange.heat_source[cell] = heat * (350.0 + 100.0 * noise(cell, 3));
        exchange.drag_coefficient[cell] = 1e-5 * (0.5 + noise(cell, 4));
        exchange.drag_source[cell] = Vec3::new(1e-7 * noise(cell, 5), 0.0, 0.0);
    }
    exchange
}

/// Air under gravity between rough walls, one of which loses heat.
fn heated() -> GasSetup {
    let mut setup = setup();
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    for (name, patch) in &mut setup.patches {
        if let (true, GasPatch::Wall { heat, .. }) = (name == "side", patch) {
            *heat = WallHeat::Convective {
                coefficient: Schedule::constant(20.0),
                ambient: Schedule::constant(290.0),
            };
        }
    }
    setup
}

fn launch(ranks: u32, setup: &GasSetup, folder: &Path, resume: Option<&Path>) -> Duct {
    Duct::try_launch_on_ranks(ranks, mesh(DIVISION), setup, folder, resume)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn closure(balance: &Balance) -> f64 {
    let error = balance.stored - balance.boundary - balance.exchange - balance.source;
    let terms = balance.stored_magnitude
        + balance.boundary_magnitude
        + balance.exchange.abs()
        + balance.source_magnitude;
    error.abs() / terms
}

/// Largest difference of a field over its largest value.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let largest = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let pairs = one.iter().zip(other);
    pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest.max(f64::MIN_POSITIVE)
}

fn flat(vectors: &[Vec3]) -> Vec<f64> {
    vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

/// The solver's linear tolerance here is 1e-13 of what flows and its outer one 1e-11; what is left of
/// another order of the sums is a thousand times that.
fn assert_same(one: &Duct, other: &Duct) {
    let (a, b) = (one.gas.fields(), other.gas.fields());
    let pressure = |fields: &[f64]| fields.iter().map(|p| p - 101_325.0).collect::<Vec<f64>>();
    for (name, difference) in [
        ("temperature", apart(a.temperature, b.temperature)),
        ("density", apart(a.density, b.density)),
        (
            "pressure",
            apart(&pressure(a.pressure), &pressure(b.pressure)),
        ),
        ("velocity", apart(&flat(a.velocity), &flat(b.velocity))),
        (
            "pressure gradient",
            apart(&flat(a.pressure_gradient), &flat(b.pressure_gradient)),
        ),
        ("heat", apart(&one.received.heat, &other.received.heat)),
        (
            "drag",
            apart(&flat(&one.received.drag), &flat(&other.received.drag)),
        ),
    ] {
        println!("{name}: {difference:.1e}");
        assert!(difference < 1e-8, "{name} differs by {difference:.1e}");
    }
}

fn assert_closed(duct: &Duct, tolerance: f64) {
    let received = &duct.received;
    let momentum = received.momentum.iter();
    for balance in [&received.mass, &received.energy]
        .into_iter()
        .chain(momentum)
    {
        let error = closure(balance);
        assert!(error < tolerance, "{error:.1e} of {balance:?}");
    }
}

#[test]
fn two_three_and_four_ranks_compute_the_gas_of_one_and_their_balances_close() {
    let folder = tempfile::tempdir().unwrap();
    let mut one = launch(1, &heated(), &folder.path().join("1"), None);
    one.advance(4, &bed(), &heating());
    assert_closed(&one, 1e-10);
    for ranks in [2, 3, 4] {
        let mut more = launch(
            ranks,
            &heated(),
            &folder.path().join(ranks.to_string()),
            None,
        );
        assert_eq!(more.gas.about().ranks, ranks as usize);
        more.advance(4, &bed(), &heating());
        assert_closed(&more, 1e-10);
        assert_same(&one, &more);
        more.gas.finish_run(&more.supervisor).unwrap();
    }
}

#[test]
fn a_closed_vessel_has_one_pressure_on_all_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let mut shut = heated();
    shut.velocity = Vec3::zeros();
    stop(&mut shut);
    for (_, patch) in &mut shut.patches {
        if let GasPatch::Outlet { .. } = patch {
            *patch = GasPatch::Wall {
                velocity: calcine_coupler::setup::WallVelocity::NoSlip,
                heat: WallHeat::Adiabatic,
            };
        }
    }
    let mut one = launch(1, &shut, &folder.path().join("1"), None);
    let mut two = launch(2, &shut, &folder.path().join("2"), None);
    one.advance(3, &bed(), &heating());
    two.advance(3, &bed(), &heating());
    // What stirs in a closed vessel is small against what its pressure holds up.
    assert_closed(&two, 1e-9);
    let (a, b) = (one.gas.fields(), two.gas.fields());
    assert!(apart(a.temperature, b.temperature) < 1e-8);
    assert!(a.pressure[0] > 102_000.0, "{}", a.pressure[0]);
    assert!(apart(a.pressure, b.pressure) < 1e-9);
}

#[test]
fn a_checkpoint_of_two_ranks_goes_on_with_the_same_bits_on_two_and_nearly_so_on_one() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("checkpoint/gas");
    let mut two = launch(2, &heated(), &folder.path().join("2"), None);
    two.advance(2, &bed(), &heating());
    two.gas.checkpoint(&checkpoint).unwrap();
    let window = two.window;
    two.advance(2, &bed(), &heating());
    for ranks in [2, 1] {
        let other = folder
            .path()
            .join(format!("resumed on {ranks}").replace(' ', "-"));
        let mut resumed = launch(ranks, &heated(), &other, Some(&checkpoint));
        resumed.window = window;
        resumed.advance(2, &bed(), &heating());
        if ranks == 2 {
            assert_eq!(resumed.bits(), two.bits());
        }
        assert_same(&two, &resumed);
    }
}

#[test]
fn a_rank_that_is_killed_or_its_mpirun_is_named_within_a_second() {
    for launcher in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let mut duct = launch(2, &heated(), folder.path(), None);
        duct.advance(1, &bed(), &heating());
        let ranks = duct.gas.rank_pids().to_vec();
        assert_eq!(ranks.len(), 2);
        let (victim, name) = if launcher {
            (duct.gas.pid(), "OpenFOAM (gas, launcher)")
        } else {
            (ranks[1], "OpenFOAM (gas, rank 1)")
        };
        kill_process(Pid::from_raw(victim.cast_signed()).unwrap(), Signal::KILL).unwrap();
        let begun = Instant::now();
        // The ranks of a killed mpirun may finish the window at hand.
        let error = loop {
            let started = duct.gas.start(&duct.window, &bed(), &heating());
            let finished = started.and_then(|()| {
                duct.supervisor.check(Some(&duct.window))?;
                duct.gas
                    .finish(&duct.supervisor, &mut duct.received)
                    .map(|_| ())
            });
            if let Err(error) = finished {
                break error;
            }
        };
        assert!(begun.elapsed() < Duration::from_secs(1));
        assert_eq!(error.kind, FailureKind::Died, "{error}");
        let text = error.to_string();
        assert!(text.contains(name), "{text}");
        assert!(text.contains(&format!("pid {victim}")), "{text}");
        drop(duct);
        assert!(begun.elapsed() < Duration::from_secs(5));
        for pid in ranks {
            let stat = std::fs::read_to_string(format!("/proc/{pid}/stat"));
            assert!(
                stat.is_err() || stat.is_ok_and(|stat| stat.contains(") Z ")),
                "{pid}"
            );
        }
    }
}
