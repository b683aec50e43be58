//! The locations of the source's locals, for debuggers.

use std::fmt;
use std::ops::Range;

use cranelift_entity::SecondaryMap;
use cranelift_entity::packed_option::PackedOption;

use super::legalize::FrameLayout;
use super::registers::Registers;
use super::select::Code;
use crate::ir::function::{Function, SourceVariable, VariableHome};
use crate::ir::inst::{InlineId, ValueId};
use crate::source::Span;
use crate::typed::{LocalId, SymbolId};

/// A local of the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VariablePlaces {
    /// The local.
    pub local: LocalId,
    /// Words of the unit before which it has each location; before other words it is optimised out.
    pub places: Vec<(Range<u32>, Location)>,
}

/// An inlined call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InlinedPlaces {
    /// The called function.
    pub callee: SymbolId,
    /// The statement that called it.
    pub call: Span,
    /// The index of the inlined call that contains the statement.
    pub inside: Option<u32>,
    /// Its words in the unit, without those of calls in it.
    pub words: Vec<Range<u32>>,
    /// The locations of its locals.
    pub variables: Vec<VariablePlaces>,
}

/// The location of a local.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In a register of its call.
    Register(u16),
    /// This many bytes above the beginning of the frame.
    Frame(u32),
    /// In memory, at the address in a register.
    Pointer(u16),
    /// It has no location, but always this value, given as the bits of a register.
    Constant(u64),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Register(register) => write!(f, "register {register}"),
            Self::Frame(offset) => write!(f, "frame + {offset}"),
            Self::Pointer(register) => write!(f, "at the address in register {register}"),
            Self::Constant(bits) => write!(f, "always {bits:#x}"),
        }
    }
}

/// The words of instructions and inlined calls in the function being generated, numbered within the function.
#[derive(Debug)]
pub(super) struct PlacedWords {
    /// The first word of each instruction, and of the end of each block.
    insts: Vec<u32>,
    /// The first word of each run of words of one inlined call, or of none.
    calls: Vec<(u32, PackedOption<InlineId>)>,
}

impl PlacedWords {
    /// Takes it out of the code.
    pub(super) fn take_from(code: &mut Code) -> Self {
        Self { insts: std::mem::take(&mut code.insts), calls: std::mem::take(&mut code.calls) }
    }

    /// Returns the locations of the locals of a function and of its inlined calls; `words` are its words in the unit.
    pub(super) fn collect(
        &self,
        function: &Function,
        frame: &FrameLayout,
        registers: &Registers,
        words: &Range<u32>,
    ) -> (Vec<VariablePlaces>, Vec<InlinedPlaces>) {
        let head = 1 + (registers.classes.len() as u32).div_ceil(super::head::CLASSES as u32);
        let (writes, start) = (function.writes(), words.start + head);
        let finder = Finder { placed: self, frame, registers, words, writes, start };
        let variables = finder.variables(&function.source.variables);
        let inlined = function.source.inlined.iter().map(|(id, call)| InlinedPlaces {
            callee: call.callee,
            call: call.origin.span,
            inside: call.origin.call.expand().map(InlineId::as_u32),
            words: finder.words_of(id),
            variables: finder.variables(&call.variables),
        });
        (variables, inlined.collect())
    }
}

/// Finds where locals are.
struct Finder<'a> {
    placed: &'a PlacedWords,
    frame: &'a FrameLayout,
    registers: &'a Registers,
    words: &'a Range<u32>,
    /// Number of writes of each value.
    writes: SecondaryMap<ValueId, u32>,
    /// The first word after those that enter the function.
    start: u32,
}

impl Finder<'_> {
    /// The locations of each local; a local with several possible locations lists them in the order of preference.
    fn variables(&self, variables: &[SourceVariable]) -> Vec<VariablePlaces> {
        let mut found: Vec<VariablePlaces> = Vec::with_capacity(variables.len());
        for variable in variables {
            let place = self.place(variable.home).filter(|(range, _)| !range.is_empty());
            match found.last_mut() {
                Some(last) if last.local == variable.local => last.places.extend(place),
                _ => {
                    let places = place.into_iter().collect();
                    found.push(VariablePlaces { local: variable.local, places });
                }
            }
        }
        found
    }

    fn place(&self, home: VariableHome) -> Option<(Range<u32>, Location)> {
        let all = self.start..self.words.end;
        match home {
            VariableHome::Slot(slot) => Some((all, Location::Frame(self.frame.offsets[slot]))),
            VariableHome::Pointer(value) => {
                Some((self.range(value)?, Location::Pointer(self.registers.register_of(value))))
            }
            // If a write was removed, the register may hold an older value.
            VariableHome::Value(value, writes) if self.writes[value] == writes => {
                Some((self.range(value)?, Location::Register(self.registers.register_of(value))))
            }
            VariableHome::Value(..) => None,
            VariableHome::Constant(bits) => Some((all, Location::Constant(bits))),
        }
    }

    /// The words before which a value is in its register.
    fn range(&self, value: ValueId) -> Option<Range<u32>> {
        let (from, to) = self.registers.span(value)?;
        let begin = if from == 0 { self.start } else { self.word_at(from) };
        // The last instruction that mentions it is yet to be executed.
        Some(begin..(self.word_at(to) + 1).min(self.words.end))
    }

    fn word_at(&self, position: u32) -> u32 {
        // The first instruction has position 2; the result of an instruction is available from the next one on.
        let index = (position.div_ceil(2) as usize).saturating_sub(1);
        self.placed.insts.get(index).map_or(self.words.end, |word| self.start + word)
    }

    /// The words of an inlined call, without those of calls in it.
    fn words_of(&self, id: InlineId) -> Vec<Range<u32>> {
        let calls = &self.placed.calls;
        let ends = calls.iter().skip(1).map(|(word, _)| self.start + word).chain([self.words.end]);
        let runs = calls.iter().zip(ends).filter(|((_, call), _)| call.expand() == Some(id));
        runs.map(|((word, _), end)| self.start + word..end).filter(|run| !run.is_empty()).collect()
    }
}
