//! The OpenFOAM case that calcineGasFoam runs in.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::setup::GasSetup;

use super::{NAME, dictionaries};

/// Schemes and linear solvers where no template brings its own.
const DEFAULTS: [(&str, &str); 2] = [
    (
        "system/fvSchemes",
        include_str!("../../../of-cases/default/system/fvSchemes"),
    ),
    (
        "system/fvSolution",
        include_str!("../../../of-cases/default/system/fvSolution"),
    ),
];

/// What an OpenFOAM case is made from.
#[derive(Clone, Copy, Debug)]
pub struct OpenfoamCase<'a> {
    /// The gas.
    pub setup: &'a GasSetup,
    /// The mesh of the undecomposed domain.
    pub mesh: &'a Mesh,
    /// A folder whose files are taken over where the case does not speak.
    pub template: Option<&'a Path>,
    /// Hash of the case, compared in the handshake.
    pub case_hash: &'a str,
}

impl OpenfoamCase<'_> {
    /// Writes the case into a folder, which is made if it is not there.
    pub fn write(&self, folder: &Path) -> Result<(), PartError> {
        self.check()?;
        make(folder)?;
        if let Some(template) = self.template {
            copy(template, folder)?;
        }
        for (name, text) in DEFAULTS {
            let path = folder.join(name);
            if self.template.is_none_or(|own| !own.join(name).is_file()) {
                put(&path, text)?;
            }
        }
        let setup = self.setup;
        for (name, text) in [
            ("system/controlDict", dictionaries::control()),
            (
                "constant/thermophysicalProperties",
                dictionaries::thermophysical(setup),
            ),
            ("constant/g", dictionaries::gravity(setup)),
            (
                "constant/calcineGas",
                dictionaries::calcine(setup, self.case_hash),
            ),
            ("constant/calcineCells", dictionaries::cells(self.mesh)),
            ("0/U", dictionaries::velocity(setup)),
            ("0/T", dictionaries::temperature(setup)),
            ("0/p", dictionaries::pressure(setup)),
        ] {
            put(&folder.join(name), &text)?;
        }
        let poly_mesh = folder.join("constant/polyMesh");
        polymesh::write(self.mesh, &poly_mesh).map_err(|error| {
            let message = format!("the mesh cannot be written to {}", poly_mesh.display());
            PartError::new(NAME, FailureKind::Io, message).caused_by(error)
        })
    }

    /// Every patch of the mesh needs its condition, and every condition its patch.
    fn check(&self) -> Result<(), PartError> {
        let refuse = |message: String| Err(PartError::new(NAME, FailureKind::NotStarted, message));
        for (name, _) in &self.setup.patches {
            if self.mesh.patch(name).is_none() {
                return refuse(format!("the mesh has no patch `{name}`"));
            }
            // What OpenFOAM reads as one word.
            let odd = |c: char| c.is_whitespace() || "\"'/;{}()".contains(c);
            if name.is_empty() || name.contains(odd) {
                return refuse(format!("OpenFOAM cannot have a patch named `{name}`"));
            }
        }
        for patch in self.mesh.patches() {
            if !self
                .setup
                .patches
                .iter()
                .any(|(name, _)| *name == patch.name)
            {
                return refuse(format!("patch `{}` has no boundary condition", patch.name));
            }
        }
        Ok(())
    }
}

fn failed<'a>(path: &'a Path, doing: &'a str) -> impl Fn(io::Error) -> PartError + 'a {
    move |error| {
        let message = format!("{} cannot be {doing}", path.display());
        PartError::new(NAME, FailureKind::Io, message).caused_by(error)
    }
}

fn make(folder: &Path) -> Result<(), PartError> {
    fs::create_dir_all(folder).map_err(failed(folder, "made"))
}

fn put(path: &Path, text: &str) -> Result<(), PartError> {
    if let Some(folder) = path.parent() {
        make(folder)?;
    }
    fs::write(path, text).map_err(failed(path, "written"))
}

/// Copies a template's files, folder by folder.
fn copy(from: &Path, to: &Path) -> Result<(), PartError> {
    make(to)?;
    let entries = fs::read_dir(from).map_err(failed(from, "read (the template)"))?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        paths.push(entry.map_err(failed(from, "read (the template)"))?.path());
    }
    for path in paths {
        let Some(name) = path.file_name() else {
            continue;
        };
        let target = to.join(name);
        if path.is_dir() {
            copy(&path, &target)?;
        } else {
            fs::copy(&path, &target).map_err(failed(&path, "copied"))?;
        }
    }
    Ok(())
}
