//! Links Debian's LIGGGHTS (libliggghts-dev) and the Open MPI that it was built with.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-link-lib=dylib=liggghts");
    println!("cargo:rustc-link-lib=dylib=mpi");
}
