//! `calcine doctor`: what of the machine Calcine can use, and what installs the rest.
//!
//! It looks, it starts no solver, and it works where none is installed.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use calcine_adapters::find::{NotFound, REMEDY, look_for};
use calcine_adapters::{liggghts, openfoam};

/// The program that spawns solvers by MPI.
pub(super) const MPI_PROGRAM: &str = "calcine-mpi";
/// The variable that names another one.
pub(super) const MPI_VARIABLE: &str = "CALCINE_MPI";

/// Free shared memory in bytes below which a coupled run may not start: Docker gives a
/// container 64 MB in all.
const LITTLE_MEMORY: u64 = 64 << 20;

/// What was found on this machine. [`fmt::Display`] shows it to the user.
#[derive(Clone, Debug, Default)]
pub struct DoctorReport {
    /// Name of the system.
    pub system: Option<String>,
    /// Processors that this process may use.
    pub processors: usize,
    /// Version of the HDF5 library in use; `None` if this binary was built without.
    pub hdf5: Option<String>,
    /// `mpirun` and its version.
    pub mpi: Option<String>,
    /// Version of Debian's package openfoam.
    pub openfoam: Option<String>,
    /// Our solver on OpenFOAM.
    pub openfoam_adapter: Adapter,
    /// Our host of OpenFOAM's cloud of parcels.
    pub parcel_adapter: Adapter,
    /// Version of Debian's LIGGGHTS library.
    pub liggghts: Option<String>,
    /// Our host of LIGGGHTS.
    pub liggghts_adapter: Adapter,
    /// The program that spawns solvers by MPI.
    pub mpi_adapter: Adapter,
    /// Free and total bytes of /dev/shm.
    pub shared_memory: Option<(u64, u64)>,
}

/// A program that stands between Calcine and a solver.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Adapter {
    /// Not built, or not where Calcine looks for it.
    #[default]
    Missing,
    /// The variable that names it names no file: in words, with the remedy.
    Misnamed(String),
    /// There, but these shared libraries of its are not.
    Broken(PathBuf, Vec<String>),
    /// There.
    Found(PathBuf),
}

impl Adapter {
    /// Looks where a run looks.
    fn find(variable: &str, name: &str) -> Self {
        let path = match look_for(variable, name) {
            Ok(path) => path,
            Err(why @ NotFound::Misnamed { .. }) => return Self::Misnamed(why.to_string()),
            Err(NotFound::Nowhere { .. }) => return Self::Missing,
        };
        let path = path.canonicalize().unwrap_or(path);
        let absent = absent_libraries(&path);
        if absent.is_empty() {
            Self::Found(path)
        } else {
            Self::Broken(path, absent)
        }
    }

    fn works(&self) -> bool {
        matches!(self, Self::Found(_))
    }

    /// True where there is nothing to install: it works, or its variable is to be mended.
    fn needs_nothing(&self) -> bool {
        matches!(self, Self::Found(_) | Self::Misnamed(_))
    }
}

impl fmt::Display for Adapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("not found"),
            Self::Misnamed(why) => f.write_str(why),
            Self::Broken(path, libraries) => {
                write!(
                    f,
                    "{}, but without {}",
                    path.display(),
                    libraries.join(", ")
                )
            }
            Self::Found(path) => write!(f, "{}", path.display()),
        }
    }
}

/// Looks at this machine.
pub fn run() -> DoctorReport {
    DoctorReport {
        system: system(),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        hdf5: hdf5_version(),
        mpi: mpi(),
        openfoam: package_version("openfoam"),
        openfoam_adapter: Adapter::find(openfoam::SOLVER_VARIABLE, openfoam::SOLVER),
        parcel_adapter: Adapter::find(openfoam::parcels::VARIABLE, openfoam::parcels::PROGRAM),
        liggghts: package_version("libliggghts-dev").or_else(|| package_version("liggghts")),
        liggghts_adapter: Adapter::find(liggghts::HOST_VARIABLE, liggghts::HOST),
        mpi_adapter: Adapter::find(MPI_VARIABLE, MPI_PROGRAM),
        shared_memory: shared_memory(Path::new("/dev/shm")),
    }
}

/// Shared libraries of a program that are not on this machine.
pub(super) fn absent_libraries(program: &Path) -> Vec<String> {
    let libraries = output(Command::new("ldd").arg(program)).unwrap_or_default();
    libraries
        .lines()
        .filter(|line| line.ends_with("not found"))
        .filter_map(|line| line.split_whitespace().next())
        .map(str::to_owned)
        .collect()
}

