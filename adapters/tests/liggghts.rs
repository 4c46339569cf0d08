//! The LIGGGHTS host, as it is built, with ten spheres that are held.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::liggghts::{FROZEN_STEP, LiggghtsLaunch};
use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::part::{
    Bed as VoidFractions, Part, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use rustix::process::{Pid, Signal, kill_process};

/// One run at a time, so that a test sees its own leftovers only.
static TURN: Mutex<()> = Mutex::new(());

/// Ten spheres of 10 mm in a duct, as in cases/heated-column.toml.
fn column() -> ParticleSetup {
    let count = 10;
    ParticleSetup {
        id: (1..=count).collect(),
        population: vec![0; count as usize],
        position: (0..count)
            .map(|i| Vec3::new(0.005, 0.005, 0.015 + 0.01 * i as f64))
            .collect(),
        radius: vec![0.005; count as usize],
        density: vec![2500.0; count as usize],
        ..ParticleSetup::default()
    }
}

struct Bench {
    folder: tempfile::TempDir,
    setup: ParticleSetup,
    supervisor: Supervisor,
    _turn: MutexGuard<'static, ()>,
}

impl Bench {
    fn new() -> Self {
        let own = std::env::current_exe().unwrap();
        let host = own
            .parent()
            .unwrap()
            .parent()
            .unwrap()
            .join("calcine-liggghts");
        assert!(
            host.is_file() || std::env::var_os("CALCINE_LIGGGHTS_HOST").is_some(),
            "{} is missing: `cargo build -p calcine-liggghts` makes it (it needs Debian's \
             libliggghts-dev)",
            host.display()
        );
        Self {
            _turn: TURN.lock().unwrap_or_else(PoisonError::into_inner),
            folder: tempfile::tempdir().unwrap(),
            setup: column(),
            supervisor: Supervisor::new(Duration::from_secs(30), Interrupts::default()),
        }
    }

    fn log(&self) -> PathBuf {
        self.folder.path().join("log/liggghts.log")
    }

    fn launch(&mut self, ranks: u32, resume: Option<&Path>) -> Result<LinkedParticles, PartError> {
        let launch = LiggghtsLaunch {
            inputs: Inputs {
                setup: &self.setup,
                bounds: (Vec3::zeros(), Vec3::new(0.01, 0.01, 0.12)),
                step: FROZEN_STEP,
                ranks,
                wall_impulse: false,
                moving_drag: false,
                template: None,
            },
            launcher: Launcher::Mpirun,
            case_hash: "abc".into(),
            folder: self.folder.path().join("liggghts"),
            log: self.log(),
            resume: resume.map(Path::to_owned),
            deadline: Duration::from_secs(30),
        };
        launch.launch(&mut self.supervisor)
    }
}

fn window(index: u64) -> Window {
    // 1.05 ms are ten and a half steps: ten in one window, eleven in the next.
    let span = Ticks::from_seconds(1.05e-3).unwrap();
    let start = Ticks::new(span.count() * index as i64);
    let both = |motion| Clocks {
        motion,
        process: motion,
    };
    Window {
        index,
        attempt: 0,
        start: both(start),
        span: both(span),
    }
}

fn push() -> ParticlePush {
    ParticlePush {
        force: (0..10).map(|i| Vec3::new(0.0, 0.5, f64::from(i))).collect(),
        ..ParticlePush::default()
    }
}

fn step(particles: &mut LinkedParticles, supervisor: &Supervisor, index: u64) -> Vec<Vec3> {
    // What is left of a window in which the bed was held.
    let mut received = ParticleReceived {
        deep_contacts: Some(Default::default()),
        ..ParticleReceived::default()
    };
    particles
        .start(&window(index), &VoidFractions::default(), &push())
        .unwrap();
    particles.finish(supervisor, &mut received).unwrap();
    particles.commit().unwrap();
    assert_eq!(received.deep_contacts, None, "the coordinator looks");
    received.impulse
}

fn assert_column(particles: &LinkedParticles, setup: &ParticleSetup) {
    let fields = particles.fields();
    assert_eq!(fields.id, setup.id);
    assert_eq!(fields.population, setup.population);
    assert_eq!(fields.position, setup.position);
    assert_eq!(fields.radius, setup.radius);
    assert!(fields.velocity.iter().all(|v| *v == Vec3::zeros()));
    // π/6 · (10 mm)³ · 2500 kg/m³ = 1.308 996 938 995 747 g
    let mass = 1.308_996_938_995_747e-3;
    assert!(fields.mass.iter().all(|m| (m / mass - 1.0).abs() < 1e-14));
}

/// Files in shared memory of runs of this process.
fn leftovers() -> Vec<String> {
    let own = format!("calcine-{}-", std::process::id());
    let folders = [PathBuf::from("/dev/shm"), std::env::temp_dir()];
    let entries = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap().flatten());
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with(&own)).collect()
}

fn signal(pid: u32, signal: Signal) {
    kill_process(Pid::from_raw(pid.cast_signed()).unwrap(), signal).unwrap();
}

