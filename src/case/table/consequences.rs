//! Which errors of a case only follow from a value that could not be read.

/// For a section of a case those whose values its checks use.
const USES: &[(&str, &[&str])] = &[
    ("gas", &["mesh", "time", "bodies"]),
    ("bodies", &["materials", "mesh", "gas", "walls"]),
    ("materials", &["solids"]),
    (
        "particles",
        &["materials", "mesh", "laws", "reactions", "solids"],
    ),
    ("feeds", &["particles"]),
    ("walls", &["materials", "mesh", "laws", "bodies"]),
    ("contacts", &["materials", "particles", "walls", "motion"]),
    ("reactions", &["gas", "solids", "materials", "laws"]),
    ("motion", &["time", "particles"]),
    ("openfoam", &["gas", "time", "laws"]),
    ("output", &["gas"]),
    ("laws", &["materials", "particles", "gas"]),
    ("units", &["sizes", "compounds", "attributes"]),
    (
        "quantities",
        &[
            "gas",
            "materials",
            "particles",
            "walls",
            "bodies",
            "reactions",
            "solids",
            "mesh",
            "probes",
            "compounds",
            "units",
            "streams",
        ],
    ),
];

/// Sections whose entries have names: `materials.glass`.
const NAMED: [&str; 3] = ["bodies", "materials", "solids"];

/// True where a check at one place may have failed only because a value at another place could not be read: one of a
/// section that the check uses, or of the same entry.
pub(super) fn follows(check: &str, unread: &str) -> bool {
    let (own, other) = (section(check), section(unread));
    if own == other {
        let (one, two) = (entry(check), entry(unread));
        return one == two || [one, two].contains(&own);
    }
    uses(check, other)
}

/// True where checks at a place use values of a section.
pub(super) fn uses(check: &str, other: &str) -> bool {
    let own = section(check);
    let found = USES.iter().find(|(section, _)| *section == own);
    found.is_some_and(|(_, sections)| sections.contains(&other))
}

/// True where a check of the same entry names a key whose value was not taken.
pub(super) fn names(check: &str, message: &str, refused: &str) -> bool {
    let (_, key) = parts(refused);
    let named = message.contains(&format!("`{key}`")) || message.contains(&format!(" no {key},"));
    named && entry(check) == entry(refused)
}

/// True where both keys stand in one table: one may have no effect only because the choice by the other was not taken.
pub(super) fn beside(idle: &str, refused: &str) -> bool {
    parts(idle).0 == parts(refused).0
}

/// Table and key of a place.
fn parts(place: &str) -> (&str, &str) {
    place.rsplit_once('.').unwrap_or(("", place))
}

/// `particles` of `particles[0].place`.
fn section(place: &str) -> &str {
    place.split(['.', '[']).next().unwrap_or(place)
}

/// `particles[0]` of `particles[0].place`, `materials.glass` of `materials.glass.density`.
fn entry(place: &str) -> &str {
    let parts = 1 + usize::from(NAMED.contains(&section(place)));
    let end = place.match_indices('.').nth(parts - 1);
    end.map_or(place, |(end, _)| &place[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_follows_from_what_it_uses_and_from_its_own_entry() {
        assert!(follows("particles[0].material", "materials.glass"));
        assert!(follows("materials.glass", "materials.glass.young"));
        assert!(follows("contacts", "contacts[2].between"));
        assert!(follows("quantities[1].measure.of", "gas"));
        assert!(!follows("particles[0].material", "particles[1].diameter"));
        assert!(!follows("materials.glass", "materials.iron.young"));
        assert!(!follows("mesh.box", "gas.mixture"));
    }

    #[test]
    fn a_key_is_idle_because_of_a_refused_choice_of_its_own_table_alone() {
        assert!(beside("laws.radiation.rays", "laws.radiation.law"));
        assert!(!beside("laws.radiation.rays", "laws.drag.law"));
        assert!(!beside("laws.radiation.rays", "laws.radiation"));
        assert!(beside("format", "title"));
    }
}
