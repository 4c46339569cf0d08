//! What `calcine check` says of a case that is in order.

use std::fmt::Write as _;

use calcine_adapters::openfoam::{chemistry, template};
use calcine_coupler::gas_chemistry::Combustion;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::cylinder::outline;
use calcine_coupler::physics::film::{FilmDiffusivity, ReferenceDiffusivity};
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::law::NONE;
use calcine_coupler::setup::ParticleSetup;

use super::bed::{self, Choice};
use super::conduction_step::FastestContact;
use super::flow_numbers::FlowNumbers;
use super::model::{Case, MeshSpec, PlacementSpec, Population, TimeSpec};
use super::packed::BedPacking;
use super::splitting::Splitting;
use super::units::{short, short3};
use super::{bodies, boundaries, buoyancy, mesh_shape, resolved, sizes, span, work};

/// Most names of columns in a line.
const COLUMNS: usize = 12;

/// What is read of each file of particles.
fn files(case: &Case) -> Vec<String> {
    let told = |one: &Population| {
        let PlacementSpec::File {
            path,
            timestep,
            kind,
        } = &one.place
        else {
            return None;
        };
        let choice = Choice {
            timestep: *timestep,
            kind: *kind,
        };
        let names = |names: &[String]| {
            let more = match names.len().saturating_sub(COLUMNS) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            names[..names.len().min(COLUMNS)].join(", ") + &more
        };
        let [read, others] = bed::columns(path, choice).ok()?;
        let file = path.file_name().unwrap_or(path.as_os_str()).display();
        let mut line = format!("`{}` from {file}: {}", one.name, names(&read));
        if !others.is_empty() {
            line += &format!("; not read: {}", names(&others));
        }
        Some(line)
    };
    case.particles.iter().filter_map(told).collect()
}

