//! What the design promises and is not built yet: it says so by name when used.

use clap::error::{ContextKind, ContextValue};

/// Options of `run` to come, without `--`.
const OPTIONS: &[&str] = &["json", "realtime"];

/// The option to come that made the parser refuse the command line, if it was one.
pub(super) fn option(error: &clap::Error) -> Option<&'static str> {
    let Some(ContextValue::String(argument)) = error.get(ContextKind::InvalidArg) else { return None };
    let name = argument.strip_prefix("--")?.split('=').next()?;
    OPTIONS.iter().find(|option| **option == name).copied()
}
