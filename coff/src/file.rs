//! A checked view of a file's bytes: headers, sections and symbols, without copying.
//!
//! [`File::parse`] checks that every part named in the headers lies inside the file. Names are checked only when they
//! are requested, because most readers need few of them.

use std::num::NonZeroU16;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::error::{Error, ErrorKind, Part};
use crate::image::{Aux, Line, Program, Relocation};
use crate::names::{FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target};
use crate::raw;

/// The checked bytes of an image.
#[derive(Clone, Copy, Debug)]
pub struct File<'a> {
    bytes: &'a [u8],
    header: raw::FileHeader,
    optional: Option<raw::OptionalHeader>,
    sections_at: u64,
    sections: &'a [raw::SectionHeader],
    symbols: &'a [raw::Symbol],
    /// The string table from its length word to the end of the file; empty if there is none.
    strings: &'a [u8],
}

impl<'a> File<'a> {
    /// Parses and checks the headers.
    ///
    /// # Errors
    /// The bytes are not a complete little-endian COFF2 image.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, Error> {
        let header: raw::FileHeader = structure(bytes, 0, Part::FileHeader)?;
        match header.magic.get() {
            raw::MAGIC => {}
            raw::MAGIC_BIG_ENDIAN => return Err(Error { at: 0, kind: ErrorKind::BigEndian }),
            magic => return Err(Error { at: 0, kind: ErrorKind::Magic(magic) }),
        }
        let optional_at = size::<raw::FileHeader>();
        let optional_size = u64::from(header.optional_size.get());
        slice(bytes, optional_at, optional_size, Part::OptionalHeader)?;
        let optional = if optional_size == size::<raw::OptionalHeader>() {
            Some(structure(bytes, optional_at, Part::OptionalHeader)?)
        } else {
            None
        };
        let symbols_at = u64::from(header.symbols_at.get());
        let symbols = array(bytes, symbols_at, header.symbols.get(), Part::Symbols)?;
        let strings = strings(bytes, &header)?;
        let sections_at = optional_at + optional_size;
        let count = u32::from(header.sections.get());
        let sections = array(bytes, sections_at, count, Part::SectionHeaders)?;
        let file = Self { bytes, header, optional, sections_at, sections, symbols, strings };
        file.sections().try_for_each(|section| section?.check())?;
        Ok(file)
    }

    /// The processor for which it was made.
    #[must_use]
    pub fn target(&self) -> Target {
        Target(self.header.target.get())
    }

    /// The creation time, in Unix seconds.
    #[must_use]
    pub fn timestamp(&self) -> u32 {
        self.header.timestamp.get()
    }

    /// The flags: parts that were stripped, and whether the image is complete.
    #[must_use]
    pub fn flags(&self) -> FileFlags {
        FileFlags(self.header.flags.get())
    }

    /// Entry point and sizes; `None` if the file has no optional header of the usual size.
    #[must_use]
    pub fn program(&self) -> Option<Program> {
        let optional = self.optional?;
        Some(Program {
            version_stamp: optional.version_stamp.get(),
            text_size: optional.text_size.get(),
            data_size: optional.data_size.get(),
            bss_size: optional.bss_size.get(),
            entry: optional.entry.get(),
            text_start: optional.text_start.get(),
            data_start: optional.data_start.get(),
        })
    }

    /// The sections; an error for a name outside the string table.
    pub fn sections(&self) -> impl Iterator<Item = Result<SectionView<'a>, Error>> {
        let file = *self;
        (1..).zip(self.sections).zip(self.section_offsets()).map(move |((number, header), at)| {
            Ok(SectionView { bytes: file.bytes, at, number, header, name: file.name(&header.name, at)? })
        })
    }

    /// The section called `name`, if its header can be read.
    #[must_use]
    pub fn section(&self, name: &str) -> Option<SectionView<'a>> {
        self.sections().filter_map(Result::ok).find(|section| section.name == name.as_bytes())
    }

    /// The symbols with their auxiliary entries; an error for entries that extend beyond the table.
    pub fn symbols(&self) -> impl Iterator<Item = Result<SymbolView<'a>, Error>> {
        let file = *self;
        let mut index = 0;
        std::iter::from_fn(move || {
            let (entry, rest) = file.symbols.get(index..)?.split_first()?;
            let at = u64::from(file.header.symbols_at.get()) + count(index) * size::<raw::Symbol>();
            let symbol = file.symbol(index, entry, rest, at);
            index += 1 + usize::from(entry.auxiliaries);
            Some(symbol)
        })
    }

    fn symbol(
        &self,
        index: usize,
        entry: &'a raw::Symbol,
        rest: &'a [raw::Symbol],
        at: u64,
    ) -> Result<SymbolView<'a>, Error> {
        let Some(aux) = rest.get(..usize::from(entry.auxiliaries)) else {
            let left = u32::try_from(rest.len()).unwrap_or(u32::MAX);
            return Err(Error { at, kind: ErrorKind::Auxiliary { count: entry.auxiliaries, left } });
        };
        let aux = <[Aux]>::ref_from_bytes(aux.as_bytes()).unwrap_or_default();
        let index = u32::try_from(index).unwrap_or(u32::MAX);
        Ok(SymbolView { index, at, name: self.name(&entry.name, at)?, entry, aux })
    }

    /// The file offset of each section header.
    fn section_offsets(&self) -> impl Iterator<Item = u64> + use<> {
        let start = self.sections_at;
        (0..).map(move |index| start + index * size::<raw::SectionHeader>())
    }

    /// A name of up to eight bytes, or four zeros and an offset into the string table. Offsets count from the length
    /// word in both conventions; offset 0 is the empty name.
    fn name(&self, field: &'a raw::ShortName, at: u64) -> Result<&'a [u8], Error> {
        let [0, 0, 0, 0, offset @ ..] = *field else {
            return Ok(until_nul(field));
        };
        let offset = u32::from_le_bytes(offset);
        if offset == 0 {
            return Ok(&[]);
        }
        let text = usize::try_from(offset).ok().and_then(|start| self.strings.get(start..));
        match text {
            Some(text) if offset >= 4 && !text.is_empty() => Ok(until_nul(text)),
            _ => Err(Error { at, kind: ErrorKind::Name { offset, size: count(self.strings.len()) } }),
        }
    }
}

