//! Loads the bytes of an image as a program of a thread; an image is refused before anything changes.
//!
//! [`prepare`] checks everything that can be wrong with an image (`coff.md` sections 4 and 9, design.md D7) and yields
//! a [`LoadableImage`], which the board can take without failing. The vendor's own loader checks almost nothing; with
//! it, a mistake overwrites another thread's program.

use std::ops::Range;

use coff::{Contents, FileFlags, Image, Line, Section, SectionFlags, SectionNumber, StorageClass, Target};
use kmotiondef::boards::{TargetBoard, boards};
use kmotiondef::map::ProgramSpaces;
use kmotiondef::{GuestAddr, ThreadId};
use vm::loaded::LoadedCode as Code;
use vm::verify::VerifyError;

use crate::board::code;
use crate::board::debug::{DebugInfo, FunctionInfo, ObjectInfo};
use crate::firmware::level::ModelledBoard;

/// An image that can be loaded without failing.
#[derive(Debug)]
pub struct LoadableImage {
    /// The code: verified bytecode, or an image of the real processor.
    pub code: Code,
    /// The address at which a thread begins to execute.
    pub entry: GuestAddr,
    /// The sections to be written to memory.
    pub sections: Vec<PlacedSection>,
    /// Names and lines.
    pub debug: DebugInfo,
}

/// A section and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlacedSection {
    /// The first address.
    pub address: GuestAddr,
    /// The bytes to be written.
    pub contents: Fill,
}

/// Contents of a section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fill {
    /// These bytes.
    Bytes(Vec<u8>),
    /// This many bytes of uninitialised data.
    Uninitialised(u32),
}

impl PlacedSection {
    /// Bytes that it takes.
    #[must_use]
    pub fn size(&self) -> u32 {
        match &self.contents {
            Fill::Bytes(bytes) => bytes.len() as u32,
            Fill::Uninitialised(size) => *size,
        }
    }
}

/// The reason for which an image is refused.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The bytes are not a TI COFF image.
    #[error("not a KFLOP image: {0}")]
    NotAnImage(coff::Error),
    /// The code is for another target.
    #[error("code for target {0}, not for the simulated board")]
    OtherTarget(Target),
    /// Linked against another firmware.
    #[error("linked against firmware of {}; the board runs {board}", version(*found))]
    OtherFirmware {
        /// The image's stamp.
        found: i16,
        /// The version of the board's firmware.
        board: &'static str,
    },
    /// Linked for a board with other addresses of programs.
    #[error("linked for {}; the board runs {board}", found.title())]
    OtherBoard {
        /// The board with these addresses.
        found: &'static TargetBoard,
        /// The version of the simulated board's firmware.
        board: &'static str,
    },
    /// Linked against another build of this version.
    #[error(
        "linked against another build of firmware version {number}: its file has the time stamp {found}, not {board}"
    )]
    OtherBuild {
        /// The time stamp in the image.
        found: u32,
        /// That of the board's firmware.
        board: u32,
        /// The version's number.
        number: &'static str,
    },
    /// An object file, or an image with unresolved symbols.
    #[error("an object that is not linked yet; `cc67 build` links it")]
    NotLinked,
    /// A part that every image has is missing.
    #[error("the image has no {0}")]
    Missing(&'static str),
    /// Linked for another thread.
    #[error(
        "the image is linked for thread {linked}, not for thread {wanted}: its code and data are at the \
         addresses of thread {linked}; load it there, or build it for thread {wanted}"
    )]
    OtherThread {
        /// The thread that it is linked for.
        linked: ThreadId,
        /// The thread that it should be loaded into.
        wanted: ThreadId,
    },
    /// A section lies outside the memory for programs.
    #[error("section {name} at {address}, {size} bytes, is outside the program area")]
    OutsideProgramArea {
        /// The section.
        name: String,
        /// The address of the part that is outside.
        address: GuestAddr,
        /// Its size.
        size: u64,
    },
    /// Two sections share memory.
    #[error("sections {first} and {second} overlap")]
    Overlap {
        /// The lower one.
        first: String,
        /// The higher one.
        second: String,
    },
    /// The program needs the space of a thread that holds another program.
    #[error("the program enters the space of thread {0}, which holds another program")]
    EntersThread(ThreadId),
    /// A large program of another thread takes the space.
    #[error("the space of thread {0} is taken: the program of a lower thread reaches into it")]
    SpaceTaken(ThreadId),
    /// The code breaks a rule of the bytecode.
    #[error("the code is refused: {0}")]
    Refused(VerifyError),
    /// The entry point is not a function.
    #[error("the entry point {0} is not a function of the image")]
    Entry(GuestAddr),
}

