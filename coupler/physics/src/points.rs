//! Values given at points.

/// The value at `x` of a line through points of ascending abscissa, constant before the first and after the last;
/// NaN where there is none.
///
/// ```
/// use calcine_physics::points::linear;
/// let ramp = [(0.0, 300.0), (10.0, 400.0)];
/// assert_eq!([-1.0, 2.5, 11.0].map(|x| linear(&ramp, x)), [300.0, 325.0, 400.0]);
/// ```
pub fn linear(points: &[(f64, f64)], x: f64) -> f64 {
    let next = points.partition_point(|&(from, _)| from <= x);
    let before = next.checked_sub(1).and_then(|place| points.get(place));
    match (before, points.get(next)) {
        (Some(before), Some(after)) => {
            let share = (x - before.0) / (after.0 - before.0);
            before.1 + share * (after.1 - before.1)
        }
        (Some(edge), None) | (None, Some(edge)) => edge.1,
        (None, None) => f64::NAN,
    }
}
