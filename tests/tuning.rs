//! Tunings: what is refused and how, what is recognised, and that they go on with the same bits.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::case::{parse_tuning, read_tuning};
use serde_json::Value;

pub(crate) fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")
}

/// A curve that falls from 100 to 60 % between 600 and 800 K.
pub(crate) fn curve(head: &str, row: impl Fn(f64, f64, f64) -> String) -> String {
    let mut text = format!("{head}\n");
    for k in 0..60 {
        let (time, temperature) = (0.5 * f64::from(k), 300.0 + 10.0 * f64::from(k));
        let mass = 100.0 - 40.0 / (1.0 + (-(f64::from(k) - 35.0) / 3.0).exp());
        text += &row(time, temperature, mass);
        text.push('\n');
    }
    text
}

pub(crate) fn plain() -> String {
    curve("Time (min),Temp (degC),Mass (%)", |t, temp, m| {
        format!("{t},{temp},{m:.4}")
    })
}

pub(crate) const CASE: &str = r#"
format = 1
kind = "tuning"
title = "test"
[model]
type = "kinetic"
[[reactions]]
laws = ["F1"]
[parameters.pre_exponential]
low = "1e2 1/s"
high = "1e20 1/s"
[parameters.activation_energy]
low = "50 kJ/mol"
high = "400 kJ/mol"
[[targets]]
file = "a.csv"
"#;

