//! Packed beds by geometry.

#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_4, PI, SQRT_2};

use calcine_coupler::contacts::touching;
use calcine_coupler::packing::regular::{
    Lattice, hexagonal_close, regular_in_box, regular_in_cylinder, simple_cubic,
};
use calcine_coupler::packing::{
    Fill, Packing, PackingError, RandomSpec, Shape, Share, Sizes, random_in_box, random_in_cylinder,
};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::Vec3;

const TUBE: f64 = 0.05;
const GRAIN: f64 = 0.08 * TUBE;

fn spec(seed: u64) -> RandomSpec {
    RandomSpec {
        sizes: Sizes::Equal(GRAIN),
        fill: Fill::Number {
            number: 3000,
            solid_fraction: 0.58,
        },
        seed,
        size_seed: seed,
        periodicity: Default::default(),
    }
}

fn mixture(parts: Vec<(f64, f64)>, share: Share) -> Sizes {
    Sizes::Mixture { parts, share }
}

fn range(shape: Shape, min: f64, max: f64) -> Sizes {
    let share = Share::Number;
    Sizes::Range {
        shape,
        min,
        max,
        share,
    }
}

fn bed(seed: u64) -> Packing {
    random_in_cylinder(Vec3::zeros(), TUBE, &spec(seed)).unwrap()
}

/// Smallest gap between two surfaces over the sum of radii; every pair, independent of the cells.
fn smallest_gap(packing: &Packing) -> f64 {
    let mut gap = f64::INFINITY;
    for (a, first) in packing.centres.iter().enumerate() {
        for (b, second) in packing.centres.iter().enumerate().skip(a + 1) {
            let contact = 0.5 * (packing.diameters[a] + packing.diameters[b]);
            gap = gap.min((first - second).norm() / contact - 1.0);
        }
    }
    gap
}

/// Share of solid on a cylinder surface at `radius`, between two heights, by sampling.
fn solid_at(packing: &Packing, radius: f64, low: f64, high: f64) -> f64 {
    let (turns, steps) = (90, 120);
    let mut hits = 0;
    for k in 0..steps {
        let z = low + (high - low) * (k as f64 + 0.5) / steps as f64;
        let near: Vec<_> = packing
            .centres
            .iter()
            .filter(|c| (c.z - z).abs() < 0.5 * GRAIN)
            .collect();
        for t in 0..turns {
            let angle = 2.0 * PI * t as f64 / turns as f64;
            let point = Vec3::new(radius * angle.cos(), radius * angle.sin(), z);
            let solid = |c: &&Vec3| (*c - point).norm_squared() < 0.25 * GRAIN * GRAIN;
            hits += usize::from(near.iter().any(solid));
        }
    }
    hits as f64 / (turns * steps) as f64
}

#[test]
fn a_random_bed_has_its_solid_fraction_no_overlap_and_lies_inside() {
    let bed = bed(1);
    assert_eq!(bed.centres.len(), 3000);
    assert!(smallest_gap(&bed) > -1e-12, "{}", smallest_gap(&bed));
    for c in &bed.centres {
        assert!(c.x.hypot(c.y) <= 0.5 * (TUBE - GRAIN) + 1e-15);
        assert!(c.z >= 0.5 * GRAIN - 1e-15 && c.z <= bed.height - 0.5 * GRAIN + 1e-15);
    }
    let fraction = bed.volume() / (FRAC_PI_4 * TUBE * TUBE * bed.height);
    assert!((fraction - 0.58).abs() < 1e-12);
}

#[test]
fn the_bulk_is_denser_than_the_mean_and_looser_than_random_close() {
    let bed = bed(1);
    let (mut sum, mut weight) = (0.0, 0.0);
    for i in 0..40 {
        let radius = (0.5 * TUBE - 2.0 * GRAIN) * (i as f64 + 0.5) / 40.0;
        sum += radius * solid_at(&bed, radius, 3.0 * GRAIN, bed.height - 3.0 * GRAIN);
        weight += radius;
    }
    let bulk = sum / weight;
    assert!(bulk > 0.58 && bulk < 0.65, "{bulk}");
}

#[test]
fn a_seed_fixes_every_bit_and_another_gives_another_bed() {
    assert_eq!(bed(7), bed(7));
    assert_ne!(bed(7), bed(8));
}

