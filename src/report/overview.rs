//! The overview of a sweep: one self-contained page beside the folders of its runs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::colour;
use super::number::{figure, span};
use super::page::{Page, escape, stacked_table, tiles};
use super::plot::{Curve, Plot, Stroke};
use super::swept_axis::{SweptAxis, labels, swept_axis};
use crate::exit;
use crate::results::summary::QuantityResult;
use crate::results::{ResultsError, Verdict, files};

/// Name of the page in the folder of a sweep.
pub(crate) const OVERVIEW: &str = "index.html";
/// What the line above the title of each says.
const KICKER: &str = " · sweep of ";
/// Up to so many lines of a plot have the page's own colours; more have those of the scale.
const OWN_COLOURS: usize = 6;

/// A sweep.
pub(crate) struct Overview<'a> {
    /// Name of its case.
    pub name: &'a str,
    /// Title of its case.
    pub title: &'a str,
    /// All its runs, with the same keys in the same order.
    pub runs: Vec<SweptRun>,
}

/// One run of a sweep.
pub(crate) struct SweptRun {
    /// `key=value` of each key.
    pub settings: Vec<String>,
    /// What there is to read of it, from the folder of the sweep, and what that is.
    pub link: Option<(String, &'static str)>,
    /// How it ended.
    pub end: SweptEnd,
}

/// How a run ended.
pub(crate) enum SweptEnd {
    /// Not yet.
    Open,
    /// With an error.
    Failed {
        /// In words.
        how: String,
        /// What it said.
        told: String,
    },
    /// At the end of its case.
    Complete(SweptResult),
}

/// What came out of a complete run.
pub(crate) struct SweptResult {
    /// The verdict over all quantities.
    pub verdict: Verdict,
    /// Kinds of warning.
    pub warnings: usize,
    /// Quantities of interest by name.
    pub quantities: BTreeMap<String, QuantityResult>,
    /// Wall time in s.
    pub wall_time_s: f64,
}

impl SweptResult {
    fn outside(&self) -> Vec<&str> {
        let all = self.quantities.iter();
        let outside = all.filter(|(_, quantity)| quantity.verdict == Verdict::Fail);
        outside.map(|(name, _)| name.as_str()).collect()
    }

    /// The verdict in words, with the quantities that are outside their bands.
    pub fn verdict(&self) -> String {
        match self.outside()[..] {
            [] if self.verdict == Verdict::None => "no bands stated".to_owned(),
            [] => self.verdict.word().to_owned(),
            ref outside => format!("outside: {}", outside.join(", ")),
        }
    }

    /// The exit code of the run.
    pub fn exit_code(&self) -> u8 {
        match self.outside()[..] {
            [] => exit::OK,
            _ => exit::OUTSIDE_BANDS,
        }
    }
}

impl SweptRun {
    fn values(&self) -> impl Iterator<Item = &str> {
        let values = self.settings.iter();
        values.filter_map(|setting| Some(setting.split_once('=')?.1.trim_matches('"')))
    }

    fn value(&self, key: usize) -> &str {
        self.values().nth(key).unwrap_or_default()
    }

    fn result(&self) -> Option<&SweptResult> {
        match &self.end {
            SweptEnd::Complete(result) => Some(result),
            _ => None,
        }
    }

