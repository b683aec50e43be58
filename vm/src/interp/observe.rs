//! Accesses to memory that threads can share, reported to the firmware.
//!
//! A load or store through a register tests its address before it is executed; a constant address is tested once. An
//! instruction with a shared access leaves the execution, is executed alone and reported; the results stay the same.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

use super::context::Context;
use crate::engine::{ContextId, Slice};
use crate::firmware::{Firmware, NextAccess, SharedAccess, SwitchPoint};
use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, Count, Off, RegI32};
use crate::program::Program;
pub(super) use crate::shared::{is_of_program, is_shared};
use crate::shared::{loads_of, loads_together, registers};

/// The form of an access's address.
#[derive(Clone, Copy, Debug)]
pub(super) enum AccessPlace {
    /// All.
    Constant(u32),
    /// In a register, plus a displacement.
    Register,
    /// In a register, for a block that is copied or cleared.
    Block,
}

/// The place that an instruction accesses.
pub(super) fn place_of(op: &Op) -> Option<AccessPlace> {
    match op.kind() {
        OpKind::Load(_) | OpKind::Store(_) => Some(
            op.operand(Name::Addr)
                .map_or(AccessPlace::Register, |Addr(address)| AccessPlace::Constant(address)),
        ),
        OpKind::Block => Some(AccessPlace::Block),
        OpKind::Structure
        | OpKind::Charge
        | OpKind::Constant
        | OpKind::Move
        | OpKind::Address
        | OpKind::Arithmetic
        | OpKind::Negation
        | OpKind::Conversion
        | OpKind::Jump
        | OpKind::Branch
        | OpKind::Table
        | OpKind::Argument(_)
        | OpKind::Call
        | OpKind::Result(_)
        | OpKind::Return(_)
        | OpKind::Stop => None,
    }
}

/// A part of an access that is about to be made.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccessPart {
    pub(super) address: GuestAddr,
    /// Number of bytes.
    pub(super) size: u32,
    pub(super) is_store: bool,
}

/// The accesses that the present instruction of `context` is about to make.
pub(super) fn accesses(op: &Op, context: &Context) -> Vec<AccessPart> {
    let pointer = |name| op.operand::<RegI32>(name).map(|register| context.get(register.0) as u32);
    let part = |address, size, is_store| AccessPart { address: GuestAddr::new(address), size, is_store };
    let one = |address: u32| op.kind().width().map(|width| part(address, width.bytes(), is_store(op)));
    match place_of(op) {
        None => Vec::new(),
        Some(AccessPlace::Block) => {
            let len = op.operand::<Count>(Name::Len).map_or(0, |Count(len)| len.into());
            let (to, from) = (pointer(Name::To), pointer(Name::Src));
            let parts = [(from, false), (to, true)].into_iter();
            parts.filter_map(|(address, is_store)| Some(part(address?, len, is_store))).collect()
        }
        Some(AccessPlace::Constant(address)) => one(address).into_iter().collect(),
        Some(AccessPlace::Register) => {
            let address = op.operand(Name::Off).zip(pointer(Name::Base));
            let address = address.map(|(Off(off), base)| base.wrapping_add_signed(off.into()));
            address.and_then(one).into_iter().collect()
        }
    }
}

/// Facts about the text of programs, computed when first needed.
#[derive(Debug, Default)]
pub(super) struct Observer {
    /// The loads that stored values depend on, or that are used with a load, by instruction.
    loads: BTreeMap<CodeAddr, Arc<[CodeAddr]>>,
    /// The functions whose loads are known.
    functions: BTreeSet<CodeAddr>,
    /// The programs, by their start, and whether each shares its own data with a call-back.
    has_call_back: BTreeMap<GuestAddr, bool>,
}

/// An access that is about to be made.
#[derive(Debug)]
pub(super) struct Pending {
    op: Op,
    at: CodeAddr,
    made_of: Arc<[CodeAddr]>,
    parts: Vec<AccessPart>,
    /// The stored value.
    stored: u64,
}

impl Observer {
    /// Forgets what it knows of programs.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Returns the loads that the access of the word `pc` is made of, or used with if it is a load.
    fn loads_at(&mut self, program: &Program, pc: usize, is_store: bool) -> Arc<[CodeAddr]> {
        let at = program.address_of(pc);
        if is_store {
            return Arc::clone(self.loads.entry(at).or_insert_with(|| loads_of(program, pc).into()));
        }
        if let Some(function) = program.function_around(pc)
            && self.functions.insert(program.address_of(function.body.start))
        {
            let together = loads_together(program, function);
            self.loads.extend(together.into_iter().map(|(at, loads)| (at, loads.into_iter().collect())));
        }
        Arc::clone(self.loads.entry(at).or_default())
    }

    /// The access that the present instruction of `context` is about to make, if it is to shared memory.
    pub(super) fn about_to(&mut self, program: &Program, context: &Context) -> Option<Pending> {
        let pc = context.calls.pc;
        let op = *program.ops().get(pc)?;
        let at = program.address_of(pc);
        place_of(&op)?;
        let has_call_back = self.has_call_back.entry(program.base());
        let has_call_back = *has_call_back.or_insert_with(|| program.has_call_back());
        let is_noticed = |address: u32| is_shared(address) || has_call_back && is_of_program(address);
        let mut parts = accesses(&op, context);
        parts.retain(|part| is_noticed(part.address.get()));
        if parts.is_empty() {
            return None;
        }
        let stored = registers(&op).sources.first().map_or(0, |register| context.get(*register));
        let made_of = self.loads_at(program, pc, is_store(&op));
        Some(Pending { op, at, made_of, parts, stored })
    }
}

impl Pending {
    /// The point at which the thread loses the processor there, if it does.
    pub(super) fn switch_at<F: Firmware + ?Sized>(
        &self,
        id: ContextId,
        slice: &mut Slice<'_, F>,
    ) -> Option<SwitchPoint> {
        let (thread, part) = (id.thread()?, *self.parts.first()?);
        let AccessPart { address, size, is_store } = part;
        let (at, now) = (self.at, slice.now());
        slice.firmware.switch_at(&NextAccess { thread, at, address, size, is_store, now })
    }

    /// Reports the access, which has been made.
    pub(super) fn report<F: Firmware + ?Sized>(
        &self,
        id: ContextId,
        context: &Context,
        slice: &mut Slice<'_, F>,
    ) {
        let Self { op, at, made_of, parts, stored } = self;
        let now = slice.now();
        for AccessPart { address, size, is_store } in parts.iter().copied() {
            let loaded = registers(op).assigned.map_or(0, |register| context.get(register));
            let value = if op.kind() == OpKind::Block {
                0
            } else if is_store {
                *stored
            } else {
                loaded
            };
            let thread = id.thread();
            let access = SharedAccess { thread, at: *at, address, size, is_store, value, made_of, now };
            slice.firmware.accessed(&access, slice.memory);
        }
    }
}

fn is_store(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Store(_))
}
