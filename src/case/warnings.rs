//! All that is to be warned of in a case before it runs: `check` prints it, `run` repeats it in its log, its report and its
//! exit code with `--strict`.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::ParticleSetup;

use super::cautions::cautions;
use super::conduction_step::FastestContact;
use super::flow_numbers::FlowNumbers;
use super::model::Case;
use super::packed::BedPacking;
use super::splitting::Splitting;
use super::{
    accuracy_cautions, buoyancy, contacts, duct_flow, flow_time, idle_cautions, mesh_shape,
    overlap, patch_cautions, resolved, size_cautions, temperature_cautions,
};

/// Warnings about a case with its mesh, and its particles with their temperatures in K and what was noted of their files, in a fixed
/// order, each once.
pub fn warnings(
    case: &Case,
    mesh: &Mesh,
    (setup, temperature, notes): (&ParticleSetup, &[f64], &[String]),
    packing: &BedPacking,
) -> Vec<String> {
    let void_fraction = packing.void_fraction;
    let mut all: Vec<String> = buoyancy::warning(buoyancy::number(case, mesh))
        .into_iter()
        .chain(flow_time::warning(case, mesh, setup, void_fraction))
        .collect();
    all.extend(cautions(case));
    all.extend(temperature_cautions::of_files(
        case,
        &setup.population,
        temperature,
    ));
    all.extend(notes.iter().cloned());
    all.extend(overlap::deepest(case, setup, mesh.periodicity()));
    all.extend(patch_cautions::columns(case, mesh));
    all.extend(size_cautions::pores(case));
    all.extend(resolved::warnings(case));
    all.extend(size_cautions::wide_mesh(mesh, setup));
    all.extend(accuracy_cautions::extents(case, mesh, setup));
    all.extend(duct_flow::turbulent_inlet(case, mesh, setup.id.len()));
    all.extend(mesh_shape::report(mesh).1);
    all.extend(contacts::warnings(case, mesh, setup));
    let fastest = FastestContact::of(case, setup, mesh.periodicity());
    all.extend(fastest.and_then(|one| one.warning(case)));
    all.extend(packing.warning(case));
    let flow = FlowNumbers::of(case, mesh, setup, packing);
    all.extend(flow.iter().flat_map(|flow| flow.warnings(case)));
    all.extend(mesh_shape::overlaps(case, mesh));
    all.extend(idle_cautions::unseen_walls(case, mesh));
    all.extend(idle_cautions::regions(case, mesh, setup));
    let populations = case.particles.iter();
    let splittings = populations.filter_map(|one| Splitting::of(case, one, void_fraction));
    for warning in splittings.flat_map(|one| one.warnings(case)) {
        if !all.contains(&warning) {
            all.push(warning);
        }
    }
    all
}

#[cfg(test)]
pub(in crate::case) mod tests {
    use crate::valid::ValidCase;

    /// The warnings about a good case with keys set.
    pub(in crate::case) fn warned(name: &str, set: &[&str]) -> Vec<String> {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join(format!("tests/inputs/good/{name}.toml"));
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        ValidCase::open(&path, &set).unwrap().case.warnings
    }

    #[test]
    fn what_check_marks_in_its_lines_is_a_warning() {
        let all = warned("burning-beads", &[]);
        let found = |words: &str| all.iter().any(|one| one.contains(words));
        assert!(found("0.18 hA AF dt/(m c) of `"), "{all:?}");
        let all = warned("reactions", &[]);
        let drag = all.iter().filter(|one| one.contains("the law of drag"));
        assert_eq!(drag.count(), 1, "{all:?}");
        let all = warned("moving", &[]);
        assert!(
            all[0].starts_with("`motion.motion_step` is 26 %"),
            "{all:?}"
        );
    }

    #[test]
    fn coefficients_of_friction_beyond_those_of_materials_are_told() {
        let told = |set: &str| {
            let all = warned("burning-moving", &[set]);
            all.iter().any(|one| one.contains("lack a decimal point"))
        };
        assert!(told("contacts[0].friction=40"));
        assert!(told("contacts[0].rolling_friction=2.1"));
        assert!(!told("contacts[0].friction=1.9"));
    }
}
