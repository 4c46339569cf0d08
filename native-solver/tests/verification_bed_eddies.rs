//! Verification of eddies in the bed (docs/theory.md, TRB-1): the equilibrium of a uniform bed, the way to it along a
//! bed against an independent integration, walls, and what eddies of the bed mix.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::{EddyExchange, Gas};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::setup::{GasPatch, GasSetup, InletTurbulence, Schedule, Turbulence};

use crate::common::*;

/// Void fraction, superficial velocity in m/s and diameter in m of the bed, after which the sources below are made.
const PORES: f64 = 0.4;
const SUPERFICIAL: f64 = 0.5;
/// ε∞ in m²/s³ and C₂ ε∞²/k∞ in m²/s⁴ of Nakayama and Kuwahara in spheres of 10 mm, in Python: k∞ = 3.7 (1 − φ)/√φ U²,
/// ε∞ = 39 (1 − φ)^2.5/φ U³/d.
const NAKAYAMA: [f64; 3] = [339.85428862970076, 252710.76973647845, 0.0];
/// k∞ in m²/s² of them.
const DEVELOPED: f64 = 0.8775320506967254;
/// c_k U/√K in 1/s of Pedras and de Lemos in the same bed.
const PEDRAS: [f64; 3] = [0.0, 0.0, 406.66325135177874];
/// Eddies that flow in: k in m²/s² of 10 % of the interstitial speed, and their length in m.
const ENERGY: f64 = 0.023_437_5;
const SCALE: f64 = 2e-3;

fn laws(source: [f64; 3], cells: usize) -> EddyExchange {
    EddyExchange {
        energy: vec![source[0]; cells],
        dissipation: vec![source[1]; cells],
        growth: vec![source[2]; cells],
    }
}

/// A bed along a duct into which eddies of an energy and a length flow; they are the same at the start.
fn bed(side: GasPatch, energy: f64, length_scale: f64) -> GasSetup {
    let GasPatch::Inlet {
        flow, temperature, ..
    } = GasPatch::inlet(Schedule::constant(SUPERFICIAL), Schedule::constant(300.0))
    else {
        panic!("an inlet");
    };
    let inlet = GasPatch::Inlet {
        flow,
        temperature,
        composition: None,
        turbulence: Some(InletTurbulence {
            intensity: (energy / 1.5).sqrt() * PORES / SUPERFICIAL,
            length_scale,
        }),
        scalars: Default::default(),
    };
    let mut setup = setup(&[("side", side), ("bottom", inlet), ("top", outlet())]);
    setup.turbulence = Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl: 0.85,
        schmidt: 0.7,
        iterations: 1000,
        in_bed: true,
    };
    setup.velocity = Vec3::new(0.0, 0.0, SUPERFICIAL);
    setup.properties = inviscid();
    setup
}

fn driver(mesh: &std::sync::Arc<Mesh>, setup: &GasSetup, source: [f64; 3]) -> Driver {
    let mut driver = Driver::new(mesh, setup);
    driver.bed.void_fraction.fill(PORES);
    driver.exchange.eddies = laws(source, mesh.cells());
    driver
}

#[test]
fn a_uniform_bed_keeps_the_developed_eddies_of_nakayama_and_kuwahara() {
    let scale = 0.09_f64.powf(0.75) * DEVELOPED.powf(1.5) / NAKAYAMA[0];
    let mesh = duct([0.02, 0.02, 0.05], [2, 2, 5]);
    let mut driver = driver(&mesh, &bed(slip(), DEVELOPED, scale), NAKAYAMA);
    for _ in 0..20 {
        driver.window(5e-3, 1.0);
    }
    let eddies = driver.gas.fields().turbulence;
    for (k, eps) in eddies.energy.iter().zip(eddies.dissipation) {
        assert!((k / DEVELOPED - 1.0).abs() < 1e-9, "{k}");
        assert!((eps / NAKAYAMA[0] - 1.0).abs() < 1e-9, "{eps}");
    }
    // The laws of the pair are its equilibrium: others do not keep it.
    driver.exchange.eddies = laws([1.01 * NAKAYAMA[0], NAKAYAMA[1], 0.0], mesh.cells());
    driver.window(5e-3, 1.0);
    let moved = driver.gas.fields().turbulence.energy[19];
    assert!(moved / DEVELOPED > 1.001, "{moved}");
}

#[test]
fn eddies_of_pedras_and_de_lemos_keep_any_energy_at_the_rate_of_the_pores() {
    // ε/k = b.
    let scale = 0.09_f64.powf(0.75) * 0.3_f64.sqrt() / PEDRAS[2];
    let mesh = duct([0.02, 0.02, 0.05], [2, 2, 5]);
    let mut driver = driver(&mesh, &bed(slip(), 0.3, scale), PEDRAS);
    for _ in 0..20 {
        driver.window(5e-3, 1.0);
    }
    let eddies = driver.gas.fields().turbulence;
    for (k, eps) in eddies.energy.iter().zip(eddies.dissipation) {
        assert!((k / 0.3 - 1.0).abs() < 1e-9, "{k}");
        assert!((eps / (0.3 * PEDRAS[2]) - 1.0).abs() < 1e-9, "{eps}");
    }
}

