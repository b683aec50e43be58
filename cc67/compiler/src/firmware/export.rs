//! The simulated board's firmware as a file that programs can be linked against.
//!
//! It has what linkers and the version check of the vendor's library look at: every name that
//! programs can use, with the underscore that TI's compiler puts before it, and the version
//! text in `.const`. There is no code in it.

use coff::{
    BaseType, Contents, Derivation, Error, FileFlags, Image, Name, Program, Section, SectionFlags,
    SectionNumber, StorageClass, Symbol, SymbolType, Target,
};
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS, Origin};
use kmotiondef::limits::{VERSION, VERSION_STAMP};
use kmotiondef::variables::{FIRMWARE_VARIABLES, variable_named};

/// The variable that holds the version text.
const VERSION_NAME: &str = "VersionAndBuildTime";

/// Writes the file.
///
/// # Errors
/// If it exceeds what the format can count.
pub fn export() -> Result<Vec<u8>, Error> {
    let address = variable_named(VERSION_NAME).map_or(0, |variable| variable.address.get());
    let mut text = VERSION.as_bytes().to_vec();
    text.push(0);
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
        target: Target::CC67,
        timestamp: 0,
        flags: FileFlags::LINKED,
        program: Some(Program { version_stamp: VERSION_STAMP, ..Program::default() }),
        sections: vec![constants],
        symbols: symbols(),
    };
    image.write()
}

fn symbols() -> Vec<Symbol> {
    let int = SymbolType::new(BaseType::INT);
    let symbol = |name: &str, value, section, ty| Symbol {
        name: Name::from(format!("_{name}").as_str()),
        value,
        section,
        ty,
        class: StorageClass::EXTERNAL,
        aux: Vec::new(),
    };
    let functions = FIRMWARE_FUNCTIONS
        .iter()
        .filter(|function| function.origin != Origin::Library && !ABSENT.contains(&function.name));
    let functions = functions.map(|function| {
        let ty = int.derived(Derivation::Function);
        symbol(function.name, function.address.get(), SectionNumber::ABSOLUTE, ty)
    });
    let variables = FIRMWARE_VARIABLES.iter().filter(|variable| !ABSENT.contains(&variable.name));
    let variables = variables.map(|variable| {
        let is_version = variable.name == VERSION_NAME;
        let section = if is_version { SectionNumber(1) } else { SectionNumber::ABSOLUTE };
        symbol(variable.name, variable.address.get(), section, int)
    });
    functions.chain(variables).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::{BuiltIn, Firmware, FirmwareFile, FirmwareSymbols};

    #[test]
    fn the_exported_file_has_the_symbols_of_the_tables() {
        let bytes = export().expect("it fits");
        let file = FirmwareFile::read(&bytes).expect("it is a firmware file");
        assert_eq!(file.version(), Some(VERSION.trim_end()));
        assert_eq!(file.version_stamp(), VERSION_STAMP);
        let file = Firmware::File(file.into());
        assert_eq!(file.check_version(), Ok(()));
        for name in BuiltIn.symbol_names() {
            assert_eq!(file.find(name), BuiltIn.find(name), "{name}");
        }
        assert!(file.symbol_names().all(|name| BuiltIn.find(name).is_some()));
    }
}
