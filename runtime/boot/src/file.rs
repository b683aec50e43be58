//! The firmware file: its loaded sections and its symbols (`dsp-board.md` 2.1 and 10).

use std::collections::BTreeMap;

use coff::{Contents, Image, SectionFlags, SectionNumber, StorageClass, Target};
use kmotiondef::boards::{TargetBoard, moved_objects};
use kmotiondef::map::{IRAM, ROM_SIZE, Region, SDRAM};
use kmotiondef::{Axes, GuestAddr};
use vm::memory::GuestMemory;
use vm::memory::places::Places;

use super::rom::{self, RomFunction};

/// Sections with one of these flags are not loaded; of the loaded ones there must be at least one.
const LEFT_OUT: u32 = 0x12;
const LOADED: u32 = 0xE0;
/// The symbols that all firmware for this board has.
const REQUIRED: [&str; 4] = ["c_int00", "main", "persist", "chan"];
/// The symbol of the version text.
const VERSION: &str = "VersionAndBuildTime";
/// The maximum length of this text.
const VERSION_LENGTH: usize = 80;

/// The reason why a file cannot be started.
#[derive(Debug, thiserror::Error)]
pub enum FirmwareError {
    /// The bytes are not a TI COFF image, or are incomplete.
    #[error("not a firmware file: {0}")]
    NotAnImage(coff::Error),
    /// It is for another processor.
    #[error("not a firmware file: it is for target {0}, the board's processor has {want}", want = Target::C6000)]
    OtherTarget(Target),
    /// It has no entry point.
    #[error(
        "not a firmware file: it has no entry point in the board's memory; is it an object or a library?"
    )]
    NoEntry,
    /// A part of it does not belong to this board.
    #[error(
        "firmware of another board: section {name} at 0x{address:08X} lies outside this board's memory \
         (on-chip RAM at 0x10000000, SDRAM at 0x80000000)"
    )]
    OtherBoard {
        /// The section.
        name: String,
        /// The address to which it would be loaded.
        address: u32,
    },
    /// A symbol that all firmware has is missing.
    #[error(
        "not a firmware file: it has no `{0}`; a user program runs on a firmware, as `cc67 run --boot FIRMWARE PROGRAM`"
    )]
    Missing(&'static str),
}

/// A loaded section.
#[derive(Clone, Debug, PartialEq, Eq)]
struct LoadedSection {
    address: u32,
    /// The bytes; `None` to fill it with 0.
    bytes: Option<Vec<u8>>,
}

/// A firmware file that can be started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareFile {
    entry: u32,
    sections: Vec<LoadedSection>,
    /// Names as programs write them.
    symbols: BTreeMap<String, u32>,
    /// Functions by address.
    functions: BTreeMap<u32, String>,
    /// Functions of the processor's ROM by address.
    rom: BTreeMap<u32, &'static RomFunction>,
    places: Places,
}

impl FirmwareFile {
    /// Reads a file.
    ///
    /// # Errors
    /// The first reason found why the board could not start from it.
    pub fn read(bytes: &[u8]) -> Result<Self, FirmwareError> {
        let image = Image::read(bytes).map_err(FirmwareError::NotAnImage)?;
        if image.target != Target::C6000 {
            return Err(FirmwareError::OtherTarget(image.target));
        }
        let sections = sections(&image)?;
        let symbols = symbols(&image);
        if let Some(name) = REQUIRED.iter().find(|name| !symbols.contains_key(**name)) {
            return Err(FirmwareError::Missing(name));
        }
        let entry = image.program.map(|program| program.entry).ok_or(FirmwareError::NoEntry)?;
        if !sections
            .iter()
            .any(|one| one.bytes.as_ref().is_some_and(|bytes| holds(one.address, bytes, entry)))
        {
            return Err(FirmwareError::NoEntry);
        }
        let rom = rom_functions(&image);
        let mut functions = functions(&image);
        functions.extend(rom.iter().map(|(address, function)| (*address, function.name.to_owned())));
        let version = version_text(&symbols, &sections);
        let places = places(&symbols, &version);
        Ok(Self { entry, sections, symbols, functions, rom, places })
    }

    /// Returns the address at which execution begins.
    #[must_use]
    pub const fn entry(&self) -> u32 {
        self.entry
    }

    /// The address of a variable or function by its C name; `None` if this version does not have it.
    #[must_use]
    pub fn address(&self, name: &str) -> Option<GuestAddr> {
        self.symbols.get(name).copied().map(GuestAddr::new)
    }

    /// The version text of the firmware; empty if it has none.
    #[must_use]
    pub fn version(&self) -> String {
        version_text(&self.symbols, &self.sections)
    }

    /// The function that contains an address, and the offset in it.
    #[must_use]
    pub fn function_at(&self, address: u32) -> Option<(String, u32)> {
        let (start, name) = self.functions.range(..=address).next_back()?;
        Some((name.clone(), address - start))
    }

