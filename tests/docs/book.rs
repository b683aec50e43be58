//! The book: its programs behave as described, its links are valid, its lists match the tables.
//!
//! Chapters that are lists are generated from the tables; `CC67_WRITE_BOOK=1 cargo test --test docs` rewrites them.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use cc67::limits::{ALL, with_separators};
use compiler::diag::Lint;
use harness::{Scratch, cc67, files};
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS};
use kmotiondef::variables::FIRMWARE_VARIABLES;
use runtime::commands::COMMANDS;
use runtime::{REMARKS, Severity};

use crate::messages::{is_of, messages, sources};

fn source() -> PathBuf {
    harness::root().join("cc67/book/src")
}

fn read(name: &str) -> String {
    fs::read_to_string(source().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The fenced blocks of a chapter: the text after the fence, and the contents.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, String)> = None;
    for line in text.lines() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(info), None) => open = Some((info.to_owned(), String::new())),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (None, Some((_, text))) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

#[test]
fn programs_do_what_the_book_says() {
    let scratch = Scratch::new("book");
    let path = scratch.path().join("program.c");
    let mut count = 0;
    for chapter in files(&source(), "md") {
        let name = chapter.file_name().expect("a name").to_string_lossy().into_owned();
        let all = blocks(&fs::read_to_string(&chapter).expect("chapters are UTF-8"));
        for (index, (info, text)) in all.iter().enumerate() {
            if info != "c" && info != "c run" {
                continue;
            }
            fs::write(&path, text).expect("files can be written");
            count += 1;
            let check = cc67(&scratch, ["check", "program.c"]);
            assert_eq!(check.code, 0, "{name}: {text}\n{}", check.stderr);
            if info == "c run" {
                let output = cc67(&scratch, ["run", "program.c"]);
                let (kind, expect) = &all[index + 1];
                assert_eq!(
                    (kind.as_str(), output.stdout.as_str()),
                    ("text", expect.as_str()),
                    "{name}: {text}"
                );
            }
        }
    }
    assert!(count >= 3, "only {count} programs");
}

/// Returns whether a build without the default features lacks a command.
fn is_left_out(command: &str) -> bool {
    command == "live" && !cfg!(feature = "live")
}

/// The command lines of `cc67` in a text: the words of each, without the parts interpreted by the shell.
fn command_lines(text: &str) -> Vec<Vec<&str>> {
    const BEGINNINGS: [&str; 3] = ["cc67 ", "target/release/cc67 ", "cargo run --release -- "];
    let lines = text.lines().filter_map(|line| BEGINNINGS.iter().find_map(|start| line.strip_prefix(start)));
    lines.map(|line| line.split('#').next().unwrap_or_default().split_whitespace().collect()).collect()
}

#[test]
fn commands_and_options_in_the_book_exist() {
    let mut count = 0;
    let pages = files(&source(), "md").into_iter().chain([harness::root().join("README.md")]);
    for page in pages {
        let text = fs::read_to_string(&page).expect("pages are UTF-8");
        let shell = blocks(&text).into_iter().filter(|(info, _)| info.starts_with("sh"));
        let lines: Vec<_> = shell.map(|(_, text)| text).collect();
        for words in lines.iter().flat_map(|text| command_lines(text)) {
            let (command, options) = words.split_first().expect("a command");
            if command.starts_with('-') {
                continue;
            }
            let help = cc67(harness::root(), [command, "--help"]);
            if help.code != 0 && is_left_out(command) {
                continue;
            }
            assert_eq!(help.code, 0, "{}: cc67 {words:?}", page.display());
            // Options after `--` belong to another command.
            let own = options.iter().take_while(|word| **word != "--");
            for option in own.filter(|word| word.starts_with("--")) {
                let name = option.split('=').next().unwrap_or_default();
                let is_known =
                    help.stdout.split(|c: char| !(c.is_alphanumeric() || c == '-')).any(|word| word == name);
                assert!(is_known, "{}: cc67 {command} has no {name}", page.display());
            }
            count += 1;
        }
    }
    assert!(count >= 15, "only {count} commands");
}

