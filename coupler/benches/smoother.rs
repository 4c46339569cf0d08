//! The smoother of a bed of one particle to ten cells that fills the lower 0.7 of a cube, on meshes of 10 k
//! and 100 k cells (`CALCINE_BENCH_LARGE=1`: 1 M cells and 100 k particles too):
//!
//! - `smoother sweeps`: per active cell and sweep, S against plain Jacobi sweeps over all faces;
//! - `smoother beds`: per cell, from solid volumes to S, against plain Jacobi sweeps down to an excess
//!   of 1e-4 of the solid volume, and against the diffusion of usual codes, which solves
//!   (I − ∇·ℓ²∇) α = α₀ for the whole field (and leaves maxima above the threshold);
//! - `smoother W`: per cell and field, W and its transpose.
//!
//! How many sweeps each took is printed beforehand.
#![allow(clippy::unwrap_used, missing_docs)]

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::{Duration, Instant};

use calcine_coupler::mapping::{Mapper, Method, Weights};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};
use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};

/// Height of the bed; the cube's edge is 1 m.
const HEIGHT: f64 = 0.7;
const THRESHOLD: f64 = 0.64;

struct Bed {
    mesh: Mesh,
    centres: Vec<Vec3>,
    radius: f64,
}

impl Bed {
    /// Spheres near a lattice, each off it by the golden ratio's multiples so that cells cut
    /// them in all ways; so large that the bed has this mean solid fraction.
    fn new(along: usize, mean: f64) -> Self {
        let mesh = box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::repeat(1.0),
            cells: [along; 3],
            patches: ["side"; 6].map(String::from),
        })
        .unwrap();
        let pitch = (10.0 * HEIGHT).cbrt() / along as f64;
        let across = (1.0 / pitch) as usize;
        let layers = (HEIGHT / pitch) as usize;
        let (across_pitch, layer_pitch) = (1.0 / across as f64, HEIGHT / layers as f64);
        let count = across * across * layers;
        let centres = (0..count).map(|n| {
            let place = [n % across, n / across % across, n / across / across];
            let off = |k: f64| 0.3 * ((n as f64 * 0.618_033_988_749_895 * k).fract() - 0.5);
            Vec3::new(
                (place[0] as f64 + 0.5 + off(1.0)) * across_pitch,
                (place[1] as f64 + 0.5 + off(2.0)) * across_pitch,
                (place[2] as f64 + 0.5 + off(3.0)) * layer_pitch,
            )
        });
        Self {
            mesh,
            centres: centres.collect(),
            radius: (mean * HEIGHT / count as f64 * 0.75 / PI).cbrt(),
        }
    }

    fn weights(&self) -> Weights {
        let radii = vec![self.radius; self.centres.len()];
        let mapper = Mapper::new(&self.mesh);
        mapper.fill(Method::Overlap, &self.centres, &radii).unwrap()
    }

    fn solid_volumes(&self) -> Vec<f64> {
        vec![sphere::volume(self.radius); self.centres.len()]
    }

    /// Solid volume of each cell by W₀.
    fn solid(&self) -> Vec<f64> {
        let volume = sphere::volume(self.radius);
        let weights = self.weights();
        let of = |cell| weights.of_cell(cell).map(|(_, share)| share * volume).sum();
        (0..self.mesh.cells()).map(of).collect()
    }
}

/// S alone: one particle per cell.
fn kernel(smoother: &Smoother, mesh: &Mesh, solid: &[f64]) -> Operator {
    let rows = (0..mesh.cells()).map(|cell| vec![(cell as u32, 1.0)]);
    let weights = Weights::new(mesh.cells(), rows.collect()).unwrap();
    smoother.operator(weights, solid).unwrap()
}

/// Faces and conductances, for the usual codes' loops.
struct Faces {
    cells: Vec<(usize, usize, f64)>,
    total: Vec<f64>,
    volume: Vec<f64>,
}

impl Faces {
    fn new(mesh: &Mesh) -> Self {
        let mut total = vec![0.0; mesh.cells()];
        let faces = mesh.neighbour().iter().enumerate().map(|(face, &b)| {
            let (a, b) = (mesh.owner()[face] as usize, b as usize);
            let distance = (mesh.cell_centre()[b] - mesh.cell_centre()[a]).norm();
            let conductance = mesh.face_area()[face].norm() / distance;
            total[a] += conductance;
            total[b] += conductance;
            (a, b, conductance)
        });
        Self {
            cells: faces.collect(),
            total,
            volume: mesh.cell_volume().to_vec(),
        }
    }

