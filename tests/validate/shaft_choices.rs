//! What the choices of the shaft furnace change (docs/theory.md, SHF-1): air at the burners, emissivity, range of the view factors, load,
//! and a shaft with room for its zones, beside the peaks that the paper reports.
//!
//! The case as shipped and the tall shaft run two turnovers of their beds; each other row goes on from the end of one of them
//! by `--from`, with one thing changed, for one turnover more. Some hours of one core; an interrupted run goes on.

use std::path::Path;

use crate::kept::{self, Kept};
use crate::shaft_furnace::{PAPER, by_height};
use crate::shipped;

/// A row of the table.
struct Choice {
    name: &'static str,
    /// Whether in the tall shaft.
    tall: bool,
    /// Air ratio of the burners.
    lambda: f64,
    set: &'static [&'static str],
}

/// At λ = 1 the burners let in as much methane with less air.
const STOICHIOMETRIC: &[&str] = &[
    "time.end=2400 s",
    "gas.patch.burners.inlet.mass_flow=3.0149 g/s",
    "gas.patch.burners.inlet.composition={ mole = { CH4 = 0.095057, O2 = 0.190114, N2 = 0.714829 } }",
];
const STOICHIOMETRIC_TALL: &[&str] = &["time.end=9700 s", STOICHIOMETRIC[1], STOICHIOMETRIC[2]];

const CHOICES: [Choice; 5] = [
    Choice {
        name: "lambda-1",
        tall: false,
        lambda: 1.0,
        set: STOICHIOMETRIC,
    },
    Choice {
        name: "emissivity-1",
        tall: false,
        lambda: 1.1,
        set: &["time.end=2400 s", FIRED, "materials.magnesia.emissivity=1"],
    },
    Choice {
        name: "views-3",
        tall: false,
        lambda: 1.1,
        set: &["time.end=2400 s", FIRED, "laws.radiation.range=3"],
    },
    Choice {
        name: "half-load",
        tall: false,
        lambda: 1.1,
        set: &[
            "time.end=4600 s",
            "gas.patch.burners.inlet.mass_flow=1.65 g/s",
            "gas.patch.bottom.inlet.mass_flow=3.45 g/s",
            "feeds[0].mass_rate=3.4 g/s",
            "outlets[0].mass_rate=3.4 g/s",
        ],
    },
    Choice {
        name: "tall-lambda-1",
        tall: true,
        lambda: 1.0,
        set: STOICHIOMETRIC_TALL,
    },
];
/// The burners fire from the start, as they do where the run goes on.
const FIRED: &str = "gas.patch.burners.inlet.mass_flow=3.3 g/s";

/// By how much in K the mean temperature may move over the last part of a steady run.
const STEADY: f64 = 19.0;
/// No gas is hotter in K than methane and air of 300 K that burn by the four steps without loss at λ = 1, and 1.1.
const EQUILIBRIUM: [f64; 2] = [2247.0, 2190.0];

pub fn run() {
    let tall = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/shaft-tall.toml");
    let cases = [shipped("shaft-furnace"), tall];
    let bases = [("shaft-furnace", 0), ("shaft-tall", 1)]
        .map(|(name, which)| kept::run(name, &cases[which], &[], None));
    println!(
        "  | run | hottest gas | hottest particle | off-gas | product | mean, moves by | pressure drop | windows | wall time |"
    );
    println!(
        "  | the paper | {} K | {} K | | | | | | |",
        PAPER[0], PAPER[1]
    );
    row("as shipped", &bases[0], 1.1);
    row("tall", &bases[1], 1.1);
    for choice in &CHOICES {
        let which = usize::from(choice.tall);
        let set: Vec<String> = choice.set.iter().map(|one| (*one).to_owned()).collect();
        let name = format!("shaft-{}", choice.name);
        let done = kept::run(&name, &cases[which], &set, Some(&bases[which].out));
        row(choice.name, &done, choice.lambda);
    }
}

/// Prints a row and asserts what any furnace has to show: steady, closed, and no hotter than a flame.
fn row(name: &str, done: &Kept, lambda: f64) {
    let [gas, particle] = ["hottest_gas", "hottest_particle"].map(|quantity| done.last(quantity));
    let moved = done.moved();
    let product = by_height(&done.out).first().map_or(f64::NAN, |one| one.1);
    println!(
        "  | {name} | {gas:.0} K | {particle:.0} K | {:.0} K | {product:.0} K | {:.0} K, {moved:.1} K | {:.0} Pa | {} | {:.0} s |",
        done.last("off_gas"),
        done.last("mean_temperature"),
        done.last("pressure_drop"),
        done.summary.windows,
        done.summary.wall_time_s.total,
    );
    let highest = EQUILIBRIUM[usize::from(lambda > 1.0)];
    assert!(particle < gas && gas < highest, "{name}: {gas} {particle}");
    assert!(moved.abs() < STEADY, "{name} is not steady: {moved}");
    let (lines, elements) = (&done.summary.ledger.lines, &done.summary.ledger.elements);
    for line in ["mass", "energy", "particle_mass"].map(|line| &lines[line]) {
        assert!(line.relative_error < 1e-10, "{name}: {line:?}");
    }
    for (element, line) in elements {
        assert!(line.relative_error < 1e-10, "{name}, {element}: {line:?}");
    }
}
