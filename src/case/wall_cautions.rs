//! What of the walls of a case is likely not meant.

use calcine_coupler::mesh::cylinder::outline;
use calcine_coupler::motion::{WallMotion, WallShape};
use calcine_coupler::physics::Vec3;

use super::model::{Case, MeshSpec, MotionSpec};
use super::surface_holes::holes;
use super::units::shown;

/// Ratio of the sizes of a wall and of the mesh beyond which a unit of length is likely wrong: between m and mm it is 1000.
const FAR: f64 = 100.0;

/// Warnings, in the order of the walls.
pub(super) fn all(case: &Case) -> Vec<String> {
    let mut all = case.left_out_of_walls.clone();
    all.extend(beyond_flat_sides(case));
    let Some(mesh) = size(&case.mesh) else {
        return all;
    };
    for wall in &case.walls {
        let WallShape::Mesh { triangles } = &wall.shape else {
            continue;
        };
        let size = largest_extent(triangles);
        if size > FAR * mesh || size * FAR < mesh {
            all.push(format!(
                "the triangles of the wall `{}` reach over {} m, the mesh over {} m: check `scale`, 1e-3 for a file in mm",
                wall.name,
                shown(size),
                shown(mesh)
            ));
        } else if wall.motion == WallMotion::Still && beside(triangles, &case.mesh) {
            all.push(format!(
                "the triangles of the wall `{}` all lie beside the mesh, where no particle comes: check `scale` and the place of the surface",
                wall.name
            ));
        }
        all.extend(open_surface(case, &wall.name, triangles, size));
    }
    all
}

/// Warns of holes in a surface through which the smallest particles that move may pass.
fn open_surface(case: &Case, name: &str, triangles: &[[Vec3; 3]], extent: f64) -> Option<String> {
    let moving = case.particles.iter();
    let moving = moving.filter(|one| one.motion == MotionSpec::Free);
    let smallest = moving.map(|one| one.sizes.smallest()).reduce(f64::min)?;
    let mut holes = holes(triangles, extent);
    holes.retain(|hole| hole.width > smallest);
    let widest = holes.iter().max_by(|a, b| a.width.total_cmp(&b.width))?;
    let [x, y, z] = [0, 1, 2].map(|axis| shown(widest.centre[axis]));
    let many = match holes.len() {
        1 => "a hole".to_owned(),
        count => format!("{count} holes"),
    };
    Some(format!(
        "the surface of the wall `{name}` has {many} through which particles of {} m pass; the widest one, of {} edges, is {} m wide, at ({x}, {y}, {z}) m: \
         close it in the file, unless it is an outlet",
        shown(smallest),
        widest.edges,
        shown(widest.width)
    ))
}

/// True of triangles that all lie beside a mesh that the case states.
fn beside(triangles: &[[Vec3; 3]], mesh: &MeshSpec) -> bool {
    let (low, high) = match mesh {
        MeshSpec::Box { origin, size, .. } => (*origin, origin + size),
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            ..
        } => {
            let across = Vec3::new(0.5 * diameter, 0.5 * diameter, 0.0);
            (origin - across, origin + across + *length * Vec3::z())
        }
        MeshSpec::PolyMesh(_) => return false,
    };
    let (from, to) = extent(triangles);
    (0..3).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
}

/// Warns where a round wall lies so far beyond the flat sides of a cylinder's mesh that the smallest particles that move may leave it.
fn beyond_flat_sides(case: &Case) -> Option<String> {
    let MeshSpec::Cylinder {
        origin,
        diameter,
        cells,
        ..
    } = &case.mesh
    else {
        return None;
    };
    let flat = 0.5 * diameter * outline(cells[0]).across_sides;
    let radii = case.walls.iter().filter_map(|wall| match &wall.shape {
        WallShape::Cylinder {
            point,
            axis,
            radius,
        } if axis.xy().norm() < 1e-9 => Some(radius + (point - origin).xy().norm()),
        _ => None,
    });
    let reach = radii.fold(0.0, f64::max);
    let moving = case
        .particles
        .iter()
        .filter(|one| one.motion == MotionSpec::Free);
    let smallest = moving
        .map(|one| 0.5 * one.sizes.smallest())
        .reduce(f64::min)?;
    (reach - smallest > flat).then(|| {
        format!(
            "a round wall of {} m radius lies beyond the flat sides of the mesh, {} m from its axis, by more than {} m, the radius of the smallest \
             particles that move: a centre that leaves the mesh there ends the run; take more cells across",
            shown(reach),
            shown(flat),
            shown(smallest)
        )
    })
}

/// Lowest and highest corner in m of a box around triangles.
fn extent(triangles: &[[Vec3; 3]]) -> (Vec3, Vec3) {
    let corners = || triangles.iter().flatten();
    let low = corners().fold(Vec3::repeat(f64::MAX), |low, one| low.inf(one));
    let high = corners().fold(Vec3::repeat(f64::MIN), |high, one| high.sup(one));
    (low, high)
}

fn largest_extent(triangles: &[[Vec3; 3]]) -> f64 {
    let (low, high) = extent(triangles);
    (high - low).max()
}

/// Largest extent in m of a mesh that the case states; `None` for one of a file.
fn size(mesh: &MeshSpec) -> Option<f64> {
    match mesh {
        MeshSpec::Box { size, .. } => Some(size.max()),
        MeshSpec::Cylinder {
            diameter, length, ..
        } => Some(diameter.max(*length)),
        MeshSpec::PolyMesh(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::case::read;

    fn folder() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good")
    }

    #[test]
    fn a_file_in_mm_without_scale_is_warned_of() {
        let path = folder().join("moving.toml");
        assert_eq!(all(&read(&path, &[]).unwrap()), [""; 0]);
        let told = all(&read(&path, &["walls.plate.scale=10".to_owned()]).unwrap());
        assert_eq!(
            told,
            [
                "the triangles of the wall `plate` reach over 100 m, the mesh over 0.3 m: check `scale`, 1e-3 for a file in mm"
            ]
        );
    }

    #[test]
    fn a_round_wall_beyond_the_flat_sides_is_warned_of_where_particles_are_small() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/hopper.toml");
        let set = |diameter: &str| format!("particles.beads.diameter={diameter}");
        let told = |sizes: &str| all(&read(&path, &[set(sizes)]).unwrap());
        assert_eq!(told("1 mm"), [""; 0]);
        let small = told("0.01 mm");
        assert!(small[0].contains("by more than 0.000005 m"), "{small:?}");
    }

    #[test]
    fn triangles_without_area_are_told_with_their_numbers() {
        let copy = tempfile::tempdir().unwrap();
        let (case, plate) = (
            copy.path().join("moving.toml"),
            copy.path().join("plate.stl"),
        );
        fs::copy(folder().join("moving.toml"), &case).unwrap();
        let text = fs::read_to_string(folder().join("plate.stl")).unwrap();
        let facet = "facet\nvertex 1 1 1\nvertex 2 2 2\nvertex 3 3 3\nendfacet\n";
        fs::write(&plate, format!("{text}{}", facet.repeat(7))).unwrap();
        let told = all(&read(&case, &[]).unwrap());
        assert!(
            told[0].ends_with("plate.stl: triangles 2, 3, 4, 5, 6 and 2 more without area, left out; mend the surface if particles could pass there"),
            "{told:?}"
        );
    }
}
