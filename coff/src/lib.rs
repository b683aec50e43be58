//! Reader and writer of TI COFF2 images, and of linked ELF programs for the same processors.
//!
//! [`Image::read`] accepts any bytes and either returns the whole image or reports the fault and its offset;
//! [`Image::write`] gives the same bytes for the same image on every host. [`File::parse`] does the same checks without
//! copying, for readers that need only a few symbols of a large file. [`dump`] lists an image for users and for golden
//! tests.
//!
//! The format is that of C6000 programs: the vendor compiler's images, the firmware file, and cc67's own images and
//! objects. The [`Target`] of images for the simulator differs, so that no real board executes them. Everything is
//! little endian; nothing is padded or aligned.
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
//! In files of TI's tools, the length of the string table includes its own four bytes; in those of the vendor's
//! compiler it does not. The reader accepts both; the writer uses TI's form. Section numbers in comments refer to
//! `coff.md` of the specification.
//!
//! The firmware of the Kogna board and its programs may be ELF files instead. [`Image::read`] and [`Image::write`]
//! represent them by the same values, see [`Container`].
//!
//! Invariants:
//! - No input causes a panic or a large allocation: the sizes that an image claims are first compared with the length
//!   of the file.
//! - The reader checks only the container. The loader checks the addresses.

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
mod budget;
pub mod dump;
mod elf;
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
pub use image::{Aux, Container, Contents, Image, Line, Name, Program, Relocation, Section, Symbol};
pub use names::{
    BaseType, Derivation, FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target,
};
pub use write::Layout;
