//! Where particles exchange mass: a particle over several cells, with a gas that is held.

#![allow(clippy::unwrap_used)]

use calcine_coupler::interior::{Channel, GasLines};
use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{GasFields, SpeciesExchange};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};
use calcine_coupler::species_coupling::{ChannelLines, SpeciesCoupling};

const CELLS: usize = 4;
const SPECIES: usize = 3;
/// Of CO, from cell to cell.
const CO: [f64; CELLS] = [0.30, 0.24, 0.10, 0.02];

/// One sphere over four cells in a row.
fn operator() -> Operator {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(8e-3, 8e-3, 8e-3),
        cells: [CELLS, 1, 1],
        patches: ["a", "b", "side", "side", "side", "side"].map(String::from),
    })
    .unwrap();
    let (position, radius) = ([Vec3::new(3.7e-3, 4e-3, 4e-3)], [3e-3]);
    let weights = Mapper::new(&mesh)
        .fill(Method::Overlap, &position, &radius)
        .unwrap();
    let settings = SmootherSettings {
        max_solid_fraction: 0.9,
        tolerance: 1e-6,
        diffusion_length: None,
    };
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius[0] * radius[0] * radius[0];
    Smoother::new(&mesh, settings)
        .unwrap()
        .operator(weights, &[volume])
        .unwrap()
}

/// What the gas is told of CO, as it is and fixed, with the particle's rate at the gas it sees and these slopes.
fn told(operator: &Operator, rate: f64, whole: f64, local: f64) -> [SpeciesExchange; 2] {
    let mixture = Mixture::new(["CO", "CO2", "N2"]).unwrap();
    let masses: Vec<f64> = mixture
        .species()
        .iter()
        .map(|one| one.molar_mass())
        .collect();
    let properties = GasModel::Mixture(mixture);
    let channel = Channel {
        name: "reduction".into(),
        key: Some(0),
        mass: vec![-masses[0], masses[1], 0.0],
    };
    let composition: Vec<f64> = CO.iter().flat_map(|co| [*co, 0.4 - co, 0.6]).collect();
    let (scalars, vectors) = ([1000.0; CELLS], [Vec3::zeros(); CELLS]);
    let gas = GasFields {
        temperature: &scalars,
        pressure: &scalars,
        density: &scalars,
        composition: &composition,
        velocity: &vectors,
        pressure_gradient: &vectors,
        turbulence: Default::default(),
    };
    let mut seen = [0.0];
    operator.sample(&CO, &mut seen);
    let mut lines = GasLines::default();
    lines.reset(1, 1);
    lines.slope[0] = whole;
    lines.offset[0] = whole * seen[0] - rate;
    lines.local_slope[0] = local;
    lines.released[0] = 1000.0;
    let given = ChannelLines {
        channels: &[channel],
        lines: &lines,
    };
    let mut coupling = SpeciesCoupling::default();
    let [mut implicit, mut fixed] = [SpeciesExchange::default(), SpeciesExchange::default()];
    coupling.linearise(operator, given, &gas, &properties, &mut implicit);
    coupling.fix(operator, given, |_| (), &properties, &mut fixed);
    [implicit, fixed]
}

#[test]
fn no_attempt_takes_more_of_a_gas_than_there_is_whatever_the_slopes_say() {
    let operator = operator();
    for (rate, whole, local) in [(0.2, 0.0, 0.0), (20.0, 0.3, 1.5), (1e3, 1.0, 0.1)] {
        let [implicit, _] = told(&operator, rate, whole, local);
        let least = implicit.source.iter().copied().fold(0.0, f64::min);
        assert_eq!(least, 0.0, "{rate}, {whole}, {local}");
    }
}

#[test]
fn a_particle_gives_its_rate_to_its_cells_by_the_local_slope_whatever_that_of_its_total() {
    let operator = operator();
    let (rate, local) = (0.2, 1.5);
    let molar = Mixture::new(["CO"]).unwrap().species()[0].molar_mass();
    // W of each cell: what reaches it of one.
    let mut share = [0.0; CELLS];
    operator.spread(&[1.0], &mut share);
    let seen: f64 = share.iter().zip(CO).map(|(w, y)| w * y).sum();
    for whole in [0.0, 0.3, 1.0, 1.5] {
        let [implicit, fixed] = told(&operator, rate, whole, local);
        for (cell, co) in CO.into_iter().enumerate() {
            let at = cell * SPECIES;
            let expected = -molar * share[cell] * (rate + local * (co - seen));
            let at_rest = implicit.source[at] - implicit.coefficient[at] * co;
            let scale = molar * rate;
            assert!(
                (at_rest - expected).abs() < 1e-14 * scale,
                "{whole}, {cell}"
            );
            assert!(
                (fixed.source[at] - expected).abs() < 1e-14 * scale,
                "{whole}, {cell}"
            );
            assert_eq!(fixed.coefficient[at], 0.0);
            // Implicit enough for the cells of a particle to agree, for its total, and for no cell to give what it does not have.
            let least = molar * share[cell] * whole.max(0.5 * local);
            let least = least.max(-expected / co);
            assert!(
                (implicit.coefficient[at] - least).abs() < 1e-14 * least,
                "{whole}, {cell}"
            );
        }
        let all: f64 = (0..CELLS).map(|cell| fixed.source[cell * SPECIES]).sum();
        assert!((all + molar * rate).abs() < 1e-14 * molar * rate);
    }
}

#[test]
fn a_first_order_reaction_takes_from_each_cell_by_what_it_holds() {
    let operator = operator();
    let mut seen = [0.0];
    operator.sample(&CO, &mut seen);
    // r = k Y: the local slope is r/Y, and no cell gives what it does not have.
    let constant = 2.0;
    let molar = Mixture::new(["CO"]).unwrap().species()[0].molar_mass();
    let mut share = [0.0; CELLS];
    operator.spread(&[1.0], &mut share);
    let [_, fixed] = told(&operator, constant * seen[0], 0.0, constant);
    for (cell, co) in CO.into_iter().enumerate() {
        let expected = -molar * share[cell] * constant * co;
        assert!((fixed.source[cell * SPECIES] - expected).abs() < 1e-14 * molar);
    }
}
