//! The parts of a translator: its knowledge of registers, calls, second translations and the frame.

use std::collections::BTreeMap;

use cranelift_codegen::ir::{Block, FuncRef, MemFlagsData, SigRef, Value};
use cranelift_frontend::Variable;

use super::fast::{BudgetEdge, FastIterations};
use super::shortcut::{Attempt, ShortcutWords};
use super::unroll::Plan;
use crate::polling::PollingLoop;

/// The variables that hold the registers of the program.
pub(super) struct Registers {
    pub(super) variables: Vec<Variable>,
    pub(super) budget: Variable,
    /// The floating-point registers in which any NaN stands for the canonical NaN.
    pub(super) lax: Vec<bool>,
    /// Results of this block's floating-point arithmetic before canonicalisation of NaNs, in other registers.
    pub(super) raw: BTreeMap<usize, Value>,
}

/// The state for calls and requests.
pub(super) struct CallParts {
    /// The functions of the program that this function has called so far.
    pub(super) callees: BTreeMap<usize, FuncRef>,
    /// For each callee the words that callers inline; the number of attempts so far; and the current attempt.
    pub(super) shortcuts: BTreeMap<usize, Option<ShortcutWords>>,
    pub(super) attempts: usize,
    pub(super) attempt: Option<Attempt>,
    pub(super) request: FuncRef,
    pub(super) leave: SigRef,
    /// Arguments of the next call.
    pub(super) arguments: Vec<Value>,
    /// Result of the preceding call, as a slot or as a value.
    pub(super) result: Option<Value>,
}

/// The state for loops that are unrolled: their words are translated a second time.
#[derive(Default)]
pub(super) struct UnrollState {
    /// The loops of which several iterations are translated at once, by their first word, and the current one.
    pub(super) plans: BTreeMap<usize, Plan>,
    pub(super) fast: Option<FastIterations>,
    /// True while code is translated for the rare case that fast iterations cannot continue.
    pub(super) is_rare: bool,
    /// The edges that are still to be translated.
    pub(super) edges: Vec<BudgetEdge>,
}

/// The loops that may only wait.
#[derive(Default)]
pub(super) struct WaitParts {
    pub(super) loops: Vec<PollingLoop>,
    /// The block at the first word of each loop that is entered by its branches, by that word.
    pub(super) entries: BTreeMap<usize, Block>,
    /// The block in which the iterations of the loop that is being translated end, by its first word.
    pub(super) end: Option<(usize, Block)>,
    /// The call of that loop that yields the time, and the budget after it.
    pub(super) clock: Option<(usize, Variable)>,
}

/// Flags of accesses to the state and to guest memory, which never overlap.
pub(super) struct Flags {
    pub(super) state: MemFlagsData,
    pub(super) guest: MemFlagsData,
}

/// The values of the machine function that belong to the call.
pub(super) struct FrameParts {
    pub(super) state: Value,
    /// Address of this call's frame in guest memory.
    pub(super) stack_pointer: Value,
    /// The entry of the table of calls that belongs to the frame.
    pub(super) call_entry: Value,
}
