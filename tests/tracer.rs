//! Residence times by tagged feeds: parcels that cross a duct at one speed, and a pulse of tracer among them.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

/// Mass flow of the feeds in kg/s.
const RATE: f64 = 0.4e-3;
/// Time in s for which the tracer is fed.
const PULSE: f64 = 10.5e-3;
/// From the middle of the feeds' region to the outlet, in m, at 1 m/s.
const WAY: f64 = 0.17;
/// Room of the centres along the duct, in m.
const ROOM: f64 = 0.02 - 0.2e-3;
const WINDOW: f64 = 1e-3;

#[test]
fn residence_times_and_a_pulse_of_tracer_are_those_of_flight_at_one_speed() {
    let folder = tempfile::tempdir().unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/tracer.toml");
    // Killed and resumed, as ages and totals are part of the checkpoint.
    let out = killed::resumes_to_the_same_bits(folder.path(), &[150, 300], |out| {
        program::command(&case, out, &[], &["time.checkpoint.every=20 ms"])
    });
    let summary = Summary::read(&out).unwrap();
    let value = |name: &str| summary.quantities[name].value.unwrap();
    // Particles are looked at where windows begin: half of one late, on average.
    let mean = WAY + 0.5 * WINDOW;
    println!("{} s for {mean} s", value("stay"));
    let deviation = (ROOM.powi(2) / 12.0 + WINDOW.powi(2) / 12.0).sqrt();
    // 2000 parcels left: means are good to a fortieth of the deviation.
    assert!((value("stay") - mean).abs() < 0.1 * deviation);
    println!("{} s for {deviation} s", value("spread"));
    assert!((value("spread") / deviation - 1.0).abs() < 0.06);
    assert!((value("tracer_stay") - mean).abs() < 0.3 * deviation);
    // What of the pulse was fed comes out whole, with the one of the start, to half a parcel at either end.
    let parcel = 10.0 * PI / 6.0 * 0.2e-3_f64.powi(3) * 1000.0;
    let pulse = RATE * PULSE;
    let out_of_it = value("tracer") - parcel;
    println!("{out_of_it} kg of {pulse} kg");
    assert!((out_of_it - pulse).abs() < 1.01 * parcel);
    // The curve of the tracer: none before and after it can have come.
    let series = Series::read(&out).unwrap();
    let (times, flow) = (
        series.column("process_time"),
        series.column("quantities.tracer_flow"),
    );
    let (first, last) = (0.05 + WAY - 0.01, 0.05 + PULSE + WAY + 0.01);
    let own = times.iter().zip(flow).filter(|(time, _)| **time > 0.1);
    let mut area = 0.0;
    for (time, flow) in own {
        let inside = *time > first && *time < last + 4.0 * WINDOW;
        assert!(inside || *flow == 0.0, "{time}: {flow}");
        area += flow * WINDOW;
    }
    println!("{area} kg under the curve");
    assert!((area - out_of_it).abs() < 1e-9 * pulse, "{area}");
}
