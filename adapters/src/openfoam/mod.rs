//! Gas and parcels in Debian's OpenFOAM 1912: the solvers calcineGasFoam and calcineParcelFoam ([`parcels`]) in cases that are
//! generated here.

pub mod case;
pub mod chemistry;
mod decompose;
mod dictionaries;
mod dictionary;
mod foam_file;
mod identity;
mod names;
mod parcel_case;
pub mod parcels;
mod species;
mod start_fields;
pub mod stock;
pub mod template;
pub mod turbulence;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::{GasSetup, GasStart};
use calcine_coupler::supervisor::Supervisor;
use calcine_wire::Hello;
use calcine_wire::hello::NEW;

use crate::checkpoint;
use crate::find::find_program;
use crate::gas::LinkedGas;
use crate::launch::{Launcher, Program};
use crate::solver::{ExternalSolver, Launch};
use case::OpenfoamCase;
use names::NAME;
pub use names::SOLVER;
pub use parcel_case::ParcelCase;
use stock::StockSolver;

/// The library with Calcine's fvOption, beside it.
pub const LIBRARY: &str = "libcalcineFoam.so";
/// The variable that names another solver program.
pub const SOLVER_VARIABLE: &str = "CALCINE_GASFOAM";
/// How much longer than the deadline the division of a mesh may take, for each cell: twice what it was seen
/// to take.
const DIVIDING_PER_CELL: Duration = Duration::from_micros(60);
/// Where Debian's OpenFOAM has its `etc`.
const PROJECT: &str = "/usr/share/openfoam";

/// What OpenFOAM is started with.
#[derive(Clone, Debug)]
pub struct OpenfoamLaunch<'a> {
    /// The gas.
    pub setup: &'a GasSetup,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// A folder whose files are taken over where the case does not speak.
    pub template: Option<&'a Path>,
    /// A time directory that OpenFOAM wrote, whose fields the gas starts from.
    pub start: Option<&'a Path>,
    /// Fields of a gas of another solver that the gas starts from, in place of the directory's.
    pub gas: Option<&'a GasStart>,
    /// Which program computes the gas.
    pub solver: StockSolver,
    /// Hash of the case.
    pub case_hash: String,
    /// Where the OpenFOAM case is written and the solver runs.
    pub folder: PathBuf,
    /// Where the solver's output goes.
    pub log: PathBuf,
    /// Number of ranks; more than one work on a decomposed case.
    pub ranks: u32,
    /// Who starts them.
    pub launcher: Launcher,
    /// The gas' folder of the checkpoint to start from.
    pub resume: Option<PathBuf>,
    /// The gas' folder of another run's checkpoint to continue from.
    pub from: Option<PathBuf>,
    /// Longest silence while starting, writing a checkpoint or ending.
    pub deadline: Duration,
}

