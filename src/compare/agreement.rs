//! Whether a difference is within its band.

use serde::Serialize;

/// How a difference stands against its band.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Agreement {
    /// Within the band.
    Inside,
    /// Out of the band.
    Outside,
    /// The case states no band.
    None,
}

impl Agreement {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Agreement::Inside => "inside",
            Agreement::Outside => "outside",
            Agreement::None => "–",
        }
    }

    /// How a multiple of the allowed distance stands; NaN is outside.
    pub(super) fn of(multiple: Option<f64>) -> Self {
        match multiple {
            None => Agreement::None,
            Some(multiple) if multiple <= 1.0 => Agreement::Inside,
            Some(_) => Agreement::Outside,
        }
    }
}
