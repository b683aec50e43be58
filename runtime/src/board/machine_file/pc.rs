//! `[host]`: the answers of the PC, and its files.
//!
//! The answers are the settings of [`Answers`], which checks them; a mistake is reported at the value.

use super::boards::file;
use super::read::{ReadResult, Table, TextError, Value, keys};
use super::{Answers, MachineFile};

pub(super) fn host(machine: &mut MachineFile, table: &Table<'_>) -> ReadResult<()> {
    keys!(table, |key, value| {
        "enabled" => machine.pc.is_connected = value.flag()?;
        "disk_root" => machine.pc.disk_root = file(&value)?;
        "disk_latency_s" => machine.pc.disk_latency_s = value.not_negative()?;
        "files" => machine.pc.disk_files.extend(files(&value)?);
        "message_box" => {
            for button in one_or_more(&value) {
                answer(&mut machine.pc.answers, &button, &format!("msgbox={}", button.raw_text()))?;
            }
        };
        "cells" => {
            for (key, text) in value.table()?.entries() {
                answer(&mut machine.pc.answers, &text, &format!("cell.{}={}", key.text, text.text()?))?;
            }
        };
        "answers" => {
            for setting in one_or_more(&value) {
                answer(&mut machine.pc.answers, &setting, setting.text()?)?;
            }
        };
    });
    Ok(())
}

/// A value, or the values of a list.
fn one_or_more<'a>(value: &Value<'a>) -> Vec<Value<'a>> {
    value.array().unwrap_or_else(|_| vec![value.clone()])
}

fn answer(answers: &mut Answers, value: &Value<'_>, setting: &str) -> ReadResult<()> {
    answers.set(setting).map_err(|error| TextError::new(value.offset(), error.to_string()))
}

/// Names that programs use, and the files meant.
fn files(value: &Value<'_>) -> ReadResult<Vec<(String, String)>> {
    let table = value.table()?;
    table.entries().map(|(key, value)| Ok((key.text.to_owned(), value.text()?.to_owned()))).collect()
}