/// Clocks, sizes, the flow, and how far the time splitting may be from the unsplit run.
pub fn check_report(
    case: &Case,
    mesh: &Mesh,
    setup: &ParticleSetup,
    packing: &BedPacking,
    refusals: Refusals<'_>,
) -> String {
    let (particles, void_fraction) = (setup.id.len(), packing.void_fraction);
    let cells = mesh.cells();
    let mut text = format!("{} ({})\n", case.title, case.path.display());
    for change in &case.changes {
        let _ = writeln!(text, "  set            {change}");
    }
    let time = &case.time;
    for &(start, factor) in time.acceleration.steps() {
        let factor = short(factor);
        let _ = writeln!(text, "  from {start} of process time   AF {factor}");
    }
    let _ = writeln!(
        text,
        "  process time   {} in {} windows",
        time.end,
        number_of_windows(time)
    );
    let _ = writeln!(
        text,
        "  motion time    {} s, windows of {} s{}",
        short(span::motion_time(time, [0.0, time.end.seconds()])),
        lengths(time),
        if time.process_step.is_some() {
            " (chosen for `process_step`)"
        } else {
            ""
        }
    );
    let _ = writeln!(text, "  gas storage    {}", time.storage.name());
    let _ = writeln!(text, "  mesh           {cells} cells");
    if let MeshSpec::Cylinder {
        diameter, cells, ..
    } = &case.mesh
    {
        let outline = outline(cells[0]);
        let _ = writeln!(
            text,
            "                 diameter {} m: {} sides that enclose its area, {} m from side to side, {} m from corner to corner",
            short(*diameter),
            outline.sides,
            short(outline.across_sides * diameter),
            short(outline.across_corners * diameter)
        );
    }
    if let MeshSpec::PolyMesh(_) = &case.mesh {
        let [low, high] = mesh
            .bounds()
            .map(|at| [at.x, at.y, at.z].map(short).join(", "));
        let _ = writeln!(text, "                 from ({low}) to ({high}) m");
    }
    let directions = boundaries::lines(case, mesh);
    let shape = mesh_shape::pieces(mesh)
        .into_iter()
        .chain(mesh_shape::report(mesh).0);
    for line in directions.into_iter().chain(shape) {
        let _ = writeln!(text, "                 {line}");
    }
    let _ = match case.particles.is_empty() {
        true => writeln!(
            text,
            "  bed            none: the gas is computed alone, since the case has no [[particles]]"
        ),
        false => writeln!(
            text,
            "  bed            {particles} particles, void fraction {void_fraction:.3}"
        ),
    };
    for line in files(case) {
        let _ = writeln!(text, "                 {line}");
    }
    if packing.moved_share > 0.0 {
        let _ = writeln!(
            text,
            "  smoother       moves {} % of the solid volume out of cells above {}; packing {:.3}",
            short3(100.0 * packing.moved_share),
            case.coupling.max_solid_fraction,
            packing.solid_fraction
        );
    }
    if !case.gas.turbulence.is_laminar() {
        let bed = match case.gas.turbulence.is_in_bed() {
            true => "and in the bed",
            false => "outside the bed, none in it (`gas.turbulence.bed`)",
        };
        let _ = writeln!(text, "  eddies         k-epsilon {bed}");
    }
    if let Some(gas) = case.gas.chemistry.reacting() {
        let how = match gas.combustion {
            Combustion::Laminar => "laminar".to_owned(),
            Combustion::Pasr { mixing_constant } => {
                let bed = match case.gas.turbulence.is_in_bed() {
                    true => "in the bed as outside",
                    false => "laminar in the bed, whose gas counts as mixed",
                };
                format!("partially stirred, C_mix {mixing_constant}; {bed}")
            }
        };
        let _ = writeln!(
            text,
            "  gas reactions  {}, {how}",
            gas.mechanism.steps().len()
        );
    }
    laws(&mut text, case);
    let memory = sizes::memory(case, cells as f64, particles as f64);
    let _ = writeln!(
        text,
        "  memory         about {} (native)",
        sizes::shown(memory)
    );
    let _ = writeln!(
        text,
        "  wall time      {} (native, two cores; without what feeds bring)",
        work::shown(work::seconds(case, cells, setup))
    );
    let flow = FlowNumbers::of(case, mesh, setup, packing);
    for line in flow.iter().flat_map(FlowNumbers::lines) {
        let _ = writeln!(text, "  {line}");
    }
    let number = buoyancy::number(case, mesh);
    let _ = match number > 0.0 {
        true => writeln!(
            text,
            "  buoyancy       N sqrt(AF) dt is {number:.2e}; waves are resolved below {}",
            buoyancy::LIMIT
        ),
        false => writeln!(text, "  buoyancy       none"),
    };
    if let Some(fastest) = FastestContact::of(case, setup, mesh.periodicity()) {
        let _ = writeln!(text, "  {}", fastest.line());
    }
    for (row, line) in bodies::lines(case, mesh).iter().enumerate() {
        let head = if row == 0 { "bodies" } else { "" };
        let _ = writeln!(text, "  {head:<14} {line}");
    }
    for warning in &case.warnings {
        let _ = writeln!(text, "  warning: {warning}");
    }
    for population in &case.particles {
        if let Some(splitting) = Splitting::of(case, population, void_fraction) {
            let _ = writeln!(text, "  {}:", population.name);
            for line in splitting.lines(case) {
                let _ = writeln!(text, "    {line}");
            }
        }
        for line in resolved::lines(case, population) {
            let _ = writeln!(text, "    {line}");
        }
        if let Some(line) = prescribed(population) {
            let _ = writeln!(text, "    {line}");
        }
    }
    honoured(&mut text, case, refusals);
    text
}

/// How many windows a run makes; where their length follows the gas, between which numbers.
fn number_of_windows(time: &TimeSpec) -> String {
    let fewest = span::windows(time);
    match span::most_windows(time) {
        most if most > fewest => format!("{fewest} to {most}"),
        _ => fewest.to_string(),
    }
}

/// Lengths of windows in s of motion time, and what they follow.
fn lengths(time: &TimeSpec) -> String {
    let longest = short(time.motion_window.seconds());
    let Some(bounds) = time.window_bounds else {
        return longest;
    };
    let courant = bounds.courant.map(|it| format!("Courant number {it}"));
    let error = bounds.error.map(|it| format!("error of a step {it}"));
    let follow: Vec<String> = courant.into_iter().chain(error).collect();
    format!(
        "{} to {longest} (up to {})",
        short(bounds.min.seconds()),
        follow.join(", ")
    )
}

/// The laws that the case chose, with their sources.
fn laws(text: &mut String, case: &Case) {
    let laws = &case.laws;
    let mut chosen = vec![
        ("drag", laws.drag.entry().about()),
        ("heat transfer", laws.heat_transfer.entry().about()),
        ("mass transfer", laws.mass_transfer.entry().about()),
        ("eddies of bed", laws.bed_eddies.entry().about()),
        ("conduction", laws.conduction.law.entry().about()),
        ("through gaps", laws.conduction.gap.entry().about()),
    ];
    let radiation = laws.radiation.iter();
    chosen.extend(radiation.map(|one| ("radiation", one.view_factors.law().about())));
    // Of several reactions and materials each law once.
    let rates = case.chemistry.reactions.iter();
    let rates = rates.map(|one| ("reactions", one.rate.law().about()));
    let reacts = case
        .materials
        .iter()
        .filter(|one| one.composition.is_some());
    let sizes = reacts.map(|one| ("size", one.size.law().about()));
    for one in rates.chain(sizes) {
        if !chosen.contains(&one) {
            chosen.push(one);
        }
    }
    for (what, law) in chosen.iter().filter(|(_, law)| law.name != NONE) {
        let _ = writeln!(text, "  {what:<14} {} ({})", law.name, law.source);
    }
    if !laws.mass_transfer.is_none() && !case.chemistry.reactions.is_empty() {
        let how = diffusivity(case);
        let _ = writeln!(text, "  {:<14} {how}", "of films");
    }
}

