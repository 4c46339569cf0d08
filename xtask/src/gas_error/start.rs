//! Flows that a case does not begin from rest, as every solver reads them: fields of OpenFOAM, and for the native gas
//! those of a checkpoint, which the run goes on from.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Stop, TaskResult, output};

/// The flow at the start in a square of gas of 1 kg/m³, whose walls lie on streamlines.
pub struct Start {
    /// Edge of the square and depth in m.
    pub edge: f64,
    pub depth: f64,
    /// What is at a place in m.
    pub at: fn(f64, f64) -> Here,
}

/// The flow at a place.
pub struct Here {
    /// Velocity in m/s.
    pub velocity: [f64; 2],
    /// Stream function in m²/s: velocity is its slope along y, and minus that along x.
    pub stream: f64,
    /// Pressure in Pa, and its gradient in Pa/m.
    pub pressure: f64,
    pub pressure_gradient: [f64; 2],
}

impl Start {
    /// Place of a corner of cells, or with halves of a centre.
    fn place(&self, counts: [usize; 2], x: f64, y: f64) -> Here {
        (self.at)(
            self.edge * x / counts[0] as f64,
            self.edge * y / counts[1] as f64,
        )
    }

    /// What is at the centres of cells, x fastest.
    fn cells(&self, counts: [usize; 2]) -> impl Iterator<Item = Here> {
        (0..counts[0] * counts[1]).map(move |cell| {
            let (x, y) = (cell % counts[0], cell / counts[0]);
            self.place(counts, x as f64 + 0.5, y as f64 + 0.5)
        })
    }

    /// Mass flux in kg/s through faces between cells, in OpenFOAM's order: of each cell that to its neighbour along x,
    /// then along y. That of the stream function, so that no cell gains any.
    fn fluxes(&self, counts: [usize; 2]) -> Vec<f64> {
        let stream = |x: usize, y: usize| self.place(counts, x as f64, y as f64).stream;
        let mut fluxes = Vec::new();
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                if x + 1 < counts[0] {
                    fluxes.push(self.depth * (stream(x + 1, y + 1) - stream(x + 1, y)));
                }
                if y + 1 < counts[1] {
                    fluxes.push(self.depth * (stream(x, y + 1) - stream(x + 1, y + 1)));
                }
            }
        }
        fluxes
    }

    /// Writes `U`, and `p` over density where it is asked for, of OpenFOAM to a folder.
    pub fn write_openfoam(
        &self,
        folder: &Path,
        counts: [usize; 2],
        (sides, pressure): (&str, bool),
    ) -> TaskResult<()> {
        fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
        let (mut velocities, mut pressures) = (String::new(), String::new());
        for Here {
            velocity: [u, v],
            pressure,
            ..
        } in self.cells(counts)
        {
            // Writing to a String cannot fail.
            let _ = writeln!(velocities, "({u:e} {v:e} 0)");
            let _ = writeln!(pressures, "{pressure:e}");
        }
        let cells = counts[0] * counts[1];
        let file = |name: &str,
                    (class, list, units): (&str, &str, &str),
                    walls: &str,
                    values: &str| {
            let text = format!(
                "FoamFile {{ version 2.0; format ascii; class {class}; object {name}; }}\ndimensions [{units}];\n\
                 internalField nonuniform List<{list}>\n{cells}\n(\n{values})\n;\n\
                 boundaryField {{ walls {{ type {walls}; }} side {{ type {sides}; }} }}\n"
            );
            let path = folder.join(name);
            fs::write(&path, text).map_err(|cause| Stop::io(&path, &cause))
        };
        file(
            "U",
            ("volVectorField", "vector", "0 1 -1 0 0 0 0"),
            "slip",
            &velocities,
        )?;
        if pressure {
            let kind = ("volScalarField", "scalar", "0 2 -2 0 0 0 0");
            file("p", kind, "zeroGradient", &pressures)?;
        }
        Ok(())
    }

    /// Puts the flow into the checkpoint of native gas below the results of a run on this mesh.
    pub fn write_native(&self, results: &Path, counts: [usize; 2]) -> TaskResult<()> {
        let path = results.join("checkpoint/gas/gas.state");
        let mut bytes = fs::read(&path).map_err(|cause| Stop::io(&path, &cause))?;
        let three = |[x, y]: [f64; 2]| [x, y, 0.0];
        let arrays = [
            (
                "velocity",
                self.cells(counts)
                    .flat_map(|here| three(here.velocity))
                    .collect(),
            ),
            (
                "pressure",
                self.cells(counts).map(|here| here.pressure).collect(),
            ),
            (
                "pressure_gradient",
                self.cells(counts)
                    .flat_map(|here| three(here.pressure_gradient))
                    .collect(),
            ),
            ("flux", self.fluxes(counts)),
        ];
        for (name, values) in &arrays {
            replace(&mut bytes, name, values)
                .ok_or_else(|| Stop(format!("{}: no array `{name}`", path.display())))?;
        }
        let content = bytes.len() - CHECKSUM;
        bytes.truncate(content);
        let write = |bytes: &[u8]| fs::write(&path, bytes).map_err(|cause| Stop::io(&path, &cause));
        write(&bytes)?;
        bytes.extend(binary(&sha256(&path)?));
        write(&bytes)?;
        let sums = results.join("checkpoint/SHA256SUMS");
        let text = fs::read_to_string(&sums).map_err(|cause| Stop::io(&sums, &cause))?;
        let text = with_sum(&text, "gas/gas.state", &sha256(&path)?);
        fs::write(&sums, text).map_err(|cause| Stop::io(&sums, &cause))
    }
}

