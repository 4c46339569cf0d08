//! `[motion.parcels]`: how parcels move.

use calcine_coupler::parcels::{ParcelCollisions, ParcelFriction, ParcelPacking};
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};

use crate::case::model::{Coupling, FreeMotion, MotionKind, MotionSpec, ParcelSpec, Population};
use crate::case::table::TableReader;
use crate::case::words::PackingScheme;

/// Keys of `[motion]` that are of particles which touch each other, and which walls may let out.
const OF_CONTACTS: [&str; 7] = [
    "contact",
    "rolling",
    "cohesion",
    "motion_step",
    "long_step",
    "attractive_damping",
    "lost",
];

pub(super) fn parcels(motion: &TableReader<'_>) -> Option<ParcelSpec> {
    for key in OF_CONTACTS.into_iter().filter(|key| motion.has(key)) {
        let rule = "stands beside `motion.parcels`, and parcels have no contacts with each other";
        let help = "remove it: parcels meet each other by the stress of the solid, and walls by `restitution` and `friction` of [[contacts]]";
        motion.fail(key, rule, help);
    }
    let table = motion.table("parcels")?;
    let courant = table.number("courant");
    let most_steps = table.small_whole("most_steps");
    let scheme = table.choice::<PackingScheme>("packing");
    let pressure = table.number("pressure");
    let exponent = table.number("exponent");
    let floor = table.number("floor");
    let close_packing = table.number("close_packing");
    let restitution = table.number("restitution");
    let damping = table.truth("damping");
    let isotropy = table.truth("isotropy");
    let seed = table.whole("seed");
    let friction = friction(&table);
    let resistance = resistance(&table);
    table.finish();
    let (scheme, damping, isotropy) = (scheme?, damping?, isotropy?);
    let collide = damping || isotropy || scheme == PackingScheme::Explicit;
    if collide && restitution.is_none() {
        let help = "add restitution = 0.9, that of two particles";
        table.fail_whole("has no `restitution`, which collisions need", help);
    }
    if isotropy && seed.is_none() {
        let help = "add seed = 1: equal seeds give equal runs";
        table.fail_whole(
            "has no `seed`, which velocities that are drawn anew need",
            help,
        );
    }
    if friction.is_some() && scheme == PackingScheme::None {
        let rule =
            "stands beside packing = \"none\", and it is the stress of the packing that presses";
        let help = "write packing = \"implicit\", or remove it";
        table.fail("friction", rule, help);
    }
    let stress = HarrisCrighton {
        pressure: pressure?,
        exponent: exponent?,
        floor: floor?,
        close_packing: close_packing?,
    };
    let restitution = restitution.unwrap_or(1.0);
    Some(ParcelSpec {
        courant: courant?,
        most_steps: most_steps?,
        close_packing: stress.close_packing,
        packing: match scheme {
            PackingScheme::Implicit => ParcelPacking::Implicit(stress),
            PackingScheme::Explicit => ParcelPacking::Explicit {
                stress,
                restitution,
            },
            PackingScheme::None => ParcelPacking::None,
        },
        collisions: ParcelCollisions {
            times: CollisionTimes {
                restitution,
                close_packing: stress.close_packing,
            },
            damping,
            isotropy,
            seed: seed.unwrap_or(0),
        },
        friction,
        resistance,
    })
}

/// `motion.parcels.friction`.
fn friction(parcels: &TableReader<'_>) -> Option<ParcelFriction> {
    let table = parcels.table("friction")?;
    let bed = table.number("bed");
    let slip = table.number("slip");
    table.finish();
    Some(ParcelFriction {
        bed: bed?,
        slip: slip?,
    })
}

/// `motion.parcels.resistance`.
fn resistance(parcels: &TableReader<'_>) -> Option<(f64, String)> {
    let table = parcels.table("resistance")?;
    let rate = table.number("rate");
    let wall = table.text("wall").map(str::to_owned);
    table.finish();
    Some((rate?, wall?))
}

/// Checks that parcels go with the rest of the case.
pub(super) fn fits(
    root: &TableReader<'_>,
    (motion, coupling): (Option<&FreeMotion>, Option<&Coupling>),
    particles: &[Population],
) {
    let parcels = |one: &Population| one.motion == MotionSpec::Parcels;
    let tables = root.tables("particles");
    let section = root.table("motion");
    let Some(spec) = motion.and_then(|motion| motion.parcels.as_ref()) else {
        let first = particles.iter().position(parcels);
        if let (Some(at), Some(section)) = (first, section) {
            let rule = format!(
                "has no table `parcels`, and `particles.{}` are parcels",
                particles[at].name
            );
            let help = "add [motion.parcels] with pressure and close_packing of the solid's stress";
            section.fail_whole(&rule, help);
        }
        return;
    };
    for (population, table) in particles.iter().zip(&tables) {
        if !parcels(population) {
            let rule = "stands beside `motion.parcels`: other particles and parcels do not meet";
            let help = "write motion = \"parcels\" for all populations, or remove [motion.parcels]";
            table.fail("motion", rule, help);
        }
    }
    let Some(section) = section else { return };
    if motion.is_some_and(|motion| motion.kind == MotionKind::Accelerated) {
        let rule = "is \"accelerated\", and parcels move in process time: AF is 1";
        section.fail("kind", rule, "write kind = \"real-time\"");
    }
    if let Some(coupling) = coupling.filter(|one| spec.close_packing > one.max_solid_fraction) {
        let rule = format!(
            "has close_packing = {}, above the largest solid fraction {} that the smoother leaves in a cell: the gas would see \
             another bed than the parcels",
            spec.close_packing, coupling.max_solid_fraction
        );
        let help =
            "lower `motion.parcels.close_packing`, or raise `coupling.smoother.max_solid_fraction`";
        section.fail("parcels", rule, help);
    }
}
