//! `place = value` and its short forms in C: `n += 1`, `n++`.

/// An assignment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Assignment {
    /// The place.
    pub(crate) place: String,
    /// Its new value, an expression.
    pub(crate) value: String,
    /// True if its result is the old value: `n++`.
    pub(crate) is_postfix: bool,
}

impl Assignment {
    /// Parses a text as an assignment; `None` for an expression that is not one.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let text = text.trim();
        for (sign, operator) in [("++", '+'), ("--", '-')] {
            let (prefix, postfix) = (text.strip_prefix(sign), text.strip_suffix(sign));
            if let Some(place) = prefix.or(postfix).map(str::trim).filter(|place| !place.is_empty()) {
                let value = format!("({place}) {operator} 1");
                return Some(Self { place: place.to_owned(), value, is_postfix: prefix.is_none() });
            }
        }
        let at = sign_of(text)?;
        let (before, value) = (&text[..at], text[at + 1..].trim());
        let place = before.trim_end_matches(['+', '-', '*', '/', '%', '&', '|', '^', '<', '>']);
        let operator = &before[place.len()..];
        let place = place.trim().to_owned();
        let value =
            if operator.is_empty() { value.to_owned() } else { format!("({place}) {operator} ({value})") };
        (!place.is_empty()).then_some(Self { place, value, is_postfix: false })
    }
}

/// The position of the `=` of an assignment outside brackets and quotation marks.
fn sign_of(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut quote) = (0_u32, None);
    for (at, &byte) in bytes.iter().enumerate() {
        let before = |back: usize| at.checked_sub(back).and_then(|index| bytes.get(index)).copied();
        match (quote, byte) {
            (Some(mark), _) if byte == mark && before(1) != Some(b'\\') => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'(' | b'[') => depth += 1,
            (None, b')' | b']') => depth = depth.saturating_sub(1),
            (None, b'=') if depth == 0 => {
                let is_comparison = match before(1) {
                    Some(b'=' | b'!') => true,
                    // `<=` compares, `<<=` shifts.
                    Some(sign @ (b'<' | b'>')) => before(2) != Some(sign),
                    _ => bytes.get(at + 1) == Some(&b'='),
                };
                if !is_comparison {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_are_told_from_comparisons() {
        for (text, expect) in [
            ("n = 5", Some(("n", "5", false))),
            ("a[b == 1] = c >= 2", Some(("a[b == 1]", "c >= 2", false))),
            ("n += m + 1", Some(("n", "(n) + (m + 1)", false))),
            ("n <<= 2", Some(("n", "(n) << (2)", false))),
            ("p->x |= 4", Some(("p->x", "(p->x) | (4)", false))),
            ("n++", Some(("n", "(n) + 1", true))),
            ("--n", Some(("n", "(n) - 1", false))),
            ("c = '='", Some(("c", "'='", false))),
            ("n == 5", None),
            ("n != 5", None),
            ("a <= b", None),
            ("a >= b", None),
            ("f(a = 1)", None),
            ("n", None),
            ("a + + b", None),
        ] {
            let found = Assignment::of(text);
            let found = found.as_ref().map(|it| (it.place.as_str(), it.value.as_str(), it.is_postfix));
            assert_eq!(found, expect, "{text}");
        }
    }
}
