//! Expectations: a value compared with another, a text on the console, the state of an axis or a thread.
//!
//! An expectation is checked at a moment, and reports the actual value. [`monitor`](super::monitor) watches
//! expectations that hold over a time.

use std::fmt;
use std::sync::Arc;

use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::PERSIST;
use kmotiondef::{Axes, AxisId, ThreadId};
use vm::scheduler::ThreadSet;

use super::reader::{StatementReader, integer, number};
use super::reading;
use super::relation::Relation;
use super::scene::Scene;
use super::tokens::Mistake;
use crate::text::legible;
use crate::views::TypedAccess;
use crate::world::trace::{Formula, Item, View};

/// A statement that a condition holds, or does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// The fact to examine.
    pub predicate: Predicate,
    /// The required outcome.
    pub sense: Sense,
}

/// The outcome that an expectation requires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// It should.
    Is,
    /// It should not.
    IsNot,
    /// It should not be so at any time.
    Never,
}

/// A fact about the board that holds or does not.
#[derive(Clone, Debug, PartialEq)]
pub enum Predicate {
    /// A value is in a relation to a number, or within a distance of it.
    Value {
        /// The value.
        subject: Subject,
        /// The relation.
        relation: Relation,
        /// The number.
        number: f64,
        /// The tolerance for equality.
        tolerance: f64,
    },
    /// The console output so far contains a line with the text.
    Printed(String),
    /// An axis is enabled, or disabled.
    Enabled(AxisId, bool),
    /// A thread is active, or not.
    Active(ThreadId, bool),
}

/// A value that expectations compare.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// An item of the board, and its name in statements.
    Item(Item, Arc<str>),
    /// An element of `persist.UserData`, or two.
    Persist(usize, UserDataFormat),
    /// A variable or an expression in the words of the programs.
    Expression(Expression),
}

/// The representation of a value in `persist.UserData`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UserDataFormat {
    /// An integer.
    Whole,
    /// A `float`.
    Single,
    /// A `double` in two elements.
    Double,
}

/// An expression, and its evaluator once code that knows the programs has [resolved](super::Stimulus::resolve) it.
#[derive(Clone, Debug)]
pub struct Expression {
    /// The text.
    pub text: Arc<str>,
    pub(super) formula: Option<Arc<dyn Formula>>,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

/// Values of an axis as statements call them, and the items that they are.
const OF_AXIS: &[(&str, &str)] =
    &[("position", "pos"), ("dest", "dest"), ("velocity", "vel"), ("output", "out"), ("load", "load")];

/// The facts about a board that expectations examine.
pub trait Facts {
    /// Returns a value; `None` if it is unknown.
    fn value(&self, subject: &Subject) -> Option<f64>;

    /// Returns whether the text that an expectation waits for was printed.
    fn has_printed(&self, text: &str) -> bool;

    /// Returns whether an axis is enabled.
    fn is_enabled(&self, axis: AxisId) -> bool;

    /// Returns whether a thread is active.
    fn is_active(&self, thread: ThreadId) -> bool;
}

/// The parts of a simulated board that expectations examine.
pub(super) struct ExpectationContext<'a> {
    pub(super) view: View<'a>,
    pub(super) threads: ThreadSet,
    /// True if the text of this expectation was printed.
    pub(super) is_printed: bool,
}

impl Facts for ExpectationContext<'_> {
    fn value(&self, subject: &Subject) -> Option<f64> {
        subject.value(&self.view)
    }

    fn has_printed(&self, _: &str) -> bool {
        self.is_printed
    }

    fn is_enabled(&self, axis: AxisId) -> bool {
        self.view.memory.axis(axis, Chan::ENABLE) != 0
    }

    fn is_active(&self, thread: ThreadId) -> bool {
        self.threads.contains(thread)
    }
}

/// The result of an examination.
#[derive(Clone, Debug, PartialEq)]
pub struct Examination {
    /// True if the expectation is met.
    pub is_met: bool,
    /// The actual and the expected value, as text.
    pub text: String,
}

