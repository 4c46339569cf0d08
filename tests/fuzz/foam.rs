//! Templates for OpenFOAM: no file of one makes the check of a case panic, hang or overflow the stack.

use std::fs;
use std::path::{Path, PathBuf};

use calcine::case::parse;
use tempfile::TempDir;

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target, scratch};

/// Files of the shipped templates.
const CORPUS: [&str; 6] = [
    "default/system/fvSchemes",
    "default/system/fvSolution",
    "k-epsilon/constant/turbulenceProperties",
    "k-epsilon/0/k",
    "k-epsilon/0/nut",
    "buoyantPimpleFoam/system/fvSolution",
];

/// One file of a template.
pub struct Templates {
    case: String,
    /// Names below a template, and contents.
    corpus: Vec<(String, Vec<u8>)>,
    folder: TempDir,
}

impl Templates {
    pub fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let case = fs::read_to_string(root.join("cases/heated-column.toml")).unwrap();
        let file = |path: &str| {
            let (_, name) = path.split_once('/').unwrap();
            let text = fs::read(root.join("of-cases").join(path)).unwrap();
            (name.to_owned(), text)
        };
        let folder = scratch();
        for name in ["0", "constant", "system"] {
            fs::create_dir_all(folder.path().join("template").join(name)).unwrap();
        }
        Self {
            case: case + "\n[openfoam]\ntemplate = \"template\"\n",
            corpus: CORPUS.into_iter().map(file).collect(),
            folder,
        }
    }
}

impl Target for Templates {
    fn input(&self, random: &mut Random) -> Files {
        let (name, bytes) = random.one(&self.corpus);
        let mut bytes = bytes.clone();
        let others: Vec<&[u8]> = self.corpus.iter().map(|(_, bytes)| &bytes[..]).collect();
        for _ in 0..=random.below(2) * random.below(6) {
            mutate(&mut bytes, random, &others);
        }
        vec![(name.clone(), bytes)]
    }

    fn execute(&mut self, files: &Files) -> bool {
        let (name, bytes) = &files[0];
        let file = self.folder.path().join("template").join(name);
        fs::write(&file, bytes).unwrap();
        let place: PathBuf = self.folder.path().join("case.toml");
        let read = parse(&place, &self.case, &[]);
        fs::remove_file(file).unwrap();
        match read {
            Ok(_) => true,
            Err(errors) => {
                assert!(errors.render().contains("openfoam.template"));
                false
            }
        }
    }
}
