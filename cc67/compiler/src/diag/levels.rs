//! The levels of warnings: the `-W` switches.
//!
//! A switch for a lint takes precedence over a switch for a group, in any order; of switches of the same kind, the last
//! one applies. `-w` silences everything.

use crate::diag::{Diagnostic, Lint, Preset, Severity};

/// The level of every lint.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// `-Wall`, `-Wno-all`
    all: Option<bool>,
    /// `-Wextra`, `-Wno-extra`
    extra: Option<bool>,
    /// `-Werror`
    as_errors: bool,
    /// `-w`
    is_silent: bool,
    /// The settings of single lints, the last of each.
    named: Vec<LintSetting>,
}

/// The setting of one lint.
#[derive(Clone, Copy, Debug)]
struct LintSetting {
    lint: Lint,
    shown: Option<bool>,
    as_error: Option<bool>,
}

/// A `-W` switch that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no warning is named `{name}`{}", suggestion.map_or_else(|| "; `cc67 --explain warnings` lists them".to_owned(), |lint| format!("; did you mean `{lint}`?")))]
pub struct UnknownLint {
    name: String,
    suggestion: Option<&'static str>,
}

impl Lint {
    /// The lint of this name, in any letter case, with or without the rest of the switch.
    ///
    /// # Errors
    /// No lint has that name.
    pub fn from_name(text: &str) -> Result<Self, UnknownLint> {
        let name = text.to_ascii_lowercase();
        let plain = name.strip_prefix("-w").unwrap_or(&name);
        let plain = plain.strip_prefix("no-").or(plain.strip_prefix("error=")).unwrap_or(plain);
        let found = Self::ALL.iter().find(|lint| lint.name() == plain);
        found.copied().ok_or_else(|| UnknownLint {
            name: text.to_owned(),
            suggestion: crate::words::suggest(plain, Self::ALL.iter().map(|lint| lint.name())),
        })
    }
}

impl Levels {
    /// Obeys one switch, written without `-W`: `NAME`, `no-NAME`, `error=NAME`, `no-error=NAME`, and the groups
    /// `all`, `extra`, `error` with or without `no-`.
    ///
    /// # Errors
    /// If no lint has that name.
    pub fn set(&mut self, switch: &str) -> Result<(), UnknownLint> {
        let (name, on) = switch.strip_prefix("no-").map_or((switch, true), |name| (name, false));
        match (name, name.strip_prefix("error=")) {
            ("error", _) => self.as_errors = on,
            ("all", _) => self.all = Some(on),
            ("extra", _) => self.extra = Some(on),
            (_, Some(name)) => {
                let named = self.setting_mut(name)?;
                named.as_error = Some(on);
                if on {
                    named.shown = Some(true);
                }
            }
            (_, None) => self.setting_mut(name)?.shown = Some(on),
        }
        Ok(())
    }

    /// Shows a lint as `-WNAME` does.
    pub fn enable(&mut self, lint: Lint) {
        self.entry(lint).shown = Some(true);
    }

    /// Obeys `-w`: no warning at all.
    pub fn disable_all(&mut self) {
        self.is_silent = true;
    }

    fn setting_mut(&mut self, name: &str) -> Result<&mut LintSetting, UnknownLint> {
        Lint::from_name(name).map(|lint| self.entry(lint))
    }

    fn entry(&mut self, lint: Lint) -> &mut LintSetting {
        let index = self.named.iter().position(|named| named.lint == lint).unwrap_or(self.named.len());
        if index == self.named.len() {
            self.named.push(LintSetting { lint, shown: None, as_error: None });
        }
        &mut self.named[index]
    }

    /// The diagnostic as it should be shown; `None` if its lint is off.
    #[must_use]
    pub fn apply(&self, diagnostic: &Diagnostic) -> Option<Diagnostic> {
        if diagnostic.severity != Severity::Error && self.is_silent {
            return None;
        }
        let named = diagnostic.lint.and_then(|lint| self.named.iter().find(|named| named.lint == lint));
        let is_shown = diagnostic.lint.is_none_or(|lint| {
            named.and_then(|named| named.shown).unwrap_or_else(|| self.is_enabled(lint.preset()))
        });
        let mut diagnostic = is_shown.then(|| diagnostic.clone())?;
        let as_error = named.and_then(|named| named.as_error).unwrap_or(self.as_errors);
        if as_error && diagnostic.severity == Severity::Warning {
            diagnostic.severity = Severity::Error;
        }
        Some(diagnostic)
    }

    fn is_enabled(&self, preset: Preset) -> bool {
        match preset {
            Preset::On => self.all.unwrap_or(true),
            Preset::All => self.all.unwrap_or(false),
            Preset::Extra => self.extra.unwrap_or(false),
            Preset::Own => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    fn severity(switches: &str, lint: Lint) -> Option<Severity> {
        let mut levels = Levels::default();
        switches.split_whitespace().for_each(|switch| levels.set(switch).expect("the switch exists"));
        let warning = Diagnostic::warning(lint, Span::new(0, 1), "x");
        levels.apply(&warning).map(|diagnostic| diagnostic.severity)
    }

    #[test]
    fn switches_show_or_hide_warnings_or_make_them_errors() {
        let (warning, error) = (Some(Severity::Warning), Some(Severity::Error));
        for (switches, default, all, extra) in [
            ("", warning, None, None),
            ("all", warning, warning, None),
            ("extra", warning, None, warning),
            ("no-all", None, None, None),
            ("no-all extra", None, None, warning),
            ("void-value no-all", warning, None, None),
            ("no-void-value all", None, warning, None),
            ("error", error, None, None),
            ("error=void-value all", error, warning, None),
            ("error no-error=void-value all", warning, error, None),
            ("error=falls-off-end", warning, error, None),
            ("portability no-portability", warning, None, None),
        ] {
            let found =
                [Lint::VoidValue, Lint::FallsOffEnd, Lint::Portability].map(|lint| severity(switches, lint));
            assert_eq!(found, [default, all, extra], "{switches}");
        }
    }

    #[test]
    fn silence_hides_warnings_and_no_errors() {
        let mut levels = Levels::default();
        levels.disable_all();
        assert_eq!(levels.apply(&Diagnostic::warning(Lint::Format, Span::new(0, 1), "x")), None);
        assert_eq!(levels.apply(&Diagnostic::requested_warning(Span::new(0, 1), "x")), None);
        assert!(levels.apply(&Diagnostic::global_error("x")).is_some());
    }

    #[test]
    fn unknown_names_get_a_suggestion() {
        let say = |name: &str| Lint::from_name(name).map_err(|error| error.to_string());
        assert_eq!(say("-Wno-Stack-Size"), Ok(Lint::StackSize));
        assert_eq!(
            say("stack-siez"),
            Err("no warning is named `stack-siez`; did you mean `stack-size`?".to_owned())
        );
        assert_eq!(
            say("zzz"),
            Err("no warning is named `zzz`; `cc67 --explain warnings` lists them".to_owned())
        );
    }
}
