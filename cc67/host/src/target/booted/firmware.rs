//! A firmware file that has started: the state in which sessions begin, and the symbols against which programs are
//! linked.

use std::path::Path;
use std::sync::Arc;

use boot::{BootedBoard, BootedSnapshot, FirmwareFile, FlashError, HaltError};
use compiler::Options;
use compiler::firmware::{Firmware, FirmwareFile as Symbols};
use compiler::target::Target as CodeTarget;
use kmotiondef::timing::{Timing, WaitStates};

/// The reason for which a firmware file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FirmwareError {
    /// It cannot be read.
    #[error("{0}")]
    Read(String),
    /// It is not a firmware file.
    #[error(transparent)]
    File(#[from] boot::FirmwareError),
    /// Its symbols cannot be read.
    #[error(transparent)]
    Symbols(#[from] compiler::firmware::FirmwareError),
    /// It does not start.
    #[error(transparent)]
    Halted(#[from] HaltError),
}

/// A firmware file that has started; any number of sessions can begin from it.
#[derive(Clone, Debug)]
pub struct BootedFirmware {
    file: Arc<FirmwareFile>,
    ready: Arc<BootedSnapshot>,
    symbols: Firmware,
}

impl BootedFirmware {
    /// Starts the firmware of a file.
    ///
    /// # Errors
    /// It is not a firmware file, or does not start.
    pub fn new(bytes: &[u8]) -> Result<Self, FirmwareError> {
        let file = Arc::new(FirmwareFile::read(bytes)?);
        let symbols = Symbols::read(bytes)?;
        let mut board = BootedBoard::booted(Arc::clone(&file))?;
        let ready = Arc::new(board.snapshot());
        Ok(Self { file, ready, symbols: Firmware::File(Arc::new(symbols)) })
    }

    /// Boots the firmware of a named file.
    ///
    /// # Errors
    /// The file cannot be read, or an error as for [`new`](Self::new).
    pub fn open(path: &Path) -> Result<Self, FirmwareError> {
        let bytes = compiler::files::read(path).map_err(|error| {
            FirmwareError::Read(format!(
                "cannot read {}: {}",
                path.display(),
                compiler::files::reason(&error)
            ))
        })?;
        Self::new(&bytes)
    }

    /// Returns the options for programs of this firmware: for the processor, against its symbols, with the execution
    /// time of its instructions when memory never stalls.
    #[must_use]
    pub fn options(&self, options: Options) -> Options {
        let timing = Timing::Vendor(WaitStates::NONE);
        Options { target: CodeTarget::C67x, firmware: self.symbols.clone(), timing, ..options }
    }

    /// A board on which the firmware is ready, started from the contents of its flash if given.
    ///
    /// # Errors
    /// The flash belongs to another firmware, or the firmware does not start from it.
    pub(super) fn board(&self, flash: Option<&[u8]>) -> Result<BootedBoard, FlashError> {
        match flash {
            Some(flash) => BootedBoard::booted_from(Arc::clone(&self.file), flash),
            None => Ok(self.ready.board()),
        }
    }
}
