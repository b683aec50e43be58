//! Options that all commands which compile have in common.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};

use compiler::diag::levels::Levels;
use compiler::firmware::{Firmware, FirmwareFile};
use compiler::link::SectionAddresses;
use compiler::passes::Level;
use compiler::render::Format;
use compiler::{Options, pp};

/// How to compile.
#[derive(Debug, Args)]
pub(super) struct CompilerOptions {
    /// Search DIR for included files
    #[arg(short = 'I', value_name = "DIR")]
    include_dirs: Vec<PathBuf>,
    /// Define a macro, as 1 without a value
    #[arg(short = 'D', value_name = "NAME[=VALUE]")]
    defines: Vec<String>,
    /// Undefine a predefined macro
    #[arg(short = 'U', value_name = "NAME")]
    undefines: Vec<String>,
    /// Optimisation: 0 none, 1 and 2 what makes programs faster
    #[arg(short = 'O', value_name = "LEVEL", default_value = "1", value_parser = clap::value_parser!(u8).range(0..=2))]
    optimization: u8,
    /// Switch a warning on (NAME), off (no-NAME), make it an error (error=NAME), or all of them (all, extra, error)
    #[arg(short = 'W', value_name = "WARNING")]
    warnings: Vec<String>,
    /// Show no warnings
    #[arg(short = 'w')]
    silent: bool,
    /// Link against the symbols of a firmware file in place of firmware 4.34's
    #[arg(long, value_name = "FILE")]
    firmware: Option<PathBuf>,
    /// Leave out functions and objects that `main` cannot reach, at -O0 too
    #[arg(long, overrides_with = "no_gc_sections")]
    gc_sections: bool,
    /// Keep them
    #[arg(long, overrides_with = "gc_sections")]
    no_gc_sections: bool,
    /// Form of the diagnostics
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = FormatName::Human)]
    message_format: FormatName,
}

/// Forms of diagnostics by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// Source lines, ranges, suggestions
    Human,
    /// One line each, as editors read it
    Short,
    /// One JSON object a line
    Json,
    /// As the controller's own compiler writes them; nothing without an error
    Vendor,
}

impl CompilerOptions {
    /// The same for the compiler.
    pub(super) fn resolve(&self) -> Result<Options> {
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
            },
            level: if self.optimization == 0 { Level::None } else { Level::Full },
            firmware: self.firmware()?,
            gc_sections: self.gc_sections || (self.optimization > 0 && !self.no_gc_sections),
            addresses: SectionAddresses::default(),
        })
    }

    /// The firmware to link against.
    fn firmware(&self) -> Result<Firmware> {
        let Some(path) = &self.firmware else { return Ok(Firmware::BuiltIn) };
        let file = FirmwareFile::read(&super::run::read(path)?);
        let file = file.with_context(|| format!("`--firmware {}`", path.display()))?;
        Ok(Firmware::File(Arc::new(file)))
    }

    /// The form of the diagnostics.
    pub(super) fn format(&self) -> Format {
        match self.message_format {
            FormatName::Human => Format::Human,
            FormatName::Short => Format::Short,
            FormatName::Json => Format::Json,
            FormatName::Vendor => Format::Vendor,
        }
    }

    /// Which warnings are shown.
    pub(super) fn levels(&self) -> Result<Levels> {
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
