//! `cargo xtask gallery`: runs the shipped cases and writes docs/gallery.md with a picture of each, the time it takes, its pairings, and
//! what to change first. All of it is from the runs, the case files and docs/verification.md.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::json::Json;
use crate::packages::{self, Needs};
use crate::steps::{Stop, TaskResult, new_log, output, quietly, say, step};
use crate::tasks;
use crate::workspace::{CargoProfile, Workspace};

/// Runs that take longer than this are left out, in s.
const LONGEST: u64 = 60;
/// Largest width and height of a picture in px, and of a flowsheet, which has small print.
const LARGEST: [f64; 2] = [480.0, 300.0];
const LARGEST_WIDE: [f64; 2] = [1000.0, 400.0];
/// Begin of the figure of a flowsheet.
const WIDE: &str = "<figure class=\"wide\"";
/// Begin of the line of a case that says what to change first.
const CHANGE: &str = "# Change first: ";
/// Pairings beside the native one, by the options of `calcine check`.
const PAIRINGS: [[&str; 2]; 3] = [
    ["native", "liggghts"],
    ["openfoam", "native"],
    ["openfoam", "liggghts"],
];
/// The line above the table of docs/verification.md in which pairings are compared.
const COMPARED: &str = "All four pairings (`calcine compare";

/// What is asked of the gallery.
#[derive(Debug, PartialEq, Eq)]
pub struct GalleryChoice {
    /// Names of cases; all where none is named.
    pub cases: Vec<String>,
    /// Longest time of a run in s.
    pub longest: u64,
    /// With the programs that were built last.
    pub built: bool,
}

impl GalleryChoice {
    /// From the words after `gallery`.
    pub fn read(words: &[OsString]) -> Option<Self> {
        let mut choice = Self {
            cases: Vec::new(),
            longest: LONGEST,
            built: false,
        };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match word.to_str()? {
                "--longest" => choice.longest = words.next()?.to_str()?.parse().ok()?,
                "--no-build" => choice.built = true,
                option if option.starts_with('-') => return None,
                name => choice.cases.push(name.trim_end_matches(".toml").into()),
            }
        }
        Some(choice)
    }
}

/// Runs the cases and writes the page. Sections of cases that were not asked for stay as they are.
pub fn run(workspace: &Workspace, choice: &GalleryChoice) -> TaskResult<()> {
    let browser = browser()?;
    let shipped = shipped(workspace)?;
    if let Some(unknown) = choice.cases.iter().find(|name| !shipped.contains(name)) {
        return Err(Stop(format!(
            "cases/{unknown}.toml does not exist; the cases are {}",
            shipped.join(", ")
        )));
    }
    if !choice.built {
        let _lock = workspace.lock()?;
        packages::install(Needs::NATIVE, &workspace.logs)?;
        tasks::build_parts(workspace, Needs::NATIVE, tasks::BuildScope::Runs)?;
    }
    let gallery = Gallery {
        workspace,
        calcine: workspace
            .target
            .join(CargoProfile::Release.folder())
            .join("calcine"),
        browser,
        longest: Duration::from_secs(choice.longest),
    };
    let asked = |name: &&String| choice.cases.is_empty() || choice.cases.contains(name);
    for name in shipped.iter().filter(asked) {
        gallery.accepts(name)?;
    }
    let path = workspace.root.join("docs/gallery.md");
    let before = fs::read_to_string(&path).unwrap_or_default();
    let mut sections = Vec::new();
    let mut left_out = Vec::new();
    for name in &shipped {
        if !asked(&name) {
            match section_of(&before, name) {
                Some(section) => sections.push(section.to_owned()),
                None => left_out.push(name.as_str()),
            }
            continue;
        }
        match gallery.section(name)? {
            Some(section) => sections.push(section),
            None => {
                say(&format!(
                    "{name} is left out: it takes more than {} s",
                    choice.longest
                ));
                left_out.push(name);
            }
        }
    }
    let page = page(&sections, &left_out);
    fs::write(&path, page).map_err(|cause| Stop::io(&path, &cause))?;
    say(&format!(
        "{} has {} cases; left out: {}",
        path.display(),
        sections.len(),
        if left_out.is_empty() {
            "none".into()
        } else {
            left_out.join(", ")
        }
    ));
    Ok(())
}

/// Names of the shipped cases.
fn shipped(workspace: &Workspace) -> TaskResult<Vec<String>> {
    let folder = workspace.root.join("cases");
    let entries = fs::read_dir(&folder).map_err(|cause| Stop::io(&folder, &cause))?;
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|entry| {
            Some(
                entry
                    .file_name()
                    .to_str()?
                    .strip_suffix(".toml")?
                    .to_owned(),
            )
        })
        .collect();
    names.sort_unstable();
    Ok(names)
}

