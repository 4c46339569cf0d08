//! The solvers in plain C of `adapters/wire/examples`, compiled as their users would.

#![allow(clippy::unwrap_used, dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// What a solver in C is linked with, beside the static library.
const LIBRARIES: [&str; 6] = ["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl"];

/// The folder of the sources, and of a case.
pub fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("adapters/wire/examples")
}

/// The folder of the header.
pub fn header() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("adapters/wire/include")
}

/// The static library of this build.
pub fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let own = std::env::current_exe().unwrap();
        let target = own.parent().unwrap().parent().unwrap();
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--lib", "-p", "calcine-wire"]);
        if target.ends_with("release") {
            build.arg("--release");
        }
        build.current_dir(env!("CARGO_MANIFEST_DIR"));
        assert!(build.status().unwrap().success());
        target.join("libcalcine_wire.a")
    })
}

/// Compiles a source of the examples with a header folder and further words; the program has this name.
pub fn compile(source: &str, include: &Path, words: &[&str], program: &Path) {
    let compiled = Command::new("cc")
        .args([
            "-std=c11",
            "-O2",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
        ])
        .args(words)
        .arg("-I")
        .arg(include)
        .arg(examples().join(source))
        .arg(library())
        .args(LIBRARIES)
        .arg("-o")
        .arg(program)
        .status()
        .unwrap();
    assert!(compiled.success());
}

/// The gas.
pub fn gas() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| made("column_gas.c", "column-gas"))
}

/// The particles.
pub fn particles() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| made("ballistic_particles.c", "ballistic-particles"))
}

fn made(source: &str, name: &str) -> PathBuf {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    compile(source, &header(), &[], &program);
    program
}
