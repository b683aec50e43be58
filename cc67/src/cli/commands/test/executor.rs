//! The means of executing tests.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::cli::args::engine::EngineName;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Executor {
    /// An engine, with the modelled firmware.
    Engine(EngineName),
    /// An engine, with threads switched inside statements.
    AsBoard(EngineName),
    /// The user's own firmware file.
    Boot(PathBuf),
    /// The controller at an address.
    Controller(String),
}

impl Executor {
    /// A firmware file; its path is absolute, as tests run in their own folders.
    pub(super) fn firmware(path: &Path) -> Result<Self> {
        let whole = path.canonicalize().with_context(|| format!("cannot read {}", path.display()))?;
        Ok(Self::Boot(whole))
    }

    /// The options of `cc67 run` that select it.
    pub(super) fn options(&self) -> Vec<OsString> {
        match self {
            Self::Engine(engine) => vec!["--engine".into(), engine.name().into()],
            Self::AsBoard(engine) => ["--as", "board", "--engine", engine.name()].map(OsString::from).into(),
            Self::Boot(path) => vec!["--boot".into(), path.into()],
            Self::Controller(address) => vec!["--yes".into(), "--on".into(), address.into()],
        }
    }

    /// The name for reports.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Engine(engine) => engine.name(),
            Self::AsBoard(EngineName::Bytecode) => "bytecode as on the board",
            Self::AsBoard(EngineName::Native) => "native as on the board",
            Self::AsBoard(EngineName::Dsp) => "dsp as on the board",
            Self::Boot(_) => "firmware",
            Self::Controller(_) => "controller",
        }
    }
}
