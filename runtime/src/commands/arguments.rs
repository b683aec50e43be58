//! Arguments of script commands: their kinds, and how the board reads them.
//!
//! The rules, odd ones included, are those of the released firmware (host-protocol.md section 2): characters directly
//! after a number are ignored; only spaces separate arguments; a hexadecimal number also consumes the character after
//! it; a mistake is reported with the column where reading stopped.

use kmotiondef::{AxisId, Bit, ThreadId};

use crate::firmware::level::CommandSet;
use crate::text::{float_value, integer_prefix};

/// An argument of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Argument {
    /// A decimal integer within limits.
    Integer(i32, i32),
    /// A decimal integer within limits, the last of which is another one on a Kogna.
    Numbered(i32, i32, i32),
    /// A real number.
    Real,
    /// A real number within limits, which the board holds as singles.
    Limited(f32, f32),
    /// A hexadecimal number of 32 bits.
    Hex,
    /// A hexadecimal number that may be missing, together with all arguments after it.
    OptionalHex,
    /// An equals sign.
    Equals,
    /// An equals sign that may be omitted.
    OptionalEquals,
    /// An equals sign; when the command ends before it, the present value is requested.
    Assign,
    /// No argument: the current value is requested, and the board stops if anything follows.
    End,
}

/// A mistake in a line: the message, and where reading stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mistake {
    pub(super) column: usize,
    pub(super) message: Message,
}

/// The message about a mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Message {
    /// The first word is not a command.
    InvalidCommand,
    /// A number is missing or is none.
    Number,
    /// A number is out of its limits, which are named.
    Limits(String),
    /// A hexadecimal number is missing or is none.
    Hex,
    /// A data byte is above FF.
    Byte,
    /// The equals sign is missing.
    Equals,
}

impl Message {
    /// The board's words.
    pub(super) fn text(&self) -> String {
        match self {
            Self::InvalidCommand => "error, invalid command".to_owned(),
            Self::Number => "Error:Expecting Number".to_owned(),
            Self::Limits(limits) => format!("Error:Expecting value {limits}"),
            Self::Hex => "error, expecting value".to_owned(),
            Self::Byte => "error, expecting value 0 to FF".to_owned(),
            Self::Equals => "Error:Expecting \"=\"".to_owned(),
        }
    }
}

/// The integer at the beginning of a text, and its length in characters; a sign without digits is 0.
fn integer(text: &[u8]) -> (i32, usize) {
    let (value, used) = integer_prefix(text, 10);
    let sign = usize::from(matches!(text, [b'+' | b'-', ..]));
    (value as i32, used.max(sign))
}

/// A line being read.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineReader<'t> {
    text: &'t [u8],
    column: usize,
}

impl<'t> LineReader<'t> {
    /// Begins at a column.
    pub(super) const fn new(text: &'t [u8], column: usize) -> Self {
        Self { text, column }
    }