impl Expectation {
    /// Examines the facts of an instant.
    pub fn look(&self, facts: &impl Facts) -> Examination {
        let is_wanted = self.sense == Sense::Is;
        let (holds, was) = match &self.predicate {
            Predicate::Value { subject, relation, number, tolerance } => match facts.value(subject) {
                Some(value) => {
                    let holds = relation.holds(value, *number, *tolerance);
                    (holds, format!("{subject} is {}", legible(value)))
                }
                // It is not met in either case.
                None => (!is_wanted, format!("{subject} has no value here")),
            },
            Predicate::Printed(text) => {
                let has_printed = facts.has_printed(text);
                let who = if has_printed { "a" } else { "no" };
                (has_printed, format!("{who} line contains \"{text}\""))
            }
            Predicate::Enabled(axis, expected) => {
                let is_enabled = facts.is_enabled(*axis);
                let state = if is_enabled { "enabled" } else { "disabled" };
                (is_enabled == *expected, format!("axis {axis} is {state}"))
            }
            Predicate::Active(thread, expected) => {
                let is_active = facts.is_active(*thread);
                let state = if is_active { "active" } else { "not active" };
                (is_active == *expected, format!("thread {thread} is {state}"))
            }
        };
        let is_met = holds == is_wanted;
        let hint = || reading::hint(self, |subject| facts.value(subject)).unwrap_or_default();
        let hint = if is_met { String::new() } else { hint() };
        Examination { is_met, text: format!("{was}, expected {}{hint}", self.expected()) }
    }

    /// Returns the words that follow "expected" in messages.
    fn expected(&self) -> String {
        let what = match &self.predicate {
            Predicate::Value { relation: Relation::Equal, number, tolerance, .. } => match tolerance {
                0.0 => number.to_string(),
                tolerance => format!("{number} ± {tolerance}"),
            },
            Predicate::Value { relation, number, .. } => format!("{} {number}", relation.sign()),
            Predicate::Printed(_) => {
                return match self.sense {
                    Sense::Is => "one".to_owned(),
                    Sense::IsNot | Sense::Never => "none".to_owned(),
                };
            }
            Predicate::Enabled(_, true) => "enabled".to_owned(),
            Predicate::Enabled(_, false) => "disabled".to_owned(),
            Predicate::Active(_, true) => "active".to_owned(),
            Predicate::Active(_, false) => "ended".to_owned(),
        };
        match self.sense {
            Sense::Is => what,
            Sense::IsNot => format!("not {what}"),
            Sense::Never => format!("never {what}"),
        }
    }

    /// The text that it waits for on the console.
    pub(super) fn printed(&self) -> Option<&str> {
        match &self.predicate {
            Predicate::Printed(text) => Some(text),
            Predicate::Value { .. } | Predicate::Enabled(..) | Predicate::Active(..) => None,
        }
    }

    /// Its expression, if it has one.
    pub(super) fn expression(&mut self) -> Option<&mut Expression> {
        match &mut self.predicate {
            Predicate::Value { subject: Subject::Expression(expression), .. } => Some(expression),
            Predicate::Value { .. }
            | Predicate::Printed(_)
            | Predicate::Enabled(..)
            | Predicate::Active(..) => None,
        }
    }
}

impl fmt::Display for Expectation {
    /// As a statement has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.sense != Sense::Is {
            f.write_str("not ")?;
        }
        match &self.predicate {
            Predicate::Value { subject, relation, number, .. } => {
                write!(f, "{subject} {} {number}", relation.sign())
            }
            Predicate::Printed(text) => write!(f, "printed \"{text}\""),
            Predicate::Enabled(axis, true) => write!(f, "axis {axis} enabled"),
            Predicate::Enabled(axis, false) => write!(f, "axis {axis} disabled"),
            Predicate::Active(thread, true) => write!(f, "thread {thread} active"),
            Predicate::Active(thread, false) => write!(f, "thread {thread} ended"),
        }
    }
}

impl Subject {
    /// Its value; `None` for an expression that has not been resolved.
    pub(super) fn value(&self, view: &View<'_>) -> Option<f64> {
        let user_data = PERSIST.field(Persist::USER_DATA);
        let word = |index| view.memory.get(user_data.element(index)).cast_unsigned();
        match self {
            Self::Item(item, _) => Some(view.item(*item)),
            Self::Persist(index, UserDataFormat::Whole) => Some(f64::from(word(*index).cast_signed())),
            Self::Persist(index, UserDataFormat::Single) => Some(f64::from(f32::from_bits(word(*index)))),
            Self::Persist(index, UserDataFormat::Double) => {
                let (low, high) = (u64::from(word(*index)), u64::from(word(*index + 1)));
                Some(f64::from_bits(high << 32 | low))
            }
            Self::Expression(expression) => Some(expression.formula.as_ref()?.value(view)),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Item(_, name) => f.write_str(name),
            Self::Persist(index, _) => write!(f, "persist {index}"),
            Self::Expression(expression) => f.write_str(&expression.text),
        }
    }
}

/// The action `expect`.
pub(super) fn read(reader: &mut StatementReader<'_>) -> Result<(Expectation,), Mistake> {
    Ok((expectation(reader)?,))
}

