//! A LIGGGHTS script of the user's own in place of the generated one: checked line by line, completed with
//! the case's values as LIGGGHTS variables and with what Calcine needs to drive it.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use calcine_coupler::motion::{Contacts, LostParticles};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::Vec3;
use thiserror::Error;

use super::moving;

/// Name of the data file.
pub const DATA: &str = "particles.data";
/// The variable of the sides of the box.
const VARIABLE: &str = "${calcine_boundary}";
/// Name of the script's variables of Calcine begin with this.
const PREFIX: &str = "calcine_";
/// Numbers of a script and of its case may differ by this share, as texts of few digits do.
const SAME: f64 = 1e-9;

/// What Calcine does itself, by the first words of commands that would do it too, and the remedy.
const REFUSED: [(&[&str], &str, &str); 6] = [
    (
        &["run", "minimize", "rerun", "reset_timestep"],
        "Calcine advances the particles and keeps the time",
        "leave the line out: the script ends with the setup",
    ),
    (
        &["clear", "jump", "label", "next", "quit"],
        "the script is run line by line, and once more at every checkpoint",
        "write each command once, without loops",
    ),
    (
        &[
            "create_box",
            "create_atoms",
            "delete_atoms",
            "displace_atoms",
            "read_restart",
            "set",
            "velocity",
        ],
        "the case file says which particles there are and where they start",
        "place them by `particles.place`, and read them by `read_data ${calcine_data}`",
    ),
    (
        &["run_style"],
        "the host adds the force of the gas at each step of the integrator `verlet`, which is LIGGGHTS' own",
        "leave the line out",
    ),
    (
        &["if", "partition"],
        "commands within others cannot be looked at",
        "write the commands that hold, each in a line of its own",
    ),
    (
        &["include"],
        "of included files only calcine.contacts, calcine.gravity, calcine.walls and calcine.motion are known",
        "write the lines of other files into the script",
    ),
];

/// How styles of fixes begin that integrate the motion of particles.
const INTEGRATES: [&str; 3] = ["nve", "rigid", "multisphere"];

/// A script that cannot be used, with the line and the remedy.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ScriptTemplateError {
    /// The file.
    #[error("{} cannot be read: {cause}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        cause: String,
    },
    /// A line that does not go with the case.
    #[error("line {line}, `{text}`: {rule}; {remedy}")]
    Line {
        /// Its number.
        line: usize,
        /// As it stands there.
        text: String,
        /// What is wrong with it.
        rule: String,
        /// What to write.
        remedy: String,
    },
    /// Something that every script needs.
    #[error("there is no `{what}`; write `{remedy}`")]
    Missing {
        /// The command.
        what: &'static str,
        /// What to write.
        remedy: &'static str,
    },
    /// Several of these, in the order of their lines.
    #[error("{}", told(.0))]
    Several(Vec<Self>),
}

/// Findings one after the other.
fn told(findings: &[ScriptTemplateError]) -> String {
    let each: Vec<String> = findings.iter().map(ToString::to_string).collect();
    each.join("\n")
}

impl ScriptTemplateError {
    /// What is wrong, and the remedy.
    pub fn parts(&self) -> (String, String) {
        match self {
            Self::File { .. } => (self.to_string(), "name a file that can be read".into()),
            Self::Line {
                line,
                text,
                rule,
                remedy,
            } => (format!("line {line}, `{text}`: {rule}"), remedy.clone()),
            Self::Missing { what, remedy } => {
                (format!("there is no `{what}`"), format!("write `{remedy}`"))
            }
            Self::Several(_) => (self.to_string(), "change these lines".into()),
        }
    }

    /// Line of the script; of what is missing, behind all.
    fn line(&self) -> usize {
        match self {
            Self::Line { line, .. } => *line,
            _ => usize::MAX,
        }
    }

    /// One error for each thing that is wrong.
    pub fn findings(&self) -> &[Self] {
        match self {
            Self::Several(findings) => findings,
            one => std::slice::from_ref(one),
        }
    }

