//! Code generation for the real processor: the folder that knows execute packets.
//!
//! A function passes these stages, a file each:
//!
//! 1. [`select`]: IR to instructions over virtual registers ([`code`]); [`forms`] has the forms of the table that can
//!    express an instruction.
//! 2. [`predicate`]: short branches become conditions. [`copies`]: copies of selection are replaced by their sources.
//!    [`turns`]: short loops are unrolled. [`counters`]: the counters of loops are tested directly. [`sides`]: every
//!    register gets one of the two files; copies where an instruction reaches only one.
//! 3. [`live`], [`allocate`], [`spill`]: registers of the processor, those that survive a thread switch.
//! 4. [`frame`], [`moves`], [`expand`]: calls, the stack, the beginning and the ends; regions of [`step`]s.
//! 5. [`graph`], [`resources`], [`schedule`]: packets, [`refine`] makes them smaller; [`pipeline`], [`modulo`]: those of
//!    loops whose iterations overlap.
//! 6. [`layout`]: words, on fetch packets, with what the linker completes ([`text`]).
//!
//! Rules that all stages keep (`c67x.md`):
//! - no register is read while a result for it is in flight, for an interrupt would make it land early; except between
//!   packets of a loop where none is taken, in the delay slots of its branch ([`modulo`]);
//! - accesses to memory that others can see keep their order;
//! - at the end of a region nothing is in flight, so calls, returns and jumps are safe whatever follows;
//! - nothing that the program needs is at B15 or below, and B15 is a multiple of 8.

mod abi;
mod allocate;
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
mod turns;

#[cfg(test)]
mod tests;

pub(crate) use externs::Externs;

use crate::diag::Diagnostic;
use crate::ir::function::{Function, Signatures};
use crate::passes::Level;
use crate::source::Span;
use code::Code;
use expand::{Back, TooLarge};
use packets::Scheduled;
use schedule::Order;
use sides::Policy;
use text::Words;

/// Writes the functions of a unit, one after another.
#[derive(Debug)]
pub(crate) struct Generator {
    words: Vec<u32>,
    externs: Externs,
    level: Level,
}

/// The most loops of a function that are tried in two ways.
const MOST_TRIED: u32 = 6;

/// A function in packets.
struct Attempt {
    regions: Vec<Scheduled>,
    code: Code,
    /// Bytes of its frame.
    frame: u32,
}

impl Attempt {
    /// Its words.
    fn words(&self) -> u32 {
        self.regions.iter().fold(0, |at, region| refine::end(region, at))
    }

    /// Its cycles, as far as one can guess how often each region happens.
    fn cost(&self) -> f32 {
        self.regions.iter().map(|region| region.weight * region.cycles as f32).sum()
    }

    /// The cost of the code in loops.
    fn loop_cost(&self) -> f32 {
        let inside = self.regions.iter().filter(|region| region.weight > 1.0);
        inside.map(|region| region.weight * region.cycles as f32).sum()
    }
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
    ) -> Result<Words, Box<Diagnostic>> {
        let context = select::Context { function: ir, signatures, externs: &mut self.externs };
        let mut code = select::select(context);
        if self.level != Level::None {
            predicate::run(&mut code);
            copies::run(&mut code);
        }
        let attempt = self.best(ir, code).map_err(|why| match why {
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
        Ok(Words { words: start..end, fixups: laid.fixups, spans, frame, exceeded })
    }

    /// The packets of a function. At the level that makes code larger, short loops are tried unrolled and not, and all
    /// loops with other sides for their registers; the better ones stay.
    fn best(&self, ir: &Function, code: Code) -> Result<Attempt, TooLarge> {
        if self.level != Level::Fast {
            let frame = self.attempt(ir, code.clone(), Back::Frame, Policy::USUAL);
            if self.level == Level::None || code.calls.is_empty() {
                return frame;
            }
            let register = self.attempt(ir, code, Back::Register, Policy::USUAL)?;
            return frame.map(|frame| if register.words() <= frame.words() { register } else { frame });
        }
        let has_loop = (0..).zip(&code.blocks).any(|(own, block)| block.end.targets().any(|to| to == own));
        let with_turns = |skipped: u32, policy: Policy| {
            let mut code = code.clone();
            let count = turns::run(&mut code, skipped);
            (self.attempt(ir, code, Back::Register, policy), count)
        };
        let (mut best, count) = with_turns(0, Policy::USUAL);
        let mut skipped = 0;
        for index in 0..count.min(MOST_TRIED) {
            let (other, _) = with_turns(skipped | 1 << index, Policy::USUAL);
            if other.as_ref().is_ok_and(|other| best.as_ref().map_or(true, |best| other.cost() < best.cost()))
            {
                best = other;
                skipped |= 1 << index;
            }
        }
        for policy in Policy::OTHERS.into_iter().filter(|_| has_loop) {
            let (other, _) = with_turns(skipped, policy);
            let costs = |attempt: &Attempt| (attempt.loop_cost(), attempt.cost());
            if other.as_ref().is_ok_and(|other| best.as_ref().map_or(true, |best| costs(other) < costs(best)))
            {
                best = other;
            }
        }
        best
    }

    /// Takes instructions over virtual registers through the stages that follow.
    fn attempt(
        &self,
        ir: &Function,
        mut code: Code,
        back: Back,
        policy: Policy,
    ) -> Result<Attempt, TooLarge> {
        if self.level != Level::None {
            counters::run(&mut code);
        }
        sides::assign(&mut code, policy);
        let assignment = allocate::allocate(&mut code, self.level).ok_or(TooLarge::Code)?;
        let order = if self.level == Level::None { Order::Source } else { Order::Early };
        let expanded = expand::expand(ir, &code, &assignment, back)?;
        let mut regions = if self.level == Level::Fast {
            pipeline::schedule(expanded.regions, expanded.labels)
        } else {
            let mut at = 0;
            let in_place = |region| {
                let scheduled = schedule::schedule(region, order, at);
                at = refine::end(&scheduled, at);
                scheduled
            };
            expanded.regions.into_iter().map(in_place).collect()
        };
        late::run(&mut regions, &expanded.late);
        Ok(Attempt { regions, code, frame: expanded.frame })
    }

    /// The words of all functions, and the names that they need besides those of the unit.
    pub(crate) fn finish(self) -> (Vec<u32>, Vec<&'static str>) {
        (self.words, self.externs.into_added())
    }
}

/// Checks the schedule with the rules that the processor's own crate has, which knows nothing of this one.
#[cfg(debug_assertions)]
fn verify(laid: &layout::Laid, name: &str) {
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
