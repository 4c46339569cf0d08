//! The mesh of a case with its periodic patches joined, and what its other patches say of it.

use std::path::Path;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::periodic::axis_name;
use calcine_coupler::mesh::polymesh::{self, PatchType};
use calcine_coupler::setup::{GasPatch, WallVelocity};

use super::mesh_shape;
use super::meshing::{MeshingError, mesh};
use super::model::{Case, MeshSpec, MotionSpec};
use super::units::short;

/// Generates or reads the gas mesh of a case, joins its periodic patches, and checks the sides of plane and axisymmetric flows.
pub fn mesh_of(case: &Case) -> Result<Mesh, MeshingError> {
    let plain = mesh(&case.mesh)?;
    unmatched(case, &plain)?;
    if let MeshSpec::PolyMesh(folder) = &case.mesh {
        agree(case, folder, &polymesh::patch_types(folder)?)?;
    }
    let mut pairs: Vec<[String; 2]> = Vec::new();
    for (name, patch) in &case.gas.patches {
        if let GasPatch::Periodic { with } = patch
            && !pairs.iter().any(|[_, other]| other == name)
        {
            pairs.push([name.clone(), with.clone()]);
        }
    }
    let joined = plain.with_periodic(&pairs)?;
    let (empty, wedge) = (
        joined.empty_axis(&named(case, &GasPatch::Empty))?,
        joined.wedge_slice(&named(case, &GasPatch::Wedge))?,
    );
    if let Some(wrong) = mesh_shape::closed_pieces(case, &joined) {
        return Err(MeshingError::Pieces(wrong));
    }
    let moves = |motion: &MotionSpec| *motion != MotionSpec::Frozen;
    let moving = case.particles.iter().find(|one| moves(&one.motion));
    let flat = match (empty, wedge) {
        (Some(_), _) => Some("empty"),
        (None, Some(_)) => Some("wedge"),
        (None, None) => None,
    };
    if let (Some(kind), Some(population)) = (flat, moving) {
        return Err(MeshingError::Moving {
            kind,
            population: population.name.clone(),
        });
    }
    let gradient = case.gas.pressure_gradient;
    let stray = |axis: &usize| gradient[*axis] != 0.0 && joined.periodicity().axes[*axis].is_none();
    if let Some(axis) = (0..3).find(stray) {
        return Err(MeshingError::Gradient {
            axis: axis_name(axis),
            gradient: gradient[axis],
        });
    }
    Ok(joined)
}

/// Refuses patches without a condition, and conditions without a patch: all of them at once.
fn unmatched(case: &Case, mesh: &Mesh) -> Result<(), MeshingError> {
    if case.gas_held || case.gas.properties.is_vacuum() {
        return Ok(());
    }
    let stated = |name: &str| case.gas.patches.iter().any(|(own, _)| own == name);
    let filled = mesh.patches().iter().filter(|patch| patch.count > 0);
    let lacking: Vec<&str> = filled
        .map(|patch| patch.name.as_str())
        .filter(|name| !stated(name))
        .collect();
    let conditions = case.gas.patches.iter().map(|(name, _)| name.as_str());
    let strange: Vec<&str> = conditions
        .filter(|name| mesh.patch(name).is_none())
        .collect();
    let (mut facts, mut remedies) = (Vec::new(), Vec::new());
    if !lacking.is_empty() {
        facts.push(match lacking[..] {
            [name] => format!("patch `{name}` of the mesh has no boundary condition"),
            _ => format!(
                "{} patches of the mesh have no boundary condition: {}",
                lacking.len(),
                quoted("", &lacking)
            ),
        });
        let each = if lacking.len() == 1 { "it" } else { "each" };
        remedies.push(format!(
            "give {each} one in {}",
            quoted("gas.patch.", &lacking)
        ));
    }
    if !strange.is_empty() {
        let present: Vec<&str> = mesh.patches().iter().map(|one| one.name.as_str()).collect();
        let name = if strange.len() == 1 { "names" } else { "name" };
        facts.push(format!(
            "{} {name} no patch of the mesh, which has {}",
            quoted("gas.patch.", &strange),
            present.join(", ")
        ));
        remedies.push("rename what has no patch, or remove it".to_owned());
    }
    match facts.is_empty() {
        true => Ok(()),
        false => Err(MeshingError::Patches(format!(
            "{}; {}",
            facts.join(", and "),
            remedies.join(", and ")
        ))),
    }
}

