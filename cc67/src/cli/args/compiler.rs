//! Options that all commands which compile have in common.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use clap::{Args, ValueEnum};

use compiler::diag::levels::Levels;
use compiler::firmware::{Firmware, FirmwareFile};
use compiler::link::SectionAddresses;
use compiler::passes::Level;
use compiler::pp::Standard;
use compiler::render::Format;
use compiler::target::Target;
use compiler::{Options, pp};
use kmotiondef::boards::{BOARDS, TargetBoard};
use kmotiondef::timing::{Timing, WaitStates};

use crate::cli::io::input::read;

/// How to compile.
#[derive(Debug, Args)]
pub(crate) struct CompilerArguments {
    /// Search DIR for included files
    #[arg(short = 'I', value_name = "DIR")]
    include_dirs: Vec<PathBuf>,
    /// Define a macro; without a value it is 1
    #[arg(short = 'D', value_name = "NAME[=VALUE]")]
    defines: Vec<String>,
    /// Undefine a predefined macro
    #[arg(short = 'U', value_name = "NAME")]
    undefines: Vec<String>,
    /// Rules for constants: a C standard (c99, c11, c17) or the vendor's compiler
    #[arg(long, value_name = "STANDARD", default_value = "vendor", value_parser = standard)]
    std: Standard,
    /// Optimisation level: 0 none; 1 for speed; 2 for more speed, with larger code for the controller; s for small code
    #[arg(short = 'O', value_name = "LEVEL", default_value = "1", value_parser = level)]
    optimization: Level,
    /// The code whose execution time the board counts
    #[arg(long, value_name = "CODE", value_enum, default_value_t)]
    timing: TimedCode,
    /// Memory waits of the processor: none, io44 (44 cycles for a register access), io44_sd20 (also 20 for 32 bits of
    /// SDRAM), or a number of cycles for SDRAM
    #[arg(long, value_name = "WAITS", value_parser = wait_states)]
    wait_states: Option<WaitStates>,
    /// Switch a warning on (NAME) or off (no-NAME), or make it an error (error=NAME); all, extra and error set many at
    /// once
    #[arg(short = 'W', value_name = "WARNING")]
    warnings: Vec<String>,
    /// Show no warnings
    #[arg(short = 'w')]
    silent: bool,
    /// The target of the code: the controller's processor, or only the simulated board
    #[arg(long, value_name = "TARGET", value_enum)]
    target: Option<TargetName>,
    /// The board and firmware that programs are for: kflop-4.34, kflop-5.3.2 or kogna-5.3.2 [default: kflop-4.34, or
    /// the one with the version of the firmware file]
    #[arg(long, value_name = "NAME", value_parser = board)]
    board: Option<&'static TargetBoard>,
    /// Link against the symbols of a firmware file in place of those that cc67 has
    #[arg(long, value_name = "FILE")]
    firmware: Option<PathBuf>,
    /// Leave out functions and objects that `main` cannot reach, at -O0 too
    #[arg(long, overrides_with = "no_gc_sections")]
    gc_sections: bool,
    /// Keep unreachable functions and objects
    #[arg(long, overrides_with = "gc_sections")]
    no_gc_sections: bool,
    /// Format of the diagnostics
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = FormatName::Human)]
    message_format: FormatName,
}

/// The board with a name.
pub(crate) fn board(name: &str) -> Result<&'static TargetBoard, String> {
    TargetBoard::named(name).ok_or_else(|| {
        let names: Vec<_> = BOARDS.iter().map(|board| board.name).collect();
        format!("the boards are {}", names.join(", "))
    })
}

/// Timings by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum TimedCode {
    /// The vendor's code: a program takes as long as on the board
    #[default]
    Vendor,
    /// cc67's code for the controller: its true cycles are counted, on every engine
    Cc67,
    /// Simplified: one or two cycles for each instruction
    Fast,
}

/// Targets by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TargetName {
    /// The controller's processor; the simulated board executes this code too. The default for `build`
    C67x,
    /// Bytecode for the simulated board only. The default for commands that run programs
    Sim,
}

/// Forms of diagnostics by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// Source lines, ranges, suggestions
    Human,
    /// One line each, for editors
    Short,
    /// One JSON object per line
    Json,
    /// Like the vendor's compiler; nothing unless there is an error
    Vendor,
}

