//! The laws that cases may choose.

use calcine_coupler::interior::reacting::size::{SIZE_LAWS, SizeRule};
use calcine_coupler::interior::{HeatLaws, ThermalProperties};
use calcine_coupler::motion::{
    COHESION_LAWS, CONTACT_LAWS, Cohesion, ContactForce, ROLLING_LAWS, Rolling,
};
use calcine_coupler::physics::conduction::{
    CONDUCTION_LAWS, Conduction, Conductivity, ContactArea, ElasticLaw, GAP_LAWS, GasGap, Stiffness,
};
use calcine_coupler::physics::drag::{DRAG_LAWS, Drag};
use calcine_coupler::physics::heat_transfer::{HEAT_TRANSFER_LAWS, HeatTransfer};
use calcine_coupler::physics::law::{LawEntry, LawSummary};
use calcine_coupler::physics::pores::{
    CONDUCTIVITY_LAWS, PERMEABILITY_LAWS, Permeability, PorousConductivity,
};
use calcine_coupler::physics::reaction::{RATE_LAWS, RateLaw};
use calcine_coupler::physics::turbulence::{BED_EDDY_LAWS, BedEddies};
use calcine_coupler::view_factors::{RADIATION_LAWS, RadiationLaw};
use calcine_flowsheet::mill::{MILL_LAWS, MillLaw};
use calcine_flowsheet::population::{
    AGGREGATION_LAWS, AggregationKernel, BREAKAGE_LAWS, BreakageLaw,
};
use calcine_flowsheet::screen::{SCREEN_LAWS, ScreenLaw};
use calcine_tuning::law::CONVERSION_LAWS;

use crate::case::model::{Case, ConductionArea};