/// Names with what stands before each, as keys.
fn quoted(before: &str, names: &[&str]) -> String {
    let names: Vec<String> = names
        .iter()
        .map(|name| format!("`{before}{name}`"))
        .collect();
    names.join(", ")
}

/// Names of the patches with this condition.
fn named(case: &Case, condition: &GasPatch) -> Vec<String> {
    let patches = case.gas.patches.iter();
    let same = patches.filter(|(_, patch)| patch == condition);
    same.map(|(name, _)| name.clone()).collect()
}

/// What `calcine check` says of periodic directions and of plane and axisymmetric flows.
pub(super) fn lines(case: &Case, mesh: &Mesh) -> Vec<String> {
    let mut lines = Vec::new();
    for (axis, span) in mesh.periodicity().axes.iter().enumerate() {
        if let Some(span) = span {
            lines.push(format!(
                "periodic along {}, from {} to {} m",
                axis_name(axis),
                short(span.low),
                short(span.high)
            ));
        }
    }
    if let Ok(Some(axis)) = mesh.empty_axis(&named(case, &GasPatch::Empty)) {
        lines.push(format!(
            "plane flow: one cell along {}, in which nothing varies",
            axis_name(axis)
        ));
    }
    if let Ok(Some(slice)) = mesh.wedge_slice(&named(case, &GasPatch::Wedge)) {
        lines.push(format!(
            "axisymmetric flow without swirl about {}: a slice of {} degrees; flows and balances are those of the slice",
            axis_name(slice.axis),
            short(slice.angle)
        ));
    }
    lines
}

/// A polyMesh's own types of patches must be those of the case, where they say how its sides hang together.
fn agree(case: &Case, folder: &Path, types: &[PatchType]) -> Result<(), MeshingError> {
    for patch in types {
        let stated = case
            .gas
            .patches
            .iter()
            .find(|(name, _)| *name == patch.name);
        let stated = stated.map(|(_, condition)| condition);
        let wrong = |wanted: String| {
            Err(MeshingError::Boundary {
                file: folder.join("boundary"),
                patch: patch.name.clone(),
                kind: patch.kind.clone(),
                stated: stated.map_or("no condition", word).to_owned(),
                wanted,
            })
        };
        match (patch.kind.as_str(), stated) {
            ("cyclic", Some(GasPatch::Periodic { with })) => match &patch.neighbour {
                Some(neighbour) if neighbour != with => {
                    return wrong(format!("periodic = {{ with = \"{neighbour}\" }}"));
                }
                _ => {}
            },
            ("cyclic", _) => {
                let partner = patch.neighbour.as_deref().unwrap_or("its partner");
                return wrong(format!("periodic = {{ with = \"{partner}\" }}"));
            }
            ("empty", Some(GasPatch::Empty)) | ("wedge", Some(GasPatch::Wedge)) => {}
            ("empty" | "wedge", _) => return wrong(format!("{} = {{}}", patch.kind)),
            ("symmetry" | "symmetryPlane", Some(GasPatch::Symmetry)) => {}
            (
                "symmetry" | "symmetryPlane",
                Some(GasPatch::Wall {
                    velocity: WallVelocity::Slip,
                    ..
                }),
            ) => {}
            ("symmetry" | "symmetryPlane", _) => return wrong("symmetry = {}".to_owned()),
            ("wall", Some(GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge)) => {
                return wrong("wall = { … }".to_owned());
            }
            (kind, _) if kind.starts_with("processor") => {
                return Err(MeshingError::Unsupported {
                    file: folder.join("boundary"),
                    patch: patch.name.clone(),
                    kind: kind.to_owned(),
                    remedy: "it is a part of a divided mesh: name the polyMesh of the whole (reconstructParMesh makes it)",
                });
            }
            (kind, _) if kind.starts_with("cyclic") => {
                return Err(MeshingError::Unsupported {
                    file: folder.join("boundary"),
                    patch: patch.name.clone(),
                    kind: kind.to_owned(),
                    remedy: "periodic sides need the same faces on both: mesh them alike and make them `cyclic`",
                });
            }
            _ => {}
        }
    }
    Ok(())
}

