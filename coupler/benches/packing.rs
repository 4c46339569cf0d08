//! Random packings in a box, by all threads: 52 000 spheres of 2 to 20 mm, even by mass, and 100 000 of one size
//! (`CALCINE_BENCH_LARGE=1`: a million too, which takes some 20 minutes).
#![allow(clippy::unwrap_used, missing_docs)]

use calcine_coupler::packing::{Fill, RandomSpec, Shape, Share, Sizes, random_in_box};
use calcine_coupler::physics::Vec3;
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn packings(criterion: &mut Criterion) {
    let wide = Sizes::Range {
        shape: Shape::Uniform,
        min: 2e-3,
        max: 20e-3,
        share: Share::Mass,
    };
    let equal = Sizes::Equal(1.0);
    let mut cases = vec![
        (&wide, 52_000, 0.55, 0.2),
        (&wide, 52_000, 0.60, 0.2),
        (&equal, 100_000, 0.57, 45.0),
    ];
    if std::env::var_os("CALCINE_BENCH_LARGE").is_some() {
        cases.extend([0.55, 0.57].map(|fraction| (&equal, 1_000_000, fraction, 100.0)));
    }
    let mut group = criterion.benchmark_group("random packings");
    group.sample_size(10);
    for (sizes, number, solid_fraction, width) in cases {
        let spec = RandomSpec {
            sizes: sizes.clone(),
            fill: Fill::Number {
                number,
                solid_fraction,
            },
            seed: 1,
            size_seed: 2,
            periodicity: Default::default(),
        };
        let of = format!("solid fraction {solid_fraction}");
        group.bench_function(BenchmarkId::new(of, number), |bencher| {
            bencher.iter(|| random_in_box(Vec3::zeros(), [width; 2], &spec).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, packings);
criterion_main!(benches);
