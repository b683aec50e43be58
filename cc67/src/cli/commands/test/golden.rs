//! The text of an `.expected` file: all that a run shows, and how it ended.

use std::time::Duration;

/// What a run showed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shown {
    /// The golden text: console, notes of the board, exit code.
    pub(super) golden: String,
    /// What else stood on stderr: the messages of the compiler.
    pub(super) messages: String,
    /// The exit code; `None` of a process that was killed.
    pub(super) code: Option<i32>,
    /// How long it took on the clock.
    pub(super) took: Duration,
}

impl Shown {
    /// What the golden holds beside a console: remarks of the board, traps, what is not as expected.
    pub(super) fn notes(&self) -> &str {
        let marks = ["---- notes\n", "---- exit ", "---- killed\n"];
        let first = marks.iter().filter_map(|mark| find(&self.golden, mark)).min();
        first.and_then(|at| self.golden.get(at..)).unwrap_or_default()
    }
}

/// A golden text without messages: the console, and how the run ended.
pub(super) fn without_notes(golden: &str) -> String {
    let Some(at) = find(golden, "---- notes\n") else { return golden.to_owned() };
    let (console, rest) = golden.split_at(at);
    let end = ["---- exit ", "---- killed\n"].iter().filter_map(|mark| find(rest, mark)).max();
    console.to_owned() + end.and_then(|at| rest.get(at..)).unwrap_or_default()
}

/// Where the line that begins with a mark is.
fn find(text: &str, mark: &str) -> Option<usize> {
    match text.starts_with(mark) {
        true => Some(0),
        false => text.find(&format!("\n{mark}")).map(|at| at + 1),
    }
}

/// Puts together what a process printed.
pub(super) fn shown(stdout: &[u8], stderr: &[u8], code: Option<i32>) -> Shown {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).replace("\r\n", "\n");
    let mut golden = text(stdout);
    let stderr = text(stderr);
    let (notes, messages): (Vec<_>, Vec<_>) =
        stderr.split_inclusive('\n').partition(|line| line.starts_with("cc67: "));
    if !golden.is_empty() && !golden.ends_with('\n') {
        golden.push('\n');
    }
    if !notes.is_empty() {
        golden.push_str("---- notes\n");
        golden.extend(notes);
    }
    match code {
        Some(0) => {}
        Some(code) => golden.push_str(&format!("---- exit {code}\n")),
        None => golden.push_str("---- killed\n"),
    }
    Shown { golden, messages: messages.concat(), code, took: Duration::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(stdout: &str, stderr: &str, code: i32, golden: &str, messages: &str) {
        let shown = shown(stdout.as_bytes(), stderr.as_bytes(), Some(code));
        assert_eq!((shown.golden.as_str(), shown.messages.as_str()), (golden, messages));
    }

    #[test]
    fn a_successful_run_records_only_the_console() {
        check("done\n", "", 0, "done\n", "");
        check("no end", "", 0, "no end\n", "");
        check("", "", 0, "", "");
    }

    #[test]
    fn errors_follow_the_console_output() {
        check(
            "one\n",
            "cc67: thread 1 trapped\n",
            3,
            "one\n---- notes\ncc67: thread 1 trapped\n---- exit 3\n",
            "",
        );
        check("", "a.c:1: error\n", 1, "---- exit 1\n", "a.c:1: error\n");
    }
}
