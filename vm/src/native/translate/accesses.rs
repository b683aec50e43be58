//! The accesses that instructions make through registers.

use crate::kind::{Name, OpKind, Width};
use crate::op::Op;
use crate::operand::{Off, RegI32};

/// A value that the plan of fast iterations follows.
pub(super) type Root = u32;

/// Base register, displacement and width of an access, and whether it is a store.
pub(super) type Accessed = (RegI32, Off, Width, bool);

/// The access that an instruction makes through a register.
pub(super) fn accessed(op: &Op) -> Option<Accessed> {
    let kind = op.kind();
    Some((op.operand(Name::Base)?, op.operand(Name::Off)?, kind.width()?, matches!(kind, OpKind::Store(_))))
}
