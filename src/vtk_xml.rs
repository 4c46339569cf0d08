//! Reads VTK's XML files: `.vtu` and `.vtp` with ASCII or raw appended arrays, and `.pvd` collections.

use std::str::FromStr;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use thiserror::Error;

/// What is wrong with a file.
#[derive(Clone, Debug, Error, PartialEq)]
pub(crate) enum VtkError {
    /// Not well-formed.
    #[error("it is not XML: {0}")]
    Syntax(String),
    /// Another kind of file.
    #[error("it has no element <VTKFile>")]
    Root,
    /// Compressed arrays.
    #[error("its arrays are compressed; write it without compression")]
    Compressed,
    /// The order of bytes of other machines.
    #[error("it is big-endian; write it as ASCII")]
    BigEndian,
    /// Appended data in base64.
    #[error("its appended data is not raw; write it as ascii or appended raw")]
    Encoded,
    /// An array that cannot be read.
    #[error("the array `{name}` {what}")]
    Array {
        /// Its name.
        name: String,
        /// What is wrong with it.
        what: String,
    },
    /// An entry of a collection.
    #[error("a data set has no time or file")]
    DataSet,
}

/// The pieces of a file.
#[derive(Debug)]
pub(crate) struct VtkFile<'b> {
    /// Arrays of each `<Piece>`.
    pub pieces: Vec<Vec<DataArray>>,
    /// `NumberOfPoints` of each, where it is stated.
    pub points: Vec<Option<usize>>,
    appended: Appended<'b>,
}

/// An array of a piece, not yet decoded.
#[derive(Debug)]
pub(crate) struct DataArray {
    /// The element that holds it: `Points`, `PointData`, `CellData`, `Cells`, `Verts` …
    pub section: String,
    /// Its name.
    pub name: String,
    /// Values a tuple.
    pub components: usize,
    kind: String,
    /// Where the values are, or what is wrong with the element: said where somebody wants them.
    store: Result<Store, String>,
}

/// Where the values of an array are.
#[derive(Debug)]
enum Store {
    Inline(String),
    Appended(usize),
}

/// Appended arrays: their bytes, and the length of the count before each.
#[derive(Debug, Default)]
struct Appended<'b> {
    bytes: &'b [u8],
    header: usize,
}

/// Reads the elements of a `.vtu` or `.vtp` file; what is cut short after them is noticed as arrays are decoded.
pub(crate) fn read(bytes: &[u8]) -> Result<VtkFile<'_>, VtkError> {
    let mut reader = Reader::from_reader(bytes);
    let mut pieces: Vec<Vec<DataArray>> = Vec::new();
    let mut points: Vec<Option<usize>> = Vec::new();
    let mut appended = Appended::default();
    let mut open: Vec<String> = Vec::new();
    let mut is_vtk = false;
    loop {
        match event(&mut reader)? {
            Event::Start(element) => {
                match element.name().as_ref() {
                    "VTKFile" => {
                        is_vtk = true;
                        appended.header = header(&element)?;
                    }
                    "Piece" => {
                        pieces.push(Vec::new());
                        let stated = attribute(&element, "NumberOfPoints")?;
                        points.push(stated.and_then(|text| text.trim().parse().ok()));
                    }
                    "DataArray" => {
                        if let (Some(piece), Some(section)) = (pieces.last_mut(), open.last()) {
                            piece.push(DataArray::new(section, &element)?);
                        }
                    }
                    "AppendedData" => {
                        if attribute(&element, "encoding")?.as_deref() != Some("raw") {
                            return Err(VtkError::Encoded);
                        }
                        let rest = reader.into_inner();
                        let mark = rest.iter().position(|&byte| byte == b'_');
                        appended.bytes = mark.map_or(&[], |mark| &rest[mark + 1..]);
                        break;
                    }
                    _ => {}
                }
                open.push(element.name().as_ref().to_owned());
            }
            Event::Empty(element) if element.name().as_ref() == "DataArray" => {
                if let (Some(piece), Some(section)) = (pieces.last_mut(), open.last()) {
                    piece.push(DataArray::new(section, &element)?);
                }
            }
            Event::Text(text) if open.last().is_some_and(|name| name == "DataArray") => {
                let array = pieces.last_mut().and_then(|piece| piece.last_mut());
                if let Some(DataArray {
                    store: Ok(Store::Inline(inline)),
                    ..
                }) = array
                {
                    inline.push_str(&text);
                }
            }
            Event::End(element) => {
                open.pop();
                if element.name().as_ref() == "VTKFile" {
                    break;
                }
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if !is_vtk {
        return Err(VtkError::Root);
    }
    Ok(VtkFile {
        pieces,
        points,
        appended,
    })
}

/// Time and file of each entry of a `.pvd` collection.
pub(crate) fn collection(text: &str) -> Result<Vec<(f64, String)>, VtkError> {
    let mut reader = Reader::from_str(text);
    let mut entries = Vec::new();
    loop {
        match event(&mut reader)? {
            Event::Start(element) | Event::Empty(element)
                if element.name().as_ref() == "DataSet" =>
            {
                let time = attribute(&element, "timestep")?.and_then(|time| time.parse().ok());
                let file = attribute(&element, "file")?;
                entries.push(time.zip(file).ok_or(VtkError::DataSet)?);
            }
            Event::Eof => return Ok(entries),
            _ => {}
        }
    }
}

fn event<'b>(reader: &mut Reader<&'b [u8]>) -> Result<Event<'b>, VtkError> {
    let event = reader.read_event();
    event.map_err(|error| VtkError::Syntax(error.to_string()))
}

