//! Particles that go and come between two windows, get another size, or come to rest.
//!
//! The coordinator tells them as lines: `rest`, `remove ID`, `insert ID TYPE x y z vx vy vz RADIUS DENSITY [WEIGHT]`, and
//! `resize ID RADIUS MASS`, in SI with every digit.

use std::f64::consts::PI;

use crate::error::HostError;
use crate::library::Liggghts;
use crate::rank_particles::RankParticles;

/// Ids in one command: LIGGGHTS' lines are limited to 2048 letters.
const IDS_A_LINE: usize = 100;
/// The group of those that go.
const GROUP: &str = "calcine_gone";

/// A place in no box.
const NOWHERE: &str = "1e30 1e30 1e30";

/// One particle that comes.
struct New {
    id: i32,
    kind: i32,
    /// Centre, velocity, radius, density.
    values: [f64; 8],
}

/// One particle that gets another size.
struct Resized {
    id: u64,
    radius: f64,
    mass: f64,
}

/// What goes and comes, and what becomes of those that stay.
pub struct PopulationUpdate {
    remove: Vec<u64>,
    insert: Vec<New>,
    resize: Vec<Resized>,
    rest: bool,
}

impl PopulationUpdate {
    /// Reads the lines.
    pub fn parse(text: &str) -> Result<Self, HostError> {
        let (mut remove, mut insert, mut resize) = (Vec::new(), Vec::new(), Vec::new());
        let mut rest = false;
        for line in text.lines() {
            let refuse = || HostError::Change { line: line.into() };
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["rest"] => rest = true,
                ["remove", id] => remove.push(id.parse().map_err(|_| refuse())?),
                ["insert", id, kind, ref rest @ ..] => {
                    let values: Result<Vec<f64>, _> =
                        rest.iter().map(|word| word.parse()).collect();
                    let mut values = values.map_err(|_| refuse())?;
                    // A weight may stand last; what moves and touches others stands for itself alone.
                    if values.len() == 9 && values.pop() != Some(1.0) {
                        return Err(refuse());
                    }
                    insert.push(New {
                        id: id.parse().map_err(|_| refuse())?,
                        kind: kind.parse().map_err(|_| refuse())?,
                        values: <[f64; 8]>::try_from(values).map_err(|_| refuse())?,
                    });
                }
                ["resize", id, radius, mass] => resize.push(Resized {
                    id: id.parse().map_err(|_| refuse())?,
                    radius: radius.parse().map_err(|_| refuse())?,
                    mass: mass.parse().map_err(|_| refuse())?,
                }),
                _ => return Err(refuse()),
            }
        }
        Ok(Self {
            remove,
            insert,
            resize,
            rest,
        })
    }

    /// Makes the change; how many particles there must be afterwards. `state`: this rank's particles since LIGGGHTS'
    /// last command.
    ///
    /// Deleting comes first, be it of nobody. The springs of contacts lie in the list of neighbours, by the places
    /// of particles, and deleting takes them over to the particles. One that comes takes the place of a ghost: if
    /// the list were read after that, springs would be lost or those of other pairs, and different ones on the two
    /// ranks of a pair, whose forces would no more cancel.
    pub fn apply(
        &self,
        liggghts: &mut Liggghts,
        state: &RankParticles,
        before: u64,
    ) -> Result<u64, HostError> {
        self.rest(liggghts)?;
        self.resize(liggghts, state)?;
        if self.remove.is_empty() && self.insert.is_empty() {
            return Ok(before);
        }
        liggghts.command(&format!("group {GROUP} subtract all all"));
        for ids in self.remove.chunks(IDS_A_LINE) {
            let words: Vec<String> = ids.iter().map(u64::to_string).collect();
            liggghts.command(&format!("group {GROUP} id {}", words.join(" ")));
        }
        // Without `no` the ids of those that stay would be counted anew.
        liggghts.command(&format!("delete_atoms group {GROUP} compress no"));
        liggghts.command(&format!("group {GROUP} delete"));
        for new in &self.insert {
            put_in(liggghts, new)?;
        }
        if !self.insert.is_empty() {
            // Creating one beyond the box makes nothing but LIGGGHTS' map of ids anew, which must hold those given here.
            liggghts.command(&format!("create_atoms 1 single {NOWHERE} units box"));
        }
        Ok(before + self.insert.len() as u64 - self.remove.len() as u64)
    }

    /// Stops this rank's particles, where they shall come to rest.
    fn rest(&self, liggghts: &mut Liggghts) -> Result<(), HostError> {
        let names: &[_] = if self.rest { &["v", "omega"] } else { &[] };
        for &name in names {
            let speeds = liggghts.vectors_mut(name);
            speeds.ok_or(HostError::Missing { name })?.fill(0.0);
        }
        Ok(())
    }

    /// Gives this rank's particles their new sizes; other ranks get theirs in the setup that follows.
    fn resize(&self, liggghts: &mut Liggghts, state: &RankParticles) -> Result<(), HostError> {
        if self.resize.is_empty() {
            return Ok(());
        }
        let place = |new: &Resized| Some(state.place[state.id.binary_search(&new.id).ok()?]);
        let own = self.resize.iter();
        let own: Vec<(usize, &Resized)> = own.filter_map(|new| Some((place(new)?, new))).collect();
        let value = |name, new: &Resized| match name {
            "radius" => new.radius,
            "rmass" => new.mass,
            _ => new.mass / volume(new.radius),
        };
        for name in ["radius", "rmass", "density"] {
            let column = liggghts.scalars_mut(name);
            let column = column.ok_or(HostError::Missing { name })?;
            for (place, new) in &own {
                column[*place] = value(name, new);
            }
        }
        Ok(())
    }
}

