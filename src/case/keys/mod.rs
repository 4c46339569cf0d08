//! The keys of a case file. Each is declared once, in the file of its section: its type with dimension and bounds,
//! whether it must be there, what holds without it, what it means and an example. The reader, the JSON schema and
//! the reference in the docs take them from here; a reader that asks for what is not declared is refused.

mod agreement;
mod below;
mod bodies;
mod contacts;
mod coupling;
mod describe;
mod docs;
mod external;
mod flowsheet;
mod gas;
mod key;
mod kinds;
mod law_path;
mod laws;
mod materials;
mod mesh;
mod motion;
mod of_laws;
mod output;
mod particles;
mod placed;
mod prelude;
mod quantities;
mod reactions;
mod root;
mod tuning;
mod walls;
mod zone;

pub(super) use describe::{number_words, parse_number};
pub use docs::{BEGIN, markdown};
pub use key::{Key, KeyPresence, KeyValue, MOST};
pub use kinds::{CaseKind, KINDS, kind_named, kind_names};
pub use law_path::{LawFamily, LawPath};
pub use placed::{PlacedKey, keys};

#[cfg(test)]
mod tests;