impl OpenfoamLaunch<'_> {
    /// Writes the case, starts the solver and takes over the state it starts from.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedGas, PartError> {
        let launch = self;
        let (path, own) = find(launch.solver)?;
        let library = own.with_file_name(LIBRARY);
        if launch.solver.is_stock() && launch.ranks > 1 {
            let message = "a stock solver is coupled on one rank only: leave `openfoam.ranks` out";
            return Err(PartError::new(NAME, FailureKind::NotStarted, message));
        }
        if launch.solver.is_stock() && (launch.resume.is_some() || launch.from.is_some()) {
            let message = "a stock solver takes up no checkpoint; its checkpoint is a time directory, \
                           which `openfoam.start` takes as a start";
            return Err(PartError::new(NAME, FailureKind::NotStarted, message));
        }
        let case = OpenfoamCase {
            setup: launch.setup,
            mesh: &launch.mesh,
            template: launch.template,
            start: launch.start,
            gas: launch.gas,
            solver: launch.solver,
            library: &library,
            case_hash: &launch.case_hash,
            ranks: launch.ranks,
        };
        let given = [("-resume", &launch.resume), ("-from", &launch.from)];
        for folder in [
            Some(&launch.folder),
            launch.resume.as_ref(),
            launch.from.as_ref(),
        ]
        .into_iter()
        .flatten()
        {
            without_spaces(NAME, folder)?;
        }
        case.write(&launch.folder)?;
        let catalogue = case.catalogue();
        let mut arguments: Vec<OsString> = Vec::new();
        if launch.ranks > 1 {
            let patience = launch.deadline + DIVIDING_PER_CELL * launch.mesh.cells() as u32;
            let alone = Supervisor::new(patience, supervisor.interrupts().clone());
            let variables = environment(&launch.folder);
            decompose::run(&launch.folder, launch.ranks, &variables, &alone)?;
            arguments.push("-parallel".into());
        }
        let mut origin = NEW.to_owned();
        for (option, folder) in given {
            let Some(folder) = folder else { continue };
            let folder = checkpoint::absolute(NAME, folder)?;
            origin = folder.to_string_lossy().into_owned();
            arguments.extend([option.into(), folder.into()]);
        }
        let hello = Hello {
            role: "gas".into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            mesh_hash: identity::mesh_hash(&launch.mesh),
            origin,
            case_hash: launch.case_hash,
            count: launch.mesh.cells() as u64,
            ranks: launch.ranks,
            catalogue,
        };
        let program = Program {
            path,
            arguments,
            environment: environment(&launch.folder),
            directory: launch.folder,
        };
        let solver = ExternalSolver::launch(
            Launch::of_own(
                NAME,
                program,
                launch.launcher,
                launch.log,
                hello,
                launch.deadline,
            ),
            supervisor,
        )?;
        LinkedGas::new(solver, launch.setup, launch.mesh, !launch.solver.is_stock())
    }
}

/// The program of a solver, and calcineGasFoam, beside which the coupling's library lies.
pub fn find(solver: StockSolver) -> Result<(PathBuf, PathBuf), PartError> {
    let own = find_program(SOLVER_VARIABLE, SOLVER)?;
    let path = match solver.is_stock() {
        true => stock_program(&own, solver.name())?,
        false => own.clone(),
    };
    Ok((path, own))
}

/// A program of OpenFOAM: the one that was built with Calcine's own, because Debian's is wrong (adapters/openfoam/build.sh), else on
/// the path.
fn stock_program(own: &Path, name: &str) -> Result<PathBuf, PartError> {
    let beside = own.with_file_name(name);
    if beside.is_file() {
        return Ok(beside);
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|program| program.is_file());
    found.ok_or_else(|| {
        let message = format!(
            "{name} is nowhere on the PATH; it comes with Debian's package openfoam, which `cargo xtask \
             setup` installs"
        );
        PartError::new(NAME, FailureKind::NotStarted, message)
    })
}

/// OpenFOAM takes no path with a space or a quote in it.
fn without_spaces(name: &str, folder: &Path) -> Result<(), PartError> {
    let text = folder.to_string_lossy();
    if !text.contains([' ', '\t', '"', '\'']) {
        return Ok(());
    }
    let message = format!(
        "OpenFOAM cannot work in {}, whose path has a space or a quote: choose a results folder \
         without, with `--out`",
        folder.display()
    );
    Err(PartError::new(name, FailureKind::NotStarted, message))
}

/// OpenFOAM compares PWD with the folder it runs in, and looks for its `etc` where WM_PROJECT_DIR
/// says: Debian's, unless the user has set both another solver and its OpenFOAM.
fn environment(folder: &Path) -> Vec<(OsString, OsString)> {
    let mut variables = vec![("PWD".into(), folder.into())];
    let own = [SOLVER_VARIABLE, "WM_PROJECT_DIR"];
    if own.iter().any(|name| std::env::var_os(name).is_none()) {
        variables.push(("WM_PROJECT_DIR".into(), PROJECT.into()));
    }
    variables
}
