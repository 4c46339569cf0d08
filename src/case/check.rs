//! What `calcine check` says of a case that is in order.

use std::f64::consts::PI;
use std::fmt::Write as _;

use calcine_adapters::openfoam::{chemistry, turbulence};
use calcine_coupler::gas_chemistry::Combustion;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::film::{FilmDiffusivity, ReferenceDiffusivity};
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::law::NONE;
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::numbers::VoidFraction;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::{GasPatch, InletFlow};

use super::cautions::cautions;
use super::model::{Case, MotionSpec, Population};
use super::{buoyancy, mesh_shape, ranges, sizes};

/// Above this, a number of the time splitting gets a warning (docs/theory.md, TSM-6, TSM-8).
const WARNING: f64 = 0.1;

/// Clocks, sizes, and how far the time splitting may be from the unsplit run.
/// `void_fraction`: mean over the cells that hold particles.
pub fn check_report(case: &Case, mesh: &Mesh, particles: usize, void_fraction: f64) -> String {
    let cells = mesh.cells();
    let mut text = format!("{} ({})\n", case.title, case.path.display());
    for change in &case.changes {
        let _ = writeln!(text, "  set            {change}");
    }
    let time = &case.time;
    let (mut motion, mut windows, mut from) = (0.0, 0.0, 0.0);
    for (index, &(start, factor)) in time.acceleration.steps().iter().enumerate() {
        let next = time
            .acceleration
            .steps()
            .get(index + 1)
            .map_or(time.end, |step| step.0.min(time.end));
        from = start.seconds().max(from);
        let length = (next.seconds() - start.seconds()).max(0.0) / factor;
        motion += length;
        windows += (length / time.motion_window.seconds()).ceil();
        let _ = writeln!(text, "  from {} of process time   AF {factor}", start);
    }
    let _ = writeln!(
        text,
        "  process time   {} in {windows:.0} windows",
        time.end
    );
    let _ = writeln!(
        text,
        "  motion time    {motion} s, windows of {}{}",
        time.motion_window,
        if time.process_step.is_some() {
            " (chosen for `process_step`)"
        } else {
            ""
        }
    );
    let _ = writeln!(text, "  gas storage    {}", time.storage.name());
    let _ = writeln!(text, "  mesh           {cells} cells");
    let (shape, badly_shaped) = mesh_shape::report(mesh);
    for line in shape {
        let _ = writeln!(text, "                 {line}");
    }
    let _ = writeln!(
        text,
        "  bed            {particles} particles, void fraction {void_fraction:.3}"
    );
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
    let number = buoyancy::number(case, mesh);
    let _ = match number > 0.0 {
        true => writeln!(
            text,
            "  buoyancy       N sqrt(AF) dt is {number:.2e}; waves are resolved below {}",
            buoyancy::LIMIT
        ),
        false => writeln!(text, "  buoyancy       none"),
    };
    if let Some(warning) = buoyancy::warning(number) {
        let _ = writeln!(text, "  warning: {warning}");
    }
    for warning in cautions(case).into_iter().chain(badly_shaped) {
        let _ = writeln!(text, "  warning: {warning}");
    }
    for population in &case.particles {
        splitting(&mut text, case, population, void_fraction);
        if let Some(line) = prescribed(population) {
            let _ = writeln!(text, "    {line}");
        }
    }
    honoured(&mut text, case);
    text
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

/// What each backend makes of the case.
fn honoured(text: &mut String, case: &Case) {
    let _ = writeln!(text, "  backends:");
    let external = case.external_gas.as_ref().map(|_| "external gas");
    let names = ["native gas", "OpenFOAM", "native particles", "LIGGGHTS"];
    let particles = case.external_particles.as_ref();
    let particles = particles.map(|_| "external particles");
    for name in names.into_iter().chain(external).chain(particles) {
        let foam = openfoam(case);
        let note = match name {
            "OpenFOAM" => foam.as_str(),
            "native gas" if case.openfoam.start.is_some() => {
                "not its start: `openfoam.start` is the start of an OpenFOAM gas alone"
            }
            "native gas" if case.openfoam.template.is_some() => {
                "every key but `openfoam.template`: what only the template states is left out"
            }
            "LIGGGHTS" if case.liggghts.template.is_some() => {
                "every key; contacts, walls and integration are those of `liggghts.template`, which restricts \
                 the case to these particles where they differ from the case's"
            }
            "native particles" if case.liggghts.template.is_some() => {
                "every key but `liggghts.template`: what only the script states is left out"
            }
            "external gas" => {
                "its own settings: of the case's gas it is told what the particles exchange, and must have the same mesh"
            }
            "external particles" => {
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
    let mut stated = stated(case);
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
        let mut names = Vec::new();
        for folder in ["0", "constant", "system"] {
            let Ok(entries) = std::fs::read_dir(template.join(folder)) else {
                continue;
            };
            for entry in entries.filter_map(Result::ok) {
                let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
                if entry.path().is_file() && !stated.contains(&name) {
                    names.push(name);
                }
            }
        }
        names.sort();
        let _ = write!(
            text,
            "; `openfoam.template`, which restricts the case to this gas, adds {}",
            names.join(", ")
        );
    }
    text
}

/// Files of a template over which OpenFOAM's case is written, without those of reactions.
fn stated(case: &Case) -> Vec<String> {
    let always = [
        "0/U",
        "0/T",
        "0/p",
        "0/p_rgh",
        "constant/g",
        "constant/thermophysicalProperties",
    ];
    let eddies = turbulence::files(&case.gas, "").into_iter();
    let eddies = eddies
        .map(|file| file.0)
        // A template's own options stay beside.
        .filter(|name| *name != "constant/fvOptions");
    let species = case.gas.properties.species().iter();
    let species = species.map(|name| format!("0/{name}"));
    let names = always.into_iter().chain(eddies).map(str::to_owned);
    names.chain(species).collect()
}

/// R, the error of process storage, and the window against the drag's own time.
fn splitting(text: &mut String, case: &Case, population: &Population, eps: f64) {
    let material = &case.materials[population.material];
    let gas = &case.gas.properties;
    let solid_capacity = material.heat_capacity.at(case.gas.temperature);
    let factor = case.time.acceleration.largest();
    let density = gas.density(
        case.gas.pressure,
        case.gas.temperature,
        &case.gas.composition,
    );
    let capacity = gas.heat_capacity(case.gas.temperature, &case.gas.composition);
    let solid = (1.0 - eps) * material.density * solid_capacity;
    let ratio = factor * eps * density * capacity / solid;
    let Some(local) = local(case, eps, density) else {
        return;
    };
    let Ok(d) = population.sizes.mean() else {
        return;
    };
    let nusselt = case.laws.heat_transfer.make().nusselt(&local, d);
    let volume = sphere::volume_of_diameter(d);
    let rate = nusselt * local.conductivity * PI * d / (material.density * volume * solid_capacity);
    // Requirements TSM-8: the error of process storage in shares of the span.
    let error = 0.11 * rate * factor * case.time.motion_window.seconds();
    let warn = |value: f64| {
        if value > WARNING {
            "   warning: above 0.1"
        } else {
            ""
        }
    };
    let _ = writeln!(text, "  {}:", population.name);
    let _ = writeln!(
        text,
        "    R, gas heat stored over solid heat stored times AF   {ratio:.4}{}",
        if case.time.storage == calcine_coupler::time::GasStorage::Accelerated {
            warn(ratio)
        } else {
            " (matters with `accelerated` storage)"
        }
    );
    let _ = writeln!(
        text,
        "    0.11 hA AF dt/(m c), error of process storage       {error:.2e}{}",
        warn(error)
    );
    for line in ranges::lines(case, &local, d) {
        let _ = writeln!(text, "    {line}");
    }
    if !case.laws.drag.is_none() {
        let coefficient = case.laws.drag.make().coefficient(&local, d);
        let response = material.density * volume / coefficient;
        let window = case.time.motion_window.seconds();
        let share = window / response;
        let constant =
            population.motion == MotionSpec::Free && !case.coupling.window_drag.follows();
        let _ = writeln!(
            text,
            "    window over the drag's time m/K                      {share:.2e}{}",
            match constant && share > 1.0 {
                true => "   long: shorten it, or write coupling.window_drag = \"following\"",
                false => "",
            }
        );
    }
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

/// The gas at the start, at the fastest inlet's superficial velocity.
fn local(case: &Case, eps: f64, density: f64) -> Option<LocalGas> {
    let fastest = case
        .gas
        .patches
        .iter()
        .filter_map(|(_, patch)| match patch {
            GasPatch::Inlet {
                flow: InletFlow::SuperficialVelocity(velocity),
                ..
            } => Some(velocity.0.iter().map(|entry| entry.1).fold(0.0, f64::max)),
            _ => None,
        })
        .fold(case.gas.velocity.norm(), f64::max);
    let gas = &case.gas.properties;
    Some(LocalGas {
        void_fraction: VoidFraction::new(eps).ok()?,
        density,
        viscosity: gas.viscosity(case.gas.temperature, &case.gas.composition),
        conductivity: gas.conductivity(case.gas.temperature, &case.gas.composition),
        heat_capacity: gas.heat_capacity(case.gas.temperature, &case.gas.composition),
        slip: fastest / eps,
    })
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
            std::fs::write(path, "").unwrap();
        }
        let added = |name: &str| {
            let text = openfoam(&good(name, template.path()));
            text.split_once(" adds ").unwrap().1.to_owned()
        };
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
