//! The simulated board's firmware as a file that programs can be linked against.
//!
//! It contains the data used by linkers and by the version check of the vendor's library: every name that programs can
//! use, with the underscore that TI's compiler puts before it, and the version text in `.const`, in a COFF2 file
//! without code.

use coff::{
    BaseType, Container, Contents, Derivation, Error, FileFlags, Image, Name, Program, Section, SectionFlags,
    SectionNumber, StorageClass, Symbol, SymbolType, Target,
};
use kmotiondef::GuestAddr;
use kmotiondef::boards::TargetBoard;

/// The variable that holds the version text.
const VERSION_NAME: &str = "VersionAndBuildTime";

/// Writes the file of a board's firmware.
///
/// # Errors
/// It exceeds the limits of the format.
pub fn export(board: &TargetBoard) -> Result<Vec<u8>, Error> {
    let address = board.variable(VERSION_NAME).map_or(0, GuestAddr::get);
    let text = format!("{}\n\0", board.version).into_bytes();
    let constants = Section {
        name: Name::from(".const"),
        physical: address,
        address,
        flags: SectionFlags::DATA.with_align(8),
        page: 0,
        contents: Contents::Data(text),
        relocations: Vec::new(),
        lines: Vec::new(),
    };
    let image = Image {
        container: if board.has_elf { Container::Elf } else { Container::Coff },
        target: if board.has_elf { Target::C6000 } else { Target::CC67 },
        timestamp: board.time_stamp.filter(|_| !board.is_default()).unwrap_or(0),
        flags: FileFlags::LINKED,
        program: Some(Program { version_stamp: board.version_stamp(), ..Program::default() }),
        sections: vec![constants],
        symbols: symbols(board),
    };
    image.write()
}

fn symbols(board: &TargetBoard) -> Vec<Symbol> {
    let prefix = if board.has_elf { "" } else { "_" };
    let int = SymbolType::new(BaseType::INT);
    let symbol = |(name, address): (&str, GuestAddr)| {
        let is_version = name == VERSION_NAME;
        let is_function = board.function(name).is_some();
        Symbol {
            name: Name::from(format!("{prefix}{name}").as_str()),
            value: address.get(),
            section: if is_version { SectionNumber(1) } else { SectionNumber::ABSOLUTE },
            ty: if is_function { int.derived(Derivation::Function) } else { int },
            class: StorageClass::EXTERNAL,
            aux: Vec::new(),
        }
    };
    board.symbols().into_iter().map(symbol).collect()
}

#[cfg(test)]
mod tests {
    use kmotiondef::boards::boards;

    use super::*;
    use crate::firmware::{BuiltIn, Firmware, FirmwareFile, FirmwareSymbols};

    #[test]
    fn the_exported_file_has_the_symbols_of_the_tables() {
        let board = TargetBoard::default_board();
        let bytes = export(board).expect("it fits");
        let file = FirmwareFile::read(&bytes).expect("it is a firmware file");
        assert_eq!(file.version(), Some(board.version));
        assert_eq!(file.version_stamp(), board.version_stamp());
        let file = Firmware::File(file.into());
        assert_eq!(file.check_version(), Ok(()));
        for name in BuiltIn.symbol_names() {
            assert_eq!(file.find(name), BuiltIn.find(name), "{name}");
        }
        assert!(file.symbol_names().all(|name| BuiltIn.find(name).is_some()));
    }

    #[test]
    fn files_of_other_boards_link_as_the_boards_do() {
        for board in boards() {
            let file = FirmwareFile::read(&export(board).expect("it fits")).expect("it is a firmware file");
            assert_eq!(file.board(), Some(board));
            let file = Firmware::File(file.into());
            for name in FirmwareSymbols::symbol_names(&board) {
                assert_eq!(file.find(name), board.find(name), "{}: {name}", board.name);
            }
        }
    }
}
