//! The firmware that programs are compiled for and linked against.
//!
//! By default that is the simulated board's own, from the tables of `kmotiondef` ([`BuiltIn`]); `--board` names another
//! board. `--firmware` names a file instead, the vendor's or one written by `cc67 firmware export`: its symbols give
//! the names and their addresses; the types, which the file does not contain, come from the tables of the board with
//! the same version.

mod board;
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

use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::Origin;

/// The firmware that programs are linked against.
#[derive(Clone, Debug)]
pub enum Firmware {
    /// The firmware of a board.
    Board(&'static TargetBoard),
    /// The firmware of a file.
    File(Arc<FirmwareFile>),
}

impl Default for Firmware {
    fn default() -> Self {
        Self::Board(TargetBoard::default_board())
    }
}

impl Firmware {
    /// The board of the firmware; for an unknown version, the board whose tables are used instead.
    #[must_use]
    pub fn board(&self) -> &'static TargetBoard {
        match self {
            Self::Board(board) => board,
            Self::File(file) => file.board().unwrap_or_else(TargetBoard::default_board),
        }
    }

    /// Reports whether the firmware has `name`, or the simulated board supplies it to every program.
    fn has(&self, name: &str) -> bool {
        match self {
            Self::Board(_) => true,
            Self::File(file) => file.has(name) || self.board().origin(name) == Some(Origin::Library),
        }
    }
}

/// The firmware in a file has an unknown version.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`--firmware`: the firmware file is of `{file}`, the simulated board runs `{board}`")]
pub struct VersionMismatch {
    file: String,
    board: &'static str,
}

impl Firmware {
    /// The version that a firmware file states.
    #[must_use]
    pub fn version(&self) -> Option<&str> {
        match self {
            Self::Board(board) => Some(board.version).filter(|_| !board.is_default()),
            Self::File(file) => file.version(),
        }
    }

    /// Compares the version with that of the [board](Self::board), byte for byte as the vendor's host
    /// library does: a program that is linked for another firmware calls wrong addresses.
    ///
    /// # Errors
    /// They differ, or the file does not state its version.
    pub fn check_version(&self) -> Result<(), VersionMismatch> {
        let board = self.board().version;
        let version = match self {
            Self::Board(own) => Some(own.version),
            Self::File(file) => file.version(),
        };
        if version == Some(board) {
            return Ok(());
        }
        Err(VersionMismatch { file: version.unwrap_or("unknown version").to_owned(), board })
    }
}

impl FirmwareNames for Firmware {
    fn board(&self) -> &'static TargetBoard {
        Self::board(self)
    }

    fn prototype(&self, name: &str) -> Option<Prototype> {
        self.board().prototype(name).filter(|_| self.has(name))
    }

    fn origin(&self, name: &str) -> Option<Origin> {
        self.board().origin(name).filter(|_| self.has(name))
    }

    fn is_variable(&self, name: &str) -> bool {
        self.board().is_variable(name) && self.has(name)
    }

    fn is_hidden(&self, name: &str) -> bool {
        self.board().is_hidden(name) && self.has(name)
    }

    fn is_type(&self, name: &str) -> bool {
        self.board().is_type(name)
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        match self {
            Self::Board(board) => FirmwareNames::names(board),
            Self::File(file) => Box::new(file.names()),
        }
    }
}

impl FirmwareSymbols for Firmware {
    fn find(&self, name: &str) -> Option<FirmwareSymbol> {
        match self {
            Self::Board(board) => board.find(name),
            Self::File(file) => {
                let found = file.find(name, self.board());
                found.or_else(|| self.board().find(name).filter(|_| self.has(name)))
            }
        }
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        FirmwareNames::names(self)
    }

    fn board(&self) -> &'static TargetBoard {
        Self::board(self)
    }

    fn version_stamp(&self) -> i16 {
        match self {
            Self::Board(board) => board.version_stamp(),
            Self::File(file) => file.version_stamp(),
        }
    }

    fn time_stamp(&self) -> u32 {
        match self {
            Self::Board(board) if board.is_default() => 0,
            Self::Board(board) => board.time_stamp.unwrap_or(0),
            Self::File(file) => file.time_stamp(),
        }
    }
}
