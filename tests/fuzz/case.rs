//! Case files: no text makes the reader, or the check of what it accepts, panic, hang or ask for
//! memory beyond measure.

use std::fs;
use std::path::{Path, PathBuf};

use calcine::assembly::PreparedCase;
use calcine::case::model::{Case, MeshSpec, PlacementSpec};
use calcine::case::{check_report, parse};

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target};

/// What is still meshed, packed and mapped after it was read: cells and particles.
const MOST: [f64; 2] = [3000.0, 200.0];

/// Keys for `--set`.
const KEYS: [&str; 12] = [
    "time.end",
    "time.acceleration",
    "time.checkpoint.every",
    "mesh.box.cells",
    "particles[0].diameter",
    "particles[0].place.height",
    "gas.initial.temperature",
    "gas.patch.bottom.inlet.temperature",
    "coupling.smoother",
    "laws.drag.law",
    "quantities[1].measure",
    "no.such.key",
];

/// Values for `--set`, to be mutated.
const VALUES: [&str; 10] = [
    "10 s",
    "200",
    "2 mm",
    "[3, 4, 5]",
    "\"300 K\"",
    "[[\"0 s\", 1], [\"5 s\", 20]]",
    "[[\"0 s\", \"300 K\"], [\"9 s\", \"400 K\"]]",
    "gidaspow",
    "{ max_solid_fraction = 0.6, tolerance = 1e-5 }",
    "{ particles = \"temperature\", statistic = \"mean\" }",
];

/// The shipped cases and the tests' inputs.
pub struct CaseFiles {
    corpus: Vec<(PathBuf, Vec<u8>)>,
}

impl CaseFiles {
    pub fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut corpus = Vec::new();
        for folder in ["cases", "tests/inputs/good", "tests/inputs/bad"] {
            for entry in fs::read_dir(root.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path
                    .extension()
                    .is_some_and(|extension| extension == "toml")
                {
                    // Errors of a kind are those of the reader of beds.
                    let kind = calcine::case::kind_of(&path, &[]);
                    if kind.map_or(true, |kind| kind.name == "bed") {
                        let text = fs::read(&path).unwrap();
                        corpus.push((path, text));
                    }
                }
            }
        }
        // The order of a folder's entries is not the same everywhere.
        corpus.sort();
        assert!(corpus.len() > 40, "{} case files", corpus.len());
        Self { corpus }
    }
}

impl Target for CaseFiles {
    fn input(&self, random: &mut Random) -> Files {
        // Good files are worth more: what is wrong early hides what comes later.
        let good: Vec<usize> = (0..self.corpus.len())
            .filter(|&at| !self.corpus[at].0.to_string_lossy().contains("/bad/"))
            .collect();
        let at = match random.once_in(4) {
            true => random.below(self.corpus.len()),
            false => *random.one(&good),
        };
        let (path, text) = &self.corpus[at];
        let others: Vec<&[u8]> = self.corpus.iter().map(|(_, text)| &text[..]).collect();
        let mut text = text.clone();
        for _ in 0..=random.below(2) * random.below(6) {
            mutate(&mut text, random, &others);
        }
        let mut files = vec![("case.toml".to_owned(), text)];
        if random.once_in(4) {
            let mut value = random.one(&VALUES).as_bytes().to_vec();
            if random.once_in(2) {
                mutate(&mut value, random, &others);
            }
            let set = [random.one(&KEYS).as_bytes(), b"=", &value].concat();
            files.push(("set".to_owned(), set));
        }
        // Relative paths in it are meant from its own folder.
        let place = path.to_string_lossy().into_owned();
        files.push(("place".to_owned(), place.into_bytes()));
        files
    }

    fn execute(&mut self, files: &Files) -> bool {
        let text = |name: &str| {
            let found = files.iter().find(|(other, _)| other == name);
            found.map(|(_, bytes)| String::from_utf8_lossy(bytes).into_owned())
        };
        let set: Vec<String> = text("set").into_iter().collect();
        let place = PathBuf::from(text("place").unwrap_or_default());
        match parse(&place, &text("case.toml").unwrap_or_default(), &set) {
            Ok(case) => {
                check(&case);
                true
            }
            Err(errors) => {
                assert!(!errors.problems().is_empty(), "refused without a problem");
                assert!(!errors.render().is_empty());
                false
            }
        }
    }
}

/// What `calcine check` does, for beds that are small.
fn check(case: &Case) {
    let cells = match &case.mesh {
        MeshSpec::Box { cells, .. } => cells.iter().map(|&n| n as f64).product(),
        MeshSpec::Cylinder { cells, .. } => (cells[0] * cells[0] * cells[1]) as f64,
        _ => f64::INFINITY,
    };
    let placed = |place: &PlacementSpec| match place {
        PlacementSpec::Grid { counts, .. } => counts.iter().map(|&n| n as f64).product(),
        PlacementSpec::File { .. } => 10.0,
        _ => f64::INFINITY,
    };
    let beds = case.particles.iter();
    let particles: f64 = beds.map(|population| placed(&population.place)).sum();
    if cells > MOST[0] || particles > MOST[1] {
        return;
    }
    let Ok(prepared) = PreparedCase::new(case) else {
        return;
    };
    if let Ok(packing) = prepared.packing(case) {
        let particles = &prepared.particles;
        assert!(
            !check_report(
                case,
                &prepared.mesh,
                particles,
                &packing,
                Default::default()
            )
            .is_empty()
        );
    }
}
