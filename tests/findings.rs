//! Planted faults that end no run: gas, particles and flow outside the ranges of their laws, iterations that end at their
//! limits. They show once in the log and in the closing lines, and with figures in the summary and the report.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use calcine::laws::LawCatalogue;
use calcine::results::Summary;
use calcine::results::warnings::{WarningPlace, WarningSummary};
use calcine::simulation::{Simulation, SimulationError};
use calcine::{exit, report};
use calcine_coupler::interior::{
    At, Bodies, GasLines, Inventory, ModelError, NetworkHeat, Newcomer, ParticleModel, Ragged,
    StateColumn, SurfaceLine, Surroundings, Thin, Transfer,
};
use calcine_coupler::physics::flow_range::FlowRange;
use calcine_coupler::physics::heat_transfer::{Gunn, HeatTransfer};
use calcine_coupler::physics::law::LawEntry;
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::solid::HeatCapacity;
use tempfile::TempDir;

use crate::agreement::cases;
use crate::support::program;

/// Air of oxygen and nitrogen at 7000 K flows past a bead.
const HOT: &str = r#"
format = 1
title = "Gas above the polynomials' range"

[time]
end = "2 ms"
motion_window = "0.1 ms"

[mesh]
box = { size = "10 10 40 mm", cells = [1, 1, 8] }

[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"

[gas]
mixture = "oxygen and nitrogen"
species = ["O2", "N2"]
schmidt = 0.7
initial = { temperature = "7000 K", pressure = "1 atm", velocity = "0 0 5 m/s", composition = { mole = { O2 = 0.2, N2 = 0.8 } } }
controls = { outer_iterations = 60, convection = "upwind" }

[gas.patch.bottom]
inlet = { superficial_velocity = "5 m/s", temperature = "7000 K", composition = { mole = { O2 = 0.2, N2 = 0.8 } } }

[gas.patch.top]
outlet = { pressure = "1 atm" }

[gas.patch.side]
symmetry = {}

[[particles]]
name = "bead"
material = "glass"
diameter = "1 mm"
motion = "frozen"
place = { grid = { first = "5 5 35 mm", spacing = "2 2 2 mm", counts = [1, 1, 1] } }
temperature = "1000 K"

[laws]
drag = { law = "none" }
heat_transfer = { law = "none" }
conduction = { law = "none" }
radiation = { law = "none" }

[coupling]
mapping = "overlap"
smoother = { max_solid_fraction = 0.64 }

[output]
every = "2 ms"
gas = ["temperature"]
"#;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/good/{name}.toml"))
}

/// Runs the hot gas; what the program said, and the results folder.
fn hot(directory: &Path, words: &[&str]) -> (Output, PathBuf) {
    let (case, out) = (directory.join("hot.toml"), directory.join("out"));
    fs::write(&case, HOT).unwrap();
    let output = program::command(&case, &out, words, &[""; 0]).output();
    (output.unwrap(), out)
}

