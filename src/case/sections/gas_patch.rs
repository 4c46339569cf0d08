//! `[gas.patch.NAME]`: boundary conditions of the gas.

use calcine_coupler::bodies::BodyPatch;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    AxialTemperature, CompositionSchedule, GasPatch, InletFlow, PatchGas, Schedule, WallHeat,
    WallVelocity,
};

use super::common::{direction, patches, turning};
use super::composition::{no_species, of_gas};
use super::turbulence::of_inlet;
use crate::case::model::MeshSpec;
use crate::case::table::TableReader;
use crate::case::units::shown;
use crate::case::words::Adiabatic;

/// Conditions that name no other patch.
const ALONE: [&str; 7] = [
    "inlet", "outlet", "opening", "wall", "symmetry", "empty", "wedge",
];

/// Conditions of all patches, for a gas, turbulent or not; one of constant density cannot flow into a closed domain.
pub(super) fn boundary(
    section: &TableReader<'_>,
    mesh: Option<&MeshSpec>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
    surfaces: &mut Vec<BodySurface>,
) -> Option<Vec<(String, GasPatch)>> {
    section.need("patch");
    let table = section.table("patch")?;
    let named = table.named();
    let mut made = Vec::new();
    let mut complete = true;
    for (name, reader) in &named {
        surfaces.extend(surface(name, reader));
        match patch(reader, gas, turbulent) {
            Some(patch) => made.push((name.clone(), patch)),
            None => complete = false,
        }
        reader.finish();
    }
    let stated: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
    partners(&table, &stated, &mut made, &mut complete);
    if let Some(known) = patches(mesh) {
        for (name, _) in &named {
            if !known.contains(&name.as_str()) {
                let help = format!("the patches of the mesh are {}", known.join(", "));
                table.fail(name, "is not a patch of the mesh", help);
            }
        }
        for (name, patch) in &made {
            if let GasPatch::Periodic { with } = patch
                && known.contains(&name.as_str())
                && !known.contains(&with.as_str())
            {
                let help = format!("the patches of the mesh are {}", known.join(", "));
                let rule = format!("is periodic with `{with}`, which is not a patch of the mesh");
                table.fail(name, rule, help);
                complete = false;
            }
        }
        // An entry that could not be read may be the one that names a patch as its partner.
        let unknown_partner = known.iter().any(|name| {
            let read = made.iter().any(|(other, _)| other == name);
            let mut own = named.iter().filter(|(other, _)| other == name);
            let alone = own.any(|(_, reader)| ALONE.iter().any(|kind| reader.has(kind)));
            table.has_named(name) && !read && !alone
        });
        for name in known {
            let stated = unknown_partner || named.iter().any(|(other, _)| other == name);
            if !stated && !made.iter().any(|(other, _)| other == name) {
                table.missing_like(
                    name,
                    "{ wall = { velocity = \"no-slip\", heat = \"adiabatic\" } }",
                );
                complete = false;
            }
        }
    }
    let has = |kind: fn(&GasPatch) -> bool| made.iter().any(|(_, patch)| kind(patch));
    let (inlet, outlet) = (
        has(|patch| matches!(patch, GasPatch::Inlet { .. })),
        has(GasPatch::is_open),
    );
    let fixed = gas.is_some_and(|gas| !gas.compressible());
    if complete && inlet && !outlet && fixed {
        section.fail(
            "patch",
            "lets a gas of constant density in and has no outlet",
            "give one patch outlet = { pressure = \"1 atm\" }",
        );
    }
    complete.then_some(made)
}

/// Gives each periodic patch's partner its side, where the file states one of the two, and compares them where it states both.
fn partners(
    table: &TableReader<'_>,
    stated: &[&str],
    made: &mut Vec<(String, GasPatch)>,
    complete: &mut bool,
) {
    let pairs: Vec<(String, String)> = made
        .iter()
        .filter_map(|(name, patch)| match patch {
            GasPatch::Periodic { with } => Some((name.clone(), with.clone())),
            _ => None,
        })
        .collect();
    for (name, with) in pairs {
        let mut refuse = |rule: String, help: String| {
            table.fail(&name, rule, help);
            *complete = false;
        };
        if name == with {
            let help = "name the patch on the other side".to_owned();
            refuse("is periodic with itself".to_owned(), help);
            continue;
        }
        let partner = made.iter().find(|(other, _)| *other == with);
        match partner.map(|(_, patch)| patch) {
            None if stated.contains(&with.as_str()) => *complete = false,
            None => {
                let with_this = GasPatch::Periodic { with: name };
                made.push((with, with_this));
            }
            Some(GasPatch::Periodic { with: back }) if *back == name => {}
            Some(GasPatch::Periodic { with: back }) => refuse(
                format!("is periodic with `{with}`, which is periodic with `{back}`"),
                "a periodic patch has one partner: let both name each other".to_owned(),
            ),
            Some(_) => refuse(
                format!("is periodic with `{with}`, which has another condition"),
                format!(
                    "leave out the condition of `{with}`, or write periodic = {{ with = \"{name}\" }} there"
                ),
            ),
        }
    }
}

