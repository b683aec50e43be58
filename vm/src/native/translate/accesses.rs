//! The memory accesses of instructions through registers.

use crate::kind::{Name, OpKind, Width};
use crate::op::Op;
use crate::operand::{Off, RegI32};

/// A value that the planning of fast iterations tracks.
pub(super) type Root = u32;

/// The base register, displacement and width of an access, and whether it is a store.
pub(super) type RegisterAccess = (RegI32, Off, Width, bool);

/// The access of an instruction through a register.
pub(super) fn accessed(op: &Op) -> Option<RegisterAccess> {
    let kind = op.kind();
    Some((op.operand(Name::Base)?, op.operand(Name::Off)?, kind.width()?, matches!(kind, OpKind::Store(_))))
}
