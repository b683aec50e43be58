//! What executes the programs, by name.

use clap::ValueEnum;

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EngineName {
    /// The interpreter
    Bytecode,
    /// Machine code of the host
    Native,
}

impl Default for EngineName {
    /// The fastest that this command is built with.
    fn default() -> Self {
        if cfg!(feature = "native") { Self::Native } else { Self::Bytecode }
    }
}

impl EngineName {
    /// Those that this command is built with.
    pub(crate) fn available() -> Vec<Self> {
        let mut engines = vec![Self::Bytecode];
        if cfg!(feature = "native") {
            engines.push(Self::Native);
        }
        engines
    }

    /// The name that `--engine` takes.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Bytecode => "bytecode",
            Self::Native => "native",
        }
    }
}
