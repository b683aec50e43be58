//! The firmware that programs are compiled for and linked against.
//!
//! By default that is the simulated board's own, from the tables of `kmotiondef`
//! ([`BuiltIn`]). `--firmware` names a file instead, the vendor's or one that
//! `cc67 firmware export` wrote: its symbols say which names there are and where, the tables go on
//! saying what their types are, because the file does not.

mod built_in;
mod export;
mod file;
mod names;
mod symbols;

pub use built_in::BuiltIn;
pub use export::export;
pub use file::{FirmwareError, FirmwareFile};
pub use names::{FirmwareNames, Prototype};
pub use symbols::{FirmwareKind, FirmwareSymbol, FirmwareSymbols};

use std::sync::Arc;

use kmotiondef::firmware::Origin;
use kmotiondef::limits::VERSION;

/// Which firmware.
#[derive(Clone, Debug, Default)]
pub enum Firmware {
    /// That of the simulated board.
    #[default]
    BuiltIn,
    /// That of a file.
    File(Arc<FirmwareFile>),
}

impl Firmware {
    /// Whether the firmware has `name`, or the simulated board supplies it to every program.
    fn has(&self, name: &str) -> bool {
        match self {
            Self::BuiltIn => true,
            Self::File(file) => file.has(name) || BuiltIn.origin(name) == Some(Origin::Library),
        }
    }
}

/// The firmware of the simulated board is not that of the file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the firmware file is of `{file}`, the simulated board runs `{board}`")]
pub struct VersionMismatch {
    file: String,
    board: &'static str,
}

impl Firmware {
    /// The version that a firmware file states.
    #[must_use]
    pub fn version(&self) -> Option<&str> {
        match self {
            Self::BuiltIn => None,
            Self::File(file) => file.version(),
        }
    }

    /// Compares the version with that of the simulated board, byte for byte as the vendor's host
    /// library does: a program that is linked for another firmware calls wrong addresses.
    ///
    /// # Errors
    /// If they differ, or the file does not state its version.
    pub fn check_version(&self) -> Result<(), VersionMismatch> {
        let Self::File(file) = self else { return Ok(()) };
        let board = VERSION.trim_end();
        if file.version() == Some(board) {
            return Ok(());
        }
        Err(VersionMismatch { file: file.version().unwrap_or("unknown version").to_owned(), board })
    }
}

impl FirmwareNames for Firmware {
    fn prototype(&self, name: &str) -> Option<Prototype> {
        BuiltIn.prototype(name).filter(|_| self.has(name))
    }

    fn origin(&self, name: &str) -> Option<Origin> {
        BuiltIn.origin(name).filter(|_| self.has(name))
    }

    fn is_variable(&self, name: &str) -> bool {
        BuiltIn.is_variable(name) && self.has(name)
    }

    fn is_hidden(&self, name: &str) -> bool {
        BuiltIn.is_hidden(name) && self.has(name)
    }

    fn is_type(&self, name: &str) -> bool {
        BuiltIn.is_type(name)
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        match self {
            Self::BuiltIn => FirmwareNames::names(&BuiltIn),
            Self::File(file) => Box::new(file.names()),
        }
    }
}

impl FirmwareSymbols for Firmware {
    fn find(&self, name: &str) -> Option<FirmwareSymbol> {
        match self {
            Self::BuiltIn => BuiltIn.find(name),
            Self::File(file) => file.find(name).or_else(|| BuiltIn.find(name).filter(|_| self.has(name))),
        }
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        FirmwareNames::names(self)
    }

    fn version_stamp(&self) -> i16 {
        match self {
            Self::BuiltIn => BuiltIn.version_stamp(),
            Self::File(file) => file.version_stamp(),
        }
    }
}