/// The browser that draws the pictures of reports.
fn browser() -> TaskResult<&'static str> {
    ["chromium", "google-chrome", "chromium-browser"]
        .into_iter()
        .find(|name| packages::is_here(name))
        .ok_or_else(|| {
            Stop::new("pictures of reports are drawn by Chromium, which is not here: apt-get install chromium")
        })
}

/// What the gallery is made with.
struct Gallery<'a> {
    workspace: &'a Workspace,
    calcine: PathBuf,
    browser: &'static str,
    longest: Duration,
}

impl Gallery<'_> {
    /// The section of a case; nothing where its run takes too long.
    fn section(&self, name: &str) -> TaskResult<Option<String>> {
        let (case, text) = self.case(name)?;
        let change = change(name, &text)?;
        let out = self.workspace.target.join("xtask/gallery").join(name);
        let Some(took) = self.timed(&case, &out)? else {
            return Ok(None);
        };
        let file = format!("images/gallery/{name}.png");
        step(&format!("picture of {name}"), || {
            self.picture(&out, &self.workspace.root.join("docs").join(&file))
        })?;
        let summary = out.join("summary.json");
        let summary = fs::read_to_string(&summary).ok();
        let summary = summary.and_then(|text| Json::read(&text));
        let title = value(&text, "title").unwrap_or(name);
        let pairings = self.pairings(&case, &text);
        let compared = self.compared(name)?;
        Ok(Some(format!(
            "## {name}\n\n![{title}]({file})\n\n{title}. {}{} s: `calcine run cases/{name}.toml`.\n\n- {pairings}{compared}\n- \
             Change first: `--set \"{}\"`, {}.\n",
            summary.as_ref().map(sizes).unwrap_or_default(),
            rounded(took.as_secs_f64()),
            change.0,
            change.1
        )))
    }

    /// A case and its text.
    fn case(&self, name: &str) -> TaskResult<(PathBuf, String)> {
        let case = self.workspace.root.join(format!("cases/{name}.toml"));
        let text = fs::read_to_string(&case).map_err(|cause| Stop::io(&case, &cause))?;
        Ok((case, text))
    }

    /// Has `calcine check` take what to change first, so that the page names keys that there are.
    fn accepts(&self, name: &str) -> TaskResult<()> {
        let (case, text) = self.case(name)?;
        let log = new_log(&self.workspace.logs, "gallery-check")?;
        let mut check = Command::new(&self.calcine);
        let (change, _) = change(name, &text)?;
        quietly(check.arg("check").arg(case).args(["--set", change]), &log)
    }

    /// Runs a case; the time that it took, or nothing where it was ended because it took too long.
    fn timed(&self, case: &Path, out: &Path) -> TaskResult<Option<Duration>> {
        let _ = fs::remove_dir_all(out);
        let begun = Instant::now();
        let mut child = Command::new(&self.calcine)
            .arg("run")
            .arg(case)
            .arg("--quiet")
            .arg("--out")
            .arg(out)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|cause| Stop::io(&self.calcine, &cause))?;
        loop {
            let status = child.try_wait();
            if let Some(status) = status.map_err(|cause| Stop::io(&self.calcine, &cause))? {
                let took = begun.elapsed();
                // Quantities that miss their bands, 1, are told by the report; a run that has them is complete.
                if matches!(status.code(), Some(0 | 1)) {
                    return Ok(Some(took));
                }
                return Err(Stop(format!("{}: {status}", case.display())));
            }
            if begun.elapsed() > self.longest {
                let _ = child.kill();
                let _ = child.wait();
                return Ok(None);
            }
            sleep(Duration::from_millis(20));
        }
    }

    /// Draws the first picture of a report, as it stands there.
    fn picture(&self, out: &Path, file: &Path) -> TaskResult<()> {
        let report = out.join("report.html");
        let html = fs::read_to_string(&report).map_err(|cause| Stop::io(&report, &cause))?;
        let figure =
            figure(&html).ok_or_else(|| Stop(format!("{} has no picture", report.display())))?;
        let [width, height] = size(figure).unwrap_or(LARGEST);
        let largest = if figure.starts_with(WIDE) {
            LARGEST_WIDE
        } else {
            LARGEST
        };
        let scale = (largest[0] / width).min(largest[1] / height);
        let [width, height] = [width, height].map(|side| (side * scale).ceil());
        let styles = html.split_inclusive("</style>").filter_map(|part| {
            let at = part.find("<style>")?;
            Some(&part[at..])
        });
        let page = format!(
            "<!doctype html><meta charset=\"utf-8\"><title>picture</title>{}<style>:root{{color-scheme:light}}html,body{{margin:0;background:#fff}}\
             figcaption,.legend{{display:none}}figure svg{{width:{width}px!important;height:{height}px!important;min-width:0!important;max-width:none!important;margin:0!important}}</style>{figure}",
            styles.collect::<String>()
        );
        let drawn = out.join("picture.html");
        fs::write(&drawn, page).map_err(|cause| Stop::io(&drawn, &cause))?;
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
        }
        let log = new_log(&self.workspace.logs, "gallery-picture")?;
        let mut draw = Command::new(self.browser);
        draw.args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--force-device-scale-factor=1",
        ])
        .arg(format!("--window-size={width},{height}"))
        .arg(format!("--screenshot={}", file.display()))
        .arg(format!("file://{}", drawn.display()));
        quietly(&mut draw, &log)
    }

    /// Which pairings `calcine check` takes the case in.
    fn pairings(&self, case: &Path, text: &str) -> String {
        if let Some(kind) = value(text, "kind") {
            return match kind {
                "tuning" => "A tuning: no pairing.".into(),
                _ => "A plant: its units are Calcine's own, beds in them natively.".into(),
            };
        }
        let taken = PAIRINGS.iter().filter(|[gas, particles]| {
            let mut check = Command::new(&self.calcine);
            check.arg("check").arg(case);
            output(check.args(["--gas", gas, "--particles", particles])).is_some()
        });
        let others: Vec<String> = taken
            .map(|pairing| format!("`{}`", pairing.join("+")))
            .collect();
        match others.is_empty() {
            true => "Pairings: `native+native` only.".into(),
            false => format!(
                "Pairings: `native+native` (this run), {}.",
                others.join(", ")
            ),
        }
    }

    /// What docs/verification.md tells of the case in all pairings.
    fn compared(&self, name: &str) -> TaskResult<String> {
        let path = self.workspace.root.join("docs/verification.md");
        let text = fs::read_to_string(&path).map_err(|cause| Stop::io(&path, &cause))?;
        Ok(
            difference(&text, name).map_or_else(String::new, |difference| {
                format!(" [Compared](verification.md), largest differences: {difference}.")
            }),
        )
    }
}

