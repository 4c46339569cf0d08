//! The docs hold what they say: commands are executed or at least parsed, case files are read, links lead somewhere.
//!
//! Each command of a fenced `sh` block in README.md, CONTRIBUTING.md and docs/ is
//! - parsed: its subcommand and options are accepted, and the files of the repository that it names exist;
//! - executed, in a scratch folder that holds what a page assumes, unless a line of [`ONLY_PARSED`] says why not.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Commands, by a part of them, that are parsed only, with the reason.
const ONLY_PARSED: &[(&str, &str)] = &[
    (
        "calcine watch",
        "shows a run until Ctrl-C, as tests/live_page.rs does",
    ),
    (
        "cargo xtask",
        "installs packages and builds; `cargo xtask test` itself runs this",
    ),
    ("python3 -m venv", "installs packages"),
    ("bin/pip install", "installs packages and compiles"),
    (
        "cargo build",
        "compiles; run by the tests of the solvers in C",
    ),
    ("cargo bench", "measures for minutes"),
    (
        "cargo run --release",
        "compiles Calcine for another program",
    ),
    ("cc -std", "compiles; run by the tests of the solvers in C"),
    (".ci/run", "runs this test"),
    (
        "--gas openfoam",
        "takes OpenFOAM; run by the tests of pairings",
    ),
    (
        "--particles liggghts",
        "takes LIGGGHTS; run by the tests of pairings",
    ),
    ("--pairings", "takes OpenFOAM; run by the tests of pairings"),
    ("mpirun", "takes several machines"),
    ("#!/bin/bash", "a queue's script; run by the tests of ranks"),
    ("sbatch --array", "takes SLURM; run by the validation slurm"),
    ("--gather", "takes what a queue has run; so does the same"),
    ("blockMesh", "takes OpenFOAM"),
    ("gmsh -3", "takes gmsh"),
    ("gmshToFoam", "takes OpenFOAM"),
    ("paraview", "takes a screen"),
    ("perf record", "takes a kernel that counts events"),
    ("python3 read.py", "takes h5py; run by the tests of readers"),
    ("export PATH", "changes the shell"),
    ("export PKG_CONFIG_PATH", "changes the shell"),
];

/// What a page may assume to be there: files of a scratch folder, by the names that pages give them.
const CASES: &[(&str, &str)] = &[
    ("bed.toml", "heated-column"),
    ("case.toml", "heated-column"),
    ("CASE", "heated-column"),
];

/// Settings that shorten runs outside the tutorial: the column's first windows.
const SHORT: &[&str] = &[
    "time.end=2 s",
    "output.every=1 s",
    "time.checkpoint.every=1 s",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The pages, relative to the repository.
fn pages() -> Vec<PathBuf> {
    fn below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let path = folder.join(entry.unwrap().file_name());
            if root().join(&path).is_dir() {
                below(&path, found);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                found.push(path);
            }
        }
    }
    let mut found: Vec<PathBuf> = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
        .map(PathBuf::from)
        .into();
    below(Path::new("docs"), &mut found);
    found.sort();
    found
}

fn text(page: &Path) -> String {
    fs::read_to_string(root().join(page)).unwrap()
}

/// The fenced blocks of a language, without the indentation of their fence.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Option<(usize, Option<String>)> = None;
    for line in page.lines() {
        let inner = line.trim_start();
        match &mut open {
            None if inner.starts_with("```") => {
                let wanted = inner.trim_start_matches('`') == language;
                open = Some((line.len() - inner.len(), wanted.then(String::new)));
            }
            Some((_, kept)) if inner.starts_with("```") => {
                found.extend(kept.take());
                open = None;
            }
            Some((indent, Some(kept))) => {
                kept.push_str(line.get(*indent..).unwrap_or(inner));
                kept.push('\n');
            }
            _ => {}
        }
    }
    assert!(open.is_none(), "a block is not closed");
    found
}

/// The commands of a block: lines, joined where a backslash ends them, without comments; a script as a whole.
fn commands(block: &str) -> Vec<String> {
    if block.starts_with("#!") {
        return vec![block.to_owned()];
    }
    let joined = block.replace("\\\n", " ");
    let lines = joined.lines().map(|line| {
        let words = split(line);
        words.join("\u{1f}")
    });
    lines.filter(|line| !line.is_empty()).collect()
}

