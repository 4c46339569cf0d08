//! Profiles of the bed's void fraction at the end of a run: over the height, and in a cylinder over the distance
//! from the wall. `voids.csv` holds them.

use std::f64::consts::PI;
use std::path::Path;

use calcine_coupler::motion::WallShape;
use calcine_coupler::part::ParticleFields;
use calcine_coupler::physics::quadrature::gauss;
use calcine_coupler::physics::{Vec3, sphere};

use super::files::VOIDS;
use super::{ResultsError, files, sheet};
use crate::case::model::{Case, MeshSpec};

/// Fewer particles have no profile: each would show as itself.
const FEWEST: usize = 50;
/// Points of a profile in one mean diameter, and in all.
const POINTS: (f64, f64) = (25.0, 600.0);
/// How far from the ends of a bed, in mean diameters, they no longer order its layers; and the share of centres
/// below which the bed is taken to end.
const ENDS: (f64, f64, f64) = (2.5, 2.0, 0.95);

/// Void fraction over a length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VoidProfile {
    /// Places in m.
    pub place: Vec<f64>,
    /// Void fraction there.
    pub void_fraction: Vec<f64>,
}

/// The profiles of a bed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VoidProfiles {
    /// Over the height z in m: share of the container's cross-section that no particle cuts.
    pub height: VoidProfile,
    /// In a cylinder, over the distance from its wall in m: share of the surface of that distance that no particle
    /// cuts, away from the ends of the bed. Empty elsewhere, and where the bed is too low.
    pub wall: VoidProfile,
}

/// What holds a bed: an upright cylinder or a box.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Container {
    /// A point of the axis and the radius, in m.
    Cylinder(Vec3, f64),
    /// Cross-section in m².
    Box(f64),
}

impl Container {
    /// That of a case: a wall that is an upright cylinder, else the mesh; `None` where the cross-section is unknown
    /// or changes with the height.
    fn of(case: &Case) -> Option<Self> {
        let mut round = case.walls.iter().filter_map(|wall| match wall.shape {
            WallShape::Cylinder {
                point,
                axis,
                radius,
            } => Some((point, axis, radius)),
            _ => None,
        });
        if let Some((point, axis, radius)) = round.next() {
            let upright = axis.z.abs() >= axis.norm() * (1.0 - 1e-12);
            let alone = round.next().is_none();
            return (upright && alone).then_some(Self::Cylinder(point, radius));
        }
        match &case.mesh {
            MeshSpec::Box { size, .. } => Some(Self::Box(size.x * size.y)),
            MeshSpec::Cylinder {
                origin, diameter, ..
            } => Some(Self::Cylinder(*origin, 0.5 * diameter)),
            MeshSpec::PolyMesh(_) => None,
        }
    }

    fn area(self) -> f64 {
        match self {
            Self::Cylinder(_, radius) => sphere::cross_section(radius),
            Self::Box(area) => area,
        }
    }
}

/// The profiles of a bed in the container of its case; `None` where it has none.
pub(super) fn of_bed(case: &Case, bed: &ParticleFields<'_>) -> Option<VoidProfiles> {
    let container = Container::of(case)?;
    (bed.len() >= FEWEST).then(|| profiles(container, bed.position, bed.radius))
}

fn profiles(container: Container, centres: &[Vec3], radii: &[f64]) -> VoidProfiles {
    let diameter = 2.0 * radii.iter().sum::<f64>() / radii.len() as f64;
    let ends = centres.iter().zip(radii).map(|(c, r)| (c.z - r, c.z + r));
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| {
        (a.0.min(b.0), a.1.max(b.1))
    });
    let height = over_height(
        container.area(),
        centres,
        radii,
        places(low, high, diameter),
    );
    let mut wall = VoidProfile::default();
    if let Container::Cylinder(axis, radius) = container {
        let mut heights: Vec<f64> = centres.iter().map(|centre| centre.z).collect();
        heights.sort_by(f64::total_cmp);
        let top = heights[((heights.len() - 1) as f64 * ENDS.2) as usize];
        let band = [low + ENDS.0 * diameter, top - ENDS.1 * diameter];
        if band[1] - band[0] > diameter {
            let places = places(0.0, radius, diameter);
            wall = over_distance((axis, radius), band, centres, radii, places);
        }
    }
    VoidProfiles { height, wall }
}

/// Places from one to another in m, so many in a diameter that its oscillations are seen.
fn places(from: f64, to: f64, diameter: f64) -> Vec<f64> {
    let step = (diameter / POINTS.0).max((to - from) / POINTS.1);
    let count = ((to - from) / step * (1.0 + 1e-12)) as usize;
    (0..=count).map(|k| from + k as f64 * step).collect()
}