/// A section in a file.
#[derive(Clone, Copy, Debug)]
pub struct SectionView<'a> {
    bytes: &'a [u8],
    at: u64,
    number: usize,
    header: &'a raw::SectionHeader,
    /// Its name.
    pub name: &'a [u8],
}

impl<'a> SectionView<'a> {
    /// Its header.
    #[must_use]
    pub const fn header(&self) -> &'a raw::SectionHeader {
        self.header
    }

    /// The file offset of its header.
    #[must_use]
    pub const fn offset(&self) -> u64 {
        self.at
    }

    /// The flags: its kind and alignment.
    #[must_use]
    pub fn flags(&self) -> SectionFlags {
        SectionFlags(self.header.flags.get())
    }

    /// Its bytes; `None` if they are not in the file.
    #[must_use]
    pub fn data(&self) -> Option<&'a [u8]> {
        self.checked_data().ok().flatten()
    }

    /// Its relocations.
    pub fn relocations(&self) -> impl ExactSizeIterator<Item = Relocation> + use<'a> {
        self.relocation_entries().unwrap_or_default().iter().map(|entry| Relocation {
            address: entry.address.get(),
            symbol: entry.symbol.get(),
            displacement: entry.displacement.get(),
            kind: entry.kind.get(),
        })
    }

    /// Its line numbers.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = Line> + use<'a> {
        self.line_entries().unwrap_or_default().iter().map(|entry| match NonZeroU16::new(entry.line.get()) {
            Some(line) => Line::Statement { address: entry.address.get(), line },
            None => Line::Function(entry.address.get()),
        })
    }

    fn check(&self) -> Result<(), Error> {
        self.checked_data()?;
        self.relocation_entries()?;
        self.line_entries()?;
        Ok(())
    }

    fn checked_data(&self) -> Result<Option<&'a [u8]>, Error> {
        let (at, size) = (u64::from(self.header.data_at.get()), u64::from(self.header.size.get()));
        if at == 0 {
            return Ok(None);
        }
        slice(self.bytes, at, size, Part::Data(self.number)).map(Some)
    }

    fn relocation_entries(&self) -> Result<&'a [raw::Relocation], Error> {
        let at = u64::from(self.header.relocations_at.get());
        array(self.bytes, at, self.header.relocations.get(), Part::Relocations(self.number))
    }

    fn line_entries(&self) -> Result<&'a [raw::Line], Error> {
        let at = u64::from(self.header.lines_at.get());
        array(self.bytes, at, self.header.lines.get(), Part::Lines(self.number))
    }
}