/// A warning in summary, report, log and closing lines of a run.
fn shown(output: &Output, out: &Path, kind: &str) -> WarningSummary {
    let told = String::from_utf8_lossy(&output.stdout);
    let line = format!("warning: {kind} in ");
    assert!(told.contains(&line), "{told}");
    let log = fs::read_to_string(out.join("log/calcine.log")).unwrap();
    let warning = Summary::read(out).unwrap().warnings[kind].clone();
    assert_eq!(log.matches(&warning.message).count(), 1, "{log}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains(kind) && page.contains("Warnings"));
    warning
}

/// Gas of 7000 K, by one of the solvers.
fn gas_of_7000_kelvin(solver: &[&str]) {
    let directory = TempDir::new().unwrap();
    let (output, out) = hot(directory.path(), solver);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let warning = shown(&output, &out, "gas_temperature");
    // Eight cells in each of twenty windows; the bead takes no heat.
    assert_eq!((warning.windows, warning.count), (20, 160));
    assert_eq!(warning.limit, Some(6000.0));
    assert!((warning.worst - 7000.0).abs() < 10.0, "{}", warning.worst);
    assert!(matches!(warning.place, WarningPlace::Cell(_)));

    let directory = TempDir::new().unwrap();
    let (output, _) = hot(directory.path(), &[solver, &["--strict"]].concat());
    assert_eq!(output.status.code(), Some(i32::from(exit::WARNINGS)));
}

#[test]
fn native_gas_of_7000_kelvin_is_computed_and_told_of() {
    gas_of_7000_kelvin(&[]);
}

#[test]
fn openfoam_s_gas_of_7000_kelvin_is_computed_and_told_of() {
    gas_of_7000_kelvin(&["--gas", "openfoam"]);
}

/// Beads of 5 MPa that fall at 6 m/s, by one of the particle solvers.
fn beads_too_soft(particles: &str) -> WarningSummary {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let set = [
        "time.end=4 ms",
        "time.motion_window=0.1 ms",
        "particles[0].velocity=\"0 0 -6 m/s\"",
        "output.every=4 ms",
        "output.series_every=4 ms",
        "liggghts.wall_impulse=false",
    ];
    let case = program::shipped("settled-bed");
    let output = program::command(&case, &out, &["--particles", particles], &set).output();
    let output = output.unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let warning = shown(&output, &out, "deep_contacts");
    assert_eq!(warning.limit, Some(0.2));
    assert!(matches!(warning.place, WarningPlace::Particle(_)));
    warning
}

#[test]
fn beads_pressed_in_too_far_are_told_of_by_both_backends() {
    let [native, liggghts] = ["native", "liggghts"].map(beads_too_soft);
    // By Hertz a bead comes to 0.45 of its radius in the floor at 6 m/s, deeper with others on its back; LIGGGHTS is looked at
    // once a window, and between beads only.
    assert!(native.worst > 0.44, "{native:?}");
    assert!(
        native.worst >= 0.9 * liggghts.worst,
        "{native:?} {liggghts:?}"
    );
}

#[test]
fn gas_too_fast_for_low_mach_flow_is_told_of() {
    let directory = TempDir::new().unwrap();
    let set = [
        "gas.initial.temperature=300 K",
        "gas.initial.velocity=0 0 150 m/s",
        "gas.patch.bottom.inlet.temperature=300 K",
        "gas.patch.bottom.inlet.superficial_velocity=150 m/s",
    ];
    let words: Vec<&str> = set.iter().flat_map(|one| ["--set", *one]).collect();
    let (output, out) = hot(directory.path(), &words);
    let warning = shown(&output, &out, "mach_number");
    assert_eq!((warning.windows, warning.count), (20, 160));
    assert_eq!(warning.limit, Some(0.3));
    // √(γ R T/M) of four parts of nitrogen and one of oxygen is 348.0 m/s.
    assert!(
        (warning.worst - 150.0 / 348.0).abs() < 1e-3,
        "{}",
        warning.worst
    );
}

#[test]
fn particles_above_the_polynomials_of_their_material_are_told_of_by_their_id() {
    let directory = TempDir::new().unwrap();
    let mut simulation = Simulation::open(good("two-in-contact"))
        .set("materials.iron.heat_capacity.ranges=\"200 250 350 K\"")
        .out(directory.path().join("out"))
        .start()
        .unwrap();
    simulation.step().unwrap();
    simulation.stop().unwrap();
    let summary = simulation.summary().unwrap();
    let warning = &summary.warnings["particle_temperature"];
    assert_eq!((warning.windows, warning.count), (1, 1));
    assert_eq!(warning.limit, Some(350.0));
    assert_eq!(warning.place, WarningPlace::Particle(2));
}

#[test]
fn iterations_that_end_at_their_limits_are_counted_over_a_resume_and_told_of_once() {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let start = |resume| {
        let keys = [
            "gas.controls={ outer_iterations = 1, outer_tolerance = 1e-8 }",
            "coupling.exchange={ attempts = 1, tolerance = 1e-12, cuts = 0 }",
        ];
        let builder = Simulation::open(good("reactions")).out(&out);
        let builder = keys
            .into_iter()
            .fold(builder, |builder, key| builder.set(key));
        builder.resume(resume).start().unwrap()
    };
    let mut simulation = start(false);
    for _ in 0..3 {
        simulation.step().unwrap();
    }
    simulation.stop().unwrap();
    drop(simulation);
    let mut simulation = start(true);
    simulation.step().unwrap();
    simulation.stop().unwrap();
    let summary = simulation.summary().unwrap();
    let log = fs::read_to_string(out.join("log/calcine.log")).unwrap();
    for kind in ["gas_iterations", "exchange_attempts"] {
        let warning = &summary.warnings[kind];
        assert_eq!((warning.windows, warning.count), (4, 4), "{kind}");
        assert_eq!(warning.place, WarningPlace::Run);
        assert_eq!(log.matches(&warning.message).count(), 1, "{kind}: {log}");
    }
    assert_eq!(summary.warnings["exchange_attempts"].limit, Some(1e-12));
    assert_eq!(summary.warnings["gas_iterations"].limit, Some(1e-8));
    assert_eq!(exit::complete(summary, false), exit::OK);
    assert_eq!(exit::complete(summary, true), exit::WARNINGS);
}

#[test]
fn gas_that_comes_back_in_through_an_outlet_without_a_stated_state_is_told_of() {
    for gas in ["native", "openfoam"] {
        for (backflow, told) in [
            ("", true),
            (
                ", backflow = { temperature = \"300 K\", composition = { mass = { N2 = 1 } } }",
                false,
            ),
        ] {
            let directory = TempDir::new().unwrap();
            let out = directory.path().join("out");
            let outlet = |patch: &str| {
                format!(
                    "gas.patch.{patch}={{ outlet = {{ pressure = \"1.00001 atm\"{backflow} }} }}"
                )
            };
            let set = [outlet("west"), outlet("east"), "time.end=0.05 s".into()];
            program::run(&good("open-box"), &out, &["--gas", gas], &set);
            let summary = Summary::read(&out).unwrap();
            assert_eq!(
                summary.warnings.contains_key("backflow"),
                told,
                "{gas}: {:?}",
                summary.warnings
            );
        }
    }
}

/// Thin particles whose surface lines are spoilt, by how often they have been asked for.
struct Spoilt {
    thin: Thin,
    asked: u64,
    spoil: fn(u64, &mut SurfaceLine),
}

/// Particles of iron with spoilt surface lines that touch, for two seconds; the summary after the report was written.
fn two_with_spoilt_lines(kind: &str, spoil: fn(u64, &mut SurfaceLine)) -> Summary {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let mut simulation = Simulation::open(good("two-in-contact"))
        .set("time.end=2 s")
        .model("iron", move |_| {
            Box::new(Spoilt {
                thin: Thin::new(HeatCapacity::constant(450.0)),
                asked: 0,
                spoil,
            })
        })
        .out(&out)
        .start()
        .unwrap();
    simulation.finish().unwrap();
    let summary = simulation.summary().unwrap().clone();
    assert_eq!(summary.warnings[kind].windows, summary.windows);
    assert!(summary.ledger.lines["energy"].relative_error < 1e-11);
    assert_eq!(exit::complete(&summary, false), exit::OK);
    assert_eq!(exit::complete(&summary, true), exit::WARNINGS);
    report::write(&out).unwrap();
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains(kind));
    summary
}

