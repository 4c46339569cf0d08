//! Files that are read, and files that are not.

use std::fmt::Write as _;

use calcine_coupler::physics::kinetics::{Broadening, MixtureState, RateConstant};
use proptest::prelude::*;

use super::*;

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"];
const MOLES: [f64; 7] = [0.05, 0.12, 0.03, 0.02, 0.11, 0.07, 0.6];

fn gas() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Compares with Cantera's rates (`coupler/physics/tests/reference/references.py`).
fn as_cantera(mechanism: &Mechanism, name: &str, tolerance: f64) {
    let table = folder("coupler/physics/tests/reference/rates.csv");
    let table = std::fs::read_to_string(table).unwrap();
    let y = gas().mass_fractions(&MOLES);
    let mut count = 0;
    for line in table
        .lines()
        .filter(|line| line.starts_with(&format!("{name},")))
    {
        let cells = line.split(',').skip(1);
        let row: Vec<f64> = cells.map(|cell| cell.parse().unwrap()).collect();
        let [temperature, pressure, reaction, forth, back] = row[..] else {
            panic!("{line}")
        };
        let state = MixtureState {
            pressure,
            temperature,
            fractions: &y,
        };
        let found = mechanism.progress(state)[reaction as usize];
        assert!(
            (found.0 / forth - 1.0).abs() < tolerance,
            "{line}: {found:?}"
        );
        assert!(
            (found.1 - back).abs() <= tolerance * back,
            "{line}: {found:?}"
        );
        count += 1;
    }
    assert_eq!(count, 3 * mechanism.steps().len(), "{name}");
}

#[test]
fn the_four_steps_from_cantera_s_file_run_as_in_cantera() {
    let path = folder("coupler/physics/tests/reference/jones-lindstedt.yaml");
    let file = read(&path, None).unwrap();
    assert_eq!(file.thermo.len(), 7);
    as_cantera(&file.over(&gas()).unwrap(), "jones-lindstedt", 1e-4);
}

#[test]
fn every_kind_of_reaction_that_is_read_runs_as_in_cantera() {
    let path = folder("coupler/physics/tests/reference/kinds.yaml");
    let file = read(&path, None).unwrap();
    as_cantera(&file.over(&gas()).unwrap(), "kinds", 2e-4);
}

#[test]
fn the_same_kinds_in_chemkin_s_form_run_as_in_cantera() {
    let text = "
SPECIES
N2 O2 CO2 H2O CO H2 CH4
END
REACTIONS   CAL/MOLE MOLES
2H2+O2=>2H2O            3.0E13 -0.5 2.5E4   ! orders of its own
   FORD/H2 1.0/ FORD/O2 0.5/
CO+H2O<=>CO2+H2         2.75E12 0.2 20076.4818
2 CO + O2 + M = 2 CO2 + M   1.2D+17 -0.7 3.0E4
   H2O/6.0/ CO2/2.0/ H2/0.0/
CH4+H2O(+M)=CO+3H2(+M)  4.0E14 0.1 5.5E4
   LOW / 1.0E20 -1.0 5.0E4 /
   H2O/6.0/
CH4+CO2(+M)<=>2CO+2H2(+M)  13.9E15 -0.534 536
   LOW/2.62E33 -4.76 2440/ TROE/0.783 74 2941 6964/ CH4/3/
CO2+H2(+M)=>CO+H2O(+M)  1.0E14 0 4.0E4
   LOW/1.0E24 -2.0 3.0E4/
   TROE/0.6 100. 2000./
END
";
    let file = parse(Path::new("kinds.inp"), text).unwrap();
    as_cantera(&file.over(&gas()).unwrap(), "kinds", 2e-4);
}

#[test]
fn chemkin_s_thermodynamics_are_those_of_the_same_table() {
    let thermo = folder("tests/inputs/good/four-steps-thermo.dat");
    let file = read(&folder("tests/inputs/good/four-steps.inp"), Some(&thermo)).unwrap();
    assert_eq!(file.thermo.len(), 7);
    for stated in &file.thermo {
        let gas = gas();
        let own = gas
            .species()
            .iter()
            .find(|one| one.name() == stated.name)
            .unwrap();
        assert_eq!(stated.atoms, *own.atoms());
        for t in [300.0, 900.0, 2000.0] {
            let [here, there] = [stated.polynomial, *own.polynomial()];
            assert!(
                (here.enthalpy(t) - there.enthalpy(t)).abs() < 0.01,
                "{} {t}",
                stated.name
            );
            // Of 1 atm in place of 1 bar.
            let shift = 8.314_462_618 * 1.013_25_f64.ln();
            let entropy = here.entropy(t) - shift;
            assert!(
                (entropy - there.entropy(t)).abs() < 1e-5,
                "{} {t}",
                stated.name
            );
        }
    }
    as_cantera(&file.over(&gas()).unwrap(), "jones-lindstedt", 2e-4);
}

