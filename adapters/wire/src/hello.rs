//! What the two ends say of themselves before anything else, and how it is compared.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::catalogue::Catalogue;
use crate::error::WireError;
use crate::record::VERSION;

/// Said in place of a hash by a solver whose inputs Calcine does not write: its cells are compared one by one.
pub const NOT_COMPARED: &str = "-";
/// The origin of a solver that takes up no checkpoint.
pub const NEW: &str = "new";

/// One end's introduction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hello {
    /// "gas" or "particles".
    pub role: String,
    /// Name, for example "OpenFOAM".
    pub name: String,
    /// The solver's version; not compared.
    pub version: String,
    /// Hash of the case that the inputs were written for, or [`NOT_COMPARED`].
    pub case_hash: String,
    /// Hash of the mesh, or of the initial particles, or [`NOT_COMPARED`].
    pub mesh_hash: String,
    /// The checkpoint that the state at the start is from, as the solver was given it, or [`NEW`].
    pub origin: String,
    /// Cells or particles of all ranks.
    pub count: u64,
    /// Ranks of the solver.
    pub ranks: u32,
    /// Columns of all messages.
    pub catalogue: Catalogue,
}

impl Hello {
    /// The introduction as `key value` lines; the catalogue's come last.
    pub fn to_text(&self) -> String {
        let line = |value: &str| value.replace('\n', " ");
        let mut text = format!(
            "protocol {VERSION}\nrole {}\nname {}\nversion {}\ncase {}\nmesh {}\norigin {}\ncount {}\nranks {}\n",
            line(&self.role),
            line(&self.name),
            line(&self.version),
            line(&self.case_hash),
            line(&self.mesh_hash),
            line(&self.origin),
            self.count,
            self.ranks
        );
        for field in self.catalogue.fields() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "field {field}");
        }
        text
    }

    /// Reads what [`Hello::to_text`] wrote; another protocol version is a mismatch.
    pub fn from_text(text: &str) -> Result<Self, WireError> {
        let mut values = BTreeMap::new();
        let mut fields = Vec::new();
        for line in text.lines() {
            let (key, value) = line.split_once(' ').unwrap_or((line, ""));
            if key == "field" {
                fields.push(value);
            } else {
                values.insert(key, value);
            }
        }
        let value = |key: &str| {
            values
                .get(key)
                .map(|value| (*value).to_owned())
                .ok_or_else(|| WireError::Text {
                    detail: format!("the introduction lacks `{key}`"),
                })
        };
        let number = |key: &str| {
            let text = value(key)?;
            text.parse::<u64>().map_err(|_| WireError::Text {
                detail: format!("`{key}` is `{text}`, not a number"),
            })
        };
        compare(
            "protocol version",
            &VERSION.to_string(),
            &value("protocol")?,
        )?;
        Ok(Self {
            role: value("role")?,
            name: value("name")?,
            version: value("version")?,
            case_hash: value("case")?,
            mesh_hash: value("mesh")?,
            origin: value("origin")?,
            count: number("count")?,
            ranks: u32::try_from(number("ranks")?).unwrap_or(u32::MAX),
            catalogue: fields.join("\n").parse()?,
        })
    }

    /// Compares with the other end's; the error names what differs and both values.
    pub fn agree(&self, theirs: &Hello) -> Result<(), WireError> {
        compare("role", &self.role, &theirs.role)?;
        compare("case hash", &self.case_hash, &theirs.case_hash)?;
        compare("mesh hash", &self.mesh_hash, &theirs.mesh_hash)?;
        compare("checkpoint to start from", &self.origin, &theirs.origin)?;
        let counts = (self.count.to_string(), theirs.count.to_string());
        compare("number of cells or particles", &counts.0, &counts.1)?;
        let ranks = (self.ranks.to_string(), theirs.ranks.to_string());
        compare("number of ranks", &ranks.0, &ranks.1)?;
        let (ours, theirs) = (self.catalogue.fields(), theirs.catalogue.fields());
        for (ours, theirs) in ours.iter().zip(theirs) {
            compare("catalogue entry", &ours.to_string(), &theirs.to_string())?;
        }
        let lengths = (ours.len().to_string(), theirs.len().to_string());
        compare("number of catalogue entries", &lengths.0, &lengths.1)
    }
}