/// The board that an image is linked for, by its version stamp; the default board if it has none.
#[must_use]
pub fn board_of(image: &[u8]) -> ModelledBoard {
    let image = Image::read(image).ok();
    let stamp = image.and_then(|image| image.program).map(|program| program.version_stamp);
    let mut boards = boards().filter(|board| Some(board.version_stamp()) == stamp);
    boards.find_map(ModelledBoard::of).unwrap_or_default()
}

/// Checks an image for `thread` of a board; `holds` are the threads whose spaces contain a program, other than the
/// program that the image replaces.
///
/// # Errors
/// The first reason to refuse it.
pub fn prepare(
    bytes: &[u8],
    thread: ThreadId,
    board: &ModelledBoard,
    holds: impl Fn(ThreadId) -> bool,
) -> Result<LoadableImage, LoadError> {
    let image = Image::read(bytes).map_err(LoadError::NotAnImage)?;
    check_origin(&image, board.board())?;
    let header = image.program.ok_or(LoadError::Missing("entry point"))?;
    let text = image.section(".text").ok_or(LoadError::Missing("section .text"))?;
    let spaces = &board.board().programs();
    check_thread(text, spaces, thread)?;
    check_sections(&image, spaces, thread, holds)?;
    let base = GuestAddr::new(text.address);
    let code = match image.target {
        Target::C6000 => code::image(base, text.data().len() as u32, functions(&image), board),
        _ => code::program(text.data(), base).map_err(LoadError::Refused)?,
    };
    let entry = GuestAddr::new(header.entry);
    if !code.has_function(entry) {
        return Err(LoadError::Entry(entry));
    }
    let sections = image.sections.iter().filter(|section| is_loaded(section)).map(place).collect();
    Ok(LoadableImage { code, entry, sections, debug: debug(&image, spaces) })
}

fn check_origin(image: &Image, board: &TargetBoard) -> Result<(), LoadError> {
    match image.target {
        Target::CC67 | Target::C6000 => {}
        other => return Err(LoadError::OtherTarget(other)),
    }
    if let Some(found) = other_board(image, board) {
        return Err(LoadError::OtherBoard { found, board: board.version });
    }
    let has_relocations = image.sections.iter().any(|section| !section.relocations.is_empty());
    if has_relocations || !image.flags.contains(FileFlags::EXECUTABLE) {
        return Err(LoadError::NotLinked);
    }
    match image.program {
        Some(header)
            if states_firmware(image.target, header.version_stamp)
                && header.version_stamp != board.version_stamp() =>
        {
            Err(LoadError::OtherFirmware { found: header.version_stamp, board: board.version })
        }
        Some(header) if states_firmware(image.target, header.version_stamp) => {
            match (image.timestamp, board.time_stamp) {
                (found @ 1.., Some(stamp)) if found != stamp => {
                    Err(LoadError::OtherBuild { found, board: stamp, number: board.number() })
                }
                _ => Ok(()),
            }
        }
        _ => Ok(()),
    }
}

/// The board that an image is linked for, if its programs are at other addresses than on `board`.
fn other_board(image: &Image, board: &TargetBoard) -> Option<&'static TargetBoard> {
    let linked = TargetBoard::of_image(image.program?.version_stamp, image.section(".text")?.address)?;
    (linked.programs() != board.programs()).then_some(linked)
}

/// Returns whether the stamp of an image is the version of its firmware. Other linkers use the field for their own
/// stamp.
fn states_firmware(target: Target, stamp: i16) -> bool {
    /// The stamp of the vendor's compiler.
    const VENDOR: i16 = 0x190;
    target == Target::CC67 || (VENDOR + 1..1000).contains(&stamp)
}

/// A version stamp in words.
fn version(stamp: i16) -> String {
    let known = boards().find(|board| board.version_stamp() == stamp);
    match (stamp, known) {
        (_, Some(board)) => format!("version {}", board.number()),
        (1.., None) => format!("version {}.{:02}", stamp / 100, stamp % 100),
        (_, None) => "an unknown version".to_owned(),
    }
}

