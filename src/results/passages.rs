//! What passes patches of the gas and outlets of particles, as measures tell it.

use calcine_coupler::observer::CommittedState;
use calcine_coupler::outflows::OutletTotals;
use calcine_coupler::part::PatchFlow;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::time::Ticks;
use serde::{Deserialize, Serialize};

use crate::case::model::{Case, Discharged, ForcePart, Measure, Passing};

/// What had left through each outlet at past times, as far back as a measure looks: between two marks it grew evenly.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct OutflowTrail {
    /// Process time in ps, and the totals of each population at each outlet by then; after the last mark nothing left. The first is
    /// the start of the run.
    marks: Vec<(i64, Vec<[f64; 5]>)>,
}

impl OutflowTrail {
    /// Notes what has left by now; measures look back by so many ps at most.
    pub fn note(&mut self, moment: &CommittedState<'_>, reach: i64) {
        let began = moment.window.map(|window| window.start.process.count());
        let totals = moment.outlets.iter().map(OutletTotals::numbers).collect();
        self.mark(began, moment.clocks.process.count(), totals, reach);
    }

    /// Notes the totals at a time, which were those of the last mark until the window began.
    fn mark(&mut self, began: Option<i64>, now: i64, totals: Vec<[f64; 5]>, reach: i64) {
        let last = self.marks.last();
        if last.is_none_or(|last| last.1 != totals) {
            // What left in this window left evenly over it, and nothing between the last mark and its start.
            let still = began.zip(last).filter(|(began, last)| *began > last.0);
            let still = still.map(|(began, last)| (began, last.1.clone()));
            self.marks.extend(still);
            self.marks.push((now, totals));
        }
        // The start stays, and of what is too far back the last.
        let far = self.marks.partition_point(|mark| mark.0 <= now - reach);
        self.marks.drain(1..far.saturating_sub(1).max(1));
    }

    /// What of a population, or all, left through an outlet, or all, over a time up to now or since the start; and the span in s.
    /// Of a window in which this time begins it takes the part after that.
    fn since(
        &self,
        moment: &CommittedState<'_>,
        (outlet, population): (Option<usize>, Option<usize>),
        over: Option<Ticks>,
    ) -> (OutletTotals, f64) {
        let now = moment.clocks.process.count();
        let begin = self.marks.first().map_or(0, |mark| mark.0);
        let from = over.map_or(begin, |over| (now - over.count()).max(begin));
        let mut sum = [0.0; 5];
        for (place, totals) in moment.outlets.iter().enumerate() {
            let others = outlet.is_some_and(|only| only != totals.outlet)
                || population.is_some_and(|only| only != totals.population as usize);
            if others {
                continue;
            }
            let before = self.totals_at(from, place);
            for ((sum, total), before) in sum.iter_mut().zip(totals.numbers()).zip(before) {
                *sum += total - before;
            }
        }
        (
            OutletTotals::default().with_numbers(sum),
            Ticks::new(now - from).seconds(),
        )
    }

    /// What of one population had left through one outlet by a time in ps that lies within the marks.
    fn totals_at(&self, time: i64, place: usize) -> [f64; 5] {
        let numbers = |mark: &(i64, Vec<[f64; 5]>)| mark.1.get(place).copied().unwrap_or_default();
        let next = self.marks.partition_point(|mark| mark.0 <= time);
        let Some(before) = next.checked_sub(1).and_then(|last| self.marks.get(last)) else {
            return [0.0; 5];
        };
        let mut totals = numbers(before);
        if let Some(after) = self.marks.get(next).filter(|_| before.0 < time) {
            let share = (time - before.0) as f64 / (after.0 - before.0) as f64;
            for (total, later) in totals.iter_mut().zip(numbers(after)) {
                *total += share * (later - *total);
            }
        }
        totals
    }
}

/// By how many ps of process time measures of a case look back.
pub(super) fn reach(case: &Case) -> i64 {
    let over = case.quantities.iter().map(|one| match one.measure {
        Measure::Discharge { over, .. } => over.map_or(0, Ticks::count),
        _ => 0,
    });
    over.max().unwrap_or(0)
}

/// What of a population, or all, left through an outlet, or all; NaN for the mean of none.
pub(super) fn discharge(
    moment: &CommittedState<'_>,
    trail: &OutflowTrail,
    what: Discharged,
    of: (Option<usize>, Option<usize>),
    over: Option<Ticks>,
) -> f64 {
    let (left, span) = trail.since(moment, of, over);
    match what {
        Discharged::MassFlow => left.mass / span,
        Discharged::Mass => left.mass,
        Discharged::Count => left.particles,
        Discharged::ResidenceTime => left.mean_age(),
        Discharged::ResidenceDeviation => left.age_deviation(),
    }
}

