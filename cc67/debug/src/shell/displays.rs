//! `display`: expressions that are shown at every stop.

use cc67_host::Target;

use super::{Shell, show};
use crate::debugger::DebugError;

impl<T: Target> Shell<T> {
    pub(super) fn display(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        if name == "undisplay" {
            let number: Option<u32> = rest.parse().ok();
            if !rest.is_empty() && !self.displays.iter().any(|(one, ..)| Some(*one) == number) {
                return Err(format!("No display number {rest}.").into());
            }
            self.displays.retain(|(one, ..)| !rest.is_empty() && number != Some(*one));
            return Ok(String::new());
        }
        if !rest.is_empty() {
            let (format, expression) = show::format_of(rest);
            let number = self.last_display + 1;
            let shown = self.shown((number, format, expression))?;
            self.last_display = number;
            self.displays.push((number, format.to_owned(), expression.to_owned()));
            return Ok(shown);
        }
        Ok(self.shown_all())
    }

    fn shown(&mut self, (number, format, expression): (u32, &str, &str)) -> Result<String, DebugError> {
        if format.ends_with('i') {
            let at = self.number_of(expression)? as i64 as u32;
            let count = format.trim_end_matches('i').parse().unwrap_or(1);
            return Ok(format!(
                "{number}: x/{format} {expression}\n{}",
                self.instructions(at, count, u32::MAX)
            ));
        }
        let letter = show::format_of_letter(format)?;
        let slash = if format.is_empty() { String::new() } else { format!("/{format} ") };
        let replaced = self.replaced(expression)?;
        let shown = self.debugger.look_at(&replaced, letter)?;
        let cast = if letter.is_none() { shown.cast } else { String::new() };
        Ok(format!("{number}: {slash}{expression} = {cast}{}\n", shown.text))
    }

    /// The text of the expressions that are shown at every stop, for those that have values there.
    pub(super) fn shown_all(&mut self) -> String {
        let rows = self.displays.clone();
        let shown = rows
            .iter()
            .filter_map(|(number, format, expression)| self.shown((*number, format, expression)).ok());
        shown.collect()
    }

    /// The list of the expressions that are shown at every stop.
    pub(super) fn displayed(&self) -> String {
        if self.displays.is_empty() {
            return "There are no auto-display expressions now.\n".to_owned();
        }
        let rows = self.displays.iter().map(|(number, format, expression)| {
            let slash = if format.is_empty() { String::new() } else { format!("/{format} ") };
            format!("{number}:   y  {slash}{expression}\n")
        });
        format!("Auto-display expressions now in effect:\nNum Enb Expression\n{}", rows.collect::<String>())
    }
}
