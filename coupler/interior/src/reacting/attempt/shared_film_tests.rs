//! Reactions of one particle that meet the same gases at its surface: one film brings them all.

use calcine_numerics::IntegrationStatistics;
use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

use super::*;
use crate::reacting::passage::ParticleSurroundings;
use crate::reacting::{LayerDiffusivity, Rate, Reaction, SizeChange};

const GASES: [&str; 4] = ["O2", "CO2", "CO", "N2"];
const MOLAR: [f64; 4] = [31.998, 44.009, 28.01, 28.014];
const SOLIDS: [&str; 4] = ["C", "FeO", "Fe", "CaCO3"];
const O2: usize = 0;
const CO2: usize = 1;
const CO: usize = 2;
const PRESSURE: f64 = 1.5e5;
const RADIUS: f64 = 1e-3;
/// mol of each solid.
const AMOUNT: f64 = 4e-4;
/// In m/s, of each gas.
const FILMS: [f64; 4] = [0.30, 0.26, 0.33, 0.31];
const AIR: [f64; 4] = [0.21, 0.0, 0.0, 0.79];
const PARTICLE: f64 = 1400.0;
const HOT: f64 = 1100.0;

/// Films of the temperature of the gas, without a net flow.
const PLAIN: FilmTheory = FilmTheory {
    temperature: FilmTemperature::Gas,
    stefan_flow: StefanFlow::None,
};
const THEORIES: [FilmTheory; 3] = [
    PLAIN,
    FilmTheory {
        temperature: FilmTemperature::TwoThirds,
        stefan_flow: StefanFlow::Molar,
    },
    FilmTheory {
        temperature: FilmTemperature::TwoThirds,
        stefan_flow: StefanFlow::Mass,
    },
];

fn constant(factor: f64) -> Arrhenius {
    Arrhenius {
        factor,
        exponent: 0.0,
        activation_energy: 0.0,
    }
}

/// A power law of carbon's reactions with gases, of orders in gases alone.
fn law(gases: &[(usize, f64)], carbon: f64, factor: f64, orders: &[(usize, f64)]) -> Reaction {
    Reaction {
        name: format!("{gases:?}"),
        solids: vec![(0, -carbon)],
        gases: gases.to_vec(),
        rate: Rate::Power(PowerLaw {
            rate_constant: constant(factor),
            in_series: None,
            solids: Vec::new(),
            gases: orders.to_vec(),
        }),
        equilibrium: Equilibrium::OneWay,
    }
}

fn to_dioxide(factor: f64, order: f64) -> Reaction {
    law(&[(O2, -1.0), (CO2, 1.0)], 1.0, factor, &[(O2, order)])
}

fn to_monoxide(factor: f64, order: f64) -> Reaction {
    law(&[(O2, -1.0), (CO, 2.0)], 2.0, factor, &[(O2, order)])
}

fn boudouard(factor: f64, order: f64) -> Reaction {
    law(&[(CO2, -1.0), (CO, 2.0)], 1.0, factor, &[(CO2, order)])
}

fn reversible(reaction: Reaction, equilibrium_constant: f64) -> Reaction {
    Reaction {
        equilibrium: Equilibrium::Line {
            constant: equilibrium_constant.ln(),
            over_temperature: 0.0,
        },
        ..reaction
    }
}

