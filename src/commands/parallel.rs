//! How external solvers are started: ranks, launchers, by hand.

use std::sync::Arc;

use calcine_adapters::launch::{Launcher, Spawner};
use calcine_wire::SolverNetwork;
use clap::{Args, ValueEnum};

use super::failure::Failure;
use crate::assembly::{GasBackend, Pairing, ParticleBackend, SolverStart, SolverStarts};
use crate::exit;

/// What carries messages between Calcine and external solvers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Transport {
    /// Shared memory of this machine.
    #[default]
    SharedMemory,
    /// MPI, also between machines; the program `calcine-mpi` runs in place of the command.
    Mpi,
}

impl Transport {
    /// The name as users write it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Transport::SharedMemory => "shared-memory",
            Transport::Mpi => "mpi",
        }
    }
}

/// Options of external solvers.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct Parallel {
    /// MPI ranks of an external gas solver [default: that of the case, or 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    ranks_gas: Option<u16>,
    /// MPI ranks of an external particle solver [default: that of the case, or 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    ranks_particles: Option<u16>,
    /// What carries messages between Calcine and external solvers.
    #[arg(long, value_enum, default_value_t)]
    transport: Transport,
    /// Launcher of an external gas solver's ranks in place of `mpirun`, for example "srun -n 16"; give
    /// the same number with `--ranks-gas`.
    #[arg(long, value_name = "WORDS", value_parser = Launcher::parse)]
    launch_gas: Option<Launcher>,
    /// Launcher of an external particle solver's ranks in place of `mpirun`; give the same number with
    /// `--ranks-particles`.
    #[arg(long, value_name = "WORDS", value_parser = Launcher::parse)]
    launch_particles: Option<Launcher>,
    /// Prints the commands that start the solvers by hand, for debuggers and queues, and waits for
    /// them; messages go through shared memory.
    #[arg(long, conflicts_with_all = ["launch_gas", "launch_particles"])]
    attach: bool,
}

impl Parallel {
    /// What carries the messages of a pairing's solvers.
    pub(super) fn transport(&self) -> Transport {
        self.transport
    }

    /// The first option that was given, if any was.
    pub(super) fn given(&self) -> Option<&'static str> {
        let options = [
            ("--ranks-gas", self.ranks_gas.is_some()),
            ("--ranks-particles", self.ranks_particles.is_some()),
            ("--transport", self.transport != Transport::default()),
            ("--launch-gas", self.launch_gas.is_some()),
            ("--launch-particles", self.launch_particles.is_some()),
            ("--attach", self.attach),
        ];
        options
            .iter()
            .find(|(_, given)| *given)
            .map(|(name, _)| *name)
    }

    /// What was asked for; an option for a solver that does not take part is refused.
    pub(super) fn starts(
        &self,
        pairing: Pairing,
        case: &SolverStarts,
        network: Option<&Arc<dyn SolverNetwork>>,
    ) -> Result<SolverStarts, Failure> {
        let gas = pairing.gas != GasBackend::Native;
        let particles = pairing.particles != ParticleBackend::Native;
        for (option, given, taken, remedy) in [
            (
                "--ranks-gas",
                self.ranks_gas.is_some(),
                gas,
                "--gas openfoam",
            ),
            (
                "--launch-gas",
                self.launch_gas.is_some(),
                gas,
                "--gas openfoam",
            ),
            (
                "--ranks-particles",
                self.ranks_particles.is_some(),
                particles,
                "--particles liggghts",
            ),
            (
                "--launch-particles",
                self.launch_particles.is_some(),
                particles,
                "--particles liggghts",
            ),
            (
                "--attach",
                self.attach,
                gas || particles,
                "--gas openfoam or --particles liggghts",
            ),
        ] {
            if given && !taken {
                let message = format!(
                    "`{option}` is for an external solver: add `{remedy}`, or leave it out \
                     (native solvers use threads, `--threads`)"
                );
                return Err(Failure::new(exit::CASE, message));
            }
        }
        let own = self.launch_gas.is_some() || self.launch_particles.is_some() || self.attach;
        let network = network.filter(|_| self.transport == Transport::Mpi);
        if own && self.transport == Transport::Mpi {
            let message = "over MPI Calcine spawns the ranks itself, where MPI's own settings say; \
                           leave out --launch-gas, --launch-particles and --attach, or take \
                           --transport shared-memory";
            return Err(Failure::new(exit::CASE, message));
        }
        let start =
            |ranks: Option<u16>, case: &SolverStart, launcher: &Option<Launcher>| SolverStart {
                ranks: ranks.map_or(case.ranks, u32::from),
                launcher: match (launcher, network) {
                    (Some(launcher), _) => launcher.clone(),
                    (None, Some(network)) => Launcher::Network(Spawner(Arc::clone(network))),
                    (None, None) if self.attach => Launcher::Hand,
                    (None, None) => Launcher::Mpirun,
                },
            };
        Ok(SolverStarts {
            gas: start(self.ranks_gas, &case.gas, &self.launch_gas),
            particles: start(
                self.ranks_particles,
                &case.particles,
                &self.launch_particles,
            ),
        })
    }
}