/// By which diffusivities gases pass films.
fn diffusivity(case: &Case) -> String {
    let fuller = "mixture-averaged, of pairs by Fuller, Schettler and Giddings";
    match &case.laws.film_diffusivity {
        FilmDiffusivity::Fuller => format!("diffusivities {fuller}"),
        FilmDiffusivity::Schmidt(schmidt) => {
            format!("diffusivity of all gases mu/(rho Sc) with Sc {schmidt}")
        }
        FilmDiffusivity::Stated(values) => {
            let names = case.gas.properties.species().iter().zip(values);
            let of = |one: &ReferenceDiffusivity| {
                format!(
                    "{:e} m^2/s (T/{} K)^{} ({} Pa/p)",
                    one.value, one.at, one.exponent, one.pressure
                )
            };
            let each = names.map(|(name, value)| match value {
                Some(value) => format!("{name} {}", of(value)),
                None => format!("{name} {fuller}"),
            });
            let each: Vec<String> = each.collect();
            format!("diffusivities: {}", each.join("; "))
        }
    }
}

/// Name of OpenFOAM's cloud of parcels in the report.
const FOAM_PARCELS: &str = "OpenFOAM parcels";

/// Why particle solvers cannot move the particles of a case; `None` where they can.
#[derive(Clone, Copy, Debug, Default)]
pub struct Refusals<'a> {
    /// LIGGGHTS.
    pub liggghts: Option<&'a str>,
    /// OpenFOAM's cloud of parcels.
    pub openfoam_parcels: Option<&'a str>,
}

/// What each backend makes of the case.
fn honoured(text: &mut String, case: &Case, refusals: Refusals<'_>) {
    let _ = writeln!(text, "  backends:");
    let external = case.external_gas.as_ref().map(|_| "external gas");
    let names = ["native gas", "OpenFOAM", "native particles", "LIGGGHTS"];
    let particles = case.external_particles.as_ref();
    let particles = particles.map(|_| "external particles");
    let parcels = case.motion.as_ref().and_then(|one| one.parcels.as_ref());
    let parcels = parcels.map(|_| FOAM_PARCELS);
    for name in names
        .into_iter()
        .chain(parcels)
        .chain(external)
        .chain(particles)
    {
        let foam = openfoam(case);
        let refused = match name {
            "LIGGGHTS" => refusals.liggghts,
            FOAM_PARCELS => refusals.openfoam_parcels,
            _ => None,
        };
        let refused = refused.map(|reason| format!("not this case: {reason}"));
        let note = match (name, &refused) {
            (_, Some(refused)) => refused,
            ("OpenFOAM", _) => foam.as_str(),
            (FOAM_PARCELS, _) => {
                "every key but `motion.parcels.most_steps`: a window is one step of the cloud, whose tracks have parts of the Courant \
                 number `courant` at most"
            }
            ("native gas", _) if case.openfoam.start.is_some() => {
                "not its start: `openfoam.start` is the start of an OpenFOAM gas alone"
            }
            ("native gas", _) if case.openfoam.template.is_some() => {
                "every key but `openfoam.template`: what only the template states is left out"
            }
            ("LIGGGHTS", _) if case.liggghts.template.is_some() => {
                "every key; contacts, walls and integration are those of `liggghts.template`, which restricts \
                 the case to these particles where they differ from the case's"
            }
            ("native particles", _) if case.liggghts.template.is_some() => {
                "every key but `liggghts.template`: what only the script states is left out"
            }
            ("external gas", _) => {
                "its own settings: of the case's gas it is told what the particles exchange, and must have the same mesh"
            }
            ("external particles", _) => {
                "their own settings: of the case they are given the particles at the start, and what the gas pushes"
            }
            _ => "every key",
        };
        let _ = writeln!(text, "    {name:<17} {note}");
    }
}

