//! Shrinking cores against their closed forms, adiabatic calorimeters, elements.

use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::{Element, Mixture};

use super::*;
use crate::{
    At, GasLines, NetworkHeat, Newcomer, ParticleModel, Surroundings, TEMPERATURE, Transfer,
};

/// Films of the temperature of the gas, without a net flow.
const PLAIN: FilmTheory = FilmTheory {
    temperature: FilmTemperature::Gas,
    stefan_flow: StefanFlow::None,
};
const RADIUS: f64 = 6e-3;
const PRESSURE: f64 = 101_325.0;
const HOT: f64 = 1100.0;

fn constant(factor: f64) -> Arrhenius {
    Arrhenius {
        factor,
        exponent: 0.0,
        activation_energy: 0.0,
    }
}

fn solid(name: &str) -> SolidSpecies {
    SolidSpecies::built_in(name).unwrap()
}

/// FeO + CO => Fe + CO2 as a shrinking core with these constants (m/s and m²/s).
fn reduction(rate_constant: f64, diffusivity: f64) -> SolidChemistry {
    let reaction = Reaction {
        name: "reduction".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, -1.0), (1, 1.0)],
        rate: Rate::Core {
            rate_constant: constant(rate_constant),
            diffusivity: LayerDiffusivity {
                value: diffusivity,
                at: 300.0,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::OneWay,
    };
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    SolidChemistry::new(vec![solid("FeO"), solid("Fe")], Some(gas), vec![reaction]).unwrap()
}

/// FeO + CO <=> Fe + CO2, written with so many moles of each, with ln K of one mole.
fn reversible(moles: f64, ln_k: f64) -> SolidChemistry {
    let mut reaction = reduction(0.05, 1e-5).reactions[0].clone();
    for (_, n) in reaction.solids.iter_mut().chain(&mut reaction.gases) {
        *n *= moles;
    }
    reaction.equilibrium = Equilibrium::Line {
        constant: moles * ln_k,
        over_temperature: 0.0,
    };
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    SolidChemistry::new(vec![solid("FeO"), solid("Fe")], Some(gas), vec![reaction]).unwrap()
}

/// One particle of 1 g of the first solid.
fn particle(chemistry: SolidChemistry) -> Reacting {
    let mut fractions = vec![0.0; chemistry.solids.len()];
    fractions[0] = 1.0;
    particle_of(Reacting::new(chemistry, &fractions))
}

fn particle_of(mut reacting: Reacting) -> Reacting {
    let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[HOT])];
    let new = Newcomer {
        id: 1,
        mass: 1e-3,
        radius: RADIUS,
        state: &state,
    };
    reacting.change(&[], &[new]).unwrap();
    reacting
}

/// Follows particles in gas of a composition for so many windows; the extents so far after each.
fn follow(
    reacting: &mut Reacting,
    composition: &[f64],
    (film, conductance): (f64, f64),
    span: f64,
    windows: usize,
) -> Vec<f64> {
    let species = composition.len();
    let mut sum = 0.0;
    (0..windows)
        .map(|_| {
            let film = vec![FilmCoefficient::constant(film); species];
            let measured = reacting.bodies(At::Commit).radius.first().copied();
            let radius = [measured.unwrap_or(RADIUS)];
            let around = Surroundings {
                temperature: &[HOT],
                pressure: &[PRESSURE],
                composition,
                conductance: &[conductance],
                film: &film,
                theory: PLAIN,
                radius: &radius,
                end: 0.0,
            };
            let mut lines = GasLines::default();
            lines.reset(1, reacting.channels().len());
            reacting
                .respond(&around, span, &[NetworkHeat::default()], &mut lines)
                .unwrap();
            let keys = reacting.channels().iter().map(|one| one.key.unwrap());
            let channels = lines.slope.iter().zip(&lines.offset).zip(keys);
            let mut rates: Vec<f64> = channels.map(|((s, o), k)| s * composition[k] - o).collect();
            reacting.limit(&mut rates, span);
            let took = Transfer {
                heat: &[lines.conductance[0] * (HOT - lines.temperature[0])],
                network: &[0.0],
                carried: &[carried(reacting, &rates)],
                rates: &rates,
            };
            reacting.settle(&took, span).unwrap();
            sum += reacting.extents.iter().sum::<f64>();
            reacting.commit();
            sum
        })
        .collect()
}

