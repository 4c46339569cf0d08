//! What `calcine check` says of the cells of a mesh.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::quality::{InCell, MeshPiece};
use calcine_coupler::physics::Vec3;

use super::model::{Case, MeshSpec};

/// Largest angle in degrees between a face's normal and the line of centres at which gas was tried (docs/verification.md).
const MOST_ANGLE: f64 = 70.0;
/// Largest skewness of faces at which gas was tried.
const MOST_SKEWNESS: f64 = 1.0;
/// Largest ratio of the thicknesses of neighbours at which gas was tried.
const MOST_RATIO: f64 = 100.0;
/// Pieces of a mesh that are listed.
const LISTED: usize = 4;
/// Angle in degrees and skewness that nobody needs to be told of.
const SLIGHT: [f64; 2] = [0.1, 1e-3];

/// Openings of different names that lie in each other's faces.
pub(super) fn overlaps(case: &Case, mesh: &Mesh) -> Vec<String> {
    let openings = match &case.mesh {
        MeshSpec::Box { openings, .. } | MeshSpec::Cylinder { openings, .. } => &openings[..],
        MeshSpec::PolyMesh(_) => &[],
    };
    let centres = &mesh.face_centre()[mesh.internal_faces()..];
    let pairs = openings.iter().enumerate();
    let pairs = pairs.flat_map(|(k, first)| openings[..k].iter().map(move |other| (other, first)));
    let mut told = Vec::new();
    for (first, second) in pairs.filter(|(first, second)| first.name != second.name) {
        let both = |at: &&Vec3| first.zone.holds(**at) && second.zone.holds(**at);
        let shared = centres.iter().filter(both).count();
        if shared > 0 {
            told.push(format!(
                "the openings `{}` and `{}` overlap in {shared} faces, which belong to `{0}`, the first in the file: make one of them \
                 smaller",
                first.name, second.name
            ));
        }
    }
    told
}

/// The lines that follow the number of cells, and warnings.
pub(super) fn report(mesh: &Mesh) -> (Vec<String>, Vec<String>) {
    let Some(quality) = mesh.quality() else {
        return Default::default();
    };
    let (angle, skewness) = (quality.angle, quality.skewness);
    let skewest = match quality.boundary_skewness.value > skewness.value {
        true => quality.boundary_skewness,
        false => skewness,
    };
    let (mut lines, mut warnings) = (Vec::new(), Vec::new());
    if angle.value > SLIGHT[0] {
        lines.push(format!(
            "non-orthogonality up to {:.1} degrees, average {:.1}; largest {}",
            angle.value,
            quality.average_angle,
            place(&angle)
        ));
    }
    if skewest.value > SLIGHT[1] {
        let between = match skewest == skewness {
            true => String::new(),
            false => format!(", {:.2} between cells", skewness.value),
        };
        lines.push(format!(
            "skewness up to {:.2}{between}; largest {}",
            skewest.value,
            place(&skewest)
        ));
    }
    if angle.value > MOST_ANGLE {
        warnings.push(format!(
            "non-orthogonality of {:.1} degrees {}, above the {MOST_ANGLE} at which the gases were tried: pressure corrections converge \
             slowly or not at all; mesh anew with cells that lean less, or shorten the windows",
            angle.value,
            place(&angle)
        ));
    }
    if skewness.value > MOST_SKEWNESS {
        warnings.push(format!(
            "skewness between cells of {:.2} {}, above the {MOST_SKEWNESS} at which the gases were tried: values at such faces are of first order",
            skewness.value,
            place(&skewness)
        ));
    }
    let ratio = quality.thickness_ratio;
    if ratio.value > MOST_RATIO {
        warnings.push(format!(
            "a cell {:.0} times thinner than its neighbour {}, above the {MOST_RATIO} at which the gases were tried: pressure converges \
             slowly or not at all; let the cells grow by steps, or shorten the windows",
            ratio.value,
            place(&ratio)
        ));
    }
    (lines, warnings)
}

/// A line on a mesh of several pieces.
pub(super) fn pieces(mesh: &Mesh) -> Vec<String> {
    let pieces = mesh.pieces();
    if pieces.len() < 2 {
        return Vec::new();
    }
    vec![format!(
        "{} pieces that no face joins, between which no gas passes: {}",
        pieces.len(),
        listed(mesh, &pieces)
    )]
}

