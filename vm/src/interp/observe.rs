//! Accesses to memory that threads can share, reported to the firmware.
//!
//! A load or store through a register tests its address before it is executed; a constant address is tested once. An
//! instruction with a shared access leaves the execution, is executed alone and reported; the results stay the same.

use std::collections::BTreeMap;
use std::sync::Arc;

use kmotiondef::{CodeAddr, GuestAddr};

use super::context::Context;
use crate::engine::{ContextId, Slice};
use crate::firmware::{Firmware, SharedAccess};
use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, Count, Off, RegI32};
use crate::program::Program;
pub(super) use crate::shared::is_shared;
use crate::shared::{loads_of, registers};

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

/// The loads that stored values are made of, by instruction.
#[derive(Debug, Default)]
pub(super) struct Observer(BTreeMap<CodeAddr, Arc<[CodeAddr]>>);

/// An access that is about to be made.
#[derive(Debug)]
pub(super) struct Pending {
    op: Op,
    at: CodeAddr,
    made_of: Arc<[CodeAddr]>,
    /// Address, bytes, whether it is a store.
    parts: Vec<(GuestAddr, u32, bool)>,
    /// The stored value.
    stored: u64,
}

impl Observer {
    /// Forgets what it knows of programs.
    pub(super) fn forget(&mut self) {
        self.0.clear();
    }

    /// The access that the present instruction of `context` is about to make, if it is to shared memory.
    pub(super) fn about_to(&mut self, program: &Program, context: &Context) -> Option<Pending> {
        let pc = context.calls.pc;
        let op = *program.ops().get(pc)?;
        let at = program.address_of(pc);
        let pointer = |name| op.operand::<RegI32>(name).map(|register| context.get(register.0) as u32);
        let parts = match place_of(&op)? {
            AccessPlace::Block => {
                let len = op.operand::<Count>(Name::Len).map_or(0, |Count(len)| len.into());
                let (to, from) = (pointer(Name::To), pointer(Name::Src));
                [(from, false), (to, true)]
                    .into_iter()
                    .filter_map(|(p, is_store)| Some((p?, len, is_store)))
                    .collect()
            }
            AccessPlace::Constant(address) => vec![(address, op.kind().width()?.bytes(), is_store(&op))],
            AccessPlace::Register => {
                let Off(off) = op.operand(Name::Off)?;
                let address = pointer(Name::Base)?.wrapping_add_signed(off.into());
                vec![(address, op.kind().width()?.bytes(), is_store(&op))]
            }
        };
        let parts: Vec<_> = parts
            .into_iter()
            .filter(|(address, ..)| is_shared(*address))
            .map(|(address, size, is_store)| (GuestAddr::new(address), size, is_store))
            .collect();
        if parts.is_empty() {
            return None;
        }
        let stored = registers(&op).sources.first().map_or(0, |register| context.get(*register));
        let made_of = if is_store(&op) {
            Arc::clone(self.0.entry(at).or_insert_with(|| loads_of(program, pc).into()))
        } else {
            Arc::from([])
        };
        Some(Pending { op, at, made_of, parts, stored })
    }
}

impl Pending {
    /// Reports the access, which has been made.
    pub(super) fn report<F: Firmware + ?Sized>(
        self,
        id: ContextId,
        context: &Context,
        slice: &mut Slice<'_, F>,
    ) {
        let Self { op, at, made_of, parts, stored } = self;
        let now = slice.now();
        for (address, size, is_store) in parts {
            let loaded = registers(&op).assigned.map_or(0, |register| context.get(register));
            let value = if op.kind() == OpKind::Block {
                0
            } else if is_store {
                stored
            } else {
                loaded
            };
            let thread = id.thread();
            let access = SharedAccess { thread, at, address, size, is_store, value, made_of: &made_of, now };
            slice.firmware.accessed(&access, slice.memory);
        }
    }
}

fn is_store(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Store(_))
}
