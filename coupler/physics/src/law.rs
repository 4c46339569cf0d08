//! Laws by name: each law declares beside its code what a case file writes to choose it.

use std::fmt;
use std::ops::Deref;

use crate::dimension::Dimension;

/// The name of the law that does nothing, in every family.
pub const NONE: &str = "none";

/// A law of a family such as `dyn Drag`: its name and keys in a case file, and its constructor.
///
/// A new law is one file that holds the law and its entry, and one line in the family's list:
///
/// ```
/// use calcine_physics::drag::Drag;
/// use calcine_physics::law::{LawChoice, LawEntry};
/// use calcine_physics::local::LocalGas;
///
/// /// Drag of a lone sphere in creeping flow, K_A = 3π μ d.
/// #[derive(Debug)]
/// struct Stokes;
///
/// impl Drag for Stokes {
///     fn name(&self) -> &'static str {
///         STOKES.name
///     }
///
///     fn coefficient(&self, gas: &LocalGas, diameter: f64) -> f64 {
///         3.0 * std::f64::consts::PI * gas.viscosity * diameter
///     }
/// }
///
/// static STOKES: LawEntry<dyn Drag> = LawEntry {
///     name: "stokes",
///     summary: "A lone sphere in creeping flow.",
///     source: "Stokes, Trans. Camb. Phil. Soc. 9 (1851) 8",
///     parameters: &[],
///     tables: &[],
///     make: |_| Box::new(Stokes),
/// };
///
/// let chosen = LawChoice::new(&STOKES, Vec::new());
/// assert_eq!(chosen.make().name(), "stokes");
/// ```
pub struct LawEntry<L: ?Sized + 'static> {
    /// Name as case files write it.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// Where it was published; empty for the law that does nothing.
    pub source: &'static str,
    /// The numbers that it takes from the case, beside its name.
    pub parameters: &'static [LawParameter],
    /// The tables that it takes from the case, beside its name.
    pub tables: &'static [LawTable],
    /// Makes it from the values of its keys.
    pub make: fn(&LawValues) -> Box<L>,
}

/// What a law declares, whatever its family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawSummary {
    /// Name as case files write it.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// The numbers that it takes from the case.
    pub parameters: &'static [LawParameter],
    /// The tables that it takes from the case.
    pub tables: &'static [LawTable],
}

impl<L: ?Sized> LawEntry<L> {
    /// What it declares.
    pub fn about(&self) -> LawSummary {
        LawSummary {
            name: self.name,
            summary: self.summary,
            source: self.source,
            parameters: self.parameters,
            tables: self.tables,
        }
    }
}

#[cfg(test)]
impl<L: ?Sized> LawEntry<L> {
    /// The law with the defaults of its numbers, and 1 for those that a case must state.
    pub(crate) fn by_default(&self) -> Box<L> {
        let values = self.parameters.iter();
        let values: Vec<f64> = values.map(|one| one.default.unwrap_or(1.0)).collect();
        (self.make)(&values.into())
    }
}

/// A number that a law takes from the case: a key beside `law`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawParameter {
    /// The key.
    pub name: &'static str,
    /// Dimension of its value.
    pub dimension: Dimension,
    /// The values that it may have.
    pub bound: Bound,
    /// Its value in SI units where the case does not state it; `None` where the case must.
    pub default: Option<f64>,
    /// A number of the same table beside which the case must state it, unless that one is zero; `None` of most. Its
    /// default then has no meaning of its own.
    pub needed_with: Option<&'static str>,
    /// What it means.
    pub meaning: &'static str,
    /// An example of a value, as a case writes it.
    pub example: &'static str,
}

/// A table that a law takes from the case: a key beside `law`, or in another table of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawTable {
    /// The key.
    pub name: &'static str,
    /// True where the case must state it.
    pub required: bool,
    /// What it means.
    pub meaning: &'static str,
    /// An example of it, as a case writes it.
    pub example: &'static str,
    /// Dimension of the numbers of a table whose keys are names of the user's, such as those of species; it has no
    /// parameters and tables then.
    pub by_name: Option<Dimension>,
    /// The numbers in it.
    pub parameters: &'static [LawParameter],
    /// The tables in it.
    pub tables: &'static [LawTable],
}

/// The values of a law's keys, or of one of its tables; as a slice those of its parameters, in their order and in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LawValues {
    /// Values of the parameters.
    pub numbers: Vec<f64>,
    /// What a table of names holds, in the order of the case.
    pub by_name: Vec<(String, f64)>,
    /// The tables in their order; `None` for one that the case leaves out.
    pub tables: Vec<Option<LawValues>>,
}

impl LawValues {
    /// A table by its place among those of the law; `None` where the case leaves it out.
    pub fn table(&self, index: usize) -> Option<&Self> {
        self.tables.get(index)?.as_ref()
    }
}

impl From<Vec<f64>> for LawValues {
    fn from(numbers: Vec<f64>) -> Self {
        Self {
            numbers,
            ..Self::default()
        }
    }
}

impl Deref for LawValues {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.numbers
    }
}

/// The values that a number may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Any finite one.
    Any,
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// Above the first and below the second.
    Within(f64, f64),
    /// Above the first, and the second at most.
    UpTo(f64, f64),
    /// From the first to the second.
    Between(f64, f64),
    /// Not below it.
    AtLeast(f64),
}

