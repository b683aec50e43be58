//! Instructions with their cycles, for scheduling and layout.

use c67x::{FETCH_PACKET, Inst};

use super::code::Value;
use crate::source::Span;

/// Words of a fetch packet.
pub(super) const FETCH: u32 = FETCH_PACKET / 4;

/// The longest `NOP`.
pub(super) const LONGEST: u32 = 9;

/// An instruction with its cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct IssuedInst {
    pub(super) cycle: u32,
    pub(super) inst: Inst,
    pub(super) value: Option<Value>,
    pub(super) span: Span,
}

/// A region whose instructions have been scheduled.
#[derive(Clone, Debug)]
pub(super) struct ScheduledRegion {
    pub(super) label: u32,
    /// Ascending by cycle.
    pub(super) insts: Vec<IssuedInst>,
    /// Cycles of the region.
    pub(super) cycles: u32,
    /// The estimated frequency of its execution.
    pub(super) weight: f32,
    pub(super) span: Span,
    /// True for a loop whose search for an overlap exceeded its budget.
    pub(super) is_exceeded: bool,
}
