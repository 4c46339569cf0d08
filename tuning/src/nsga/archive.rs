use super::sort::dominates;

/// One evaluation that nothing dominates.
#[derive(Clone, Debug, PartialEq)]
pub struct ArchivedPoint {
    /// Number of the evaluation, from zero.
    pub evaluation: usize,
    /// Genes from zero to one.
    pub genes: Vec<f64>,
    /// Objectives.
    pub objectives: Vec<f64>,
}

/// The front of all evaluations so far: points that no other dominates.
#[derive(Clone, Debug, Default)]
pub struct ParetoArchive {
    points: Vec<ArchivedPoint>,
}

impl ParetoArchive {
    /// Takes a point unless one of it is as good everywhere, and drops those that it dominates. A point with an objective
    /// that is not finite is not taken.
    pub fn offer(&mut self, point: ArchivedPoint) -> bool {
        if !point.objectives.iter().all(|one| one.is_finite()) {
            return false;
        }
        let known = |one: &ArchivedPoint| {
            one.objectives == point.objectives || dominates(&one.objectives, &point.objectives)
        };
        if self.points.iter().any(known) {
            return false;
        }
        self.points
            .retain(|one| !dominates(&point.objectives, &one.objectives));
        self.points.push(point);
        true
    }

    /// The points in the order of the first objective.
    pub fn front(&self) -> Vec<&ArchivedPoint> {
        let mut front: Vec<&ArchivedPoint> = self.points.iter().collect();
        front.sort_by(|a, b| {
            let first = |one: &ArchivedPoint| one.objectives.first().copied().unwrap_or(0.0);
            first(a)
                .total_cmp(&first(b))
                .then(a.evaluation.cmp(&b.evaluation))
        });
        front
    }

    /// The point with the smallest value of an objective.
    pub fn best(&self, objective: usize) -> Option<&ArchivedPoint> {
        let value =
            |one: &ArchivedPoint| one.objectives.get(objective).copied().unwrap_or(f64::NAN);
        self.points
            .iter()
            .min_by(|a, b| value(a).total_cmp(&value(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_archive_holds_what_nothing_dominates() {
        let mut archive = ParetoArchive::default();
        let offers = [
            [2.0, 2.0],
            [3.0, 3.0],
            [1.0, 3.0],
            [2.0, 2.0],
            [1.5, 1.5],
            [f64::NAN, 0.0],
        ];
        let taken: Vec<bool> = offers
            .iter()
            .enumerate()
            .map(|(k, objectives)| {
                archive.offer(ArchivedPoint {
                    evaluation: k,
                    genes: vec![],
                    objectives: objectives.to_vec(),
                })
            })
            .collect();
        assert_eq!(taken, [true, false, true, false, true, false]);
        let front: Vec<usize> = archive.front().iter().map(|one| one.evaluation).collect();
        assert_eq!(front, [2, 4]);
        assert_eq!(archive.best(1).unwrap().evaluation, 4);
    }
}
