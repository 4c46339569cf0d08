//! A file of particles as named columns.

use std::fmt;

use calcine_coupler::physics::Vec3;

use crate::fortran;

/// Which particles of a file are meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::case) struct Choice {
    /// The snapshot of a dump; `None`: its last one.
    pub timestep: Option<u64>,
    /// Those of one type; `None`: all.
    pub kind: Option<u64>,
}

/// A particle of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::case) struct Entry {
    /// Where in the file it stands.
    pub row: Row,
    /// Its centre in m.
    pub centre: Vec3,
    /// Its diameter in m, where the file states one.
    pub diameter: Option<f64>,
    /// Its temperature in K, where the file states one.
    pub temperature: Option<f64>,
    /// Its velocity in m/s, where the file states one.
    pub velocity: Option<Vec3>,
    /// Its angular velocity in rad/s, where the file states one.
    pub spin: Option<Vec3>,
    /// Its statistical weight, where the file states one.
    pub weight: Option<f64>,
    /// Its density in kg/m³ or its mass in kg, where the file states one.
    pub heaviness: Option<Heaviness>,
}

/// What a file says of how heavy a particle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::case) enum Heaviness {
    /// In kg/m³.
    Density(f64),
    /// In kg.
    Mass(f64),
}

/// Where a particle stands in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum Row {
    /// A line, from 1.
    Line(usize),
    /// The number of a particle, from 1, in files that have no line of its own for it.
    Particle(usize),
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Row::Line(line) => write!(f, "line {line}"),
            Row::Particle(number) => write!(f, "particle {number}"),
        }
    }
}

/// What is wrong with a file, and where.
pub(super) type Fault = (Option<Row>, String);

/// A file as named columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sheet {
    /// Names in lower case, and values.
    pub(super) columns: Vec<(String, Vec<f64>)>,
    /// Line of each particle; empty where particles have none.
    pub(super) lines: Vec<usize>,
}

/// Names under which programs write the same thing, the first one that is there counts.
const AXES: [[&str; 2]; 3] = [["x", "points:0"], ["y", "points:1"], ["z", "points:2"]];

const VELOCITY: [[&str; 3]; 3] = [
    ["vx", "velocity:0", "v:0"],
    ["vy", "velocity:1", "v:1"],
    ["vz", "velocity:2", "v:2"],
];

const SPIN: [[&str; 3]; 3] = [
    ["omegax", "angular_velocity:0", "omega:0"],
    ["omegay", "angular_velocity:1", "omega:1"],
    ["omegaz", "angular_velocity:2", "omega:2"],
];

/// Names under which people write what is read under another one, alone or beside a unit; and what to do.
const MEANT: [(&[&str], &str); 7] = [
    (
        &[
            "d",
            "dia",
            "diam",
            "diameter",
            "diametre",
            "diamètre",
            "durchmesser",
            "size",
        ],
        "name it `diameter` (in m), or leave it out",
    ),
    (
        &["r", "rad", "radius"],
        "name it `radius` (in m), or leave it out",
    ),
    (
        &["t", "temp", "temperatur", "temperature"],
        "name it `temperature` (in K), or leave it out",
    ),
    (
        &["density", "dichte", "rho"],
        "name it `density` (in kg/m^3), or leave it out",
    ),
    (
        &["mass", "masse"],
        "name it `mass` (in kg), or leave it out",
    ),
    (
        &[
            "angularvelocity",
            "omega",
            "omegax",
            "omegay",
            "omegaz",
            "spin",
            "wx",
            "wy",
            "wz",
        ],
        "name angular velocities `omegax`, `omegay` and `omegaz` (in rad/s), or leave them out",
    ),
    (
        &[
            "geschwindigkeit",
            "speed",
            "u",
            "ux",
            "uy",
            "uz",
            "v",
            "velocities",
            "velocity",
            "velocityx",
            "velocityy",
            "velocityz",
            "vx",
            "vy",
            "vz",
            "w",
        ],
        "name velocities `vx`, `vy` and `vz` (in m/s), or leave them out",
    ),
];

/// Parts of names that are units.
const UNITS: [&str; 15] = [
    "m", "mm", "cm", "um", "k", "c", "degc", "kg", "g", "m3", "mm3", "s", "ms", "m^3", "rad",
];

/// Parts of names that say whose value it is: it is the particle's all the same.
const WHOSE: [&str; 8] = [
    "bead",
    "grain",
    "initial",
    "p",
    "particle",
    "particles",
    "pellet",
    "sphere",
];

/// What LIGGGHTS and LAMMPS put before the names of computes and fixes.
const COMPUTED: [&str; 2] = ["c_", "f_"];

const DIAMETER: [&str; 1] = ["diameter"];

/// Smallest diameter of a particle in m.
const SMALLEST: f64 = 1e-9;

const RADIUS: [&str; 1] = ["radius"];

/// Share by which a diameter and twice a radius may differ where each is rounded.
const SAME_SIZE: f64 = 1e-2;

const TEMPERATURE: [&str; 3] = ["temperature", "f_temp", "f_temp[0]"];

