//! What planes take of spheres, eight faces of three or four corners at a time, in the lanes of vector
//! registers. The bits of a lane do not depend on its neighbours.

use std::f64::consts::PI;

use pulp::Simd;

use super::disc::Point;
use super::wide::{Wide, angle};

/// Faces at a time.
const LANES: usize = 8;
/// One number of each face.
type Lane = [f64; LANES];

/// No cell beyond a face.
pub(super) const NONE: u32 = u32::MAX;

/// A face that cuts a sphere, and whose edges do.
pub(super) struct CutFace<'a> {
    /// Three or four corners in the plane's axes, in m.
    pub corners: &'a [Point],
    /// The foot of the sphere's centre in the same axes.
    pub foot: Point,
    /// Signed height of the plane over the centre in m.
    pub height: f64,
    /// Radius of the sphere in m.
    pub radius: f64,
    /// Where the volumes of the two cells stand; `NONE` beyond a boundary.
    pub slots: [u32; 2],
}

/// Faces that wait to be evaluated together, in units of their sphere's radius.
#[derive(Default)]
#[repr(align(64))]
pub(super) struct Batch {
    corners: [[Lane; 2]; 4],
    height: Lane,
    /// R³/3 in m³.
    scale: Lane,
    slots: [[u32; 2]; LANES],
    filled: usize,
}

impl Batch {
    /// Takes a face; evaluates all when eight have come.
    #[inline]
    pub fn push(&mut self, face: &CutFace<'_>, volumes: &mut [f64]) {
        let (lane, inverse) = (self.filled, 1.0 / face.radius);
        let last = face.corners.len() - 1;
        for (k, corner) in self.corners.iter_mut().enumerate() {
            // A triangle has its last corner twice: an edge without length takes nothing.
            let place = (face.corners[k.min(last)] - face.foot) * inverse;
            (corner[0][lane], corner[1][lane]) = (place.x, place.y);
        }
        self.height[lane] = face.height * inverse;
        self.scale[lane] = face.radius * face.radius * face.radius / 3.0;
        self.slots[lane] = face.slots;
        self.filled += 1;
        if self.filled == LANES {
            self.flush(volumes);
        }
    }

    /// Evaluates the faces at hand: the first of the two cells gets h/3 · area(F ∩ D) − sign(h) R³/3 · Ω(F ∩ D), the
    /// second the opposite.
    pub fn flush(&mut self, volumes: &mut [f64]) {
        if self.filled == 0 {
            return;
        }
        let mut within = [0.0; LANES];
        pulp::Arch::new().dispatch(Evaluation {
            batch: self,
            within: &mut within,
        });
        for (slots, within) in self.slots.iter().zip(within).take(self.filled) {
            volumes[slots[0] as usize] += within;
            if slots[1] != NONE {
                volumes[slots[1] as usize] -= within;
            }
        }
        self.filled = 0;
    }

    /// Drops the faces whose volumes stand at `first` or beyond.
    pub fn forget(&mut self, first: usize) {
        while self.filled > 0 && self.slots[self.filled - 1][0] as usize >= first {
            self.filled -= 1;
        }
    }
}

/// The work on a batch, compiled for each set of vector instructions.
struct Evaluation<'a> {
    batch: &'a Batch,
    within: &'a mut Lane,
}

impl pulp::WithSimd for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let batch = self.batch;
        let lanes = |lane, k: usize| Wide::new(simd, S::as_simd_f64s(lane).0[k]);
        let (found, _) = S::as_mut_simd_f64s(self.within);
        for (k, found) in found.iter_mut().enumerate() {
            let zero = Wide::new(simd, simd.splat_f64s(0.0));
            let mut corners = [[zero; 2]; 4];
            for (corner, lane) in corners.iter_mut().zip(&batch.corners) {
                *corner = [lanes(&lane[0], k), lanes(&lane[1], k)];
            }
            let within = within(&corners, lanes(&batch.height, k));
            *found = (lanes(&batch.scale, k) * within).lanes();
        }
    }
}

