//! Boundary conditions: a case's patches, and their values at one process time.

use std::ops::Range;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{
    CompositionSchedule, GasPatch, GasSetup, InletFlow, InletScalars, InletTurbulence, PatchGas,
    Schedule, WallHeat, WallVelocity,
};

use super::error::NativeError;
use crate::numerics::gradient::FreeCells;
use crate::numerics::grid::MeshGraph;
use crate::numerics::parallel::sums;

/// Slope of a wall's velocity against the wall that counts as round-off.
const TANGENTIAL: f64 = 1e-9;
/// Slope of the velocity of a wall that turns against its faces that flat faces of a round wall may have.
const ROUND: f64 = 0.1;

/// A patch and its condition.
#[derive(Clone, Debug)]
struct Boundary {
    /// Its name.
    name: String,
    /// Its place among the patches of the mesh.
    place: usize,
    /// How many faces it has.
    count: usize,
    /// Area in m².
    area: f64,
    condition: GasPatch,
    /// First face.
    start: usize,
    /// One for the whole patch, or one a face.
    values: Vec<FaceCondition>,
    /// Centre in m and unit normal of each face, of a wall whose condition differs from face to face; else empty.
    faces: Vec<(Vec3, Vec3)>,
    /// Mass fractions of the gas that flows in; empty where none does, or for a single gas.
    composition: Vec<f64>,
}

/// The conditions of all patches.
#[derive(Clone, Debug)]
pub struct Boundaries {
    internal: usize,
    /// How many patches the mesh has, periodic ones and those without faces too.
    of_mesh: usize,
    patches: Vec<Boundary>,
    /// Index into `patches` of each boundary face.
    patch_of: Vec<u32>,
}

/// The condition of a face at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaceCondition {
    /// Gas flows in.
    Inlet {
        /// Superficial velocity into the domain in m/s.
        superficial_velocity: f64,
        /// Superficial mass flux into the domain in kg/m²/s.
        mass_flux: f64,
        /// State of the gas that flows in.
        gas: BoundaryGas,
        /// Its eddies; `None` where the gas is laminar.
        turbulence: Option<InletTurbulence>,
        /// Whether species diffuse and heat is conducted through the face.
        diffuses: bool,
    },
    /// Gas leaves at a pressure, or comes back in.
    Outlet {
        /// Pressure above the setup's pressure in Pa; of an opening at the height of its point.
        pressure: f64,
        /// Gas that comes back in; `None`: that of the cell.
        backflow: Option<BoundaryGas>,
        /// Surroundings at rest; of an opening.
        surroundings: Option<AmbientGas>,
    },
    /// A wall or a plane of symmetry.
    Wall {
        /// Velocity of the wall that the gas sticks to in m/s; `None` where it slips.
        sticks: Option<Vec3>,
        /// Heat through it.
        heat: HeatCondition,
    },
}

/// Heat through a wall at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeatCondition {
    /// None.
    Adiabatic,
    /// The wall has this temperature in K.
    Temperature(f64),
    /// Heat flux into the gas in W/m².
    Flux(f64),
    /// Exchange with surroundings.
    Convective {
        /// Overall coefficient in W/m²/K.
        coefficient: f64,
        /// Temperature of the surroundings in K.
        ambient: f64,
    },
}

/// Gas at rest beyond an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientGas {
    /// Density in kg/m³.
    pub density: f64,
    /// Point in m whose height has the pressure.
    pub at: Vec3,
}

/// The gas that flows in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryGas {
    /// Temperature in K.
    pub temperature: f64,
    /// Sensible enthalpy in J/kg.
    pub enthalpy: f64,
    /// Specific heat capacity in J/kg/K.
    pub heat_capacity: f64,
    /// Dynamic viscosity in Pa s.
    pub viscosity: f64,
    /// Thermal conductivity in W/m/K.
    pub conductivity: f64,
}

impl BoundaryGas {
    fn at(gas: &GasModel, temperature: f64, composition: &[f64]) -> Self {
        Self {
            temperature,
            enthalpy: gas.enthalpy(temperature, composition),
            heat_capacity: gas.heat_capacity(temperature, composition),
            viscosity: gas.viscosity(temperature, composition),
            conductivity: gas.conductivity(temperature, composition),
        }
    }
}