/// Returns whether a load puts the section into memory (`coff.md` section 9.2).
fn is_loaded(section: &Section) -> bool {
    let is = |flag| section.flags.contains(flag);
    let is_kept_back = is(SectionFlags::DSECT) || is(SectionFlags::NOLOAD) || is(SectionFlags::COPY);
    let has_bytes = match section.contents {
        Contents::Data(_) => true,
        Contents::Uninitialised(_) => section.name == *".bss" && is(SectionFlags::BSS),
    };
    section.size() > 0 && !is_kept_back && has_bytes
}

fn check_thread(text: &Section, spaces: &ProgramSpaces, wanted: ThreadId) -> Result<(), LoadError> {
    if text.address == spaces.start(wanted).get() {
        return Ok(());
    }
    match ThreadId::all().find(|thread| spaces.start(*thread).get() == text.address) {
        Some(linked) => Err(LoadError::OtherThread { linked, wanted }),
        None => Err(outside_error(text)),
    }
}

fn outside_error(section: &Section) -> LoadError {
    LoadError::OutsideProgramArea {
        name: section.name.to_string(),
        address: GuestAddr::new(section.address),
        size: section.size(),
    }
}

/// Checks that every section is inside the program area, that none overlap, and that none is in a space that is taken.
fn check_sections(
    image: &Image,
    spaces: &ProgramSpaces,
    thread: ThreadId,
    holds: impl Fn(ThreadId) -> bool,
) -> Result<(), LoadError> {
    let mut ranges = Vec::new();
    for section in image.sections.iter().filter(|section| is_loaded(section)) {
        let (start, end) = (u64::from(section.address), u64::from(section.address) + section.size());
        if start < u64::from(spaces.start(thread).get()) || end > u64::from(spaces.limit) {
            return Err(outside_error(section));
        }
        for other in ThreadId::all().filter(|other| holds(*other)) {
            let Range { start: first, end: behind } = spaces.space(other);
            if start < u64::from(behind) && end > u64::from(first) {
                return Err(if other == thread {
                    LoadError::SpaceTaken(thread)
                } else {
                    LoadError::EntersThread(other)
                });
            }
        }
        ranges.push((start, end, section));
    }
    ranges.sort_by_key(|(start, ..)| *start);
    for pair in ranges.windows(2) {
        if let [(_, end, first), (start, _, second)] = pair
            && start < end
        {
            return Err(LoadError::Overlap {
                first: first.name.to_string(),
                second: second.name.to_string(),
            });
        }
    }
    Ok(())
}

/// Returns the addresses at which functions begin.
fn functions(image: &Image) -> Vec<u32> {
    let functions = image.symbols.iter().filter(|symbol| {
        matches!(symbol.class, StorageClass::EXTERNAL | StorageClass::STATIC)
            && symbol.section == SectionNumber(1)
    });
    functions.map(|symbol| symbol.value).collect()
}

fn place(section: &Section) -> PlacedSection {
    let contents = match &section.contents {
        Contents::Data(bytes) => Fill::Bytes(bytes.clone()),
        Contents::Uninitialised(size) => Fill::Uninitialised(*size),
    };
    PlacedSection { address: GuestAddr::new(section.address), contents }
}

/// Collects functions, lines and objects from the symbol table.
///
/// A file symbol names the file of the functions after it. The size of an object is in its auxiliary entry, as is the
/// size of a function.
fn debug(image: &Image, spaces: &ProgramSpaces) -> DebugInfo {
    let mut file = String::new();
    let (mut functions, mut objects) = (Vec::new(), Vec::new());
    for symbol in &image.symbols {
        let name = symbol.name.to_string();
        let size = symbol.aux.first().map_or(0, |aux| aux.as_function().size.get());
        match symbol.class {
            StorageClass::FILE => file = name,
            StorageClass::EXTERNAL | StorageClass::STATIC if symbol.section == SectionNumber(1) => {
                let (start, end) = (symbol.value, symbol.value.saturating_add(size));
                functions.push(FunctionInfo { name, file: file.clone(), start, end });
            }
            StorageClass::EXTERNAL | StorageClass::STATIC
                if symbol.section.0 > 1 && spaces.holds(symbol.value) =>
            {
                objects.push(ObjectInfo { name, start: symbol.value, size });
            }
            _ => {}
        }
    }
    let lines = image.sections.iter().flat_map(|section| &section.lines);
    let lines = lines.filter_map(|line| match line {
        Line::Statement { address, line } => Some((*address, u32::from(line.get()))),
        Line::Function(_) => None,
    });
    DebugInfo::new(functions, lines.collect(), objects)
}
