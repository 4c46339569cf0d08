//! The script and the data file of a bed, as LIGGGHTS reads them.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::motion::{LostParticles, Motion};
use calcine_coupler::periodic_motion;
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;

use super::moving::WallForm;
use super::template::{DATA, ScriptTemplate, ScriptVariables};
use super::{facets, moving};

/// Name of the script.
pub const SCRIPT: &str = "in.liggghts";
/// The script of a bed that is held; it reads [`DATA`].
const FROZEN_BED: &str = include_str!("../../../liggghts-inputs/frozen-bed.in");
/// The script of a bed that moves.
const MOVING_BED: &str = include_str!("../../../liggghts-inputs/moving-bed.in");
const WHO: &str = "LIGGGHTS (particles)";

/// Name of the file of statistical weights, and the command that has LIGGGHTS keep them with its particles; the host
/// fills them in.
const WEIGHTS: (&str, &str) = (
    "particles.weight",
    "fix calcine_weight all property/atom calcine_weight scalar yes no no 1.\n",
);

/// What has LIGGGHTS keep eleven numbers for the drag of each particle.
const DRAG: &str = "\
fix calcine_drag all property/atom calcine_drag vector no no no 0. 0. 0. 0. 0. 0. 0. 0. 0. 0. 0.
";
/// Where LIGGGHTS calls the host at each step, which adds to the forces: behind all others.
const EACH_STEP: &str = "fix calcine_each_step all external pf/array 1\n";

/// What the inputs are made from.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// The particles.
    pub setup: &'a ParticleSetup,
    /// Lower and upper corner of the domain in m; the box is widened where particles reach out.
    pub bounds: (Vec3, Vec3),
    /// Time step of LIGGGHTS in s of motion time.
    pub step: f64,
    /// Number of ranks, side by side along the longer horizontal side.
    pub ranks: u32,
    /// Whether the impulse of walls is counted, step by step.
    pub wall_impulse: bool,
    /// Whether drag may be pushed by coefficient and gas velocity.
    pub moving_drag: bool,
    /// The user's own script in place of the generated one; of a bed that moves only.
    pub template: Option<&'a ScriptTemplate>,
}

