//! The text of an `.expected` file: the output of a run, and how it ended.

use std::time::Duration;

use runtime::is_request;

/// The output of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shown {
    /// The text in the format of the file: console, notes of the board, exit code.
    pub(super) golden: String,
    /// The rest of stderr: the messages of the compiler.
    pub(super) messages: String,
    /// The exit code; `None` for a process that was killed.
    pub(super) code: Option<i32>,
    /// The duration on the clock.
    pub(super) took: Duration,
}

impl Shown {
    /// Returns the part after the console: remarks of the board, traps, unmet expectations.
    pub(super) fn notes(&self) -> &str {
        let marks = ["---- notes\n", "---- exit ", "---- killed\n"];
        let first = marks.iter().filter_map(|mark| find(&self.golden, mark)).min();
        first.and_then(|at| self.golden.get(at..)).unwrap_or_default()
    }
}

/// Messages of the board about faults on the console.
const FAULTS: &[&str] = &[
    "Following Error Disabled Axis",
    "Limit Disabled Axis",
    "Limit Stop Axis",
    "Soft Limit FeedHold",
    "Fatal Error",
];

/// The beginnings of messages about a run that was stopped while threads were still active.
const CUT_OFF: &[&str] = &["cc67: still running after ", "cc67: at the end, after "];

impl Shown {
    /// Returns the parts that a user should review before they become the expected output: traps, remarks, unmet
    /// expectations, and faults that the board prints on the console, but not threads that have not ended or requests
    /// to the PC.
    pub(super) fn doubts(&self) -> String {
        let (console, notes) = self.golden.split_at(self.golden.len() - self.notes().len());
        let faults = console.lines().filter(|line| FAULTS.iter().any(|fault| line.contains(fault)));
        let is_end = |line: &str| {
            CUT_OFF.iter().any(|words| line.starts_with(words))
                || line.strip_prefix("cc67: ").is_some_and(is_request)
                || line.starts_with("---- notes")
                || line == "---- exit 4"
        };
        let doubts: Vec<_> = faults.chain(notes.lines().filter(|line| !is_end(line))).collect();
        doubts.iter().map(|line| format!("{line}\n")).collect()
    }
}

/// An expected output without notes: the console, and how the run ended.
pub(super) fn without_notes(golden: &str) -> String {
    let Some(at) = find(golden, "---- notes\n") else { return golden.to_owned() };
    let (console, rest) = golden.split_at(at);
    let end = ["---- exit ", "---- killed\n"].iter().filter_map(|mark| find(rest, mark)).max();
    console.to_owned() + end.and_then(|at| rest.get(at..)).unwrap_or_default()
}

/// Returns the offset of the line that begins with a mark.
fn find(text: &str, mark: &str) -> Option<usize> {
    match text.starts_with(mark) {
        true => Some(0),
        false => text.find(&format!("\n{mark}")).map(|at| at + 1),
    }
}

/// Combines the output of a process.
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
    fn faults_are_doubtful_and_endless_threads_and_requests_are_not() {
        let doubts = |stdout: &str, stderr: &str, code| {
            shown(stdout.as_bytes(), stderr.as_bytes(), Some(code)).doubts()
        };
        assert_eq!(
            doubts("ready\n", "cc67: still running after 60 s of board time; `--for SECONDS`\n", 4),
            ""
        );
        let requests = "cc67: message box: ready?\ncc67: set G-code variables from 5063\n";
        assert_eq!(doubts("ready\n", requests, 0), "");
        let fault = "Following Error Disabled Axis:0\n";
        assert_eq!(doubts(&format!("ready\n{fault}"), "", 0), fault);
        assert_eq!(doubts("", "cc67: thread 1 stopped\n", 3), "cc67: thread 1 stopped\n---- exit 3\n");
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
