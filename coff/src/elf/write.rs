//! Conversion of an image to an ELF program.

use object::build::elf::{Builder, SectionData, SectionId};
use object::{Endianness, elf};

use super::{NOTE, NOTE_FIRMWARE, NOTE_NAME};
use crate::error::{Error, ErrorKind, Part};
use crate::image::{Contents, Image, Name, Section, Symbol};
use crate::names::{Derivation, SectionFlags, SectionNumber, StorageClass};

/// The alignment of the data of sections in the file.
const ALIGN: u64 = 4;

/// Writes a linked program.
///
/// No loader clears memory: the zeros of uninitialised data are in the file.
///
/// # Errors
/// A name contains a NUL, or a number exceeds its field in the format.
pub(crate) fn write(image: &Image) -> Result<Vec<u8>, Error> {
    let mut builder = Builder::new(Endianness::Little, false);
    builder.header.e_type = elf::ET_EXEC;
    builder.header.e_machine = elf::EM_TI_C6000;
    builder.header.e_entry = image.program.map_or(0, |program| program.entry).into();
    let mut at = builder.file_header_size();
    let mut ids = Vec::new();
    for section in &image.sections {
        ids.push((section.size() > 0).then(|| add_section(&mut builder, section, &mut at)).transpose()?);
    }
    add_note(&mut builder, image);
    for symbol in &image.symbols {
        add_symbol(&mut builder, symbol, &ids)?;
    }
    add_tables(&mut builder);
    builder.set_section_sizes();
    let mut bytes = Vec::new();
    builder.write(&mut bytes).map_err(|_| Error { at: 0, kind: ErrorKind::TooLarge(Part::File) })?;
    Ok(bytes)
}

fn add_section<'a>(
    builder: &mut Builder<'a>,
    section: &'a Section,
    at: &mut u64,
) -> Result<SectionId, Error> {
    let name = checked(&section.name)?;
    let is_code = section.flags.contains(SectionFlags::TEXT);
    let data = match &section.contents {
        Contents::Data(bytes) => bytes.as_slice().into(),
        Contents::Uninitialised(size) => {
            let size =
                usize::try_from(*size).map_err(|_| Error { at: 0, kind: ErrorKind::TooLarge(Part::File) })?;
            vec![0; size].into()
        }
    };
    let access = if is_code { elf::SHF_EXECINSTR } else { elf::SHF_WRITE };
    let added = builder.sections.add();
    added.name = name.into();
    added.sh_type = elf::SHT_PROGBITS;
    added.sh_flags = elf::SHF_ALLOC | access;
    added.sh_addr = section.address.into();
    *at = at.next_multiple_of(ALIGN);
    added.sh_offset = *at;
    *at += section.size();
    added.sh_addralign = section.flags.align().into();
    added.data = SectionData::Data(data);
    Ok(added.id())
}

/// The note about the firmware for which the program is linked.
fn add_note(builder: &mut Builder<'_>, image: &Image) {
    let stamp = image.program.map_or(0, |program| program.version_stamp);
    let size = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(u32::MAX);
    let words = [u32::from(stamp.unsigned_abs()), image.timestamp];
    let contents: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    // The name ends with a NUL and is padded to whole words.
    let name = [NOTE_NAME, &[0]].concat();
    let mut note = Vec::new();
    for word in [size(&name), size(&contents), NOTE_FIRMWARE] {
        note.extend(word.to_le_bytes());
    }
    note.extend(&name);
    note.resize(note.len().next_multiple_of(4), 0);
    note.extend(contents);
    let added = builder.sections.add();
    added.name = NOTE.as_bytes().into();
    added.sh_type = elf::SHT_NOTE;
    added.sh_addralign = 4;
    added.data = SectionData::Note(note.into());
}

fn add_symbol<'a>(
    builder: &mut Builder<'a>,
    symbol: &'a Symbol,
    ids: &[Option<SectionId>],
) -> Result<(), Error> {
    let bind = match symbol.class {
        StorageClass::EXTERNAL => elf::STB_GLOBAL,
        StorageClass::STATIC | StorageClass::FILE => elf::STB_LOCAL,
        // Symbols that only the line table of COFF2 needs.
        _ => return Ok(()),
    };
    let index = usize::try_from(symbol.section.0).ok().and_then(|number| number.checked_sub(1));
    let is_inside = index.is_some();
    let kind = match symbol.ty.outermost() {
        _ if symbol.class == StorageClass::FILE => elf::STT_FILE,
        Some(Derivation::Function) => elf::STT_FUNC,
        _ if is_inside => elf::STT_OBJECT,
        _ => elf::STT_NOTYPE,
    };
    let name = checked(&symbol.name)?;
    let added = builder.symbols.add();
    added.name = name.into();
    added.set_st_info(bind, kind);
    added.section = index.and_then(|index| ids.get(index).copied().flatten());
    added.st_shndx = if symbol.section == SectionNumber::UNDEFINED { elf::SHN_UNDEF } else { elf::SHN_ABS };
    added.st_value = if kind == elf::STT_FILE { 0 } else { symbol.value.into() };
    added.st_size = symbol.size().unwrap_or(0).into();
    Ok(())
}

/// The tables of names and symbols.
fn add_tables(builder: &mut Builder<'_>) {
    let tables = [
        (".symtab", elf::SHT_SYMTAB, SectionData::Symbol),
        (".strtab", elf::SHT_STRTAB, SectionData::String),
        (".shstrtab", elf::SHT_STRTAB, SectionData::SectionString),
    ];
    for (name, kind, data) in tables {
        let added = builder.sections.add();
        added.name = name.as_bytes().into();
        added.sh_type = kind;
        added.sh_addralign = if kind == elf::SHT_SYMTAB { 4 } else { 1 };
        added.data = data;
    }
}

/// The bytes of a name, which must not contain a NUL, its terminator in the file.
fn checked(name: &Name) -> Result<&[u8], Error> {
    match name.as_bytes().contains(&0) {
        true => Err(Error { at: 0, kind: ErrorKind::NulInName }),
        false => Ok(name.as_bytes()),
    }
}
