//! The laws of all particles, of LIGGGHTS, on one rank and on two.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::LiggghtsLaunch;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_coupler::conformance::particles;
use calcine_coupler::physics::Vec3;

const DEADLINE: Duration = Duration::from_secs(30);

/// Runs the laws of particles for LIGGGHTS on a number of ranks.
fn liggghts_obeys(ranks: u32) {
    let folder = tempfile::tempdir().unwrap();
    let mut launched = 0;
    let broken = particles::run(&mut particles::ParticlesUnderTest {
        make: &mut |setup, from, supervisor| {
            launched += 1;
            let launch = LiggghtsLaunch {
                inputs: Inputs {
                    setup,
                    bounds: (Vec3::zeros(), Vec3::repeat(particles::BOX)),
                    step: particles::STEP,
                    ranks,
                    wall_impulse: true,
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
    let broken: Vec<String> = broken.iter().map(ToString::to_string).collect();
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
