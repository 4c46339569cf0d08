//! ParaView files: `.vtu` for the gas, `.vtp` for the particles, `.pvd` for their times.
//!
//! VTK XML with raw appended arrays (little endian, 64-bit block lengths), which VTK 5.10 and later
//! read, and so ParaView 5.11; the same state gives the same bytes.

use std::fmt::Write as _;
use std::path::Path;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;

use super::snapshot::{Field, Values, lengths_of, padded};
use super::{ResultsError, files};

/// VTK's number of a hexahedron.
const HEXAHEDRON: u8 = 12;
/// VTK's number of a polyhedron.
const POLYHEDRON: u8 = 42;

/// A VTK XML file under construction: the text of its elements and the appended bytes.
#[derive(Default)]
struct Draft {
    xml: String,
    data: Vec<u8>,
}

impl Draft {
    /// Adds an array: `kind` as VTK names it, `components` per tuple, and its bytes.
    fn array(&mut self, kind: &str, name: &str, components: usize, bytes: &[u8]) {
        // Writing to a String cannot fail.
        let _ = writeln!(
            self.xml,
            r#"<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="appended" offset="{}"/>"#,
            self.data.len()
        );
        self.data.extend((bytes.len() as u64).to_le_bytes());
        self.data.extend(bytes);
    }

    fn floats<'a>(&mut self, name: &str, components: usize, values: impl Iterator<Item = &'a f64>) {
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.array("Float64", name, components, &bytes);
    }

    fn wholes(&mut self, name: &str, values: impl IntoIterator<Item = i64>) {
        let bytes: Vec<u8> = values.into_iter().flat_map(i64::to_le_bytes).collect();
        self.array("Int64", name, 1, &bytes);
    }

    fn vectors(&mut self, name: &str, values: &[Vec3]) {
        self.floats(name, 3, values.iter().flat_map(|vector| vector.iter()));
    }

    fn field(&mut self, field: &Field<'_>) {
        match field.values {
            Values::Scalar(list) => self.floats(field.name, 1, list.iter()),
            Values::Column {
                table,
                column,
                columns,
            } => self.floats(field.name, 1, Values::column(table, column, columns).iter()),
            Values::Vector(list) => self.vectors(field.name, list),
            Values::Whole(list) => self.wholes(field.name, list.iter().map(|&id| id as i64)),
            Values::Small(list) => self.wholes(field.name, list.iter().map(|&n| i64::from(n))),
            Values::Ragged(rows) => {
                let (width, values, lengths) = padded(rows);
                self.floats(field.name, width, values.iter());
                let name = lengths_of(field.name);
                self.wholes(&name, lengths.iter().map(|&n| n as i64));
            }
        }
    }

    fn text(&mut self, text: &str) {
        self.xml.push_str(text);
        self.xml.push('\n');
    }

    /// The time as ParaView shows it.
    fn time(&mut self, seconds: f64) {
        let _ = writeln!(
            self.xml,
            r#"<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{seconds:?}</DataArray></FieldData>"#
        );
    }

    fn write(self, path: &Path, kind: &str) -> Result<(), ResultsError> {
        let mut bytes = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{kind}>\n{}</{kind}>\n\
             <AppendedData encoding=\"raw\">\n_",
            self.xml
        )
        .into_bytes();
        bytes.extend(self.data);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        files::replace(path, &bytes)
    }
}

/// Cells of a mesh as VTK wants them; the same for every snapshot.
pub(super) struct Cells {
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    kinds: Vec<u8>,
    faces: Vec<i64>,
    face_offsets: Vec<i64>,
}

impl Cells {
    /// Hexahedra where a cell is one, general polyhedra else.
    pub fn new(mesh: &Mesh) -> Self {
        let mut cells = Self {
            connectivity: Vec::new(),
            offsets: Vec::new(),
            kinds: Vec::new(),
            faces: Vec::new(),
            face_offsets: Vec::new(),
        };
        for cell in 0..mesh.cells() {
            match hexahedron(mesh, cell) {
                Some(points) => {
                    cells.connectivity.extend(points.map(i64::from));
                    cells.kinds.push(HEXAHEDRON);
                    cells.face_offsets.push(-1);
                }
                None => cells.polyhedron(mesh, cell),
            }
            cells.offsets.push(cells.connectivity.len() as i64);
        }
        cells
    }

