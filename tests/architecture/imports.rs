//! Which file of a crate takes names from which, and the circles in that.
//!
//! A file takes from another what it names by a path (in a `use` or in place) that leads to an item which the
//! other file defines at its top level. A path counts for the file that defines the item: a `mod` declaration,
//! and a parent that only hands on (`pub use`) what a child defines, are no ties, so that `mod.rs` above its
//! children makes a circle only where a child takes an item that `mod.rs` itself defines, while `mod.rs` takes
//! something of the child. Methods are found by their types, so that an `impl` elsewhere ties its file to the
//! type's, and a call does not tie back. What only tests compile does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::source::{behind, words};

/// A file that is a module.
struct Module {
    file: PathBuf,
    parent: Option<usize>,
    children: BTreeMap<String, usize>,
    words: Vec<String>,
    items: BTreeSet<String>,
    /// Names that `use` brings in, and the paths that they stand for.
    names: BTreeMap<String, Vec<String>>,
    /// Those that the file hands on (`pub use`) and does not name itself.
    handed_on: BTreeSet<String>,
    /// Paths of `use …::*`.
    globs: Vec<Vec<String>>,
}

/// The files of a crate, from its root on.
pub struct Modules {
    all: Vec<Module>,
}

/// What each file takes from which other: file, file, names.
pub type Ties = BTreeMap<PathBuf, BTreeMap<PathBuf, BTreeSet<String>>>;

impl Modules {
    /// Reads a crate from its root file, `lib.rs` or `main.rs`.
    pub fn read(root: &Path) -> Self {
        let mut modules = Self { all: Vec::new() };
        let folder = root.parent().map(Path::to_path_buf).unwrap_or_default();
        modules.add(root.to_path_buf(), &folder, None);
        modules
    }

    fn add(&mut self, file: PathBuf, folder: &Path, parent: Option<usize>) -> usize {
        let text = fs::read_to_string(&file);
        let words = words(&text.unwrap_or_else(|error| panic!("{}: {error}", file.display())));
        let items = items(&words);
        let Uses {
            names,
            globs,
            public,
        } = uses(&words);
        let own_names = names_outside_uses(&words);
        let handed_on = public.difference(&own_names).cloned().collect();
        let declared = declared(&words);
        let own = self.all.len();
        self.all.push(Module {
            file,
            parent,
            children: BTreeMap::new(),
            words,
            items,
            names,
            handed_on,
            globs,
        });
        for name in declared {
            let flat = folder.join(format!("{name}.rs"));
            let inner = folder.join(&name);
            let file = if flat.is_file() {
                flat
            } else {
                inner.join("mod.rs")
            };
            let child = self.add(file, &inner, Some(own));
            self.all[own].children.insert(name, child);
        }
        own
    }

    /// The module whose file defines what a path leads to, and the item's name; `None` for what is of no file of
    /// this crate, and for a path that leads to a module.
    fn definer(&self, from: usize, path: &[String], depth: usize) -> Option<(usize, String)> {
        let mut at = from;
        for (i, step) in path.iter().enumerate() {
            let module = &self.all[at];
            let last = i + 1 == path.len();
            at = match step.as_str() {
                "crate" => 0,
                "self" => at,
                "super" => module.parent?,
                name if last && module.items.contains(name) => return Some((at, step.clone())),
                name if module.children.contains_key(name) => module.children[name],
                name if module.items.contains(name) => return Some((at, step.clone())),
                name => {
                    // Names of names end somewhere; `use a::a` of a library named `a` does not.
                    if depth > 8 {
                        return None;
                    }
                    if let Some(stands_for) = module.names.get(name) {
                        let whole: Vec<String> =
                            stands_for.iter().chain(&path[i + 1..]).cloned().collect();
                        return self.definer(at, &whole, depth + 1);
                    }
                    return module.globs.iter().find_map(|glob| {
                        let whole: Vec<String> = glob.iter().chain(&path[i..]).cloned().collect();
                        self.definer(at, &whole, depth + 1)
                    });
                }
            };
        }
        None
    }

    /// What the files take from each other.
    pub fn ties(&self) -> Ties {
        let mut ties = Ties::new();
        for (own, module) in self.all.iter().enumerate() {
            let named = module.names.iter();
            let named = named.filter(|(name, _)| !module.handed_on.contains(*name));
            let of_uses = named.map(|(_, path)| path.clone());
            for path in of_uses.chain(paths(&module.words)) {
                if let Some((other, name)) = self.definer(own, &path, 0)
                    && other != own
                {
                    let from = ties.entry(module.file.clone()).or_default();
                    let file = self.all[other].file.clone();
                    from.entry(file).or_default().insert(name);
                }
            }
        }
        ties
    }

    /// Number of files.
    pub fn len(&self) -> usize {
        self.all.len()
    }
}