    /// Nothing, the only finding, or all of them.
    fn of(mut findings: Vec<Self>) -> Result<(), Self> {
        match findings.len() {
            0 | 1 => findings.pop().map_or(Ok(()), Err),
            _ => Err(Self::Several(findings)),
        }
    }
}

/// A script of the user's own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptTemplate {
    path: PathBuf,
    commands: Vec<Command>,
    populations: Vec<String>,
    materials: Vec<String>,
}

/// One command, its continued lines joined.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Command {
    line: usize,
    text: String,
}

impl Command {
    fn words(&self) -> Vec<&str> {
        self.text.split_ascii_whitespace().collect()
    }

    fn refuse(&self, rule: impl Into<String>, remedy: impl Into<String>) -> ScriptTemplateError {
        ScriptTemplateError::Line {
            line: self.line,
            text: self.text.trim().to_owned(),
            rule: rule.into(),
            remedy: remedy.into(),
        }
    }
}

/// What the case says beside its contacts, as the script's variables have it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScriptVariables {
    /// Time step in s.
    pub step: f64,
    /// Grid of ranks, three numbers.
    pub processors: String,
    /// Skin of the neighbour list in m.
    pub skin: f64,
    /// Size of its bins in m.
    pub bins: f64,
    /// Corners of the box in m.
    pub corners: (Vec3, Vec3),
    /// How walls are told.
    pub walls: moving::WallForm,
}

impl ScriptTemplate {
    /// Reads a script and checks what can be checked without the case's numbers. Populations and materials
    /// by name, in the order of their atom types.
    pub fn read(
        path: &Path,
        populations: Vec<String>,
        materials: Vec<String>,
    ) -> Result<Self, ScriptTemplateError> {
        let text = fs::read_to_string(path).map_err(|cause| ScriptTemplateError::File {
            path: path.to_owned(),
            cause: cause.to_string(),
        })?;
        let mut commands = commands(&text);
        let mut findings = check(&commands);
        let folder = path.parent().unwrap_or(Path::new("."));
        findings.extend(beside(folder, &mut commands));
        findings.sort_by_key(ScriptTemplateError::line);
        ScriptTemplateError::of(findings)?;
        Ok(Self {
            path: path.to_owned(),
            commands,
            populations,
            materials,
        })
    }

    /// The script as the host runs it; time step and gravity must be those of the case.
    pub fn script(
        &self,
        contacts: &Contacts,
        values: &ScriptVariables,
    ) -> Result<String, ScriptTemplateError> {
        let variables = self.variables(contacts, values);
        let findings = [
            self.check_boundary(&contacts.periodicity, contacts.lost),
            self.check_step(&variables, values.step),
            self.check_gravity(&variables, contacts.gravity),
        ];
        ScriptTemplateError::of(findings.into_iter().filter_map(Result::err).collect())?;
        let mut text = format!(
            "# Written by Calcine: its variables, then {}, then what Calcine drives it by.\n",
            self.path.display()
        );
        for (name, value) in &variables {
            let _ = writeln!(text, "variable {name} string \"{value}\"");
        }
        for command in &self.commands {
            match command.words().as_slice() {
                ["read_data", ..] => {
                    let _ = writeln!(text, "read_data {DATA}");
                    text += &moving::groups(contacts);
                }
                ["include", "calcine.contacts"] => text += &moving::laws(contacts),
                ["include", "calcine.gravity"] => text += &moving::gravity(contacts),
                ["include", "calcine.walls"] => text += &moving::walls(contacts, values.walls),
                ["include", "calcine.motion"] => text += &moving::motion(contacts),
                _ => {
                    text += &command.text;
                    text.push('\n');
                }
            }
        }
        text += &moving::push();
        text += "thermo 1000000\nthermo_modify lost ignore norm no\n";
        Ok(text)
    }