/// Adds `covered` of every place between `from` and `to` to a profile with even places.
fn add(
    sums: &mut [f64],
    places: &[f64],
    (from, to): (f64, f64),
    mut covered: impl FnMut(f64) -> f64,
) {
    let first = places.partition_point(|&place| place < from);
    let last = places.partition_point(|&place| place <= to);
    for k in first..last {
        sums[k] += covered(places[k]);
    }
}

/// One less the area in which spheres cut the plane of each height, over the cross-section in m².
fn over_height(area: f64, centres: &[Vec3], radii: &[f64], place: Vec<f64>) -> VoidProfile {
    let mut sums = vec![0.0; place.len()];
    for (centre, &radius) in centres.iter().zip(radii) {
        let range = (centre.z - radius, centre.z + radius);
        add(&mut sums, &place, range, |z| {
            PI * (radius * radius - (z - centre.z).powi(2))
        });
    }
    VoidProfile {
        void_fraction: sums.iter().map(|sum| 1.0 - sum / area).collect(),
        place,
    }
}

/// One less the area in which spheres cut the surface of each distance from the wall, between two heights, over
/// that surface. Around the axis a sphere at the distance b from it covers, at the angle φ and the radius r, a line
/// of the length 2 √(R² − r² − b² + 2 r b cos φ), and all angles up to where that is zero; with φ = φ₀ sin θ the
/// integrand is smooth.
fn over_distance(
    (axis, wall): (Vec3, f64),
    band: [f64; 2],
    centres: &[Vec3],
    radii: &[f64],
    place: Vec<f64>,
) -> VoidProfile {
    let around = 2.0 * PI * (band[1] - band[0]);
    let mut sums = vec![0.0; place.len()];
    for (centre, &radius) in centres.iter().zip(radii) {
        if centre.z + radius <= band[0] || centre.z - radius >= band[1] {
            continue;
        }
        let out = (centre.x - axis.x).hypot(centre.y - axis.y);
        let range = (wall - out - radius, wall - (out - radius).max(0.0));
        add(&mut sums, &place, range, |distance| {
            let r = wall - distance;
            let squares = r * r + out * out;
            let last = if r + out <= radius || r * out == 0.0 {
                PI
            } else {
                let cosine = (squares - radius * radius) / (2.0 * r * out);
                cosine.clamp(-1.0, 1.0).acos()
            };
            let line = |theta: f64| {
                let angle = last * theta.sin();
                let square = radius * radius - squares + 2.0 * r * out * angle.cos();
                let half = square.max(0.0).sqrt();
                let (low, high) = (centre.z - half, centre.z + half);
                let length = (high.min(band[1]) - low.max(band[0])).max(0.0);
                length * last * theta.cos()
            };
            2.0 * gauss(0.0, 0.5 * PI, line) / around
        });
    }
    VoidProfile {
        void_fraction: sums.iter().map(|sum| 1.0 - sum).collect(),
        place,
    }
}

impl VoidProfiles {
    /// Writes the file: the name of the profile, the place, the void fraction.
    pub(super) fn write(&self, directory: &Path) -> Result<(), ResultsError> {
        let path = directory.join(VOIDS);
        let head = ["profile", "place [m]", "void_fraction [1]"];
        let mut text = sheet::line(&path, &head.map(str::to_owned))?;
        for (name, profile) in [("height", &self.height), ("wall", &self.wall)] {
            for (&place, &value) in profile.place.iter().zip(&profile.void_fraction) {
                let words = [name.to_owned(), sheet::number(place), sheet::number(value)];
                text.extend(sheet::line(&path, &words)?);
            }
        }
        files::replace(&path, &text)
    }

