//! The code that this folder generates for a function, as text for people and for tests.

use std::fmt::Write as _;

use super::legalize;
use super::{GeneratedFunction, Text};
use crate::ir::function::{Block, Function, Signatures};
use crate::ir::inst::{CodeOrigin, Terminator};
use crate::ir::text::{self, SymbolNames};
use crate::relocation::{Relocation, RelocationKind};

/// A function in the instructions of the machine: its frame as a comment, and the instructions that are executed once
/// as a separate block before the first.
pub(crate) fn print_legalized(
    mut function: Function,
    signatures: &Signatures,
    names: &dyn SymbolNames,
) -> String {
    let frame = legalize::legalize(&mut function);
    if let (false, Some(&entry)) = (frame.prologue.is_empty(), function.layout.first()) {
        let (terminator, origin) = (Terminator::Jump(entry), CodeOrigin::of(function.span));
        let block = function.blocks.push(Block { insts: frame.prologue, terminator, origin });
        function.layout.insert(0, block);
    }
    let mut shown = match frame.size {
        Some(0) => String::new(),
        Some(size) => format!("; frame of {size} bytes"),
        None => "; frame larger than an address space".to_owned(),
    };
    let slots = if frame.size == Some(0) { 0 } else { function.slots.len() };
    for slot in function.slots.keys().take(slots) {
        // Writing to a string cannot fail.
        let _ = write!(shown, ", {slot} at {}", frame.offsets[slot]);
    }
    if !shown.is_empty() {
        shown.push('\n');
    }
    shown + &text::print(&function, signatures, names)
}

/// The words of a function; words that the linker completes show the names of their symbols.
pub(crate) fn print_words(text: &Text, generated: &GeneratedFunction, names: &dyn SymbolNames) -> String {
    let mut shown = String::new();
    for (number, op) in text.numbered_words(&generated.text.words) {
        let _ = write!(shown, "@{number}: {op}");
        let relocation = generated.text.relocations.iter().find(|relocation| relocation.word == number);
        if let Some(Relocation { kind, symbol, .. }) = relocation {
            let what = match kind {
                RelocationKind::Address => "+ &",
                RelocationKind::Call(_) => "calls ",
                RelocationKind::Processor(_) => "for the processor ",
            };
            let _ = write!(shown, " ; {what}{}", names.symbol_name(*symbol));
        }
        shown.push('\n');
    }
    shown
}
