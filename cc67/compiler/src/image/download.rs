//! Conversion between images and the commands that download them into a controller's thread.
//!
//! The vendor's host library sends these lines for a load (`coff.md` section 9 of the
//! specification): the thread is killed, the bytes of each section follow in lines of 64, the
//! entry point comes last. Nothing starts the program.

use std::fmt::{self, Write};
use std::iter;

use coff::{Container, Contents, FileFlags, Image, Name, Program, Section, SectionFlags, Target};
use kmotiondef::limits::N_BYTES_PER_LINE;
use kmotiondef::{GuestAddr, ThreadId};

/// Bytes of one `LOADDATA`.
const PIECE: usize = 0x4000;

/// A program in the form in which it is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Download {
    /// The thread into which it is loaded.
    pub thread: ThreadId,
    /// The address at which a thread begins to execute it.
    pub entry: GuestAddr,
    /// The addresses and bytes to store, in the order of sending.
    pub writes: Vec<(GuestAddr, Vec<u8>)>,
}

/// The error for lines that are not a download.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct DownloadError {
    /// Number of the line, from 1.
    pub line: usize,
    /// The kind of error.
    pub kind: DownloadErrorKind,
}

/// A kind of error in a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DownloadErrorKind {
    /// It is not one of the three commands, or incomplete.
    #[error("not `Kill`, `LOADDATA` or `EntryPoint` with its numbers")]
    Command,
    /// Bytes are missing, too many or no numbers.
    #[error("not the bytes that `LOADDATA` announced")]
    Bytes,
    /// There is no entry point, or there are two threads.
    #[error("the download needs one thread and its entry point")]
    Incomplete,
}

/// The lines that load an image into `thread`.
#[must_use]
pub fn script(image: &Image, thread: ThreadId) -> String {
    let entry = image.program.map_or(0, |program| program.entry);
    let writes = image.sections.iter().flat_map(section_writes).collect();
    Download { thread, entry: GuestAddr::new(entry), writes }.to_string()
}

/// The stores with which a load sends a section.
fn section_writes(section: &Section) -> Vec<(GuestAddr, Vec<u8>)> {
    let is = |flag| section.flags.contains(flag);
    let address = GuestAddr::new(section.address);
    if section.size() == 0 || is(SectionFlags::DSECT) || is(SectionFlags::NOLOAD) {
        return Vec::new();
    }
    match &section.contents {
        Contents::Data(bytes) if is(SectionFlags::COPY) => {
            if section.name == *".cinit" {
                initial_values(bytes)
            } else {
                Vec::new()
            }
        }
        Contents::Data(bytes) => vec![(address, bytes.clone())],
        Contents::Uninitialised(size) if section.name == *".bss" && is(SectionFlags::BSS) => {
            vec![(address, vec![0; *size as usize])]
        }
        Contents::Uninitialised(_) => Vec::new(),
    }
}

/// The records of a `.cinit` section: length, address, bytes. A length of 0 is padding.
fn initial_values(mut bytes: &[u8]) -> Vec<(GuestAddr, Vec<u8>)> {
    let mut writes = Vec::new();
    while let Some((length, rest)) = word(bytes) {
        bytes = rest;
        if length == 0 {
            continue;
        }
        let Some((address, rest)) = word(rest) else { break };
        let Some((data, rest)) = rest.split_at_checked(length as usize) else { break };
        writes.push((GuestAddr::new(address), data.to_vec()));
        bytes = rest;
    }
    writes
}

fn word(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (word, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*word), rest))
}

impl fmt::Display for Download {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Kill {}", self.thread)?;
        for (address, bytes) in &self.writes {
            for (index, piece) in bytes.chunks(PIECE).enumerate() {
                let at = address.offset((index * PIECE) as u32).get();
                writeln!(f, "LOADDATA {at:X} {:X}", piece.len())?;
                for line in piece.chunks(N_BYTES_PER_LINE) {
                    for (byte, separator) in line.iter().zip(iter::once("").chain(iter::repeat(" "))) {
                        write!(f, "{separator}{byte:02X}")?;
                    }
                    f.write_char('\n')?;
                }
            }
        }
        writeln!(f, "EntryPoint{} {:X}", self.thread, self.entry.get())
    }
}

