//! Radiation and contacts, which particles with shells follow by steps of their own, and thin ones by means.

use calcine_physics::conduction::{BatchelorObrien, NoConduction};
use calcine_physics::radiation::STEFAN_BOLTZMANN;
use calcine_physics::solid::HeatCapacity;
use calcine_physics::sphere;

use super::support::*;
use crate::model::{At, GasLines, NetworkHeat, Newcomer, ParticleModel, SurfaceMean, Transfer};
use crate::network::{
    ExchangeAreas, HeatLaws, HeatNetwork, NeighbourPair, Neighbours, NetworkBodies, NetworkOutcome,
    NetworkSurroundings, RowImbalance, plain,
};
use crate::radial::{Radial, RadialNumerics};
use crate::thin::{TEMPERATURE, Thin};

const RADIUS: f64 = 5e-3;
const DENSITY: f64 = 2500.0;
const CAPACITY: f64 = 900.0;
const WALL: f64 = 1400.0;
const START: f64 = 300.0;

/// A network of radiation: exchange areas of pairs and to the wall in m², of surfaces with this emissivity.
fn radiating(
    count: usize,
    pairs: Vec<([usize; 2], f64)>,
    wall: Vec<([usize; 2], f64)>,
    emissivity: f64,
) -> HeatNetwork {
    let laws = HeatLaws {
        radiates: true,
        ..HeatLaws::contacts(Box::new(NoConduction))
    };
    let mut material = plain(1.0);
    material.emissivity = emissivity;
    let mut network = HeatNetwork::new(laws, vec![material], vec![0]);
    network.change(&[], &vec![(RADIUS, 0); count]);
    network.set_views(&ExchangeAreas {
        pairs,
        reservoirs: wall,
        radiosity: true,
        own: vec![0.0; count],
        surface: vec![sphere::surface(RADIUS); count],
        imbalance: RowImbalance::default(),
    });
    network
}

/// One sphere within a wall.
fn within_wall(emissivity: f64) -> HeatNetwork {
    let all = vec![([0, 0], sphere::surface(RADIUS))];
    radiating(1, Vec::new(), all, emissivity)
}

fn shells(conductivity: f64, numerics: RadialNumerics) -> Radial {
    let mut model = inert(DENSITY, CAPACITY, conductivity, numerics);
    put(&mut model, RADIUS, DENSITY, START, 1);
    model
}

fn thin() -> Thin {
    let mut thin = Thin::new(HeatCapacity::constant(CAPACITY));
    let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[START])];
    let one = Newcomer {
        id: 1,
        mass: sphere::mass(RADIUS, DENSITY),
        radius: RADIUS,
        state: &state,
    };
    thin.change(&[], &[one]).unwrap();
    thin
}

/// A window without gas, as the coordinator does it: heat in J from the wall, and what the ledger leaves open in J.
fn window(model: &mut dyn ParticleModel, network: &mut HeatNetwork, span: f64) -> [f64; 2] {
    let start = model.bodies(At::Commit).temperature.to_vec();
    let count = start.len();
    let still = Still {
        temperature: START,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: 0.0,
        film: 0.0,
        network: 0.0,
    };
    let lists = Lists::of(&still, RADIUS, count);
    let around = still.around(&lists);
    let beside = NetworkSurroundings {
        gas_conductivity: &vec![0.0; count],
        reservoirs: &[WALL],
        bodies: NetworkBodies::NONE,
    };
    let (mut told, mut lines): (Vec<NetworkHeat>, _) = (Vec::new(), GasLines::default());
    for _ in 0..4 {
        let solved = network.solve(&start, &beside, |at, lines| {
            model.surface(&around, span, at, lines)
        });
        assert_eq!(solved.unwrap(), NetworkOutcome::Settled);
        network.told(&mut told);
        lines.reset(count, 0);
        model.respond(&around, span, &told, &mut lines).unwrap();
        let means: Vec<Option<SurfaceMean>> =
            (0..count).map(|row| model.surface_mean(row)).collect();
        if network.book_means(&means, &told) < 1e-3 {
            break;
        }
    }
    let took = Transfer {
        heat: &vec![0.0; count],
        network: &network.heat,
        carried: &vec![0.0; count],
        rates: &[],
    };
    model.settle(&took, span).unwrap();
    let rows: Vec<usize> = (0..count).collect();
    let changed = model.changed(&rows).energy;
    let from_wall = network.reservoir_heat[0] * span;
    model.commit();
    network.begin();
    [from_wall, changed.sum - from_wall]
}

/// Temperature of the first surface after a time in so many windows.
fn after(
    model: &mut dyn ParticleModel,
    network: &mut HeatNetwork,
    time: f64,
    windows: usize,
) -> f64 {
    for _ in 0..windows {
        let [wall, open] = window(model, network, time / windows as f64);
        assert!(open.abs() <= 1e-11 * wall.abs(), "{open} of {wall}");
    }
    model.bodies(At::Commit).temperature[0]
}

