//! Instructions executed one at a time: for a debugger, and up to the end of a slice that comes in the middle of a
//! segment.
//!
//! A single instruction is executed in a text in which all other words hold the context.

use std::sync::Arc;

use kmotiondef::{Cycles, GuestAddr};

use super::code::{Word, Words};
use super::context::Context;
use super::observe::{self, Observer};
use super::split::SegmentRest;
use crate::engine::{ObservedAccesses, Preemption, Slice};
use crate::firmware::Firmware;
use crate::kind::{Name, OpKind, Width};
use crate::op::Op;
use crate::operand::{Addr, FuncRef, Off, RegF64, RegI32, RegI64};
use crate::polling::PollingLoop;
use crate::program::Program;
use crate::trap::TrapKind;

/// A text that contains a single instruction.
#[derive(Debug, Default)]
pub(super) struct SingleText(Vec<Word>);

impl SingleText {
    /// Does `work` with a text in which only the instruction `pc` of `program` is not held; `words` are the program's.
    pub(super) fn with<R>(
        &mut self,
        program: &Program,
        words: &Words,
        pc: usize,
        work: impl FnOnce(&Words) -> R,
    ) -> Option<R> {
        let op = program.ops().get(pc)?;
        self.with_word(program, words, pc, Word::plain(op), work)
    }

    /// As [`with`](Self::with), for an instruction whose access is reported if `is_observed`. Words with accesses then
    /// do not form sequences.
    pub(super) fn with_observed<R>(
        &mut self,
        (program, words): (&Program, &Words),
        pc: usize,
        is_observed: bool,
        work: impl FnOnce(&Words) -> R,
    ) -> Option<R> {
        let (op, word) = (program.ops().get(pc)?, words.get(pc)?);
        let word = if is_observed && observe::place_of(op).is_some() { *word } else { Word::plain(op) };
        self.with_word(program, words, pc, word, work)
    }

    fn with_word<R>(
        &mut self,
        program: &Program,
        words: &Words,
        pc: usize,
        word: Word,
        work: impl FnOnce(&Words) -> R,
    ) -> Option<R> {
        let op = program.ops().get(pc)?;
        if self.0.len() < words.len() {
            self.0.resize(words.len(), Word::HELD);
        }
        self.0[pc] = word;
        // A call finds the facts about its callee there.
        let callee = op.operand::<FuncRef>(Name::Func).map(|function| function.0 as usize);
        if let Some(callee) = callee {
            self.0[callee] = words[callee];
        }
        let result = work(&self.0);
        self.0[pc] = Word::HELD;
        if let Some(callee) = callee {
            self.0[callee] = Word::HELD;
        }
        Some(result)
    }
}

/// The preemption mode, and the state for executing instructions one at a time.
#[derive(Debug, Default)]
pub(super) struct StepState {
    pub(super) preemption: Preemption,
    pub(super) single: SingleText,
    /// The loops of the present program that may only wait, and the text for an iteration of one.
    pub(super) loops: Arc<[PollingLoop]>,
    pub(super) waiting: SingleText,
    /// The observer of accesses to shared memory, if they are reported.
    pub(super) observer: Option<Observer>,
}

impl StepState {
    /// The accesses that are reported.
    pub(super) fn observed(&self) -> ObservedAccesses {
        match &self.observer {
            None => ObservedAccesses::None,
            Some(observer) if observer.reports_all() => ObservedAccesses::All,
            Some(_) => ObservedAccesses::Fresh,
        }
    }
}

/// The next step of a segment that is executed in steps.
pub(super) enum NextStep {
    /// The slice is over.
    Preempted,
    /// A debugger holds the context before the present instruction.
    Held,
    /// The slice is over, after the low word of a store.
    StoredLowWord,
    /// The present instruction must be executed; its cycles are spent.
    Execute,
    /// The present instruction has been executed.
    Executed,
}

impl Context {
    /// Continues with the next step of the segment that is executed in steps.
    pub(super) fn next_step<F: Firmware + ?Sized>(
        &mut self,
        program: &Program,
        words: &Words,
        slice: &mut Slice<'_, F>,
    ) -> Result<NextStep, TrapKind> {
        let Some(split) = &mut self.split else { return Ok(NextStep::Execute) };
        if let Some(word) = split.high_word.take() {
            slice.store_high_word(word)?;
            self.end_step();
            self.calls.pc += 1;
            return Ok(NextStep::Executed);
        }
        if slice.budget <= Cycles::default() {
            return Ok(NextStep::Preempted);
        }
        if words.get(self.calls.pc).is_some_and(Word::is_held) {
            return Ok(NextStep::Held);
        }
        let left = slice.budget;
        let cycles = split.steps.get(split.next).map_or(0, |(_, cycles)| *cycles);
        slice.budget = left - Cycles::new(i64::from(cycles));
        if left == Cycles::new(1)
            && let Some((address, width, slot)) = self.store_of_two_words(program)
        {
            let word = slice.store_low_word(address, width, slot)?;
            let Some(word) = word else {
                self.end_step();
                self.calls.pc += 1;
                return Ok(NextStep::Executed);
            };
            if let Some(split) = &mut self.split {
                split.high_word = Some(word);
            }
            return Ok(NextStep::StoredLowWord);
        }
        self.end_step();
        Ok(NextStep::Execute)
    }

    /// Returns whether the high word of the present instruction is still to be stored.
    pub(super) fn has_high_word(&self) -> bool {
        self.split.as_ref().is_some_and(|split| split.high_word.is_some())
    }

    /// Stores the low word of the present instruction, which is a store of eight bytes, and leaves the high word for the
    /// next slice; `false` if it cannot be parted.
    pub(super) fn stores_low_word<F: Firmware + ?Sized>(
        &mut self,
        program: &Program,
        slice: &mut Slice<'_, F>,
    ) -> Result<bool, TrapKind> {
        let Some((address, width, slot)) = self.store_of_two_words(program) else { return Ok(false) };
        let Some(word) = slice.store_low_word(address, width, slot)? else {
            // It has been stored as a whole.
            self.calls.pc += 1;
            return Ok(true);
        };
        let pc = self.calls.pc;
        let alone = || SegmentRest { steps: [(pc, 0)].into(), next: 0, high_word: None };
        self.split.get_or_insert_with(alone).high_word = Some(word);
        Ok(true)
    }

    /// The present instruction is the last one in steps if none is left.
    fn end_step(&mut self) {
        if let Some(split) = &mut self.split {
            split.next += 1;
            if split.next == split.steps.len() {
                self.split = None;
            }
        }
    }

    /// Address, width and value, if the present instruction stores eight bytes.
    fn store_of_two_words(&self, program: &Program) -> Option<(GuestAddr, Width, u64)> {
        let op: &Op = program.ops().get(self.calls.pc)?;
        let OpKind::Store(width @ (Width::I64 | Width::F64)) = op.kind() else { return None };
        let single = op.operand::<RegI64>(Name::Src).map(|register| register.0);
        let register = single.or_else(|| op.operand::<RegF64>(Name::Src).map(|register| register.0))?;
        let address = if let Some(Addr(address)) = op.operand(Name::Addr) {
            GuestAddr::new(address)
        } else {
            let (base, Off(off)) = (op.operand::<RegI32>(Name::Base)?, op.operand(Name::Off)?);
            GuestAddr::new((self.get(base.0) as u32).wrapping_add_signed(off.into()))
        };
        Some((address, width, self.get(register)))
    }
}
