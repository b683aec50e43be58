//! `cc67 explain NAME`, and `--explain NAME`: table entries for a name, and pages on topics.
//!
//! A name may be a firmware function, a variable, a field, a constant, a bit, a script command, a warning, a remark, a
//! limit or a topic; an answer contains all of them that match. Nothing is listed here: each module converts the rows
//! of a table to text. A word that is not a name finds the names whose texts contain it, or the name that was probably
//! meant.

mod bits;
mod boards;
mod commands;
mod functions;
mod places;
mod topics;
mod words;

use std::fmt::Write as _;

use anyhow::{Result, bail};
use clap::Args;
use compiler::diag::{Lint, Preset};
use compiler::words::suggest;
use runtime::{REMARKS, RemarkRow};

use super::limits;
use crate::cli::io::exit::Exit;
use crate::cli::io::output;

/// A kind of name, and the function that lists the names of that kind.
type List = (&'static str, fn() -> String);

/// A name that can be explained, with a one-sentence description.
struct ExplainedName {
    name: &'static str,
    about: String,
}

/// Arguments of `cc67 explain`.
#[derive(Debug, Args)]
pub(super) struct ExplainArguments {
    /// Name such as EnableAxis, Dest, bit46, Jog, fraction-lost or homing; `topics` lists topics and lists of names
    #[arg(value_name = "NAME", default_value = "topics", allow_hyphen_values = true)]
    pub(super) name: String,
}

/// Explains a name from a message, an option or the user's memory.
pub(super) fn explain(name: &str) -> Result<Exit> {
    let name = name.trim();
    let text = match answer(name) {
        Some(text) => text,
        None => match bits::answer(name)? {
            Some(text) => text,
            None => search_names(name)?,
        },
    };
    output::print(&text)?;
    Ok(Exit::Success)
}

/// All explanations of a name: with exact case, otherwise in any case.
fn answer(name: &str) -> Option<String> {
    let same: &dyn Fn(&str) -> bool = &|known| known == name;
    let similar: &dyn Fn(&str) -> bool = &|known| known.eq_ignore_ascii_case(name);
    [same, similar].into_iter().find_map(|is_meant| {
        let parts: Vec<_> = [
            list(is_meant),
            topics::answer(is_meant),
            warning(name),
            remark(is_meant),
            functions::answer(is_meant),
            boards::answer(is_meant),
            places::answer(is_meant),
        ]
        .into_iter()
        .flatten()
        .collect();
        // The name of a script command is not case-sensitive, and may be the same as a field's or function's.
        let command = commands::answer(&|known: &str| known.eq_ignore_ascii_case(name));
        let parts: Vec<_> = parts.into_iter().chain(command).chain(words::answer(name)).collect();
        (!parts.is_empty()).then(|| parts.join("\n"))
    })
}

/// Returns a list of the rows of a table.
fn list(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    const LISTS: &[List] = &[
        ("warnings", warnings),
        ("remarks", remarks),
        ("limits", limits::page),
        ("functions", functions::list),
        ("variables", places::variables),
        ("commands", commands::list),
        ("bits", bits::list),
        ("topics", list_all),
    ];
    LISTS.iter().find(|(name, _)| is_meant(name)).map(|(_, text)| text())
}

/// Lists all that can be explained: topics, lists, and the kinds of names.
fn list_all() -> String {
    let mut text = "Topics:\n".to_owned();
    for entry in topics::entries() {
        let _ = writeln!(text, "  {:<12}{}", entry.name, entry.about);
    }
    text.push_str("\nLists:\n");
    for (name, about) in [
        ("functions", "firmware functions by group"),
        ("variables", "firmware variables"),
        ("CHAN", "fields of an axis; PERSIST and other structures likewise"),
        ("bits", "ranges of I/O bits; `bit46` explains one"),
        ("commands", "script commands of the console"),
        ("warnings", "warnings of the compiler"),
        ("remarks", "remarks of the simulated board"),
        ("limits", "limits of the tool and of the board"),
    ] {
        let _ = writeln!(text, "  {name:<12}{about}");
    }
    text.push_str("\nEach name in these lists is explained as well, such as `cc67 explain EnableAxis`.\n");
    text
}

fn warning(name: &str) -> Option<String> {
    let lint = Lint::from_name(name).ok()?;
    Some(format!("{}\n{}", lint.page(), lint.switches()))
}

fn remark(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let RemarkRow { code, about, text, .. } = REMARKS.iter().find(|row| is_meant(row.code))?;
    let off = format!(
        "`-R no-{code}` switches it off; so does `{code} = false` in `[remarks]` of the machine file."
    );
    Some(format!("# {code}\n\n{}\n\n    {text}\n\n{off}\n", about.trim()))
}

/// All remarks of the board with their subjects.
fn remarks() -> String {
    REMARKS.iter().fold(String::new(), |mut rows, row| {
        let _ = writeln!(rows, "  {:<24}{}", row.code, row.about.trim());
        rows
    })
}

/// All warnings with their descriptions.
fn warnings() -> String {
    let mut text = String::new();
    for (preset, title) in [
        (Preset::On, "On by default, also named by -Wall:"),
        (Preset::All, "Switched on by -Wall:"),
        (Preset::Extra, "Switched on by -Wextra:"),
        (Preset::Own, "Switched on by its own name:"),
    ] {
        let lints = Lint::ALL.iter().filter(|lint| lint.preset() == preset);
        let rows = lints.fold(String::new(), |mut rows, lint| {
            let _ = writeln!(rows, "  {:<24}{}", lint.name(), lint.summary());
            rows
        });
        let separator = if text.is_empty() { "" } else { "\n" };
        let _ = write!(text, "{separator}{title}\n{rows}");
    }
    text
}

/// All names with their sentences.
fn entries() -> Vec<ExplainedName> {
    let lints =
        Lint::ALL.iter().map(|lint| ExplainedName { name: lint.name(), about: lint.summary().to_owned() });
    let remarks =
        REMARKS.iter().map(|row| ExplainedName { name: row.code, about: row.about.trim().to_owned() });
    let mut all = topics::entries();
    all.extend(functions::entries());
    all.extend(places::entries());
    all.extend(commands::entries());
    all.extend(lints);
    all.extend(remarks);
    all
}

/// The names whose sentences contain a word; without any, the name that was probably meant.
fn search_names(word: &str) -> Result<String> {
    const MOST: usize = 20;
    const LEAST: usize = 4;
    let entries = entries();
    if let Some(near) = near(word, &entries) {
        bail!("no page is named `{word}`; did you mean `{near}`?");
    }
    let lower = word.to_lowercase();
    let has = |entry: &&ExplainedName| {
        let text = format!("{} {}", entry.name, entry.about).to_lowercase();
        text.split(|c: char| !c.is_alphanumeric() && c != '_')
            .any(|of| of.strip_prefix(lower.as_str()).is_some_and(|rest| rest.len() <= 2))
            || entry.name.to_lowercase().contains(&lower)
    };
    let mut rows: Vec<_> = entries.iter().filter(has).filter(|_| word.len() >= LEAST).collect();
    rows.dedup_by_key(|entry| entry.name);
    if rows.is_empty() {
        bail!("no page is named `{word}`; `cc67 --explain topics` lists them");
    }
    let mut text = format!("No page is named `{word}`. Related names:\n\n");
    for entry in rows.iter().take(MOST) {
        let _ = writeln!(text, "  {:<24}{}", entry.name, first_sentence(&entry.about));
    }
    if rows.len() > MOST {
        let _ = writeln!(text, "  … and {} more", rows.len() - MOST);
    }
    Ok(text)
}

/// The name that was probably meant; for the name of a list, that list.
fn near(word: &str, entries: &[ExplainedName]) -> Option<&'static str> {
    const LISTS: &[&str] = &["warnings", "remarks", "limits", "functions", "variables", "commands", "topics"];
    let names = || entries.iter().map(|entry| entry.name).chain(LISTS.iter().copied());
    let near = suggest(word, names())?;
    // A name of which the word is only the beginning is not a correction of its spelling.
    let is_spelling = !word.to_lowercase().starts_with(&near.to_lowercase());
    names().find(|name| *name == near).filter(|_| is_spelling)
}

/// The text up to the first full stop, on one line.
fn first_sentence(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.split_once(". ") {
        Some((first, _)) => format!("{first}."),
        None => line,
    }
}

#[cfg(test)]
mod tests {
    use super::{entries, topics};

    #[test]
    fn every_action_of_a_stimulus_is_explained() {
        let page = topics::answer(&|name| name == "stimulus").expect("there is the page");
        for usage in runtime::stimulus::usages() {
            let words: Vec<_> =
                usage.split(' ').take_while(|word| word.chars().all(char::is_lowercase)).collect();
            assert!(page.contains(&format!("`{}", words.join(" "))), "{usage}");
        }
    }

    #[test]
    fn every_name_has_an_answer() {
        for entry in entries() {
            assert!(super::answer(entry.name).is_some(), "{}", entry.name);
        }
    }

    #[test]
    fn each_name_that_a_topic_refers_to_is_explained() {
        for entry in topics::entries() {
            let page = topics::answer(&|name| name == entry.name).expect("a page");
            let Some((_, names)) = page.rsplit_once("See also:") else { continue };
            for name in names.split('`').skip(1).step_by(2) {
                assert!(super::answer(name).is_some() || name == "bits", "{}: {name}", entry.name);
            }
        }
    }
}
