//! The fluidised bed of the shipped case, on each pairing that the issue of moving beds names: the plateau at
//! the buoyant weight, the packed branch by the drag law, the minimum fluidisation velocity by their crossing.
//! By models A and B of the momentum.

use crate::fluidised::{Hold, examine};
use crate::shipped;

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("fluidised-bed");
    let hold = |from: f64, to: f64, speed: f64| Hold { from, to, speed };
    let moving = [hold(0.5, 1.0, 0.040), hold(1.5, 2.0, 0.034)];
    let packed = [
        hold(3.2, 3.6, 0.020),
        hold(4.2, 4.4, 0.014),
        hold(4.9, 5.0, 0.008),
    ];
    let runs = [
        ("native", "native", "a"),
        ("native", "native", "b"),
        ("native", "liggghts", "a"),
        ("openfoam", "liggghts", "a"),
    ];
    for (gas, particles, model) in runs {
        let name = format!("{gas}-{particles}-{model}");
        println!("  {gas} gas, {particles} particles, model {model}");
        let set = vec![format!("laws.drag.model={model}")];
        let pairing = ["--gas", gas, "--particles", particles];
        let (out, _) = crate::run_with(&case, folder.path(), &name, &set, &pairing);
        let found = examine(&case, &set, &out, &moving, &packed);
        for share in found.plateau {
            assert!((share - 1.0).abs() < 0.02, "{name}: {share}");
        }
        for share in found.packed {
            assert!((share - 1.0).abs() < 0.01, "{name}: {share}");
        }
        for by in [found.by_particles, found.by_bed] {
            assert!((found.crossing / by - 1.0).abs() < 0.05, "{name}: {by}");
        }
    }
}
