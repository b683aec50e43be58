//! The invariants of the source tree that neither the compiler nor clippy checks.

mod citations;
mod comments;
mod phrases;

mod arrows;
mod circles;
mod extension;
mod firmware_names;
mod imports;
mod layers;
mod notices;
mod options;
mod packages;
mod passes;
mod promises;
mod remarks;
mod shapes;
mod tokens;
mod wildcards;
mod workflows;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace")
}

/// Every file below `folder` with the extension, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("the folder is readable") {
            let path = entry.expect("the entry is readable").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && name != "target" && !name.starts_with('.') {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).expect("the path lies in the workspace").to_string_lossy().replace('\\', "/")
}

/// Source text without line comments, so that prose may mention what code may not.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("sources are UTF-8");
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// Whether the code uses `name::` as a path root.
fn names_crate(code: &str, name: &str) -> bool {
    let path = format!("{name}::");
    code.match_indices(&path).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':')
    })
}

#[test]
fn crates_depend_only_in_the_allowed_directions() {
    let forbidden: &[(&str, &[&str], &[&str])] = &[
        ("kmotiondef/src", &["coff", "vm", "runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("coff/src", &["kmotiondef", "vm", "runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("vm/src", &["coff", "runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("vm/c67x/src", &["kmotiondef", "coff", "vm", "runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("runtime/src", &["compiler", "cc67_host", "cc67"], &[]),
        (
            "runtime/src",
            &["coff"],
            &["runtime/src/board/loader.rs", "runtime/src/board/recorded_programs.rs"],
        ),
        (
            "runtime/chips/src",
            &["coff", "c67x", "vm", "runtime", "boot", "compiler", "cc67_host", "cc67"],
            &[],
        ),
        ("runtime/boot/src", &["runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("cc67/compiler/src", &["runtime", "cc67_host", "cc67"], &[]),
        ("cc67/wire/src", &["coff", "vm", "runtime", "compiler", "cc67_host", "cc67"], &[]),
        ("cc67/host/src", &["cc67", "cc67_live", "cc67_controller", "cc67_wire"], &[]),
        ("cc67/controller/src", &["cc67", "cc67_live", "cc67_debug"], &[]),
        ("cc67/live/src", &["cc67"], &[]),
        ("cc67/debug/src", &["cc67"], &[]),
        (
            "cc67/capi/src",
            &["kmotiondef", "coff", "vm", "runtime", "compiler", "cc67_live", "cc67_debug", "cc67"],
            &[],
        ),
    ];
    let mut broken = Vec::new();
    for (folder, names, except) in forbidden {
        for file in files(&root().join(folder), "rs") {
            let path = relative(&file);
            if except.iter().any(|allowed| path.starts_with(allowed)) {
                continue;
            }
            let code = code(&file);
            broken
                .extend(names.iter().filter(|n| names_crate(&code, n)).map(|n| format!("{path} names {n}")));
        }
    }
    assert!(broken.is_empty(), "forbidden arrows:\n{}", broken.join("\n"));
}

/// The crates in the order of `architecture.md`, by folder.
fn crates_in_order() -> Vec<String> {
    let page = root().join("cc67/book/src/architecture.md");
    let page = fs::read_to_string(page).expect("the page exists");
    let rows =
        page.lines().filter_map(|line| line.strip_prefix("| `")?.split("` | `").nth(1)?.split_once("/` |"));
    rows.map(|(folder, _)| folder.to_owned()).collect()
}

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
            let below = order.iter().position(|other| *other == folder);
            assert!(
                below.is_some_and(|below| below < place),
                "{member} depends on {folder}, which is not above it"
            );
        }
    }
}

/// What a crate needs to be built, of ours and of others.
fn needed_by(package: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}"])
        .args(["--package", package])
        .current_dir(root())
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("names of crates are ASCII");
    let mut names: Vec<_> =
        text.lines().filter_map(|line| line.split(' ').next().map(str::to_owned)).collect();
    names.sort();
    names.dedup();
    names
}

#[test]
fn embedding_a_board_builds_no_terminal_picture_web_or_cli_crate() {
    const OF_THE_COMMAND: &[&str] = &[
        "ab_glyph",
        "anstream",
        "anstyle",
        "axum",
        "cc67",
        "clap",
        "clap_builder",
        "clap_complete",
        "clap_mangen",
        "console",
        "crossterm",
        "env_logger",
        "epaint_default_fonts",
        "hyper",
        "image",
        "indicatif",
        "inferno",
        "plotters",
        "png",
        "ratatui",
        "rustyline",
        "similar",
        "termcolor",
        "tiny_http",
        "tokio",
        "tungstenite",
    ];
    let needed = needed_by("cc67-host");
    assert!(needed.iter().any(|name| name == "cc67-runtime"), "{needed:?}");
    let found: Vec<_> = needed.iter().filter(|name| OF_THE_COMMAND.contains(&name.as_str())).collect();
    assert!(found.is_empty(), "cc67-host needs {found:?}");
}

#[test]
fn every_source_file_starts_with_a_module_doc() {
    let silent: Vec<_> = files(root(), "rs")
        .into_iter()
        .filter(|file| !fs::read_to_string(file).expect("sources are UTF-8").starts_with("//!"))
        .map(|file| relative(&file))
        .collect();
    assert!(silent.is_empty(), "files without a module doc:\n{}", silent.join("\n"));
}

#[test]
fn unsafe_code_exists_only_in_the_native_engine_and_the_c_interface() {
    for file in files(root(), "rs") {
        let path = relative(&file);
        // Compiled code is unsafe to run, and what a C program hands over is unsafe to look at.
        if ["vm/src/native/", "cc67/capi/src/"].iter().any(|folder| path.starts_with(folder))
            || path == "tests/tidy/main.rs"
        {
            continue;
        }
        let found =
            code(&file).split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "unsafe");
        assert!(!found, "{path} uses unsafe code");
    }
    let safe = [
        "kmotiondef",
        "coff",
        "vm/c67x",
        "runtime",
        "runtime/boot",
        "runtime/chips",
        "cc67/compiler",
        "cc67/controller",
        "cc67/debug",
        "cc67/host",
        "cc67/live",
        "cc67/wire",
        "cc67",
    ]
    .map(|name| format!("{name}/src/lib.rs"));
    for library in safe {
        let text = fs::read_to_string(root().join(&library)).expect("the library exists");
        assert!(text.contains("#![forbid(unsafe_code)]"), "{library} does not forbid unsafe code");
    }
}

#[test]
fn every_library_states_its_invariants() {
    for library in [
        "kmotiondef",
        "coff",
        "vm",
        "vm/c67x",
        "runtime",
        "runtime/boot",
        "runtime/chips",
        "cc67",
        "cc67/compiler",
        "cc67/controller",
        "cc67/debug",
        "cc67/host",
        "cc67/live",
        "cc67/wire",
        "cc67/capi",
    ] {
        let path = root().join(library).join("src/lib.rs");
        let text = fs::read_to_string(path).expect("the library exists");
        assert!(text.contains("//! Invariant"), "{library}/src/lib.rs states no invariant");
    }
}

#[test]
fn no_test_is_disabled_and_no_code_is_unfinished() {
    for file in files(root(), "rs") {
        if relative(&file) == "tests/tidy/main.rs" {
            continue;
        }
        let code = code(&file);
        for word in ["#[ignore", "#[should_panic", "todo!(", "unimplemented!(", "#[allow("] {
            assert!(!code.contains(word), "{} contains {word}", relative(&file));
        }
    }
}

#[test]
fn no_file_is_too_long() {
    // Tables are long by nature; a program's text is not.
    const TABLES: &[&str] = &["kmotiondef/src/firmware.rs", "vm/src/op.rs"];
    let long: Vec<_> = files(root(), "rs")
        .into_iter()
        .filter(|file| !TABLES.contains(&relative(file).as_str()))
        .map(|file| (fs::read_to_string(&file).expect("sources are UTF-8").lines().count(), relative(&file)))
        .filter(|(lines, _)| *lines > 800)
        .collect();
    assert!(long.is_empty(), "files over 800 lines: {long:?}");
}

#[test]
fn the_top_level_has_only_the_expected_names() {
    let mut names: Vec<_> = fs::read_dir(root())
        .expect("the workspace is readable")
        .map(|entry| entry.expect("the entry is readable").file_name().to_string_lossy().into_owned())
        .filter(|name| !name.starts_with('.') && name != "target")
        .collect();
    names.sort();
    let expected = [
        "Cargo.lock",
        "Cargo.toml",
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "README.md",
        "c-programs",
        "cc67",
        "coff",
        "kmotiondef",
        "runtime",
        "tests",
        "vm",
    ];
    assert_eq!(names, expected);
}

#[test]
fn the_index_of_programs_has_every_program_and_no_dead_entry() {
    let folder = root().join("c-programs");
    let index = fs::read_to_string(folder.join("README.md")).expect("the index exists");
    for file in files(&folder, "c") {
        let path = relative(&file);
        let entry = path.strip_prefix("c-programs/").expect("it lies there");
        // Parts of other programs are shown with those.
        if !fs::read_to_string(&file).expect("programs are UTF-8").starts_with("// cc67: run") {
            continue;
        }
        assert!(index.contains(&format!("({entry})")), "c-programs/README.md does not link {entry}");
    }
    for (at, _) in index.match_indices("](") {
        let target = index[at + 2..].split(')').next().expect("split yields at least one piece");
        assert!(target.contains("://") || folder.join(target).exists(), "dead entry {target}");
    }
}
