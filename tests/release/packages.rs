//! Packages are complete: each contains the files that its crate reads, and its licence, and a build script that cannot
//! read a file fails.
//!
//! `.ci/packages` packages the crates, builds the command from only the packages, and runs the README's tour with it.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use crate::{files, relative, root};

/// The folders of the workspace's crates.
fn members() -> Vec<String> {
    let text = read("Cargo.toml");
    let (_, list) = text.split_once("\nmembers = [").expect("the workspace has members");
    let list = list.split(']').next().unwrap_or_default();
    list.split(',')
        .map(|name| name.trim().trim_matches('"').to_owned())
        .filter(|name| !name.is_empty())
        .collect()
}

fn read(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The folders of the crates that are published, with their manifests.
fn published() -> Vec<(String, String)> {
    let manifests = members().into_iter().map(|folder| {
        let manifest = read(&format!("{folder}/Cargo.toml"));
        (folder, manifest)
    });
    manifests.filter(|(_, manifest)| !manifest.contains("\npublish = false\n")).collect()
}

#[test]
fn published_crates_have_what_their_pages_show() {
    let crates = published();
    assert!(crates.len() >= 11, "{crates:?}");
    for (folder, manifest) in crates {
        let fields = [
            "description = \"",
            "license.",
            "readme = \"",
            "keywords.",
            "categories.",
            "exclude.",
            "rust-version.",
        ];
        for field in fields {
            assert!(manifest.contains(&format!("\n{field}")), "{folder}/Cargo.toml has no {field}");
        }
        let (_, readme) = manifest.split_once("\nreadme = \"").expect("it has one");
        let page = root().join(&folder).join(readme.split('"').next().unwrap_or_default());
        assert!(page.is_file(), "{} is not there", page.display());
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let own = read(&format!("{folder}/{licence}"));
            // A link, or, if git creates no links, a file that contains its target.
            assert!(own == read(licence) || own.ends_with(licence), "{folder}/{licence} is another text");
        }
    }
}

/// Crates of different releases do not work together, and internal ones have no stable interface.
#[test]
fn our_crates_ask_for_exactly_the_same_release() {
    let text = read("Cargo.toml");
    let rows: Vec<_> =
        text.lines().filter(|line| line.contains("{ path = \"") && line.contains("version = ")).collect();
    assert!(rows.len() >= 12, "{rows:?}");
    for row in rows {
        assert!(row.contains("version = \"="), "{row}");
    }
}

/// The text after a mark, up to a quotation mark.
fn value<'a>(text: &'a str, mark: &str) -> &'a str {
    text.split_once(mark).and_then(|(_, rest)| rest.split('"').next()).unwrap_or_default()
}

#[test]
fn every_manifest_has_the_same_version() {
    let version = value(&read("Cargo.toml"), "[workspace.package]\nversion = \"").to_owned();
    assert!(!version.is_empty());
    assert_eq!(value(&read("cc67/python/Cargo.toml"), "\nversion = \""), version);
    assert_eq!(value(&read("cc67/editors/vscode/package.json"), "\"version\": \""), version);
    for row in read("Cargo.toml").lines().filter(|line| line.contains("{ path = \"")) {
        let wanted = value(row, "version = \"=");
        assert!(wanted.is_empty() || wanted == version, "{row}");
    }
}

