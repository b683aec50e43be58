//! Settings of the PC's answers, of the form `key=value`.
//!
//! Several answers of one kind are used in turn; the last one is repeated. The keys are listed in [`HELP`].

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// The keys, for people.
pub const HELP: &str = "\
msgbox=BUTTON          ok, cancel, abort, retry, ignore, yes, no or its number
input=NUMBER|cancel    what is typed into an input box
boxes=wait             boxes for which no answer is given stay open until one is, and each answer is for one box
mdi=NUMBER             result of an MDI line, 0 for success
request.N=NUMBER|never answer to request N, negative for failure, or none at all
var.N=NUMBER           G-code variable #N
tool.N.KIND=NUMBER     of tool N its length, diameter, xoffset or yoffset
dro.AXIS=NUMBER        display of axis x, y, z, a, b or c
resolution.AXIS=NUMBER counts per inch of an axis
cell.N=TEXT            text of the screen cell tied to UserData element N
setup=A,B,C,D          1 inch or 2 mm, tool, length index, diameter index
job=active             a job runs from the start
";

/// The letters of the axes that the PC shows.
pub(super) const LETTERS: [&str; 6] = ["x", "y", "z", "a", "b", "c"];
/// Buttons of a message box and their numbers.
const BUTTONS: [(&str, i32); 7] =
    [("ok", 1), ("cancel", 2), ("abort", 3), ("retry", 4), ("ignore", 5), ("yes", 6), ("no", 7)];
/// Kinds of entries of the tool table, by the request that reads them.
const TOOL_KINDS: [(&str, i32); 4] = [("length", 23), ("diameter", 30), ("xoffset", 32), ("yoffset", 34)];
/// Counts per inch of an axis without a setup.
const RESOLUTION: f32 = 1000.0;

/// An invalid setting.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AnswerError {
    /// There is no `=`.
    #[error("`{0}` is not `key=value`")]
    NotASetting(String),
    /// The key is not in [`HELP`].
    #[error(
        "there is no answer `{0}`; known: msgbox, input, boxes, mdi, request.N, var.N, tool.N.KIND, dro.AXIS, resolution.AXIS, cell.N, setup and job"
    )]
    UnknownKey(String),
    /// The value does not fit the key.
    #[error("`{value}` is not valid for `{key}`: {expected}")]
    BadValue {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// The expected form.
        expected: &'static str,
    },
}

/// Answers that are used in turn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AnswerQueue<T>(VecDeque<T>);

impl<T> Default for AnswerQueue<T> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

impl<T: Copy> AnswerQueue<T> {
    /// Returns whether no answer is left.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The next answer; the last one is repeated. `None` if there are no answers.
    pub(super) fn next(&mut self) -> Option<T> {
        if self.0.len() > 1 { self.0.pop_front() } else { self.0.front().copied() }
    }
}

/// The answers to message and input boxes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Boxes {
    pub(super) buttons: AnswerQueue<i32>,
    /// Numbers typed; `None` for the cancel button.
    pub(super) inputs: AnswerQueue<Option<f32>>,
    /// True if a box that has no answer waits for one, and each answer is for one box.
    pub(super) waits: bool,
}

impl Boxes {
    /// The button that is pressed next.
    pub(super) fn press(&mut self) -> Option<i32> {
        if self.waits { self.buttons.0.pop_front() } else { self.buttons.next() }
    }

    /// Returns the next input; `Some(None)` for the cancel button.
    pub(super) fn type_in(&mut self) -> Option<Option<f32>> {
        if self.waits { self.inputs.0.pop_front() } else { self.inputs.next() }
    }
}

/// The PC's answers and its variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers {
    pub(super) boxes: Boxes,
    pub(super) mdi: AnswerQueue<i32>,
    /// Answers to requests by number, which replace the requested action.
    pub(super) results: BTreeMap<i32, i32>,
    /// Requests that are never answered.
    pub(super) silent: BTreeSet<i32>,
    pub(super) variables: BTreeMap<i32, f64>,
    /// By kind, as the request that reads it, and tool.
    pub(super) tools: BTreeMap<(i32, i32), f64>,
    pub(super) dros: [f64; 6],
    pub(super) resolutions: [f32; 6],
    pub(super) cells: BTreeMap<i32, String>,
    pub(super) setup: [i32; 4],
    pub(super) has_job: bool,
}

impl Default for Answers {
    fn default() -> Self {
        Self {
            boxes: Boxes::default(),
            mdi: AnswerQueue::default(),
            results: BTreeMap::new(),
            silent: BTreeSet::new(),
            variables: BTreeMap::new(),
            tools: BTreeMap::new(),
            dros: [0.0; 6],
            resolutions: [RESOLUTION; 6],
            cells: BTreeMap::new(),
            setup: [1; 4],
            has_job: false,
        }
    }
}

impl Answers {
    /// Reads a line of settings, as a file has them: `#` begins a comment, an empty line is ignored.
    ///
    /// # Errors
    /// The error in the line.
    pub fn line(&mut self, line: &str) -> Result<(), AnswerError> {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') { Ok(()) } else { self.set(line) }
    }

