//! How a simulation is begun.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_coupler::coordinator::{CheckpointPaths, Ending};
use calcine_coupler::interior::ParticleModel;
use calcine_coupler::observer::Observer;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use tracing::dispatcher::with_default;
use tracing::{info, warn};

use super::{Simulation, SimulationError, folder};
use crate::assembly::{
    self, GasBackend, Pairing, ParticleBackend, PreparedCase, SolverStarts, assemble_with,
};
use crate::case::buoyancy;
use crate::case::model::Case;
use crate::laws::LawCatalogue;
use crate::results::{self, Recorder, RunInfo, files};
use crate::valid::ValidCase;

/// A simulation that is not begun yet: the case, and how it is to be run.
#[derive(Clone, Debug)]
pub struct SimulationBuilder {
    case: PathBuf,
    set: Vec<String>,
    laws: LawCatalogue,
    pairing: Pairing,
    starts: Option<SolverStarts>,
    transport: String,
    out: Option<PathBuf>,
    resume: bool,
    from: Option<PathBuf>,
    interrupts: Interrupts,
    models: Vec<GivenModel>,
    /// The text of `command.json`, for a run that begins.
    command: Option<String>,
}

/// A model of particles that the case file does not know, and the material that it is for.
#[derive(Clone)]
struct GivenModel {
    material: String,
    make: Arc<MakeModel>,
}

/// Makes a model without particles, with what it needs to know of the case.
type MakeModel = dyn Fn(&Case) -> Box<dyn ParticleModel> + Send + Sync;

impl std::fmt::Debug for GivenModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a model of particles of {}", self.material)
    }
}

impl Simulation {
    /// Begins with a case file; nothing is read before [`SimulationBuilder::start`].
    pub fn open(case: impl Into<PathBuf>) -> SimulationBuilder {
        SimulationBuilder::new(case.into())
    }
}

impl SimulationBuilder {
    pub(super) fn new(case: PathBuf) -> Self {
        Self {
            case,
            set: Vec::new(),
            laws: LawCatalogue::default(),
            pairing: Pairing::default(),
            starts: None,
            transport: "shared-memory".into(),
            out: None,
            resume: false,
            from: None,
            interrupts: Interrupts::default(),
            models: Vec::new(),
            command: None,
        }
    }

    /// Changes a key of the case, as `--set KEY=VALUE` does.
    #[must_use]
    pub fn set(mut self, assignment: impl Into<String>) -> Self {
        self.set.push(assignment.into());
        self
    }

    /// The laws that the case may choose among; Calcine's own unless told.
    #[must_use]
    pub fn laws(mut self, laws: LawCatalogue) -> Self {
        self.laws = laws;
        self
    }

    /// Who computes the gas; the native solver unless told.
    #[must_use]
    pub fn gas(mut self, gas: GasBackend) -> Self {
        self.pairing.gas = gas;
        self
    }

    /// Who computes the particles; the native solver unless told.
    #[must_use]
    pub fn particles(mut self, particles: ParticleBackend) -> Self {
        self.pairing.particles = particles;
        self
    }

    /// How external solvers are started, and what carries their messages (`shared-memory` or `mpi`); as the case
    /// says over shared memory unless told.
    #[must_use]
    pub fn starts(mut self, starts: SolverStarts, transport: &str) -> Self {
        self.starts = Some(starts);
        self.transport = transport.to_owned();
        self
    }

    /// The results folder; `results/NAME` below the working directory unless told.
    #[must_use]
    pub fn out(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out = Some(folder.into());
        self
    }

    /// Goes on from the last checkpoint in the results folder, or begins again where a run ended before its first
    /// one.
    #[must_use]
    pub fn resume(mut self, resume: bool) -> Self {
        self.resume = resume;
        self
    }

    /// Continues from the last checkpoint of another run on the same mesh, with clocks that start at
    /// zero.
    #[must_use]
    pub fn from(mut self, folder: impl Into<PathBuf>) -> Self {
        self.from = Some(folder.into());
        self
    }

    /// Interrupts that may be raised from elsewhere while solvers start; else [`Simulation::interrupts`] gives them.
    #[must_use]
    pub fn interrupts(mut self, interrupts: Interrupts) -> Self {
        self.interrupts = interrupts;
        self
    }

    /// Has the command of a run that begins kept in its folder from the first moment on, as JSON.
    pub(crate) fn command(mut self, text: Option<String>) -> Self {
        self.command = text;
        self
    }

    /// Computes the inside of the particles of a material by a model of one's own, without particles as it is made;
    /// it takes the place of the case's. Columns that it shows come to the results by `output.particles = ["inside"]`.
    #[must_use]
    pub fn model(
        mut self,
        material: impl Into<String>,
        make: impl Fn(&Case) -> Box<dyn ParticleModel> + Send + Sync + 'static,
    ) -> Self {
        self.models.push(GivenModel {
            material: material.into(),
            make: Arc::new(make),
        });
        self
    }

