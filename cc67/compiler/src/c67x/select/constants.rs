//! Constants in registers.

use super::Selector;
use crate::c67x::code::{Arg, Inst, VReg, VRegInfo, Value};
use crate::c67x::forms::Kind;
use crate::ir::inst::{Constant, Operand};

/// The most constants that are loaded before the first block.
const MAX_EARLY: usize = 40;

impl Selector<'_> {
    /// A register that holds a constant.
    pub(super) fn constant(&mut self, constant: Constant) -> VReg {
        match constant {
            Constant::I32(value) => self.constant_register(Value::Number(value)),
            Constant::F32(bits) => self.constant_register(Value::Number(bits.cast_signed())),
            Constant::Symbol(symbol, offset) => self.constant_register(Value::Symbol(symbol, offset)),
            Constant::I64(value) => self.wide_constant(value.cast_unsigned()),
            Constant::F64(bits) => self.wide_constant(bits),
        }
    }

    /// A register that holds a known word, shared by its users.
    pub(super) fn constant_register(&mut self, value: Value) -> VReg {
        let early = || self.early.constants.iter().find(|(known, _)| *known == value).map(|(_, reg)| *reg);
        if let Some(reg) = self.constants.get(&value).copied().or_else(early) {
            return reg;
        }
        let reg = self.code.reg(VRegInfo { constant: Some(value), ..VRegInfo::default() });
        let insts = make(reg.into(), value, self.span);
        if self.depth > 0 && self.early.constants.len() < MAX_EARLY {
            self.early.insts.extend(insts);
            self.early.constants.push((value, reg));
        } else {
            self.out.extend(insts);
            self.constants.insert(value, reg);
        }
        reg
    }

    fn wide_constant(&mut self, bits: u64) -> VReg {
        if let Some((_, reg)) = self.early.wide_constants.iter().find(|(known, _)| *known == bits) {
            return *reg;
        }
        let reg = self.pair();
        if self.depth > 0 && self.early.insts.len() < MAX_EARLY {
            self.early.wide_constants.push((bits, reg));
            // Made once, before everything else.
            let here = std::mem::take(&mut self.out);
            self.wide_in(reg, bits);
            let insts = std::mem::replace(&mut self.out, here);
            self.early.insts.extend(insts);
        } else {
            self.wide_in(reg, bits);
        }
        reg
    }

    fn wide_in(&mut self, dst: VReg, bits: u64) {
        self.begin(dst);
        let (low, high) = (bits as u32, (bits >> 32) as u32);
        let span = self.span;
        self.out.extend(make(Arg::Low(dst), Value::Number(low.cast_signed()), span));
        self.out.extend(make(Arg::High(dst), Value::Number(high.cast_signed()), span));
    }

    /// Makes a constant in a register.
    pub(super) fn constant_in(&mut self, dst: VReg, constant: Constant) {
        let value = match constant {
            Constant::I32(value) => Value::Number(value),
            Constant::F32(bits) => Value::Number(bits.cast_signed()),
            Constant::Symbol(symbol, offset) => Value::Symbol(symbol, offset),
            Constant::I64(value) => return self.wide_in(dst, value.cast_unsigned()),
            Constant::F64(bits) => return self.wide_in(dst, bits),
        };
        let span = self.span;
        self.out.extend(make(dst.into(), value, span));
    }

    /// An operand of class `I32` as a source, which may be a constant in the range.
    pub(super) fn small_constant(&mut self, operand: Operand, range: std::ops::RangeInclusive<i32>) -> Arg {
        match operand.as_int() {
            Some(value) if range.contains(&value) => Arg::number(value),
            _ => self.operand(operand).into(),
        }
    }
}

/// The instructions that make a known word.
pub(in crate::c67x) fn make(dst: Arg, value: Value, span: crate::source::Span) -> impl Iterator<Item = Inst> {
    let is_short = matches!(value, Value::Number(number) if i16::try_from(number).is_ok());
    let low = Inst::new(Kind::Mvk, dst, Arg::Value(value), Arg::None, span);
    let high = Inst::new(Kind::Mvkh, dst, Arg::Value(value), Arg::None, span);
    std::iter::once(low).chain((!is_short).then_some(high))
}
