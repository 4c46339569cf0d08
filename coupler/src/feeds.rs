//! Feeds and outlets: which particles come and go between two windows. The coordinator decides, so
//! that every backend gets the same.

use std::f64::consts::PI;
use std::iter;

use calcine_physics::{Vec3, sphere};

use crate::checkpoint::{StateFile, StateFileError};
use crate::mesh::zone::Zone;
use crate::motion::{NewParticle, ParticleChanges};
use crate::neighbourhood::Neighbourhood;
use crate::outflows::Outflows;
use crate::packing::random::SplitMix64;
use crate::packing::{PackingError, Sizes};
use crate::part::ParticleFields;
use crate::periodicity::Periodicity;

/// Places that are tried for a particle in one window; without a free one it waits for the next.
const TRIES: u32 = 200;

/// Particles that come in.
#[derive(Clone, Debug)]
pub struct Feed {
    /// Its name.
    pub name: String,
    /// Index of their population.
    pub population: u32,
    /// Where they appear, whole spheres within.
    pub zone: Zone,
    /// Mass flow in kg/s of process time.
    pub rate: f64,
    /// Process times in s at which that flow begins and ends.
    pub period: [f64; 2],
    /// Mass in kg that is there for the first window, as far as it finds room.
    pub batch: f64,
    /// Their diameters.
    pub sizes: Sizes,
    /// Their density in kg/m³.
    pub density: f64,
    /// Number of real particles that each stands for.
    pub weight: f64,
    /// Their velocity in m/s of process time; AF times as much on the motion clock.
    pub velocity: Vec3,
    /// Their temperature in K.
    pub temperature: f64,
    /// Equal seeds give equal particles.
    pub seed: u64,
}

/// Particles that go out.
#[derive(Clone, Debug)]
pub struct Outlet {
    /// Its name.
    pub name: String,
    /// They go when their centres are here before a window, and where they left the mesh within one through here.
    pub zone: Zone,
    /// Mass flow in kg/s of process time at most, the lowest first; `None`: all.
    pub rate: Option<f64>,
}

/// All feeds and outlets of a run, and how far they are.
#[derive(Clone, Debug, Default)]
pub struct FeedsAndOutlets {
    /// What comes.
    pub feeds: Vec<Feed>,
    /// What goes.
    pub outlets: Vec<Outlet>,
    /// What left through the outlets so far.
    pub outflows: Outflows,
    /// Upwards, by which "lowest" is meant.
    pub up: Vec3,
    /// Directions in which the domain repeats itself.
    periodicity: Periodicity,
    /// Id of the next particle that comes.
    next_id: u64,
    /// Mass in kg that each feed owes, and that each outlet may still take.
    due: [Vec<f64>; 2],
    /// Particles that each feed has drawn.
    drawn: Vec<u64>,
}

/// What is to be done before a window.
#[derive(Clone, Debug, Default)]
pub struct PopulationChange {
    /// The change of the particles.
    pub change: ParticleChanges,
    /// Temperature in K of each that comes.
    pub temperature: Vec<f64>,
    /// Rows of those that go, in the order of the particles.
    pub rows: Vec<usize>,
    /// The outlet through which each of them goes.
    pub outlets: Vec<usize>,
}

/// A window's place in time.
#[derive(Clone, Copy, Debug)]
pub struct WindowSpan {
    /// Windows before this one.
    pub window: u64,
    /// Process time in s at which it begins.
    pub start: f64,
    /// Its process span in s.
    pub span: f64,
    /// Its acceleration factor.
    pub acceleration: f64,
}

impl WindowSpan {
    /// How much of it in s lies between two process times in s.
    fn within(&self, [begin, end]: [f64; 2]) -> f64 {
        if begin <= self.start && self.start + self.span <= end {
            return self.span;
        }
        let end = end.min(self.start + self.span);
        (end - begin.max(self.start)).max(0.0)
    }
}

