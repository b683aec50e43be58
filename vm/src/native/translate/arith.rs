//! Constants, copies, arithmetic, comparisons and conversions, with the semantics of [`crate::arith`].
//!
//! Every operation that makes a NaN makes the canonical one, which takes a comparison and a selection. For registers
//! whose bits are not observed this is deferred (`nan.rs`). For the others, arithmetic in the same block reads the
//! unselected result (`raw`), and Cranelift removes the selection if it is not used elsewhere.

use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::immediates::{Ieee32, Ieee64};
use cranelift_codegen::ir::{AbiParam, Block, InstBuilder, Signature, Value, types};

use super::super::request::{Reason, Request};
use super::super::state::State;
use super::{Register, Translator, type_of};
use crate::arith::{WordDivision, canonical_f32, canonical_f64};
use crate::operand::{Bits32, Class, Imm, Imm16, Pool, RegF32, RegF64, RegI32, RegI64};

/// Instructions that are one or two of Cranelift's: `name: operands -> result = function`.
macro_rules! operations {
    (unary { $($un:ident: $un_src:ident -> $un_dst:ident = $un_fn:expr;)* }
     binary { $($bin:ident: $bin_a:ident, $bin_b:ident -> $bin_dst:ident = $bin_fn:expr;)* }
     immediate { $($imm:ident = $imm_fn:expr;)* }
     float { $($float:ident: $float_reg:ident = $float_fn:ident;)* }
     compare { $($cmp:ident: $cmp_reg:ident = $code:expr;)* }
     compare_float { $($fcmp:ident: $fcmp_reg:ident = $fcode:expr;)* }
     divide { $($div:ident: $div_reg:ident = $div_fn:ident, by zero $op:expr;)* }) => {
        impl Translator<'_, '_> {
            $(pub(super) fn $un(&mut self, dst: $un_dst, src: $un_src) {
                let src = self.get(src);
                let function: fn(&mut Self, Value) -> Value = $un_fn;
                let value = function(self, src);
                self.set(dst, value);
            })*

            $(pub(super) fn $bin(&mut self, dst: $bin_dst, a: $bin_a, b: $bin_b) {
                let (a, b) = (self.get(a), self.get(b));
                let function: fn(&mut Self, Value, Value) -> Value = $bin_fn;
                let value = function(self, a, b);
                self.set(dst, value);
            })*

            $(pub(super) fn $imm(&mut self, dst: RegI32, a: RegI32, imm: Imm16) {
                let a = self.get(a);
                let b = self.builder.ins().iconst(types::I32, i64::from(imm.0));
                let function: fn(&mut Self, Value, Value) -> Value = $imm_fn;
                let value = function(self, a, b);
                self.set(dst, value);
            })*

            $(pub(super) fn $float(&mut self, dst: $float_reg, a: $float_reg, b: $float_reg) {
                let (a, b) = (self.get_raw(a), self.get_raw(b));
                let value = self.builder.ins().$float_fn(a, b);
                self.set_arithmetic(dst, value);
            })*

            $(pub(super) fn $cmp(&mut self, dst: RegI32, a: $cmp_reg, b: $cmp_reg) {
                let (a, b) = (self.get(a), self.get(b));
                let truth = self.builder.ins().icmp($code, a, b);
                self.set_truth(dst, truth);
            })*

            $(pub(super) fn $fcmp(&mut self, dst: RegI32, a: $fcmp_reg, b: $fcmp_reg) {
                let (a, b) = (self.get_raw(a), self.get_raw(b));
                let truth = self.builder.ins().fcmp($fcode, a, b);
                self.set_truth(dst, truth);
            })*

            $(pub(super) fn $div(&mut self, dst: $div_reg, a: $div_reg, b: $div_reg) {
                let (a, b) = (self.get(a), self.get(b));
                let answered = self.ask_if_zero($div_reg::CLASS, $op, a, b);
                let value = self.$div_fn(a, b);
                let value = self.or_answer(answered, value);
                self.set(dst, value);
            })*
        }
    };
}
operations! {
    unary {
        mov_i32: RegI32 -> RegI32 = |_, v| v;
        mov_i64: RegI64 -> RegI64 = |_, v| v;
        ext8_s: RegI32 -> RegI32 = |t, v| {
            let v = t.builder.ins().ireduce(types::I8, v);
            t.builder.ins().sextend(types::I32, v)
        };
        ext8_u: RegI32 -> RegI32 = |t, v| t.builder.ins().band_imm_u(v, 0xff);
        ext16_s: RegI32 -> RegI32 = |t, v| {
            let v = t.builder.ins().ireduce(types::I16, v);
            t.builder.ins().sextend(types::I32, v)
        };
        ext16_u: RegI32 -> RegI32 = |t, v| t.builder.ins().band_imm_u(v, 0xffff);
        neg_f32: RegF32 -> RegF32 = |t, v| t.builder.ins().fneg(v);
        neg_f64: RegF64 -> RegF64 = |t, v| t.builder.ins().fneg(v);
        i64_from_i32_s: RegI32 -> RegI64 = |t, v| t.builder.ins().sextend(types::I64, v);
        i64_from_i32_u: RegI32 -> RegI64 = |t, v| t.builder.ins().uextend(types::I64, v);
        i32_from_i64: RegI64 -> RegI32 = |t, v| t.builder.ins().ireduce(types::I32, v);
        f32_from_i32_s: RegI32 -> RegF32 = |t, v| t.builder.ins().fcvt_from_sint(types::F32, v);
        f32_from_i32_u: RegI32 -> RegF32 = |t, v| t.builder.ins().fcvt_from_uint(types::F32, v);
        f32_from_i64_s: RegI64 -> RegF32 = |t, v| t.builder.ins().fcvt_from_sint(types::F32, v);
        f32_from_i64_u: RegI64 -> RegF32 = |t, v| t.builder.ins().fcvt_from_uint(types::F32, v);
        f64_from_i32_s: RegI32 -> RegF64 = |t, v| t.builder.ins().fcvt_from_sint(types::F64, v);
        f64_from_i32_u: RegI32 -> RegF64 = |t, v| t.builder.ins().fcvt_from_uint(types::F64, v);
        f64_from_i64_s: RegI64 -> RegF64 = |t, v| t.builder.ins().fcvt_from_sint(types::F64, v);
        f64_from_i64_u: RegI64 -> RegF64 = |t, v| t.builder.ins().fcvt_from_uint(types::F64, v);
        i32_from_f32_s: RegF32 -> RegI32 = |t, v| t.saturate(v, Class::I32);
        i32_from_f32_u: RegF32 -> RegI32 = |t, v| {
            let v = t.builder.ins().fpromote(types::F64, v);
            let wide = t.wrap(v);
            t.builder.ins().ireduce(types::I32, wide)
        };
        i32_from_f64_s: RegF64 -> RegI32 = |t, v| t.saturate(v, Class::I32);
        i32_from_f64_u: RegF64 -> RegI32 = |t, v| {
            let wide = t.wrap(v);
            t.builder.ins().ireduce(types::I32, wide)
        };
        i64_from_f64_s: RegF64 -> RegI64 = |t, v| t.saturate(v, Class::I64);
        i64_from_f64_u: RegF64 -> RegI64 = |t, v| t.wrap(v);
    }
    binary {
        add_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().iadd(a, b);
        sub_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().isub(a, b);
        mul_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().imul(a, b);
        and_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().band(a, b);
        or_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().bor(a, b);
        xor_i32: RegI32, RegI32 -> RegI32 = |t, a, b| t.builder.ins().bxor(a, b);
        shl_i32: RegI32, RegI32 -> RegI32 = Translator::shift_left;
        shr_i32_s: RegI32, RegI32 -> RegI32 = Translator::shift_right_signed;
        shr_i32_u: RegI32, RegI32 -> RegI32 = Translator::shift_right_unsigned;
        add_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().iadd(a, b);
        sub_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().isub(a, b);
        mul_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().imul(a, b);
        and_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().band(a, b);
        or_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().bor(a, b);
        xor_i64: RegI64, RegI64 -> RegI64 = |t, a, b| t.builder.ins().bxor(a, b);
        // Cranelift takes the count modulo the width, as the instruction does.
        shl_i64: RegI64, RegI32 -> RegI64 = |t, a, b| t.builder.ins().ishl(a, b);
        shr_i64_s: RegI64, RegI32 -> RegI64 = |t, a, b| t.builder.ins().sshr(a, b);
        shr_i64_u: RegI64, RegI32 -> RegI64 = |t, a, b| t.builder.ins().ushr(a, b);
    }
    immediate {
        add_i32_imm = |t, a, b| t.builder.ins().iadd(a, b);
        mul_i32_imm = |t, a, b| t.builder.ins().imul(a, b);
        and_i32_imm = |t, a, b| t.builder.ins().band(a, b);
        shl_i32_imm = Translator::shift_left;
        shr_i32_s_imm = Translator::shift_right_signed;
        shr_i32_u_imm = Translator::shift_right_unsigned;
    }
    float {
        add_f32: RegF32 = fadd;
        sub_f32: RegF32 = fsub;
        mul_f32: RegF32 = fmul;
        div_f32: RegF32 = fdiv;
        add_f64: RegF64 = fadd;
        sub_f64: RegF64 = fsub;
        mul_f64: RegF64 = fmul;
        div_f64: RegF64 = fdiv;
    }
    compare {
        eq_i32: RegI32 = IntCC::Equal;
        ne_i32: RegI32 = IntCC::NotEqual;
        lt_i32_s: RegI32 = IntCC::SignedLessThan;
        le_i32_s: RegI32 = IntCC::SignedLessThanOrEqual;
        lt_i32_u: RegI32 = IntCC::UnsignedLessThan;
        le_i32_u: RegI32 = IntCC::UnsignedLessThanOrEqual;
        eq_i64: RegI64 = IntCC::Equal;
        ne_i64: RegI64 = IntCC::NotEqual;
        lt_i64_s: RegI64 = IntCC::SignedLessThan;
        le_i64_s: RegI64 = IntCC::SignedLessThanOrEqual;
        lt_i64_u: RegI64 = IntCC::UnsignedLessThan;
        le_i64_u: RegI64 = IntCC::UnsignedLessThanOrEqual;
    }
    compare_float {
        eq_f32: RegF32 = FloatCC::Equal;
        ne_f32: RegF32 = FloatCC::NotEqual;
        lt_f32: RegF32 = FloatCC::LessThan;
        le_f32: RegF32 = FloatCC::LessThanOrEqual;
        eq_f64: RegF64 = FloatCC::Equal;
        ne_f64: RegF64 = FloatCC::NotEqual;
        lt_f64: RegF64 = FloatCC::LessThan;
        le_f64: RegF64 = FloatCC::LessThanOrEqual;
    }
    divide {
        div_i32_s: RegI32 = divide_signed, by zero Some(WordDivision::Quotient);
        div_i32_u: RegI32 = divide_unsigned, by zero Some(WordDivision::UnsignedQuotient);
        rem_i32_s: RegI32 = remainder_signed, by zero Some(WordDivision::Remainder);
        rem_i32_u: RegI32 = remainder_unsigned, by zero Some(WordDivision::UnsignedRemainder);
        div_i64_s: RegI64 = divide_signed, by zero None;
        div_i64_u: RegI64 = divide_unsigned, by zero None;
        rem_i64_s: RegI64 = remainder_signed, by zero None;
        rem_i64_u: RegI64 = remainder_unsigned, by zero None;
    }
}