/// FeO + CO => Fe + CO2 as a shrinking core.
fn reduction(rate_constant: f64) -> Reaction {
    Reaction {
        name: "reduction".into(),
        solids: vec![(1, -1.0), (2, 1.0)],
        gases: vec![(CO, -1.0), (CO2, 1.0)],
        rate: Rate::Core {
            rate_constant: constant(rate_constant),
            diffusivity: LayerDiffusivity {
                value: 2e-4,
                at: PARTICLE,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::Line {
            constant: 0.6f64.ln(),
            over_temperature: 0.0,
        },
    }
}

/// Beside what reacts a solid of so much heat capacity that the temperature stays.
fn chemistry(reactions: Vec<Reaction>) -> SolidChemistry {
    let solids = SOLIDS.map(|name| SolidSpecies::built_in(name).unwrap());
    let ballast = SolidSpecies::inert("ballast", HeatCapacity::constant(1e12));
    let solids = solids.into_iter().chain([ballast]).collect();
    SolidChemistry::new(solids, Some(Mixture::new(GASES).unwrap()), reactions).unwrap()
}

struct Followed {
    extents: Vec<f64>,
    slopes: Vec<f64>,
    statistics: IntegrationStatistics,
}

fn follow(
    reactions: &[Reaction],
    fractions: &[f64; 4],
    theory: FilmTheory,
    span: f64,
    accuracy: ParticleAccuracy,
) -> Followed {
    let chemistry = chemistry(reactions.to_vec());
    let films = FILMS.map(FilmCoefficient::constant);
    let start = ParticleStart {
        amounts: &[AMOUNT; 5],
        first: &[AMOUNT; 5],
        temperature: PARTICLE,
        around: ParticleSurroundings {
            temperature: HOT,
            pressure: PRESSURE,
            fractions,
            film: &films,
            theory,
            radius: RADIUS,
            size: &SizeChange::Constant,
        },
        conductance: 1e-3,
        heat: 0.0,
    };
    let mut workspace = ParticleWorkspace::default();
    let outcome = chemistry
        .follow(&start, span, accuracy, &mut workspace)
        .unwrap();
    Followed {
        extents: workspace.extents,
        slopes: workspace.slopes,
        statistics: outcome.statistics,
    }
}

/// Rates in mol/s at the start.
fn rates(reactions: &[Reaction], fractions: &[f64; 4], theory: FilmTheory) -> Vec<f64> {
    let span = 1e-12;
    let accuracy = ParticleAccuracy::default();
    let done = follow(reactions, fractions, theory, span, accuracy);
    done.extents.iter().map(|extent| extent / span).collect()
}

fn volume() -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3)
}

/// Concentrations in the gas beyond the film, at the temperature of the particle, in mol/m³.
fn bulk(fractions: &[f64; 4]) -> [f64; 4] {
    fractions.map(|x| x * PRESSURE / (GAS_CONSTANT * PARTICLE))
}

/// What a film of the temperature of the gas brings of a gas, in m³/s.
fn brings(gas: usize) -> f64 {
    sphere::surface(RADIUS) * FILMS[gas] * PARTICLE / HOT
}

/// The factor of a first-order law of oxygen with which it uses `damkoehler` times what the film brings.
fn factor(damkoehler: f64) -> f64 {
    damkoehler * brings(O2) / volume()
}

/// Mole fractions at the surface by the film's equations from what reacts in mol/s, and the concentrations of that.
fn surface(
    reactions: &[Reaction],
    rates: &[f64],
    fractions: &[f64; 4],
    theory: FilmTheory,
) -> [f64; 4] {
    let net: Vec<f64> = (0..4)
        .map(|g| {
            let pairs = reactions.iter().zip(rates);
            let parts = pairs.map(|(one, rate)| {
                let moles = one.gases.iter().filter(|gas| gas.0 == g);
                rate * moles.map(|gas| gas.1).sum::<f64>()
            });
            parts.sum()
        })
        .collect();
    let film = theory.temperature.of(PARTICLE, HOT);
    let flux = sphere::surface(RADIUS) * PRESSURE / (GAS_CONSTANT * film);
    let of_moles: f64 = net.iter().sum();
    let of_mass: f64 = net.iter().zip(MOLAR).map(|(n, m)| n * m).sum();
    let mean: f64 = fractions.iter().zip(MOLAR).map(|(x, m)| x * m).sum();
    let velocity = match theory.stefan_flow {
        StefanFlow::None => 0.0,
        StefanFlow::Molar => -of_moles / flux,
        StefanFlow::Mass => -of_mass / flux / mean,
    };
    // X_s m = (X β⁺ + N/(c A))/β⁻
    let scaled: Vec<f64> = (0..4)
        .map(|g| {
            let phi = velocity / FILMS[g];
            let back = if phi == 0.0 { 1.0 } else { phi / phi.exp_m1() };
            fractions[g] * phi.exp() + net[g] / flux / (FILMS[g] * back)
        })
        .collect();
    let lighter = match theory.stefan_flow {
        StefanFlow::Mass => scaled.iter().sum(),
        _ => 1.0,
    };
    [0, 1, 2, 3].map(|g| scaled[g] / lighter * PRESSURE / (GAS_CONSTANT * PARTICLE))
}

