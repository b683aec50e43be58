//! The invariants of the source tree that neither the compiler nor clippy checks.

mod arrows;
mod citations;
mod comments;
mod imports;
mod tables;

use std::fs;
use std::path::PathBuf;

use harness::{files, relative, root};

/// Every source file: its path relative to the root of the workspace, and its text.
fn sources() -> impl Iterator<Item = (String, String)> {
    let read = |path: PathBuf| (relative(&path), fs::read_to_string(&path).expect("sources are UTF-8"));
    files(root(), "rs").into_iter().map(read)
}

/// The folders of the crates in the order of `architecture.md`.
fn crates_in_order() -> Vec<String> {
    let page = root().join("cc67/book/src/architecture.md");
    let page = fs::read_to_string(page).expect("the page exists");
    let rows =
        page.lines().filter_map(|line| line.strip_prefix("| `")?.split("` | `").nth(1)?.split_once("/` |"));
    rows.map(|(folder, _)| folder.to_owned()).collect()
}

/// Crates that a crate does not use although they are above it in the table.
const INDEPENDENT: &[(&str, &[&str])] = &[
    ("coff", &["kmotiondef"]),
    ("vm/c67x", &["kmotiondef", "coff"]),
    ("vm", &["coff"]),
    ("runtime/chips", &["coff", "vm/c67x", "vm"]),
    ("cc67/compiler", &["runtime", "runtime/chips", "runtime/boot"]),
    ("cc67/wire", &["coff", "vm", "runtime", "cc67/compiler"]),
    ("cc67/capi", &["kmotiondef", "coff", "vm", "runtime", "cc67/compiler", "cc67/live", "cc67/debug"]),
];

#[test]
fn crates_depend_only_on_crates_above_them_in_the_table_of_the_book() {
    let order = crates_in_order();
    let manifest = |folder: &str| {
        fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("each crate has a manifest")
    };
    let workspace = manifest("");
    let folder_of = |key: &str| {
        let prefix = format!("{key} = {{ path = \"");
        let line = workspace.lines().find_map(|line| line.strip_prefix(&prefix))?;
        line.split('"').next().map(str::to_owned)
    };
    let members =
        workspace.lines().find(|line| line.starts_with("members = ")).expect("a workspace has members");
    for member in members.split('"').skip(1).step_by(2) {
        let place = order.iter().position(|folder| folder == member);
        let place = place.unwrap_or_else(|| panic!("the table of architecture.md lacks {member}"));
        let text = manifest(member);
        let dependencies =
            text.split("\n[").find(|part| part.starts_with("dependencies]")).unwrap_or_default();
        for key in dependencies.lines().filter_map(|line| line.split(['.', ' ', '=']).next()) {
            let Some(folder) = folder_of(key) else { continue };
            let is_above = order[..place].contains(&folder);
            assert!(is_above, "{member} depends on {folder}, which is not above it");
            let independent =
                INDEPENDENT.iter().find(|(name, _)| *name == member).map_or(&[][..], |(_, all)| all);
            assert!(!independent.contains(&folder.as_str()), "{member} depends on {folder}");
        }
    }
}

#[test]
fn only_what_loads_images_reads_them_in_the_runtime() {
    let loaders = ["runtime/src/board/loader.rs", "runtime/src/board/recorded_programs.rs"];
    for (path, text) in sources().filter(|(path, _)| path.starts_with("runtime/src/")) {
        let code = text.lines().any(|line| line.contains("coff::") && !line.trim_start().starts_with("//"));
        assert!(!code || loaders.contains(&path.as_str()), "{path} uses coff");
    }
}

#[test]
fn every_source_file_starts_with_a_module_doc() {
    let silent: Vec<_> =
        sources().filter(|(_, text)| !text.starts_with("//!")).map(|(path, _)| path).collect();
    assert!(silent.is_empty(), "files without a module doc:\n{}", silent.join("\n"));
}

#[test]
fn unsafe_code_exists_only_in_the_native_engine_the_c_interface_and_a_driver() {
    // The workspace denies it. Executing compiled code is unsafe, and so are accesses to a C program's pointers and
    // calls of a library loaded at run time.
    let driver = "cc67/wire/src/transport/d2xx.rs";
    let folders = ["vm/src/native/", "cc67/capi/src/", driver, "tests/tidy/main.rs"];
    for (path, text) in sources().filter(|(path, _)| !folders.iter().any(|folder| path.starts_with(folder))) {
        let words = ["expect(unsafe_code", "allow(unsafe_code", "warn(unsafe_code"];
        assert!(!words.iter().any(|word| text.contains(word)), "{path} uses unsafe code");
    }
}

#[test]
fn every_library_states_its_invariants() {
    for library in crates_in_order().into_iter().filter(|folder| folder != "cc67/python" && folder != "tests")
    {
        let path = root().join(&library).join("src/lib.rs");
        let text = fs::read_to_string(path).expect("the library exists");
        assert!(text.contains("//! Invariant"), "{library}/src/lib.rs states no invariant");
        let may = ["vm", "cc67/capi", "cc67/wire"].contains(&library.as_str());
        assert!(may || text.contains("#![forbid(unsafe_code)]"), "{library} does not forbid unsafe code");
    }
}

#[test]
fn no_test_is_disabled() {
    for (path, text) in sources().filter(|(path, _)| path != "tests/tidy/main.rs") {
        for word in ["#[ignore", "#[should_panic"] {
            let found = text.lines().any(|line| line.trim_start().starts_with(word));
            assert!(!found, "{path} contains {word}");
        }
    }
}

#[test]
fn no_file_is_too_long() {
    // Tables are long by nature; a program's text is not.
    const TABLES: &[&str] = &["kmotiondef/src/firmware.rs", "vm/src/op.rs"];
    for (path, text) in sources().filter(|(path, _)| !TABLES.contains(&path.as_str())) {
        assert!(text.lines().count() <= 800, "{path} has more than 800 lines");
    }
}

#[test]
fn the_top_level_has_only_the_expected_names() {
    let mut names: Vec<_> = fs::read_dir(root())
        .expect("the workspace is readable")
        .map(|entry| entry.expect("the entry is readable").file_name().to_string_lossy().into_owned())
        .filter(|name| !name.starts_with('.') && name != "target")
        .collect();
    names.sort();
    let files = ["Cargo.lock", "Cargo.toml", "LICENSE-APACHE", "LICENSE-MIT", "README.md"];
    let folders = ["c-programs", "cc67", "coff", "kmotiondef", "runtime", "tests", "vm"];
    assert_eq!(names, [&files[..], &folders[..]].concat());
}
