//! Johnson, Kendall, Roberts.

use std::f64::consts::PI;

use super::PairConstants;

/// Energy of a contact at first touch, δ = 0, in units of 8/15 E* a_t⁵/R*²: −9 · 4^(4/3), from u³ = 4.
const MADE: f64 = -57.146_437_870_855_18;
/// δ R*/a_t² beyond which adhesion is below round-off of the circle of contact: u⁴ = y + 4 u is y to 1e-22.
const STRONG: f64 = 1e30;

/// What adhesion makes of an elastic contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdhesiveContact {
    /// Overlap in m at which Hertz' law has the same circle of contact: a²/R*.
    pub hertz_overlap: f64,
    /// What adhesion adds to the force of Hertz' law at that overlap, in N; negative.
    pub pull: f64,
    /// What it adds to the energy of Hertz' law at that overlap, in J; the energy of a contact at first touch is zero.
    pub energy: f64,
    /// Pull-off force in N.
    pub pull_off: f64,
}

impl AdhesiveContact {
    /// Of surfaces that do not attract each other, at an overlap in m.
    #[inline(always)]
    pub fn none(overlap: f64) -> Self {
        Self {
            hertz_overlap: overlap,
            pull: 0.0,
            energy: 0.0,
            pull_off: 0.0,
        }
    }
}

/// Radius a_t in m of the circle in which a contact tears off: a_t³ = π w R*²/(8 E*).
#[inline]
fn tear_off_radius(pair: &PairConstants, radius: f64) -> f64 {
    (PI * pair.work_of_adhesion * radius * radius / (8.0 * pair.young)).cbrt()
}

/// Distance of the surfaces in m at which a contact tears off: 3 a_t²/R*, a_t³ = π w R*²/(8 E*); effective radius in m.
#[inline]
pub fn tear_off_distance(pair: &PairConstants, radius: f64) -> f64 {
    let tear = tear_off_radius(pair, radius);
    3.0 * tear * tear / radius
}

/// Energy in J that is lost as a contact tears off, and with it in each contact that is made and broken slowly:
/// 8/15 (6 + 9 · 4^(4/3)) E* a_t⁵/R*² = 7.093 (w⁵ R*⁴/E*²)^(1/3); effective radius in m.
#[inline]
pub fn tear_off_energy(pair: &PairConstants, radius: f64) -> f64 {
    let tear = tear_off_radius(pair, radius);
    unit(pair, radius, tear) * (6.0 - MADE)
}

/// Adhesive elastic spheres: overlap δ and effective radius R* in m. Contact is made at δ = 0, and kept until it tears off at the
/// [distance](tear_off_distance) 3 a_t²/R*; in between a contact has a force only where it was made before.
///
/// δ = a²/R* − √(2π w a/E*), F = 4/3 E* a³/R* − √(8π w E* a³)
///
/// w is the work of adhesion in J/m², a the radius of the circle of contact. The contact is torn by 3/2 π w R*, at a³ = 3 a_t³; where
/// the distance is given, it holds down to a_t³ = π w R*²/(8 E*), where δ(a) is lowest, at 5/9 of that force.
///
/// With u = √(a/a_t) and y = δ R*/a_t² the first equation is u⁴ − 4 u = y, solved in closed form (Ferrari): u = ½ (√(2m) +
/// √(4 √(2/m) − 2m)), m³ + y m = 2. F = 4/3 E* a_t³/R* · u³ (u³ − 6), energy 8/15 E* a_t⁵/R*² · (u¹⁰ − 10 u⁷ + 15 u⁴) but for a constant.
///
/// Validity: soft, large particles and strong adhesion (Tabor's parameter (R* w²/(E*² z³))^(1/3) above 5, z the range of the attraction,
/// some 0.3 nm); contact radii small against the spheres.
///
/// Source: Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324 (1971) 301, doi 10.1098/rspa.1971.0141; a of δ in closed form as by
/// Parteli et al., Sci. Rep. 4 (2014) 6227, doi 10.1038/srep06227; energy lost by Thornton and Ning, Powder Technol. 99 (1998) 154,
/// doi 10.1016/S0032-5910(98)00099-0.
#[inline]
pub fn jkr(pair: &PairConstants, overlap: f64, radius: f64) -> AdhesiveContact {
    if pair.work_of_adhesion == 0.0 {
        return AdhesiveContact::none(overlap);
    }
    let tear = tear_off_radius(pair, radius);
    let root = root_of_contact_radius(overlap * radius / (tear * tear));
    let square = root * root;
    let (cube, fourth) = (square * root, square * square);
    AdhesiveContact {
        hertz_overlap: fourth * tear * tear / radius,
        pull: -8.0 * pair.young * tear.powi(3) / radius * cube,
        energy: unit(pair, radius, tear) * (fourth * (15.0 - 10.0 * cube) - MADE),
        pull_off: 1.5 * PI * pair.work_of_adhesion * radius,
    }
}

/// The largest root of u⁴ − 4 u = y, which is 1 at y = −3, below which there is none.
#[inline]
fn root_of_contact_radius(y: f64) -> f64 {
    if y > STRONG {
        return y.sqrt().sqrt();
    }
    let third = y / 3.0;
    // 1 + (y/3)³; at the tear-off distance round-off may make it negative.
    let discriminant = ((1.0 + third) * (1.0 - third + third * third)).max(0.0);
    let p = (1.0 + discriminant.sqrt()).cbrt();
    // m = p − q with p³ − q³ = 2, p q = y/3, without the difference.
    let q = third / p;
    let m = 2.0 / (p * p + p * q + q * q);
    let rest = (4.0 * (2.0 / m).sqrt() - 2.0 * m).max(0.0);
    0.5 * ((2.0 * m).sqrt() + rest.sqrt())
}