/// Sensible heat in W that gases bring in: what is taken at the gas' temperature, what leaves at the particle's.
fn carried(reacting: &Reacting, rates: &[f64]) -> f64 {
    let Some(gas) = &reacting.chemistry().gas else {
        return 0.0;
    };
    let channels = reacting.channels().iter().zip(rates);
    channels
        .flat_map(|(channel, rate)| {
            channel
                .mass
                .iter()
                .enumerate()
                .map(move |(k, m)| (k, m * rate))
        })
        .map(|(k, made)| {
            let at = if made < 0.0 { HOT } else { reacting.end[0] };
            -made * gas.species_enthalpy(k, at)
        })
        .sum()
}

/// Largest difference of the time at which a conversion is reached from a closed form t(X), as a share of
/// the time τ; kept hot by the gas.
fn worst(
    rate_constant: f64,
    diffusivity: f64,
    film: f64,
    closed: impl Fn(f64) -> f64,
    tau: f64,
) -> f64 {
    worst_of(
        particle(reduction(rate_constant, diffusivity)),
        film,
        closed,
        tau,
    )
}

fn worst_of(mut reacting: Reacting, film: f64, closed: impl Fn(f64) -> f64, tau: f64) -> f64 {
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.3, 0.0, 0.7]);
    let amount = 1e-3 / solid("FeO").molar_mass();
    // Within a window the Sherwood number stays, from window to window the coefficient.
    let windows: u32 = 400;
    let span = closed(1.0) * tau * (40.0 / 41.0) / f64::from(windows);
    let sums = follow(
        &mut reacting,
        &composition,
        (film, 1e6),
        span,
        windows as usize,
    );
    let errors = sums.iter().enumerate().map(|(k, sum)| {
        let time = (k + 1) as f64 * span;
        (closed(sum / amount) - time / tau).abs()
    });
    let errors: Vec<f64> = errors.collect();
    assert!(errors.iter().all(|error| error.is_finite()));
    errors.into_iter().fold(0.0, f64::max)
}

fn concentration() -> f64 {
    0.3 * PRESSURE / (GAS_CONSTANT * HOT)
}

/// Moles of the core's solid by volume of the particle.
fn density() -> f64 {
    1e-3 / solid("FeO").molar_mass() / (4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3))
}

#[test]
fn the_three_limiting_regimes_of_the_shrinking_core_are_met_within_half_a_percent() {
    // Levenspiel, Chemical Reaction Engineering (1999), chapter 25: t/τ = X with τ = ρ R/(3 β c),
    // 1 − 3 (1−X)^⅔ + 2 (1−X) with ρ R²/(6 D c), 1 − (1−X)^⅓ with ρ R/(k c).
    let (rho, c) = (density(), concentration());
    let film = worst(1e3, 1e3, 1e-3, |x| x, rho * RADIUS / (3.0 * 1e-3 * c));
    assert!(film < 1e-4, "film: {film}");
    let layer = |x: f64| 1.0 - 3.0 * (1.0 - x).powf(2.0 / 3.0) + 2.0 * (1.0 - x);
    let layer = worst(
        1e3,
        1e-6,
        1e3,
        layer,
        rho * RADIUS * RADIUS / (6.0 * 1e-6 * c),
    );
    assert!(layer < 2e-4, "layer: {layer}");
    let kinetics = worst(
        1e-4,
        1e3,
        1e3,
        |x| 1.0 - (1.0 - x).cbrt(),
        rho * RADIUS / (1e-4 * c),
    );
    // Where 1.5e-5 of the core is left, an error of 1e-6 in X is one of 6e-4 in t.
    assert!(kinetics < 1e-3, "kinetics: {kinetics}");
}

