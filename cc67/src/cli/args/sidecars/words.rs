//! Splits a line into words like a shell: both kinds of quotes, and backslash escapes.

use anyhow::{Result, bail};

/// Parts a line into words.
///
/// # Errors
/// A quote that is not closed.
pub(super) fn split(line: &str) -> Result<Vec<String>> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut characters = line.chars();
    while let Some(character) = characters.next() {
        match character {
            '\'' | '"' => quoted_part(character, &mut characters, word.get_or_insert_default())?,
            '\\' => word.get_or_insert_default().extend(characters.next()),
            _ if character.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(character),
        }
    }
    words.extend(word);
    Ok(words)
}

/// The rest of a part in quotes; within double ones a backslash goes before a quote, a dollar sign or a backslash.
fn quoted_part(quote: char, characters: &mut std::str::Chars<'_>, word: &mut String) -> Result<()> {
    loop {
        match characters.next() {
            None => bail!("a {quote} is not closed"),
            Some(character) if character == quote => return Ok(()),
            Some('\\') if quote == '"' => match characters.next() {
                Some(character @ ('"' | '\\' | '$')) => word.push(character),
                Some(character) => word.extend(['\\', character]),
                None => bail!("a {quote} is not closed"),
            },
            Some(character) => word.push(character),
        }
    }
}

/// A word as one types it.
pub(super) fn quoted(word: &str) -> String {
    let is_plain = |character: char| character.is_ascii_alphanumeric() || "-_./:,=+@%".contains(character);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    let escaped: String = word
        .chars()
        .flat_map(|c| matches!(c, '"' | '\\' | '$').then_some('\\').into_iter().chain([c]))
        .collect();
    format!("\"{escaped}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_as_in_a_shell() {
        for (line, expect) in [
            ("--for 2  --time", &["--for", "2", "--time"][..]),
            ("--stim \"at 1s bit 8 = 1\" x", &["--stim", "at 1s bit 8 = 1", "x"]),
            ("--stim='once printed \"go\" uart \"a\\r\"'", &["--stim=once printed \"go\" uart \"a\\r\""]),
            ("\"a\\\"b\\r\" c\\ d ''", &["a\"b\\r", "c d", ""]),
        ] {
            assert_eq!(split(line).expect(line), expect);
            let again: Vec<_> = expect.iter().map(|word| quoted(word)).collect();
            assert_eq!(split(&again.join(" ")).expect(line), expect);
        }
        assert_eq!(split("a \"b").expect_err("it is open").to_string(), "a \" is not closed");
    }
}
