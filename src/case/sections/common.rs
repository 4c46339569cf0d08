//! What several sections of a case read.

use std::path::{Path, PathBuf};

use calcine_coupler::physics::Vec3;

use crate::case::model::MeshSpec;
use crate::case::table::TableReader;

/// The patch names of a mesh, where the case itself knows them.
pub(super) fn patches(mesh: Option<&MeshSpec>) -> Option<Vec<&str>> {
    let (mut names, openings, cut): (Vec<&str>, _, _) = match mesh? {
        MeshSpec::Box {
            patches,
            openings,
            cut,
            ..
        } => (patches.iter().map(String::as_str).collect(), openings, cut),
        MeshSpec::Cylinder { openings, cut, .. } => (vec!["bottom", "side", "top"], openings, cut),
        MeshSpec::PolyMesh(_) => return None,
    };
    names.extend(cut.iter().map(|one| one.name.as_str()));
    names.extend(openings.iter().map(|one| one.name.as_str()));
    names.sort_unstable();
    names.dedup();
    Some(names)
}

/// True of a case without particles, whose gas is computed alone.
pub(super) fn gas_alone(root: &TableReader<'_>) -> bool {
    let of_particles = ["particles", "feeds", "outlets", "motion", "reactions"];
    !of_particles.into_iter().any(|key| root.has(key))
}

/// A path of the case file, absolute; an error where there is nothing.
pub(super) fn existing(reader: &TableReader<'_>, key: &str, folder: &Path) -> Option<PathBuf> {
    let text = reader.text(key)?;
    let path = folder.join(text);
    match path.canonicalize() {
        Ok(path) => Some(path),
        Err(cause) => {
            let rule = format!("names \"{text}\", which cannot be opened: {cause}");
            reader.fail(key, rule, "paths are relative to the case file");
            None
        }
    }
}

/// The name of what results files hold under it: a group or a column of its own.
pub(super) fn name_in_results<'a>(table: &TableReader<'a>) -> Option<&'a str> {
    let name = table.text("name")?;
    if ["", ".", ".."].contains(&name.trim())
        || name.contains(['/', ',', '"', '[', ']'])
        || name.contains(char::is_control)
    {
        let rule = format!("is \"{name}\"");
        let help = "results have it as a name: write a word, without slashes, commas, quotes, brackets and control characters";
        table.fail("name", rule, help);
    }
    Some(name)
}

/// A direction, made one long.
pub(super) fn direction(table: &TableReader<'_>, key: &str) -> Option<Vec3> {
    let vector = Vec3::from(table.vector(key)?);
    if vector.norm() == 0.0 {
        table.fail(key, "has no length", "write a direction such as \"0 0 1\"");
        return None;
    }
    Some(vector.normalize())
}

/// A point of the axis in m and the angular velocity in rad/s, from the keys of `rotating`.
pub(super) fn turning(table: &TableReader<'_>) -> Option<(Vec3, Vec3)> {
    let point = table.vector("point");
    let speed = table.vector("angular_velocity");
    table.finish();
    Some((point?.into(), speed?.into()))
}
