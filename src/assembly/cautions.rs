//! What is to be warned of in a case because of the solvers that are to compute it.

use calcine_coupler::motion::Motion;
use calcine_coupler::parcels::ParcelPacking;

use super::pairing::{Pairing, ParticleBackend};
use super::prepared::PreparedCase;
use crate::case::model::Case;

/// Solid fraction of the layers of the shipped bed of parcels at rest by OpenFOAM's explicit packing, and of its fullest cell, with close packing
/// at 0.6 (docs/verification.md, parcels by OpenFOAM).
const OVERPACKED: [f64; 2] = [0.87, 1.3];

/// Warnings about a case with a pairing, beside those about the case alone.
pub fn pairing_cautions(case: &Case, prepared: &PreparedCase, pairing: Pairing) -> Vec<String> {
    let of_parcels = pairing.particles_of(case) == ParticleBackend::Openfoam;
    let explicit = of_parcels.then(|| explicit_packing(prepared)).flatten();
    explicit.into_iter().collect()
}

/// OpenFOAM's explicit packing, whose beds become denser than close packing.
fn explicit_packing(prepared: &PreparedCase) -> Option<String> {
    let Motion::Parcels(motion) = &prepared.particles.motion else {
        return None;
    };
    let ParcelPacking::Explicit { stress, .. } = &motion.packing else {
        return None;
    };
    let [layers, cell] = OVERPACKED;
    Some(format!(
        "`motion.parcels.packing` is \"explicit\", and by that of OpenFOAM's cloud beds become denser than close packing, {} here: it limits what the stress \
         does by velocities after the fall of the step, so that it does not carry the weight of a bed. The shipped bed at rest, close packing 0.6, has a solid \
         fraction of {layers} in its layers and of {cell} in a cell, and stands a third too low (one that floats at 0.4 m/s stands right to 1.2 %); write packing = \"implicit\", whose cells stay below close \
         packing, or move the parcels natively (`--particles native`), where either packing keeps to it within 1 %",
        stress.close_packing
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valid::ValidCase;

    #[test]
    fn explicit_packing_by_openfoam_is_warned_of_and_by_no_other() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join("cases/parcel-bed.toml");
        let told = |packing: &str, pairing: &str| {
            let set = [format!("motion.parcels.packing={packing}")];
            let mut valid = ValidCase::open(&path, &set).unwrap();
            let before = valid.case.warnings.len();
            valid.warn_of(Pairing::parse(pairing).unwrap());
            valid.case.warnings.split_off(before)
        };
        let all = told("explicit", "native+openfoam");
        assert_eq!(all.len(), 1, "{all:?}");
        for words in [
            "close packing, 0.6 here",
            "packing = \"implicit\"",
            "--particles native",
        ] {
            assert!(all[0].contains(words), "{all:?}");
        }
        assert_eq!(told("implicit", "native+openfoam"), [""; 0]);
        assert_eq!(told("explicit", "native+native"), [""; 0]);
    }
}
