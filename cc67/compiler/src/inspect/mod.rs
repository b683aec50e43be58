//! The contents of an image, for people and tools.
//!
//! [`Inspection`] analyses an image once: functions, objects, lines, and for our own images the verified program, from
//! which disassembly, calls and stack depth are derived. For the controller's processor, listing and cycles are derived
//! from packets instead. The submodules format parts of it as text.

mod calls;
mod code_calls;
mod compare;
mod cycles;
mod disassembly;
mod frames;
mod json;
mod lines;
mod machine;
mod stack;
mod symbols;

pub use compare::compare;
pub use disassembly::Sources;
pub use lines::SourceLine;
pub use symbols::{Entry, EntryKind, Order};

use std::fmt::Write as _;

use coff::{Image, Target, dump};
use kmotiondef::GuestAddr;
use kmotiondef::boards::TargetBoard;
use vm::program::Program;
use vm::verify::verify_image;

use self::calls::Calls;

/// An analysed image.
#[derive(Debug)]
pub struct Inspection {
    /// The image.
    pub image: Image,
    /// Functions and objects with addresses, in ascending order.
    pub symbols: Vec<Entry>,
    /// The source line of each address where one begins, ascending.
    pub lines: Vec<SourceLine>,
    /// The code, if the machine can run it; otherwise the reason why not.
    pub program: Result<Program, String>,
}

impl Inspection {
    /// Analyses an image.
    #[must_use]
    pub fn new(image: Image) -> Self {
        let symbols = symbols::collect(&image);
        let lines = lines::collect(&image, &symbols);
        let program = program(&image);
        Self { image, symbols, lines, program }
    }

    /// Reads and analyses an image.
    ///
    /// # Errors
    /// The bytes are not an image.
    pub fn read(bytes: &[u8]) -> Result<Self, coff::Error> {
        Image::read(bytes).map(Self::new)
    }

    /// Headers and sections.
    #[must_use]
    pub fn headers(&self) -> String {
        let mut text = dump::headers(&self.image);
        if let Some(program) = &self.image.program
            && let Some(entry) = self.entry_at(self.main().unwrap_or(program.entry))
        {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "entry is `{}`", entry.name);
        }
        text + &dump::relocations(&self.image)
    }

    /// The board for which the image is linked; the default board if it does not name one.
    fn board(&self) -> &'static TargetBoard {
        let program = self.image.program.as_ref();
        let known = program.and_then(|it| TargetBoard::of_image(it.version_stamp, it.text_start));
        known.unwrap_or_else(TargetBoard::default_board)
    }

    /// The address of `main`; an image of bytecode is entered before it.
    fn main(&self) -> Option<u32> {
        let program = self.program.as_ref().ok().and_then(Program::main);
        program.map(GuestAddr::get).or_else(|| self.image.program.as_ref().map(|program| program.entry))
    }

    /// The function or object that contains `address`.
    #[must_use]
    pub fn entry_at(&self, address: u32) -> Option<&Entry> {
        let after = self.symbols.partition_point(|entry| entry.address <= address);
        let entry = self.symbols.get(after.checked_sub(1)?)?;
        let is_inside = address - entry.address < entry.size.unwrap_or(0).max(1);
        is_inside.then_some(entry)
    }

    /// The name of a function at exactly this address.
    fn function_name(&self, address: u32) -> Option<&str> {
        let entry = self.entry_at(address).filter(|entry| entry.address == address)?;
        Some(&entry.name)
    }

    /// Renders the call graph.
    #[must_use]
    pub fn calls(&self) -> String {
        match self.call_graph() {
            Ok(calls) => calls.render(),
            Err(reason) => format!("no call graph: {reason}\n"),
        }
    }

    /// The stack that each function needs, and the worst chain of calls.
    #[must_use]
    pub fn stack(&self) -> String {
        match self.call_graph() {
            Ok(calls) => stack::render(self, &calls),
            Err(reason) => format!("no stack depth: {reason}\n"),
        }
    }

    fn call_graph(&self) -> Result<Calls, String> {
        match (&self.program, self.image.target) {
            (Ok(program), _) => Ok(Calls::build(self, program)),
            (Err(_), Target::C6000) => Calls::of_code(self),
            (Err(reason), _) => Err(reason.clone()),
        }
    }
}

/// The verified code of an image.
fn program(image: &Image) -> Result<Program, String> {
    match image.target {
        Target::CC67 if image.program.is_none() => return Err("the object is not linked".to_owned()),
        Target::CC67 => {}
        Target::C6000 => return Err("it is code for the controller's processor, not bytecode".to_owned()),
        other => return Err(format!("code for target {other}")),
    }
    let text = image.section(".text").ok_or("there is no section .text")?;
    verify_image(text.data(), GuestAddr::new(text.address)).map_err(|error| error.to_string())
}
