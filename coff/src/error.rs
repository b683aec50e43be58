//! Errors in an image, each with its position in the file.

use std::fmt;

/// An error in an image, with the file offset of the bytes that show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind} (at offset {at:#x})")]
pub struct Error {
    /// Offset in the file.
    pub at: u64,
    /// The kind of error.
    pub kind: ErrorKind,
}

/// A kind of error in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ErrorKind {
    /// The file begins with an unknown magic number.
    #[error("not a COFF2 image: the magic number is {0:#06x}, not 0x00c2")]
    Magic(u16),
    /// The file is an ELF file with an invalid structure.
    #[error("damaged ELF file: {0}")]
    Elf(object::read::Error),
    /// The file is an ELF file of another kind.
    #[error("not a linked ELF program of the C6000")]
    OtherElf,
    /// The file is a COFF2 image of a big-endian processor.
    #[error("the image is big endian")]
    BigEndian,
    /// A part lies partly or completely outside the file.
    #[error("{part} needs {size} bytes, which the file does not have")]
    Truncated {
        /// The part.
        part: Part,
        /// Its size in bytes.
        size: u64,
    },
    /// Parts share more bytes than a file of this size can contain.
    #[error("{0} overlaps with others")]
    Overlap(Part),
    /// A name lies outside the string table.
    #[error("name at offset {offset} of a string table of {size} bytes")]
    Name {
        /// Offset in the string table.
        offset: u32,
        /// Size of the table.
        size: u64,
    },
    /// The auxiliary entries of a symbol extend beyond the symbol table.
    #[error("{count} auxiliary entries where {left} entries are left")]
    Auxiliary {
        /// Number of auxiliary entries that the symbol claims.
        count: u8,
        /// Number of entries after the symbol.
        left: u32,
    },
    /// A name to be written contains a NUL.
    #[error("a name contains a NUL character")]
    NulInName,
    /// A count exceeds the range of its field.
    #[error("{0} exceeds what the format can count")]
    TooLarge(Part),
}

/// A part of an image, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The file header of 22 bytes.
    FileHeader,
    /// The optional header.
    OptionalHeader,
    /// The table of section headers.
    SectionHeaders,
    /// The raw data of a section, counted from 1.
    Data(usize),
    /// The relocations of a section, counted from 1.
    Relocations(usize),
    /// The line numbers of a section, counted from 1.
    Lines(usize),
    /// The symbol table.
    Symbols,
    /// The auxiliary entries of a symbol.
    Auxiliaries,
    /// The string table.
    Strings,
    /// The names in the string table.
    Names,
    /// The file as a whole.
    File,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FileHeader => f.write_str("the file header"),
            Self::OptionalHeader => f.write_str("the optional header"),
            Self::SectionHeaders => f.write_str("the table of section headers"),
            Self::Data(section) => write!(f, "the data of section {section}"),
            Self::Relocations(section) => write!(f, "the relocations of section {section}"),
            Self::Lines(section) => write!(f, "the line table of section {section}"),
            Self::Symbols => f.write_str("the symbol table"),
            Self::Auxiliaries => f.write_str("the number of auxiliary entries"),
            Self::Strings => f.write_str("the string table"),
            Self::Names => f.write_str("the text of the names"),
            Self::File => f.write_str("the file"),
        }
    }
}
