//! What a column of a curve may be, its headings and its units.

/// What a column of a curve may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum CurveColumn {
    /// Time.
    Time,
    /// Temperature.
    Temperature,
    /// Mass: thermogravimetry.
    Mass,
    /// Rate at which the mass falls: derivative thermogravimetry.
    LossRate,
    /// Which run a row belongs to.
    Run,
}

impl CurveColumn {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Time,
        Self::Temperature,
        Self::Mass,
        Self::LossRate,
        Self::Run,
    ];

    /// Key in a case file.
    pub fn key(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Temperature => "temperature",
            Self::Mass => "mass",
            Self::LossRate => "loss_rate",
            Self::Run => "run",
        }
    }

    /// Beginnings of headings that mean it, in small letters.
    pub(super) fn beginnings(self) -> &'static [&'static str] {
        match self {
            Self::Time => &[
                "time", "zeit", "temps", "tiempo", "t/s", "t/min", "t (s", "t (min", "t [s",
                "t [min", "t_s", "t_min",
            ],
            Self::Temperature => &[
                "temp",
                "sample temp",
                "ts",
                "tr",
                "t/°c",
                "t/c",
                "t/deg",
                "t/k",
                "t (°c",
                "t (c",
                "t (deg",
                "t (k",
                "t [°c",
                "t [c",
                "t [deg",
                "t [k",
                "t_c",
                "t_deg",
                "t_k",
                "probentemp",
            ],
            Self::Mass => &[
                "mass",
                "weight",
                "tg",
                "masse",
                "gewicht",
                "sample mass",
                "sample weight",
                "unsubtracted weight",
                "m/",
                "m (",
                "m [",
            ],
            Self::LossRate => &[
                "dtg",
                "deriv",
                "d(m",
                "dm/dt",
                "dw/dt",
                "rate of loss",
                "loss_rate",
            ],
            Self::Run => &["run", "segment no", "experiment"],
        }
    }

    /// Units with the factor and the offset to SI; the mass in kg, or as a share.
    pub(super) fn units(self) -> &'static [(&'static str, f64, f64)] {
        match self {
            Self::Time => &[
                ("s", 1.0, 0.0),
                ("sec", 1.0, 0.0),
                ("min", 60.0, 0.0),
                ("h", 3600.0, 0.0),
                ("hr", 3600.0, 0.0),
                ("ms", 1e-3, 0.0),
            ],
            Self::Temperature => &[
                ("°C", 1.0, 273.15),
                ("degC", 1.0, 273.15),
                ("deg C", 1.0, 273.15),
                ("deg. C", 1.0, 273.15),
                ("degrees C", 1.0, 273.15),
                ("ºC", 1.0, 273.15),
                ("℃", 1.0, 273.15),
                ("C", 1.0, 273.15),
                ("Cel", 1.0, 273.15),
                ("K", 1.0, 0.0),
            ],
            Self::Mass => &[
                ("%", 0.01, 0.0),
                ("wt%", 0.01, 0.0),
                ("wt.%", 0.01, 0.0),
                ("mg", 1e-6, 0.0),
                ("g", 1e-3, 0.0),
                ("ug", 1e-9, 0.0),
                ("µg", 1e-9, 0.0),
                ("kg", 1.0, 0.0),
                ("1", 1.0, 0.0),
            ],
            Self::LossRate => &[
                ("%/min", 0.01 / 60.0, 0.0),
                ("%/s", 0.01, 0.0),
                ("mg/min", 1e-6 / 60.0, 0.0),
                ("mg/s", 1e-6, 0.0),
                ("1/s", 1.0, 0.0),
                ("1/min", 1.0 / 60.0, 0.0),
            ],
            Self::Run => &[("1", 1.0, 0.0)],
        }
    }

    /// True of units of a mass that need the mass at the start.
    pub(crate) fn is_weighed(self, unit: &str) -> bool {
        matches!(self, Self::Mass | Self::LossRate) && unit.contains('g')
    }
}

/// A heading as its name and its unit: `Temp./°C`, `Mass (mg)`, `Time [min]`, `mass_mg`.
pub(super) fn parted(heading: &str) -> (String, Option<String>) {
    let text = heading.trim();
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let Some((name, rest)) = text.rsplit_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            return (name.trim().to_owned(), Some(unit.trim().to_owned()));
        }
    }
    for sign in ["/", ", ", " in ", "_"] {
        // DTG/(%/min) and dm/dt/%/min: the unit is the longest end that is one.
        for (place, _) in text.match_indices(sign) {
            let unit = &text[place + sign.len()..];
            if is_unit(unit) {
                return (text[..place].trim().to_owned(), Some(bare(unit).to_owned()));
            }
        }
    }
    (text.to_owned(), None)
}

/// True of a text that is a unit of some column.
pub(super) fn is_unit(text: &str) -> bool {
    let bare = bare(text);
    CurveColumn::ALL
        .iter()
        .any(|one| one.units().iter().any(|(name, ..)| *name == bare))
}

/// A unit without brackets.
pub(super) fn bare(text: &str) -> &str {
    text.trim().trim_matches(['(', ')', '[', ']', '/']).trim()
}
