//! Floating point as the processor computes it: see `dsp/float.rs`.

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Type, Value, types};

use super::super::decode::MicroOp;
use super::super::float::SUM_EXPONENT;
use super::super::work::Work;
use super::packet::PacketState;
use super::region::{NoNextPacket, Translator};

const EXPONENT_SINGLE: i64 = 0x7F80_0000;
const SIGN_SINGLE: i64 = 0x8000_0000;
const NAN_SINGLE: i64 = 0x7FFF_FFFF;
const EXPONENT_DOUBLE: i64 = 0x7FF0_0000_0000_0000;
const SIGN_DOUBLE: i64 = i64::MIN;
const NAN_DOUBLE: i64 = i64::MAX;

impl Translator<'_, '_> {
    fn constant(&mut self, ty: Type, value: i64) -> Value {
        self.builder.ins().iconst(ty, value)
    }

    fn cast(&mut self, ty: Type, value: Value) -> Value {
        self.builder.ins().bitcast(ty, MemFlagsData::new(), value)
    }

    /// The bits of a value with denormals replaced by zeros of the same sign.
    fn flushed(&mut self, bits: Value) -> Value {
        let ty = self.builder.func.dfg.value_type(bits);
        let is_single = ty == types::I32;
        let exponent = self.constant(ty, if is_single { EXPONENT_SINGLE } else { EXPONENT_DOUBLE });
        let sign = self.constant(ty, if is_single { SIGN_SINGLE } else { SIGN_DOUBLE });
        let exponent = self.builder.ins().band(bits, exponent);
        let zero = self.builder.ins().band(bits, sign);
        let is_small = self.builder.ins().icmp_imm_u(IntCC::Equal, exponent, 0);
        self.builder.ins().select(is_small, zero, bits)
    }

    /// A single as a source.
    fn single_source(&mut self, bits: Value) -> Value {
        let bits = self.flushed(bits);
        self.cast(types::F32, bits)
    }

    /// A double as a source.
    fn double_source(&mut self, bits: Value) -> Value {
        let bits = self.flushed(bits);
        self.cast(types::F64, bits)
    }

    /// A number as a result.
    fn float_result(&mut self, value: Value) -> Value {
        let is_single = self.builder.func.dfg.value_type(value) == types::F32;
        let ty = if is_single { types::I32 } else { types::I64 };
        let bits = self.cast(ty, value);
        let bits = self.flushed(bits);
        let nan = self.constant(ty, if is_single { NAN_SINGLE } else { NAN_DOUBLE });
        let is_nan = self.builder.ins().fcmp(FloatCC::Unordered, value, value);
        self.builder.ins().select(is_nan, nan, bits)
    }

    /// Arithmetic of singles.
    pub(super) fn single(&mut self, work: Work, s1: Value, s2: Value) -> Value {
        let (one, two) = (self.single_source(s1), self.single_source(s2));
        let ins = self.builder.ins();
        let value = match work {
            Work::Addsp => ins.fadd(one, two),
            Work::Subsp => ins.fsub(one, two),
            _ => ins.fmul(one, two),
        };
        self.float_result(value)
    }

    pub(super) fn compare_singles(&mut self, work: Work, s1: Value, s2: Value) -> Value {
        let (one, two) = (self.single_source(s1), self.single_source(s2));
        let condition = match work {
            Work::Cmpgtsp => FloatCC::GreaterThan,
            Work::Cmpltsp => FloatCC::LessThan,
            _ => FloatCC::Equal,
        };
        let truth = self.builder.ins().fcmp(condition, one, two);
        self.builder.ins().uextend(types::I32, truth)
    }

    /// The double in the second source.
    fn second(&mut self, packet_state: &PacketState, m: &MicroOp, low: Value) -> Value {
        let high = self.read(packet_state, m.b | 1);
        self.join(low, high)
    }