/// A warning where Calcine starts more ranks on this machine than it has cores.
pub(super) fn crowded(starts: &SolverStarts, pairing: Pairing) -> Option<String> {
    let external = [
        (pairing.gas != GasBackend::Native, &starts.gas),
        (
            pairing.particles != ParticleBackend::Native,
            &starts.particles,
        ),
    ];
    let here = |launcher: &Launcher| matches!(launcher, Launcher::Mpirun | Launcher::Hand);
    let started = external
        .iter()
        .filter(|(external, start)| *external && here(&start.launcher));
    let ranks = started.map(|(_, start)| start.ranks).max()?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    (ranks as usize > cores).then(|| {
        format!(
            "{ranks} ranks on a machine of {cores} cores: ranks that wait for each other take turns, and a window may take hundreds of times \
             longer; start {cores} at most (`--ranks-gas`, `--ranks-particles`, or `ranks` of the case), or name a launcher of other \
             machines (`--launch-gas`, `--launch-particles`)"
        )
    })
}

/// The options that a run was started with, word by word.
pub(super) fn flags(starts: &SolverStarts) -> Vec<String> {
    let mut words = Vec::new();
    for (name, start) in [("gas", &starts.gas), ("particles", &starts.particles)] {
        if start.ranks > 1 {
            words.extend([format!("--ranks-{name}"), start.ranks.to_string()]);
        }
        if let Launcher::Own(launcher) = &start.launcher {
            words.extend([format!("--launch-{name}"), launcher.join(" ")]);
        }
    }
    let both = [&starts.gas, &starts.particles];
    if both.iter().any(|start| start.launcher == Launcher::Hand) {
        words.push("--attach".into());
    }
    let spawned = |start: &&&SolverStart| matches!(start.launcher, Launcher::Network(_));
    if both.iter().any(|start| spawned(&start)) {
        words.extend(["--transport".into(), "mpi".into()]);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        parallel: Parallel,
    }

    fn starts(words: &[&str], pairing: &str) -> Result<SolverStarts, String> {
        let words = ["calcine"].iter().chain(words);
        let line = Line::try_parse_from(words).map_err(|error| error.to_string())?;
        let pairing = Pairing::parse(pairing).unwrap();
        line.parallel
            .starts(pairing, &SolverStarts::default(), None)
            .map_err(|failure| failure.message)
    }

    #[test]
    fn ranks_and_launchers_are_read_and_told_again() {
        let words = ["--ranks-gas", "16", "--launch-gas", "srun -n 16"];
        let read = starts(&words, "openfoam+native").unwrap();
        assert_eq!(read.gas.ranks, 16);
        assert_eq!(flags(&read), words);
        assert!(flags(&starts(&[], "native+native").unwrap()).is_empty());
    }

    #[test]
    fn more_ranks_than_cores_are_told_unless_another_machine_has_them() {
        let told = |words: &[&str], pairing: &str| {
            crowded(
                &starts(words, pairing).unwrap(),
                Pairing::parse(pairing).unwrap(),
            )
        };
        let many = ["--ranks-gas", "60000"];
        let text = told(&many, "openfoam+native").unwrap();
        assert!(text.starts_with("60000 ranks on a machine of "), "{text}");
        assert_eq!(told(&["--ranks-gas", "1"], "openfoam+native"), None);
        let elsewhere = [&many[..], &["--launch-gas", "srun -n 60000"]].concat();
        assert_eq!(told(&elsewhere, "openfoam+native"), None);
        assert_eq!(told(&[], "native+native"), None);
    }

    #[test]
    fn an_option_for_a_solver_that_does_not_take_part_is_refused() {
        let error = starts(&["--ranks-gas", "2"], "native+liggghts").unwrap_err();
        assert!(error.contains("add `--gas openfoam`"), "{error}");
        assert!(starts(&["--attach"], "native+native").is_err());
        assert!(starts(&["--ranks-gas", "0"], "openfoam+native").is_err());
    }
}