/// The words of a line as a shell has them: quotes join, `#` begins a comment.
fn split(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for letter in line.chars() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (Some(_), _) => word.get_or_insert_default().push(letter),
            (None, '"' | '\'') => {
                word.get_or_insert_default();
                quote = Some(letter);
            }
            (None, '#') if word.is_none() => break,
            (None, ' ' | '\t') => words.extend(word.take()),
            (None, _) => word.get_or_insert_default().push(letter),
        }
    }
    assert!(quote.is_none(), "{line}: a quote is not closed");
    words.extend(word);
    words
}

/// The arguments of `calcine` in a command, also where `cargo xtask` runs it; none of another program.
fn of_calcine(words: &[String]) -> Option<Vec<String>> {
    let texts: Vec<&str> = words.iter().map(String::as_str).collect();
    let skipped = match texts.as_slice() {
        ["calcine", ..] => 1,
        ["cargo", "xtask", "calcine", ..] => 3,
        ["cargo", "xtask", "run", ..] => 2,
        _ => return None,
    };
    Some(words[skipped..].to_vec())
}

fn calcine(folder: &Path, words: &[String]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(words).current_dir(folder);
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    let texts = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    texts.concat()
}

/// Each command as its words, with its page.
fn all() -> Vec<(PathBuf, Vec<String>)> {
    let mut found = Vec::new();
    for page in pages() {
        for block in blocks(&text(&page), "sh") {
            for command in commands(&block) {
                let words = command.split('\u{1f}').map(str::to_owned).collect();
                found.push((page.clone(), words));
            }
        }
    }
    assert!(found.len() > 40, "{} commands", found.len());
    found
}

/// The reason why a command is parsed only.
fn only_parsed(words: &[String]) -> Option<&'static str> {
    let line = words.join(" ");
    ONLY_PARSED
        .iter()
        .find(|(part, _)| line.contains(part))
        .map(|(_, reason)| *reason)
}

#[test]
fn subcommands_and_options_of_every_command_are_those_of_the_program() {
    for (page, words) in all() {
        let Some(mut words) = of_calcine(&words) else {
            continue;
        };
        // Options are read before the help is shown: a wrong one ends with an error.
        let end = words.iter().position(|word| word == "--");
        words.insert(end.unwrap_or(words.len()), "--help".into());
        let output = calcine(root(), &words);
        assert!(
            output.status.success(),
            "{}: {words:?}\n{}",
            page.display(),
            said(&output)
        );
    }
    let wrong = ["run", "bed.toml", "--ranks-gaz", "2", "--help"].map(str::to_owned);
    assert!(!calcine(root(), &wrong).status.success());
}

#[test]
fn files_of_the_repository_that_commands_name_exist() {
    for (page, words) in all() {
        for word in words.iter().filter(|word| {
            ["cases/", "of-cases/", "liggghts-inputs/", "tests/", ".ci/"]
                .iter()
                .any(|folder| word.starts_with(folder))
        }) {
            assert!(root().join(word).exists(), "{}: {word}", page.display());
        }
    }
}

#[test]
fn every_reason_for_not_executing_a_command_is_of_one_that_is_there() {
    let lines: Vec<String> = all().iter().map(|(_, words)| words.join(" ")).collect();
    for (part, _) in ONLY_PARSED {
        assert!(
            lines.iter().any(|line| line.contains(part)),
            "no command with `{part}`"
        );
    }
}

/// A scratch folder with what pages assume: the shipped cases, cases of the names that pages use, and a run.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(root().join("cases"), folder.path().join("cases")).unwrap();
    for (name, like) in CASES {
        let case = root().join(format!("cases/{like}.toml"));
        fs::copy(case, folder.path().join(name)).unwrap();
    }
    folder
}