#[test]
fn a_reaction_stated_in_parts_is_the_one_of_their_sum() {
    let accuracy = ParticleAccuracy::default();
    for theory in THEORIES {
        for order in [0.0, 0.5, 1.0, 1.6, 2.0] {
            for damkoehler in [1e-3, 0.3, 3.0, 1e3, 1e9] {
                // Of the same rate at the concentration in the gas.
                let bulk = bulk(&AIR)[O2];
                let whole = factor(damkoehler) * bulk.powf(1.0 - order);
                for span in [1e-6, 0.05, 1.0, 30.0] {
                    let of = |shares: &[f64]| {
                        let parts = shares.iter().map(|share| to_dioxide(share * whole, order));
                        let parts: Vec<_> = parts.collect();
                        follow(&parts, &AIR, theory, span, accuracy)
                    };
                    let one = of(&[1.0]).extents[0];
                    for shares in [&[0.5, 0.5][..], &[0.2, 0.3, 0.5]] {
                        let parts = of(shares);
                        let all: f64 = parts.extents.iter().sum();
                        let at = format!("{theory:?} {order} {damkoehler} {span}");
                        assert!((all / one - 1.0).abs() < 1e-12, "{at}: {all:e} {one:e}");
                        for (extent, share) in parts.extents.iter().zip(shares) {
                            assert!((extent / all - share).abs() < 1e-12, "{at}: {share}");
                        }
                        let took = parts.statistics;
                        assert!(took.steps + took.rejected < 100, "{at}: {took:?}");
                    }
                    let rate = one / span;
                    let film = brings(O2) * bulk;
                    if theory == PLAIN && span < 1e-5 {
                        assert!(rate < film * (1.0 + 1e-9), "{rate:e} {film:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn what_one_film_brings_is_all_that_any_number_of_reactions_use() {
    let film = brings(O2) * bulk(&AIR)[O2];
    for count in 1..7 {
        let parts = vec![to_monoxide(factor(1e9), 1.0); count];
        let all: f64 = rates(&parts, &AIR, PLAIN).iter().sum();
        assert!((all / film - 1.0).abs() < 1e-8, "{count}: {all:e} {film:e}");
    }
}

#[test]
fn reactions_that_compete_for_oxygen_share_it_by_their_kinetics() {
    // D (b − c) = V (k₁ + k₂) c, each of V k c.
    let (film, bulk) = (brings(O2), bulk(&AIR)[O2]);
    for (first, second) in [
        (1e-3, 2e-3),
        (0.4, 3.0),
        (1e3, 30.0),
        (1e9, 2e9),
        (1e8, 1.0),
    ] {
        let reactions = [
            to_dioxide(factor(first), 1.0),
            to_monoxide(factor(second), 1.0),
        ];
        let found = rates(&reactions, &AIR, PLAIN);
        let all = film * bulk / (1.0 + first + second);
        for (rate, share) in found.iter().zip([first, second]) {
            assert!((rate / (all * share) - 1.0).abs() < 1e-8, "{rate:e}");
        }
    }
}

#[test]
fn each_rate_is_that_of_the_surface_which_all_rates_together_make() {
    // Orders in two gases, one of what no reaction uses, one of a product, and a net flow: the state of the surface
    // by the film's equations from the rates found, and each law there.
    let laws = |k: f64| {
        vec![
            to_dioxide(k * factor(0.5), 0.6),
            to_monoxide(k * factor(0.1), 1.7),
            boudouard(k * factor(0.7), 1.0),
            law(
                &[(CO2, -1.0), (CO, 2.0)],
                1.0,
                k * factor(0.4),
                &[(CO2, 1.3), (CO, -0.2), (3, 0.5)],
            ),
            law(
                &[(CO, -2.0), (O2, -1.0), (CO2, 2.0)],
                0.0,
                k * factor(0.05),
                &[(CO, 1.0), (O2, 0.5)],
            ),
        ]
    };
    for fractions in [
        [0.21, 0.05, 0.01, 0.73],
        [0.9, 0.02, 0.05, 0.03],
        [0.05, 0.3, 0.3, 0.35],
    ] {
        for theory in THEORIES {
            for k in [0.01, 1.0, 10.0] {
                let reactions = laws(k);
                let found = rates(&reactions, &fractions, theory);
                let there = surface(&reactions, &found, &fractions, theory);
                for (rate, reaction) in found.iter().zip(&reactions) {
                    let Rate::Power(law) = &reaction.rate else {
                        unreachable!()
                    };
                    let powers = law.gases.iter().map(|&(g, n)| there[g].powf(n));
                    let expected = volume() * law.rate_constant.factor * powers.product::<f64>();
                    assert!(
                        (rate / expected - 1.0).abs() < 1e-7,
                        "{theory:?} {k} {}: {rate:e} {expected:e} {there:?}",
                        reaction.name
                    );
                }
            }
        }
    }
}

#[test]
fn boudouard_s_reaction_uses_the_dioxide_that_the_oxygen_makes() {
    // O2: D₁ (b − c) = V k₁ c. CO2: V k₁ c = D₂ c′ + V k₂ c′, in gas that holds none.
    let oxygen = brings(O2) * bulk(&AIR)[O2];
    for (first, second) in [(0.3, 0.2), (1e9, 5.0), (1e9, 1e9), (1e-3, 1e9)] {
        let reactions = [
            to_dioxide(factor(first), 1.0),
            boudouard(factor(second), 1.0),
        ];
        let found = rates(&reactions, &AIR, PLAIN);
        let burnt = oxygen * first / (1.0 + first);
        let taken = second * brings(O2);
        let gasified = burnt * taken / (brings(CO2) + taken);
        assert!((found[0] / burnt - 1.0).abs() < 1e-8, "{found:?} {burnt:e}");
        assert!(
            (found[1] / gasified - 1.0).abs() < 1e-8,
            "{found:?} {gasified:e}"
        );
    }
}

#[test]
fn a_reversible_reaction_of_any_rate_is_held_back_by_what_it_makes_at_the_surface() {
    // c²(CO)/c(CO2) = K p°/(R T) in the limit; carbon of both in balance: D₂ (b₂ − c₂) + r₁ = r, D₃ c₃ = 2 r.
    let at_rest = 0.4 * 1e5 / (GAS_CONSTANT * PARTICLE);
    for fractions in [AIR, [0.21, 0.1, 0.05, 0.64], [0.0, 0.0, 0.5, 0.5]] {
        let gas = bulk(&fractions);
        let burnt = brings(O2) * gas[O2];
        for speed in [1e5, 1e9, 1e12] {
            let reactions = [
                to_dioxide(factor(1e9), 1.0),
                reversible(boudouard(factor(speed), 1.0), 0.4),
            ];
            let found = rates(&reactions, &fractions, PLAIN);
            let (mut low, mut high) = (-brings(CO) * gas[CO] / 2.0, burnt + brings(CO2) * gas[CO2]);
            for _ in 0..200 {
                let r = 0.5 * (low + high);
                let monoxide = gas[CO] + 2.0 * r / brings(CO);
                let dioxide = gas[CO2] + (burnt - r) / brings(CO2);
                if monoxide * monoxide < at_rest * dioxide {
                    low = r;
                } else {
                    high = r;
                }
            }
            // The distance from rest is of the order of one over the rate.
            let near = 10.0 / speed + 1e-8;
            assert!(
                (found[1] / low - 1.0).abs() < near,
                "{speed:e}: {found:?} {low:e}"
            );
            // It alone meets the same film.
            let alone = rates(
                &reactions[1..],
                &[0.0, fractions[1], fractions[2], 0.4],
                PLAIN,
            )[0];
            let both = [to_dioxide(1e-30, 1.0), reactions[1].clone()];
            let beside = rates(&both, &[0.0, fractions[1], fractions[2], 0.4], PLAIN)[1];
            assert!(
                (alone - beside).abs() <= 1e-9 * alone.abs(),
                "{alone:e} {beside:e}"
            );
        }
    }
}

#[test]
fn reactions_of_order_zero_share_what_the_film_brings_by_their_constants() {
    let film = brings(O2) * bulk(&AIR)[O2];
    let of = |share: f64| share * film / volume();
    for (first, second) in [(0.2, 0.3), (3.0, 1.0), (1e6, 1e6)] {
        let reactions = [to_dioxide(of(first), 0.0), to_monoxide(of(second), 0.0)];
        let found = rates(&reactions, &AIR, PLAIN);
        let limit = (1.0 / (first + second)).min(1.0);
        for (rate, share) in found.iter().zip([first, second]) {
            assert!(
                (rate / (film * share * limit) - 1.0).abs() < 1e-8,
                "{found:?}"
            );
        }
    }
    // Beside one of first order they take what they would, as long as there is some.
    for (zeroth, first) in [(0.4, 2.0), (2.0, 5.0)] {
        let reactions = [to_dioxide(of(zeroth), 0.0), to_monoxide(factor(first), 1.0)];
        let found = rates(&reactions, &AIR, PLAIN);
        let left = (1.0 - zeroth).max(0.0) / (1.0 + first);
        let expected = [film * zeroth.min(1.0), film * first * left];
        for (rate, expected) in found.iter().zip(expected) {
            assert!(
                (rate - expected).abs() < 1e-8 * film,
                "{found:?} {expected:e}"
            );
        }
    }
}

#[test]
fn a_shrinking_core_and_a_power_law_meet_one_film() {
    // The core takes A (c − c*)/z, z its interface behind the layer; c + c′ at the surface is what the gas holds of both but for
    // what the gasification makes of one of them two.
    let fractions = [0.0, 0.1, 0.3, 0.6];
    let share = |v: f64| v.cbrt();
    for (core, gasification) in [(0.05, 1e-9), (0.05, 0.8), (10.0, 3.0)] {
        let reactions = [reduction(core), boudouard(factor(gasification), 1.0)];
        let found = rates(&reactions, &fractions, PLAIN);
        let there = surface(&reactions, &found, &fractions, PLAIN);
        let xi = share(0.5);
        let layer = RADIUS / 2e-4 * (1.0 / xi - 1.0);
        let together = core * (1.0 + 1.0 / 0.6);
        let resistance = layer + 1.0 / (together * xi * xi);
        // By the convention of the ladder the pair passes by the film of its key gas.
        let net_of_both = found[1];
        let both = bulk(&fractions)[CO] + bulk(&fractions)[CO2] + net_of_both / brings(CO);
        let at_rest = both / (1.0 + 0.6);
        let expected = sphere::surface(RADIUS) * (there[CO] - at_rest) / resistance;
        assert!(
            (found[0] / expected - 1.0).abs() < 1e-4,
            "{found:?} {expected:e}"
        );
        let used = volume() * factor(gasification) * there[CO2];
        assert!((found[1] / used - 1.0).abs() < 1e-7, "{found:?} {used:e}");
    }
}

#[test]
fn two_cores_of_other_solids_share_the_film_of_their_gas() {
    // Calcination at one interface, iron and its oxide at another: beside a core that makes nothing each is as alone.
    let calcination = |rate_constant: f64| Reaction {
        name: "calcination".into(),
        solids: vec![(3, -1.0), (0, 1.0)],
        gases: vec![(CO2, 1.0)],
        rate: Rate::Core {
            rate_constant: constant(rate_constant),
            diffusivity: LayerDiffusivity {
                value: 1e-2,
                at: PARTICLE,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::Line {
            constant: 0.8f64.ln(),
            over_temperature: 0.0,
        },
    };
    let fractions = [0.0, 0.1, 0.3, 0.6];
    let alone = rates(&[reduction(0.05)], &fractions, PLAIN)[0];
    let beside = |k: f64| rates(&[reduction(0.05), calcination(k)], &fractions, PLAIN);
    assert!((beside(1e-12)[0] / alone - 1.0).abs() < 1e-9);
    let fast = beside(1e3);
    assert!(fast[1] > 0.0);
    // The dioxide that it makes holds the reduction back.
    assert!(fast[0] < 0.9 * alone, "{fast:?} {alone:e}");
}

#[test]
fn the_tangent_of_shared_rates_is_their_difference_quotient() {
    let accuracy = ParticleAccuracy {
        amount: 1e-9,
        temperature: 1e-5,
    };
    let reactions = [
        to_dioxide(factor(3.0), 0.7),
        to_monoxide(factor(1.0), 1.0),
        reversible(boudouard(factor(20.0), 1.0), 0.4),
        reduction(0.1),
    ];
    let keys = [O2, O2, CO2, CO];
    let fractions = [0.2, 0.1, 0.2, 0.5];
    for theory in THEORIES {
        for span in [1e-3, 0.5] {
            let done = follow(&reactions, &fractions, theory, span, accuracy);
            let scale = done.extents.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
            for (j, key) in keys.into_iter().enumerate() {
                let h = 1e-4;
                let moved = |h: f64| {
                    let mut varied = fractions;
                    varied[key] += h;
                    if j == 3 {
                        varied[CO2] -= h;
                    }
                    follow(&reactions, &varied, theory, span, accuracy).extents[j]
                };
                let quotient = (moved(h) - moved(-h)) / (2.0 * h);
                let slope = done.slopes[j];
                assert!(
                    (slope - quotient).abs() < 0.01 * quotient.abs() + 0.002 * scale,
                    "{theory:?} {span} {j}: {slope:e} {quotient:e}"
                );
            }
        }
    }
}

#[test]
fn gas_that_makes_more_of_itself_ends_by_the_flow_that_carries_it_away() {
    // FeO + CO => Fe + CO2 and C + CO2 => 2CO as fast as any: the film's equations, and the flow of moles 2 r for r that ends in it.
    let one_way = |reaction: Reaction| Reaction {
        equilibrium: Equilibrium::OneWay,
        ..reaction
    };
    let fractions = [0.0, 0.1, 0.3, 0.6];
    let reactions = [one_way(reduction(1.0)), boudouard(factor(30.0), 1.0)];
    for theory in &THEORIES[1..] {
        let found = rates(&reactions, &fractions, *theory);
        let there = surface(&reactions, &found, &fractions, *theory);
        let used = volume() * factor(30.0) * there[CO2];
        assert!((found[1] / used - 1.0).abs() < 1e-7, "{found:?} {used:e}");
        assert!(there.iter().all(|c| *c >= 0.0), "{there:?}");
    }
}

#[test]
fn a_fraction_that_is_not_a_number_gives_no_rates() {
    for broken in [O2, CO2] {
        let reactions = [to_dioxide(1.0, 1.0), boudouard(1.0, 1.0)];
        let chemistry = chemistry(reactions.to_vec());
        let mut fractions = AIR;
        fractions[broken] = f64::NAN;
        let start = ParticleStart {
            amounts: &[AMOUNT; 5],
            first: &[AMOUNT; 5],
            temperature: PARTICLE,
            around: ParticleSurroundings {
                temperature: HOT,
                pressure: PRESSURE,
                fractions: &fractions,
                film: &FILMS.map(FilmCoefficient::constant),
                theory: PLAIN,
                radius: RADIUS,
                size: &SizeChange::Constant,
            },
            conductance: 1e-3,
            heat: 0.0,
        };
        let mut workspace = ParticleWorkspace::default();
        let accuracy = ParticleAccuracy::default();
        let done = chemistry.follow(&start, 1.0, accuracy, &mut workspace);
        let error = done.unwrap_err().to_string();
        assert!(error.contains("not finite"), "{error}");
    }
}

/// A number between 0 and 1 that follows from its place.
fn scattered(place: u64) -> f64 {
    let mut x = place.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / 2f64.powi(53)
}

#[test]
fn particles_of_any_rates_that_share_gases_end_within_their_solids() {
    let mut counts = Vec::new();
    for case in 0..400u64 {
        let number = |k: u64| scattered(100 * case + k);
        let speed = |k: u64| factor(10f64.powf(-4.0 + 16.0 * number(k)));
        let theory = THEORIES[case as usize % 5 % 3];
        let order = |k: u64| [0.0, 0.5, 1.0, 1.0, 1.5, 2.0][(6.0 * number(k)) as usize];
        let mut reactions = vec![
            to_dioxide(speed(0), order(1)),
            to_monoxide(speed(2), order(3)),
        ];
        let gasification = boudouard(speed(4), order(5));
        let constant = 10f64.powf(-3.0 + 6.0 * number(6));
        reactions.push(match case % 3 {
            0 => gasification,
            _ => reversible(gasification, constant),
        });
        // Where more gas is made the more there is, with a net flow or both ways.
        if case % 3 == 2 || case % 7 == 0 && theory.stefan_flow != StefanFlow::None {
            reactions.push(reduction(10f64.powf(-3.0 + 10.0 * number(7))));
        }
        let fractions = match case % 4 {
            0 => AIR,
            1 => [0.0, 0.2, 0.0, 0.8],
            2 => [0.1, 0.0, 0.2, 0.7],
            _ => [0.1, 0.1, 0.1, 0.7],
        };
        let span = 10f64.powf(-4.0 + 6.0 * number(8));
        let done = follow(
            &reactions,
            &fractions,
            theory,
            span,
            ParticleAccuracy::default(),
        );
        let carbon: f64 = [1.0, 2.0, 1.0]
            .iter()
            .zip(&done.extents)
            .map(|(n, extent)| n * extent)
            .sum();
        assert!(carbon <= AMOUNT * (1.0 + 1e-9), "{case}: {carbon:e}");
        assert!(
            done.extents[..2]
                .iter()
                .all(|extent| *extent > -1e-8 * AMOUNT),
            "{case}"
        );
        counts.push(done.statistics.steps + done.statistics.rejected);
    }
    counts.sort_unstable();
    assert!(counts[399] <= 150, "{counts:?}");
}
