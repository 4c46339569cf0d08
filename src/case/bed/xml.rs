//! VTK's XML format (`.vtp`, `.vtu`): ASCII arrays, or appended raw ones as Calcine writes them.

use super::{Fault, Sheet, add};

/// Appended arrays: their bytes, and how long the count before each is.
struct Appended<'b> {
    bytes: &'b [u8],
    header: usize,
}

pub(super) fn sheet(bytes: &[u8]) -> Result<Sheet, Fault> {
    let fault = |what: &str| Err((None, what.to_owned()));
    let mark = b"<AppendedData";
    let begin = find(bytes, mark).unwrap_or(bytes.len());
    let Ok(head) = std::str::from_utf8(&bytes[..begin]) else {
        return fault("it is not XML text before its appended data");
    };
    let Some(file) = element(head, "VTKFile") else {
        return fault("it has no element <VTKFile>");
    };
    if attribute(file, "compressor").is_some() {
        return fault("its arrays are compressed; write it without compression");
    }
    if attribute(file, "byte_order") == Some("BigEndian") {
        return fault("it is big-endian; write it as ASCII");
    }
    let header = match attribute(file, "header_type") {
        Some("UInt64") => 8,
        _ => 4,
    };
    let appended = Appended {
        bytes: raw(&bytes[begin..])?,
        header,
    };
    let mut sheet = Sheet::default();
    for piece in head.split("<Piece").skip(1) {
        let Some(points) = between(piece, "<Points", "</Points>") else {
            return fault("a <Piece> has no <Points>");
        };
        let mut part = Sheet::default();
        for (_, components, values) in arrays(points, &appended)? {
            if components != 3 {
                return fault("its points have not three components");
            }
            add(&mut part, "points", 3, &values);
        }
        let count = part.columns.first().map_or(0, |(_, list)| list.len());
        if let Some(data) = between(piece, "<PointData", "</PointData>") {
            for (name, components, values) in arrays(data, &appended)? {
                if values.len() != count * components {
                    let what = format!(
                        "the array `{name}` has {} values for {count} points",
                        values.len()
                    );
                    return Err((None, what));
                }
                add(&mut part, &name, components, &values);
            }
        }
        join(&mut sheet, part)?;
    }
    if sheet.columns.is_empty() {
        return fault("it has no points");
    }
    Ok(sheet)
}

/// Appends the particles of a piece; all pieces have the same arrays.
fn join(sheet: &mut Sheet, part: Sheet) -> Result<(), Fault> {
    if sheet.columns.is_empty() {
        *sheet = part;
        return Ok(());
    }
    let same = sheet.columns.len() == part.columns.len();
    let mut pairs = sheet.columns.iter_mut().zip(part.columns);
    if same
        && pairs.all(|(all, more)| {
            all.0 == more.0 && {
                all.1.extend(more.1);
                true
            }
        })
    {
        return Ok(());
    }
    Err((None, "its pieces have different arrays".into()))
}

type Arrays = Vec<(String, usize, Vec<f64>)>;

/// The arrays of a part of the file: name, components, values.
fn arrays(text: &str, appended: &Appended<'_>) -> Result<Arrays, Fault> {
    let mut found = Vec::new();
    for part in text.split("<DataArray").skip(1) {
        let (head, rest) = part.split_once('>').unwrap_or((part, ""));
        let name = attribute(head, "Name").unwrap_or("").to_owned();
        let components = attribute(head, "NumberOfComponents");
        let components = components.map_or(Some(1), |text| text.parse::<usize>().ok());
        let kind = attribute(head, "type").unwrap_or("");
        let wrong = |what: &str| (None, format!("the array `{name}` {what}"));
        let components = components
            .filter(|&n| (1..=1000).contains(&n))
            .ok_or_else(|| wrong("has no sensible NumberOfComponents"))?;
        let values = match attribute(head, "format") {
            Some("ascii") => {
                let body = rest.split('<').next().unwrap_or("");
                let numbers: Result<Vec<f64>, _> =
                    body.split_whitespace().map(str::parse).collect();
                numbers.map_err(|_| wrong("holds something that is not a number"))?
            }
            Some("appended") => {
                let offset = attribute(head, "offset").and_then(|text| text.parse().ok());
                let offset = offset.ok_or_else(|| wrong("has no offset"))?;
                let block = appended
                    .block(offset)
                    .ok_or_else(|| wrong("lies beyond the end of the file"))?;
                decode(kind, block).ok_or_else(|| wrong(&format!("is of the type \"{kind}\"")))?
            }
            other => {
                let form = other.unwrap_or("none");
                let what = format!("has the format \"{form}\"; write it as ascii or appended raw");
                return Err(wrong(&what));
            }
        };
        if values.len() % components != 0 {
            return Err(wrong("does not hold whole tuples"));
        }
        found.push((name, components, values));
    }
    Ok(found)
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

/// The bytes after the mark `_` of raw appended data; none where the file has none.
fn raw(bytes: &[u8]) -> Result<&[u8], Fault> {
    let Some(end) = find(bytes, b">") else {
        return Ok(&[]);
    };
    let head = String::from_utf8_lossy(&bytes[..end]);
    if attribute(&head, "encoding") != Some("raw") {
        let what = "its appended data is not raw; write it as ascii or appended raw";
        return Err((None, what.into()));
    }
    let rest = &bytes[end + 1..];
    let start = find(rest, b"_").map_or(rest.len(), |mark| mark + 1);
    Ok(&rest[start..])
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

fn find(bytes: &[u8], mark: &[u8]) -> Option<usize> {
    bytes.windows(mark.len()).position(|window| window == mark)
}

/// The attributes of the first element of a name.
fn element<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    let (_, rest) = text.split_once(&format!("<{name}"))?;
    rest.split('>').next()
}

fn between<'t>(text: &'t str, open: &str, close: &str) -> Option<&'t str> {
    let (_, rest) = text.split_once(open)?;
    rest.split_once(close).map(|(inner, _)| inner)
}

fn attribute<'t>(head: &'t str, name: &str) -> Option<&'t str> {
    let (_, rest) = head.split_once(&format!(" {name}=\""))?;
    rest.split('"').next()
}
