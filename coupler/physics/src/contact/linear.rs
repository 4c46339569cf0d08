//! Linear spring and dashpot.

use super::{ContactModel, PairConstants, Slip, Springs};

/// A linear spring that overlaps as much as Hertz' law does when two spheres meet at a characteristic speed.
///
/// k = 16/15 E* √R* (15 m* V²/(16 E* √R*))^(1/5), F = k δ, γ_n = 2 β √(k m*), k_t = k, γ_t = γ_n
///
/// Validity: speeds near V; the duration of a contact, π√(m*/k)/√(1 − β²), does not depend on the speed.
///
/// Source: equality of the largest elastic energies, ½ k δ² = 8/15 E* √R* δ^2.5 = ½ m* V².
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// Characteristic speed V of impact in m/s.
    pub speed: f64,
}

impl ContactModel for Linear {
    const SLIP: Slip = Slip::SpringKept;

    /// The stiffness k in N/m.
    fn prepare(&self, pair: &PairConstants, radius: f64, mass: f64) -> f64 {
        let hertz = 16.0 / 15.0 * pair.young * radius.sqrt();
        hertz * (mass * self.speed * self.speed / hertz).powf(0.2)
    }

    #[inline(always)]
    fn springs(
        &self,
        pair: &PairConstants,
        stiffness: f64,
        overlap: f64,
        _radius: f64,
        mass: f64,
    ) -> Springs {
        let damping = 2.0 * pair.damping * (stiffness * mass).sqrt();
        let elastic = stiffness * overlap;
        Springs {
            elastic,
            energy: 0.5 * elastic * overlap,
            normal_damping: damping,
            tangential_stiffness: stiffness,
            tangential_damping: damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{HertzMindlin, glass};
    use super::*;

    #[test]
    fn overlaps_as_much_as_hertz_law_at_the_characteristic_speed() {
        let (pair, radius, mass) = (glass(1.0), 1e-3, 1e-5);
        let stiffness = Linear { speed: 2.0 }.prepare(&pair, radius, mass);
        // ½ k δ² = ½ m V²
        let overlap = 2.0 * (mass / stiffness).sqrt();
        let kinetic = 0.5 * mass * 4.0;
        let hertz = HertzMindlin.springs(&pair, 0.0, overlap, radius, mass);
        let linear = Linear { speed: 2.0 }.springs(&pair, stiffness, overlap, radius, mass);
        assert!((hertz.energy / kinetic - 1.0).abs() < 1e-13);
        assert!((linear.energy / kinetic - 1.0).abs() < 1e-13);
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // E* = 5.3333333e6, R* = 1e-3, m* = 1e-5, V = 2: 16/15 E* √R* = 179898.46, k = 179898.46 (2.2234838e-10)^0.2.
        let pair = glass(0.5);
        let law = Linear { speed: 2.0 };
        let stiffness = law.prepare(&pair, 1e-3, 1e-5);
        assert!((stiffness / 2_110.736_2 - 1.0).abs() < 1e-5, "{stiffness}");
        let s = law.springs(&pair, stiffness, 1e-6, 1e-3, 1e-5);
        let damping = 2.0 * 0.215_453_762 * (stiffness * 1e-5).sqrt();
        assert!((s.normal_damping / damping - 1.0).abs() < 1e-7);
    }
}
