//! Linear springs and dashpots of a stated stiffness.

use super::{ContactModel, PairConstants, Slip, Springs};

/// A linear spring of one stiffness for all pairs, and a tangential one of a share of it.
///
/// F = k δ, k_t = r k, γ_n = 2 β √(k m*), γ_t = 2 β √(k_t m*)
///
/// with the damping ratio β of the restitution. Young's moduli do not enter.
///
/// Validity: the duration of a contact, π √(m*/k)/√(1 − β²), and the restitution do not depend on the speed; r is 2/7 where a grazing
/// impact without slip is to swing back in step with the normal one, 2/3 to 1 by Mindlin.
///
/// Source: Cundall and Strack, Geotechnique 29 (1979) 47, doi 10.1680/geot.1979.29.1.47.
#[derive(Clone, Copy, Debug)]
pub struct LinearSprings {
    /// Normal stiffness k in N/m.
    pub stiffness: f64,
    /// k_t/k.
    pub tangential_ratio: f64,
}

impl ContactModel for LinearSprings {
    const SLIP: Slip = Slip::SpringKept;

    #[inline(always)]
    fn springs(
        &self,
        pair: &PairConstants,
        _prepared: f64,
        overlap: f64,
        _radius: f64,
        mass: f64,
    ) -> Springs {
        let damping = |stiffness: f64| 2.0 * pair.damping * (stiffness * mass).sqrt();
        let elastic = self.stiffness * overlap;
        let tangential_stiffness = self.tangential_ratio * self.stiffness;
        Springs {
            elastic,
            energy: 0.5 * elastic * overlap,
            normal_damping: damping(self.stiffness),
            tangential_stiffness,
            tangential_damping: damping(tangential_stiffness),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Linear, glass};
    use super::*;

    #[test]
    fn are_those_of_the_characteristic_speed_where_the_stiffness_is_its_own_and_the_ratio_is_one() {
        let (pair, radius, mass) = (glass(0.5), 1e-3, 1e-5);
        let other = Linear { speed: 2.0 };
        let stiffness = other.prepare(&pair, radius, mass);
        let law = LinearSprings {
            stiffness,
            tangential_ratio: 1.0,
        };
        assert_eq!(
            law.springs(&pair, 0.0, 1e-6, radius, mass),
            other.springs(&pair, stiffness, 1e-6, radius, mass)
        );
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // β of e = 0.5 is 0.215453762; k 1000 N/m, k_t 250 N/m, m* 10 mg.
        let law = LinearSprings {
            stiffness: 1000.0,
            tangential_ratio: 0.25,
        };
        let s = law.springs(&glass(0.5), 0.0, 2e-6, 1e-3, 1e-5);
        assert_eq!((s.elastic, s.tangential_stiffness), (2e-3, 250.0));
        assert!((s.energy / 2e-9 - 1.0).abs() < 1e-12);
        assert!(
            (s.normal_damping / 0.043_090_752_4 - 1.0).abs() < 1e-8,
            "{s:?}"
        );
        assert!((s.tangential_damping / 0.021_545_376_2 - 1.0).abs() < 1e-8);
    }
}
