//! Gas in Debian's OpenFOAM 1912: the solver calcineGasFoam in a case that is generated here.

pub mod case;
pub mod chemistry;
mod columns;
mod decompose;
mod dictionaries;
mod identity;
mod species;
mod start_fields;
pub mod stock;
pub mod turbulence;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::boundary_value::BoundaryValue;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::{
    Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, Part, SolverInfo,
};
use calcine_coupler::setup::{GasPatch, GasSetup};
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::{GasStorage, Window};
use calcine_wire::{Catalogue, Hello, MessageKind};

use crate::launch::{Launcher, Program, find_program};
use crate::solver::{ExternalSolver, Launch, header};
use case::OpenfoamCase;
use columns::{GasRanks, ReceivedGas};
use stock::StockSolver;

/// Name in messages.
const NAME: &str = "OpenFOAM (gas)";
/// Name of the solver's program.
pub const SOLVER: &str = "calcineGasFoam";
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

/// The gas of a running calcineGasFoam.
pub struct OpenfoamGas {
    solver: ExternalSolver,
    about: SolverInfo,
    mesh: Arc<Mesh>,
    storage: GasStorage,
    /// Number of species; zero for a single gas.
    species: usize,
    /// True where it has eddies.
    turbulent: bool,
    /// Which program computes it.
    program: StockSolver,
    /// Conditions of the patches as they were set last.
    patches: Vec<(String, GasPatch)>,
    state: ReceivedGas,
    window: Option<Window>,
}

impl OpenfoamGas {
    /// Writes the case, starts the solver and takes over the state it starts from.
    pub fn launch(
        launch: OpenfoamLaunch<'_>,
        supervisor: &mut Supervisor,
    ) -> Result<Self, PartError> {
        let remedy = "`cargo xtask setup` installs OpenFOAM and builds it";
        let own = find_program(SOLVER_VARIABLE, SOLVER, remedy)?;
        let library = own.with_file_name(LIBRARY);
        let path = if launch.solver.is_stock() {
            stock_program(launch.solver.name())?
        } else {
            own
        };
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
            without_spaces(folder)?;
        }
        case.write(&launch.folder)?;
        let mut arguments: Vec<OsString> = Vec::new();
        if launch.ranks > 1 {
            let patience = launch.deadline + DIVIDING_PER_CELL * launch.mesh.cells() as u32;
            let alone = Supervisor::new(patience, supervisor.interrupts().clone());
            let variables = environment(&launch.folder);
            decompose::run(&launch.folder, launch.ranks, &variables, &alone)?;
            arguments.push("-parallel".into());
        }
        for (option, folder) in given {
            let Some(folder) = folder else { continue };
            let folder = std::path::absolute(folder).map_err(|error| {
                let message = format!("the checkpoint {} cannot be used", folder.display());
                PartError::new(NAME, FailureKind::Io, message).caused_by(error)
            })?;
            arguments.extend([option.into(), folder.into()]);
        }
        let species = launch.setup.properties.species().len();
        let turbulent = !launch.setup.turbulence.is_laminar();
        let hello = Hello {
            role: "gas".into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            mesh_hash: identity::mesh_hash(&launch.mesh),
            case_hash: launch.case_hash,
            count: launch.mesh.cells() as u64,
            ranks: launch.ranks,
            catalogue: Catalogue::gas(species, turbulent).map_err(|error| {
                PartError::new(NAME, FailureKind::NotStarted, "its columns").caused_by(error)
            })?,
        };
        let program = Program {
            path,
            arguments,
            environment: environment(&launch.folder),
            directory: launch.folder,
        };
        let solver = ExternalSolver::launch(
            Launch {
                name: NAME.into(),
                program,
                launcher: launch.launcher,
                log: launch.log,
                hello,
                handshake: launch.deadline,
                deadline: launch.deadline,
            },
            supervisor,
        )?;
        let about = SolverInfo {
            name: solver.hello().name.clone(),
            version: solver.hello().version.clone(),
            ranks: launch.ranks as usize,
        };
        let mut gas = Self {
            solver,
            about,
            mesh: launch.mesh,
            storage: launch.setup.storage,
            species,
            turbulent,
            program: launch.solver,
            patches: launch.setup.patches.clone(),
            state: ReceivedGas::default(),
            window: None,
        };
        gas.read_state(None)?;
        Ok(gas)
    }

    /// Process id of the solver.
    pub fn pid(&self) -> u32 {
        self.solver.pid()
    }

    /// Process ids of the ranks.
    pub fn rank_pids(&self) -> &[u32] {
        self.solver.rank_pids()
    }

    /// Takes the state out of the messages that the links hold.
    fn read_state(&mut self, window: Option<&Window>) -> Result<(), PartError> {
        let ranks = ranks(&self.solver, &self.mesh);
        let read = self.state.read(ranks, self.species, self.turbulent);
        read.map_err(|error| self.solver.failure(window, error))
    }
}

