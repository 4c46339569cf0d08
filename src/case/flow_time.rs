//! Whether the motion clock of an accelerated run leaves the gas the time in which its flow develops.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::{GasPatch, InletFlow, ParticleSetup, Schedule};

use super::model::Case;
use super::units::{short, short3};
use super::{buoyancy, span, step};

/// Times of free fall through the height after which a flow by buoyancy is developed: tanh 2 is 0.96.
const FALLS: f64 = 2.0;
/// Share of its size by which a boundary value changes that the flow has to follow.
const CHANGE: f64 = 0.1;
/// Factor by which a shorter process step is looked for.
const SHORTER: f64 = 0.9;

/// The motion time that the flow of a case needs.
struct Need {
    /// In s.
    motion: f64,
    /// For what, with numbers.
    what: String,
}

/// A warning where the motion time of the run, or about a change of the gas' boundary, is short against what the flow
/// needs.
pub(super) fn warning(
    case: &Case,
    mesh: &Mesh,
    setup: &ParticleSetup,
    void_fraction: f64,
) -> Option<String> {
    let time = &case.time;
    let end = time.end.seconds();
    if case.gas_held || !span::is_accelerated(time, [0.0, end]) {
        return None;
    }
    let need = need(case, mesh, free_space(case, mesh, setup, void_fraction))?;
    let whole = span::motion_time(time, [0.0, end]);
    let (fact, share) = if whole < need.motion {
        let fact = format!("the run has {} s of motion time", short3(whole));
        (fact, whole / need.motion)
    } else {
        let change = hasty(case, need.motion)?;
        let fact = format!(
            "`{}` changes at {} s, and changes again or the run ends after {} s of motion time",
            change.key,
            short(change.at),
            short3(change.motion)
        );
        (fact, change.motion / need.motion)
    };
    Some(format!(
        "{fact}, but {}: the flow does not develop; {}, or run longer (a run that begins `--from` another has its flow)",
        need.what,
        remedy(case, mesh, share, whole / share)
    ))
}

/// What makes the motion clock slower; `share`: of what is needed that there is; `whole`: motion time in s of the run that
/// would do.
fn remedy(case: &Case, mesh: &Mesh, share: f64, whole: f64) -> String {
    let end = case.time.end.seconds();
    let stated = case.time.process_step.iter().flatten();
    let Some(stated) = stated.map(|(_, step)| *step).max() else {
        let factor = (case.time.acceleration.largest() * share).max(1.0);
        return format!("lower `time.acceleration` to {} or less", short3(factor));
    };
    let mut shorter = stated.seconds();
    while end / shorter * step::motion_span(case, mesh, shorter) < whole
        && step::motion_span(case, mesh, shorter) < shorter
    {
        shorter *= SHORTER;
    }
    format!(
        "shorten `time.process_step` to {} s or less",
        format!("{shorter:.1e}")
            .parse()
            .map_or(shorter, |one: f64| one)
    )
}

/// The shorter of the times in which inlets renew the gas and in which buoyancy accelerates it; `None` where neither is
/// there.
fn need(case: &Case, mesh: &Mesh, free: f64) -> Option<Need> {
    let both = [passage(case, mesh, free), buoyant(case, mesh)];
    let needs = both.into_iter().flatten();
    needs.min_by(|one, other| one.motion.total_cmp(&other.motion))
}

/// Volume in m³ outside the bed, in which drag brings the gas to its speed within milliseconds.
fn free_space(case: &Case, mesh: &Mesh, setup: &ParticleSetup, void_fraction: f64) -> f64 {
    let whole: f64 = mesh.cell_volume().iter().sum();
    if case.laws.drag.is_none() {
        return whole;
    }
    let radii = setup.radius.iter().enumerate();
    let solid: f64 = radii
        .map(|(row, radius)| setup.weight_of(row) * sphere::volume(*radius))
        .sum();
    (whole - solid / (1.0 - void_fraction)).max(0.0)
}

/// By inlets: the free space in m³ over what flows in at most.
fn passage(case: &Case, mesh: &Mesh, free: f64) -> Option<Need> {
    let inlets = case
        .gas
        .patches
        .iter()
        .filter(|(_, patch)| matches!(patch, GasPatch::Inlet { .. }));
    let flow: f64 = inlets
        .map(|(name, patch)| step::fastest_in(case, mesh, name, patch) * step::area(mesh, name))
        .sum();
    (flow > 0.0 && flow.is_finite()).then(|| Need {
        motion: free / flow,
        what: format!(
            "what flows in needs {} s to pass once through the space outside the bed ({} m^3 at {} m^3/s)",
            short3(free / flow),
            short3(free),
            short3(flow)
        ),
    })
}

/// By buoyancy: 2 √(2 H/(g β)), β of the coldest and hottest temperature that the case states.
fn buoyant(case: &Case, mesh: &Mesh) -> Option<Need> {
    let gravity = case.gas.gravity.norm();
    let (coldest, hottest) = buoyancy::temperatures(case);
    let height = buoyancy::height(case, mesh);
    let ratio = (hottest - coldest) / coldest;
    let motion = FALLS * (2.0 * height / (gravity * ratio)).sqrt();
    (gravity > 0.0 && ratio > 0.0 && motion.is_finite()).then(|| Need {
        motion,
        what: format!(
            "buoyancy needs {} s to accelerate the gas over the height of {} m (2 sqrt(2 H/(g beta)), beta {} of {} and {} K)",
            short3(motion),
            short3(height),
            short3(ratio),
            short(coldest),
            short(hottest)
        ),
    })
}