/// The same particle, whose iron takes `swelling` times the room of the oxide that it was made of.
fn swelling(rate_constant: f64, diffusivity: f64, swelling: f64) -> Reacting {
    let chemistry = reduction(rate_constant, diffusivity);
    let own = 1e-3 / (4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3));
    let molar = solid("Fe").molar_mass() / solid("FeO").molar_mass();
    let densities = [2.0 * own, 2.0 * own * molar / swelling];
    let start = (own, [1.0, 0.0].as_slice());
    let size = SizeChange::of_densities(&densities, start, &chemistry.solids, 1e-6);
    particle_of(Reacting::new(chemistry, &[1.0, 0.0]).with_size(size))
}

#[test]
fn a_shrinking_core_in_a_layer_that_swells_or_shrinks_meets_its_closed_forms() {
    // G. Valensi, Bull. Soc. Chim. France 5 (1936) 668 (layer); the others follow from dX/dt = 3 β c R²/(ρ R₀³)
    // with R³ = R₀³ (1 + (z − 1) X), and from the area of the core, which the layer does not change.
    let (rho, c) = (density(), concentration());
    for z in [0.5, 2.0] {
        let wide = move |x: f64| 1.0 + (z - 1.0) * x;
        let film = swelling(1e3, 1e3, z);
        let film = worst_of(
            film,
            1e-3,
            |x| 3.0 * (wide(x).cbrt() - 1.0) / (z - 1.0),
            rho * RADIUS / (3.0 * 1e-3 * c),
        );
        assert!(film < 5e-4, "film, {z}: {film}");
        let valensi = |x: f64| {
            let outside = (z - wide(x).powf(2.0 / 3.0)) / (z - 1.0);
            3.0 * (outside - (1.0 - x).powf(2.0 / 3.0))
        };
        let layer = swelling(1e3, 1e-6, z);
        let layer = worst_of(
            layer,
            1e3,
            valensi,
            rho * RADIUS * RADIUS / (6.0 * 1e-6 * c),
        );
        assert!(layer < 5e-4, "layer, {z}: {layer}");
        let kinetics = swelling(1e-4, 1e3, z);
        let kinetics = worst_of(
            kinetics,
            1e3,
            |x| 1.0 - (1.0 - x).cbrt(),
            rho * RADIUS / (1e-4 * c),
        );
        assert!(kinetics < 1e-3, "kinetics, {z}: {kinetics}");
    }
}

#[test]
fn the_three_resistances_in_series_add_their_times() {
    let (rho, c) = (density(), concentration());
    let taus = [
        rho * RADIUS / (3.0 * 0.02 * c),
        rho * RADIUS * RADIUS / (6.0 * 2e-5 * c),
        rho * RADIUS / (0.01 * c),
    ];
    let tau: f64 = taus.iter().sum();
    let closed = |x: f64| {
        let layer = 1.0 - 3.0 * (1.0 - x).powf(2.0 / 3.0) + 2.0 * (1.0 - x);
        (taus[0] * x + taus[1] * layer + taus[2] * (1.0 - (1.0 - x).cbrt())) / tau
    };
    let error = worst(0.01, 2e-5, 0.02, closed, tau);
    assert!(error < 1e-3, "{error}");
}

#[test]
fn an_equation_written_with_other_numbers_of_moles_is_the_same_reaction() {
    // K = 4 of one mole, 3 of 0.788: gas with a ratio of 3.5 would be taken for one in which iron is oxidised.
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    for carbon_dioxide in [0.0, 0.35] {
        let composition = gas.mass_fractions(&[0.1, carbon_dioxide, 0.9 - carbon_dioxide]);
        let turned = [1.0, 0.788, 2.5].map(|moles| {
            let mut one = particle(reversible(moles, 4.0_f64.ln()));
            moles * follow(&mut one, &composition, (0.1, 1e6), 20.0, 3)[2]
        });
        assert!(turned[0] > 1e-6, "{turned:?}");
        for other in &turned[1..] {
            // What the integration is exact to.
            assert!((other / turned[0] - 1.0).abs() < 1e-3, "{turned:?}");
        }
    }
}

