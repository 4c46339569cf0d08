//! The view of a bed that turns: spheres and walls in the browser's WebGL2, self-contained.

mod cast;
mod pack;
mod surface;
mod walls;

use std::path::Path;

use self::cast::Cast;
use self::surface::{Surface, surface};
use self::walls::{Extent, extent, polygons};
use super::colour::Range;
use super::shade::Shade;
use crate::results::ResultsError;
use crate::results::read;

/// What draws it.
pub(super) const SCRIPT: &str = include_str!("view.js");
/// Its part of the page's styles.
pub(super) const STYLE: &str = include_str!("view.css");
const FIGURE: &str = include_str!("view.html");
/// Bytes of the description beside the data, at most, about.
const DESCRIPTION: usize = 20_000;

/// The particles and walls of a run, read.
pub(super) struct View {
    cast: Cast,
    surface: Surface,
    extent: Extent,
}

impl View {
    /// Reads snapshots and walls; `None` where there are no particles.
    pub fn read(directory: &Path) -> Result<Option<Self>, ResultsError> {
        let Some(cast) = Cast::read(directory)? else {
            return Ok(None);
        };
        let walls = match read::collection(directory, "gas.pvd")?.first() {
            Some((_, file)) => polygons(directory, &read::arrays(file)?),
            None => Vec::new(),
        };
        let centres = cast.moments.iter().flat_map(|moment| &moment.centres);
        let Some(extent) = extent(walls.iter().flatten().chain(centres)) else {
            return Ok(None);
        };
        Ok(Some(Self {
            surface: surface(&walls, extent),
            cast,
            extent,
        }))
    }

    /// The range over all its snapshots of what colours the pictures.
    pub fn range(&self, shade: Shade) -> Option<Range> {
        self.cast.range(shade.column())
    }

    /// The view in so many bytes, with the range of the pictures.
    pub fn render(mut self, shade: Shade, range: Option<Range>, room: usize) -> String {
        let first = shade.column();
        for column in &mut self.cast.columns {
            if let (Some(range), true) = (range, column.name == first) {
                column.range = column.range.with(range);
            }
        }
        let fixed = FIGURE.len() + SCRIPT.len() + STYLE.len() + DESCRIPTION;
        let room = room.saturating_sub(fixed);
        let data = pack::pack(&self.cast, &self.surface, self.extent, first, room);
        let all = self.cast.moments.len();
        let mut note = String::new();
        if data.stride > 1 {
            note = format!("One of {} particles is drawn. ", data.stride);
        }
        if data.snapshots() < all {
            note += &format!(
                "{} of the snapshots are in this page; all of them are beside it.",
                data.snapshots()
            );
        }
        if !note.is_empty() {
            note = format!("<p class=\"note\">{}</p>", note.trim_end());
        }
        // A text in a script must not end it.
        let json = serde_json::to_string(&data).unwrap_or_default();
        let json = json.replace('<', "\\u003c");
        format!(
            "{}{note}<script type=\"application/json\" class=\"bed-data\">{json}</script></figure>",
            FIGURE.trim_end()
        )
    }
}