/// Checks that each boundary condition has its patch of the mesh, and each patch with faces its condition.
pub fn match_patches(mesh: &Mesh, setup: &GasSetup) -> Result<(), NativeError> {
    for (name, _) in &setup.patches {
        if mesh.patch(name).is_none() {
            let present: Vec<_> = mesh.patches().iter().map(|p| p.name.as_str()).collect();
            return Err(NativeError::NoPatch {
                patch: name.clone(),
                present: present.join(", "),
            });
        }
    }
    let mut patches = mesh.patches().iter().filter(|patch| patch.count > 0);
    patches.try_for_each(|patch| condition_of(setup, &patch.name).map(drop))
}

fn condition_of<'a>(setup: &'a GasSetup, patch: &str) -> Result<&'a GasPatch, NativeError> {
    let named = setup.patches.iter().find(|(name, _)| name == patch);
    let lacking = || NativeError::NoCondition {
        patch: patch.to_owned(),
    };
    named.map(|(_, condition)| condition).ok_or_else(lacking)
}

/// The sums of all patches.
pub fn of_all<const N: usize>(patches: &[[f64; N]]) -> [f64; N] {
    std::array::from_fn(|place| patches.iter().map(|own| own[place]).sum())
}

impl Boundaries {
    /// Matches the setup's patches with the mesh's and checks their numbers.
    pub fn new(mesh: &Mesh, setup: &GasSetup) -> Result<Self, NativeError> {
        match_patches(mesh, setup)?;
        for (name, condition) in &setup.patches {
            check(name, condition)?;
            let laminar = matches!(
                condition,
                GasPatch::Inlet {
                    turbulence: None,
                    ..
                }
            );
            if laminar && !setup.turbulence.is_laminar() {
                return Err(NativeError::NoEddies {
                    patch: name.clone(),
                });
            }
        }
        let mut boundaries = Self {
            internal: mesh.internal_faces() + mesh.periodic_faces().len(),
            of_mesh: mesh.patches().len(),
            patches: Vec::new(),
            patch_of: Vec::with_capacity(mesh.faces() - mesh.internal_faces()),
        };
        let patches = mesh.patches().iter().enumerate();
        for (place_in_mesh, patch) in patches.filter(|(_, patch)| patch.count > 0) {
            let condition = condition_of(setup, &patch.name)?;
            let joined = mesh.periodic_pair(patch.start).is_some();
            if joined != matches!(condition, GasPatch::Periodic { .. }) {
                return Err(NativeError::NotJoined {
                    patch: patch.name.clone(),
                    joined,
                });
            }
            if joined {
                continue;
            }
            if let GasPatch::Wall { velocity, .. } = condition {
                check_tangential(mesh, &patch.name, patch.faces(), velocity)?;
            }
            let index = boundaries.patches.len() as u32;
            boundaries.patch_of.extend(patch.faces().map(|_| index));
            boundaries.patches.push(Boundary {
                name: patch.name.clone(),
                place: place_in_mesh,
                count: patch.count,
                area: patch
                    .faces()
                    .map(|face| mesh.face_area()[face].norm())
                    .sum(),
                condition: condition.clone(),
                start: patch.start,
                values: Vec::new(),
                faces: if differs(condition) {
                    patch.faces().map(|face| place(mesh, face)).collect()
                } else {
                    Vec::new()
                },
                composition: Vec::new(),
            });
        }
        let inlet = |boundary: &Boundary| matches!(boundary.condition, GasPatch::Inlet { .. });
        let filled = boundaries.closed() && boundaries.patches.iter().any(inlet);
        if filled && !setup.properties.compressible() {
            return Err(NativeError::NoOutlet);
        }
        boundaries.update(setup, 0.0);
        Ok(boundaries)
    }

    /// True where no patch lets gas out.
    pub fn closed(&self) -> bool {
        !self
            .patches
            .iter()
            .any(|boundary| boundary.condition.is_open())
    }

