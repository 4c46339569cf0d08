//! The fields of a gas as columns of one's own.

use crate::part::{GasFields, TurbulenceFields};
use crate::physics::Vec3;

/// Owned columns of [`GasFields`], one value per cell each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GasColumns {
    /// Temperature in K.
    pub temperature: Vec<f64>,
    /// Absolute pressure in Pa, hydrostatic part included.
    pub pressure: Vec<f64>,
    /// Density of the gas itself in kg/m³.
    pub density: Vec<f64>,
    /// Mass fractions, species by species within each cell; empty for a single gas.
    pub composition: Vec<f64>,
    /// Interstitial velocity in m/s.
    pub velocity: Vec<Vec3>,
    /// Cell gradient of the total pressure in Pa/m.
    pub pressure_gradient: Vec<Vec3>,
    /// Turbulent energy in m²/s²; empty where the gas is laminar, as are the next two.
    pub turbulent_energy: Vec<f64>,
    /// Dissipation of turbulent energy in m²/s³.
    pub dissipation: Vec<f64>,
    /// Void fraction × eddy viscosity in Pa s.
    pub eddy_viscosity: Vec<f64>,
}

impl GasColumns {
    /// Copies the fields of a gas into the memory that is there.
    pub fn take(&mut self, gas: &GasFields<'_>) {
        // Names every field, so that a new one is not left out.
        let GasFields {
            temperature,
            pressure,
            density,
            composition,
            velocity,
            pressure_gradient,
            turbulence:
                TurbulenceFields {
                    energy,
                    dissipation,
                    viscosity,
                },
        } = *gas;
        temperature.clone_into(&mut self.temperature);
        pressure.clone_into(&mut self.pressure);
        density.clone_into(&mut self.density);
        composition.clone_into(&mut self.composition);
        velocity.clone_into(&mut self.velocity);
        pressure_gradient.clone_into(&mut self.pressure_gradient);
        energy.clone_into(&mut self.turbulent_energy);
        dissipation.clone_into(&mut self.dissipation);
        viscosity.clone_into(&mut self.eddy_viscosity);
    }

    /// The columns as fields of a gas.
    pub fn fields(&self) -> GasFields<'_> {
        GasFields {
            temperature: &self.temperature,
            pressure: &self.pressure,
            density: &self.density,
            composition: &self.composition,
            velocity: &self.velocity,
            pressure_gradient: &self.pressure_gradient,
            turbulence: TurbulenceFields {
                energy: &self.turbulent_energy,
                dissipation: &self.dissipation,
                viscosity: &self.eddy_viscosity,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_show_the_fields_that_they_took() {
        let scalars: [Vec<f64>; 7] = std::array::from_fn(|k| vec![k as f64 + 0.5, 2.0]);
        let vectors = [1.0, 2.0].map(|z| vec![Vec3::new(0.0, 0.0, z); 2]);
        let gas = GasFields {
            temperature: &scalars[0],
            pressure: &scalars[1],
            density: &scalars[2],
            composition: &scalars[3],
            velocity: &vectors[0],
            pressure_gradient: &vectors[1],
            turbulence: TurbulenceFields {
                energy: &scalars[4],
                dissipation: &scalars[5],
                viscosity: &scalars[6],
            },
        };
        let mut columns = GasColumns::default();
        columns.take(&gas);
        assert_eq!(format!("{:?}", columns.fields()), format!("{gas:?}"));
    }
}
