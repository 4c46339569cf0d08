//! The void fraction of a settled bed over the distance from the wall of a cylinder of twenty diameters, against
//! Benenati and Brosilow, AIChE J. 8 (1962) 359, doi 10.1002/aic.690080319: one at the wall, a minimum of 0.2 to
//! 0.25 half a diameter from it, damped oscillations over four to five diameters. And the void fraction of the whole bed,
//! which is looser the rougher the beads are.

use std::f64::consts::PI;
use std::path::Path;

use calcine::results::read;
use calcine::results::voids::VoidProfiles;

use crate::run as calcine;

/// Diameter of the beads and radius of the cylinder in m.
const BEAD: f64 = 2e-3;
const RADIUS: f64 = 20e-3;
/// Points on each surface of one distance from the wall.
const POINTS: u32 = 6000;

/// Coefficients of friction, the first of them the case's, the second that of usual beads.
const FRICTIONS: [f64; 3] = [0.1, 0.3, 0.5];
/// Where a settled bed of equal spheres in a wide cylinder lies.
const USUAL: std::ops::RangeInclusive<f64> = 0.38..=0.42;

pub fn run() {
    let beds = FRICTIONS.map(settle);
    assert!(USUAL.contains(&beds[1].whole) && USUAL.contains(&beds[1].bulk));
    assert!(beds.windows(2).all(|pair| pair[0].bulk < pair[1].bulk));
    assert!((0.37..0.43).contains(&beds[0].bulk), "{}", beds[0].bulk);
    oscillates(&beds[0]);
}

/// Void fractions of a settled bed.
struct Bed {
    /// Over the distance from the wall, in steps of 0.08 diameters.
    profile: Vec<f64>,
    /// From wall to wall.
    whole: f64,
    /// From 5 to 8 diameters from the wall.
    bulk: f64,
}

fn settle(friction: f64) -> Bed {
    let folder = tempfile::tempdir().unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/settled-cylinder.toml");
    let set = [format!("contacts[0].friction={friction}")];
    let (out, series) = calcine(&case, folder.path(), "cylinder", &set);
    let speed = series.column("quantities.mean_speed");
    let speed = *speed.last().unwrap();
    let files = read::collection(&out, "particles.pvd").unwrap();
    let (_, last) = files.last().unwrap();
    let arrays = read::arrays(last).unwrap();
    let centres: Vec<[f64; 3]> = arrays["points"].values.as_chunks::<3>().0.to_vec();
    let mut heights: Vec<f64> = centres.iter().map(|centre| centre[2]).collect();
    heights.sort_by(f64::total_cmp);
    // Away from the bottom and the top, which order the layers beside them.
    let band = [2.5 * BEAD, heights[heights.len() * 95 / 100] - 2.0 * BEAD];
    println!(
        "  friction {friction}: {} beads, {speed:.1e} m/s, heights of {band:.4?} m",
        centres.len()
    );
    assert!(speed < 1e-2, "{speed} m/s");

    let steps = 100;
    let profile: Vec<f64> = (0..=steps)
        .map(|k| void(&centres, RADIUS - at(k) * BEAD, band))
        .collect();
    // The run's own profile cuts the spheres exactly, at every second of its places.
    let own = VoidProfiles::read(&out).unwrap().unwrap().wall;
    let apart = profile.iter().enumerate().map(|(k, void)| {
        assert!((own.place[2 * k] - at(k) * BEAD).abs() < 1e-9);
        (own.void_fraction[2 * k] - void).abs()
    });
    let apart = apart.fold(0.0, f64::max);
    println!("  the run's own profile: {apart:.4} apart at most");
    assert!(apart < 0.015, "{apart}");
    // Each ring counts by its circumference.
    let rings = (0..=steps).map(|k| (profile[k], RADIUS - at(k) * BEAD));
    let (voids, all) = rings.fold((0.0, 0.0), |(voids, all), (void, radius)| {
        (voids + void * radius, all + radius)
    });
    let (whole, bulk) = (voids / all, mean(&profile, 5.0, 8.0));
    println!(
        "  void fraction {whole:.3} from wall to wall, {bulk:.3} from 5 to 8 diameters from it"
    );
    Bed {
        profile,
        whole,
        bulk,
    }
}

/// Distance from the wall in diameters.
fn at(step: usize) -> f64 {
    step as f64 * 0.08
}

fn oscillates(Bed { profile, bulk, .. }: &Bed) {
    let extremes: Vec<(f64, f64, bool)> = (1..profile.len() - 1)
        .filter_map(|k| {
            let low = profile[k] < profile[k - 1] && profile[k] <= profile[k + 1];
            let high = profile[k] > profile[k - 1] && profile[k] >= profile[k + 1];
            (low || high).then(|| (at(k), profile[k], low))
        })
        .collect();
    println!("  | diameters from the wall | void fraction |");
    for (place, value, low) in extremes.iter().take(10) {
        let kind = if *low { "least" } else { "most" };
        println!("  | {place:>22.2}  | {value:.3} {kind} |");
    }
    let lows: Vec<_> = extremes.iter().filter(|one| one.2).collect();
    let (place, value, _) = *lows[0];
    assert!(
        (0.4..0.65).contains(&place) && (0.18..0.28).contains(&value),
        "{place} {value}"
    );
    let highs: Vec<_> = extremes
        .iter()
        .filter(|one| !one.2 && one.0 > 0.3)
        .collect();
    assert!(
        (0.8..1.15).contains(&highs[0].0) && highs[0].1 > 0.45,
        "{:?}",
        highs[0]
    );
    // The second and third minimum follow at the distance of layers, ever shallower.
    let period = 0.5 * (lows[2].0 - lows[0].0);
    println!("  period {period:.2} diameters");
    assert!((0.8..1.0).contains(&period), "{period}");
    assert!(lows[1].1 > lows[0].1 && lows[2].1 > lows[1].1);
    let far = (0..profile.len())
        .filter(|&k| at(k) > 5.0)
        .map(|k| (profile[k] - bulk).abs());
    assert!(far.fold(0.0, f64::max) < 0.06);
}

fn mean(profile: &[f64], from: f64, to: f64) -> f64 {
    let inside: Vec<f64> = (0..profile.len())
        .filter(|&k| (from..=to).contains(&at(k)))
        .map(|k| profile[k])
        .collect();
    inside.iter().sum::<f64>() / inside.len() as f64
}

/// Share of a cylindrical surface of a radius, between two heights, that no sphere covers.
fn void(centres: &[[f64; 3]], radius: f64, band: [f64; 2]) -> f64 {
    if radius >= RADIUS {
        return 1.0;
    }
    let near: Vec<&[f64; 3]> = centres
        .iter()
        .filter(|c| (c[0].hypot(c[1]) - radius).abs() < 0.5 * BEAD)
        .collect();
    // A regular lattice of points, turned from row to row by the golden angle.
    let golden = PI * (3.0 - 5f64.sqrt());
    let free = (0..POINTS).filter(|&k| {
        let angle = golden * f64::from(k);
        let height = band[0] + (band[1] - band[0]) * (f64::from(k) + 0.5) / f64::from(POINTS);
        let place = [radius * angle.cos(), radius * angle.sin(), height];
        let square = |c: &[f64; 3]| (0..3).map(|i| (c[i] - place[i]).powi(2)).sum::<f64>();
        near.iter().all(|c| square(c) > 0.25 * BEAD * BEAD)
    });
    free.count() as f64 / f64::from(POINTS)
}
