//! Tests on the user's own firmware file.
//!
//! Remarks and traps exist only in the modelled firmware, so only the console and the exit code are compared; and
//! programs that measure time print different last digits. Tests that need features of the model are skipped.

use super::case::Case;
use super::golden::{self, Shown};
use super::near::is_near;
use super::verdict::Verdict;
use crate::cli::io::exit::Exit;

/// The end of the message with which `cc67 run` rejects an option.
const REFUSED: &str = " does not work with `--boot`";

/// Reduces the expected output of a test to the parts that exist with a firmware file.
pub(super) fn reduce(case: &mut Case) {
    case.expected = case.expected.as_deref().map(golden::without_notes);
}

/// Judges a run on the firmware.
pub(super) fn verdict(case: &Case, shown: Shown) -> Verdict {
    let Some(expected) = &case.expected else { return Verdict::Unknown };
    let first = shown.notes().lines().find(|line| line.contains(REFUSED));
    if let (Some(2), Some(line)) = (shown.code, first) {
        return Verdict::Skipped(line.trim_start_matches("cc67: ").to_owned());
    }
    let traps = format!("---- exit {}\n", Exit::Trapped as i32);
    if expected.ends_with(&traps) {
        return Verdict::Skipped("it expects a trap, which only the modelled firmware has".to_owned());
    }
    let shown = Shown { golden: golden::without_notes(&shown.golden), ..shown };
    if is_near(expected, &shown.golden) { Verdict::Passed } else { Verdict::Differs(shown) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(expected: &str, stdout: &str, stderr: &str, code: i32, expect: &str) {
        let expected = Some(expected.to_owned());
        let mut case = Case { source: "a.c".into(), expected, options: Vec::new(), also: Vec::new() };
        reduce(&mut case);
        let verdict = verdict(&case, golden::shown(stdout.as_bytes(), stderr.as_bytes(), Some(code)));
        let verdict = format!("{verdict:?}");
        assert!(verdict.starts_with(expect), "{verdict}");
    }

    #[test]
    fn the_console_and_the_exit_code_are_compared() {
        check("a\n---- notes\ncc67: a remark\n", "a\n", "", 0, "Passed");
        check("took 3.200 s\n", "took 3.201 s\n", "", 0, "Passed");
        check("took 3.200 s\n", "took 3.300 s\n", "", 0, "Differs");
        check("a\n", "a\nb\n", "", 0, "Differs");
        check("a\n---- notes\ncc67: still\n---- exit 4\n", "a\n", "cc67: running\n", 4, "Passed");
        check("a\n", "a\n", "", 5, "Differs");
    }

    #[test]
    fn tests_that_need_the_model_are_skipped_with_the_reason() {
        let refused = "cc67: `--engine` does not work with `--boot`\n";
        check("a\n", "", refused, 2, "Skipped(\"`--engine` does not work");
        check("a\n---- notes\ncc67: trap\n---- exit 3\n", "a\n", "", 0, "Skipped(\"it expects a trap");
        check("a\n", "", "cc67: no such file\n", 2, "Differs");
    }
}