impl Feed {
    /// Radius in m of a particle, by how many come before it, and the mass in kg of all that it stands for.
    fn particle(&self, number: u64) -> Result<(f64, f64), PackingError> {
        let diameters = self.sizes.sample(1, mixed(self.seed, number, 0))?;
        let radius = 0.5 * diameters.first().copied().unwrap_or(0.0);
        Ok((radius, self.weight * sphere::mass(radius, self.density)))
    }
}

impl FeedsAndOutlets {
    /// Feeds and outlets of a run whose first particles have ids below `next_id`.
    pub fn new(feeds: Vec<Feed>, outlets: Vec<Outlet>, up: Vec3, next_id: u64) -> Self {
        let owed = feeds.iter().map(|feed| feed.batch).collect();
        Self {
            due: [owed, vec![0.0; outlets.len()]],
            drawn: vec![0; feeds.len()],
            outflows: Outflows::new(outlets.len()),
            feeds,
            outlets,
            up,
            periodicity: Periodicity::default(),
            next_id,
        }
    }

    /// The same in a domain that repeats itself: new particles keep away from images too, and no particle is lower than
    /// another along a periodic direction.
    #[must_use]
    pub fn in_periods(mut self, periodicity: &Periodicity) -> Self {
        self.periodicity = *periodicity;
        for (axis, span) in periodicity.axes.iter().enumerate() {
            if span.is_some() {
                self.up[axis] = 0.0;
            }
        }
        self
    }

    /// True where nothing ever comes or goes.
    pub fn is_none(&self) -> bool {
        self.feeds.is_empty() && self.outlets.is_empty()
    }

    /// Mass in kg that is due and found no room, of feeds where more than one particle waits.
    pub fn waiting(&self) -> f64 {
        let owed = |index: usize, feed: &Feed| {
            let owed = self.due[0][index];
            let next = feed.particle(self.drawn[index]);
            // The next one is due with half of its mass, the one after it with one and a half.
            let several = next.is_ok_and(|(_, mass)| mass > 0.0 && owed >= 1.5 * mass);
            if several { owed } else { 0.0 }
        };
        let feeds = self.feeds.iter().enumerate();
        feeds.map(|(index, feed)| owed(index, feed)).sum()
    }

    /// True where an outlet takes what leaves the mesh through its zone: it does so unless it has a rate of its own.
    pub fn lets_out(&self) -> bool {
        self.outlets.iter().any(|outlet| outlet.rate.is_none())
    }

    /// The first such outlet that the straight line between two places in m meets.
    pub fn outlet_between(&self, ends: [Vec3; 2]) -> Option<usize> {
        let meets = |outlet: &Outlet| outlet.rate.is_none() && outlet.zone.meets(ends);
        self.outlets.iter().position(meets)
    }

    /// Decides what goes and comes before a window.
    pub fn decide(
        &mut self,
        moment: WindowSpan,
        particles: &ParticleFields<'_>,
    ) -> Result<PopulationChange, PackingError> {
        let mut due = PopulationChange::default();
        self.take_out(moment, particles, &mut due);
        self.bring_in(moment, particles, &mut due)?;
        Ok(due)
    }

