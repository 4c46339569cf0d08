//! Keys of the file, and of `time`.

use super::agreement::AGREEMENT;
use super::bodies::BODIES;
use super::contacts::CONTACTS;
use super::coupling::COUPLING;
use super::external::{EXTERNAL, LIGGGHTS, OPENFOAM};
use super::gas::GAS;
use super::laws::LAWS;
use super::materials::{MATERIALS, SOLIDS};
use super::mesh::MESH;
use super::motion::MOTION;
use super::output::{OUTPUT, PROBES};
use super::particles::{FEEDS, OUTLETS, PARTICLES};
use super::prelude::*;
use super::quantities::QUANTITIES;
use super::reactions::REACTIONS;
use super::walls::WALLS;

/// The keys of the file of a bed.
#[rustfmt::skip]
pub(super) const BED: &[Key] = &[
    key("kind", Choice(|| vec!["bed"]), Default("bed"), "What the file describes; without it a bed.", "\"bed\""),
    key("format", Whole(0, MOST), Required, "Version of the format; 1 is the only one.", "1"),
    key("title", Text, Required, "Title for people.", "\"Hot air heats a column\""),
    key("time", Table(TIME), Required, "Clocks. All times are process time, save `motion_window` (motion time).", "[time]"),
    key("mesh", Table(MESH), Required, "The gas mesh: exactly one of `box`, `cylinder` and `polymesh`.", "[mesh]"),
    key("materials", Named(MATERIALS), Without("required with `particles`"), "Solid materials by name.", "[materials.glass]"),
    key("solids", Named(SOLIDS), Without("none"), "Pure solids by name, beside the built-in C, Fe, FeO, Fe0.947O, Fe3O4, Fe2O3, CaCO3, CaO and Al2O3.", "[solids.quartz]"),
    key("reactions", Tables(REACTIONS), Without("none"), "Reactions in particles.", "[[reactions]]"),
    key("contacts", Tables(CONTACTS), Without("none"), "Contacts of pairs of materials.", "[[contacts]]"),
    key("walls", Tables(WALLS), Without("none"), "Walls that free particles touch, and that all particles exchange heat with.", "[[walls]]"),
    key("bodies", Named(BODIES), Without("none"), "Bodies of one temperature that store heat, such as crucibles, by name.", "[bodies.crucible]"),
    key("motion", Table(MOTION), Without("required where particles are free"), "How free particles move; gravity is that of `gas.gravity`.", "[motion]"),
    key("gas", Table(GAS), Required, "The gas.", "[gas]"),
    key("particles", Tables(PARTICLES), Without("the gas alone"), "Populations. Without any, the gas is computed alone, and `materials`, `laws` and `coupling` are left out.", "[[particles]]"),
    key("feeds", Tables(FEEDS), Without("none"), "Particles that come in.", "[[feeds]]"),
    key("outlets", Tables(OUTLETS), Without("none"), "Where particles go out.", "[[outlets]]"),
    key("laws", Table(LAWS), Without("required with `particles`"), "Laws; each is stated, none has a default.", "[laws]"),
    key("coupling", Table(COUPLING), Without("required with `particles`"), "How gas and particles are coupled.", "[coupling]"),
    key("openfoam", Table(OPENFOAM), Without("all inputs are generated"), "What only an OpenFOAM gas needs; a native gas ignores it.", "[openfoam]"),
    key("liggghts", Table(LIGGGHTS), Without("all inputs are generated"), "What only LIGGGHTS particles need; native particles ignore it.", "[liggghts]"),
    key("external", Table(EXTERNAL), Without("none"), "Solvers of the user's own, which couple through Calcine's C ABI (docs/attach-a-solver.md).", "[external]"),
    key("output", Table(OUTPUT), Required, "What is written.", "[output]"),
    key("probes", Tables(PROBES), Without("none"), "Points at which fields are sampled with every snapshot, into `results.h5` and `probes/`.", "[[probes]]"),
    key("quantities", Tables(QUANTITIES), Without("none"), "Quantities of interest.", "[[quantities]]"),
    key("agreement", Table(AGREEMENT), Without("windows that converge, no bands of fields"), "What `compare` judges beside quantities.", "[agreement]"),
];

#[rustfmt::skip]
const CHECKPOINT: &[Key] = &[
    key("every", Number(D::TIME, Positive), Without("never"), "A checkpoint each so much process time.", "\"60 s\""),
    key("wall", Number(D::TIME, Positive), Without("never"), "A checkpoint each so much wall time.", "\"15 min\""),
];

#[rustfmt::skip]
const WINDOW: &[Key] = &[
    key("min", Number(D::TIME, Positive), Required, "The shortest window, with which the run begins, and begins anew where something jumps.", "\"10 us\""),
    key("max", Number(D::TIME, Positive), Required, "The longest window.", "\"10 ms\""),
    key("courant", Number(D::NONE, Positive), Without("no bound; required without `error`"), "Largest Courant number of the gas over a window's motion time.", "2"),
    key("error", Number(D::NONE, UpTo(0.0, 0.1)), Without("no bound; required without `courant`"), "Largest estimated error of a window's step: root mean square over the gas, of the velocity as a share of its largest, of the temperature as a share of itself, of the mass fractions as they are.", "1e-3"),
];

#[rustfmt::skip]
const TIME: &[Key] = &[
    key("end", Number(D::TIME, Positive), Required, "End of the run.", "\"10 min\""),
    key("motion_window", Either(&Number(D::TIME, Positive), &Table(WINDOW)), OneOf, "Length of a coupling window in motion time, or bounds between which it follows the gas (docs/how-to/adaptive-windows.md). Either this or `process_step`.", "\"1 ms\""),
    key("process_step", Schedule(D::TIME, Positive), OneOf, "Length of a coupling window in process time, for beds that do not move, or lengths that hold from their times on, in steps: the motion time and with it the acceleration factor follow from mesh and inlets. Either this or `motion_window`; not with `acceleration` or `accelerated` storage.", "[[\"0 s\", \"60 s\"], [\"5000 s\", \"10 s\"]]"),
    key("acceleration", Schedule(D::NONE, Any), Default("1"), "Acceleration factor AF, at least 1: process time passes AF times as fast as motion time.", "[[\"0 s\", 1], [\"5 s\", 50]]"),
    key("gas_storage", Choice(words::<GasStorage>), Default("process"), "Clock over which the gas stores mass and heat.", "\"process\""),
    key("checkpoint", Table(CHECKPOINT), Without("only on interrupt"), "When a checkpoint is written.", "{ every = \"60 s\" }"),
];
