//! What the particles of a bed make of eddies (docs/theory.md, TRB-1): which diameter, slip and void fraction the law
//! sees in a cell, and where it is asked.

use calcine_coupler::bed_eddies::{BedEddyInputs, BedEddyStage};
use calcine_coupler::closures::Closures;
use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::part::{Bed, EddyExchange, GasFields, ParticleFields};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::drag::NoDrag;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
use calcine_coupler::physics::heat_transfer::NoHeatTransfer;
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::turbulence::{BedEddies, EddySource, NoBedEddies};
use calcine_coupler::smoother::{Smoother, SmootherSettings};

/// A law that gives back what it is told.
#[derive(Debug)]
struct Told;

impl BedEddies for Told {
    fn name(&self) -> &'static str {
        "told"
    }

    fn source(&self, gas: &LocalGas, diameter: f64) -> EddySource {
        EddySource {
            energy: diameter,
            dissipation: gas.slip,
            growth: gas.void_fraction.value(),
        }
    }
}

/// What the gas of three cells of 20 mm is told: in the first two spheres of 6 and 3 mm in radius and m/s, in the second a
/// small one, nothing in the third.
fn told(law: Box<dyn BedEddies>, acceleration: f64) -> EddyExchange {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(0.02, 0.02, 0.06),
        cells: [1, 1, 3],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap();
    let radius = [6e-3, 3e-3, 2e-3];
    let position = [
        Vec3::new(0.007, 0.007, 0.008),
        Vec3::new(0.016, 0.016, 0.01),
        Vec3::new(0.01, 0.01, 0.03),
    ];
    let velocity = [
        Vec3::new(0.0, 0.0, -6.0),
        Vec3::new(0.0, 0.0, -3.0),
        Vec3::zeros(),
    ];
    let weights = Mapper::new(&mesh).fill(Method::Centroid, &position, &radius);
    let volume = radius.map(|r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3));
    let settings = SmootherSettings {
        max_solid_fraction: 0.9,
        tolerance: 1e-6,
        diffusion_length: None,
    };
    let smoother = Smoother::new(&mesh, settings).unwrap();
    let operator = smoother.operator(weights.unwrap(), &volume).unwrap();
    let solid = operator.solid_fraction();
    let bed = Bed {
        void_fraction: solid.iter().map(|alpha| 1.0 - alpha).collect(),
    };
    let particles = ParticleFields {
        id: &[1, 2, 3],
        population: &[0; 3],
        position: &position,
        velocity: &velocity,
        angular_velocity: &velocity,
        radius: &radius,
        mass: &volume,
        weight: &[],
    };
    let one = vec![1.0; 3];
    let gas = GasFields {
        temperature: &[300.0; 3],
        pressure: &one,
        density: &one,
        composition: &[],
        velocity: &[Vec3::new(0.0, 0.0, 2.0); 3],
        pressure_gradient: &[Vec3::zeros(); 3],
        turbulence: Default::default(),
    };
    let closures = Closures {
        gas: GasModel::Constant(ConstantGas {
            density: 1.2,
            heat_capacity: 1000.0,
            viscosity: 1.8e-5,
            conductivity: 0.026,
        }),
        drag: Box::new(NoDrag),
        momentum: MomentumModel::A,
        heat_transfer: Box::new(NoHeatTransfer),
        mass_transfer: Box::new(NoHeatTransfer),
        film_diffusivity: Default::default(),
        bed_eddies: law,
        heat_film: calcine_coupler::physics::film::FilmTemperature::Gas,
        film: calcine_coupler::physics::film::FilmTheory {
            temperature: calcine_coupler::physics::film::FilmTemperature::Gas,
            stefan_flow: calcine_coupler::physics::film::StefanFlow::None,
        },
    };
    let mut stage = BedEddyStage::default();
    let inputs = BedEddyInputs {
        operator: &operator,
        bed: &bed,
        particles,
        acceleration,
    };
    stage.evaluate(&closures, &inputs, &gas);
    stage.exchange
}

#[test]
fn the_law_sees_spheres_of_the_cell_s_surface_per_volume_and_the_slip_to_its_mean_solid() {
    let found = told(Box::new(Told), 3.0);
    // 2 (6³ + 3³)/(6² + 3²) mm; the solid moves by (6⁴ + 3⁴)/(6³ + 3³) on the motion clock, a third of it in process time.
    assert!((found.energy[0] / 10.8e-3 - 1.0).abs() < 1e-12);
    let drift = (6f64.powi(4) + 3f64.powi(4)) / (6f64.powi(3) + 3f64.powi(3)) / 3.0;
    assert!((found.dissipation[0] / (2.0 + drift) - 1.0).abs() < 1e-12);
    let solid = 4.0 / 3.0 * std::f64::consts::PI * 243e-9 / 8e-6;
    assert!((found.growth[0] / (1.0 - solid) - 1.0).abs() < 1e-12);
}

#[test]
fn cells_with_a_tenth_of_solid_and_less_are_free_of_the_law() {
    let found = told(Box::new(Told), 1.0);
    assert_eq!(
        (found.energy[1], found.dissipation[1], found.growth[1]),
        (0.0, 0.0, 0.0)
    );
    assert_eq!(
        (found.energy[2], found.dissipation[2], found.growth[2]),
        (0.0, 0.0, 0.0)
    );
}

#[test]
fn where_eddies_end_at_the_bed_nothing_is_told() {
    assert_eq!(told(Box::new(NoBedEddies), 1.0), EddyExchange::default());
}