fn patch(
    reader: &TableReader<'_>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
) -> Option<GasPatch> {
    let kind = reader.exactly_one()?;
    let table = reader.table(kind)?;
    let made = match kind {
        "inlet" => inlet(&table, gas, turbulent),
        "outlet" => outlet(&table, gas),
        "opening" => opening(&table, gas),
        "symmetry" => Some(GasPatch::Symmetry),
        "periodic" => {
            let with = table.text("with").map(str::to_owned);
            with.map(|with| GasPatch::Periodic { with })
        }
        "empty" => Some(GasPatch::Empty),
        "wedge" => Some(GasPatch::Wedge),
        _ => wall(&table),
    };
    table.finish();
    made
}

fn inlet(
    table: &TableReader<'_>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
) -> Option<GasPatch> {
    let flow = flow(table);
    let entering = entering(table, gas);
    let turbulence = of_inlet(table, turbulent);
    let scalars = table.choice("scalars");
    let PatchGas {
        temperature,
        composition,
    } = entering?;
    Some(GasPatch::Inlet {
        flow: flow?,
        temperature,
        composition,
        turbulence: turbulence?,
        scalars: scalars?,
    })
}

fn outlet(table: &TableReader<'_>, gas: Option<&GasModel>) -> Option<GasPatch> {
    let pressure = table.schedule("pressure");
    let backflow = match table.table("backflow") {
        Some(inner) => {
            let made = entering(&inner, gas);
            inner.finish();
            Some(made?)
        }
        None => None,
    };
    Some(GasPatch::Outlet {
        pressure: pressure?,
        backflow,
    })
}

fn opening(table: &TableReader<'_>, gas: Option<&GasModel>) -> Option<GasPatch> {
    let pressure = table.schedule("pressure");
    let at = table.vector("pressure_at").unwrap_or([0.0; 3]);
    let gas = entering(table, gas);
    Some(GasPatch::Opening {
        pressure: pressure?,
        at: Vec3::from(at),
        gas: gas?,
    })
}

/// `temperature` and `composition` of gas that comes in.
fn entering(table: &TableReader<'_>, gas: Option<&GasModel>) -> Option<PatchGas> {
    let temperature = table.schedule("temperature");
    let composition = match gas {
        Some(GasModel::Mixture(mixture)) => Some(composition(table, mixture)?),
        Some(_) => {
            no_species(table);
            None
        }
        None => {
            table.has("composition");
            None
        }
    };
    Some(PatchGas {
        temperature: temperature?,
        composition,
    })
}

/// `composition` of the gas that flows in.
fn composition(table: &TableReader<'_>, mixture: &Mixture) -> Option<CompositionSchedule> {
    let Some(dated) = table.dated_tables("composition") else {
        table.need("composition");
        return None;
    };
    let mut entries = Vec::new();
    for (time, entry) in &dated {
        entries.push((*time, of_gas(entry, mixture)?));
    }
    Some(CompositionSchedule(entries))
}

/// `superficial_velocity` or `mass_flow`.
fn flow(table: &TableReader<'_>) -> Option<InletFlow> {
    let keys = ["superficial_velocity", "mass_flow"];
    let mut given = keys.iter().copied().filter(|key| table.has(key));
    let (key, more) = (given.next().unwrap_or(keys[0]), given.next());
    if more.is_some() {
        table.fail(
            "mass_flow",
            "stands beside `superficial_velocity`",
            "state one of the two",
        );
        return None;
    }
    table.need(key);
    let schedule = table.schedule(key)?;
    Some(if key == keys[0] {
        InletFlow::SuperficialVelocity(schedule)
    } else {
        InletFlow::MassFlow(schedule)
    })
}

fn wall(table: &TableReader<'_>) -> Option<GasPatch> {
    let velocity = wall_velocity(table);
    let heat = if table.is_table("heat") {
        let inner = table.table("heat")?;
        let heat = wall_heat(&inner);
        inner.finish();
        heat
    } else {
        let word = table.choice("heat");
        word.map(|Adiabatic| WallHeat::Adiabatic)
    };
    Some(GasPatch::Wall {
        velocity: velocity?,
        heat: heat?,
    })
}

