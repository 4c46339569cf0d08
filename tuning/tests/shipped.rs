//! Data of the shipped tunings are those of the models that they name.
//!
//! `CALCINE_WRITE_DOCS=1` writes them anew.

use std::fmt::Write as _;
use std::path::Path;

use calcine_tuning::model::{LumpedSettings, SampleModel, SampleResponse};
use calcine_tuning::{ComparedQuantity, SearchRandom};

use crate::kinetics::{ENERGY, FACTOR, LOSS, RATES, curves};
use crate::lumped::{lumped, run};
use crate::twin::{CONTACT, TWIN_FACTOR};

fn agrees(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../cases")
        .join(name);
    if std::env::var_os("CALCINE_WRITE_DOCS").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text, "{name}");
}

#[test]
fn the_twin_data_are_those_of_the_lumped_model_with_the_published_numbers() {
    let mut truth = lumped(LumpedSettings::default());
    assert!(truth.set("contact_transfer", CONTACT) && truth.set("pre_exponential", TWIN_FACTOR));
    let run = run(15.0, 5e-6, 10.0);
    let values: Vec<f64> = truth.parameters().iter().map(|one| one.value).collect();
    let mut response = SampleResponse::default();
    truth.prepare(&run).respond(&values, &mut response).unwrap();
    let mut text = "Time (s),Sample temperature (degC),Mass (%)\n".to_owned();
    for (k, time) in run.times.iter().enumerate() {
        let (temperature, mass) = (response.temperature[k] - 273.15, 100.0 * response.mass[k]);
        writeln!(text, "{time},{temperature:.3},{mass:.4}").unwrap();
    }
    agrees("tg-tuning.csv", &text);
}

#[test]
fn the_noisy_data_are_those_of_contracting_areas_at_four_heating_rates() {
    assert_eq!((ENERGY, FACTOR, LOSS), (235.78e3, 1.13e11, 0.4397));
    let mut random = SearchRandom::new(2);
    let mut text = "rate in K/min;Temp./°C;Time/min;Mass/%\n".to_owned();
    for (rate, curve) in RATES.iter().zip(curves(&RATES, 0.005, 2)) {
        let mass = curve.of(ComparedQuantity::Mass).unwrap();
        for (time, mass) in curve.run.times.iter().zip(mass) {
            let temperature = curve.run.programme.at(*time).0 - 273.15 + 0.05 * random.normal();
            writeln!(
                text,
                "{rate};{temperature:.2};{:.4};{:.3}",
                time / 60.0,
                100.0 * mass
            )
            .unwrap();
        }
    }
    agrees(
        "tg-laws.csv",
        &text.replace('.', ",").replace("Temp,/", "Temp./"),
    );
}