/// Returns the text after each `mark` up to `end`.
fn behind<'a>(text: &'a str, mark: &str, end: char) -> Vec<&'a str> {
    text.split(mark).skip(1).filter_map(|rest| rest.split(end).next()).collect()
}

/// A text without its fenced blocks.
fn prose(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut prose = String::new();
    let mut is_code = false;
    for line in text.lines() {
        is_code ^= line.starts_with("```");
        if !is_code {
            prose.push_str(line);
        }
        prose.push('\n');
    }
    prose
}

/// The anchors that links to a page can use: its headings, as the book and code hosts convert them.
fn anchors(prose: &str) -> BTreeSet<String> {
    let headings = prose.lines().filter(|line| line.starts_with('#'));
    let spell = |line: &str| {
        let text = line.trim_start_matches('#').trim().to_lowercase();
        let kept = text.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(spell).collect()
}

/// Checks that every link of a page leads to a file, and to a heading in it.
fn check_links(page: &Path) {
    let text = prose(page);
    for link in behind(&text, "](", ')').into_iter().filter(|link| !link.contains("://")) {
        let (file, place) = link.split_once('#').unwrap_or((link, ""));
        let target = if file.is_empty() { page.to_owned() } else { page.with_file_name(file) };
        assert!(target.exists(), "{} links to {link}, which is not there", page.display());
        assert!(
            place.is_empty() || anchors(&prose(&target)).contains(place),
            "{} links to {link}: no such heading",
            page.display()
        );
    }
}

#[test]
fn links_lead_to_files_and_headings() {
    for chapter in files(&source(), "md") {
        check_links(&chapter);
    }
    for page in ["README.md", "c-programs/README.md", "vm/benches/README.md"] {
        check_links(&harness::root().join(page));
    }
}

#[test]
fn every_chapter_is_in_the_summary() {
    let summary = read("SUMMARY.md");
    let listed: BTreeSet<_> = behind(&summary, "](", ')').into_iter().collect();
    for chapter in files(&source(), "md") {
        let path = chapter.strip_prefix(source()).expect("chapters are in the book");
        let name = path.to_string_lossy().replace('\\', "/");
        assert!(name == "SUMMARY.md" || listed.contains(name.as_str()), "{name} is not in the summary");
    }
}

#[test]
fn heading_anchors_match_the_form_of_links() {
    let anchors = anchors("# A `b` (c), d_e\ntext\n## F-g");
    assert_eq!(anchors.into_iter().collect::<Vec<_>>(), ["a-b-c-d_e", "f-g"]);
}

/// Checks that a chapter matches the tables.
pub(crate) fn check_list(name: &str, text: &str) {
    if std::env::var_os("CC67_WRITE_BOOK").is_some() {
        fs::write(source().join(name), text).expect("the book can be written");
    }
    assert!(
        read(name) == text,
        "{name} is out of date: `CC67_WRITE_BOOK=1 cargo test --test docs` writes it"
    );
}

/// A page of the command or of the compiler.
fn page(name: &str) -> String {
    fs::read_to_string(harness::root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn the_chapters_of_machine_file_and_stimulus_are_the_pages_of_the_command() {
    for name in ["machine.md", "stimulus.md"] {
        check_list(name, &page(&format!("cc67/src/cli/commands/pages/{name}")));
    }
}

/// Readers of the book in the repository see its sources: nothing may be included only during the build.
#[test]
fn every_chapter_is_whole_in_the_repository() {
    for chapter in files(&source(), "md") {
        let text = fs::read_to_string(&chapter).expect("chapters are UTF-8");
        assert!(!text.lines().any(|line| line.starts_with("{{#")), "{} includes a file", chapter.display());
    }
}

#[test]
fn the_chapter_of_warnings_has_every_page() {
    let mut text = "# Warnings\n\nMessages name the warning in brackets; `-Wno-NAME` switches it off, `-Werror=NAME` makes it an \
                    error,\nand `cc67 --explain NAME` shows its page. `-Wall` and `-Wextra` switch on more.\n"
        .to_owned();
    let mut lints: Vec<_> = Lint::ALL.iter().collect();
    lints.sort_by_key(|lint| lint.name());
    for lint in lints {
        text.push('\n');
        text.push_str(&page(&format!("cc67/compiler/src/lints/pages/{}.md", lint.name())));
    }
    check_list("warnings.md", &text);
}

#[test]
fn the_chapter_of_remarks_lists_every_remark() {
    let mut text = "# Remarks\n\nThe simulated board makes remarks on likely mistakes; a real board is silent. A remark on a call begins with \
                    thread,\nfile, line and column of the call. `-R no-CODE` switches a remark off for one run; `CODE = false` under \
                    `[remarks]` in the\nmachine file switches it off permanently. `cc67 --explain CODE` shows its page. Only `--verbose` \
                    shows remarks marked *detail*.\n"
        .to_owned();
    let mut rows: Vec<_> = REMARKS.iter().collect();
    rows.sort_by_key(|row| row.code);
    for row in rows {
        let detail = if row.severity == Severity::Detail { " *(detail)*" } else { "" };
        let _ =
            write!(text, "\n## {}\n\n{}{detail}\n\n```text\n{}\n```\n", row.code, row.about.trim(), row.text);
    }
    check_list("remarks.md", &text);
}

/// The parts of the compiler in the order of a compilation: folder, heading.
const PARTS: &[(&str, &str)] = &[
    ("driver", "Reading files"),
    ("pp", "Preprocessing"),
    ("parse", "Syntax"),
    ("sema", "Types and names"),
    ("lints", "Warnings that look at the whole program"),
    ("sharing", "Memory that threads and call-backs share"),
    ("bytecode", "Code"),
    ("c67x", "Code for the board's processor"),
    ("link", "Linking"),
];

#[test]
fn the_chapter_of_messages_lists_every_message() {
    let (found, unknown) = messages(&sources(&harness::root().join("cc67/compiler/src")));
    assert!(unknown.is_empty(), "the text of these diagnostics was not found: {unknown:#?}");
    assert!(found.len() >= 250, "only {} messages", found.len());
    let parts: BTreeSet<_> = PARTS.iter().map(|(part, _)| *part).collect();
    let other: Vec<_> = found.iter().filter(|message| !parts.contains(message.part.as_str())).collect();
    assert!(other.is_empty(), "add a part: {other:?}");
    let mut text = "# Messages of the compiler\n\nEach message is listed once; braces mark the parts that are filled in. A message may name a warning in \
                    brackets, which\n[warnings](warnings.md) explains. [Remarks](remarks.md) lists the messages of the board during a \
                    run.\n"
        .to_owned();
    for (part, title) in PARTS {
        let _ = write!(text, "\n## {title}\n");
        for kind in ["error", "warning", "note"] {
            let rows: Vec<_> =
                found.iter().filter(|message| message.part == *part && message.kind == kind).collect();
            if !rows.is_empty() {
                let _ = write!(text, "\n{kind}s:\n\n```text\n");
                rows.iter().for_each(|message| text.push_str(&format!("{}\n", message.text)));
                text.push_str("```\n");
            }
        }
    }
    check_list("messages.md", &text);
}

#[test]
fn messages_of_the_filetests_are_in_the_chapter() {
    let (found, _) = messages(&sources(&harness::root().join("cc67/compiler/src")));
    let mut count = 0;
    for file in files(&harness::root().join("tests/filetests/diagnostics"), "snap") {
        let text = fs::read_to_string(&file).expect("snapshots are UTF-8");
        for line in text.lines() {
            let Some((head, shown)) = line.split_once(": ") else { continue };
            let kind = head.split('[').next().unwrap_or_default();
            if !["error", "warning"].contains(&kind) || shown.starts_with("cc67") {
                continue;
            }
            count += 1;
            // In an error of the linker, the file comes first.
            let without_file = shown.split_once(".c: ").map_or(shown, |(_, text)| text);
            let is_there = found.iter().any(|message| is_of(without_file, &message.text));
            assert!(is_there, "{}: no message of the chapter is `{shown}`", file.display());
        }
    }
    assert!(count >= 50, "only {count} messages");
}

#[test]
fn the_chapter_of_limits_lists_every_limit() {
    let mut text = "# Limits\n\nEvery limit is a number, and every message about a limit names it; `cc67 --explain limits` lists them all.\nCompiling \
                    takes at most a gigabyte of memory, whatever the source. A run takes at most half a gigabyte, whatever its\nlength, \
                    output, traces and pictures; an ordinary run takes less than 20 megabytes, with or without traces.\n"
        .to_owned();
    for (title, limits) in ALL {
        let _ = write!(text, "\n## {title}\n\n| at most | of | beyond |\n|--:|---|---|\n");
        for limit in limits {
            let _ =
                writeln!(text, "| {} | {} | {} |", with_separators(limit.number), limit.what, limit.beyond);
        }
    }
    text.push_str("\nNames, string constants and lines are as long as their file allows.\n");
    text.push_str("Loops that wait are passed over within limits that [Threads and time](threads.md#loops-that-wait) states.\n");
    check_list("limits.md", &text);
}

#[test]
fn the_chapter_of_functions_lists_every_function() {
    let mut text =
        "# Firmware functions\n\nEach call takes the processor time in parentheses; waiting takes additional time.\n".to_owned();
    let shown = || FIRMWARE_FUNCTIONS.iter().filter(|function| !ABSENT.contains(&function.name));
    let groups: BTreeSet<_> = shown().map(|function| function.group).collect();
    for group in groups {
        let _ = write!(text, "\n## {group}\n\n");
        for function in shown().filter(|function| function.group == group) {
            let cost = function.cost.get() as f64 / 200.0;
            let (prototype, doc) = (function.prototype(), function.doc.trim().replace('\n', " "));
            let _ = writeln!(text, "- `{prototype}` ({cost} µs)\n  {doc}");
        }
    }
    check_list("functions.md", &text);
}

#[test]
fn the_chapter_of_variables_lists_every_variable() {
    let mut text = "# Firmware variables\n\n| address | variable | meaning |\n|---|---|---|\n".to_owned();
    for variable in FIRMWARE_VARIABLES {
        let (declaration, doc) = (variable.ty.declare(variable.name), variable.doc.trim().replace('\n', " "));
        let _ = writeln!(
            text,
            "| `{:08x}` | `{declaration}` | {} |",
            variable.address.get(),
            doc.replace('|', "\\|")
        );
    }
    check_list("variables.md", &text);
}

#[test]
fn the_chapter_of_console_commands_lists_every_command() {
    let mut text = "# Console commands\n\nThese are the script commands that `cc67 console` sends to the board, and `command \"...\"` in a stimulus. \
                    Case does not\nmatter, and a line may hold several, separated by `;`. The console's `help` lists its own words, such \
                    as `run` and `wait`.\n\n| command | effect |\n|---|---|\n"
        .to_owned();
    let mut commands: Vec<_> = COMMANDS.iter().collect();
    commands.sort_by_key(|command| command.name.to_lowercase());
    for command in commands {
        let _ = writeln!(text, "| `{}` | {} |", command.usage().replace('|', "\\|"), command.help);
    }
    check_list("commands.md", &text);
}

/// Folders with which a path in the book may begin.
const FOLDERS: [&str; 7] = ["kmotiondef/", "coff/", "vm/", "runtime/", "cc67/", "tests/", "c-programs/"];

/// The paths of the repository that a page names in backquotes, outside blocks.
fn paths(page: &str) -> Vec<&str> {
    let mut is_code = false;
    let mut found = Vec::new();
    for line in page.lines() {
        is_code ^= line.starts_with("```");
        if !is_code {
            let quoted = line.split('`').skip(1).step_by(2);
            found.extend(quoted.filter(|text| FOLDERS.iter().any(|folder| text.starts_with(folder))));
        }
    }
    let is_path = |text: &&str| text.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
    found.into_iter().filter(is_path).collect()
}

#[test]
fn paths_named_in_the_book_exist() {
    let mut broken = Vec::new();
    for file in files(&harness::root().join("cc67/book/src"), "md")
        .into_iter()
        .chain([harness::root().join("README.md")])
    {
        let text = fs::read_to_string(&file).expect("pages are UTF-8");
        let dead = paths(&text).into_iter().filter(|path| {
            let path = harness::root().join(path);
            !path.exists() && !path.with_extension("rs").exists()
        });
        broken.extend(
            dead.map(|path| format!("{} names {path}, which does not exist", harness::relative(&file))),
        );
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