impl Download {
    /// Reads the lines.
    ///
    /// # Errors
    /// The first line that is wrong.
    pub fn parse(text: &str) -> Result<Self, DownloadError> {
        let mut lines = text.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty());
        let (mut thread, mut entry, mut writes) = (None, None, Vec::new());
        let mut last = 1;
        while let Some((line, number)) = lines.next() {
            last = number;
            let fail = |kind| DownloadError { line: number, kind };
            let command = DownloadCommand::parse(line).ok_or(fail(DownloadErrorKind::Command))?;
            match command {
                DownloadCommand::Kill(_) if thread.is_some() => {
                    return Err(fail(DownloadErrorKind::Incomplete));
                }
                DownloadCommand::Kill(killed) => thread = Some(killed),
                DownloadCommand::Load(address, count) => {
                    let bytes = lines.by_ref().take(count.div_ceil(N_BYTES_PER_LINE));
                    let bytes: Option<Vec<u8>> = bytes.flat_map(|(line, _)| numbers(line)).collect();
                    let bytes = bytes.filter(|bytes| bytes.len() == count);
                    writes.push((address, bytes.ok_or(fail(DownloadErrorKind::Bytes))?));
                }
                DownloadCommand::EntryPoint(owner, address) if thread == Some(owner) => entry = Some(address),
                DownloadCommand::EntryPoint(..) => return Err(fail(DownloadErrorKind::Incomplete)),
            }
        }
        match (thread, entry) {
            (Some(thread), Some(entry)) => Ok(Self { thread, entry, writes }),
            _ => Err(DownloadError { line: last, kind: DownloadErrorKind::Incomplete }),
        }
    }

    /// An image with the stored bytes; names and lines are not part of a download.
    #[must_use]
    pub fn to_image(&self, version_stamp: i16) -> Image {
        let mut sections: Vec<Section> = Vec::new();
        for (address, bytes) in &self.writes {
            // The pieces of one section follow each other.
            if let Some(Section { address: start, contents: Contents::Data(known), .. }) = sections.last_mut()
                && start.wrapping_add(known.len() as u32) == address.get()
                && known.len() % PIECE == 0
            {
                known.extend_from_slice(bytes);
                continue;
            }
            let (name, flags) = match sections.len() {
                0 => (".text".to_owned(), SectionFlags::TEXT),
                1 => (".data".to_owned(), SectionFlags::DATA),
                number => (format!(".part{number}"), SectionFlags::DATA),
            };
            sections.push(Section {
                name: Name::from(name.as_str()),
                physical: address.get(),
                address: address.get(),
                flags,
                page: 0,
                contents: Contents::Data(bytes.clone()),
                relocations: Vec::new(),
                lines: Vec::new(),
            });
        }
        let program = Program { version_stamp, entry: self.entry.get(), ..Program::default() };
        Image {
            container: Container::Coff,
            target: Target::CC67,
            timestamp: 0,
            flags: FileFlags::LINKED,
            program: Some(program),
            sections,
            symbols: Vec::new(),
        }
    }
}

/// A line that is not bytes.
enum DownloadCommand {
    Kill(ThreadId),
    Load(GuestAddr, usize),
    EntryPoint(ThreadId, GuestAddr),
}

impl DownloadCommand {
    fn parse(line: &str) -> Option<Self> {
        let mut words = line.split_ascii_whitespace();
        let name = words.next()?.to_ascii_lowercase();
        let first = words.next()?;
        let address = || u32::from_str_radix(first, 16).ok().map(GuestAddr::new);
        let command = match name.as_str() {
            "kill" => Self::Kill(first.parse().ok().and_then(ThreadId::new)?),
            "loaddata" => Self::Load(address()?, u32::from_str_radix(words.next()?, 16).ok()? as usize),
            _ => {
                let thread = name.strip_prefix("entrypoint")?.parse().ok().and_then(ThreadId::new)?;
                Self::EntryPoint(thread, address()?)
            }
        };
        words.next().is_none().then_some(command)
    }
}

/// The bytes of a line.
fn numbers(line: &str) -> impl Iterator<Item = Option<u8>> {
    line.split_ascii_whitespace().map(|word| u8::from_str_radix(word, 16).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn download() -> Download {
        let thread = ThreadId::new(1).expect("1 is a thread");
        let bytes = (0..=255).cycle().take(PIECE + 70).collect();
        let writes =
            vec![(GuestAddr::new(0x8005_0000), bytes), (GuestAddr::new(0x8005_4080), vec![7, 0, 0, 0])];
        Download { thread, entry: GuestAddr::new(0x8005_0000), writes }
    }

    #[test]
    fn download_lines_have_the_documented_form() {
        let text = Download { writes: download().writes.split_off(1), ..download() }.to_string();
        assert_eq!(text, "Kill 1\nLOADDATA 80054080 4\n07 00 00 00\nEntryPoint1 80050000\n");
    }

    #[test]
    fn sections_go_out_in_pieces_and_come_back_whole() {
        let text = download().to_string();
        assert!(text.contains("LOADDATA 80050000 4000\n") && text.contains("LOADDATA 80054000 46\n"));
        let read = Download::parse(&text).expect("the lines are good");
        let sections: Vec<_> = read
            .to_image(434)
            .sections
            .iter()
            .map(|s| (GuestAddr::new(s.address), s.data().to_vec()))
            .collect();
        assert_eq!(sections, download().writes);
        assert_eq!(read.to_string(), text);
    }

    #[test]
    fn wrong_lines_are_named() {
        for (text, expect) in [
            ("Kill 9", "line 1: not `Kill`"),
            ("Kill 1\nLOADDATA 80050000", "line 2: not `Kill`"),
            ("Kill 1\nLOADDATA 80050000 3\n01 02", "line 2: not the bytes"),
            ("Kill 1\nLOADDATA 80050000 FFFFFFFF\n01 02", "line 2: not the bytes"),
            ("Kill 1\nLOADDATA 80050000 2\n01 0x", "line 2: not the bytes"),
            ("Kill 1\nEntryPoint2 80050000", "line 2: the download needs"),
            ("Kill 1", "line 1: the download needs"),
            ("", "line 1: the download needs"),
        ] {
            let message = Download::parse(text).expect_err("it is wrong").to_string();
            assert!(message.starts_with(expect), "{text:?}: {message}");
        }
    }

    #[test]
    fn records_of_initial_values_are_decoded() {
        let mut bytes = Vec::new();
        for word in [0_u32, 3, 0x1000, 0x00ab_cdef, 0, 100] {
            bytes.extend_from_slice(&word.to_le_bytes());
        }
        // The byte after the three is padding of the record before the next length.
        bytes.remove(15);
        assert_eq!(initial_values(&bytes), [(GuestAddr::new(0x1000), vec![0xef, 0xcd, 0xab])]);
    }
}
