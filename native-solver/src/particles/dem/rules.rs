//! What the forces of a run depend on, worked out once.

use calcine_coupler::motion::{Cohesion, Contacts, Rolling};
use calcine_coupler::physics::contact::PairConstants;

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
    /// True with cohesion.
    pub cohesion: bool,
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
            cohesion: contacts.law.cohesion != Cohesion::None,
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

    /// Constants of a pair of materials.
    #[inline(always)]
    pub fn pair(&self, a: u32, b: u32) -> &PairConstants {
        &self.pairs[a as usize * self.materials + b as usize]
    }
}
