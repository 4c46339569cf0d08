//! Keys of `contacts`.

use super::prelude::*;

#[rustfmt::skip]
pub(super) const CONTACTS: &[Key] = &[
    key("between", Texts(2), Required, "The two materials.", "[\"glass\", \"glass\"]"),
    key("restitution", Number(D::NONE, UpTo(0.0, 1.0)), Without("not known"), "Coefficient of restitution, above 0 and up to 1.", "0.6"),
    key("friction", Number(D::NONE, NotNegative), Without("not known"), "Coefficient of friction, zero or above.", "0.3"),
    key("rolling_friction", Number(D::NONE, NotNegative), Without("not known"), "Coefficient of rolling friction, zero or above.", "0.05"),
    key("rolling_damping", Number(D::NONE, NotNegative), Without("not known"), "Damping of rolling as a share of the critical one, zero or above; for the rolling law `elastic-plastic`.", "0.3"),
    key("cohesion_energy", Number(D::PRESSURE, NotNegative), Without("not known"), "Cohesion energy density, zero or above; for the cohesion law `sjkr`.", "\"2 kJ/m^3\""),
    key("work_of_adhesion", Number(D::SURFACE_ENERGY, NotNegative), Without("not known"), "Work of adhesion w, zero or above, for the cohesion law `jkr`: of equal surfaces twice their surface energy.", "\"50 mJ/m^2\""),
];
