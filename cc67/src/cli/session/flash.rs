//! The file that a board's flash memory is kept in.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use runtime::FLASH_SIZE;

use crate::cli::io::input::read;
use crate::cli::io::output;

/// A file of flash memory, if there is one, and what it holds.
#[derive(Debug, Default)]
pub(crate) struct Flash {
    path: Option<PathBuf>,
    /// What it held at the start, or was written to it since; nothing if it was not there.
    before: Option<Vec<u8>>,
}

impl Flash {
    /// Reads the file, if it is there.
    pub(super) fn read(path: Option<PathBuf>) -> Result<Self> {
        let Some(path) = path else { return Ok(Self { path: None, before: None }) };
        let before = if path.exists() { Some(read(&path)?) } else { None };
        if let Some(bytes) = before.as_ref().filter(|bytes| bytes.len() != FLASH_SIZE) {
            bail!(
                "{} is not a board's flash: it has {} bytes, not {FLASH_SIZE}",
                path.display(),
                bytes.len()
            );
        }
        Ok(Self { path: Some(path), before })
    }

    /// What a board begins with.
    pub(super) fn contents(&self) -> Option<Vec<u8>> {
        self.before.clone()
    }

    /// A board holds this from the start: only something else is kept.
    pub(super) fn begins_with(&mut self, now: &[u8]) {
        if self.path.is_some() && self.before.is_none() {
            self.before = Some(now.to_vec());
        }
    }

    /// The file and what it holds, if it is there.
    pub(super) fn held(&self) -> Option<(&Path, &[u8])> {
        self.path.as_deref().zip(self.before.as_deref())
    }

    /// Keeps what flash memory holds now, if that is another than before; only looks at it if there is a file.
    pub(crate) fn keep<'m>(&mut self, now: impl FnOnce() -> &'m [u8]) -> Result<()> {
        let Some(path) = &self.path else { return Ok(()) };
        let now = now();
        let is_erased = || now.iter().all(|byte| *byte == 0xFF);
        if self.before.as_ref().map_or_else(|| !is_erased(), |before| before != now) {
            output::write(path, now)?;
            self.before = Some(now.to_vec());
        }
        Ok(())
    }
}
