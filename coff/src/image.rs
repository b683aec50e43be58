//! The image as values, shared by reader and writer.
//!
//! Names are bytes, because a file may contain any; there are no counts and file offsets, as the writer computes them.
//! Auxiliary entries stay as they are in the file, because their meaning depends on the symbol
//! ([`Auxiliary`](crate::Auxiliary)); [`Layout`](crate::Layout) provides the offsets that some of them contain.

use std::borrow::Cow;
use std::fmt;
use std::num::NonZeroU16;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::names::{FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target};
use crate::raw;

/// An image: a linked program, or an object that a linker completes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The type of file.
    pub container: Container,
    /// The processor for which it was made.
    pub target: Target,
    /// The creation time, in Unix seconds; 0 in images written by compilers.
    pub timestamp: u32,
    /// Flags: parts that were stripped, and whether the image is complete.
    pub flags: FileFlags,
    /// Entry point and sizes; `None` if the file has no optional header of the usual size.
    pub program: Option<Program>,
    /// The sections in the order of their headers.
    pub sections: Vec<Section>,
    /// The symbols in the order of the table.
    pub symbols: Vec<Symbol>,
}

/// A type of file for an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Container {
    /// TI COFF2.
    #[default]
    Coff,
    /// ELF: a linked program without line numbers.
    Elf,
}

/// The part of the optional header that describes the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Program {
    /// Version of the tool that wrote the image.
    pub version_stamp: i16,
    /// Size of `.text`.
    pub text_size: u32,
    /// Size of initialised data.
    pub data_size: u32,
    /// Size of uninitialised data; in an image of the vendor's compiler, only this field contains it.
    pub bss_size: u32,
    /// Address of the entry point.
    pub entry: u32,
    /// Start address of `.text`.
    pub text_start: u32,
    /// Start address of `.data`.
    pub data_start: u32,
}

/// A section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Its name.
    pub name: Name,
    /// Physical address.
    pub physical: u32,
    /// The run-time address, to which the loader copies it.
    pub address: u32,
    /// Its kind and alignment.
    pub flags: SectionFlags,
    /// Memory page.
    pub page: u16,
    /// Its bytes.
    pub contents: Contents,
    /// Its relocations, for a linker; empty in a linked image.
    pub relocations: Vec<Relocation>,
    /// Its line numbers.
    pub lines: Vec<Line>,
}

impl Section {
    /// Its size in bytes.
    #[must_use]
    pub fn size(&self) -> u64 {
        match &self.contents {
            // A usize has at most 64 bits, so the default is never used.
            Contents::Data(bytes) => u64::try_from(bytes.len()).unwrap_or(u64::MAX),
            Contents::Uninitialised(size) => u64::from(*size),
        }
    }

    /// Its bytes; empty if it is uninitialised.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        match &self.contents {
            Contents::Data(bytes) => bytes,
            Contents::Uninitialised(_) => &[],
        }
    }
}

/// The contents of a section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Contents {
    /// Bytes in the file.
    Data(Vec<u8>),
    /// This many bytes that are not in the file.
    Uninitialised(u32),
}

/// Bytes that depend on the address of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Relocation {
    /// Address of the bytes.
    pub address: u32,
    /// Index of the symbol as counted by the format, including auxiliary entries.
    pub symbol: u32,
    /// Additional data for the kind.
    pub displacement: u16,
    /// The kind of relocation; its meaning depends on the target.
    pub kind: u16,
}

/// A line number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// The following entries belong to the function with this symbol index.
    Function(u32),
    /// The code at an address belongs to a line.
    Statement {
        /// The address.
        address: u32,
        /// The line in the source file.
        line: NonZeroU16,
    },
}

/// A symbol.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name, possibly empty.
    pub name: Name,
    /// Its value, usually an address.
    pub value: u32,
    /// The section that contains the value.
    pub section: SectionNumber,
    /// The type of the named object.
    pub ty: SymbolType,
    /// Its storage class.
    pub class: StorageClass,
    /// Its auxiliary entries.
    pub aux: Vec<Aux>,
}

/// An auxiliary entry: 18 bytes whose meaning depends on the symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(transparent)]
pub struct Aux(pub [u8; 18]);

impl Aux {
    /// Creates an auxiliary entry from one of the structures of [`raw`].
    #[must_use]
    pub fn new<T: IntoBytes + Immutable>(entry: &T) -> Self {
        let mut bytes = [0; 18];
        for (to, from) in bytes.iter_mut().zip(entry.as_bytes()) {
            *to = *from;
        }
        Self(bytes)
    }

    /// The entry of a function.
    #[must_use]
    pub fn as_function(&self) -> raw::FunctionAux {
        zerocopy::transmute!(self.0)
    }

    /// The entry of `.bf` or `.ef`.
    #[must_use]
    pub fn as_boundary(&self) -> raw::BoundaryAux {
        zerocopy::transmute!(self.0)
    }

    /// The entry of an object.
    #[must_use]
    pub fn as_object(&self) -> raw::ObjectAux {
        zerocopy::transmute!(self.0)
    }

    /// The entry of a symbol that names a section.
    #[must_use]
    pub fn as_section(&self) -> raw::SectionAux {
        zerocopy::transmute!(self.0)
    }

    /// The entry of a tag.
    #[must_use]
    pub fn as_tag(&self) -> raw::TagAux {
        zerocopy::transmute!(self.0)
    }

    /// The entry of an array.
    #[must_use]
    pub fn as_array(&self) -> raw::ArrayAux {
        zerocopy::transmute!(self.0)
    }
}

/// A name: bytes without NUL, usually ASCII.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Name(Vec<u8>);

impl Name {
    /// Creates a name from the bytes in a file.
    #[must_use]
    pub fn new(bytes: &[u8]) -> Self {
        Self(bytes.to_vec())
    }

    /// The bytes.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// The name as text, with the replacement character for invalid UTF-8.
    #[must_use]
    pub fn to_str(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.0)
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Self::new(text.as_bytes())
    }
}

impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        self.0 == other.as_bytes()
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.to_str())
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.to_str(), f)
    }
}

impl Image {
    /// The section called `name`.
    #[must_use]
    pub fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.name == *name)
    }

    /// The first symbol called `name`.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.iter().find(|symbol| symbol.name == *name)
    }

    /// The number of entries in the symbol table, including auxiliary ones.
    #[must_use]
    pub fn symbol_entries(&self) -> usize {
        self.symbols.iter().map(|symbol| 1 + symbol.aux.len()).sum()
    }
}