    /// Plain Jacobi sweeps; returns how many, and how many cells passed something on.
    fn sweep(&self, solid: &mut [f64], most: usize) -> (usize, usize) {
        let allowed = 1e-4 * solid.iter().sum::<f64>();
        let mut passed = vec![false; solid.len()];
        let mut pressure = vec![0.0; solid.len()];
        for sweep in 0..most {
            let mut excess_in_all = 0.0;
            for cell in 0..solid.len() {
                let excess = (solid[cell] - THRESHOLD * self.volume[cell]).max(0.0);
                excess_in_all += excess;
                passed[cell] |= excess > 0.0;
                pressure[cell] = excess / self.total[cell];
            }
            if excess_in_all <= allowed {
                return (sweep, passed.iter().filter(|&&passed| passed).count());
            }
            for &(a, b, conductance) in &self.cells {
                let flux = (pressure[a] - pressure[b]) * conductance;
                solid[a] -= flux;
                solid[b] += flux;
            }
        }
        (most, passed.iter().filter(|&&passed| passed).count())
    }

    /// (V + ℓ² L) α = V α₀ by conjugate gradients with the diagonal, to 1e-6; returns the steps.
    fn diffuse(&self, solid: &[f64], length: f64, alpha: &mut [f64]) -> usize {
        let square = length * length;
        let apply = |x: &[f64], out: &mut [f64]| {
            for cell in 0..x.len() {
                out[cell] = self.volume[cell] * x[cell];
            }
            for &(a, b, conductance) in &self.cells {
                let flux = square * conductance * (x[a] - x[b]);
                out[a] += flux;
                out[b] -= flux;
            }
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let precondition = |r: &[f64]| -> Vec<f64> {
            let diagonal = |cell: usize| self.volume[cell] + square * self.total[cell];
            r.iter().enumerate().map(|(c, r)| r / diagonal(c)).collect()
        };
        let mut image = vec![0.0; solid.len()];
        for cell in 0..solid.len() {
            alpha[cell] = solid[cell] / self.volume[cell];
        }
        apply(alpha, &mut image);
        let mut residual: Vec<f64> = solid.iter().zip(&image).map(|(b, a)| b - a).collect();
        let mut through = precondition(&residual);
        let mut direction = through.clone();
        let mut size = dot(&residual, &through);
        let enough = 1e-12 * size;
        let mut steps = 0;
        while size > enough {
            apply(&direction, &mut image);
            let alpha_step = size / dot(&direction, &image);
            for cell in 0..solid.len() {
                alpha[cell] += alpha_step * direction[cell];
                residual[cell] -= alpha_step * image[cell];
            }
            through = precondition(&residual);
            let next = dot(&residual, &through);
            for cell in 0..solid.len() {
                direction[cell] = through[cell] + next / size * direction[cell];
            }
            size = next;
            steps += 1;
        }
        steps
    }
}

fn sizes() -> Vec<usize> {
    let mut sizes = vec![22, 46];
    if std::env::var_os("CALCINE_BENCH_LARGE").is_some() {
        sizes.push(100);
    }
    sizes
}

fn group<'c>(criterion: &'c mut Criterion, name: &str) -> BenchmarkGroup<'c, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(2));
    group
}

fn settings() -> SmootherSettings {
    SmootherSettings {
        max_solid_fraction: THRESHOLD,
        ..SmootherSettings::default()
    }
}

