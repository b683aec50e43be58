//! Conversion of an image to bytes: reserve, then write.
//!
//! [`Layout::of`] decides the position of each part, in the order of the vendor's tools: headers, raw data,
//! relocations, line numbers, symbols, strings. Writing then only appends, and each part is written at its reserved
//! position.

use std::collections::BTreeMap;

use zerocopy::IntoBytes;
use zerocopy::little_endian::{I16, U16, U32};

use crate::elf;
use crate::error::{Error, ErrorKind, Part};
use crate::image::{Container, Contents, Image, Line, Name, Program, Relocation, Section, Symbol};
use crate::raw;

impl Image {
    /// Writes the image in its file type.
    ///
    /// # Errors
    /// A name contains a NUL, or a number exceeds its field in the format.
    pub fn write(&self) -> Result<Vec<u8>, Error> {
        if self.container == Container::Elf {
            return elf::write(self);
        }
        let layout = Layout::of(self)?;
        let mut bytes = Vec::with_capacity(layout.size);
        self.write_headers(&layout, &mut bytes)?;
        for section in &self.sections {
            bytes.extend_from_slice(section.data());
        }
        for relocation in self.sections.iter().flat_map(|section| &section.relocations) {
            bytes.extend_from_slice(relocation_entry(relocation).as_bytes());
        }
        for line in self.sections.iter().flat_map(|section| &section.lines) {
            bytes.extend_from_slice(line_entry(line).as_bytes());
        }
        for symbol in &self.symbols {
            bytes.extend_from_slice(symbol_entry(symbol, &layout)?.as_bytes());
            for aux in &symbol.aux {
                bytes.extend_from_slice(&aux.0);
            }
        }
        if layout.has_strings {
            bytes.extend_from_slice(&layout.strings.size()?.to_le_bytes());
            bytes.extend_from_slice(&layout.strings.bytes);
        }
        debug_assert_eq!(bytes.len(), layout.size, "written as reserved");
        Ok(bytes)
    }

    fn write_headers(&self, layout: &Layout, bytes: &mut Vec<u8>) -> Result<(), Error> {
        let sections = u16::try_from(self.sections.len())
            .map_err(|_| Error { at: 2, kind: ErrorKind::TooLarge(Part::SectionHeaders) })?;
        let header = raw::FileHeader {
            magic: U16::new(raw::MAGIC),
            sections: U16::new(sections),
            timestamp: U32::new(self.timestamp),
            symbols_at: U32::new(layout.symbols_at),
            symbols: U32::new(offset(self.symbol_entries(), Part::Symbols)?),
            optional_size: U16::new(if self.program.is_some() { 28 } else { 0 }),
            flags: U16::new(self.flags.0),
            target: U16::new(self.target.0),
        };
        bytes.extend_from_slice(header.as_bytes());
        if let Some(program) = &self.program {
            bytes.extend_from_slice(optional_header(program).as_bytes());
        }
        for (section, place) in self.sections.iter().zip(&layout.sections) {
            bytes.extend_from_slice(section_header(section, place, layout)?.as_bytes());
        }
        Ok(())
    }
}

/// The file offsets of the parts of an image.
#[derive(Clone, Debug)]
pub struct Layout {
    sections: Vec<SectionPlace>,
    symbols_at: u32,
    has_strings: bool,
    strings: Strings,
    size: usize,
}

/// The file offsets of the parts of a section.
#[derive(Clone, Copy, Debug)]
struct SectionPlace {
    data_at: u32,
    relocations_at: u32,
    lines_at: u32,
}

impl Layout {
    /// Computes the layout of an image.
    ///
    /// # Errors
    /// A name contains a NUL, or a number exceeds its field in the format.
    pub fn of(image: &Image) -> Result<Self, Error> {
        let optional = if image.program.is_some() { size_of::<raw::OptionalHeader>() } else { 0 };
        let headers = image.sections.len() * size_of::<raw::SectionHeader>();
        let mut end = size_of::<raw::FileHeader>() + optional + headers;
        let mut sections = Vec::with_capacity(image.sections.len());
        for (section, number) in image.sections.iter().zip(1..) {
            let data_at = match section.contents {
                Contents::Data(_) => offset(end, Part::Data(number))?,
                Contents::Uninitialised(_) => 0,
            };
            sections.push(SectionPlace { data_at, relocations_at: 0, lines_at: 0 });
            end += section.data().len();
        }
        for ((section, place), number) in image.sections.iter().zip(&mut sections).zip(1..) {
            if !section.relocations.is_empty() {
                place.relocations_at = offset(end, Part::Relocations(number))?;
            }
            end += section.relocations.len() * size_of::<raw::Relocation>();
        }
        for ((section, place), number) in image.sections.iter().zip(&mut sections).zip(1..) {
            if !section.lines.is_empty() {
                place.lines_at = offset(end, Part::Lines(number))?;
            }
            end += section.lines.len() * size_of::<raw::Line>();
        }
        let symbols_at = offset(end, Part::Symbols)?;
        end += image.symbol_entries() * size_of::<raw::Symbol>();
        let strings = Strings::of(image)?;
        let has_strings = !image.symbols.is_empty() || !strings.bytes.is_empty();
        if has_strings {
            end += Strings::LENGTH_WORD + strings.bytes.len();
        }
        offset(end, Part::File)?;
        Ok(Self { sections, symbols_at, has_strings, strings, size: end })
    }

