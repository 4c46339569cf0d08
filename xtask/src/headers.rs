//! Headers of OpenFOAM. Debian ships its libraries and solvers without them; they come from
//! Debian's source package of exactly the installed version, verified by APT.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::packages;
use crate::sources::write_source_entries;
use crate::steps::{Stop, TaskResult, new_log, quietly, step};

/// A complete tree of headers holds this file: written last, before the tree gets its name.
const STAMP: &str = ".complete-with-solvers";

/// What is kept of the sources: headers, and the solver that Debian's compiler broke (adapters/openfoam/build.sh).
const KEPT: [&str; 3] = [
    "src",
    "wmake",
    "applications/solvers/heatTransfer/buoyantPimpleFoam",
];

/// End of the name of a folder in which headers are being prepared.
const PART: &str = ".headers.part";

/// Files that one `#include`s, templates in `.C` among them.
const INCLUDED: [&str; 7] = ["H", "C", "h", "hpp", "cpp", "cxx", "I"];

/// The folders below `src/` and `wmake/` for the installed OpenFOAM, as `FOLDER/VERSION`;
/// made if it is not there yet. Each library's `lnInclude` folder is ready to use.
pub fn prepare(folder: &Path, logs: &Path) -> TaskResult<PathBuf> {
    let version = packages::source_version("openfoam").ok_or_else(|| {
        Stop::new("the package openfoam is not installed: run `cargo xtask setup`")
    })?;
    let tree = folder.join(version.replace(':', "_"));
    if tree.join(STAMP).is_file() {
        return Ok(tree);
    }
    fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let work = folder.join(format!("{}{PART}", std::process::id()));
    remove_leftovers(folder);
    let log = new_log(logs, "openfoam-headers")?;
    step(
        &format!("fetch Debian's sources of openfoam {version} (45 MB)"),
        || fetch(&version, &work, &log),
    )?;
    step("unpack them", || unpack(&work, &log))?;
    step("collect the headers of each library", || {
        let kept = work.join("kept");
        link_headers(&kept.join("src"))?;
        write(&kept.join(STAMP), &version)?;
        remove(&tree)?;
        fs::rename(&kept, &tree).map_err(|cause| Stop::io(&tree, &cause))?;
        remove(&work)
    })?;
    Ok(tree)
}

/// Downloads the source package with a private configuration of APT into `work`.
fn fetch(version: &str, work: &Path, log: &Path) -> TaskResult<()> {
    for sub in ["parts", "lists/partial", "cache/archives/partial"] {
        let path = work.join(sub);
        fs::create_dir_all(&path).map_err(|cause| Stop::io(&path, &cause))?;
    }
    write_source_entries(&work.join("parts"))?;
    quietly(apt(work).arg("update"), log)?;
    let package = format!("openfoam={version}");
    let download = ["source", "--download-only", "--only-source", &package];
    quietly(apt(work).args(download), log).map_err(|stop| {
        Stop(format!(
            "{}\nDebian's source package must be of the installed version {version}; if the \
             servers hold a newer one only, `apt-get install --only-upgrade openfoam` first",
            stop.0
        ))
    })
}

/// `apt-get` with its own entries, lists and cache below `work`, which needs no root. The
/// downloads are verified by the same keys; only the sandbox user is left out, who could not
/// write here.
fn apt(work: &Path) -> Command {
    let mut command = Command::new("apt-get");
    command
        .current_dir(work)
        .args(["-q", "-y", "-o", "Dir::Etc::SourceList=/dev/null"]);
    let folders = [
        ("Dir::Etc::SourceParts", "parts"),
        ("Dir::State::Lists", "lists"),
        ("Dir::Cache", "cache"),
    ];
    for (option, sub) in folders {
        let mut value = std::ffi::OsString::from(format!("{option}="));
        value.push(work.join(sub));
        command.arg("-o").arg(value);
    }
    command.args(["-o", "APT::Sandbox::User=root", "-o", "Acquire::Retries=3"]);
    command.args(["-o", "APT::Get::List-Cleanup=false"]);
    command.env("LC_ALL", "C.UTF-8");
    command
}

