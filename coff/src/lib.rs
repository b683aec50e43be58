//! TI COFF2 images, read and written.
//!
//! [`Image::read`] takes any bytes and either gives the whole image or says what is wrong at
//! which offset; [`Image::write`] gives the same bytes for the same image on every host.
//! [`File::parse`] does the same checks and copies nothing, for a reader that needs a few
//! symbols of a large file. [`dump`] lists an image for people and for golden tests.
//!
//! The format is that of C6000 programs: the vendor compiler's images, the firmware file, and
//! cc67's own images and objects, which differ in their [`Target`] so that no real board executes
//! them. Everything is little endian; nothing is padded or aligned.
//!
//! | part | bytes | where | here |
//! |---|---|---|---|
//! | file header | 22 | 0 | [`raw::FileHeader`] |
//! | optional header: entry point and sizes | 28, or none | 22 | [`raw::OptionalHeader`], [`Program`] |
//! | section headers | 48 each | after it | [`raw::SectionHeader`], [`Section`] |
//! | raw data | as their headers say | anywhere; the writer puts them in header order | [`Contents`] |
//! | relocations, none in a linked image | 12 each | anywhere; after all raw data | [`raw::Relocation`] |
//! | line numbers | 6 each | anywhere; after all relocations | [`raw::Line`] |
//! | symbols and their auxiliary entries | 18 each | anywhere; after all line numbers | [`raw::Symbol`], [`Aux`] |
//! | string table: length, then the names above eight characters | to the end of the file | after the symbols | [`Name`] |
//!
//! The length of the string table counts its own four bytes in files of TI's tools, and does not
//! in those of the vendor's compiler; both are read, the first is written. Section numbers in
//! comments are those of `coff.md` of the specification.
//!
//! Invariants:
//! - No panic and no large allocation, whatever the bytes: what an image claims is compared
//!   with the length of the file first.
//! - The reader judges the container alone. Whether the addresses make sense is for the loader.

#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::as_conversions,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unwrap_used
    )
)]

mod auxiliary;
pub mod dump;
mod error;
mod file;
mod image;
mod names;
pub mod raw;
mod read;
mod write;

pub use auxiliary::Auxiliary;
pub use error::{Error, ErrorKind, Part};
pub use file::{File, SectionView, SymbolView};
pub use image::{Aux, Contents, Image, Line, Name, Program, Relocation, Section, Symbol};
pub use names::{
    BaseType, Derivation, FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target,
};
pub use write::Layout;
