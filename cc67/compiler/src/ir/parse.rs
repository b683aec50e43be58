//! Reads the text form of functions, see [`super::text`].
//!
//! Printed functions can be read back and print the same. A text is checked as a whole: every value has one class,
//! every block ends, every target exists, and finally [`verify`](super::verify) checks the result.

mod body;
mod cursor;
mod inst;

use std::collections::BTreeMap;

use cranelift_entity::PrimaryMap;

use super::function::{Function, Signatures};
use super::text::SymbolNames;
use crate::typed::SymbolId;
use body::Body;
use cursor::Cursor;

/// The functions of a text.
#[derive(Debug, Default)]
pub struct Functions {
    /// The functions, in the order of the text.
    pub functions: Vec<Function>,
    /// The signatures of the functions and of their callees.
    pub signatures: Signatures,
    /// The names that they mention.
    pub symbols: Symbols,
}

/// The symbols that a text mentions.
#[derive(Debug, Default)]
pub struct Symbols {
    names: PrimaryMap<SymbolId, String>,
    numbers: BTreeMap<String, SymbolId>,
}

impl Symbols {
    /// The symbol with a name, new if it was not mentioned before.
    fn intern(&mut self, name: &str) -> SymbolId {
        if let Some(symbol) = self.numbers.get(name) {
            return *symbol;
        }
        let symbol = self.names.push(name.to_owned());
        self.numbers.insert(name.to_owned(), symbol);
        symbol
    }
}

impl SymbolNames for Symbols {
    fn symbol_name(&self, symbol: SymbolId) -> &str {
        self.names.get(symbol).map_or("?", String::as_str)
    }
}

/// The error for a text that is not IR.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct ParseError {
    /// Number of the line, from 1.
    pub line: usize,
    /// The error.
    pub message: String,
}

/// Reads the functions of a text.
///
/// # Errors
/// The first line that is wrong.
pub fn parse(text: &str) -> Result<Functions, ParseError> {
    let mut unit = Functions::default();
    let mut open: Option<Body> = None;
    for (number, content) in (1..).zip(text.lines()) {
        let content = content.split(';').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let mut line = Cursor::new(content);
        let read = if line.keyword("function") {
            finish(&mut unit, open.take())?;
            Body::read_head(&mut line, number, &mut unit).map(|body| open = Some(body))
        } else if let Some(body) = &mut open {
            body.line(&mut line, number, &mut unit.symbols)
        } else {
            Err("a function begins with `function name(…)`".to_owned())
        };
        read.and_then(|()| line.expect_end()).map_err(|message| ParseError { line: number, message })?;
    }
    finish(&mut unit, open)?;
    Ok(unit)
}

/// Adds the function that was read.
fn finish(unit: &mut Functions, body: Option<Body>) -> Result<(), ParseError> {
    if let Some(body) = body {
        let function = body.finish(&mut unit.signatures)?;
        unit.functions.push(function);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
