//! Laws, energies and intervals from noisy curves at several heating rates.

use std::sync::atomic::AtomicBool;

use calcine_physics::dimension::Dimension;
use calcine_tuning::analysis::{
    SmoothedRun, friedman, kissinger, kissinger_temperature, ozawa_flynn_wall,
};
use calcine_tuning::information::{akaike, choose};
use calcine_tuning::interval::{BootstrapSettings, bootstrap, profile};
use calcine_tuning::law::{CONVERSION_LAWS, conversion_law, law_defaults};
use calcine_tuning::least_squares::{FitChoice, FittedPlaces, fit};
use calcine_tuning::model::{
    HeatingRun, KineticModel, ReactionSet, SampleModel, SampleReaction, SampleResponse,
};
use calcine_tuning::search::{StartSettings, fit_globally};
use calcine_tuning::{
    ComparedQuantity, DifferenceForm, ParameterSpace, SampleProblem, SearchRandom, TargetCurve,
    TemperatureProgramme, TunedParameter, TuningProblem, WholeLoss,
};

/// Contracting area of calcite, Crystals 10(9) 849: requirements DEC-T15.
pub const ENERGY: f64 = 235.78e3;
pub const FACTOR: f64 = 1.13e11;
pub const LOSS: f64 = 0.4397;

fn reaction(law: &str, factor: f64, energy: f64) -> SampleReaction {
    let law = conversion_law(law).unwrap();
    SampleReaction {
        name: String::new(),
        law,
        law_numbers: law_defaults(law),
        pre_exponential: factor,
        activation_energy: energy,
        reactant: 1.0,
        mass_loss: LOSS,
        enthalpy: 0.0,
    }
}

fn model(law: &str, factor: f64, energy: f64) -> KineticModel {
    KineticModel::new(ReactionSet::new(vec![reaction(law, factor, energy)]))
}

fn respond(model: &KineticModel, run: &HeatingRun) -> SampleResponse {
    let values: Vec<f64> = model.parameters().iter().map(|one| one.value).collect();
    let mut out = SampleResponse::default();
    model.prepare(run).respond(&values, &mut out).unwrap();
    out
}

/// A curve at a heating rate in K/min from 400 to 900 °C, 251 values, with noise of the mass as a share of the loss.
fn curve(truth: &KineticModel, rate: f64, noise: f64, random: &mut SearchRandom) -> TargetCurve {
    let (start, span) = (673.15, 500.0);
    let end = span / rate * 60.0;
    let run = HeatingRun {
        programme: TemperatureProgramme::heating(start, rate / 60.0, end).unwrap(),
        sample_mass: 5e-6,
        times: (0..=250).map(|k| end * f64::from(k) / 250.0).collect(),
    };
    let mass = respond(truth, &run).mass;
    let mass = mass
        .iter()
        .map(|m| m + noise * LOSS * random.normal())
        .collect();
    TargetCurve {
        name: format!("{rate} K/min"),
        run,
        values: vec![(ComparedQuantity::Mass, mass)],
        counted: Vec::new(),
        start_values: None,
    }
}

pub fn curves(rates: &[f64], noise: f64, seed: u64) -> Vec<TargetCurve> {
    let truth = model("R2", FACTOR, ENERGY);
    let mut random = SearchRandom::new(seed);
    rates
        .iter()
        .map(|&rate| curve(&truth, rate, noise, &mut random))
        .collect()
}

fn problem(law: &str, targets: Vec<TargetCurve>) -> SampleProblem {
    let parameter = |name: &str, dimension, low, high, logarithmic| TunedParameter {
        name: name.into(),
        dimension,
        low,
        high,
        logarithmic,
    };
    let mut tuned = vec![
        parameter(
            "pre_exponential",
            Dimension::ANGULAR_VELOCITY,
            1e2,
            1e25,
            true,
        ),
        parameter(
            "activation_energy",
            Dimension::MOLAR_ENERGY,
            50e3,
            500e3,
            false,
        ),
    ];
    for own in conversion_law(law).unwrap().parameters {
        let (low, high) = match own.name {
            "structure" => (0.0, 100.0),
            _ => (0.5, 4.0),
        };
        tuned.push(parameter(own.name, own.dimension, low, high, false));
    }
    let reactions = vec![reaction(law, 1e10, 2e5)];
    let model = KineticModel::new(ReactionSet::new(reactions.clone()));
    let space = ParameterSpace::new(tuned).unwrap();
    let mut made = SampleProblem::new(&model, space, targets, DifferenceForm::Absolute).unwrap();
    made.guess_by(&reactions);
    made
}

