//! Laws that a case may choose: one that this test alone declares is read, described and run.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use calcine::case::{keys, parse_with, schema};
use calcine::laws::LawCatalogue;
use calcine::simulation::Simulation;
use calcine_coupler::interior::reacting::Rate;
use calcine_coupler::physics::dimension::Dimension;
use calcine_coupler::physics::drag::Drag;
use calcine_coupler::physics::law::{Bound, LawEntry, LawParameter, LawTable};
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::reaction::{Arrhenius, LayerDiffusivity, RateLaw};
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
        needed_with: None,
        meaning: "What the drag of a lone sphere is multiplied by.",
        example: "20",
    }],
    tables: &[],
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
    let placed = keys::keys(&keys::KINDS[0], &laws());
    let factor = placed.iter().find(|key| key.place == "laws.drag.factor");
    assert_eq!(
        factor.unwrap().meaning(),
        "What the drag of a lone sphere is multiplied by. Of `stokes`."
    );
    let schema = schema::schema(&keys::KINDS[0], &laws());
    let drag = &schema["properties"]["laws"]["properties"]["drag"]["properties"];
    let names = drag["law"]["enum"].as_array().unwrap();
    assert!(names.iter().any(|name| name == "stokes"));
    assert_eq!(drag["factor"]["default"], 1.0);
}

/// A shrinking core whose rate constant a share slows, stated in a table within a table.
static HALVED: LawEntry<RateLaw> = LawEntry {
    name: "halved-core",
    summary: "A shrinking core of a rate constant times a share.",
    source: "tests/laws.rs",
    parameters: &[],
    tables: &[LawTable {
        name: "rate",
        required: true,
        meaning: "Rate constant.",
        example: "{ factor = \"0.3 m/s\", slowed = { share = 0.5 } }",
        by_name: None,
        parameters: &[LawParameter {
            name: "factor",
            dimension: Dimension::VELOCITY,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Before it is slowed.",
            example: "\"0.3 m/s\"",
        }],
        tables: &[LawTable {
            name: "slowed",
            required: true,
            meaning: "By how much it is slowed.",
            example: "{ share = 0.5 }",
            by_name: None,
            parameters: &[
                LawParameter {
                    name: "share",
                    dimension: Dimension::NONE,
                    bound: Bound::UpTo(0.0, 1.0),
                    default: None,
                    needed_with: None,
                    meaning: "What is left of it.",
                    example: "0.5",
                },
                LawParameter {
                    name: "through",
                    dimension: Dimension::DIFFUSIVITY,
                    bound: Bound::Positive,
                    default: Some(1e-5),
                    needed_with: None,
                    meaning: "Diffusivity of the layer.",
                    example: "\"1e-5 m^2/s\"",
                },
            ],
            tables: &[],
        }],
    }],
    make: |values| {
        let rate = values.table(0).unwrap();
        let slowed = rate.table(0).unwrap();
        Box::new(RateLaw::ShrinkingCore {
            rate_constant: Arrhenius {
                factor: rate[0] * slowed[0],
                exponent: 0.0,
                activation_energy: 0.0,
            },
            diffusivity: LayerDiffusivity {
                value: slowed[1],
                at: 1.0,
                exponent: 0.0,
            },
        })
    },
};

/// The rate of a box of limestone whose reaction goes by a law with these keys; else messages and helps.
fn limestone(law: &str) -> Result<Rate, Vec<String>> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/calcining-box.toml");
    let text = std::fs::read_to_string(&case).unwrap();
    let keys = |line: &&str| {
        ["rate =", "layer_diffusivity ="]
            .iter()
            .all(|key| !line.starts_with(key))
    };
    let text: Vec<&str> = text.lines().filter(keys).collect();
    let text = text.join("\n");
    assert!(text.contains("law = \"shrinking-core\""));
    let text = text.replace("law = \"shrinking-core\"", law);
    let laws = LawCatalogue::default().with_rate(&HALVED);
    match parse_with(&case, &text, &[], &laws) {
        Ok(case) => Ok(case.chemistry.reactions[0].rate.clone()),
        Err(error) => {
            let told = error.problems().iter();
            Err(told
                .map(|one| format!("{}; {}", one.message, one.help))
                .collect())
        }
    }
}

