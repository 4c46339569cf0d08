//! The catalogue of columns that the handshake fixes, so that more species or shells are more lines
//! of a catalogue and never another protocol.

use std::fmt;
use std::str::FromStr;

use crate::record::MessageKind;
use crate::transport::WireError;

/// Words (of 8 bytes) in the alignment of a column: 64 bytes.
const COLUMN_WORDS: usize = 8;

/// Which message carries a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnSet {
    /// `Start`, from the coordinator.
    Start,
    /// `State`, `Finished`, `Checkpointed`, from the solver.
    State,
    /// `Owned`, from a gas.
    Owned,
}

impl ColumnSet {
    /// The record that a kind of message carries, if it carries columns.
    pub fn of(kind: MessageKind) -> Option<ColumnSet> {
        match kind {
            MessageKind::Start => Some(ColumnSet::Start),
            MessageKind::State
            | MessageKind::Finished
            | MessageKind::Checkpointed
            | MessageKind::Changed => Some(ColumnSet::State),
            MessageKind::Owned => Some(ColumnSet::Owned),
            MessageKind::Hello
            | MessageKind::Commit
            | MessageKind::Checkpoint
            | MessageKind::Change
            | MessageKind::Boundary
            | MessageKind::Failed
            | MessageKind::Bye => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            ColumnSet::Start => "start",
            ColumnSet::State => "state",
            ColumnSet::Owned => "owned",
        }
    }
}

/// One column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Which message carries it.
    pub record: ColumnSet,
    /// Its name, without spaces.
    pub name: String,
    /// Components of an item; interleaved.
    pub components: usize,
    /// Unit in SI; "u64" for integers.
    pub unit: String,
    /// One item per cell or particle, or one for the whole rank.
    pub per_item: bool,
}

impl Field {
    fn words(&self, count: usize) -> usize {
        self.components * if self.per_item { count } else { 1 }
    }
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let extent = if self.per_item { "item" } else { "rank" };
        let (record, name) = (self.record.name(), &self.name);
        write!(
            f,
            "{record} {name} {} {} {extent}",
            self.components, self.unit
        )
    }
}

impl FromStr for Field {
    type Err = WireError;

    fn from_str(line: &str) -> Result<Self, WireError> {
        let refuse = || WireError::Catalogue { line: line.into() };
        let mut words = line.split_ascii_whitespace();
        let mut next = || words.next().ok_or_else(refuse);
        let record = match next()? {
            "start" => ColumnSet::Start,
            "state" => ColumnSet::State,
            "owned" => ColumnSet::Owned,
            _ => return Err(refuse()),
        };
        let name = next()?.to_owned();
        let components = next()?.parse().map_err(|_| refuse())?;
        let unit = next()?.to_owned();
        let per_item = match next()? {
            "item" => true,
            "rank" => false,
            _ => return Err(refuse()),
        };
        if components == 0 || words.next().is_some() {
            return Err(refuse());
        }
        Ok(Field {
            record,
            name,
            components,
            unit,
            per_item,
        })
    }
}

/// The columns of all messages of a link, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Catalogue {
    fields: Vec<Field>,
}

/// The standard catalogue of a gas; one value per cell, signs as in the coordinator's exchange.
const GAS: &str = "\
owned cell 1 u64 item
start void_fraction 1 1 item
start drag_coefficient 1 kg/s item
start drag_source 3 N item
start heat_coefficient 1 W/K item
start heat_source 1 W item
state heat 1 W item
state drag 3 N item
state temperature 1 K item
state pressure 1 Pa item
state density 1 kg/m^3 item
state velocity 3 m/s item
state pressure_gradient 3 Pa/m item
state balances 35 kg,J,Ns rank
state storage_clock 3 Ns rank
state convergence 5 1 rank";

/// The standard catalogue of particles, in ascending id.
const PARTICLES: &str = "\
start id 1 u64 item
start force 3 N item
state id 1 u64 item
state population 1 u64 item
state position 3 m item
state velocity 3 m/s item
state angular_velocity 3 rad/s item
state radius 1 m item
state mass 1 kg item
state impulse 3 Ns item
state support 4 s,Ns rank";

impl Catalogue {
    /// The standard catalogue of a role, "gas" or "particles".
    pub fn standard(role: &str) -> Result<Self, WireError> {
        match role {
            "gas" => GAS.parse(),
            "particles" => PARTICLES.parse(),
            _ => Err(WireError::Role { role: role.into() }),
        }
    }

    /// That of a gas of so many species (0: a single gas): the standard one with the composition, species by
    /// species within each cell, what particles exchange of it, and a balance of each species after the momentum's.
    /// That of a turbulent gas has the eddies too.
    pub fn gas(species: usize, turbulent: bool) -> Result<Self, WireError> {
        let mut gas = Self::standard("gas")?;
        if species > 0 {
            for field in &mut gas.fields {
                if field.name == "balances" {
                    field.components += 7 * species;
                }
            }
            for line in [
                format!("state composition {species} 1 item"),
                format!("start species_source {species} kg/s item"),
                format!("start species_coefficient {species} kg/s item"),
                format!("start species_taken {species} kg/s item"),
                "start species_heat 1 W item".into(),
            ] {
                gas.fields.push(line.parse()?);
            }
        }
        if turbulent {
            for line in [
                "state turbulent_energy 1 m^2/s^2 item",
                "state dissipation 1 m^2/s^3 item",
                "state eddy_viscosity 1 Pas item",
            ] {
                gas.fields.push(line.parse()?);
            }
        }
        Ok(gas)
    }