    /// Names and values; texts, so that no digit is lost.
    fn variables(&self, contacts: &Contacts, values: &ScriptVariables) -> Vec<(String, String)> {
        let mut all = Vec::new();
        let mut add = |name: &str, value: String| all.push((format!("{PREFIX}{name}"), value));
        add("data", DATA.into());
        add("processors", values.processors.clone());
        add(
            "boundary",
            moving::boundary(&contacts.periodicity, contacts.lost),
        );
        let (lower, upper) = values.corners;
        let numbers = [
            ("step", values.step),
            ("skin", values.skin),
            ("bins", values.bins),
            ("gravity_x", contacts.gravity.x),
            ("gravity_y", contacts.gravity.y),
            ("gravity_z", contacts.gravity.z),
            ("gravity", contacts.gravity.norm()),
            ("lower_x", lower.x),
            ("lower_y", lower.y),
            ("lower_z", lower.z),
            ("upper_x", upper.x),
            ("upper_y", upper.y),
            ("upper_z", upper.z),
        ];
        for (name, value) in numbers {
            add(name, format!("{value:e}"));
        }
        add("types", moving::types(contacts).to_string());
        for (index, name) in self.populations.iter().enumerate() {
            add(&format!("type_{}", word(name)), (index + 1).to_string());
        }
        let first = self.populations.len() + 1;
        for (index, (name, elastic)) in self.materials.iter().zip(&contacts.materials).enumerate() {
            let name = word(name);
            add(&format!("wall_{name}"), (first + index).to_string());
            add(&format!("young_{name}"), format!("{:e}", elastic.young));
            add(&format!("poisson_{name}"), format!("{:e}", elastic.poisson));
        }
        for (a, one) in self.materials.iter().enumerate() {
            for (b, other) in self.materials.iter().enumerate() {
                let (pair, names) = (
                    contacts.pair(a, b),
                    format!("{}_{}", word(one), word(other)),
                );
                add(
                    &format!("restitution_{names}"),
                    format!("{:e}", pair.restitution),
                );
                add(&format!("friction_{names}"), format!("{:e}", pair.friction));
            }
        }
        all
    }

    /// Sides of the box repeat themselves where those of the case do, and nowhere else. A script that says nothing of them
    /// has them all do so.
    fn check_boundary(
        &self,
        periodicity: &Periodicity,
        lost: LostParticles,
    ) -> Result<(), ScriptTemplateError> {
        let wanted = moving::boundary(periodicity, lost);
        let mut found = None;
        for command in &self.commands {
            let words = command.words();
            let sides = match words[..] {
                ["boundary", VARIABLE] => {
                    found = Some(command);
                    continue;
                }
                ["boundary", x, y, z] => [x, y, z],
                ["boundary", ..] => ["?"; 3],
                _ => continue,
            };
            found = Some(command);
            let is_same = |(side, span): (&str, &Option<PeriodicSpan>)| match span {
                Some(_) => side == "p",
                None => ["f", "s", "m"].contains(&side.get(..1).unwrap_or_default()),
            };
            if !sides.into_iter().zip(&periodicity.axes).all(is_same) {
                let periodic: Vec<&str> = ["x", "y", "z"]
                    .into_iter()
                    .zip(&periodicity.axes)
                    .filter_map(|(name, span)| span.map(|_| name))
                    .collect();
                let rule = match periodic.is_empty() {
                    true => "the case has no periodic patches".to_owned(),
                    false => format!(
                        "the case is periodic along {} alone",
                        periodic.join(" and ")
                    ),
                };
                return Err(command.refuse(
                    rule,
                    format!("write `boundary {wanted}`, or `boundary {VARIABLE}`"),
                ));
            }
            let fixed =
                lost == LostParticles::TakeOut && sides.iter().any(|side| side.contains('f'));
            if fixed {
                return Err(command.refuse(
                    "LIGGGHTS drops what leaves a fixed side, but motion.lost = \"take-out\" has it booked",
                    format!("write `boundary {wanted}`, or `boundary {VARIABLE}`"),
                ));
            }
        }
        match found.is_some() || wanted == "p p p" {
            true => Ok(()),
            false => Err(ScriptTemplateError::Missing {
                what: "boundary",
                remedy: "boundary ${calcine_boundary}",
            }),
        }
    }

