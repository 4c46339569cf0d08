//! Files of curves as instruments and people write them: changes of mass, runs, headings, heating rates.

use std::fs;

use calcine::case::parse_tuning;

use crate::tuning::{CASE, calcine, curve, plain, told, warned};

#[test]
fn a_change_of_the_mass_is_refused_in_every_unit() {
    let change = |unit: &str, scale: f64| {
        curve(
            &format!("Time (min),Temp (degC),Mass ({unit})"),
            |t, temp, m| {
                let noise = 0.01 * (17.0 * t).sin();
                format!("{t},{temp},{:.4}", scale * (m - 99.6 + noise))
            },
        )
    };
    let stated = format!("{CASE}sample_mass = \"8 mg\"\n");
    let share = format!("{CASE}sample_share = \"100 %\"\n");
    for (case, csv) in [
        (CASE, change("mg", 0.08)),
        (&stated[..], change("mg", 0.08)),
        (CASE, change("%", 1.0)),
        (&share[..], change("%", 1.0)),
        // From 30 % of the mass on, to 10 % below zero.
        (
            CASE,
            curve("Time (min),Temp (degC),Mass (%)", |t, temp, m| {
                format!("{t},{temp},{:.4}", m - 70.0)
            }),
        ),
    ] {
        let told = told(case, &csv);
        assert!(told.contains("export the mass of the sample"), "{told}");
    }
    // All of a sample that burns, and a balance that drifts by 2 % beyond it.
    let burnt = curve("Time (min),Temp (degC),Mass (%)", |t, temp, m| {
        format!("{t},{temp},{:.4}", 2.55 * (m - 100.0) + 100.0)
    });
    assert_eq!(told(CASE, &burnt), "");
}

/// Runs that the file tells apart by texts have these as names; another column of texts is told with its heading.
#[test]
fn runs_may_be_told_apart_by_texts() {
    let rows = |head: &str, name: &str| {
        let of = |run: &str| {
            let text = curve(head, |t, temp, m| format!("{run},{t},{temp},{m:.4}"));
            text.split_once('\n').unwrap().1.to_owned()
        };
        format!(
            "{head}\n{}{}",
            of(&format!("{name}5")),
            of(&format!("{name}10"))
        )
    };
    let read = |head: &str, name: &str, keys: &str| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.csv"), rows(head, name)).unwrap();
        let case = format!("{CASE}{keys}");
        let case = parse_tuning(&folder.path().join("case.toml"), &case, &[]);
        let case = case.map_err(|errors| errors.to_string()).unwrap();
        let names = case.targets.iter().map(|one| one.name.clone());
        names.collect::<Vec<String>>()
    };
    let of_sample = "Sample,Time (min),Temp (degC),Mass (%)";
    let of_run = "run,Time (min),Temp (degC),Mass (%)";
    let key = "columns = { run = \"Sample\" }";
    assert_eq!(read(of_sample, "S", key), ["S5", "S10"]);
    assert_eq!(
        read(of_sample, "S", "columns = { run = \"1\" }"),
        ["S5", "S10"]
    );
    assert_eq!(read(of_run, "S", ""), ["S5", "S10"]);
    // Numbers are no names.
    assert_eq!(read(of_run, "", ""), ["20 K/min", "20 K/min'"]);
    let named = format!("{key}\nname = \"lime\"");
    assert_eq!(read(of_sample, "S", &named), ["lime S5", "lime S10"]);
    let told = told(CASE, &rows(of_sample, "S"));
    for word in [
        "\"S5\" is not a number in column 1, \"Sample\"",
        "`columns.run`",
    ] {
        assert!(told.contains(word), "{told}");
    }
}

/// Signals of TA Instruments in UTF-16, and headings that are not known.
#[test]
fn headings_of_other_instruments_are_recognised_or_shown() {
    let head = "Version\tV1\nNsig\t3\nSig1\tTime (min)\nSig2 Temperature (°C)\nSig3\tWeight (mg)\nOrgFile a.001\nStartOfData";
    let text = curve(head, |t, temp, m| format!("{t}\t{temp}\t{:.6}", 0.05 * m));
    for mark in [&[0xff, 0xfe][..], &[]] {
        let folder = tempfile::tempdir().unwrap();
        let units = text.encode_utf16().flat_map(u16::to_le_bytes);
        let bytes: Vec<u8> = mark.iter().copied().chain(units).collect();
        fs::write(folder.path().join("a.csv"), bytes).unwrap();
        let case = parse_tuning(&folder.path().join("case.toml"), CASE, &[]);
        let case = case.map_err(|errors| errors.to_string()).unwrap();
        let run = &case.targets[0].run;
        assert_eq!((run.times[1], run.programme.at(0.0).0), (30.0, 573.15));
        assert!((run.sample_mass / 5e-6 - 1.0).abs() < 1e-3);
    }
    let unknown = curve("Clock Oven Sample Signal A", |t, temp, m| {
        format!("{t} {temp} {m:.4}")
    });
    let told = told(CASE, &unknown);
    assert!(
        told.contains("the line above them is \"Clock Oven Sample Signal A\""),
        "{told}"
    );
}

