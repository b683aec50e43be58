//! What executes the programs, by name.

use anyhow::{Result, ensure};
use clap::ValueEnum;
use compiler::Options;
use compiler::target::Target;

use super::compiler::CompilerArguments;

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EngineName {
    /// The interpreter
    Bytecode,
    /// Machine code of the host
    Native,
    /// Code for the controller's processor, executed in its true cycles; sources are compiled for it
    Dsp,
}

impl Default for EngineName {
    /// The fastest that this command is built with.
    fn default() -> Self {
        if cfg!(feature = "native") { Self::Native } else { Self::Bytecode }
    }
}

impl EngineName {
    /// How sources are compiled for it.
    pub(crate) fn options(self, compiler: &CompilerArguments) -> Result<Options> {
        let options = compiler.resolve()?;
        if self != Self::Dsp {
            return Ok(options);
        }
        ensure!(
            compiler.target() != Some(Target::Sim),
            "`--engine dsp` executes code for the controller's processor, `--target sim` makes none: leave one out"
        );
        Ok(Options { target: Target::C67x, ..options })
    }

    /// Those that this command is built with and that take the same board time.
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
            Self::Dsp => "dsp",
        }
    }
}