    /// Takes up conditions that were set since.
    pub fn take(&mut self, setup: &GasSetup) {
        for boundary in &mut self.patches {
            let named = setup
                .patches
                .iter()
                .find(|(name, _)| *name == boundary.name);
            if let Some((_, condition)) = named {
                boundary.condition.clone_from(condition);
            }
        }
    }

    /// Evaluates all conditions at a process time in s.
    pub fn update(&mut self, setup: &GasSetup, time: f64) {
        for boundary in &mut self.patches {
            boundary.update(setup, time);
        }
    }

    /// The condition of a boundary face.
    #[inline]
    pub fn at(&self, face: usize) -> &FaceCondition {
        self.patches[self.patch_of[face - self.internal] as usize].at(face)
    }

    /// The cells behind walls without friction and planes of symmetry, which stay what they are; outlets count with them.
    pub fn free_cells(&self, grid: &MeshGraph) -> FreeCells {
        let slips = |face: usize| matches!(self.at(face), FaceCondition::Wall { sticks: None, .. });
        let opens = |face: usize| matches!(self.at(face), FaceCondition::Outlet { .. });
        FreeCells::find(grid, slips, opens)
    }

    /// Sums over the faces of each patch of the mesh; 0 of periodic ones and those without faces.
    pub fn by_patch<const N: usize>(
        &self,
        of_face: impl Fn(usize) -> [f64; N] + Sync,
    ) -> Vec<[f64; N]> {
        let mut values = vec![[0.0; N]; self.of_mesh];
        let mut first = self.internal;
        for boundary in &self.patches {
            values[boundary.place] = sums(boundary.count, |face| of_face(first + face));
            first += boundary.count;
        }
        values
    }

    /// The same of flows inwards, and of their magnitudes.
    pub fn flows_by_patch(&self, of_face: impl Fn(usize) -> f64 + Sync) -> Vec<[f64; 2]> {
        self.by_patch(|face| {
            let inflow = of_face(face);
            [inflow, inflow.abs()]
        })
    }

    /// True where a patch is a side of a wedge.
    pub fn has_wedges(&self) -> bool {
        self.patches
            .iter()
            .any(|boundary| boundary.condition == GasPatch::Wedge)
    }

    /// True of a boundary face on a side of a wedge.
    pub fn is_wedge(&self, face: usize) -> bool {
        let patch = self.patch_of[face - self.internal] as usize;
        self.patches[patch].condition == GasPatch::Wedge
    }

    /// Mass fractions of the gas that flows in through a boundary face; `None` where it is the cell's or none does.
    #[inline]
    pub fn composition(&self, face: usize) -> Option<&[f64]> {
        let boundary = &self.patches[self.patch_of[face - self.internal] as usize];
        boundary.at(face).entering().map(|_| &*boundary.composition)
    }

    /// k in m²/s² and its dissipation in m²/s³ of the gas that flows in through a boundary face into a cell of
    /// this void fraction; zero where none does, or the gas is laminar.
    #[inline]
    pub fn eddies(&self, face: usize, void_fraction: f64) -> [f64; 2] {
        match self.at(face) {
            FaceCondition::Inlet {
                superficial_velocity,
                turbulence: Some(turbulence),
                ..
            } => turbulence.state(superficial_velocity / void_fraction),
            _ => [0.0; 2],
        }
    }
}

impl FaceCondition {
    /// Gas that flows in, where it is stated.
    #[inline]
    pub fn entering(&self) -> Option<BoundaryGas> {
        match self {
            Self::Inlet { gas, .. } => Some(*gas),
            Self::Outlet { backflow, .. } => *backflow,
            Self::Wall { .. } => None,
        }
    }
}

impl Boundary {
    /// Takes up gas beyond the patch at a process time in s.
    fn beyond(&mut self, model: &GasModel, gas: &PatchGas, time: f64) -> BoundaryGas {
        self.composition = of_schedule(gas.composition.as_ref(), time);
        BoundaryGas::at(model, gas.temperature.at(time), &self.composition)
    }