/// All that is said of a case with a curve beside it; empty where it is taken.
pub(crate) fn told(case: &str, csv: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), csv).unwrap();
    match parse_tuning(&folder.path().join("case.toml"), case, &[]) {
        Ok(_) => String::new(),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn bad_curves_are_refused_with_line_fact_and_remedy() {
    let replaced = |from: &str, to: &str| plain().replacen(from, to, 1);
    let line = |k: usize| plain().lines().nth(k - 1).unwrap().to_owned();
    let comma = |text: &str| text.replace('.', ",");
    let tenths = curve("Time (min),Temp (degC),Mass (%)", |t, temp, m| {
        format!("{t:.1},{temp:.1},{m:.1}")
    });
    let cases: Vec<(String, [&str; 3])> = vec![
        (String::new(), ["a.csv", "empty", "export the curve again"]),
        (
            "a b c\nd e f\n".into(),
            ["line 2", "no table of numbers", "`delimiter`"],
        ),
        (
            plain().replace("Mass (%)", "Mass"),
            ["line 1", "has no unit", "`units.mass`"],
        ),
        (
            plain().replace("Mass (%)", "Mass (stone)"),
            ["line 1", "\"stone\"", "`units.mass`"],
        ),
        (
            plain().replace("Mass", "Signal"),
            [
                "line 1",
                "no column was recognised as the mass",
                "`columns.mass`",
            ],
        ),
        (
            plain().replace("Time", "Clock"),
            ["line 1", "recognised as the time", "`columns.time`"],
        ),
        (
            plain().replace("Temp", "Heat"),
            ["line 1", "recognised as the temperature", "heating_rate"],
        ),
        (
            plain().replace("Temp (degC)", "Mass 2 (%)"),
            [
                "line 1",
                "several columns may be the mass",
                "`columns.mass`",
            ],
        ),
        (
            replaced("\n10,", "\n9,"),
            [
                "line 22",
                "the time goes back from 9.5 to 9 min",
                "`columns.run`",
            ],
        ),
        (
            replaced("\n10,", "\n9.5,"),
            ["line 22", "stands there twice", "remove one"],
        ),
        (comma(&tenths), ["a.csv", "decimal sign", "semicolons"]),
        (
            replaced(&line(30), "14.2,280,NaN"),
            ["line 30", "column 3 has NaN", "remove the row"],
        ),
        (
            replaced(&line(30), "14,oops,80"),
            [
                "line 30",
                "\"oops\" is not a number in column 2, \"Temp (degC)\"",
                "remove the line",
            ],
        ),
        (
            replaced(&line(30), "14,440"),
            ["line 30", "2 fields where 3 columns", "one table"],
        ),
        (
            replaced(&line(50), "24,780,90"),
            ["line 50", "the mass rises", "largest_rise"],
        ),
        (
            replaced(&line(2), "0,300,0"),
            ["line 2", "the mass is 0 % at the start", "not its change"],
        ),
        (
            replaced(&line(2), "0,300,5"),
            ["line 2", "where 100 % are meant", "`units.mass`"],
        ),
        (
            replaced(&line(40), "19,-300,62"),
            ["line 40", "the temperature -300", "unit of the temperature"],
        ),
        (
            plain().lines().take(8).collect::<Vec<_>>().join("\n"),
            ["line 2", "7 rows are no curve", "ten rows"],
        ),
        (
            curve("Time (min),Temp (degC),Mass (%)", |t, temp, _| {
                format!("{t},{temp},100")
            }),
            ["a.csv", "the mass falls by", "`columns.mass`"],
        ),
        ("PK\u{3}\u{4}xlsx".into(), ["a.csv", "no text", "CSV"]),
        (
            curve("Time (min) Temp (degC) Mass (%)", |t, temp, m| {
                comma(&format!("{t:.1} {temp:.1} {m:.1}"))
            }),
            [
                "a.csv",
                "no column was recognised as the time",
                "`columns.time`",
            ],
        ),
    ];
    for (csv, words) in cases {
        let told = told(CASE, &csv);
        for word in words {
            assert!(told.contains(word), "{word}: {told}\n{csv:.120}");
        }
    }
}

#[test]
fn bad_tuning_files_are_refused_at_their_line() {
    let cases: &[(&str, &str, &[&str])] = &[
        (
            "low = \"50 kJ/mol\"",
            "low = \"500 kJ/mol\"",
            &["low", "not below `high`", "exchange"],
        ),
        (
            "low = \"1e2 1/s\"",
            "low = \"0 1/s\"",
            &["logarithmic scale", "linear"],
        ),
        ("laws = [\"F1\"]", "laws = []", &["laws", "names no law"]),
        (
            "low = \"1e2 1/s\"",
            "low = \"-5 1/s\"\nscale = \"linear\"",
            &["is -5 ", "zero or above"],
        ),
        (
            "[[targets]]",
            "[parameters.mass_loss]\nlow = 0.1\nhigh = 2\n[[targets]]",
            &["high", "share of a mass"],
        ),
        ("low = \"50 kJ/mol\"", "low = 50", &["needs a unit"]),
        (
            "low = \"50 kJ/mol\"",
            "low = \"50 kJ\"",
            &["a molar energy"],
        ),
        ("low = \"50 kJ/mol\"", "", &["low` is missing"]),
        (
            "[parameters.activation_energy]",
            "[parameters.energy]",
            &["not a parameter of this model", "activation_energy"],
        ),
        ("\"F1\"", "\"R4\"", &["\"R4\", which is not known", "R2"]),
        ("type = \"kinetic\"", "type = \"lump\"", &["type", "lumped"]),
        (
            "type = \"kinetic\"",
            "type = \"lumped\"",
            &["sample_mass", "missing"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"b.csv\"",
            &["cannot be read", "relative to the case file"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\nconversion = [0.9, 0.1]",
            &["two numbers from 0 to 1"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\ncompare = [\"temperature\"]",
            &["takes the temperature of the file"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\ncompare = [\"loss_rate\"]",
            &["the file has no column", "`columns`"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\ncolumns = { mass = \"Weight\" }",
            &["no column is called \"Weight\"", "its columns are"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\nmass = \"5 mg\"",
            &["not a key of a case"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\n[method]\nchoose = \"speed\"",
            &["which no target compares", "mass"],
        ),
        (
            "file = \"a.csv\"",
            "file = \"a.csv\"\n[intervals]\nlevel = 1.2",
            &["level", "0.5"],
        ),
        (
            "laws = [\"F1\"]",
            "laws = [\"F1\"]\norder = 2",
            &["has no effect with these laws"],
        ),
        (
            "laws = [\"F1\"]",
            "laws = [\"F1\"]\nreactant = 0.6\nname = \"a\"\nmass_loss = 0.4\n[[reactions]]\nname = \"a\"\nreactant = 0.6\nmass_loss = 0.4",
            &["1.2 of the sample", "second time"],
        ),
    ];
    assert_eq!(told(CASE, &plain()), "");
    for (from, to, words) in cases {
        assert!(CASE.contains(from), "{from}");
        let told = told(&CASE.replacen(from, to, 1), &plain());
        for word in *words {
            assert!(told.contains(word), "{to}: {word}: {told}");
        }
    }
}

/// Warnings of a case with curves beside it, by their names.
pub(crate) fn warned(case: &str, files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, csv) in files {
        fs::write(folder.path().join(name), csv).unwrap();
    }
    let read = parse_tuning(&folder.path().join("case.toml"), case, &[]);
    read.map_err(|errors| errors.to_string()).unwrap().warnings
}

#[test]
fn what_is_likely_not_meant_is_told() {
    assert_eq!(warned(CASE, &[("a.csv", &plain())]), Vec::<String>::new());
    // Temperatures in degrees Celsius under a heading of kelvin.
    let kelvin = curve("Time (min),Temp (K),Mass (%)", |t, temp, m| {
        format!("{t},{},{m:.4}", temp - 270.0)
    });
    let [cold] = &warned(CASE, &[("a.csv", &kelvin)])[..] else {
        panic!("one warning");
    };
    assert!(
        cold.starts_with("a.csv begins at -243.1 °C (30.0 K): is the unit"),
        "{cold}"
    );
    // A row that a balance lost, of a rise that the case allows.
    let lost = plain().replace("27.5,850,60.0508", "27.5,850,20");
    assert_ne!(lost, plain());
    let allowed = format!("{CASE}largest_rise = \"90 %\"");
    let [lone] = &warned(&allowed, &[("a.csv", &lost)])[..] else {
        panic!("one warning");
    };
    assert!(
        lone.starts_with("a.csv, line 57: the mass stands alone"),
        "{lone}"
    );
    let refused = told(CASE, &lost);
    assert!(
        refused.contains(
            "a.csv: the mass is 20.000 % of that at the start in this row alone, and 60.0"
        ),
        "{refused}"
    );
    // One curve twice.
    let twice = format!("{CASE}[[targets]]\nfile = \"b.csv\"\nname = \"again\"\n");
    let files = [("a.csv", &plain()[..]), ("b.csv", &plain()[..])];
    let [same] = &warned(&twice, &files)[..] else {
        panic!("one warning");
    };
    assert!(same.contains("and again have the same values"), "{same}");
}

#[test]
fn a_stated_heating_rate_that_the_temperatures_contradict_is_refused() {
    let case = |rate: f64| {
        let start = "start_temperature = \"300 degC\"";
        format!("{CASE}heating_rate = \"{rate} K/min\"\n{start}\n")
    };
    assert_eq!(told(&case(20.0), &plain()), "");
    let refused = told(&case(15.0), &plain());
    assert!(
        refused
            .contains("is 15.0000 K/min, but the temperatures of the file rise by 20.0000 K/min"),
        "{refused}"
    );
}

#[test]
fn files_of_other_instruments_give_the_same_curve() {
    let comma = |text: String| text.replace('.', ",");
    let read = |csv: &str, keys: &str| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.csv"), csv).unwrap();
        let case = format!("{CASE}{keys}");
        let case = parse_tuning(&folder.path().join("case.toml"), &case, &[]).unwrap();
        let target = &case.targets[0];
        (
            target.run.times.clone(),
            target.values[0].1.clone(),
            target.run.programme.at(600.0).0,
        )
    };
    let expected = read(&plain(), "");
    let others = [
        (
            curve("##Temp./°C;Time/min;Mass/%", |t, temp, m| {
                comma(format!("{temp:.1};{t:.1};{m:.4}"))
            }),
            "",
        ),
        (
            curve("time\tT\tweight\nh\tK\tmg", |t, temp, m| {
                format!("{}\t{}\t{:.6}", t / 60.0, temp + 273.15, 0.05 * m)
            }),
            "columns = { temperature = \"T\" }",
        ),
        (
            curve("Instrument X\nrun of today\n\nt_s,Ts_C,TG", |t, temp, m| {
                format!("{},{temp},{m:.4}", 60.0 * t)
            }),
            "units = { mass = \"%\" }",
        ),
        (
            curve(
                "Curve Name:\n  S1, 03.04.2025\nCurve Values:\n  Index       t        Ts        Tr     Value\n        [s]      [°C]      [°C]      [mg]",
                |t, temp, m| {
                    format!(
                        "  {} {:.1} {temp:.3} {:.3} {:.6}",
                        2.0 * t,
                        60.0 * t,
                        temp + 1.2,
                        0.05 * m
                    )
                },
            ) + "Results:\n  Sample: S1, 5.0000 mg\n",
            "",
        ),
    ];
    for (csv, keys) in others {
        let found = read(&csv, keys);
        let near = |a: &[f64], b: &[f64], within: f64| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < within)
        };
        assert!(near(&found.0, &expected.0, 1e-6), "{csv:.60}");
        assert!(near(&found.1, &expected.1, 1e-5), "{csv:.60}");
        assert!((found.2 - expected.2).abs() < 1e-6, "{csv:.60}");
    }
}

/// A file that was cut after drying begins below 100 %: its masses, its rates and its loss go by what is there then, in every
/// unit, unless `sample_share` says otherwise.
#[test]
fn masses_are_relative_to_the_start_of_the_file_in_every_unit() {
    let read = |mass: &str, scale: f64, keys: &str| {
        let folder = tempfile::tempdir().unwrap();
        let rate = format!("DTG ({mass}/min)");
        let csv = curve(
            &format!("Time (min),Temp (degC),Mass ({mass}),{rate}"),
            |t, temp, m| format!("{t},{temp},{:.8},{:.8}", scale * m, scale * (m - 60.0)),
        );
        fs::write(folder.path().join("a.csv"), csv).unwrap();
        let path = folder.path().join("case.toml");
        let text = format!("{CASE}compare = [\"mass\", \"loss_rate\"]\n{keys}");
        fs::write(&path, &text).unwrap();
        let case = parse_tuning(&path, &text, &[]).unwrap();
        let (code, told) = calcine("check", &[path.to_str().unwrap()]);
        assert_eq!(code, 0, "{told}");
        let of = |k: usize| case.targets[0].values[k].1[35];
        (of(0), of(1), case.model.reactions[0].mass_loss, told)
    };
    let expected = read("%", 1.0, "");
    assert!((expected.2 - 0.4).abs() < 1e-3);
    let share = read("%", 0.97, "");
    let weighed = read("mg", 0.97 * 0.05, "");
    for found in [&share, &weighed] {
        assert!((found.0 - expected.0).abs() < 1e-6);
        assert!((found.1 / expected.1 - 1.0).abs() < 1e-6);
        assert!((found.2 - expected.2).abs() < 1e-6);
    }
    assert!(share.3.contains("masses relative to 96.99"), "{}", share.3);
    assert!(
        share.3.contains("mass loss of the reactant: 0.39"),
        "{}",
        share.3
    );
    let stated = read("%", 0.97, "sample_share = \"100 %\"");
    assert!((stated.0 / expected.0 - 0.97).abs() < 1e-4);
    assert!(
        stated.3.contains("masses relative to 100 %, as stated"),
        "{}",
        stated.3
    );
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), plain()).unwrap();
    let path = folder.path().join("case.toml");
    let case = parse_tuning(&path, &format!("{CASE}sample_mass = \"5 mg\""), &[]).unwrap();
    assert!(
        case.warnings[0].contains("`sample_share` states"),
        "{:?}",
        case.warnings
    );
    let case = format!("{CASE}sample_share = 0.97");
    let told = told(&case, &plain().replace("(%)", "(mg)"));
    assert!(
        told.contains("state `sample_mass` in place of `sample_share`"),
        "{told}"
    );
}

/// Holds at 780, 800 and 820 K of a contracting area that loses 30 %, by Riemann sums of 1 s: the first two end early.
#[test]
fn holds_that_end_early_agree_with_the_law_behind_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = CASE
        .replace("F1", "R2")
        .replace("[[targets]]\nfile = \"a.csv\"\n", "");
    text += "[parameters.mass_loss]\nlow = 0.05\nhigh = 1\n[intervals]\nbootstrap = 0\n";
    for end in [780.0f64, 800.0, 820.0] {
        let mut csv = "time [min]\ttemperature [K]\tmass [mg]\n".to_owned();
        let (mut x, mut before) = (0.0, None);
        for second in 0..5400 {
            let temperature = (500.0 + f64::from(second) / 6.0).min(end);
            let k = 1e8 * (-180e3 / 8.314_462_618 / temperature).exp();
            x += before.map_or(0.0, |before: f64| 0.5 * (before + k));
            before = Some(k);
            if second % 15 == 0 {
                let mass = 8.0 * (1.0 - 0.3 * (1.0 - (1.0 - x).max(0.0).powi(2)));
                csv += &format!(
                    "{:.6}\t{temperature:.5}\t{mass:.6}\n",
                    f64::from(second) / 60.0
                );
            }
        }
        fs::write(folder.path().join(format!("{end}.txt")), csv).unwrap();
        text += &format!("[[targets]]\nfile = \"{end}.txt\"\n");
    }
    let path = folder.path().join("case.toml");
    fs::write(&path, text).unwrap();
    let out = folder.path().join("out");
    let (code, told) = tune(&[path.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{told}");
    assert!(!told.contains("differs from that without a law"), "{told}");
    assert!(!told.contains("one heating rate"), "{told}");
    let found = summary(&out);
    let energy = &found["tuning"]["parameters"]["activation_energy"]["value"];
    assert!(
        (energy.as_f64().unwrap() / 180e3 - 1.0).abs() < 1e-3,
        "{told}"
    );
}

/// Contracting area at 10 K/min from 600 K, 30 % lost, with another energy in J/mol: conversions by Riemann sums of 1 s.
fn heated(energy: f64) -> String {
    let mut csv = "time [min]\ttemperature [K]\tmass [%]\n".to_owned();
    let mut x = 0.0;
    for second in 0..2400 {
        let temperature = 600.0 + f64::from(second) / 6.0;
        x += 1e8 * (-energy / (8.314_462_618 * temperature)).exp();
        if second % 15 == 0 {
            let mass = 100.0 * (1.0 - 0.3 * (1.0 - (1.0 - x).max(0.0).powi(2)));
            csv += &format!(
                "{:.6}\t{temperature:.5}\t{mass:.8}\n",
                f64::from(second) / 60.0
            );
        }
    }
    csv
}

/// A curve with `fit = false` leaves the parameters as they are without it, to the bit, and its errors are those of its rows in
/// `curves.csv`.
#[test]
fn curves_that_are_kept_back_are_compared_and_not_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.csv"), heated(150e3)).unwrap();
    fs::write(at("b.csv"), heated(151e3)).unwrap();
    let case = CASE.replace("F1", "R2")
        + "sample_share = \"100 %\"\n[intervals]\nbootstrap = 0\nprofile = false\n";
    let kept_back =
        "[[targets]]\nfile = \"b.csv\"\nname = \"later\"\nfit = false\nsample_share = \"100 %\"\n";
    let run = |name: &str, text: &str| {
        let path = at(&format!("{name}.toml"));
        fs::write(&path, text).unwrap();
        let out = at(name);
        let (code, told) = tune(&[path.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code, 0, "{told}");
        (summary(&out)["tuning"].clone(), out)
    };
    let stated = case.replace("laws = [\"R2\"]", "laws = [\"R2\"]\nmass_loss = 0.3");
    let (alone, _) = run("alone", &stated);
    let (both, out) = run("both", &(stated.clone() + kept_back));
    for key in ["parameters", "objectives", "evaluations"] {
        assert_eq!(alone[key], both[key], "{key}");
    }
    let text = fs::read_to_string(out.join("curves.csv")).unwrap();
    let rows = text.lines().filter(|line| line.starts_with("later,"));
    let pairs: Vec<[f64; 2]> = rows
        .map(|line| {
            let mut ends = line.rsplit(',').map(|word| word.parse().unwrap());
            [ends.next().unwrap(), ends.next().unwrap()]
        })
        .collect();
    assert_eq!(pairs.len(), 160);
    let relative = pairs.iter().map(|[m, x]| ((m - x) / x).abs()).sum::<f64>() / 160.0;
    let reacting = pairs
        .iter()
        .filter(|[_, x]| (0.001..0.999).contains(&((1.0 - x) / 0.3)));
    let largest = reacting
        .map(|[m, x]| (m - x).abs() / 0.3)
        .fold(0.0, f64::max);
    let errors = &both["curves"];
    assert_eq!(errors[0]["fitted"], true);
    assert!(errors[0]["largest_error_of_loss"].as_f64().unwrap() < 1e-3);
    assert_eq!(errors[1]["target"], "later");
    assert_eq!(errors[1]["fitted"], false);
    let of = |key: &str| errors[1][key].as_f64().unwrap();
    assert!((of("mean_relative_error") - relative).abs() < 1e-12);
    assert!((of("largest_error_of_loss") - largest).abs() < 1e-12);
    // A later curve by 1 kJ/mol of 150: some 5 K at 10 K/min.
    assert!((0.02..0.2).contains(&largest), "{largest}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("later (not fitted)"));
    fs::write(
        at("none.toml"),
        stated.replace("file =", "fit = false\nfile ="),
    )
    .unwrap();
    let (code, told) = calcine("check", &[at("none.toml").to_str().unwrap()]);
    assert_eq!(code, 2, "{told}");
    assert!(told.contains("no curve that is fitted"), "{told}");
}

/// A contracting area at 10 K/min, by its rate of loss alone, within bounds far apart: where a model's peak lies outside the curve,
/// no parameter has a slope.
#[test]
fn rates_of_loss_alone_are_fitted_by_every_law() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let text = heated(150e3);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for line in text.lines().skip(1) {
        rows.push(line.split('\t').map(|one| one.parse().unwrap()).collect());
    }
    let mut csv = "time [min]\ttemperature [K]\tDTG [%/min]\n".to_owned();
    for three in rows.windows(3) {
        let rate = (three[0][2] - three[2][2]) / (three[2][0] - three[0][0]);
        csv += &format!("{}\t{}\t{rate:.6}\n", three[1][0], three[1][1]);
    }
    fs::write(at("a.csv"), csv).unwrap();
    let text = CASE
        .replace("laws = [\"F1\"]", "laws = [\"all\"]\nmass_loss = 0.3")
        .replace("1e20", "1e25")
        .replace("400 kJ", "500 kJ")
        + "compare = [\"loss_rate\"]\n[intervals]\nbootstrap = 0\nprofile = false\n";
    fs::write(at("case.toml"), &text).unwrap();
    let run = |out: &str, set: &[&str]| {
        let (case, out) = (at("case.toml"), at(out));
        let mut words = vec![case.to_str().unwrap(), "--out", out.to_str().unwrap()];
        words.extend(set);
        tune(&words)
    };
    let (code, told) = run("all", &[]);
    assert_eq!(code, 0, "{told}");
    let found = summary(&at("all"));
    let energy = found["tuning"]["parameters"]["activation_energy"]["value"].as_f64();
    assert!((energy.unwrap() / 150e3 - 1.0).abs() < 0.01, "{told}");
    assert!(!told.contains("does not react"), "{told}");
    let criteria = found["tuning"]["laws"].as_array().unwrap().iter();
    let mut criteria: Vec<f64> = criteria.map(|one| one["aic"].as_f64().unwrap()).collect();
    criteria.sort_by(f64::total_cmp);
    // Laws that find the peak miss it by shapes of their own.
    let apart = criteria.windows(2).all(|pair| pair[1] - pair[0] > 1e-3);
    assert!(apart, "{criteria:?}");
    // Bounds within which nothing reacts.
    let cold = [
        "--set",
        "parameters.activation_energy.low=450 kJ/mol",
        "--set",
        "parameters.pre_exponential.high=1e5 1/s",
    ];
    let (code, told) = run("cold", &cold);
    assert_eq!(code, 3, "{told}");
    for word in [
        "no better than a sample that does not react",
        "Widen the bounds",
    ] {
        assert!(told.contains(word), "{told}");
    }
}

/// A change of the mass begins near zero and becomes negative.
pub(crate) fn tune(words: &[&str]) -> (i32, String) {
    calcine("tune", words)
}

pub(crate) fn calcine(command: &str, words: &[&str]) -> (i32, String) {
    let out = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg(command)
        .args(words)
        .output()
        .unwrap();
    let text =
        String::from_utf8_lossy(&out.stdout).into_owned() + &String::from_utf8_lossy(&out.stderr);
    (out.status.code().unwrap_or(-1), text)
}

pub(crate) fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

#[test]
fn the_shipped_twin_gives_back_its_numbers_and_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = cases().join("tg-tuning.toml");
    let case = case.to_str().unwrap();
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    let (first, second) = (one.to_str().unwrap(), two.to_str().unwrap());
    let short = "method.generations=40";
    let (code, text) = tune(&[case, "--set", short, "--out", first]);
    assert_eq!(code, 0, "{text}");
    let found = summary(&one);
    let parameters = &found["tuning"]["parameters"];
    let value = |name: &str| parameters[name]["value"].as_f64().unwrap();
    assert!(
        (value("contact_transfer") / 73.5 - 1.0).abs() < 0.01,
        "{text}"
    );
    assert!(
        (value("pre_exponential") / 1.63e15 - 1.0).abs() < 0.005,
        "{text}"
    );
    assert_eq!(parameters["pre_exponential"]["unit"], "1/s");
    assert!(found["tuning"]["objectives"]["mass"]["value"].is_f64());
    assert!(
        found["warnings"][0]
            .as_str()
            .unwrap()
            .contains("correlated")
    );
    // As if it had been stopped in the middle of a generation: its state, and a part of its evaluations.
    fs::create_dir(&two).unwrap();
    let stopped = fs::read_to_string(one.join("summary.json")).unwrap();
    let mut stopped: Value = serde_json::from_str(&stopped).unwrap();
    stopped["verdict"] = "stopped".into();
    fs::write(two.join("summary.json"), stopped.to_string()).unwrap();
    fs::copy(one.join("command.json"), two.join("command.json")).unwrap();
    let lines = fs::read_to_string(one.join("evaluations.csv")).unwrap();
    let part: Vec<&str> = lines.lines().take(400).collect();
    fs::write(two.join("evaluations.csv"), part.join("\n")).unwrap();
    let (code, text) = tune(&["--resume", second]);
    assert_eq!(code, 0, "{text}");
    for file in ["front.csv", "curves.csv", "profiles.csv", "evaluations.csv"] {
        let same = fs::read(one.join(file)).unwrap() == fs::read(two.join(file)).unwrap();
        assert!(same, "{file}");
    }
    assert_eq!(summary(&two)["tuning"]["parameters"], *parameters);
    let evaluations = |of: &Path| summary(of)["tuning"]["evaluations"].clone();
    assert_eq!(evaluations(&two), evaluations(&one));
    let (code, text) = tune(&[case, "--set", short, "--out", first]);
    assert!(
        code == 2 && text.contains("holds the results of another tuning"),
        "{text}"
    );
    let (code, text) = tune(&[case, "--resume", "--out", first]);
    assert!(code == 2 && text.contains("resume with the file"), "{text}");
}

#[test]
fn the_shipped_laws_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let case = cases().join("tg-laws.toml");
    let words = [
        case.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--set",
        "intervals.bootstrap=20",
    ];
    let (code, text) = tune(&words);
    assert_eq!(code, 0, "{text}");
    let found = summary(&out);
    assert_eq!(found["tuning"]["law"], "R2", "{text}");
    let energy = &found["tuning"]["parameters"]["activation_energy"];
    let of = |key: &str| energy[key].as_f64().unwrap();
    assert!((of("value") / 235.78e3 - 1.0).abs() < 0.02, "{text}");
    assert!(of("low") < of("value") && of("value") < of("high"));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains("Kissinger") && !page.contains("http"),
        "one self-contained page"
    );
    // One of the rates alone, by first order.
    let one = folder.path().join("one");
    let csv = fs::read_to_string(cases().join("tg-laws.csv")).unwrap();
    let rows = csv
        .lines()
        .filter(|line| line.starts_with("6;") || line.starts_with("rate"));
    fs::write(
        folder.path().join("tg-laws.csv"),
        rows.collect::<Vec<_>>().join("\n"),
    )
    .unwrap();
    let text = fs::read_to_string(&case).unwrap();
    let text = text.replace("[\"all\"]", "[\"F1\"]");
    let single = folder.path().join("single.toml");
    fs::write(&single, text).unwrap();
    let (code, text) = tune(&[
        single.to_str().unwrap(),
        "--out",
        one.to_str().unwrap(),
        "--set",
        "intervals.bootstrap=0",
    ]);
    assert_eq!(code, 0, "{text}");
    assert!(
        text.contains("all targets have one heating rate, 6 K/min"),
        "{text}"
    );
    for number in ["order", "exponent", "structure"] {
        let words = format!("`parameters.{number}` has no effect: none of the laws");
        assert!(text.contains(&words), "{text}");
    }
    let energy = summary(&one)["tuning"]["parameters"]["activation_energy"]["value"]
        .as_f64()
        .unwrap();
    assert!(energy / 235.78e3 > 1.2, "{energy}");
}

#[test]
fn shipped_tunings_are_in_order() {
    for name in ["tg-tuning.toml", "tg-laws.toml"] {
        let case = read_tuning(&cases().join(name), &[]).unwrap();
        assert!(!case.targets.is_empty() && case.hash.len() == 64, "{name}");
    }
}
