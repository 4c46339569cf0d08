//! Particles per second of the base mappings, and cells per second of W and its transpose, for
//! one cube of particles on meshes of 10 k and 100 k cells (`CALCINE_BENCH_LARGE=1`: 1 M too):
//! particles of 0.8, 1.7 and 3.6 cells.
#![allow(clippy::unwrap_used, missing_docs)]

use std::time::Duration;

use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Particles along an edge of the cube.
const ALONG: usize = 27;
/// Edge of the cube in m.
const EDGE: f64 = 1.0;

/// The cube, with this many cells along an edge.
fn cube(along: usize) -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::repeat(EDGE),
        cells: [along; 3],
        patches: ["side"; 6].map(String::from),
    })
    .unwrap()
}

/// Centres and radii in m of spheres that fill 0.48 of the cube, each a little off a lattice by
/// the golden ratio's multiples, so that cells cut them in all ways.
fn spheres() -> (Vec<Vec3>, Vec<f64>) {
    let pitch = EDGE / ALONG as f64;
    let radius = 0.485 * pitch;
    let slack = pitch - 2.0 * radius;
    let count = ALONG.pow(3);
    let centres = (0..count).map(|n| {
        let place = [n % ALONG, n / ALONG % ALONG, n / ALONG / ALONG];
        let share = |k: f64| (n as f64 * 0.618_033_988_749_895 * k).fract();
        Vec3::from_fn(|axis, _| {
            (place[axis] as f64 + 0.5) * pitch + slack * (share(1.0 + axis as f64) - 0.5)
        })
    });
    (centres.collect(), vec![radius; count])
}

fn sizes() -> Vec<usize> {
    let mut sizes = vec![22, 46];
    if std::env::var_os("CALCINE_BENCH_LARGE").is_some() {
        sizes.push(100);
    }
    sizes
}

fn base(criterion: &mut Criterion) {
    let (centres, radii) = spheres();
    let mut group = criterion.benchmark_group("mapping particles");
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(centres.len() as u64));
    let methods = [
        ("centroid", Method::Centroid),
        ("divided", Method::Divided),
        ("overlap", Method::Overlap),
    ];
    for along in sizes() {
        let mesh = cube(along);
        let mapper = Mapper::new(&mesh);
        for (name, method) in methods {
            group.bench_function(BenchmarkId::new(name, mesh.cells()), |bencher| {
                bencher.iter(|| mapper.fill(method, &centres, &radii).unwrap());
            });
        }
    }
    group.finish();
}

/// W of the bed by overlap: with `most`, the threshold that the smoother works against, and a
/// diffusion F over one particle diameter.
fn operator(mesh: &Mesh, most: f64, diffusion: bool) -> Operator {
    let (centres, radii) = spheres();
    let volume: Vec<f64> = radii.iter().map(|&r| sphere::volume(r)).collect();
    let weights = Mapper::new(mesh).fill(Method::Overlap, &centres, &radii);
    let settings = SmootherSettings {
        max_solid_fraction: most,
        diffusion_length: diffusion.then(|| 2.0 * radii[0]),
        ..SmootherSettings::default()
    };
    let smoother = Smoother::new(mesh, settings).unwrap();
    smoother.operator(weights.unwrap(), &volume).unwrap()
}

fn apply(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("W cells");
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(2));
    for along in sizes() {
        let mesh = cube(along);
        group.throughput(Throughput::Elements(mesh.cells() as u64));
        let kinds = [
            ("W0", 0.999, false),
            ("S W0", 0.5, false),
            ("F S W0", 0.5, true),
        ];
        for (name, most, diffusion) in kinds {
            let operator = operator(&mesh, most, diffusion);
            let mut cells = vec![0.0; operator.cells()];
            let mut particles = vec![1.0; operator.particles()];
            group.bench_function(BenchmarkId::new(name, mesh.cells()), |bencher| {
                bencher.iter(|| operator.spread(&particles, &mut cells));
            });
            let transposed = BenchmarkId::new(format!("{name} transposed"), mesh.cells());
            group.bench_function(transposed, |bencher| {
                bencher.iter(|| operator.sample(&cells, &mut particles));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, base, apply);
criterion_main!(benches);
