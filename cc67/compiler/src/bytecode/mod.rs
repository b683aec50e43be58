//! IR to bytecode: the only folder that depends on the machine's instructions.
//!
//! A function passes four stages: [`legalize`] leaves only instructions that the machine has, [`registers`] gives every
//! value a register, [`select`] writes the words, [`meter`] inserts the charges. [`Generator`] does so for all
//! functions of a unit. The input is IR; the output is [`Text`], [relocations](crate::relocation) and constants;
//! [`references`] lists the symbols that a program's instructions refer to.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

pub(crate) mod head;
mod legalize;
mod meter;
mod operators;
mod pool;
pub(crate) mod references;
mod registers;
mod select;
pub(crate) mod text;
mod variables;

pub(crate) mod show;

#[cfg(test)]
mod tests;

pub use text::Text;
pub use variables::{InlinedPlaces, Location, VariablePlaces};
pub(crate) use vm::op::WORD;

use vm::verify::MAX_REGISTERS;

use crate::diag::Diagnostic;
use crate::ir::function::Function;
use crate::source::Span;
use pool::ConstantPool;
use text::FunctionText;

/// Bytes of guest frame that a function can have: 16 bits of units of eight bytes.
pub const MAX_FRAME: u32 = u16::MAX as u32 * WORD as u32;

/// A function in words.
#[derive(Debug)]
pub(crate) struct GeneratedFunction {
    /// Its words and their symbols, relocations and positions.
    pub(crate) text: FunctionText,
    /// Bytes of its frame in guest memory.
    pub(crate) frame: u32,
    /// The locations of the source's locals.
    pub(crate) variables: Vec<VariablePlaces>,
    /// The inlined calls.
    pub(crate) inlined: Vec<InlinedPlaces>,
    /// The loops that are scheduled without overlap because the search for it exceeded its limit of work.
    pub(crate) exceeded: Vec<Span>,
}

/// Writes the functions of a unit, one after another.
#[derive(Debug, Default)]
pub(crate) struct Generator {
    text: Text,
    pool: ConstantPool,
    keeps_variables: bool,
}

impl Generator {
    /// Sets whether variables of the source keep their registers to the end of their function.
    pub(crate) const fn keeps_variables(&mut self, keeps: bool) {
        self.keeps_variables = keeps;
    }

    /// Takes one optimised function through all stages; `name` is for messages.
    ///
    /// # Errors
    /// That the function is too large for the machine.
    pub(crate) fn function(
        &mut self,
        mut ir: Function,
        name: &str,
    ) -> Result<GeneratedFunction, Box<Diagnostic>> {
        let frame = legalize::legalize(&mut ir);
        let size =
            frame.size.filter(|size| *size <= MAX_FRAME).ok_or_else(|| frame_too_large(ir.span, name))?;
        let kept = if self.keeps_variables { registers::assign(&ir, &frame.prologue, true) } else { None };
        let registers = kept.or_else(|| registers::assign(&ir, &frame.prologue, false));
        let registers = registers.ok_or_else(|| too_large(ir.span, name))?;
        let mut code = select::select(&ir, &frame, &registers, &mut self.pool);
        if code.is_too_large {
            return Err(too_large(ir.span, name));
        }
        meter::insert_charges(&mut code);
        let places = variables::PlacedWords::take_from(&mut code);
        let added = self.text.append(ir.signature, &registers, size, code);
        let (variables, inlined) = places.collect(&ir, &frame, &registers, &added.words);
        Ok(GeneratedFunction { text: added, frame: size, variables, inlined, exceeded: Vec::new() })
    }

    /// The words of all functions so far.
    pub(crate) const fn text(&self) -> &Text {
        &self.text
    }

    /// The words of all functions, and the constants that they use.
    pub(crate) fn finish(self) -> (Text, Vec<u64>) {
        (self.text, self.pool.into_values())
    }
}

fn frame_too_large(span: Span, name: &str) -> Box<Diagnostic> {
    let error = Diagnostic::error(span, format!("the local variables of `{name}` are too large"))
        .note(format!("a function can have {MAX_FRAME} bytes of them"))
        .help("make large arrays `static` or global");
    Box::new(error)
}

fn too_large(span: Span, name: &str) -> Box<Diagnostic> {
    let error = Diagnostic::error(span, format!("function `{name}` is too large"))
        .note(format!("it needs more than {MAX_REGISTERS} registers, signatures or table entries"))
        .help("split it");
    Box::new(error)
}
