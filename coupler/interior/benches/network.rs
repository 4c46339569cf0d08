//! Time of an implicit step of heat between 100 000 spheres in contact, without and with radiation, on one and two threads.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::time::Instant;

use calcine_interior::{
    ExchangeAreas, HeatLaws, HeatNetwork, NeighbourPair, Neighbours, NetworkBodies, NetworkOutcome,
    NetworkSurroundings, RowImbalance, ThermalProperties,
};
use calcine_physics::conduction::{BatchelorObrien, Conductivity, Stiffness};

const RADIUS: f64 = 5e-3;

/// Spheres on a cubic lattice, each with its six neighbours.
fn lattice(side: usize) -> Vec<[usize; 2]> {
    let index = |[i, j, k]: [usize; 3]| (k * side + j) * side + i;
    let mut pairs = Vec::new();
    for node in 0..side * side * side {
        let place = [node % side, node / side % side, node / (side * side)];
        for axis in 0..3 {
            if place[axis] + 1 < side {
                let mut next = place;
                next[axis] += 1;
                pairs.push([node, index(next)]);
            }
        }
    }
    pairs
}

fn network(pairs: &[[usize; 2]], count: usize, radiates: bool) -> HeatNetwork {
    let laws = HeatLaws {
        radiates,
        ..HeatLaws::contacts(Box::new(BatchelorObrien))
    };
    let stiffness = Stiffness {
        young: 5e9,
        poisson: 0.25,
    };
    let material = ThermalProperties {
        conductivity: Conductivity::constant(2.0),
        emissivity: 0.8,
        density: 2000.0,
        soft: stiffness,
        real: stiffness,
    };
    let mut network = HeatNetwork::new(laws, vec![material], Vec::new());
    network.change(&[], &vec![(RADIUS, 0); count]);
    let touch = |&particles: &[usize; 2]| NeighbourPair {
        particles,
        radius: [RADIUS; 2],
        overlap: 1e-5,
    };
    let touching: Vec<NeighbourPair> = pairs.iter().map(touch).collect();
    let surface = 4.0 * std::f64::consts::PI * RADIUS * RADIUS;
    let areas = ExchangeAreas {
        pairs: pairs.iter().map(|pair| (*pair, surface / 8.0)).collect(),
        reservoirs: Vec::new(),
        radiosity: true,
        own: vec![surface / 4.0; count],
        surface: vec![surface; count],
        imbalance: RowImbalance::default(),
    };
    network.set_neighbours(&Neighbours {
        pairs: &touching,
        walls: &[],
        views: radiates.then_some(&areas),
    });
    network
}

fn main() {
    let quick = std::env::args().any(|word| word == "--test");
    let side = if quick { 10 } else { 46 };
    let (count, pairs) = (side * side * side, lattice(side));
    let kelvin: Vec<f64> = (0..count)
        .map(|p| 600.0 + (p * 7919 % 601) as f64)
        .collect();
    let gas = vec![0.05; count];
    for radiates in [false, true] {
        println!(
            "{count} spheres, {} contacts, radiation: {radiates}",
            pairs.len()
        );
        let mut bits: Option<Vec<f64>> = None;
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let mut network = network(&pairs, count, radiates);
            let surroundings = NetworkSurroundings {
                gas_conductivity: &gas,
                reservoirs: &[],
                bodies: NetworkBodies::NONE,
            };
            let mut best = f64::INFINITY;
            for _ in 0..if quick { 1 } else { 3 } {
                let begun = Instant::now();
                let outcome = pool.as_ref().unwrap().install(|| {
                    network.solve(&kelvin, &surroundings, |_, lines| {
                        for (p, line) in lines.iter_mut().enumerate() {
                            (line.conductance, line.temperature) = (0.1, kelvin[p]);
                        }
                        Ok::<(), ()>(())
                    })
                });
                assert_eq!(outcome, Ok(NetworkOutcome::Settled));
                best = best.min(begun.elapsed().as_secs_f64());
            }
            println!("  {threads} threads: {:.1} ms wall", 1e3 * best);
            match &bits {
                None => bits = Some(network.heat.clone()),
                Some(first) => println!("  same bits: {}", *first == network.heat),
            }
        }
    }
}