/// As measured by Benenati and Brosilow (AIChE J. 8, 1962, 359): void 1 at the wall, its first
/// minimum near half a diameter, a maximum near one.
#[test]
fn the_void_fraction_oscillates_at_the_wall() {
    let bed = bed(1);
    let void = |i: usize| {
        let radius = 0.5 * TUBE - 0.05 * GRAIN * i as f64;
        1.0 - solid_at(&bed, radius, 3.0 * GRAIN, bed.height - 3.0 * GRAIN)
    };
    let profile: Vec<f64> = (0..=24).map(void).collect();
    let lowest = (0..=20).min_by(|&a, &b| profile[a].total_cmp(&profile[b]));
    let at = 0.05 * lowest.unwrap() as f64;
    assert!(profile[0] > 0.95, "{profile:?}");
    assert!((at - 0.5).abs() <= 0.15, "{at}: {profile:?}");
    let highest = profile[16..].iter().copied().fold(0.0, f64::max);
    assert!(highest > profile[lowest.unwrap()] + 0.15, "{profile:?}");
}

#[test]
fn contacts_point_in_all_directions_alike() {
    let mut spec = spec(3);
    spec.sizes = Sizes::Equal(1.0);
    let bed = random_in_box(Vec3::zeros(), [14.0, 14.0], &spec).unwrap();
    let bulk = |c: &Vec3| {
        (0..2).all(|axis| c[axis] > 2.5 && c[axis] < 11.5) && c.z > 2.5 && c.z < bed.height - 2.5
    };
    let (mut squares, mut count) = (Vec3::zeros(), 0.0);
    for (a, first) in bed.centres.iter().enumerate().filter(|(_, c)| bulk(c)) {
        for (b, second) in bed.centres.iter().enumerate() {
            let line = second - first;
            if a != b && line.norm() < 1.05 {
                squares += line.normalize().map(|x| x * x);
                count += 1.0;
            }
        }
    }
    // Each mean square is 1/3, with a deviation of √(4/45/count): 0.005 for 4000 contacts.
    assert!(count > 3000.0, "{count}");
    for axis in 0..3 {
        assert!(
            (squares[axis] / count - 1.0 / 3.0).abs() < 0.025,
            "{squares} {count}"
        );
    }
}

#[test]
fn mixed_sizes_fill_a_box_to_a_height() {
    let mut spec = spec(5);
    spec.sizes = mixture(vec![(1.0, 1.0), (2.0, 1.0)], Share::Number);
    spec.fill = Fill::Height {
        height: 16.0,
        solid_fraction: 0.57,
    };
    let origin = Vec3::new(5.0, -3.0, 2.0);
    let bed = random_in_box(origin, [12.0, 14.0], &spec).unwrap();
    assert!(smallest_gap(&bed) > -1e-12);
    let space = 12.0 * 14.0 * 16.0;
    // The number is whole: half the largest sphere at most is missing or over.
    assert!((bed.volume() - 0.57 * space).abs() <= 0.5 * PI / 6.0 * 8.0 + 1e-9);
    for (c, d) in bed.centres.iter().zip(&bed.diameters) {
        let from = c - origin;
        for (axis, size) in [12.0, 14.0, 16.0].into_iter().enumerate() {
            assert!(from[axis] >= 0.5 * d - 1e-12 && from[axis] <= size - 0.5 * d + 1e-12);
        }
    }
    let large = bed.diameters.iter().filter(|d| **d == 2.0).count() as f64;
    assert!((large / bed.diameters.len() as f64 - 0.5).abs() < 0.08);
}

#[test]
fn a_fraction_out_of_reach_is_refused_with_the_one_reached() {
    let mut spec = spec(1);
    spec.fill = Fill::Number {
        number: 500,
        solid_fraction: 0.70,
    };
    let error = random_in_cylinder(Vec3::zeros(), TUBE, &spec).unwrap_err();
    let PackingError::Fraction { reached, .. } = error else {
        unreachable!("{error}");
    };
    assert!(reached > 0.2 && reached < 0.70, "{error}");
    assert!(error.to_string().contains("write a smaller solid fraction"));
    // 40 000 of them fill the tube's 50 mm by more than is there.
    spec.fill = Fill::NumberToHeight {
        number: 40_000,
        height: 0.05,
    };
    let error = random_in_cylinder(Vec3::zeros(), TUBE, &spec).unwrap_err();
    let error = error.to_string();
    // π/6 · 0.08³ · 40 000 over π/4.
    assert!(error.contains("solid fraction is 13.65"), "{error}");
    assert!(error.contains("by fewer or smaller spheres"), "{error}");
}

#[test]
fn an_exact_number_fills_a_height() {
    let mut spec = spec(1);
    spec.fill = Fill::NumberToHeight {
        number: 1500,
        height: 0.05,
    };
    let bed = random_in_cylinder(Vec3::zeros(), TUBE, &spec).unwrap();
    assert_eq!((bed.centres.len(), bed.height), (1500, 0.05));
    assert!(smallest_gap(&bed) > -1e-12);
    let top = bed.centres.iter().map(|c| c.z + 0.5 * GRAIN);
    assert!(top.fold(0.0, f64::max) <= 0.05 + 1e-12);
}

