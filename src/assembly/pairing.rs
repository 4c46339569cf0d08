//! Who computes what: the backends and their pairings.

use clap::ValueEnum;

use crate::case::model::Case;

/// Who computes the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum GasBackend {
    /// Calcine's own finite-volume solver.
    #[default]
    Native,
    /// calcineGasFoam on Debian's OpenFOAM.
    Openfoam,
    /// The program of `external.gas`, which couples through Calcine's C ABI.
    External,
}

/// Who computes the particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ParticleBackend {
    /// Calcine's own.
    #[default]
    Native,
    /// Debian's LIGGGHTS as a library.
    Liggghts,
    /// The MP-PIC cloud of Debian's OpenFOAM, for parcels.
    Openfoam,
    /// The program of `external.particles`, which couples through Calcine's C ABI.
    External,
}

/// A gas and a particle backend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairing {
    /// The gas.
    pub gas: GasBackend,
    /// The particles.
    pub particles: ParticleBackend,
}

impl Pairing {
    /// The four pairings of the solvers that every case has.
    pub const ALL: [Pairing; 4] = [
        Pairing {
            gas: GasBackend::Native,
            particles: ParticleBackend::Native,
        },
        Pairing {
            gas: GasBackend::Native,
            particles: ParticleBackend::Liggghts,
        },
        Pairing {
            gas: GasBackend::Openfoam,
            particles: ParticleBackend::Native,
        },
        Pairing {
            gas: GasBackend::Openfoam,
            particles: ParticleBackend::Liggghts,
        },
    ];

    /// Who has the particles of a case: without any there is nothing for a program to move, and Calcine keeps the empty list.
    pub fn particles_of(self, case: &Case) -> ParticleBackend {
        match case.particles.is_empty() {
            true => ParticleBackend::Native,
            false => self.particles,
        }
    }

    /// The name as `compare --pairings` takes it, for example `openfoam+native`.
    pub fn name(self) -> String {
        format!("{}+{}", self.gas.name(), self.particles.name())
    }

    /// The pairing of a name.
    pub fn parse(name: &str) -> Option<Self> {
        let (gas, particles) = name.split_once('+')?;
        let all = GasBackend::value_variants().iter();
        let gas = all.copied().find(|one| one.name() == gas)?;
        let all = ParticleBackend::value_variants().iter();
        let particles = all.copied().find(|one| one.name() == particles)?;
        Some(Self { gas, particles })
    }

    /// True where no external solver takes part.
    pub fn is_native(self) -> bool {
        self == Self::default()
    }
}

impl GasBackend {
    /// The name as users write it.
    pub fn name(self) -> &'static str {
        match self {
            GasBackend::Native => "native",
            GasBackend::Openfoam => "openfoam",
            GasBackend::External => "external",
        }
    }
}

impl ParticleBackend {
    /// The name as users write it.
    pub fn name(self) -> &'static str {
        match self {
            ParticleBackend::Native => "native",
            ParticleBackend::Liggghts => "liggghts",
            ParticleBackend::Openfoam => "openfoam",
            ParticleBackend::External => "external",
        }
    }
}
