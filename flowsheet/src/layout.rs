//! What a stream is made of: a row of extensive numbers whose places the layout gives.

use crate::sums::{add_in_turns, sum};
use crate::{PlantError, SizeGrid};

/// Temperature of zero sensible enthalpy in K.
pub const REFERENCE_TEMPERATURE: f64 = 273.15;

/// A compound. It may occur in each of the three phases; its heat capacities do not depend on temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Compound {
    /// Name.
    pub name: String,
    /// True where it leaves a dryer or a granulator as vapour; what is not volatile is deposited there.
    pub volatile: bool,
    /// Heat capacity of the solid in J/kg/K.
    pub solid_heat_capacity: f64,
    /// Heat capacity of the liquid in J/kg/K.
    pub liquid_heat_capacity: f64,
    /// Heat capacity of the vapour in J/kg/K.
    pub vapour_heat_capacity: f64,
    /// Heat of evaporation at the reference temperature in J/kg.
    pub evaporation_heat: f64,
}

/// A secondary attribute of particles (colour, moisture class, porosity class): its name and how many classes it has.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name.
    pub name: String,
    /// Number of classes.
    pub classes: usize,
}

/// What all streams of a plant are made of. A stream is a row of extensive numbers, so that mixing adds:
///
/// - solids in kg/s by size class, then attribute classes (the last attribute runs fastest), then compound;
/// - liquids in kg/s by compound; vapours in kg/s by compound;
/// - the enthalpy flow in W.
///
/// What a unit holds has the same places, in kg and J.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamLayout {
    grid: SizeGrid,
    attributes: Vec<Attribute>,
    compounds: Vec<Compound>,
    inner: usize,
}

impl StreamLayout {
    /// A layout of size classes, secondary attributes and compounds.
    pub fn new(
        grid: SizeGrid,
        attributes: Vec<Attribute>,
        compounds: Vec<Compound>,
    ) -> Result<Self, PlantError> {
        let value = |place: &str, quantity, value, allowed| PlantError::Value {
            place: place.to_owned(),
            quantity,
            value,
            allowed,
        };
        if compounds.is_empty() {
            return Err(value(
                "plant",
                "number of compounds",
                0.0,
                "give one at least",
            ));
        }
        for attribute in &attributes {
            if attribute.classes == 0 {
                let place = format!("attribute \"{}\"", attribute.name);
                return Err(value(&place, "number of classes", 0.0, "give one at least"));
            }
        }
        for compound in &compounds {
            for (quantity, number) in [
                ("heat capacity of the solid", compound.solid_heat_capacity),
                ("heat capacity of the liquid", compound.liquid_heat_capacity),
                ("heat capacity of the vapour", compound.vapour_heat_capacity),
                ("heat of evaporation", compound.evaporation_heat),
            ] {
                if !(number.is_finite() && number >= 0.0) {
                    let place = format!("compound \"{}\"", compound.name);
                    return Err(value(&place, quantity, number, "it is positive and finite"));
                }
            }
        }
        let cells: usize = attributes.iter().map(|a| a.classes).product();
        let inner = cells * compounds.len();
        Ok(Self {
            grid,
            attributes,
            compounds,
            inner,
        })
    }

    /// Size classes.
    pub fn grid(&self) -> &SizeGrid {
        &self.grid
    }