/// Reads an expectation; `not` negates it.
pub(super) fn expectation(reader: &mut StatementReader<'_>) -> Result<Expectation, Mistake> {
    let sense = if reader.accept("not") { Sense::IsNot } else { Sense::Is };
    Ok(Expectation { predicate: predicate(reader)?, sense })
}

/// Reads an expectation that must not be so at any time.
pub(super) fn never(reader: &mut StatementReader<'_>) -> Result<Expectation, Mistake> {
    Ok(Expectation { predicate: predicate(reader)?, sense: Sense::Never })
}

/// Checks a statement in the place that knows the printed text.
pub(super) fn check(scene: &mut Scene<'_, '_, '_>, _: Expectation) {
    scene.is_checked = true;
}

fn predicate(reader: &mut StatementReader<'_>) -> Result<Predicate, Mistake> {
    if reader.is_at_text() {
        let text = reader.string()?;
        return parse_comparison(reader, expression(&text));
    }
    let word = reader.peek().unwrap_or_default().to_owned();
    if word.is_empty() {
        return reader.expected(
            "`axis`, `bit`, `printed`, `not printed`, `persist`, `thread`, a variable or an expression in \"…\"",
        );
    }
    match word.as_str() {
        "printed" => {
            reader.advance();
            reader.string().map(Predicate::Printed)
        }
        "thread" => thread(reader),
        "axis" => axis(reader),
        "persist" => persist(reader),
        "bit" => {
            let bit = reader.bit()?;
            let item = Item::new(&format!("bit{bit}")).expect("every bit is an item");
            reader.expect_equals()?;
            let level = reader.level()?;
            let subject = Subject::Item(item, format!("bit {bit}").into());
            let number = f64::from(u8::from(level));
            Ok(Predicate::Value { subject, relation: Relation::Equal, number, tolerance: 0.0 })
        }
        _ => {
            let subject = match Item::new(&word) {
                Ok(item) => Subject::Item(item, word.as_str().into()),
                Err(_) => expression(&word),
            };
            reader.advance();
            parse_comparison(reader, subject)
        }
    }
}

fn expression(text: &str) -> Subject {
    Subject::Expression(Expression { text: text.into(), formula: None })
}

fn thread(reader: &mut StatementReader<'_>) -> Result<Predicate, Mistake> {
    let thread = reader.thread()?;
    reader.take("`active` or `ended`", |word| match word {
        "active" | "running" => Some(Predicate::Active(thread, true)),
        "ended" => Some(Predicate::Active(thread, false)),
        _ => None,
    })
}

fn axis(reader: &mut StatementReader<'_>) -> Result<Predicate, Mistake> {
    reader.advance();
    let axis = reader.axis()?;
    for (word, is_enabled) in [("enabled", true), ("disabled", false)] {
        if reader.accept(word) {
            return Ok(Predicate::Enabled(axis, is_enabled));
        }
    }
    let what = "`position`, `dest`, `velocity`, `output`, `load`, `enabled` or `disabled`";
    let (name, kind) = reader.take(what, |word| OF_AXIS.iter().find(|(name, _)| *name == word).copied())?;
    let item = Item::among(Axes::new(Axes::MAX), &format!("{kind}{axis}")).expect("every axis has it");
    parse_comparison(reader, Subject::Item(item, format!("axis {axis} {name}").into()))
}

/// An element is read in the form of the number with which it is compared.
fn persist(reader: &mut StatementReader<'_>) -> Result<Predicate, Mistake> {
    reader.advance();
    let index = reader.persist()?;
    let relation = reader.relation()?;
    let last_double = kmotiondef::limits::N_USER_DATA_VARS - 2;
    let what = "an integer, a float such as f:1.25, or a double such as d:1.25";
    let (stored, number) = reader.take(what, |word| match word.split_once(':') {
        Some(("f", float)) => Some((UserDataFormat::Single, f64::from(number(float)? as f32))),
        Some(("d", double)) if index <= last_double => Some((UserDataFormat::Double, number(double)?)),
        Some(_) => None,
        None => Some((UserDataFormat::Whole, f64::from(integer(word)?))),
    })?;
    let tolerance = reader.tolerance()?;
    Ok(Predicate::Value { subject: Subject::Persist(index, stored), relation, number, tolerance })
}

/// Reads a relation, a number, and possibly a tolerance for an equal value.
fn parse_comparison(reader: &mut StatementReader<'_>, subject: Subject) -> Result<Predicate, Mistake> {
    let relation = reader.relation()?;
    let number = reader.take("a number", |word| number(word).or_else(|| integer(word).map(f64::from)))?;
    let tolerance = reader.tolerance()?;
    Ok(Predicate::Value { subject, relation, number, tolerance })
}