const DENSITY: [&str; 2] = ["density", "rho"];

const MASS: [&str; 1] = ["mass"];

/// Results of Calcine have the index of the population.
const TYPE: [&str; 2] = ["type", "population"];

const WEIGHT: [&str; 1] = ["weight"];

const ID: [&str; 1] = ["id"];

/// What a column that is not read is likely meant for.
///
/// A longer name that says more, such as `mass_fraction` or `surface_temperature`, is of something else.
fn meant(name: &str) -> Option<&'static str> {
    if is_read(name) {
        return None;
    }
    let plain = COMPUTED.iter().find_map(|start| name.strip_prefix(start));
    let plain = plain.unwrap_or(name);
    plain_meant(name).or_else(|| plain_meant(plain))
}

fn plain_meant(name: &str) -> Option<&'static str> {
    let parts: Vec<&str> = name
        .split(|letter: char| !letter.is_alphanumeric() && letter != '^')
        .filter(|part| !part.is_empty())
        .collect();
    // The first part is a name even where it is the letter of a unit.
    let rest = parts
        .iter()
        .enumerate()
        .filter(|(place, part)| !WHOSE.contains(part) && (*place == 0 || !UNITS.contains(part)));
    let word: String = rest.map(|(_, part)| *part).collect();
    // A letter glued to a name, as in `dp`.
    let short = word.strip_suffix('p').filter(|word| word.len() == 1);
    let word = short.unwrap_or(&word);
    MEANT
        .iter()
        .find(|(names, _)| names.contains(&word))
        .map(|(_, meant)| *meant)
}

impl Sheet {
    fn column(&self, names: &[&str]) -> Option<&[f64]> {
        names.iter().find_map(|name| {
            let mut all = self.columns.iter();
            all.find(|(other, _)| other == name)
                .map(|(_, values)| values.as_slice())
        })
    }

