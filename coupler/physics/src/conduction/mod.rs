//! Heat conduction between particles that touch, or nearly so, one law a file.
//!
//! Three things add up to the conductance of a pair: through the contact (trait [`Conduction`]), whose
//! overlap may be that of the real, stiffer material ([`ContactArea`]), and through the gas between the
//! surfaces around it (trait [`GasGap`]).
//!
//! The forms of a contact of overlap δ differ by constant factors where δ is small against the radii. With
//! k = 2 k₁k₂/(k₁ + k₂) and R* = R₁R₂/(R₁ + R₂):
//!
//! | law | G | over 2 k √(R* δ) | over 2 k r of the same contact radius r |
//! |---|---|---|---|
//! | [`BatchelorObrien`] | 2 k r, r² = R* δ (Hertz) | 1 | 1 |
//! | [`Geometric`] | 2 k r, r² = 2 R* δ (circle of intersection) | √2 | 1 |
//! | [`Lens`] | 2 k √A, A = π r², r² = 2 R* δ | √(2π) | √π |
//!
//! [`RoughContact`] puts the asperities of rough surfaces in series with the first; [`HalfPaths`] leaves out the constriction, so that it goes
//! with δ and not with its root.
//!
//! Per area of contact, G = A/R_th, that is R_th = π r/(2 k) for the first two and √(π) r/(2 k) for the third.

mod area;
mod batchelor_obrien;
mod cheng;
mod conductivity;
mod gap;
mod geometric;
mod half_paths;
mod lens;
mod model;
mod none;
mod rong_horio;
mod rough;

pub use area::{ContactArea, ElasticLaw, Stiffness};
pub use batchelor_obrien::BatchelorObrien;
pub use cheng::Cheng;
pub use conductivity::Conductivity;
pub use gap::{GasGap, NoGap, SphereGap};
pub use geometric::Geometric;
pub use half_paths::HalfPaths;
pub use lens::Lens;
pub use model::{Conduction, SphereContact};
pub use none::NoConduction;
pub use rong_horio::RongHorio;
pub use rough::RoughContact;

use crate::law::LawEntry;

/// The laws of contacts that a case may choose. A new one is a file beside these, declared above and listed here.
pub static CONDUCTION_LAWS: &[&LawEntry<dyn Conduction>] = &[
    &batchelor_obrien::LAW,
    &geometric::LAW,
    &lens::LAW,
    &half_paths::LAW,
    &rough::LAW,
    &none::LAW,
];

/// The laws of the gas between surfaces that a case may choose.
pub static GAP_LAWS: &[&LawEntry<dyn GasGap>] = &[&rong_horio::LAW, &cheng::LAW, &gap::NO_GAP];

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn at_small_overlaps_the_forms_differ_by_the_factors_of_the_table() {
        for radius in [[5e-3, 5e-3], [2e-3, 7e-3], [4e-3, f64::INFINITY]] {
            let contact = SphereContact {
                radius,
                overlap: 1e-9,
                conductivity: [50.0, 20.0],
            };
            let hertz = (contact.reduced_radius() * contact.overlap).sqrt();
            let unit = 2.0 * (2.0 * 50.0 * 20.0 / 70.0) * hertz;
            for (law, factor) in [
                (&BatchelorObrien as &dyn Conduction, 1.0),
                (&Geometric, 2.0_f64.sqrt()),
                (&Lens, (2.0 * PI).sqrt()),
            ] {
                let ratio = law.conductance(&contact) / unit;
                assert!(
                    (ratio / factor - 1.0).abs() < 1e-5,
                    "{}: {ratio}",
                    law.name()
                );
            }
        }
    }
}
