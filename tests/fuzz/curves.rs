//! Files of curves: no bytes make their reader panic, and what it takes is a curve.

use std::fs;
use std::path::Path;

use calcine::tuning::curves::{CurveFile, parse_curves};

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target};

/// The shipped curves and some of other forms.
pub struct Curves {
    corpus: Vec<Vec<u8>>,
}

impl Curves {
    pub fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
        let mut corpus = Vec::new();
        for name in ["tg-tuning.csv", "tg-laws.csv"] {
            let text = fs::read_to_string(root.join(name)).unwrap();
            let lines: Vec<&str> = text.lines().step_by(12).collect();
            corpus.push(lines.join("\n").into_bytes());
        }
        let rows = |head: &str, sign: &str| {
            let row = |k: i32| format!("{k}.5{sign}{}{sign}{}\n", 300 + 10 * k, 100 - k);
            (head.to_owned() + &(0..30).map(row).collect::<String>()).into_bytes()
        };
        corpus.push(rows("##Time/min;Temp./°C;Mass/%\n", ";"));
        corpus.push(rows("t  T  m\nmin  degC  mg\n", "  "));
        corpus.push(rows("run\ttemp (K)\tweight (mg)\n", "\t"));
        Self { corpus }
    }
}

impl Target for Curves {
    fn input(&self, random: &mut Random) -> Files {
        let mut bytes = random.one(&self.corpus).clone();
        let others: Vec<&[u8]> = self.corpus.iter().map(|one| &one[..]).collect();
        mutate(&mut bytes, random, &others);
        vec![("curve.csv".into(), bytes)]
    }

    fn execute(&mut self, files: &Files) -> bool {
        let read = parse_curves(Path::new("curve.csv"), &files[0].1, &CurveFile::default());
        match read {
            Ok(runs) => {
                for run in &runs {
                    assert!(run.time.windows(2).all(|pair| pair[1] > pair[0]));
                    let finite = |list: &[f64]| list.iter().all(|one| one.is_finite());
                    assert!(finite(&run.time) && finite(&run.temperature) && finite(&run.mass));
                }
                true
            }
            Err(error) => {
                assert!(!error.fact.is_empty() && !error.help.is_empty());
                false
            }
        }
    }
}
