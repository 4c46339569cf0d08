use super::*;
use calcine_physics::conduction::{BatchelorObrien, NoConduction, RongHorio, SphereGap};
use calcine_physics::radiation::STEFAN_BOLTZMANN;

fn still(count: usize) -> Vec<f64> {
    vec![0.0; count]
}

fn chain(count: usize) -> HeatNetwork {
    let laws = HeatLaws::contacts(Box::new(BatchelorObrien));
    let mut network = HeatNetwork::new(laws, vec![plain(50.0)], Vec::new());
    network.change(&[], &vec![(5e-3, 0); count]);
    let touch = |i: usize| NeighbourPair {
        particles: [i, i + 1],
        radius: [5e-3; 2],
        overlap: 1e-6,
    };
    let pairs: Vec<NeighbourPair> = (0..count - 1).map(touch).collect();
    network.set_neighbours(&Neighbours {
        pairs: &pairs,
        walls: &[],
        views: None,
    });
    network
}

fn step(
    network: &mut HeatNetwork,
    capacity: f64,
    old: &[f64],
    sink_conductance: &[f64],
    beside: &[f64],
    reservoirs: &[f64],
) {
    let gas = vec![0.03; old.len()];
    let surroundings = NetworkSurroundings {
        gas_conductivity: &gas,
        reservoirs,
        bodies: super::NetworkBodies::NONE,
    };
    let solved: Result<NetworkOutcome, ()> = network.solve(old, &surroundings, |_, lines| {
        for (i, line) in lines.iter_mut().enumerate() {
            line.conductance = capacity + sink_conductance[i];
            line.temperature =
                old[i] + sink_conductance[i] * (beside[i] - old[i]) / line.conductance;
        }
        Ok(())
    });
    assert_eq!(solved, Ok(NetworkOutcome::Settled));
}

#[test]
fn two_particles_approach_each_other_as_the_implicit_step_has_it() {
    // G = 5e-3 W/K (COR-17), C = 2: T₁ − T₀ shrinks to 1/(1 + 2 G/C) of 100 K.
    let mut network = chain(2);
    step(
        &mut network,
        2.0,
        &[300.0, 400.0],
        &still(2),
        &still(2),
        &[],
    );
    let expected = 5e-3 * 100.0 / (1.0 + 2.0 * 5e-3 / 2.0);
    assert!((network.heat[0] / expected - 1.0).abs() < 1e-12);
    assert_eq!(network.heat[0], -network.heat[1]);
}

#[test]
fn a_chain_between_two_surroundings_carries_the_series_conductance_in_any_step() {
    // Ends coupled by h = 1 W/K to 500 and 300 K; a huge step is the steady state: resistances
    // 1/h + 9/G + 1/h.
    let mut network = chain(10);
    let mut sink_conductance = [0.0; 10];
    let mut beside = [0.0; 10];
    (sink_conductance[0], sink_conductance[9]) = (1.0, 1.0);
    (beside[0], beside[9]) = (500.0, 300.0);
    step(
        &mut network,
        1e-12,
        &[400.0; 10],
        &sink_conductance,
        &beside,
        &[],
    );
    let flow = 200.0 / (2.0 + 9.0 / 5e-3);
    assert!(
        (network.heat[0] / -flow - 1.0).abs() < 1e-9,
        "{:?}",
        network.heat
    );
    assert!((network.heat[9] / flow - 1.0).abs() < 1e-9);
    assert!(network.heat.iter().sum::<f64>().abs() < 1e-12 * flow);
}

#[test]
fn equal_temperatures_conduct_nothing() {
    let mut network = chain(5);
    step(&mut network, 1.0, &[350.0; 5], &[0.3; 5], &[350.0; 5], &[]);
    assert_eq!(network.heat, [0.0; 5]);
}

/// Three surfaces of 2, 1 and 1 m² that see only each other: a closed enclosure.
fn enclosure(emissivity: [f64; 3]) -> HeatNetwork {
    let laws = HeatLaws {
        radiates: true,
        ..HeatLaws::contacts(Box::new(NoConduction))
    };
    let materials = emissivity.map(|emissivity| ThermalProperties {
        emissivity,
        ..plain(1.0)
    });
    let mut network = HeatNetwork::new(laws, materials.to_vec(), Vec::new());
    network.change(&[], &[0, 1, 2].map(|material| (1.0, material)));
    network.set_neighbours(&Neighbours {
        pairs: &[],
        walls: &[],
        views: Some(&ExchangeAreas {
            pairs: vec![([0, 1], 1.0), ([0, 2], 1.0)],
            reservoirs: Vec::new(),
            radiosity: true,
            own: vec![0.0; 3],
            surface: vec![2.0, 1.0, 1.0],
            imbalance: RowImbalance::default(),
        }),
    });
    network
}