/// Time in s in which a black sphere of one temperature comes to one in K: (ρ c R/3)/(4 σ T_w³) times the difference of
/// ln((T_w + T)/(T_w − T)) + 2 arctan(T/T_w).
fn time_to(kelvin: f64) -> f64 {
    let way = |t: f64| ((WALL + t) / (WALL - t)).ln() + 2.0 * (t / WALL).atan();
    let scale = DENSITY * CAPACITY * RADIUS / 3.0 / (4.0 * STEFAN_BOLTZMANN * WALL.powi(3));
    scale * (way(kelvin) - way(START))
}

/// The temperature in K after a time in s.
fn lumped(time: f64) -> f64 {
    let (mut low, mut high) = (START, WALL);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match time_to(middle) < time {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

#[test]
fn shells_heat_by_radiation_as_a_sphere_of_one_temperature_does_in_windows_of_any_length() {
    let numerics = RadialNumerics {
        temperature: 0.1,
        ..RadialNumerics::new(grid(8))
    };
    // 45 s to 1359 K.
    for (time, windows) in [(30.0, 1), (30.0, 3), (30.0, 30), (100.0, 1), (100.0, 10)] {
        let mut model = shells(1e5, numerics);
        let found = after(&mut model, &mut within_wall(1.0), time, windows);
        let exact = lumped(time);
        assert!(
            (found - exact).abs() < 1.0,
            "{time} s in {windows}: {found} {exact}"
        );
    }
}

#[test]
fn shells_that_conduct_badly_come_to_the_same_in_windows_of_any_length() {
    let numerics = RadialNumerics {
        temperature: 0.1,
        ..RadialNumerics::new(grid(20))
    };
    for emissivity in [1.0, 0.6] {
        let at = |windows: usize| {
            after(
                &mut shells(1.0, numerics),
                &mut within_wall(emissivity),
                60.0,
                windows,
            )
        };
        let fine = at(600);
        for windows in [1, 6, 60] {
            let found = at(windows);
            assert!(
                (found - fine).abs() < 1.0,
                "{emissivity}, {windows}: {found} {fine}"
            );
        }
    }
}

#[test]
fn radiation_is_of_second_order_in_the_steps_of_shells() {
    let at = |steps: usize| {
        let mut model = shells(1.0, one_step(grid(12)));
        after(&mut model, &mut within_wall(1.0), 40.0, steps)
    };
    let exact = at(1280);
    let errors = [20, 40, 80].map(|steps| (at(steps) - exact).abs());
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 1.8, "{errors:?}");
    }
}

#[test]
fn radiation_of_thin_particles_is_of_second_order_in_windows() {
    let exact = lumped(20.0);
    let errors = [4, 8, 16]
        .map(|windows| (after(&mut thin(), &mut within_wall(1.0), 20.0, windows) - exact).abs());
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 1.7, "{errors:?}");
    }
    assert!(errors[0] < 20.0, "{errors:?}");
}

/// Two stones, of which the first sees the wall, and both see and touch each other: temperature of the second after 60 s.
fn second(windows: usize, emissivity: f64, contacts: bool) -> f64 {
    let numerics = RadialNumerics {
        temperature: 0.05,
        ..RadialNumerics::new(grid(10))
    };
    let mut model = inert(DENSITY, CAPACITY, 2.0, numerics);
    put(&mut model, RADIUS, DENSITY, START, 2);
    let area = sphere::surface(RADIUS);
    let mut network = match contacts {
        false => radiating(
            2,
            vec![([0, 1], 0.5 * area)],
            vec![([0, 0], 0.5 * area)],
            emissivity,
        ),
        true => {
            let laws = HeatLaws::contacts(Box::new(BatchelorObrien));
            let mut network = HeatNetwork::new(laws, vec![plain(50.0)], Vec::new());
            network.change(&[], &[(RADIUS, 0); 2]);
            network.set_neighbours(&Neighbours {
                pairs: &[NeighbourPair {
                    particles: [0, 1],
                    radius: [RADIUS; 2],
                    overlap: 1e-4,
                }],
                walls: &[],
                views: None,
            });
            network
        }
    };
    if contacts {
        // The first is hotter.
        let kelvin = model
            .columns()
            .iter()
            .position(|one| one.name == TEMPERATURE);
        assert!(kelvin.is_some());
        let width = model.layout.width();
        let shells = model.layout.temperatures();
        model.committed[shells].fill(1000.0);
        model.committed[0] = 1000.0;
        assert!(width > 0);
        model.begin();
    }
    for _ in 0..windows {
        window(&mut model, &mut network, 60.0 / windows as f64);
    }
    model.bodies(At::Commit).temperature[1]
}

#[test]
fn particles_that_see_or_touch_each_other_come_to_the_same_in_long_windows() {
    for (emissivity, contacts) in [(1.0, false), (0.7, false), (1.0, true)] {
        let fine = second(240, emissivity, contacts);
        let errors = [3, 6, 12].map(|windows| (second(windows, emissivity, contacts) - fine).abs());
        assert!(
            errors[2] < 0.5 * errors[0].max(0.2) && errors[0] < 20.0,
            "{emissivity} {contacts}: {errors:?} of {fine}"
        );
    }
}