    /// The function of the processor's ROM at an address, if the file has a symbol for it.
    pub(super) fn rom_function(&self, address: u32) -> Option<&'static RomFunction> {
        self.rom.get(&address).copied()
    }

    /// Returns this firmware's addresses for the variables of the tables.
    pub(super) fn places(&self) -> Places {
        self.places.clone()
    }

    /// Copies the sections to memory.
    pub(super) fn load(&self, memory: &mut GuestMemory) {
        for section in &self.sections {
            if let Some(bytes) = &section.bytes {
                let stored = memory.poke_bytes(GuestAddr::new(section.address), bytes);
                debug_assert!(stored.is_ok(), "sections lie in RAM");
            }
        }
    }
}

fn holds(address: u32, bytes: &[u8], entry: u32) -> bool {
    (entry.wrapping_sub(address) as usize) < bytes.len()
}

/// Returns whether `size` bytes at `address` are within a RAM region.
fn is_inside(region: &Region, address: u32, size: u64) -> bool {
    let offset = u64::from(address.wrapping_sub(region.base.get()));
    offset + size <= u64::from(region.size)
}

fn sections(image: &Image) -> Result<Vec<LoadedSection>, FirmwareError> {
    let is_loaded = |flags: SectionFlags| flags.0 & LEFT_OUT == 0 && flags.0 & LOADED != 0;
    let mut loaded = Vec::new();
    for section in image.sections.iter().filter(|one| one.size() != 0 && is_loaded(one.flags)) {
        let (address, size) = (section.address, section.size());
        if !is_inside(&IRAM, address, size) && !is_inside(&SDRAM, address, size) {
            return Err(FirmwareError::OtherBoard { name: section.name.to_str().into_owned(), address });
        }
        let bytes = match &section.contents {
            Contents::Data(bytes) => Some(bytes.clone()),
            Contents::Uninitialised(_) => None,
        };
        loaded.push(LoadedSection { address, bytes });
    }
    Ok(loaded)
}

/// External symbols, without the underscore that C names have in an image.
fn symbols(image: &Image) -> BTreeMap<String, u32> {
    let external =
        image.symbols.iter().filter(|one| one.class == StorageClass::EXTERNAL && one.section.0 > 0);
    let mut symbols = BTreeMap::new();
    for symbol in external {
        let name = symbol.name.to_str();
        match name.strip_prefix('_') {
            Some(plain) => {
                symbols.insert(plain.to_owned(), symbol.value);
            }
            None => {
                symbols.entry(name.into_owned()).or_insert(symbol.value);
            }
        }
    }
    symbols
}

/// The version text of a firmware; empty if it has none.
fn version_text(symbols: &BTreeMap<String, u32>, sections: &[LoadedSection]) -> String {
    let Some(at) = symbols.get(VERSION) else { return String::new() };
    let holder = sections.iter().find_map(|one| {
        let bytes = one.bytes.as_ref()?;
        bytes.get(usize::try_from(at.checked_sub(one.address)?).ok()?..)
    });
    let text = holder.unwrap_or_default().iter().take(VERSION_LENGTH).take_while(|byte| **byte != 0);
    text.map(|byte| char::from(*byte)).collect()
}

/// Returns the firmware's addresses for the variables of the tables; an unknown version is assumed to have the
/// structures of the default board.
fn places(symbols: &BTreeMap<String, u32>, version: &str) -> Places {
    let board = TargetBoard::of_version(version.trim_ascii_end());
    let layouts = board.map_or(&[][..], TargetBoard::own_structures);
    let address = |name: &str| symbols.get(name).copied().map(GuestAddr::new);
    let objects = moved_objects(address, layouts, Axes::default());
    Places::new(objects.into_iter().map(|object| (object.table, object.size, object.place)))
}

/// Functions of the processor's ROM by address: absolute symbols within it.
fn rom_functions(image: &Image) -> BTreeMap<u32, &'static RomFunction> {
    let absolute = image.symbols.iter().filter(|one| {
        one.class == StorageClass::EXTERNAL && one.section == SectionNumber::ABSOLUTE && one.value < ROM_SIZE
    });
    let named = absolute.filter_map(|one| {
        let name = one.name.to_str();
        Some((one.value, rom::named(name.strip_prefix('_')?)?))
    });
    named.collect()
}

/// Symbols of code by address: external and static ones of sections with code.
fn functions(image: &Image) -> BTreeMap<u32, String> {
    let is_code = |number: i16| {
        let index = usize::try_from(i32::from(number) - 1).ok();
        let section = index.and_then(|index| image.sections.get(index));
        section.is_some_and(|section| section.flags.contains(SectionFlags::TEXT))
    };
    let named = image.symbols.iter().filter(|one| {
        matches!(one.class, StorageClass::EXTERNAL | StorageClass::STATIC) && is_code(one.section.0)
    });
    let names =
        named.filter(|one| !one.name.as_bytes().starts_with(b".") && !one.name.as_bytes().starts_with(b"$"));
    names.map(|one| (one.value, one.name.to_str().trim_start_matches('_').to_owned())).collect()
}
