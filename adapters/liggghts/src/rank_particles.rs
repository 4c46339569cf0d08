//! This rank's particles as columns, in ascending id.

use calcine_wire::hello::{hash_text, particles_hash};
use calcine_wire::{Header, Link, WireError};

use crate::error::HostError;
use crate::library::{self, Liggghts};

/// One value or vector per particle, in ascending id.
#[derive(Debug, Default)]
pub struct RankParticles {
    /// LIGGGHTS' tags.
    pub id: Vec<u64>,
    /// Place of each in LIGGGHTS' own arrays, until its next command.
    pub place: Vec<usize>,
    population: Vec<u64>,
    /// Centres in m, interleaved.
    pub position: Vec<f64>,
    velocity: Vec<f64>,
    angular_velocity: Vec<f64>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    /// Statistical weights; `None` where the bed has none.
    weight: Option<Vec<f64>>,
}

/// The fix that keeps statistical weights; the script of a bed that has some makes it.
pub const WEIGHT: &str = "calcine_weight";

impl RankParticles {
    /// Reads what LIGGGHTS holds now, with statistical weights where the bed has some.
    pub fn read(liggghts: &Liggghts, weights: bool) -> Result<Self, HostError> {
        let own = match weights {
            true => {
                let kept = liggghts.fix_scalars(WEIGHT);
                Some(kept.ok_or(HostError::Missing { name: WEIGHT })?.to_vec())
            }
            false => None,
        };
        let missing = |name: &'static str| move || HostError::Missing { name };
        let tags = liggghts.integers("id").ok_or_else(missing("id"))?;
        let mut order: Vec<usize> = (0..tags.len()).collect();
        order.sort_unstable_by_key(|&index| tags[index]);

        let integers = |name: &'static str| {
            let values = liggghts.integers(name).ok_or_else(missing(name))?;
            Ok::<Vec<i32>, HostError>(order.iter().map(|&index| values[index]).collect())
        };
        let scalars = |name: &'static str| {
            let values = liggghts.scalars(name).ok_or_else(missing(name))?;
            Ok::<Vec<f64>, HostError>(order.iter().map(|&index| values[index]).collect())
        };
        let vectors = |name: &'static str| {
            let values = liggghts.vectors(name).ok_or_else(missing(name))?;
            let rows = order
                .iter()
                .flat_map(|&index| &values[3 * index..3 * index + 3]);
            Ok::<Vec<f64>, HostError>(rows.copied().collect())
        };
        let whole = |value: &i32| u64::from(value.unsigned_abs());
        Ok(Self {
            id: integers("id")?.iter().map(whole).collect(),
            // LIGGGHTS counts types from 1.
            population: integers("type")?
                .iter()
                .map(|kind| whole(kind) - 1)
                .collect(),
            position: vectors("x")?,
            velocity: vectors("v")?,
            angular_velocity: vectors("omega")?,
            radius: scalars("radius")?,
            mass: scalars("rmass")?,
            weight: own.map(|own| order.iter().map(|&index| own[index]).collect()),
            place: order,
        })
    }

    /// Hash of the particles of all ranks; the coordinator computes the same from its own.
    pub fn hash(&self) -> String {
        hash_text(library::sum_over_ranks(particles_hash(
            &self.id,
            &self.radius,
        )))
    }

    /// 1/m in 1/kg of each, 0 for those of populations that are held.
    pub fn inverse_masses(&self, held: &[u64]) -> Vec<f64> {
        let pairs = self.population.iter().zip(&self.mass);
        let each = pairs.map(|(population, mass)| match held.contains(population) {
            true => 0.0,
            false => 1.0 / mass,
        });
        each.collect()
    }

    /// Sends the state with the impulses in N s, those of drag where they are told, and the time in s that the window's steps cover with the
    /// impulse of walls on this rank's particles in N s.
    pub fn send(
        &self,
        link: &mut Link,
        header: Header,
        (impulse, drag): (&[f64], Option<&[f64]>),
        support: [f64; 4],
    ) -> Result<(), WireError> {
        link.loan(header, self.id.len())?;
        link.column_words_mut("id")?.copy_from_slice(&self.id);
        link.column_words_mut("population")?
            .copy_from_slice(&self.population);
        let columns = [
            ("position", self.position.as_slice()),
            ("velocity", &self.velocity),
            ("angular_velocity", &self.angular_velocity),
            ("radius", &self.radius),
            ("mass", &self.mass),
            ("impulse", impulse),
            ("support", &support),
        ];
        for (name, values) in columns {
            link.column_mut(name)?.copy_from_slice(values);
        }
        if let Some(drag) = drag {
            link.column_mut("drag_impulse")?.copy_from_slice(drag);
        }
        if let Some(weight) = &self.weight {
            link.column_mut("weight")?.copy_from_slice(weight);
        }
        link.send()
    }
}
