//! Options that commands which compile have in common.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use clap::{Args, ValueEnum};

use cc67_host::BootedFirmware;
use compiler::diag::levels::Levels;
use compiler::firmware::{Firmware, FirmwareFile};
use compiler::link::SectionAddresses;
use compiler::passes::Level;
use compiler::pp::Standard;
use compiler::render::Format;
use compiler::target::Target;
use compiler::{Division, Options, pp};
use kmotiondef::boards::{TargetBoard, boards};
use kmotiondef::timing::{Timing, WaitStates};

use super::heading;
use crate::cli::io::input::read;

/// The options of a compilation, of every command that compiles.
#[derive(Debug, Args)]
#[command(next_help_heading = heading::COMPILER)]
pub(crate) struct SourceArguments {
    /// Search DIR for included files
    #[arg(short = 'I', value_name = "DIR")]
    include_dirs: Vec<PathBuf>,
    /// Define a macro; without a value it is 1
    #[arg(short = 'D', value_name = "NAME[=VALUE]")]
    defines: Vec<String>,
    /// Undefine a predefined macro
    #[arg(short = 'U', value_name = "NAME")]
    undefines: Vec<String>,
    /// Optimise: 0 not at all, 1 for speed, 2 for more speed with larger code for the controller, s for small code
    #[arg(short = 'O', value_name = "LEVEL", default_value = "1", value_parser = level)]
    optimization: Level,
    /// Switch a warning on (NAME) or off (no-NAME), or make it an error (error=NAME); `all`, `extra` and `error` switch
    /// many
    #[arg(short = 'W', value_name = "WARNING")]
    warnings: Vec<String>,
    /// Show no warnings
    #[arg(short = 'w')]
    silent: bool,
    /// C standard that decides the types of constants (c90, c99, c11, c17), or the vendor's rules; the accepted language is the same
    #[arg(long, value_name = "STANDARD", default_value = "vendor", value_parser = standard)]
    std: Standard,
    /// Format of errors and warnings
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = FormatName::Human)]
    message_format: FormatName,
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
}

/// The options of a compilation for a simulated board.
#[derive(Debug, Args)]
pub(crate) struct CompilerArguments {
    #[command(flatten)]
    source: SourceArguments,
    /// Code whose execution time the board counts
    #[arg(long, value_name = "CODE", value_enum, default_value_t, help_heading = heading::EXPERTS)]
    timing: TimedCode,
    /// Memory waits of the processor: none, io44 (44 cycles for a register access; the default except with --boot), io44_sd20
    /// (also 20 for 32 bits of SDRAM), or a number of cycles for SDRAM
    #[arg(long, value_name = "WAITS", value_parser = wait_states, help_heading = heading::EXPERTS)]
    wait_states: Option<WaitStates>,
    #[command(flatten)]
    target: TargetArguments,
}

/// The target of a compilation.
#[derive(Debug, Args)]
pub(crate) struct TargetArguments {
    /// Target of the code
    #[arg(long, value_name = "TARGET", value_enum, help_heading = heading::EXPERTS)]
    target: Option<TargetName>,
}