fn sweeps(criterion: &mut Criterion) {
    let mut group = group(criterion, "smoother sweeps");
    for along in sizes() {
        let bed = Bed::new(along, 0.60);
        let (solid, faces) = (bed.solid(), Faces::new(&bed.mesh));
        let smoother = Smoother::new(&bed.mesh, settings()).unwrap();
        let cells = bed.mesh.cells();

        let (plain, passed) = faces.sweep(&mut solid.clone(), 100_000);
        eprintln!("{cells} cells: {plain} plain sweeps, {passed} cells pass something on");
        group.throughput(Throughput::Elements((plain * passed) as u64));
        group.bench_function(BenchmarkId::new("plain Jacobi", cells), |bencher| {
            bencher.iter(|| faces.sweep(&mut solid.clone(), 100_000));
        });

        let operator = kernel(&smoother, &bed.mesh, &solid);
        let (count, active) = (operator.sweeps(), operator.active_cells());
        let multigrid = operator.is_multigrid();
        eprintln!("{cells} cells: S of {active} cells, {count} steps, multigrid: {multigrid}");
        let mut out = vec![0.0; cells];
        group.throughput(Throughput::Elements(u64::from(count) * active as u64));
        group.bench_function(BenchmarkId::new("S", cells), |bencher| {
            bencher.iter(|| operator.spread(&solid, &mut out));
        });
    }
    group.finish();
}

fn beds(criterion: &mut Criterion) {
    let mut group = group(criterion, "smoother beds");
    for along in sizes() {
        for mean in [0.60, 0.635] {
            let bed = Bed::new(along, mean);
            let (solid, faces) = (bed.solid(), Faces::new(&bed.mesh));
            let smoother = Smoother::new(&bed.mesh, settings()).unwrap();
            let cells = bed.mesh.cells();
            group.throughput(Throughput::Elements(cells as u64));
            let name = |what: &str| BenchmarkId::new(format!("{what} at {mean}"), cells);
            let operator = kernel(&smoother, &bed.mesh, &solid);
            let kind = if operator.is_multigrid() {
                "cycles"
            } else {
                "sweeps"
            };
            eprintln!("{cells} cells at {mean}: S in {} {kind}", operator.sweeps());
            let (weights, volumes) = (bed.weights(), bed.solid_volumes());
            group.bench_function(name("S"), |bencher| {
                bencher.iter(|| smoother.operator(weights.clone(), &volumes).unwrap());
            });
            let most = 200_000_000 / cells;
            let begun = Instant::now();
            let (count, _) = faces.sweep(&mut solid.clone(), most);
            let took = begun.elapsed();
            eprintln!("{cells} cells at {mean}: {count} plain sweeps (at most {most}) in {took:?}");
            if mean < 0.61 {
                group.bench_function(name("plain Jacobi"), |bencher| {
                    bencher.iter(|| faces.sweep(&mut solid.clone(), most));
                });
                // As wide as usual: three particle diameters.
                let mut alpha = vec![0.0; cells];
                let length = 6.0 * bed.radius;
                let steps = faces.diffuse(&solid, length, &mut alpha);
                let highest = alpha.iter().copied().fold(0.0, f64::max);
                eprintln!("{cells} cells: diffusion in {steps} steps, largest fraction {highest}");
                group.bench_function(name("diffusion"), |bencher| {
                    bencher.iter(|| black_box(faces.diffuse(&solid, length, &mut alpha)));
                });
            }
        }
    }
    group.finish();
}

fn fields(criterion: &mut Criterion) {
    let mut group = group(criterion, "smoother W");
    for along in sizes() {
        for mean in [0.60, 0.635] {
            let bed = Bed::new(along, mean);
            let smoother = Smoother::new(&bed.mesh, settings()).unwrap();
            let operator = smoother.operator(bed.weights(), &bed.solid_volumes());
            let operator = operator.unwrap();
            let cells = bed.mesh.cells();
            let mut field = vec![0.0; cells];
            let mut seen = vec![1.0; operator.particles()];
            group.throughput(Throughput::Elements(cells as u64));
            group.bench_function(
                BenchmarkId::new(format!("spread at {mean}"), cells),
                |bencher| bencher.iter(|| operator.spread(&seen, &mut field)),
            );
            group.bench_function(
                BenchmarkId::new(format!("sample at {mean}"), cells),
                |bencher| bencher.iter(|| operator.sample(&field, &mut seen)),
            );
            let mut vectors = vec![Vec3::zeros(); cells];
            let carried = vec![Vec3::repeat(1.0); operator.particles()];
            group.throughput(Throughput::Elements(3 * cells as u64));
            group.bench_function(
                BenchmarkId::new(format!("spread vectors at {mean}"), cells),
                |bencher| bencher.iter(|| operator.spread_vectors(&carried, &mut vectors)),
            );
        }
    }
    group.finish();
}

criterion_group!(benches, sweeps, beds, fields);
criterion_main!(benches);
