//! The third-party notices cover the crates that the executables contain.
//!
//! `cc67/THIRD-PARTY.txt` is part of every package, archive and wheel. It contains the licence of each crate with which
//! the command, the C interface or the Python package is linked, on any system, and the texts from the crates;
//! `CC67_WRITE_NOTICES=1 cargo test --test release notices` writes it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::root;

/// A third-party crate: name and version.
type Package = (String, String);

/// The third-party crates with which a package is linked, each with its licence.
fn linked(manifest: &str, packages: &[&str]) -> BTreeMap<Package, String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--edges", "normal,no-proc-macro", "--target", "all", "--prefix", "none"])
        .args(["--no-dedupe", "--format", "{p}|{l}", "--manifest-path"])
        .arg(root().join(manifest))
        .args(packages.iter().flat_map(|package| ["--package", package]))
        .output()
        .expect("cargo starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "`cargo fetch --manifest-path {manifest}` gets what is missing: {said}");
    let text = String::from_utf8(output.stdout).expect("names of crates are ASCII");
    let rows = text.lines().filter_map(|line| {
        let (package, licence) = line.split_once('|')?;
        let (name, version) = package.split_once(" v")?;
        // Our crates have a path in the source tree after the version.
        (!version.contains('(')).then(|| ((name.to_owned(), version.to_owned()), licence.to_owned()))
    });
    rows.collect()
}

/// The folder to which Cargo has unpacked a crate.
fn unpacked((name, version): &Package) -> PathBuf {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| env::home_dir().map(|home| home.join(".cargo"))).expect("cargo has a home");
    let sources = fs::read_dir(home.join("registry/src")).expect("cargo has unpacked crates");
    let folder = format!("{name}-{version}");
    sources
        .map(|entry| entry.expect("the entry is readable").path().join(&folder))
        .find(|path| path.is_dir())
        .unwrap_or_else(|| panic!("{folder} is not there: `cargo fetch --locked` gets it"))
}

/// Returns whether a file contains a licence, judged by its name.
fn is_licence(name: &str) -> bool {
    const BEGINNINGS: &[&str] = &["licen", "copying", "notice", "unlicense", "copyright", "ofl", "ufl"];
    let name = name.to_lowercase();
    BEGINNINGS.iter().any(|start| name.starts_with(start)) && !name.ends_with(".rs")
}

/// The files with licences in a folder.
fn licences(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.expect("the entry is readable").path());
    let mut files: Vec<_> = paths
        .filter(|path| path.is_file() && is_licence(&path.file_name().unwrap_or_default().to_string_lossy()))
        .collect();
    files.sort();
    files
}

/// The licence texts of a crate; if there is a choice, only MIT's, which is always among them and is the shortest.
fn texts(folder: &Path, licence: &str) -> Vec<String> {
    let mut files = licences(folder);
    files.extend(licences(&folder.join("fonts")));
    let named = |path: &PathBuf, word: &str| {
        path.file_name().is_some_and(|name| name.to_string_lossy().to_uppercase().contains(word))
    };
    let is_choice = licence.contains(" OR ") || licence.contains('/');
    if is_choice && files.iter().any(|path| named(path, "MIT")) {
        let others = ["APACHE", "ZLIB", "UNLICENSE", "BSD", "LGPL", "COPYRIGHT", "0BSD"];
        files.retain(|path| !others.iter().any(|word| named(path, word)));
    }
    let read = |path: &PathBuf| {
        let text = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let text = String::from_utf8_lossy(&text).into_owned();
        let lines: Vec<_> = text.lines().map(str::trim_end).collect();
        lines.join("\n").trim().to_owned()
    };
    files.iter().map(read).filter(|text| !text.is_empty()).collect()
}

/// The contents of the whole file.
fn notices() -> String {
    let mut packages = linked("Cargo.toml", &["cc67", "cc67-capi"]);
    packages.extend(linked("cc67/python/Cargo.toml", &[]));
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    let mut in_order = Vec::new();
    let mut rows = String::new();
    for (package, licence) in &packages {
        let found = texts(&unpacked(package), licence);
        let mut shown = Vec::new();
        for text in found {
            let next = numbers.len() + 1;
            let number = *numbers.entry(text.clone()).or_insert_with(|| {
                in_order.push(text);
                next
            });
            shown.push(number.to_string());
        }
        let shown = if shown.is_empty() { "none in the crate".to_owned() } else { shown.join(", ") };
        let _ = writeln!(rows, "{:<32} {:<12} {licence}; text: {shown}", package.0, package.1);
    }
    let mut text = "THIRD-PARTY NOTICES\n\nThe command cc67, the library cc67board and the Python package cc67 contain the crates below, and the standard library\n\
                    of Rust, which is under MIT or Apache-2.0. The source of each crate is at https://crates.io/crates/NAME/VERSION. The texts\n\
                    of the licences follow, as the crates have them; where a crate offers a choice, cc67 takes MIT if that is one, and\nwhere it has no text, that of another crate with the same licence is meant.\n\n"
        .to_owned();
    text.push_str(&rows);
    for (index, licence) in in_order.iter().enumerate() {
        let _ = write!(text, "\n---- {} ----\n\n{licence}\n", index + 1);
    }
    text
}

#[test]
fn notices_name_every_crate_of_the_executables() {
    let path = root().join("cc67/THIRD-PARTY.txt");
    let now = notices();
    if env::var_os("CC67_WRITE_NOTICES").is_some() {
        fs::write(&path, &now).expect("the file can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    let different = now.lines().zip(written.lines()).find(|(now, written)| now != written);
    assert!(
        now == written,
        "cc67/THIRD-PARTY.txt is out of date, first here: {different:?}; `CC67_WRITE_NOTICES=1 cargo test --test release notices` writes it"
    );
}