/// The key of a condition.
fn word(patch: &GasPatch) -> &'static str {
    match patch {
        GasPatch::Inlet { .. } => "inlet",
        GasPatch::Outlet { .. } => "outlet",
        GasPatch::Opening { .. } => "opening",
        GasPatch::Wall { .. } => "wall",
        GasPatch::Symmetry => "symmetry",
        GasPatch::Periodic { .. } => "periodic",
        GasPatch::Empty => "empty",
        GasPatch::Wedge => "wedge",
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::case::{parse, read};

    fn channel() -> PathBuf {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good");
        folder.join("periodic-channel.toml")
    }

    /// What is wrong with the mesh of the channel when these are set.
    fn refusal(set: &[&str]) -> String {
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        let case = read(&channel(), &set).unwrap();
        mesh_of(&case).unwrap_err().to_string()
    }

    #[test]
    fn a_channel_is_periodic_along_its_axis_and_plane_across() {
        let case = read(&channel(), &[]).unwrap();
        let mesh = mesh_of(&case).unwrap();
        assert_eq!(mesh.periodic_faces().len(), 10);
        let lines = lines(&case, &mesh);
        assert_eq!(lines[0], "periodic along x, from 0 to 0.02 m");
        assert!(
            lines[1].starts_with("plane flow: one cell along z"),
            "{lines:?}"
        );
        // One side stated gives the other its condition.
        let right = case.gas.patches.iter().find(|(name, _)| name == "right");
        let left = GasPatch::Periodic {
            with: "left".into(),
        };
        assert_eq!(right.unwrap().1, left);
    }

    #[test]
    fn meshes_that_do_not_suit_their_patches_are_refused_with_place_and_remedy() {
        let one = refusal(&["mesh.box.cells=[1, 10, 1]"]);
        assert!(one.contains("there is one cell across"), "{one}");
        let two = refusal(&["mesh.box.cells=[4, 10, 2]"]);
        assert!(two.contains("1 faces on the empty patches"), "{two}");
        let stray = refusal(&["gas.pressure_gradient=0 1 0 Pa/m"]);
        assert!(
            stray.contains("1 Pa/m along y, which is not periodic"),
            "{stray}"
        );
        let graded = refusal(&[
            "gas.patch.front={ wedge = {} }",
            "gas.patch.back={ wedge = {} }",
        ]);
        assert!(graded.contains("are parallel"), "{graded}");
    }

    #[test]
    fn types_of_a_polymesh_and_conditions_of_the_case_must_agree() {
        let folder = tempfile::tempdir().unwrap();
        let text = std::fs::read_to_string(channel()).unwrap();
        let mesh = mesh_of(&read(&channel(), &[]).unwrap()).unwrap();
        let (begin, end) = (text.find("box = ").unwrap(), text.find("[gas]").unwrap());
        let own = format!(
            "{}polymesh = \"polyMesh\"\n\n{}",
            &text[..begin],
            &text[end..]
        );
        let poly_mesh = folder.path().join("polyMesh");
        let kind = |name: &str| match name {
            "front" | "back" => "empty",
            _ => "wall",
        };
        polymesh::write_with(&mesh, &poly_mesh, kind).unwrap();
        let path = folder.path().join("case.toml");
        let read = |text: &str| mesh_of(&parse(&path, text, &[]).unwrap());
        assert_eq!(read(&own).unwrap().periodic_faces(), mesh.periodic_faces());

        let said = |text: &str| read(text).unwrap_err().to_string();
        let wall = "wall = { velocity = \"slip\", heat = \"adiabatic\" }";
        let other = own.replace("periodic = { with = \"right\" }", wall)
            + &format!("[gas.patch.right]\n{wall}\n");
        let other = said(&other.replace("pressure_gradient = \"-0.1 0 0 Pa/m\"\n", ""));
        for words in [
            "patch `left` is of type `cyclic`",
            "states wall",
            "with = \"right\"",
        ] {
            assert!(other.contains(words), "{other}");
        }
        let symmetry = said(&own.replace("empty = {}", "symmetry = {}"));
        assert!(
            symmetry.contains("states symmetry: write empty = {}"),
            "{symmetry}"
        );
        let boundary = poly_mesh.join("boundary");
        let types = std::fs::read_to_string(&boundary).unwrap();
        for (kind, words) in [
            ("cyclicAMI", "the same faces on both"),
            ("processor", "reconstructParMesh"),
        ] {
            std::fs::write(&boundary, types.replace("cyclic;", &format!("{kind};"))).unwrap();
            let refused = said(&own);
            assert!(
                refused.contains(kind) && refused.contains(words),
                "{refused}"
            );
        }
    }
}