/// Unpacks the source package and keeps the parts in use, as `work/kept`.
fn unpack(work: &Path, log: &Path) -> TaskResult<()> {
    let description = fs::read_dir(work)
        .map_err(|cause| Stop::io(work, &cause))?
        .flatten()
        .map(|entry| entry.path())
        .find(|path| path.extension().is_some_and(|extension| extension == "dsc"))
        .ok_or_else(|| Stop(format!("{}: apt-get left no .dsc file", work.display())))?;
    let mut command = Command::new("dpkg-source");
    command
        .current_dir(work)
        .args(["-q", "-x"])
        .arg(&description)
        .arg("tree");
    quietly(&mut command, log)?;
    let kept = work.join("kept");
    fs::create_dir_all(&kept).map_err(|cause| Stop::io(&kept, &cause))?;
    for part in KEPT {
        let (from, to) = (work.join("tree").join(part), kept.join(part));
        if let Some(parent) = to.parent() {
            fs::create_dir_all(parent).map_err(|cause| Stop::io(parent, &cause))?;
        }
        fs::rename(&from, &to).map_err(|cause| Stop::io(&from, &cause))?;
    }
    Ok(())
}

/// Gives every library below `source` (a folder that holds `Make/files`) a folder `lnInclude`
/// with a link to each of its headers, as OpenFOAM's `wmakeLnInclude` does.
fn link_headers(source: &Path) -> TaskResult<()> {
    let mut folders = vec![source.to_owned()];
    while let Some(folder) = folders.pop() {
        for sub in subfolders(&folder)? {
            folders.push(sub);
        }
        if folder.join("Make/files").is_file() {
            link_library(&folder)?;
        }
    }
    Ok(())
}

fn link_library(library: &Path) -> TaskResult<()> {
    let mut headers = BTreeMap::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(relative) = folders.pop() {
        for sub in subfolders(&library.join(&relative))? {
            if let Some(name) = sub.file_name() {
                folders.push(relative.join(name));
            }
        }
        let here = library.join(&relative);
        for entry in fs::read_dir(&here)
            .map_err(|cause| Stop::io(&here, &cause))?
            .flatten()
        {
            let path = entry.path();
            let extension = path
                .extension()
                .and_then(|text| text.to_str())
                .unwrap_or_default();
            if INCLUDED.contains(&extension) && path.is_file() {
                // Of two files with one name the first in alphabetical order counts.
                let found = relative.join(entry.file_name());
                let slot = headers
                    .entry(entry.file_name())
                    .or_insert_with(|| found.clone());
                if found < *slot {
                    *slot = found;
                }
            }
        }
    }
    let links = library.join("lnInclude");
    fs::create_dir_all(&links).map_err(|cause| Stop::io(&links, &cause))?;
    for (name, path) in headers {
        let link = links.join(name);
        symlink(Path::new("..").join(path), &link).map_err(|cause| Stop::io(&link, &cause))?;
    }
    Ok(())
}

/// Subfolders that can hold a library's own headers.
fn subfolders(folder: &Path) -> TaskResult<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let own = |path: &PathBuf| {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        !["lnInclude", "Make", "config", "noLink"].contains(&name)
            && path.is_dir()
            && !path.is_symlink()
    };
    Ok(entries
        .flatten()
        .map(|entry| entry.path())
        .filter(own)
        .collect())
}

fn write(path: &Path, text: &str) -> TaskResult<()> {
    fs::write(path, text).map_err(|cause| Stop::io(path, &cause))
}

/// Removes what interrupted preparations left. What a dying one still writes can stay for once.
fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().ends_with(PART) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

fn remove(folder: &Path) -> TaskResult<()> {
    match fs::remove_dir_all(folder) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(Stop::io(folder, &cause)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_library_gets_links_to_its_own_headers() {
        let root = std::env::temp_dir().join(format!("xtask headers {}", std::process::id()));
        let library = root.join("src/mesh tools");
        for folder in ["Make", "deep/er", "noLink"] {
            fs::create_dir_all(library.join(folder)).unwrap();
        }
        write(&library.join("Make/files"), "").unwrap();
        for file in [
            "a.H",
            "deep/b.C",
            "deep/er/c.H",
            "deep/er/a.H",
            "deep/read.me",
            "noLink/d.H",
        ] {
            write(&library.join(file), file).unwrap();
        }
        link_headers(&root.join("src")).unwrap();
        let read = |name: &str| fs::read_to_string(library.join("lnInclude").join(name)).ok();
        assert_eq!(read("a.H").as_deref(), Some("a.H"));
        assert_eq!(read("b.C").as_deref(), Some("deep/b.C"));
        assert_eq!(read("c.H").as_deref(), Some("deep/er/c.H"));
        assert_eq!(read("read.me"), None);
        assert_eq!(read("d.H"), None);
        fs::remove_dir_all(&root).unwrap();
    }
}
