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
pub(super) const MOTION: &[Key] = &[
    key("kind", Choice(words::<MotionKind>), Required, "Fluidised beds, drums and sprays move in real time, and AF is 1; the slow motion of shafts and moving beds is the same at any pace, and may be accelerated.", "\"real-time\""),
    key("motion_step", Number(D::TIME, Positive), Without("a whole share of the window, at most 15 % of the time of a Rayleigh wave and 5 % of the shortest impact"), "Time step of the contacts in motion time.", "\"5 us\""),
    key("long_step", Truth, Default("false"), "Whether a `motion_step` that is too long for the contacts is warned of in place of refused: above half the time of a Rayleigh wave, or a quarter of the shortest impact.", "true"),
    key("contact", Law(laws::contact, &[]), Required, "Force of an elastic contact with damping and friction; LIGGGHTS has `hertz-mindlin` and `linear`.", "{ law = \"hertz-mindlin\" }"),
    key("attractive_damping", Truth, Default("true"), "Whether damping may pull separating spheres together: true gives the stated restitution, false cuts the force at zero.", "false"),
    key("rolling", Law(laws::rolling, &[]), Required, "Resistance to rolling.", "{ law = \"none\" }"),
    key("cohesion", Law(laws::cohesion, &[]), Required, "Attraction between surfaces.", "{ law = \"none\" }"),
    key("held", Either(&Spans, &Table(HELD)), Without("never"), "Process times in which the bed is held: it comes to rest, and is let go from rest with its contacts as they were. Meanwhile walls, feeds and outlets stand, and AF may be above 1 in real time too.", "[[\"10 s\", \"60 s\"], [\"70 s\", \"120 s\"]]"),
];
