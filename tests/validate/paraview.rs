//! The script that each run writes for ParaView, under Debian's ParaView without a screen. Needs `paraview`, `python3-paraview` and
//! `xvfb`, which are not among the packages that `cargo xtask setup` installs.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::{run as calcine, shipped};

/// Colours that a picture of fields has at least: that of an empty view has 183.
const COLOURS: usize = 700;
/// Counts the colours of a picture.
const COUNT: &str = "
import sys
import numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.util.numpy_support import vtk_to_numpy
reader = vtkPNGReader()
reader.SetFileName(sys.argv[1])
reader.Update()
points = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
print(len(numpy.unique(points, axis=0)))
";

pub fn run() {
    for (program, package) in [("pvpython", "python3-paraview"), ("xvfb-run", "xvfb")] {
        if Command::new(program).arg("--version").output().is_err() {
            println!(
                "  {program} is not here: apt-get install paraview python3-paraview xvfb ({package})"
            );
            return;
        }
    }
    let folder = tempfile::tempdir().unwrap();
    println!("  | run | colours of the picture |");
    // Gas and particles; parcels; the gas alone; particles alone.
    for ((name, end), screen) in [
        ("heated-bed", "time.end=20 s"),
        ("wet-drum", "time.end=0.2 s"),
        ("pipe", "time.end=6 s"),
        ("rotating-drum", "time.end=0.1 s"),
    ]
    .into_iter()
    .zip(120..)
    {
        let (out, _) = calcine(&shipped(name), folder.path(), name, &[end.into()]);
        let picture = folder.path().join(name).with_extension("png");
        let output = Command::new("xvfb-run")
            // A screen of its own: that of the run before may still be closing.
            .args(["-a", &format!("--server-num={screen}"), "pvpython"])
            .arg(out.join("open_in_paraview.py"))
            .arg(&picture)
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success() && !told.contains("rror"),
            "{name}: {told}"
        );
        let colours = colours(&picture, folder.path());
        println!("  | {name} | {colours} |");
        assert!(colours >= COLOURS, "{name}: {}", picture.display());
    }
}

/// Number of colours in a picture, counted by ParaView's own reader.
fn colours(picture: &Path, folder: &Path) -> usize {
    let script = folder.join("colours.py");
    fs::write(&script, COUNT).unwrap();
    let output = Command::new("pvpython")
        .arg(&script)
        .arg(picture)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    let count = told.trim().parse();
    count.unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)))
}