/// `"no-slip"`, `"slip"`, `{ moving = "1 0 0 m/s" }`, or `{ rotating = { point = …, angular_velocity = … } }`.
fn wall_velocity(table: &TableReader<'_>) -> Option<WallVelocity> {
    if !table.is_table("velocity") {
        return table.choice("velocity");
    }
    let inner = table.table("velocity")?;
    let made = match inner.exactly_one() {
        Some("moving") => inner
            .vector("moving")
            .map(|velocity| WallVelocity::Moving(velocity.into())),
        Some(_) => inner
            .table("rotating")
            .and_then(|rotating| turning(&rotating))
            .map(|(point, angular_velocity)| WallVelocity::Rotating {
                point,
                angular_velocity,
            }),
        None => None,
    };
    inner.finish();
    made
}

/// A patch that is the surface of a body that stores heat.
pub(super) struct BodySurface {
    /// Name of the body.
    pub body: String,
    /// The patch.
    pub patch: BodyPatch,
}

/// What a patch says of the body that it is the surface of.
fn surface(name: &str, reader: &TableReader<'_>) -> Option<BodySurface> {
    if !reader.is_table("wall") {
        return None;
    }
    let wall = reader.table("wall")?;
    if !wall.is_table("heat") {
        return None;
    }
    let heat = wall.table("heat")?;
    if !heat.has("body") {
        return None;
    }
    let (body, film) = (heat.text("body"), heat.number("film"));
    Some(BodySurface {
        body: body?.to_owned(),
        patch: BodyPatch {
            name: name.to_owned(),
            film,
        },
    })
}

/// `{ temperature = … }`, `{ along = … }`, `{ flux = … }`, `{ coefficient = …, ambient = … }`, or `{ body = … }`.
fn wall_heat(table: &TableReader<'_>) -> Option<WallHeat> {
    let kinds = ["temperature", "along", "flux", "coefficient", "body"];
    let mut given = kinds.iter().copied().filter(|kind| table.has(kind));
    let (kind, more) = (given.next(), given.next());
    let (Some(kind), None) = (kind, more) else {
        table.fail_whole(
            "needs exactly one of temperature, along, flux, body, and coefficient with ambient",
            "for example { coefficient = \"10 W/m^2/K\", ambient = \"300 K\" }",
        );
        return None;
    };
    match kind {
        "temperature" => table.schedule(kind).map(WallHeat::Temperature),
        "along" => along(&table.table(kind)?).map(WallHeat::Along),
        "flux" => table.schedule(kind).map(WallHeat::Flux),
        // What the body gives comes as exchange with the cells at the wall.
        "body" => {
            // Read as that of a surface, with all that is wrong of it.
            table.raw("film");
            Some(WallHeat::Adiabatic)
        }
        _ => {
            let coefficient = table.schedule(kind);
            table.need("ambient");
            let ambient = table.schedule("ambient");
            Some(WallHeat::Convective {
                coefficient: coefficient?,
                ambient: ambient?,
            })
        }
    }
}

/// `{ axis = …, stations = [{ at = …, temperature = … }, …] }`.
fn along(table: &TableReader<'_>) -> Option<AxialTemperature> {
    let axis = direction(table, "axis");
    let list = table.tables("stations");
    let station = |one: &TableReader<'_>| {
        let (at, temperature) = (one.number("at"), one.schedule("temperature"));
        one.finish();
        Some((at?, temperature?))
    };
    let stations: Vec<(f64, Schedule)> = list.iter().filter_map(station).collect();
    table.finish();
    if stations.len() < list.len() {
        return None;
    }
    if stations.len() < 2 {
        let rule = format!("has {} of at least two stations", stations.len());
        let help = "state two or more, for example [{ at = \"0 mm\", temperature = \"300 K\" }, { at = \"200 mm\", temperature = \"600 K\" }]; \
                    for one temperature write `temperature`";
        table.fail("stations", rule, help);
        return None;
    }
    let falls = stations.windows(2).position(|pair| pair[1].0 <= pair[0].0);
    if let Some(index) = falls {
        let [before, after] = [stations[index].0, stations[index + 1].0];
        let rule = format!("goes from {} m to {} m", shown(before), shown(after));
        table.fail("stations", rule, "sort the stations by `at`, each once");
        return None;
    }
    Some(AxialTemperature {
        axis: axis?,
        stations,
    })
}
