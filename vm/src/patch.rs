//! The parts of encoded instructions that a linker changes: labels, constants, signatures.
//!
//! The types of an instruction's operands determine its parts, so a new row of the table needs no code here.

use crate::for_each_op;
use crate::op::Op;
use crate::operand::{
    Addr, Bits32, Classes, Count, Count32, FuncRef, Imm, Imm16, Label, Off, Pool, RegF32, RegF64, RegI32,
    RegI64, SigRef,
};

/// A change of operands; the rest is unchanged.
pub trait Patch {
    /// Changes a place in the code.
    fn label(&mut self, _: &mut Label) {}

    /// Changes the number of a constant.
    fn constant(&mut self, _: &mut Pool) {}

    /// Changes the number of a signature.
    fn signature(&mut self, _: &mut SigRef) {}
}

/// An operand to which a change can apply.
trait Patchable {
    fn patch(&mut self, patch: &mut impl Patch);
}

impl Patchable for Label {
    fn patch(&mut self, patch: &mut impl Patch) {
        patch.label(self);
    }
}

impl Patchable for Pool {
    fn patch(&mut self, patch: &mut impl Patch) {
        patch.constant(self);
    }
}

impl Patchable for SigRef {
    fn patch(&mut self, patch: &mut impl Patch) {
        patch.signature(self);
    }
}

macro_rules! unchanged {
    ($($operand:ty),*) => {$(
        impl Patchable for $operand {
            fn patch(&mut self, _: &mut impl Patch) {}
        }
    )*};
}
unchanged!(Addr, Bits32, Classes, Count, Count32, FuncRef, Imm, Imm16, Off, RegF32, RegF64, RegI32, RegI64);

macro_rules! define_patch {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        impl Op {
            /// Offers every operand to `patch`.
            pub fn patch(&mut self, patch: &mut impl Patch) {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $($field.patch(patch);)*
                    })*
                }
            }
        }
    };
}
for_each_op!(define_patch);

/// Changes the labels of an instruction.
pub fn labels(op: &mut Op, change: impl FnMut(u32) -> u32) {
    struct Labels<F>(F);
    impl<F: FnMut(u32) -> u32> Patch for Labels<F> {
        fn label(&mut self, label: &mut Label) {
            label.0 = (self.0)(label.0);
        }
    }
    op.patch(&mut Labels(change));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_constants_and_signatures_are_found_in_any_operand() {
        struct Add;
        impl Patch for Add {
            fn label(&mut self, label: &mut Label) {
                label.0 += 100;
            }

            fn constant(&mut self, pool: &mut Pool) {
                pool.0 += 200;
            }

            fn signature(&mut self, sig: &mut SigRef) {
                sig.0 += 300;
            }
        }
        let patched = |mut op: Op| {
            op.patch(&mut Add);
            op.to_string()
        };
        assert_eq!(patched(Op::BrIf { cond: RegI32(1), to: Label(2) }), "br_if r1, @102");
        assert_eq!(patched(Op::ConstF64 { dst: RegF64(1), pool: Pool(2) }), "const_f64 d1, pool[202]");
        assert_eq!(patched(Op::CallFw { sig: SigRef(1), addr: Addr(2) }), "call_fw sig301, 0x00000002");
        assert_eq!(patched(Op::Call { func: FuncRef(1) }), "call fn@1");
    }
}
