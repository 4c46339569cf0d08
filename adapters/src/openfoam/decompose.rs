//! Division of the mesh among ranks.
//!
//! Debian's OpenFOAM comes without the graph partitioner (its scotch is a stub), so that Calcine divides by
//! itself and has OpenFOAM's decomposePar make the parts.

use std::ffi::OsString;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_coupler::supervisor::{Supervisor, log_end};

use super::names::NAME;

/// The dictionary of decomposePar.
pub const DICTIONARY: &str = "system/decomposeParDict";
/// The list of ranks by cell, in `constant/`.
pub const DATA: &str = "cellDecomposition";
const PROGRAM: &str = "decomposePar";
/// Between two looks at it.
const PAUSE: Duration = Duration::from_millis(5);

/// The rank of each cell, by recursive bisection of the cells' centres across the longest side of what
/// is to be divided: every rank gets its share to a few cells, in a piece that is as compact as that allows.
pub fn divide(centres: &[Vec3], ranks: u32) -> Vec<u32> {
    let mut parts = vec![0; centres.len()];
    let mut cells: Vec<usize> = (0..centres.len()).collect();
    bisect(centres, &mut cells, 0, ranks, &mut parts);
    parts
}

/// Gives the cells on both sides of each periodic pair of faces to one rank, the lowest of theirs, so that a cyclic patch stays one.
pub fn keep_pairs(mesh: &Mesh, parts: &mut [u32]) {
    // Cells at the edge of two periodic directions hang together by several pairs.
    loop {
        let mut changed = false;
        for pair in mesh.periodic_faces() {
            let [one, other] = [pair.face, pair.partner].map(|face| mesh.owner()[face] as usize);
            let rank = parts[one].min(parts[other]);
            changed |= parts[one] != rank || parts[other] != rank;
            parts[one] = rank;
            parts[other] = rank;
        }
        if !changed {
            return;
        }
    }
}

fn bisect(centres: &[Vec3], cells: &mut [usize], first: u32, ranks: u32, parts: &mut [u32]) {
    if ranks <= 1 || cells.is_empty() {
        for &cell in cells.iter() {
            parts[cell] = first;
        }
        return;
    }
    let (mut low, mut high) = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
    for &cell in cells.iter() {
        (low, high) = (low.inf(&centres[cell]), high.sup(&centres[cell]));
    }
    let axis = (high - low).imax();
    // Of equal centres the lower cell goes first, so that the division is the same everywhere.
    cells.sort_unstable_by(|&a, &b| {
        centres[a][axis]
            .total_cmp(&centres[b][axis])
            .then(a.cmp(&b))
    });
    let left = ranks.div_ceil(2);
    let share = (cells.len() * left as usize).div_ceil(ranks as usize);
    let (lower, upper) = cells.split_at_mut(share);
    bisect(centres, lower, first, left, parts);
    bisect(centres, upper, first + left, ranks - left, parts);
}

/// Has decomposePar make the folders of the ranks in a case; it may take as long as the supervisor lets it.
pub fn run(
    folder: &Path,
    ranks: u32,
    environment: &[(OsString, OsString)],
    supervisor: &Supervisor,
) -> Result<(), PartError> {
    let refuse = |message: String| PartError::new(NAME, FailureKind::NotStarted, message);
    let path = folder.join("log.decomposePar");
    let log = || -> std::io::Result<(File, File)> {
        let file = File::create(&path)?;
        Ok((file.try_clone()?, file))
    };
    let (output, errors) = log().map_err(|error| {
        refuse(format!("{} cannot be written", path.display())).caused_by(error)
    })?;
    let mut child = Command::new(PROGRAM)
        .arg("-force")
        .current_dir(folder)
        .envs(environment.iter().cloned())
        .stdin(Stdio::null())
        .stdout(output)
        .stderr(errors)
        .spawn()
        .map_err(|error| refuse(format!("{PROGRAM} cannot be started")).caused_by(error))?;
    let name = format!("OpenFOAM (gas, {PROGRAM}), pid {}", child.id());
    let waited = supervisor.wait(&name, None, |slice| {
        std::thread::sleep(slice.min(PAUSE));
        child
            .try_wait()
            .map_err(|error| refuse(format!("{PROGRAM} cannot be waited for")).caused_by(error))
    });
    let status = waited.map_err(|error| {
        // One that has ended meanwhile is what is wanted.
        let _ = child.kill();
        let _ = child.wait();
        error.with_log(log_end(&path))
    })?;
    let made = fs::read_dir(folder).into_iter().flatten().flatten();
    let made = made.filter(|entry| {
        let name = entry.file_name();
        name.to_string_lossy().starts_with("processor")
    });
    let made = made.count();
    if status.success() && made == ranks as usize {
        return Ok(());
    }
    let remedy = if status.success() {
        format!("; a template's {DICTIONARY} must ask for as many")
    } else {
        String::new()
    };
    let message =
        format!("ended with {status} and {made} parts of the mesh for {ranks} ranks{remedy}");
    let error = PartError::new(name, FailureKind::NotStarted, message);
    Err(error.with_log(log_end(&path)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_cells_is_cut_across_into_equal_pieces() {
        let centres: Vec<Vec3> = (0..12).map(|i| Vec3::new(0.5, 0.5, f64::from(i))).collect();
        let thirds: Vec<u32> = (0..12).map(|cell| cell / 4).collect();
        assert_eq!(divide(&centres, 3), thirds);
        assert_eq!(divide(&centres, 1), vec![0; 12]);
    }

    #[test]
    fn every_rank_gets_its_share_to_a_few_cells_and_the_division_does_not_change() {
        let centres: Vec<Vec3> = (0..1000)
            .map(|i| {
                Vec3::new(
                    f64::from(i % 10),
                    f64::from(i / 10 % 10),
                    f64::from(i / 100),
                )
            })
            .collect();
        for ranks in [2, 3, 5, 7, 16] {
            let parts = divide(&centres, ranks);
            let mut sizes = vec![0usize; ranks as usize];
            for &part in &parts {
                sizes[part as usize] += 1;
            }
            let (least, most) = (sizes.iter().min().unwrap(), sizes.iter().max().unwrap());
            assert!(most - least <= 3, "{ranks} ranks: {sizes:?}");
            assert_eq!(divide(&centres, ranks), parts);
        }
    }
}
