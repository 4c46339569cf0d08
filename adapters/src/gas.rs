//! The gas of a solver at the other end of links, whichever it is.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::boundary_value::BoundaryValue;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::gas_columns::GasColumns;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::{
    Backflow, Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, Part, SolverInfo,
};
use calcine_coupler::setup::{GasPatch, GasSetup};
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::{GasStorage, Window};
use calcine_wire::{Link, MessageKind, WireError};

use crate::answer::{self, WrongAnswer};
use crate::gas_columns::{self as columns, GasRanks};
use crate::solver::{ExternalSolver, header};

/// The gas of a running solver.
pub struct LinkedGas {
    solver: ExternalSolver,
    about: SolverInfo,
    mesh: Arc<Mesh>,
    storage: GasStorage,
    /// Number of species; zero for a single gas.
    species: usize,
    /// True where it is turbulent.
    turbulent: bool,
    /// True where conditions of patches can be set while it runs.
    takes_conditions: bool,
    /// Conditions of the patches as they were set last.
    patches: Vec<(String, GasPatch)>,
    state: GasColumns,
    /// What the last commit left unconverged of the equations of turbulence.
    turbulence_residual: Option<f64>,
    /// Of the last attempt.
    backflow: Option<Backflow>,
    window: Option<Window>,
}

impl LinkedGas {
    /// The gas of a solver that has shaken hands: takes over the state it starts from.
    pub(crate) fn new(
        solver: ExternalSolver,
        setup: &GasSetup,
        mesh: Arc<Mesh>,
        takes_conditions: bool,
    ) -> Result<Self, PartError> {
        let hello = solver.hello();
        let mut gas = Self {
            about: SolverInfo {
                name: hello.name.clone(),
                version: hello.version.clone(),
                ranks: hello.ranks as usize,
            },
            solver,
            mesh,
            storage: setup.storage,
            species: setup.properties.species().len(),
            turbulent: !setup.turbulence.is_laminar(),
            takes_conditions,
            patches: setup.patches.clone(),
            state: GasColumns::default(),
            turbulence_residual: None,
            backflow: None,
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
        for (link, cells) in self.solver.links().iter().zip(self.solver.owned().iter()) {
            let wrong = wrong_answer(link, cells, window);
            let wrong = wrong.map_err(|error| self.solver.failure(window, error))?;
            if let Some(wrong) = wrong {
                return Err(self.solver.wrong(window, wrong));
            }
        }
        let ranks = ranks(&self.solver, &self.mesh);
        let read = columns::read_state(ranks, self.species, self.turbulent, &mut self.state);
        read.map_err(|error| self.solver.failure(window, error))
    }
}

/// What is wrong with the state that a rank has sent.
fn wrong_answer(
    link: &Link,
    cells: &[usize],
    window: Option<&Window>,
) -> Result<Option<WrongAnswer>, WireError> {
    if let Some(window) = window
        && let Some(wrong) = answer::of_another_attempt(link, window)?
    {
        return Ok(Some(wrong));
    }
    if let Some(wrong) = answer::of_another_length(link, cells.len())? {
        return Ok(Some(wrong));
    }
    answer::not_finite(link, |row| format!("cell {}", cells[row]))
}

fn ranks<'a>(solver: &'a ExternalSolver, mesh: &Mesh) -> GasRanks<'a> {
    GasRanks {
        links: solver.links(),
        owned: solver.owned(),
        cells: mesh.cells(),
    }
}

impl Part for LinkedGas {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        if self.solver.commit()? {
            let residual = columns::turbulence_residual(self.solver.links());
            self.turbulence_residual =
                residual.map_err(|error| self.solver.failure(None, error))?;
        }
        Ok(())
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

impl Gas for LinkedGas {
    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        let name = &self.about.name;
        let refused = |message: String| PartError::new(name, FailureKind::Refused, message);
        if !self.takes_conditions {
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

    fn backflow(&self) -> Option<Backflow> {
        self.backflow
    }

    fn begins_again(&self) -> bool {
        // A solver of its own process has ended by then.
        false
    }

    fn turbulence_residual(&self) -> Option<f64> {
        self.turbulence_residual
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
        let eddies = &exchange.eddies;
        for list in [&eddies.energy, &eddies.dissipation, &eddies.growth] {
            let found = list.len();
            if found != cells && found != 0 {
                let message =
                    format!("what particles make of eddies has {found} values for {cells} cells");
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
            .wait(supervisor, &window, MessageKind::Finished)?;
        self.read_state(Some(&window))?;
        let convergence = columns::read(ranks(&self.solver, &self.mesh), received);
        let convergence = convergence.map_err(|error| self.solver.failure(Some(&window), error))?;
        let backflow = columns::backflow(self.solver.links());
        self.backflow = backflow.map_err(|error| self.solver.failure(Some(&window), error))?;
        Ok(convergence)
    }
}