fn system() -> Option<String> {
    let text = fs::read_to_string("/etc/os-release").ok()?;
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
    Some(name.trim_matches('"').to_owned())
}

#[cfg(feature = "hdf5")]
fn hdf5_version() -> Option<String> {
    let (major, minor, patch) = hdf5::library_version();
    Some(format!("{major}.{minor}.{patch}"))
}

#[cfg(not(feature = "hdf5"))]
fn hdf5_version() -> Option<String> {
    None
}

pub(super) fn mpi() -> Option<String> {
    let text = output(Command::new("mpirun").arg("--version"))?;
    text.lines()
        .next()
        .map(|line| line.trim().to_owned())
        .filter(|line| !line.is_empty())
}

fn package_version(package: &str) -> Option<String> {
    let format = "${db:Status-Status} ${Version}\\n";
    let text = output(Command::new("dpkg-query").args(["-W", "-f", format, package]))?;
    text.lines()
        .find_map(|line| line.strip_prefix("installed "))
        .map(str::to_owned)
}

fn shared_memory(folder: &Path) -> Option<(u64, u64)> {
    let data = rustix::fs::statvfs(folder).ok()?;
    Some((data.f_bavail * data.f_frsize, data.f_blocks * data.f_frsize))
}

/// What a program printed; `None` if it is not there or fails.
fn output(command: &mut Command) -> Option<String> {
    let output = command
        .env("LC_ALL", "C.UTF-8")
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

impl DoctorReport {
    /// True if the gas can be OpenFOAM's.
    pub fn openfoam_works(&self) -> bool {
        self.openfoam.is_some() && self.mpi.is_some() && self.openfoam_adapter.works()
    }

    /// True if the particles can be LIGGGHTS'.
    pub fn liggghts_works(&self) -> bool {
        self.liggghts.is_some() && self.mpi.is_some() && self.liggghts_adapter.works()
    }

    /// Names of what is missing and can be installed.
    fn missing(&self) -> Vec<&'static str> {
        let all = [
            ("HDF5", self.hdf5.is_some()),
            ("MPI", self.mpi.is_some()),
            ("OpenFOAM", self.openfoam.is_some()),
            ("calcineGasFoam", self.openfoam_adapter.needs_nothing()),
            ("calcineParcelFoam", self.parcel_adapter.needs_nothing()),
            ("LIGGGHTS", self.liggghts.is_some()),
            ("calcine-liggghts", self.liggghts_adapter.needs_nothing()),
            ("calcine-mpi", self.mpi_adapter.needs_nothing()),
        ];
        all.into_iter()
            .filter(|(_, here)| !here)
            .map(|(name, _)| name)
            .collect()
    }

    /// What can carry messages between Calcine and external solvers here.
    fn transports(&self) -> Vec<&'static str> {
        let mpi = self.mpi.is_some() && self.mpi_adapter.works();
        let all = [
            ("shared-memory", self.shared_memory.is_some()),
            ("mpi", mpi),
        ];
        all.into_iter()
            .filter(|(_, works)| *works)
            .map(|(name, _)| name)
            .collect()
    }

    /// Pairings that can run here.
    fn pairings(&self) -> Vec<&'static str> {
        let (foam, particles) = (self.openfoam_works(), self.liggghts_works());
        let parcels = self.openfoam.is_some() && self.mpi.is_some() && self.parcel_adapter.works();
        let all = [
            ("native+native", true),
            ("native+liggghts", particles),
            ("openfoam+native", foam),
            ("openfoam+liggghts", foam && particles),
            ("native+openfoam", parcels),
            ("openfoam+openfoam", foam && parcels),
        ];
        all.into_iter()
            .filter(|(_, works)| *works)
            .map(|(name, _)| name)
            .collect()
    }
}

