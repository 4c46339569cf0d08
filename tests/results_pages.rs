//! Pages made of results: the report of a run, and the comparison of several.
#![allow(clippy::unwrap_used)]

use std::fs;

use calcine::case::model::ToleranceBand;
use calcine::compare::{Agreement, CompareError, compare};

use crate::support::fake;

#[test]
fn the_report_is_one_page_that_loads_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let mut case = fake::case();
    case.title = "Heat & <spheres>".into();
    fake::run(&case, &out, 0.0);
    let page = fs::read_to_string(calcine::report::write(&out).unwrap()).unwrap();
    for outside in ["http:", "https:", "src=", "href=", "@import", "<script"] {
        assert!(!page.contains(outside), "the page contains `{outside}`");
    }
    assert!(page.contains("Heat &amp; &lt;spheres&gt;"));
    // Five views of two columns of twelve cells and ten particles each.
    assert_eq!(page.matches("<polygon").count(), 5 * 24);
    assert_eq!(page.matches("class=\"sphere\"").count(), 5 * 10);
    // The curves: ten particles, three quantities, two residuals, two iterations, two errors of steps; four fields of the
    // gas and two of the particles along the probe at five times.
    assert_eq!(page.matches("class=\"curve\"").count(), 19 + 6 * 5);
    assert!(!page.contains("NaN"));
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
