//! Links objects to a program at a thread's address.
//!
//! The program's own definitions take precedence over those of the firmware. All missing symbols are reported together.
//!
//! Placement (specification, `coff.md` section 4): text at the start of the thread's space,
//! data and uninitialised data after it, each at a multiple of 32, every object aligned to
//! its type. A pointer to a function is the address of its `func` word.

mod error;
mod names;
mod place;
mod processor;
mod reach;
mod text;

pub use error::{LinkError, LinkErrorKind, LinkWarning};

use std::sync::Arc;

use kmotiondef::{GuestAddr, ThreadId};

use crate::firmware::FirmwareSymbols;
use crate::object::{Object, SourceLine, SymbolKind};
use crate::typed::Linkage;

/// The options of a link.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The thread for which the program is linked.
    pub thread: ThreadId,
    /// The symbols of the firmware.
    pub firmware: &'a dyn FirmwareSymbols,
    /// Drop functions and objects that `main` cannot reach.
    pub gc: bool,
    /// The addresses of sections outside the space of the thread.
    pub addresses: SectionAddresses,
}

/// Addresses of sections; addresses that are not given follow from the thread and the previous sections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SectionAddresses {
    /// The address of the text.
    pub text: Option<GuestAddr>,
    /// The address of the initialised data.
    pub data: Option<GuestAddr>,
    /// The address of the uninitialised data.
    pub bss: Option<GuestAddr>,
}

/// A program with final addresses.
#[derive(Clone, Debug)]
pub struct LinkedProgram {
    /// The thread for which it is linked.
    pub thread: ThreadId,
    /// The target of its code.
    pub target: crate::target::Target,
    /// The text.
    pub text: LinkedSection,
    /// The initialised data.
    pub data: LinkedSection,
    /// The uninitialised data.
    pub bss: UninitializedSection,
    /// The address at which a thread begins to execute it: `main`, or the words before bytecode, which lead the
    /// simulated board to `main` and make a real processor return.
    pub entry: GuestAddr,
    /// The firmware that it needs.
    pub firmware: LinkedFirmware,
    /// Source files.
    pub files: Vec<String>,
    /// The program's symbols: functions, then objects, each in the order of their addresses.
    pub symbols: Vec<LinkedSymbol>,
    /// The functions, in the order of their addresses; index for index the first of `symbols`.
    pub functions: Vec<LinkedFunction>,
    /// The starts of source lines and of positions in them, ascending.
    pub lines: Vec<LinkedLine>,
    /// The warnings.
    pub warnings: Vec<LinkWarning>,
}

/// The firmware against which a program is linked.
#[derive(Clone, Debug)]
pub struct LinkedFirmware {
    /// Its version.
    pub version_stamp: i16,
    /// The time stamp of its file; 0 if unknown.
    pub time_stamp: u32,
    /// Its symbols that the program refers to.
    pub imports: Vec<Import>,
}

/// A section with its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkedSection {
    /// Its start address.
    pub address: GuestAddr,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// A section that a load clears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UninitializedSection {
    /// Its start address.
    pub address: GuestAddr,
    /// Its size in bytes.
    pub size: u32,
}

/// The section of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Code.
    Text,
    /// Initialised data.
    Data,
    /// Uninitialised data.
    Bss,
}

/// A symbol of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkedSymbol {
    /// Its name.
    pub name: String,
    /// Its address.
    pub address: GuestAddr,
    /// Its size in bytes.
    pub size: u32,
    /// Its section.
    pub section: Section,
    /// The kind of its type.
    pub kind: SymbolKind,
    /// Its linkage: `static` or external.
    pub linkage: Linkage,
    /// The position of its definition.
    pub place: SourceLine,
}

/// A function of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkedFunction {
    /// Its part of [`LinkedProgram::lines`].
    pub lines: std::ops::Range<usize>,
    /// Bytes of its frame in guest memory.
    pub frame: u32,
    /// The line of its closing brace.
    pub end: SourceLine,
    /// The loops that are scheduled without overlap because the search for it exceeded its limit of work.
    pub exceeded: Vec<SourceLine>,
}

/// The source position of the code from an address on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkedLine {
    /// The address.
    pub address: GuestAddr,
    /// The line; the file is an index into [`LinkedProgram::files`].
    pub place: SourceLine,
    /// The column, counted from 1; 0 if the object does not have it.
    pub column: u32,
    /// The function that the source belongs to, if it was inlined into another function.
    pub inlined: Option<Arc<str>>,
}

/// A symbol of the firmware that the program refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// Its name.
    pub name: String,
    /// Its address.
    pub address: GuestAddr,
    /// True if it is a function.
    pub is_function: bool,
}

/// Links objects to a program.
///
/// # Errors
/// All errors that prevent linking.
pub fn link(objects: &[Object], options: &Options<'_>) -> Result<LinkedProgram, Vec<LinkError>> {
    processor::check_targets(objects)?;
    let names = names::Names::collect(objects)?;
    let reached = reach::reach(objects, &names, options)?;
    let board = options.firmware.board();
    let base = options.addresses.text.unwrap_or_else(|| board.program_base(options.thread));
    let layout = text::TextLayout::new(objects, &reached, base)?;
    let code = base.offset(layout.guard);
    let placed = place::place(objects, &names, &reached, &layout, code, &options.addresses);
    let warnings = place::check_size(&placed, base, board.programs())?;
    let addresses = text::Addresses { base: code, reached: &reached, placed: &placed };
    Ok(LinkedProgram {
        thread: options.thread,
        target: processor::target(objects),
        text: LinkedSection { address: base, bytes: text::text(objects, &layout, &addresses)? },
        data: LinkedSection { address: placed.data_address, bytes: text::data(objects, &addresses) },
        bss: UninitializedSection { address: placed.bss_address, size: placed.bss_size },
        entry: if layout.guard > 0 { base } else { placed.function(reached.main) },
        firmware: LinkedFirmware {
            version_stamp: options.firmware.version_stamp(),
            time_stamp: options.firmware.time_stamp(),
            imports: reached.imports,
        },
        files: layout.files.clone(),
        functions: text::functions(objects, &layout),
        lines: text::lines(objects, &layout, code),
        symbols: placed.symbols,
        warnings,
    })
}

#[cfg(test)]
mod tests;