    fn remaining(&self) -> &'t [u8] {
        self.text.get(self.column..).unwrap_or_default()
    }

    /// Returns the reader with leading spaces skipped.
    fn behind_spaces(&self) -> Self {
        self.after_prefix(b" ")
    }

    fn after_prefix(&self, skipped: &[u8]) -> Self {
        let spaces = self.remaining().iter().take_while(|byte| skipped.contains(byte)).count();
        Self { column: self.column + spaces, ..*self }
    }

    /// Takes the characters of a number, converted by `read`, if there are any; returns its value.
    fn number<V>(&mut self, read: impl FnOnce(&[u8]) -> (V, usize)) -> Result<V, Mistake> {
        let mut next = self.after_prefix(b" \t");
        let (value, used) = read(next.remaining());
        if used == 0 {
            return Err(self.mistake(Message::Number));
        }
        next.column += used;
        *self = next;
        Ok(value)
    }

    fn mistake(&self, message: Message) -> Mistake {
        Mistake { column: self.column, message }
    }

    /// A decimal integer; 0 if there are no digits.
    fn integer(&mut self, lo: i32, hi: i32) -> Result<i32, Mistake> {
        let value = self.number(integer)?;
        if !(lo..=hi).contains(&value) {
            return Err(self.mistake(Message::Limits(format!("{lo} to {hi}"))));
        }
        Ok(value)
    }

    /// A real number; 0 if there are no digits.
    fn real(&mut self) -> Result<f64, Mistake> {
        self.number(float_value)
    }

    fn limited_number(&mut self, lo: f32, hi: f32) -> Result<f64, Mistake> {
        let value = self.real()?;
        if !(f64::from(lo)..=f64::from(hi)).contains(&value) {
            let limits = [lo, hi].map(super::numbers::limit);
            return Err(self.mistake(Message::Limits(limits.join(" to "))));
        }
        Ok(value)
    }

    /// A hexadecimal number, low 32 bits, and the character after it.
    pub(super) fn hex(&mut self) -> Result<u32, Mistake> {
        let mut next = self.behind_spaces();
        let is_negative = next.remaining().first() == Some(&b'-');
        next.column += usize::from(is_negative || next.remaining().first() == Some(&b'+'));
        let digits = next.remaining().iter().take_while(|byte| byte.is_ascii_hexdigit()).count();
        if digits == 0 {
            return Err(self.mistake(Message::Hex));
        }
        let value = next.remaining()[..digits]
            .iter()
            .fold(0_u32, |sum, &byte| (sum << 4) | char::from(byte).to_digit(16).unwrap_or(0));
        next.column = (next.column + digits + 1).min(next.text.len());
        *self = next;
        Ok(if is_negative { value.wrapping_neg() } else { value })
    }

    /// A data byte.
    pub(super) fn byte(&mut self) -> Result<u8, Mistake> {
        let value = self.hex()?;
        u8::try_from(value).map_err(|_| self.mistake(Message::Byte))
    }

    fn expect_equals(&mut self) -> Result<(), Mistake> {
        let mut next = self.behind_spaces();
        if next.remaining().first() != Some(&b'=') {
            return Err(next.mistake(Message::Equals));
        }
        next.column += 1;
        *self = next;
        Ok(())
    }

    fn is_at_end(&self) -> bool {
        self.behind_spaces().remaining().is_empty()
    }
}

/// One argument as it was read.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ArgumentValue {
    Integer(i32),
    Real(f64),
    Word(u32),
}

/// The arguments of a command, as many as there are.
///
/// The table gives the kinds of a command's arguments; a request for another kind, or for more arguments, yields 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Values {
    values: Vec<ArgumentValue>,
    is_question: bool,
}

impl Values {
    /// Reads the arguments that `arguments` lists.
    pub(super) fn read(
        arguments: &[Argument],
        set: CommandSet,
        reader: &mut LineReader<'_>,
    ) -> Result<Self, Mistake> {
        let mut read = Self::default();
        for argument in arguments {
            let value = match *argument {
                Argument::Numbered(lo, hi, of_kogna) => {
                    let hi = if set == CommandSet::Kogna { of_kogna } else { hi };
                    ArgumentValue::Integer(reader.integer(lo, hi)?)
                }
                Argument::Integer(lo, hi) => ArgumentValue::Integer(reader.integer(lo, hi)?),
                Argument::Real => ArgumentValue::Real(reader.real()?),
                Argument::Limited(lo, hi) => ArgumentValue::Real(reader.limited_number(lo, hi)?),
                Argument::OptionalHex if reader.is_at_end() => break,
                Argument::Hex | Argument::OptionalHex => ArgumentValue::Word(reader.hex()?),
                // A blank at the end is already too much.
                Argument::Assign | Argument::End if reader.remaining().is_empty() => {
                    read.is_question = true;
                    break;
                }
                Argument::End => break,
                Argument::Equals | Argument::Assign => {
                    reader.expect_equals()?;
                    continue;
                }
                Argument::OptionalEquals => {
                    // It may be missing.
                    let _ = reader.expect_equals();
                    continue;
                }
            };
            read.values.push(value);
        }
        Ok(read)
    }

    /// Returns whether the present value is requested.
    pub(super) const fn is_question(&self) -> bool {
        self.is_question
    }

    /// An integer.
    pub(super) fn integer(&self, index: usize) -> i32 {
        match self.values.get(index) {
            Some(ArgumentValue::Integer(value)) => *value,
            _ => 0,
        }
    }

    /// An integer that is not negative according to the table.
    pub(super) fn count(&self, index: usize) -> usize {
        usize::try_from(self.integer(index)).unwrap_or(0)
    }

    /// A real number; a hexadecimal one is the bits of a single.
    pub(super) fn real(&self, index: usize) -> f64 {
        match self.values.get(index) {
            Some(ArgumentValue::Real(value)) => *value,
            Some(ArgumentValue::Word(bits)) => f32::from_bits(*bits).into(),
            _ => 0.0,
        }
    }

