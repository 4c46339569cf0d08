//! What a template says that has no effect in calcineGasFoam is refused by name; what says what calcineGasFoam does is not.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::supervisor::{Interrupts, Supervisor};

use crate::openfoam_support::*;

const SOLUTION: &str = include_str!("../../of-cases/default/system/fvSolution");
const SCHEMES: &str = include_str!("../../of-cases/default/system/fvSchemes");

/// Starts the solver with a template of one file.
fn started_with(name: &str, text: &str) -> Result<(), PartError> {
    let folder = tempfile::tempdir().unwrap();
    let template = folder.path().join("template");
    let file = template.join(name);
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(&file, text).unwrap();
    let setup = setup();
    let launch = OpenfoamLaunch {
        setup: &setup,
        mesh: Arc::new(mesh([1, 1, CELLS])),
        template: Some(Path::new(&template)),
        start: None,
        gas: None,
        solver: StockSolver::default(),
        case_hash: "template".into(),
        folder: folder.path().join("case"),
        log: folder.path().join("log"),
        ranks: 1,
        launcher: Launcher::Mpirun,
        resume: None,
        from: None,
        deadline: Duration::from_secs(30),
    };
    let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
    launch.launch(&mut supervisor).map(|_| ())
}

#[track_caller]
fn refused(name: &str, text: &str, told: &str) {
    let error = started_with(name, text).err().unwrap();
    assert_eq!(error.kind, FailureKind::InvalidInput, "{error}");
    let message = error.to_string();
    assert!(message.contains(told), "{message}");
    // Where it stands.
    assert!(
        message.contains(name) && message.contains("line"),
        "{message}"
    );
}

#[test]
fn loops_of_other_solvers_are_refused_with_the_controls_that_take_their_place() {
    for algorithm in ["PIMPLE", "PISO", "SIMPLE"] {
        refused(
            "system/fvSolution",
            &format!("{SOLUTION}\n{algorithm}\n{{\n    nCorrectors 3;\n}}\n"),
            &format!(
                "`{algorithm}` has no effect in calcineGasFoam: remove it, and state outer_iterations, pressure_corrections and \
                 outer_tolerance in `gas.controls` of the case"
            ),
        );
    }
}

#[test]
fn relaxation_factors_are_refused_and_an_empty_dictionary_is_not() {
    let with = |factors: &str| format!("{SOLUTION}\nrelaxationFactors\n{{\n{factors}}}\n");
    refused(
        "system/fvSolution",
        &with("    equations { U 0.7; }\n"),
        "`relaxationFactors` have no effect in calcineGasFoam: remove them",
    );
    started_with("system/fvSolution", &with("")).unwrap();
}

#[test]
fn schemes_of_time_other_than_the_gas_own_are_refused() {
    let with = |entry: &str| SCHEMES.replace("default         Euler;", entry);
    for (entry, named) in [
        ("default backward;", "default backward"),
        (
            "default Euler; ddt(rho,U) CrankNicolson;",
            "ddt(rho,U) CrankNicolson",
        ),
    ] {
        refused(
            "system/fvSchemes",
            &with(entry),
            &format!(
                "`{named}` of ddtSchemes has no effect in calcineGasFoam, which steps in time itself: remove it, and state \
                 `gas.controls.time_scheme` in the case"
            ),
        );
    }
    started_with("system/fvSchemes", &with("default steadyState;")).unwrap();
}