    /// File offset of entry `line` in the line table of the section at `index`, for the
    /// auxiliary entry of a function.
    #[must_use]
    pub fn line_offset(&self, index: usize, line: u32) -> Option<u32> {
        self.sections.get(index)?.lines_at.checked_add(line.checked_mul(6)?)
    }

    /// The size of the whole file in bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The field for a name: the name itself if it is short, otherwise its offset in the string table.
    fn name_field(&self, name: &Name) -> raw::ShortName {
        if let Some(offset) = self.strings.offsets.get(name) {
            let [a, b, c, d] = offset.to_le_bytes();
            return [0, 0, 0, 0, a, b, c, d];
        }
        let mut field = raw::ShortName::default();
        for (to, from) in field.iter_mut().zip(name.as_bytes()) {
            *to = *from;
        }
        field
    }
}

/// The string table: the names that are too long for their fields, without duplicates.
#[derive(Clone, Debug, Default)]
struct Strings {
    /// The bytes after the length word.
    bytes: Vec<u8>,
    /// Offset of each name, counted from the length word.
    offsets: BTreeMap<Name, u32>,
}

impl Strings {
    /// The size of the length word in bytes.
    const LENGTH_WORD: usize = 4;

    fn of(image: &Image) -> Result<Self, Error> {
        let mut strings = Self::default();
        let sections = image.sections.iter().map(|section| &section.name);
        for name in sections.chain(image.symbols.iter().map(|symbol| &symbol.name)) {
            if name.as_bytes().contains(&0) {
                return Err(Error { at: 0, kind: ErrorKind::NulInName });
            }
            if name.as_bytes().len() > size_of::<raw::ShortName>() && !strings.offsets.contains_key(name) {
                strings.offsets.insert(name.clone(), strings.size()?);
                strings.bytes.extend_from_slice(name.as_bytes());
                strings.bytes.push(0);
            }
        }
        Ok(strings)
    }

    /// The size of the table as stored in the length word: by TI's convention, including the length word itself.
    fn size(&self) -> Result<u32, Error> {
        offset(Self::LENGTH_WORD + self.bytes.len(), Part::Strings)
    }
}

/// A count or offset in the format's representation.
fn offset(value: usize, part: Part) -> Result<u32, Error> {
    u32::try_from(value).map_err(|_| Error { at: u64::from(u32::MAX), kind: ErrorKind::TooLarge(part) })
}

fn optional_header(program: &Program) -> raw::OptionalHeader {
    raw::OptionalHeader {
        magic: I16::new(raw::OPTIONAL_MAGIC),
        version_stamp: I16::new(program.version_stamp),
        text_size: U32::new(program.text_size),
        data_size: U32::new(program.data_size),
        bss_size: U32::new(program.bss_size),
        entry: U32::new(program.entry),
        text_start: U32::new(program.text_start),
        data_start: U32::new(program.data_start),
    }
}

fn section_header(
    section: &Section,
    place: &SectionPlace,
    layout: &Layout,
) -> Result<raw::SectionHeader, Error> {
    let size = match &section.contents {
        Contents::Data(bytes) => offset(bytes.len(), Part::SectionHeaders)?,
        Contents::Uninitialised(size) => *size,
    };
    Ok(raw::SectionHeader {
        name: layout.name_field(&section.name),
        physical: U32::new(section.physical),
        address: U32::new(section.address),
        size: U32::new(size),
        data_at: U32::new(place.data_at),
        relocations_at: U32::new(place.relocations_at),
        lines_at: U32::new(place.lines_at),
        relocations: U32::new(offset(section.relocations.len(), Part::SectionHeaders)?),
        lines: U32::new(offset(section.lines.len(), Part::SectionHeaders)?),
        flags: U32::new(section.flags.0),
        reserved: U16::ZERO,
        page: U16::new(section.page),
    })
}

fn relocation_entry(relocation: &Relocation) -> raw::Relocation {
    raw::Relocation {
        address: U32::new(relocation.address),
        symbol: U32::new(relocation.symbol),
        displacement: U16::new(relocation.displacement),
        kind: U16::new(relocation.kind),
    }
}

fn line_entry(line: &Line) -> raw::Line {
    match *line {
        Line::Function(symbol) => raw::Line { address: U32::new(symbol), line: U16::ZERO },
        Line::Statement { address, line } => {
            raw::Line { address: U32::new(address), line: U16::new(line.get()) }
        }
    }
}

fn symbol_entry(symbol: &Symbol, layout: &Layout) -> Result<raw::Symbol, Error> {
    let auxiliaries = u8::try_from(symbol.aux.len()).map_err(|_| Error {
        at: u64::from(layout.symbols_at),
        kind: ErrorKind::TooLarge(Part::Auxiliaries),
    })?;
    Ok(raw::Symbol {
        name: layout.name_field(&symbol.name),
        value: U32::new(symbol.value),
        section: I16::new(symbol.section.0),
        ty: U16::new(symbol.ty.0),
        class: symbol.class.0,
        auxiliaries,
    })
}
