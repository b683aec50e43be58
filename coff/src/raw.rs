//! Headers, symbols, relocations and line numbers, in the layout of the document.
//!
//! Plain bytes in little-endian order without alignment or padding, so that a structure can be read from, and written
//! to, any position of a file. Section numbers refer to `coff.md`.

use zerocopy::little_endian::{I16, U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// Magic number of COFF version 2.
pub const MAGIC: u16 = 0x00C2;
/// The first two bytes of a big-endian file, read as little-endian.
pub const MAGIC_BIG_ENDIAN: u16 = 0xC200;
/// Magic number of the optional header.
pub const OPTIONAL_MAGIC: i16 = 0x0108;
/// A name of a symbol or section that needs no string table.
pub type ShortName = [u8; 8];

macro_rules! structures {
    ($($(#[$doc:meta])+ $name:ident, $size:literal { $($(#[$field_doc:meta])+ $field:ident: $ty:ty,)* })*) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
        #[repr(C)]
        pub struct $name {
            $($(#[$field_doc])+ pub $field: $ty,)*
        }

        const _: () = assert!(size_of::<$name>() == $size);
    )*};
}

structures! {
    /// File header (section 2).
    FileHeader, 22 {
        /// [`MAGIC`].
        magic: U16,
        /// Number of sections.
        sections: U16,
        /// Unix seconds.
        timestamp: U32,
        /// File offset of the symbol table.
        symbols_at: U32,
        /// Number of entries in it, including auxiliary ones.
        symbols: U32,
        /// Size of the optional header.
        optional_size: U16,
        /// See [`FileFlags`](crate::FileFlags).
        flags: U16,
        /// See [`Target`](crate::Target).
        target: U16,
    }

    /// Optional header (section 3).
    OptionalHeader, 28 {
        /// [`OPTIONAL_MAGIC`].
        magic: I16,
        /// Version of the tool.
        version_stamp: I16,
        /// Size of `.text`.
        text_size: U32,
        /// Size of initialised data.
        data_size: U32,
        /// Size of uninitialised data.
        bss_size: U32,
        /// Entry point.
        entry: U32,
        /// Start of `.text`.
        text_start: U32,
        /// Start of `.data`.
        data_start: U32,
    }

    /// Section header (section 4).
    SectionHeader, 48 {
        /// Name, or zeros and an offset into the string table.
        name: ShortName,
        /// Physical address.
        physical: U32,
        /// Address at run time.
        address: U32,
        /// Size in bytes.
        size: U32,
        /// File offset of the raw data, 0 for none.
        data_at: U32,
        /// File offset of the relocations.
        relocations_at: U32,
        /// File offset of the line numbers.
        lines_at: U32,
        /// Number of relocations.
        relocations: U32,
        /// Number of line numbers.
        lines: U32,
        /// See [`SectionFlags`](crate::SectionFlags).
        flags: U32,
        /// Zero.
        reserved: U16,
        /// Memory page.
        page: U16,
    }

    /// Relocation (section 7).
    Relocation, 12 {
        /// Address of the bytes to complete.
        address: U32,
        /// Index of the symbol whose address is stored there.
        symbol: U32,
        /// Additional data for the kind.
        displacement: U16,
        /// The kind of relocation; its meaning depends on the target.
        kind: U16,
    }

    /// Line number (section 5).
    Line, 6 {
        /// Address, or the index of the function's symbol if `line` is 0.
        address: U32,
        /// Line in the source file.
        line: U16,
    }

    /// Symbol (section 6.1).
    Symbol, 18 {
        /// Name, or zeros and an offset into the string table.
        name: ShortName,
        /// Value, usually an address.
        value: U32,
        /// Section, from 1; see [`SectionNumber`](crate::SectionNumber).
        section: I16,
        /// See [`SymbolType`](crate::SymbolType).
        ty: U16,
        /// See [`StorageClass`](crate::StorageClass).
        class: u8,
        /// Number of auxiliary entries that follow.
        auxiliaries: u8,
    }

    /// Auxiliary entry of a function (section 6.2).
    FunctionAux, 18 {
        /// Zero.
        tag: U32,
        /// Size of the function in bytes.
        size: U32,
        /// File offset of its first line number.
        lines_at: U32,
        /// Index of the symbol after the function's entries.
        next: U32,
        /// Zero.
        reserved: U16,
    }

    /// Auxiliary entry of `.bf` and `.ef`, where a function begins and ends (section 6.2).
    BoundaryAux, 18 {
        /// Zero.
        tag: U32,
        /// `.bf`: 0; `.ef`: the last line of the function + 1.
        line: U16,
        /// `.bf`: number of line entries of the function minus 1; `.ef`: 0.
        lines: U16,
        /// Zero.
        size: U32,
        /// `.bf`: index of the symbol after the function's entries; `.ef`: 0.
        next: U32,
        /// Zero.
        reserved: U16,
    }

    /// Auxiliary entry of a symbol that names a section.
    SectionAux, 18 {
        /// Size of the section in bytes.
        size: U32,
        /// Number of relocations.
        relocations: U16,
        /// Number of line numbers.
        lines: U16,
        /// Zero.
        reserved: [u8; 10],
    }

    /// Auxiliary entry of a structure, union or enumeration tag.
    TagAux, 18 {
        /// Zero.
        tag: U32,
        /// Size of the type in bytes.
        size: U32,
        /// Zero.
        reserved: U32,
        /// Index of the symbol after the members.
        next: U32,
        /// Zero.
        reserved_end: U16,
    }

    /// Auxiliary entry of an array.
    ArrayAux, 18 {
        /// Index of the tag of its elements, 0 for none.
        tag: U32,
        /// Size of the array in bytes.
        size: U32,
        /// The first four dimensions.
        dimensions: [U16; 4],
        /// Zero.
        reserved: U16,
    }

    /// Auxiliary entry of a structure, of its end, of a member or of any other object.
    ObjectAux, 18 {
        /// Index of the tag of its type, 0 for none.
        tag: U32,
        /// Size in bytes.
        size: U32,
        /// Zero; alignment of the object in objects of cc67.
        align: U32,
        /// Zero; index of the source file that defines it in objects of cc67, counted from 0.
        file: U32,
        /// Zero; line of the definition in objects of cc67.
        line: U16,
    }
}
