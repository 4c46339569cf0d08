//! What keeps walls from going with the mesh of parcels.

use thiserror::Error;

/// Walls that do not go with the mesh in which parcels move.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ParcelWallError {
    /// A patch at which no wall is.
    #[error(
        "no wall lies at patch `{patch}` of the mesh, and parcels rebound from its boundary; add [[walls]] with patches = [\"{patch}\"]"
    )]
    None {
        /// Its name.
        patch: String,
    },
    /// A patch at which several are.
    #[error(
        "walls `{one}` and `{other}` both lie at patch `{patch}`, and parcels rebound from a patch in one way; give the patch one \
         wall, or divide it"
    )]
    Several {
        /// Its name.
        patch: String,
        /// A wall.
        one: String,
        /// Another one.
        other: String,
    },
    /// A contact that is not stated.
    #[error(
        "parcels of \"{material}\" meet wall `{wall}` of \"{other}\", but [[contacts]] has no restitution and friction of the two; add \
         an entry with between = [\"{material}\", \"{other}\"]"
    )]
    Contact {
        /// Material of the parcels.
        material: String,
        /// The wall.
        wall: String,
        /// Its material.
        other: String,
    },
    /// A resistance against a wall that there is not.
    #[error(
        "`motion.parcels.resistance` is against the wall \"{wall}\", which is not one of [[walls]]; name one of them: {known}"
    )]
    Unknown {
        /// The name.
        wall: String,
        /// Those that there are.
        known: String,
    },
    /// A motion that moves the wall away from the mesh.
    #[error(
        "wall `{wall}` is `moved` or `oscillating`, and the mesh in which parcels move stays; walls of parcels turn or move along \
         themselves"
    )]
    Moves {
        /// The wall.
        wall: String,
    },
}
