//! Reads whole files, up to a size far beyond that of any program, image or description.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Bytes of a source, an image, a machine file. An endless device or a huge file does not fill the memory.
pub const FILE_BYTES: u64 = SOURCE_BYTES as u64;

/// Bytes of the largest source.
pub const SOURCE_BYTES: u32 = 32 << 20;

/// Bytes of saved data that are drawn.
pub const DATA_BYTES: u64 = 512 << 20;

/// The bytes of a file of at most [`FILE_BYTES`].
///
/// # Errors
/// The error of the system, or the file is too large.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    read_up_to(path, FILE_BYTES)
}

/// The bytes of a file of at most this size.
///
/// # Errors
/// The error of the system, or the file is too large.
pub fn read_up_to(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // One byte more than allowed shows that the file is too large without reading all of it.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {most} bytes")));
    }
    Ok(bytes)
}