    /// The fields, in the order of the columns.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Fields of a record.
    pub fn of(&self, record: ColumnSet) -> impl Iterator<Item = &Field> {
        self.fields
            .iter()
            .filter(move |field| field.record == record)
    }

    /// Words of a record's payload for `count` items, every column 64-byte aligned; `None` where
    /// that many do not fit a number.
    pub fn words(&self, record: ColumnSet, count: usize) -> Option<usize> {
        self.of(record).try_fold(0usize, |sum, field| {
            let items = if field.per_item { count } else { 1 };
            let words = field.components.checked_mul(items)?;
            sum.checked_add(words.checked_next_multiple_of(COLUMN_WORDS)?)
        })
    }

    /// Index within the record, and words, of a column for `count` items.
    pub fn column(
        &self,
        record: ColumnSet,
        name: &str,
        count: usize,
    ) -> Result<(usize, std::ops::Range<usize>), WireError> {
        let mut start = 0;
        for (index, field) in self.of(record).enumerate() {
            let words = field.words(count);
            if field.name == name {
                return Ok((index, start..start + words));
            }
            start += words.next_multiple_of(COLUMN_WORDS);
        }
        Err(WireError::NoColumn {
            name: name.into(),
            record: record.name(),
        })
    }
}

impl fmt::Display for Catalogue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, field) in self.fields.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{field}")?;
        }
        Ok(())
    }
}

impl FromStr for Catalogue {
    type Err = WireError;

    fn from_str(text: &str) -> Result<Self, WireError> {
        let fields = text.lines().map(str::parse).collect::<Result<_, _>>()?;
        Ok(Self { fields })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_catalogue_survives_its_text() {
        for role in ["gas", "particles"] {
            let catalogue = Catalogue::standard(role).unwrap();
            assert_eq!(
                catalogue.to_string().parse::<Catalogue>().unwrap(),
                catalogue
            );
        }
    }

    #[test]
    fn the_gas_sends_a_heat_first_and_five_balances_of_seven_numbers() {
        let gas = Catalogue::standard("gas").unwrap();
        assert_eq!(
            gas.column(ColumnSet::State, "heat", 12).unwrap(),
            (0, 0..12)
        );
        // 12 heats take 16 words, 12 drags 40, then the temperatures.
        assert_eq!(
            gas.column(ColumnSet::State, "temperature", 12).unwrap(),
            (2, 56..68)
        );
        assert_eq!(
            gas.column(ColumnSet::State, "balances", 12)
                .unwrap()
                .1
                .len(),
            35
        );
        assert_eq!(
            gas.words(ColumnSet::Start, 12),
            Some(16 + 16 + 40 + 16 + 16)
        );
    }

    #[test]
    fn species_add_a_column_of_mass_fractions_and_a_balance_each() {
        let gas = Catalogue::gas(3, false).unwrap();
        let length = |name| gas.column(ColumnSet::State, name, 12).unwrap().1.len();
        assert_eq!(length("composition"), 36);
        assert_eq!(length("balances"), 35 + 21);
        let single = Catalogue::standard("gas").unwrap();
        assert_eq!(Catalogue::gas(0, false).unwrap(), single);
        let turbulent = Catalogue::gas(0, true).unwrap();
        assert_eq!(turbulent.fields().len(), single.fields().len() + 3);
    }

    #[test]
    fn a_malformed_line_is_refused_with_the_line() {
        for line in [
            "",
            "start x 1 K",
            "begin x 1 K item",
            "state x 0 K item",
            "state x 1 K cell",
        ] {
            let error = line.parse::<Field>().unwrap_err();
            assert!(error.to_string().contains(line), "{error}");
        }
        assert!(Catalogue::standard("plasma").is_err());
    }

    #[test]
    fn a_count_beyond_memory_is_not_a_size() {
        let gas = Catalogue::standard("gas").unwrap();
        assert_eq!(gas.words(ColumnSet::State, usize::MAX), None);
    }

    proptest! {
        #[test]
        fn columns_are_aligned_and_never_overlap(count in 0usize..1000) {
            let gas = Catalogue::standard("gas").unwrap();
            let mut end = 0;
            for field in gas.of(ColumnSet::State) {
                let (_, range) = gas.column(ColumnSet::State, &field.name, count).unwrap();
                prop_assert_eq!(range.start % 8, 0);
                prop_assert!(range.start >= end);
                end = range.end;
            }
            prop_assert!(gas.words(ColumnSet::State, count).unwrap() >= end);
        }
    }
}
