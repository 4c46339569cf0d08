//! The catalogue of columns that the handshake fixes, so that more species or shells are more lines
//! of a catalogue and never another protocol.

use std::fmt;
use std::str::FromStr;

use crate::column_set::ColumnSet;
use crate::columns::{self, ColumnPresence, ProtocolColumn};
use crate::error::WireError;

/// Words (of 8 bytes) in the alignment of a column: 64 bytes.
const COLUMN_WORDS: usize = 8;

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
            "committed" => ColumnSet::Committed,
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

impl Catalogue {
    /// The columns of a table that a link of so many species has.
    fn of_table(
        table: &[ProtocolColumn],
        species: usize,
        has: impl Fn(ColumnPresence) -> bool,
    ) -> Self {
        let kept = table.iter().filter(|column| has(column.presence));
        let fields = kept.map(|column| Field {
            record: column.record,
            name: column.name.into(),
            components: column.components.count(species),
            unit: column.unit.into(),
            per_item: column.per_item,
        });
        Self {
            fields: fields.collect(),
        }
    }

    /// The standard catalogue of a role, "gas" (a single gas, laminar) or "particles".
    pub fn standard(role: &str) -> Result<Self, WireError> {
        match role {
            "gas" => Ok(Self::gas(0, false)),
            "particles" => Ok(Self::particles(&[])),
            _ => Err(WireError::Role { role: role.into() }),
        }
    }

    /// That of a gas of so many species (0: a single gas), turbulent or not.
    pub fn gas(species: usize, turbulent: bool) -> Self {
        Self::of_table(columns::GAS, species, |presence| match presence {
            ColumnPresence::Always => true,
            ColumnPresence::Species => species > 0,
            ColumnPresence::Turbulent => turbulent,
            ColumnPresence::ForeignInputs
            | ColumnPresence::BedEddies
            | ColumnPresence::TurbulenceReport
            | ColumnPresence::BackflowReport
            | ColumnPresence::PatchReport
            | ColumnPresence::MovingDrag
            | ColumnPresence::Weights => false,
        })
    }

    /// The same catalogue with what a gas says of its cells where no hash of the mesh is compared.
    pub fn with_geometry(mut self) -> Self {
        let own = |presence| presence == ColumnPresence::ForeignInputs;
        let geometry = Self::of_table(columns::GAS, 0, own);
        self.fields.extend(geometry.fields);
        self
    }

    /// The same catalogue with what particles make of eddies of the gas.
    pub fn with_bed_eddies(mut self) -> Self {
        let own = |presence| presence == ColumnPresence::BedEddies;
        self.fields
            .extend(Self::of_table(columns::GAS, 0, own).fields);
        self
    }

    /// The column of a gas that answers commits with how its equations of turbulence were solved.
    pub fn turbulence_report() -> Vec<Field> {
        let own = |presence| presence == ColumnPresence::TurbulenceReport;
        Self::of_table(columns::GAS, 0, own).fields
    }

    /// The same catalogue with that column.
    pub fn with_turbulence_report(mut self) -> Self {
        self.fields.extend(Self::turbulence_report());
        self
    }

    /// The column of a gas that says what comes back in through outlets.
    pub fn backflow_report() -> Vec<Field> {
        let own = |presence| presence == ColumnPresence::BackflowReport;
        Self::of_table(columns::GAS, 0, own).fields
    }

    /// The same catalogue with that column.
    pub fn with_backflow_report(mut self) -> Self {
        self.fields.extend(Self::backflow_report());
        self
    }

    /// The column of a gas of so many species that says what passes so many patches; none without patches.
    pub fn patch_report(species: usize, patches: usize) -> Vec<Field> {
        let own = |presence| presence == ColumnPresence::PatchReport;
        let mut fields = Self::of_table(columns::GAS, species, own).fields;
        fields
            .iter_mut()
            .for_each(|field| field.components *= patches);
        fields.retain(|field| field.components > 0);
        fields
    }

    /// The same catalogue with that column.
    pub fn with_patch_report(mut self, species: usize, patches: usize) -> Self {
        self.fields.extend(Self::patch_report(species, patches));
        self
    }

    /// That of particles, with further columns that are pushed or received.
    pub fn particles(further: &[Field]) -> Self {
        let own = |presence| presence == ColumnPresence::Always;
        let mut particles = Self::of_table(columns::PARTICLES, 0, own);
        particles.fields.extend_from_slice(further);
        particles
    }

    /// The same with the groups of columns that the coordinator knows.
    pub fn particles_with(weights: bool, moving_drag: bool) -> Self {
        let groups = [
            (weights, Self::weights()),
            (moving_drag, Self::moving_drag()),
        ];
        let further = groups.into_iter().filter(|(has, _)| *has);
        Self::particles(&further.flat_map(|(_, group)| group).collect::<Vec<_>>())
    }

