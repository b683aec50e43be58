//! Links the command for a fast start, and lists the programs of `c-programs/` with their texts, which are embedded in
//! it.
//!
//! Reads only files of this package, and fails if one cannot be read: a command without its examples is not built.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Suffixes of the files of programs: sources, machine files, stimuli, expected outputs.
const SUFFIXES: &[&str] = &["c", "h", "toml", "stim", "expected"];

fn main() -> Result<(), Box<dyn Error>> {
    link();
    list_examples()
}

/// Links the executable at a fixed address on Linux.
///
/// A position-independent executable has 25,000 pointers to adjust and 130 pages to copy before `main`, a fifth of the
/// time for compiling a program of 300 lines. Libraries, heap, stacks and the machine code of programs keep their
/// random addresses; the accesses of a program do not depend on any address, as each of them is checked.
fn link() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = |what: &str| std::env::var(format!("CARGO_CFG_TARGET_{what}")).unwrap_or_default();
    let is_static = target("FEATURE").split(',').any(|feature| feature == "crt-static");
    if target("OS") == "linux" && target("ENV") == "gnu" && !is_static {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}

/// Writes a table of all files of the examples.
fn list_examples() -> Result<(), Box<dyn Error>> {
    let root = examples(&PathBuf::from(env::var("CARGO_MANIFEST_DIR")?))?;
    let mut files = Vec::new();
    collect(&root, &mut files)?;
    files.sort();
    if files.is_empty() {
        return Err(format!("{} has no example programs", root.display()).into());
    }
    let mut text = String::from("&[\n");
    for path in &files {
        let name = path.strip_prefix(&root)?.to_string_lossy().replace('\\', "/");
        let place = path.canonicalize().map_err(|error| at(path, &error))?;
        writeln!(text, "({name:?}, include_bytes!({:?})),", place.to_string_lossy())?;
    }
    text.push_str("]\n");
    let table = PathBuf::from(env::var("OUT_DIR")?).join("examples.rs");
    fs::write(&table, text).map_err(|error| at(&table, &error))?;
    Ok(())
}

/// The folder of the examples: a folder in a published package, a link in the repository. If git creates no symbolic
/// links, the link is a file that contains its target.
fn examples(package: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let folder = package.join("c-programs");
    if !folder.is_file() {
        return Ok(folder);
    }
    let target = fs::read_to_string(&folder).map_err(|error| at(&folder, &error))?;
    Ok(package.join(target.trim()))
}

/// Adds the files of programs in a folder and its subfolders.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder).map_err(|error| at(folder, &error))? {
        let path = entry.map_err(|error| at(folder, &error))?.path();
        let suffix = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            collect(&path, files)?;
        } else if SUFFIXES.contains(&suffix.as_str()) {
            files.push(path);
        }
    }
    Ok(())
}

/// An error with the path.
fn at(path: &Path, error: &io::Error) -> Box<dyn Error> {
    format!("{}: {error}", path.display()).into()
}
