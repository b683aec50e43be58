//! What the design promises and is not built yet: it says so by name when used.

use anyhow::{Result, bail};
use clap::error::{ContextKind, ContextValue};
use clap::{Args, Subcommand};

use super::Exit;

macro_rules! planned_commands {
    ($($variant:ident = $name:literal;)*) => {
        /// Subcommands to come.
        #[derive(Debug, Subcommand)]
        pub(super) enum Command {
            $(#[command(hide = true, disable_help_flag = true)] $variant(Anything),)*
        }

        impl Command {
            /// Says that the command is not built yet.
            pub(super) fn refuse(&self) -> Result<Exit> {
                match self {
                    $(Self::$variant(_) => bail!(concat!("`cc67 ", $name, "` is not built yet")),)*
                }
            }
        }
    };
}

planned_commands! {
    Plot = "plot";
}

/// Arguments that nobody reads.
#[derive(Debug, Args)]
pub(super) struct Anything {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    _arguments: Vec<std::ffi::OsString>,
}

/// Options of `run` to come, without `--`.
const OPTIONS: &[&str] = &["flash", "json", "plot", "realtime", "watch"];

/// The option to come that made the parser refuse the command line, if it was one.
pub(super) fn option(error: &clap::Error) -> Option<&'static str> {
    let Some(ContextValue::String(argument)) = error.get(ContextKind::InvalidArg) else { return None };
    let name = argument.strip_prefix("--")?.split('=').next()?;
    OPTIONS.iter().find(|option| **option == name).copied()
}