    /// The columns of drag that particles evaluate as they move: a coefficient, the gas' velocity, and its impulse.
    pub fn moving_drag() -> Vec<Field> {
        let own = |presence| presence == ColumnPresence::MovingDrag;
        Self::of_table(columns::PARTICLES, 0, own).fields
    }

    /// The column of rows that stand for several real particles.
    pub fn weights() -> Vec<Field> {
        let own = |presence| presence == ColumnPresence::Weights;
        Self::of_table(columns::PARTICLES, 0, own).fields
    }

    /// A catalogue by its lines: columns as they are written, or names of groups of columns: `standard` (those that all
    /// links of the role have), `moving_drag` and `weights` (of particles).
    pub fn of_lines(role: &str, text: &str) -> Result<Self, WireError> {
        let mut fields = Vec::new();
        for line in text.lines() {
            match line.trim() {
                "standard" => fields.extend(Self::standard(role)?.fields),
                "moving_drag" => fields.extend(Self::moving_drag()),
                "weights" => fields.extend(Self::weights()),
                line => fields.push(line.parse()?),
            }
        }
        Ok(Self { fields })
    }

    /// With those of another catalogue's columns that are among these and not here yet.
    pub fn with_further(mut self, theirs: &Catalogue, among: &[Field]) -> Self {
        let further = theirs.fields.iter().filter(|field| among.contains(field));
        let new: Vec<Field> = further
            .filter(|field| !self.fields.contains(field))
            .cloned()
            .collect();
        self.fields.extend(new);
        self
    }

    /// Columns of numbers for each particle that messages of a kind carry beyond those that the coordinator knows itself.
    pub fn further(&self, record: ColumnSet) -> impl Iterator<Item = &Field> {
        let own = Self::particles(&Self::weights());
        self.of(record).filter(move |field| {
            field.per_item && field.unit != "u64" && !own.fields.contains(field)
        })
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

    /// True where a record has a column of a name.
    pub fn has(&self, record: ColumnSet, name: &str) -> bool {
        self.of(record).any(|field| field.name == name)
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
        let gas = Catalogue::gas(3, false);
        let length = |name| gas.column(ColumnSet::State, name, 12).unwrap().1.len();
        assert_eq!(length("composition"), 36);
        assert_eq!(length("balances"), 35 + 21);
        let single = Catalogue::standard("gas").unwrap();
        assert_eq!(Catalogue::gas(0, false), single);
        let turbulent = Catalogue::gas(0, true);
        assert_eq!(turbulent.fields().len(), single.fields().len() + 3);
    }

    #[test]
    fn cells_are_told_by_their_geometry_where_no_hash_of_the_mesh_is_compared() {
        let gas = Catalogue::gas(0, false).with_geometry();
        let length = |name| gas.column(ColumnSet::Owned, name, 4).unwrap().1.len();
        assert_eq!(
            (length("cell"), length("centre"), length("volume")),
            (4, 12, 4)
        );
    }

    #[test]
    fn particles_may_have_further_columns_both_ways() {
        let mut further = Catalogue::moving_drag();
        further.push("state film 1 m item".parse().unwrap());
        let particles = Catalogue::particles(&further);
        assert!(
            particles
                .column(ColumnSet::Start, "gas_velocity", 2)
                .is_ok()
        );
        assert!(particles.column(ColumnSet::State, "film", 2).is_ok());
        assert_eq!(
            particles.to_string().parse::<Catalogue>().unwrap(),
            particles
        );
    }

    #[test]
    fn groups_of_columns_are_told_by_their_names() {
        let told = Catalogue::of_lines("particles", "standard\nmoving_drag\nstate film 1 m item\n");
        let mut further = Catalogue::moving_drag();
        further.push("state film 1 m item".parse().unwrap());
        assert_eq!(told.unwrap(), Catalogue::particles(&further));
        assert!(Catalogue::of_lines("particles", "usual").is_err());
    }

    #[test]
    fn what_the_other_end_offers_is_taken_up_where_it_is_known() {
        let mut offered = Catalogue::moving_drag();
        offered.push("state film 1 m item".parse().unwrap());
        let theirs = Catalogue::particles(&offered);
        let ours = Catalogue::particles(&[]).with_further(&theirs, &Catalogue::moving_drag());
        assert_eq!(ours, Catalogue::particles(&Catalogue::moving_drag()));
        let names = |record| ours.further(record).map(|field| field.name.clone());
        assert_eq!(
            names(ColumnSet::Start).collect::<Vec<_>>(),
            ["drag_coefficient", "gas_velocity"]
        );
        assert_eq!(
            names(ColumnSet::State).collect::<Vec<_>>(),
            ["drag_impulse"]
        );
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
