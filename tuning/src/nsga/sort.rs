//! Who is better than whom.

/// True where `a` is nowhere worse than `b` and somewhere better.
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    let mut better = false;
    for (a, b) in a.iter().zip(b) {
        // A NaN is worse than all.
        if a.is_nan() || a > b {
            return false;
        }
        better |= a < b || b.is_nan();
    }
    better
}

/// Indices of points front by front: those of the first are dominated by none, those of the next by points of the fronts
/// before alone (Deb et al. 2002, section III A).
pub fn fronts(points: &[&[f64]]) -> Vec<Vec<usize>> {
    let count = points.len();
    let mut beats: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut beaten = vec![0usize; count];
    for a in 0..count {
        for b in a + 1..count {
            if dominates(points[a], points[b]) {
                beats[a].push(b);
                beaten[b] += 1;
            } else if dominates(points[b], points[a]) {
                beats[b].push(a);
                beaten[a] += 1;
            }
        }
    }
    let mut all = Vec::new();
    let mut front: Vec<usize> = (0..count).filter(|&k| beaten[k] == 0).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for &a in &front {
            for &b in &beats[a] {
                beaten[b] -= 1;
                if beaten[b] == 0 {
                    next.push(b);
                }
            }
        }
        next.sort_unstable();
        all.push(std::mem::replace(&mut front, next));
    }
    all
}

/// Crowding distances of the points of a front: the sum over objectives of the span between the neighbours, relative to the
/// front's; infinite at its ends (Deb et al. 2002, section III B).
pub fn crowding(points: &[&[f64]]) -> Vec<f64> {
    let count = points.len();
    let mut distance = vec![0.0; count];
    let objectives = points.first().map_or(0, |point| point.len());
    let mut order: Vec<usize> = (0..count).collect();
    let columns = (0..objectives).map(|k| points.iter().map(move |point| point[k]).collect());
    for column in columns {
        let column: Vec<f64> = column;
        let value = |k: usize| column[k];
        order.sort_by(|&a, &b| value(a).total_cmp(&value(b)).then(a.cmp(&b)));
        let (first, last) = (order[0], order[count - 1]);
        distance[first] = f64::INFINITY;
        distance[last] = f64::INFINITY;
        let span = value(last) - value(first);
        if !(span > 0.0 && span.is_finite()) {
            continue;
        }
        for trio in order.windows(3) {
            distance[trio[1]] += (value(trio[2]) - value(trio[0])) / span;
        }
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fronts_peel_points_from_the_best_to_the_worst() {
        let points: [&[f64]; 6] = [
            &[1.0, 3.0],
            &[2.0, 2.0],
            &[3.0, 1.0],
            &[2.0, 3.0],
            &[3.0, 3.0],
            &[f64::INFINITY, f64::INFINITY],
        ];
        assert_eq!(fronts(&points), [vec![0, 1, 2], vec![3], vec![4], vec![5]]);
        assert!(!dominates(&[1.0, 1.0], &[1.0, 1.0]));
        assert!(dominates(&[1.0, 1.0], &[1.0, f64::NAN]));
        assert!(!dominates(&[f64::NAN, 0.0], &[1.0, 1.0]));
    }

    #[test]
    fn the_ends_of_a_front_are_kept_and_lonely_points_come_next() {
        let points: [&[f64]; 4] = [&[0.0, 4.0], &[1.0, 3.0], &[1.5, 2.5], &[4.0, 0.0]];
        let distance = crowding(&points);
        assert!(distance[0].is_infinite() && distance[3].is_infinite());
        assert_eq!(distance[1], 1.5 / 4.0 + 1.5 / 4.0);
        assert_eq!(distance[2], 3.0 / 4.0 + 3.0 / 4.0);
    }
}