/// Bytes of the checksum at the end of a state file.
const CHECKSUM: usize = 32;

/// Replaces the first values of an array of a state file (`coupler/src/checkpoint.rs` has the layout): those of faces
/// between cells come before those of the boundary, through which nothing flows.
fn replace(bytes: &mut [u8], name: &str, values: &[f64]) -> Option<()> {
    let mut mark = u32::try_from(name.len()).ok()?.to_le_bytes().to_vec();
    mark.extend(name.as_bytes());
    // Its type: 64-bit reals.
    mark.extend(0u32.to_le_bytes());
    let found = bytes
        .windows(mark.len())
        .position(|window| window == mark)?;
    let (length, data) = bytes[found + mark.len()..].split_first_chunk_mut::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let numbers = data.get_mut(..8 * length)?.as_chunks_mut::<8>().0;
    for (number, value) in numbers.get_mut(..values.len())?.iter_mut().zip(values) {
        *number = value.to_le_bytes();
    }
    Some(())
}

/// SHA-256 of a file in hexadecimal digits.
fn sha256(path: &Path) -> TaskResult<String> {
    let told = output(Command::new("sha256sum").arg(path));
    let sum = told
        .as_deref()
        .and_then(|told| told.split_whitespace().next());
    let sum = sum.map(|sum| sum.trim_start_matches('\\').to_owned());
    sum.ok_or_else(|| Stop(format!("sha256sum cannot read {}", path.display())))
}

fn binary(digits: &str) -> Vec<u8> {
    let pairs = digits
        .as_bytes()
        .chunks(2)
        .filter_map(|pair| std::str::from_utf8(pair).ok());
    pairs
        .filter_map(|pair| u8::from_str_radix(pair, 16).ok())
        .collect()
}

/// The list of sums with that of one file replaced.
fn with_sum(sums: &str, file: &str, sum: &str) -> String {
    let line = |line: &str| match line.strip_suffix(file) {
        Some(_) => format!("{sum}  {file}\n"),
        None => format!("{line}\n"),
    };
    sums.lines().map(line).collect()
}

/// Where the fields of a start are kept beside the results `folder` of a run.
pub fn beside(folder: &Path) -> PathBuf {
    folder.with_extension("start")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocity of a turning solid; its walls are no streamlines, which does not matter here.
    const TURNING: Start = Start {
        edge: 2.0,
        depth: 0.5,
        at: |x, y| Here {
            velocity: [-y, x],
            stream: -0.5 * (x * x + y * y),
            pressure: 0.0,
            pressure_gradient: [x, y],
        },
    };

    #[test]
    fn fluxes_are_those_of_the_stream_function_in_the_order_of_faces() {
        // Two cells along x, two along y, 1 m each: mean velocity at a face times its half square metre.
        assert_eq!(TURNING.fluxes([2, 2]), [-0.25, 0.25, 0.75, -0.75]);
    }

    #[test]
    fn an_array_of_a_state_is_found_by_name_and_type_and_replaced_at_its_front() {
        let mut bytes = b"CALCSTAT".to_vec();
        for name in ["flux_of_heat", "flux"] {
            bytes.extend((name.len() as u32).to_le_bytes());
            bytes.extend(name.as_bytes());
            bytes.extend(0u32.to_le_bytes());
            bytes.extend(2u64.to_le_bytes());
            bytes.extend([1f64, 2.0].iter().flat_map(|value| value.to_le_bytes()));
        }
        let end = bytes.len();
        assert_eq!(replace(&mut bytes, "flux", &[7.0]), Some(()));
        assert_eq!(bytes[end - 16..end - 8], 7f64.to_le_bytes());
        assert_eq!(bytes[end - 8..], 2f64.to_le_bytes());
        assert_eq!(replace(&mut bytes, "flux", &[1.0; 3]), None);
        assert_eq!(replace(&mut bytes, "mass", &[]), None);
    }

    #[test]
    fn sums_are_replaced_line_by_line() {
        let sums = "aa  gas/gas.state\nbb  coordinator.state\n";
        let wanted = "cc  gas/gas.state\nbb  coordinator.state\n";
        assert_eq!(with_sum(sums, "gas/gas.state", "cc"), wanted);
        assert_eq!(binary("00ff10"), [0, 255, 16]);
    }
}