#[test]
fn nothing_reacts_beyond_what_is_there_and_elements_stay() {
    let mut reacting = particle(reduction(1.0, 1e-3));
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.3, 0.0, 0.7]);
    let sums = follow(&mut reacting, &composition, (1.0, 1.0), 1e5, 3);
    let amount = 1e-3 / solid("FeO").molar_mass();
    assert!((sums[2] / amount - 1.0).abs() < 1e-9);
    assert!(reacting.amounts()[0].abs() < 1e-9 * amount);
    assert!((reacting.amounts()[1] / amount - 1.0).abs() < 1e-9);
}

#[test]
fn an_inner_reaction_heats_a_closed_particle_by_its_enthalpies() {
    // 3 Fe + ... : 4 FeO => Fe3O4 + Fe of first order, adiabatic: sensible enthalpy of the products at the
    // end is that of the start and the heat at 298.15 K.
    let reaction = Reaction {
        name: "disproportionation".into(),
        solids: vec![(0, -4.0), (1, 1.0), (2, 1.0)],
        gases: Vec::new(),
        rate: Rate::Power(PowerLaw {
            rate_constant: constant(0.1),
            in_series: None,
            solids: vec![(0, 1.0)],
            gases: Vec::new(),
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let solids = vec![solid("FeO"), solid("Fe3O4"), solid("Fe")];
    let chemistry = SolidChemistry::new(solids.clone(), None, vec![reaction]).unwrap();
    assert!(
        chemistry
            .imbalance(&chemistry.reactions[0])
            .iter()
            .all(|n| n.abs() < 1e-12)
    );
    let mut reacting = particle(chemistry);
    let amount = 1e-3 / solids[0].molar_mass();
    let begin = amount * solids[0].molar_mass() * solids[0].enthalpy(HOT);
    for _ in 0..10 {
        follow(&mut reacting, &[], (0.0, 0.0), 2.0, 1);
    }
    let now = reacting.amounts().to_vec();
    let turned = amount - now[0];
    assert!(turned / amount > 0.9);
    let heat = 4.0 * -272_035.0 + 1_119_926.0;
    let gained = heat * turned / 4.0;
    let expected = |t: f64| {
        let parts = solids.iter().zip(&now);
        parts
            .map(|(s, n)| n * s.molar_mass() * s.enthalpy(t))
            .sum::<f64>()
            - begin
            - gained
    };
    let (mut low, mut high) = (HOT - 500.0, HOT + 500.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if expected(middle) > 0.0 {
            high = middle
        } else {
            low = middle
        }
    }
    let rise = reacting.bodies(At::Commit).temperature[0] - HOT;
    assert!(rise > 10.0, "{rise}");
    assert!(
        (rise / (low - HOT) - 1.0).abs() < 1e-6,
        "{rise} {}",
        low - HOT
    );
    let mass: f64 = solids
        .iter()
        .zip(&now)
        .map(|(s, n)| s.molar_mass() * n)
        .sum();
    assert!((mass / 1e-3 - 1.0).abs() < 1e-12);
    for element in [Element::Fe, Element::O] {
        let atoms = |n: &[f64]| -> f64 {
            solids
                .iter()
                .zip(n)
                .map(|(s, n)| s.atoms()[element as usize] * n)
                .sum()
        };
        assert!((atoms(&now) / atoms(&[amount, 0.0, 0.0]) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_first_order_reaction_decays_as_its_exponential() {
    let reaction = Reaction {
        name: "decay".into(),
        solids: vec![(0, -4.0), (1, 1.0), (2, 1.0)],
        gases: Vec::new(),
        rate: Rate::Power(PowerLaw {
            rate_constant: constant(0.01),
            in_series: None,
            solids: vec![(0, 1.0)],
            gases: Vec::new(),
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let solids = vec![solid("FeO"), solid("Fe3O4"), solid("Fe")];
    let chemistry = SolidChemistry::new(solids, None, vec![reaction]).unwrap();
    let mut reacting = particle(chemistry);
    let amount = 1e-3 / solid("FeO").molar_mass();
    let sums = follow(&mut reacting, &[], (0.0, 0.0), 5.0, 10);
    for (k, sum) in sums.iter().enumerate() {
        // dn/dt = −4 k n
        let left = (-0.04 * 5.0 * (k + 1) as f64).exp();
        assert!((1.0 - 4.0 * sum / amount - left).abs() < 1e-4, "{k}");
    }
}

#[test]
fn limestone_in_hot_gas_keeps_to_the_temperature_of_its_equilibrium() {
    // Heat-controlled: fast kinetics, slow heat; the particle stays where p_CO2 is that of the gas.
    let reaction = Reaction {
        name: "calcination".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, 1.0)],
        rate: Rate::Core {
            rate_constant: constant(10.0),
            diffusivity: LayerDiffusivity {
                value: 1.0,
                at: 300.0,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::Line {
            constant: 18.0,
            over_temperature: -19_800.0,
        },
    };
    let gas = Mixture::new(["CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.2, 0.8]);
    let chemistry = SolidChemistry::new(
        vec![solid("CaCO3"), solid("CaO")],
        Some(gas),
        vec![reaction],
    )
    .unwrap();
    let mut reacting = particle(chemistry);
    // ln K = ln(0.2 · 1.01325): T = 19800/(18 + 1.5962) = 1010.4 K
    let rest = 19_800.0 / (18.0 - (0.2 * 1.01325f64).ln());
    let sums = follow(&mut reacting, &composition, (10.0, 0.01), 50.0, 10);
    let turned = sums[9] * 100.09e-3 / 1e-3;
    assert!(turned > 0.1 && turned < 0.9, "{turned}");
    assert!(
        (reacting.bodies(At::Commit).temperature[0] - rest).abs() < 3.0,
        "{} {rest}",
        reacting.bodies(At::Commit).temperature[0]
    );
}

#[test]
fn three_oxides_are_reduced_in_their_order() {
    let core = |name: &str, from: (usize, f64), to: (usize, f64), gas: f64| Reaction {
        name: name.into(),
        solids: vec![(from.0, -from.1), to],
        gases: vec![(0, -gas), (1, gas)],
        rate: Rate::Core {
            rate_constant: constant(0.05),
            diffusivity: LayerDiffusivity {
                value: 1e-4,
                at: 300.0,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::OneWay,
    };
    let reactions = vec![
        core("wustite", (2, 1.0), (3, 0.947), 1.0),
        core("hematite", (0, 3.0), (1, 2.0), 1.0),
        core("magnetite", (1, 0.947), (2, 3.0), 0.788),
    ];
    let solids = vec![
        solid("Fe2O3"),
        solid("Fe3O4"),
        solid("Fe0.947O"),
        solid("Fe"),
    ];
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.4, 0.0, 0.6]);
    let chemistry = SolidChemistry::new(solids.clone(), Some(gas), reactions).unwrap();
    for reaction in &chemistry.reactions {
        assert!(chemistry.imbalance(reaction).iter().all(|n| n.abs() < 1e-9));
    }
    let mut reacting = particle(chemistry);
    let iron = |n: &[f64]| -> f64 {
        let parts = solids.iter().zip(n);
        parts
            .map(|(s, n)| s.atoms()[Element::Fe as usize] * n)
            .sum()
    };
    let begin = iron(reacting.amounts());
    let mut peaks = [0.0f64; 4];
    let mut when = [0; 4];
    for window in 0..400 {
        follow(&mut reacting, &composition, (0.05, 1.0), 5.0, 1);
        let now = reacting.amounts();
        assert!((iron(now) / begin - 1.0).abs() < 1e-12);
        for (k, &amount) in now.iter().enumerate() {
            assert!(amount > -1e-12 * begin);
            if amount > peaks[k] {
                (peaks[k], when[k]) = (amount, window);
            }
        }
    }
    assert!(when[1] < when[2] && when[2] < when[3], "{when:?}");
    assert!(
        (reacting.amounts()[3] / begin - 1.0).abs() < 1e-6,
        "all iron in the end"
    );
}

#[test]
fn a_reaction_of_order_zero_takes_from_a_cell_in_proportion_to_what_it_holds() {
    // The rate does not follow the gas; the share of a cell does, or an empty one would give what it has not.
    let reaction = Reaction {
        name: "order zero".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, -1.0), (1, 1.0)],
        rate: Rate::Power(PowerLaw {
            rate_constant: constant(1e-3),
            in_series: None,
            solids: Vec::new(),
            gases: vec![(0, 0.0)],
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let gas = Mixture::new(["CO", "CO2"]).unwrap();
    let solids = vec![solid("FeO"), solid("Fe")];
    let chemistry = SolidChemistry::new(solids, Some(gas), vec![reaction]).unwrap();
    let mut reacting = particle(chemistry);
    let composition = [0.4, 0.6];
    let around = Surroundings {
        temperature: &[HOT],
        pressure: &[PRESSURE],
        composition: &composition,
        conductance: &[0.0],
        film: &[FilmCoefficient::constant(1e3); 2],
        theory: PLAIN,
        radius: &[RADIUS],
        end: 0.0,
    };
    let mut lines = GasLines::default();
    lines.reset(1, 1);
    reacting
        .respond(&around, 1.0, &[NetworkHeat::default()], &mut lines)
        .unwrap();
    let rate = lines.slope[0] * composition[0] - lines.offset[0];
    assert!(rate > 0.0);
    assert!((lines.local_slope[0] * composition[0] / rate - 1.0).abs() < 1e-6);
    assert!(lines.slope[0].abs() < 1e-3 * lines.local_slope[0]);
}

#[test]
fn heat_that_would_take_a_particle_2_percent_from_its_integration_is_owed_to_it() {
    let gas = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.3, 0.0, 0.7]);
    let around = Surroundings {
        temperature: &[HOT],
        pressure: &[PRESSURE],
        composition: &composition,
        conductance: &[0.01],
        film: &[FilmCoefficient::constant(0.05); 3],
        theory: PLAIN,
        radius: &[RADIUS],
        end: 0.0,
    };
    for (share, is_owed) in [(0.0199, false), (0.0201, true), (-0.0201, true)] {
        let mut reacting = particle(reduction(0.01, 1e-4));
        // A window whose heat is off, and one in which it is not.
        for off in [share, 0.0] {
            let mut lines = GasLines::default();
            lines.reset(1, 1);
            reacting
                .respond(&around, 1.0, &[NetworkHeat::default()], &mut lines)
                .unwrap();
            let rates = [lines.slope[0] * composition[0] - lines.offset[0]];
            let followed = reacting.end[0];
            let mut left = reacting.amounts().to_vec();
            left[0] -= rates[0];
            left[1] += rates[0];
            let chemistry = reacting.chemistry();
            let beyond = chemistry.enthalpy(&left, followed * (1.0 + off))
                - chemistry.enthalpy(&left, followed);
            let heat = lines.conductance[0] * (HOT - lines.temperature[0]) + beyond;
            let took = Transfer {
                heat: &[heat],
                network: &[0.0],
                carried: &[carried(&reacting, &rates)],
                rates: &rates,
            };
            let given = reacting.committed.owed[0];
            reacting.settle(&took, 1.0).unwrap();
            let change = reacting.now.temperature[0] / followed - 1.0;
            if is_owed && off != 0.0 {
                assert_eq!(change, 0.0);
                assert!((reacting.now.owed[0] / beyond - 1.0).abs() < 1e-9);
            } else {
                assert!((change - off).abs() < 1e-9, "{change}");
                assert_eq!(reacting.now.owed[0], 0.0);
            }
            assert!(off != 0.0 || is_owed == (given != 0.0));
            reacting.commit();
        }
    }
}
