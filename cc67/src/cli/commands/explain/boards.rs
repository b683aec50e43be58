//! The boards with a name: a line for names that not all boards have, an answer for names that only other boards have.

use std::fmt::Write as _;

use kmotiondef::boards::{TargetBoard, boards};
use kmotiondef::firmware::row_named;
use kmotiondef::variables::variable_named;

/// The boards whose firmware has a name and those whose firmware lacks it, as a line of a list; empty if all boards are
/// alike.
pub(super) fn line(name: &str) -> String {
    let (with, without): (Vec<&TargetBoard>, Vec<&TargetBoard>) = boards().partition(|board| board.has(name));
    if with.is_empty() || without.is_empty() {
        return String::new();
    }
    let names =
        |boards: Vec<&TargetBoard>| boards.iter().map(|board| board.name).collect::<Vec<_>>().join(", ");
    format!("- Boards with it: {}. Boards without: {}.\n", names(with), names(without))
}

/// The answer for a name that the default board does not have.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let board = boards().skip(1).find(|board| board.names().any(is_meant))?;
    let name = board.names().find(|name| is_meant(name))?;
    if row_named(name).is_some() || variable_named(name).is_some() {
        return None;
    }
    let declaration = board.declaration(name).unwrap_or_else(|| name.to_owned());
    let mut text = format!("# {name}\n\n    {declaration};\n\n{}", line(name));
    let _ = writeln!(text, "- `--board {}` builds for one that has it.", board.name);
    Some(text)
}
