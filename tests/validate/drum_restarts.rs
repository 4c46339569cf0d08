//! A turning drum of wet parcels that dry and char, and beds of parcels, interrupted by SIGINT at random moments again and again and resumed on one
//! and two threads in turn: the same bits in every dataset and in the series as without, and the ledger closed.

use std::path::Path;
use std::process::Command;

use calcine::results::Summary;

use crate::random::Random;
use crate::results_equal::values_that_differ;
use crate::stopped::{finish, interrupt_often};
use crate::{program, shipped};

/// The seed of the moments.
const SEED: u64 = 20_261_128;
/// Rows of the series between two interrupts at most.
const ROWS: usize = 5;
/// Largest share of what moves that a line of the ledger may miss.
const LEDGER: f64 = 1e-10;

/// Lines of the ledger that close, beside those of the elements.
const CLOSED: [&str; 6] = [
    "mass",
    "energy",
    "energy_exchange",
    "momentum",
    "particle_mass",
    "particle_momentum",
];

/// What is interrupted: a case, the pairing, how often, and settings; the series has a row a window.
struct Interrupted {
    case: &'static str,
    pairing: [&'static str; 2],
    times: usize,
    set: &'static [&'static str],
}

/// Wood that gives off volatiles from the start: drying and charring at once.
const CASES: [Interrupted; 4] = [
    Interrupted {
        case: "wet-drum",
        pairing: ["native", "native"],
        times: 50,
        set: &[
            "time.end=0.4 s",
            "reactions.volatiles.rate.factor=2.58e22",
            "particles.chips.temperature=360 K",
            "output.series_every=2 ms",
            "output.every=50 ms",
        ],
    },
    Interrupted {
        case: "wet-drum",
        pairing: ["openfoam", "native"],
        times: 10,
        set: &[
            "time.end=0.1 s",
            "reactions.volatiles.rate.factor=2.58e22",
            "particles.chips.temperature=360 K",
            "output.series_every=2 ms",
            "output.every=50 ms",
        ],
    },
    Interrupted {
        case: "parcel-bed",
        pairing: ["native", "native"],
        times: 20,
        set: &["time.end=0.5 s", "output.series_every=1 ms"],
    },
    Interrupted {
        case: "parcel-bed",
        pairing: ["openfoam", "openfoam"],
        times: 10,
        set: &[
            "time.end=0.25 s",
            "output.series_every=1 ms",
            "motion.parcels.pressure=10 Pa",
            "motion.parcels.floor=1e-2",
        ],
    },
];

impl Interrupted {
    /// The run on so many threads.
    fn command(&self, out: &Path, threads: usize) -> Command {
        let threads = threads.to_string();
        let [gas, particles] = self.pairing;
        let words = ["--gas", gas, "--particles", particles];
        let words = [&words[..], &["--threads", &threads]].concat();
        program::command(&shipped(self.case), out, &words, self.set)
    }

    /// The largest error of a line of the ledger, with its name.
    fn ledger(out: &Path) -> (String, f64) {
        let ledger = Summary::read(out).unwrap().ledger;
        let lines = ledger.lines.iter().filter(|one| CLOSED.contains(&&**one.0));
        let lines = lines.chain(&ledger.elements);
        let errors = lines.map(|(name, line)| (name.clone(), line.relative_error));
        errors.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }
}

pub fn run() {
    println!(
        "  | case, pairing | interrupts | on 1 and 2 threads | interrupted | worst line of the ledger |"
    );
    let mut failed = Vec::new();
    for (index, one) in CASES.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let [single, double, out] =
            ["single", "double", "interrupted"].map(|name| folder.path().join(name));
        finish(one.command(&single, 1));
        finish(one.command(&double, 2));
        let mut random = Random::of(SEED, index as u64);
        let growths: Vec<usize> = (0..one.times).map(|_| 1 + random.below(ROWS)).collect();
        let left = interrupt_often(|stretch| one.command(&out, 2 - stretch % 2), &out, &growths);
        let alike = [&double, &out].map(|other| values_that_differ(&single, other));
        let told = |differing: &Vec<String>| match differing.len() {
            0 => "same bits".to_owned(),
            count => format!("{count} datasets differ"),
        };
        let (line, error) = Interrupted::ledger(&out);
        let name = format!("{}, {}", one.case, one.pairing.join("+"));
        println!(
            "  | {name} | {left} | {} | {} | {line} {error:.0e} |",
            told(&alike[0]),
            told(&alike[1])
        );
        let [threads, interrupted] = alike;
        if !threads.is_empty() || !interrupted.is_empty() {
            failed.push(format!(
                "{name}: threads {threads:?}, interrupted {interrupted:?}"
            ));
        }
        if left != one.times {
            failed.push(format!("{name}: {left} interrupts of {}", one.times));
        }
        if error > LEDGER {
            failed.push(format!("{name}: {line} {error:e}"));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
