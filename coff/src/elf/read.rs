//! Conversion of an ELF program to an image.

use object::elf;
use object::endian::LittleEndian;
use object::read::elf::{ElfFile32, FileHeader as _, SectionHeader as _, SectionTable, Sym as _};

use super::{NOTE, NOTE_FIRMWARE, NOTE_NAME};
use crate::budget::{NAME_SHARING, length, spend};
use crate::error::{Error, ErrorKind, Part};
use crate::image::{Aux, Container, Contents, Image, Name, Program, Section, Symbol};
use crate::names::{
    BaseType, Derivation, FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target,
};
use crate::raw::FunctionAux;

type File<'a> = ElfFile32<'a, LittleEndian>;
type Header = elf::FileHeader32<LittleEndian>;

/// Reads a linked program of the C6000.
///
/// # Errors
/// The bytes are something else, or incomplete.
pub(crate) fn read(bytes: &[u8]) -> Result<Image, Error> {
    let file = File::parse(bytes).map_err(structure_error)?;
    let header = file.elf_header();
    if header.e_machine(LittleEndian) != elf::EM_TI_C6000 || header.e_type(LittleEndian) != elf::ET_EXEC {
        return Err(Error { at: 16, kind: ErrorKind::OtherElf });
    }
    let size = length(bytes.len());
    let mut reader =
        Reader { bytes, file: &file, data_left: size, names_left: size.saturating_mul(NAME_SHARING) };
    let (sections, numbers) = reader.sections()?;
    let symbols = reader.symbols(&numbers)?;
    let (version_stamp, timestamp) = reader.firmware()?;
    let place = |name: &str| sections.iter().find(|section| section.name == *name);
    let size_of = |name| place(name).map_or(0, |section| u32::try_from(section.size()).unwrap_or(u32::MAX));
    let start_of = |name| place(name).map_or(0, |section| section.address);
    let program = Program {
        version_stamp,
        text_size: size_of(".text"),
        data_size: size_of(".data"),
        bss_size: size_of(".bss"),
        entry: header.e_entry(LittleEndian),
        text_start: start_of(".text"),
        data_start: start_of(".data"),
    };
    Ok(Image {
        container: Container::Elf,
        target: Target::C6000,
        timestamp,
        flags: FileFlags::LINKED,
        program: Some(program),
        sections,
        symbols,
    })
}

struct Reader<'a> {
    bytes: &'a [u8],
    file: &'a File<'a>,
    /// The remaining work for reading, bounded by the size of the file.
    data_left: u64,
    names_left: u64,
}

impl<'a> Reader<'a> {
    fn table(&self) -> &'a SectionTable<'a, Header> {
        self.file.elf_section_table()
    }

    /// The sections that occupy memory, and for each section of the file its number among them.
    fn sections(&mut self) -> Result<(Vec<Section>, Vec<SectionNumber>), Error> {
        let mut sections = Vec::new();
        let mut numbers = Vec::new();
        for header in self.table().iter() {
            let flags = header.sh_flags(LittleEndian);
            let size = header.sh_size(LittleEndian);
            if flags.0 & elf::SHF_ALLOC.0 == 0 || size == 0 {
                numbers.push(SectionNumber::ABSOLUTE);
                continue;
            }
            let is_code = flags.0 & elf::SHF_EXECINSTR.0 != 0;
            let is_absent = header.sh_type(LittleEndian) == elf::SHT_NOBITS;
            let at = u64::from(header.sh_offset(LittleEndian));
            let contents = if is_absent {
                Contents::Uninitialised(size)
            } else {
                let data = header.data(LittleEndian, self.bytes).map_err(structure_error)?;
                let part = Part::Data(sections.len() + 1);
                spend(&mut self.data_left, u64::from(size), at, part)?;
                Contents::Data(data.to_vec())
            };
            let kind = match (is_absent, is_code) {
                (true, _) => SectionFlags::BSS,
                (false, true) => SectionFlags::TEXT,
                (false, false) => SectionFlags::DATA,
            };
            let align = header.sh_addralign(LittleEndian);
            let address = header.sh_addr(LittleEndian);
            let name = self.table().section_name(LittleEndian, header).map_err(structure_error)?;
            sections.push(Section {
                name: self.name(name, at)?,
                physical: address,
                address,
                flags: if align.is_power_of_two() { kind.with_align(align) } else { kind },
                page: 0,
                contents,
                relocations: Vec::new(),
                lines: Vec::new(),
            });
            let number = i16::try_from(sections.len()).map_or(SectionNumber::ABSOLUTE, SectionNumber);
            numbers.push(number);
        }
        Ok((sections, numbers))
    }

