//! What of the boundary of a case's gas is likely not meant.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasPatch, InletFlow};

use super::model::Case;
use super::units::{short3, shown};

/// Share of a pressure by which another differs that is no longer a head of flow: between 1 bar and 1 atm it is 0.013.
const UNIT_SLIP: f64 = 5e-3;
/// Ratio of two pressures of one gas above which one of them is likely wrong.
const FAR: f64 = 1.1;
/// Share of the weight of a column of gas below which a difference of pressures does not hold it.
const LACKING: f64 = 0.25;

/// Warnings, in a fixed order.
pub(super) fn all(case: &Case) -> Vec<String> {
    let mut all = intensities(case);
    all.extend(far_pressures(case));
    all.extend(driving_pressures(case));
    all.extend(closed_inlets(case));
    all
}

/// Inlets of a gas that has no way out.
fn closed_inlets(case: &Case) -> Option<String> {
    if case.gas_held || !open(case).is_empty() {
        return None;
    }
    let mut inlets = case.gas.patches.iter().filter_map(|(name, patch)| {
        let GasPatch::Inlet { flow, .. } = patch else {
            return None;
        };
        let (InletFlow::SuperficialVelocity(over_time) | InletFlow::MassFlow(over_time)) = flow;
        over_time
            .0
            .iter()
            .any(|(_, value)| *value > 0.0)
            .then_some(name)
    });
    inlets.next().map(|name| {
        format!(
            "gas comes in through `{name}`, and no patch lets it out: its pressure rises as long as the inlet flows; make a patch an \
             `outlet` or an `opening` if that is not meant"
        )
    })
}

/// Fluctuations larger than the mean flow.
fn intensities(case: &Case) -> Vec<String> {
    let patches = case.gas.patches.iter();
    let eddies = patches.filter_map(|(name, patch)| match patch {
        GasPatch::Inlet {
            turbulence: Some(eddies),
            ..
        } => Some((name, eddies.intensity)),
        _ => None,
    });
    let wild = eddies.filter(|(_, intensity)| *intensity > 1.0);
    wild.map(|(name, intensity)| {
        format!(
            "the intensity of turbulence at `{name}` is {}: its fluctuations are larger than its mean flow; it is a fraction, so \
             that {} percent is {}",
            shown(intensity),
            shown(intensity),
            shown(intensity / 100.0)
        )
    })
    .collect()
}

/// Patches through which pressure drives gas: name, pressure in Pa at the start, and height along gravity in m where it
/// holds, of those that say.
fn open(case: &Case) -> Vec<(&str, f64, Option<f64>)> {
    let gravity = case.gas.gravity;
    let up = |at: Vec3| match gravity.norm() {
        0.0 => 0.0,
        norm => -at.dot(&gravity) / norm,
    };
    let patches = case.gas.patches.iter();
    let open = patches.filter_map(|(name, patch)| match patch {
        GasPatch::Outlet { pressure, .. } => Some((name.as_str(), pressure.at(0.0), None)),
        GasPatch::Opening { pressure, at, .. } => {
            Some((name.as_str(), pressure.at(0.0), Some(up(*at))))
        }
        _ => None,
    });
    open.collect()
}

/// Pressures of patches that have little to do with that of the gas at the start.
fn far_pressures(case: &Case) -> Vec<String> {
    // A density that is stated follows none.
    if !case.gas.properties.compressible() {
        return Vec::new();
    }
    let start = case.gas.pressure;
    let far = |pressure: &f64| *pressure > FAR * start || start > FAR * pressure;
    let patches = case.gas.patches.iter().filter_map(|(name, patch)| {
        let (GasPatch::Outlet { pressure, .. } | GasPatch::Opening { pressure, .. }) = patch else {
            return None;
        };
        let mut entries = pressure.0.iter().map(|entry| entry.1);
        Some((name, entries.find(far)?))
    });
    patches
        .map(|(name, pressure)| {
            format!(
                "`{name}` has a pressure of {} Pa, but `gas.initial.pressure` is {} Pa, which its density follows: the patch \
                 sets the level of the pressures alone; write the same in both",
                shown(pressure),
                shown(start)
            )
        })
        .collect()
}

/// Pairs of open patches whose pressures differ as units do.
fn driving_pressures(case: &Case) -> Vec<String> {
    let gas = &case.gas;
    let density = gas
        .properties
        .density(gas.pressure, gas.temperature, &gas.composition);
    let open = open(case);
    let pairs = open.iter().enumerate();
    let pairs = pairs.flat_map(|(k, one)| open[k + 1..].iter().map(move |other| (one, other)));
    let driven = pairs.filter_map(|(one, other)| {
        // Gas at rest has its own weight between heights.
        let weight = match (one.2, other.2) {
            (Some(low), Some(high)) => density * gas.gravity.norm() * (high - low),
            _ => 0.0,
        };
        let head = (one.1 - other.1 - weight).abs();
        (head > UNIT_SLIP * one.1.min(other.1)).then_some((one, other, head))
    });
    driven
        .map(|(one, other, head)| {
            format!(
                "`{}` and `{}` have pressures of {} and {}: where nothing resists, the difference drives {:.0} m/s; 1 atm is \
                 101325 Pa, 1 bar 100000 Pa",
                one.0,
                other.0,
                pressure_at(one),
                pressure_at(other),
                (2.0 * head / density).sqrt()
            )
        })
        .collect()
}

/// A pressure with the height where it holds, in words.
fn pressure_at((_, pressure, height): &(&str, f64, Option<f64>)) -> String {
    match height {
        Some(height) => format!("{} Pa at {} m of height", shown(*pressure), short3(*height)),
        None => format!("{} Pa", shown(*pressure)),
    }
}

