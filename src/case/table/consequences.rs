//! Which errors of a case only follow from a value that could not be read.

/// What is said of a key that goes with another choice.
pub(super) const NO_EFFECT: &str = " has no effect here";

/// For a section of a case those whose values its checks use.
const USES: &[(&str, &[&str])] = &[
    ("gas", &["mesh", "time"]),
    ("materials", &["solids"]),
    (
        "particles",
        &["materials", "mesh", "laws", "reactions", "solids"],
    ),
    ("feeds", &["particles"]),
    ("walls", &["materials", "mesh", "laws"]),
    ("contacts", &["materials", "particles", "walls", "motion"]),
    ("reactions", &["gas", "solids", "materials", "laws"]),
    ("motion", &["time", "particles"]),
    ("openfoam", &["gas", "time", "laws"]),
    ("output", &["gas"]),
    ("laws", &["materials", "particles", "gas"]),
    (
        "quantities",
        &[
            "gas",
            "materials",
            "particles",
            "walls",
            "reactions",
            "solids",
            "mesh",
            "probes",
        ],
    ),
];

/// Sections whose entries have names: `materials.glass`.
const NAMED: [&str; 2] = ["materials", "solids"];

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

/// True where a check of the same entry is about a key whose value was not taken: it names it, or calls another key of
/// its table without effect.
pub(super) fn names(check: &str, message: &str, refused: &str) -> bool {
    let (table, key) = refused.rsplit_once('.').unwrap_or(("", refused));
    let own_table = check.rsplit_once('.').map_or("", |(table, _)| table);
    let idle = message.ends_with(NO_EFFECT) && own_table == table;
    let named = message.contains(&format!("`{key}`")) || message.contains(&format!(" no {key},"));
    idle || (named && entry(check) == entry(refused))
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
}