impl Translator<'_, '_> {
    pub(super) fn const_i32(&mut self, dst: RegI32, imm: Imm) {
        let value = self.builder.ins().iconst(types::I32, i64::from(imm.0));
        self.set(dst, value);
    }

    pub(super) fn const_i64(&mut self, dst: RegI64, pool: Pool) {
        let bits = self.translation.program.pool()[pool.0 as usize];
        let value = self.builder.ins().iconst(types::I64, bits.cast_signed());
        self.set(dst, value);
    }

    pub(super) fn const_f32(&mut self, dst: RegF32, bits: Bits32) {
        let value = self.builder.ins().f32const(Ieee32::with_bits(bits.0));
        self.set(dst, value);
    }

    pub(super) fn const_f64(&mut self, dst: RegF64, pool: Pool) {
        let bits = self.translation.program.pool()[pool.0 as usize];
        let value = self.builder.ins().f64const(Ieee64::with_bits(bits));
        self.set(dst, value);
    }

    pub(super) fn mov_f32(&mut self, dst: RegF32, src: RegF32) {
        self.copy_float(dst, src);
    }

    pub(super) fn mov_f64(&mut self, dst: RegF64, src: RegF64) {
        self.copy_float(dst, src);
    }

    pub(super) fn f64_from_f32(&mut self, dst: RegF64, src: RegF32) {
        let src = self.get_raw(src);
        let value = self.builder.ins().fpromote(types::F64, src);
        self.set_arithmetic(dst, value);
    }