/// What passed a patch in the last window; none before the first, and of a gas that does not tell.
fn passed<'a>(moment: &CommittedState<'a>, patch: &str) -> Option<&'a PatchFlow> {
    let mut patches = moment.mesh.patches().iter();
    let place = patches.position(|one| one.name == patch)?;
    moment.patch_flows.get(place)
}

/// What flows through a patch into the gas: of species the one of a column.
pub(super) fn flow(
    moment: &CommittedState<'_>,
    what: Passing,
    patch: &str,
    column: Option<usize>,
) -> f64 {
    let of = |flow: &PatchFlow| match what {
        Passing::Heat => Some(flow.heat),
        Passing::Mass => Some(flow.mass),
        Passing::Species => flow.species.get(column?).copied(),
    };
    passed(moment, patch).and_then(of).unwrap_or(f64::NAN)
}

/// Mean by mass flow of what flows through a patch over the last window, of the net flow where some of it comes back: of a mass
/// fraction Σ φ Y/Σ φ; of the temperature that of gas with this composition and the enthalpy Σ φ h/Σ φ (mixing-cup temperature).
/// NaN before the first window, and where no gas flows.
pub(super) fn flow_mean(
    moment: &CommittedState<'_>,
    gas: &GasModel,
    patch: &str,
    (field, column): (&str, Option<usize>),
    guess: f64,
) -> f64 {
    let Some(flow) = passed(moment, patch).filter(|flow| flow.mass != 0.0) else {
        return f64::NAN;
    };
    let composition: Vec<f64> = flow.species.iter().map(|one| one / flow.mass).collect();
    match field {
        "temperature" => gas.temperature(flow.heat / flow.mass, &composition, guess),
        _ => {
            let own = column.and_then(|column| composition.get(column));
            own.copied().unwrap_or(f64::NAN)
        }
    }
}

/// Force in N of the gas on a wall along a direction; NaN before the first window.
pub(super) fn force(
    moment: &CommittedState<'_>,
    part: ForcePart,
    patch: &str,
    along: &Vec3,
    reference: f64,
) -> f64 {
    if moment.windows == 0 {
        return f64::NAN;
    }
    let viscous = || passed(moment, patch).map_or(f64::NAN, |flow| -flow.momentum.dot(along));
    match part {
        ForcePart::Pressure => pressure_force(moment, patch, along, reference),
        ForcePart::Viscous => viscous(),
        ForcePart::Total => pressure_force(moment, patch, along, reference) + viscous(),
    }
}

/// Σ (p_f − p₀) S_f along a direction, with S_f out of the gas and the pressure at face centres, p_f = p_c + ∇p·(x_f − x_c).
fn pressure_force(moment: &CommittedState<'_>, patch: &str, along: &Vec3, reference: f64) -> f64 {
    let mesh = moment.mesh;
    let Some(patch) = mesh.patch(patch) else {
        return f64::NAN;
    };
    let on_face = |face: usize| {
        let cell = mesh.owner()[face] as usize;
        let arm = mesh.face_centre()[face] - mesh.cell_centre()[cell];
        let pressure = moment.gas.pressure[cell] + moment.gas.pressure_gradient[cell].dot(&arm);
        (pressure - reference) * mesh.face_area()[face].dot(along)
    };
    patch.faces().map(on_face).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Windows of 14 ps: one in which nothing leaves, and three that 7, 14 and 28 leave in.
    fn trail(reach: i64) -> OutflowTrail {
        let mut trail = OutflowTrail::default();
        trail.mark(None, 0, Vec::new(), reach);
        trail.mark(Some(0), 14, Vec::new(), reach);
        for (end, all) in [(28, 7.0), (42, 21.0), (56, 49.0)] {
            trail.mark(Some(end - 14), end, vec![[all; 5]], reach);
        }
        trail
    }

    #[test]
    fn of_a_window_in_which_the_time_begins_counts_the_part_after_it() {
        let trail = trail(100);
        let by = |time| trail.totals_at(time, 0)[0];
        assert_eq!([by(0), by(7), by(14)], [0.0; 3]);
        assert_eq!([by(16), by(28), by(35)], [1.0, 7.0, 14.0]);
        assert_eq!([by(42), by(43), by(56), by(60)], [21.0, 23.0, 49.0, 49.0]);
        assert_eq!(trail.totals_at(43, 1), [0.0; 5]);
    }

    #[test]
    fn of_what_is_too_far_back_stays_what_the_oldest_time_needs() {
        let short = trail(10);
        assert_eq!(short.marks.len(), 3);
        let all = trail(100);
        for time in 46..=56 {
            assert_eq!(short.totals_at(time, 0), all.totals_at(time, 0));
        }
    }
}