impl ParticleModel for Spoilt {
    fn columns(&self) -> &[StateColumn] {
        self.thin.columns()
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        self.thin.read(column, out);
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        self.thin.load(from)
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        self.thin.bodies(at)
    }

    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        self.thin.surface(around, span, at, out)?;
        self.asked += 1;
        out.iter_mut()
            .for_each(|line| (self.spoil)(self.asked, line));
        Ok(())
    }

    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        self.thin.respond(around, span, network, out)
    }

    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        self.thin.settle(took, span)
    }

    fn changed(&self, rows: &[usize]) -> Inventory {
        self.thin.changed(rows)
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        self.thin.held(rows)
    }

    fn commit(&mut self) -> Vec<usize> {
        self.thin.commit()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        self.thin.change(gone, new)
    }
}

#[test]
fn heat_between_particles_that_does_not_converge_is_told_of_and_closes_its_balance() {
    // Each other time a surface takes twice as much: the iteration over surfaces finds no end.
    let summary = two_with_spoilt_lines("network_iterations", |asked, line| {
        if asked.is_multiple_of(2) {
            line.conductance *= 2.0;
        }
    });
    let warning = &summary.warnings["network_iterations"];
    assert!(warning.worst > 1e-6, "{}", warning.worst);
    assert!(matches!(warning.place, WarningPlace::Particle(1 | 2)));
}

