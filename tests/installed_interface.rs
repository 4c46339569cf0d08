//! What is installed for those who attach a solver suffices to compile one: header, library, pkg-config file, Makefile.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::results::Summary;

use crate::support::{c_solver, program};

#[test]
fn the_solvers_in_c_compile_from_the_installed_files_alone_and_couple() {
    let folder = tempfile::tempdir().unwrap();
    let prefix = folder.path().join("a prefix");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("adapters/wire/install.sh");
    let installed = Command::new(script)
        .arg(&prefix)
        .arg(c_solver::library())
        .status()
        .unwrap();
    assert!(installed.success());
    // It may be moved.
    let moved = folder.path().join("opt");
    fs::rename(&prefix, &moved).unwrap();
    let examples = moved.join("share/calcine/examples");
    let made = Command::new("make")
        .current_dir(&examples)
        .env("CFLAGS", "-O2 -Wall -Wextra -Werror")
        .output()
        .unwrap();
    assert!(
        made.status.success(),
        "{}",
        String::from_utf8_lossy(&made.stderr)
    );
    assert!(examples.join("ballistic-particles").is_file());
    let version = Command::new("pkg-config")
        .args(["--modversion", "calcine-wire"])
        .env("PKG_CONFIG_PATH", moved.join("lib/pkgconfig"))
        .output()
        .unwrap();
    let version = String::from_utf8_lossy(&version.stdout).trim().to_owned();
    assert_eq!(version, calcine_wire::record::VERSION.to_string());
    let out = folder.path().join("run");
    let words = ["--gas", "external"];
    program::run(
        &examples.join("column.toml"),
        &out,
        &words,
        &["time.end=1 s"],
    );
    assert_eq!(Summary::read(&out).unwrap().backend.gas, "external");
}