fn best(problem: &SampleProblem) -> FittedPlaces {
    let settings = StartSettings {
        samples: 20,
        starts: 4,
        seed: 1,
    };
    fit_globally(
        problem,
        &FitChoice::default(),
        &settings,
        &AtomicBool::new(false),
    )
    .unwrap()
}

fn energy(problem: &SampleProblem, fitted: &FittedPlaces) -> f64 {
    problem.space().values(&fitted.places)[1]
}

/// Rates of loss alone of a law at heating rates in K/min, with noise as a share of the largest one.
fn rates_of_loss(law: &str, factor: f64, rates: &[f64], noise: f64) -> Vec<TargetCurve> {
    let truth = model(law, factor, ENERGY);
    let mut random = SearchRandom::new(1);
    let mut targets = Vec::new();
    for &rate in rates {
        let mut target = curve(&truth, rate, 0.0, &mut random);
        let mut list = respond(&truth, &target.run).loss_rate;
        let largest = list.iter().copied().fold(0.0, f64::max);
        list.iter_mut()
            .for_each(|one| *one += noise * largest * random.normal());
        target.values = vec![(ComparedQuantity::LossRate, list)];
        targets.push(target);
    }
    targets
}

/// A rate is zero on both sides of its peak: far from it no parameter has a slope, and a fit that starts there stays.
#[test]
fn rates_of_loss_alone_give_back_their_law_within_bounds_far_apart() {
    for (law, factor) in [("F1", FACTOR), ("A2", FACTOR), ("R3", 0.4 * FACTOR)] {
        for (rates, within) in [(&[6.0][..], 0.03), (&[5.0, 10.0, 20.0][..], 0.01)] {
            let targets = rates_of_loss(law, factor, rates, 0.03);
            let problem = problem(law, targets);
            let found = best(&problem);
            // The noise of 3 % makes the energy uncertain by 1 % of one curve, and by a third of it of three.
            let energy = energy(&problem, &found);
            assert!(
                (energy / ENERGY - 1.0).abs() < within,
                "{law} {rates:?}: {energy}"
            );
            let left = problem.left_of_no_reaction(&found.places).unwrap();
            assert!(left < 0.05, "{law} {rates:?}: {left}");
        }
    }
}

/// Every law, be it the right one or not, finds the peak of the rates.
#[test]
fn no_law_settles_where_nothing_reacts() {
    let targets = rates_of_loss("R3", 0.4 * FACTOR, &[6.0], 0.03);
    for law in CONVERSION_LAWS {
        let problem = problem(law.name, targets.clone());
        let left = problem.left_of_no_reaction(&best(&problem).places).unwrap();
        assert!(left < 0.5, "{}: {left}", law.name);
    }
    let problem = problem("R3", targets);
    let idle = problem.left_of_no_reaction(&[0.0, 1.0]).unwrap();
    assert!((idle - 1.0).abs() < 1e-9, "{idle}");
}