    /// Takes one setting and makes its answer the next one, before all others.
    ///
    /// # Errors
    /// The error in the setting.
    pub fn set_next(&mut self, setting: &str) -> Result<(), AnswerError> {
        match setting.split('=').next().map(str::trim) {
            Some("msgbox" | "message_box") => self.boxes.buttons.0.clear(),
            Some("input") => self.boxes.inputs.0.clear(),
            Some("mdi") => self.mdi.0.clear(),
            _ => {}
        }
        self.set(setting)
    }

    /// Takes one setting, `key=value`.
    ///
    /// # Errors
    /// The error in the setting.
    pub fn set(&mut self, setting: &str) -> Result<(), AnswerError> {
        let (key, value) =
            setting.split_once('=').ok_or_else(|| AnswerError::NotASetting(setting.to_owned()))?;
        // Machine files call it `message_box`.
        let key = if key.trim() == "message_box" { "msgbox" } else { key.trim() };
        let value = value.trim();
        let bad = |expected| AnswerError::BadValue { key: key.to_owned(), value: value.to_owned(), expected };
        let real = || value.parse::<f64>().map_err(|_| bad("a number"));
        let whole = || value.parse::<i32>().map_err(|_| bad("a whole number"));
        let parts: Vec<&str> = key.split('.').collect();
        let unknown = || AnswerError::UnknownKey(key.to_owned());
        let number = |text: &str| text.parse::<i32>().map_err(|_| unknown());
        let axis = |text: &str| LETTERS.iter().position(|letter| *letter == text).ok_or_else(unknown);
        match parts[..] {
            ["msgbox"] => {
                self.boxes.buttons.0.push_back(button(value).ok_or_else(|| bad("a button, such as `yes`"))?);
            }
            ["input"] if value == "cancel" => self.boxes.inputs.0.push_back(None),
            ["input"] => self.boxes.inputs.0.push_back(Some(real()? as f32)),
            ["boxes"] if value == "wait" => self.boxes.waits = true,
            ["boxes"] => return Err(bad("`wait`")),
            ["mdi"] => self.mdi.0.push_back(whole()?),
            ["request", request] if value == "never" => {
                self.silent.insert(number(request)?);
            }
            ["request", request] => {
                let result = whole()?;
                if result > 0 {
                    return Err(bad("0, a negative number or `never`"));
                }
                self.results.insert(number(request)?, result);
            }
            ["var", variable] => {
                self.variables.insert(number(variable)?, real()?);
            }
            ["tool", tool, kind] => {
                let kind = TOOL_KINDS.iter().find(|(name, _)| *name == kind).ok_or_else(unknown)?;
                self.tools.insert((kind.1, number(tool)?), real()?);
            }
            ["dro", letter] => self.dros[axis(letter)?] = real()?,
            ["resolution", letter] => self.resolutions[axis(letter)?] = real()? as f32,
            ["cell", element] => {
                self.cells.insert(number(element)?, value.to_owned());
            }
            ["setup"] => {
                let numbers: Option<Vec<i32>> =
                    value.split(',').map(|part| part.trim().parse().ok()).collect();
                let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
                self.setup = numbers.ok_or_else(|| bad("four whole numbers, such as `1,3,3,3`"))?;
            }
            ["job"] if value == "active" => self.has_job = true,
            ["job"] => return Err(bad("`active`")),
            _ => return Err(unknown()),
        }
        Ok(())
    }
}

fn button(text: &str) -> Option<i32> {
    let named = BUTTONS.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
    named.map(|(_, number)| *number).or_else(|| text.parse().ok())
}

/// The name of a button, if it has one.
pub(super) fn button_name(number: i32) -> Option<&'static str> {
    BUTTONS.iter().find(|(_, other)| *other == number).map(|(name, _)| *name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_given_in_turn_and_the_last_one_repeats() {
        let mut answers = Answers::default();
        for line in ["# buttons", "", "msgbox = no", "msgbox=YES", "input=1.5", "input=cancel"] {
            answers.line(line).expect(line);
        }
        let pressed: Vec<_> = (0..3).map(|_| answers.boxes.buttons.next()).collect();
        assert_eq!(pressed, [Some(7), Some(6), Some(6)]);
        let typed: Vec<_> = (0..3).map(|_| answers.boxes.inputs.next()).collect();
        assert_eq!(typed, [Some(Some(1.5)), Some(None), Some(None)]);
        assert_eq!(answers.mdi.next(), None);
    }

    #[test]
    fn setting_the_next_answer_replaces_those_still_to_come() {
        let mut answers = Answers::default();
        answers.line("msgbox=no").expect("an answer");
        answers.set_next("msgbox=yes").expect("an answer");
        assert_eq!(answers.boxes.buttons.next(), Some(6));
    }

    #[test]
    fn wrong_answers_say_what_is_wrong() {
        for (setting, expect) in [
            ("msgbox", "`msgbox` is not `key=value`"),
            ("msgbox=maybe", "`maybe` is not valid for `msgbox`: a button, such as `yes`"),
            ("box=yes", "there is no answer `box`"),
            ("dro.q=1", "there is no answer `dro.q`"),
            ("tool.5.colour=1", "there is no answer `tool.5.colour`"),
            ("request.14=1", "0, a negative number or `never`"),
            ("setup=1,2", "four whole numbers"),
            ("var.x=1", "there is no answer `var.x`"),
            ("boxes=shut", "`shut` is not valid for `boxes`: `wait`"),
        ] {
            let error = Answers::default().set(setting).expect_err(setting).to_string();
            assert!(error.contains(expect), "{setting}: {error}");
        }
    }
}
