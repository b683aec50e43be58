//! Reads values of TOML, and reports errors with their location.

use kmotiondef::bits::BitDirection;
use kmotiondef::boards::TargetBoard;
use kmotiondef::{AxisId, Bit};
use strsim::levenshtein;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{KeyPlace, MachineFileError};

/// Something wrong at an offset of the text.
#[derive(Debug)]
pub(super) struct TextError {
    offset: usize,
    message: String,
}

impl TextError {
    pub(super) fn new(offset: usize, message: impl Into<String>) -> Self {
        Self { offset, message: message.into() }
    }

    /// The error with line and column.
    pub(super) fn in_text(self, text: &str) -> MachineFileError {
        let before = text.get(..self.offset).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        MachineFileError {
            line: line(text, self.offset),
            column: before[line_start..].chars().count() + 1,
            message: self.message,
        }
    }
}

pub(super) type ReadResult<T> = Result<T, TextError>;

/// The line of an offset, from 1.
fn line(text: &str, offset: usize) -> usize {
    text.get(..offset).unwrap_or(text).matches('\n').count() + 1
}

/// The text, and the board that the machine is for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    /// The text of a machine file; `None` of a key that an option sets.
    pub(super) text: Option<&'a str>,
    pub(super) board: &'static TargetBoard,
}

impl Source<'_> {
    fn place(self, offset: usize) -> KeyPlace {
        self.text.map_or(KeyPlace::Option, |text| KeyPlace::Line(line(text, offset)))
    }
}

/// A table, with its name for messages.
#[derive(Clone, Debug)]
pub(super) struct Table<'a> {
    pub(super) name: String,
    pub(super) offset: usize,
    entries: &'a DeTable<'a>,
    from: Source<'a>,
}

impl<'a> Table<'a> {
    pub(super) fn new(name: &str, offset: usize, entries: &'a DeTable<'a>, from: Source<'a>) -> Self {
        Self { name: name.to_owned(), offset, entries, from }
    }

    /// Returns its place.
    pub(super) fn place(&self) -> KeyPlace {
        self.from.place(self.offset)
    }

    /// The keys with their values.
    pub(super) fn entries(&self) -> impl Iterator<Item = (Key<'a>, Value<'a>)> {
        let (name, from) = (self.name.clone(), self.from);
        self.entries.iter().map(move |(key, value)| {
            let text = key.get_ref().as_ref();
            let path = if name.is_empty() { text.to_owned() } else { format!("{name}.{text}") };
            let key = Key { text, offset: key.span().start, table: name.clone(), from };
            (key, Value { path, source: value, from })
        })
    }

    pub(super) fn is_missing(&self, key: &str) -> TextError {
        TextError::new(self.offset, format!("`{}` needs `{key}`", self.name))
    }
}

/// A key.
#[derive(Clone, Debug)]
pub(super) struct Key<'a> {
    pub(super) text: &'a str,
    offset: usize,
    table: String,
    from: Source<'a>,
}

impl Key<'_> {
    /// Returns its place.
    pub(super) fn place(&self) -> KeyPlace {
        self.from.place(self.offset)
    }

    /// The error for a word that is not one of those `known`.
    pub(super) fn is_unknown(&self, known: &[&str]) -> TextError {
        let place = if self.table.is_empty() { String::new() } else { format!(" in `{}`", self.table) };
        let near = known.iter().min_by_key(|name| levenshtein(self.text, name));
        let hint = match near.filter(|name| levenshtein(self.text, name) <= 2) {
            Some(name) => format!("; did you mean `{name}`?"),
            None => format!("; known: {}", known.join(", ")),
        };
        TextError::new(self.offset, format!("unknown key `{}`{place}{hint}", self.text))
    }

    /// The axis it numbers.
    pub(super) fn axis(&self) -> ReadResult<AxisId> {
        let axes = self.from.board.axes;
        let number = self.text.parse().ok().and_then(|number| axes.get(number));
        let wrong = || format!("`{}` is not an axis (0-{})", self.text, axes.last());
        number.ok_or_else(|| TextError::new(self.offset, wrong()))
    }
}

/// A value, with the path of its key.
#[derive(Clone, Debug)]
pub(super) struct Value<'a> {
    pub(super) path: String,
    source: &'a Spanned<DeValue<'a>>,
    from: Source<'a>,
}

impl<'a> Value<'a> {
    pub(super) fn is_wrong(&self, expected: &str) -> TextError {
        let found = match self.source.get_ref() {
            DeValue::String(text) => format!("{text:?}"),
            DeValue::Integer(number) => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            DeValue::Boolean(flag) => flag.to_string(),
            DeValue::Array(values) if values.iter().any(|value| value.get_ref().is_table()) => {
                format!("`[[{}]]`", self.path)
            }
            other => format!("a value of type {}", other.type_str()),
        };
        TextError::new(self.source.span().start, format!("`{}` must be {expected}, not {found}", self.path))
    }

    /// Returns its offset in the text.
    pub(super) fn offset(&self) -> usize {
        self.source.span().start
    }

    /// The text of a word or number, unchanged.
    pub(super) fn raw_text(&self) -> String {
        match self.source.get_ref() {
            DeValue::String(text) => text.to_string(),
            DeValue::Boolean(flag) => flag.to_string(),
            DeValue::Integer(number) => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            other => other.type_str().to_owned(),
        }
    }

    fn parsed(&self) -> Option<f64> {
        match self.source.get_ref() {
            DeValue::Float(number) => number.as_str().replace('_', "").parse().ok(),
            DeValue::Integer(number) => {
                let digits = number.as_str().replace('_', "");
                i64::from_str_radix(&digits, number.radix()).ok().map(|number| number as f64)
            }
            _ => None,
        }
    }

