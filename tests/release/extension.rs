//! The extension for VS Code: its snippets, settings and files match the book's description.

use std::fs;

use crate::root;

fn read(name: &str) -> String {
    fs::read_to_string(root().join("cc67/editors/vscode").join(name))
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The values of a key, in the order of the file.
fn values<'a>(json: &'a str, key: &str) -> Vec<&'a str> {
    let mark = format!("\"{key}\": \"");
    json.split(mark.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn snippets_are_programs_for_the_board() {
    let text = read("snippets.json");
    let prefixes = values(&text, "prefix");
    assert!(prefixes.len() >= 5 && prefixes.iter().all(|prefix| prefix.starts_with("kflop")), "{prefixes:?}");
    assert_eq!(values(&text, "description").len(), prefixes.len());
    // Each call is a call of a firmware function.
    let header =
        fs::read_to_string(root().join("kmotiondef/include/KMotionDef.h")).expect("the header is there");
    let calls = text.split('(').filter_map(|before| {
        let name = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
        name.starts_with(|c: char| c.is_ascii_uppercase()).then_some(name)
    });
    let calls: Vec<_> = calls.collect();
    assert!(calls.len() >= 10, "{calls:?}");
    for call in calls {
        assert!(header.contains(&format!("{call}(")), "KMotionDef.h has no {call}");
    }
}

#[test]
fn the_manifest_names_files_that_are_packed() {
    let manifest = read("package.json");
    let (_, files) = manifest.split_once("\"files\": [").expect("it lists its files");
    let files = files.split(']').next().unwrap_or_default();
    for name in ["extension.js", "snippets.json", "README.md", "LICENSE.txt"] {
        assert!(files.contains(&format!("\"{name}\"")), "{name} is not packed");
        // The licence is added when the extension is packaged.
        assert!(name == "LICENSE.txt" || !read(name).is_empty());
    }
    assert_eq!(values(&manifest, "main"), ["./extension.js"]);
}