/// The circles: files each of which leads to all others of its circle; every circle in order, and all of them.
pub fn circles(ties: &Ties) -> Vec<Vec<PathBuf>> {
    let reached = |from: &PathBuf| {
        let (mut found, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(file) = next.pop() {
            for other in ties.get(file).into_iter().flat_map(BTreeMap::keys) {
                if found.insert(other.clone()) {
                    next.push(other);
                }
            }
        }
        found
    };
    let all: BTreeMap<&PathBuf, BTreeSet<PathBuf>> =
        ties.keys().map(|file| (file, reached(file))).collect();
    let mut circles = BTreeSet::new();
    for (file, others) in &all {
        if others.contains(*file) {
            let back = |other: &&PathBuf| all.get(*other).is_some_and(|set| set.contains(*file));
            circles.insert(others.iter().filter(back).cloned().collect::<Vec<_>>());
        }
    }
    circles.into_iter().collect()
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Modules with files of their own that a file declares.
fn declared(words: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for (i, word) in words.iter().enumerate() {
        if word == "mod" && words.get(i + 2).is_some_and(|end| end == ";") {
            found.push(words[i + 1].clone());
        }
    }
    found
}

/// Items that a file defines at its top level.
fn items(words: &[String]) -> BTreeSet<String> {
    let kinds = [
        "fn", "struct", "enum", "union", "trait", "type", "const", "static", "mod",
    ];
    let mut found = BTreeSet::new();
    let mut i = 0;
    while i < words.len() {
        let word = words[i].as_str();
        let next = words.get(i + 1).map_or("", String::as_str);
        if word == "macro_rules" {
            found.insert(words[i + 2].clone());
        }
        let of_file = word == "mod" && words.get(i + 2).is_some_and(|end| end == ";");
        if kinds.contains(&word) && is_name(next) && !kinds.contains(&next) && !of_file {
            found.insert(next.to_owned());
        }
        i = if ["(", "[", "{"].contains(&word) {
            behind(words, i)
        } else {
            i + 1
        };
    }
    found
}

/// What `use` brings into a file, wherever it stands.
#[derive(Default)]
struct Uses {
    names: BTreeMap<String, Vec<String>>,
    globs: Vec<Vec<String>>,
    /// Names that are handed on.
    public: BTreeSet<String>,
}

/// True where a `use` begins; `impl Trait + use<'a>` is none.
fn is_use(words: &[String], i: usize) -> bool {
    words[i] == "use" && words.get(i + 1).is_some_and(|next| next != "<")
}

fn uses(words: &[String]) -> Uses {
    let mut all = Uses::default();
    for i in (0..words.len()).filter(|&i| is_use(words, i)) {
        let mut uses = Uses::default();
        tree(words, i + 1, &[], &mut uses);
        // `pub use`, `pub(super) use`.
        if i > 0 && ["pub", ")"].contains(&words[i - 1].as_str()) {
            all.public.extend(uses.names.keys().cloned());
        }
        all.names.extend(uses.names);
        all.globs.extend(uses.globs);
    }
    all
}

/// Reads a tree of `use` and gives the index behind it.
fn tree(words: &[String], mut i: usize, before: &[String], uses: &mut Uses) -> usize {
    let mut path = before.to_vec();
    while i < words.len() {
        match words[i].as_str() {
            "::" => i += 1,
            "*" => {
                uses.globs.push(path);
                return i + 1;
            }
            "{" => {
                i += 1;
                while words[i] != "}" {
                    i = tree(words, i, &path, uses);
                    i += usize::from(words[i] == ",");
                }
                return i + 1;
            }
            "as" => {
                uses.names.insert(words[i + 1].clone(), path);
                return i + 2;
            }
            word if is_name(word) => {
                path.push(word.to_owned());
                i += 1;
            }
            _ => break,
        }
    }
    if path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    if let Some(last) = path.last() {
        uses.names.insert(last.clone(), path.clone());
    }
    i
}

/// All names of a file outside `use`, but those of fields and methods.
fn names_outside_uses(words: &[String]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut i = 0;
    while i < words.len() {
        if is_use(words, i) {
            i = tree(words, i + 1, &[], &mut Uses::default());
        } else {
            let of_another = i > 0 && [".", "mod"].contains(&words[i - 1].as_str());
            if !of_another && words.get(i + 1).is_none_or(|next| next != ":") {
                found.insert(words[i].clone());
            }
            i += 1;
        }
    }
    found
}

/// Paths of more than one name outside `use`, as far as the names go.
fn paths(words: &[String]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut i = 0;
    while i < words.len() {
        if is_use(words, i) {
            i = tree(words, i + 1, &[], &mut Uses::default());
            continue;
        }
        let begin = i;
        let mut path = Vec::new();
        while is_name(&words[i]) {
            path.push(words[i].clone());
            let more = words.get(i + 1).is_some_and(|word| word == "::");
            if !more || !words.get(i + 2).is_some_and(|word| is_name(word)) {
                break;
            }
            i += 2;
        }
        let continued = begin > 0 && ["::", "."].contains(&words[begin - 1].as_str());
        if path.len() > 1 && !continued {
            found.push(path);
        }
        i += 1;
    }
    found
}
