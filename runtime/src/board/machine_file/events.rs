//! `[[event]]` and `[[device]]`: what happens around the board, as statements of a stimulus.
//!
//! Each key of an event is one statement of [`crate::world::stimulus`], which checks it; a mistake is told at the key's value.

use super::MachineFileError;
use super::read::{Key, Read, Table, Value, Wrong, keys};
use crate::world::stimulus::{Place, Rule, Stimulus};

/// What messages about rules of a machine file call it.
const SOURCE: &str = "machine file";

/// A statement and where it stands in the text.
type Statement = (usize, String);

/// The statements of `[[event]]`.
pub(super) fn events(value: &Value<'_>) -> Read<Vec<Statement>> {
    let tables = value.tables()?;
    tables.iter().map(event).collect::<Read<Vec<_>>>().map(|all| all.concat())
}

/// The statements of `[[device]]`.
pub(super) fn devices(value: &Value<'_>) -> Read<Vec<Statement>> {
    value.tables()?.iter().map(device).collect()
}

/// The rules of statements.
pub(super) fn rules(statements: Vec<Statement>, text: &str) -> Result<Vec<Rule>, MachineFileError> {
    let mut rules = Vec::new();
    for (offset, statement) in statements {
        let read = Stimulus::parse(&statement, SOURCE)
            .map_err(|error| Wrong::new(offset, error.message).in_text(text))?;
        let MachineFileError { line, column, .. } = Wrong::new(offset, "").in_text(text);
        let place = Place { source: SOURCE.into(), line, column };
        rules.extend(read.rules.into_iter().map(|rule| Rule { place: place.clone(), ..rule }));
    }
    Ok(rules)
}

fn event(table: &Table<'_>) -> Read<Vec<Statement>> {
    let mut moment = None;
    let mut actions: Vec<Statement> = Vec::new();
    keys!(table, |key, value| {
        "at" => moment = Some(format!("at {}", value.not_negative()?));
        "after" => moment = Some(format!("once {}", condition(value.text()?)));
        "set_bit" => actions.extend(each(&value, |bit, level| format!("bit {bit} = {level}"))?);
        "adc" => actions.extend(each(&value, |channel, counts| format!("adc {channel} = {counts}"))?);
        "uart" => actions.push((value.offset(), format!("uart {}", quoted(value.text()?))));
        "encoder" => actions.extend(each(&value, |axis, counts| format!("encoder {axis} moves {counts}"))?);
        "disturb" => actions.push((value.offset(), disturb(&value.table()?)?));
        "command" => actions.push((value.offset(), format!("command {}", quoted(value.text()?))));
        "run" => actions.push((value.offset(), run(&value.table()?)?));
        "persist" => actions.extend(each(&value, |index, number| format!("persist {index} = {number}"))?);
        "kill" => actions.push((value.offset(), format!("kill {}", value.whole(7)?)));
        "expect" => actions.extend(expect(&value.table()?)?);
        "host" => actions.extend(answers(&value.table()?)?);
        "encoder_error" => actions.push((value.offset(), format!("encoder {} fails", value.whole(15)?)));
    });
    let moment = moment.unwrap_or_default();
    Ok(actions.into_iter().map(|(offset, action)| (offset, format!("{moment} {action}"))).collect())
}

/// A condition as statements have it: there the text that is printed stands in quotes.
fn condition(text: &str) -> String {
    match text.strip_prefix("printed ") {
        Some(printed) => format!("printed {}", quoted(printed)),
        None => text.to_owned(),
    }
}

/// A statement for each key of a table of numbers.
fn each(value: &Value<'_>, write: impl Fn(&str, f64) -> String) -> Read<Vec<Statement>> {
    let table = value.table()?;
    table.entries().map(|(key, value)| Ok((value.offset(), write(key.text, value.number()?)))).collect()
}

fn disturb(table: &Table<'_>) -> Read<String> {
    let (mut axis, mut units) = (None, None);
    keys!(table, |key, value| {
        "axis" => axis = Some(value.axis()?);
        "units" => units = Some(value.number()?);
    });
    let axis = axis.ok_or_else(|| table.is_missing("axis"))?;
    Ok(format!("axis {axis} push {}", units.ok_or_else(|| table.is_missing("units"))?))
}

fn run(table: &Table<'_>) -> Read<String> {
    let (mut thread, mut program) = (None, None);
    keys!(table, |key, value| {
        "thread" => thread = Some(value.whole(7)?);
        "program" => program = Some(value.text()?);
    });
    let thread = thread.ok_or_else(|| table.is_missing("thread"))?;
    Ok(match program {
        Some(program) => format!("run thread {thread} {}", quoted(program)),
        None => format!("start thread {thread}"),
    })
}

/// Answers of the PC: the keys that it has for them, and `message_box`.
fn answers(table: &Table<'_>) -> Read<Vec<Statement>> {
    let setting = |(key, value): (Key<'_>, Value<'_>)| {
        let key = if key.text == "message_box" { "msgbox" } else { key.text };
        (value.offset(), format!("answer {}", quoted(&format!("{key}={}", value.plain()))))
    };
    Ok(table.entries().map(setting).collect())
}

fn expect(table: &Table<'_>) -> Read<Vec<Statement>> {
    let mut all = Vec::new();
    keys!(table, |key, value| {
        "bit" => all.extend(each(&value, |bit, level| format!("expect bit {bit} = {level}"))?);
        "persist" => all.extend(each(&value, |index, number| format!("expect persist {index} = {number}"))?);
        "printed" => all.push((value.offset(), format!("expect printed {}", quoted(value.text()?))));
    });
    Ok(all)
}

fn device(table: &Table<'_>) -> Read<Statement> {
    let mut name = None;
    let mut settings = String::new();
    for (key, value) in table.entries() {
        match key.text {
            "type" => name = Some(value.text()?),
            // Where an echo is; there is only one place.
            "on" => value.choice(&[("uart", ())])?,
            key => settings.push_str(&format!(" {key}={}", value.plain())),
        }
    }
    let name = name.ok_or_else(|| table.is_missing("type"))?;
    Ok((table.offset, format!("device {name}{settings}")))
}

/// A text in quotes that a statement can hold.
fn quoted(text: &str) -> String {
    let escape = |byte: u8| match byte {
        b'"' | b'\\' | 0..=31 | 127..=255 => format!("\\x{byte:02x}"),
        _ => char::from(byte).to_string(),
    };
    format!("\"{}\"", text.bytes().map(escape).collect::<String>())
}
