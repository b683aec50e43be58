//! Singles and doubles.

use super::Selector;
use crate::c67x::code::{Arg, VReg};
use crate::c67x::forms::Kind;
use crate::ir::inst::{Class, Operand, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp};

impl Selector<'_> {
    /// Inverts the sign, of any number.
    pub(super) fn negate_float(&mut self, class: Class, dst: VReg, src: VReg) {
        let sign = self.operand(Operand::int(i32::MIN));
        if class == Class::F32 {
            return self.push(Kind::Xor, dst, sign, src);
        }
        let high = self.make(Kind::Xor, sign, Arg::High(src));
        let low = self.word();
        self.copy_word(low, Arg::Low(src));
        self.join(dst, low, high);
    }

    pub(super) fn binary_float(&mut self, class: Class, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) {
        let (dst, a, b) = (self.value(dst), self.operand(a), self.operand(b));
        let is_single = class == Class::F32;
        let kind = match op {
            BinaryOp::Add => [Kind::AddDp, Kind::AddSp],
            BinaryOp::Subtract => [Kind::SubDp, Kind::SubSp],
            BinaryOp::Multiply => [Kind::MpyDp, Kind::MpySp],
            // Floats have no other operators; the rest of the table is for integers.
            BinaryOp::Divide
            | BinaryOp::DivideUnsigned
            | BinaryOp::Remainder
            | BinaryOp::RemainderUnsigned
            | BinaryOp::And
            | BinaryOp::Or
            | BinaryOp::Xor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::ShiftRightUnsigned => {
                let name = if is_single { "__cc67_divf" } else { "__cc67_divd" };
                return self.helper(name, &[a, b], dst);
            }
        };
        self.push(kind[usize::from(is_single)], dst, a, b);
    }

    pub(super) fn compare_float(
        &mut self,
        class: Class,
        op: CompareOp,
        dst: VReg,
        a: Operand,
        b: Operand,
    ) -> bool {
        let (a, b) = (self.operand(a), self.operand(b));
        let (equal, less) =
            if class == Class::F32 { (Kind::CmpEqSp, Kind::CmpLtSp) } else { (Kind::CmpEqDp, Kind::CmpLtDp) };
        match op {
            CompareOp::Equal | CompareOp::NotEqual => {
                self.push(equal, dst, a, b);
                op == CompareOp::NotEqual
            }
            CompareOp::Less | CompareOp::LessUnsigned => {
                self.push(less, dst, a, b);
                false
            }
            // Not the opposite of `b < a`, which also holds for a NaN.
            CompareOp::LessEqual | CompareOp::LessEqualUnsigned => {
                let below = self.make(less, a, b);
                let same = self.make(equal, a, b);
                self.push(Kind::Or, dst, below, same);
                false
            }
        }
    }
}
