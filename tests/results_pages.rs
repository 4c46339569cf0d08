//! Pages made of results: the report of a run, and the comparison of several.
#![allow(clippy::unwrap_used)]

use std::fs;

use calcine::case::model::ToleranceBand;
use calcine::compare::{Agreement, CompareError, compare};
use calcine_coupler::time::Ticks;

use crate::support::fake;

#[test]
fn the_report_is_one_page_that_loads_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let mut case = fake::case();
    case.title = "Heat & <spheres>".into();
    fake::run(&case, &out, 0.0);
    let page = fs::read_to_string(calcine::report::write(&out).unwrap()).unwrap();
    for outside in ["http:", "https:", "src=", "@import", "<link"] {
        assert!(!page.contains(outside), "the page contains `{outside}`");
    }
    for link in page.split("href=\"").skip(1) {
        let file = link.split('"').next().unwrap();
        assert!(out.join(file).is_file(), "{file}");
    }
    well_formed(&page);
    assert!(page.contains("Heat &amp; &lt;spheres&gt;"));
    // Five views of two columns of twelve cells and ten particles each.
    assert_eq!(page.matches("<polygon").count(), 5 * 24);
    assert_eq!(page.matches("class=\"sphere\"").count(), 5 * 10);
    // The curves: ten particles, three quantities, two residuals, two iterations, the window; four fields of the
    // gas and two of the particles along the probe at five times.
    let curves = |text: &str| text.matches("class=\"curve\"").count();
    let (before, rest) = page.split_once("<h2>Profiles</h2>").unwrap();
    let (profiles, after) = rest.split_once("<h2>Ledger</h2>").unwrap();
    assert_eq!(curves(before) + curves(after), 18 + 6 * 5);
    // Profiles at three times; the histogram of temperatures at two.
    assert!(
        profiles.contains("Gas: temperature in K")
            && profiles.contains("Particles: temperature in K")
    );
    assert_eq!(curves(profiles) % 3, 2);
    let view = page.split("class=\"bed-view").count() - 1;
    assert_eq!((view, page.matches("class=\"bed-data\"").count()), (1, 1));
    assert!(!page.contains("NaN"));
}

#[test]
fn the_view_of_a_hundred_thousand_particles_fits_the_page() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run(&fake::case(), &out, 0.0);
    for number in 0..5 {
        let path = out.join(format!("particles/particles_{number:04}.vtp"));
        fs::write(path, many_particles(100_000, number)).unwrap();
    }
    let page = fs::read_to_string(calcine::report::write(&out).unwrap()).unwrap();
    assert!(page.len() <= 3_000_000, "{}", page.len());
    let data = page.split("class=\"bed-data\">").nth(1).unwrap();
    let data: serde_json::Value =
        serde_json::from_str(data.split("</script>").next().unwrap()).unwrap();
    let frames = data["frames"].as_array().unwrap();
    assert!(!frames.is_empty());
    assert!(frames.iter().all(|frame| frame["count"] == 100_000));
    // The last snapshot is there, with the quantity of the pictures.
    assert_eq!(frames.last().unwrap()["time"], "20 s");
    let first = data["first"].as_u64().unwrap() as usize;
    assert_eq!(data["columns"][first]["label"], "temperature in K");
    well_formed(&page);
}

/// A snapshot of particles at pseudo-random places that warm up.
fn many_particles(count: usize, number: u32) -> Vec<u8> {
    let mut state = 1_u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut arrays: [(&str, usize, Vec<f64>); 3] = [
        ("points", 3, vec![]),
        ("radius", 1, vec![]),
        ("temperature", 1, vec![]),
    ];
    for _ in 0..count {
        let centre = [
            0.01 * random(),
            0.01 * random(),
            0.1 * random() + 1e-4 * f64::from(number),
        ];
        arrays[2]
            .2
            .push(300.0 + 1000.0 * centre[2] + f64::from(number));
        arrays[0].2.extend(centre);
        arrays[1].2.push(1e-4 * (1.0 + random()));
    }
    let (mut heads, mut data) = (String::new(), Vec::new());
    for (name, components, values) in &arrays {
        heads += &format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{}\"/>",
            data.len()
        );
        data.extend((8 * values.len() as u64).to_le_bytes());
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }
    let mut file = format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt64\"><PolyData><Piece NumberOfPoints=\"{count}\">\
         <PointData>{heads}</PointData></Piece></PolyData><AppendedData encoding=\"raw\">_"
    )
    .into_bytes();
    file.extend(data);
    file.extend(b"</AppendedData></VTKFile>");
    file
}