/// Executes the commands of a page in one folder, in their order. Runs outside the tutorial are shortened.
fn execute(page: &Path) {
    let folder = scratch();
    let mut here = folder.path().to_owned();
    let whole = page.ends_with("tutorial.md");
    if !whole {
        let words = ["run", "bed.toml", "--out", "results/heated-bed"].map(str::to_owned);
        let output = calcine(&here, &shortened(&words));
        assert!(output.status.success(), "{}", said(&output));
    }
    for (_, words) in all().into_iter().filter(|(of, _)| of == page) {
        if only_parsed(&words).is_some() {
            continue;
        }
        let line = words.join(" ");
        match words[0].as_str() {
            "calcine" => {
                let mut words = words[1..].to_vec();
                if !whole {
                    words = shortened(&words);
                }
                let output = calcine(&here, &words);
                let told = said(&output);
                assert!(
                    output.status.success(),
                    "{}: {line}\n{told}",
                    page.display()
                );
            }
            "cd" => {
                here.push(&words[1]);
                save_cases(page, &here);
            }
            "cat" => assert!(here.join(&words[1]).is_file(), "{}: {line}", page.display()),
            _ => panic!(
                "{}: `{line}` is neither executed nor in the list",
                page.display()
            ),
        }
    }
}

/// Saves the complete cases of a page under the names that it gives them: "Save this as `NAME`".
fn save_cases(page: &Path, folder: &Path) {
    let text = text(page);
    let names = text.split("Save this as `").skip(1);
    let names = names.map(|part| part.split('`').next().unwrap());
    let complete = blocks(&text, "toml")
        .into_iter()
        .filter(|block| block.starts_with("format"));
    for (name, block) in names.zip(complete) {
        fs::write(folder.join(name), block).unwrap();
    }
}

/// A run of a page's case is that of the short column, shorter still.
fn shortened(words: &[String]) -> Vec<String> {
    let mut words = words.to_vec();
    if !matches!(words[0].as_str(), "run" | "sweep") {
        return words;
    }
    if let Some(case) = words[1].strip_prefix("cases/").map(str::to_owned) {
        words[1] = "bed.toml".into();
        if words[0] == "sweep" {
            // The folder that the case would have had.
            words.extend(["--out".into(), format!("results/{case}-sweep")]);
        }
    }
    let set: &[&str] = if words[0] == "run" {
        SHORT
    } else {
        &SHORT[..1]
    };
    // `--resume DIR` alone takes the values that the run was begun with.
    let alone = words
        .windows(2)
        .any(|pair| pair[0] == "--resume" && !pair[1].starts_with('-'));
    let set = if alone { &[] } else { set };
    words.extend(
        set.iter()
            .flat_map(|set| ["--set".into(), (*set).to_owned()]),
    );
    words
}

#[test]
fn the_commands_of_the_tutorial_run_as_they_stand() {
    execute(Path::new("docs/tutorial.md"));
}

#[test]
fn what_the_tutorial_shows_of_check_is_what_check_prints() {
    let page = text(Path::new("docs/tutorial.md"));
    let mut shown = blocks(&page, "text");
    shown.retain(|block| block.contains("of process time   AF"));
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| {
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        let output = calcine(folder.path(), &words);
        assert!(output.status.success(), "{}", said(&output));
        String::from_utf8(output.stdout).unwrap()
    };
    run(&["new", "my-bed", "--like", "heated-bed"]);
    save_cases(Path::new("docs/tutorial.md"), folder.path());
    let printed = [
        run(&["check", "my-bed/my-bed.toml"]).replace("my-bed/my-bed.toml", "my-bed.toml"),
        run(&["check", "regenerator.toml"]),
    ];
    assert_eq!(shown[0].trim_end(), printed[0].trim_end());
    assert!(printed[1].contains(&shown[1]), "{}", printed[1]);
}

#[test]
fn the_commands_of_all_other_pages_run() {
    for page in pages() {
        if !page.ends_with("tutorial.md") && !page.ends_with("CHANGELOG.md") {
            execute(&page);
        }
    }
}

