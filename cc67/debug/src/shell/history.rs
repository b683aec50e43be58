//! Values that were shown, and convenience variables, by their names in expressions: `$3`, `$`, `$$2`, `$count`.

use std::collections::BTreeMap;

use crate::debugger::{DebugError, ShownVariable};

/// A value that was shown.
#[derive(Clone, Debug)]
pub(crate) struct KeptValue {
    /// Its text.
    pub(crate) text: String,
    /// Its C expression, if there is one.
    literal: Option<String>,
}

impl KeptValue {
    /// The value of a variable that was never set.
    fn void() -> Self {
        Self { text: "void".to_owned(), literal: None }
    }

    /// A value as it was shown.
    pub(crate) fn of(shown: &ShownVariable) -> Self {
        Self { text: format!("{}{}", shown.cast, shown.text), literal: shown.literal.clone() }
    }
}

/// The values that were shown, and the debugger's variables.
#[derive(Debug, Default)]
pub(crate) struct ShownValues {
    values: Vec<KeptValue>,
    variables: BTreeMap<String, KeptValue>,
}

impl ShownValues {
    /// Keeps a value; returns its number, counted from 1.
    pub(crate) fn keep(&mut self, value: KeptValue) -> usize {
        self.values.push(value);
        self.values.len()
    }

    /// Forgets the last value.
    pub(crate) fn drop_last(&mut self) {
        self.values.pop();
    }

    /// Gives a variable a value; `name` is without its `$`.
    pub(crate) fn set(&mut self, name: &str, value: KeptValue) {
        self.variables.insert(name.to_owned(), value);
    }

    /// The value of an expression that consists only of such a name.
    ///
    /// # Errors
    /// There is no such value.
    pub(crate) fn value_by_name(&self, expression: &str) -> Result<Option<KeptValue>, DebugError> {
        let Some(word) = expression.trim().strip_prefix('$') else { return Ok(None) };
        let rest = word.strip_prefix('$').unwrap_or(word);
        let is_word = rest.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !is_word || rest == "pc" { Ok(None) } else { self.value(word).map(Some) }
    }

    /// The value of a word without its first `$`.
    fn value(&self, word: &str) -> Result<KeptValue, DebugError> {
        let count = self.values.len();
        let back = match word.strip_prefix('$') {
            Some("") => Some(1),
            Some(number) => number.parse().ok(),
            None if word.is_empty() => Some(0),
            None => None,
        };
        if let Some(back) = back {
            if count == 0 {
                return Ok(KeptValue::void());
            }
            let index = (count - 1).checked_sub(back);
            let found = index.and_then(|index| self.values.get(index));
            return found.cloned().ok_or_else(|| format!("History does not go back to $${back}.").into());
        }
        if let Ok(number) = word.parse::<usize>() {
            let found = number.checked_sub(1).and_then(|index| self.values.get(index));
            return found.cloned().ok_or_else(|| format!("History has not yet reached ${number}.").into());
        }
        Ok(self.variables.get(word).cloned().unwrap_or_else(KeptValue::void))
    }

    /// An expression with the names replaced by their values; `pc` is the address of the present instruction.
    ///
    /// # Errors
    /// There is no such value, or C has no notation for it.
    pub(crate) fn replaced(&self, expression: &str, pc: Option<u32>) -> Result<String, DebugError> {
        let mut out = String::new();
        let mut quote = None;
        let mut letters = expression.char_indices().peekable();
        while let Some((at, letter)) = letters.next() {
            match quote {
                Some(_) if letter == '\\' => {
                    out.push(letter);
                    out.extend(letters.next().map(|(_, next)| next));
                    continue;
                }
                Some(mark) if letter == mark => quote = None,
                None if letter == '"' || letter == '\'' => quote = Some(letter),
                None if letter == '$' => {
                    let rest = &expression[at + 1..];
                    let marks = usize::from(rest.starts_with('$'));
                    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
                    let length = marks + rest[marks..].chars().take_while(|c| is_part(*c)).count();
                    let word = &rest[..length];
                    for _ in 0..length {
                        letters.next();
                    }
                    out.push_str(&self.literal(word, pc)?);
                    continue;
                }
                _ => {}
            }
            out.push(letter);
        }
        Ok(out)
    }

    fn literal(&self, word: &str, pc: Option<u32>) -> Result<String, DebugError> {
        if word == "pc" {
            return Ok(format!("((void (*)()){:#x})", pc.ok_or("No registers.")?));
        }
        let value = self.value(word)?;
        value
            .literal
            .ok_or_else(|| format!("`${word}` is {}, which an expression cannot use", value.text).into())
    }
}

/// The place and the count of `PLACE@COUNT`.
pub(crate) fn extension(expression: &str) -> Option<(&str, &str)> {
    let (mut depth, mut quote, mut found) = (0_i32, None, None);
    for (at, letter) in expression.char_indices() {
        match (quote, letter) {
            (Some(mark), _) if mark == letter => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '(' | '[') => depth += 1,
            (None, ')' | ']') => depth -= 1,
            (None, '@') if depth == 0 => found = Some(at),
            _ => {}
        }
    }
    found.map(|at| (expression[..at].trim(), expression[at + 1..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history() -> ShownValues {
        let mut history = ShownValues::default();
        for number in [10, 20] {
            history.keep(KeptValue { text: number.to_string(), literal: Some(format!("((int){number})")) });
        }
        history.keep(KeptValue { text: "{...}".to_owned(), literal: None });
        history.set("k", KeptValue { text: "7".to_owned(), literal: Some("((int)7)".to_owned()) });
        history
    }

    #[test]
    fn values_are_named_as_in_gdb() {
        let history = history();
        for (text, expect) in [
            ("$1 + n", Ok("((int)10) + n")),
            ("$$ * $k", Ok("((int)20) * ((int)7)")),
            ("$$2", Ok("((int)10)")),
            ("f(\"$1\", '$')", Ok("f(\"$1\", '$')")),
            ("$pc", Ok("((void (*)())0x80050000)")),
            ("$9", Err("History has not yet reached $9.")),
            ("$$9", Err("History does not go back to $$9.")),
            ("$ + 1", Err("`$` is {...}, which an expression cannot use")),
            ("$none + 1", Err("`$none` is void, which an expression cannot use")),
        ] {
            let found = history.replaced(text, Some(0x8005_0000));
            assert_eq!(found, expect.map(str::to_owned).map_err(DebugError::from), "{text}");
        }
        let alone = |text| history.value_by_name(text).expect(text).map(|value| value.text);
        assert_eq!(alone("$ "), Some("{...}".to_owned()));
        assert_eq!(alone("$none"), Some("void".to_owned()));
        assert_eq!(alone("$1 + 1"), None);
    }

    #[test]
    fn places_are_extended_outside_of_brackets() {
        assert_eq!(extension("table[0]@4"), Some(("table[0]", "4")));
        assert_eq!(extension("f(a@2)"), None);
        assert_eq!(extension("'@'"), None);
    }
}
