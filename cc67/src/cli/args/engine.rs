//! Engines that execute programs, by name.

use anyhow::{Result, ensure};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Arg, ValueEnum};
use compiler::Options;
use compiler::target::Target;

use super::compiler::CompilerArguments;

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EngineName {
    /// Interpret bytecode
    Bytecode,
    /// Translate to machine code of this computer; the default where that is possible
    Native,
    /// Execute code of the controller's processor cycle by cycle; sources are compiled for that processor
    Dsp,
}

impl Default for EngineName {
    /// The fastest engine in this build.
    fn default() -> Self {
        if cfg!(feature = "native") { Self::Native } else { Self::Bytecode }
    }
}

impl EngineName {
    /// Returns the options for compiling sources for this engine.
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

    /// Restricts the argument to engines that a debugger can stop anywhere.
    pub(crate) fn debuggable(argument: Arg) -> Arg {
        let names = [Self::Bytecode, Self::Dsp].iter().filter_map(Self::to_possible_value);
        let parser = PossibleValuesParser::new(names).try_map(|name| Self::from_str(&name, true));
        argument.value_parser(parser)
    }

    /// The engines in this build that take the same board time.
    pub(crate) fn available() -> Vec<Self> {
        let mut engines = vec![Self::Bytecode];
        if cfg!(feature = "native") {
            engines.push(Self::Native);
        }
        engines
    }

    /// The name for `--engine`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Bytecode => "bytecode",
            Self::Native => "native",
            Self::Dsp => "dsp",
        }
    }
}