impl Bound {
    /// True where a value may be this.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Bound::Any => value.is_finite(),
            Bound::Positive => value > 0.0,
            Bound::NotNegative => value >= 0.0,
            Bound::Within(low, high) => value > low && value < high,
            Bound::UpTo(low, high) => value > low && value <= high,
            Bound::Between(low, high) => (low..=high).contains(&value),
            Bound::AtLeast(low) => value >= low,
        }
    }

    /// What a value must be, as the rest of a sentence that begins with "it".
    pub fn words(self) -> String {
        match self {
            Bound::Any => "must be finite".into(),
            Bound::Positive => "must be above zero".into(),
            Bound::NotNegative => "is zero or above".into(),
            Bound::Within(low, high) => {
                format!("must lie between {low} and {high}, both excluded")
            }
            Bound::UpTo(low, high) => format!("lies above {low} and up to {high}"),
            Bound::Between(low, high) => format!("lies between {low} and {high}"),
            Bound::AtLeast(low) => format!("is {low} or more"),
        }
    }
}

impl<L: ?Sized> fmt::Debug for LawEntry<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LawEntry")
            .field("name", &self.name)
            .field("parameters", &self.parameters)
            .finish_non_exhaustive()
    }
}

/// A law that a case chose, with the values of its parameters.
pub struct LawChoice<L: ?Sized + 'static> {
    entry: &'static LawEntry<L>,
    values: LawValues,
}

impl<L: ?Sized> LawChoice<L> {
    /// A law with the values of its keys, in SI units; numbers alone are those of its parameters in their order.
    pub fn new(entry: &'static LawEntry<L>, values: impl Into<LawValues>) -> Self {
        let values = values.into();
        debug_assert_eq!(values.len(), entry.parameters.len());
        debug_assert_eq!(values.tables.len(), entry.tables.len());
        Self { entry, values }
    }

    /// The law of a list by its name; `None` where it has none of that name.
    pub fn named(laws: &[&'static LawEntry<L>], name: &str, values: Vec<f64>) -> Option<Self> {
        let entry = laws.iter().find(|law| law.name == name)?;
        Some(Self::new(entry, values))
    }

    /// What the law declares.
    pub fn entry(&self) -> &'static LawEntry<L> {
        self.entry
    }

    /// True of the law that does nothing.
    pub fn is_none(&self) -> bool {
        self.entry.name == NONE
    }

    /// The law.
    pub fn make(&self) -> Box<L> {
        (self.entry.make)(&self.values)
    }
}

impl<L: ?Sized> Clone for LawChoice<L> {
    fn clone(&self) -> Self {
        Self {
            entry: self.entry,
            values: self.values.clone(),
        }
    }
}

impl<L: ?Sized> PartialEq for LawChoice<L> {
    fn eq(&self, other: &Self) -> bool {
        self.entry.name == other.entry.name && self.values == other.values
    }
}

impl<L: ?Sized> fmt::Debug for LawChoice<L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{:?}", self.entry.name, self.values.numbers)?;
        match self.values.tables.is_empty() {
            true => Ok(()),
            false => write!(f, "{:?}", self.values.tables),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conduction::{CONDUCTION_LAWS, GAP_LAWS};
    use crate::drag::DRAG_LAWS;
    use crate::heat_transfer::HEAT_TRANSFER_LAWS;
    use crate::turbulence::BED_EDDY_LAWS;

    fn sound<L: ?Sized>(laws: &[&'static LawEntry<L>], name_of: fn(&L) -> &'static str) {
        let mut names: Vec<&str> = laws.iter().map(|law| law.name).collect();
        assert!(names.contains(&NONE));
        for law in laws {
            assert!(law.summary.ends_with('.'), "{}", law.name);
            assert_eq!(law.source.is_empty(), law.name == NONE, "{}", law.name);
            for parameter in law.parameters {
                let default = parameter.default.unwrap_or(1.0);
                assert!(parameter.bound.holds(default), "{}", parameter.name);
            }
            assert_eq!(name_of(&law.by_default()), law.name);
        }
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), laws.len());
    }

    #[test]
    fn laws_have_names_of_their_own_sources_and_defaults_within_their_bounds() {
        sound(DRAG_LAWS, |law| law.name());
        sound(HEAT_TRANSFER_LAWS, |law| law.name());
        sound(CONDUCTION_LAWS, |law| law.name());
        sound(GAP_LAWS, |law| law.name());
        sound(BED_EDDY_LAWS, |law| law.name());
    }

    #[test]
    fn bounds_hold_their_ends_as_their_words_say() {
        for (bound, inside, outside) in [
            (Bound::Positive, 1e-300, 0.0),
            (Bound::NotNegative, 0.0, -1e-300),
            (Bound::Within(0.0, 1.0), 0.5, 1.0),
            (Bound::UpTo(0.0, 1.0), 1.0, 0.0),
            (Bound::Between(-1.0, 0.5), -1.0, 0.6),
            (Bound::AtLeast(1.0), 1.0, 0.9),
            (Bound::Any, -1.0, f64::NAN),
        ] {
            assert!(bound.holds(inside) && !bound.holds(outside), "{bound:?}");
            assert!(!bound.holds(f64::NAN), "{bound:?}");
        }
    }
}