#[inline(always)]
fn dot<S: Simd>(a: [Wide<S>; 2], b: [Wide<S>; 2]) -> Wide<S> {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
fn cross<S: Simd>(a: [Wide<S>; 2], b: [Wide<S>; 2]) -> Wide<S> {
    a[0] * b[1] - a[1] * b[0]
}

/// The product of complex numbers.
#[inline(always)]
fn turned<S: Simd>(a: [Wide<S>; 2], b: [Wide<S>; 2]) -> [Wide<S>; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Argument of a product whose true angle lies above −3π/4 and may pass π by round-off.
#[inline(always)]
fn argument<S: Simd>(product: [Wide<S>; 2]) -> Wide<S> {
    let found = angle(product[1], product[0]);
    found.if_below(found.all(-0.75 * PI), found + found.all(2.0 * PI), found)
}

/// A share of an edge brought between 0 and 1; 1 where the root is not positive.
#[inline(always)]
fn share<S: Simd>(share: Wide<S>, root: Wide<S>) -> Wide<S> {
    let (zero, one) = (root.all(0.0), root.all(1.0));
    let share = share.if_positive(share, zero);
    root.if_positive(share.if_below(one, share, one), one)
}

/// h · area(F ∩ D) − sign(h) · Ω(F ∩ D) of a convex polygon F with these corners, counted from the foot of the centre of
/// a sphere of radius 1, counter-clockwise.
///
/// Angles are summed as the arguments of products of complex numbers, each of half an angle: an arctangent for all
/// triangles over chords, and one for all sectors beyond. Half the solid angle of the former lies above −π/2 and
/// up to π, half the angle of the latter between 0 and π.
#[inline(always)]
fn within<S: Simd>(corners: &[[Wide<S>; 2]; 4], height: Wide<S>) -> Wide<S> {
    let (zero, one) = (height.all(0.0), height.all(1.0));
    let h = height.abs();
    let disc = (one - h) * (one + h);
    let rho = disc.sqrt();
    let (mut square, mut near, mut far) = ([zero; 4], [zero; 4], [zero; 4]);
    for k in 0..4 {
        square[k] = dot(corners[k], corners[k]);
        near[k] = square[k].sqrt();
        far[k] = (h * h + square[k]).sqrt();
    }
    let (mut triangles, mut angles, mut sectors) = (zero, [one, zero], [one, zero]);
    for k in 0..4 {
        let next = (k + 1) % 4;
        let (a, b) = (corners[k], corners[next]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let (length, slope) = (dot(along, along), dot(a, along));
        let root = slope * slope - length * (square[k] - disc);
        let half = root.if_positive(root, zero).sqrt();
        let inverse = one / length.if_positive(length, one);
        // Where the edge enters the disc and leaves it, as shares of its length. One whose line passes by lies
        // beyond the disc as a whole, as if it entered at its end.
        let enter = share((half + slope).negated() * inverse, root);
        let leave = share((half - slope) * inverse, root);
        let p = [a[0] + along[0] * enter, a[1] + along[1] * enter];
        let q = [a[0] + along[0] * leave, a[1] + along[1] * leave];
        let moment = cross(a, along);
        let turn = moment * (leave - enter);
        triangles = triangles + turn;
        // Van Oosterom and Strackee, doi:10.1109/TBME.1983.325207, with one corner at the foot. With the distances e of
        // the edge from the foot, g from the centre, and s and t of p and q along it,
        // |p||q| + st = g² (g² + s² + t²)/(|p||q| − st), which does not cancel where the foot lies between.
        let far_p = enter.if_positive(one, far[k]);
        let far_q = leave.if_below(one, one, far[next]);
        let distance = moment * moment * inverse;
        let (s, t) = (slope + length * enter, slope + length * leave);
        let (ss, st, tt) = (s * s * inverse, s * t * inverse, t * t * inverse);
        let (g, product) = (h * h + distance, far_p * far_q);
        let apart = product - st;
        let between = g * (g + ss + tt) / apart.if_positive(apart, one);
        let joint = st.if_positive(product + st, between);
        let straight = joint + h * (far_p + far_q + h) + distance;
        angles = turned(angles, [straight, turn]);
        let near_p = enter.if_below(one, rho, near[next]);
        let near_q = leave.if_positive(rho, near[k]);
        let before = [
            enter.if_positive(near[k] * near_p + dot(a, p), one),
            enter.if_positive(cross(a, p), zero),
        ];
        let after = [
            leave.if_below(one, near_q * near[next] + dot(q, b), one),
            leave.if_below(one, cross(q, b), zero),
        ];
        sectors = turned(turned(sectors, before), after);
    }
    let arc = height.all(2.0) * argument(sectors);
    let area = height.all(0.5) * (triangles + disc * arc);
    let angle = height.all(2.0) * argument(angles) + arc * (one - h);
    let magnitude = h * area - angle;
    height.if_below(zero, magnitude.negated(), magnitude)
}
