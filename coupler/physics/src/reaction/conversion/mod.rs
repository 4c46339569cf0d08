//! How the rate of a reaction in the whole of a porous solid follows what is left of the solid (docs/theory.md, XDP-9).
//!
//! Such a law is a function f(w) of the share w of the solid that is left, one where nothing has reacted, of the rate
//! r = k(T) n₀ f(w) Π c_i^n_i in mol/s, n₀ the amount at the start. Below a share of [`TRACE`] each ends along a line through
//! zero, so that the implicit steps of a particle find the end.

mod contracting_area;
mod contracting_volume;
mod equilibrium_pressure;
mod first_order;
mod nucleation;
mod random_pore;
mod table;

pub use contracting_area::{CONTRACTING_AREA, ContractingArea};
pub use contracting_volume::{CONTRACTING_VOLUME, ContractingVolume};
pub use equilibrium_pressure::{EQUILIBRIUM_PRESSURE, GrainSurface};
pub use first_order::{FIRST_ORDER, FirstOrder};
pub use nucleation::{NUCLEATION, Nucleation};
pub use random_pore::{RANDOM_PORE, RandomPore};

/// The share of a solid below which its rate ends along a line.
pub const TRACE: f64 = 1e-9;

/// f(w) of a law and its derivative.
pub trait ConversionLaw {
    /// f(w) and df/dw at a share w of the solid that is left, above zero.
    fn of(&self, left: f64) -> [f64; 2];
}

/// Which law of conversion a reaction follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conversion {
    /// f = w.
    FirstOrder(FirstOrder),
    /// f = 2 w^1/2.
    ContractingArea(ContractingArea),
    /// f = 3 w^2/3.
    ContractingVolume(ContractingVolume),
    /// f = m w (a − ln w)^(1 − 1/m).
    Nucleation(Nucleation),
    /// f = w (1 − ψ ln w)^1/2.
    RandomPore(RandomPore),
}

impl Conversion {
    /// f and its derivative at any share w; a line through zero below [`TRACE`].
    pub fn of(&self, left: f64) -> [f64; 2] {
        let at = left.max(TRACE);
        let [value, slope] = match self {
            Self::FirstOrder(law) => law.of(at),
            Self::ContractingArea(law) => law.of(at),
            Self::ContractingVolume(law) => law.of(at),
            Self::Nucleation(law) => law.of(at),
            Self::RandomPore(law) => law.of(at),
        };
        if left >= TRACE {
            [value, slope]
        } else {
            let steep = value / TRACE;
            [steep * left, steep]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Conversion; 5] = [
        Conversion::FirstOrder(FirstOrder),
        Conversion::ContractingArea(ContractingArea),
        Conversion::ContractingVolume(ContractingVolume),
        Conversion::Nucleation(Nucleation {
            exponent: 2.0,
            nuclei: 1e-3,
        }),
        Conversion::RandomPore(RandomPore { structure: 4.6 }),
    ];

    #[test]
    fn slopes_are_difference_quotients() {
        for law in ALL {
            for w in [1.0, 0.7, 0.2, 1e-3, 1e-6] {
                let h = 1e-7 * w;
                let quotient = (law.of(w + h)[0] - law.of(w - h)[0]) / (2.0 * h);
                let slope = law.of(w)[1];
                assert!(
                    (slope - quotient).abs() < 1e-5 * slope.abs().max(1.0),
                    "{law:?} {w}: {slope} {quotient}"
                );
            }
        }
    }

    #[test]
    fn every_law_ends_along_a_line_through_zero() {
        for law in ALL {
            let [value, slope] = law.of(0.0);
            assert_eq!(value, 0.0);
            assert!(slope > 0.0, "{law:?}");
            let [above, _] = law.of(TRACE);
            let [below, _] = law.of(TRACE * (1.0 - 1e-12));
            assert!((above / below - 1.0).abs() < 1e-11, "{law:?}");
        }
    }
}