#[test]
fn case_files_of_the_docs_are_toml_and_complete_ones_are_accepted() {
    let folder = scratch();
    let mut complete = 0;
    for page in pages() {
        for block in blocks(&text(&page), "toml") {
            let read: Result<toml::Table, _> = block.parse();
            let read = read.unwrap_or_else(|error| panic!("{}: {error}\n{block}", page.display()));
            if !read.contains_key("format") {
                continue;
            }
            complete += 1;
            let file = folder.path().join(format!("docs-{complete}.toml"));
            fs::write(&file, &block).unwrap();
            let output = calcine(folder.path(), &["check".into(), file.display().to_string()]);
            assert!(
                output.status.success(),
                "{}:\n{}",
                page.display(),
                said(&output)
            );
        }
    }
    assert!(complete > 0, "the tutorial has a complete case");
}

/// The identifiers that links to a page may name: its headings as forges make them, and its anchors.
fn anchors(page: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut inside = false;
    for line in page.lines() {
        inside ^= line.trim_start().starts_with("```");
        if let Some(title) = line.strip_prefix('#').filter(|_| !inside) {
            let title = title.trim_start_matches('#').trim().to_lowercase();
            let kept = title.chars().filter_map(|letter| match letter {
                ' ' => Some('-'),
                '-' | '_' => Some(letter),
                _ => letter.is_alphanumeric().then_some(letter),
            });
            found.insert(kept.collect());
        }
        for part in line.split("<a id=\"").skip(1) {
            found.insert(part.split('"').next().unwrap().to_owned());
        }
    }
    found
}

#[test]
fn links_between_pages_lead_to_files_and_headings_that_exist() {
    let mut links = 0;
    for page in pages() {
        let folder = page.parent().unwrap();
        for part in text(&page).split("](").skip(1) {
            let target = part.split(')').next().unwrap();
            if target.contains("://") || target.contains(char::is_whitespace) {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = match file {
                "" => root().join(&page),
                file => root().join(folder).join(file),
            };
            links += 1;
            assert!(path.exists(), "{}: {target}", page.display());
            if !anchor.is_empty() {
                let known = anchors(&fs::read_to_string(&path).unwrap());
                assert!(
                    known.contains(anchor),
                    "{}: {target} of {known:?}",
                    page.display()
                );
            }
        }
    }
    assert!(links > 100, "{links} links");
}

/// Every file of the repository that people write.
fn sources() -> Vec<PathBuf> {
    let listed = Command::new("git")
        .args(["ls-files", "-z"])
        .current_dir(root())
        .output()
        .unwrap();
    let listed = String::from_utf8(listed.stdout).unwrap();
    let written = ["rs", "md", "toml", "C", "H", "h", "in", "py", "c"];
    listed
        .split('\0')
        .map(PathBuf::from)
        .filter(|path| {
            path.extension()
                .is_some_and(|it| written.iter().any(|&end| it == end))
        })
        .filter(|path| root().join(path).is_file())
        .collect()
}

/// Identifiers such as TSM-9 that follow `theory.md` in a text, also several with commas or "and" between.
fn cited(text: &str) -> BTreeSet<String> {
    let is_one = |word: &str| {
        let (letters, number) = word.split_once('-')?;
        let number = number.strip_prefix('V').unwrap_or(number);
        let digits = !number.is_empty() && number.chars().all(|it| it.is_ascii_digit());
        (letters.len() == 3 && letters.chars().all(|it| it.is_ascii_uppercase()) && digits)
            .then(|| word.to_owned())
    };
    let mut found = BTreeSet::new();
    for part in text.split("theory.md,").skip(1) {
        let words =
            part.split(|letter: char| letter.is_whitespace() || "#,;:.()/!`'\"".contains(letter));
        let mut words = words.filter(|word| !word.is_empty());
        let first: Vec<_> = words.by_ref().map_while(is_one).collect();
        found.extend(first);
    }
    found
}

#[test]
fn every_equation_that_a_text_cites_is_in_the_theory_guide() {
    let known = anchors(&text(Path::new("docs/theory.md")));
    let mut citations = 0;
    for file in sources() {
        for name in cited(&text(&file)) {
            citations += 1;
            assert!(known.contains(&name), "{}: {name}", file.display());
        }
    }
    assert!(citations > 50, "{citations} citations");
    let example = cited("(docs/theory.md, TSM-9, DRG-1). See TSM-10");
    assert_eq!(example.into_iter().collect::<Vec<_>>(), ["DRG-1", "TSM-9"]);
}
