//! The points at which a debugger holds contexts: before given instructions, after one, after a change in memory.
//!
//! In a copy of the encoded words, a word at which a context is held gets an opcode that leaves the execution; so code
//! without holds runs at full speed. Watched bytes are compared after every instruction that can store; such
//! instructions get the opcode, too.

use std::collections::BTreeSet;
use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

use super::code::{Code, EncodedProgram, Words};
use super::context::Context;
use super::observe::{self, AccessPart, AccessPlace};
use super::steps::{SingleText, StepState};
use crate::engine::{AccessRange, ContextId, Hold, HoldReason, Slice, Stop};
use crate::firmware::Firmware;
use crate::kind::OpKind;
use crate::memory::GuestMemory;
use crate::op::Op;
use crate::program::Program;
use crate::trap::TrapKind;

/// Bytes of memory that are compared with their earlier values.
#[derive(Clone, Debug)]
struct WatchedBytes {
    address: GuestAddr,
    bytes: Vec<u8>,
}

impl WatchedBytes {
    fn is_changed(&self, memory: &GuestMemory) -> bool {
        let present =
            |(offset, byte): (usize, &u8)| memory.peek::<u8>(self.address.offset(offset as u32)) != *byte;
        self.bytes.iter().enumerate().any(present)
    }
}

/// The points at which contexts are held.
#[derive(Debug, Default)]
pub(super) struct Holds {
    breakpoints: BTreeSet<u32>,
    watched: Vec<WatchedBytes>,
    accessed: Vec<AccessRange>,
    stepping: Option<ContextId>,
    /// Contexts whose current instruction is executed without being held first.
    pub(super) passes: [bool; ContextId::COUNT],
    pub(super) hold: Option<Hold>,
    patched: Vec<(Arc<Program>, Arc<EncodedProgram>)>,
    single: SingleText,
}

impl Holds {
    /// Reports whether a context can be held anywhere.
    pub(super) fn is_active(&self) -> bool {
        self.stepping.is_some() || !self.breakpoints.is_empty() || self.looks_at_memory()
    }

    fn looks_at_memory(&self) -> bool {
        !self.watched.is_empty() || !self.accessed.is_empty()
    }

    pub(super) fn set_breakpoints(&mut self, addresses: impl IntoIterator<Item = CodeAddr>) {
        self.breakpoints = addresses.into_iter().map(CodeAddr::get).collect();
        self.patched.clear();
    }

    pub(super) fn set_watched(&mut self, memory: &GuestMemory, ranges: &[(GuestAddr, u32)]) {
        let bytes = |address: GuestAddr, length: u32| {
            (0..length).map(|offset| memory.peek::<u8>(address.offset(offset))).collect()
        };
        self.watched = ranges
            .iter()
            .map(|(address, length)| WatchedBytes { address: *address, bytes: bytes(*address, *length) })
            .collect();
        self.patched.clear();
    }

    pub(super) fn set_accessed(&mut self, ranges: &[AccessRange]) {
        self.accessed = ranges.to_vec();
        self.patched.clear();
    }

    pub(super) const fn set_stepping(&mut self, context: Option<ContextId>) {
        self.stepping = context;
        if let Some(context) = context {
            self.passes[context.index()] = true;
        }
    }

    /// Returns the index of the first watched range that has changed, and updates its saved bytes.
    pub(super) fn take_change(&mut self, memory: &GuestMemory) -> Option<usize> {
        let index = self.watched.iter().position(|watched| watched.is_changed(memory))?;
        let WatchedBytes { address, bytes } = &mut self.watched[index];
        for (offset, byte) in bytes.iter_mut().enumerate() {
            *byte = memory.peek(address.offset(offset as u32));
        }
        Some(index)
    }

    /// The words of a program, with the holds inserted; `plain` are the words without them.
    pub(super) fn words(
        &mut self,
        program: &Arc<Program>,
        plain: Arc<EncodedProgram>,
    ) -> Arc<EncodedProgram> {
        if self.breakpoints.is_empty() && !self.looks_at_memory() {
            return plain;
        }
        if let Some((_, words)) = self.patched.iter().find(|(known, _)| Arc::ptr_eq(known, program)) {
            return Arc::clone(words);
        }
        let is_probed = |op: &Op| !self.watched.is_empty() && may_store(op) || self.may_access(op);
        let is_held =
            |pc: usize, op: &Op| self.breakpoints.contains(&program.address_of(pc).get()) || is_probed(op);
        let words = Arc::new(plain.held(program, &is_held));
        self.patched.push((Arc::clone(program), Arc::clone(&words)));
        words
    }

