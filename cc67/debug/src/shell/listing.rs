//! `list`: the source, ten lines at a time.

use cc67_host::Target;

use super::Shell;
use crate::debugger::{DebugError, file_name};

/// The number of lines that `list` shows.
const LINES: u32 = 10;
/// The number of lines that it shows before the requested one.
const BEFORE: u32 = 5;

/// The lines that were shown last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ListedLines {
    /// The first of these lines; if none was shown, the line with which the next listing begins.
    first: u32,
    /// The line after the last of these lines.
    next: u32,
}

impl<T: Target> Shell<T> {
    /// Makes the next listing show the lines around the present one.
    pub(super) fn list_around_present(&mut self) {
        if let Some(place) = self.debugger.present() {
            let first = place.line.saturating_sub(BEFORE).max(1);
            self.listing = ListedLines { first, next: first };
        }
    }

    /// `list`, `list -`, `list PLACE`, `list FIRST,LAST`.
    pub(super) fn list(&mut self, rest: &str) -> Result<String, DebugError> {
        let ListedLines { first, next } = self.listing;
        let lines = match (rest, rest.split_once(',')) {
            ("", _) => next.max(1)..next.max(1) + LINES,
            ("-", _) if first <= 1 => return Err("Already at the start of the source.".into()),
            ("-", _) => first.saturating_sub(LINES).max(1)..first,
            (_, Some(("", last))) => {
                let last = self.line_of(last)?;
                last.saturating_sub(LINES - 1).max(1)..last + 1
            }
            (_, Some((first, ""))) => {
                let first = self.line_of(first)?;
                first..first + LINES
            }
            (_, Some((first, last))) => self.line_of(first)?..self.line_of(last)? + 1,
            (place, None) => {
                let first = self.line_of(place)?.saturating_sub(BEFORE).max(1);
                first..first + LINES
            }
        };
        let model = self.debugger.programs().of(self.debugger.thread())?;
        let text = String::from_utf8_lossy(model.text()).into_owned();
        let count = text.lines().count() as u32;
        if lines.start > count {
            let file = file_name(&model.path.to_string_lossy()).to_owned();
            return Err(format!("Line number {} out of range; {file} has {count} lines.", lines.start).into());
        }
        let end = lines.end.min(count + 1);
        let shown = (1..).zip(text.lines()).skip(lines.start as usize - 1);
        let shown = shown.take(end.saturating_sub(lines.start) as usize);
        let out = shown.map(|(number, line): (u32, &str)| format!("{number}\t{line}\n")).collect();
        self.listing = ListedLines { first: lines.start, next: end };
        Ok(out)
    }

    /// The line of a location.
    fn line_of(&self, place: &str) -> Result<u32, DebugError> {
        let place = place.trim();
        let (file, name) = place.rsplit_once(':').map_or((None, place), |(file, name)| (Some(file), name));
        let model = self.debugger.programs().of(self.debugger.thread())?;
        let is_file = |file: &str| model.path.ends_with(file);
        if let Ok(line) = name.parse()
            && file.is_none_or(is_file)
        {
            return Ok(line);
        }
        if let Some(function) = model.function_named(name) {
            return Ok(model.body_line(function));
        }
        let (found, _) = self.debugger.resolve(place, Some(self.debugger.thread()))?;
        Ok(found.first().map_or(1, |one| one.line))
    }

    /// `info line [PLACE]`: the code of a line.
    pub(super) fn line_information(&self, rest: &str) -> Result<String, DebugError> {
        let present = || self.debugger.present().map(|place| place.line);
        let line = match rest {
            "" => present().ok_or("No line number information available.")?,
            place => self.line_of(place)?,
        };
        let model = self.debugger.programs().of(self.debugger.thread())?;
        let file = file_name(&model.path.to_string_lossy()).to_owned();
        let code = model.image().lines.iter().find(|code| code.line >= line);
        let Some(code) = code else {
            return Ok(format!("Line number {line} is out of range for \"{file}\".\n"));
        };
        let named = |address: u32| match model.symbol_at(address) {
            Some(name) => format!("{address:#x} <{name}>"),
            None => format!("{address:#x}"),
        };
        let start = named(code.address);
        if code.line != line {
            return Ok(format!("Line {line} of \"{file}\" is at address {start} but contains no code.\n"));
        }
        let after =
            model.image().lines.iter().map(|other| other.address).filter(|at| *at > code.address).min();
        let function_end = model.function_at(code.address).map(|function| function.addresses.end);
        let end = after.or(function_end).unwrap_or(code.address);
        Ok(format!("Line {line} of \"{file}\" starts at address {start} and ends at {}.\n", named(end)))
    }
}