    /// Reads the file of a result directory; `None` where there is none.
    pub fn read(directory: &Path) -> Result<Option<Self>, ResultsError> {
        let path = directory.join(VOIDS);
        if !path.is_file() {
            return Ok(None);
        }
        let mut voids = Self::default();
        for row in sheet::rows(&path, &files::read(&path)?)?.iter().skip(1) {
            let number = |place: usize| row.get(place)?.parse::<f64>().ok();
            let profile = match row.get(0) {
                Some("height") => Some(&mut voids.height),
                Some("wall") => Some(&mut voids.wall),
                _ => None,
            };
            let (Some(profile), Some(place), Some(value)) = (profile, number(1), number(2)) else {
                return Err(ResultsError::content(
                    &path,
                    format!("a line is `{}`", sheet::words(row)),
                ));
            };
            profile.place.push(place);
            profile.void_fraction.push(value);
        }
        Ok(Some(voids))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simpson's rule over even places.
    fn integral(place: &[f64], value: impl Fn(usize) -> f64) -> f64 {
        assert!(place.len() % 2 == 1);
        let step = place[1] - place[0];
        let weight = |k: usize| match k {
            0 => 1.0,
            _ if k == place.len() - 1 => 1.0,
            _ if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..place.len()).map(|k| weight(k) * value(k)).sum::<f64>() * step / 3.0
    }

    fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
        let step = (to - from) / (count - 1) as f64;
        (0..count).map(|k| from + k as f64 * step).collect()
    }

    #[test]
    fn over_the_height_the_covered_areas_add_up_to_the_volumes_of_the_spheres() {
        let centres = [Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.1, 0.0, 0.5)];
        let radii = [0.1, 0.25];
        let profile = over_height(0.7, &centres, &radii, even(0.0, 1.0, 4001));
        let covered = |k: usize| 0.7 * (1.0 - profile.void_fraction[k]);
        let volume = 4.0 / 3.0 * PI * (0.001 + 0.015_625);
        let found = integral(&profile.place, covered);
        assert!((found / volume - 1.0).abs() < 1e-4, "{found} {volume}");
    }

    #[test]
    fn a_sphere_on_the_axis_covers_a_chord_at_each_radius() {
        let place = vec![0.5, 0.6, 0.8, 0.95, 1.0];
        let band = [-1.0, 1.0];
        let profile = over_distance((Vec3::zeros(), 1.0), band, &[Vec3::zeros()], &[0.5], place);
        for (distance, void_fraction) in profile.place.iter().zip(&profile.void_fraction) {
            let r: f64 = 1.0 - distance;
            let exact = 1.0 - (0.25 - r * r).max(0.0).sqrt();
            assert!(
                (void_fraction - exact).abs() < 1e-12,
                "{r}: {void_fraction}"
            );
        }
    }

    #[test]
    fn over_the_distance_the_covered_surfaces_add_up_to_the_volume_of_a_sphere_anywhere() {
        for out in [0.05, 0.1, 0.4, 0.8] {
            let centre = Vec3::new(0.3 + out * 0.6, out * 0.8, 0.02);
            let axis = Vec3::new(0.3, 0.0, 7.0);
            let (radius, band) = (0.1, [-0.5, 0.5]);
            let place = even(0.0, 1.0, 8001);
            let profile = over_distance((axis, 1.0), band, &[centre], &[radius], place);
            let surface =
                |k: usize| 2.0 * PI * (1.0 - profile.place[k]) * (1.0 - profile.void_fraction[k]);
            let found = integral(&profile.place, surface);
            let volume = 4.0 / 3.0 * PI * radius * radius * radius;
            assert!(
                (found / volume - 1.0).abs() < 1e-4,
                "{out}: {found} {volume}"
            );
            // Half of it where the band ends at its centre.
            let lower = [-0.5, 0.02];
            let place = even(0.0, 1.0, 8001);
            let half = over_distance((axis, 1.0), lower, &[centre], &[radius], place);
            let share = 0.52; // height of the band
            let surface =
                |k: usize| 2.0 * PI * share * (1.0 - half.place[k]) * (1.0 - half.void_fraction[k]);
            let found = integral(&half.place, surface);
            assert!((found / volume - 0.5).abs() < 1e-4, "{out}: {found}");
        }
    }

    #[test]
    fn a_file_reads_back_to_the_same_bits_and_another_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(VoidProfiles::read(folder.path()).unwrap(), None);
        let centres: Vec<Vec3> = (0..400)
            .map(|k| Vec3::new(f64::from(k % 9) * 0.1, 0.0, f64::from(k) / 300.0))
            .collect();
        let voids = profiles(
            Container::Cylinder(Vec3::zeros(), 1.0),
            &centres,
            &[0.05; 400],
        );
        assert!(!voids.wall.place.is_empty() && !voids.height.place.is_empty());
        voids.write(folder.path()).unwrap();
        assert_eq!(VoidProfiles::read(folder.path()).unwrap(), Some(voids));
        files::replace(&folder.path().join(VOIDS), b"head\nslope,1,2\n").unwrap();
        let error = VoidProfiles::read(folder.path()).unwrap_err().to_string();
        assert!(error.contains("slope,1,2"), "{error}");
    }
}
