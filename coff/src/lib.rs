//! TI COFF2 images, read and written.
//!
//! [`Image::read`] takes any bytes and either gives the whole image or says what is wrong at
//! which offset; [`Image::write`] gives the same bytes for the same image on every host.
//! [`dump`] lists an image for people and for golden tests.
//!
//! The format is that of linked C6000 programs: the vendor compiler's images, the firmware
//! file, and cc67's own, which differ in their [`Target`] alone so that no real board
//! executes them. Section numbers in comments are those of `coff.md` of the specification.
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

pub mod dump;
mod error;
mod image;
mod names;
pub mod raw;
mod read;
mod write;

pub use error::{Error, ErrorKind, Part};
pub use image::{Aux, Contents, Image, Line, Name, Program, Section, Symbol};
pub use names::{
    BaseType, Derivation, FileFlags, SectionFlags, SectionNumber, StorageClass, SymbolType, Target,
};
pub use write::Layout;