#[test]
fn a_network_that_is_not_positive_definite_is_told_of_and_closes_its_balance() {
    // A surface that gives the more heat the hotter it is leaves the network without a minimum.
    let summary = two_with_spoilt_lines("network_solver", |_, line| line.conductance *= -1.0);
    let warning = &summary.warnings["network_solver"];
    assert!(warning.worst.is_finite() && warning.worst > 1e-12);
    assert_eq!(warning.place, WarningPlace::Run);
    assert!(!summary.warnings.contains_key("network_iterations"));
}

/// Eddies whose linear solvers end after one iteration, by one of the solvers.
fn turbulence_that_does_not_converge(solver: &[&str]) {
    let case = good("turbulent-duct");
    let run = |limit: &str, more: &[&str]| {
        let directory = TempDir::new().unwrap();
        let out = directory.path().join("out");
        let set = [format!("gas.turbulence.iterations={limit}")];
        let words = [solver, more].concat();
        let output = program::command(&case, &out, &words, &set).output();
        (output.unwrap(), out, directory)
    };
    let (output, out, _directory) = run("1", &[]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(exit::OK.into()), "{told}");
    let warning = shown(&output, &out, "turbulence_solver");
    // Each of the ten windows, the last one too.
    assert_eq!((warning.windows, warning.count), (10, 10));
    assert!(warning.worst.is_finite() && warning.worst > 1e-10);
    assert_eq!((warning.limit, warning.place), (None, WarningPlace::Run));

    let (output, _, _directory) = run("1", &["--strict"]);
    assert_eq!(output.status.code(), Some(exit::WARNINGS.into()));

    let (_, out, _directory) = run("1000", &[]);
    let summary = Summary::read(&out).unwrap();
    assert!(!summary.warnings.contains_key("turbulence_solver"));
}

#[test]
fn eddies_that_the_native_gas_does_not_solve_are_told_of() {
    turbulence_that_does_not_converge(&[]);
}

#[test]
fn eddies_that_openfoam_does_not_solve_are_told_of_over_the_wire() {
    turbulence_that_does_not_converge(&["--gas", "openfoam"]);
}

#[test]
fn eddies_of_a_template_s_own_model_that_openfoam_does_not_solve_are_told_of() {
    let template = Path::new(env!("CARGO_MANIFEST_DIR")).join("of-cases");
    let directory = TempDir::new().unwrap();
    let own = directory.path().join("foam");
    for (from, name) in [
        ("k-epsilon", "constant/turbulenceProperties"),
        ("k-epsilon", "0/k"),
        ("k-epsilon", "0/epsilon"),
        ("k-epsilon", "0/nut"),
        ("k-epsilon", "0/alphat"),
        ("default", "system/fvSolution"),
    ] {
        let file = own.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        let text = fs::read_to_string(template.join(from).join(name)).unwrap();
        let text = text.replace("tolerance       1e-10;", "tolerance 1e-10; maxIter 1;");
        fs::write(file, text).unwrap();
    }
    let text = cases::duct("upwind").replace(r#""0 s", "0.4 kg/h""#, r#""0 s", "6 kg/h""#);
    let case = directory.path().join("duct.toml");
    fs::write(&case, text).unwrap();
    let set = [
        format!("openfoam.template={}", own.display()),
        "time.end=0.05 s".into(),
    ];
    let out = directory.path().join("out");
    let output = program::command(&case, &out, &["--gas", "openfoam"], &set).output();
    let warning = shown(&output.unwrap(), &out, "turbulence_solver");
    assert_eq!(warning.windows, Summary::read(&out).unwrap().windows);
}

/// A film whose source states void fractions that no bed of spheres has.
#[derive(Debug)]
struct Sparse {
    /// True where it has no value outside its range.
    breaks: bool,
}

impl HeatTransfer for Sparse {
    fn name(&self) -> &'static str {
        if self.breaks {
            BREAKS.name
        } else {
            SPARSE.name
        }
    }

    fn nusselt(&self, gas: &LocalGas, diameter: f64) -> f64 {
        if self.breaks {
            f64::NAN
        } else {
            Gunn.nusselt(gas, diameter)
        }
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.0, 0.25),
            ..FlowRange::UNSTATED
        }
    }
}

