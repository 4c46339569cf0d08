//! The surface of the bed in a turning drum becomes steeper as friction grows: the dynamic angle of repose.

use crate::{run as calcine, shipped};

const FRICTIONS: [f64; 5] = [0.1, 0.2, 0.35, 0.5, 0.8];

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    println!("  | friction | surface, degrees | least and most |");
    let mut angles = Vec::new();
    for friction in FRICTIONS {
        let set = [format!("contacts[0].friction={friction}")];
        let name = format!("{friction}");
        let (_, series) = calcine(&shipped("rotating-drum"), folder.path(), &name, &set);
        let times = series.column("process_time");
        let all = times.iter().zip(series.column("quantities.surface_angle"));
        let steady: Vec<f64> = all
            .filter(|(time, _)| **time > 1.5)
            .map(|(_, angle)| angle.to_degrees())
            .collect();
        let mean = steady.iter().sum::<f64>() / steady.len() as f64;
        let [least, most] = [
            steady.iter().copied().fold(f64::MAX, f64::min),
            steady.iter().copied().fold(f64::MIN, f64::max),
        ];
        println!("  | {friction:>8} | {mean:>16.1} | {least:.1} to {most:.1} |");
        angles.push(mean);
    }
    assert!(
        angles.windows(2).all(|pair| pair[1] > pair[0] + 0.3),
        "{angles:?}"
    );
    // A bed slides as a whole where its contacts cannot hold it, and no free surface of spheres is steeper than this.
    assert!(angles[0] > 4.0 && angles[4] < 40.0, "{angles:?}");
}
