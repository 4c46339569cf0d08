//! The laws of every gas and of all particles, of the native ones.

use std::sync::Arc;

use calcine_coupler::conformance::{broken, gas, particles};
use calcine_coupler::error::{FailureKind, PartError};
use calcine_native::gas::{NativeError, NativeGas};
use calcine_native::particles::NativeParticles;

fn unmade(error: NativeError) -> PartError {
    PartError::new("native", FailureKind::NotStarted, error.to_string())
}

#[test]
fn the_native_gas_obeys_the_laws_of_a_gas() {
    let folder = tempfile::tempdir().unwrap();
    let outcomes = gas::run(&mut gas::GasUnderTest {
        make: &mut |setup, mesh, from, _| {
            let mut gas = NativeGas::new(Arc::clone(mesh), setup).map_err(unmade)?;
            if let Some(folder) = from {
                gas.restore(folder).map_err(unmade)?;
            }
            Ok(Box::new(gas))
        },
        scratch: folder.path(),
        // The outer loop ends at 1e-11 of momentum; species and enthalpy are solved to round-off after it.
        closure: 1e-10,
        told: 1e-9,
    });
    let broken = broken(&outcomes.unwrap());
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn the_native_particles_obey_the_laws_of_particles() {
    let folder = tempfile::tempdir().unwrap();
    let outcomes = particles::run(&mut particles::ParticlesUnderTest {
        make: &mut |setup, from, _| {
            let mut particles = NativeParticles::new(setup).map_err(unmade)?;
            if let Some(folder) = from {
                particles.restore(folder).map_err(unmade)?;
            }
            Ok(Box::new(particles))
        },
        scratch: folder.path(),
    });
    let broken = broken(&outcomes);
    assert!(broken.is_empty(), "{broken:#?}");
}
