//! The surface of the bed in a turning drum becomes steeper as friction grows: the dynamic angle of repose, of particles and of
//! parcels.

use std::path::Path;

use crate::{run as calcine, shipped};

const FRICTIONS: [f64; 5] = [0.1, 0.2, 0.35, 0.5, 0.8];

/// Mean, least and most slope in degrees.
struct Slope([f64; 3]);

impl Slope {
    /// That of a run from a time in s on.
    fn of(case: &Path, (folder, name): (&Path, &str), set: &[String], from: f64) -> Self {
        let (_, series) = calcine(case, folder, name, set);
        let times = series.column("process_time");
        let all = times.iter().zip(series.column("quantities.surface_angle"));
        let steady: Vec<f64> = all
            .filter(|(time, _)| **time > from)
            .map(|(_, angle)| angle.to_degrees())
            .collect();
        let mean = steady.iter().sum::<f64>() / steady.len() as f64;
        let least = steady.iter().copied().fold(f64::MAX, f64::min);
        let most = steady.iter().copied().fold(f64::MIN, f64::max);
        Self([mean, least, most])
    }

    fn show(&self, name: &str) {
        let Self([mean, least, most]) = self;
        println!("  | {name:>22} | {mean:>16.1} | {least:.1} to {most:.1} |");
    }
}

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    println!("  | particles, friction | surface, degrees | least and most |");
    let slopes = FRICTIONS.map(|friction| {
        let set = [format!("contacts[0].friction={friction}")];
        let name = format!("{friction}");
        let slope = Slope::of(&shipped("rotating-drum"), (folder.path(), &name), &set, 1.5);
        slope.show(&name);
        slope.0[0]
    });
    assert!(
        slopes.windows(2).all(|pair| pair[1] > pair[0] + 0.3),
        "{slopes:?}"
    );
    // A bed slides as a whole where its contacts cannot hold it, and no free surface of spheres is steeper than this.
    assert!(slopes[0] > 4.0 && slopes[4] < 40.0, "{slopes:?}");
    println!("  | parcels, friction | surface, degrees | least and most |");
    let parcels = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/drum-parcels.toml");
    let friction = |value: f64| {
        vec![
            format!("contacts[0].friction={value}"),
            format!("motion.parcels.friction.bed={value}"),
        ]
    };
    let small = [
        r#"mesh.cylinder.diameter="60 mm""#,
        r#"walls[0].rotating.angular_velocity="0 0 10 rpm""#,
        r#"particles.beads.place.grid={ first = "-22 -14 2 mm", spacing = "3 3 3 mm", counts = [9, 10, 8] }"#,
    ];
    let rows = [
        ("0", friction(0.0)),
        ("0.2", friction(0.2)),
        ("0.5", friction(0.5)),
        ("0.8", friction(0.8)),
        (
            "0.5, cells of 14 mm",
            vec!["mesh.cylinder.cells=[7, 2]".to_owned()],
        ),
        ("0.5, 60 mm, 10 rpm", small.map(str::to_owned).to_vec()),
    ];
    let slopes = rows.map(|(name, set)| {
        let own = format!("parcels, {name}");
        let slope = Slope::of(&parcels, (folder.path(), &own), &set, 0.4);
        slope.show(name);
        slope.0[0]
    });
    // How far parcels stay below particles is told in docs/verification.md.
    assert!(
        slopes[0].abs() < 5.0 && slopes[1..4].iter().all(|slope| *slope > 10.0),
        "{slopes:?}"
    );
}
