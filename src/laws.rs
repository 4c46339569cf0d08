//! The laws that a case names.

use calcine_coupler::physics::conduction::{BatchelorObrien, Conduction, Lens};
use calcine_coupler::physics::drag::{
    Beetstra, DiFelice, Drag, Ergun, ErgunWenYu, Gidaspow, KochHill, NoDrag, WenYu,
};
use calcine_coupler::physics::heat_transfer::{
    Gnielinski, Gunn, HeatTransfer, NoHeatTransfer, RanzMarshall, Wakao,
};

use crate::case::model::{ConductionLaw, DragLaw, HeatLaw};

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

/// The conduction law of a case; `None` where particles conduct nothing to each other.
pub fn conduction(law: ConductionLaw) -> Option<Box<dyn Conduction>> {
    match law {
        ConductionLaw::None => None,
        ConductionLaw::BatchelorObrien => Some(Box::new(BatchelorObrien)),
        ConductionLaw::Lens => Some(Box::new(Lens)),
    }
}