/// A program of Debian's OpenFOAM, on the path.
fn stock_program(name: &str) -> Result<PathBuf, PartError> {
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
fn without_spaces(folder: &Path) -> Result<(), PartError> {
    let text = folder.to_string_lossy();
    if !text.contains([' ', '\t', '"', '\'']) {
        return Ok(());
    }
    let message = format!(
        "OpenFOAM cannot work in {}, whose path has a space or a quote: choose a results folder \
         without, with `--out`",
        folder.display()
    );
    Err(PartError::new(NAME, FailureKind::NotStarted, message))
}

fn ranks<'a>(solver: &'a ExternalSolver, mesh: &Mesh) -> GasRanks<'a> {
    GasRanks {
        links: solver.links(),
        owned: solver.owned(),
        cells: mesh.cells(),
    }
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

impl Part for OpenfoamGas {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.solver.commit()
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.solver.checkpoint(directory)?;
        self.read_state(None)
    }

    fn processor_time(&self) -> Duration {
        self.solver.processor_time()
    }

    fn finish_run(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        let _ = supervisor;
        self.solver.goodbye()
    }
}

impl Gas for OpenfoamGas {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        let refused = |message: String| PartError::new(NAME, FailureKind::Refused, message);
        if self.program.is_stock() {
            return Err(refused(format!(
                "a stock solver takes its conditions from its own case: `{value}` cannot be set while it runs"
            )));
        }
        let set = value.apply(&mut self.patches);
        set.map_err(|error| refused(error.to_string()).caused_by(error))?;
        self.solver.set_boundary(&value.line())
    }

    fn fields(&self) -> GasFields<'_> {
        self.state.fields()
    }

    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError> {
        let cells = self.mesh.cells();
        for (field, found) in [
            ("void fraction", bed.void_fraction.len()),
            ("drag coefficient", exchange.drag_coefficient.len()),
            ("drag source", exchange.drag_source.len()),
            ("heat coefficient", exchange.heat_coefficient.len()),
            ("heat source", exchange.heat_source.len()),
        ] {
            if found != cells {
                let message = format!("the {field} has {found} values for {cells} cells");
                return Err(self.solver.refuse(Some(window), message));
            }
        }
        let mut request = header(MessageKind::Start, window);
        request.storage_span = match self.storage {
            GasStorage::Process => request.span_process,
            GasStorage::Accelerated => request.span_motion,
        };
        self.window = Some(*window);
        let owned = Arc::clone(self.solver.owned());
        let species = self.species;
        self.solver.send_columns(
            window,
            request,
            |rank| owned[rank].len(),
            |rank, link| columns::write(link, &owned[rank], bed, exchange, species),
        )
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError> {
        let Some(window) = self.window.take() else {
            return Err(self.solver.refuse(None, "finished without a start".into()));
        };
        self.solver
            .wait(supervisor, &window, MessageKind::Finished)
            .map_err(|mut error| {
                if error.message.starts_with("diverged") {
                    error.kind = FailureKind::Diverged;
                }
                error
            })?;
        let convergence = columns::read(ranks(&self.solver, &self.mesh), received);
        let convergence = convergence.map_err(|error| self.solver.failure(Some(&window), error))?;
        self.read_state(Some(&window))?;
        Ok(convergence)
    }
}