/// Two reactions side by side, of which the one that the file names last comes first.
#[test]
fn rates_of_two_reactions_give_back_both_energies() {
    let of = |name: &str, factor, energy, loss| SampleReaction {
        name: name.into(),
        mass_loss: loss,
        ..reaction("F1", factor, energy)
    };
    let reactions = vec![
        of("late", FACTOR, ENERGY, 0.3),
        of("early", 1e10, 170e3, 0.1),
    ];
    let truth = KineticModel::new(ReactionSet::new(reactions.clone()));
    let mut random = SearchRandom::new(1);
    let mut targets = Vec::new();
    for rate in [5.0, 10.0, 20.0] {
        let mut target = curve(&truth, rate, 0.0, &mut random);
        let list = respond(&truth, &target.run).loss_rate;
        target.values = vec![(ComparedQuantity::LossRate, list)];
        targets.push(target);
    }
    let mut tuned = Vec::new();
    for name in ["late", "early"] {
        let of = |own: &str, dimension, low, high| TunedParameter {
            name: format!("{name}.{own}"),
            dimension,
            low,
            high,
            logarithmic: own == "pre_exponential",
        };
        let rate = Dimension::ANGULAR_VELOCITY;
        tuned.push(of("pre_exponential", rate, 1e2, 1e25));
        tuned.push(of(
            "activation_energy",
            Dimension::MOLAR_ENERGY,
            50e3,
            500e3,
        ));
    }
    let space = ParameterSpace::new(tuned).unwrap();
    let mut problem = SampleProblem::new(&truth, space, targets, DifferenceForm::Absolute).unwrap();
    problem.guess_by(&reactions);
    let values = problem.space().values(&best(&problem).places);
    assert!((values[1] / ENERGY - 1.0).abs() < 1e-3, "{values:?}");
    assert!((values[3] / 170e3 - 1.0).abs() < 1e-3, "{values:?}");
}

pub const RATES: [f64; 4] = [3.0, 6.0, 9.0, 12.0];

#[test]
fn first_order_without_lag_peaks_where_kissinger_has_it() {
    // Requirements: 0.05 K. Curves of 0.02 K, and the model's own rate.
    let first = model("F1", 1.235e15, 325.1e3);
    for rate in [3.0, 6.0, 9.0, 12.0, 15.0] {
        let end = 200.0 / rate * 60.0;
        let run = HeatingRun {
            programme: TemperatureProgramme::heating(873.15, rate / 60.0, end).unwrap(),
            sample_mass: 1e-6,
            times: (0..=10_000).map(|k| end * f64::from(k) / 1e4).collect(),
        };
        let response = respond(&first, &run);
        let peak = response.loss_rate.iter().enumerate();
        let peak = peak.max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        let expected = kissinger_temperature(1.235e15, 325.1e3, rate / 60.0);
        let off = response.temperature[peak] - expected;
        assert!(off.abs() < 0.05, "{rate} K/min: {off} K");
    }
}

#[test]
fn the_law_behind_noisy_curves_is_chosen_and_its_energy_found() {
    for seed in [11, 12, 13] {
        let targets = curves(&RATES, 0.005, seed);
        let fits = CONVERSION_LAWS.iter().map(|law| {
            let problem = problem(law.name, targets.clone());
            let fitted = best(&problem);
            let (values, count) = (fitted.counts.iter().sum(), problem.space().len());
            let criterion = akaike(fitted.deviance(), values, count + 1);
            ((criterion, count), energy(&problem, &fitted))
        });
        let (fits, energies): (Vec<(f64, usize)>, Vec<f64>) = fits.unzip();
        let chosen = choose(&fits).unwrap();
        assert_eq!(CONVERSION_LAWS[chosen].name, "R2", "seed {seed}");
        let off = energies[chosen] / ENERGY - 1.0;
        assert!(off.abs() < 0.02, "seed {seed}: {off}");
    }
}

#[test]
fn one_heating_rate_by_first_order_is_far_from_the_energy() {
    // Requirements DEC-T15: 292.5 kJ/mol, +24 %, by least squares of the mass over 0.001 < X < 0.999 without noise.
    for rate in RATES {
        let mut targets = curves(&[rate], 0.0, 1);
        targets
            .iter_mut()
            .for_each(|target| target.count_within(0.001, 0.999, LOSS));
        let problem = problem("F1", targets);
        let found = energy(&problem, &best(&problem));
        assert!(found / ENERGY - 1.0 > 0.2, "{rate}: {found}");
    }
}

