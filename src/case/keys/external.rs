//! Keys of `openfoam`, `liggghts` and `external`.

use super::prelude::*;

#[rustfmt::skip]
pub(super) const OPENFOAM: &[Key] = &[
    key("template", Path, Without("none"), "Folder of OpenFOAM files to start from.", "\"foam\""),
    key("solver", Choice(words::<StockSolver>), Default("calcineGasFoam"), "Program of an OpenFOAM gas: Calcine's own, or a stock solver with Calcine's sources in it, which is approximate (docs/how-to/stock-solvers.md).", "\"buoyantPimpleFoam\""),
    key("start", Path, Without("`gas.initial`"), "Time directory that OpenFOAM wrote on the same mesh, of a whole (reconstructed) case: its T, p (absolute), U (superficial) and mass fractions, as far as they are there, are the start of the gas.", "\"foam/0.5\""),
    key("ranks", Whole(1, 100_000), Default("1"), "MPI ranks; `--ranks-gas` overrides it.", "4"),
];

#[rustfmt::skip]
pub(super) const LIGGGHTS: &[Key] = &[
    key("template", Path, Without("none"), "LIGGGHTS script of the user's own for particles that move, in place of the generated one (docs/how-to/own-liggghts-script.md).", "\"in.bed\""),
    key("wall_impulse", Truth, Default("false"), "Whether LIGGGHTS counts the impulse of walls, for the line `particle_momentum` of the ledger; it then goes step by step. Native particles always count it.", "true"),
    key("ranks", Whole(1, 100_000), Default("1"), "MPI ranks; `--ranks-particles` overrides it.", "2"),
];

#[rustfmt::skip]
const GAS: &[Key] = &[
    key("program", Path, Required, "The program. It runs in `solvers/external-gas` of the results, where the case lies as `case.toml` and the mesh as `constant/polyMesh`.", "\"column-gas\""),
    key("arguments", Texts(0), Without("none"), "Its arguments.", "[\"velocity=0.5\"]"),
    key("ranks", Whole(1, 100_000), Default("1"), "MPI ranks; `--ranks-gas` overrides it.", "4"),
];

#[rustfmt::skip]
const PARTICLES: &[Key] = &[
    key("program", Path, Required, "The program. It runs in `solvers/external-particles` of the results, where the case lies as `case.toml` and the particles as `particles.csv`.", "\"ballistic-particles\""),
    key("arguments", Texts(0), Without("none"), "Its arguments.", "[\"gravity=-9.81\"]"),
    key("ranks", Whole(1, 100_000), Default("1"), "MPI ranks; `--ranks-particles` overrides it.", "4"),
];

#[rustfmt::skip]
pub(super) const EXTERNAL: &[Key] = &[
    key("gas", Table(GAS), Without("none"), "The gas of `--gas external`; other runs ignore it.", "{ program = \"column-gas\" }"),
    key("particles", Table(PARTICLES), Without("none"), "The particles of `--particles external`; other runs ignore it.", "{ program = \"ballistic-particles\" }"),
];