    fn check_step(
        &self,
        variables: &[(String, String)],
        step: f64,
    ) -> Result<(), ScriptTemplateError> {
        for command in &self.commands {
            if let ["timestep", value, ..] = command.words()[..] {
                let found = number(value, variables);
                if found.is_none_or(|found| (found / step - 1.0).abs() > SAME) {
                    let rule = format!("the time step of the case is {step:e} s");
                    let remedy = "write `timestep ${calcine_step}`, or state the script's as \
                                  `motion.motion_step` in the case file";
                    return Err(command.refuse(rule, remedy));
                }
            }
        }
        Ok(())
    }

    fn check_gravity(
        &self,
        variables: &[(String, String)],
        gravity: Vec3,
    ) -> Result<(), ScriptTemplateError> {
        let (mut sum, mut last) = (Vec3::zeros(), None);
        for command in &self.commands {
            let words = command.words();
            match words[..] {
                ["include", "calcine.gravity"] => sum += gravity,
                ["fix", _, _, "gravity", strength, "vector", x, y, z] => {
                    let read = |word| number(word, variables);
                    let values = (read(strength), read(x), read(y), read(z));
                    let (Some(strength), Some(x), Some(y), Some(z)) = values else {
                        let rule = "Calcine cannot tell the numbers of this gravity";
                        return Err(
                            command.refuse(rule, "write numbers, or variables of Calcine's")
                        );
                    };
                    let direction = Vec3::new(x, y, z).try_normalize(0.0);
                    sum += strength * direction.unwrap_or_default();
                }
                ["fix", _, _, "gravity", ..] => {
                    let rule = "Calcine compares gravity with the case's only in one form";
                    let remedy = "write `fix NAME GROUP gravity STRENGTH vector X Y Z`";
                    return Err(command.refuse(rule, remedy));
                }
                _ => continue,
            }
            last = Some(command);
        }
        if (sum - gravity).norm() <= SAME * gravity.norm() {
            return Ok(());
        }
        let Some(command) = last else {
            return Err(ScriptTemplateError::Missing {
                what: "fix … gravity",
                remedy: "include calcine.gravity",
            });
        };
        let [x, y, z] = gravity.into();
        let rule = format!("gravity of the case is ({x} {y} {z}) m/s² (`gas.gravity`)");
        Err(command.refuse(rule, "write `include calcine.gravity`"))
    }
}

/// A name as part of a variable's.
fn word(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(letter).collect()
}

/// A number, or what a variable of Calcine's stands for.
fn number(word: &str, variables: &[(String, String)]) -> Option<f64> {
    let named = word
        .strip_prefix("${")
        .and_then(|rest| rest.strip_suffix('}'));
    let text = match named {
        None => word,
        Some(name) => variables.iter().find(|(own, _)| own == name)?.1.as_str(),
    };
    text.parse().ok()
}

/// Commands of a script: continued lines joined, comments and empty lines left out.
fn commands(text: &str) -> Vec<Command> {
    let mut all: Vec<Command> = Vec::new();
    let mut continued = false;
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split('#').next().unwrap_or_default().trim_end();
        let (content, goes_on) = match content.strip_suffix('&') {
            Some(content) => (content, true),
            None => (content, false),
        };
        match all.last_mut() {
            Some(last) if continued => last.text += content,
            _ if content.trim().is_empty() => {}
            _ => all.push(Command {
                line,
                text: content.trim_start().to_owned(),
            }),
        }
        continued = goes_on;
    }
    all
}