#[test]
fn black_surfaces_exchange_the_difference_of_fourth_powers() {
    let mut network = enclosure([1.0; 3]);
    // A heat capacity so large that nothing changes.
    step(
        &mut network,
        1e15,
        &[1000.0, 500.0, 300.0],
        &still(3),
        &still(3),
        &[],
    );
    let flux = |a: f64, b: f64| STEFAN_BOLTZMANN * (a.powi(4) - b.powi(4));
    let (first, second) = (flux(1000.0, 500.0), flux(1000.0, 300.0));
    assert!((network.heat[1] / first - 1.0).abs() < 1e-9);
    assert!((network.heat[2] / second - 1.0).abs() < 1e-9);
    assert!((network.heat[0] / -(first + second) - 1.0).abs() < 1e-9);
}

#[test]
fn views_of_those_that_stay_hold_while_others_go_and_come() {
    let mut network = enclosure([1.0; 3]);
    network.change(&[1], &[(0.05, 0)]);
    let old = [1000.0, 300.0, 900.0];
    step(&mut network, 1e15, &old, &still(3), &still(3), &[]);
    let flux = STEFAN_BOLTZMANN * (1000.0f64.powi(4) - 300.0f64.powi(4));
    assert!((network.heat[1] / flux - 1.0).abs() < 1e-9);
    assert_eq!((network.heat[0], network.heat[2]), (-network.heat[1], 0.0));
}

#[test]
fn grey_surfaces_exchange_through_resistances_in_series() {
    // Concentric or any two surfaces that see only each other: Q = σ ΔT⁴/((1−e₁)/(e₁A₁) + 1/(A₁F) + …).
    let laws = HeatLaws {
        radiates: true,
        ..HeatLaws::contacts(Box::new(NoConduction))
    };
    let grey = |emissivity| ThermalProperties {
        emissivity,
        ..plain(1.0)
    };
    let mut network = HeatNetwork::new(laws, vec![grey(0.8), grey(0.3)], Vec::new());
    network.change(&[], &[(1.0, 0), (1.0, 1)]);
    network.set_neighbours(&Neighbours {
        pairs: &[],
        walls: &[],
        views: Some(&ExchangeAreas {
            pairs: vec![([0, 1], 2.0)],
            reservoirs: Vec::new(),
            radiosity: true,
            own: vec![0.0; 2],
            surface: vec![2.0, 5.0],
            imbalance: RowImbalance::default(),
        }),
    });
    step(
        &mut network,
        1e15,
        &[1200.0, 400.0],
        &still(2),
        &still(2),
        &[],
    );
    let resistance = 0.2 / (0.8 * 2.0) + 1.0 / 2.0 + 0.7 / (0.3 * 5.0);
    let exact = STEFAN_BOLTZMANN * (1200.0_f64.powi(4) - 400.0_f64.powi(4)) / resistance;
    assert!(
        (network.heat[1] / exact - 1.0).abs() < 1e-8,
        "{}",
        network.heat[1] / exact
    );
}

#[test]
fn an_enclosure_keeps_its_energy_to_round_off_in_any_step_and_stays_between_its_temperatures() {
    for emissivity in [[1.0; 3], [0.9, 0.4, 0.05], [0.9, 1.0, 0.5]] {
        for capacity in [1e4, 10.0, 1e-2, 1e-6] {
            let mut network = enclosure(emissivity);
            let mut kelvin = [2000.0, 300.0, 900.0];
            for _ in 0..5 {
                step(
                    &mut network,
                    capacity,
                    &kelvin.clone(),
                    &still(3),
                    &still(3),
                    &[],
                );
                let sum: f64 = network.heat.iter().sum();
                let sizes: f64 = network.heat.iter().map(|q| q.abs()).sum();
                assert!(
                    sum.abs() <= 1e-15 * sizes,
                    "{emissivity:?} {capacity}: {sum}"
                );
                for (t, q) in kelvin.iter_mut().zip(&network.heat) {
                    *t += q / capacity;
                }
                let within = |t: &f64| (299.9..2000.1).contains(t);
                assert!(
                    kelvin.iter().all(within),
                    "{emissivity:?} {capacity}: {kelvin:?}"
                );
            }
        }
    }
}

