//! Where the labels of a picture stand: beside their lines, clear of boxes, of other lines and of each other.

/// Width of a character and height of a line of text in a picture, at 11 px.
const CHARACTER: f64 = 6.8;
const LINE: f64 = 12.0;
/// What a label costs that covers so much of a box or another label, or a point of another line, against a step along its own line.
const COVERED: f64 = 1.0;
const CROSSED: f64 = 60.0;
const STEP: f64 = 4.0;
/// Distance between a line and its label, and what is left free about a label for the next ones.
const SPACE: f64 = 5.0;
const CLEAR: f64 = 8.0;

/// A rectangle: left, top, right, bottom.
pub(super) type Rectangle = [f64; 4];

/// A line of a picture with what is written beside it.
pub(super) struct Labelled {
    /// Points along the line, near to each other, where the label may stand.
    pub line: Vec<(f64, f64)>,
    /// Points along the rest of it.
    pub rest: Vec<(f64, f64)>,
    /// Lines of text.
    pub text: Vec<String>,
}

impl Labelled {
    /// The rectangle of the text about a point.
    fn about(&self, (x, y): (f64, f64)) -> Rectangle {
        let longest = self.text.iter().map(|line| line.chars().count());
        let width = CHARACTER * longest.max().unwrap_or(0) as f64;
        let height = LINE * self.text.len() as f64;
        [
            x - 0.5 * width,
            y - 0.5 * height,
            x + 0.5 * width,
            y + 0.5 * height,
        ]
    }
}

fn shared(one: Rectangle, other: Rectangle) -> f64 {
    let width = one[2].min(other[2]) - one[0].max(other[0]);
    let height = one[3].min(other[3]) - one[1].max(other[1]);
    width.max(0.0) * height.max(0.0)
}

/// A rectangle and what is left free about it.
fn with_room([left, top, right, bottom]: Rectangle) -> Rectangle {
    [left - CLEAR, top - CLEAR, right + CLEAR, bottom + CLEAR]
}

fn holds(one: Rectangle, (x, y): (f64, f64)) -> bool {
    (one[0]..=one[2]).contains(&x) && (one[1]..=one[3]).contains(&y)
}

/// Rectangles of the labels, in their order: each where it covers least, near the middle of its line.
pub(super) fn placed(all: &[Labelled], boxes: &[Rectangle]) -> Vec<Rectangle> {
    let mut found = Vec::new();
    let mut taken: Vec<Rectangle> = Vec::new();
    for (own, label) in all.iter().enumerate() {
        let count = label.line.len();
        let mut best: Option<(f64, Rectangle)> = None;
        for (k, point) in label.line.iter().enumerate() {
            let [left, top, right, bottom] = label.about((0.0, 0.0));
            // Above, below, beside, and upon it.
            let shifts = [
                (0.0, top - SPACE),
                (0.0, bottom + SPACE),
                (right + SPACE, 0.0),
                (left - SPACE, 0.0),
                (0.0, 0.0),
            ];
            for (across, down) in shifts {
                let here = label.about((point.0 + across, point.1 + down));
                let covered: f64 = boxes.iter().chain(&taken).map(|b| shared(here, *b)).sum();
                let others = all.iter().enumerate().filter(|(other, _)| *other != own);
                let crossed = others.flat_map(|(_, other)| other.line.iter().chain(&other.rest));
                let crossed = crossed.filter(|point| holds(here, **point)).count();
                let on = label
                    .line
                    .iter()
                    .filter(|point| holds(here, **point))
                    .count();
                let away = (k as f64 - 0.5 * count as f64).abs();
                let cost = COVERED * covered
                    + CROSSED * crossed as f64
                    + 0.5 * CROSSED * on as f64
                    + STEP * away;
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, here));
                }
            }
        }
        let here = best.map_or([0.0; 4], |(_, here)| here);
        taken.push(with_room(here));
        found.push(here);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_lines_that_cross_stand_clear_of_each_other_and_of_boxes() {
        let line = |from: (f64, f64), to: (f64, f64)| Labelled {
            line: (0..=20)
                .map(|k| f64::from(k) / 20.0)
                .map(|s| (from.0 + s * (to.0 - from.0), from.1 + s * (to.1 - from.1)))
                .collect(),
            rest: Vec::new(),
            text: vec!["a stream".into(), "1 kg/s".into()],
        };
        let all = [
            line((0.0, 0.0), (200.0, 120.0)),
            line((0.0, 120.0), (200.0, 0.0)),
        ];
        let boxes = [[-100.0, -30.0, 0.0, 150.0], [200.0, -30.0, 300.0, 150.0]];
        let found = placed(&all, &boxes);
        assert_eq!(shared(with_room(found[0]), found[1]), 0.0);
        for label in found {
            assert!(
                boxes.iter().all(|own| shared(label, *own) == 0.0),
                "{label:?}"
            );
        }
    }
}