/// A symbol in a file.
#[derive(Clone, Copy, Debug)]
pub struct SymbolView<'a> {
    /// Its index as counted by the format, including auxiliary entries.
    pub index: u32,
    /// The file offset of its entry.
    pub at: u64,
    /// Its name.
    pub name: &'a [u8],
    entry: &'a raw::Symbol,
    /// Its auxiliary entries.
    pub aux: &'a [Aux],
}

impl SymbolView<'_> {
    /// Its value, usually an address.
    #[must_use]
    pub fn value(&self) -> u32 {
        self.entry.value.get()
    }

    /// The section that contains the value.
    #[must_use]
    pub fn section(&self) -> SectionNumber {
        SectionNumber(self.entry.section.get())
    }

    /// The type of the named object.
    #[must_use]
    pub fn ty(&self) -> SymbolType {
        SymbolType(self.entry.ty.get())
    }

    /// Its storage class.
    #[must_use]
    pub fn class(&self) -> StorageClass {
        StorageClass(self.entry.class)
    }
}

/// The string table extends from the end of the symbols to the end of the file. Whether its length word counts itself
/// depends on the tool, so the length is only compared with the size of the file.
fn strings<'a>(bytes: &'a [u8], header: &raw::FileHeader) -> Result<&'a [u8], Error> {
    let symbols_at = u64::from(header.symbols_at.get());
    let at = symbols_at + u64::from(header.symbols.get()) * size::<raw::Symbol>();
    if symbols_at == 0 || at >= count(bytes.len()) {
        return Ok(&[]);
    }
    let word = slice(bytes, at, 4, Part::Strings)?;
    let stated = u64::from(word.try_into().map(u32::from_le_bytes).unwrap_or_default());
    slice(bytes, at, stated, Part::Strings)?;
    slice(bytes, at, count(bytes.len()) - at, Part::Strings)
}

fn structure<T: FromBytes>(bytes: &[u8], at: u64, part: Part) -> Result<T, Error> {
    let bytes = slice(bytes, at, size::<T>(), part)?;
    T::read_from_bytes(bytes)
        .map_err(|_| Error { at, kind: ErrorKind::Truncated { part, size: size::<T>() } })
}

/// Reads `count` structures at `at`; reads nothing if `count` is 0.
fn array<T>(bytes: &[u8], at: u64, count: u32, part: Part) -> Result<&[T], Error>
where
    T: FromBytes + KnownLayout + Immutable + Unaligned,
{
    if count == 0 {
        return Ok(&[]);
    }
    let table = slice(bytes, at, u64::from(count) * size::<T>(), part)?;
    Ok(<[T]>::ref_from_bytes(table).unwrap_or_default())
}

/// Returns `size` bytes of the file at `at`.
fn slice(bytes: &[u8], at: u64, size: u64, part: Part) -> Result<&[u8], Error> {
    let end = at.checked_add(size).and_then(|end| usize::try_from(end).ok());
    let range = usize::try_from(at).ok().zip(end);
    range
        .and_then(|(start, end)| bytes.get(start..end))
        .ok_or(Error { at, kind: ErrorKind::Truncated { part, size } })
}

fn until_nul(bytes: &[u8]) -> &[u8] {
    bytes.split(|byte| *byte == 0).next().unwrap_or_default()
}

/// A length in bytes or entries; a usize has at most 64 bits.
fn count(length: usize) -> u64 {
    u64::try_from(length).unwrap_or(u64::MAX)
}

/// The size of a structure; none has more than 48 bytes.
fn size<T>() -> u64 {
    count(size_of::<T>())
}