/// An attribute of an element, its entities resolved.
fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, VtkError> {
    let found = element.try_get_attribute(name);
    let found = found.map_err(|error| VtkError::Syntax(error.to_string()))?;
    let value = found.map(|found| found.normalized_value(XmlVersion::Implicit1_0));
    let value = value.transpose();
    let value = value.map_err(|error| VtkError::Syntax(error.to_string()))?;
    Ok(value.map(|value| value.into_owned()))
}

/// Bytes of the count before each appended array.
fn header(file: &BytesStart<'_>) -> Result<usize, VtkError> {
    if attribute(file, "compressor")?.is_some() {
        return Err(VtkError::Compressed);
    }
    if attribute(file, "byte_order")?.as_deref() == Some("BigEndian") {
        return Err(VtkError::BigEndian);
    }
    Ok(match attribute(file, "header_type")?.as_deref() {
        Some("UInt64") => 8,
        _ => 4,
    })
}

impl DataArray {
    fn new(section: &str, element: &BytesStart<'_>) -> Result<Self, VtkError> {
        let components = match attribute(element, "NumberOfComponents")? {
            Some(text) => text.parse().ok().filter(|n| (1..=1000).contains(n)),
            None => Some(1),
        };
        let store = match attribute(element, "format")?.as_deref() {
            _ if components.is_none() => Err("has no sensible NumberOfComponents".to_owned()),
            Some("ascii") => Ok(Store::Inline(String::new())),
            Some("appended") => {
                let offset = attribute(element, "offset")?;
                let offset = offset.and_then(|text| text.parse().ok());
                offset
                    .map(Store::Appended)
                    .ok_or_else(|| "has no offset".into())
            }
            other => Err(format!(
                "has the format \"{}\"; write it as ascii or appended raw",
                other.unwrap_or("none")
            )),
        };
        Ok(Self {
            section: section.to_owned(),
            name: attribute(element, "Name")?.unwrap_or_default(),
            components: components.unwrap_or(1),
            kind: attribute(element, "type")?.unwrap_or_default(),
            store,
        })
    }
}

impl DataArray {
    /// True where its values are whole numbers of 64 bits.
    pub fn is_whole(&self) -> bool {
        matches!(self.kind.as_str(), "Int64" | "UInt64")
    }
}

impl VtkFile<'_> {
    /// The bytes of an appended array of numbers of 64 bits.
    pub fn bytes(&self, array: &DataArray) -> Result<&[u8], VtkError> {
        let wrong = |what: &str| VtkError::Array {
            name: array.name.clone(),
            what: what.to_owned(),
        };
        let block = match array.store.as_ref().map_err(|what| wrong(what))? {
            Store::Inline(_) => return Err(wrong("is not appended")),
            Store::Appended(offset) => self.appended.block(*offset),
        };
        let block = block.ok_or_else(|| wrong("lies beyond the end of the file"))?;
        let wide = array.is_whole() || array.kind == "Float64";
        if !wide || !block.len().is_multiple_of(8 * array.components) {
            return Err(wrong("does not hold whole tuples of 64 bits"));
        }
        Ok(block)
    }

    /// The values of an array, whole tuples; whole numbers too.
    pub fn values(&self, array: &DataArray) -> Result<Vec<f64>, VtkError> {
        let wrong = |what: &str| VtkError::Array {
            name: array.name.clone(),
            what: what.to_owned(),
        };
        let values: Vec<f64> = match array.store.as_ref().map_err(|what| wrong(what))? {
            Store::Inline(text) => {
                let numbers = text.split_whitespace().map(f64::from_str);
                let numbers: Result<_, _> = numbers.collect();
                numbers.map_err(|_| wrong("holds something that is not a number"))?
            }
            Store::Appended(offset) => {
                let block = self.appended.block(*offset);
                let block = block.ok_or_else(|| wrong("lies beyond the end of the file"))?;
                let kind = &array.kind;
                decode(kind, block).ok_or_else(|| wrong(&format!("is of the type \"{kind}\"")))?
            }
        };
        if !values.len().is_multiple_of(array.components) {
            return Err(wrong("does not hold whole tuples"));
        }
        Ok(values)
    }
}

