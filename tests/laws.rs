//! Laws that a case may choose: one that this test alone declares is read, described and run.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use calcine::case::{keys, parse_with, schema};
use calcine::laws::LawCatalogue;
use calcine::simulation::Simulation;
use calcine_coupler::physics::dimension::Dimension;
use calcine_coupler::physics::drag::Drag;
use calcine_coupler::physics::law::{Bound, LawEntry, LawParameter};
use calcine_coupler::physics::local::LocalGas;
use tempfile::TempDir;

/// Stokes' drag of a lone sphere times a number.
#[derive(Debug)]
struct Stokes(f64);

impl Drag for Stokes {
    fn name(&self) -> &'static str {
        STOKES.name
    }

    fn coefficient(&self, gas: &LocalGas, diameter: f64) -> f64 {
        self.0 * 3.0 * PI * gas.viscosity * diameter
    }
}

static STOKES: LawEntry<dyn Drag> = LawEntry {
    name: "stokes",
    summary: "A lone sphere in creeping flow, times a number.",
    source: "Stokes, Trans. Camb. Phil. Soc. 9 (1851) 8",
    parameters: &[LawParameter {
        name: "factor",
        dimension: Dimension::NONE,
        bound: Bound::Positive,
        default: Some(1.0),
        meaning: "What the drag of a lone sphere is multiplied by.",
        example: "20",
    }],
    make: |values| Box::new(Stokes(values[0])),
};

fn laws() -> LawCatalogue {
    LawCatalogue::default().with_drag(&STOKES)
}

fn column() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/packed-column.toml")
}

/// Pressure drop in Pa of the packed column with a drag law, after some windows.
fn pressure_drop(drag: &str) -> f64 {
    let folder = TempDir::new().unwrap();
    let mut simulation = Simulation::open(column())
        .laws(laws())
        .set(format!("laws.drag={drag}"))
        .out(folder.path().join("out"))
        .start()
        .unwrap();
    for _ in 0..3 {
        assert!(simulation.step().unwrap().is_none());
    }
    let gas = simulation.gas().pressure;
    let (low, high) = gas.iter().fold((f64::INFINITY, 0.0f64), |(low, high), p| {
        (low.min(*p), high.max(*p))
    });
    high - low
}

#[test]
fn a_law_of_another_program_is_read_and_run_like_calcine_s_own() {
    let text = std::fs::read_to_string(column()).unwrap();
    let parse = |drag: &str| {
        let set = [format!("laws.drag={drag}")];
        parse_with(&column(), &text, &set, &laws())
    };
    let case = parse("{ law = \"stokes\", factor = 20 }").unwrap();
    let drag = case.laws.drag.make();
    assert_eq!(format!("{drag:?}"), "Stokes(20.0)");
    let message = |drag: &str| parse(drag).unwrap_err().problems()[0].message.clone();
    assert!(message("{ law = \"stokes\", factor = 0 }").ends_with("`laws.drag.factor` is 0"));
    let other = message("{ law = \"ergun\", factor = 2 }");
    assert!(
        other.ends_with("`laws.drag.factor` does not go with law = \"ergun\""),
        "{other}"
    );
    // The drag and with it the pressure drop are proportional to the factor; the weight of the gas is not.
    let drops = [100.0, 200.0, 300.0]
        .map(|factor| pressure_drop(&format!("{{ law = \"stokes\", factor = {factor} }}")));
    let steps = [drops[1] - drops[0], drops[2] - drops[1]];
    assert!(
        steps[0] > 1.0 && (steps[1] / steps[0] - 1.0).abs() < 0.01,
        "{drops:?}"
    );
}

#[test]
fn a_law_of_another_program_is_in_schema_and_reference_with_its_keys() {
    let placed = keys::keys(&laws());
    let factor = placed.iter().find(|key| key.place == "laws.drag.factor");
    assert_eq!(
        factor.unwrap().meaning(),
        "What the drag of a lone sphere is multiplied by. Of `stokes`."
    );
    let schema = schema::schema(&laws());
    let drag = &schema["properties"]["laws"]["properties"]["drag"]["properties"];
    let names = drag["law"]["enum"].as_array().unwrap();
    assert!(names.iter().any(|name| name == "stokes"));
    assert_eq!(drag["factor"]["default"], 1.0);
}