/// k and ε along 50 mm of bed at these places in m, of the steady equations with diffusion, the eddies of the inlet at its
/// face: second-order finite volumes of 2000 cells in Python, extrapolated from 1000, to 2e-4.
const PLACES: [f64; 4] = [0.005, 0.01, 0.02, 0.04];
const ALONG_NAKAYAMA: [[f64; 2]; 4] = [
    [0.609_173, 272.304],
    [0.774_097, 315.411],
    [0.860_601, 335.964],
    [0.877_050, 339.744],
];
const ALONG_PEDRAS: [[f64; 2]; 4] = [
    [0.112_810, 6.479_52],
    [0.375_413, 68.505_1],
    [0.821_014, 314.825],
    [0.873_797, 355.279],
];

/// k and ε at the places, by so many cells.
fn along(source: [f64; 3], cells: usize) -> [[f64; 2]; 4] {
    let mesh = duct([0.01, 0.01, 0.05], [1, 1, cells]);
    let mut driver = driver(&mesh, &bed(slip(), ENERGY, SCALE), source);
    for _ in 0..150 {
        driver.window(1e-3, 1.0);
    }
    let eddies = driver.gas.fields().turbulence;
    PLACES.map(|place| {
        let at = place / 0.05 * cells as f64 - 0.5;
        let (below, share) = (at.floor() as usize, at.fract());
        [eddies.energy, eddies.dissipation]
            .map(|field| (1.0 - share) * field[below] + share * field[below + 1])
    })
}

/// Asserts that the errors halve with the cells, of which the first mesh has so many, and what is extrapolated.
fn follows(source: [f64; 3], exact: [[f64; 2]; 4], coarsest: usize) {
    let found = [1, 2, 4].map(|times| along(source, times * coarsest));
    for place in 0..4 {
        for field in 0..2 {
            let right = exact[place][field];
            let errors = found.map(|one| one[place][field] / right - 1.0);
            let limit = 2.0 * errors[2] - errors[1];
            println!(
                "{:.3} m, {right:.5}: {errors:.5?}, {limit:.1e}",
                PLACES[place]
            );
            // Upwind.
            assert!(errors[2].abs() < 0.04, "{errors:?}");
            assert!(errors[2].abs() < 0.6 * errors[1].abs() + 5e-4, "{errors:?}");
            // What is left is of second order in the cell.
            assert!(limit.abs() < 6e-3, "{errors:?}");
        }
    }
}

#[test]
fn eddies_grow_along_a_bed_as_an_independent_integration_of_nakayama_and_kuwahara_says() {
    follows(NAKAYAMA, ALONG_NAKAYAMA, 100);
}

#[test]
fn eddies_grow_along_a_bed_as_an_independent_integration_of_pedras_and_de_lemos_says() {
    // ε grows by e over 1.4 mm.
    follows(PEDRAS, ALONG_PEDRAS, 400);
}

#[test]
fn walls_of_a_bed_have_no_wall_function() {
    let scale = 0.09_f64.powf(0.75) * DEVELOPED.powf(1.5) / NAKAYAMA[0];
    let mesh = duct([0.04, 0.04, 0.05], [4, 4, 5]);
    let mut setup = bed(no_slip(), DEVELOPED, scale);
    let mut friction = 0.0;
    for in_bed in [true, false] {
        if let Turbulence::KEpsilon { in_bed: on, .. } = &mut setup.turbulence {
            *on = in_bed;
        }
        let source = if in_bed { NAKAYAMA } else { [0.0; 3] };
        let mut driver = driver(&mesh, &setup, source);
        // As stiff as a bed: 1e4 Pa/m at 1.25 m/s.
        driver.exchange.drag_coefficient.fill(1e4 * 1e-6 / 1.25);
        for _ in 0..20 {
            driver.window(5e-3, 1.0);
        }
        let fields = driver.gas.fields();
        let eddies = fields.turbulence;
        if in_bed {
            // The corner, and the middle: shear at the wall makes a little.
            for cell in [32, 37] {
                let k = eddies.energy[cell] / DEVELOPED;
                assert!((0.99..1.06).contains(&k), "{cell}: {k}");
            }
            friction = fields.velocity[32].z / fields.velocity[37].z;
        } else {
            assert!(eddies.viscosity.iter().all(|mu| *mu == 0.0));
            assert!((fields.velocity[32].z / fields.velocity[37].z - friction).abs() < 0.02);
        }
    }
}

#[test]
fn eddies_of_the_bed_carry_heat_with_their_viscosity() {
    // ν_t = C_μ k²/ε of the developed bed; nothing else conducts.
    let scale = 0.09_f64.powf(0.75) * DEVELOPED.powf(1.5) / NAKAYAMA[0];
    let mesh = duct([0.02, 0.02, 0.05], [2, 2, 5]);
    let mut driver = driver(&mesh, &bed(slip(), DEVELOPED, scale), NAKAYAMA);
    driver.window(1e-3, 1.0);
    let fields = driver.gas.fields();
    let right = KEpsilon::STANDARD.viscosity * DEVELOPED * DEVELOPED / NAKAYAMA[0];
    for (mu, density) in fields.turbulence.viscosity.iter().zip(fields.density) {
        let found = mu / (PORES * density);
        assert!((found / right - 1.0).abs() < 1e-9, "{found} {right}");
    }
}