    /// Three columns, where all are there.
    fn vectors(
        &self,
        what: &str,
        names: [[&'static str; 3]; 3],
    ) -> Result<Option<[&[f64]; 3]>, Fault> {
        let found = names.map(|names| self.column(&names));
        match found {
            [Some(x), Some(y), Some(z)] => Ok(Some([x, y, z])),
            [None, None, None] => Ok(None),
            _ => {
                let is_missing = |index: &usize| found[*index].is_none();
                let missing = (0..3).filter(is_missing).map(|index| names[index][0]);
                let missing = missing.collect::<Vec<_>>().join(" and ");
                let fact = format!("it has components of the {what}, but no column {missing}");
                Err((None, fact))
            }
        }
    }

    /// Diameters must be twice the radii where a file states both, up to what rounding leaves.
    fn check_sizes(&self, order: &[usize]) -> Result<(), Fault> {
        let both = (self.column(&DIAMETER), self.column(&RADIUS));
        let (Some(diameter), Some(radius)) = both else {
            return Ok(());
        };
        let odd = order.iter().find(|&&index| {
            let (diameter, twice) = (diameter[index], 2.0 * radius[index]);
            (diameter - twice).abs() > SAME_SIZE * diameter.abs()
        });
        match odd {
            None => Ok(()),
            Some(&index) => {
                let what = format!(
                    "the diameter is {}, the radius {}, which is not half of it; correct one of them, or leave out its column",
                    diameter[index], radius[index]
                );
                Err((Some(self.row(index)), what))
            }
        }
    }

    fn row(&self, index: usize) -> Row {
        match self.lines.get(index) {
            Some(&line) => Row::Line(line),
            None => Row::Particle(index + 1),
        }
    }

    /// The sheet, of a text that people write.
    pub(super) fn checked(self) -> Result<Self, Fault> {
        self.check_names()?;
        Ok(self)
    }

    /// No column twice, and none that looks like a size, a velocity or a temperature under a name that is not read.
    fn check_names(&self) -> Result<(), Fault> {
        for (index, (name, _)) in self.columns.iter().enumerate() {
            if self.columns[..index].iter().any(|(other, _)| other == name) {
                return Err((None, format!("it has two columns `{name}`; leave one out")));
            }
            if let Some(meant) = meant(name) {
                let fact = format!("its column `{name}` is not read; {meant}");
                return Err((None, fact));
            }
        }
        Ok(())
    }

    pub(super) fn entries(&self, choice: Choice) -> Result<Vec<Entry>, Fault> {
        let [x, y, z] = AXES.map(|names| self.column(&names));
        let (Some(x), Some(y), Some(z)) = (x, y, z) else {
            let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
            let unnamed = names.iter().all(|name| name.is_empty());
            let what = match names[..] {
                [] => "it is empty; its first line names the columns: x, y and z (in m)".into(),
                [one] if one.contains([';', '\t', ' ']) => {
                    "its first line has no comma; separate columns by commas, and write decimals with a point".into()
                }
                _ if unnamed => "its first line names no column; write x, y and z (in m)".into(),
                _ => format!(
                    "it has the columns {}, and needs x, y and z (in m)",
                    names.join(", ")
                ),
            };
            return Err((None, what));
        };
        let kinds = self.column(&TYPE);
        if choice.kind.is_some() && kinds.is_none() {
            return Err((
                None,
                "it has no column `type` or `population` to choose by".into(),
            ));
        }
        let wanted = |index: &usize| match (choice.kind, kinds) {
            (Some(kind), Some(kinds)) => kinds[*index] == kind as f64,
            _ => true,
        };
        let mut order: Vec<usize> = (0..x.len()).filter(wanted).collect();
        if let Some(id) = self.column(&ID) {
            // Programs in parallel write in any order; the sort keeps equal ids as they stand.
            order.sort_by(|&a, &b| id[a].total_cmp(&id[b]));
            if let Some(pair) = order.windows(2).find(|pair| id[pair[0]] == id[pair[1]]) {
                let what = format!(
                    "the id {} stands there twice; give each particle its own",
                    id[pair[1]]
                );
                return Err((Some(self.row(pair[1])), what));
            }
        }
        if let (Some(kind), true) = (choice.kind, order.is_empty()) {
            return Err((None, format!("it has no particle of type {kind}")));
        }
        let own = self.column(&DIAMETER).map(|list| (list, 1.0));
        let own = own.or_else(|| self.column(&RADIUS).map(|list| (list, 2.0)));
        self.check_sizes(&order)?;
        let (temperature, weight) = (self.column(&TEMPERATURE), self.column(&WEIGHT));
        let (density, mass) = (self.column(&DENSITY), self.column(&MASS));
        let heaviness = |index: usize| match (density, mass) {
            (Some(list), _) => Some(Heaviness::Density(list[index])),
            (None, Some(list)) => Some(Heaviness::Mass(list[index])),
            (None, None) => None,
        };
        let velocity = self.vectors("velocity", VELOCITY)?;
        let spin = self.vectors("angular velocity", SPIN)?;
        let positive = |what: &str, index: usize, value: f64| {
            // Of what is larger no volume can be computed.
            if value.powi(3).is_finite() && value > 0.0 {
                return Ok(value);
            }
            let rule = if value > 0.0 {
                "beyond all measure"
            } else {
                "not above zero"
            };
            let what = format!("the {what} is {value}, {rule}");
            Err((Some(self.row(index)), what))
        };
        let entry = |index: usize| {
            let centre = Vec3::new(x[index], y[index], z[index]);
            if centre.iter().any(|x| !x.is_finite()) {
                let what = "a coordinate of the centre is not a finite number".into();
                return Err((Some(self.row(index)), what));
            }
            let diameter = own.map(|(list, factor)| {
                let what = if factor == 1.0 { "diameter" } else { "radius" };
                let diameter = factor * positive(what, index, list[index])?;
                if diameter < SMALLEST {
                    let what = format!("the {what} is {} m, below a nanometre", list[index]);
                    return Err((Some(self.row(index)), what));
                }
                Ok(diameter)
            });
            let stated = |what: &str, list: Option<&[f64]>| {
                list.map(|list| positive(what, index, list[index]))
                    .transpose()
            };
            let vector = |what: &str, lists: [&[f64]; 3]| {
                let value = Vec3::from(lists.map(|list| list[index]));
                match value.iter().all(|one| one.is_finite()) {
                    true => Ok(value),
                    false => {
                        let what = format!("a component of the {what} is not a finite number");
                        Err((Some(self.row(index)), what))
                    }
                }
            };
            let velocity = velocity.map(|lists| vector("velocity", lists));
            let spin = spin.map(|lists| vector("angular velocity", lists));
            Ok(Entry {
                row: self.row(index),
                centre,
                diameter: diameter.transpose()?,
                temperature: stated("temperature", temperature)?,
                weight: stated("weight", weight)?,
                velocity: velocity.transpose()?,
                spin: spin.transpose()?,
                heaviness: heaviness(index),
            })
        };
        order.into_iter().map(entry).collect()
    }
}

/// True of a column that is read.
pub(super) fn is_read(name: &str) -> bool {
    let vectors = VELOCITY.iter().chain(&SPIN).flatten();
    let mut all = AXES.iter().flatten().chain(vectors);
    all.any(|other| *other == name)
        || [
            &DIAMETER[..],
            &RADIUS,
            &TEMPERATURE,
            &DENSITY,
            &MASS,
            &TYPE,
            &ID,
            &WEIGHT,
        ]
        .iter()
        .any(|names| names.contains(&name))
}

/// A number of a text file.
pub(super) fn number(word: &str, line: usize) -> Result<f64, Fault> {
    word.parse()
        .ok()
        .or_else(|| fortran::number(word))
        .ok_or_else(|| (Some(Row::Line(line)), format!("\"{word}\" is not a number")))
}

/// Adds an array to a sheet: a single column, or one for each component.
pub(super) fn add(sheet: &mut Sheet, name: &str, components: usize, values: &[f64]) {
    let name = name.to_lowercase();
    if components == 1 {
        sheet.columns.push((name, values.to_vec()));
        return;
    }
    for component in 0..components {
        let one = values.iter().skip(component).step_by(components);
        sheet
            .columns
            .push((format!("{name}:{component}"), one.copied().collect()));
    }
}