    fn quantity(&self, name: &str) -> Option<f64> {
        self.result()?.quantities.get(name)?.value
    }
}

/// True of a folder whose page, where there is one, is of a sweep.
pub(crate) fn own_overview(folder: &Path) -> bool {
    std::fs::read(folder.join(OVERVIEW))
        .map_or(true, |page| String::from_utf8_lossy(&page).contains(KICKER))
}

impl Overview<'_> {
    /// Writes the page into the folder of the sweep.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ResultsError> {
        let path = folder.join(OVERVIEW);
        files::replace(&path, self.render().as_bytes())?;
        Ok(path)
    }

    fn render(&self) -> String {
        let first = self.runs.first();
        let settings = first.map_or(&[][..], |run| &run.settings[..]);
        let keys = settings.iter().filter_map(|one| one.split_once('='));
        let keys: Vec<&str> = keys.map(|(key, _)| key).collect();
        let names = labels(&keys);
        let differs = |key: &usize| {
            let mut values = self.runs.iter().map(|run| run.value(*key));
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let (swept, same): (Vec<usize>, Vec<usize>) = (0..keys.len()).partition(differs);
        let kicker = format!("{}{KICKER}{} runs", self.name, self.runs.len());
        let mut page = Page::new(&kicker, self.title, &self.badge());
        page.raw(&self.headline());
        let same = same.iter().zip(&self.runs);
        let same = same.map(|(key, run)| format!("{} = {}", keys[*key], run.value(*key)));
        let same: Vec<String> = same.collect();
        let sentence = match same.is_empty() {
            true => String::new(),
            false => format!("All runs have {}.", same.join(", ")),
        };
        page.section("Runs", &sentence, &self.table(&swept, &names));
        page.section(
            "Runs that failed",
            "What each of them said.",
            &self.failures(&swept, &names),
        );
        page.section("Quantities", "", &self.plots(&swept, &names));
        page.finish(&format!("Calcine {}", env!("CARGO_PKG_VERSION")))
    }

    fn ended(&self) -> usize {
        let open = |run: &&SweptRun| matches!(run.end, SweptEnd::Open);
        self.runs.len() - self.runs.iter().filter(open).count()
    }

    fn failed(&self) -> impl Iterator<Item = (&SweptRun, &str, &str)> {
        self.runs.iter().filter_map(|run| match &run.end {
            SweptEnd::Failed { how, told } => Some((run, how.as_str(), told.as_str())),
            _ => None,
        })
    }

    fn badge(&self) -> String {
        let results = self.runs.iter().filter_map(SweptRun::result);
        let outside = results.filter(|result| result.exit_code() != exit::OK);
        let (class, word) = match (self.failed().count(), outside.count()) {
            _ if self.ended() < self.runs.len() => ("none", "not all have ended"),
            (0, 0) => ("pass", "complete"),
            (0, _) => ("fail", "outside its bands"),
            _ => ("fail", "with runs that failed"),
        };
        format!("<span class=\"badge {class}\">{word}</span>")
    }

    fn headline(&self) -> String {
        let results = self.runs.iter().filter_map(SweptRun::result);
        let wall: f64 = results.map(|result| result.wall_time_s).sum();
        let failed = self.failed().count();
        tiles(&[
            (
                "runs that have ended",
                self.ended().to_string(),
                format!("of {}", self.runs.len()),
            ),
            ("runs that failed", failed.to_string(), String::new()),
            ("wall time", span(wall), "of all complete runs".into()),
        ])
    }

    /// The quantities of all runs by name, with their units.
    fn quantities(&self) -> BTreeMap<&str, &str> {
        let results = self.runs.iter().filter_map(SweptRun::result);
        let all = results.flat_map(|result| &result.quantities);
        all.map(|(name, quantity)| (name.as_str(), quantity.unit.as_str()))
            .collect()
    }

    fn table(&self, swept: &[usize], names: &[String]) -> String {
        let quantities = self.quantities();
        let mut head = vec!["#run".to_owned()];
        head.extend(swept.iter().map(|key| names[*key].clone()));
        head.extend(["verdict", "#warnings"].map(str::to_owned));
        let named = quantities.iter().map(|(name, unit)| titled(name, unit));
        head.extend(named.map(|name| format!("#{name}")));
        head.extend(["#wall time", "read"].map(str::to_owned));
        let numbered = self.runs.iter().enumerate();
        let row = |(place, run): (usize, &SweptRun)| {
            let mut row = vec![(place + 1).to_string()];
            row.extend(swept.iter().map(|key| escape(run.value(*key))));
            row.push(verdict(run));
            let result = run.result();
            row.push(result.map_or(String::new(), |result| result.warnings.to_string()));
            row.extend(quantities.keys().map(|name| {
                match result {
                    None => String::new(),
                    Some(_) => run
                        .quantity(name)
                        .map_or("–".into(), |value| figure(value, 6)),
                }
            }));
            row.push(result.map_or(String::new(), |result| span(result.wall_time_s)));
            row.push(link(run));
            row
        };
        let rows: Vec<Vec<String>> = numbered.map(row).collect();
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        stacked_table(&head, &rows)
    }

    fn failures(&self, swept: &[usize], names: &[String]) -> String {
        let failed = self.failed().map(|(run, how, told)| {
            let values = swept
                .iter()
                .map(|key| format!("{} = {}", names[*key], run.value(*key)));
            let values: Vec<String> = values.collect();
            let told = match told {
                "" => "It said nothing, or on the terminal alone: its log has more.",
                told => told,
            };
            format!(
                "<h3>{}: {}</h3><pre>{}</pre>",
                escape(&values.join(", ")),
                escape(how),
                escape(told)
            )
        });
        failed.collect()
    }

    /// Each quantity over each numeric key, a line for each combination of the others.
    fn plots(&self, swept: &[usize], names: &[String]) -> String {
        let mut html = String::new();
        for (name, unit) in self.quantities() {
            for key in swept {
                let values: Vec<&str> = self.runs.iter().map(|run| run.value(*key)).collect();
                let Some(axis) = swept_axis(&values) else {
                    continue;
                };
                let others = swept.iter().filter(|other| *other != key);
                let others: Vec<usize> = others.copied().collect();
                let x_label = titled(&names[*key], &axis.unit);
                html.push_str(&self.plot((name, unit), (&axis, &x_label), &others, names));
            }
        }
        match html.is_empty() {
            true => html,
            false => format!("<div class=\"plots\">{html}</div>"),
        }
    }

    fn plot(
        &self,
        (name, unit): (&str, &str),
        (axis, x_label): (&SweptAxis, &str),
        others: &[usize],
        names: &[String],
    ) -> String {
        let mut lines: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
        for (run, x) in self.runs.iter().zip(&axis.values) {
            let of = others
                .iter()
                .map(|key| format!("{} = {}", names[*key], run.value(*key)));
            let label = of.collect::<Vec<_>>().join(", ");
            // A run without a value breaks its line.
            let point = (*x, run.quantity(name).unwrap_or(f64::NAN));
            match lines.iter_mut().find(|line| line.0 == label) {
                Some((_, points)) => points.push(point),
                None => lines.push((label, vec![point])),
            }
        }
        let lines = lines.into_iter().map(|(label, mut points)| {
            points.sort_by(|one, other| one.0.total_cmp(&other.0));
            let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            (label, x, y)
        });
        let lines: Vec<_> = lines.collect();
        let last = lines.len().max(2) - 1;
        let curves = lines.iter().enumerate().flat_map(|(place, (label, x, y))| {
            let colour = match lines.len() <= OWN_COLOURS {
                true => colour::line(place),
                // The ends of the scale are too dark and too light for a line.
                false => colour::scale(0.2 + 0.62 * place as f64 / last as f64),
            };
            let strokes = [Stroke::Solid, Stroke::Points].into_iter();
            strokes.map(move |stroke| Curve {
                label: match stroke {
                    Stroke::Points => String::new(),
                    _ => label.clone(),
                },
                colour: colour.clone(),
                x,
                y,
                stroke,
            })
        });
        let plot = Plot {
            title: titled(name, unit),
            x_label,
            logarithmic: false,
            above: None,
            band: None,
            curves: curves.collect(),
        };
        plot.render()
    }
}