/// Checks that each element of a page ends where it should; what has no end in HTML is let be.
fn well_formed(page: &str) {
    const EMPTY: [&str; 5] = ["meta", "input", "br", "img", "link"];
    let mut open: Vec<&str> = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        if rest.starts_with('!') {
            continue;
        }
        let end = rest.find('>').expect("a tag ends");
        let tag = &rest[..end];
        rest = &rest[end + 1..];
        let name = tag
            .trim_start_matches('/')
            .split([' ', '/', '\n'])
            .next()
            .unwrap();
        match tag {
            _ if tag.starts_with('/') => assert_eq!(open.pop(), Some(name)),
            _ if tag.ends_with('/') || EMPTY.contains(&name) => {}
            _ => {
                open.push(name);
                if ["script", "style"].contains(&name) {
                    rest = &rest[rest.find(&format!("</{name}")).expect("its text ends")..];
                }
            }
        }
    }
    assert_eq!(open, [""; 0]);
}

#[test]
fn runs_that_differ_by_less_than_the_bands_agree() {
    let scratch = tempfile::tempdir().unwrap();
    let case = fake::case();
    let runs = [("native", 0.0), ("other", 0.25)].map(|(name, shift)| {
        let out = scratch.path().join(name);
        fake::run(&case, &out, shift);
        (name.to_owned(), out)
    });
    let comparison = compare(&case, &runs).unwrap();
    assert!(comparison.agrees);
    let mean = &comparison.quantities[2];
    assert_eq!(mean.name, "mean_temperature");
    assert!((mean.largest.difference - 0.25).abs() < 1e-9);
    let field = &comparison.fields[0];
    assert_eq!(field.name, "particles.temperature");
    assert!((field.pairs[0].l2 - 0.25).abs() < 1e-9);
    assert!((field.pairs[0].maximum - 0.25).abs() < 1e-9);
    let gas = comparison
        .fields
        .iter()
        .find(|field| field.name == "gas.temperature");
    assert_eq!(gas.unwrap().pairs[0].maximum, 0.0);
    assert!(
        comparison
            .table()
            .contains("2 runs agree within the case's bands.")
    );
}

#[test]
fn runs_that_stopped_early_do_not_agree_in_words_or_by_the_verdict() {
    let scratch = tempfile::tempdir().unwrap();
    let mut case = fake::case();
    let runs = [("native", 0.0), ("other", 0.25)].map(|(name, shift)| {
        let out = scratch.path().join(name);
        fake::run(&case, &out, shift);
        (name.to_owned(), out)
    });
    case.time.end = Ticks::from_seconds(2.0 * case.time.end.seconds()).unwrap();
    let comparison = compare(&case, &runs).unwrap();
    assert!(!comparison.agrees);
    let table = comparison.table();
    assert!(!table.contains("runs agree"), "{table}");
    let words = "2 runs do not agree: their differences are within the case's bands, but not every run counts.";
    assert!(table.contains(words), "{table}");
    assert!(table.contains("Stopped early: native, other"), "{table}");
    let page = comparison
        .write(&scratch.path().join("comparison"))
        .unwrap();
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains(">stopped early</span>"), "{page}");
}

#[test]
fn a_run_outside_a_band_is_named_and_the_comparison_does_not_agree() {
    let scratch = tempfile::tempdir().unwrap();
    let mut case = fake::case();
    case.quantities[1].agree = Some(ToleranceBand::Absolute(0.5));
    let runs = [("a", 0.0), ("b", 0.1), ("c", -0.6)].map(|(name, shift)| {
        let out = scratch.path().join(name);
        fake::run(&case, &out, shift);
        (name.to_owned(), out)
    });
    let comparison = compare(&case, &runs).unwrap();
    assert!(!comparison.agrees);
    assert_eq!(comparison.quantities[0].verdict, Agreement::Inside);
    assert_eq!(comparison.quantities[1].verdict, Agreement::Outside);
    assert!((comparison.quantities[1].multiple.unwrap() - 1.4).abs() < 1e-9);
    // The band of one particle holds for the field of all.
    assert_eq!(comparison.fields[0].verdict, Agreement::Outside);
    assert_eq!(comparison.fields[0].worst().unwrap().runs, ["b", "c"]);
    let table = comparison.table();
    assert!(
        table.contains("outside its band: top_temperature, particles.temperature."),
        "{table}"
    );
    let page = comparison
        .write(&scratch.path().join("comparison"))
        .unwrap();
    assert!(
        fs::read_to_string(page)
            .unwrap()
            .contains("outside its bands")
    );
    let data = fs::read_to_string(scratch.path().join("comparison/compare.json")).unwrap();
    let data: serde_json::Value = serde_json::from_str(&data).unwrap();
    assert_eq!(data["agrees"], false);
    assert_eq!(data["quantities"][1]["verdict"], "outside");
}

#[test]
fn runs_of_different_cases_and_single_runs_are_not_compared() {
    let scratch = tempfile::tempdir().unwrap();
    let mut case = fake::case();
    let out = scratch.path().join("out");
    fake::run(&case, &out, 0.0);
    let run = ("native".to_owned(), out);
    let error = compare(&case, std::slice::from_ref(&run)).err().unwrap();
    assert!(matches!(error, CompareError::TooFew { count: 1 }));
    case.hash = "f".repeat(64);
    let error = compare(&case, &[run.clone(), run]).err().unwrap();
    assert!(matches!(error, CompareError::OtherCase { .. }), "{error}");
}
