//! The images written by the vendor's compiler, byte by byte (`coff.md` section 11).

use std::num::NonZeroU16;

use coff::{
    Aux, BaseType, Container, Contents, Derivation, Error, ErrorKind, FileFlags, Image, Line, Part, Program,
    Section, SectionFlags, SectionNumber, StorageClass, Symbol, SymbolType, Target, dump, raw,
};

fn statement(address: u32, line: u16) -> Line {
    Line::Statement { address, line: NonZeroU16::new(line).expect("a line") }
}

fn symbol(name: &str, value: u32, section: i16, ty: SymbolType, class: StorageClass) -> Symbol {
    Symbol { name: name.into(), value, section: SectionNumber(section), ty, class, aux: Vec::new() }
}

/// The document's example without the firmware's symbols.
fn tiny() -> Image {
    let int = SymbolType::new(BaseType::INT);
    let function = Aux::new(&raw::FunctionAux {
        tag: 0.into(),
        size: 0x7c.into(),
        lines_at: 0x112.into(),
        next: 7.into(),
        reserved: 0.into(),
    });
    let main = symbol("main", 0x8005_0000, 1, int.derived(Derivation::Function), StorageClass::EXTERNAL);
    Image {
        container: Container::Coff,
        target: Target::C6000,
        timestamp: 0,
        flags: FileFlags::LINKED,
        program: Some(Program {
            version_stamp: 0x190,
            text_size: 0x7c,
            data_size: 4,
            bss_size: 4,
            entry: 0x8005_0000,
            text_start: 0x8005_0000,
            data_start: 0x8005_0080,
        }),
        sections: vec![
            Section {
                name: ".text".into(),
                physical: 0x8005_0000,
                address: 0x8005_0000,
                flags: (SectionFlags::TEXT | SectionFlags::DATA).with_align(32),
                page: 0,
                contents: Contents::Data(vec![0x58; 0x7c]),
                relocations: Vec::new(),
                lines: vec![Line::Function(1), statement(0x8005_0000, 4), statement(0x8005_0014, 5)],
            },
            Section {
                name: ".data".into(),
                physical: 0x8005_0080,
                address: 0x8005_0080,
                flags: SectionFlags::DATA,
                page: 0,
                contents: Contents::Data(vec![7, 0, 0, 0]),
                relocations: Vec::new(),
                lines: Vec::new(),
            },
        ],
        symbols: vec![
            symbol("tiny.c", 33, SectionNumber::DEBUG.0, SymbolType::default(), StorageClass::FILE),
            Symbol { aux: vec![function], ..main },
            symbol("count", 0x8005_0080, 2, int, StorageClass::EXTERNAL),
            symbol("SetFlashBankBoot", 0x1000_0030, 2, int, StorageClass::EXTERNAL),
        ],
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ")
}

#[test]
fn headers_match_the_specification() {
    let bytes = tiny().write().expect("fits");
    assert_eq!(hex(&bytes[..22]), "c2 00 02 00 00 00 00 00 24 01 00 00 05 00 00 00 1c 00 43 11 99 00");
    assert_eq!(
        hex(&bytes[22..50]),
        "08 01 90 01 7c 00 00 00 04 00 00 00 04 00 00 00 00 00 05 80 00 00 05 80 80 00 05 80"
    );
    assert_eq!(
        hex(&bytes[50..98]),
        "2e 74 65 78 74 00 00 00 00 00 05 80 00 00 05 80 7c 00 00 00 92 00 00 00 \
         00 00 00 00 12 01 00 00 00 00 00 00 03 00 00 00 60 05 00 00 00 00 00 00"
    );
    assert_eq!(
        hex(&bytes[98..146]),
        "2e 64 61 74 61 00 00 00 80 00 05 80 80 00 05 80 04 00 00 00 0e 01 00 00 \
         00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 40 00 00 00 00 00 00 00"
    );
}

#[test]
fn lines_symbols_and_strings_match_the_specification() {
    let bytes = tiny().write().expect("fits");
    assert_eq!(
        hex(&bytes[0x10e..0x124]),
        "07 00 00 00 01 00 00 00 00 00 00 00 05 80 04 00 14 00 05 80 05 00"
    );
    assert_eq!(hex(&bytes[0x124..0x136]), "74 69 6e 79 2e 63 00 00 21 00 00 00 fe ff 00 00 67 00");
    assert_eq!(hex(&bytes[0x136..0x148]), "6d 61 69 6e 00 00 00 00 00 00 05 80 01 00 24 00 02 01");
    assert_eq!(hex(&bytes[0x148..0x15a]), "00 00 00 00 7c 00 00 00 12 01 00 00 07 00 00 00 00 00");
    assert_eq!(hex(&bytes[0x16c..0x17e]), "00 00 00 00 04 00 00 00 30 00 00 10 02 00 04 00 02 00");
    assert_eq!(bytes[0x17e..], *b"\x15\0\0\0SetFlashBankBoot\0");
}

#[test]
fn both_conventions_for_the_length_of_the_string_table_are_read() {
    let image = tiny();
    let mut bytes = image.write().expect("fits");
    assert_eq!(Image::read(&bytes), Ok(image.clone()));
    bytes[0x17e] -= 4;
    assert_eq!(Image::read(&bytes), Ok(image));
}

#[test]
fn an_uninitialised_section_takes_no_room_in_the_file() {
    let mut image = tiny();
    let size = image.write().expect("fits").len();
    image.sections[1].contents = Contents::Uninitialised(u32::MAX);
    let bytes = image.write().expect("fits");
    assert_eq!(bytes.len(), size - 4);
    assert_eq!(Image::read(&bytes), Ok(image));
}

#[test]
fn listings_show_everything() {
    let image = tiny();
    assert_eq!(
        dump::headers(&image),
        "\
target C6000, flags LINKED, timestamp 0
entry 80050000, version 0x0190, text 0x7c at 80050000, data 0x4 at 80050080, bss 0x4
  # name         physical address  size     flags
  1 .text        80050000 80050000 0000007c TEXT|DATA align 32
  2 .data        80050080 80050080 00000004 DATA align 1
"
    );
    assert_eq!(
        dump::symbols(&image),
        "\
index value    section  class  name: type
    0 00000021 DEBUG    FILE   tiny.c: none
    1 80050000 .text    EXT    main: function returning int, 0x7c bytes
    3 80050080 .data    EXT    count: int
    4 10000030 .data    EXT    SetFlashBankBoot: int
"
    );
    assert_eq!(
        dump::lines(&image),
        "\
lines of .text
  function with symbol 1
  80050000 line 4
  80050014 line 5
"
    );
    assert_eq!(dump::data(&image.sections[1]), "80050080  07 00 00 00\n");
}

/// Reads the example after a change of its bytes.
fn read_changed(change: impl FnOnce(&mut Vec<u8>)) -> Error {
    let mut bytes = tiny().write().expect("fits");
    change(&mut bytes);
    Image::read(&bytes).expect_err("the change is a fault")
}

#[test]
fn errors_name_the_place() {
    let check = |change: fn(&mut Vec<u8>), at, kind| assert_eq!(read_changed(change), Error { at, kind });
    check(|bytes| bytes[0] = 0x7f, 0, ErrorKind::Magic(0x7f));
    check(|bytes| bytes[..2].reverse(), 0, ErrorKind::BigEndian);
    check(|bytes| bytes.truncate(10), 0, ErrorKind::Truncated { part: Part::FileHeader, size: 22 });
    check(|bytes| bytes[0x49] = 1, 0x100_0092, ErrorKind::Truncated { part: Part::Data(1), size: 0x7c });
    check(|bytes| bytes[0x55] = 1, 0, ErrorKind::Truncated { part: Part::Relocations(1), size: 0xc00_0000 });
    check(|bytes| bytes[0x59] = 1, 0x112, ErrorKind::Truncated { part: Part::Lines(1), size: 0x600_0012 });
    check(|bytes| bytes[0x147] = 4, 0x136, ErrorKind::Auxiliary { count: 4, left: 3 });
    check(|bytes| bytes[0x170] = 99, 0x16c, ErrorKind::Name { offset: 99, size: 21 });
    check(|bytes| bytes[0x180] = 1, 0x17e, ErrorKind::Truncated { part: Part::Strings, size: 0x1_0015 });
}

#[test]
fn sections_that_share_bytes_are_refused() {
    let mut image = tiny();
    let data = Contents::Data(vec![0; 1000]);
    image.sections[0].contents = data.clone();
    image.sections[1].contents = data;
    let mut bytes = image.write().expect("fits");
    // The header of the second section becomes a copy of the first, and a third one as well.
    bytes.truncate(1000 + 146);
    bytes[8..16].fill(0);
    bytes.copy_within(50..98, 98);
    bytes[0x52 + 4..0x52 + 8].fill(0);
    bytes[0x52 + 4 + 48..0x52 + 8 + 48].fill(0);
    let fault = Image::read(&bytes).expect_err("the sections overlap");
    assert_eq!(fault.kind, ErrorKind::Overlap(Part::Data(2)));
}

#[test]
fn names_that_cannot_be_read_back_are_not_written() {
    let mut image = tiny();
    image.symbols[0].name = "a\0b".into();
    assert_eq!(image.write(), Err(Error { at: 0, kind: ErrorKind::NulInName }));
}

#[test]
fn the_layout_tells_where_line_tables_will_be() {
    let layout = coff::Layout::of(&tiny()).expect("fits");
    assert_eq!(layout.line_offset(0, 1), Some(0x118));
    assert_eq!(layout.line_offset(2, 0), None);
    assert_eq!(layout.size(), tiny().write().expect("fits").len());
}