/// What an OpenFOAM gas makes of the case, and what its template alone states.
fn openfoam(case: &Case) -> String {
    let mut text = String::from("every key");
    let mut stated = template::written(&case.gas);
    if let (Some(gas), GasModel::Mixture(mixture)) =
        (case.gas.chemistry.reacting(), &case.gas.properties)
    {
        match chemistry::files(&case.gas, mixture, gas) {
            Ok(files) => stated.extend(files.into_iter().map(|file| file.0.to_owned())),
            Err(error) => return format!("not this case: {error}"),
        }
        text += " but `gas.chemistry.fraction_tolerance` and `gas.chemistry.negligible`, in whose place OpenFOAM's \
                 integration has numbers of its own";
    }
    if case.openfoam.solver.is_stock() {
        text += ", approximately: a stock solver (`openfoam.solver`) has no void fraction in its storage; \
                 see docs/how-to/stock-solvers.md";
    }
    if let Some(template) = &case.openfoam.template {
        let (mut names, mut ignored) = (Vec::new(), Vec::new());
        for folder in ["0", "constant", "system"] {
            let Ok(entries) = std::fs::read_dir(template.join(folder)) else {
                continue;
            };
            for entry in entries.filter_map(Result::ok) {
                let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
                match entry.path().is_file() {
                    true if stated.contains(&name) => ignored.push(name),
                    true => names.push(name),
                    false => {}
                }
            }
        }
        names.sort();
        ignored.sort();
        let _ = write!(text, "; `openfoam.template` restricts the case to this gas");
        if !ignored.is_empty() {
            let list = ignored.join(", ");
            let _ = write!(
                text,
                "; its {list} are ignored, as the case states what is in them"
            );
        }
        if !names.is_empty() {
            let _ = write!(text, "; it adds {}", names.join(", "));
        }
    }
    text
}

/// Of particles whose temperature is prescribed, between what values.
fn prescribed(population: &Population) -> Option<String> {
    let values = population.prescribed_temperature.as_ref()?.0.iter();
    let values = values.map(|(_, value)| *value);
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let range = match low == high {
        true => format!("{low} K"),
        false => format!("{low} to {high} K"),
    };
    Some(format!(
        "temperature prescribed, {range}; the heat that it takes is `prescribed_heat` of the ledger"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn good(name: &str, template: &std::path::Path) -> Case {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join(format!("tests/inputs/good/{name}.toml"));
        let template = format!("openfoam.template={}", template.display());
        crate::case::read(&path, &[template]).unwrap()
    }

    #[test]
    fn a_template_adds_what_the_case_does_not_write_itself() {
        let template = tempfile::tempdir().unwrap();
        for name in [
            "0/U",
            "0/k",
            "0/alphat",
            "0/G",
            "constant/turbulenceProperties",
            "constant/fvOptions",
            "system/fvSchemes",
        ] {
            let path = template.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            let text = match name {
                "constant/turbulenceProperties" => "FoamFile {}\nsimulationType laminar;\n",
                "system/fvSchemes" => {
                    "FoamFile {}\ngradSchemes {}\ndivSchemes {}\nlaplacianSchemes {}\n"
                }
                _ => "FoamFile {}\n",
            };
            std::fs::write(path, text).unwrap();
        }
        let added = |name: &str| {
            let text = openfoam(&good(name, template.path()));
            text.split_once(" adds ").unwrap().1.to_owned()
        };
        let said = openfoam(&good("turbulent-duct", template.path()));
        let ignored =
            "its 0/U, 0/alphat, 0/k, constant/turbulenceProperties are ignored, as the case states";
        assert!(said.contains(ignored), "{said}");
        let turbulent = "0/G, constant/fvOptions, system/fvSchemes";
        assert_eq!(added("turbulent-duct"), turbulent);
        assert_eq!(
            added("two-populations"),
            "0/G, 0/alphat, 0/k, constant/fvOptions, constant/turbulenceProperties, system/fvSchemes"
        );
    }

    #[test]
    fn prescribed_temperatures_are_told_with_their_range() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join("tests/inputs/good/prescribed-temperature.toml");
        let case = crate::case::read(&path, &[]).unwrap();
        assert_eq!(prescribed(&case.particles[0]), None);
        let told = prescribed(&case.particles[1]).unwrap();
        assert!(
            told.starts_with("temperature prescribed, 1200 to 1300 K;"),
            "{told}"
        );
    }

    #[test]
    fn tolerances_that_openfoam_does_not_take_are_told_of_a_gas_that_reacts() {
        let template = tempfile::tempdir().unwrap();
        let said = |name: &str| openfoam(&good(name, template.path()));
        assert!(said("gas-mechanism").contains("but `gas.chemistry.fraction_tolerance` and"));
        assert!(said("turbulent-duct").starts_with("every key; "));
    }
}