/// The difference between pairings of a case in the table of the verification page.
fn difference<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let table = &text[text.find(COMPARED)?..];
    let rows = table.lines().skip_while(|line| !line.starts_with('|'));
    rows.take_while(|line| line.starts_with('|'))
        .find_map(|row| {
            let (case, difference) = row.trim_matches(['|', ' ']).split_once(" | ")?;
            (case.split(',').next()? == name).then_some(difference)
        })
}

/// What to change first of a case, as an argument of `--set`, and in words.
fn change<'a>(name: &str, text: &'a str) -> TaskResult<(&'a str, &'a str)> {
    let line = text.lines().find_map(|line| line.strip_prefix(CHANGE));
    line.and_then(|line| line.split_once("  ")).ok_or_else(|| {
        Stop(format!(
            "cases/{name}.toml has no line `{CHANGE}KEY=VALUE  what it is`, with two spaces before the words"
        ))
    })
}

/// The value of a key of text that stands in a line of its own before the first table.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let lines = text.lines().take_while(|line| !line.starts_with('['));
    let mut values =
        lines.filter_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix('='));
    values.next()?.trim().strip_prefix('"')?.strip_suffix('"')
}

/// Cells, particles and windows of a run.
fn sizes(summary: &Json) -> String {
    let whole = |key: &str| summary.number(&[key]).filter(|number| *number > 0.0);
    let told = [
        ("particles", "particles"),
        ("cells", "cells"),
        ("windows", "windows"),
    ];
    let told: Vec<String> = told
        .into_iter()
        .filter_map(|(key, words)| {
            let number = whole(key)?;
            let words = if number == 1.0 {
                &words[..words.len() - 1]
            } else {
                words
            };
            Some(format!("{number:.0} {words}"))
        })
        .collect();
    match told.is_empty() {
        true => String::new(),
        false => format!("{}, ", told.join(", ")),
    }
}

/// A time in s in two figures.
fn rounded(seconds: f64) -> String {
    match seconds {
        time if time < 1.0 => format!("{time:.2}"),
        time if time < 10.0 => format!("{time:.1}"),
        time => format!("{time:.0}"),
    }
}