/// Families of laws by the table in which a law is chosen.
pub type LawFamilies = Vec<(&'static str, Vec<LawSummary>)>;

/// The laws that a case may choose: Calcine's own, and those that a program adds to them.
#[derive(Clone, Debug)]
pub struct LawCatalogue {
    /// Drag on a particle.
    pub drag: Vec<&'static LawEntry<dyn Drag>>,
    /// Heat transfer between gas and particle, and by analogy mass transfer.
    pub heat_transfer: Vec<&'static LawEntry<dyn HeatTransfer>>,
    /// What the particles of a bed make of eddies of the gas.
    pub bed_eddies: Vec<&'static LawEntry<dyn BedEddies>>,
    /// Conduction through contacts.
    pub conduction: Vec<&'static LawEntry<dyn Conduction>>,
    /// Conduction through the gas between surfaces.
    pub gap: Vec<&'static LawEntry<dyn GasGap>>,
    /// Radiation between particles.
    pub radiation: Vec<&'static LawEntry<RadiationLaw>>,
    /// Rate of a reaction of particles.
    pub rate: Vec<&'static LawEntry<RateLaw>>,
    /// Size of particles that react.
    pub size: Vec<&'static LawEntry<SizeRule>>,
    /// Permeability of particles with shells.
    pub permeability: Vec<&'static LawEntry<Permeability>>,
    /// Conductivity of particles with shells.
    pub porous_conductivity: Vec<&'static LawEntry<PorousConductivity>>,
    /// Force of a contact.
    pub contact: Vec<&'static LawEntry<ContactForce>>,
    /// Resistance to rolling.
    pub rolling: Vec<&'static LawEntry<Rolling>>,
    /// Attraction between surfaces.
    pub cohesion: Vec<&'static LawEntry<Cohesion>>,
    /// Which share of a size a screen sends to its coarse side.
    pub screen: Vec<&'static LawEntry<dyn ScreenLaw>>,
    /// What a mill makes of a distribution.
    pub mill: Vec<&'static LawEntry<dyn MillLaw>>,
    /// Rate at which pairs of particles aggregate.
    pub aggregation: Vec<&'static LawEntry<dyn AggregationKernel>>,
    /// What breaks, and into what.
    pub breakage: Vec<&'static LawEntry<dyn BreakageLaw>>,
}

impl Default for LawCatalogue {
    fn default() -> Self {
        Self {
            drag: DRAG_LAWS.to_vec(),
            heat_transfer: HEAT_TRANSFER_LAWS.to_vec(),
            bed_eddies: BED_EDDY_LAWS.to_vec(),
            conduction: CONDUCTION_LAWS.to_vec(),
            gap: GAP_LAWS.to_vec(),
            radiation: RADIATION_LAWS.to_vec(),
            rate: RATE_LAWS.to_vec(),
            size: SIZE_LAWS.to_vec(),
            permeability: PERMEABILITY_LAWS.to_vec(),
            porous_conductivity: CONDUCTIVITY_LAWS.to_vec(),
            contact: CONTACT_LAWS.to_vec(),
            rolling: ROLLING_LAWS.to_vec(),
            cohesion: COHESION_LAWS.to_vec(),
            screen: SCREEN_LAWS.to_vec(),
            mill: MILL_LAWS.to_vec(),
            aggregation: AGGREGATION_LAWS.to_vec(),
            breakage: BREAKAGE_LAWS.to_vec(),
        }
    }
}

fn summaries<L: ?Sized>(laws: &[&'static LawEntry<L>]) -> Vec<LawSummary> {
    laws.iter().map(|law| law.about()).collect()
}

impl LawCatalogue {
    /// Adds a drag law.
    #[must_use]
    pub fn with_drag(mut self, law: &'static LawEntry<dyn Drag>) -> Self {
        self.drag.push(law);
        self
    }

    /// Adds a law of the rates of particles' reactions.
    #[must_use]
    pub fn with_rate(mut self, law: &'static LawEntry<RateLaw>) -> Self {
        self.rate.push(law);
        self
    }

    /// The families of plants by the table in which a law is chosen.
    pub fn plant_families(&self) -> LawFamilies {
        vec![
            ("units.screen", summaries(&self.screen)),
            ("units.mill", summaries(&self.mill)),
            ("units.granulator.aggregation", summaries(&self.aggregation)),
            ("units.granulator.breakage", summaries(&self.breakage)),
        ]
    }

    /// The families of beds by the table in which a law is chosen.
    pub fn families(&self) -> LawFamilies {
        vec![
            ("laws.drag", summaries(&self.drag)),
            ("laws.heat_transfer", summaries(&self.heat_transfer)),
            ("laws.mass_transfer", summaries(&self.heat_transfer)),
            ("gas.turbulence.bed", summaries(&self.bed_eddies)),
            ("laws.conduction", summaries(&self.conduction)),
            ("laws.conduction.gap", summaries(&self.gap)),
            ("laws.radiation", summaries(&self.radiation)),
            ("reactions", summaries(&self.rate)),
            ("materials.NAME.size", summaries(&self.size)),
            (
                "materials.NAME.radial.permeability",
                summaries(&self.permeability),
            ),
            (
                "materials.NAME.radial.conduction",
                summaries(&self.porous_conductivity),
            ),
            ("motion.contact", summaries(&self.contact)),
            ("motion.rolling", summaries(&self.rolling)),
            ("motion.cohesion", summaries(&self.cohesion)),
        ]
    }
}

impl LawCatalogue {
    /// Families of laws that a tuning chooses from; their numbers are keys of its reactions.
    pub fn tuning_families(&self) -> LawFamilies {
        vec![("reactions.laws", summaries(CONVERSION_LAWS))]
    }
}

/// Families for the declarations of keys.
macro_rules! families {
    ($($name:ident),*) => {
        $(pub(crate) fn $name(laws: &LawCatalogue) -> Vec<LawSummary> {
            summaries(&laws.$name)
        })*
    };
}

families!(
    drag,
    heat_transfer,
    bed_eddies,
    conduction,
    gap,
    radiation,
    rate,
    size,
    permeability,
    porous_conductivity,
    contact,
    rolling,
    cohesion,
    screen,
    mill,
    aggregation,
    breakage
);

/// The laws of heat between particles of a case; `None` where there are none.
pub fn heat(case: &Case) -> Option<HeatLaws> {
    let (laws, radiates) = (&case.laws.conduction, case.laws.radiation.is_some());
    if !case.laws.conducts() && !radiates {
        return None;
    }
    let area = match laws.area {
        ConductionArea::Overlap => ContactArea::Overlap,
        ConductionArea::Load { force, within } => ContactArea::Load { force, within },
        ConductionArea::Force => {
            ContactArea::Force(match case.motion.as_ref().map(|motion| motion.law.force) {
                Some(ContactForce::Linear {
                    characteristic_speed: speed,
                }) => ElasticLaw::Linear { speed },
                Some(ContactForce::LinearSprings { stiffness, .. }) => {
                    ElasticLaw::Springs { stiffness }
                }
                _ => ElasticLaw::Hertz,
            })
        }
    };
    Some(HeatLaws {
        conduction: laws.law.make(),
        area,
        gap: laws.gap.make(),
        radiates,
        inside: case.laws.radiation.as_ref().is_some_and(|one| one.inside),
    })
}

/// What heat between particles needs of the materials of a case. What a case does not state is not asked for:
/// the check demands all that its laws need.
pub fn thermal(case: &Case) -> Vec<ThermalProperties> {
    let of = |material: &crate::case::model::MaterialSpec| {
        let stiffness = |young: Option<f64>| Stiffness {
            young: young.unwrap_or(f64::NAN),
            poisson: material.poisson.unwrap_or(f64::NAN),
        };
        ThermalProperties {
            conductivity: material
                .conductivity
                .clone()
                .unwrap_or(Conductivity::constant(0.0)),
            emissivity: material.emissivity.unwrap_or(1.0),
            density: material.density,
            soft: stiffness(material.young),
            real: stiffness(material.real_young.or(material.young)),
        }
    };
    case.materials.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::physics::law::NONE;

    #[test]
    fn laws_of_every_family_have_names_of_their_own_and_sources() {
        let catalogue = LawCatalogue::default();
        for (family, laws) in [catalogue.families(), catalogue.plant_families()].concat() {
            let mut names: Vec<&str> = laws.iter().map(|law| law.name).collect();
            for law in &laws {
                assert!(law.summary.ends_with('.'), "{family}: {}", law.name);
                assert_eq!(
                    law.source.is_empty(),
                    law.name == NONE,
                    "{family}: {}",
                    law.name
                );
            }
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), laws.len(), "{family}");
        }
    }
}