#[test]
fn a_held_bed_stays_bit_for_bit_and_its_support_takes_force_times_span() {
    let mut bench = Bench::new();
    let mut particles = bench.launch(1, None).unwrap();
    assert_eq!(particles.about().name, "LIGGGHTS");
    assert!(
        particles.about().version.contains("3.8"),
        "{:?}",
        particles.about()
    );
    assert_column(&particles, &bench.setup);
    for index in 0..3 {
        let impulse = step(&mut particles, &bench.supervisor, index);
        assert_eq!(impulse[4], Vec3::new(0.0, 0.5, 4.0) * 1.05e-3);
        assert_column(&particles, &bench.setup);
    }
    particles.finish_run(&bench.supervisor).unwrap();
    drop(particles);
    assert_eq!(leftovers(), Vec::<String>::new());
}

/// Nothing moves in it: no step of LIGGGHTS is needed.
#[test]
fn a_held_bed_passes_a_window_of_days_at_once() {
    let mut bench = Bench::new();
    let mut particles = bench.launch(1, None).unwrap();
    let span = Ticks::from_seconds(1e6).unwrap();
    let days = Window {
        span: Clocks {
            motion: span,
            process: span,
        },
        ..window(0)
    };
    let mut received = ParticleReceived::default();
    particles
        .start(&days, &VoidFractions::default(), &push())
        .unwrap();
    let begun = Instant::now();
    particles.finish(&bench.supervisor, &mut received).unwrap();
    particles.commit().unwrap();
    // By steps it would be minutes, and more of them than LIGGGHTS counts.
    assert!(begun.elapsed() < Duration::from_secs(20));
    assert_eq!(received.impulse[4], Vec3::new(0.0, 0.5, 4.0) * 1e6);
    assert_column(&particles, &bench.setup);
    particles.finish_run(&bench.supervisor).unwrap();
}

#[test]
fn a_run_goes_on_from_its_checkpoint_here_and_in_another_process() {
    let mut bench = Bench::new();
    let checkpoint = bench.folder.path().join("a folder/particles");
    fs::create_dir_all(&checkpoint).unwrap();
    let mut particles = bench.launch(1, None).unwrap();
    step(&mut particles, &bench.supervisor, 0);
    particles.checkpoint(&checkpoint).unwrap();
    assert_column(&particles, &bench.setup);
    let went_on = step(&mut particles, &bench.supervisor, 1);
    particles.finish_run(&bench.supervisor).unwrap();
    drop(particles);

    bench.supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
    let mut resumed = bench.launch(1, Some(&checkpoint)).unwrap();
    assert_column(&resumed, &bench.setup);
    assert_eq!(step(&mut resumed, &bench.supervisor, 1), went_on);
    resumed.finish_run(&bench.supervisor).unwrap();
}

#[test]
fn two_ranks_give_the_same_particles_as_one() {
    let mut bench = Bench::new();
    let mut particles = bench.launch(2, None).unwrap();
    assert_column(&particles, &bench.setup);
    let impulse = step(&mut particles, &bench.supervisor, 0);
    assert_eq!(impulse[9], Vec3::new(0.0, 0.5, 9.0) * 1.05e-3);
    assert_column(&particles, &bench.setup);
    particles.finish_run(&bench.supervisor).unwrap();
    drop(particles);
    assert_eq!(leftovers(), Vec::<String>::new());
}

#[test]
fn a_host_killed_in_a_window_is_named_within_a_second_and_leaves_nothing() {
    let mut bench = Bench::new();
    let mut particles = bench.launch(1, None).unwrap();
    step(&mut particles, &bench.supervisor, 0);
    let pid = particles.pid();
    // Stopped, it cannot answer: the kill falls into the window.
    signal(pid, Signal::STOP);
    particles
        .start(&window(1), &VoidFractions::default(), &push())
        .unwrap();
    signal(pid, Signal::KILL);
    let begun = Instant::now();
    let mut received = ParticleReceived::default();
    let error = particles
        .finish(&bench.supervisor, &mut received)
        .unwrap_err();
    assert!(begun.elapsed() < Duration::from_secs(1));
    let text = error.to_string();
    assert_eq!(error.kind, FailureKind::Died);
    for part in [
        "LIGGGHTS",
        &format!("pid {pid}"),
        "signal 9 (SIGKILL)",
        "window 1",
        "10 particles",
    ] {
        assert!(text.contains(part), "`{part}` is missing in: {text}");
    }
    drop(particles);
    assert!(begun.elapsed() < Duration::from_secs(5));
    assert_eq!(leftovers(), Vec::<String>::new());
}

#[test]
fn a_script_that_liggghts_refuses_is_reported_with_its_words() {
    let mut bench = Bench::new();
    // LIGGGHTS refuses a negative diameter.
    bench.setup.radius[3] = -1.0;
    let error = bench.launch(1, None).map(|_| ()).unwrap_err();
    assert_eq!(error.kind, FailureKind::Reported, "{error}");
    let text = error.to_string();
    assert!(
        text.contains("Invalid radius") || text.contains("LIGGGHTS: "),
        "{text}"
    );
    assert!(!error.log_end.is_empty());
    assert_eq!(leftovers(), Vec::<String>::new());
}

#[test]
fn a_checkpoint_that_is_not_there_is_an_error_that_names_it() {
    let mut bench = Bench::new();
    let missing = bench.folder.path().join("nothing");
    let error = bench.launch(1, Some(&missing)).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("liggghts.restart"), "{error}");
}
