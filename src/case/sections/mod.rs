//! The sections of a case file, one file each.

mod agreement;
mod bodies;
mod chemistry;
mod common;
mod composition;
mod conversion;
mod coupling;
mod drying;
mod feeds;
mod film_diffusivity;
mod gas;
mod gas_patch;
mod heat;
mod hold;
mod inventory;
mod known;
mod laws;
mod mesh;
mod motion;
mod output;
mod packing;
mod parcels;
mod particles;
mod passages;
mod place;
mod probes;
mod quantities;
mod radial;
mod rate_constants;
mod reactions;
mod sizes;
mod solids;
mod species_data;
mod time;
pub(super) mod tuning;
mod tuning_targets;
mod turbulence;
mod walls;
mod zone;

use std::collections::BTreeMap;
use std::path::Path;

use self::gas::GasRead;
use super::model::Case;
use super::parse::FORMAT;
use super::table::TableReader;

/// Reads all sections; `None` where one could not be read (its problems are recorded).
pub(super) fn case(
    root: &TableReader<'_>,
    path: &Path,
    effective: &str,
    hash: String,
) -> Option<Case> {
    if root.whole("format").is_some_and(|format| format != FORMAT) {
        root.fail(
            "format",
            "is not 1, the only one there is",
            "write format = 1",
        );
    }
    let title = root.text("title");
    if !common::gas_alone(root) {
        for key in ["particles", "materials", "laws", "coupling"] {
            root.need(key);
        }
    }
    let listed = root.raw("particles").and_then(|item| item.as_array());
    if listed.is_some_and(|list| list.is_empty()) {
        let help = "add one: [[particles]], or leave the key out to compute the gas alone";
        root.fail("particles", "is an empty list", help);
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let time = time::read(root);
    let mesh = mesh::read(root, folder);
    let solids = solids::solids(root);
    let materials = particles::materials(root, &solids);
    let contacts = particles::contacts(root, &materials);
    let gas = gas::read(
        root,
        mesh.as_ref(),
        time.as_ref().map(|(_, storage)| *storage),
        folder,
    );
    let particles = particles::populations(root, &materials, mesh.as_ref(), folder);
    for (section, is_read) in [
        ("time", time.is_some()),
        ("mesh", mesh.is_some()),
        ("gas", gas.is_some()),
        ("particles", particles.is_some()),
    ] {
        if !is_read {
            root.unusable(section);
        }
    }
    let feeds = feeds::feeds(root, particles.as_deref());
    let outlets = feeds::outlets(root);
    let bed_eddies = gas.as_ref().map(|gas| gas.bed_eddies.clone());
    let film_gas = gas.as_ref().map(|gas| film_diffusivity::FilmGas {
        species: gas.setup.properties.species(),
        schmidt: gas.setup.schmidt,
    });
    let laws = laws::read(root, bed_eddies, film_gas);
    if let (Some(gas), Some(laws)) = (&gas, &laws) {
        gas::acts(root, &gas.setup, laws);
    }
    let (mut bodies, body_materials): (Vec<_>, Vec<_>) =
        bodies::bodies(root, &materials).into_iter().unzip();
    let read = walls::walls(root, &materials, mesh.as_ref(), folder, &bodies);
    let (walls, wall_bodies, left_out) = (read.walls, read.bodies, read.left_out);
    let motion = motion::motion(root, time.as_ref().map(|(time, _)| time));
    let coupling = coupling::read(root);
    let openfoam = coupling::external(root, "openfoam", folder);
    let liggghts = coupling::external(root, "liggghts", folder);
    let surfaces = gas.as_ref().map_or(&[][..], |gas| &gas.surfaces);
    bodies::join(root, &mut bodies, surfaces, &wall_bodies, &openfoam);
    let (external_gas, external_particles) = coupling::programs(root, folder);
    if let (Some(laws), Some(particles)) = (&laws, &particles) {
        heat::need_properties(root, laws, &materials, particles, &walls);
        particles::weights_fit(root, particles, laws);
    }
    let reactions = reactions::reactions(root, &solids, gas.as_ref().map(|gas| &gas.setup));
    if reactions::are_all(root, &reactions) {
        drying::no_drying(root, &solids, &materials, &reactions);
    }
    let populations = particles.as_deref().unwrap_or_default();
    let chemistry = inventory::inventory(solids, reactions, &materials, populations);
    if let Some(particles) = &particles {
        conversion::fits(root, &chemistry, &materials, particles);
        radial::fits(root, &chemistry, &materials, particles);
        let reactions = chemistry.reactions.len();
        particles::prescribed_fit(root, particles, &materials, reactions);
    }
    drying::fits(root, &chemistry, laws.as_ref());
    if let Some(laws) = &laws {
        reactions::fits(root, &chemistry, laws, openfoam.solver);
    }
    let end = time.as_ref().map(|(time, _)| time.end);
    let output = output::output(root, end);
    if let (Some(gas), Some(output)) = (&gas, &output) {
        turbulence::fits(root, &gas.setup.turbulence, gas.held, output);
    }
    let agreement = agreement::agreement(root, output.as_ref());
    let probes = probes::probes(root);
    let quantities = {
        let species = gas.as_ref().map(|gas| gas.setup.properties.species());
        let known = known::Known {
            mesh: mesh.as_ref(),
            populations: particles.as_deref(),
            materials: &materials,
            probes: &probes,
            walls: &walls,
            bodies: &bodies,
            species: species.unwrap_or_default(),
            solids: reactions::are_all(root, &chemistry.reactions).then_some(&chemistry.solids[..]),
            compositions: &chemistry.compositions,
            gravity: gas.as_ref().map(|gas| gas.setup.gravity),
            patches: gas.as_ref().map_or(&[], |gas| &gas.setup.patches),
            held: gas.as_ref().is_some_and(|gas| gas.held),
            solver: openfoam.solver,
            outlets: &outlets,
            feeds: !feeds.is_empty(),
        };
        quantities::quantities(root, &known)
    };
    let (walls, wall_temperatures): (Vec<_>, Vec<_>) = walls.into_iter().unzip();
    if let Some(gas) = &gas {
        coupling::check_template(root, &openfoam, &gas.setup);
    }
    if let (Some(gas), Some((time, _))) = (&gas, &time) {
        coupling::check_stock(root, &openfoam, &gas.setup, time, laws.as_ref());
    }
    if let Some(particles) = &particles {
        coupling::check_script(root, &liggghts, particles);
        coupling::check_drag(root, particles);
    }
    if let (Some((time, _)), Some(particles)) = (&time, &particles) {
        motion::fits(root, motion.as_ref(), time, particles);
        parcels::fits(root, (motion.as_ref(), coupling.as_ref()), particles);
        if let Some(motion) = &motion {
            let meeting = motion::Meeting {
                motion,
                materials: &materials,
                contacts: &contacts,
                particles,
                walls: &walls,
            };
            motion::need_properties(root, &meeting);
        }
    }
    if let (Some((time, _)), Some(gas), Some(section)) = (&time, &gas, root.table("time"))
        && time.window_bounds.is_some()
        && gas.held
    {
        let help = "write a number, for example motion_window = \"1 ms\"";
        section.fail(
            "motion_window",
            "follows the gas, but `gas.held` keeps it as it is",
            help,
        );
    }
    let (time, _) = time?;
    let GasRead {
        setup: mut gas,
        held: gas_held,
        gravity_is_stated,
        files: gas_files,
        bed_eddies: _,
        surfaces: _,
    } = gas?;
    let laws = laws?;
    gas.momentum = laws.momentum;
    Some(Case {
        name: path
            .file_stem()
            .map(|name| name.to_string_lossy().into_owned())?,
        title: title?.into(),
        path: path.to_owned(),
        hash,
        changes: Vec::new(),
        warnings: Vec::new(),
        effective: effective.into(),
        lines: Vec::new(),
        time,
        mesh: mesh?,
        materials,
        chemistry,
        contacts,
        walls,
        wall_temperatures,
        wall_bodies,
        bodies,
        body_materials,
        left_out_of_walls: left_out,
        motion,
        gas,
        gas_held,
        gravity_is_stated,
        gas_files,
        files: BTreeMap::new(),
        particles: particles?,
        feeds,
        outlets,
        laws,
        coupling: coupling?,
        openfoam,
        liggghts,
        external_gas,
        external_particles,
        output: output?,
        probes,
        quantities,
        agreement,
    })
}