    fn symbols(&mut self, numbers: &[SectionNumber]) -> Result<Vec<Symbol>, Error> {
        let table = self.file.elf_symbol_table();
        let mut symbols = Vec::new();
        for (at, symbol) in (0..).zip(table.iter()) {
            let kind = symbol.st_type();
            let name = symbol.name(LittleEndian, table.strings()).map_err(structure_error)?;
            if name.is_empty() || kind == elf::STT_SECTION {
                continue;
            }
            let class = match (kind, symbol.st_bind()) {
                (elf::STT_FILE, _) => StorageClass::FILE,
                (_, elf::STB_LOCAL) => StorageClass::STATIC,
                _ => StorageClass::EXTERNAL,
            };
            let int = SymbolType::new(BaseType::INT);
            let ty = match kind {
                elf::STT_FUNC => int.derived(Derivation::Function),
                elf::STT_OBJECT => SymbolType::new(BaseType::STRUCT),
                elf::STT_FILE => SymbolType::default(),
                _ => int,
            };
            let section = match symbol.st_shndx(LittleEndian) {
                _ if kind == elf::STT_FILE => SectionNumber::DEBUG,
                elf::SHN_UNDEF => SectionNumber::UNDEFINED,
                other => {
                    let index = usize::from(other.0);
                    numbers.get(index).copied().unwrap_or(SectionNumber::ABSOLUTE)
                }
            };
            let size = symbol.st_size(LittleEndian);
            let stated = FunctionAux { size: size.into(), ..FunctionAux::default() };
            symbols.push(Symbol {
                name: self.name(name, at)?,
                value: symbol.st_value(LittleEndian),
                section,
                ty,
                class,
                aux: if size > 0 { vec![Aux::new(&stated)] } else { Vec::new() },
            });
        }
        Ok(symbols)
    }

    /// Version stamp and time stamp of the firmware for which the program is linked; 0 without a note.
    fn firmware(&self) -> Result<(i16, u32), Error> {
        let Some((_, header)) = self.table().section_by_name(LittleEndian, NOTE.as_bytes()) else {
            return Ok((0, 0));
        };
        let Some(mut notes) = header.notes(LittleEndian, self.bytes).map_err(structure_error)? else {
            return Ok((0, 0));
        };
        while let Some(note) = notes.next().map_err(structure_error)? {
            if note.name() == NOTE_NAME && note.n_type(LittleEndian).0 == NOTE_FIRMWARE {
                let words = note.desc().as_chunks::<4>().0;
                let word = |index: usize| words.get(index).copied().map_or(0, u32::from_le_bytes);
                return Ok((i16::try_from(word(0)).unwrap_or(0), word(1)));
            }
        }
        Ok((0, 0))
    }

    fn name(&mut self, name: &[u8], at: u64) -> Result<Name, Error> {
        spend(&mut self.names_left, length(name.len()), at, Part::Names)?;
        Ok(Name::new(name))
    }
}

/// The error for a file with an invalid structure.
const fn structure_error(error: object::read::Error) -> Error {
    Error { at: 0, kind: ErrorKind::Elf(error) }
}
