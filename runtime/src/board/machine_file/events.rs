//! `[[event]]` and `[[device]]`: events around the board, as statements of a stimulus.
//!
//! Each key of an event is one statement of [`crate::world::stimulus`], which checks it; a mistake is reported at the
//! key's value.

use super::MachineFileError;
use super::read::{ReadResult, Table, TextError, Value};
use crate::world::stimulus::{Form, KEYS, Rule, StatementPlace, Stimulus};

/// The name under which messages about rules of a machine file cite their source.
const SOURCE: &str = "machine file";

/// A statement and its offset in the text.
type Statement = (usize, String);

/// The statements of `[[event]]`.
pub(super) fn events(value: &Value<'_>) -> ReadResult<Vec<Statement>> {
    let tables = value.tables()?;
    tables.iter().map(event).collect::<ReadResult<Vec<_>>>().map(|all| all.concat())
}

/// The statements of `[[device]]`.
pub(super) fn devices(value: &Value<'_>) -> ReadResult<Vec<Statement>> {
    value.tables()?.iter().map(device).collect()
}

/// The rules of statements.
pub(super) fn rules(statements: Vec<Statement>, text: &str) -> Result<Vec<Rule>, MachineFileError> {
    let mut rules = Vec::new();
    for (offset, statement) in statements {
        let read = Stimulus::parse(&statement, SOURCE)
            .map_err(|error| TextError::new(offset, error.message).in_text(text))?;
        let MachineFileError { line, column, .. } = TextError::new(offset, "").in_text(text);
        let place = StatementPlace { source: SOURCE.into(), line, column };
        rules.extend(read.rules.into_iter().map(|rule| Rule { place: place.clone(), ..rule }));
    }
    Ok(rules)
}

fn event(table: &Table<'_>) -> ReadResult<Vec<Statement>> {
    let mut moment = String::new();
    let mut actions: Vec<Statement> = Vec::new();
    for (key, value) in table.entries() {
        match key.text {
            "at" => moment = format!("at {}", value.not_negative()?),
            "after" => moment = format!("once {}", condition(value.text()?)),
            name => match KEYS.iter().find(|(known, _)| *known == name) {
                Some((_, form)) => write(*form, &value, &mut actions)?,
                None => {
                    let known: Vec<_> =
                        ["at", "after"].into_iter().chain(KEYS.iter().map(|(key, _)| *key)).collect();
                    return Err(key.is_unknown(&known));
                }
            },
        }
    }
    Ok(actions.into_iter().map(|(offset, action)| (offset, format!("{moment} {action}"))).collect())
}

/// A condition as statements have it: there the text that is printed is in quotes.
fn condition(text: &str) -> String {
    match text.strip_prefix("printed ") {
        Some(printed) if !printed.starts_with('"') => format!("printed {}", quoted(printed)),
        _ => text.to_owned(),
    }
}

/// Writes the statements of a key.
fn write(form: Form, value: &Value<'_>, actions: &mut Vec<Statement>) -> ReadResult<()> {
    match form {
        Form::One(template) => {
            actions.push((value.offset(), template.replace("{value}", &literal(value))));
        }
        Form::Each(template) => {
            for (key, value) in value.table()?.entries() {
                let setting = quoted(&format!("{}={}", key.text, value.raw_text()));
                let text = template.replace("{key}", key.text).replace("{value}", &literal(&value));
                actions.push((value.offset(), text.replace("{setting}", &setting)));
            }
        }
        Form::Fields(templates) => actions.push((value.offset(), fields(templates, &value.table()?)?)),
        Form::Nested(..) | Form::Statement if value.text().is_ok() || value.array().is_ok() => {
            let word = if let Form::Nested(word, _) = form { word } else { "" };
            let texts = value.array().unwrap_or_else(|_| vec![value.clone()]);
            for text in texts {
                actions.push((text.offset(), format!("{word} {}", text.text()?)));
            }
        }
        Form::Nested(_, forms) => {
            for (key, value) in value.table()?.entries() {
                let Some((_, form)) = forms.iter().find(|(known, _)| *known == key.text) else {
                    return Err(key.is_unknown(&forms.iter().map(|(known, _)| *known).collect::<Vec<_>>()));
                };
                write(*form, &value, actions)?;
            }
        }
        Form::Statement => return Err(value.is_wrong("a statement of a stimulus, or several")),
    }
    Ok(())
}

/// The first template whose names are all keys of the table.
fn fields(templates: &[&str], table: &Table<'_>) -> ReadResult<String> {
    let names = |template: &str| -> Vec<String> {
        template.split('{').skip(1).filter_map(|part| part.split('}').next().map(str::to_owned)).collect()
    };
    let known: Vec<String> = templates.iter().flat_map(|template| names(template)).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    if let Some((key, _)) = table.entries().find(|(key, _)| !known.contains(&key.text)) {
        return Err(key.is_unknown(&known));
    }
    let has = |name: &str| table.entries().find(|(key, _)| key.text == name).map(|(_, value)| value);
    let complete = templates.iter().find(|template| names(template).iter().all(|name| has(name).is_some()));
    let Some(template) = complete else {
        let missing = known.iter().find(|name| has(name).is_none()).copied().unwrap_or_default();
        return Err(table.is_missing(missing));
    };
    let mut text = (*template).to_owned();
    for (key, value) in table.entries() {
        text = text.replace(&format!("{{{}}}", key.text), &literal(&value));
    }
    Ok(text)
}

/// A value as a statement has it.
fn literal(value: &Value<'_>) -> String {
    value.text().map_or_else(|_| value.raw_text(), quoted)
}

fn device(table: &Table<'_>) -> ReadResult<Statement> {
    let mut name = None;
    let mut settings = String::new();
    for (key, value) in table.entries() {
        match key.text {
            "type" => name = Some(value.text()?),
            // The location of the echo; only the UART is possible.
            "on" => value.choice(&[("uart", ())])?,
            key => settings.push_str(&format!(" {key}={}", value.raw_text())),
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