impl fmt::Display for DoctorReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let or_not = |version: &Option<String>| version.clone().unwrap_or("not found".to_owned());
        let hdf5 = self.hdf5.as_deref().unwrap_or("left out of this binary");
        let system = self.system.as_deref().unwrap_or("an unknown system");
        let version = env!("CARGO_PKG_VERSION");
        writeln!(
            f,
            "calcine {version} on {system}, {} processors",
            self.processors
        )?;
        writeln!(f, "  HDF5              {hdf5}")?;
        writeln!(f, "  MPI               {}", or_not(&self.mpi))?;
        writeln!(f, "  OpenFOAM          {}", or_not(&self.openfoam))?;
        writeln!(f, "  calcineGasFoam    {}", self.openfoam_adapter)?;
        writeln!(f, "  calcineParcelFoam {}", self.parcel_adapter)?;
        writeln!(f, "  LIGGGHTS          {}", or_not(&self.liggghts))?;
        writeln!(f, "  calcine-liggghts  {}", self.liggghts_adapter)?;
        writeln!(f, "  calcine-mpi       {}", self.mpi_adapter)?;
        match self.shared_memory {
            None => writeln!(
                f,
                "  shared memory     no /dev/shm: only native+native runs here"
            )?,
            Some((free, total)) => {
                let (free_mb, total_mb) = (free as f64 / 1e6, total as f64 / 1e6);
                writeln!(
                    f,
                    "  shared memory     {free_mb:.0} of {total_mb:.0} MB free in /dev/shm"
                )?;
                if free < LITTLE_MEMORY {
                    writeln!(
                        f,
                        "    that is little for a coupled run: enlarge it, in Docker with \
                         `--shm-size=1g`"
                    )?;
                }
            }
        }
        write!(f, "pairings that run here: {}", self.pairings().join(", "))?;
        write!(f, "\ntransports: {}", self.transports().join(", "))?;
        let missing = self.missing();
        if missing.is_empty() {
            return Ok(());
        }
        write!(f, "\nmissing: {}\n  {REMEDY}", missing.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole() -> DoctorReport {
        let adapter = |name: &str| Adapter::Found(Path::new("/opt").join(name));
        DoctorReport {
            hdf5: Some("1.10.8".into()),
            mpi: Some("mpirun (Open MPI) 4.1.4".into()),
            openfoam: Some("1912.200626-1+b1".into()),
            openfoam_adapter: adapter("calcineGasFoam"),
            parcel_adapter: adapter("calcineParcelFoam"),
            liggghts: Some("3.8.0+repack1-9+b2".into()),
            liggghts_adapter: adapter("calcine-liggghts"),
            mpi_adapter: adapter("calcine-mpi"),
            shared_memory: Some((1 << 30, 1 << 30)),
            ..DoctorReport::default()
        }
    }

    #[test]
    fn a_machine_with_nothing_runs_natively_and_names_one_command() {
        let text = DoctorReport::default().to_string();
        assert!(
            text.contains("pairings that run here: native+native\n"),
            "{text}"
        );
        assert!(text.ends_with(REMEDY), "{text}");
        for command in ["cargo xtask setup --all", "cargo xtask install --prefix"] {
            assert!(REMEDY.contains(command), "{REMEDY}");
        }
        assert!(
            text.contains(
                "missing: HDF5, MPI, OpenFOAM, calcineGasFoam, calcineParcelFoam, LIGGGHTS"
            ),
            "{text}"
        );
    }

    #[test]
    fn a_machine_with_everything_runs_all_pairings() {
        let text = whole().to_string();
        let all = "native+native, native+liggghts, openfoam+native, openfoam+liggghts, native+openfoam, openfoam+openfoam";
        assert!(text.contains(all), "{text}");
        assert!(text.ends_with("transports: shared-memory, mpi"), "{text}");
        assert!(!text.contains("missing"), "{text}");
    }

    #[test]
    fn an_adapter_without_its_libraries_is_named_with_them() {
        let lost = Adapter::Broken(
            "/opt/calcine-liggghts".into(),
            vec!["libliggghts.so".into()],
        );
        let report = DoctorReport {
            liggghts_adapter: lost,
            ..whole()
        };
        let text = report.to_string();
        assert!(!report.liggghts_works());
        assert!(
            text.contains("/opt/calcine-liggghts, but without libliggghts.so"),
            "{text}"
        );
        assert!(text.contains("missing: calcine-liggghts\n"), "{text}");
    }

    #[test]
    fn little_shared_memory_is_said_with_its_remedy() {
        let report = DoctorReport {
            shared_memory: Some((1 << 20, 64 << 20)),
            ..whole()
        };
        assert!(report.to_string().contains("--shm-size=1g"));
    }

    #[test]
    fn this_machine_can_be_looked_at() {
        let report = run();
        assert!(report.processors >= 1);
        assert!(report.to_string().contains("native+native"));
    }
}
