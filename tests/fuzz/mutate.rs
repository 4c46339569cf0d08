//! Mutations of files at the level of bytes, lines, tokens and values.

use std::ops::Range;

use crate::random::Random;

/// Numbers that readers stumble over.
const NUMBERS: [&str; 34] = [
    "0",
    "-0.0",
    "-1",
    "1",
    "3",
    "0.5",
    "1e-320",
    "1e308",
    "-1e308",
    "1e999",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "127",
    "255",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "1000000000000",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "123456789012345678901234567890",
    "0x7f",
    "0b1",
    "1_000",
    "1e",
    ".5",
    "5.",
    "--1",
];

/// Units and what may stand for one.
const UNITS: [&str; 36] = [
    "m",
    "mm",
    "um",
    "km",
    "cm^3/min",
    "m^3",
    "kg",
    "kg/m^3",
    "g/cm^3",
    "t/m^3",
    "s",
    "ms",
    "ps",
    "min",
    "h",
    "d",
    "K",
    "degC",
    "Pa",
    "bar",
    "atm",
    "MPa",
    "J/kg/K",
    "kJ/kg/K",
    "W/m/K",
    "W/m^2/K",
    "W/m^2",
    "m/s",
    "m/s^2",
    "kg/s",
    "g/mol",
    "Pa s",
    "%",
    "1",
    "m^99999999999",
    "µm",
];

/// Words of the files' syntax, and pieces that break it.
const PIECES: [&str; 26] = [
    "=",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "(",
    ")",
    ",",
    ";",
    "\"",
    "\"\"\"",
    "'",
    "#",
    "\n",
    "/*",
    "*/",
    "//",
    "{}",
    "[]",
    "true",
    "1979-05-27",
    "\\u0000",
    "\u{feff}",
    "é",
];

/// Changes a file in place; text of `others` may be taken over.
pub fn mutate(bytes: &mut Vec<u8>, random: &mut Random, others: &[&[u8]]) {
    match random.below(20) {
        0 => flip(bytes, random),
        1 => splice(bytes, random, &[]),
        2 => {
            let byte = [random.next() as u8];
            insert(bytes, random, &byte);
        }
        3 => {
            let piece = *random.one(&PIECES);
            insert(bytes, random, piece.as_bytes());
        }
        4 => bytes.truncate(random.below(bytes.len())),
        5 => take_over(bytes, random, others),
        6 => repeat(bytes, random),
        7 => lines(bytes, random, |lines, random| {
            let at = random.below(lines.len());
            lines.remove(at);
        }),
        8 => lines(bytes, random, |lines, random| {
            let copy = random.one(lines).clone();
            lines.insert(random.below(lines.len()), copy);
        }),
        9 => lines(bytes, random, |lines, random| {
            let (a, b) = (random.below(lines.len()), random.below(lines.len()));
            lines.swap(a, b);
        }),
        10 | 11 => entries(bytes, random),
        12 => replace_one(bytes, random, is_word, |random| {
            random.one(&UNITS).as_bytes().to_vec()
        }),
        13 => swap_tokens(bytes, random),
        14 => integers(bytes, random),
        _ => replace_one(bytes, random, is_number, |random| {
            random.one(&NUMBERS).as_bytes().to_vec()
        }),
    }
}

fn flip(bytes: &mut [u8], random: &mut Random) {
    let at = random.below(bytes.len());
    if let Some(byte) = bytes.get_mut(at) {
        *byte ^= 1 << random.below(8);
    }
}

/// A random range, short as a rule.
fn range(length: usize, random: &mut Random) -> Range<usize> {
    let start = random.below(length);
    let most = if random.once_in(4) { length } else { 16 };
    start..(start + random.below(most) + 1).min(length)
}

fn splice(bytes: &mut Vec<u8>, random: &mut Random, with: &[u8]) {
    let range = range(bytes.len(), random);
    bytes.splice(range, with.iter().copied());
}

fn insert(bytes: &mut Vec<u8>, random: &mut Random, with: &[u8]) {
    let at = random.below(bytes.len() + 1);
    bytes.splice(at..at, with.iter().copied());
}