#[test]
fn beds_of_many_spheres_are_the_same_bits_on_any_number_of_threads() {
    let mut spec = spec(3);
    spec.sizes = range(Shape::Uniform, 0.2 * GRAIN, GRAIN);
    spec.fill = Fill::Number {
        number: 25_000,
        solid_fraction: 0.5,
    };
    let bed = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| random_in_cylinder(Vec3::zeros(), TUBE, &spec).unwrap())
    };
    let one = bed(1);
    assert!(one == bed(3));
    let radii: Vec<f64> = one.diameters.iter().map(|d| 0.5 * d).collect();
    assert!(touching(&Default::default(), &radii, &one.centres, 0.0).is_empty());
}

#[test]
fn numbers_without_meaning_are_refused() {
    let said = |change: fn(&mut RandomSpec)| {
        let mut spec = spec(1);
        change(&mut spec);
        let error = random_in_cylinder(Vec3::zeros(), TUBE, &spec);
        error.unwrap_err().to_string()
    };
    assert!(
        said(|s| {
            s.fill = Fill::Number {
                number: 10,
                solid_fraction: f64::NAN,
            }
        })
        .contains("solid fraction is NaN")
    );
    assert!(said(|s| s.sizes = Sizes::Equal(0.0)).contains("diameter is 0"));
    assert!(said(|s| s.sizes = Sizes::Equal(0.06)).contains("do not fit between walls"));
    assert!(
        said(|s| {
            s.fill = Fill::NumberToHeight {
                number: 0,
                height: 1.0,
            }
        })
        .contains("number of spheres is 0")
    );
    assert!(
        said(|s| s.sizes = mixture(vec![], Share::Number)).contains("number of diameters is 0")
    );
    assert!(said(|s| s.sizes = range(Shape::Uniform, 0.002, 0.001)).contains("range of diameters"));
}

#[test]
fn a_simple_cubic_stack_fills_its_box_to_pi_over_6() {
    let stack = simple_cubic(Vec3::zeros(), 2.0, [3, 4, 5]);
    assert!((stack.volume() / (6.0 * 8.0 * 10.0) - PI / 6.0).abs() < 1e-14);
    assert!(smallest_gap(&stack).abs() < 1e-14);
}

#[test]
fn a_hexagonal_close_stack_has_12_contacts_and_pi_over_3_root_2() {
    let count = 8;
    let stack = hexagonal_close(Vec3::zeros(), 1.0, [count; 3]);
    assert!(smallest_gap(&stack).abs() < 1e-12);
    let middle = stack.centres[4 + count * (4 + count * 4)];
    let touching = |c: &&Vec3| (*c - middle).norm() < 1.0 + 1e-9;
    assert_eq!(stack.centres.iter().filter(touching).count() - 1, 12);
    // One sphere a cell of the lattice: along a row, to the row after next, to the layer after next.
    let at = |i: usize, j: usize, k: usize| stack.centres[i + count * (j + count * k)];
    let [row, rows, layers] = [at(1, 0, 0), at(0, 2, 0), at(0, 0, 2)].map(|p| p - at(0, 0, 0));
    let cell = row.cross(&rows).dot(&layers) / 4.0;
    assert!((PI / 6.0 / cell - PI / (3.0 * SQRT_2)).abs() < 1e-12);
}

/// Mean and standard deviation of so many draws.
fn moments(sizes: &Sizes) -> (f64, f64) {
    let all = sizes.sample(40_000, 11).unwrap();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let square = all.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>();
    (mean, (square / all.len() as f64).sqrt())
}

/// 40,000 draws know a mean to its deviation over 200; three times that is allowed.
#[test]
fn drawn_diameters_have_the_moments_of_their_distribution() {
    let (mean, deviation) = moments(&range(Shape::Uniform, 1.0, 3.0));
    assert!((mean - 2.0).abs() < 0.009 && (deviation - 1.0 / 3f64.sqrt()).abs() < 0.009);
    let normal = |mean, deviation| Shape::Normal { mean, deviation };
    let (mean, deviation) = moments(&range(normal(5.0, 0.5), 1.0, 9.0));
    assert!((mean - 5.0).abs() < 0.008 && (deviation - 0.5).abs() < 0.008);
    // Cut at the mean: the mean of a half normal distribution is √(2/π) deviations above.
    let (mean, _) = moments(&range(normal(5.0, 0.5), 5.0, 9.0));
    assert!(
        (mean - 5.0 - 0.5 * (2.0 / PI).sqrt()).abs() < 0.005,
        "{mean}"
    );
    // Mean of a log-normal distribution: median exp(σ²/2).
    let (median, deviation) = (2.0, 1.3);
    let shape = Shape::LogNormal { median, deviation };
    let expected = 2.0 * (0.5 * 1.3f64.ln().powi(2)).exp();
    let sizes = range(shape, 0.2, 20.0);
    assert!((moments(&sizes).0 - expected).abs() < 0.009);
    assert!((sizes.mean().unwrap() - expected).abs() < 1e-6);
}

