//! Keys of `motion`.

use super::prelude::*;
use crate::laws;

#[rustfmt::skip]
const HELD: &[Key] = &[
    key("from", Number(D::TIME, Any), Default("0 s"), "Begin of the first hold.", "\"10 s\""),
    key("for", Number(D::TIME, Positive), Required, "Length of each hold.", "\"50 s\""),
    key("every", Number(D::TIME, Positive), Required, "Time from one begin to the next, up to the end of the run.", "\"60 s\""),
];

#[rustfmt::skip]
const PARCELS: &[Key] = &[
    key("courant", Number(D::NONE, UpTo(0.0, 1.0)), Default("0.5"), "Courant number of a parcel in a step at most: a window has as many steps as that needs. Of OpenFOAM's parcels, whose step is the window, in a part of a track.", "0.5"),
    key("most_steps", Whole(1, 1_000_000), Default("1000"), "Steps of a window at most; a window that needs more ends the run.", "1000"),
    key("packing", Choice(words::<PackingScheme>), Default("implicit"), "How the stress acts: the solid fraction at the end of the step is solved for, its gradient at the start acts limited (Snider), or not at all.", "\"implicit\""),
    key("pressure", Number(D::PRESSURE, Positive), Required, "Constant P_s of the stress by Harris and Crighton.", "\"10 Pa\""),
    key("exponent", Number(D::NONE, Between(1.0, 10.0)), Default("2"), "Its exponent β.", "2"),
    key("floor", Number(D::NONE, Within(0.0, 1.0)), Default("1e-7"), "Share e of the void that its distance from close packing has at least; of the explicit packing, and of OpenFOAM's implicit one, which needs 0.01 or more.", "1e-7"),
    key("close_packing", Number(D::NONE, Within(0.0, 1.0)), Required, "Solid fraction of the closest packing, at most that of the smoother.", "0.6"),
    key("restitution", Number(D::NONE, UpTo(0.0, 1.0)), Without("required with explicit packing, damping and isotropy"), "Coefficient of restitution of two particles, above 0 and up to 1.", "0.9"),
    key("damping", Truth, Default("false"), "Whether collisions damp velocities towards their mean.", "true"),
    key("isotropy", Truth, Default("false"), "Whether collisions draw velocities anew, so that they become isotropic.", "true"),
    key("seed", Whole(0, MOST), Without("required with isotropy"), "Equal seeds give equal draws, bit for bit.", "1"),
    key("friction", Table(PARCEL_FRICTION), Without("only parcels that meet a wall rub"), "Coulomb's friction under the stress of the solid: of the bed with itself, and with the walls by `friction` of [[contacts]] ([NSP-1](../theory.md#NSP-1)). With a packing only.", "{ bed = 0.5 }"),
    key("resistance", Table(PARCEL_RESISTANCE), Without("none"), "A force -c m (v - v_wall) on each particle, wherever it is: what holds back particles that are no spheres ([NSP-2](../theory.md#NSP-2)). Its rate is a fit to a measured residence time.", "{ rate = \"0.2 1/s\", wall = \"drum\" }"),
];

#[rustfmt::skip]
const PARCEL_RESISTANCE: &[Key] = &[
    key("rate", Number(D::ANGULAR_VELOCITY, NotNegative), Required, "Its rate c.", "\"0.2 1/s\""),
    key("wall", Text, Required, "One of [[walls]], whose motion v_wall is that of: of one that turns, as a body that turns with it.", "\"drum\""),
];

const PARCEL_FRICTION: &[Key] = &[
    key(
        "bed",
        Number(D::NONE, NotNegative),
        Required,
        "Coefficient of friction within the bed, the tangent of its angle of internal friction; 0 where only walls rub.",
        "0.5",
    ),
    key(
        "slip",
        Number(D::VELOCITY, Positive),
        Default("0.1 mm/s"),
        "Slip between neighbouring cells, and at walls, below which friction falls off: what holds creeps by less than this from cell to cell. The smaller, the more iterations a step takes.",
        "\"0.1 mm/s\"",
    ),
];

#[rustfmt::skip]
pub(super) const MOTION: &[Key] = &[
    key("kind", Choice(words::<MotionKind>), Required, "Fluidised beds, drums and sprays move in real time, and AF is 1; the slow motion of shafts and moving beds is the same at any pace, and may be accelerated.", "\"real-time\""),
    key("motion_step", Number(D::TIME, Positive), Without("a whole share of the window, at most 15 % of the time of a Rayleigh wave and 5 % of the shortest impact"), "Time step of the contacts in motion time.", "\"5 us\""),
    key("long_step", Truth, Default("false"), "Whether a `motion_step` that is too long for the contacts is warned of in place of refused: above half the time of a Rayleigh wave, or a quarter of the shortest impact.", "true"),
    key("contact", Law(laws::contact, &[]), Without("required where particles are free"), "Force of an elastic contact with damping and friction; LIGGGHTS has `hertz-mindlin` and `linear`.", "{ law = \"hertz-mindlin\" }"),
    key("attractive_damping", Truth, Default("true"), "Whether damping may pull separating spheres together: true gives the stated restitution, false cuts the force at zero.", "false"),
    key("rolling", Law(laws::rolling, &[]), Without("required where particles are free"), "Resistance to rolling.", "{ law = \"none\" }"),
    key("cohesion", Law(laws::cohesion, &[]), Without("required where particles are free"), "Attraction between surfaces.", "{ law = \"none\" }"),
    key("parcels", Table(PARCELS), Without("particles move one by one"), "How parcels move, with motion = \"parcels\" of all populations; in place of contacts, rolling and cohesion. [[walls]] lie at every patch that is not periodic, and [[contacts]] state `restitution` and `friction` with them.", "{ pressure = \"10 Pa\", close_packing = 0.6 }"),
    key("lost", Choice(words::<LostParticles>), Default("end"), "What becomes of particles whose centres leave the gas mesh: they end the run, or are taken out after the window in which they left, warned of and booked (`passed.lost` of summary.json). Parcels never leave.", "\"take-out\""),
    key("held", Either(&Spans, &Table(HELD)), Without("never"), "Process times in which the bed is held: it comes to rest, and is let go from rest with its contacts as they were. Meanwhile walls, feeds and outlets stand, and AF may be above 1 in real time too.", "[[\"10 s\", \"60 s\"], [\"70 s\", \"120 s\"]]"),
];