/// Outlets that stand at another height than an opening and have its pressure, without the weight of the gas between them.
pub(super) fn columns(case: &Case, mesh: &Mesh) -> Vec<String> {
    let gas = &case.gas;
    let gravity = gas.gravity.norm();
    let openings = gas.patches.iter().filter_map(|(name, patch)| match patch {
        GasPatch::Opening {
            pressure,
            at,
            gas: outside,
        } => Some((name, pressure.at(0.0), *at, outside)),
        _ => None,
    });
    let Some((opening, pressure, at, outside)) = openings.into_iter().next() else {
        return Vec::new();
    };
    let composition = outside.composition.as_ref().map(|one| one.at(0.0));
    let density = gas.properties.density(
        pressure,
        outside.temperature.at(0.0),
        &composition.unwrap_or_default(),
    );
    let outlets = gas.patches.iter().filter_map(|(name, patch)| match patch {
        GasPatch::Outlet { pressure, .. } => Some((name, pressure.at(0.0))),
        _ => None,
    });
    let lacking = outlets.filter_map(|(name, own)| {
        let height = (at - centre(mesh, name)?).dot(&gas.gravity) / gravity;
        let weight = density * gravity * height;
        // A suction, or a head that is meant, differs by another number.
        let lacks = weight != 0.0 && (pressure - own).abs() < LACKING * weight.abs();
        lacks.then(|| {
            let due = pressure - weight;
            format!(
                "`{name}` has the pressure of the opening `{opening}`, {} Pa, but lies {} m {} where that holds: without the weight of the \
                 gas between them, {} Pa, gas is driven through the domain against its buoyancy; write {} Pa, or make it an opening too",
                shown(own),
                short3(height.abs()),
                if height > 0.0 { "above" } else { "below" },
                short3(weight.abs()),
                format_args!("{due:.3}")
            )
        })
    });
    lacking.collect()
}

/// Centre in m of a patch.
pub(super) fn centre(mesh: &Mesh, name: &str) -> Option<Vec3> {
    let faces = mesh.patch(name)?.faces();
    let parts = faces.map(|face| (mesh.face_centre()[face], mesh.face_area()[face].norm()));
    let (sum, area) = parts.fold((Vec3::zeros(), 0.0), |(sum, area), (at, own)| {
        (sum + at * own, area + own)
    });
    (area > 0.0).then(|| sum / area)
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};
    use crate::case::warnings::tests::warned;

    #[test]
    fn an_outlet_above_an_opening_at_the_same_pressure_is_told() {
        let lacks = |pressure: &str| {
            let outlet = format!(
                "gas.patch.top={{ outlet = {{ pressure = \"{pressure}\", backflow = {{ temperature = \"300 K\" }} }} }}"
            );
            let all = warned("chimney", &[&outlet]);
            all.into_iter()
                .find(|one| one.contains("has the pressure of the opening"))
        };
        let text = lacks("1 atm").unwrap();
        assert!(
            text.starts_with("`top` has the pressure of the opening `bottom`, 101325 Pa, but lies 0.2 m above where that holds"),
            "{text}"
        );
        // 1.177 kg/m^3 of air over 0.2 m.
        assert!(
            text.contains("2.31 Pa") && text.contains("write 101322.692 Pa"),
            "{text}"
        );
        assert_eq!(lacks("101322.69 Pa"), None);
        assert_eq!(lacks("101300 Pa"), None);
    }

    #[test]
    fn gas_that_has_no_way_out_is_told() {
        let closed = r#"gas.patch.top={ wall = { velocity = "no-slip", heat = "adiabatic" } }"#;
        let text = one("turbulent-duct", &[closed]);
        assert!(
            text.contains("through `bottom`, and no patch lets it out"),
            "{text}"
        );
        let still = "gas.patch.bottom.inlet.superficial_velocity=0 m/s";
        assert!(said("turbulent-duct", &[closed, still]).is_empty());
    }

    #[test]
    fn intensities_above_one_are_told_as_percent() {
        let text = one(
            "turbulent-duct",
            &["gas.patch.bottom.inlet.turbulence.intensity=5"],
        );
        assert!(
            text.contains("at `bottom` is 5") && text.contains("5 percent is 0.05"),
            "{text}"
        );
        let key = "gas.patch.bottom.inlet.turbulence.intensity=1";
        assert!(said("turbulent-duct", &[key]).is_empty());
    }

    #[test]
    fn pressures_that_drive_a_gale_or_are_not_those_of_the_density_are_told() {
        let text = one("turbulent-duct", &["gas.patch.top.outlet.pressure=2 atm"]);
        assert!(text.contains("`top` has a pressure of 202650 Pa"), "{text}");
        assert!(
            said(
                "turbulent-duct",
                &["gas.patch.top.outlet.pressure=1.05 atm"]
            )
            .is_empty()
        );
        // √(2 · 1325 Pa/(1.17 kg/m³)) of either opening against the third patch.
        let west = "gas.patch.west.opening.pressure=1 bar";
        let told = said("open-box", &[west]);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains("drives 48 m/s"), "{told:?}");
        let named = |name: &str| told.iter().all(|one| one.contains(name));
        assert!(named("`west`") && named("1 bar 100000 Pa"), "{told:?}");
    }

    #[test]
    fn surroundings_of_one_column_of_air_drive_nothing_at_any_height() {
        // 100 m of air of 300 K weigh 1154 Pa, more than a slip of units of half a percent.
        let set = [
            "gas.patch.east.opening.pressure=100171 Pa",
            "gas.patch.east.opening.pressure_at=0 0 100 m",
        ];
        assert!(
            said("open-box", &set)
                .iter()
                .all(|one| !one.contains("`west`"))
        );
    }
}