#[test]
fn shares_by_mass_are_of_mass() {
    // Uniform by mass from 1 to 2 is d⁻³ by number: ∫d⁻² = 1/2 over ∫d⁻³ = 3/8.
    let sizes = Sizes::Range {
        shape: Shape::Uniform,
        min: 1.0,
        max: 2.0,
        share: Share::Mass,
    };
    assert!((sizes.mean().unwrap() - 4.0 / 3.0).abs() < 1e-6);
    let half = mixture(vec![(1e-3, 0.5), (2e-3, 0.5)], Share::Mass);
    let all = half.sample(90_000, 4).unwrap();
    let mass = |d: f64| {
        all.iter()
            .filter(|x| **x == d)
            .map(|x| x.powi(3))
            .sum::<f64>()
    };
    // 10,000 large ones: known to 1 %.
    assert!((mass(2e-3) / mass(1e-3) - 1.0).abs() < 0.03);
    assert_eq!(half.largest(), 2e-3);
    assert_eq!(half.sample(5, 4).unwrap(), all[..5]);
}

#[test]
fn spheres_of_very_different_sizes_pack_without_overlap() {
    let mut spec = spec(2);
    spec.sizes = mixture(vec![(1.0, 0.5), (5.0, 0.5)], Share::Mass);
    spec.fill = Fill::Height {
        height: 20.0,
        solid_fraction: 0.62,
    };
    let bed = random_in_cylinder(Vec3::zeros(), 20.0, &spec).unwrap();
    assert!(smallest_gap(&bed) > -1e-12);
    let fraction = bed.volume() / (FRAC_PI_4 * 20.0 * 20.0 * 20.0);
    assert!((fraction - 0.62).abs() < 0.01, "{fraction}");
    for (c, d) in bed.centres.iter().zip(&bed.diameters) {
        assert!(c.x.hypot(c.y) + 0.5 * d <= 10.0 + 1e-12);
        assert!(c.z >= 0.5 * d - 1e-12 && c.z + 0.5 * d <= 20.0 + 1e-12);
    }
}

#[test]
fn stackings_fill_containers_from_wall_to_wall() {
    let origin = Vec3::new(1.0, 2.0, 3.0);
    let fit = |lattice| regular_in_box(origin, [6.0, 8.0, 10.0], 2.0, lattice).unwrap();
    let cubic = fit(Lattice::SimpleCubic);
    assert_eq!(cubic.centres.len(), 3 * 4 * 5);
    assert!((cubic.height - 10.0).abs() < 1e-12);
    assert!((cubic.centres[0] - origin - Vec3::repeat(1.0)).norm() < 1e-12);
    // Square layers of 3 x 4 and 2 x 3 in turns, 2/√2 apart: 1 + 8/√2 = 6.6, 6 layers.
    let face = fit(Lattice::FaceCentred);
    assert_eq!(face.centres.len(), 3 * 12 + 3 * 6);
    for lattice in [
        Lattice::SimpleCubic,
        Lattice::HexagonalClose,
        Lattice::FaceCentred,
    ] {
        let wide = regular_in_box(origin, [20.3, 21.7, 19.1], 1.0, lattice).unwrap();
        let tube = regular_in_cylinder(origin, [20.0, 12.0], 1.0, lattice).unwrap();
        for packing in [&wide, &tube] {
            assert!(smallest_gap(packing).abs() < 1e-9);
        }
        for c in &tube.centres {
            assert!((c - origin).xy().norm() <= 9.5 + 1e-9 && c.z <= 3.0 + 11.5 + 1e-9);
        }
        // The middle of the box is as dense as the lattice, the walls cost a part.
        let bulk = if lattice == Lattice::SimpleCubic {
            PI / 6.0
        } else {
            PI / (3.0 * SQRT_2)
        };
        let fraction = wide.volume() / (20.3 * 21.7 * 19.1);
        assert!(
            fraction < bulk && fraction > 0.88 * bulk,
            "{lattice:?}: {fraction}"
        );
        // What is left over is shared between the walls.
        let gap = |axis: usize| {
            let low = wide
                .centres
                .iter()
                .map(|c| c[axis])
                .fold(f64::INFINITY, f64::min);
            let high = wide.centres.iter().map(|c| c[axis]).fold(0.0, f64::max);
            (low - origin[axis]) - (origin[axis] + [20.3, 21.7][axis] - high)
        };
        assert!(gap(0).abs() < 1e-9 && gap(1).abs() < 1e-9);
    }
    let ten = regular_in_cylinder(Vec3::zeros(), [10.0, 1.0], 1.0, Lattice::SimpleCubic).unwrap();
    let on_axis = ten.centres.iter().filter(|c| c.y.abs() < 1e-12).count();
    // Nine whole spheres with one on the axis.
    assert_eq!(on_axis, 9);
    let narrow = regular_in_box(origin, [0.5, 1.0, 1.0], 1.0, Lattice::SimpleCubic).unwrap_err();
    assert!(narrow.to_string().contains("0.5000 m apart"));
}