impl CompilerArguments {
    /// The same for the compiler.
    pub(crate) fn resolve(&self) -> Result<Options> {
        let defines = self.defines.iter().map(|text| define(text)).collect::<Result<_>>()?;
        for name in &self.undefines {
            check_macro_name(name)?;
        }
        ensure!(
            (self.timing, self.target) != (TimedCode::Cc67, Some(TargetName::Sim)),
            "`--timing cc67` counts the cycles of code for the controller: `--target sim` makes none"
        );
        Ok(Options {
            preprocessor: pp::Options {
                include_dirs: self.include_dirs.clone(),
                defines,
                undefines: self.undefines.clone(),
                embedded: kmotiondef::headers::EMBEDDED,
                standard: self.std,
            },
            target: self.target().unwrap_or_default(),
            level: self.optimization,
            timing: self.timing(),
            firmware: self.firmware()?,
            gc_sections: self.gc_sections || (self.optimization != Level::None && !self.no_gc_sections),
            addresses: SectionAddresses::default(),
        })
    }

    /// Whose code the board's time is counted for, and with which memory.
    pub(crate) fn timing(&self) -> Timing {
        match self.timing {
            TimedCode::Vendor | TimedCode::Cc67 => self.wait_states.map_or(Timing::VENDOR, Timing::Vendor),
            TimedCode::Fast => Timing::Fast,
        }
    }

    /// What the code is for, if the command line says so: the code of which the cycles are counted has to be there.
    pub(crate) fn target(&self) -> Option<Target> {
        match (self.target, self.timing) {
            (Some(TargetName::C67x), _) | (None, TimedCode::Cc67) => Some(Target::C67x),
            (Some(TargetName::Sim), _) => Some(Target::Sim),
            (None, TimedCode::Vendor | TimedCode::Fast) => None,
        }
    }

    /// The firmware to link against.
    fn firmware(&self) -> Result<Firmware> {
        let Some(path) = &self.firmware else {
            return Ok(self.board.map_or_else(Firmware::default, Firmware::Board));
        };
        let file = FirmwareFile::read(&read(path)?);
        let file = file.with_context(|| format!("`--firmware {}`", path.display()))?;
        if let (Some(board), Some(version)) = (self.board, file.version()) {
            ensure!(
                version == board.version,
                "`--firmware {}` is `{version}`, and `--board {}` is `{}`",
                path.display(),
                board.name,
                board.version
            );
        }
        Ok(Firmware::File(Arc::new(file)))
    }

    /// The form of the diagnostics.
    pub(crate) fn format(&self) -> Format {
        match self.message_format {
            FormatName::Human => Format::Human,
            FormatName::Short => Format::Short,
            FormatName::Json => Format::Json,
            FormatName::Vendor => Format::Vendor,
        }
    }

    /// Which warnings are shown.
    pub(crate) fn levels(&self) -> Result<Levels> {
        let mut levels = Levels::default();
        if self.silent {
            levels.silence();
        }
        for switch in &self.warnings {
            levels.set(switch).with_context(|| format!("option `-W{switch}`"))?;
        }
        Ok(levels)
    }
}

/// The standard of `--std`.
fn standard(name: &str) -> Result<Standard, String> {
    Standard::named(name).ok_or_else(|| "expected c90, c99, c11, c17 or vendor".to_owned())
}

/// The level of `-O`.
fn level(text: &str) -> Result<Level, String> {
    match text {
        "0" => Ok(Level::None),
        "1" => Ok(Level::Full),
        "2" => Ok(Level::Fast),
        "s" => Ok(Level::Small),
        _ => Err("expected 0, 1, 2 or s".to_owned()),
    }
}

/// The wait states of `--wait-states`.
fn wait_states(name: &str) -> Result<WaitStates, String> {
    WaitStates::named(name).ok_or_else(|| "expected none, io44, io44_sd20 or a number of cycles".to_owned())
}

/// Splits `NAME=VALUE`.
fn define(text: &str) -> Result<(String, String)> {
    let (name, value) = text.split_once('=').unwrap_or((text, "1"));
    check_macro_name(name)?;
    Ok((name.to_owned(), value.to_owned()))
}

fn check_macro_name(name: &str) -> Result<()> {
    let mut characters = name.chars();
    let is_name = characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && characters.all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_name {
        bail!("`{name}` is not a macro name");
    }
    Ok(())
}
