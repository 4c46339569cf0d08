//! Particles that move must not begin inside walls.

use calcine_coupler::motion::{Contacts, Motion, Wall, WallShape};
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_native::particles::dem::{distance_to_shape, distance_to_triangle, repeated};

use super::model::Case;
use super::overlap::CRUSHED;
use super::place_error::PlaceError;

/// Refuses the first particle that moves and is deeper in a wall than softened contacts press it: a wall is as the sphere that
/// it mirrors.
pub fn check(case: &Case, setup: &ParticleSetup) -> Result<(), PlaceError> {
    let Motion::Free(contacts) = &setup.motion else {
        return Ok(());
    };
    let moving = Moving::new(contacts, setup);
    let deep = contacts
        .walls
        .iter()
        .filter_map(|wall| Some((wall, moving.first_in(wall)?)));
    // The first particle in the order of the case, and of several walls that in which it is deepest.
    let first = deep.min_by(|(_, a), (_, b)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let Some((wall, (row, distance))) = first else {
        return Ok(());
    };
    Err(PlaceError::InWall {
        id: setup.id[row],
        name: case.particles[setup.population[row] as usize].name.clone(),
        wall: wall.name.clone(),
        distance,
        radius: setup.radius[row],
    })
}

/// The particles that move, in ascending x.
struct Moving<'a> {
    setup: &'a ParticleSetup,
    rows: Vec<usize>,
    largest: f64,
    periodicity: Periodicity,
}

impl<'a> Moving<'a> {
    fn new(contacts: &Contacts, setup: &'a ParticleSetup) -> Self {
        let held = |row: usize| contacts.held[setup.population[row] as usize];
        let mut rows: Vec<usize> = (0..setup.radius.len()).filter(|&row| !held(row)).collect();
        rows.sort_by(|&a, &b| setup.position[a].x.total_cmp(&setup.position[b].x));
        let largest = setup.radius.iter().copied().fold(0.0, f64::max);
        Self {
            setup,
            rows,
            largest,
            periodicity: contacts.periodicity,
        }
    }

    /// The first particle that is in a wall, and the distance of its centre from it in m.
    fn first_in(&self, wall: &Wall) -> Option<(usize, f64)> {
        match &wall.shape {
            WallShape::Mesh { .. } => {
                let WallShape::Mesh { triangles } = repeated(&wall.shape, &self.periodicity) else {
                    return None;
                };
                let each = triangles.iter().filter_map(|one| self.first_at(one));
                each.min_by_key(|(row, _)| *row)
            }
            shape => {
                let near = self.rows.iter().filter_map(|&row| {
                    let distance = distance_to_shape(shape, self.setup.position[row])?;
                    self.is_in(row, distance).then_some((row, distance))
                });
                near.min_by_key(|(row, _)| *row)
            }
        }
    }

    fn first_at(&self, corners: &[Vec3; 3]) -> Option<(usize, f64)> {
        let [a, b, c] = corners;
        let low = a.inf(b).inf(c).add_scalar(-self.largest);
        let high = a.sup(b).sup(c).add_scalar(self.largest);
        let place = |row: usize| self.setup.position[row];
        let first = self.rows.partition_point(|&row| place(row).x < low.x);
        let near = self.rows[first..].iter().copied();
        let near = near.take_while(|&row| place(row).x <= high.x);
        let found = near.filter_map(|row| {
            let centre = place(row);
            let outside =
                centre.y < low.y || centre.y > high.y || centre.z < low.z || centre.z > high.z;
            if outside {
                return None;
            }
            let distance = distance_to_triangle(corners, centre);
            self.is_in(row, distance).then_some((row, distance))
        });
        found.min_by_key(|(row, _)| *row)
    }

    fn is_in(&self, row: usize, distance: f64) -> bool {
        let radius = self.setup.radius[row];
        radius - distance > CRUSHED * radius
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::assembly::PreparedCase;
    use crate::case::read;

    /// What preparing a case says with one bead here, in mm.
    fn said(case: &str, first: &str) -> Option<String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("{case}.toml"));
        let set = format!(
            "particles[0].place={{ grid = {{ first = \"{first} mm\", spacing = \"4 4 4 mm\", counts = [1, 1, 1] }} }}"
        );
        let case = read(&path, &[set]).unwrap();
        let prepared = PreparedCase::new(&case);
        prepared.err().map(|error| error.to_string())
    }

    #[test]
    fn a_bead_in_a_plane_wall_is_told_with_its_depth() {
        let case = "cases/settled-bed";
        assert_eq!(said(case, "8 8 0.85"), None);
        let told = said(case, "8 8 0.7").unwrap();
        for words in [
            "particle 1 of \"beads\" is in the wall \"container.z-\"",
            "its centre lies 0.0007 m from it, its radius is 0.001 m",
            "Move the population",
        ] {
            assert!(told.contains(words), "{told}");
        }
        let told = said(case, "0.1 8 20").unwrap();
        assert!(told.contains("its centre lies 0.0001 m from it"), "{told}");
    }

    /// The plate is at 5 mm, the floor at 1 mm, the drum 15 mm wide about (10, 10) mm.
    #[test]
    fn so_is_one_in_triangles_and_one_beyond_a_wall() {
        let case = "tests/inputs/good/moving";
        assert_eq!(said(case, "3 3 6.1"), None);
        let told = said(case, "3 3 5.2").unwrap();
        assert!(
            told.contains("in the wall \"plate\": its centre lies 0.0002 m from it"),
            "{told}"
        );
        let told = said(case, "3 3 1.1").unwrap();
        assert!(told.contains("particle 1 of"), "{told}");
        let told = said(case, "10 10 0.5").unwrap();
        assert!(
            told.contains("in the wall \"floor\": its centre lies 0.0005 m beyond it"),
            "{told}"
        );
    }
}
