//! Beds and meshes that a case file describes: files of particles, stackings, distributions of
//! sizes, graded and refined meshes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::assembly::PreparedCase;
use calcine::case::model::Case;
use calcine::case::{InitialParticles, mesh, particles, read};
use calcine_coupler::mesh::locate::Locator;
use tempfile::TempDir;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/inputs/good")
        .join(name)
}

fn case(name: &str, set: &[&str]) -> Case {
    let set: Vec<String> = set.iter().map(|&text| text.to_owned()).collect();
    read(&good(name), &set).unwrap_or_else(|errors| panic!("{errors}"))
}

/// (z − radius, z + radius, diameter, temperature) of each particle of a population.
fn of(placed: &InitialParticles, population: usize) -> Vec<[f64; 4]> {
    let setup = &placed.setup;
    (0..setup.id.len())
        .filter(|&p| setup.population[p] as usize == population)
        .map(|p| {
            let (z, radius) = (setup.position[p].z, setup.radius[p]);
            [z - radius, z + radius, 2.0 * radius, placed.temperature[p]]
        })
        .collect()
}

#[test]
fn ten_layers_lie_each_in_its_own_place_with_its_own_sizes() {
    let placed = particles(&case("layers.toml", &[]), &Default::default()).unwrap();
    let sizes = [
        [3.0, 5.0],
        [2.0, 6.0],
        [3.0, 5.0],
        [3.0, 6.0],
        [5.0, 5.0],
        [5.0, 5.0],
        [5.0, 5.0],
    ];
    for (layer, [small, large]) in sizes.into_iter().enumerate() {
        let spheres = of(&placed, layer);
        assert!(spheres.len() > 100, "layer {layer}: {}", spheres.len());
        let (low, high) = (0.02 * layer as f64, 0.02 * (layer + 1) as f64);
        for [bottom, top, diameter, temperature] in spheres {
            assert!(bottom > low - 1e-9 && top < high + 1e-9, "layer {layer}");
            let right = 1e-3 * small - 1e-12..=1e-3 * large + 1e-12;
            assert!(right.contains(&diameter));
            assert_eq!(temperature, 300.0);
        }
    }
    // Half of the mass of the fourth layer is in the large spheres, 8 times the mass of a small one.
    let table = of(&placed, 3);
    let large = table.iter().filter(|sphere| sphere[2] > 0.005).count() as f64;
    let small = table.len() as f64 - large;
    let share = 8.0 * large / (8.0 * large + small);
    assert!((share - 0.7).abs() < 0.1, "{share}");
}

/// Of the dump: ids 3 and 7 of type 2 at step 1000, in the order of their ids.
#[test]
fn files_give_their_own_diameters_and_temperatures_where_they_hold_them() {
    let placed = particles(&case("layers.toml", &[]), &Default::default()).unwrap();
    let shown = |population| -> Vec<[f64; 2]> {
        let spheres = of(&placed, population);
        spheres
            .iter()
            .map(|sphere| [sphere[2], sphere[3]])
            .collect()
    };
    assert_eq!(shown(7), [[0.005, 360.0], [0.004, 350.0]]);
    assert_eq!(shown(8), [[0.004, 310.0], [0.005, 320.0], [0.006, 330.0]]);
    for [diameter, temperature] in shown(9) {
        assert!((0.002..0.003).contains(&diameter) && temperature == 300.0);
    }
}

#[test]
fn populations_that_reach_into_each_other_are_refused_with_both_names() {
    let region = "particles[1].place.region={ from = \"19 mm\", to = \"40 mm\" }";
    let error = particles(&case("layers.toml", &[region]), &Default::default()).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("\"normal\"") && message.contains("\"log-normal\" overlap"),
        "{message}"
    );
}

#[test]
fn a_grid_that_leaves_a_cylinder_is_refused_with_its_particle() {
    let grid = "particles[4].place={ grid = { first = \"0 0 90 mm\", spacing = \"9 9 9 mm\", counts = [4, 1, 1] } }";
    let error = particles(&case("layers.toml", &[grid]), &Default::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "population \"cubic\", particle 4: the centre lies at distance from the axis = 0.027 m, but the \
         mesh reaches from 0 m to 0.025 m; move the particle, or enlarge the mesh"
    );
}

#[test]
fn a_timestep_of_a_file_without_timesteps_is_refused() {
    let error = particles(
        &case("layers.toml", &["particles[8].place.timestep=3"]),
        &Default::default(),
    )
    .unwrap_err();
    let message = error.to_string();
    assert!(
        message.ends_with("bed.vtk: it holds no timesteps to choose from; leave out `timestep`"),
        "{message}"
    );
    let error = particles(
        &case("layers.toml", &["particles[7].place.timestep=3"]),
        &Default::default(),
    )
    .unwrap_err();
    let message = error.to_string();
    assert!(
        message.ends_with("bed.liggghts: it has no timestep 3; it holds 0, 1000, 2000"),
        "{message}"
    );
}

