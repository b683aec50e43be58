//! Firmware functions: the row of the table, waits, common errors, an example.
//!
//! Common errors and examples are on the page `pages/functions.md`, whose headings name functions; for a function not
//! mentioned there, the example is a call in an example program.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use kmotiondef::ctype::Role;
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS, FirmwareFunction, Origin};
use kmotiondef::limits::{N_CHANNELS, N_USER_THREADS};
use runtime::REMARKS;

use super::{ExplainedName, boards};
use crate::cli::commands::examples;

/// The page: headings with names of functions, each followed by their text.
const PAGE: &str = include_str!("../pages/functions.md");

/// Cycles of the processor per microsecond.
const CYCLES_PER_US: f64 = 200.0;

fn shown() -> impl Iterator<Item = &'static FirmwareFunction> {
    FIRMWARE_FUNCTIONS.iter().filter(|function| !ABSENT.contains(&function.name))
}

/// Each function with the doc comment of its row.
pub(super) fn entries() -> impl Iterator<Item = ExplainedName> {
    shown().map(|function| ExplainedName { name: function.name, about: sentence(function) })
}

/// The names of all functions, by group.
pub(super) fn list() -> String {
    let groups: BTreeSet<_> = shown().map(|function| function.group).collect();
    let mut text = String::new();
    for group in groups {
        let _ = writeln!(text, "{group}:");
        for function in shown().filter(|function| function.group == group) {
            let _ = writeln!(text, "  {:<24}{}", function.name, super::first_sentence(&sentence(function)));
        }
    }
    text
}

/// The answer for one function.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let function = shown().find(|function| is_meant(function.name))?;
    let name = function.name;
    let mut text = format!("# {name}\n\n    {};\n\n{}\n\n", function.prototype(), sentence(function));
    let cost = function.cost.get() as f64 / CYCLES_PER_US;
    let _ = match function.attributes.waits {
        Some(what) => writeln!(
            text,
            "- It waits {what}, while other threads run: not in the call-back (`UserCallBack`). In addition it takes {cost} µs."
        ),
        None => writeln!(text, "- It takes {cost} µs and does not wait."),
    };
    text.push_str(match function.origin {
        Origin::Header => "- `#include \"KMotionDef.h\"` declares it.\n",
        Origin::Firmware => "- The firmware has it, but the header does not declare it: declare it in the program.\n",
        Origin::Library => {
            "- Firmware 4.34 lacks it; the simulated board has it, but on a real board the program must define it.\n"
        }
    });
    text.push_str(&arguments(function));
    text.push_str(&boards::line(name));
    let codes = codes(name);
    if !codes.is_empty() {
        let _ = writeln!(text, "- Remarks that name it: {}.", codes.join(", "));
    }
    match section(name) {
        Some(section) => {
            let _ = write!(text, "\n{section}\n");
        }
        None => {
            if let Some((program, line)) = examples::call(name) {
                let _ = write!(text, "\nFrom `cc67 examples {program}`:\n\n    {line}\n");
            }
        }
    }
    Some(text)
}

/// The arguments whose meaning goes beyond their C type, as a line of a list.
fn arguments(function: &FirmwareFunction) -> String {
    let meanings = function.params.iter().filter_map(|param| {
        let meaning = match param.role {
            Role::Value => return None,
            Role::Axis => format!("the number of an axis, 0 to {}", N_CHANNELS - 1),
            Role::Bit => "the number of a bit".to_owned(),
            Role::Thread => format!("the number of a thread, 1 to {N_USER_THREADS}"),
            Role::PrintFormat | Role::ScanFormat => "a format".to_owned(),
            Role::FileName => "the name of a file on the PC".to_owned(),
            Role::Within(most) => format!("limited to {most} and -{most}"),
        };
        Some(format!("`{}` is {meaning}", param.name))
    });
    let meanings: Vec<_> = meanings.collect();
    if meanings.is_empty() { String::new() } else { format!("- {}.\n", meanings.join(", ")) }
}

/// The doc comment of the row on one line.
fn sentence(function: &FirmwareFunction) -> String {
    function.doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The remarks whose text or description mentions a function.
fn codes(name: &str) -> Vec<String> {
    let names = |text: &str| {
        text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == name)
            && (text.contains(&format!("{name}(")) || text.contains(&format!("{name}:")))
    };
    REMARKS.iter().filter(|row| names(row.text)).map(|row| format!("`{}`", row.code)).collect()
}

/// The text under the heading that names a function.
fn section(name: &str) -> Option<&'static str> {
    PAGE.split("\n## ").skip(1).find_map(|section| {
        let (heading, text) = section.split_once('\n')?;
        heading.split(", ").any(|of| of.trim() == name).then(|| text.trim_matches(['\n', '\r']))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_heading_of_the_page_is_a_function_listed_once() {
        let mut seen = BTreeSet::new();
        for section in PAGE.split("\n## ").skip(1) {
            for name in section.lines().next().unwrap_or_default().split(", ") {
                assert!(kmotiondef::firmware::function_named(name.trim()).is_some(), "{name}");
                assert!(seen.insert(name.trim()), "{name} has two sections");
            }
        }
    }

    #[test]
    fn every_remark_code_on_the_page_exists() {
        for word in PAGE.split('`').skip(1).step_by(2).filter(|word| word.contains('-')) {
            let is_code =
                !word.starts_with('-') && word.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-');
            assert!(!is_code || REMARKS.iter().any(|row| row.code == word), "{word}");
        }
    }

    #[test]
    fn functions_of_the_board_have_an_example() {
        let groups = ["io", "motion", "time", "thread", "sync"];
        let missing: Vec<_> = shown()
            .filter(|function| groups.contains(&function.group))
            .filter(|function| section(function.name).is_none() && examples::call(function.name).is_none())
            .map(|function| function.name)
            .collect();
        assert!(missing.len() <= 12, "{missing:?}");
    }
}
