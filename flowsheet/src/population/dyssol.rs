//! Dyssol's own scheme of growth, for comparison.

use crate::SizeGrid;

/// Adds the rates in kg/s of the masses of size classes by Dyssol's scheme: mass densities are carried upwind, and gain the
/// ratio of the volumes of two classes where they pass from one to the next (docs/theory.md, PBM-5). `growth` is dd/dt in
/// m/s. What the masses sum to is not what the spray brings.
///
/// Source: units "Granulator" and "GranulatorSimpleBatch" of Dyssol (SoftwareX 12 (2020) 100572,
/// doi 10.1016/j.softx.2020.100572). There the first class of the continuous granulator does not change, that of the batch
/// one empties: `first_empties`.
pub fn dyssol_growth(
    grid: &SizeGrid,
    growth: f64,
    masses: &[f64],
    first_empties: bool,
    rates: &mut [f64],
) {
    for class in 0..masses.len() {
        let own = masses[class] / grid.width(class);
        let before = if class == 0 {
            if !first_empties {
                continue;
            }
            0.0
        } else {
            let ratio = grid.diameters()[class] / grid.diameters()[class - 1];
            masses[class - 1] / grid.width(class - 1) * ratio.powi(3)
        };
        rates[class] -= growth * (own - before);
    }
}
