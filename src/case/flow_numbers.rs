//! What an engineer asks of the flow of a case before it runs: is it slow enough for a gas without sound, does it carry the bed,
//! what does the bed resist, and how does the window compare with it.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::numbers::VoidFraction;
use calcine_coupler::physics::pressure_drop::{ergun, minimum_fluidisation};
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::{Convection, GasPatch, ParticleSetup, Schedule};

use super::accuracy_cautions;
use super::model::{Case, MotionSpec};
use super::packed::BedPacking;
use super::patch_cautions::centre;
use super::step;
use super::units::short3;

/// Mach number above which the density of a gas follows its velocity by more than 5 %.
const LOW_MACH: f64 = 0.3;
/// Share of the pressure above which a pressure drop changes the density of the gas, which the low-Mach form takes at one pressure.
const PRESSURE_SHARE: f64 = 0.1;
/// Solid fraction from which particles are a packed bed.
const PACKED: f64 = 0.35;
/// Fewest particles of which a bed is made.
const FEWEST: usize = 20;
/// Angle in degrees and Reynolds number of a cell above which central convection is warned of: at 42 degrees and 200 velocities were 1.7
/// times what other schemes have, up to 66 within 2 %.
const LEANS: f64 = 20.0;
const WAVY: f64 = 100.0;
/// Share of the length of an axis that the way from inlets to outlets must have along it to be called that of the flow.
const ALONG: f64 = 0.9;

/// Numbers of the flow at its fastest.
pub(super) struct FlowNumbers {
    /// Largest superficial velocity of an inlet in m/s.
    speed: f64,
    /// Largest Mach number, at an inlet or in the gaps of the bed.
    mach: Option<f64>,
    /// Largest number of cells that the gas crosses in a window.
    courant: f64,
    /// Time in s in which inlets renew the gas.
    residence: f64,
    /// Windows over that time, on the process clock.
    windows: f64,
    /// Reynolds number of a cell at the speed of the fastest inlet, and by how many degrees cells lean at most; of central convection.
    undamped: Option<[f64; 2]>,
    bed: Option<BedNumbers>,
}

/// Numbers of the flow through a packed bed.
struct BedNumbers {
    /// Superficial velocity in m/s.
    superficial: f64,
    /// Length along the flow in m.
    length: f64,
    /// Ergun's pressure drop in Pa.
    pressure_drop: f64,
    /// Temperature in K of its gas, the hottest that flows in.
    temperature: f64,
    /// Velocity of minimum fluidisation in m/s, where the flow goes up.
    fluidisation: Option<f64>,
}

impl FlowNumbers {
    /// Of a case whose gas flows in through inlets; `None` where it does not.
    pub(super) fn of(
        case: &Case,
        mesh: &Mesh,
        setup: &ParticleSetup,
        packing: &BedPacking,
    ) -> Option<Self> {
        if case.gas_held {
            return None;
        }
        let inlets = inlets(case, mesh);
        let flow: f64 = inlets.iter().map(|one| one.flow).sum();
        if !(flow > 0.0 && flow.is_finite()) {
            return None;
        }
        let gas = &case.gas;
        let temperature = inlets.iter().map(|one| one.temperature);
        let temperature = temperature.fold(0.0, f64::max);
        let speed = inlets.iter().map(|one| one.speed).fold(0.0, f64::max);
        let bed = bed(case, mesh, setup, packing, &inlets);
        let pores = packing.void_fraction;
        let in_bed = bed.as_ref().map_or(0.0, |bed| bed.superficial / pores);
        let fastest = in_bed.max(speed);
        let sound = gas.properties.sound_speed(temperature, &gas.composition);
        let room: f64 = mesh.cell_volume().iter().sum();
        let radii = setup.radius.iter().enumerate();
        let solid: f64 = radii
            .map(|(row, radius)| setup.weight_of(row) * sphere::volume(*radius))
            .sum();
        let residence = (room - solid).max(0.0) / flow;
        let window = case.time.motion_window.seconds();
        let size = (room / mesh.cells() as f64).cbrt();
        let at_inlets = inlets.iter().map(|one| one.crossed * window);
        let central = matches!(gas.controls.convection, Convection::Central(share) if share > 0.5);
        let properties = &gas.properties;
        let undamped = central.then(|| {
            let density = properties.density(gas.pressure, temperature, &gas.composition);
            let viscosity = properties.viscosity(temperature, &gas.composition);
            let leaning = mesh.quality().map_or(0.0, |quality| quality.angle.value);
            [speed * size * density / viscosity, leaning]
        });
        Some(Self {
            speed,
            mach: sound.map(|sound| fastest / sound),
            courant: at_inlets.fold(in_bed * window / size, f64::max),
            residence,
            windows: window * case.time.acceleration.largest() / residence,
            undamped,
            bed,
        })
    }

