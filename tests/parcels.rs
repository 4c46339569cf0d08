//! Parcels, through the program: balances and interrupts.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use calcine::results::Summary;

use crate::support::{killed, program};

#[test]
fn a_bed_of_parcels_that_is_killed_resumes_to_the_same_bits_and_its_ledger_closes() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("parcel-bed");
    let settings = ["time.end=0.3 s", "time.checkpoint.every=20 ms"];
    let whole = killed::resumes_to_the_same_bits(folder.path(), &[20, 40], |out| {
        program::command(&case, out, &[], &settings)
    });
    let summary = Summary::read(&whole).unwrap();
    for name in ["mass", "energy", "momentum", "particle_momentum"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error}");
    }
}