/// Volume of a sphere in m³.
fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// Creates a particle and gives it its id and its state, on the rank that has its place.
fn put_in(liggghts: &mut Liggghts, new: &New) -> Result<(), HostError> {
    let [x, y, z, vx, vy, vz, radius, density] = new.values;
    let before = liggghts.here();
    liggghts.command(&format!(
        "create_atoms {} single {x:e} {y:e} {z:e} units box",
        new.kind
    ));
    let place = before;
    if liggghts.here() == before {
        return Ok(()); // another rank's, or beyond the box: then it is noticed as lost
    }
    let missing = |name| HostError::Missing { name };
    let mass = volume(radius) * density;
    for (name, value) in [("radius", radius), ("density", density), ("rmass", mass)] {
        let column = liggghts.scalars_mut(name);
        column.ok_or_else(|| missing(name))?[place] = value;
    }
    for (name, vector) in [("x", [x, y, z]), ("v", [vx, vy, vz]), ("omega", [0.0; 3])] {
        let column = liggghts.vectors_mut(name).ok_or_else(|| missing(name))?;
        column[3 * place..3 * place + 3].copy_from_slice(&vector);
    }
    liggghts.tags_mut().ok_or_else(|| missing("id"))?[place] = new.id;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_not_understood_are_told() {
        let good =
            PopulationUpdate::parse("remove 7\ninsert 9 1 0 0 0.5 0 0 -1 1e-3 2500\n").unwrap();
        assert_eq!((good.remove[0], good.insert[0].id), (7, 9));
        assert_eq!(good.insert[0].values[2], 0.5);
        let other = PopulationUpdate::parse("rest\nresize 3 2.5e-3 1.5e-4\n").unwrap();
        assert!(other.rest && !good.rest);
        let Resized { id, radius, mass } = other.resize[0];
        assert_eq!((id, radius, mass), (3, 2.5e-3, 1.5e-4));
        for line in [
            "remove",
            "insert 9 1 0 0",
            "resize 9 1e-3",
            "insert 9 1 0 0 0 0 0 0 x 1",
            "add 3",
        ] {
            let error = PopulationUpdate::parse(line).err().unwrap().to_string();
            assert!(error.contains(line), "{error}");
        }
    }
}
