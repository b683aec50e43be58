//! ELF programs, represented by the same values as COFF2 images.
//!
//! The firmware of the Kogna board is an ELF file, and its loader takes ELF programs as well as COFF2 images.
//! [`Image::read`](crate::Image::read) takes either; [`Image::write`](crate::Image::write) writes the file type given
//! by the image's [`Container`](crate::Container).
//!
//! Only linked programs are read, and only their sections that occupy memory. Line numbers are neither read nor
//! written: in ELF files they belong to the debug information. The version and time stamp of the firmware for which a
//! program is linked, which have fields in COFF2 headers, are stored in a note of our own (section [`NOTE`]); loaders
//! skip it.

mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;

/// The first bytes of an ELF file.
pub(crate) const MAGIC: &[u8] = b"\x7fELF";

/// The section of the note about the firmware.
const NOTE: &str = ".note.cc67";

/// The name in the note.
const NOTE_NAME: &[u8] = b"cc67";

/// The type of the note: the version stamp of the firmware, then its time stamp, 32 bits each.
const NOTE_FIRMWARE: u32 = 1;
