//! OpenFOAM's polyMesh folders: `points`, `faces`, `owner`, `neighbour`, `boundary`, as
//! OpenFOAM 1912 reads and writes them (its User Guide, chapter "Mesh generation and conversion").

mod error;
mod field;
mod read;
mod tokens;
mod write;

pub use error::PolyMeshError;
pub use field::internal_field;
pub use read::{PatchType, patch_types, read};
pub use write::{write, write_with};
