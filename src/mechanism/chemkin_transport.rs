//! CHEMKIN's transport data (`tran.dat`): per line a name, the shape of the molecule (0 an atom, 1 linear, 2 not), ε/k in K, σ in Å, the
//! dipole moment in D, the polarisability in Å³ and the collision number of rotational relaxation; `!` begins a remark (Kee, Dixon-Lewis,
//! Warnatz, Coltrin and Miller 1986, Sandia report SAND86-8246).

use calcine_coupler::physics::thermo::LennardJones;

use super::chemkin_thermo;
use super::fault::{Fault, fault};

/// Names of the numbers behind a species' name.
const NUMBERS: [&str; 6] = [
    "the shape",
    "the well depth",
    "the diameter",
    "the dipole moment",
    "the polarisability",
    "the collision number",
];

/// The potential of a species.
#[derive(Clone, Debug, PartialEq)]
pub struct Molecule {
    /// Name of the species.
    pub name: String,
    /// Its potential.
    pub potential: LennardJones,
}

/// Reads the lines of a file.
pub fn parse(text: &str) -> Result<Vec<Molecule>, Fault> {
    let mut found: Vec<Molecule> = Vec::new();
    for (line, text) in text.lines().enumerate().map(|(k, text)| (k + 1, text)) {
        let bare = text.split('!').next().unwrap_or("");
        let mut words = bare.split_whitespace();
        let Some(name) = words.next() else {
            continue;
        };
        match name.to_ascii_uppercase().as_str() {
            "TRAN" | "TRANSPORT" => continue,
            "END" => break,
            _ => {}
        }
        let molecule = molecule(name, &words.collect::<Vec<_>>(), line)?;
        match found.iter().find(|one| one.name == name) {
            Some(before) if *before != molecule => {
                return fault(line, format!("{name} is there twice, with other data"));
            }
            Some(_) => {}
            None => found.push(molecule),
        }
    }
    match found.is_empty() {
        true => Err((None, "has no line of transport data".to_owned())),
        false => Ok(found),
    }
}

fn molecule(name: &str, words: &[&str], line: usize) -> Result<Molecule, Fault> {
    let mut numbers = [0.0; NUMBERS.len()];
    if words.len() < numbers.len() {
        let what = format!(
            "{name} has {} numbers behind its name, not the six of CHEMKIN's transport data",
            words.len()
        );
        return fault(line, what);
    }
    for ((number, word), what) in numbers.iter_mut().zip(words).zip(NUMBERS) {
        *number = chemkin_thermo::number(word, line, name, what)?;
    }
    let [shape, well_depth, diameter, ..] = numbers;
    if ![0.0, 1.0, 2.0].contains(&shape) {
        return fault(
            line,
            format!("{name} has the shape {shape}, but must have 0, 1 or 2"),
        );
    }
    for (number, what) in [(well_depth, NUMBERS[1]), (diameter, NUMBERS[2])] {
        if number <= 0.0 {
            return fault(
                line,
                format!("{what} of {name} is {number}, but must be positive"),
            );
        }
    }
    Ok(Molecule {
        name: name.to_owned(),
        potential: LennardJones {
            diameter: 1e-10 * diameter,
            well_depth,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_six_numbers_are_read_with_remarks_and_a_repeated_line() {
        let text = "TRANSPORT\n! name  shape\n\
                    AR  0  136.500  3.330  0.000  0.000  0.000\n\
                    C2H4  2  280.800  3.971  0.000  0.000  1.500  ! NMM\n\
                    C2H4 2 280.8 3.971 0 0 1.5\nEND\nrubbish";
        let found = parse(text).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(found[1].name, "C2H4");
        assert_eq!(found[1].potential.well_depth, 280.8);
        assert!((found[1].potential.diameter - 3.971e-10).abs() < 1e-25);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line, said) in [
            ("N2 1 97.53 3.621 0. 1.76", Some(1), "5 numbers"),
            (
                "\nN2 1 97.53 3,621 0. 1.76 4.",
                Some(2),
                "\"3,621\" for the diameter",
            ),
            ("N2 3 97.53 3.621 0. 1.76 4.", Some(1), "the shape 3"),
            (
                "N2 1 -97.53 3.621 0. 1.76 4.",
                Some(1),
                "the well depth of N2 is -97.53",
            ),
            (
                "N2 1 97.5 3.6 0 0 4\nN2 1 97.5 3.7 0 0 4",
                Some(2),
                "N2 is there twice",
            ),
            ("! nothing", None, "no line of transport data"),
        ] {
            let (found, what) = parse(text).unwrap_err();
            assert!(
                found == line && what.contains(said),
                "{text}: {found:?} {what}"
            );
        }
    }
}