#[test]
fn energies_without_a_law_are_those_of_the_data() {
    // Kissinger's intercept and slope are those of first order (237.6 kJ/mol of these data by requirements DEC-T15), Ozawa's
    // are Doyle's: both are off by up to 2 % without noise.
    for (noise, within) in [(0.0, 0.02), (0.005, 0.04)] {
        let runs: Vec<SmoothedRun> = curves(&RATES, noise, 5)
            .iter()
            .map(|target| SmoothedRun::of(target, LOSS).unwrap())
            .collect();
        let found = kissinger(&runs).unwrap();
        assert!((found.energy / ENERGY - 1.0).abs() < within, "{found:?}");
        for list in [friedman(&runs).unwrap(), ozawa_flynn_wall(&runs).unwrap()] {
            let inner = list
                .iter()
                .filter(|one| (0.2..0.81).contains(&one.conversion));
            let inner: Vec<f64> = inner.map(|one| one.energy).collect();
            let mean = inner.iter().sum::<f64>() / inner.len() as f64;
            assert!((mean / ENERGY - 1.0).abs() < within, "{noise}: {list:?}");
            let worst = inner.iter().map(|energy| (energy / ENERGY - 1.0).abs());
            assert!(
                worst.fold(0.0, f64::max) < 2.0 * within + noise * 10.0,
                "{list:?}"
            );
        }
    }
}

/// Contracting areas, heated at 10 K/min to a temperature in K and held there, up to 90 min in all: 250 values or more.
fn hold(truth: &KineticModel, temperature: f64) -> TargetCurve {
    let reached = (temperature - 500.0) * 6.0;
    let programme = TemperatureProgramme::new(
        vec![0.0, reached, 5400.0],
        vec![500.0, temperature, temperature],
    );
    let run = HeatingRun {
        programme: programme.unwrap(),
        sample_mass: 8e-6,
        times: (0..360).map(|k| 15.0 * f64::from(k)).collect(),
    };
    TargetCurve {
        name: format!("{temperature} K"),
        values: vec![(ComparedQuantity::Mass, respond(truth, &run).mass)],
        run,
        counted: Vec::new(),
        start_values: None,
    }
}

/// At 780 K the sample comes to a conversion of 0.6, at 820 K to completion: curves that each ended at one had given
/// 75 kJ/mol. A loss that is too small by a common factor renames conversions and moves no energy.
#[test]
fn energies_of_holds_that_end_before_completion_are_those_of_the_data() {
    let truth = model("R2", 1e8, 180e3);
    for temperatures in [[780.0, 800.0, 820.0], [760.0, 770.0, 780.0]] {
        let curves = temperatures.map(|one| hold(&truth, one));
        let whole = WholeLoss::of(&curves).unwrap();
        assert!(whole.unlike && whole.loss < 1.001 * LOSS, "{whole:?}");
        for loss in [LOSS, whole.loss] {
            let runs = curves.iter().map(|one| SmoothedRun::of(one, loss).unwrap());
            let runs: Vec<SmoothedRun> = runs.collect();
            let list = friedman(&runs).unwrap();
            let inner = list.iter().filter(|one| one.conversion > 0.195);
            let inner: Vec<f64> = inner.map(|one| one.energy).collect();
            assert!(inner.len() > 2, "{temperatures:?}: {list:?}");
            for energy in inner {
                assert!(
                    (energy / 180e3 - 1.0).abs() < 0.03,
                    "{temperatures:?}, {loss}: {list:?}"
                );
            }
            // They have no heating rate.
            assert!(kissinger(&runs).is_err() && ozawa_flynn_wall(&runs).is_err());
        }
    }
}

