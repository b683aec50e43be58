//! Integers of 32 bits.

use kmotiondef::firmware::Function;

use super::Selector;
use crate::c67x::code::{Arg, VReg};
use crate::c67x::forms::Kind;
use crate::ir::inst::{Class, Operand, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp, UnaryOp};

/// Constants that a field of five bits holds.
const C5: std::ops::RangeInclusive<i32> = -16..=15;
/// Constants of four bits without sign.
const U4: std::ops::RangeInclusive<i32> = 0..=15;

impl Selector<'_> {
    pub(super) fn unary_op(&mut self, op: UnaryOp, dst: ValueId, src: Operand) {
        let class = self.class(dst);
        let (dst, src) = (self.value(dst), self.operand(src));
        match (op, class) {
            (UnaryOp::Negate, Class::I32) => self.push(Kind::Sub, dst, Arg::number(0), src),
            (UnaryOp::Complement, Class::I32) => self.push(Kind::Xor, dst, Arg::number(-1), src),
            (UnaryOp::Negate, Class::I64) => self.negate_i64(dst, src),
            (UnaryOp::Complement, Class::I64) => {
                let (low, high) = (self.word(), self.word());
                self.push(Kind::Xor, low, Arg::number(-1), Arg::Low(src));
                self.push(Kind::Xor, high, Arg::number(-1), Arg::High(src));
                self.join(dst, low, high);
            }
            (UnaryOp::Negate | UnaryOp::Complement, Class::F32 | Class::F64) => {
                self.negate_float(class, dst, src);
            }
        }
    }

    pub(super) fn binary_i32(&mut self, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) {
        let to = self.value(dst);
        let (a, b) = if op.is_commutative() && a.as_value().is_none() { (b, a) } else { (a, b) };
        match op {
            BinaryOp::Add => self.add(to, a, b),
            BinaryOp::Subtract => match b.as_int() {
                Some(value) => self.add(to, a, Operand::int(value.wrapping_neg())),
                None => {
                    let (a, b) = (self.small_constant(a, C5), self.operand(b));
                    self.push(Kind::Sub, to, a, b);
                }
            },
            BinaryOp::Multiply => self.multiply(to, a, b),
            BinaryOp::And => self.and(to, a, b),
            BinaryOp::Or => self.logic(Kind::Or, to, a, b),
            BinaryOp::Xor => self.logic(Kind::Xor, to, a, b),
            BinaryOp::ShiftLeft => self.shift(Kind::Shl, to, a, b),
            BinaryOp::ShiftRight => self.shift(Kind::Shr, to, a, b),
            BinaryOp::ShiftRightUnsigned => self.shift(Kind::Shru, to, a, b),
            BinaryOp::Divide => self.helper_i32(Function::_divi.name(), to, a, b),
            BinaryOp::DivideUnsigned => self.helper_i32(Function::_divu.name(), to, a, b),
            BinaryOp::Remainder => self.helper_i32(Function::_remi.name(), to, a, b),
            BinaryOp::RemainderUnsigned => self.helper_i32(Function::_remu.name(), to, a, b),
        }
    }

    fn helper_i32(&mut self, name: &'static str, dst: VReg, a: Operand, b: Operand) {
        let (a, b) = (self.operand(a), self.operand(b));
        self.helper(name, &[a, b], dst);
    }

    fn logic(&mut self, kind: Kind, dst: VReg, a: Operand, b: Operand) {
        let (b, a) = (self.small_constant(b, C5), self.operand(a));
        self.push(kind, dst, b, a);
    }

    /// `dst = a + b`; a constant is b. For a register that is incremented, more constants fit the instruction.
    pub(super) fn add(&mut self, dst: VReg, a: Operand, b: Operand) {
        let a = self.operand(a);
        let range = if a == dst { i16::MIN.into()..=i16::MAX.into() } else { C5 };
        let b = self.small_constant(b, range);
        self.push(Kind::Add, dst, b, a);
    }

    /// `dst = a & b`: masks of low bits and of all but a field need no constant.
    fn and(&mut self, dst: VReg, a: Operand, b: Operand) {
        let Some(mask) = b.as_int().filter(|mask| !C5.contains(mask)).map(i32::cast_unsigned) else {
            return self.logic(Kind::And, dst, a, b);
        };
        let a = self.operand(a);
        if mask & mask.wrapping_add(1) == 0 {
            let shift = mask.leading_zeros() as u8;
            return self.field(Kind::Extu, dst, a, (shift, shift));
        }
        let hole = !mask;
        let low = hole.trailing_zeros();
        let end = 31 - hole.leading_zeros();
        if (hole >> low) & (hole >> low).wrapping_add(1) == 0 {
            return self.field(Kind::Clr, dst, a, (low as u8, end as u8));
        }
        let mask = self.operand(b);
        self.push(Kind::And, dst, mask, a);
    }

    /// A shift; counts are taken modulo 64, as on the processor.
    fn shift(&mut self, kind: Kind, dst: VReg, a: Operand, b: Operand) {
        let Some(count) = b.as_int() else {
            let (count, a) = (self.operand(b), self.operand(a));
            return self.push(kind, dst, count, a);
        };
        match (count & 63, kind) {
            (count @ 0..=31, _) => {
                let a = self.operand(a);
                self.push(kind, dst, Arg::number(count), a);
            }
            (_, Kind::Shr) => {
                let a = self.operand(a);
                self.push(kind, dst, Arg::number(31), a);
            }
            _ => self.push(Kind::Mvk, dst, Arg::number(0), Arg::None),
        }
    }

    fn multiply(&mut self, dst: VReg, a: Operand, b: Operand) {
        let a = self.operand(a);
        match b.as_int() {
            Some(value) => self.multiply_constant(dst, a, value),
            None => {
                let b = self.operand(b);
                self.push(Kind::Mpyi, dst, a, b);
            }
        }
    }

    /// A product with a constant, from shifts and sums where that is shorter than the nine cycles of a product.
    fn multiply_constant(&mut self, dst: VReg, a: VReg, value: i32) {
        let bits = value.cast_unsigned();
        let shifted = |bits: u32| Arg::number(bits.trailing_zeros().cast_signed());
        match bits.count_ones() {
            0 => self.push(Kind::Mvk, dst, Arg::number(0), Arg::None),
            1 => self.push(Kind::Shl, dst, shifted(bits), a),
            2 => {
                let low = bits & bits.wrapping_neg();
                let high = self.make(Kind::Shl, shifted(bits & !low), a);
                let low = if low == 1 { a } else { self.make(Kind::Shl, shifted(low), a) };
                self.push(Kind::Add, dst, high, low);
            }
            _ if bits.wrapping_add(bits & bits.wrapping_neg()).is_power_of_two() => {
                // A run of ones is the difference of two powers.
                let low = bits & bits.wrapping_neg();
                let high = self.make(Kind::Shl, shifted(bits.wrapping_add(low)), a);
                let low = if low == 1 { a } else { self.make(Kind::Shl, shifted(low), a) };
                self.push(Kind::Sub, dst, high, low);
            }
            _ if value == -1 => self.push(Kind::Sub, dst, Arg::number(0), a),
            _ => {
                let factor = if C5.contains(&value) {
                    Arg::number(value)
                } else {
                    self.operand(Operand::int(value)).into()
                };
                self.push(Kind::Mpyi, dst, factor, a);
            }
        }
    }

    /// Compares; returns whether `dst` is the opposite of the requested result.
    pub(super) fn compare(&mut self, op: CompareOp, dst: VReg, a: Operand, b: Operand) -> bool {
        match self.function.class(a) {
            Class::I32 => self.compare_i32(op, dst, a, b),
            Class::I64 => self.compare_i64(op, dst, a, b),
            class @ (Class::F32 | Class::F64) => self.compare_float(class, op, dst, a, b),
        }
    }

    fn compare_i32(&mut self, op: CompareOp, dst: VReg, a: Operand, b: Operand) -> bool {
        match op {
            CompareOp::Equal | CompareOp::NotEqual => {
                let (a, b) = if a.as_value().is_none() { (b, a) } else { (a, b) };
                let (b, a) = (self.small_constant(b, C5), self.operand(a));
                self.push(Kind::CmpEq, dst, b, a);
                op == CompareOp::NotEqual
            }
            CompareOp::Less => {
                self.less(dst, a, b, false);
                false
            }
            CompareOp::LessEqual => {
                self.less(dst, b, a, false);
                true
            }
            CompareOp::LessUnsigned => {
                self.less(dst, a, b, true);
                false
            }
            CompareOp::LessEqualUnsigned => {
                self.less(dst, b, a, true);
                true
            }
        }
    }

    /// `dst = a < b`
    pub(super) fn less(&mut self, dst: VReg, a: Operand, b: Operand, is_unsigned: bool) {
        let (lt, gt, range) =
            if is_unsigned { (Kind::CmpLtu, Kind::CmpGtu, U4) } else { (Kind::CmpLt, Kind::CmpGt, C5) };
        if let Some(value) = b.as_int().filter(|value| range.contains(value)) {
            let a = self.operand(a);
            return self.push(gt, dst, Arg::number(value), a);
        }
        let (a, b) = (self.small_constant(a, range), self.operand(b));
        self.push(lt, dst, a, b);
    }
}