/// 8/15 E* a_t⁵/R*² in J.
#[inline]
fn unit(pair: &PairConstants, radius: f64, tear: f64) -> f64 {
    8.0 / 15.0 * pair.young * tear.powi(5) / (radius * radius)
}

#[cfg(test)]
mod tests {
    use super::super::{ContactModel, HertzMindlin, glass};
    use super::*;

    const RADIUS: f64 = 1e-3;

    fn sticky() -> PairConstants {
        PairConstants {
            work_of_adhesion: 0.2,
            ..glass(0.5)
        }
    }

    /// Force in N and energy in J at an overlap in m.
    fn law(overlap: f64) -> (f64, f64) {
        let pair = sticky();
        let adhesion = jkr(&pair, overlap, RADIUS);
        let springs = HertzMindlin.springs(&pair, 0.0, adhesion.hertz_overlap, RADIUS, 1e-5);
        (
            springs.elastic + adhesion.pull,
            springs.energy + adhesion.energy,
        )
    }

    /// The paper's overlap and force of a contact radius in m.
    fn paper(a: f64) -> (f64, f64) {
        let (young, w) = (sticky().young, 0.2);
        (
            a * a / RADIUS - (2.0 * PI * w * a / young).sqrt(),
            4.0 / 3.0 * young * a.powi(3) / RADIUS - (8.0 * PI * w * young * a.powi(3)).sqrt(),
        )
    }

    #[test]
    fn agrees_with_the_equations_of_the_paper_in_its_contact_radius() {
        // a_t³ = π w R*²/(8 E*)
        let tear = (PI * 0.2 * 1e-6 / (8.0 * 5.333_333_333_333_333e6)).cbrt();
        for share in [1.001, 1.2, 2.0, 2.52, 5.0, 30.0, 300.0] {
            let (overlap, force) = paper(share * tear);
            let found = law(overlap).0;
            let size = 3.0 * PI * 0.2 * RADIUS + force.abs();
            assert!(
                (found - force).abs() < 1e-11 * size,
                "{share}: {found} {force}"
            );
        }
    }

    #[test]
    fn pulls_off_at_the_published_force_and_tears_at_the_published_distance() {
        let pair = sticky();
        let tear = tear_off_distance(&pair, RADIUS);
        // 3/R* (π w R*²/(8 E*))^(2/3) by hand: 3e3 · (1.4726216e-14)^(2/3) = 1.8023897e-6
        assert!((tear / 1.802_389_67e-6 - 1.0).abs() < 1e-8, "{tear}");
        let forces = (0..=100_000).map(|k| law(-tear * f64::from(k) / 1e5).0);
        let lowest = forces.fold(0.0, f64::min);
        assert!((lowest / (-1.5 * PI * 0.2 * RADIUS) - 1.0).abs() < 1e-8);
        assert_eq!(jkr(&pair, 0.0, RADIUS).pull_off, 1.5 * PI * 0.2 * RADIUS);
        // At first touch 8/9 of it, where it tears off 5/9: from a_t³ = π w R*²/(8 E*), 16 a_t³.
        assert!((law(0.0).0 / lowest - 8.0 / 9.0).abs() < 1e-8);
        assert!((law(-tear).0 / lowest - 5.0 / 9.0).abs() < 1e-6);
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy_which_is_zero_at_first_touch() {
        assert!(law(0.0).1.abs() < 1e-12 * tear_off_energy(&sticky(), RADIUS));
        for overlap in [-1.5e-6, -1e-7, 1e-7, 1e-6, 1e-5, 1e-4] {
            let step = 1e-4 * overlap;
            let slope = (law(overlap + step).1 - law(overlap - step).1) / (2.0 * step);
            let force = law(overlap).0;
            assert!(
                (slope - force).abs() < 1e-6 * (force.abs() + 1e-3),
                "{overlap}"
            );
        }
    }

    #[test]
    fn a_contact_made_and_broken_loses_what_is_published() {
        let pair = sticky();
        let lost = tear_off_energy(&pair, RADIUS);
        // Thornton and Ning's 7.09 (Γ⁵ R⁴/E²)^(1/3); the quadrature of the force from 0 to the tear-off.
        let published = (0.2f64.powi(5) * RADIUS.powi(4) / pair.young.powi(2)).cbrt();
        assert!(
            (lost / (7.09 * published) - 1.0).abs() < 1e-3,
            "{}",
            lost / published
        );
        let tear = tear_off_distance(&pair, RADIUS);
        let count = 200_000;
        let sum: f64 = (0..count)
            .map(|k| {
                // δ = −δ_t (1 − s²): the force has a root at the end.
                let s = (f64::from(k) + 0.5) / f64::from(count);
                -law(-tear * (1.0 - s * s)).0 * tear * 2.0 * s / f64::from(count)
            })
            .sum();
        assert!((sum / lost - 1.0).abs() < 1e-8, "{}", sum / lost);
        assert!((law(-tear).1 / lost - 1.0).abs() < 1e-7);
    }

    #[test]
    fn without_adhesion_it_is_hertz_law_to_the_bit_and_with_little_nearly() {
        let none = jkr(&glass(0.5), 1e-6, RADIUS);
        assert_eq!(none, AdhesiveContact::none(1e-6));
        for work in [1e-12, 1e-30, 1e-60, 1e-300] {
            let little = PairConstants {
                work_of_adhesion: work,
                ..glass(0.5)
            };
            let found = jkr(&little, 1e-6, RADIUS);
            assert!(
                (found.hertz_overlap / 1e-6 - 1.0).abs() < 1e-5,
                "{work}: {found:?}"
            );
        }
    }
}