    /// Lines of `check`.
    pub(super) fn lines(&self) -> Vec<String> {
        let mach = self
            .mach
            .map(|mach| format!(", Mach number {}", short3(mach)));
        let mut lines = vec![
            format!(
                "inlets         {} m/s at most{}, Courant number {}",
                short3(self.speed),
                mach.unwrap_or_default(),
                short3(self.courant)
            ),
            format!(
                "residence time {} s of the gas; a window is {} of it",
                short3(self.residence),
                short3(self.windows)
            ),
        ];
        lines.extend(self.bed.as_ref().map(|bed| {
            let fluidisation = bed.fluidisation.map(|least| {
                format!(
                    ", {} of minimum fluidisation ({} m/s)",
                    short3(bed.superficial / least),
                    short3(least)
                )
            });
            format!(
                "flow in bed    {} m/s (superficial){}; pressure drop about {} Pa over {} m (Ergun, gas of {} K)",
                short3(bed.superficial),
                fluidisation.unwrap_or_default(),
                short3(bed.pressure_drop),
                short3(bed.length),
                short3(bed.temperature)
            )
        }));
        lines
    }

    /// What of it is to be warned of.
    pub(super) fn warnings(&self, case: &Case) -> Vec<String> {
        let mut all: Vec<String> = accuracy_cautions::courant(case, self.courant)
            .into_iter()
            .collect();
        if let Some(mach) = self.mach.filter(|mach| *mach > LOW_MACH) {
            all.push(format!(
                "the gas flows at a Mach number of {} (inlets of {} m/s at most), above {LOW_MACH}: its density follows its velocity, which \
                 low-Mach flow leaves out; lower the flow, or check its unit",
                short3(mach),
                short3(self.speed)
            ));
        }
        if let Some([reynolds, leaning]) = self.undamped
            && leaning > LEANS
            && reynolds > WAVY
        {
            all.push(format!(
                "central convection at a cell Reynolds number of about {} on cells that lean by up to {:.0} degrees: it does not damp what \
                 such cells excite, and velocities may grow beyond any bound; write gas.controls.convection = \"van-leer\", or a \
                 finer mesh",
                short3(reynolds),
                leaning
            ));
        }
        let Some(bed) = &self.bed else {
            return all;
        };
        let pressure = case.gas.pressure;
        let is_gas = self.mach.is_some();
        if is_gas && bed.pressure_drop > PRESSURE_SHARE * pressure {
            all.push(format!(
                "the bed resists a flow of {} m/s with about {} Pa (Ergun), {} % of `gas.initial.pressure`: the density of the gas is \
                 taken at that one pressure, and is off by this share; lower the flow, or use larger particles",
                short3(bed.superficial),
                short3(bed.pressure_drop),
                short3(100.0 * bed.pressure_drop / pressure)
            ));
        }
        let frozen = case
            .particles
            .iter()
            .find(|one| one.motion == MotionSpec::Frozen);
        if let (Some(least), Some(frozen)) = (bed.fluidisation, frozen)
            && bed.superficial > least
        {
            all.push(format!(
                "`particles.{}` is frozen, but gas flows up through it at {} m/s, {} times its minimum fluidisation of {} m/s: free \
                 particles would be carried; write motion = \"free\", or lower the flow",
                frozen.name,
                short3(bed.superficial),
                short3(bed.superficial / least),
                short3(least)
            ));
        }
        all
    }
}

/// An inlet at its fastest.
struct InletFlowNumbers {
    /// Superficial velocity in m/s.
    speed: f64,
    /// Volume flow in m³/s.
    flow: f64,
    /// Temperature in K.
    temperature: f64,
    /// Cells behind it that it crosses in a second, at most.
    crossed: f64,
    /// Its centre in m.
    centre: Vec3,
}

fn inlets(case: &Case, mesh: &Mesh) -> Vec<InletFlowNumbers> {
    let largest = |schedule: &Schedule| schedule.0.iter().map(|entry| entry.1).fold(0.0, f64::max);
    let patches = case.gas.patches.iter();
    let flowing = patches.filter_map(|(name, patch)| {
        let GasPatch::Inlet { temperature, .. } = patch else {
            return None;
        };
        let speed = step::fastest_in(case, mesh, name, patch);
        let faces = mesh.patch(name)?.faces();
        let widths = faces.map(|face| {
            let cell = mesh.owner()[face] as usize;
            mesh.face_area()[face].norm() / mesh.cell_volume()[cell]
        });
        Some(InletFlowNumbers {
            speed,
            flow: speed * step::area(mesh, name),
            temperature: largest(temperature),
            crossed: speed * widths.fold(0.0, f64::max),
            centre: centre(mesh, name)?,
        })
    });
    flowing.filter(|one| one.flow > 0.0).collect()
}

