//! The laws of every gas and of all particles, of OpenFOAM and of LIGGGHTS, on one rank and on two.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::LiggghtsLaunch;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::conformance::{broken, gas, particles};
use calcine_coupler::physics::Vec3;

const DEADLINE: Duration = Duration::from_secs(30);

/// Runs the laws of a gas for calcineGasFoam on a number of ranks.
fn openfoam_obeys(ranks: u32) {
    let folder = tempfile::tempdir().unwrap();
    let mut launched = 0;
    let outcomes = gas::run(&mut gas::GasUnderTest {
        make: &mut |setup, mesh, from, supervisor| {
            launched += 1;
            let launch = OpenfoamLaunch {
                setup,
                mesh: Arc::clone(mesh),
                template: None,
                start: None,
                gas: None,
                solver: StockSolver::default(),
                case_hash: "conformance".into(),
                folder: folder.path().join(format!("case-{launched}")),
                log: folder.path().join(format!("log-{launched}")),
                ranks,
                launcher: Launcher::Mpirun,
                resume: from.map(Path::to_owned),
                from: None,
                deadline: DEADLINE,
            };
            Ok(Box::new(launch.launch(supervisor)?))
        },
        scratch: folder.path(),
        closure: 1e-10,
        told: 1e-9,
    });
    let broken = broken(&outcomes.unwrap());
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn openfoam_obeys_the_laws_of_a_gas() {
    openfoam_obeys(1);
}

#[test]
fn openfoam_on_two_ranks_obeys_the_laws_of_a_gas() {
    openfoam_obeys(2);
}

/// Runs the laws of particles for LIGGGHTS on a number of ranks.
fn liggghts_obeys(ranks: u32) {
    let folder = tempfile::tempdir().unwrap();
    let mut launched = 0;
    let outcomes = particles::run(&mut particles::ParticlesUnderTest {
        make: &mut |setup, from, supervisor| {
            launched += 1;
            let launch = LiggghtsLaunch {
                inputs: Inputs {
                    setup,
                    bounds: (Vec3::zeros(), Vec3::repeat(particles::BOX)),
                    step: particles::STEP,
                    ranks,
                    wall_impulse: true,
                    moving_drag: true,
                    template: None,
                },
                case_hash: "conformance".into(),
                launcher: Launcher::Mpirun,
                folder: folder.path().join(format!("host-{launched}")),
                log: folder.path().join(format!("log-{launched}")),
                resume: from.map(Path::to_owned),
                deadline: DEADLINE,
            };
            Ok(Box::new(launch.launch(supervisor)?))
        },
        scratch: folder.path(),
    });
    let broken = broken(&outcomes);
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn liggghts_obeys_the_laws_of_particles() {
    liggghts_obeys(1);
}

#[test]
fn liggghts_on_two_ranks_obeys_the_laws_of_particles() {
    liggghts_obeys(2);
}
