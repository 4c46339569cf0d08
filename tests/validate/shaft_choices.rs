//! What the choices of the shaft furnace change (docs/theory.md, SHF-1): air at the burners, emissivity, range of the view factors, load,
//! and a shaft with room for its zones, beside the peaks that the paper reports.
//!
//! The case as shipped and the tall shaft run two turnovers of their beds; each other row goes on from the end of another one by
//! `--from`, with one thing changed or none, for one turnover more. The tall shaft takes three turnovers to be steady, and
//! two more at another air ratio. Some hours of one core; an interrupted run goes on.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::kept::{self, Kept};
use crate::shaft_furnace::{PAPER, TURNOVER, by_height};
use crate::shipped;

/// A row of the table.
struct Choice {
    name: &'static str,
    /// The run from whose end it goes on; none where it begins with the case.
    from: Option<&'static str>,
    /// Whether in the tall shaft.
    tall: bool,
    /// Whether it is steady at its end; else another row goes on from it.
    steady: bool,
    /// Duration in s of one turnover of its bed.
    turnover: f64,
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

/// The case as shipped, at λ = 1.1.
const SHIPPED: Choice = Choice {
    name: "shaft-furnace",
    from: None,
    tall: false,
    steady: true,
    turnover: TURNOVER,
    lambda: 1.1,
    set: &[],
};
/// The tall shaft, which is not steady after two turnovers.
const TALL: Choice = Choice {
    name: "shaft-tall",
    tall: true,
    steady: false,
    turnover: 8800.0,
    ..SHIPPED
};
const CHOICES: [Choice; 9] = [
    SHIPPED,
    Choice {
        name: "shaft-lambda-1",
        from: Some(SHIPPED.name),
        lambda: 1.0,
        set: STOICHIOMETRIC,
        ..SHIPPED
    },
    Choice {
        name: "shaft-emissivity-1",
        from: Some(SHIPPED.name),
        set: &["time.end=2400 s", FIRED, "materials.magnesia.emissivity=1"],
        ..SHIPPED
    },
    Choice {
        name: "shaft-views-3",
        from: Some(SHIPPED.name),
        set: &["time.end=2400 s", FIRED, "laws.radiation.range=3"],
        ..SHIPPED
    },
    Choice {
        name: "shaft-half-load",
        from: Some(SHIPPED.name),
        turnover: 2.0 * TURNOVER,
        set: &[
            "time.end=4600 s",
            "gas.patch.burners.inlet.mass_flow=1.65 g/s",
            "gas.patch.bottom.inlet.mass_flow=3.45 g/s",
            "feeds[0].mass_rate=3.4 g/s",
            "outlets[0].mass_rate=3.4 g/s",
        ],
        ..SHIPPED
    },
    TALL,
    Choice {
        name: "shaft-tall-on",
        from: Some(TALL.name),
        steady: true,
        set: &["time.end=9700 s", FIRED],
        ..TALL
    },
    Choice {
        name: "shaft-tall-lambda-1",
        from: Some(TALL.name),
        lambda: 1.0,
        set: STOICHIOMETRIC_TALL,
        ..TALL
    },
    Choice {
        name: "shaft-tall-lambda-1-on",
        from: Some("shaft-tall-lambda-1"),
        steady: true,
        lambda: 1.0,
        set: STOICHIOMETRIC_TALL,
        ..TALL
    },
];
/// The burners fire from the start, as they do where the run goes on.
const FIRED: &str = "gas.patch.burners.inlet.mass_flow=3.3 g/s";

/// By how much in K the mean temperature may move over the last 0.4 turnovers of a steady run.
const STEADY: f64 = 19.0;
/// No gas of the small shaft is hotter in K than methane and air of 300 K that burn by the four steps without loss at λ = 1,
/// and 1.1. In the tall one it may be: air from below reaches the flames as hot as the particles there.
const EQUILIBRIUM: [f64; 2] = [2247.0, 2190.0];

pub fn run() {
    let tall = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/shaft-tall.toml");
    let cases = [shipped("shaft-furnace"), tall];
    println!(
        "  | run | hottest gas | hottest particle | off-gas | product | mean, moves by | pressure drop | windows | wall time |"
    );
    println!(
        "  | the paper | {} K | {} K | | | | | | |",
        PAPER[0], PAPER[1]
    );
    let mut ends: HashMap<&str, PathBuf> = HashMap::new();
    for choice in &CHOICES {
        let set: Vec<String> = choice.set.iter().map(|one| (*one).to_owned()).collect();
        let from = choice.from.map(|name| ends[name].as_path());
        let done = kept::run(choice.name, &cases[usize::from(choice.tall)], &set, from);
        row(choice, &done);
        ends.insert(choice.name, done.out);
    }
}

/// Prints a row and asserts what any furnace has to show: closed, no hotter than its heat allows, and steady.
fn row(choice: &Choice, done: &Kept) {
    let name = choice.name;
    let [gas, particle] = ["hottest_gas", "hottest_particle"].map(|quantity| done.last(quantity));
    let moved = done.moved(choice.turnover);
    let product = by_height(&done.out).first().map_or(f64::NAN, |one| one.1);
    println!(
        "  | {name} | {gas:.0} K | {particle:.0} K | {:.0} K | {product:.0} K | {:.0} K, {moved:.1} K | {:.0} Pa | {} | {:.0} s |",
        done.last("off_gas"),
        done.last("mean_temperature"),
        done.last("pressure_drop"),
        done.summary.windows,
        done.summary.wall_time_s.total,
    );
    assert!(particle < gas, "{name}: {gas} {particle}");
    let highest = EQUILIBRIUM[usize::from(choice.lambda > 1.0)];
    if !choice.tall {
        assert!(gas < highest, "{name}: {gas} {highest}");
    }
    if choice.steady {
        assert!(moved.abs() < STEADY, "{name} is not steady: {moved}");
    }
    let (lines, elements) = (&done.summary.ledger.lines, &done.summary.ledger.elements);
    for line in ["mass", "energy", "particle_mass"].map(|line| &lines[line]) {
        assert!(line.relative_error < 1e-10, "{name}: {line:?}");
    }
    for (element, line) in elements {
        assert!(line.relative_error < 1e-10, "{name}, {element}: {line:?}");
    }
}