/// Writes a file of particles and places them as the only population of a box.
fn from_file(name: &str, bytes: &[u8]) -> Result<InitialParticles, String> {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string(good("two-populations.toml")).unwrap();
    let grid = "{ grid = { first = \"5 5 5 mm\", spacing = \"10 10 10 mm\", counts = [1, 1, 2] } }";
    let text = text.replace(grid, &format!("{{ file = \"{name}\" }}"));
    fs::write(
        folder.path().join("case.toml"),
        text.replace("number = 4", "number = 1"),
    )
    .unwrap();
    fs::write(folder.path().join(name), bytes).unwrap();
    fs::write(folder.path().join("bed.csv"), "x,y,z\n0.005,0.005,0.1\n").unwrap();
    let case = read(&folder.path().join("case.toml"), &[]).unwrap();
    let folder = folder.path().canonicalize().unwrap();
    let prefix = format!("{}/", folder.display());
    particles(&case, &Default::default()).map_err(|error| error.to_string().replace(&prefix, ""))
}

/// A `.vtp` as Calcine writes it: raw appended arrays, here with single-precision radii.
fn raw() -> Vec<u8> {
    let mut data = Vec::new();
    let mut array = |bytes: &[u8]| {
        let offset = data.len();
        data.extend((bytes.len() as u64).to_le_bytes());
        data.extend(bytes);
        offset
    };
    let centres = [0.005f64, 0.005, 0.02, 0.005, 0.005, 0.04]
        .map(f64::to_le_bytes)
        .concat();
    let radii = [0.003f32, 0.004].map(f32::to_le_bytes).concat();
    let [points, radius] = [array(&centres), array(&radii)];
    let head = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"2\">\n<Points>\n\
         <DataArray type=\"Float64\" Name=\"points\" NumberOfComponents=\"3\" format=\"appended\" \
         offset=\"{points}\"/>\n</Points>\n<PointData>\n<DataArray type=\"Float32\" Name=\"Radius\" \
         format=\"appended\" offset=\"{radius}\"/>\n</PointData>\n</Piece>\n</PolyData>\n\
         <AppendedData encoding=\"raw\">\n_"
    );
    [head.as_bytes(), &data, b"\n</AppendedData>\n</VTKFile>\n"].concat()
}

#[test]
fn raw_appended_arrays_are_read() {
    let placed = from_file("bed.vtp", &raw()).unwrap();
    assert_eq!(placed.setup.position[1].z, 0.04);
    assert_eq!(
        placed.setup.radius[..2],
        [f64::from(0.003f32), f64::from(0.004f32)]
    );
}

#[test]
fn a_snapshot_of_a_version_5_file_and_a_table_of_paraview_are_read() {
    let vtk = "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n\
               0.005 0.005 0.02\nMETADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n\
               CELLS 2 1\nOFFSETS vtktypeint64\n0 1\nCONNECTIVITY vtktypeint64\n0\nCELL_TYPES 1\n1\n\n\
               POINT_DATA 1\nFIELD FieldData 1\ndiameter 1 1 double\n0.006\n";
    let placed = from_file("a.vtk", vtk.as_bytes()).unwrap();
    assert_eq!(placed.setup.radius[0], 0.003);
    let csv = "\"radius\",\"Points:0\",\"Points:1\",\"Points:2\"\n0.002,0.005,0.005,0.03\n";
    let placed = from_file("a.csv", csv.as_bytes()).unwrap();
    assert_eq!(placed.setup.radius[0], 0.002);
    assert_eq!(placed.setup.position[0].z, 0.03);
    // Exponents as Fortran writes them.
    let placed = from_file("a.csv", b"x,y,z,radius\n5D-3,0.5d-2,3E-2,2D-3\n").unwrap();
    assert_eq!(placed.setup.radius[0], 0.002);
    assert_eq!(placed.setup.position[0].z, 0.03);
}

#[test]
fn particle_input_of_mfix_is_read() {
    let text = "0.005 0.005 0.03 2.0D-3 2500.0 0.0 0.0 -0.5\n";
    let placed = from_file("particle_input.dat", text.as_bytes()).unwrap();
    assert_eq!(placed.setup.radius[0], 0.002);
    assert_eq!(placed.setup.position[0].z, 0.03);
    let said = from_file("particle_input.dat", b"1 2 3\n").unwrap_err();
    assert!(
        said.starts_with("particle_input.dat, line 1: there are 3 values; version 1.0"),
        "{said}"
    );
}

