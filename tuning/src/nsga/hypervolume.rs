/// Volume of what is dominated by some of the points and is better than a reference in every objective: the measure of a
/// front, larger is better. Points that are not better than the reference everywhere count with what of theirs is.
///
/// One objective after the other is cut into slabs between the points, down to two, over which a sweep keeps the stairs of
/// the points so far: O(n log n) for two objectives, O(n²) at most for three.
///
/// Source: Zitzler and Thiele, IEEE Trans. Evol. Comput. 3 (1999) 257, doi 10.1109/4235.797969.
pub fn hypervolume(points: &[&[f64]], reference: &[f64]) -> f64 {
    let inside = |point: &&[f64]| point.iter().zip(reference).all(|(a, b)| a < b);
    let mut kept: Vec<&[f64]> = points.iter().copied().filter(inside).collect();
    volume(&mut kept, reference)
}

fn volume(points: &mut [&[f64]], reference: &[f64]) -> f64 {
    let last = match reference.len() {
        0 => return 0.0,
        1 => {
            let least = points.iter().map(|point| point[0]);
            return (reference[0] - least.fold(reference[0], f64::min)).max(0.0);
        }
        2 => {
            let mut stairs = Stairs::default();
            points.iter().for_each(|point| stairs.add(point, reference));
            return stairs.area;
        }
        count => count - 1,
    };
    points.sort_by(|a, b| a[last].total_cmp(&b[last]));
    let mut stairs = Stairs::default();
    let mut sum = 0.0;
    for k in 0..points.len() {
        let top = points.get(k + 1).map_or(reference[last], |next| next[last]);
        let height = top - points[k][last];
        if last == 2 {
            stairs.add(points[k], reference);
            sum += height * stairs.area;
        } else if height > 0.0 {
            let mut below: Vec<&[f64]> = points[..=k].to_vec();
            sum += height * volume(&mut below, &reference[..last]);
        }
    }
    sum
}

/// The front of points in two objectives, by the first of them, with the area that it dominates.
#[derive(Default)]
struct Stairs {
    steps: Vec<[f64; 2]>,
    area: f64,
}

impl Stairs {
    fn add(&mut self, point: &[f64], reference: &[f64]) {
        let (x, y) = (point[0], point[1]);
        let at = self.steps.partition_point(|step| step[0] < x);
        let mut ceiling = match at.checked_sub(1) {
            Some(before) => self.steps[before][1],
            None => reference[1],
        };
        if y >= ceiling {
            return;
        }
        // Steps to the right that the point dominates go; up to each of them the ceiling is that of the one before.
        let (mut from, mut end) = (x, at);
        while let Some(step) = self.steps.get(end) {
            if step[1] < y {
                break;
            }
            self.area += (step[0] - from) * (ceiling - y);
            (from, ceiling) = (step[0], step[1]);
            end += 1;
        }
        let to = self.steps.get(end).map_or(reference[0], |step| step[0]);
        self.area += (to - from) * (ceiling - y);
        self.steps.splice(at..end, [[x, y]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volumes_of_boxes_are_their_products_and_overlaps_count_once() {
        assert_eq!(hypervolume(&[&[0.25]], &[1.0]), 0.75);
        assert_eq!(
            hypervolume(&[&[0.0, 0.5], &[0.5, 0.0], &[0.6, 0.6]], &[1.0, 1.0]),
            0.75
        );
        assert_eq!(hypervolume(&[&[2.0, 0.0]], &[1.0, 1.0]), 0.0);
        let cube: [&[f64]; 2] = [&[0.0, 0.0, 0.5], &[0.5, 0.5, 0.0]];
        // ½ of the first, ¼ of the cube of the second, of which one eighth lies in the first.
        assert!((hypervolume(&cube, &[1.0, 1.0, 1.0]) - (0.5 + 0.25 - 0.125)).abs() < 1e-15);
        let four: [&[f64]; 1] = [&[0.5, 0.5, 0.5, 0.5]];
        assert_eq!(hypervolume(&four, &[1.0; 4]), 0.0625);
    }
}