/// Pieces by their cells, places and patches, of very many the first.
fn listed(mesh: &Mesh, pieces: &[MeshPiece]) -> String {
    let told = |piece: &MeshPiece| {
        let at = piece.centre;
        let names = piece.patches.iter();
        let names: Vec<&str> = names.map(|&k| mesh.patches()[k].name.as_str()).collect();
        format!(
            "{} cells about ({:.4}, {:.4}, {:.4}) m with the patches {}",
            piece.cells,
            at.x,
            at.y,
            at.z,
            names.join(", ")
        )
    };
    let mut list: Vec<String> = pieces.iter().take(LISTED).map(told).collect();
    if pieces.len() > LISTED {
        list.push(format!("{} more", pieces.len() - LISTED));
    }
    list.join("; ")
}

/// What is wrong with a mesh of several pieces, of which one has no patch with a pressure: the gases have one level of pressure for the
/// whole domain, and a piece of its own has none (docs/theory.md, BND-4).
pub(super) fn closed_pieces(case: &Case, mesh: &Mesh) -> Option<String> {
    let pieces = mesh.pieces();
    if pieces.len() < 2 || case.gas_held || case.gas.properties.is_vacuum() {
        return None;
    }
    let open = |patch: &usize| {
        let name = &mesh.patches()[*patch].name;
        let mut conditions = case.gas.patches.iter();
        conditions.any(|(own, condition)| own == name && condition.is_open())
    };
    let shut: Vec<MeshPiece> = pieces
        .iter()
        .filter(|piece| !piece.patches.iter().any(open))
        .cloned()
        .collect();
    (!shut.is_empty()).then(|| {
        format!(
            "the mesh has {} pieces that no face joins, of which {} {} no `outlet` or `opening`: {}: the level of pressure there is not \
             known; give each piece an outlet or an opening of its own, join the pieces where their faces should be one (`checkMesh` \
             counts regions), or leave these cells out of the mesh and run them by themselves",
            pieces.len(),
            shut.len(),
            if shut.len() == 1 { "has" } else { "have" },
            listed(mesh, &shut)
        )
    })
}

fn place(one: &InCell) -> String {
    let at = one.centre;
    format!(
        "in cell {} at ({:.4}, {:.4}, {:.4}) m",
        one.cell, at.x, at.y, at.z
    )
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::case::meshing::mesh;
    use crate::case::read;

    fn mesh_of(case: &str) -> Mesh {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(case);
        mesh(&read(&path, &[]).unwrap().mesh).unwrap()
    }

    /// What `checkMesh` of OpenFOAM 1912 prints for the meshes that an OpenFOAM gas of these cases is given.
    #[test]
    fn refined_meshes_have_the_shape_that_openfoam_finds() {
        for (case, angle, average, skewness) in [
            (
                "cases/heated-bed.toml",
                32.372_377_493_424_85,
                7.836_162_083_714_9,
                0.505_369_187_764_537_6,
            ),
            (
                "cases/shaft-furnace.toml",
                25.239_401_820_679_39,
                6.924_654_143_888_745,
                0.333_333_333_333_344_8,
            ),
        ] {
            let quality = mesh_of(case).quality().unwrap();
            for (found, expected) in [
                (quality.angle.value, angle),
                (quality.average_angle, average),
                (
                    quality.skewness.value.max(quality.boundary_skewness.value),
                    skewness,
                ),
            ] {
                assert!((found / expected - 1.0).abs() < 1e-6, "{case}: {quality:?}");
            }
        }
    }

    #[test]
    fn a_mesh_of_boxes_is_not_told_of_and_one_that_leans_too_far_is_warned_of() {
        let plain = mesh_of("cases/ore-reduction.toml");
        assert_eq!(report(&plain), (Vec::new(), Vec::new()));
        let mut topology = plain.topology().clone();
        let tangent = 75_f64.to_radians().tan();
        for point in &mut topology.points {
            point.x += tangent * point.z;
        }
        let (lines, warnings) = report(&Mesh::new(topology).unwrap());
        assert!(
            lines[0].starts_with("non-orthogonality up to 75.0 degrees, average "),
            "{lines:?}"
        );
        assert!(
            warnings[0].starts_with("non-orthogonality of 75.0 degrees in cell "),
            "{warnings:?}"
        );
        // That of the leaning walls is no matter.
        assert!(
            lines[1].contains(", 0.00 between cells; largest in cell "),
            "{lines:?}"
        );
        assert_eq!((lines.len(), warnings.len()), (2, 1));
    }
}
