//! Round trips: a written image is read back; a mutilated one is rejected or read, without a panic.

use std::num::NonZeroU16;

use coff::{
    Aux, Container, Contents, FileFlags, Image, Line, Name, Program, Relocation, Section, SectionFlags,
    SectionNumber, StorageClass, Symbol, SymbolType, Target, dump,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

fn name() -> impl Strategy<Value = Name> {
    vec(1..=255u8, 0..20).prop_map(|bytes| Name::new(&bytes))
}

fn line() -> impl Strategy<Value = Line> {
    prop_oneof![
        any::<u32>().prop_map(Line::Function),
        (any::<u32>(), any::<NonZeroU16>()).prop_map(|(address, line)| Line::Statement { address, line }),
    ]
}

fn relocation() -> impl Strategy<Value = Relocation> {
    any::<(u32, u32, u16, u16)>().prop_map(|(address, symbol, displacement, kind)| Relocation {
        address,
        symbol,
        displacement,
        kind,
    })
}

fn contents() -> impl Strategy<Value = Contents> {
    prop_oneof![
        vec(any::<u8>(), 0..100).prop_map(Contents::Data),
        any::<u32>().prop_map(Contents::Uninitialised),
    ]
}

fn section() -> impl Strategy<Value = Section> {
    let tables = (vec(relocation(), 0..3), vec(line(), 0..5));
    (name(), any::<(u32, u32, u32, u16)>(), contents(), tables).prop_map(
        |(name, (physical, address, flags, page), contents, (relocations, lines))| Section {
            name,
            physical,
            address,
            flags: SectionFlags(flags),
            page,
            contents,
            relocations,
            lines,
        },
    )
}

fn symbol() -> impl Strategy<Value = Symbol> {
    let aux = vec(any::<[u8; 18]>().prop_map(Aux), 0..3);
    (name(), any::<(u32, i16, u16, u8)>(), aux).prop_map(|(name, (value, section, ty, class), aux)| Symbol {
        name,
        value,
        section: SectionNumber(section),
        ty: SymbolType(ty),
        class: StorageClass(class),
        aux,
    })
}

fn program() -> impl Strategy<Value = Program> {
    any::<(i16, [u32; 6])>().prop_map(
        |(version_stamp, [text_size, data_size, bss_size, entry, text_start, data_start])| Program {
            version_stamp,
            text_size,
            data_size,
            bss_size,
            entry,
            text_start,
            data_start,
        },
    )
}

fn image() -> impl Strategy<Value = Image> {
    (any::<(u16, u32, u16)>(), option::of(program()), vec(section(), 0..5), vec(symbol(), 0..10)).prop_map(
        |((target, timestamp, flags), program, sections, symbols)| Image {
            container: Container::Coff,
            target: Target(target),
            timestamp,
            flags: FileFlags(flags),
            program,
            sections,
            symbols,
        },
    )
}

/// Reads and lists arbitrary bytes.
fn digest(bytes: &[u8]) -> Option<String> {
    let image = Image::read(bytes).ok()?;
    Some(dump::headers(&image) + &dump::symbols(&image) + &dump::lines(&image))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn an_image_is_read_as_it_was_written(image in image()) {
        let bytes = image.write().expect("small images fit");
        prop_assert_eq!(Image::read(&bytes), Ok(image));
    }

    #[test]
    fn a_changed_image_does_not_harm_the_reader(
        image in image(),
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..20),
        end in any::<prop::sample::Index>(),
    ) {
        let mut bytes = image.write().expect("small images fit");
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        digest(&bytes);
        bytes.truncate(end.index(bytes.len()));
        digest(&bytes);
    }

    #[test]
    fn arbitrary_bytes_do_not_harm_the_reader(mut bytes in vec(any::<u8>(), 0..300)) {
        digest(&bytes);
        if let Some(magic) = bytes.get_mut(..2) {
            magic.copy_from_slice(&[0xc2, 0]);
        }
        digest(&bytes);
    }
}
