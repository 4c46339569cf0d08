//! Kinetic laws of solids, one a file.
//!
//! A law is stated by its conversion α over the reduced time x = ∫ k dt (docs/theory.md, TUN-3): the inverse of its integral
//! form g(α) = x, so that no law needs a seed at α = 0 and none is stiff at its end.

mod contracting;
mod conversion;
mod diffusion;
mod nucleation;
mod order;
mod power;
mod random_pore;

pub use contracting::{CONTRACTING_AREA, CONTRACTING_VOLUME};
pub use conversion::KineticLaw;
pub use diffusion::{DIFFUSION_1, DIFFUSION_2, DIFFUSION_3, DIFFUSION_4};
pub use nucleation::{AVRAMI, AVRAMI_2, AVRAMI_3};
pub use order::{FIRST_ORDER, REACTION_ORDER};
pub use power::POWER_LAW;
pub use random_pore::RANDOM_PORE;

use calcine_physics::law::{LawEntry, LawValues};

/// All kinetic laws by their names.
pub const CONVERSION_LAWS: &[&LawEntry<dyn KineticLaw>] = &[
    &FIRST_ORDER,
    &REACTION_ORDER,
    &CONTRACTING_AREA,
    &CONTRACTING_VOLUME,
    &AVRAMI_2,
    &AVRAMI_3,
    &AVRAMI,
    &POWER_LAW,
    &RANDOM_PORE,
    &DIFFUSION_1,
    &DIFFUSION_2,
    &DIFFUSION_3,
    &DIFFUSION_4,
];

/// A law by its name; `None` where there is none of that name. `A1` is `F1`.
pub fn conversion_law(name: &str) -> Option<&'static LawEntry<dyn KineticLaw>> {
    let name = if name == "A1" { "F1" } else { name };
    CONVERSION_LAWS.iter().find(|law| law.name == name).copied()
}

/// Values of a law's own numbers where a case states none.
pub fn law_defaults(law: &LawEntry<dyn KineticLaw>) -> Vec<f64> {
    let numbers = law.parameters.iter();
    numbers.map(|one| one.default.unwrap_or(1.0)).collect()
}

/// A law with the defaults of its numbers.
pub fn default_law(name: &str) -> Option<Box<dyn KineticLaw>> {
    let law = conversion_law(name)?;
    Some((law.make)(&LawValues::from(law_defaults(law))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_inverts_its_integral_form_and_has_the_slopes_of_its_quotients() {
        for entry in CONVERSION_LAWS {
            let law = default_law(entry.name).unwrap();
            assert_eq!(law.name(), entry.name);
            for alpha in [0.02, 0.1, 0.3, 0.5, 0.8, 0.95] {
                let x = law.reduced_time(alpha);
                let [value, slope, curvature] = law.at(x);
                assert!(
                    (value - alpha).abs() < 1e-10,
                    "{} {alpha}: {value}",
                    entry.name
                );
                let h = 1e-4 * x;
                let [below, before, _] = law.at(x - h);
                let [above, after, _] = law.at(x + h);
                let quotient = (above - below) / (2.0 * h);
                // Second order in 1e-4.
                assert!(
                    (slope / quotient - 1.0).abs() < 1e-5,
                    "{} {alpha}",
                    entry.name
                );
                let second = (after - before) / (2.0 * h);
                assert!(
                    (curvature - second).abs() < 1e-4 * (second.abs() + slope / x),
                    "{} {alpha}: {curvature} {second}",
                    entry.name
                );
            }
        }
    }

    #[test]
    fn conversion_starts_at_zero_rises_and_never_passes_one() {
        for entry in CONVERSION_LAWS {
            let law = default_law(entry.name).unwrap();
            let mut before = law.conversion(0.0);
            assert_eq!(before, 0.0, "{}", entry.name);
            for k in 1..2000 {
                let [now, slope, curvature] = law.at(1e-6 * 1.02f64.powi(k));
                assert!(now >= before && now <= 1.0 && slope >= 0.0 && curvature.is_finite());
                before = now;
            }
            assert!(before > 0.999, "{}: {before}", entry.name);
        }
    }

    #[test]
    fn the_first_avrami_law_is_first_order_and_unknown_names_are_none() {
        assert_eq!(default_law("A1").unwrap().name(), "F1");
        assert!(conversion_law("Z9").is_none());
    }
}
