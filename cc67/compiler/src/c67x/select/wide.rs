//! Integers of 64 bits, in pairs.
//!
//! Results are computed in separate words and joined at the end, because the destination may be a source.

use super::Selector;
use crate::c67x::code::{Arg, VReg};
use crate::c67x::forms::Kind;
use crate::ir::inst::{Operand, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp};

impl Selector<'_> {
    /// A pair of two words.
    pub(super) fn join(&mut self, dst: VReg, low: VReg, high: VReg) {
        self.begin(dst);
        self.copy_word(Arg::Low(dst), low);
        self.copy_word(Arg::High(dst), high);
    }

    pub(super) fn negate_i64(&mut self, dst: VReg, src: VReg) {
        let low = self.make(Kind::Sub, Arg::number(0), Arg::Low(src));
        let high = self.make(Kind::Sub, Arg::number(0), Arg::High(src));
        // Unless the low word is 0, one is borrowed.
        let none = self.make(Kind::CmpEq, Arg::number(0), Arg::Low(src));
        let less = self.make(Kind::Add, Arg::number(-1), high);
        let high = self.make(Kind::Add, less, none);
        self.join(dst, low, high);
    }

    pub(super) fn binary_i64(&mut self, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) {
        let to = self.value(dst);
        let (low, high) = match op {
            BinaryOp::ShiftLeft => return self.shift_i64(op, "__cc67_shl64", to, a, b),
            BinaryOp::ShiftRight => return self.shift_i64(op, "__cc67_shr64", to, a, b),
            BinaryOp::ShiftRightUnsigned => return self.shift_i64(op, "__cc67_shru64", to, a, b),
            BinaryOp::Divide => return self.helper_i64("__cc67_div64", to, a, b),
            BinaryOp::DivideUnsigned => return self.helper_i64("__cc67_divu64", to, a, b),
            BinaryOp::Remainder => return self.helper_i64("__cc67_rem64", to, a, b),
            BinaryOp::RemainderUnsigned => return self.helper_i64("__cc67_remu64", to, a, b),
            BinaryOp::Add => self.sum(a, b),
            BinaryOp::Subtract => self.difference(a, b),
            BinaryOp::Multiply => self.product(a, b),
            BinaryOp::And => self.by_words(Kind::And, a, b),
            BinaryOp::Or => self.by_words(Kind::Or, a, b),
            BinaryOp::Xor => self.by_words(Kind::Xor, a, b),
        };
        self.join(to, low, high);
    }

    fn sum(&mut self, a: Operand, b: Operand) -> (VReg, VReg) {
        let (a, b) = (self.operand(a), self.operand(b));
        let low = self.make(Kind::Add, Arg::Low(a), Arg::Low(b));
        let carry = self.make(Kind::CmpLtu, low, Arg::Low(a));
        let high = self.make(Kind::Add, Arg::High(a), Arg::High(b));
        (low, self.make(Kind::Add, high, carry))
    }

    fn difference(&mut self, a: Operand, b: Operand) -> (VReg, VReg) {
        let (a, b) = (self.operand(a), self.operand(b));
        let low = self.make(Kind::Sub, Arg::Low(a), Arg::Low(b));
        let borrow = self.make(Kind::CmpLtu, Arg::Low(a), Arg::Low(b));
        let high = self.make(Kind::Sub, Arg::High(a), Arg::High(b));
        (low, self.make(Kind::Sub, high, borrow))
    }

    fn by_words(&mut self, kind: Kind, a: Operand, b: Operand) -> (VReg, VReg) {
        let (a, b) = (self.operand(a), self.operand(b));
        (self.make(kind, Arg::Low(a), Arg::Low(b)), self.make(kind, Arg::High(a), Arg::High(b)))
    }

    fn helper_i64(&mut self, name: &'static str, dst: VReg, a: Operand, b: Operand) {
        let (a, b) = (self.operand(a), self.operand(b));
        self.helper(name, &[a, b], dst);
    }

    /// The low 64 bits of a product. The processor multiplies signed words to 64 bits; a factor with its top bit set
    /// counts as 2³² too little.
    fn product(&mut self, a: Operand, b: Operand) -> (VReg, VReg) {
        let (a, b) = (self.operand(a), self.operand(b));
        let whole = self.pair();
        self.push(Kind::Mpyid, whole, Arg::Low(a), Arg::Low(b));
        let cross1 = self.make(Kind::Mpyi, Arg::Low(a), Arg::High(b));
        let cross2 = self.make(Kind::Mpyi, Arg::High(a), Arg::Low(b));
        let sign_a = self.make(Kind::Shr, Arg::number(31), Arg::Low(a));
        let more_b = self.make(Kind::And, sign_a, Arg::Low(b));
        let sign_b = self.make(Kind::Shr, Arg::number(31), Arg::Low(b));
        let more_a = self.make(Kind::And, sign_b, Arg::Low(a));
        let more = self.make(Kind::Add, more_a, more_b);
        let cross = self.make(Kind::Add, cross1, cross2);
        let upper = self.make(Kind::Add, cross, more);
        let high = self.make(Kind::Add, upper, Arg::High(whole));
        let low = self.word();
        self.copy_word(low, Arg::Low(whole));
        (low, high)
    }

    /// A shift; `name` is the function for an unknown count.
    fn shift_i64(&mut self, op: BinaryOp, name: &'static str, dst: VReg, a: Operand, b: Operand) {
        let a = self.operand(a);
        let Some(count) = b.as_int() else {
            let count = self.operand(b);
            return self.helper(name, &[a, count], dst);
        };
        let count = count & 63;
        let is_left = op == BinaryOp::ShiftLeft;
        let down = if op == BinaryOp::ShiftRight { Kind::Shr } else { Kind::Shru };
        // The word out of which bits are shifted, and the word into which they are shifted.
        let (from, into) = if is_left { (Arg::Low(a), Arg::High(a)) } else { (Arg::High(a), Arg::Low(a)) };
        let (same, back) = if is_left { (Kind::Shl, Kind::Shru) } else { (Kind::Shru, Kind::Shl) };
        let outer = if is_left { Kind::Shl } else { down };
        let (left, entered) = if count == 0 {
            let (left, entered) = (self.word(), self.word());
            self.copy_word(left, from);
            self.copy_word(entered, into);
            (left, entered)
        } else if count < 32 {
            let own = self.make(same, Arg::number(count), into);
            let moved = self.make(back, Arg::number(32 - count), from);
            (self.make(outer, Arg::number(count), from), self.make(Kind::Or, own, moved))
        } else {
            let entered = self.make(outer, Arg::number(count - 32), from);
            let left = if down == Kind::Shr && !is_left {
                self.make(Kind::Shr, Arg::number(31), from)
            } else {
                self.make(Kind::Mvk, Arg::number(0), Arg::None)
            };
            (left, entered)
        };
        if is_left { self.join(dst, left, entered) } else { self.join(dst, entered, left) }
    }

    pub(super) fn compare_i64(&mut self, op: CompareOp, dst: VReg, a: Operand, b: Operand) -> bool {
        let (a, b) = (self.operand(a), self.operand(b));
        match op {
            CompareOp::Equal | CompareOp::NotEqual => {
                let low = self.make(Kind::Xor, Arg::Low(a), Arg::Low(b));
                let high = self.make(Kind::Xor, Arg::High(a), Arg::High(b));
                let any = self.make(Kind::Or, low, high);
                self.push(Kind::CmpEq, dst, Arg::number(0), any);
                op == CompareOp::NotEqual
            }
            CompareOp::Less => self.less_i64(dst, a, b, Kind::CmpLt, false),
            CompareOp::LessEqual => self.less_i64(dst, b, a, Kind::CmpLt, true),
            CompareOp::LessUnsigned => self.less_i64(dst, a, b, Kind::CmpLtu, false),
            CompareOp::LessEqualUnsigned => self.less_i64(dst, b, a, Kind::CmpLtu, true),
        }
    }

    /// `dst = a < b`: by the high words, or by the low words if the high ones are equal.
    fn less_i64(&mut self, dst: VReg, a: VReg, b: VReg, high: Kind, is_inverted: bool) -> bool {
        let above = self.make(high, Arg::High(a), Arg::High(b));
        let same = self.make(Kind::CmpEq, Arg::High(a), Arg::High(b));
        let below = self.make(Kind::CmpLtu, Arg::Low(a), Arg::Low(b));
        let decided = self.make(Kind::And, same, below);
        self.push(Kind::Or, dst, above, decided);
        is_inverted
    }
}
