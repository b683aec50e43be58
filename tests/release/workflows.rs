//! Workflows are valid: runner labels that exist, no assumption of root, pinned actions.
//!
//! `.ci/workflows` also checks them with actionlint and zizmor; the rules here need neither.

use std::fs;

use crate::{files, relative, root};

/// The labels of the public runners on 21 August 2026, without the paid ones: `README.md` of `actions/runner-images`.
const LABELS: &[&str] = &[
    "ubuntu-26.04",
    "ubuntu-26.04-arm",
    "ubuntu-latest",
    "ubuntu-24.04",
    "ubuntu-24.04-arm",
    "ubuntu-22.04",
    "ubuntu-22.04-arm",
    "ubuntu-slim",
    "xcode-27",
    "macos-26-intel",
    "macos-latest",
    "macos-26",
    "macos-15-intel",
    "macos-15",
    "macos-14",
    "windows-latest",
    "windows-2025",
    "windows-2025-vs2026",
    "windows-2022",
    "windows-11-arm",
    "windows-11-vs2026-arm",
];

/// The workflows of the repository, and those written by `cc67 init`, with their texts.
fn workflows() -> Vec<(String, String)> {
    let folders = [".github/workflows", "cc67/src/cli/commands/init/project/.github/workflows"];
    let paths: Vec<_> = folders.iter().flat_map(|folder| files(&root().join(folder), "yml")).collect();
    assert!(paths.len() >= 3, "{paths:?}");
    paths
        .into_iter()
        .map(|path| (relative(&path), fs::read_to_string(&path).expect("workflows are UTF-8")))
        .collect()
}

/// The runner labels in a line: in `runs-on: LABEL`, in `os: [A, B]`, and in `{ os: A, … }`.
fn labels(line: &str) -> Vec<&str> {
    let value = |mark: &str| line.split_once(mark).map(|(_, rest)| rest.trim());
    let Some(value) = value("runs-on: ").or_else(|| value("os: ")) else { return Vec::new() };
    if value.starts_with("${{") {
        return Vec::new();
    }
    let list = value.strip_prefix('[').and_then(|list| list.split(']').next());
    let list = list.unwrap_or_else(|| value.split(',').next().unwrap_or(value));
    list.split(',').map(str::trim).collect()
}

#[test]
fn jobs_run_on_labels_that_exist() {
    assert_eq!(labels("    runs-on: macos-13"), ["macos-13"]);
    assert_eq!(labels("        os: [a, b]"), ["a", "b"]);
    assert_eq!(labels("          - { os: a, target: b }"), ["a"]);
    for (path, text) in workflows() {
        let used: Vec<_> = text.lines().flat_map(labels).collect();
        assert!(!used.is_empty(), "{path} has no job");
        for label in used {
            assert!(LABELS.contains(&label), "{path}: no public runner has the label {label}");
        }
    }
}

#[test]
fn actions_are_pinned_to_a_commit_and_name_its_version() {
    for (path, text) in workflows() {
        for line in
            text.lines().filter(|line| line.trim_start().trim_start_matches("- ").starts_with("uses:"))
        {
            let (_, pin) = line.split_once('@').unwrap_or_default();
            let (commit, version) = pin.split_once(" # v").unwrap_or_default();
            let is_commit = commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit());
            assert!(is_commit && !version.is_empty(), "{path}: {}", line.trim());
        }
    }
}

#[test]
fn every_workflow_limits_its_permissions() {
    for (path, text) in workflows() {
        assert!(text.contains("\npermissions:\n  contents: read\n"), "{path}: no permissions for all jobs");
    }
}

/// Runners are ordinary users: only `.ci/system`, which uses sudo, may install packages.
#[test]
fn nothing_assumes_to_be_root() {
    let scripts = fs::read_dir(root().join(".ci")).expect("the folder is readable");
    let scripts =
        scripts.map(|entry| entry.expect("the entry is readable").path()).filter(|path| path.is_file());
    let scripts =
        scripts.map(|path| (relative(&path), fs::read_to_string(&path).expect("scripts are UTF-8")));
    for (path, text) in workflows().into_iter().chain(scripts) {
        if path == ".ci/system" || path == ".ci/Containerfile" {
            continue;
        }
        for line in text.lines().filter(|line| line.contains("apt-get")) {
            assert!(line.contains("sudo apt-get"), "{path} installs packages as root: {}", line.trim());
        }
    }
}

/// Package managers get manifests for exactly the archives that are built.
#[test]
fn manifests_and_the_workflow_name_the_same_archives() {
    let workflow = fs::read_to_string(root().join(".github/workflows/release.yml")).expect("it is there");
    let (_, archives) = workflow.split_once("\n  archives:\n").expect("it makes archives");
    let built = archives
        .lines()
        .take_while(|line| !line.contains("runs-on:"))
        .filter_map(|line| Some(line.split_once("target: ")?.1.trim_end_matches(" }").to_owned()));
    let manifests = fs::read_to_string(root().join(".ci/manifests.py")).expect("it is there");
    let (_, list) = manifests.split_once("\nTARGETS = [\n").expect("it has a list");
    let named = list
        .lines()
        .take_while(|line| *line != "]")
        .filter_map(|line| Some(line.split('"').nth(1)?.to_owned()));
    let built: Vec<_> = built.collect();
    assert!(built.len() >= 6, "{built:?}");
    assert_eq!(built, named.collect::<Vec<_>>());
}

/// A release is made by these jobs, in this order.
#[test]
fn every_job_of_a_release_follows_the_check_of_its_version() {
    let text = fs::read_to_string(root().join(".github/workflows/release.yml")).expect("it is there");
    let (_, jobs) = text.split_once("\njobs:\n").expect("it has jobs");
    let names: Vec<_> = jobs
        .lines()
        .filter_map(|line| line.strip_prefix("  ")?.strip_suffix(':'))
        .filter(|name| name.chars().all(|c| c.is_ascii_lowercase() || c == '-'))
        .collect();
    assert_eq!(names.first(), Some(&"version"), "{names:?}");
    assert_eq!(names.last(), Some(&"release"), "{names:?}");
    for job in &names[1..] {
        let (_, body) = jobs.split_once(&format!("  {job}:\n")).expect("it is one of them");
        let needs = body.lines().next().unwrap_or_default();
        assert!(needs.trim_start().starts_with("needs: "), "the job {job} begins with {needs}");
    }
}
