//! Kinds of cases: what a file describes, by its key `kind`.

use super::flowsheet::FLOWSHEET;
use super::key::Key;
use super::root::BED;
use super::tuning::TUNING;
use crate::laws::{LawCatalogue, LawFamilies};

/// A kind of case. A new one is an entry of [`KINDS`], and its commands are one of the list in
/// `src/commands/kinds.rs`.
pub struct CaseKind {
    /// Word of the key `kind`.
    pub name: &'static str,
    /// What it describes, in a few words.
    pub summary: &'static str,
    /// The keys of the file.
    pub(in crate::case) keys: &'static [Key],
    /// Families of laws that it chooses from, by the table in which a law is chosen.
    pub(in crate::case) families: fn(&LawCatalogue) -> LawFamilies,
    /// Page of the docs whose last part is made from the keys.
    pub page: &'static str,
}

/// All kinds; a case that states none is of the first.
pub static KINDS: &[CaseKind] = &[
    CaseKind {
        name: "bed",
        summary: "a reactive granular bed, gas coupled with particles",
        keys: BED,
        families: LawCatalogue::families,
        page: "docs/reference/case-file.md",
    },
    CaseKind {
        name: "flowsheet",
        summary: "a plant of units and streams",
        keys: FLOWSHEET,
        families: LawCatalogue::plant_families,
        page: "docs/reference/plant-file.md",
    },
    CaseKind {
        name: "tuning",
        summary: "a model whose parameters are tuned to curves",
        keys: TUNING,
        families: LawCatalogue::tuning_families,
        page: "docs/reference/tuning-file.md",
    },
];

/// The kind of this name.
pub fn kind_named(name: &str) -> Option<&'static CaseKind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// The names of all kinds.
pub fn kind_names() -> Vec<&'static str> {
    KINDS.iter().map(|kind| kind.name).collect()
}
