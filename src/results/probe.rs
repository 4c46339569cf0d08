//! Probes: which cells and particles lie at their points, and what is read there.

use std::collections::HashMap;
use std::path::Path;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::physics::Vec3;

use super::snapshot::{Field, Values};
use super::{ResultsError, files, sheet};
use crate::case::model::Probe;

/// The points of a probe, and the cell of each.
pub(super) struct Site {
    /// What the case says.
    pub probe: Probe,
    /// The cell of each point, `None` outside the mesh.
    pub cells: Vec<Option<usize>>,
}

/// Finds the cells of all probes' points; an error where none of a probe's lies in the mesh.
pub(super) fn sites(probes: &[Probe], mesh: &Mesh) -> Result<Vec<Site>, ResultsError> {
    if probes.is_empty() {
        return Ok(Vec::new());
    }
    let locator = Locator::new(mesh);
    let site = |probe: &Probe| {
        let points = probe.points.iter();
        let cells: Vec<_> = points.map(|&point| locator.cell_at(point)).collect();
        if cells.iter().all(Option::is_none) {
            return Err(ResultsError::ProbeOutside {
                probe: probe.name.clone(),
            });
        }
        Ok(Site {
            probe: probe.clone(),
            cells,
        })
    };
    probes.iter().map(site).collect()
}

impl Site {
    /// The particle at each point: the one that holds it, else the one of the nearest surface, if
    /// that is within the particle's own diameter.
    pub fn particles(&self, centres: &[Vec3], radii: &[f64]) -> Vec<Option<usize>> {
        let points = &self.probe.points;
        let mut nearest: Vec<Option<(f64, usize)>> = vec![None; points.len()];
        let largest = radii.iter().copied().fold(0.0, f64::max);
        // Points by cells as wide as a particle reaches.
        let width = 3.0 * largest;
        let cell = |point: &Vec3| [0, 1, 2].map(|axis| (point[axis] / width).floor() as i64);
        let mut by_cell: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (index, point) in points.iter().enumerate() {
            by_cell.entry(cell(point)).or_default().push(index);
        }
        for (particle, (centre, radius)) in centres.iter().zip(radii).enumerate() {
            let own = cell(centre);
            for n in 0..27 {
                let step = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
                let place = [0, 1, 2].map(|axis| own[axis].saturating_add(step[axis]));
                for &point in by_cell.get(&place).into_iter().flatten() {
                    let gap = (points[point] - centre).norm() - radius;
                    let best = &mut nearest[point];
                    if gap <= 2.0 * radius && best.is_none_or(|(least, _)| gap < least) {
                        *best = Some((gap, particle));
                    }
                }
            }
        }
        let found = nearest.into_iter();
        found
            .map(|best| best.map(|(_, particle)| particle))
            .collect()
    }
}

/// One field at the points of a probe.
pub(super) struct Column {
    /// Whether it is of the particles.
    pub of_particles: bool,
    /// Name of the field.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub description: String,
    /// A value for each point; vectors by their magnitude, NaN where there is nothing.
    pub values: Vec<f64>,
}

/// A probe with all its fields at one moment.
pub(super) struct Sample<'a> {
    /// The probe.
    pub site: &'a Site,
    /// The fields.
    pub columns: Vec<Column>,
}

/// Reads the fields of a snapshot at all probes; those of particles begin with id and radius.
pub(super) fn samples<'a>(
    sites: &'a [Site],
    gas: &[Field<'_>],
    particles: &[Field<'_>],
    centres: &[Vec3],
    radii: &[f64],
) -> Vec<Sample<'a>> {
    let of = |site: &'a Site| {
        let mut columns = Vec::new();
        if site.probe.gas {
            columns.extend(gas.iter().map(|field| column(field, &site.cells, false)));
        }
        if site.probe.particles {
            let places = site.particles(centres, radii);
            let single = |field: &&Field<'_>| !matches!(field.values, Values::Ragged(_));
            let fields = particles.iter().filter(single);
            columns.extend(fields.map(|field| column(field, &places, true)));
        }
        Sample { site, columns }
    };
    sites.iter().map(of).collect()
}

fn column(field: &Field<'_>, places: &[Option<usize>], of_particles: bool) -> Column {
    let value = |place: &Option<usize>| match (*place, field.values) {
        (Some(place), Values::Scalar(list)) => list[place],
        (
            Some(place),
            Values::Column {
                table,
                column,
                columns,
            },
        ) => table[place * columns + column],
        (Some(place), Values::Vector(list)) => list[place].norm(),
        (Some(place), Values::Whole(list)) => list[place] as f64,
        (Some(place), Values::Small(list)) => f64::from(list[place]),
        (None, _) | (Some(_), Values::Ragged(_)) => f64::NAN,
    };
    let holder = if of_particles {
        "of the particle at each point"
    } else {
        "of the cell that holds each point"
    };
    Column {
        of_particles,
        name: field.name.to_owned(),
        unit: field.unit,
        description: format!(
            "{} {holder} (vectors: magnitude), snapshot by point",
            field.description
        ),
        values: places.iter().map(value).collect(),
    }
}

/// Writes the probes of one snapshot as a table: a row a point, the distance along the points.
pub(super) fn write(path: &Path, samples: &[Sample<'_>]) -> Result<(), ResultsError> {
    let mut names: Vec<String> = Vec::new();
    let head = |column: &Column| {
        let of = if column.of_particles { "particle_" } else { "" };
        format!("{of}{} [{}]", column.name, column.unit)
    };
    for column in samples.iter().flat_map(|sample| &sample.columns) {
        let name = head(column);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let fixed = ["probe", "distance [m]", "x [m]", "y [m]", "z [m]"];
    let first: Vec<String> = fixed.into_iter().map(str::to_owned).collect();
    let mut text = sheet::line(path, &[&first[..], &names].concat())?;
    for sample in samples {
        let columns: Vec<Option<&Column>> = names
            .iter()
            .map(|name| sample.columns.iter().find(|column| head(column) == *name))
            .collect();
        let (mut distance, mut before) = (0.0, None);
        for (index, point) in sample.site.probe.points.iter().enumerate() {
            distance += before.map_or(0.0, |before: &Vec3| (point - before).norm());
            before = Some(point);
            let place = [distance, point.x, point.y, point.z];
            let values = columns
                .iter()
                .map(|column| column.map_or(f64::NAN, |column| column.values[index]));
            let mut words = vec![sample.site.probe.name.clone()];
            words.extend(place.into_iter().chain(values).map(sheet::number));
            text.extend(sheet::line(path, &words)?);
        }
    }
    files::replace(path, &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_the_particle_that_holds_it_or_the_nearest_within_a_diameter() {
        let probe = Probe {
            name: "p".into(),
            points: [0.5, 1.4, 3.9, 4.1, -40.0]
                .map(|z| Vec3::new(0.0, 0.0, z))
                .into(),
            gas: false,
            particles: true,
        };
        let site = Site {
            cells: vec![None; 5],
            probe,
        };
        let centres = [Vec3::zeros(), Vec3::new(0.0, 0.0, 2.0)];
        // The radius is 1 and 0.5: the second's surface is 2.5, a diameter farther 3.5.
        let found = site.particles(&centres, &[1.0, 0.5]);
        assert_eq!(found, [Some(0), Some(1), None, None, None]);
        assert_eq!(
            site.particles(&centres, &[1.0, 1.0])[2..4],
            [Some(1), Some(1)]
        );
        assert!(site.particles(&[], &[]).iter().all(Option::is_none));
    }
}