    /// The condition of one of its faces.
    #[inline]
    fn at(&self, face: usize) -> &FaceCondition {
        match &*self.values {
            [whole] => whole,
            each => &each[face - self.start],
        }
    }

    fn update(&mut self, setup: &GasSetup, time: f64) {
        let model = &setup.properties;
        let value = match &self.condition.clone() {
            GasPatch::Inlet {
                flow,
                temperature,
                composition,
                turbulence,
                scalars,
            } => {
                self.composition = of_schedule(composition.as_ref(), time);
                let temperature = temperature.at(time);
                let density = model.density(setup.pressure, temperature, &self.composition);
                let (superficial_velocity, mass_flux) = match flow {
                    InletFlow::SuperficialVelocity(velocity) => {
                        let velocity = velocity.at(time);
                        (velocity, density * velocity)
                    }
                    InletFlow::MassFlow(flow) => {
                        let flux = flow.at(time) / self.area;
                        (flux / density, flux)
                    }
                };
                FaceCondition::Inlet {
                    superficial_velocity,
                    mass_flux,
                    gas: BoundaryGas::at(model, temperature, &self.composition),
                    turbulence: *turbulence,
                    diffuses: *scalars == InletScalars::Value,
                }
            }
            GasPatch::Outlet { pressure, backflow } => FaceCondition::Outlet {
                pressure: pressure.at(time) - setup.pressure,
                backflow: backflow.as_ref().map(|gas| self.beyond(model, gas, time)),
                surroundings: None,
            },
            GasPatch::Opening { pressure, at, gas } => {
                let gas = self.beyond(model, gas, time);
                let density = model.density(setup.pressure, gas.temperature, &self.composition);
                FaceCondition::Outlet {
                    pressure: pressure.at(time) - setup.pressure,
                    backflow: Some(gas),
                    surroundings: Some(AmbientGas { density, at: *at }),
                }
            }
            // Nothing passes the sides of a plane or axisymmetric flow, nor does it vary across them.
            GasPatch::Symmetry | GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge => {
                FaceCondition::Wall {
                    sticks: None,
                    heat: HeatCondition::Adiabatic,
                }
            }
            GasPatch::Wall { velocity, heat } if differs(&self.condition) => {
                self.values = wall_of_faces(&self.faces, velocity, heat, time);
                return;
            }
            GasPatch::Wall { velocity, heat } => FaceCondition::Wall {
                sticks: velocity.of_gas(Vec3::zeros(), Vec3::zeros()),
                heat: whole_heat(heat, time),
            },
        };
        self.values = vec![value];
    }
}

/// True where the condition of a patch differs from face to face.
fn differs(condition: &GasPatch) -> bool {
    match condition {
        GasPatch::Wall { velocity, heat } => {
            matches!(velocity, WallVelocity::Rotating { .. }) || matches!(heat, WallHeat::Along(_))
        }
        _ => false,
    }
}

/// Centre in m and unit normal of a face.
fn place(mesh: &Mesh, face: usize) -> (Vec3, Vec3) {
    (mesh.face_centre()[face], mesh.face_area()[face].normalize())
}

/// The condition of each face of a wall that turns, or has a temperature along an axis, at a process time in s.
fn wall_of_faces(
    faces: &[(Vec3, Vec3)],
    velocity: &WallVelocity,
    heat: &WallHeat,
    time: f64,
) -> Vec<FaceCondition> {
    let profile = match heat {
        WallHeat::Along(along) => Some((along, along.at(time))),
        _ => None,
    };
    let one = |&(centre, normal): &(Vec3, Vec3)| FaceCondition::Wall {
        sticks: velocity.of_gas(centre, normal),
        heat: match &profile {
            Some((along, profile)) => HeatCondition::Temperature(along.of(profile, centre)),
            None => whole_heat(heat, time),
        },
    };
    faces.iter().map(one).collect()
}