    pub(super) fn f32_from_f64(&mut self, dst: RegF32, src: RegF64) {
        let src = self.get_raw(src);
        let value = self.builder.ins().fdemote(types::F32, src);
        self.set_arithmetic(dst, value);
    }

    /// The value of a floating register, any NaN standing for that NaN of the register.
    fn get_raw<R: Register>(&mut self, register: R) -> Value {
        let held = || self.builder.use_var(self.registers.variables[register.index()]);
        self.registers.raw.get(&register.index()).copied().unwrap_or_else(held)
    }

    /// Sets a floating-point register to the result of an operation.
    fn set_arithmetic<R: Register>(&mut self, dst: R, raw: Value) {
        if self.registers.lax[dst.index()] {
            return self.set(dst, raw);
        }
        let value = self.canonical(R::CLASS, raw);
        self.set(dst, value);
        self.registers.raw.insert(dst.index(), raw);
    }

    /// Copies a floating register, the processor's NaN with it where both may hold that.
    fn copy_float<R: Register>(&mut self, dst: R, src: R) {
        let value = if self.registers.lax[dst.index()] { self.get_raw(src) } else { self.get(src) };
        self.set(dst, value);
    }

    /// The value, with any NaN replaced by the canonical one.
    pub(super) fn canonical(&mut self, class: Class, value: Value) -> Value {
        let nan = if class == Class::F32 {
            self.builder.ins().f32const(Ieee32::with_bits(canonical_f32(f32::NAN).to_bits()))
        } else {
            self.builder.ins().f64const(Ieee64::with_bits(canonical_f64(f64::NAN).to_bits()))
        };
        let is_nan = self.builder.ins().fcmp(FloatCC::Unordered, value, value);
        self.builder.ins().select(is_nan, nan, value)
    }