    fn take_out(
        &mut self,
        moment: WindowSpan,
        particles: &ParticleFields<'_>,
        due: &mut PopulationChange,
    ) {
        let mut gone: Vec<Option<usize>> = vec![None; particles.len()];
        for (place, (outlet, due)) in self.outlets.iter().zip(&mut self.due[1]).enumerate() {
            let inside =
                |&row: &usize| gone[row].is_none() && outlet.zone.holds(particles.position[row]);
            let mut rows: Vec<usize> = (0..particles.len()).filter(inside).collect();
            let Some(rate) = outlet.rate else {
                rows.iter().for_each(|&row| gone[row] = Some(place));
                continue;
            };
            let height = |row: usize| particles.position[row].dot(&self.up);
            rows.sort_by(|&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
            *due += rate * moment.span;
            let mut enough = false;
            for row in rows {
                // The next particle goes as soon as half of it is due: what has gone is nearest to
                // what was asked for.
                let mass = particles.row_mass(row);
                if *due < 0.5 * mass {
                    enough = true;
                    break;
                }
                *due -= mass;
                gone[row] = Some(place);
            }
            // What was not there to be taken is not asked for later.
            if !enough {
                *due = due.min(0.0);
            }
        }
        let all = gone.iter().enumerate();
        let found = all.filter_map(|(row, outlet)| Some((row, (*outlet)?)));
        (due.rows, due.outlets) = found.unzip();
        due.change.remove = due.rows.iter().map(|&row| particles.id[row]).collect();
    }

    fn bring_in(
        &mut self,
        moment: WindowSpan,
        particles: &ParticleFields<'_>,
        due: &mut PopulationChange,
    ) -> Result<(), PackingError> {
        let mut gone = vec![false; particles.len()];
        due.rows.iter().for_each(|&row| gone[row] = true);
        for (index, feed) in self.feeds.iter().enumerate() {
            self.due[0][index] += feed.rate * moment.within(feed.period);
            let mut beside: Option<Neighbourhood> = None;
            loop {
                let number = self.drawn[index];
                let (radius, mass) = feed.particle(number)?;
                if !(mass > 0.0 && self.due[0][index] >= 0.5 * mass) {
                    break;
                }
                let mut random = SplitMix64(mixed(feed.seed, number, moment.window + 1));
                let mut others = beside
                    .take_if(|known| known.reaches(radius))
                    .unwrap_or_else(|| {
                        let old = (0..particles.len()).filter(|&row| !gone[row]);
                        let old = old.map(|row| (particles.position[row], particles.radius[row]));
                        let new = due.change.insert.iter();
                        let all = old.chain(new.map(|new| (new.position, new.radius)));
                        let bounds = feed.zone.bounds();
                        Neighbourhood::new(&self.periodicity, bounds, radius, all)
                    });
                let place = (0..TRIES)
                    .map(|_| within(&feed.zone, radius, &mut random))
                    .find(|place| others.has_room(*place, radius));
                let Some(place) = place else { break };
                let position = self.periodicity.wrap(place);
                others.put(position, radius);
                beside = Some(others);
                due.change.insert.push(NewParticle {
                    id: self.next_id,
                    population: feed.population,
                    position,
                    velocity: moment.acceleration * feed.velocity,
                    radius,
                    density: feed.density,
                    weight: feed.weight,
                });
                due.temperature.push(feed.temperature);
                self.next_id += 1;
                self.drawn[index] += 1;
                self.due[0][index] -= mass;
            }
        }
        Ok(())
    }

    /// Writes how far feeds and outlets are.
    pub fn record(&self, state: &mut StateFile) {
        state.set_u64s("traffic_next_id", &[self.next_id]);
        state.set_u64s("traffic_drawn", &self.drawn);
        state.set_f64s("traffic_feeds", &self.due[0]);
        state.set_f64s("traffic_outlets", &self.due[1]);
    }

    /// Goes on from what feeds and outlets of another run came to: where there are as many of both, with the particles that
    /// they drew and the masses that they owe; else with nothing owed. No batch comes again, and ids go on.
    pub fn go_on(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        let alike = state.f64s("traffic_feeds")?.len() == self.feeds.len()
            && state.f64s("traffic_outlets")?.len() == self.outlets.len();
        if alike {
            return self.restore(state);
        }
        self.due[0].fill(0.0);
        if let [next] = *state.u64s("traffic_next_id")? {
            self.next_id = self.next_id.max(next);
        }
        Ok(())
    }

    /// Takes it up again.
    pub fn restore(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        self.due = [
            state.f64s_of("traffic_feeds", self.feeds.len())?.to_vec(),
            state
                .f64s_of("traffic_outlets", self.outlets.len())?
                .to_vec(),
        ];
        let drawn = state.u64s("traffic_drawn")?;
        if drawn.len() != self.feeds.len() {
            return Err(StateFileError::Length {
                name: "traffic_drawn".into(),
                found: drawn.len(),
                expected: self.feeds.len(),
            });
        }
        self.drawn = drawn.to_vec();
        if let [next] = *state.u64s("traffic_next_id")? {
            self.next_id = next;
        }
        Ok(())
    }
}

/// A seed of its own for each particle and window.
fn mixed(seed: u64, number: u64, window: u64) -> u64 {
    seed ^ number.wrapping_mul(0xd605_1ba1_9ee3_4e1d) ^ window.wrapping_mul(0xa076_1d64_78bd_642f)
}

/// Centres in m of spheres of a radius in m as a feed would place them in its zone, whatever else is there.
pub fn places(zone: Zone, radius: f64, seed: u64) -> impl Iterator<Item = Vec3> {
    let mut random = SplitMix64(seed);
    iter::repeat_with(move || within(&zone, radius, &mut random))
}

/// A centre in a zone (m) such that a sphere about it lies within, evenly distributed; where the sphere
/// is larger than the zone, its middle along that direction.
fn within(zone: &Zone, radius: f64, random: &mut SplitMix64) -> Vec3 {
    let mut between = |low: f64, high: f64| {
        let share = random.unit();
        match low + radius < high - radius {
            true => low + radius + share * (high - low - 2.0 * radius),
            false => 0.5 * (low + high),
        }
    };
    match *zone {
        Zone::Box { low, high } => Vec3::new(
            between(low.x, high.x),
            between(low.y, high.y),
            between(low.z, high.z),
        ),
        Zone::Cylinder {
            from,
            to,
            radius: wide,
        } => {
            let length = (to - from).norm();
            let axis = (to - from) / length;
            let along = between(0.0, length);
            let off = (wide - radius).max(0.0) * random.unit().sqrt();
            let angle = 2.0 * PI * random.unit();
            let other = match axis.x.abs() < 0.5 {
                true => Vec3::x(),
                false => Vec3::y(),
            };
            let across = axis.cross(&other).normalize();
            let third = axis.cross(&across);
            from + along * axis + off * (angle.cos() * across + angle.sin() * third)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bed {
        id: Vec<u64>,
        position: Vec<Vec3>,
        zero: Vec<Vec3>,
        radius: Vec<f64>,
        mass: Vec<f64>,
    }

    impl Bed {
        fn stack(count: usize) -> Self {
            Self {
                id: (1..=count as u64).collect(),
                position: (0..count)
                    .map(|k| Vec3::new(0.05, 0.05, 0.01 * k as f64 + 0.005))
                    .collect(),
                zero: vec![Vec3::zeros(); count],
                radius: vec![0.005; count],
                mass: vec![1e-3; count],
            }
        }

        fn fields(&self) -> ParticleFields<'_> {
            ParticleFields {
                id: &self.id,
                population: &[],
                position: &self.position,
                velocity: &self.zero,
                angular_velocity: &self.zero,
                radius: &self.radius,
                mass: &self.mass,
                weight: &[],
            }
        }
    }

    fn feed(rate: f64, batch: f64) -> Feed {
        Feed {
            name: "top".into(),
            population: 0,
            zone: Zone::Box {
                low: Vec3::zeros(),
                high: Vec3::new(0.1, 0.1, 0.1),
            },
            rate,
            period: [0.0, f64::INFINITY],
            batch,
            sizes: Sizes::Equal(0.01),
            density: 2000.0,
            weight: 1.0,
            velocity: Vec3::new(0.0, 0.0, -0.1),
            temperature: 500.0,
            seed: 7,
        }
    }

    fn moment(window: u64) -> WindowSpan {
        WindowSpan {
            window,
            start: 0.01 * window as f64,
            span: 0.01,
            acceleration: 5.0,
        }
    }

    #[test]
    fn a_feed_keeps_its_mass_flow_and_its_particles_touch_nothing() {
        let bed = Bed::stack(3);
        let mass = 4.0 / 3.0 * PI * 0.005f64.powi(3) * 2000.0;
        let mut feeds_and_outlets =
            FeedsAndOutlets::new(vec![feed(40.0 * mass, 0.0)], Vec::new(), Vec3::z(), 4);
        let mut ids = Vec::new();
        for window in 0..100 {
            let due = feeds_and_outlets
                .decide(moment(window), &bed.fields())
                .unwrap();
            for new in &due.change.insert {
                ids.push(new.id);
                assert!(
                    (new.velocity.z + 0.5).abs() < 1e-15,
                    "AF times faster on the motion clock"
                );
                assert!(
                    bed.position
                        .iter()
                        .all(|p| (p - new.position).norm() >= 0.01)
                );
            }
        }
        // 40 particles a second for a second.
        assert_eq!(ids, (4..44).collect::<Vec<u64>>());
    }

    #[test]
    fn a_batch_comes_before_the_first_window_and_a_resumed_feed_goes_on_alike() {
        let bed = Bed::stack(0);
        let mass = 4.0 / 3.0 * PI * 0.005f64.powi(3) * 2000.0;
        let make = || {
            FeedsAndOutlets::new(
                vec![feed(300.0 * mass, 20.0 * mass)],
                Vec::new(),
                Vec3::z(),
                1,
            )
        };
        let mut feeds_and_outlets = make();
        let first = feeds_and_outlets.decide(moment(0), &bed.fields()).unwrap();
        assert_eq!(first.change.insert.len(), 23);
        let mut state = StateFile::new();
        feeds_and_outlets.record(&mut state);
        let mut other = make();
        other.restore(&state).unwrap();
        let [a, b] = [&mut feeds_and_outlets, &mut other]
            .map(|feeds_and_outlets| feeds_and_outlets.decide(moment(1), &bed.fields()).unwrap());
        assert_eq!(a.change, b.change);
        assert_eq!(a.change.insert.len(), 3);
    }

    #[test]
    fn an_outlet_takes_the_lowest_at_its_rate_or_all_that_is_there() {
        let bed = Bed::stack(10);
        let zone = Zone::Box {
            low: Vec3::zeros(),
            high: Vec3::new(0.1, 0.1, 0.05),
        };
        let outlet = |rate| Outlet {
            name: "bottom".into(),
            zone,
            rate,
        };
        let mut all = FeedsAndOutlets::new(Vec::new(), vec![outlet(None)], Vec3::z(), 11);
        let due = all.decide(moment(0), &bed.fields()).unwrap();
        assert_eq!(due.change.remove, [1, 2, 3, 4, 5]);
        // 0.2 kg/s over 10 ms are two particles of 1 g.
        let mut slow = FeedsAndOutlets::new(Vec::new(), vec![outlet(Some(0.2))], Vec3::z(), 11);
        for window in 0..3 {
            let due = slow.decide(moment(window), &bed.fields()).unwrap();
            assert_eq!(due.change.remove, [1, 2]);
        }
    }

    #[test]
    fn spheres_are_placed_wholly_within_a_cylinder() {
        let zone = Zone::Cylinder {
            from: Vec3::new(0.0, 0.0, 0.1),
            to: Vec3::new(0.0, 0.0, 0.2),
            radius: 0.03,
        };
        let mut random = SplitMix64(3);
        for _ in 0..1000 {
            let place = within(&zone, 0.01, &mut random);
            assert!(place.xy().norm() <= 0.02 + 1e-12);
            assert!((0.11..=0.19).contains(&place.z));
        }
    }
}
