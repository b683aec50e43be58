//! Script commands: usage and effect from their table.

use std::fmt::Write as _;

use kmotiondef::boards::boards;
use runtime::ModelledBoard;
use runtime::commands::{COMMANDS, Command, KOGNA_COMMANDS, LATER_COMMANDS, boards_with};

use super::ExplainedName;

/// Each command with its effect.
pub(super) fn entries() -> impl Iterator<Item = ExplainedName> {
    all().map(|command| ExplainedName {
        name: command.name,
        about: format!("Script command: {}.", command.help),
    })
}

/// The commands of all firmware versions.
fn all() -> impl Iterator<Item = &'static Command> {
    let is_new = |command: &&Command| COMMANDS.iter().all(|known| known.name != command.name);
    COMMANDS.iter().chain(LATER_COMMANDS.iter().filter(is_new)).chain(KOGNA_COMMANDS)
}

/// Every command.
pub(super) fn list() -> String {
    let mut commands: Vec<_> = all().collect();
    commands.sort_by_key(|command| command.name.to_lowercase());
    commands.iter().fold(String::new(), |mut rows, command| {
        let _ = writeln!(rows, "  {:<34}{}", command.usage(), command.help);
        rows
    })
}

/// The answer for one command.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let command: &Command = all().find(|command| is_meant(command.name))?;
    let (usage, help) = (command.usage(), command.help);
    let asks = match usage.contains("[=") {
        true => "With `=` and a value it sets, without it asks.\n\n",
        false => "",
    };
    Some(format!(
        "# {}, a script command\n\n    {usage}\n\nIt {help}.\n\n{asks}It is a line of `cc67 console`, and `command \"…\"` in a \
         stimulus; letter case does not matter.\n{boards}",
        command.name,
        help = described(help),
        boards = boards_of(command)
    ))
}

/// The boards that have a command and those that lack it; empty if all have it.
fn boards_of(command: &Command) -> String {
    let with: Vec<_> = boards_with(command.name).map(|(_, board)| board.name).collect();
    let without = boards().filter(|board| ModelledBoard::of(board).is_some());
    let without: Vec<_> = without.map(|board| board.name).filter(|name| !with.contains(name)).collect();
    if without.is_empty() {
        return String::new();
    }
    format!("\n- Boards with it: {}. Boards without: {}.\n", with.join(", "), without.join(", "))
}

/// Most descriptions begin with a verb; those of commands that return values begin with a noun.
fn described(help: &str) -> String {
    let first = help.split(' ').next().unwrap_or_default();
    let is_verb = first.ends_with('s') && !["axis", "options", "coefficients", "cycles"].contains(&first);
    if is_verb { help.to_owned() } else { format!("is the {help}") }
}
