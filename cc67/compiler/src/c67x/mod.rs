//! Code generation for the real processor: the only folder that depends on execute packets.
//!
//! A function passes through these stages, one file each:
//!
//! 1. [`select`]: IR to instructions over virtual registers ([`code`]); [`forms`] has the forms of the table that can
//!    express an instruction.
//! 2. [`predicate`]: short branches become conditions. [`copies`]: copies of selection are replaced by their sources.
//!    [`unroll`]: short loops are unrolled. [`counters`]: the counters of loops are tested directly. [`sides`]: every
//!    register gets one of the two files; copies are inserted where an instruction can only use one of them.
//! 3. [`live`], [`allocate`], [`spill`]: registers of the processor, but only those that survive a thread switch.
//! 4. [`frame`], [`moves`], [`expand`]: calls, the stack, the beginning and the ends; regions of [`step`]s.
//! 5. [`graph`], [`resources`], [`schedule`]: packets, [`refine`] makes them smaller; [`pipeline`], [`modulo`]: those of
//!    loops whose iterations overlap; [`memo`]: what an earlier attempt at the function found.
//! 6. [`attempts`]: stages 2 to 5 in several variants, of which the best is kept.
//! 7. [`layout`]: words in fetch packets, with relocations for the linker ([`text`]).
//!
//! Rules that all stages follow (`c67x.md`):
//! - no register is read while a result for it is in flight, for an interrupt would make it land early; except between
//!   packets of a loop where interrupts are off, in the delay slots of its branch ([`modulo`]);
//! - observable accesses to memory keep their order;
//! - at the end of a region nothing is in flight, so calls, returns and jumps are safe regardless of the code that
//!   follows;
//! - no data of the program is at B15 or below, and B15 is a multiple of 8.

mod abi;
mod allocate;
mod attempts;
mod code;
mod copies;
mod counters;
mod expand;
pub(crate) mod externs;
mod forms;
mod frame;
mod graph;
mod late;
mod layout;
mod live;
mod memo;
mod modulo;
mod moves;
mod packets;
mod pipeline;
mod predicate;
mod refine;
mod resources;
mod schedule;
mod select;
mod sides;
mod spill;
mod step;
pub(crate) mod text;
mod unroll;

#[cfg(test)]
mod tests;

pub(crate) use externs::Externs;

use crate::diag::Diagnostic;
use crate::ir::function::{Function, Signatures};
use crate::passes::Level;
use crate::source::Span;
use attempts::Attempt;
use expand::TooLarge;
use text::MachineText;

/// Writes the functions of a unit, one after another.
#[derive(Debug)]
pub(crate) struct Generator {
    words: Vec<u32>,
    externs: Externs,
    level: Level,
}

/// Functions begin at multiples of this many words: a fetch packet.
pub(crate) const ALIGN: u32 = 8;

impl Generator {
    /// A generator for a unit with these symbols.
    pub(crate) fn new(externs: Externs, level: Level) -> Self {
        Self { words: Vec::new(), externs, level }
    }

    /// Takes one optimised function through all stages; `name` is for messages.
    ///
    /// # Errors
    /// That the function is too large for the processor.
    pub(crate) fn function(
        &mut self,
        ir: &Function,
        signatures: &Signatures,
        name: &str,
    ) -> Result<MachineText, Box<Diagnostic>> {
        let context = select::Context { function: ir, signatures, externs: &mut self.externs };
        let mut code = select::select(context);
        if self.level != Level::None {
            predicate::run(&mut code);
            copies::run(&mut code);
        }
        let attempt = attempts::best_attempt(ir, code, self.level).map_err(|why| match why {
            TooLarge::Frame => frame_too_large(ir.span, name),
            TooLarge::Code => too_large(ir.span, name),
        })?;
        let Attempt { regions, code, frame } = attempt;
        let laid = layout::lay_out(&regions, &code.tables, code.blocks.len() as u32, ir.span);
        #[cfg(debug_assertions)]
        verify(&laid, name);
        // The words between functions are never executed.
        let start = (self.words.len() as u32).next_multiple_of(ALIGN);
        self.words.resize(start as usize, 0);
        self.words.extend(&laid.words);
        let end = self.words.len() as u32;
        let spans = laid.spans.into_iter().map(|(word, span)| (start + word, span)).collect();
        let exceeded = regions.iter().filter(|region| region.is_exceeded).map(|region| region.span).collect();
        Ok(MachineText { words: start..end, fixups: laid.fixups, spans, frame, exceeded })
    }

    /// The words of all functions, and the names that they need in addition to those of the unit.
    pub(crate) fn finish(self) -> (Vec<u32>, Vec<&'static str>) {
        (self.words, self.externs.into_added())
    }
}

/// Checks the schedule against the rules of the `c67x` crate, which is independent of this one.
#[cfg(debug_assertions)]
fn verify(laid: &layout::LaidOutFunction, name: &str) {
    let code = &laid.words[..laid.code as usize];
    let Ok(packets) = c67x::schedule::packets(code) else {
        panic!("{name}: a word that is not an instruction");
    };
    let entries: Vec<u32> = laid.entries.iter().map(|word| word * 4).collect();
    // Branches that the linker completes leave the code: a displacement of 0 would be followed.
    let found = c67x::schedule::check(0, &packets, &entries);
    assert!(
        found.is_empty(),
        "{name}: {}",
        found.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    );
}

fn frame_too_large(span: Span, name: &str) -> Box<Diagnostic> {
    let error = Diagnostic::error(span, format!("the local variables of `{name}` are too large"))
        .note(format!("a function can have {} bytes of them", frame::MAX_FRAME))
        .help("make large arrays `static` or global");
    Box::new(error)
}

fn too_large(span: Span, name: &str) -> Box<Diagnostic> {
    let error = Diagnostic::error(span, format!("function `{name}` is too large")).help("split it");
    Box::new(error)
}
