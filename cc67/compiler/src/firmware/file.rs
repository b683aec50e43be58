//! A firmware file, against which programs are linked with `--firmware`.
//!
//! The file is an image of the whole firmware. The linker needs its external symbols, the version check the firmware's
//! answer to `Version` (`coff.md` sections 8 and 9.3).

use std::collections::BTreeMap;

use coff::{BaseType, Container, Derivation, File, Image, SectionNumber, StorageClass, SymbolType};
use kmotiondef::GuestAddr;
use kmotiondef::boards::{TargetBoard, stamp};

use super::{FirmwareKind, FirmwareSymbol, FirmwareSymbols};

/// The longest version text, in bytes.
const MAX_VERSION: usize = 80;

/// The reason why a file cannot serve as firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FirmwareError {
    /// The bytes are neither a TI COFF image nor an ELF program.
    #[error("not a firmware file: {0}")]
    NotAnImage(#[from] coff::Error),
    /// The image exports no symbols.
    #[error("not a firmware file: the image has no external symbols")]
    NoSymbols,
}

/// The symbols and the version of a firmware file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareFile {
    /// Address and type of each name, as programs spell it.
    symbols: BTreeMap<String, (GuestAddr, SymbolType)>,
    version: Option<String>,
    time_stamp: u32,
}

impl FirmwareFile {
    /// Reads a file.
    ///
    /// # Errors
    /// It is not an image, or exports no symbols.
    pub fn read(bytes: &[u8]) -> Result<Self, FirmwareError> {
        if let Ok(image @ Image { container: Container::Elf, .. }) = Image::read(bytes) {
            return Self::of_elf(&image);
        }
        let file = File::parse(bytes)?;
        let mut symbols = BTreeMap::new();
        let mut version = None;
        for symbol in file.symbols() {
            let symbol = symbol?;
            if symbol.class() != StorageClass::EXTERNAL {
                continue;
            }
            if symbol.name == b"_VersionAndBuildTime"
                && let Some(section) = file.section(".const")
            {
                let start = section.header().physical.get();
                version = version_text(section.data().unwrap_or_default(), start, symbol.value());
            }
            if is_exported(symbol.ty()) {
                let name = String::from_utf8_lossy(program_name(symbol.name)).into_owned();
                symbols.entry(name).or_insert((GuestAddr::new(symbol.value()), symbol.ty()));
            }
        }
        if symbols.is_empty() {
            return Err(FirmwareError::NoSymbols);
        }
        let time_stamp = file.timestamp();
        Ok(Self { symbols, version, time_stamp })
    }

    /// Takes the symbols and the version of an ELF file, whose names are spelled as in programs.
    fn of_elf(image: &Image) -> Result<Self, FirmwareError> {
        let is_exported =
            |class, section| class == StorageClass::EXTERNAL && section != SectionNumber::UNDEFINED;
        let exported = image.symbols.iter().filter(|symbol| is_exported(symbol.class, symbol.section));
        let symbols: BTreeMap<_, _> = exported
            .map(|symbol| (symbol.name.to_string(), (GuestAddr::new(symbol.value), symbol.ty)))
            .collect();
        if symbols.is_empty() {
            return Err(FirmwareError::NoSymbols);
        }
        let version = symbols.get("VersionAndBuildTime").and_then(|(address, _)| {
            let section = image.section(".const")?;
            version_text(section.data(), section.address, address.get())
        });
        Ok(Self { symbols, version, time_stamp: image.timestamp })
    }

    /// The firmware's answer to `Version`; `None` if the file does not contain it.
    #[must_use]
    pub fn version(&self) -> Option<&str> {
        self.version.as_deref()
    }

    /// The board with this version of the firmware; `None` for an unknown version.
    #[must_use]
    pub fn board(&self) -> Option<&'static TargetBoard> {
        TargetBoard::of_version(self.version()?)
    }

    /// The time stamp in the header of the file.
    #[must_use]
    pub const fn time_stamp(&self) -> u32 {
        self.time_stamp
    }

    /// The stamp of images that are linked against it: 434 for version 4.34, 0 if it is unknown.
    #[must_use]
    pub fn version_stamp(&self) -> i16 {
        self.version.as_deref().and_then(stamp).unwrap_or(0)
    }

    /// Every name with its address.
    pub fn symbols(&self) -> impl Iterator<Item = (&str, GuestAddr)> {
        self.symbols.iter().map(|(name, (address, _))| (name.as_str(), *address))
    }

    /// Every name that programs can use.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.symbols.keys().map(String::as_str)
    }

    /// Reports whether programs can use `name`.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.symbols.contains_key(name)
    }

    /// The symbol of this name.
    ///
    /// The vendor's file declares everything as `int`, including functions, so the tables take precedence. A symbol
    /// with an unknown type may be called as the program declares it.
    pub(super) fn find(&self, name: &str, board: &'static TargetBoard) -> Option<FirmwareSymbol> {
        let (address, ty) = *self.symbols.get(name)?;
        let kind = match board.find(name) {
            Some(known) => known.kind,
            None if ty == INT || ty.outermost() == Some(Derivation::Function) => FirmwareKind::Function(None),
            None => FirmwareKind::Variable,
        };
        Some(FirmwareSymbol { address, kind })
    }
}

/// The type of everything in the vendor's file.
const INT: SymbolType = SymbolType::new(BaseType::INT);

/// Reports whether the vendor's linker takes over symbols of this type.
fn is_exported(ty: SymbolType) -> bool {
    match ty.outermost() {
        Some(Derivation::Function | Derivation::Array) => true,
        Some(Derivation::Pointer) => ty == SymbolType::new(BaseType::STRUCT).derived(Derivation::Pointer),
        None => matches!(ty.base(), BaseType::INT | BaseType::FLOAT | BaseType::DOUBLE | BaseType::STRUCT),
    }
}

/// The name in programs. The firmware's tools put an underscore before each name. Its own `main` keeps it, so that it
/// is not taken for the program's.
fn program_name(name: &[u8]) -> &[u8] {
    match name {
        b"_main" => name,
        [b'_', rest @ ..] => rest,
        _ => name,
    }
}

/// The text at `address`, without its newline; `section` contains the bytes of `.const`, which begins at `start`.
fn version_text(section: &[u8], start: u32, address: u32) -> Option<String> {
    let offset = address.checked_sub(start)?;
    let bytes = section.get(offset as usize..)?;
    let bytes = &bytes[..bytes.len().min(MAX_VERSION)];
    let text = &bytes[..bytes.iter().position(|byte| *byte == 0)?];
    let (_, text) = text.split_last()?;
    Some(String::from_utf8_lossy(text).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_one_underscore() {
        let check = |name: &str, expect: &str| assert_eq!(program_name(name.as_bytes()), expect.as_bytes());
        check("_SetBit", "SetBit");
        check("__divi", "_divi");
        check("_main", "_main");
        check("c_int00", "c_int00");
        check("_", "");
    }

    #[test]
    fn symbol_types_that_the_vendors_linker_omits_are_not_exported() {
        for (code, expect) in
            [(0, false), (4, true), (6, true), (7, true), (8, true), (0x18, true), (0x24, true)]
        {
            assert_eq!(is_exported(SymbolType(code)), expect, "{code:#x}");
        }
        for (code, expect) in [(0x14, false), (0x34, true), (0x20, true), (2, false), (14, false)] {
            assert_eq!(is_exported(SymbolType(code)), expect, "{code:#x}");
        }
    }
}