    /// Reports whether an instruction can access one of the watched ranges.
    fn may_access(&self, op: &Op) -> bool {
        let is_meant = |range: &AccessRange| match (observe::place_of(op), op.kind().width()) {
            (None, _) => false,
            (Some(AccessPlace::Constant(address)), Some(width)) => {
                let is_store = matches!(op.kind(), OpKind::Store(_));
                overlaps(
                    range,
                    &AccessPart { address: GuestAddr::new(address), size: width.bytes(), is_store },
                )
            }
            (Some(_), _) => range.has_stores || !matches!(op.kind(), OpKind::Store(_)),
        };
        self.accessed.iter().any(is_meant)
    }

    /// The reason to hold a context after its present instruction, if that accesses a range.
    fn access(&self, program: &Program, context: &Context) -> Option<HoldReason> {
        let op = program.ops().get(context.calls.pc).filter(|_| !self.accessed.is_empty())?;
        let by = program.address_of(context.calls.pc);
        observe::accesses(op, context).iter().flatten().find_map(|part| {
            let index = self.accessed.iter().position(|range| overlaps(range, part))?;
            Some(HoldReason::Accessed { index, by, is_store: part.is_store })
        })
    }

    /// Runs a context until it stops or is held.
    pub(super) fn resume<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        code: &Code,
        context: &mut Context,
        slice: &mut Slice<'_, F>,
        steps: &mut StepState,
    ) -> Result<Stop, TrapKind> {
        let me = id.index();
        if let Some(index) = self.take_change(slice.memory) {
            return Ok(self.hold(id, HoldReason::Changed { index, by: None }));
        }
        super::enter(&code.program, context)?;
        loop {
            if self.passes[me] {
                let at = code.program.address_of(context.calls.pc);
                let access = self.access(&code.program, context);
                let stop = self.single(id, code, context, slice, steps);
                // A waiting call is repeated by the same instruction.
                self.passes[me] = matches!(stop, Ok(Stop::Waiting(_)));
                let stop = stop?;
                if stop != Stop::Held {
                    return Ok(stop);
                }
                if let Some(index) = self.take_change(slice.memory) {
                    return Ok(self.hold(id, HoldReason::Changed { index, by: Some(at) }));
                }
                if let Some(reason) = access {
                    return Ok(self.hold(id, reason));
                }
            }
            if self.stepping == Some(id) {
                self.passes[me] = true;
                return Ok(self.hold(id, HoldReason::Step));
            }
            let stop = super::run(id, &code.program, code.words.words(), context, slice, steps)?;
            if stop != Stop::Held {
                return Ok(stop);
            }
            self.passes[me] = true;
            if self.breakpoints.contains(&code.program.address_of(context.calls.pc).get()) {
                return Ok(self.hold(id, HoldReason::Breakpoint));
            }
        }
    }

    const fn hold(&mut self, context: ContextId, reason: HoldReason) -> Stop {
        self.hold = Some(Hold { context, reason });
        Stop::Held
    }

    /// Executes the present instruction; [`Stop::Held`] before the next.
    fn single<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        code: &Code,
        context: &mut Context,
        slice: &mut Slice<'_, F>,
        steps: &mut StepState,
    ) -> Result<Stop, TrapKind> {
        let program = &code.program;
        let pc = context.calls.pc;
        let run = |words: &Words| super::run(id, program, words, context, slice, steps);
        let stop = self.single.with(program, code.words.words(), pc, run);
        stop.unwrap_or(Err(TrapKind::Unreachable))
    }
}

/// Reports whether an access overlaps a watched range and is of a watched kind.
fn overlaps(range: &AccessRange, part: &AccessPart) -> bool {
    let (one, other) = (range.address.get(), part.address.get());
    let is_inside = other.wrapping_sub(one) < range.size || one.wrapping_sub(other) < part.size;
    is_inside && (range.has_stores || !part.is_store)
}

/// Reports whether an instruction can change memory.
fn may_store(op: &Op) -> bool {
    matches!(
        op,
        Op::StoreI8 { .. }
            | Op::StoreI8At { .. }
            | Op::StoreI16 { .. }
            | Op::StoreI16At { .. }
            | Op::StoreI32 { .. }
            | Op::StoreI32At { .. }
            | Op::StoreI64 { .. }
            | Op::StoreI64At { .. }
            | Op::StoreF32 { .. }
            | Op::StoreF32At { .. }
            | Op::StoreF64 { .. }
            | Op::StoreF64At { .. }
            | Op::Copy { .. }
            | Op::Clear { .. }
            | Op::CallFw { .. }
            | Op::CallPtr { .. }
    )
}
