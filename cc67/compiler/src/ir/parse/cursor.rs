//! One line of the text, read from left to right.
//!
//! A word ends at white space or at one of the characters `, ( ) [ ] = :`.

use cranelift_entity::EntityRef;

use super::super::inst::Class;

/// The largest number of a value, slot or block: a text of a few bytes takes no gigabytes to hold.
const LARGEST_NUMBER: u32 = 1 << 20;

/// The rest of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    rest: &'a str,
}

impl<'a> Cursor<'a> {
    /// A line without its comment.
    pub(super) const fn new(rest: &'a str) -> Self {
        Self { rest }
    }

    /// Takes `text` if it comes next; reports whether it did.
    pub(super) fn eat(&mut self, text: &str) -> bool {
        match self.rest.trim_start().strip_prefix(text) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    /// Takes `word` if it is the next word; reports whether it was.
    pub(super) fn keyword(&mut self, word: &str) -> bool {
        let mut ahead = *self;
        let is_next = ahead.word().is_ok_and(|found| found == word);
        if is_next {
            *self = ahead;
        }
        is_next
    }

    /// Reads `text`.
    pub(super) fn expect(&mut self, text: &str) -> Result<(), String> {
        if self.eat(text) { Ok(()) } else { Err(self.unexpected_text(&format!("`{text}`"))) }
    }

    /// Reads a word.
    pub(super) fn word(&mut self) -> Result<&'a str, String> {
        let rest = self.rest.trim_start();
        let ends = |c: char| c.is_whitespace() || ",()[]=:".contains(c);
        let (word, rest) = rest.split_at(rest.find(ends).unwrap_or(rest.len()));
        if word.is_empty() {
            return Err(self.unexpected_text("a word"));
        }
        self.rest = rest;
        Ok(word)
    }

    /// Reads an entity such as `block3`.
    pub(super) fn entity<E: EntityRef>(&mut self, prefix: &str) -> Result<E, String> {
        let word = self.word()?;
        number(word, prefix)?.ok_or_else(|| format!("`{prefix}0` or the like is expected, not `{word}`"))
    }

    /// Reads the name of a class.
    pub(super) fn class(&mut self) -> Result<Class, String> {
        let word = self.word()?;
        Class::from_name(word).ok_or_else(|| format!("there is no class `{word}`"))
    }

    /// Reads an unsigned number.
    pub(super) fn count(&mut self) -> Result<u32, String> {
        let word = self.word()?;
        word.parse().map_err(|_| format!("a number is expected, not `{word}`"))
    }

    /// Takes ` + 4` or ` - 4` if it comes next; returns 0 if not.
    pub(super) fn offset(&mut self) -> Result<i32, String> {
        let is_negative = if self.eat("+ ") {
            false
        } else if self.eat("- ") {
            true
        } else {
            return Ok(0);
        };
        let size = i64::from(self.count()?);
        let offset = if is_negative { -size } else { size };
        i32::try_from(offset).map_err(|_| format!("{offset} is out of range"))
    }

    /// Fails unless the line has been read to its end.
    pub(super) fn expect_end(self) -> Result<(), String> {
        if self.rest.trim().is_empty() { Ok(()) } else { Err(self.unexpected_text("the end of the line")) }
    }

    fn unexpected_text(self, expected: &str) -> String {
        match self.rest.trim() {
            "" => format!("{expected} is expected at the end"),
            rest => format!("{expected} is expected before `{rest}`"),
        }
    }
}

/// The entity that a word such as `v3` names; `None` if it names none with this prefix.
pub(super) fn number<E: EntityRef>(word: &str, prefix: &str) -> Result<Option<E>, String> {
    let Some(digits) = word.strip_prefix(prefix) else { return Ok(None) };
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Ok(None);
    }
    match digits.parse::<u32>() {
        Ok(number) if number <= LARGEST_NUMBER => Ok(Some(E::new(number as usize))),
        _ => Err(format!("the number of `{word}` is too large")),
    }
}