/// A separate workspace with other profiles would build every dependency a second time.
#[test]
fn the_python_package_is_built_with_the_same_profiles() {
    let sections = |name: &str| {
        let text = read(name);
        let at = text.find("\n[profile.release]\n").unwrap_or_else(|| panic!("{name} has no profiles"));
        text[at..].lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(sections("cc67/python/Cargo.toml"), sections("Cargo.toml"));
}

/// The statements of a source that access files, each up to its `;` or `{`.
fn file_statements(code: &str) -> impl Iterator<Item = &str> {
    let statements = code.split([';', '{', '}']).map(str::trim);
    statements
        .filter(|text| !text.starts_with("use ") && (text.contains("fs::") || text.contains("read_dir(")))
}

/// Returns the statements of a build script that ignore file errors.
fn swallowed(code: &str) -> Vec<String> {
    let mut found: Vec<_> = file_statements(code)
        .filter(|text| !text.contains('?') || text.contains(".ok()") || text.contains("unwrap_or"))
        .map(str::to_owned)
        .collect();
    // For a folder, entries that cannot be read.
    found.extend(code.contains(".flatten()").then(|| ".flatten()".to_owned()));
    found
}

#[test]
fn build_scripts_report_what_they_cannot_read() {
    assert_eq!(swallowed("for a in fs::read_dir(f)? { }"), [""; 0]);
    assert_eq!(swallowed("for a in fs::read_dir(f).into_iter().flatten() { }").len(), 2);
    assert_eq!(swallowed("let text = fs::read_to_string(path).unwrap_or_default();").len(), 1);
    for folder in members() {
        let script = root().join(&folder).join("build.rs");
        if script.is_file() {
            let found = swallowed(&code(&script));
            assert!(found.is_empty(), "{folder}/build.rs passes over errors: {found:#?}");
        }
    }
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    plain
}

/// The paths named in a source for the compiler: included files, and modules with a path.
fn included(code: &str) -> Vec<&str> {
    const MARKS: &[&str] = &["include_str!(", "include_bytes!(", "include!(", "#[path = "];
    let after = MARKS.iter().flat_map(|mark| code.split(mark).skip(1));
    after
        .filter_map(|rest| {
            rest.trim_start_matches("concat!(").trim_start().strip_prefix('"')?.split('"').next()
        })
        .collect()
}

/// Returns whether a source is only for tests, which stay in the repository and may use all of it.
fn is_test(file: &Path) -> bool {
    if file.ends_with("tests.rs") || file.components().any(|part| part.as_os_str() == "tests") {
        return true;
    }
    let folder = file.parent().unwrap_or(file);
    let parents = [folder.join("mod.rs"), folder.join("lib.rs"), folder.with_extension("rs")];
    let row = format!("mod {};", file.file_stem().unwrap_or_default().to_string_lossy());
    parents.iter().filter_map(|parent| fs::read_to_string(parent).ok()).any(|text| {
        let lines: Vec<_> = text.lines().collect();
        lines.windows(2).any(|pair| pair[0] == "#[cfg(test)]" && pair[1].ends_with(&row))
    })
}

#[test]
fn packages_read_nothing_outside_of_themselves() {
    assert_eq!(included("include_str!(concat!(\"../a/\", $b)) #[path = \"c.rs\"]"), ["../a/", "c.rs"]);
    for (folder, manifest) in published() {
        let package = root().join(&folder);
        for line in manifest.lines().filter(|line| line.starts_with("path = \"")) {
            assert!(!line.contains(".."), "{folder}/Cargo.toml: {line}");
        }
        let sources = files(&package.join("src"), "rs").into_iter().chain([package.join("build.rs")]);
        for file in sources.filter(|file| file.is_file()) {
            let name = relative(&file);
            if is_test(&file) {
                continue;
            }
            let text = code(&file);
            // Tests within a file, and the book's programs as documentation tests.
            let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            let text = text.split("#[cfg(doctest)]").next().unwrap_or_default();
            let here = file.parent().unwrap_or(&package);
            for path in included(text) {
                let target = plain(&here.join(path));
                assert!(target.starts_with(&package), "{name} reads {path}, outside its package");
            }
            let climbs = text
                .split("CARGO_MANIFEST_DIR")
                .skip(1)
                .any(|rest| rest.split(';').next().is_some_and(|rest| rest.contains("\"..")));
            assert!(!climbs, "{name} goes from its package to another folder");
        }
    }
}

/// Source text without line comments, so that comments may mention names that code may not.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("sources are UTF-8");
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// The crates needed to build a package, ours and others.
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
