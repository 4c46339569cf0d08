//! What the forces of a run depend on, worked out once.

use calcine_coupler::motion::{Cohesion, Contacts, Rolling};
use calcine_coupler::physics::contact::{PairConstants, tear_off_distance};

/// Options and constants of pairs.
#[derive(Clone, Debug)]
pub struct ContactRules {
    /// Row by row of the symmetric matrix of materials.
    pairs: Vec<PairConstants>,
    materials: usize,
    /// True where damping may pull.
    pub attractive: bool,
    /// Resistance to rolling.
    pub rolling: Rolling,
    /// Attraction.
    pub cohesion: Cohesion,
}

impl ContactRules {
    /// Of a setup.
    pub fn new(contacts: &Contacts) -> Self {
        let materials = contacts.materials.len();
        let elastic = |i: usize| [contacts.materials[i].young, contacts.materials[i].poisson];
        let pair = |k: usize| {
            let given = &contacts.pairs[k];
            PairConstants {
                friction: given.friction,
                rolling_friction: given.rolling_friction,
                rolling_damping: given.rolling_damping,
                cohesion_energy: given.cohesion_energy,
                work_of_adhesion: given.work_of_adhesion,
                ..PairConstants::new(
                    elastic(k / materials),
                    elastic(k % materials),
                    given.restitution,
                )
            }
        };
        Self {
            pairs: (0..materials * materials).map(pair).collect(),
            materials,
            attractive: contacts.law.attractive_damping,
            rolling: contacts.law.rolling,
            cohesion: contacts.law.cohesion,
        }
    }

    /// Constants of all pairs, where there is one material only.
    #[inline(always)]
    pub fn single(&self) -> Option<&PairConstants> {
        match &self.pairs[..] {
            [only] => Some(only),
            _ => None,
        }
    }

    /// Distance in m of surfaces up to which a contact that was made holds, for a pair of materials and an effective radius in m.
    #[inline(always)]
    pub fn tear_off(&self, pair: &PairConstants, radius: f64) -> f64 {
        match self.cohesion {
            Cohesion::Jkr => tear_off_distance(pair, radius),
            Cohesion::None | Cohesion::Sjkr => 0.0,
        }
    }

    /// The longest such distance in m of all materials, for particles of at most a radius in m.
    pub fn longest_tear_off(&self, radius: f64) -> f64 {
        let pairs = self.pairs.iter();
        // Against a flat wall the effective radius is that of the particle; distances grow with it.
        pairs
            .map(|pair| self.tear_off(pair, radius))
            .fold(0.0, f64::max)
    }

    /// Constants of a pair of materials.
    #[inline(always)]
    pub fn pair(&self, a: u32, b: u32) -> &PairConstants {
        &self.pairs[a as usize * self.materials + b as usize]
    }
}