/// Heat through the whole of a wall at a process time in s.
fn whole_heat(heat: &WallHeat, time: f64) -> HeatCondition {
    match heat {
        // One of a temperature along an axis is that of its faces.
        WallHeat::Adiabatic | WallHeat::Along(_) => HeatCondition::Adiabatic,
        WallHeat::Temperature(schedule) => HeatCondition::Temperature(schedule.at(time)),
        WallHeat::Flux(schedule) => HeatCondition::Flux(schedule.at(time)),
        WallHeat::Convective {
            coefficient,
            ambient,
        } => HeatCondition::Convective {
            coefficient: coefficient.at(time),
            ambient: ambient.at(time),
        },
    }
}

/// Mass fractions at a process time in s; none of a single gas.
fn of_schedule(composition: Option<&CompositionSchedule>, time: f64) -> Vec<f64> {
    composition.map_or_else(Vec::new, |schedule| schedule.at(time))
}

/// A moving wall must slide in its own plane, and one that turns be round about its axis.
fn check_tangential(
    mesh: &Mesh,
    name: &str,
    faces: Range<usize>,
    velocity: &WallVelocity,
) -> Result<(), NativeError> {
    let (slope, rule) = match velocity {
        WallVelocity::Rotating { .. } => (
            ROUND,
            "at most a tenth of its speed: a wall turns within itself, as a drum or a disc about its axis",
        ),
        _ => (TANGENTIAL, "zero: a wall slides in its own plane"),
    };
    for face in faces {
        let (centre, normal) = place(mesh, face);
        let moves = velocity.at(centre);
        let through = moves.dot(&normal);
        if through.abs() > slope * moves.norm() {
            return Err(NativeError::Value {
                field: "the velocity through the moving wall",
                place: format!("patch `{name}`, face {face}"),
                value: through,
                unit: "m/s",
                rule,
            });
        }
    }
    Ok(())
}

fn check(name: &str, condition: &GasPatch) -> Result<(), NativeError> {
    let all = |schedule: &Schedule, field, unit, rule, allowed: fn(f64) -> bool| {
        let values = schedule.0.iter().map(|&(_, value)| value);
        match values.clone().find(|&value| !allowed(value)) {
            Some(value) => Err(NativeError::Value {
                field,
                place: format!("patch `{name}`"),
                value,
                unit,
                rule,
            }),
            None => Ok(()),
        }
    };
    let positive = |value: f64| value.is_finite() && value > 0.0;
    let not_negative = |value: f64| value.is_finite() && value >= 0.0;
    let temperature = |schedule| all(schedule, "the temperature", "K", "positive", positive);
    match condition {
        GasPatch::Inlet {
            flow,
            temperature: schedule,
            ..
        } => {
            let (flow, field, unit) = match flow {
                InletFlow::SuperficialVelocity(flow) => (flow, "the superficial velocity", "m/s"),
                InletFlow::MassFlow(flow) => (flow, "the mass flow", "kg/s"),
            };
            let rule = "zero or positive (into the domain)";
            all(flow, field, unit, rule, not_negative)?;
            temperature(schedule)
        }
        GasPatch::Outlet { pressure, backflow } => {
            all(pressure, "the pressure", "Pa", "positive", positive)?;
            backflow
                .as_ref()
                .map_or(Ok(()), |gas| temperature(&gas.temperature))
        }
        GasPatch::Opening { pressure, gas, .. } => {
            all(pressure, "the pressure", "Pa", "positive", positive)?;
            temperature(&gas.temperature)
        }
        GasPatch::Symmetry | GasPatch::Periodic { .. } | GasPatch::Empty | GasPatch::Wedge => {
            Ok(())
        }
        GasPatch::Wall { heat, .. } => match heat {
            WallHeat::Adiabatic => Ok(()),
            WallHeat::Temperature(schedule) => temperature(schedule),
            WallHeat::Along(along) => {
                let mut stations = along.stations.iter();
                stations.try_for_each(|(_, schedule)| temperature(schedule))
            }
            WallHeat::Flux(flux) => all(flux, "the heat flux", "W/m^2", "finite", f64::is_finite),
            WallHeat::Convective {
                coefficient,
                ambient,
            } => {
                let (field, rule) = ("the heat transfer coefficient", "zero or positive");
                all(coefficient, field, "W/m^2/K", rule, not_negative)?;
                temperature(ambient)
            }
        },
    }
}