    /// Checks the case as a run would, and makes nothing: its clocks, sizes and the flow in words, as `calcine check` tells them.
    pub fn check(&self) -> Result<String, SimulationError> {
        let mut valid = ValidCase::open_with(&self.case, &self.set, &self.laws)?;
        valid.honoured_by(self.pairing)?;
        valid.warn_of(self.pairing);
        Ok(valid.report())
    }

    /// Reads and checks the case, makes mesh and particles, starts the solvers, and stands before the first window.
    pub fn start(self) -> Result<Simulation, SimulationError> {
        let mut valid = ValidCase::open_with(&self.case, &self.set, &self.laws)?;
        valid.warn_of(self.pairing);
        self.start_prepared(&valid.case, &valid.prepared, Vec::new())
    }

    /// The same with what was made of the case before, and observers that see the run from its start.
    pub(crate) fn start_prepared(
        self,
        case: &Case,
        prepared: &PreparedCase,
        mut observers: Vec<Box<dyn Observer + Send>>,
    ) -> Result<Simulation, SimulationError> {
        let out = results_folder(case, self.out.as_deref());
        if self.resume && folder::finished(&out).is_some() {
            return Err(SimulationError::Over(Ending::Finished));
        }
        let resume = self.resume && folder::has_checkpoint(&out);
        let again = self.resume && !resume;
        if again && !(folder::begun_before(&out) && results::may_start_again(&out, case)?) {
            return Err(SimulationError::NoCheckpoint { folder: out });
        }
        if resume {
            folder::same_solvers(&out, self.pairing)?;
        }
        let begun_from = folder::begun_from(self.from.as_deref(), again, &out);
        let begun_from = begun_from.filter(|_| !resume);
        let continued = begun_from.map(|from| folder::origin(&from, self.pairing));
        let (origin, provenance) = continued.transpose()?.unzip();
        let claimed = folder::claim(&out, self.resume)?;
        if let Some(text) = self.command.filter(|_| !self.resume) {
            files::replace(&out.join(files::COMMAND), text.as_bytes())?;
        }
        if again {
            results::clear_start(&out)?;
        }
        let recovered = match resume {
            true => folder::recover(&out)?,
            false => None,
        };
        let damage = origin.as_ref().and_then(|origin| origin.damage.as_ref());
        let older =
            damage.map(|what| format!("{what}; this run begins from the checkpoint before it"));
        let start = again.then(|| {
            format!(
                "there is no checkpoint in {}: the run begins again from its start",
                out.display()
            )
        });
        let notes: Vec<String> = recovered.into_iter().chain(older).chain(start).collect();
        let checkpoint = CheckpointPaths::new(&out).committed();
        let info = RunInfo {
            gas: self.pairing.gas.name().into(),
            particles: self.pairing.particles.name().into(),
            transport: match self.pairing.is_native() {
                true => "none".into(),
                false => self.transport,
            },
            from: provenance,
        };
        let from = resume.then_some(checkpoint.as_path());
        let mut recorder = Recorder::create(case, info, &out, from)?;
        let log = folder::log(&out)?;
        let starts = self
            .starts
            .unwrap_or_else(|| SolverStarts::of(case, self.pairing));
        let settings = assembly::RunSettings {
            pairing: self.pairing,
            starts: &starts,
            results: &out,
            resume,
            from: origin.as_ref(),
        };
        let mut supervisor = Supervisor::new(case.coupling.deadline, self.interrupts);
        let begun = with_default(&log, || {
            info!(case = %case.name, pairing = %self.pairing.name(), resume, "start");
            for note in &notes {
                warn!("{note}");
            }
            let own = |material: &str| {
                let given = self.models.iter().rev();
                let found = given.into_iter().find(|one| one.material == material);
                found.map(|one| (one.make)(case))
            };
            let mut run = assemble_with(case, prepared, &settings, &mut supervisor, &own)?;
            let number = buoyancy::number(case, &prepared.mesh);
            info!("N sqrt(AF) dt is {number:.2e}");
            for warning in &case.warnings {
                warn!("{warning}");
            }
            run.begin(&mut super::all(&mut recorder, &mut observers))?;
            Ok::<_, SimulationError>(run)
        });
        let run = match begun {
            Ok(run) => run,
            Err(failure) => {
                if claimed.has_solver_log() {
                    claimed.keep();
                }
                return Err(failure);
            }
        };
        Ok(Simulation {
            run,
            supervisor,
            recorder,
            observers,
            case: case.clone(),
            out,
            log,
            notes,
            ending: None,
            failed: false,
            _lock: claimed.keep(),
        })
    }
}

/// The results folder: as asked for, or `results/NAME` below the working directory.
pub(crate) fn results_folder(case: &Case, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| PathBuf::from("results").join(&case.name), Path::to_owned)
}