#[test]
fn a_rate_law_of_another_program_is_read_with_its_nested_tables() {
    let rate = limestone(
        "law = \"halved-core\"\nrate = { factor = \"0.3 m/s\", slowed = { share = 0.5 } }",
    );
    let Ok(Rate::Core {
        rate_constant,
        diffusivity,
    }) = rate
    else {
        panic!("{rate:?}");
    };
    assert_eq!((rate_constant.factor, diffusivity.value), (0.15, 1e-5));
    for (keys, expected) in [
        (
            "rate = { factor = \"0.3 m/s\", slowed = { shair = 0.5, share = 0.5 } }",
            "`reactions[0].rate.slowed.shair` is not a key of a case; did you mean `share`?",
        ),
        (
            "rate = { factor = \"0.3 m/s\", slowed = {} }",
            "`reactions[0].rate.slowed.share` is missing; add it, for example share = 0.5",
        ),
        (
            "rate = { factor = \"0.3 m/s\" }",
            "`reactions[0].rate.slowed` is missing; add it, for example slowed = { share = 0.5 }",
        ),
        (
            "rate = { factor = \"0.3 m/s\", slowed = { share = 2 } }",
            "`reactions[0].rate.slowed.share` is 2; it lies above 0 and up to 1",
        ),
        (
            "rate = { factor = \"0.3 m/s\", slowed = { share = 1 }, orders = { CO2 = 1 } }",
            "`reactions[0].rate.orders` does not go with law = \"halved-core\"; remove it, or write law = \"power-law\", \
             \"first-order\", \"contracting-area\", \"contracting-volume\", \"nucleation\", \"random-pore\"",
        ),
    ] {
        let told = limestone(&format!("law = \"halved-core\"\n{keys}")).unwrap_err();
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].ends_with(expected), "{told:?}");
    }
    let core = "rate = { factor = \"0.3 m/s\", slowed = { share = 1 } }\nlayer_diffusivity = { value = \"1e-5 m^2/s\" }";
    let told = limestone(&format!("law = \"shrinking-core\"\n{core}")).unwrap_err();
    let expected = "`reactions[0].rate.slowed` does not go with law = \"shrinking-core\"; \
                    remove it, or write law = \"halved-core\"";
    assert!(told.len() == 1 && told[0].ends_with(expected), "{told:?}");
}

#[test]
fn a_rate_law_of_another_program_is_in_schema_and_reference_with_its_nested_tables() {
    let laws = LawCatalogue::default().with_rate(&HALVED);
    let placed = keys::keys(&keys::KINDS[0], &laws);
    let meaning = |place: &str| {
        placed
            .iter()
            .find(|key| key.place == place)
            .unwrap()
            .meaning()
    };
    assert_eq!(
        meaning("reactions.rate.slowed"),
        "By how much it is slowed. Of `halved-core`."
    );
    assert_eq!(
        meaning("reactions.rate.slowed.share"),
        "What is left of it."
    );
    let factor = meaning("reactions.rate.factor");
    assert!(
        factor.contains("With `halved-core`: Before it is slowed."),
        "{factor}"
    );
    let schema = schema::schema(&keys::KINDS[0], &laws);
    let reaction = &schema["properties"]["reactions"]["items"]["properties"];
    let names = reaction["law"]["enum"].as_array().unwrap();
    assert!(names.iter().any(|name| name == "halved-core"));
    let slowed = &reaction["rate"]["properties"]["slowed"];
    assert_eq!(slowed["required"][0], "share");
    assert_eq!(slowed["properties"]["through"]["default"], "0.00001 m^2/s");
    // Water that dries has no rate of its own, and the diffusivity of a layer is that of one law.
    let required = schema["properties"]["reactions"]["items"]["required"]
        .as_array()
        .unwrap();
    assert!(required.iter().any(|key| key == "equation"));
    let of_one = |key: &serde_json::Value| key == "rate" || key == "layer_diffusivity";
    assert!(!required.iter().any(of_one));
}