#[test]
fn a_name_that_reads_as_no_elsewhere_is_a_species() {
    let text = "
species:
- name: NO
  composition: {N: 1, O: 1}
  thermo: {model: NASA7, temperature-ranges: [200, 1000, 6000], data: [[3, 0, 0, 0, 0, 1e4, 5], [3, 0, 0, 0, 0, 1e4, 5]]}
- name: HE
  composition: {He: 1}
  thermo: {model: NASA7, temperature-ranges: [200, 6000], data: [[2.5, 0, 0, 0, 0, 0, 5]]}
";
    let file = parse(Path::new("a.yaml"), text).unwrap();
    let names: Vec<&str> = file.thermo.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["NO"], "helium is of no element here");
}

#[test]
fn what_of_cantera_s_is_not_read_is_refused_by_file_line_and_name() {
    let reaction = "- equation: CO + H2O <=> CO2 + H2\n  rate-constant: {A: 1, b: 0, Ea: 0}\n";
    let mut twice = String::from("reactions:\n");
    let _ = write!(twice, "{reaction}{reaction}");
    let mut wrong = Vec::new();
    for (text, expected) in [
        ("reactions: [\n", "a.yaml:2: no YAML"),
        ("", "a.yaml: has no content"),
        (
            "reactions:\n- equation: CO + H2O\n",
            "a.yaml:2: \"CO + H2O\" is no equation: it has no arrow",
        ),
        (
            "reactions:\n- equation: A => B\n  type: Chebyshev\n",
            "a.yaml:2: A => B is of the type Chebyshev, which is not read",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  Blowers-Masel: 3\n",
            "a.yaml:4: Blowers-Masel of A => B is not read",
        ),
        (
            "reactions:\n- equation: A => B\n",
            "a.yaml:2: A => B has no rate-constant",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: -1, b: 0, Ea: 0}\n",
            "a.yaml:2: A => B has a negative A without negative-A",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: many, b: 0, Ea: 0}\n",
            "a.yaml:3: A is \"many\", which is not a number",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: 1, b: 0, Ea: 3 erg/mol}\n",
            "a.yaml:3: Ea in erg/mol is not read",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  orders: {A: -1}\n",
            "a.yaml:4: A => B has the order -1 of A without negative-orders",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  orders: {C: 1}\n",
            "a.yaml:4: A => B has an order of C, which does not react, without nonreactant-orders",
        ),
        (
            "reactions:\n- equation: A <=> B\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  orders: {A: 2}\n",
            "a.yaml:4: A <=> B goes both ways and has orders, whose way back is not defined",
        ),
        (
            "reactions:\n- equation: A (+M) <=> B (+M)\n  rate-constant: {A: 1, b: 0, Ea: 0}\n",
            "a.yaml:2: A (+M) <=> B (+M) is a falloff in one of its type and equation only",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  Troe: {A: 1, T3: 1, T1: 1}\n",
            "a.yaml:4: Troe of A => B is not read",
        ),
        (
            "reactions:\n- equation: A + M => B + M\n  rate-constant: {A: 1, b: 0, Ea: 0}\n  low-P-rate-constant: {A: 1, b: 0, Ea: 0}\n",
            "a.yaml:4: low-P-rate-constant of A + M => B + M is not read",
        ),
        (
            "reactions:\n- equation: A (+M) => B (+M)\n  type: falloff\n  rate-constant: {A: 1, b: 0, Ea: 0}\n",
            "a.yaml:4: rate-constant of A (+M) => B (+M) is not read",
        ),
        (
            "reactions:\n- equation: A (+H2O) => B (+H2O)\n  type: falloff\n  high-P-rate-constant: [1, 0, 0]\n  low-P-rate-constant: [1, 0, 0]\n  efficiencies: {H2: 2}\n",
            "a.yaml:6: A (+H2O) => B (+H2O) has efficiencies beside (+H2O)",
        ),
        (
            "reactions:\n- equation: A => B\n  rate-constant: [1, 0, 0]\n  default-efficiency: 0\n",
            "a.yaml:4: A => B has efficiencies but no M",
        ),
        (
            "reactions:\n- {equation: 2 A + B => C, rate-constant: [1, 0, 0]}\n- {equation: B + 2 A => C, rate-constant: [2, 0, 0]}\n",
            "a.yaml:3: B + 2 A => C stands in line 2 too",
        ),
        (
            "units: {length: ft}\n",
            "a.yaml:1: units: length in ft is not read",
        ),
        (
            "species:\n- name: X\n  composition: {H: 1}\n  thermo: {model: NASA9}\n",
            "a.yaml:4: X has a thermo model NASA9, which is not read; NASA7 is",
        ),
        (
            twice.as_str(),
            "a.yaml:4: CO + H2O <=> CO2 + H2 stands in line 2 too",
        ),
    ] {
        let message = parse(Path::new("a.yaml"), text).unwrap_err().to_string();
        if !message.starts_with(expected) {
            wrong.push(format!("{message}\nfor {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_of_chemkin_s_is_not_read_is_refused_by_file_line_and_name() {
    let mut wrong = Vec::new();
    for (text, expected) in [
        (
            "REACTIONS\nA=>B 1 0\n",
            "a.inp:2: \"A=>B 1 0\" does not end in three numbers",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nREV/1 0 0/\n",
            "a.inp:3: REV of A=>B is not read",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nPLOG/1 1 0 0/\n",
            "a.inp:3: PLOG of A=>B is not read",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nLOW/1 0 0/\n",
            "a.inp:2: A=>B has LOW but no (+M)",
        ),
        (
            "REACTIONS\nA(+M)=>B(+M) 1 0 0\n",
            "a.inp:2: A(+M)=>B(+M) has (+M) but no LOW",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nB/2/\n",
            "a.inp:2: A=>B has efficiencies but no M",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nTROE/0.6 100 2000/\n",
            "a.inp:2: A=>B has TROE but no (+M)",
        ),
        (
            "REACTIONS\nA+M=>B+M 1 0 0\nTROE/0.6 100 2000/\n",
            "a.inp:2: A+M=>B+M has TROE but no (+M)",
        ),
        (
            "REACTIONS\nA(+M)=>B(+M) 1 0 0\nLOW/1 0 0/\nTROE/0.6 100 2000/ TROE/0.5 100 2000/\n",
            "a.inp:4: A(+M)=>B(+M) has TROE twice",
        ),
        (
            "REACTIONS\nA(+M)=>B(+M) 1 0 0\nLOW/1 0 0/\nLOW/2 0 0/\n",
            "a.inp:4: A(+M)=>B(+M) has LOW twice",
        ),
        (
            "REACTIONS\nA(+H2O)=>B(+H2O) 1 0 0\nLOW/1 0 0/ H2/2/\n",
            "a.inp:2: A(+H2O)=>B(+H2O) has efficiencies beside (+H2O)",
        ),
        (
            "REACTIONS\nH+O2+M=>HO2+M 1 0 0\nO2+H+M=>HO2+M 2 0 0\n",
            "a.inp:3: O2+H+M=>HO2+M stands in line 2 too",
        ),
        (
            "REACTIONS\nA<=>B 1 0 0\nFORD/A 2/\n",
            "a.inp:2: A<=>B goes both ways and has FORD",
        ),
        (
            "REACTIONS\nA=>B -1 0 0\n",
            "a.inp:2: A=>B has a negative A and is no DUPLICATE",
        ),
        (
            "REACTIONS ERGS/MOLE\n",
            "a.inp:1: the unit ERGS/MOLE of REACTIONS is not read",
        ),
        (
            "A => B 1 0 0\n",
            "a.inp:1: \"A => B 1 0 0\" is in no section",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nA=>B 2 0 0\n",
            "a.inp:3: A=>B stands in line 2 too",
        ),
        (
            "REACTIONS\nA<=>B 1 0 0\nB<=>A 2 0 0\n",
            "a.inp:3: B<=>A stands in line 2 too",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nA=B 2 0 0\n",
            "a.inp:3: A=B stands in line 2 too",
        ),
        (
            "REACTIONS\nA=>B 1 0 0\nDUP\nA=>C 2 0 0\n",
            "a.inp:2: A=>B says that it is a duplicate, but no other reaction",
        ),
        (
            "REACTIONS\nA=>B 1 0 0 300\n",
            "a.inp:2: \"A=>B 1 0 0 300\" has more than three numbers A, b, E",
        ),
        ("THERMO\nX\nEND\n", "a.inp:2: a species has not four lines"),
        ("TRANSPORT\n", "a.inp:1: a section TRANSPORT is not read"),
    ] {
        let message = parse(Path::new("a.inp"), text).unwrap_err().to_string();
        if !message.starts_with(expected) {
            wrong.push(format!("{message}\nfor {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for two in [
        "REACTIONS\nA=>B 1 0 0\nDUP\nA=>B 2 0 0\nDUPLICATE\n",
        // The two ways of one equation.
        "REACTIONS\nA=>B 1 0 0\nB=>A 2 0 0\n",
        // One falloff by all gases, one by argon alone.
        "REACTIONS\nA(+M)=>B(+M) 1 0 0\nLOW/1 0 0/\nA(+AR)=>B(+AR) 1 0 0\nLOW/2 0 0/\n",
    ] {
        assert_eq!(parse(Path::new("a.inp"), two).unwrap().reactions.len(), 2);
    }
}

#[test]
fn t2_of_zero_leaves_its_term_of_troe_out_in_both_formats() {
    let chemkin = "REACTIONS\nA(+M)=>B(+M) 1 0 0\nLOW/1 0 0/ TROE/0.6 100 2000 0/\n";
    let cantera = "reactions:\n- equation: A (+M) => B (+M)\n  type: falloff\n  high-P-rate-constant: [1, 0, 0]\n  \
                   low-P-rate-constant: [1, 0, 0]\n  Troe: {A: 0.6, T3: 100, T1: 2000, T2: 0}\n";
    for (name, text) in [("a.inp", chemkin), ("a.yaml", cantera)] {
        let file = parse(Path::new(name), text).unwrap();
        let RateConstant::Falloff { broadening, .. } = file.reactions[0].statement.rate else {
            panic!("{name}")
        };
        let without = Broadening::Troe {
            share: 0.6,
            third: 100.0,
            first: 2000.0,
            second: None,
        };
        assert_eq!(broadening, without, "{name}");
    }
}

#[test]
fn a_negative_efficiency_of_a_file_is_refused_by_its_line() {
    let text = "REACTIONS\n2H2+O2=>2H2O 1 0 0\nCO+H2O+M=>CO2+H2+M 1 0 0\nH2/-2/\n";
    let file = parse(Path::new("a.inp"), text).unwrap();
    let message = file.over(&gas()).unwrap_err().to_string();
    let expected = "a.inp:3: CO+H2O+M=>CO2+H2+M: an efficiency is -2, ";
    assert!(message.starts_with(expected), "{message}");
}

#[test]
fn a_mechanism_over_the_wrong_gas_names_the_line() {
    let text =
        "reactions:\n- equation: CO + H2O <=> CO2 + H2\n  rate-constant: {A: 1, b: 0, Ea: 0}\n";
    let file = parse(Path::new("a.yaml"), text).unwrap();
    let few = Mixture::new(["CO", "H2O", "CO2", "N2"]).unwrap();
    let message = file.over(&few).unwrap_err().to_string();
    assert!(
        message.starts_with("a.yaml:2: CO + H2O <=> CO2 + H2 names H2"),
        "{message}"
    );
    let none = parse(Path::new("a.yaml"), "units: {}\n").unwrap();
    assert!(
        none.over(&gas())
            .unwrap_err()
            .to_string()
            .contains("has no reactions")
    );
}

/// A text with some of its characters replaced, doubled or cut.
fn mutate(text: &str, changes: &[(usize, u8, char)]) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for &(place, kind, letter) in changes {
        let place = place % letters.len().max(1);
        match kind % 4 {
            0 if place < letters.len() => letters[place] = letter,
            1 => letters.insert(place, letter),
            2 if place < letters.len() => {
                letters.remove(place);
            }
            _ => letters.truncate(place + 200),
        }
    }
    letters.into_iter().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn a_file_with_slips_is_read_or_refused_by_its_name(
        changes in proptest::collection::vec((0usize..6000, any::<u8>(), "[-/+=()!:{}MA0-9 \n]"), 1..6),
    ) {
        let changes: Vec<(usize, u8, char)> =
            changes.iter().map(|(p, k, c)| (*p, *k, c.chars().next().unwrap())).collect();
        for name in [
            "coupler/physics/tests/reference/kinds.yaml",
            "tests/inputs/good/four-steps.inp",
        ] {
            let path = folder(name);
            let text = mutate(&std::fs::read_to_string(&path).unwrap(), &changes);
            let read = parse(&path, &text).and_then(|file| file.over(&gas()));
            if let Err(error) = read {
                prop_assert!(error.to_string().contains(name));
            }
        }
        let path = folder("tests/inputs/good/four-steps-thermo.dat");
        let text = mutate(&std::fs::read_to_string(&path).unwrap(), &changes);
        let _ = chemkin_thermo::parse(&text, None);
    }
}

#[test]
fn exponents_of_yaml_may_follow_d() {
    let factor = |a: &str| {
        let text = format!("reactions:\n- equation: A => B\n  rate-constant: [{a}, 0, 2D3 K]\n");
        let file = parse(Path::new("a.yaml"), &text).unwrap();
        file.reactions[0].statement.rate
    };
    assert_eq!(factor("1.5D+13"), factor("1.5e13"));
}