/// The board with a name.
pub(crate) fn board(name: &str) -> Result<&'static TargetBoard, String> {
    TargetBoard::named(name).ok_or_else(|| {
        let names: Vec<_> = boards().map(|board| board.name).collect();
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
    /// Code for the controller's processor, which the simulated board executes too; the default of `build`
    C67x,
    /// Bytecode, for the simulated board only; the default of commands that run programs
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

impl SourceArguments {
    /// Returns how sources are compiled for `target`, with the board's time counted as `timing` says.
    pub(crate) fn resolve(&self, target: Target, timing: Timing) -> Result<Options> {
        let defines = self.defines.iter().map(|text| define(text)).collect::<Result<_>>()?;
        for name in &self.undefines {
            check_macro_name(name)?;
        }
        Ok(Options {
            preprocessor: pp::Options {
                include_dirs: self.include_dirs.clone(),
                defines,
                undefines: self.undefines.clone(),
                embedded: kmotiondef::headers::EMBEDDED,
                standard: self.std,
            },
            target,
            level: self.optimization,
            timing,
            firmware: self.firmware()?,
            division: Division::default(),
            gc_sections: self.gc_sections || (self.optimization != Level::None && !self.no_gc_sections),
            addresses: SectionAddresses::default(),
            float_elements: Vec::new(),
        })
    }

    /// Returns the firmware to link against.
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

    /// Returns the format of the diagnostics.
    pub(crate) fn format(&self) -> Format {
        match self.message_format {
            FormatName::Human => Format::Human,
            FormatName::Short => Format::Short,
            FormatName::Json => Format::Json,
            FormatName::Vendor => Format::Vendor,
        }
    }

    /// Returns the levels of the warnings.
    pub(crate) fn levels(&self) -> Result<Levels> {
        let mut levels = Levels::default();
        if self.silent {
            levels.disable_all();
        }
        for switch in &self.warnings {
            levels.set(switch).with_context(|| format!("option `-W{switch}`"))?;
        }
        Ok(levels)
    }
}

impl CompilerArguments {
    /// Returns how sources are compiled.
    pub(crate) fn resolve(&self) -> Result<Options> {
        ensure!(
            (self.timing, self.target.named()) != (TimedCode::Cc67, Some(Target::Sim)),
            "`--timing cc67` counts the cycles of code for the controller: `--target sim` makes none"
        );
        self.source.resolve(self.target().unwrap_or_default(), self.timing())
    }

    /// Returns how sources are compiled for a firmware file.
    pub(crate) fn for_firmware(&self, firmware: &BootedFirmware) -> Result<Options> {
        let options = firmware.options(self.resolve()?);
        let Some(waits) = self.wait_states else { return Ok(options) };
        ensure!(
            waits.sdram == 0,
            "`--wait-states` of SDRAM do not work with `--boot`, which counts those of registers"
        );
        Ok(Options { timing: Timing::Vendor(waits), ..options })
    }

    /// Refuses an option that a connected controller does not know.
    pub(crate) fn refuse_with_controller(&self) -> Result<()> {
        ensure!(self.wait_states.is_none(), "`--wait-states` does not work with `--on`");
        self.refuse_with("--on")
    }

    /// Refuses an option that only a modelled firmware knows, where `other` names another one.
    pub(crate) fn refuse_with(&self, other: &str) -> Result<()> {
        let refused = [
            ("--timing", self.timing != TimedCode::default()),
            ("--target sim", self.target.named() == Some(Target::Sim)),
        ];
        for (option, is_given) in refused {
            ensure!(!is_given, "`{option}` does not work with `{other}`");
        }
        Ok(())
    }

    /// Returns whether the options say which firmware programs are linked against.
    pub(crate) const fn names_firmware(&self) -> bool {
        self.source.board.is_some() || self.source.firmware.is_some()
    }

    /// Returns the code that the board's time is counted for, and the waits of its memory.
    pub(crate) fn timing(&self) -> Timing {
        match self.timing {
            TimedCode::Vendor | TimedCode::Cc67 => self.wait_states.map_or(Timing::VENDOR, Timing::Vendor),
            TimedCode::Fast => Timing::Fast,
        }
    }

    /// Returns the target, if the command line decides it: code whose cycles are counted has to be there.
    pub(crate) fn target(&self) -> Option<Target> {
        match (self.target.named(), self.timing) {
            (None, TimedCode::Cc67) => Some(Target::C67x),
            (target, _) => target,
        }
    }

    /// Returns the format of the diagnostics.
    pub(crate) fn format(&self) -> Format {
        self.source.format()
    }

    /// Returns the levels of the warnings.
    pub(crate) fn levels(&self) -> Result<Levels> {
        self.source.levels()
    }
}

impl TargetArguments {
    /// Returns the target that was named.
    pub(crate) fn named(&self) -> Option<Target> {
        self.target.map(|name| match name {
            TargetName::C67x => Target::C67x,
            TargetName::Sim => Target::Sim,
        })
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
