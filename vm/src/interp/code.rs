//! The code that the interpreter executes: the words of a program, each with its handler.
//!
//! The words of the image are kept as they are (`parts.rs`), with two changes made once: a function's word gets the
//! facts that its calls need, and the operands of commutative instructions are swapped if this makes the first one the
//! register assigned last.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use super::context::FunctionHead;
use super::dispatch::{
    ENDS_ITERATION, ENDS_ITERATION_IF, ENDS_ITERATION_UNLESS, Handler, OBSERVED, OBSERVED_AT,
    OBSERVED_WITH_CALL_BACK, SHARED, handler_of,
};
use super::observe::{self, AccessPlace};
use super::parts::{A, B, DST, Parts, is_commutative, parts_of};
use super::sequences::{AHEAD, BREAK, Text};
use crate::engine::ObservedAccesses;
use crate::kind::OpKind;
use crate::meter::branch_target;
use crate::op::{Op, WORD};
use crate::operand::{FuncRef, Label};
use crate::polling::{PollingLoop, Readers, polling_loops};
use crate::program::Program;
use crate::shared::is_noticed;

/// An instruction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word {
    /// The handler of the instruction, and possibly of the instructions after it.
    pub(super) handler: Handler,
    /// The word of the image.
    pub(super) parts: Parts,
}

/// The words of a program by index, and after them [`AHEAD`] that trap.
pub(super) type Words = [Word];

impl Word {
    /// The word of the opcode `code` with these operands.
    const fn new(code: u16, parts: Parts) -> Self {
        Self { handler: handler_of(code), parts }
    }

    /// The word of a single instruction that is not part of a sequence.
    pub(super) fn plain(op: &Op) -> Self {
        let parts = parts_of(op);
        Self::new(parts[0], parts)
    }

    /// The word at which a context is held.
    pub(super) const HELD: Self = Self::new(BREAK, [BREAK, 0, 0, 0]);

    /// Encodes an instruction whose accesses to shared memory are reported.
    fn observed(op: &Op, has_call_back: bool) -> Self {
        let plain = Self::plain(op);
        let handler = match observe::place_of(op) {
            Some(AccessPlace::Constant(address)) if !is_noticed(address, has_call_back) => return plain,
            Some(AccessPlace::Constant(_)) => OBSERVED_AT,
            Some(AccessPlace::Register) if has_call_back => OBSERVED_WITH_CALL_BACK,
            Some(AccessPlace::Register) => OBSERVED,
            Some(AccessPlace::Block) => SHARED,
            None => return plain,
        };
        Self { handler, ..plain }
    }

    /// The word of a branch with which an iteration of a waiting loop may end.
    fn ending_iteration(op: &Op) -> Self {
        let is_conditional = op.kind() == OpKind::Branch;
        let handler = match (is_conditional, matches!(op, Op::BrIf { .. })) {
            (false, _) => ENDS_ITERATION,
            (true, true) => ENDS_ITERATION_IF,
            (true, false) => ENDS_ITERATION_UNLESS,
        };
        Self { handler, ..Self::plain(op) }
    }

    /// Reports whether a context is held at it.
    pub(super) const fn is_held(&self) -> bool {
        self.parts[0] == BREAK
    }

    /// The head of a function, which [`encode`] stores in the function's word.
    #[inline(always)]
    pub(super) const fn head(&self) -> FunctionHead {
        let [_, parameters, registers, frame] = self.parts;
        FunctionHead { parameters, registers, frame }
    }

    /// The index of the register that is the operand at `place`.
    #[inline(always)]
    pub(super) const fn register(&self, place: usize) -> u16 {
        self.parts[place]
    }

    /// The index of the register that it assigns, if it assigns one.
    #[inline(always)]
    pub(super) const fn assigned(&self) -> u16 {
        self.parts[DST]
    }
}

/// The words of one program.
#[derive(Clone)]
pub(super) struct EncodedProgram {
    words: Box<Words>,
    /// The accesses to shared memory that are reported.
    observed: ObservedAccesses,
    /// The waiting loops; none if all accesses are reported.
    loops: Arc<[PollingLoop]>,
}

