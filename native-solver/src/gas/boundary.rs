//! Boundary conditions: a case's patches, and their values at one process time.

use std::ops::Range;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::setup::{GasPatch, GasSetup, Schedule, WallHeat};

use super::error::NativeError;

/// A patch and its condition.
#[derive(Clone, Debug)]
struct Boundary {
    faces: Range<usize>,
    condition: GasPatch,
}

/// The conditions of all patches.
#[derive(Clone, Debug)]
pub struct Boundaries {
    internal: usize,
    patches: Vec<Boundary>,
    /// Index into `patches` of each boundary face.
    patch_of: Vec<u32>,
    values: Vec<Value>,
}

/// The condition of a face at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Gas flows in.
    Inlet {
        /// Superficial velocity into the domain in m/s.
        superficial_velocity: f64,
        /// Superficial mass flux into the domain in kg/m²/s.
        mass_flux: f64,
        /// State of the gas that flows in.
        gas: BoundaryGas,
    },
    /// Gas leaves at a pressure.
    Outlet {
        /// Pressure above the reference pressure in Pa.
        pressure: f64,
    },
    /// A wall.
    Wall {
        /// True: the gas sticks to it.
        no_slip: bool,
        /// State of the gas at a wall of fixed temperature; `None` where it is adiabatic.
        gas: Option<BoundaryGas>,
    },
}

/// The gas at a boundary of fixed temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryGas {
    /// Sensible enthalpy in J/kg.
    pub enthalpy: f64,
    /// Dynamic viscosity in Pa s.
    pub viscosity: f64,
    /// Thermal conductivity in W/m/K.
    pub conductivity: f64,
}

impl BoundaryGas {
    fn at(properties: &GasProperties, temperature: f64) -> Self {
        Self {
            enthalpy: properties.enthalpy(temperature),
            viscosity: properties.viscosity(temperature),
            conductivity: properties.conductivity(temperature),
        }
    }
}

impl Boundaries {
    /// Matches the setup's patches with the mesh's and checks their numbers.
    pub fn new(mesh: &Mesh, setup: &GasSetup) -> Result<Self, NativeError> {
        for (name, condition) in &setup.patches {
            if mesh.patch(name).is_none() {
                let present: Vec<_> = mesh.patches().iter().map(|p| p.name.as_str()).collect();
                return Err(NativeError::NoPatch {
                    patch: name.clone(),
                    present: present.join(", "),
                });
            }
            check(name, condition)?;
        }
        let mut boundaries = Self {
            internal: mesh.internal_faces(),
            patches: Vec::new(),
            patch_of: Vec::with_capacity(mesh.faces() - mesh.internal_faces()),
            values: Vec::new(),
        };
        for patch in mesh.patches().iter().filter(|patch| patch.count > 0) {
            let named = setup.patches.iter().find(|(name, _)| *name == patch.name);
            let Some((_, condition)) = named else {
                return Err(NativeError::NoCondition {
                    patch: patch.name.clone(),
                });
            };
            let index = boundaries.patches.len() as u32;
            boundaries.patch_of.extend(patch.faces().map(|_| index));
            boundaries.patches.push(Boundary {
                faces: patch.faces(),
                condition: condition.clone(),
            });
        }
        let outlet = |boundary: &Boundary| matches!(boundary.condition, GasPatch::Outlet { .. });
        if !boundaries.patches.iter().any(outlet) {
            return Err(NativeError::NoOutlet);
        }
        boundaries.update(setup, 0.0);
        Ok(boundaries)
    }

    /// Evaluates all conditions at a process time in s.
    pub fn update(&mut self, setup: &GasSetup, time: f64) {
        let properties = &setup.properties;
        let value = |boundary: &Boundary| match &boundary.condition {
            GasPatch::Inlet {
                superficial_velocity,
                temperature,
            } => {
                let (velocity, temperature) = (superficial_velocity.at(time), temperature.at(time));
                Value::Inlet {
                    superficial_velocity: velocity,
                    mass_flux: properties.density(setup.pressure, temperature) * velocity,
                    gas: BoundaryGas::at(properties, temperature),
                }
            }
            GasPatch::Outlet { pressure } => Value::Outlet {
                pressure: pressure - setup.pressure,
            },
            GasPatch::Wall { no_slip, heat } => Value::Wall {
                no_slip: *no_slip,
                gas: match heat {
                    WallHeat::Adiabatic => None,
                    WallHeat::Temperature(schedule) => {
                        Some(BoundaryGas::at(properties, schedule.at(time)))
                    }
                },
            },
        };
        self.values.clear();
        self.values.extend(self.patches.iter().map(value));
    }

    /// The condition of a boundary face.
    #[inline]
    pub fn at(&self, face: usize) -> Value {
        self.values[self.patch_of[face - self.internal] as usize]
    }

    /// Faces and condition of each patch.
    pub fn patches(&self) -> impl Iterator<Item = (Range<usize>, Value)> + '_ {
        let patches = self.patches.iter().zip(&self.values);
        patches.map(|(boundary, &value)| (boundary.faces.clone(), value))
    }
}

fn check(name: &str, condition: &GasPatch) -> Result<(), NativeError> {
    let place = || format!("patch `{name}`");
    let all = |schedule: &Schedule, field, unit, rule, allowed: fn(f64) -> bool| {
        let values = schedule.0.iter().map(|&(_, value)| value);
        match values.clone().find(|&value| !allowed(value)) {
            Some(value) => Err(NativeError::Value {
                field,
                place: place(),
                value,
                unit,
                rule,
            }),
            None => Ok(()),
        }
    };
    let positive = |value: f64| value.is_finite() && value > 0.0;
    let temperature = |schedule| all(schedule, "the temperature", "K", "positive", positive);
    match condition {
        GasPatch::Inlet {
            superficial_velocity,
            temperature: schedule,
        } => {
            let inward = |value: f64| value.is_finite() && value >= 0.0;
            let rule = "zero or positive (into the domain)";
            all(
                superficial_velocity,
                "the superficial velocity",
                "m/s",
                rule,
                inward,
            )?;
            temperature(schedule)
        }
        GasPatch::Outlet { pressure } => {
            let pressure = Schedule::constant(*pressure);
            all(&pressure, "the pressure", "Pa", "positive", positive)
        }
        GasPatch::Wall { heat, .. } => match heat {
            WallHeat::Adiabatic => Ok(()),
            WallHeat::Temperature(schedule) => temperature(schedule),
        },
    }
}
