//! Where the locals of the source are, for debuggers.

use std::fmt;
use std::ops::Range;

use super::legalize::FrameLayout;
use super::registers::Registers;
use crate::ir::function::{Function, VariableHome};
use crate::typed::LocalId;

/// A local of the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VariablePlaces {
    /// The local.
    pub local: LocalId,
    /// Words of the unit before which it is where; before others it is optimised out.
    pub places: Vec<(Range<u32>, Location)>,
}

/// Where a local is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In a register of its call.
    Register(u16),
    /// This many bytes above the beginning of the frame.
    Frame(u32),
    /// In memory, at the address in a register.
    Pointer(u16),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Register(register) => write!(f, "register {register}"),
            Self::Frame(offset) => write!(f, "frame + {offset}"),
            Self::Pointer(register) => write!(f, "at the address in register {register}"),
        }
    }
}

/// Where the locals of a function are that was generated; `insts` are the first words of its instructions within the
/// function, whose `words` are those of the unit.
pub(super) fn collect(
    function: &Function,
    frame: &FrameLayout,
    registers: &Registers,
    insts: &[u32],
    words: &Range<u32>,
) -> Vec<VariablePlaces> {
    let head = 1 + (registers.classes.len() as u32).div_ceil(super::head::CLASSES as u32);
    let start = words.start + head;
    let word_at = |position: u32| {
        // Position 2 is that of the first instruction; what an instruction writes is there from the next one on.
        let index = (position.div_ceil(2) as usize).saturating_sub(1);
        insts.get(index).map_or(words.end, |word| start + word)
    };
    let range = |value| {
        let (from, to) = registers.span(value)?;
        let begin = if from == 0 { start } else { word_at(from) };
        // The last one that mentions it is still to be executed.
        Some(begin..(word_at(to) + 1).min(words.end))
    };
    let place = |home: VariableHome| match home {
        VariableHome::Slot(slot) => Some((start..words.end, Location::Frame(frame.offsets[slot]))),
        VariableHome::Pointer(value) => Some((range(value)?, Location::Pointer(registers.of(value)))),
        // Where a write is gone, the register may hold an older value.
        VariableHome::Value(value, writes) if function.writes(value) == writes => {
            Some((range(value)?, Location::Register(registers.of(value))))
        }
        VariableHome::Value(..) => None,
    };
    let variable = |variable: &crate::ir::function::SourceVariable| VariablePlaces {
        local: variable.local,
        places: place(variable.home).into_iter().filter(|(range, _)| !range.is_empty()).collect(),
    };
    function.variables.iter().map(variable).collect()
}
