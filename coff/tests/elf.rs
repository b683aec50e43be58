//! ELF programs: a written image is read back; any other bytes are rejected or read, without a panic.

use coff::{
    Aux, BaseType, Container, Contents, Derivation, ErrorKind, FileFlags, Image, Name, Program, Section,
    SectionFlags, SectionNumber, StorageClass, Symbol, SymbolType, Target, raw,
};

fn section(name: &str, address: u32, flags: SectionFlags, contents: Contents) -> Section {
    Section {
        name: Name::from(name),
        physical: address,
        address,
        flags,
        page: 0,
        contents,
        relocations: Vec::new(),
        lines: Vec::new(),
    }
}

fn symbol(name: &str, value: u32, section: i16, ty: SymbolType, class: StorageClass, size: u32) -> Symbol {
    let aux = raw::FunctionAux { size: size.into(), ..raw::FunctionAux::default() };
    Symbol {
        name: Name::from(name),
        value,
        section: SectionNumber(section),
        ty,
        class,
        aux: if size > 0 { vec![Aux::new(&aux)] } else { Vec::new() },
    }
}

/// A program as the reader returns it: local symbols first.
fn program() -> Image {
    let int = SymbolType::new(BaseType::INT);
    let object = SymbolType::new(BaseType::STRUCT);
    let function = int.derived(Derivation::Function);
    let data = Contents::Data(vec![7; 6]);
    Image {
        container: Container::Elf,
        target: Target::C6000,
        timestamp: 1_706_753_442,
        flags: FileFlags::LINKED,
        program: Some(Program {
            version_stamp: 532,
            text_size: 32,
            data_size: 6,
            bss_size: 8,
            entry: 0xC008_0000,
            text_start: 0xC008_0000,
            data_start: 0xC008_0020,
        }),
        sections: vec![
            section(
                ".text",
                0xC008_0000,
                SectionFlags::TEXT.with_align(32),
                Contents::Data((1..33).collect()),
            ),
            section(".data", 0xC008_0020, SectionFlags::DATA.with_align(8), data),
            section(".bss", 0xC008_0028, SectionFlags::DATA.with_align(8), Contents::Data(vec![0; 8])),
        ],
        symbols: vec![
            symbol("a.c", 0, SectionNumber::DEBUG.0, SymbolType::default(), StorageClass::FILE, 0),
            symbol("helper", 0xC008_0010, 1, function, StorageClass::STATIC, 16),
            symbol("main", 0xC008_0000, 1, function, StorageClass::EXTERNAL, 16),
            symbol("table", 0xC008_0020, 2, object, StorageClass::EXTERNAL, 6),
            symbol("printf", 0xC001_BD60, -1, function, StorageClass::EXTERNAL, 0),
            symbol("ch0", 0x1183_1378, -1, int, StorageClass::EXTERNAL, 0),
        ],
    }
}

#[test]
fn a_program_is_read_as_it_was_written() {
    let image = program();
    let bytes = image.write().expect("it fits");
    assert_eq!(Image::read(&bytes), Ok(image));
}

#[test]
fn the_zeros_of_uninitialised_data_are_in_the_file() {
    let mut image = program();
    image.sections[2] =
        section(".bss", 0xC008_0028, SectionFlags::BSS.with_align(8), Contents::Uninitialised(8));
    assert_eq!(image.write(), program().write());
}

#[test]
fn files_that_are_damaged_or_of_another_kind_are_refused_with_the_reason() {
    let bytes = program().write().expect("it fits");
    let changed = |at: usize, byte: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = byte;
        Image::read(&bytes).expect_err("it is refused").kind
    };
    assert_eq!(changed(18, 62), ErrorKind::OtherElf, "another machine");
    assert_eq!(changed(16, 1), ErrorKind::OtherElf, "an object");
    assert!(matches!(changed(4, 2), ErrorKind::Elf(_)), "64 bits");
    let cut = Image::read(&bytes[..bytes.len() - 40]).expect_err("it is incomplete");
    assert!(matches!(cut.kind, ErrorKind::Elf(_)), "{cut}");
    assert!(cut.to_string().starts_with("damaged ELF file: "), "{cut}");
}

#[test]
fn no_byte_makes_the_reader_panic_or_take_more_than_the_file_has() {
    let bytes = program().write().expect("it fits");
    for at in 0..bytes.len() {
        for byte in [0, 1, 0x7F, 0xFF] {
            let mut bytes = bytes.clone();
            bytes[at] = byte;
            let Ok(image) = Image::read(&bytes) else { continue };
            let taken: usize = image.sections.iter().map(|section| section.data().len()).sum();
            assert!(taken <= bytes.len(), "{at:#x}: {taken} bytes");
        }
    }
}