    fn set_truth(&mut self, dst: RegI32, truth: Value) {
        let value = self.builder.ins().uextend(types::I32, truth);
        self.set(dst, value);
    }

    /// Shifts left in 64 bits, so that counts from 32 to 63 need no special case.
    fn shift_left(&mut self, a: Value, count: Value) -> Value {
        let wide = self.builder.ins().uextend(types::I64, a);
        let wide = self.builder.ins().ishl(wide, count);
        self.builder.ins().ireduce(types::I32, wide)
    }

    fn shift_right_signed(&mut self, a: Value, count: Value) -> Value {
        let wide = self.builder.ins().sextend(types::I64, a);
        let wide = self.builder.ins().sshr(wide, count);
        self.builder.ins().ireduce(types::I32, wide)
    }

    fn shift_right_unsigned(&mut self, a: Value, count: Value) -> Value {
        let wide = self.builder.ins().uextend(types::I64, a);
        let wide = self.builder.ins().ushr(wide, count);
        self.builder.ins().ireduce(types::I32, wide)
    }

    /// Requests the result of a division by zero, if the divisor is zero; returns the block after the division, whose
    /// parameter is the answer. `None` in fast iterations, which leave this case to the ordinary loop.
    fn ask_if_zero(&mut self, class: Class, op: Option<WordDivision>, a: Value, b: Value) -> Option<Block> {
        let go_on = self.builder.create_block();
        if let Some(bail) = self.bail() {
            self.builder.ins().brif(b, go_on, &[], bail, &[]);
            self.finish_edges();
            self.enter(go_on);
            return None;
        }
        let (zero, done) = (self.builder.create_block(), self.builder.create_block());
        self.builder.append_block_param(done, type_of(class));
        self.builder.ins().brif(b, go_on, &[], zero, &[]);
        self.enter_cold(zero);
        let a = self.slot(class, a);
        let op = self.builder.ins().iconst(types::I64, Request::of_division(op));
        let slot = self.request(Reason::DivisionByZero.code(), self.at, a, op);
        let answer = self.read_slot(class, slot);
        self.builder.ins().jump(done, &[answer.into()]);
        self.enter(go_on);
        Some(done)
    }

