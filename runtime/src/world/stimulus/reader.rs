//! Reads the tokens of a statement, word by word; an error gives its column and the expected token.

use kmotiondef::bits::{BitDirection, range_of};
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::{Axes, AxisId, Bit, Cycles, ThreadId};

use super::relation::Relation;
use super::tokens::{Mistake, Token, TokenKind};

/// Goes through the tokens of a statement.
pub(crate) struct StatementReader<'a> {
    pub(super) tokens: &'a [Token],
    /// The column after the last token.
    pub(super) behind: usize,
    /// The highest axis so far.
    pub(super) highest_axis: Option<AxisId>,
}

impl StatementReader<'_> {
    pub(crate) fn column(&self) -> usize {
        self.tokens.first().map_or(self.behind, |token| token.column)
    }

    /// The error that another token is expected here.
    pub(crate) fn expected<T>(&self, what: &str) -> Result<T, Mistake> {
        let found = match self.tokens.first().map(|token| &token.kind) {
            None => "the end of the statement".to_owned(),
            Some(TokenKind::Word(word)) => format!("`{word}`"),
            Some(TokenKind::Text(_)) => "a text".to_owned(),
            Some(TokenKind::Sign(sign)) => format!("`{sign}`"),
            Some(TokenKind::Semicolon) => "`;`".to_owned(),
        };
        let hint = self.peek().map_or("", hint);
        Err((self.column(), format!("expected {what}, found {found}{hint}")))
    }

    pub(crate) fn peek(&self) -> Option<&str> {
        match &self.tokens.first()?.kind {
            TokenKind::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The word this many tokens ahead; `None` after the end of the statement.
    pub(crate) fn word(&self, index: usize) -> Option<&str> {
        match self.tokens.get(index).map(|token| &token.kind)? {
            TokenKind::Word(word) => Some(word),
            TokenKind::Text(_) | TokenKind::Sign(_) | TokenKind::Semicolon => Some(""),
        }
    }

    pub(crate) fn advance(&mut self) {
        self.tokens = self.tokens.get(1..).unwrap_or_default();
    }

    /// Takes this word, if it comes next.
    pub(crate) fn accept(&mut self, word: &str) -> bool {
        let is_next = self.peek() == Some(word);
        if is_next {
            self.advance();
        }
        is_next
    }

    pub(crate) fn expect(&mut self, word: &str) -> Result<(), Mistake> {
        if self.accept(word) { Ok(()) } else { self.expected(&format!("`{word}`")) }
    }

    pub(crate) fn expect_equals(&mut self) -> Result<(), Mistake> {
        if self.accept_sign("=") { Ok(()) } else { self.expected("`=`") }
    }

    /// Takes this sign, if it comes next.
    pub(crate) fn accept_sign(&mut self, sign: &str) -> bool {
        let is_next =
            matches!(self.tokens.first(), Some(Token { kind: TokenKind::Sign(next), .. }) if *next == sign);
        if is_next {
            self.advance();
        }
        is_next
    }

    /// Reads a comparison operator.
    pub(crate) fn relation(&mut self) -> Result<Relation, Mistake> {
        let relations = [
            ("=", Relation::Equal),
            ("!=", Relation::Different),
            ("<=", Relation::LessOrEqual),
            (">=", Relation::GreaterOrEqual),
            ("<", Relation::Less),
            (">", Relation::Greater),
        ];
        match relations.into_iter().find(|(sign, _)| self.accept_sign(sign)) {
            Some((_, relation)) => Ok(relation),
            None => self.expected("`=`, `!=`, `<`, `<=`, `>` or `>=`"),
        }
    }

    /// The distance after `±`, which is optional.
    pub(crate) fn tolerance(&mut self) -> Result<f64, Mistake> {
        if !self.accept_sign("±") {
            return Ok(0.0);
        }
        self.take("a distance of 0 or more", |word| number(word).filter(|distance| *distance >= 0.0))
    }

    /// Returns whether a text in quotation marks comes next.
    pub(crate) fn is_at_text(&self) -> bool {
        matches!(self.tokens.first(), Some(Token { kind: TokenKind::Text(_), .. }))
    }

    /// Takes a word that `read` understands.
    pub(crate) fn take<T>(&mut self, what: &str, read: impl Fn(&str) -> Option<T>) -> Result<T, Mistake> {
        match self.peek().and_then(read) {
            Some(value) => {
                self.advance();
                Ok(value)
            }
            None => self.expected(what),
        }
    }

    pub(crate) fn number(&mut self, what: &str) -> Result<f64, Mistake> {
        self.take(what, number)
    }

    pub(crate) fn time(&mut self) -> Result<Cycles, Mistake> {
        self.take("a time such as 1.5s, 20ms or 90us", time)
    }

    pub(crate) fn text(&mut self) -> Result<Vec<u8>, Mistake> {
        let Some(TokenKind::Text(bytes)) = self.tokens.first().map(|token| token.kind.clone()) else {
            return self.expected("a text in \"…\"");
        };
        self.advance();
        Ok(bytes)
    }

    pub(crate) fn string(&mut self) -> Result<String, Mistake> {
        Ok(String::from_utf8_lossy(&self.text()?).into_owned())
    }

    pub(crate) fn level(&mut self) -> Result<bool, Mistake> {
        self.take("0 or 1", |word| match word {
            "0" => Some(false),
            "1" => Some(true),
            _ => None,
        })
    }

    /// A number that must refer to something that exists.
    pub(crate) fn index<T>(&mut self, what: &str, find: impl Fn(i32) -> Option<T>) -> Result<T, Mistake> {
        self.take(what, |word| find(word.parse().ok()?))
    }

    /// One of the numbers below `count`.
    pub(crate) fn below(&mut self, what: &str, count: usize) -> Result<usize, Mistake> {
        self.index(what, |index| usize::try_from(index).ok().filter(|&index| index < count))
    }

    /// A word of memory: an integer of 32 bits, or a float as `f:1.25`.
    pub(crate) fn word32(&mut self) -> Result<i32, Mistake> {
        self.take("an integer of 32 bits, or a float such as f:1.25", |word| match word.strip_prefix("f:") {
            Some(float) => Some((number(float)? as f32).to_bits().cast_signed()),
            None => integer(word),
        })
    }

    /// An axis of any board: the board of the run is known when the stimulus is resolved.
    pub(crate) fn axis(&mut self) -> Result<AxisId, Mistake> {
        let axis = self.index("the number of an axis", |number| Axes::new(Axes::MAX).get(number))?;
        self.highest_axis = self.highest_axis.max(Some(axis));
        Ok(axis)
    }

    pub(crate) fn thread(&mut self) -> Result<ThreadId, Mistake> {
        self.accept("thread");
        self.index("a thread from 1 to 7", ThreadId::new)
    }

    pub(crate) fn persist(&mut self) -> Result<usize, Mistake> {
        let last = N_USER_DATA_VARS as i32 - 1;
        self.below(&format!("an index from 0 to {last}"), last as usize + 1)
    }

    /// The number of a bit.
    pub(crate) fn bit(&mut self) -> Result<Bit, Mistake> {
        self.expect("bit")?;
        self.bit_number()
    }

    pub(crate) fn bit_number(&mut self) -> Result<Bit, Mistake> {
        self.index(&format!("a bit from 0 to {}", Bit::MAX), Bit::new)
    }

    /// A bit that the world can drive.
    pub(crate) fn input(&mut self) -> Result<Bit, Mistake> {
        self.expect("bit")?;
        self.input_number()
    }

    /// The number of a bit that the world can drive.
    pub(crate) fn input_number(&mut self) -> Result<Bit, Mistake> {
        let column = self.column();
        let bit = self.bit_number()?;
        let Some(range) = range_of(bit) else {
            return Err((column, format!("nothing is connected to bit {bit}")));
        };
        match range.direction {
            BitDirection::Output => {
                Err((column, format!("bit {bit} ({}) is an output, only the board drives it", range.name)))
            }
            BitDirection::Programmable | BitDirection::Input | BitDirection::Memory => Ok(bit),
        }
    }
}

/// The remedy where a word is out of place.
fn hint(word: &str) -> &'static str {
    match word {
        "at" | "when" | "every" => ": separate statements with `;`, or write each on its own line",
        "after" | "wait" | "sleep" | "delay" => {
            ": a statement begins with its time, as in `at 1s set bit 136`"
        }
        _ if word.starts_with('[') => ": this is a line of a machine file, which `--machine` reads",
        _ => "",
    }
}

/// A finite decimal number.
pub(crate) fn number(word: &str) -> Option<f64> {
    let starts = word.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '-' | '+' | '.'));
    word.parse().ok().filter(|number: &f64| starts && number.is_finite())
}

/// A decimal or hexadecimal integer.
pub(super) fn integer(word: &str) -> Option<i32> {
    match word.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok().map(u32::cast_signed),
        None => word.parse().ok(),
    }
}

/// The units of times, in seconds; a longer unit comes before its suffixes.
pub(super) const TIME_UNITS: [(&str, f64); 4] = [("us", 1e-6), ("µs", 1e-6), ("ms", 1e-3), ("s", 1.0)];

/// A time; a bare number is seconds.
pub(super) fn time(word: &str) -> Option<Cycles> {
    let (digits, unit) = TIME_UNITS
        .into_iter()
        .find_map(|(name, unit)| word.strip_suffix(name).map(|digits| (digits, unit)))
        .unwrap_or((word, 1.0));
    let seconds = number(digits)? * unit;
    let cycles = libm::round(seconds * Cycles::PER_SECOND.get() as f64);
    (seconds >= 0.0).then_some(Cycles::new(cycles as i64))
}