/// FNV-1a, word by word.
fn hash(words: impl IntoIterator<Item = u64>) -> u64 {
    let mix = |hash: u64, word: u64| (hash ^ word).wrapping_mul(0x0100_0000_01b3);
    words.into_iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

/// Hash of what particles are, whatever they do: ids and radii. A sum over particles, so that ranks
/// add their shares and the order does not matter.
pub fn particles_hash(id: &[u64], radius: &[f64]) -> u64 {
    let pairs = id.iter().zip(radius);
    let each = pairs.map(|(&id, radius)| hash([id, radius.to_bits()]));
    each.fold(0, u64::wrapping_add)
}

/// A hash as a handshake has it.
pub fn hash_text(hash: u64) -> String {
    format!("{hash:016x}")
}

fn compare(what: &'static str, ours: &str, theirs: &str) -> Result<(), WireError> {
    if ours == theirs {
        return Ok(());
    }
    Err(WireError::Mismatch {
        what,
        ours: ours.into(),
        theirs: theirs.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hello() -> Hello {
        Hello {
            role: "gas".into(),
            name: "OpenFOAM".into(),
            version: "1912".into(),
            case_hash: "0a".into(),
            mesh_hash: "0b".into(),
            origin: NEW.into(),
            count: 12,
            ranks: 1,
            catalogue: Catalogue::standard("gas").unwrap(),
        }
    }

    #[test]
    fn an_introduction_survives_its_text() {
        assert_eq!(Hello::from_text(&hello().to_text()).unwrap(), hello());
    }

    #[test]
    fn a_difference_is_told_with_both_values() {
        type Change = fn(&mut Hello);
        let cases: [(&str, Change); 5] = [
            ("start from is new here, but /run/checkpoint", |h| {
                h.origin = "/run/checkpoint".into()
            }),
            ("case hash is 0a here, but 0c", |h| {
                h.case_hash = "0c".into()
            }),
            ("mesh hash is 0b here, but 0c", |h| {
                h.mesh_hash = "0c".into()
            }),
            ("is 12 here, but 13", |h| h.count = 13),
            ("owned cell 1 u64 item", |h| {
                h.catalogue = Catalogue::standard("particles").unwrap()
            }),
        ];
        for (expected, change) in cases {
            let mut other = hello();
            change(&mut other);
            let text = hello().agree(&other).unwrap_err().to_string();
            assert!(text.contains(expected), "{text}");
        }
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        // Published: FNV-1a of no bytes, and of the byte "a" (0x61), 64 bits.
        assert_eq!(hash_text(hash([])), "cbf29ce484222325");
        assert_eq!(hash_text(hash([0x61])), "af63dc4c8601ec8c");
    }

    #[test]
    fn the_hash_of_particles_adds_over_ranks_and_sees_every_radius() {
        let whole = particles_hash(&[1, 2, 5], &[0.1, 0.2, 0.3]);
        let shares =
            particles_hash(&[5, 1], &[0.3, 0.1]).wrapping_add(particles_hash(&[2], &[0.2]));
        assert_eq!(whole, shares);
        assert_ne!(whole, particles_hash(&[1, 2, 5], &[0.1, 0.3, 0.2]));
    }

    #[test]
    fn another_protocol_version_is_refused() {
        let other = VERSION + 1;
        let written = format!("protocol {VERSION}");
        let text = hello().to_text();
        let text = text.replace(&written, &format!("protocol {other}"));
        let error = Hello::from_text(&text).unwrap_err().to_string();
        let words = format!("protocol version is {VERSION} here, but {other}");
        assert!(error.contains(&words), "{error}");
    }
}