static SPARSE: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "sparse",
    summary: "Gunn's law, for void fractions up to 0.25 only.",
    source: "none",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Sparse { breaks: false }),
};

static BREAKS: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "breaks",
    summary: "No value outside its range.",
    source: "none",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Sparse { breaks: true }),
};

fn with_film(out: &Path, key: &str, law: &str) -> Simulation {
    let mut laws = LawCatalogue::default();
    laws.heat_transfer.extend([&SPARSE, &BREAKS]);
    Simulation::open(good("reactions"))
        .laws(laws)
        .set(format!("laws.{key}={{ law = \"{law}\" }}"))
        .out(out)
        .start()
        .unwrap()
}

#[test]
fn a_film_outside_its_range_of_void_fractions_is_told_of_with_the_particle() {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let mut simulation = with_film(&out, "mass_transfer", "sparse");
    simulation.step().unwrap();
    simulation.stop().unwrap();
    let summary = simulation.summary().unwrap();
    let warning = &summary.warnings["mass_transfer.void_fraction"];
    assert_eq!((warning.windows, warning.limit), (1, Some(0.25)));
    assert_eq!(warning.count as usize, simulation.particles().len());
    assert!(warning.worst > 0.25 && warning.worst <= 1.0);
    assert!(matches!(warning.place, WarningPlace::Particle(_)));
    assert!(!summary.warnings.contains_key("heat_transfer.void_fraction"));
    report::write(&out).unwrap();
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("mass_transfer.void_fraction"));
}

#[test]
fn a_film_without_a_value_ends_the_run_and_its_failure_is_in_the_summary() {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let mut simulation = with_film(&out, "heat_transfer", "breaks");
    let failure: SimulationError = simulation.step().unwrap_err();
    assert_eq!(failure.exit_code(), exit::DIVERGED);
    let told = Summary::read(&out).unwrap().failure.unwrap();
    assert_eq!(told.code, exit::DIVERGED);
    assert!(
        told.message
            .contains("breaks coefficient of particle 1 is NaN W/K")
    );
    assert!(
        told.message
            .contains("it must be finite and zero or above: look at `warnings`")
    );
    report::write(&out).unwrap();
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("The run ended with exit code 3"));
}

/// Gas that goes round at one temperature, past a speck: what moves of its heat is round-off of 1e-16 J, of which the balance may leave any share.
#[test]
fn round_off_of_heat_that_does_not_move_is_no_open_balance() {
    let directory = TempDir::new().unwrap();
    let out = directory.path().join("out");
    let set = [
        "time.end=0.1 s",
        "time.motion_window=5 ms",
        "output.every=0.1 s",
        "particles[0].diameter=1 um",
    ];
    program::run(
        &good("periodic-channel"),
        &out,
        &["--gas", "openfoam"],
        &set,
    );
    let summary = Summary::read(&out).unwrap();
    assert!(summary.ledger.lines["energy"].relative_error > 0.01);
    assert!(!summary.warnings.contains_key("open_balance"));
}