impl EncodedProgram {
    /// Encodes `program`, with accesses to shared memory reported or not, for a firmware with these `readers`.
    pub(super) fn new(program: &Program, observed: ObservedAccesses, readers: Readers<'_>) -> Self {
        let loops =
            if observed == ObservedAccesses::All { Vec::new() } else { polling_loops(program, readers) };
        Self::with(program, observed, loops.into(), &|_, _| false)
    }

    /// Encodes a program with holds at some words.
    pub(super) fn held(&self, program: &Program, is_held: &dyn Fn(usize, &Op) -> bool) -> Self {
        Self::with(program, self.observed, Arc::clone(&self.loops), is_held)
    }

    fn with(
        program: &Program,
        observed: ObservedAccesses,
        loops: Arc<[PollingLoop]>,
        is_held: &dyn Fn(usize, &Op) -> bool,
    ) -> Self {
        let is_observed = |pc: usize, op: &Op| {
            observed != ObservedAccesses::None && !is_held(pc, op) && observe::place_of(op).is_some()
        };
        let branches: BTreeSet<usize> = loops.iter().flat_map(|polling| polling.branches.clone()).collect();
        let is_alone = |pc: usize, op: &Op| is_held(pc, op) || is_observed(pc, op) || branches.contains(&pc);
        let mut words = encode(program, &is_alone);
        let has_call_back = observed != ObservedAccesses::None && program.has_call_back();
        for (pc, op) in program.ops().iter().enumerate().filter(|(pc, op)| is_observed(*pc, op)) {
            words[pc] = Word::observed(op, has_call_back);
        }
        for pc in branches {
            let op = &program.ops()[pc];
            if !is_held(pc, op) {
                words[pc] = Word::ending_iteration(op);
            }
        }
        Self { words, observed, loops }
    }

    /// The loops that may only wait.
    pub(super) fn loops(&self) -> Arc<[PollingLoop]> {
        Arc::clone(&self.loops)
    }

    /// The words.
    pub(super) const fn words(&self) -> &Words {
        &self.words
    }
}

impl fmt::Debug for EncodedProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Encoded")
    }
}

/// A program as the interpreter has it.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// The program.
    pub(super) program: Arc<Program>,
    /// Its words.
    pub(super) words: Arc<EncodedProgram>,
}

/// The words of a program; words at which contexts are held get a handler that stops a context.
fn encode(program: &Program, is_held: &dyn Fn(usize, &Op) -> bool) -> Box<Words> {
    let ops = program.ops();
    let mut parts: Vec<Parts> = ops.iter().map(parts_of).collect();
    for pc in 1..ops.len() {
        if is_commutative(&ops[pc]) && parts[pc][B] == parts[pc - 1][DST] {
            parts[pc].swap(A, B);
        }
    }
    let held = |(pc, op): (usize, &Op)| if is_held(pc, op) { BREAK } else { parts[pc][0] };
    let codes: Vec<u16> = ops.iter().enumerate().map(held).collect();
    let mut is_target = vec![false; ops.len()];
    for Label(to) in ops.iter().filter_map(branch_target) {
        is_target[to as usize] = true;
    }
    let text = Text { ops, codes: &codes, parts: &parts, is_target: &is_target };
    let word = |pc: usize| {
        let mut parts = parts[pc];
        if codes[pc] == BREAK {
            parts[0] = BREAK;
        }
        if let Op::Func { .. } = ops[pc] {
            let FunctionHead { parameters, registers, frame } = FunctionHead::of(program, FuncRef(pc as u32));
            parts = [parts[0], parameters, registers, frame];
        }
        Word::new(text.code_at(pc), parts)
    };
    let words = (0..ops.len()).map(word);
    let behind = std::iter::repeat_n(Word::new(0, [0; WORD / 2]), AHEAD);
    words.chain(behind).collect()
}