    /// Secondary attributes.
    pub fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }

    /// Compounds.
    pub fn compounds(&self) -> &[Compound] {
        &self.compounds
    }

    /// Numbers of each size class: attribute classes times compounds.
    pub fn inner(&self) -> usize {
        self.inner
    }

    /// How many numbers the solids have.
    pub fn solids(&self) -> usize {
        self.grid.classes() * self.inner
    }

    /// How many numbers a stream has.
    pub fn width(&self) -> usize {
        self.solids() + 2 * self.compounds.len() + 1
    }

    /// Place of a liquid.
    pub fn liquid(&self, compound: usize) -> usize {
        self.solids() + compound
    }

    /// Place of a vapour.
    pub fn vapour(&self, compound: usize) -> usize {
        self.solids() + self.compounds.len() + compound
    }

    /// Place of the enthalpy.
    pub fn enthalpy(&self) -> usize {
        self.width() - 1
    }

    /// Solids of a stream in kg/s.
    pub fn solid_flow(&self, stream: &[f64]) -> f64 {
        sum(&stream[..self.solids()])
    }

    /// All mass of a stream in kg/s.
    pub fn mass_flow(&self, stream: &[f64]) -> f64 {
        sum(&stream[..self.enthalpy()])
    }

    /// Mass of one compound in all phases in kg/s.
    pub fn compound_flow(&self, stream: &[f64], compound: usize) -> f64 {
        let solid = stream[..self.solids()].iter().skip(compound);
        let solid: f64 = solid.step_by(self.compounds.len()).sum();
        solid + stream[self.liquid(compound)] + stream[self.vapour(compound)]
    }

    /// Mass of each compound in all phases, and the enthalpy: what a balance counts.
    pub fn kinds(&self, stream: &[f64], to: &mut [f64]) {
        let count = self.compounds.len();
        to.fill(0.0);
        add_in_turns(&stream[..self.enthalpy()], &mut to[..count]);
        to[count] = stream[self.enthalpy()];
    }

    /// Mass of each size class in kg/s.
    pub fn by_size(&self, stream: &[f64]) -> Vec<f64> {
        if self.inner == 1 {
            return stream[..self.solids()].to_vec();
        }
        let classes = stream[..self.solids()].chunks_exact(self.inner);
        classes.map(|class| class.iter().sum()).collect()
    }

    /// Combinations of attribute classes; 1 without attributes.
    pub fn cells(&self) -> usize {
        self.inner / self.compounds.len()
    }

    /// Classes of each attribute in a combination, from 0.
    pub fn classes_of(&self, cell: usize) -> Vec<usize> {
        let mut left = cell;
        let mut classes: Vec<usize> = self
            .attributes
            .iter()
            .rev()
            .map(|attribute| {
                let class = left % attribute.classes;
                left /= attribute.classes;
                class
            })
            .collect();
        classes.reverse();
        classes
    }

    /// Mass of each size class in kg/s of the particles of some combinations of attribute classes.
    pub fn by_size_where(&self, stream: &[f64], takes: impl Fn(&[usize]) -> bool) -> Vec<f64> {
        let cells = (0..self.cells()).filter(|&cell| takes(&self.classes_of(cell)));
        let cells: Vec<usize> = cells.collect();
        let count = self.compounds.len();
        let classes = stream[..self.solids()].chunks_exact(self.inner);
        classes
            .map(|class| {
                let own = cells.iter().map(|cell| &class[cell * count..][..count]);
                own.flatten().sum()
            })
            .collect()
    }

    /// All classes of all attributes, each with the index of its attribute and its own from 0.
    pub fn attribute_classes(&self) -> Vec<(usize, usize)> {
        let attributes = self.attributes.iter().enumerate();
        attributes
            .flat_map(|(index, attribute)| (0..attribute.classes).map(move |class| (index, class)))
            .collect()
    }

    /// Heat capacity flow in W/K, and enthalpy flow at the reference temperature in W.
    pub fn heat_capacity(&self, stream: &[f64]) -> (f64, f64) {
        let count = self.compounds.len();
        let (mut capacity, mut latent) = (0.0, 0.0);
        let solids = &stream[..self.solids()];
        let mut few = [0.0; 8];
        let mut many = Vec::new();
        let by_compound = match few.get_mut(..count) {
            Some(few) => few,
            None => {
                many.resize(count, 0.0);
                &mut many[..]
            }
        };
        add_in_turns(solids, by_compound);
        for (k, compound) in self.compounds.iter().enumerate() {
            capacity += by_compound[k] * compound.solid_heat_capacity;
            let vapour = stream[self.vapour(k)];
            capacity += stream[self.liquid(k)] * compound.liquid_heat_capacity;
            capacity += vapour * compound.vapour_heat_capacity;
            latent += vapour * compound.evaporation_heat;
        }
        (capacity, latent)
    }

    /// Temperature in K; none where nothing flows.
    pub fn temperature(&self, stream: &[f64]) -> Option<f64> {
        let (capacity, latent) = self.heat_capacity(stream);
        let sensible = stream[self.enthalpy()] - latent;
        (capacity > 0.0).then(|| REFERENCE_TEMPERATURE + sensible / capacity)
    }

    /// Sets the enthalpy of a stream to that at a temperature in K.
    pub fn set_temperature(&self, stream: &mut [f64], temperature: f64) {
        let (capacity, latent) = self.heat_capacity(stream);
        let place = self.enthalpy();
        stream[place] = latent + capacity * (temperature - REFERENCE_TEMPERATURE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout() -> StreamLayout {
        let grid = SizeGrid::uniform(3, 0.0, 3e-3).unwrap();
        let colour = Attribute {
            name: "colour".into(),
            classes: 2,
        };
        let compound = |name: &str, volatile| Compound {
            name: name.into(),
            volatile,
            solid_heat_capacity: 1500.0,
            liquid_heat_capacity: 4200.0,
            vapour_heat_capacity: 1900.0,
            evaporation_heat: 2.5e6,
        };
        let compounds = vec![compound("urea", false), compound("water", true)];
        StreamLayout::new(grid, vec![colour], compounds).unwrap()
    }

    #[test]
    fn every_number_of_a_stream_is_counted_once() {
        let layout = layout();
        let stream: Vec<f64> = (0..layout.width()).map(|k| (k + 1) as f64).collect();
        let all = layout.mass_flow(&stream);
        let sum: f64 = (0..2).map(|k| layout.compound_flow(&stream, k)).sum();
        assert_eq!(layout.width(), 3 * 2 * 2 + 4 + 1);
        assert!((all - sum).abs() < 1e-12);
        let sizes: f64 = layout.by_size(&stream).iter().sum();
        assert!((sizes - layout.solid_flow(&stream)).abs() < 1e-12);
    }

    #[test]
    fn a_temperature_that_is_set_is_read_back_and_vapour_brings_its_heat() {
        let layout = layout();
        let mut stream = vec![0.0; layout.width()];
        stream[0] = 1.0;
        stream[layout.vapour(1)] = 0.1;
        layout.set_temperature(&mut stream, 350.0);
        assert!((layout.temperature(&stream).unwrap() - 350.0).abs() < 1e-12);
        // 1 kg/s · 1500 J/kg/K · 76.85 K + 0.1 kg/s (2.5e6 + 1900 · 76.85) J/kg.
        let expected = 1500.0 * 76.85 + 0.1 * (2.5e6 + 1900.0 * 76.85);
        let found = stream[layout.enthalpy()];
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        assert!(layout.temperature(&vec![0.0; layout.width()]).is_none());
    }

    #[test]
    fn masses_of_attribute_classes_add_up_to_all() {
        let plain = layout();
        let attribute = |name: &str, classes| Attribute {
            name: name.into(),
            classes,
        };
        let layout = StreamLayout::new(
            plain.grid().clone(),
            vec![attribute("colour", 2), attribute("wet", 3)],
            plain.compounds().to_vec(),
        )
        .unwrap();
        assert_eq!(layout.cells(), 6);
        assert_eq!(layout.classes_of(5), [1, 2]);
        assert_eq!(layout.classes_of(2), [0, 2]);
        assert_eq!(layout.attribute_classes()[3], (1, 1));
        let mut stream: Vec<f64> = (0..layout.width()).map(|k| k as f64).collect();
        let all = layout.by_size(&stream);
        let wet = |class| layout.by_size_where(&stream, |own| own[1] == class);
        let sum: Vec<f64> = (0..3).map(|k| wet(0)[k] + wet(1)[k] + wet(2)[k]).collect();
        assert_eq!(sum, all);
        // One number alone: second size class, colour 2, wet 3, the second compound.
        stream.fill(0.0);
        stream[12 + 5 * 2 + 1] = 7.0;
        let one = layout.by_size_where(&stream, |own| own == [1, 2]);
        assert_eq!(one, [0.0, 7.0, 0.0]);
        assert_eq!(layout.by_size_where(&stream, |own| own[0] == 0), [0.0; 3]);
    }
}