/// A name in plain words with its unit.
fn titled(name: &str, unit: &str) -> String {
    let name = name.replace('_', " ");
    match unit {
        "" | "1" => name,
        unit => format!("{name} in {unit}"),
    }
}

fn verdict(run: &SweptRun) -> String {
    let (class, words) = match &run.end {
        SweptEnd::Open => return "not ended".into(),
        SweptEnd::Failed { how, .. } => ("fail", how.clone()),
        SweptEnd::Complete(result) => match result.verdict {
            Verdict::Pass | Verdict::Fail => (result.verdict.word(), result.verdict()),
            _ => return escape(&result.verdict()),
        },
    };
    format!(
        "<span class=\"badge {class}\">{}</span>",
        escape(&words.replace('_', " "))
    )
}

fn link(run: &SweptRun) -> String {
    run.link.as_ref().map_or(String::new(), |(path, word)| {
        format!("<a href=\"{}\">{word}</a>", escape(path))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(settings: [&str; 2], value: Option<f64>) -> SweptRun {
        let quantity = QuantityResult {
            value,
            unit: "Pa".into(),
            at_s: None,
            band: None,
            expected_at_s: None,
            verdict: Verdict::None,
        };
        SweptRun {
            settings: settings.map(str::to_owned).to_vec(),
            link: None,
            end: SweptEnd::Complete(SweptResult {
                verdict: Verdict::None,
                warnings: 0,
                quantities: BTreeMap::from([("pressure_drop".into(), quantity)]),
                wall_time_s: 1.0,
            }),
        }
    }

    #[test]
    fn a_quantity_has_a_plot_for_each_numeric_key_and_a_line_for_each_combination_of_the_others() {
        let runs = [("1 m/s", 1.0), ("0.5 m/s", 0.3)]
            .into_iter()
            .flat_map(|(speed, drop)| {
                ["ergun", "gidaspow"].map(|law| {
                    let speed = format!("gas.speed={speed}");
                    run([&speed, &format!("laws.drag=\"{law}\"")], Some(drop))
                })
            });
        let overview = Overview {
            name: "bed",
            title: "A bed",
            runs: runs.collect(),
        };
        let page = overview.render();
        // Laws are no axis.
        assert_eq!(page.matches("<figure>").count(), 1);
        assert!(page.contains(">speed in m/s</text>"), "{page}");
        assert!(page.contains("<figcaption>pressure drop in Pa</figcaption>"));
        for law in ["ergun", "gidaspow"] {
            assert_eq!(page.matches(&format!("</i>drag = {law}</span>")).count(), 1);
        }
        // From left to right, whatever the order of the values.
        let first = page.split("class=\"curve\"").nth(1).unwrap();
        let path = first
            .split(" d=\"M")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        let (from, to) = path.split_once('L').unwrap();
        let x = |text: &str| text.split(' ').next().unwrap().parse::<f64>().unwrap();
        let y = |text: &str| text.split(' ').nth(1).unwrap().parse::<f64>().unwrap();
        assert!(x(from) < x(to) && y(from) > y(to), "{path}");
    }

    #[test]
    fn names_and_words_of_users_are_text_and_no_html() {
        let mut one = run(["a.name=\"<b>\"", "b.x=1"], None);
        one.end = SweptEnd::Failed {
            how: "failed, exit code 2".into(),
            told: "<script>".into(),
        };
        let overview = Overview {
            name: "bed",
            title: "A bed",
            runs: vec![one, run(["a.name=\"c\"", "b.x=2"], None)],
        };
        let page = overview.render();
        assert!(page.contains("&lt;script&gt;") && !page.contains("<script"));
        assert!(page.contains("&lt;b&gt;"));
    }
}