impl Inputs<'_> {
    /// Writes `in.liggghts` and `particles.data` into a folder; gives their paths.
    pub fn write(&self, folder: &Path) -> Result<[PathBuf; 2], PartError> {
        self.check()?;
        let files = [
            (folder.join(SCRIPT), self.script()?),
            (folder.join(DATA), self.data()),
        ];
        let meshes = match &self.setup.motion {
            Motion::Free(contacts) => moving::meshes(contacts, self.smallest()),
            Motion::Frozen | Motion::Parcels(_) => Vec::new(),
        };
        fs::create_dir_all(folder).map_err(|error| unwritable(folder, error))?;
        let mut more = meshes;
        if !self.setup.weight.is_empty() {
            more.push((WEIGHTS.0.to_owned(), self.weights()));
        }
        let more = more.into_iter();
        let more = more.map(|(name, text)| (folder.join(name), text));
        for (path, text) in files.iter().cloned().chain(more) {
            fs::write(&path, text).map_err(|error| unwritable(&path, error))?;
        }
        Ok(files.map(|(path, _)| path))
    }

    /// Refuses what LIGGGHTS cannot do.
    pub fn check(&self) -> Result<(), PartError> {
        let refuse = |message: String| Err(PartError::new(WHO, FailureKind::NotStarted, message));
        let setup = self.setup;
        if matches!(setup.motion, Motion::Parcels(_)) {
            return refuse(
                "the particles are parcels, and LIGGGHTS moves particles that touch each other; move parcels natively \
                 (`--particles native`) or by OpenFOAM (`--particles openfoam`)"
                    .into(),
            );
        }
        if let Motion::Free(contacts) = &setup.motion {
            if let Some(reason) = moving::refusal(contacts) {
                return refuse(reason);
            }
            let largest = setup.radius.iter().copied().fold(0.0, f64::max);
            if let Err(error) = periodic_motion::check(contacts, largest) {
                return refuse(format!("{error}; {}", error.remedy()));
            }
        }
        if setup.id.is_empty() {
            return refuse("there are no particles".into());
        }
        // LIGGGHTS' tags are 32-bit integers.
        if let Some(id) = setup.id.iter().find(|&&id| id == 0 || id > i32::MAX as u64) {
            return refuse(format!(
                "particle id {id} is not between 1 and {}",
                i32::MAX
            ));
        }
        for (row, id) in setup.id.iter().enumerate() {
            let held = match &setup.motion {
                Motion::Frozen => true,
                Motion::Parcels(_) => false,
                Motion::Free(contacts) => {
                    contacts.held.get(setup.population[row] as usize) == Some(&true)
                }
            };
            let weight = setup.weight_of(row);
            if !held && weight != 1.0 {
                return refuse(format!(
                    "particle {id} moves and touches others, but stands for {weight} particles; write weight = 1 for \
                     its population, or motion = \"frozen\""
                ));
            }
        }
        if !(self.step.is_finite() && self.step > 0.0) {
            return refuse(format!("a time step of {} s is not positive", self.step));
        }
        Ok(())
    }

    /// Ids and statistical weights.
    fn weights(&self) -> String {
        let pairs = self.setup.id.iter().zip(&self.setup.weight);
        pairs
            .map(|(id, weight)| format!("{id} {weight:e}\n"))
            .collect()
    }

    /// The script; an error where a script of the user's own does not go with the case.
    pub fn script(&self) -> Result<String, PartError> {
        let mut script = self.bare_script()?;
        if !self.setup.weight.is_empty() {
            script.push('\n');
            script.push_str(WEIGHTS.1);
        }
        if self.moving_drag {
            script.push('\n');
            script.push_str(DRAG);
        }
        if self.moving_drag || matches!(self.setup.motion, Motion::Free(_)) {
            script.push('\n');
            script.push_str(EACH_STEP);
        }
        Ok(script)
    }

    /// The script without what comes last.
    fn bare_script(&self) -> Result<String, PartError> {
        let (lower, upper) = self.corners();
        let along_x = upper.x - lower.x >= upper.y - lower.y;
        let grid = if along_x {
            format!("{} 1 1", self.ranks)
        } else {
            format!("1 {} 1", self.ranks)
        };
        let moves = !self.setup.motion.is_frozen();
        let share = if moves { 0.4 } else { 0.1 };
        let skin = share * self.setup.radius.iter().copied().fold(0.0, f64::max);
        // Bins as large as particles would be without number in a large box with few of them.
        let volume = (upper - lower).product();
        let room = (volume / (4.0 * self.setup.id.len() as f64)).cbrt();
        let bins = room.max(self.setup.radius.iter().copied().fold(0.0, f64::max) + 0.5 * skin);
        if let (Some(own), Motion::Free(contacts)) = (self.template, &self.setup.motion) {
            let values = ScriptVariables {
                step: self.step,
                processors: grid,
                skin,
                bins,
                corners: (lower, upper),
                walls: self.form(),
            };
            return own.script(contacts, &values).map_err(|error| {
                let message = "the script of `liggghts.template` does not go with the case";
                PartError::new(WHO, FailureKind::NotStarted, message).caused_by(error)
            });
        }
        let (template, contacts) = match &self.setup.motion {
            Motion::Frozen | Motion::Parcels(_) => (FROZEN_BED, String::new()),
            Motion::Free(contacts) => (MOVING_BED, moving::commands(contacts, self.form())),
        };
        let script = template
            .replace("{bins}", &format!("{bins:e}"))
            .replace(
                "{boundary}",
                &moving::boundary(&self.periodicity(), self.lost()),
            )
            .replace("{contacts}", &contacts)
            .replace("{processors}", &grid)
            .replace("{skin}", &format!("{skin:e}"))
            .replace("{step}", &format!("{:e}", self.step));
        Ok(script)
    }

    fn data(&self) -> String {
        let setup = self.setup;
        let (lower, upper) = self.corners();
        let types = match &setup.motion {
            Motion::Frozen | Motion::Parcels(_) => {
                setup.population.iter().max().map_or(1, |last| last + 1) as usize
            }
            Motion::Free(contacts) => moving::types(contacts),
        };
        let mut text = format!(
            "Written by Calcine: id, type (population + 1), diameter, density, centre; SI\n\n\
             {} atoms\n{types} atom types\n",
            setup.id.len()
        );
        // Writing to a string cannot fail; `e` prints the shortest digits that read back exactly.
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let (low, high) = (lower[axis], upper[axis]);
            let _ = writeln!(text, "{low:e} {high:e} {name}lo {name}hi");
        }
        text.push_str("\nAtoms\n\n");
        let periodicity = self.periodicity();
        for (p, id) in setup.id.iter().enumerate() {
            let centre = periodicity.wrap(setup.position[p]);
            let _ = writeln!(
                text,
                "{id} {} {:e} {:e} {:e} {:e} {:e}",
                setup.population[p] + 1,
                2.0 * setup.radius[p],
                setup.density[p],
                centre.x,
                centre.y,
                centre.z
            );
        }
        if setup.velocity.is_empty() && setup.angular_velocity.is_empty() {
            return text;
        }
        text.push_str("\nVelocities\n\n");
        for (row, id) in setup.id.iter().enumerate() {
            let of = |list: &[Vec3]| list.get(row).copied().unwrap_or_default();
            let [x, y, z] = of(&setup.velocity).into();
            let spin: [f64; 3] = of(&setup.angular_velocity).into();
            let [p, q, r] = spin.map(|one| match one == 0.0 {
                true => "0".to_owned(),
                false => format!("{one:e}"),
            });
            let _ = writeln!(text, "{id} {x:e} {y:e} {z:e} {p} {q} {r}");
        }
        text
    }

    /// How walls are told.
    fn form(&self) -> WallForm {
        WallForm {
            smallest: self.smallest(),
            counted: self.wall_impulse,
        }
    }

    /// Radius of the smallest sphere in m.
    fn smallest(&self) -> f64 {
        let radii = self.setup.radius.iter().copied();
        radii.fold(f64::INFINITY, f64::min)
    }

    /// What becomes of particles that leave.
    fn lost(&self) -> LostParticles {
        match &self.setup.motion {
            Motion::Free(contacts) => contacts.lost,
            Motion::Frozen | Motion::Parcels(_) => LostParticles::End,
        }
    }

    /// Directions in which the domain of moving particles repeats itself.
    fn periodicity(&self) -> Periodicity {
        match &self.setup.motion {
            Motion::Free(contacts) => contacts.periodicity,
            Motion::Frozen | Motion::Parcels(_) => Periodicity::default(),
        }
    }

    /// Corners of a box around domain and spheres, with a margin that keeps particles off its faces; along periodic
    /// directions it reaches from plane to plane.
    fn corners(&self) -> (Vec3, Vec3) {
        let (mut lower, mut upper) = self.bounds;
        for (centre, &radius) in self.setup.position.iter().zip(&self.setup.radius) {
            lower = lower.inf(&centre.add_scalar(-radius));
            upper = upper.sup(&centre.add_scalar(radius));
        }
        if let Motion::Free(contacts) = &self.setup.motion {
            let walls = contacts.walls.iter();
            let meshes = walls.filter(|wall| !facets::is_primitive(wall));
            let smallest = self.smallest();
            for corner in meshes.flat_map(|wall| facets::of(wall, contacts, smallest)) {
                for at in corner {
                    (lower, upper) = (lower.inf(&at), upper.sup(&at));
                }
            }
        }
        let margin = 0.01 * (upper - lower);
        (lower, upper) = (lower - margin, upper + margin);
        for (axis, span) in self.periodicity().axes.iter().enumerate() {
            if let Some(span) = span {
                (lower[axis], upper[axis]) = (span.low, span.high);
            }
        }
        (lower, upper)
    }
}