/// 20 K/min after a hold of 4 min.
fn held() -> String {
    let mut text = "Time (min),Temp (degC),Mass (%)\n".to_owned();
    for k in 0..80 {
        let (time, temperature) = (0.5 * f64::from(k), 300.0 + 10.0 * f64::from((k - 8).max(0)));
        let mass = 100.0 - 40.0 / (1.0 + (-(f64::from(k) - 43.0) / 3.0).exp());
        text += &format!("{time},{temperature},{mass:.4}\n");
    }
    text
}

/// The furnace of a lumped model is checked as that of a kinetic one, by the ramp and by the time of its start.
#[test]
fn a_stated_heating_rate_that_a_lumped_model_cannot_have_is_refused() {
    let lumped = CASE.replace("\"kinetic\"", "\"lumped\"")
        + "sample_mass = \"5 mg\"\nstart_temperature = \"300 degC\"\n";
    let stated = |rate: f64| format!("{lumped}heating_rate = \"{rate} K/min\"\n");
    assert_eq!(told(&stated(20.0), &plain()), "");
    let refused = told(&stated(15.0), &plain());
    assert!(
        refused.contains("the file rise by 20.0000 K/min"),
        "{refused}"
    );
    // The mean over the hold is 18 K/min, and a furnace without it is 80 K ahead.
    let refused = told(&stated(18.0), &held());
    assert!(
        refused.contains("the file rise by 20.0000 K/min"),
        "{refused}"
    );
    let refused = told(&stated(20.0), &held());
    assert!(
        refused.contains("is 20.0000 K/min from 300.0 °C on, 80 K above"),
        "{refused}"
    );
}

/// A hold at the start is no part of the heating rate, of which targets have their names.
#[test]
fn targets_have_the_heating_rate_of_their_ramp() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), held()).unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, CASE).unwrap();
    let (code, told_of_check) = calcine("check", &[path.to_str().unwrap()]);
    assert_eq!(code, 0, "{told_of_check}");
    assert!(
        told_of_check
            .contains("target 20 K/min: mass over 80 times, 300.0 to 1010.0 °C at 20 K/min"),
        "{told_of_check}"
    );
    let refused = told(&format!("{CASE}heating_rate = \"5\"\n"), &plain());
    assert!(
        refused.contains("needs a unit, for example \"5 K/min\""),
        "{refused}"
    );
}

#[test]
fn a_file_of_a_few_rows_is_no_curve() {
    for rows in 1..5 {
        let text = "Time (min);Temp (degC);Mass (%)\n".to_owned() + &"1;20;100\n".repeat(rows);
        let told = told(CASE, &text);
        let few = format!("{rows} rows of numbers are no curve");
        assert!(told.contains(&few), "{told}");
    }
}

#[test]
fn bounds_of_several_decades_on_a_linear_scale_are_told() {
    let linear = |low: &str, high: &str| {
        let case = CASE.to_owned();
        let (start, end) = {
            let start = case.find("[parameters.pre_exponential]").unwrap();
            let end = start + case[start + 1..].find('[').unwrap() + 1;
            (start, end)
        };
        let bounds = format!(
            "[parameters.pre_exponential]\nlow = \"{low}\"\nhigh = \"{high}\"\nscale = \"linear\"\n"
        );
        let case = [&case[..start], &bounds, &case[end..]].concat();
        warned(&case, &[("a.csv", &plain())])
    };
    let [told] = &linear("1e3 1/s", "1e15 1/s")[..] else {
        panic!("one warning");
    };
    assert!(told.contains("scale = \"logarithmic\""), "{told}");
    assert_eq!(linear("0 1/s", "1e9 1/s").len(), 1);
    assert_eq!(linear("1e9 1/s", "1e12 1/s"), Vec::<String>::new());
}

#[test]
fn a_file_that_two_targets_name_is_told() {
    let twice = format!("{CASE}[[targets]]\nfile = \"a.csv\"\nfit = false\n");
    let [told] = &warned(&twice, &[("a.csv", &plain())])[..] else {
        panic!("one warning");
    };
    assert!(told.starts_with("a.csv is named by two targets"), "{told}");
}

/// A loss that is tuned need not be stated, where the curves do not tell it either.
#[test]
fn a_mass_loss_that_is_tuned_need_not_be_stated() {
    let rates = curve("Time (min),Temp (degC),DTG (%/min)", |t, temp, m| {
        format!("{t},{temp},{:.4}", (100.0 - m) * (m - 60.0) / 60.0)
    });
    let missing = told(CASE, &rates);
    assert!(missing.contains("mass_loss` is missing"), "{missing}");
    let bounds = "[parameters.mass_loss]\nlow = 0.1\nhigh = 1\n";
    let case = CASE.replace("[[targets]]", &format!("{bounds}[[targets]]"));
    assert_eq!(told(&case, &rates), "");
    let two = case
        .replace(
            "laws = [\"F1\"]",
            "name = \"a\"\nreactant = 0.5\n[[reactions]]\nname = \"b\"\nreactant = 0.5\nmass_loss = 0.4",
        )
        .replace("[parameters.", "[parameters.\"a.")
        .replace("pre_exponential]", "pre_exponential\"]")
        .replace("activation_energy]", "activation_energy\"]")
        .replace("mass_loss]", "mass_loss\"]");
    assert_eq!(told(&two, &plain()), "");
}
