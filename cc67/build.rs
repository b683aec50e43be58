//! Links the command for a fast start, and lists the programs of `c-programs/` with their texts, which it brings along.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Files of programs: sources, machine files, stimuli, goldens.
const SUFFIXES: &[&str] = &["c", "h", "toml", "stim", "expected"];

fn main() {
    link();
    list_examples();
}

/// On Linux the executable gets a fixed address.
///
/// One that can be loaded anywhere has 25,000 pointers to adjust and 130 pages to copy before `main`, a fifth of the
/// time in which a program of 300 lines is compiled. Libraries, heap, stacks and the machine code of programs keep
/// their random addresses; what a program can reach does not depend on any address, each of its accesses is checked.
fn link() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = |what: &str| std::env::var(format!("CARGO_CFG_TARGET_{what}")).unwrap_or_default();
    let is_static = target("FEATURE").split(',').any(|feature| feature == "crt-static");
    if target("OS") == "linux" && target("ENV") == "gnu" && !is_static {
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}

/// Writes a table of all files of the examples.
fn list_examples() {
    let manifest = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let root = manifest.join("../c-programs");
    println!("cargo::rerun-if-changed={}", root.display());
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let mut text = String::from("&[\n");
    for path in &files {
        let name = path.strip_prefix(&root).unwrap_or(path).to_string_lossy().replace('\\', "/");
        let place = path.canonicalize().unwrap_or_else(|_| path.clone());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "({name:?}, include_bytes!({:?})),", place.to_string_lossy());
    }
    text.push_str("]\n");
    let out = env::var_os("OUT_DIR").map(PathBuf::from).unwrap_or_default();
    fs::write(out.join("examples.rs"), text).expect("cargo gives a folder to write to");
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    println!("cargo::rerun-if-changed={}", folder.display());
    for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        let suffix = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            collect(&path, files);
        } else if SUFFIXES.contains(&suffix.as_str()) {
            files.push(path);
        }
    }
}
