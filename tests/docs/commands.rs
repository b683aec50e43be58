//! The commands shown in the README and in the book are run, and must print the text shown below them.
//!
//! Each page is executed from the top in its own folder. A block `LANGUAGE file=NAME` is written to that file. The
//! lines of a block `sh run` are executed; `exit=N` after it is the expected exit code if it is not 0. A block `text`
//! directly after it is their output, standard output before standard error. `CC67_WRITE_BOOK=1` rewrites those blocks.

use std::fs;
use std::path::{Path, PathBuf};

use harness::{Output, Scratch, cc67_with_input, files, root};

/// A page as blocks and the text between them.
enum Part {
    /// Lines outside blocks.
    Prose(String),
    /// A fenced block: the text after the fence, and its lines.
    Block(String, String),
}

fn parts(text: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut prose = String::new();
    let mut open: Option<(String, String)> = None;
    for line in text.split_inclusive('\n') {
        match (line.strip_prefix("```"), &mut open) {
            (Some(info), None) => {
                parts.push(Part::Prose(std::mem::take(&mut prose)));
                open = Some((info.trim().to_owned(), String::new()));
            }
            (Some(_), Some(_)) => parts.extend(open.take().map(|(info, body)| Part::Block(info, body))),
            (None, Some((_, body))) => body.push_str(line),
            (None, None) => prose.push_str(line),
        }
    }
    parts.push(Part::Prose(prose));
    parts
}

/// The words of a command line, with quotes interpreted as by a shell; `#` begins a comment.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match (quote, c) {
            (Some(mark), c) if c == mark => quote = None,
            (None, '"' | '\'') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, ' ') => words.extend(word.take()),
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// Runs `cc67 …`, optionally with `printf 'TEXT' |` before it or `> FILE` after it.
fn run(line: &str, folder: &Path) -> Output {
    let piped = line.strip_prefix("printf '").and_then(|rest| rest.split_once("' | "));
    let (input, line) = piped.unwrap_or(("", line));
    let mut words = words(line);
    let target = words.iter().position(|word| word == ">").map(|at| words.split_off(at));
    assert_eq!(words.remove(0), "cc67", "{line}: only cc67 can be run");
    let mut output = cc67_with_input(folder, &words, &input.replace("\\n", "\n"));
    if let Some(name) = target.as_ref().and_then(|words| words.last()) {
        fs::write(folder.join(name), std::mem::take(&mut output.stdout)).expect("files can be written");
    }
    output
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("folders can be made");
    for entry in fs::read_dir(from).expect("the folder is readable") {
        let path = entry.expect("the entry is readable").path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).expect("files can be copied");
        }
    }
}

/// Runs the commands of a block and returns their output.
fn run_block(page: &str, info: &str, body: &str, folder: &mut PathBuf) -> String {
    let code = info.split_whitespace().find_map(|word| word.strip_prefix("exit=")).unwrap_or("0");
    let mut printed = String::new();
    for line in body.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(place) = line.strip_prefix("cd ") {
            folder.push(place);
            continue;
        }
        let output = run(line, folder);
        assert_eq!(output.code.to_string(), code, "{page}: {line}\n{}", output.render());
        printed.push_str(&output.stdout);
        printed.push_str(&output.stderr);
    }
    let shown = printed.trim_end_matches('\n');
    if shown.is_empty() { String::new() } else { format!("{shown}\n") }
}

/// Runs the commands of a page. Returns the page with their present output, and the number of blocks of commands.
fn replay(page: &str, text: &str) -> (String, usize) {
    let scratch = Scratch::new("page");
    let mut folder = scratch.path().to_owned();
    if text.contains("c-programs/") {
        copy(&root().join("c-programs"), &folder.join("c-programs"));
    }
    let (mut now, mut count) = (String::new(), 0);
    let mut printed: Option<String> = None;
    for part in parts(text) {
        let (info, body) = match part {
            Part::Prose(prose) => {
                now.push_str(&prose);
                continue;
            }
            Part::Block(info, body) => (info, body),
        };
        if let Some(name) = info.split_whitespace().find_map(|word| word.strip_prefix("file=")) {
            fs::write(folder.join(name), &body).expect("files can be written");
        }
        let shown = match printed.take() {
            Some(printed) if info == "text" => printed,
            _ => body,
        };
        now.push_str(&format!("```{info}\n{shown}```\n"));
        if info == "sh run" || info.starts_with("sh run ") {
            count += 1;
            printed = Some(run_block(page, &info, &shown, &mut folder));
        }
    }
    (now, count)
}

#[test]
fn commands_print_what_is_below_them() {
    let book = root().join("cc67/book/src");
    let mut count = 0;
    for page in [root().join("README.md")].into_iter().chain(files(&book, "md")) {
        let text = fs::read_to_string(&page).expect("pages are UTF-8");
        if !text.contains("```sh run") {
            continue;
        }
        let name = page.display().to_string();
        let (now, commands) = replay(&name, &text);
        if std::env::var_os("CC67_WRITE_BOOK").is_some() {
            fs::write(&page, &now).expect("the book can be written");
        }
        let different = now.lines().zip(text.lines()).find(|(now, text)| now != text);
        assert!(now == text, "{name}: the commands print something else, first here: {different:?}");
        count += commands;
    }
    assert!(count >= 20, "only {count} blocks of commands");
}

#[test]
fn command_lines_are_read_as_a_shell_reads_them() {
    assert_eq!(
        words("cc67 run --watch \"dest0, x\" 'a b' c.c  # why"),
        ["cc67", "run", "--watch", "dest0, x", "a b", "c.c"]
    );
}