/// Takes over a range of another file.
fn take_over(bytes: &mut Vec<u8>, random: &mut Random, others: &[&[u8]]) {
    if others.is_empty() {
        return;
    }
    let other = random.one(others);
    let range = range(other.len(), random);
    splice(bytes, random, &other[range]);
}

/// Repeats a range up to 4096 times: deep nesting, long lists.
fn repeat(bytes: &mut Vec<u8>, random: &mut Random) {
    let range = range(bytes.len(), random);
    let times = 1 << random.below(13);
    let block = bytes[range.clone()].repeat(times.min(1 + 65536 / range.len().max(1)));
    bytes.splice(range, block);
}

fn lines(
    bytes: &mut Vec<u8>,
    random: &mut Random,
    change: impl FnOnce(&mut Vec<Vec<u8>>, &mut Random),
) {
    let mut list: Vec<Vec<u8>> = bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
    change(&mut list, random);
    *bytes = list.join(&b'\n');
}

/// Swaps the keys or the values of two lines `key = value`.
fn entries(bytes: &mut Vec<u8>, random: &mut Random) {
    let keys = random.once_in(2);
    lines(bytes, random, |lines, random| {
        let with: Vec<usize> = (0..lines.len())
            .filter(|&line| lines[line].contains(&b'='))
            .collect();
        if with.is_empty() {
            return;
        }
        let (a, b) = (*random.one(&with), *random.one(&with));
        let split = |line: &[u8]| {
            let at = line.iter().position(|&byte| byte == b'=').unwrap_or(0);
            (line[..at].to_vec(), line[at..].to_vec())
        };
        let ((key_a, value_a), (key_b, value_b)) = (split(&lines[a]), split(&lines[b]));
        lines[a] = [key_a, value_b.clone()].concat();
        // Either both change places, or one value stands twice.
        if keys {
            lines[b] = [key_b, value_a].concat();
        }
    });
}

fn is_number(byte: u8) -> bool {
    byte.is_ascii_digit() || b"+-.eE".contains(&byte)
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || b"_^/%".contains(&byte)
}

/// Runs of bytes of one kind.
fn tokens(bytes: &[u8], kind: fn(u8) -> bool) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (at, &byte) in bytes.iter().chain(b"\n").enumerate() {
        match (kind(byte), start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                found.push(from..at);
                start = None;
            }
            _ => {}
        }
    }
    found
}

fn replace_one(
    bytes: &mut Vec<u8>,
    random: &mut Random,
    kind: fn(u8) -> bool,
    with: impl FnOnce(&mut Random) -> Vec<u8>,
) {
    let found = tokens(bytes, kind);
    if !found.is_empty() {
        let range = random.one(&found).clone();
        let with = with(random);
        bytes.splice(range, with);
    }
}

fn swap_tokens(bytes: &mut Vec<u8>, random: &mut Random) {
    let kind = if random.once_in(2) {
        is_number
    } else {
        is_word
    };
    let found = tokens(bytes, kind);
    if found.is_empty() {
        return;
    }
    let (a, b) = (random.one(&found).clone(), random.one(&found).clone());
    let (first, second) = if a.start < b.start { (a, b) } else { (b, a) };
    let [one, two] = [first.clone(), second.clone()].map(|range| bytes[range].to_vec());
    if first.end <= second.start {
        bytes.splice(second, one);
        bytes.splice(first, two);
    }
}

/// Overwrites four or eight bytes by an integer or a float, as binary lists hold them.
fn integers(bytes: &mut [u8], random: &mut Random) {
    let values: [u64; 12] = [
        0,
        1,
        7,
        0x7fff_ffff,
        0x8000_0000,
        0xffff_ffff,
        u64::MAX,
        1 << 40,
        f64::NAN.to_bits(),
        f64::INFINITY.to_bits(),
        1e308f64.to_bits(),
        (-1.0f64).to_bits(),
    ];
    let value = random.one(&values).to_le_bytes();
    let length = if random.once_in(2) { 4 } else { 8 };
    let at = random.below(bytes.len());
    for (byte, new) in bytes[at..].iter_mut().zip(&value[..length]) {
        *byte = *new;
    }
}