    /// A number.
    pub(super) fn number(&self) -> ReadResult<f64> {
        self.parsed().filter(|number| number.is_finite()).ok_or_else(|| self.is_wrong("a number"))
    }

    /// A number above 0.
    pub(super) fn positive(&self) -> ReadResult<f64> {
        let number = self.parsed().filter(|number| number.is_finite() && *number > 0.0);
        number.ok_or_else(|| self.is_wrong("a number above 0"))
    }

    /// A number from 0.
    pub(super) fn not_negative(&self) -> ReadResult<f64> {
        let number = self.parsed().filter(|number| number.is_finite() && *number >= 0.0);
        number.ok_or_else(|| self.is_wrong("0 or a positive number"))
    }

    /// A whole number up to `max`.
    pub(super) fn unsigned(&self, max: u32) -> ReadResult<u32> {
        let number =
            self.parsed().filter(|number| number.fract() == 0.0 && (0.0..=f64::from(max)).contains(number));
        number
            .map(|number| number as u32)
            .ok_or_else(|| self.is_wrong(&format!("a whole number, 0 to {max}")))
    }

    /// `true` or `false`, or 1 or 0.
    pub(super) fn flag(&self) -> ReadResult<bool> {
        match (self.source.get_ref(), self.parsed()) {
            (DeValue::Boolean(flag), _) => Ok(*flag),
            (_, Some(number)) if number == 0.0 || number == 1.0 => Ok(number == 1.0),
            _ => Err(self.is_wrong("true or false")),
        }
    }

    /// A text.
    pub(super) fn text(&self) -> ReadResult<&'a str> {
        match self.source.get_ref() {
            DeValue::String(text) => Ok(text),
            _ => Err(self.is_wrong("a text in quotes")),
        }
    }

    /// One of some words.
    pub(super) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> ReadResult<T> {
        let word = match self.source.get_ref() {
            DeValue::String(text) => text.to_string(),
            DeValue::Boolean(flag) => flag.to_string(),
            _ => String::new(),
        };
        let names: Vec<String> = choices.iter().map(|(name, _)| format!("{name:?}")).collect();
        let found = choices.iter().find(|(name, _)| *name == word);
        found.map(|(_, choice)| *choice).ok_or_else(|| self.is_wrong(&names.join(" or ")))
    }

    /// The board that the machine is for.
    pub(super) const fn board(&self) -> &'static TargetBoard {
        self.from.board
    }

    /// An axis number.
    pub(super) fn axis(&self) -> ReadResult<AxisId> {
        let number = self
            .parsed()
            .filter(|number| number.fract() == 0.0)
            .and_then(|number| self.from.board.axes.get(number as i32));
        number.ok_or_else(|| self.is_wrong(&format!("an axis, 0 to {}", self.from.board.axes.last())))
    }

    /// A bit that can be driven from outside.
    pub(super) fn input(&self) -> ReadResult<Bit> {
        self.bit_that("an input", |direction| {
            matches!(direction, BitDirection::Input | BitDirection::Programmable)
        })
    }

    /// A bit that a program can drive.
    pub(super) fn output(&self) -> ReadResult<Bit> {
        self.bit_that("an output", |direction| direction != BitDirection::Input)
    }

    fn bit_that(&self, what: &str, goes: impl Fn(BitDirection) -> bool) -> ReadResult<Bit> {
        let number =
            self.parsed().filter(|number| number.fract() == 0.0).and_then(|number| Bit::new(number as i32));
        let bit = number.ok_or_else(|| self.is_wrong("a bit number, 0 to 2047"))?;
        match self.from.board.bit_range(bit) {
            Some(range) if goes(range.direction) => Ok(bit),
            Some(range) => {
                let text = format!("`{}` must be {what}, not bit {bit} ({})", self.path, range.name);
                Err(TextError::new(self.source.span().start, text))
            }
            None => Err(self.is_wrong("a bit that is connected to something")),
        }
    }

    /// An array.
    pub(super) fn array(&self) -> ReadResult<Vec<Value<'a>>> {
        match self.source.get_ref() {
            DeValue::Array(values) => Ok(values
                .iter()
                .enumerate()
                .map(|(index, source)| Value {
                    path: format!("{}[{index}]", self.path),
                    source,
                    from: self.from,
                })
                .collect()),
            _ => Err(self.is_wrong("an array in [brackets]")),
        }
    }

    /// A table.
    pub(super) fn table(&self) -> ReadResult<Table<'a>> {
        match self.source.get_ref() {
            DeValue::Table(entries) => {
                Ok(Table::new(&self.path, self.source.span().start, entries, self.from))
            }
            DeValue::Array(_) => Err(self.is_wrong(&format!("one table, `[{}]`", self.path))),
            _ => Err(self.is_wrong("a table")),
        }
    }

    /// A table of tables that have numbers as keys.
    pub(super) fn indexed_tables(&self) -> ReadResult<Table<'a>> {
        match self.source.get_ref() {
            DeValue::Table(_) => self.table(),
            _ => Err(self.is_wrong(&format!("tables with a number, such as `[{}.0]`", self.path))),
        }
    }

    /// The tables of `[[name]]`.
    pub(super) fn tables(&self) -> ReadResult<Vec<Table<'a>>> {
        self.array()?.iter().map(Value::table).collect()
    }
}

/// Reads the keys of a table: one arm a key; any other is an error that names them all.
macro_rules! keys {
    ($table:expr, |$key:ident, $value:ident| { $($name:literal => $body:expr;)+ }) => {
        for ($key, $value) in $table.entries() {
            match $key.text {
                $($name => $body,)+
                _ => return Err($key.is_unknown(&[$($name),+])),
            }
        }
    };
}
pub(super) use keys;
