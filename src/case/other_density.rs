//! Files of particles that state densities or masses: those of the materials count.

use std::path::Path;

use calcine_coupler::physics::sphere;

use super::bed::{Entry, Heaviness};
use super::model::{Case, Population};
use super::units::short3;

/// Share by which a density of a file may differ from that of the material; masses are often rounded.
const SAME: f64 = 1e-2;

/// A warning where a file states another density than the material's; entries with the diameters in m of those that state none.
pub(super) fn told<'a>(
    case: &Case,
    population: &Population,
    path: &Path,
    mut entries: impl Iterator<Item = (&'a Entry, &'a f64)>,
) -> Option<String> {
    let material = &case.materials[population.material];
    let (row, density) = entries.find_map(|(entry, drawn)| {
        let density = match entry.heaviness? {
            Heaviness::Density(density) => density,
            Heaviness::Mass(mass) => mass / sphere::volume(0.5 * entry.diameter.unwrap_or(*drawn)),
        };
        let differs = (density - material.density).abs() > SAME * material.density;
        differs.then_some((entry.row, density))
    })?;
    let (population, name) = (&population.name, &material.name);
    Some(format!(
        "`particles.{population}.place.file`: {}, {row} has a density of {} kg/m^3, `{name}` one of {}, which counts; correct \
         `materials.{name}.density`, or give what has another density a population and a material of its own by `place.type`",
        path.display(),
        short3(density),
        short3(material.density)
    ))
}