/// Turns names of files, which are relative to the script, into absolute paths: LIGGGHTS runs in a folder of the results. What comes back
/// are files that are not there.
fn beside(folder: &Path, commands: &mut [Command]) -> Vec<ScriptTemplateError> {
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let mut absent = Vec::new();
    for command in commands {
        let words = command.words();
        let reads = match words[..] {
            ["fix", _, _, style, ..] => {
                style.starts_with("mesh/") || style.starts_with("particletemplate/")
            }
            ["variable", _, "file", ..] => true,
            _ => false,
        };
        let named = words.windows(2).find(|pair| reads && pair[0] == "file");
        let Some(name) = named.map(|pair| pair[1].trim_matches('"').to_owned()) else {
            continue;
        };
        if name.contains("${") || Path::new(&name).is_absolute() {
            continue;
        }
        let path = folder.join(&name);
        if !path.is_file() {
            let rule = format!("there is no file {name} beside the script");
            let remedy = "put it there, or write its absolute path";
            absent.push(command.refuse(rule, remedy));
            continue;
        }
        let path = path.display().to_string();
        let path = match path.contains(' ') {
            true => format!("\"{path}\""),
            false => path,
        };
        let mut is_next = false;
        let words = words.iter().map(|word| {
            let is_name = std::mem::replace(&mut is_next, *word == "file");
            if is_name { path.as_str() } else { *word }
        });
        command.text = words.collect::<Vec<_>>().join(" ");
    }
    absent
}

/// What holds for every script, whatever the case's numbers: all that is wrong.
fn check(commands: &[Command]) -> Vec<ScriptTemplateError> {
    let mut found = Vec::new();
    let mut needed = [
        ("units si", "units si", false),
        ("atom_style granular", "atom_style granular", false),
        ("read_data", "read_data ${calcine_data}", false),
        ("timestep", "timestep ${calcine_step}", false),
        ("fix … nve/sphere", "include calcine.motion", false),
    ];
    for command in commands {
        let words = command.words();
        match words[..] {
            ["units", "si"] => needed[0].2 = true,
            ["units", ..] => {
                needed[0].2 = true;
                found.push(command.refuse("Calcine is SI throughout", "write `units si`"));
            }
            ["atom_style", "granular" | "sphere"] => needed[1].2 = true,
            ["atom_style", ..] => {
                needed[1].2 = true;
                let rule = "Calcine's particles are spheres";
                found.push(command.refuse(rule, "write `atom_style granular`"));
            }
            ["read_data", _] if needed[2].2 => {
                found.push(command.refuse("particles are read once", "leave the line out"));
            }
            ["read_data", "${calcine_data}" | DATA] => needed[2].2 = true,
            ["read_data", ..] => {
                needed[2].2 = true;
                let rule = "the case file says which particles there are";
                found.push(command.refuse(rule, "write `read_data ${calcine_data}`"));
            }
            ["timestep", ..] => needed[3].2 = true,
            ["include", "calcine.motion"] => needed[4].2 = true,
            [
                "include",
                "calcine.contacts" | "calcine.gravity" | "calcine.walls",
            ] => {}
            ["fix", _, _, style, ..] if INTEGRATES.iter().any(|one| style.starts_with(one)) => {
                needed[4].2 = true;
            }
            ["fix", _, _, style, ..] if style.starts_with("insert/") => {
                let rule = "particles come in as the case file says";
                found.push(command.refuse(rule, "write a `[[feeds]]`"));
            }
            ["fix", _, _, "external", ..] => {
                let rule = "by this fix the host adds the force of the gas at each step";
                found.push(command.refuse(rule, "leave the line out"));
            }
            [first, ..] => {
                let refused = REFUSED.iter().find(|(names, ..)| names.contains(&first));
                if let Some((_, rule, remedy)) = refused {
                    found.push(command.refuse(*rule, *remedy));
                }
            }
            [] => {}
        }
    }
    let missing = needed.iter().filter(|(.., there)| !there);
    found.extend(missing.map(|&(what, remedy, _)| ScriptTemplateError::Missing { what, remedy }));
    found
}

#[cfg(test)]
mod tests;