#[test]
fn an_implicit_step_of_radiation_solves_its_own_equation() {
    // C (T − 300) = σ A (1500⁴ − T⁴): T by bisection.
    for capacity in [1e3, 50.0, 1.0, 1e-3] {
        let laws = HeatLaws {
            radiates: true,
            ..HeatLaws::contacts(Box::new(NoConduction))
        };
        let mut network = HeatNetwork::new(laws, vec![plain(1.0)], vec![0]);
        network.change(&[], &[(1.0, 0)]);
        network.set_neighbours(&Neighbours {
            pairs: &[],
            walls: &[],
            views: Some(&ExchangeAreas {
                pairs: Vec::new(),
                reservoirs: vec![([0, 0], 1.0)],
                radiosity: true,
                own: vec![0.0; 1],
                surface: vec![1.0],
                imbalance: RowImbalance::default(),
            }),
        });
        step(&mut network, capacity, &[300.0], &[0.0], &[0.0], &[1500.0]);
        let (mut low, mut high) = (300.0, 1500.0);
        for _ in 0..100 {
            let t: f64 = 0.5 * (low + high);
            if capacity * (t - 300.0) < STEFAN_BOLTZMANN * (1500.0_f64.powi(4) - t.powi(4)) {
                low = t;
            } else {
                high = t;
            }
        }
        let made = 300.0 + network.heat[0] / capacity;
        assert!((made / low - 1.0).abs() < 1e-9, "{capacity}: {made} {low}");
        assert_eq!(network.reservoir_heat, network.heat);
    }
}

#[test]
fn a_wall_heats_by_contact_and_through_the_gas() {
    let film = RongHorio {
        lens: 0.2,
        least_width: 1e-6,
    };
    let laws = HeatLaws {
        gap: Box::new(film),
        ..HeatLaws::contacts(Box::new(BatchelorObrien))
    };
    assert!((laws.reach(5e-3) - 1e-3).abs() < 1e-18);
    let mut network = HeatNetwork::new(laws, vec![plain(50.0), plain(12.5)], vec![1]);
    network.change(&[], &[(5e-3, 0)]);
    let at = |overlap: f64| NeighbourWall {
        particle: 0,
        reservoir: 0,
        radius: 5e-3,
        overlap,
    };
    let mut heat = |overlap: f64| {
        network.set_neighbours(&Neighbours {
            pairs: &[],
            walls: &[at(overlap)],
            views: None,
        });
        step(&mut network, 1e15, &[300.0], &[0.0], &[0.0], &[400.0]);
        network.heat[0]
    };
    // r_c = √(5e-3 · 2e-6) = 1e-4, k = 2·50·12.5/62.5 = 20: G = 4e-3 W/K, and the gas from r_c on.
    let contact = SphereGap {
        radius: [5e-3, f64::INFINITY],
        distance: -2e-6,
        contact_radius: 1e-4,
        conductivity: [50.0, 12.5],
        gas_conductivity: 0.03,
    };
    let expected = 100.0 * (4e-3 + film.conductance(&contact));
    assert!((heat(2e-6) / expected - 1.0).abs() < 1e-9);
    let apart = SphereGap {
        distance: 1e-4,
        contact_radius: 0.0,
        ..contact
    };
    assert!((heat(-1e-4) / (100.0 * film.conductance(&apart)) - 1.0).abs() < 1e-9);
    assert_eq!(heat(-1.1e-3), 0.0);
}

#[test]
fn many_particles_exchange_the_same_bits_on_any_number_of_threads() {
    let count = 20_000;
    let old: Vec<f64> = (0..count)
        .map(|p| 300.0 + (p * 7919 % 1013) as f64)
        .collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut network = chain(count);
        let still = still(count);
        let solve = || step(&mut network, 0.2, &old, &still, &still, &[]);
        pool.unwrap().install(solve);
        network.heat
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one, three);
    let sizes: f64 = one.iter().map(|q| q.abs()).sum();
    assert!(sizes > 1.0 && one.iter().sum::<f64>().abs() < 1e-13 * sizes);
}