    fn polyhedron(&mut self, mesh: &Mesh, cell: usize) {
        let faces = mesh.faces_of(cell);
        self.faces.push(faces.len() as i64);
        let mut corners = Vec::new();
        for &face in faces {
            let points = mesh.face_points(face as usize);
            self.faces.push(points.len() as i64);
            self.faces
                .extend(points.iter().map(|&point| i64::from(point)));
            corners.extend(points.iter().map(|&point| i64::from(point)));
        }
        corners.sort_unstable();
        corners.dedup();
        self.connectivity.extend(corners);
        self.kinds.push(POLYHEDRON);
        self.face_offsets.push(self.faces.len() as i64);
    }
}

/// The eight corners of a hexahedral cell in VTK's order: a base whose normal points into the cell,
/// then the corner opposite each; `None` for other cells.
fn hexahedron(mesh: &Mesh, cell: usize) -> Option<[u32; 8]> {
    let faces = mesh.faces_of(cell);
    let quads = faces
        .iter()
        .all(|&face| mesh.face_points(face as usize).len() == 4);
    if faces.len() != 6 || !quads {
        return None;
    }
    let base_face = faces[0] as usize;
    let mut base: [u32; 4] = mesh.face_points(base_face).try_into().ok()?;
    if mesh.owner()[base_face] as usize == cell {
        base.reverse();
    }
    let mut corners = [0; 8];
    for (place, &point) in base.iter().enumerate() {
        corners[place] = point;
        corners[place + 4] = faces[1..].iter().find_map(|&face| {
            let points = mesh.face_points(face as usize);
            let at = points.iter().position(|&other| other == point)?;
            let beside = [points[(at + 1) % 4], points[(at + 3) % 4]];
            beside.into_iter().find(|other| !base.contains(other))
        })?;
    }
    let mut sorted = corners;
    sorted.sort_unstable();
    sorted
        .windows(2)
        .all(|pair| pair[0] != pair[1])
        .then_some(corners)
}

/// Writes the gas at a process time in s.
pub(super) fn write_gas(
    path: &Path,
    mesh: &Mesh,
    cells: &Cells,
    time: f64,
    fields: &[Field<'_>],
) -> Result<(), ResultsError> {
    let points = &mesh.topology().points;
    let mut draft = Draft::default();
    draft.time(time);
    draft.text(&format!(
        r#"<Piece NumberOfPoints="{}" NumberOfCells="{}">"#,
        points.len(),
        mesh.cells()
    ));
    draft.text("<Points>");
    draft.vectors("points", points);
    draft.text("</Points>\n<Cells>");
    draft.wholes("connectivity", cells.connectivity.iter().copied());
    draft.wholes("offsets", cells.offsets.iter().copied());
    draft.array("UInt8", "types", 1, &cells.kinds);
    if !cells.faces.is_empty() {
        draft.wholes("faces", cells.faces.iter().copied());
        draft.wholes("faceoffsets", cells.face_offsets.iter().copied());
    }
    draft.text("</Cells>\n<CellData>");
    for field in fields {
        draft.field(field);
    }
    draft.text("</CellData>\n</Piece>");
    draft.write(path, "UnstructuredGrid")
}

/// Writes the particles at a process time in s.
pub(super) fn write_particles(
    path: &Path,
    positions: &[Vec3],
    time: f64,
    fields: &[Field<'_>],
) -> Result<(), ResultsError> {
    let count = positions.len();
    let mut draft = Draft::default();
    draft.time(time);
    draft.text(&format!(
        r#"<Piece NumberOfPoints="{count}" NumberOfVerts="{count}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">"#
    ));
    draft.text("<Points>");
    draft.vectors("points", positions);
    draft.text("</Points>\n<Verts>");
    draft.wholes("connectivity", 0..count as i64);
    draft.wholes("offsets", 1..=count as i64);
    draft.text("</Verts>\n<PointData>");
    for field in fields {
        draft.field(field);
    }
    draft.text("</PointData>\n</Piece>");
    draft.write(path, "PolyData")
}

/// Replaces a collection: one file per process time in s.
pub(super) fn write_collection(path: &Path, entries: &[(f64, String)]) -> Result<(), ResultsError> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
         byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (time, file) in entries {
        let _ = writeln!(
            text,
            r#"<DataSet timestep="{time:?}" group="" part="0" file="{file}"/>"#
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    files::replace(path, text.as_bytes())
}