/// A change of a boundary value that leaves the flow too little time.
struct Change {
    /// The patch.
    key: String,
    /// Process time in s at which it is through.
    at: f64,
    /// Motion time in s that is left until the next one, or the end.
    motion: f64,
}

/// The first change that passes within the motion time in s that the flow needs and is not followed by so much rest.
fn hasty(case: &Case, need: f64) -> Option<Change> {
    let time = &case.time;
    let end = time.end.seconds();
    let whole = span::motion_time(time, [0.0, end]);
    for (key, schedule) in schedules(case) {
        let size = schedule.0.iter().map(|one| one.1.abs());
        let size = size.fold(0.0, f64::max);
        let differs =
            |from: f64, to: f64| (schedule.at(from) - schedule.at(to)).abs() > CHANGE * size;
        let entries = schedule.0.iter().map(|one| one.0);
        for at in entries.filter(|at| (0.0..=end).contains(at)) {
            let passed = span::motion_time(time, [0.0, at]);
            let before = span::process_after(time, 0.0, (passed - need).max(0.0));
            let left = whole - passed;
            let after = span::process_after(time, 0.0, passed + need);
            let rests = left >= need && !differs(at, after);
            if at > 0.0
                && differs(before, at)
                && !rests
                && span::is_accelerated(time, [before, after])
            {
                let next = schedule.0.iter().map(|one| one.0);
                let next = next.filter(|next| differs(at, *next) && *next > at);
                let until = next.fold(end, f64::min);
                return Some(Change {
                    key,
                    at,
                    motion: span::motion_time(time, [at, until]),
                });
            }
        }
    }
    None
}

/// Boundary values of the gas over time, with the patches that have them.
fn schedules(case: &Case) -> Vec<(String, &Schedule)> {
    let patches = case.gas.patches.iter();
    let all = patches.flat_map(|(name, patch)| {
        let own = match patch {
            GasPatch::Inlet { flow, .. } => {
                let (InletFlow::SuperficialVelocity(over_time) | InletFlow::MassFlow(over_time)) =
                    flow;
                Some(over_time)
            }
            GasPatch::Outlet { pressure, .. } | GasPatch::Opening { pressure, .. } => {
                Some(pressure)
            }
            _ => None,
        };
        let entering = patch.entering().map(|one| one.0);
        let of_patch = own.into_iter().chain(entering);
        of_patch.map(move |schedule| (format!("gas.patch.{name}"), schedule))
    });
    all.filter(|(_, schedule)| schedule.0.len() > 1).collect()
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    fn told(name: &str, set: &[&str]) -> Vec<String> {
        let all = warned(name, set);
        all.into_iter()
            .filter(|one| one.contains("the flow does not develop"))
            .collect()
    }

    #[test]
    fn a_chimney_that_has_less_motion_time_than_buoyancy_needs_is_told() {
        // Measured: 0.523 m/s with 0.5 and 2 s, 0.137 m/s with 10 s, 0.002 m/s with 60 s.
        for step in ["0.5 s", "2 s"] {
            let set = format!("time.process_step={step}");
            assert_eq!(told("chimney", &[&set]), [""; 0], "{step}");
        }
        for step in ["10 s", "60 s"] {
            let set = format!("time.process_step={step}");
            assert_eq!(told("chimney", &[&set]).len(), 1, "{step}");
        }
        assert_eq!(
            told("chimney", &["time.process_step=10 s"]),
            [
                "the run has 0.0183 s of motion time, but buoyancy needs 0.404 s to accelerate the gas over the height of 0.2 m (2 \
                 sqrt(2 H/(g beta)), beta 1 of 300 and 600 K): the flow does not develop; shorten `time.process_step` to 2.1 s or \
                 less, or run longer (a run that begins `--from` another has its flow)"
            ]
        );
    }

    #[test]
    fn the_step_that_is_named_is_short_enough() {
        let all = told("chimney", &["time.process_step=10 s"]).concat();
        let step = all.split("`time.process_step` to ").nth(1).unwrap();
        let step = step.split(" s or less").next().unwrap();
        let set = format!("time.process_step={step} s");
        assert_eq!(told("chimney", &[&set]), [""; 0]);
    }

    #[test]
    fn without_acceleration_the_flow_is_followed_as_it_is() {
        assert_eq!(told("open-box", &["time.end=10 ms"]), [""; 0]);
        let all = told("open-box", &["time.acceleration=10"]).concat();
        assert!(
            all.contains("0.1 s of motion time")
                && all.contains("lower `time.acceleration` to 2.02 or less"),
            "{all}"
        );
    }

    #[test]
    fn a_change_shortly_before_the_end_or_the_next_one_is_told_and_a_slow_one_is_not() {
        let inlet =
            |values: &str| format!("gas.patch.bottom.inlet.superficial_velocity=[{values}]");
        // 12 s of motion time over 10 min.
        let told = |values: &str| told("two-populations", &[&inlet(values)]);
        assert_eq!(
            told("[\"0 s\", \"0.4 m/s\"], [\"10 min\", \"0.8 m/s\"]"),
            [""; 0]
        );
        let all =
            told("[\"0 s\", \"0.4 m/s\"], [\"599.4 s\", \"0.4 m/s\"], [\"599.5 s\", \"0.8 m/s\"]")
                .concat();
        assert!(
            all.starts_with("`gas.patch.bottom` changes at 599.5 s")
                && all.contains("after 0.01 s of motion time"),
            "{all}"
        );
    }
}
