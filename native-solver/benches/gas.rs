//! Cell-steps per second of the native gas: windows of a heated bed under free space, from the
//! same committed state, on one thread and on all. `CALCINE_BENCH_LARGE=1` adds a million cells.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Duration;

use common::{Driver, duct, inlet, no_slip, outlet, scatter, setup};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// A duct of about this many cells, its lower half a bed of random void fraction, after its first
/// windows.
fn bed(cells: usize) -> Driver {
    let n = (cells as f64 / 2.0).cbrt().round() as usize;
    let mesh = duct([0.05, 0.05, 0.1], [n, n, 2 * n]);
    let mut setup = setup(&[
        ("bottom", inlet(0.3, 400.0)),
        ("top", outlet()),
        ("side", no_slip()),
    ]);
    setup.controls.outer_iterations = 10;
    setup.controls.outer_tolerance = 1e-6;
    setup.controls.linear_tolerance = Some(1e-10);
    let mut driver = Driver::new(&mesh, &setup);
    let volume = mesh.cell_volume()[0];
    for (cell, share) in scatter(mesh.cells(), 3).into_iter().enumerate() {
        if mesh.cell_centre()[cell].z < 0.05 {
            driver.bed.void_fraction[cell] = 0.4 + 0.1 * share;
            // About what 2 mm spheres do, per volume in kg/m³/s and W/m³/K.
            driver.exchange.drag_coefficient[cell] = 2000.0 * volume;
            driver.exchange.heat_coefficient[cell] = 1e5 * volume;
            driver.exchange.heat_source[cell] = 350.0 * 1e5 * volume;
        }
    }
    for _ in 0..2 {
        driver.window(1e-3, 1.0);
    }
    driver
}

fn windows(criterion: &mut Criterion) {
    let mut sizes = vec![10_000, 100_000];
    if std::env::var_os("CALCINE_BENCH_LARGE").is_some() {
        sizes.push(1_000_000);
    }
    let mut group = criterion.benchmark_group("gas cell-steps");
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(500));
    group.measurement_time(Duration::from_secs(5));
    for threads in [1, rayon::current_num_threads()] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.unwrap();
        for &size in &sizes {
            let mut driver = pool.install(|| bed(size));
            group.throughput(Throughput::Elements(driver.bed.void_fraction.len() as u64));
            let name = BenchmarkId::new(format!("{threads} threads"), size);
            group.bench_function(name, |bencher| {
                bencher.iter(|| pool.install(|| driver.attempt(1e-3, 1.0)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, windows);
criterion_main!(benches);