impl<'b> Appended<'b> {
    fn block(&self, offset: usize) -> Option<&'b [u8]> {
        let rest = self.bytes.get(offset..)?;
        let (count, rest) = rest.split_at_checked(self.header)?;
        let mut length = [0; 8];
        length[..self.header].copy_from_slice(count);
        rest.get(..usize::try_from(u64::from_le_bytes(length)).ok()?)
    }
}

/// Little-endian numbers of a VTK type; `None` for types that are not numbers.
fn decode(kind: &str, bytes: &[u8]) -> Option<Vec<f64>> {
    macro_rules! each {
        ($type:ty) => {
            bytes
                .chunks_exact(size_of::<$type>())
                .map(|chunk| Some(<$type>::from_le_bytes(chunk.try_into().ok()?) as f64))
                .collect()
        };
    }
    match kind {
        "Float64" => each!(f64),
        "Float32" => each!(f32),
        "Int64" => each!(i64),
        "UInt64" => each!(u64),
        "Int32" => each!(i32),
        "UInt32" => each!(u32),
        "Int16" => each!(i16),
        "UInt16" => each!(u16),
        "Int8" => each!(i8),
        "UInt8" => each!(u8),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\"><PolyData><Piece>";

    #[test]
    fn ascii_arrays_are_found_by_section_and_name_with_entities_resolved() {
        let text = format!(
            "{HEAD}<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">1 2\n3\
             </DataArray></Points><PointData><!-- a comment --><DataArray Name=\"a&amp;b\" \
             format='ascii'>4e0</DataArray></PointData></Piece></PolyData></VTKFile>"
        );
        let file = read(text.as_bytes()).unwrap();
        let [points, data] = &file.pieces[0][..] else {
            panic!("{file:?}")
        };
        assert_eq!((points.section.as_str(), points.components), ("Points", 3));
        assert_eq!(file.values(points), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(
            (data.section.as_str(), data.name.as_str()),
            ("PointData", "a&b")
        );
        assert_eq!(file.values(data), Ok(vec![4.0]));
    }

    #[test]
    fn appended_bytes_may_hold_anything_and_are_checked_against_the_end() {
        let head = format!(
            "{HEAD}<Points><DataArray type=\"UInt8\" Name=\"p\" format=\"appended\" offset=\"0\"/>\
             <DataArray type=\"UInt8\" Name=\"q\" format=\"appended\" offset=\"7\"/></Points></Piece>\
             </PolyData><AppendedData encoding=\"raw\">\n_"
        );
        let bytes = [
            head.as_bytes(),
            &[3, 0, 0, 0, b'<', 0xff, b'_', 9, 0, 0, 0, 1],
        ]
        .concat();
        let file = read(&bytes).unwrap();
        let [p, q] = &file.pieces[0][..] else {
            panic!("{file:?}")
        };
        assert_eq!(file.values(p), Ok(vec![60.0, 255.0, 95.0]));
        let error = file.values(q).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the array `q` lies beyond the end of the file"
        );
    }

    #[test]
    fn what_is_not_read_is_named() {
        let said = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(said("x,y,z"), "it has no element <VTKFile>");
        assert!(said("<VTKFile><a></b></VTKFile>").starts_with("it is not XML: "));
        assert!(said("<VTKFile byte_order=\"BigEndian\">").starts_with("it is big-endian"));
        let binary = format!("{HEAD}<Points><DataArray Name=\"p\" format=\"binary\"/>");
        let file = read(binary.as_bytes()).unwrap();
        let error = file.values(&file.pieces[0][0]).unwrap_err().to_string();
        assert!(error.contains("`p` has the format \"binary\""), "{error}");
        assert_eq!(
            collection("<VTKFile><Collection><DataSet timestep=\"1\"/>"),
            Err(VtkError::DataSet)
        );
    }
}
