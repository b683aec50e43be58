//! The results for other tools: JSON and JUnit.

use std::time::Duration;

use compiler::render::human::Color;
use serde::Serialize;

use super::case::Case;
use super::human;
use super::verdict::Verdict;

/// The whole report.
#[derive(Serialize)]
struct Report<'a> {
    passed: usize,
    failed: usize,
    #[serde(skip_serializing_if = "is_zero")]
    skipped: usize,
    tests: Vec<Test<'a>>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

#[derive(Serialize)]
struct Test<'a> {
    name: String,
    result: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    engine: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shown: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    schedule: Option<String>,
    #[serde(skip_serializing_if = "str::is_empty")]
    messages: &'a str,
}

fn test<'a>(case: &'a Case, verdict: &'a Verdict) -> Test<'a> {
    let name = case.name();
    let plain = |result| Test {
        name: name.clone(),
        result,
        engine: None,
        expected: None,
        shown: None,
        schedule: None,
        messages: "",
    };
    match verdict {
        Verdict::Passed => plain("passed"),
        Verdict::Blessed => plain("written"),
        Verdict::Skipped(why) => Test { messages: why, ..plain("skipped") },
        Verdict::Refused(shown) | Verdict::Asked(shown) => {
            Test { shown: Some(&shown.golden), messages: &shown.messages, ..plain("not written") }
        }
        Verdict::Unknown => plain("nothing expected"),
        Verdict::Differs(shown) => Test {
            expected: case.expected.as_deref(),
            shown: Some(&shown.golden),
            messages: &shown.messages,
            ..plain("differs")
        },
        Verdict::FailsBySchedule(found) => Test {
            schedule: Some(found.smallest.to_string()),
            messages: &found.notes,
            ..plain("fails by a schedule")
        },
        Verdict::Disagrees(first, executor, second) => Test {
            engine: Some(executor.name()),
            expected: Some(&first.golden),
            shown: Some(&second.golden),
            messages: &second.messages,
            ..plain("engines disagree")
        },
    }
}

/// One JSON object: `passed`, `failed` and `tests`.
pub(super) fn json(cases: &[Case], verdicts: &[Verdict]) -> String {
    let count = |is: fn(&Verdict) -> bool| verdicts.iter().filter(|verdict| is(verdict)).count();
    let (passed, failed) = (count(Verdict::is_good), count(Verdict::is_bad));
    let skipped = verdicts.len() - passed - failed;
    let tests = cases.iter().zip(verdicts).map(|(case, verdict)| test(case, verdict)).collect();
    let report = Report { passed, failed, skipped, tests };
    let mut text = serde_json::to_string_pretty(&report).unwrap_or_default();
    text.push('\n');
    text
}

/// A JUnit report, for continuous integration.
///
/// The class of a test is its folder; its time is the sum of the times of its runs.
pub(super) fn junit(cases: &[Case], verdicts: &[Verdict], took: &[Duration]) -> String {
    let failed = verdicts.iter().filter(|verdict| verdict.is_bad()).count();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let total: Duration = took.iter().sum();
    text.push_str(&format!(
        "<testsuite name=\"cc67\" tests=\"{}\" failures=\"{failed}\" time=\"{:.3}\">\n",
        verdicts.len(),
        total.as_secs_f64()
    ));
    for ((case, verdict), took) in cases.iter().zip(verdicts).zip(took) {
        let test = test(case, verdict);
        let (folder, name) = test.name.rsplit_once('/').unwrap_or(("cc67", &test.name));
        let class = folder.trim_start_matches('/').replace('/', ".");
        let head = format!(
            "  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3}\"",
            escape(&class),
            escape(name),
            took.as_secs_f64()
        );
        if verdict.is_good() {
            text.push_str(&format!("{head}/>\n"));
            continue;
        }
        if let Verdict::Skipped(why) = verdict {
            let why = escape(why);
            text.push_str(&format!("{head}>\n    <skipped message=\"{why}\"/>\n  </testcase>\n"));
            continue;
        }
        let (expected, shown) = (test.expected.unwrap_or_default(), test.shown.unwrap_or_default());
        let diff = human::diff(expected, shown, &human::Paint { color: Color::Never });
        let body = format!("{}- expected, + shown\n{diff}", test.messages);
        text.push_str(&format!(
            "{head}>\n    <failure message=\"{}\">{}</failure>\n  </testcase>\n",
            escape(test.result),
            escape(&body)
        ));
    }
    text.push_str("</testsuite>\n");
    text
}

/// Escapes text for XML; characters that XML does not allow become question marks.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(c),
            c if c < ' ' => escaped.push('?'),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn any_text_is_escaped_for_xml() {
        assert_eq!(escape("a<b & \"c\"\x07\n"), "a&lt;b &amp; &quot;c&quot;?\n");
    }
}
