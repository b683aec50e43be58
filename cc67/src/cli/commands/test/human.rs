//! The results as text: a line for each failure, its differences, the count.

use similar::{ChangeTag, TextDiff};

use super::case::Case;
use super::golden::Shown;
use super::schedules::FailingSchedule;
use super::verdict::Verdict;
use compiler::render::human::Color;

/// The number of lines shown around a difference.
const CONTEXT: usize = 3;

/// The report of all results.
pub(super) fn report(cases: &[Case], verdicts: &[Verdict], color: Color) -> String {
    let mut text = String::new();
    let (mut passed, mut blessed, mut failed, mut skipped) = (0, 0, 0, 0);
    for (case, verdict) in cases.iter().zip(verdicts) {
        let paint = Paint { color };
        match verdict {
            Verdict::Passed => passed += 1,
            Verdict::Blessed => {
                blessed += 1;
                text.push_str(&format!("written  {}\n", case.golden().display()));
            }
            Verdict::Skipped(why) => {
                skipped += 1;
                text.push_str(&format!("skipped  {}: {why}\n", case.name()));
            }
            bad => {
                failed += 1;
                text.push_str(&failure(case, bad, &paint));
            }
        }
    }
    text.push_str(&format!("{passed} passed, {failed} failed"));
    if blessed > 0 {
        text.push_str(&format!(", {blessed} written"));
    }
    if skipped > 0 {
        text.push_str(&format!(", {skipped} skipped"));
    }
    text.push('\n');
    text
}

fn failure(case: &Case, verdict: &Verdict, paint: &Paint) -> String {
    let name = case.name();
    let failed = paint.red("FAILED");
    match verdict {
        Verdict::Passed | Verdict::Blessed | Verdict::Skipped(_) => String::new(),
        Verdict::Refused(shown) => {
            let why = match shown.code {
                Some(1) => "it does not compile",
                Some(_) => "its options or files are wrong",
                None => "it was killed",
            };
            format!(
                "{failed}   {name}: nothing is written, as {why}\n{}{}",
                messages(shown),
                indented(shown.notes())
            )
        }
        Verdict::Asked(shown) => format!(
            "{}  {name}: not written, as faults or remarks would become expected; --force writes it\n{}{}",
            paint.red("REFUSED"),
            messages(shown),
            indented(&shown.doubts())
        ),
        Verdict::Unknown => format!(
            "{failed}   {name}: there is no {}; `cc67 test --bless {}` writes it\n",
            case.golden().display(),
            case.source.display(),
        ),
        Verdict::Differs(shown) => {
            let expected = case.expected.as_deref().unwrap_or_default();
            let head = format!("{failed}   {name}: - expected, + shown now\n");
            head + &messages(shown) + &diff(expected, &shown.golden, paint)
        }
        Verdict::FailsBySchedule(found) => {
            let FailingSchedule { seed, smallest, why, notes } = found;
            let place = format!("`cc67 run --schedule {smallest}`, found with seed {seed}");
            format!("{failed}   {name}: by a schedule, {why}\n  {place}\n{}", indented(notes))
        }
        Verdict::Disagrees(first, executor, second) => {
            let head = format!(
                "{failed}   {name}: the engines disagree, which is a bug in cc67; - the first, + {}\n",
                executor.name()
            );
            head + &messages(second) + &diff(&first.golden, &second.golden, paint)
        }
    }
}

/// Indents lines.
pub(super) fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}\n")).collect()
}

fn messages(shown: &Shown) -> String {
    shown.messages.clone()
}

/// The lines that differ, with the surrounding ones.
pub(super) fn diff(old: &str, new: &str, paint: &Paint) -> String {
    let diff = TextDiff::from_lines(old, new);
    let mut text = String::new();
    for group in diff.grouped_ops(CONTEXT) {
        if let Some(first) = group.first() {
            text.push_str(&format!("  line {}\n", first.new_range().start + 1));
        }
        for change in group.iter().flat_map(|op| diff.iter_changes(op)) {
            let line = change.value().trim_end_matches('\n');
            text.push_str(&match change.tag() {
                ChangeTag::Delete => paint.red(&format!("  - {line}")),
                ChangeTag::Insert => paint.green(&format!("  + {line}")),
                ChangeTag::Equal => format!("    {line}"),
            });
            text.push('\n');
        }
    }
    text
}

/// Colours for text, if the terminal shows them.
pub(super) struct Paint {
    pub(super) color: Color,
}

impl Paint {
    fn red(&self, text: &str) -> String {
        self.with("31", text)
    }

    fn green(&self, text: &str) -> String {
        self.with("32", text)
    }

    fn with(&self, code: &str, text: &str) -> String {
        match self.color {
            Color::Always => format!("\x1b[{code}m{text}\x1b[0m"),
            Color::Never => text.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_terminal_a_difference_is_red_and_green() {
        let text = diff("a\nb\n", "a\nc\n", &Paint { color: Color::Always });
        assert_eq!(text, "  line 1\n    a\n\x1b[31m  - b\x1b[0m\n\x1b[32m  + c\x1b[0m\n");
    }
}