/// The figure of a report that shows most of it: side views of the bed, a flowsheet, or its first plot.
fn figure(html: &str) -> Option<&str> {
    let begin = ["<figure class=\"picture\"", WIDE, "<figure"];
    let at = begin.iter().find_map(|begin| html.find(begin))?;
    let end = html[at..].find("</figure>")? + "</figure>".len();
    Some(&html[at..at + end])
}

/// Width and height of the first drawing in a figure.
fn size(figure: &str) -> Option<[f64; 2]> {
    let text = figure.split("viewBox=\"").nth(1)?.split('"').next()?;
    let numbers: Vec<f64> = text.split(' ').filter_map(|one| one.parse().ok()).collect();
    let [_, _, width, height] = numbers[..] else {
        return None;
    };
    (width > 0.0 && height > 0.0).then_some([width, height])
}

/// The section of a case on a page.
fn section_of<'a>(page: &'a str, name: &str) -> Option<&'a str> {
    let heading = format!("## {name}\n");
    let begin = page.find(&heading)?;
    let rest = &page[begin + heading.len()..];
    let end = rest.find("\n## ").map_or(rest.len(), |end| end + 1);
    Some(page[begin..begin + heading.len() + end].trim_end_matches('\n'))
        .filter(|one| !one.is_empty())
}

/// The page.
fn page(sections: &[String], left_out: &[&str]) -> String {
    let mut page = String::from(
        "# Gallery\n\nThe shipped cases, each with the picture of its report, the time of its run where the page was made (two cores, which other \
         work may have shared), the pairings that take it, and what to change first. `cargo xtask gallery` makes this page from runs; `calcine new NAME --like CASE` makes a case of your own from one of \
         them.\n\n",
    );
    for section in sections {
        page.push_str(section.trim_end_matches('\n'));
        page.push_str("\n\n");
    }
    if !left_out.is_empty() {
        let names: Vec<String> = left_out
            .iter()
            .map(|name| format!("`cases/{name}.toml`"))
            .collect();
        page.push_str(&format!(
            "## Longer runs\n\nNot shown, as they take longer than the time given by `--longest`: {}.\n",
            names.join(", ")
        ));
    }
    page.trim_end_matches('\n').to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn cases_and_the_longest_time_are_read() {
        let choice =
            GalleryChoice::read(&words("hopper pipe.toml --longest 5 --no-build")).unwrap();
        assert_eq!(choice.cases, ["hopper", "pipe"]);
        assert_eq!((choice.longest, choice.built), (5, true));
        assert_eq!(GalleryChoice::read(&words("--quick")), None);
        assert_eq!(GalleryChoice::read(&words("--longest soon")), None);
    }

    #[test]
    fn each_shipped_case_says_what_to_change_first() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases");
        let mut count = 0;
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let name = entry.file_name().into_string().unwrap();
            if let Some(name) = name.strip_suffix(".toml") {
                let text = fs::read_to_string(entry.path()).unwrap();
                let (key, words) = change(name, &text).unwrap_or_else(|stop| panic!("{}", stop.0));
                assert!(key.contains('=') && !words.is_empty(), "{name}: {key}");
                assert!(value(&text, "title").is_some(), "{name}");
                count += 1;
            }
        }
        assert!(count > 20, "{count}");
    }

    #[test]
    fn the_picture_of_a_report_is_the_bed_before_a_plot() {
        let html = "<figure><svg viewBox=\"0 0 5 5\"></svg></figure><figure class=\"picture\"><svg viewBox=\"0 0 80 40\"></svg></figure>";
        let found = figure(html).unwrap();
        assert_eq!(size(found), Some([80.0, 40.0]));
        assert!(found.ends_with("</figure>"));
        assert_eq!(figure("<p>none</p>"), None);
    }

    #[test]
    fn sections_of_a_page_are_found_again() {
        let sections = ["## one\n\ntext\n".to_owned(), "## two\n\nmore\n".to_owned()];
        let page = page(&sections, &["three"]);
        assert_eq!(section_of(&page, "one"), Some("## one\n\ntext"));
        assert_eq!(section_of(&page, "two"), Some("## two\n\nmore"));
        assert_eq!(section_of(&page, "three"), None);
        assert!(page.ends_with("`cases/three.toml`.\n"));
    }

    #[test]
    fn differences_are_those_of_the_table_of_pairings() {
        let text = "| hopper | no |\n\nAll four pairings (`calcine compare x`):\n\n| case | difference |\n|---|---|\n| hopper, 1 s | 2 mm |\n\n| pipe | no |\n";
        assert_eq!(difference(text, "hopper"), Some("2 mm"));
        assert_eq!(difference(text, "pipe"), None);
    }
}
