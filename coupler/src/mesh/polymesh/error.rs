//! What can go wrong with a polyMesh folder.

use std::path::PathBuf;

use thiserror::Error;

use super::super::MeshError;

/// A polyMesh folder that cannot be read or written.
#[derive(Debug, Error)]
pub enum PolyMeshError {
    /// A file could not be opened, read or written.
    #[error("{}: {cause}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        #[source]
        cause: std::io::Error,
    },
    /// A file that OpenFOAM wrote with `writeCompression on`.
    #[error("{} is compressed, and only files without compression are read; unpack it by gunzip, as every .gz file beside it", file.display())]
    Compressed {
        /// The file.
        file: PathBuf,
    },
    /// A file that does not read as its kind should.
    #[error("{}, line {line}: {message}", file.display())]
    Syntax {
        /// The file.
        file: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What was expected and what is there.
        message: String,
    },
    /// Files that read well but make no mesh.
    #[error("{}: {cause}", folder.display())]
    Mesh {
        /// The polyMesh folder.
        folder: PathBuf,
        /// What is wrong with the mesh.
        #[source]
        cause: MeshError,
    },
}
