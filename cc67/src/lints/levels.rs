//! Which warnings are shown, and as what: the `-W` switches.

use crate::diag::{Diagnostic, Severity};
use crate::lints::{Default as Preset, Lint};

/// The level of every lint.
#[derive(Clone, Debug)]
pub struct Levels {
    /// Shown or not, in the order of [`Lint::ALL`].
    shown: Vec<bool>,
    /// Warnings count as errors.
    as_errors: bool,
}

impl Default for Levels {
    fn default() -> Self {
        let shown = Lint::ALL.iter().map(|lint| lint.default() == Preset::On).collect();
        Self { shown, as_errors: false }
    }
}

/// A `-W` switch that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no warning is named `{0}`; `-Wall` shows them all")]
pub struct UnknownLint(String);

impl Levels {
    /// Obeys one switch, written without `-W`: `NAME`, `no-NAME`, `all`, `error`, `no-error`.
    ///
    /// # Errors
    /// If no lint has that name.
    pub fn set(&mut self, switch: &str) -> Result<(), UnknownLint> {
        let (name, on) = switch.strip_prefix("no-").map_or((switch, true), |name| (name, false));
        match name {
            "error" => self.as_errors = on,
            "all" => self.shown.fill(on),
            _ => {
                let lint = Lint::ALL.iter().position(|lint| lint.name() == name);
                let shown = lint.and_then(|index| self.shown.get_mut(index));
                *shown.ok_or_else(|| UnknownLint(name.to_owned()))? = on;
            }
        }
        Ok(())
    }

    /// The diagnostic as it is to be shown; `None` if its lint is off.
    #[must_use]
    pub fn apply(&self, diagnostic: &Diagnostic) -> Option<Diagnostic> {
        let Some(lint) = diagnostic.lint else { return Some(diagnostic.clone()) };
        let index = Lint::ALL.iter().position(|other| *other == lint)?;
        if !*self.shown.get(index)? {
            return None;
        }
        let mut diagnostic = diagnostic.clone();
        if self.as_errors && diagnostic.severity == Severity::Warning {
            diagnostic.severity = Severity::Error;
        }
        Some(diagnostic)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    fn severity(levels: &Levels, lint: Lint) -> Option<Severity> {
        let warning = Diagnostic::warning(lint, Span::new(0, 1), "x");
        levels.apply(&warning).map(|diagnostic| diagnostic.severity)
    }

    #[test]
    fn switches_show_hide_and_harden() {
        let mut levels = Levels::default();
        assert_eq!(severity(&levels, Lint::VoidValue), Some(Severity::Warning));
        assert_eq!(severity(&levels, Lint::MissingReturn), None);
        for switch in ["missing-return", "no-void-value", "error"] {
            levels.set(switch).expect("the switch exists");
        }
        assert_eq!(severity(&levels, Lint::VoidValue), None);
        assert_eq!(severity(&levels, Lint::MissingReturn), Some(Severity::Error));
        assert!(levels.set("no-such-thing").is_err());
    }
}
