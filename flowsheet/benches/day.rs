//! A day of the granulation plant that oscillates (docs/theory.md, FLS-V4) at a slope of 20, 200 size classes: undisturbed, and
//! with a disturbance each hour; growth alone, and with aggregation of all pairs. One thread.
#![allow(clippy::unwrap_used, clippy::panic, dead_code, missing_docs)]

#[path = "../tests/plants.rs"]
mod plants;
#[path = "../tests/support.rs"]
mod support;

use std::time::Duration;

use calcine_flowsheet::population::{Aggregation, ConstantKernel};
use calcine_flowsheet::{Integrator, PlantRun, Timetable};
use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use plants::{hourly, oscillating};

fn day(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("plant day");
    // One run a sample: a day takes seconds, and ten runs tell how far they scatter.
    group
        .sample_size(10)
        .sampling_mode(SamplingMode::Flat)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(1));
    for (name, spray) in [
        ("steady spray", Timetable::constant(1.0)),
        ("hourly", hourly()),
    ] {
        // β₀ N is about 1/(20 000 s): weak enough for the bed to go on oscillating.
        for (what, rate) in [("growth", 0.0), ("growth and aggregation", 1e-11)] {
            let plant = oscillating(200, 20.0, spray.clone(), |bed| {
                if rate == 0.0 {
                    return bed;
                }
                bed.with_process(Box::new(Aggregation::new(Box::new(ConstantKernel {
                    rate,
                }))))
            });
            // With aggregation at 1e-3 alone, so that all is done in some minutes.
            let tolerances: &[f64] = if rate == 0.0 { &[1e-3, 1e-4] } else { &[1e-3] };
            for &tolerance in tolerances {
                group.bench_function(
                    format!("{name}, {what}, tolerance {tolerance:e}"),
                    |bench| {
                        bench.iter(|| {
                            let mut run =
                                PlantRun::new(&plant, Integrator::Stabilised, tolerance).unwrap();
                            run.advance(86_400.0).unwrap();
                            run.steps()
                        });
                    },
                );
            }
        }
    }
    group.finish();
}

criterion_group!(benches, day);
criterion_main!(benches);