#[test]
fn a_face_centred_stack_has_12_contacts() {
    let stack = regular_in_box(Vec3::zeros(), [6.0; 3], 1.0, Lattice::FaceCentred).unwrap();
    let near = |c: &&Vec3| (*c - Vec3::repeat(3.0)).norm();
    let middle = stack
        .centres
        .iter()
        .min_by(|a, b| near(a).total_cmp(&near(b)))
        .unwrap();
    let touching = stack
        .centres
        .iter()
        .filter(|c| (*c - middle).norm() < 1.0 + 1e-9)
        .count();
    assert_eq!(touching - 1, 12);
}

/// Along periodic directions that it spans a packing has no walls; spheres and the images of others do not overlap.
#[test]
fn a_periodic_packing_reaches_across_the_planes_and_overlaps_no_images() {
    let span = |low: f64, high: f64| Some(PeriodicSpan { low, high });
    let size = [0.03, 0.02];
    let axes = [span(0.01, 0.04), None, span(0.0, 0.025)];
    for (axes, sizes, solid_fraction) in [
        (axes, Sizes::Equal(2e-3), 0.6),
        ([None, span(0.0, 0.02), None], Sizes::Equal(2e-3), 0.58),
        (
            [span(0.01, 0.04), span(0.0, 0.02), span(0.0, 0.025)],
            range(Shape::Uniform, 1e-3, 4e-3),
            0.62,
        ),
    ] {
        let periodicity = Periodicity { axes };
        let spec = RandomSpec {
            sizes,
            fill: Fill::Height {
                height: 0.025,
                solid_fraction,
            },
            seed: 5,
            size_seed: 5,
            periodicity,
        };
        let packing = random_in_box(Vec3::new(0.01, 0.0, 0.0), size, &spec).unwrap();
        let reached = packing.volume() / (size[0] * size[1] * 0.025);
        assert!((reached / solid_fraction - 1.0).abs() < 2e-3, "{reached}");
        let mut crossing = [0; 3];
        let (low, high) = (Vec3::new(0.01, 0.0, 0.0), Vec3::new(0.04, 0.02, 0.025));
        for (a, (centre, diameter)) in packing.centres.iter().zip(&packing.diameters).enumerate() {
            assert_eq!(*centre, periodicity.wrap(*centre));
            let radius = 0.5 * diameter;
            for axis in 0..3 {
                let beyond = (low[axis] - centre[axis]).max(centre[axis] - high[axis]) + radius;
                crossing[axis] += usize::from(beyond > 1e-12);
            }
            for (other, diameter) in packing.centres[..a].iter().zip(&packing.diameters) {
                let apart = periodicity.shortest(centre - other).norm();
                assert!(apart >= radius + 0.5 * diameter, "{centre} {other}");
            }
        }
        for axis in 0..3 {
            assert_eq!(crossing[axis] > 20, axes[axis].is_some(), "{crossing:?}");
        }
    }
    // A box that does not reach from plane to plane has walls.
    let part = RandomSpec {
        periodicity: Periodicity { axes },
        sizes: Sizes::Equal(2e-3),
        fill: Fill::Height {
            height: 0.02,
            solid_fraction: 0.5,
        },
        ..spec(1)
    };
    let packing = random_in_box(Vec3::new(0.01, 0.0, 0.0), [0.02, 0.02], &part).unwrap();
    assert!(
        packing
            .centres
            .iter()
            .all(|c| c.x >= 0.0109999 && c.x <= 0.0290001)
    );
    assert!(packing.centres.iter().all(|c| c.z >= 0.0009999));
}