    /// The answer if there is one, otherwise `value`.
    fn or_answer(&mut self, answered: Option<Block>, value: Value) -> Value {
        let Some(done) = answered else { return value };
        self.builder.ins().jump(done, &[value.into()]);
        self.enter(done);
        self.builder.block_params(done)[0]
    }

    /// A quotient that never overflows: division by -1 is a negation.
    fn divide_signed(&mut self, a: Value, b: Value) -> Value {
        let (minus_one, safe) = self.without_minus_one(b);
        let quotient = self.builder.ins().sdiv(a, safe);
        let negative = self.builder.ins().ineg(a);
        self.builder.ins().select(minus_one, negative, quotient)
    }

    /// A remainder that never overflows: the remainder by -1, as by 1, is 0.
    fn remainder_signed(&mut self, a: Value, b: Value) -> Value {
        let (_, safe) = self.without_minus_one(b);
        self.builder.ins().srem(a, safe)
    }

    fn divide_unsigned(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().udiv(a, b)
    }

    fn remainder_unsigned(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().urem(a, b)
    }

    /// Emits the test whether `divisor` is -1, and the divisor with 1 in its place.
    fn without_minus_one(&mut self, divisor: Value) -> (Value, Value) {
        let ty = self.builder.func.dfg.value_type(divisor);
        let minus_one = self.builder.ins().icmp_imm_s(IntCC::Equal, divisor, -1);
        let one = self.builder.ins().iconst(ty, 1);
        let safe = self.builder.ins().select(minus_one, one, divisor);
        (minus_one, safe)
    }

    /// Toward zero, saturating; a NaN gives the largest number.
    fn saturate(&mut self, value: Value, class: Class) -> Value {
        let ty = type_of(class);
        let max = if class == Class::I64 { i64::MAX } else { i64::from(i32::MAX) };
        let max = self.builder.ins().iconst(ty, max);
        let number = self.builder.ins().fcvt_to_sint_sat(ty, value);
        let is_nan = self.builder.ins().fcmp(FloatCC::Unordered, value, value);
        self.builder.ins().select(is_nan, max, number)
    }

    /// Toward zero, modulo 2⁶⁴; a NaN or infinity gives 0.
    fn wrap(&mut self, value: Value) -> Value {
        let number = self.builder.ins().fcvt_to_sint_sat(types::I64, value);
        let (outside, behind) = (self.builder.create_block(), self.builder.create_block());
        let result = self.builder.append_block_param(behind, types::I64);
        // A saturated result is the smallest or the largest number.
        let distance = self.builder.ins().iadd_imm_s(number, i64::MAX.wrapping_neg());
        let saturated = self.builder.ins().icmp_imm_u(IntCC::UnsignedLessThanOrEqual, distance, 1);
        self.builder.ins().brif(saturated, outside, &[], behind, &[number.into()]);

        self.enter_cold(outside);
        let mut signature = Signature::new(self.module.isa().default_call_conv());
        signature.params = vec![AbiParam::new(types::F64)];
        signature.returns = vec![AbiParam::new(types::I64)];
        let signature = self.builder.import_signature(signature);
        let convert = self.load_state(types::I64, offset_of!(State, ways_out.convert));
        let call = self.builder.ins().call_indirect(signature, convert, &[value]);
        let number = self.builder.inst_results(call)[0];
        self.builder.ins().jump(behind, &[number.into()]);

        self.enter(behind);
        result
    }
}
