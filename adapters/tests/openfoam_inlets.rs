//! What enters through OpenFOAM's inlets is what the case says (docs/theory.md, BND-1). The native ones:
//! `native-solver/tests/inlets.rs`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine_coupler::part::{Bed, Gas};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    CompositionSchedule, Convection, GasPatch, InletFlow, InletScalars, Schedule,
};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{CELLS, Duct, PRESSURE, SIDE, exchange_of_nothing, mesh, setup};

/// Mass fractions of CH4 and N2 of the gas that flows at 400 K into a duct of nitrogen of 300 K.
const FUEL: [f64; 2] = [0.3, 0.7];

/// The duct at a Péclet number u h/D of its cells, D = μ/(ρ Sc) of the inlet's gas, and the velocity of its inlet in m/s.
fn fuelled(
    folder: &Path,
    peclet: f64,
    scalars: InletScalars,
    convection: Convection,
) -> (Duct, GasModel, f64) {
    let gas = GasModel::Mixture(Mixture::new(["CH4", "N2"]).unwrap());
    let diffusivity = gas.viscosity(400.0, &FUEL) / 0.7 / gas.density(PRESSURE, 400.0, &FUEL);
    let velocity = peclet * diffusivity / SIDE;
    let mut setup = setup();
    for (name, patch) in &mut setup.patches {
        if name == "bottom" {
            *patch = GasPatch::Inlet {
                flow: InletFlow::SuperficialVelocity(Schedule::constant(velocity)),
                temperature: Schedule::constant(400.0),
                composition: Some(CompositionSchedule(vec![(0.0, FUEL.to_vec())])),
                turbulence: None,
                scalars,
            };
        }
    }
    setup.properties = gas.clone();
    setup.composition = vec![0.0, 1.0];
    setup.schmidt = 0.7;
    setup.velocity = Vec3::zeros();
    setup.controls.convection = convection;
    setup.controls.outer_tolerance = 1e-9;
    setup.controls.linear_tolerance = Some(1e-14);
    let mut duct = Duct::launch_on(mesh([1, 1, CELLS]), &setup, folder);
    let span = if velocity > 0.0 { SIDE / velocity } else { 1.0 };
    let ticks = Ticks::from_seconds(span).unwrap();
    duct.window.span = Clocks {
        motion: ticks,
        process: ticks,
    };
    (duct, gas, velocity)
}

fn advance(duct: &mut Duct) {
    let bed = Bed {
        void_fraction: vec![1.0; CELLS],
    };
    duct.advance(1, &bed, &exchange_of_nothing(CELLS));
}

/// Fuel and enthalpy that entered over a window, over what the case says: what the cells stored and what left with the gas
/// of the last cell.
fn entered(duct: &Duct, gas: &GasModel, velocity: f64) -> [f64; 2] {
    let span = duct.window.span.process.seconds();
    let fed = gas.density(PRESSURE, 400.0, &FUEL) * velocity * SIDE * SIDE * span;
    let left = fed - duct.received.mass.stored;
    let fields = duct.gas.fields();
    let last = &fields.composition[2 * (CELLS - 1)..];
    let fuel = duct.received.species[0].stored + left * last[0];
    let heat =
        duct.received.energy.stored + left * gas.enthalpy(fields.temperature[CELLS - 1], last);
    [
        fuel / (fed * FUEL[0]),
        heat / (fed * gas.enthalpy(400.0, &FUEL)),
    ]
}

#[test]
fn what_enters_openfoam_s_gas_is_what_the_case_says_at_any_peclet_number() {
    let mut worst = [0.0_f64; 2];
    for convection in [Convection::Upwind, Convection::VanLeer] {
        for peclet in [0.01, 1.0, 100.0] {
            let folder = tempfile::tempdir().unwrap();
            let (mut duct, gas, velocity) =
                fuelled(folder.path(), peclet, InletScalars::Flux, convection);
            for _ in 0..20 {
                advance(&mut duct);
                let shares = entered(&duct, &gas, velocity);
                for (worst, share) in worst.iter_mut().zip(shares) {
                    *worst = worst.max((share - 1.0).abs());
                }
            }
        }
    }
    println!(
        "largest deviations: fuel {:.1e}, heat {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst.iter().all(|one| *one < 1e-10), "{worst:?}");
}

#[test]
fn an_inlet_of_openfoam_that_holds_the_face_lets_species_and_heat_in_beside_the_flow() {
    let folder = tempfile::tempdir().unwrap();
    let (mut duct, gas, velocity) =
        fuelled(folder.path(), 0.01, InletScalars::Value, Convection::Upwind);
    advance(&mut duct);
    let [fuel, heat] = entered(&duct, &gas, velocity);
    println!("fuel {fuel:.2}, heat {heat:.2} of what flows in");
    assert!(fuel > 2.0 && heat > 2.0, "{fuel} {heat}");
}

#[test]
fn an_inlet_of_openfoam_without_flow_is_closed_to_species_and_heat() {
    let folder = tempfile::tempdir().unwrap();
    let (mut duct, ..) = fuelled(folder.path(), 0.0, InletScalars::Flux, Convection::VanLeer);
    for _ in 0..5 {
        advance(&mut duct);
    }
    let fields = duct.gas.fields();
    assert!(fields.composition.chunks(2).all(|one| one[0].abs() < 1e-14));
    assert!(fields.temperature.iter().all(|t| (t - 300.0).abs() < 1e-9));
}