#[test]
fn files_that_cannot_be_used_are_refused_with_their_line() {
    let said = |name: &str, text: &str| from_file(name, text.as_bytes()).unwrap_err();
    let dump = "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id x y z\n1 0 0 0\n";
    for (name, text, message) in [
        (
            "a.csv",
            "x,y\n1,2\n",
            "a.csv: it has the columns x, y, and needs x, y and z (in m)",
        ),
        (
            "a.csv",
            "x,y,z\n0.005,0.005,nan\n",
            "a.csv, line 2: a coordinate of the centre is not a finite number",
        ),
        (
            "a.csv",
            "x,y,z\n0.005,0.005\n",
            "a.csv, line 2: there are 2 values, but 3 columns; separate them by commas, with a point in decimals",
        ),
        (
            "a.csv",
            "x,y,z,radius\n0.005,0.005,0.02,0\n",
            "a.csv, line 2: the radius is 0, not above zero",
        ),
        (
            "a.dump",
            dump,
            "a.dump, line 5: 2 atoms are announced, but the file ends after 1",
        ),
        (
            "a.dump",
            &format!("{dump}2 0 0 1\n\n3 0 0 2\n"),
            "a.dump, line 9: 2 atoms are announced by \"ITEM: NUMBER OF ATOMS\", but there are more",
        ),
        (
            "a.dump",
            "nothing",
            "a.dump: it is none of .csv, .dat, .vtk, .vtu, .vtp, nor does it begin with \"ITEM:\" as a LIGGGHTS dump does",
        ),
        (
            "a.vtk",
            "# vtk DataFile Version 3.0\nt\nBINARY\n",
            "a.vtk, line 3: it is binary; write it as ASCII, or as .vtp or .vtu",
        ),
        (
            "a.vtk",
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 9999999999 float\n1 2\n",
            "a.vtk, line 6: the file ends before 29999999997 numbers",
        ),
        (
            "a.vtp",
            "<VTKFile compressor=\"vtkZLibDataCompressor\">",
            "a.vtp: its arrays are compressed; write it without compression",
        ),
        (
            "a.vtp",
            "<VTKFile type=\"PolyData\"><Piece><Points><DataArray Name=\"p\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>",
            "a.vtp: the array `p` lies beyond the end of the file",
        ),
    ] {
        assert_eq!(said(name, text), message);
    }
}

/// Every beginning of a good file, and the file with each byte changed: words, never a panic.
#[test]
fn broken_files_are_refused_in_words() {
    let files = ["bed.liggghts", "bed.vtk", "bed.vtp"];
    let mut all: Vec<(String, Vec<u8>)> = files
        .map(|name| (name.to_owned(), fs::read(good(name)).unwrap()))
        .into();
    all.push(("raw.vtp".into(), raw()));
    for (name, bytes) in all {
        for at in (0..bytes.len()).step_by(7) {
            let _ = from_file(&name, &bytes[..at]);
            let mut changed = bytes.clone();
            changed[at] = changed[at].wrapping_add(13);
            let _ = from_file(&name, &changed);
        }
    }
}

#[test]
fn graded_and_refined_meshes_have_the_cells_that_the_case_says() {
    let case = case("refined-box.toml", &[]);
    let mesh = mesh(&case.mesh).unwrap();
    let volume: f64 = mesh.cell_volume().iter().sum();
    assert!((volume / 1.1e-5 - 1.0).abs() < 1e-12);
    // 270 cells; 7 more for each split: some are split twice.
    assert!(
        mesh.cells() > 270 && (mesh.cells() - 270).is_multiple_of(7),
        "{}",
        mesh.cells()
    );
    let locator = Locator::new(&mesh);
    let at = |x: f64, y: f64, z: f64| {
        let cell = locator.cell_at([x, y, z].map(|x| 1e-3 * x).into()).unwrap();
        mesh.cell_volume()[cell]
    };
    assert!(at(5.0, 5.0, 45.0) < at(5.0, 5.0, 90.0) && at(5.0, 5.0, 90.0) < at(5.0, 5.0, 10.0));
    // The last of three cells along x is twice the first: sizes 1, √2, 2.
    assert!((at(9.9, 5.0, 5.0) / at(0.1, 5.0, 5.0) - 2.0).abs() < 1e-9);
}

#[test]
fn an_excluded_zone_beside_the_mesh_is_refused() {
    let zone = "coupling.smoother.excluded[0].box={ from = \"0 0 200 mm\", to = \"10 10 210 mm\" }";
    let case = case("refined-box.toml", &[zone]);
    let prepared = PreparedCase::new(&case).unwrap();
    let error = prepared.packing(&case).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`coupling.smoother.excluded[0]` holds no centre of a cell; enlarge it, or move it into the mesh"
    );
}