/// Holds whose masses are relative to the mean of the first seven, with noise of 0.05 % of the mass. The scale of each curve is
/// fitted; where it is taken as exact, intervals do not hold its error. With `conversion` the first values do not count
/// themselves, their mean does.
#[test]
fn intervals_hold_the_truth_where_the_mass_at_the_start_is_not_stated() {
    let truth = model("R2", 1e8, 180e3);
    let (mut fitted_scale, mut drawn, mut within, mut exact_scale) = (0, 0, 0, 0);
    for seed in 0..20 {
        let mut random = SearchRandom::new(300 + seed);
        let curves = [780.0, 800.0, 820.0].map(|temperature| {
            let mut curve = hold(&truth, temperature);
            let mass = &mut curve.values[0].1;
            mass.iter_mut().for_each(|m| *m += 5e-4 * random.normal());
            let start = mass[..7].iter().sum::<f64>() / 7.0;
            mass.iter_mut().for_each(|m| *m /= start);
            curve.start_values = Some(7);
            curve
        });
        let found = |curves: Vec<TargetCurve>| {
            let parameter = |name: &str, dimension, low, high, logarithmic| TunedParameter {
                name: name.into(),
                dimension,
                low,
                high,
                logarithmic,
            };
            let tuned = vec![
                parameter(
                    "pre_exponential",
                    Dimension::ANGULAR_VELOCITY,
                    1e2,
                    1e20,
                    true,
                ),
                parameter(
                    "activation_energy",
                    Dimension::MOLAR_ENERGY,
                    50e3,
                    400e3,
                    false,
                ),
                parameter("mass_loss", Dimension::NONE, 0.05, 1.0, false),
            ];
            let space = ParameterSpace::new(tuned).unwrap();
            let problem = SampleProblem::new(&truth, space, curves, DifferenceForm::Absolute);
            let problem = problem.unwrap();
            let space = problem.space();
            let start = [
                space.place(0, 1e8),
                space.place(1, 180e3),
                space.place(2, LOSS),
            ];
            let fitted = fit(&problem, &start, &FitChoice::default()).unwrap();
            (problem, fitted)
        };
        let choice = FitChoice::default();
        let holds = |problem: &SampleProblem, fitted: &FittedPlaces| {
            let truth = problem.space().place(1, 180e3);
            let found = profile(problem, fitted, &choice, 1, 0.95).unwrap();
            i32::from(found.low.place < truth && truth < found.high.place)
        };
        let (problem, fitted) = found(curves.to_vec());
        fitted_scale += holds(&problem, &fitted);
        let settings = BootstrapSettings {
            replicates: 100,
            block: 1,
            seed,
        };
        let sets = bootstrap(&problem, &fitted.places, &choice, &settings).unwrap();
        let mut places: Vec<f64> = sets.iter().map(|places| places[1]).collect();
        places.sort_by(f64::total_cmp);
        let truth = problem.space().place(1, 180e3);
        drawn += i32::from(places[2] < truth && truth < places[97]);
        let cut = curves.clone().map(|mut curve| {
            curve.count_within(0.02, 0.98, LOSS);
            curve
        });
        let (problem, fitted) = found(cut.to_vec());
        within += holds(&problem, &fitted);
        let exact = curves.map(|mut curve| {
            curve.start_values = None;
            curve
        });
        let (problem, fitted) = found(exact.to_vec());
        exact_scale += holds(&problem, &fitted);
    }
    let told = [fitted_scale, drawn, within, exact_scale];
    assert!(told[..3].iter().all(|count| *count >= 17), "{told:?}");
    assert!(exact_scale < 15, "{told:?}");
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let (mut by_profile, mut by_bootstrap) = (0, 0);
    for set in 0..100 {
        let problem = problem("R2", curves(&RATES, 0.005, 1000 + set));
        let fitted = best(&problem);
        let truth = problem.space().place(1, ENERGY);
        let choice = FitChoice::default();
        let found = profile(&problem, &fitted, &choice, 1, 0.95).unwrap();
        assert!(!found.low.at_bound && !found.high.at_bound);
        by_profile += i32::from(found.low.place < truth && truth < found.high.place);
        let settings = BootstrapSettings {
            replicates: 100,
            block: 1,
            seed: set,
        };
        let sets = bootstrap(&problem, &fitted.places, &choice, &settings).unwrap();
        let mut places: Vec<f64> = sets.iter().map(|places| places[1]).collect();
        places.sort_by(f64::total_cmp);
        assert_eq!(places.len(), 100);
        by_bootstrap += i32::from(places[2] < truth && truth < places[97]);
    }
    assert!((90..=99).contains(&by_profile), "{by_profile}");
    assert!((90..=99).contains(&by_bootstrap), "{by_bootstrap}");
}
