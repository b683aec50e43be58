//! Tests on a connected controller.
//!
//! A controller has no model of a machine, and its own time. So only the console and the exit code are compared with
//! the expected ones, without board times; the user performs the actions of `manual` statements; tests that need the
//! model are skipped, and the report states what was not checked.

use cc67_controller::{BY_HAND, UNCHECKED};

use super::case::Case;
use super::golden::{self, Shown};
use super::near;
use super::verdict::Verdict;
use crate::cli::io::exit::Exit;

/// Parts of the messages with which `cc67 run` rejects an option or a statement.
const REFUSED: [&str; 4] = [
    "is about a simulated board",
    "does not work with `--on`",
    "only the model of a machine does this",
    "the PC does not hear the serial port",
];
/// The option that stops a program which does not end.
const LIMIT: &str = "--for=60";

/// Expectations that are not checked on a controller, by the names of their tests.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Unchecked {
    times: Vec<String>,
    remarks: Vec<String>,
}

impl Unchecked {
    /// Reduces the expected outputs of tests to the parts that exist on a controller.
    pub(super) fn reduce(cases: &mut [Case]) -> Self {
        let mut unchecked = Self::default();
        for case in cases {
            let name = case.name();
            let with_times = case.options.len();
            case.options.retain(|option| option != "--time");
            let has_times = case.options.len() < with_times;
            if !case.options.iter().any(|option| option.starts_with("--for")) {
                case.options.insert(0, LIMIT.to_owned());
            }
            let Some(expected) = &case.expected else { continue };
            let mut console = golden::without_notes(expected);
            if expected.contains("---- notes\n") {
                unchecked.remarks.push(name.clone());
            }
            if has_times {
                console = console.lines().map(|line| without_time(line).to_owned() + "\n").collect();
                unchecked.times.push(name);
            }
            case.expected = Some(console);
        }
        unchecked
    }

    /// The lines for the report.
    pub(super) fn report(&self) -> String {
        let line = |what: &str, names: &[String]| match names {
            [] => String::new(),
            names => format!("not checked on the controller: {what} of {}\n", names.join(", ")),
        };
        line("board times", &self.times) + &line("remarks", &self.remarks)
    }
}

/// Returns the text of a message line of a run that the user at the controller should see at once.
pub(super) fn for_person(line: &str) -> Option<&str> {
    line.strip_prefix("cc67: ").filter(|text| text.starts_with(BY_HAND) || text.starts_with(UNCHECKED))
}

/// A line of the console without its board time.
fn without_time(line: &str) -> &str {
    match line.split_once(' ') {
        Some((time, rest)) if time.parse::<f64>().is_ok() => rest,
        _ => line,
    }
}

/// Returns the verdict on a run on the controller.
pub(super) fn verdict(case: &Case, mut shown: Shown) -> Verdict {
    let Some(expected) = &case.expected else { return Verdict::Unknown };
    let is_refusal = |line: &&str| REFUSED.iter().any(|words| line.contains(words));
    if let (Some(2), Some(line)) = (shown.code, shown.notes().lines().find(is_refusal)) {
        return Verdict::Skipped(line.trim_start_matches("cc67: ").to_owned());
    }
    for (exit, reason) in [
        (Exit::Trapped, "it expects a trap, which only the modelled firmware has"),
        (Exit::StillRunning, "it expects a program without end; `--for SECONDS` in its first line ends it"),
    ] {
        if expected.ends_with(&format!("---- exit {}\n", exit as i32)) {
            return Verdict::Skipped(reason.to_owned());
        }
    }
    // The messages about unmet expectations are more informative than the exit code.
    if shown.code != Some(Exit::Unmet as i32) {
        shown.golden = golden::without_notes(&shown.golden);
    }
    if near::is_near(expected, &shown.golden) { Verdict::Passed } else { Verdict::Differs(shown) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(expected: &str, options: &[&str]) -> Case {
        let options = options.iter().map(|option| (*option).to_owned()).collect();
        Case { source: "a.c".into(), expected: Some(expected.to_owned()), options, also: Vec::new() }
    }

    #[test]
    fn times_and_remarks_are_not_compared_and_reported() {
        let mut cases = [case("0.5000 a\n0.7000 b\n---- notes\ncc67: a remark\n", &["--time"])];
        let unchecked = Unchecked::reduce(&mut cases);
        assert_eq!(cases[0].expected.as_deref(), Some("a\nb\n"));
        assert_eq!(cases[0].options, ["--for=60"]);
        let report =
            "not checked on the controller: board times of a\nnot checked on the controller: remarks of a\n";
        assert_eq!(unchecked.report(), report);
        let shown = golden::shown(b"a\nb\n", b"cc67: connected to usb: KFLOP 4.34\n", Some(0));
        assert!(matches!(verdict(&cases[0], shown), Verdict::Passed));
    }

    #[test]
    fn tests_that_need_a_model_are_skipped() {
        let mut cases = [case("a\n", &["--stim", "a.stim"]), case("a\n---- exit 4\n", &[])];
        Unchecked::reduce(&mut cases);
        for refused in [
            "`--machine` is about a simulated board: it does not work with `--on`",
            "a.stim:1:1: only the model of a machine does this: a person does",
        ] {
            let message = format!("cc67: {refused}\n");
            let verdict = verdict(&cases[0], golden::shown(b"", message.as_bytes(), Some(2)));
            assert!(matches!(verdict, Verdict::Skipped(why) if why == refused));
        }
        let endless = verdict(&cases[1], golden::shown(b"a\n", b"", Some(0)));
        assert!(matches!(endless, Verdict::Skipped(why) if why.contains("without end")));
    }
}
