//! Bytes to an image; every offset is checked.
//!
//! The parts of a file may lie anywhere, and the same bytes could be claimed by many of
//! them. What the image takes is therefore charged against the length of the file, so that
//! a small file cannot make a large image.

use std::num::NonZeroU16;

use zerocopy::FromBytes;

use crate::error::{Error, ErrorKind, Part};
use crate::image::{Aux, Contents, Image, Line, Name, Program, Section, Symbol};
use crate::names::{FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target};
use crate::raw;

impl Image {
    /// Reads an image.
    ///
    /// # Errors
    /// If the bytes are no complete little-endian COFF2 image, or one that is not linked.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        Reader::new(bytes).image()
    }
}

/// How often the names of an image may use the same bytes of the string table, on average.
const NAME_SHARING: u64 = 4;

/// The file and what the image may still take of it.
struct Reader<'a> {
    bytes: &'a [u8],
    /// Where the string table begins, its length word included.
    strings_at: u64,
    data_left: u64,
    lines_left: u64,
    names_left: u64,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let size = length(bytes);
        Self {
            bytes,
            strings_at: size,
            data_left: size,
            lines_left: size,
            names_left: size.saturating_mul(NAME_SHARING),
        }
    }

    fn image(mut self) -> Result<Image, Error> {
        let header: raw::FileHeader = self.structure(0, Part::FileHeader)?;
        match header.magic.get() {
            raw::MAGIC => {}
            raw::MAGIC_BIG_ENDIAN => return Err(Error { at: 0, kind: ErrorKind::BigEndian }),
            magic => return Err(Error { at: 0, kind: ErrorKind::Magic(magic) }),
        }
        self.find_strings(&header)?;
        Ok(Image {
            target: Target(header.target.get()),
            timestamp: header.timestamp.get(),
            flags: FileFlags(header.flags.get()),
            program: self.program(&header)?,
            sections: self.sections(&header)?,
            symbols: self.symbols(&header)?,
        })
    }

    /// The string table is whatever follows the symbols. Its length word counts itself or not,
    /// depending on the tool, and is therefore only compared with the file.
    fn find_strings(&mut self, header: &raw::FileHeader) -> Result<(), Error> {
        let symbols_at = u64::from(header.symbols_at.get());
        let symbols_size = u64::from(header.symbols.get()) * size::<raw::Symbol>();
        if symbols_size > 0 {
            self.slice(symbols_at, symbols_size, Part::Symbols)?;
        }
        let strings_at = symbols_at + symbols_size;
        if symbols_at == 0 || strings_at >= length(self.bytes) {
            return Ok(());
        }
        let word = self.slice(strings_at, 4, Part::Strings)?;
        let stated = u64::from(word.try_into().map(u32::from_le_bytes).unwrap_or_default());
        self.slice(strings_at, stated, Part::Strings)?;
        self.strings_at = strings_at;
        Ok(())
    }

    fn program(&self, header: &raw::FileHeader) -> Result<Option<Program>, Error> {
        let at = size::<raw::FileHeader>();
        let optional = u64::from(header.optional_size.get());
        self.slice(at, optional, Part::OptionalHeader)?;
        if optional != size::<raw::OptionalHeader>() {
            return Ok(None);
        }
        let optional: raw::OptionalHeader = self.structure(at, Part::OptionalHeader)?;
        Ok(Some(Program {
            version_stamp: optional.version_stamp.get(),
            text_size: optional.text_size.get(),
            data_size: optional.data_size.get(),
            bss_size: optional.bss_size.get(),
            entry: optional.entry.get(),
            text_start: optional.text_start.get(),
            data_start: optional.data_start.get(),
        }))
    }

    fn sections(&mut self, header: &raw::FileHeader) -> Result<Vec<Section>, Error> {
        let at = size::<raw::FileHeader>() + u64::from(header.optional_size.get());
        let count = u64::from(header.sections.get());
        self.slice(at, count * size::<raw::SectionHeader>(), Part::SectionHeaders)?;
        (1..)
            .zip(0..count)
            .map(|(number, index)| self.section(number, at + index * size::<raw::SectionHeader>()))
            .collect()
    }

    fn section(&mut self, number: usize, at: u64) -> Result<Section, Error> {
        let header: raw::SectionHeader = self.structure(at, Part::SectionHeaders)?;
        if header.relocations.get() != 0 {
            return Err(Error { at, kind: ErrorKind::Relocations { section: number } });
        }
        Ok(Section {
            name: self.name(header.name, at)?,
            physical: header.physical.get(),
            address: header.address.get(),
            flags: SectionFlags(header.flags.get()),
            page: header.page.get(),
            contents: self.contents(&header, number)?,
            lines: self.lines(&header, number)?,
        })
    }

    fn contents(&mut self, header: &raw::SectionHeader, number: usize) -> Result<Contents, Error> {
        let (at, size) = (u64::from(header.data_at.get()), u64::from(header.size.get()));
        if at == 0 {
            return Ok(Contents::Uninitialised(header.size.get()));
        }
        let data = self.slice(at, size, Part::Data(number))?;
        spend(&mut self.data_left, size, at, Part::Data(number))?;
        Ok(Contents::Data(data.to_vec()))
    }

    fn lines(&mut self, header: &raw::SectionHeader, number: usize) -> Result<Vec<Line>, Error> {
        let count = u64::from(header.lines.get());
        if count == 0 {
            return Ok(Vec::new());
        }
        let (at, size) = (u64::from(header.lines_at.get()), count * size::<raw::Line>());
        let table = self.slice(at, size, Part::Lines(number))?;
        spend(&mut self.lines_left, size, at, Part::Lines(number))?;
        let entries: &[raw::Line] = <[raw::Line]>::ref_from_bytes(table).unwrap_or_default();
        Ok(entries.iter().map(line).collect())
    }

    fn symbols(&mut self, header: &raw::FileHeader) -> Result<Vec<Symbol>, Error> {
        if header.symbols.get() == 0 {
            return Ok(Vec::new());
        }
        let at = u64::from(header.symbols_at.get());
        let table = self.slice(at, u64::from(header.symbols.get()) * size::<raw::Symbol>(), Part::Symbols)?;
        let entries: &[raw::Symbol] = <[raw::Symbol]>::ref_from_bytes(table).unwrap_or_default();
        let mut rest = (0..).map(|index| at + index * size::<raw::Symbol>()).zip(entries);
        let mut symbols = Vec::new();
        while let Some((at, entry)) = rest.next() {
            let aux: Vec<_> =
                rest.by_ref().take(entry.auxiliaries.into()).map(|(_, entry)| Aux::new(entry)).collect();
            if aux.len() < entry.auxiliaries.into() {
                let left = u32::try_from(aux.len()).unwrap_or(u32::MAX);
                return Err(Error { at, kind: ErrorKind::Auxiliary { count: entry.auxiliaries, left } });
            }
            symbols.push(Symbol {
                name: self.name(entry.name, at)?,
                value: entry.value.get(),
                section: SectionNumber(entry.section.get()),
                ty: SymbolType(entry.ty.get()),
                class: StorageClass(entry.class),
                aux,
            });
        }
        Ok(symbols)
    }

    /// A name of up to eight bytes, or four zeros and an offset into the string table. Offsets
    /// count from the length word in either convention; offset 0 is the empty name.
    fn name(&mut self, field: raw::ShortName, at: u64) -> Result<Name, Error> {
        let [0, 0, 0, 0, offset @ ..] = field else {
            return Ok(Name::new(until_nul(&field)));
        };
        let offset = u32::from_le_bytes(offset);
        if offset == 0 {
            return Ok(Name::default());
        }
        let strings = usize::try_from(self.strings_at).ok().and_then(|start| self.bytes.get(start..));
        let strings = strings.unwrap_or_default();
        let text = usize::try_from(offset).ok().and_then(|start| strings.get(start..));
        match text {
            Some(text) if offset >= 4 && !text.is_empty() => {
                let name = until_nul(text);
                spend(&mut self.names_left, length(name), at, Part::Names)?;
                Ok(Name::new(name))
            }
            _ => Err(Error { at, kind: ErrorKind::Name { offset, size: length(strings) } }),
        }
    }

    fn structure<T: FromBytes>(&self, at: u64, part: Part) -> Result<T, Error> {
        let bytes = self.slice(at, size::<T>(), part)?;
        T::read_from_bytes(bytes)
            .map_err(|_| Error { at, kind: ErrorKind::Truncated { part, size: size::<T>() } })
    }

    /// `size` bytes of the file from `at` on.
    fn slice(&self, at: u64, size: u64, part: Part) -> Result<&'a [u8], Error> {
        let range =
            usize::try_from(at).ok().zip(at.checked_add(size).and_then(|end| usize::try_from(end).ok()));
        range
            .and_then(|(start, end)| self.bytes.get(start..end))
            .ok_or(Error { at, kind: ErrorKind::Truncated { part, size } })
    }
}

/// Takes `amount` of what is left, or says that `part` overlaps with what was taken before.
fn spend(left: &mut u64, amount: u64, at: u64, part: Part) -> Result<(), Error> {
    *left = left.checked_sub(amount).ok_or(Error { at, kind: ErrorKind::Overlap(part) })?;
    Ok(())
}

fn line(entry: &raw::Line) -> Line {
    match NonZeroU16::new(entry.line.get()) {
        Some(line) => Line::Statement { address: entry.address.get(), line },
        None => Line::Function(entry.address.get()),
    }
}

fn until_nul(bytes: &[u8]) -> &[u8] {
    bytes.split(|byte| *byte == 0).next().unwrap_or_default()
}

/// The length of a slice; a usize has at most 64 bits.
fn length(bytes: &[u8]) -> u64 {
    u64::try_from(bytes.len()).unwrap_or(u64::MAX)
}

/// The size of a structure; none has more than 48 bytes.
fn size<T>() -> u64 {
    u64::try_from(size_of::<T>()).unwrap_or(u64::MAX)
}
