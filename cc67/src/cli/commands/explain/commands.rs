//! Script commands: usage and effect from their table.

use std::fmt::Write as _;

use runtime::commands::{COMMANDS, Command};

use super::Explained;

/// Each command with its effect.
pub(super) fn entries() -> impl Iterator<Item = Explained> {
    COMMANDS
        .iter()
        .map(|command| Explained { name: command.name, about: format!("Script command: {}.", command.help) })
}

/// Every command.
pub(super) fn list() -> String {
    let mut commands: Vec<_> = COMMANDS.iter().collect();
    commands.sort_by_key(|command| command.name.to_lowercase());
    commands.iter().fold(String::new(), |mut rows, command| {
        let _ = writeln!(rows, "  {:<34}{}", command.usage(), command.help);
        rows
    })
}

/// The answer for one command.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let command: &Command = COMMANDS.iter().find(|command| is_meant(command.name))?;
    let (usage, help) = (command.usage(), command.help);
    let asks = match usage.contains("[=") {
        true => "With `=` and a value it sets, without it asks.\n\n",
        false => "",
    };
    Some(format!(
        "# {}, a script command\n\n    {usage}\n\nIt {help}.\n\n{asks}It is a line of `cc67 console`, and `command \"…\"` in a \
         stimulus; letter case does not matter.\n",
        command.name,
        help = described(help)
    ))
}

/// Most rows begin with a verb, those of values with a noun.
fn described(help: &str) -> String {
    let first = help.split(' ').next().unwrap_or_default();
    let is_verb = first.ends_with('s') && !["axis", "options", "coefficients", "cycles"].contains(&first);
    if is_verb { help.to_owned() } else { format!("is the {help}") }
}