/// The axis along which gas flows from inlets to the first patch that lets it out, with its sign; `None` where it goes aslant.
fn direction(case: &Case, mesh: &Mesh, inlets: &[InletFlowNumbers]) -> Option<(usize, f64)> {
    let out = case.gas.patches.iter().find_map(|(name, patch)| {
        matches!(patch, GasPatch::Outlet { .. } | GasPatch::Opening { .. })
            .then(|| centre(mesh, name))
            .flatten()
    })?;
    let flow: f64 = inlets.iter().map(|one| one.flow).sum();
    let parts = inlets.iter().map(|one| one.centre * one.flow);
    let from = parts.sum::<Vec3>() / flow;
    let way = out - from;
    let axis = way.iamax();
    (way[axis].abs() > ALONG * way.norm()).then(|| (axis, way[axis].signum()))
}

fn bed(
    case: &Case,
    mesh: &Mesh,
    setup: &ParticleSetup,
    packing: &BedPacking,
    inlets: &[InletFlowNumbers],
) -> Option<BedNumbers> {
    if setup.radius.len() < FEWEST || packing.solid_fraction < PACKED {
        return None;
    }
    let (axis, sign) = direction(case, mesh, inlets)?;
    let spheres = setup.position.iter().zip(&setup.radius);
    let (low, high) = spheres.fold((f64::MAX, f64::MIN), |(low, high), (at, radius)| {
        (low.min(at[axis] - radius), high.max(at[axis] + radius))
    });
    let length = high - low;
    // Sauter's diameter Σ d³/Σ d², and the density of all solid.
    let (mut solid, mut surface, mut mass) = (0.0, 0.0, 0.0);
    for (row, &radius) in setup.radius.iter().enumerate() {
        let population = &case.particles[setup.population[row] as usize];
        let volume = setup.weight_of(row) * sphere::volume(radius);
        solid += volume;
        surface += volume / radius;
        mass += volume * case.materials[population.material].density;
    }
    let diameter = 2.0 * solid / surface;
    let section = solid / packing.solid_fraction / length;
    let flow: f64 = inlets.iter().map(|one| one.flow).sum();
    let superficial = flow / section;
    let gas = &case.gas;
    let temperature = inlets.iter().map(|one| one.temperature).fold(0.0, f64::max);
    let properties = &gas.properties;
    let density = properties.density(gas.pressure, temperature, &gas.composition);
    let viscosity = properties.viscosity(temperature, &gas.composition);
    let pores = VoidFraction::new(1.0 - packing.solid_fraction).ok()?;
    let gradient = ergun(pores, superficial, density, viscosity, diameter);
    let gravity = -sign * gas.gravity[axis];
    let fluidisation = minimum_fluidisation(
        pores,
        mass / solid,
        density,
        viscosity,
        diameter,
        gravity.max(0.0),
    );
    Some(BedNumbers {
        superficial,
        temperature,
        length,
        pressure_drop: gradient * length,
        fluidisation: (fluidisation > 0.0).then_some(fluidisation),
    })
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    /// The warning about a shipped or good case with keys set that has these words.
    fn told(name: &str, set: &[&str], words: &str) -> Option<String> {
        let all = warned(name, set);
        all.into_iter().find(|one| one.contains(words))
    }

    #[test]
    fn gas_too_fast_for_the_low_mach_form_is_told() {
        let inlet = |speed: &str| format!("gas.patch.bottom.inlet.superficial_velocity={speed}");
        let at = |speed: &str| told("turbulent-duct", &[&inlet(speed)], "a Mach number of");
        assert_eq!(at("50 m/s"), None);
        let text = at("200 m/s").unwrap();
        assert!(text.contains("inlets of 200 m/s at most"), "{text}");
    }

    #[test]
    fn a_pressure_drop_that_changes_the_density_and_a_flow_that_carries_a_frozen_bed_are_told() {
        let fast = ["gas.patch.bottom.inlet.superficial_velocity=50 m/s"];
        let slow = ["gas.patch.bottom.inlet.superficial_velocity=0.2 m/s"];
        let gravity = "gas.gravity=0 0 -9.81 m/s^2";
        let case = "../../../cases/packed-column";
        for (words, set) in [
            ("(Ergun), ", &fast[..]),
            ("is frozen, but gas flows up", &[fast[0], gravity]),
        ] {
            assert!(told(case, set, words).is_some(), "{words}");
            assert_eq!(told(case, &slow, words), None, "{words}");
        }
    }
}
