//! The functions and objects of an image.

use std::cmp::Reverse;
use std::fmt::Write as _;

use coff::{BaseType, Container, Derivation, Image, SectionNumber, StorageClass, Symbol, Target};

use super::Inspection;

/// The kind of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A function.
    Function,
    /// An object.
    Object,
    /// A jump target or a constant without a name.
    Label,
    /// A function or variable of the firmware, or a limit of a section.
    Absolute,
    /// Something that another object defines.
    Undefined,
}

impl EntryKind {
    /// In one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Function => "function",
            Self::Object => "object",
            Self::Label => "label",
            Self::Absolute => "absolute",
            Self::Undefined => "undefined",
        }
    }
}

/// A function or object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its address.
    pub address: u32,
    /// Its size in bytes, if the image has it.
    pub size: Option<u32>,
    /// Its section, or its other location.
    pub section: String,
    /// Its kind.
    pub kind: EntryKind,
    /// True if other units see it.
    pub is_external: bool,
    /// The file of a function.
    pub file: Option<String>,
}

/// The order of a list of symbols.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// By address.
    Address,
    /// The largest first.
    Size,
    /// By name.
    Name,
}

/// Everything of the symbol table that has a name and an address, by address.
pub(super) fn collect(image: &Image) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut files = Vec::new();
    for symbol in &image.symbols {
        if symbol.class == StorageClass::FILE {
            files.push(symbol.name.to_string());
        }
        // In an image, a function follows its file; an object lists all files first, and each function refers to its
        // file.
        if image.program.is_none()
            && symbol.class == StorageClass::FUNCTION
            && symbol.name.as_bytes() == b".bf"
        {
            let number = symbol.aux.first().map(|aux| aux.as_boundary().tag.get() as usize);
            if let Some((file, entry)) = number.and_then(|number| files.get(number)).zip(entries.last_mut()) {
                entry.file = Some(file.clone());
            }
        }
        let is_listed =
            matches!(symbol.class, StorageClass::EXTERNAL | StorageClass::STATIC | StorageClass::LABEL);
        if !is_listed || symbol.name.as_bytes().is_empty() {
            continue;
        }
        let kind = kind(image, symbol);
        entries.push(Entry {
            name: symbol.name.to_string(),
            address: symbol.value,
            size: size(image, symbol, kind),
            section: section(image, symbol),
            kind,
            is_external: symbol.class == StorageClass::EXTERNAL,
            // In an ELF file, external functions follow the functions of all files.
            file: files.last().filter(|_| kind == EntryKind::Function && !is_elf(image)).cloned(),
        });
    }
    // Of several names for one address, the most useful comes last, where it is found.
    entries.sort_by_key(|entry| (entry.address, entry.kind != EntryKind::Absolute, entry.size));
    entries
}

fn kind(image: &Image, symbol: &Symbol) -> EntryKind {
    if symbol.class == StorageClass::LABEL {
        return EntryKind::Label;
    }
    match symbol.section {
        SectionNumber::UNDEFINED => EntryKind::Undefined,
        SectionNumber::ABSOLUTE => EntryKind::Absolute,
        _ if is_elf(image) => match symbol.ty.outermost() {
            Some(Derivation::Function) => EntryKind::Function,
            _ if symbol.ty.base() == BaseType::STRUCT => EntryKind::Object,
            _ => EntryKind::Label,
        },
        SectionNumber(1) => EntryKind::Function,
        _ if image.target == Target::CC67 => EntryKind::Object,
        // The vendor's compiler writes section 2 for everything, so the address decides.
        _ if is_inside_program(image, symbol.value) => EntryKind::Object,
        _ => EntryKind::Absolute,
    }
}

/// Reports whether the file states the types and sections of its symbols.
fn is_elf(image: &Image) -> bool {
    image.container == Container::Elf
}

/// Reports whether an address is between the first and the last byte of the program.
fn is_inside_program(image: &Image, address: u32) -> bool {
    let sections = image.sections.iter().filter(|section| section.size() > 0);
    let start = sections.clone().map(|section| section.address).min().unwrap_or(0);
    let end = sections.map(|section| u64::from(section.address) + section.size()).max().unwrap_or(0);
    let bss = image.program.map_or(0, |program| u64::from(program.bss_size) + 32);
    (u64::from(start)..end + bss).contains(&u64::from(address))
}

/// Returns the size of a symbol, if it has one. The vendor's compiler writes an entry without a size after everything
/// except functions.
fn size(image: &Image, symbol: &Symbol, kind: EntryKind) -> Option<u32> {
    let has_size = image.target == Target::CC67 || is_elf(image) || kind == EntryKind::Function;
    symbol.size().filter(|_| has_size)
}

fn section(image: &Image, symbol: &Symbol) -> String {
    let index = usize::try_from(symbol.section.0).ok().and_then(|number| number.checked_sub(1));
    match index.and_then(|index| image.sections.get(index)) {
        Some(section) if image.target == Target::CC67 || is_elf(image) || section.flags.0 & 0x20 != 0 => {
            section.name.to_string()
        }
        Some(_) => {
            let found = image.sections.iter().find(|section| {
                let start = u64::from(section.address);
                (start..start + section.size()).contains(&u64::from(symbol.value))
            });
            found.map_or_else(|| "-".to_owned(), |section| section.name.to_string())
        }
        None if symbol.section == SectionNumber(3) => ".bss".to_owned(),
        None => symbol.section.to_string(),
    }
}

impl Inspection {
    /// The symbols in the given order.
    #[must_use]
    pub fn sorted(&self, order: Order) -> Vec<&Entry> {
        let mut entries: Vec<_> = self.symbols.iter().collect();
        match order {
            Order::Address => {}
            Order::Size => entries.sort_by_key(|entry| Reverse(entry.size)),
            Order::Name => entries.sort_by(|a, b| a.name.cmp(&b.name)),
        }
        entries
    }

    /// The symbols as a table.
    #[must_use]
    pub fn symbol_table(&self, order: Order) -> String {
        if self.symbols.is_empty() {
            return "no symbols\n".to_owned();
        }
        let mut out = String::from("address      size section  kind      name\n");
        for entry in self.sorted(order) {
            let size = entry.size.map_or_else(|| "-".to_owned(), |size| size.to_string());
            let local = if entry.is_external { "" } else { " (static)" };
            let file = entry.file.as_ref().map_or_else(String::new, |file| format!(" in {file}"));
            // Writing to a string cannot fail.
            let _ = writeln!(
                out,
                "{:08x} {size:>8} {:8} {:9} {}{local}{file}",
                entry.address,
                entry.section,
                entry.kind.name(),
                entry.name
            );
        }
        out
    }
}
