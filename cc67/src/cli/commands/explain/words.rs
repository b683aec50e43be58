//! Words of other languages and boards, with their equivalents here.

use compiler::words::foreign;

/// The advice on a word.
pub(super) fn answer(name: &str) -> Option<String> {
    let advice = foreign::word(name).map(|word| word.advice);
    let of_type = || foreign::TYPES.iter().find(|(word, _)| *word == name).map(|(_, advice)| *advice);
    let advice = advice.or_else(of_type)?;
    Some(format!("# {name}\n\nThe board's C has no `{name}`: {advice}.\n"))
}