    /// A real number as the board's singles hold it.
    pub(super) fn single(&self, index: usize) -> f32 {
        self.real(index) as f32
    }

    /// All real numbers as singles.
    pub(super) fn singles(&self) -> Vec<f32> {
        (0..self.values.len()).map(|index| self.single(index)).collect()
    }

    /// All integers.
    pub(super) fn integers(&self) -> Vec<i32> {
        (0..self.values.len()).map(|index| self.integer(index)).collect()
    }

    /// A hexadecimal number, if it is present.
    pub(super) fn optional_word(&self, index: usize) -> Option<u32> {
        match self.values.get(index) {
            Some(ArgumentValue::Word(value)) => Some(*value),
            _ => None,
        }
    }

    /// A hexadecimal number.
    pub(super) fn word(&self, index: usize) -> u32 {
        self.optional_word(index).unwrap_or(0)
    }

    /// The thread that the first argument names.
    pub(super) fn thread(&self) -> ThreadId {
        ThreadId::new(self.integer(0)).expect("the table limits it to threads")
    }

    /// The axis that the first argument names.
    pub(super) fn axis(&self) -> AxisId {
        AxisId::new(self.integer(0)).expect("the table limits it to axes")
    }

    /// The bit that the first argument names.
    pub(super) fn bit(&self) -> Bit {
        Bit::new(self.integer(0)).expect("the table limits it to bits")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the values that are read from a text, or the column and the message.
    fn check(arguments: &[Argument], text: &str, expect: Result<&[f64], (usize, &str)>) {
        let read = Values::read(arguments, CommandSet::First, &mut LineReader::new(text.as_bytes(), 0));
        let numbers = read.map(|read| {
            let number = |index| match read.values[index] {
                ArgumentValue::Integer(value) => value.into(),
                ArgumentValue::Real(value) => value,
                ArgumentValue::Word(value) => value.into(),
            };
            (0..read.values.len()).map(number).collect::<Vec<f64>>()
        });
        let expect = expect.map(<[f64]>::to_vec).map_err(|(column, text)| (column, text.to_owned()));
        assert_eq!(numbers.map_err(|mistake| (mistake.column, mistake.message.text())), expect, "{text:?}");
    }

    #[test]
    fn text_after_a_number_is_left_unread() {
        let thread = [Argument::Integer(1, 7)];
        check(&thread, "1.5", Ok(&[1.0]));
        check(&thread, " +1 junk", Ok(&[1.0]));
        check(&thread, " x", Err((0, "Error:Expecting Number")));
        check(&thread, " 8", Err((2, "Error:Expecting value 1 to 7")));
        check(&[Argument::Real; 2], "1E3 -.5", Ok(&[1000.0, -0.5]));
        check(&[Argument::Real; 2], "1,2", Err((1, "Error:Expecting Number")));
        check(&[Argument::Real; 2], "1.5.2 \t--1", Ok(&[1.5, 0.2]));
        check(&[Argument::Real; 2], "+-E5", Ok(&[0.0, 0.0]));
        check(&thread, "-", Err((1, "Error:Expecting value 1 to 7")));
        check(&thread, " .5", Err((0, "Error:Expecting Number")));
    }

    #[test]
    fn a_hexadecimal_number_consumes_the_next_character() {
        let words = [Argument::Hex; 2];
        check(&words, "0x12", Ok(&[0.0, 18.0]));
        check(&words, "123456789,-1", Ok(&[591_751_049.0, 4_294_967_295.0]));
        check(&words, "1 G", Err((2, "error, expecting value")));
        check(&words, "1", Err((1, "error, expecting value")));
    }

    #[test]
    fn an_assignment_without_a_value_is_a_query() {
        let arguments = [Argument::Integer(0, 7), Argument::Assign, Argument::Limited(0.0, 255.0)];
        check(&arguments, "0", Ok(&[0.0]));
        check(&arguments, "0 = 2", Ok(&[0.0, 2.0]));
        check(&arguments, "0 3", Err((2, "Error:Expecting \"=\"")));
        check(&arguments, "0=256", Err((5, "Error:Expecting value 0.000000 to 255.000000")));
        check(&[Argument::OptionalEquals, Argument::Real], " 3", Ok(&[3.0]));
    }
}
