//! How the volume of a particle follows its conversion (docs/theory.md, RXN-1, 2).

use calcine_numerics::Number;
use calcine_physics::law::LawEntry;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;

/// Which law the size of particles follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SizeRule {
    /// The diameter stays.
    ConstantDiameter,
    /// The density stays.
    ConstantDensity,
    /// Each solid has its own density.
    Densities,
}

/// The diameter stays and the density follows the mass.
pub static CONSTANT_DIAMETER: LawEntry<SizeRule> = LawEntry {
    name: "constant-diameter",
    summary: "The diameter stays and the density follows the mass.",
    source: "docs/theory.md, RXN-1",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(SizeRule::ConstantDiameter),
};

/// The density stays and particles shrink or grow.
pub static CONSTANT_DENSITY: LawEntry<SizeRule> = LawEntry {
    name: "constant-density",
    summary: "The density stays and particles shrink or grow.",
    source: "docs/theory.md, RXN-1",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(SizeRule::ConstantDensity),
};

/// Each solid has its own density in the particle.
pub static DENSITIES: LawEntry<SizeRule> = LawEntry {
    name: "densities",
    summary: "Each solid has its own density in the particle.",
    source: "docs/theory.md, RXN-1",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(SizeRule::Densities),
};

/// The laws by which a case may let particles change their size.
pub static SIZE_LAWS: &[&LawEntry<SizeRule>] = &[&CONSTANT_DIAMETER, &CONSTANT_DENSITY, &DENSITIES];

/// The law by which a particle of a material takes up room.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SizeChange {
    /// The diameter stays, and the density follows the mass: pores open or close.
    #[default]
    Constant,
    /// Each solid takes its own volume V_s in m³/mol, V = Σ n_s V_s, and the diameter follows.
    Volumes {
        /// V_s of each solid in m³/mol.
        each: Vec<f64>,
        /// Radius in m below which no particle shrinks; from there on its density follows.
        least_radius: f64,
    },
}

impl SizeChange {
    /// The density of the whole stays, in kg/m³: a particle that loses mass shrinks.
    pub fn of_density(density: f64, solids: &[SolidSpecies], least_radius: f64) -> Self {
        let each = solids.iter().map(|solid| solid.molar_mass() / density);
        Self::Volumes {
            each: each.collect(),
            least_radius,
        }
    }

    /// Each solid has its own density in kg/m³ in the particle, pores included; all are scaled by one factor
    /// such that the start, of mass fractions `start`, has exactly the material's density in kg/m³.
    pub fn of_densities(
        densities: &[f64],
        (density, start): (f64, &[f64]),
        solids: &[SolidSpecies],
        least_radius: f64,
    ) -> Self {
        let scale = 1.0 / (density * specific_volume(densities, start));
        let pairs = solids.iter().zip(densities);
        let each = pairs.map(|(solid, own)| scale * solid.molar_mass() / own);
        Self::Volumes {
            each: each.collect(),
            least_radius,
        }
    }

    /// Volumes in m³/mol of the solids; `None` where the diameter stays.
    pub fn volumes(&self) -> Option<&[f64]> {
        match self {
            Self::Constant => None,
            Self::Volumes { each, .. } => Some(each),
        }
    }

    /// Radius in m of a particle of amounts in mol; `None` where it stays as it is.
    pub fn radius(&self, amounts: &[f64]) -> Option<f64> {
        match self {
            Self::Constant => None,
            Self::Volumes { .. } => Some(self.radius_of(amounts, 0.0)),
        }
    }

    /// The same with derivatives; `own` in m where it stays as it is.
    pub(super) fn radius_of<N: Number>(&self, amounts: &[N], own: f64) -> N {
        let Self::Volumes { each, least_radius } = self else {
            return N::constant(own);
        };
        let parts = each.iter().zip(amounts);
        let volume = parts.fold(N::constant(0.0), |sum, (volume, n)| {
            sum + n.positive().times(*volume)
        });
        let radius = sphere::radius_of(volume);
        if radius.value() > *least_radius {
            radius
        } else {
            N::constant(*least_radius)
        }
    }
}

/// Volume in m³/kg of mass fractions of solids of these densities in kg/m³.
pub fn specific_volume(densities: &[f64], fractions: &[f64]) -> f64 {
    let held = fractions.iter().zip(densities).filter(|(y, _)| **y > 0.0);
    held.map(|(y, density)| y / density).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn solids() -> Vec<SolidSpecies> {
        ["CaCO3", "CaO"]
            .map(|name| SolidSpecies::built_in(name).unwrap())
            .to_vec()
    }

    #[test]
    fn a_particle_of_constant_density_shrinks_with_the_cube_root_of_its_mass() {
        let (solids, radius) = (solids(), 8e-3);
        let size = SizeChange::of_density(2700.0, &solids, 1e-3);
        let mass = 2700.0 * 4.0 / 3.0 * PI * 8e-3f64.powi(3);
        let amount = mass / solids[0].molar_mass();
        assert!((size.radius(&[amount, 0.0]).unwrap() / radius - 1.0).abs() < 1e-14);
        // CaO weighs 56.077 of 100.086 g.
        let burnt = size.radius(&[0.0, amount]).unwrap();
        assert!((burnt / radius - (56.077f64 / 100.086).cbrt()).abs() < 1e-5);
        assert_eq!(size.radius(&[1e-12, 0.0]), Some(1e-3), "the least radius");
        assert_eq!(SizeChange::Constant.radius(&[amount, 0.0]), None);
    }

    #[test]
    fn product_densities_give_the_start_its_density_and_the_end_its_volume() {
        let solids = solids();
        // Lime of 1600 kg/m³ takes 56.077/100.086 · 2700/1600 = 0.9455 of the stone's volume.
        let size = SizeChange::of_densities(&[2713.0, 1608.0], (2700.0, &[1.0, 0.0]), &solids, 0.0);
        let amount = 2700.0 / solids[0].molar_mass() * 4.0 / 3.0 * PI;
        assert!((size.radius(&[amount, 0.0]).unwrap() - 1.0).abs() < 1e-14);
        let end = size.radius(&[0.0, amount]).unwrap();
        let share = 56.077 / 100.086 * 2713.0 / 1608.0;
        assert!((end - f64::cbrt(share)).abs() < 1e-5, "{end}");
    }
}