fn unwritable(path: &Path, error: std::io::Error) -> PartError {
    let message = format!("{} cannot be written", path.display());
    PartError::new(WHO, FailureKind::Io, message).caused_by(error)
}

#[cfg(test)]
mod tests {
    use calcine_coupler::conformance::particles::soft_spheres;
    use calcine_coupler::motion::{Contacts, Wall, WallMotion, WallShape};

    use super::*;

    fn setup() -> ParticleSetup {
        ParticleSetup {
            id: vec![1, 7],
            population: vec![0, 1],
            position: vec![
                Vec3::new(0.005, 0.005, 0.1),
                Vec3::new(0.005, 0.005, 1.0 / 3.0),
            ],
            radius: vec![0.005, 0.005],
            density: vec![2500.0, 2600.0],
            ..ParticleSetup::default()
        }
    }

    fn inputs(setup: &ParticleSetup) -> Inputs<'_> {
        Inputs {
            setup,
            bounds: (Vec3::zeros(), Vec3::new(0.01, 0.01, 0.3)),
            step: 1e-4,
            ranks: 1,
            wall_impulse: false,
            moving_drag: false,
            template: None,
        }
    }

    #[test]
    fn the_data_file_reads_back_to_the_same_bits() {
        let setup = setup();
        let text = inputs(&setup).data();
        let last: Vec<&str> = text.lines().last().unwrap().split(' ').collect();
        assert_eq!(last[..2], ["7", "2"]);
        assert_eq!(last[2].parse::<f64>().unwrap(), 0.01);
        assert_eq!(last[6].parse::<f64>().unwrap(), 1.0 / 3.0);
    }

    #[test]
    fn the_script_has_no_gap_left_and_reads_the_data_file() {
        let setup = setup();
        let script = inputs(&setup).script().unwrap();
        let commands: Vec<&str> = script
            .lines()
            .filter(|line| !line.starts_with('#'))
            .collect();
        assert!(commands.iter().all(|line| !line.contains('{')), "{script}");
        assert!(commands.contains(&"timestep 1e-4"));
        // The duct is 10 mm wide both ways and taller, but ranks never lie above each other.
        assert!(commands.contains(&"processors 1 1 1"));
        assert!(commands.contains(&format!("read_data {DATA}").as_str()));
    }

    #[test]
    fn the_box_holds_domain_and_spheres() {
        let setup = setup();
        let (lower, upper) = inputs(&setup).corners();
        assert!(lower.x < 0.0 && lower.z < 0.0 && upper.y > 0.01);
        assert!(upper.z > 1.0 / 3.0 + 0.005);
    }

    #[test]
    fn what_liggghts_cannot_hold_is_refused_with_the_number() {
        let mut far = setup();
        far.id[1] = 1 << 40;
        let error = inputs(&far).check().unwrap_err().to_string();
        assert!(error.contains("1099511627776"), "{error}");
        let fine = setup();
        let still = Inputs {
            step: 0.0,
            ..inputs(&fine)
        };
        assert!(still.check().unwrap_err().to_string().contains("0 s"));
    }

    /// What LIGGGHTS does not have is refused before a process is started, not left out.
    #[test]
    fn walls_that_it_does_not_move_are_refused_with_the_remedy() {
        let wall = |motion| Wall {
            name: "lid".into(),
            material: 0,
            shape: WallShape::Plane {
                point: Vec3::zeros(),
                normal: Vec3::z(),
            },
            motion,
        };
        let direction = Vec3::z();
        let scheduled = WallMotion::Scheduled {
            direction,
            distance: vec![(0.0, 0.0), (1.0, 0.1)],
        };
        let oscillating = WallMotion::Oscillating {
            amplitude: direction,
            period: 0.1,
        };
        let servo = WallMotion::Servo {
            direction,
            force: 1.0,
            mass: 1.0,
            damping: 0.0,
        };
        for (walls, words) in [
            (
                vec![wall(scheduled)],
                ["`moved` of the wall \"lid\"", "native particles"],
            ),
            (
                vec![wall(oscillating)],
                ["`oscillating` of the wall \"lid\"", "native particles"],
            ),
            (
                vec![wall(servo)],
                ["`servo` of the wall \"lid\"", "native particles"],
            ),
        ] {
            let contacts = Contacts {
                walls,
                material_of: vec![0, 0],
                held: vec![false, false],
                ..soft_spheres(1e-5, 1e7)
            };
            let moving = ParticleSetup {
                motion: Motion::Free(Box::new(contacts)),
                ..setup()
            };
            let error = inputs(&moving).check().unwrap_err().to_string();
            for word in words {
                assert!(error.contains(word), "{error}");
            }
        }
    }
}
