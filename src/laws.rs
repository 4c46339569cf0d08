//! The laws that a case names.

use calcine_coupler::interior::{HeatLaws, ThermalProperties};
use calcine_coupler::motion::ContactForce;
use calcine_coupler::physics::conduction::{
    BatchelorObrien, Cheng, Conduction, Conductivity, ContactArea, ElasticLaw, GasGap, Lens,
    NoConduction, NoGap, RongHorio, Stiffness,
};
use calcine_coupler::physics::drag::{
    Beetstra, DiFelice, Drag, Ergun, ErgunWenYu, Gidaspow, KochHill, NoDrag, WenYu,
};
use calcine_coupler::physics::heat_transfer::{
    Gnielinski, Gunn, HeatTransfer, NoHeatTransfer, RanzMarshall, Wakao,
};

use crate::case::model::{Case, ConductionArea, ConductionLaw, DragLaw, GapSpec, HeatLaw};

/// The drag law of a case.
pub fn drag(law: DragLaw) -> Box<dyn Drag> {
    match law {
        DragLaw::None => Box::new(NoDrag),
        DragLaw::ErgunWenYu => Box::new(ErgunWenYu),
        DragLaw::Ergun => Box::new(Ergun),
        DragLaw::WenYu => Box::new(WenYu),
        DragLaw::Gidaspow => Box::new(Gidaspow),
        DragLaw::DiFelice => Box::new(DiFelice),
        DragLaw::KochHill => Box::new(KochHill),
        DragLaw::Beetstra => Box::new(Beetstra),
    }
}

/// The heat transfer law of a case.
pub fn heat_transfer(law: HeatLaw) -> Box<dyn HeatTransfer> {
    match law {
        HeatLaw::None => Box::new(NoHeatTransfer),
        HeatLaw::Gunn => Box::new(Gunn),
        HeatLaw::RanzMarshall => Box::new(RanzMarshall),
        HeatLaw::Wakao => Box::new(Wakao),
        HeatLaw::Gnielinski => Box::new(Gnielinski),
    }
}

/// The laws of heat between particles of a case; `None` where there are none.
pub fn heat(case: &Case) -> Option<HeatLaws> {
    let (laws, radiates) = (&case.laws.conduction, case.laws.radiation.is_some());
    if !case.laws.conducts() && !radiates {
        return None;
    }
    let conduction: Box<dyn Conduction> = match laws.law {
        ConductionLaw::None => Box::new(NoConduction),
        ConductionLaw::BatchelorObrien => Box::new(BatchelorObrien),
        ConductionLaw::Lens => Box::new(Lens),
    };
    let area = match laws.area {
        ConductionArea::Overlap => ContactArea::Overlap,
        ConductionArea::Load { force, within } => ContactArea::Load { force, within },
        ConductionArea::Force => {
            ContactArea::Force(match case.motion.as_ref().map(|motion| motion.law.force) {
                Some(ContactForce::Linear {
                    characteristic_speed: speed,
                }) => ElasticLaw::Linear { speed },
                _ => ElasticLaw::Hertz,
            })
        }
    };
    let gap: Box<dyn GasGap> = match laws.gap {
        GapSpec::None => Box::new(NoGap),
        GapSpec::RongHorio { lens, least_width } => Box::new(RongHorio { lens, least_width }),
        GapSpec::Cheng { cone, widest } => Box::new(Cheng { cone, widest }),
    };
    Some(HeatLaws {
        conduction,
        area,
        gap,
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