    /// A conversion to a word.
    pub(super) fn converted(&mut self, packet_state: &PacketState, m: &MicroOp, s2: Value) -> Value {
        match m.work {
            Work::Intsp | Work::Intspu => {
                // A double holds the intermediate value exactly, so it is rounded only once.
                let wide = self
                    .double_of_integer(if m.work == Work::Intsp { Work::Intdp } else { Work::Intdpu }, s2);
                let wide = self.cast(types::F64, wide);
                let value = self.builder.ins().fdemote(types::F32, wide);
                self.cast(types::I32, value)
            }
            Work::Sptrunc => {
                let value = self.single_source(s2);
                let value = self.builder.ins().fpromote(types::F64, value);
                self.truncated(value, s2)
            }
            Work::Dptrunc => {
                let bits = self.second(packet_state, m, s2);
                let high = self.read(packet_state, m.b | 1);
                let value = self.double_source(bits);
                self.truncated(value, high)
            }
            _ => {
                let bits = self.second(packet_state, m, s2);
                let value = self.double_source(bits);
                let value = self.builder.ins().fdemote(types::F32, value);
                self.float_result(value)
            }
        }
    }

    /// An integer, saturated; NaN by the sign of the word `signed`.
    fn truncated(&mut self, value: Value, signed: Value) -> Value {
        let integer = self.builder.ins().fcvt_to_sint_sat(types::I32, value);
        let is_nan = self.builder.ins().fcmp(FloatCC::Unordered, value, value);
        let is_negative = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, signed, 0);
        let least = self.constant(types::I32, i64::from(i32::MIN));
        let most = self.constant(types::I32, i64::from(i32::MAX));
        let limit = self.builder.ins().select(is_negative, least, most);
        self.builder.ins().select(is_nan, limit, integer)
    }

    /// The bits of a double that is an integer.
    pub(super) fn double_of_integer(&mut self, work: Work, s2: Value) -> Value {
        let wide =
            if work == Work::Intdp { self.sign(s2) } else { self.builder.ins().uextend(types::I64, s2) };
        let value = self.builder.ins().fcvt_from_sint(types::F64, wide);
        self.cast(types::I64, value)
    }

    /// The bits of the exact product of two singles.
    pub(super) fn double_product_of_singles(&mut self, s1: Value, s2: Value) -> Value {
        let [one, two] = [s1, s2].map(|source| {
            let value = self.single_source(source);
            self.builder.ins().fpromote(types::F64, value)
        });
        let value = self.builder.ins().fmul(one, two);
        self.float_result(value)
    }

    /// The bits of a double that is available in the first two stages.
    pub(super) fn double_at_once(&mut self, packet_state: &PacketState, m: &MicroOp, s2: Value) -> Value {
        if m.work == Work::Spdp {
            let value = self.single_source(s2);
            let value = self.builder.ins().fpromote(types::F64, value);
            return self.float_result(value);
        }
        let bits = self.second(packet_state, m, s2);
        if m.work == Work::Absdp {
            let rest = self.constant(types::I64, NAN_DOUBLE);
            return self.builder.ins().band(bits, rest);
        }
        let value = self.double_source(bits);
        let one = self.builder.ins().f64const(1.0);
        let value = self.builder.ins().fdiv(one, value);
        let bits = self.float_result(value);
        self.builder.ins().band_imm_s(bits, 0xFFFF_F000_0000_0000_u64.cast_signed())
    }

    /// The estimate of `1/s2`.
    pub(super) fn reciprocal_single(&mut self, s2: Value) -> Value {
        let value = self.single_source(s2);
        let one = self.builder.ins().f32const(1.0);
        let value = self.builder.ins().fdiv(one, value);
        let bits = self.float_result(value);
        self.builder.ins().band_imm_u(bits, 0xFFFF_8000)
    }

    /// Translates a double instruction with all of its words, a low and a high one for each source.
    pub(super) fn finish_double(
        &mut self,
        packet_state: &mut PacketState,
        m: &MicroOp,
        s1: [Value; 2],
        s2: [Value; 2],
    ) -> Result<(), NoNextPacket> {
        let is_sum = matches!(m.work, Work::Adddp | Work::Subdp);
        if is_sum || m.work == Work::Mpydp {
            let value = self.arithmetic(m.work, s1, s2);
            let due = if is_sum { [5, 6] } else { [7, 8] };
            return self.push_pair(packet_state, due, m.dst, value);
        }
        let bits2 = self.join(s2[0], s2[1]);
        let two = self.double_source(bits2);
        let condition = match m.work {
            Work::Cmpgtdp => Some(FloatCC::GreaterThan),
            Work::Cmpltdp => Some(FloatCC::LessThan),
            Work::Cmpeqdp => Some(FloatCC::Equal),
            _ => None,
        };
        if let Some(condition) = condition {
            let bits1 = self.join(s1[0], s1[1]);
            let one = self.double_source(bits1);
            let truth = self.builder.ins().fcmp(condition, one, two);
            let truth = self.builder.ins().uextend(types::I32, truth);
            return self.push(packet_state, 1, m.dst, truth);
        }
        let one = self.single_source(s1[0]);
        let one = self.builder.ins().fpromote(types::F64, one);
        let value = self.builder.ins().fmul(one, two);
        let value = self.float_result(value);
        self.push_pair(packet_state, [5, 6], m.dst, value)
    }

    /// Translates a sum, a difference or a product. If zeros, denormals or NaNs may be involved, a slow path computes
    /// it again.
    fn arithmetic(&mut self, work: Work, s1: [Value; 2], s2: [Value; 2]) -> Value {
        let [bits1, bits2] = [s1, s2].map(|[low, high]| self.join(low, high));
        let [one, two] = [bits1, bits2].map(|bits| self.cast(types::F64, bits));
        let value = self.operate(work, one, two);
        let bits = self.cast(types::I64, value);
        let any = if work == Work::Mpydp {
            let outside = self.is_outside(bits, 1);
            [s1[1], s2[1]].into_iter().fold(outside, |any, high| {
                let is_small = self.is_small(high);
                self.builder.ins().bor(any, is_small)
            })
        } else {
            // A denormal number changes no sum that is so much greater.
            self.is_outside(bits, SUM_EXPONENT.cast_signed())
        };
        let (slow, after) = (self.cold(), self.builder.create_block());
        self.builder.append_block_param(after, types::I64);
        self.builder.ins().brif(any, slow, &[], after, &[bits.into()]);
        self.continue_in(slow);
        let [one, two] = [bits1, bits2].map(|bits| self.double_source(bits));
        let value = self.operate(work, one, two);
        let bits = self.float_result(value);
        self.builder.ins().jump(after, &[bits.into()]);
        self.continue_in(after);
        self.builder.block_params(after)[0]
    }

    fn operate(&mut self, work: Work, one: Value, two: Value) -> Value {
        match work {
            Work::Adddp => self.builder.ins().fadd(one, two),
            Work::Subdp => self.builder.ins().fsub(one, two),
            _ => self.builder.ins().fmul(one, two),
        }
    }

    /// Emits the test whether a double's exponent is less than `least`, or is that of infinities and NaNs.
    fn is_outside(&mut self, bits: Value, least: i64) -> Value {
        let magnitude = self.builder.ins().ishl_imm_u(bits, 1);
        let least = least << 53;
        let from_least = self.builder.ins().iadd_imm_s(magnitude, -least);
        let range = self.constant(types::I64, (EXPONENT_DOUBLE << 1).wrapping_sub(least));
        self.builder.ins().icmp(IntCC::UnsignedGreaterThanOrEqual, from_least, range)
    }

    /// Emits the test whether a high word belongs to a zero or a denormal.
    fn is_small(&mut self, high: Value) -> Value {
        let exponent = self.builder.ins().band_imm_u(high, 0x7FF0_0000);
        self.builder.ins().icmp_imm_u(IntCC::Equal, exponent, 0)
    }
}
