//! The frame on the stack.
//!
//! B15 points below the function's frame: the word at B15 may be overwritten by an interrupt at any time, the words
//! from B15 + 4 on are safe (`c67x.md` 6.1). These are the last named argument of variadic calls, the variable
//! arguments, the objects, and the words used by the allocator.

use cranelift_entity::SecondaryMap;

use super::code::Code;
use crate::ir::function::{Function, table};
use crate::ir::inst::SlotId;

/// Bytes that an offset of the processor reaches.
pub(super) const MAX_FRAME: u32 = 0x7FC0;

/// The layout of the frame, in bytes above B15.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) slots: SecondaryMap<SlotId, u32>,
    pub(super) spills: u32,
    /// The saved registers.
    pub(super) saved: u32,
    /// By how much B15 is lowered, a multiple of 8.
    pub(super) size: u32,
}

/// Lays out the frame; `None` if it exceeds the range of an offset.
pub(super) fn lay_out(function: &Function, code: &Code, saved: u32) -> Option<Frame> {
    let mut slots = table(function.slots.len());
    let mut end = if code.has_variable_calls { 8_u32 } else { 4 };
    if let Some(outgoing) = function.outgoing {
        slots[outgoing] = 8;
        end = end.max(8_u32.checked_add(function.slots[outgoing].size)?);
    }
    let others = function.slots.iter().filter(|(id, slot)| function.outgoing != Some(*id) && slot.size > 0);
    for (id, slot) in others {
        let start = end.checked_next_multiple_of(slot.align.max(1))?;
        slots[id] = start;
        end = start.checked_add(slot.size)?;
    }
    let spills = if code.spills > 0 { end.checked_next_multiple_of(8)? } else { end };
    let end = spills.checked_add(code.spills.checked_mul(4)?)?;
    let saved_at = end.checked_next_multiple_of(4)?;
    let end = saved_at.checked_add(4 * saved)?;
    // The word at the old B15 also belongs to the function.
    let size = if end <= 4 { 0 } else { (end - 4).checked_next_multiple_of(8)? };
    (size <= MAX_FRAME).then_some(Frame { slots, spills, saved: saved_at, size })
}
