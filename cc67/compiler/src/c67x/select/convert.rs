//! Conversions.

use super::Selector;
use crate::c67x::code::Arg;
use crate::c67x::forms::Kind;
use crate::ir::inst::{Constant, Operand, ValueId};
use crate::ir::operators::ConvertOp;

/// 2³² as a double.
const TWO_TO_32: u64 = 0x41F0_0000_0000_0000;

impl Selector<'_> {
    pub(super) fn convert(&mut self, op: ConvertOp, dst: ValueId, src: Operand) {
        let (dst, src) = (self.value(dst), self.operand(src));
        match op {
            ConvertOp::SignExtend8 => self.field(Kind::Ext, dst, src, (24, 24)),
            ConvertOp::ZeroExtend8 => self.field(Kind::Extu, dst, src, (24, 24)),
            ConvertOp::SignExtend16 => self.field(Kind::Ext, dst, src, (16, 16)),
            ConvertOp::ZeroExtend16 => self.field(Kind::Extu, dst, src, (16, 16)),
            ConvertOp::I64FromI32 => {
                let high = self.make(Kind::Shr, Arg::number(31), src);
                self.join(dst, src, high);
            }
            ConvertOp::I64FromU32 => {
                let high = self.make(Kind::Mvk, Arg::number(0), Arg::None);
                self.join(dst, src, high);
            }
            ConvertOp::I32FromI64 => self.copy_word(dst, Arg::Low(src)),
            ConvertOp::F32FromI32 => self.unary(Kind::IntSp, dst, src),
            ConvertOp::F32FromU32 => self.unary(Kind::IntSpu, dst, src),
            ConvertOp::F32FromI64 => self.helper("__cc67_fltlf", &[src], dst),
            ConvertOp::F32FromU64 => self.helper("__cc67_fltulf", &[src], dst),
            ConvertOp::F64FromI32 => self.unary(Kind::IntDp, dst, src),
            ConvertOp::F64FromU32 => self.unary(Kind::IntDpu, dst, src),
            ConvertOp::F64FromI64 => self.double_from_wide(Kind::IntDp, dst, src),
            ConvertOp::F64FromU64 => self.double_from_wide(Kind::IntDpu, dst, src),
            ConvertOp::F64FromF32 => self.unary(Kind::SpDp, dst, src),
            ConvertOp::F32FromF64 => self.unary(Kind::DpSp, dst, src),
            ConvertOp::I32FromF32 => self.unary(Kind::SpTrunc, dst, src),
            ConvertOp::I32FromF64 => self.unary(Kind::DpTrunc, dst, src),
            ConvertOp::U32FromF32 => {
                let double = self.pair();
                self.unary(Kind::SpDp, double, src);
                self.helper("__cc67_fixdu", &[double], dst);
            }
            ConvertOp::U32FromF64 => self.helper("__cc67_fixdu", &[src], dst),
            ConvertOp::I64FromF64 => self.helper("__cc67_fixdl", &[src], dst),
            ConvertOp::U64FromF64 => self.helper("__cc67_fixdul", &[src], dst),
        }
    }

    /// Converts both words to doubles, which is exact, and so is the high one times 2³²; only their sum is rounded.
    fn double_from_wide(&mut self, high: Kind, dst: crate::c67x::code::VReg, src: crate::c67x::code::VReg) {
        let factor = self.constant(Constant::F64(TWO_TO_32));
        let (upper, lower, scaled) = (self.pair(), self.pair(), self.pair());
        self.unary(high, upper, Arg::High(src));
        self.unary(Kind::IntDpu, lower, Arg::Low(src));
        self.push(Kind::MpyDp, scaled, upper, factor);
        self.push(Kind::AddDp, dst, scaled, lower);
    }
}
