//! The bytecode: one table row per instruction, from which everything mechanical is expanded.
//!
//! `for_each_op!` hands the whole table to a macro of the caller's. Here it is expanded to
//! the [`Op`] enum, its encoding, decoding and cost; elsewhere to the printer, the parser
//! and the interpreter's dispatch.
//!
//! Rules of the table:
//! - A row is ``/// meaning`` then `name = Variant { field: Operand, … }, cost n, kind;`. The name is
//!   what the disassembler prints and the assembler reads.
//! - A field named `dst` is written; every other register is read.
//! - The meaning is written as arithmetic; "wrapping" is the rule for integers.
//! - The cost is in cycles of 5 ns and may use the fields of the row.
//! - The last word is the [`OpKind`], from which every predicate follows.
//! - A row is never reordered: the position is the opcode. New rows go to the end.
//!
//! A text starts with a `program` word, then the pool (raw words), the `sig` words, the
//! functions. A `sig` or `func` word is followed by as many `types` words as its registers
//! need, 16 classes each. The parameters of a function are its first registers.

use std::any::Any;

use crate::kind::{Name, OpKind, Width};
use crate::operand::{
    Addr, Bits32, Class, Classes, Count, Count32, FuncRef, Imm, Imm16, Label, Off, OperandType, Pool, RegF32,
    RegF64, RegI32, RegI64, SigRef,
};

/// Hands every row of the instruction table to the macro `$m`.
#[macro_export]
macro_rules! for_each_op {
    ($m:ident) => {
        $m! {
            // ---- structure: never executed --------------------------------------------
            /// Opens a text: format version, then `pool` raw words follow.
            program = Program { version: Count, pool: Count32 }, cost 0, Structure;
            /// A signature: `params` classes in the `types` words that follow; `ret` is 0 for none, else class + 1.
            sig = Sig { params: Count, ret: Count }, cost 0, Structure;
            /// Classes of the next 16 registers, two bits each, lowest first.
            types = Types { classes: Classes }, cost 0, Structure;
            /// Opens a function of `sig` with `regs` registers and a guest frame of `frame` units of 8 bytes.
            func = Func { sig: SigRef, regs: Count, frame: Count }, cost 0, Structure;

            // ---- time -------------------------------------------------------------------
            /// Spends `cycles`; if the budget is then below zero, the slice ends after this instruction.
            charge = Charge { cycles: Count32 }, cost 0, Charge;

            // ---- constants and copies -----------------------------------------------------
            /// `dst = imm`
            const_i32 = ConstI32 { dst: RegI32, imm: Imm }, cost 1, Constant;
            /// `dst = pool`
            const_i64 = ConstI64 { dst: RegI64, pool: Pool }, cost 1, Constant;
            /// `dst = bits as f32`
            const_f32 = ConstF32 { dst: RegF32, bits: Bits32 }, cost 1, Constant;
            /// `dst = pool as f64`
            const_f64 = ConstF64 { dst: RegF64, pool: Pool }, cost 1, Constant;
            /// `dst = src`
            mov_i32 = MovI32 { dst: RegI32, src: RegI32 }, cost 1, Move;
            /// `dst = src`
            mov_i64 = MovI64 { dst: RegI64, src: RegI64 }, cost 1, Move;
            /// `dst = src`
            mov_f32 = MovF32 { dst: RegF32, src: RegF32 }, cost 1, Move;
            /// `dst = src`
            mov_f64 = MovF64 { dst: RegF64, src: RegF64 }, cost 1, Move;
            /// `dst = frame + offset`: the address of a local in the guest frame.
            frame_addr = FrameAddr { dst: RegI32, offset: Imm }, cost 1, Address;

            // ---- 32-bit integers ------------------------------------------------------------
            /// `dst = a + b`, wrapping
            add_i32 = AddI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a - b`, wrapping
            sub_i32 = SubI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a * b`, wrapping
            mul_i32 = MulI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 2, Arithmetic;
            /// `dst = a / b`, toward zero; traps for `b == 0`; `MIN / -1 == MIN`
            div_i32_s = DivI32S { dst: RegI32, a: RegI32, b: RegI32 }, cost 16, Arithmetic;
            /// `dst = a / b`, unsigned; traps for `b == 0`
            div_i32_u = DivI32U { dst: RegI32, a: RegI32, b: RegI32 }, cost 16, Arithmetic;
            /// `dst = a % b` with the sign of `a`; traps for `b == 0`; `MIN % -1 == 0`
            rem_i32_s = RemI32S { dst: RegI32, a: RegI32, b: RegI32 }, cost 16, Arithmetic;
            /// `dst = a % b`, unsigned; traps for `b == 0`
            rem_i32_u = RemI32U { dst: RegI32, a: RegI32, b: RegI32 }, cost 16, Arithmetic;
            /// `dst = a & b`
            and_i32 = AndI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a | b`
            or_i32 = OrI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a ^ b`
            xor_i32 = XorI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a << (b mod 64)`, 0 from 32 on
            shl_i32 = ShlI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a >> (b mod 64)`, arithmetic, all sign from 32 on
            shr_i32_s = ShrI32S { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a >> (b mod 64)`, logical, 0 from 32 on
            shr_i32_u = ShrI32U { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a + imm`, wrapping
            add_i32_imm = AddI32Imm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 1, Arithmetic;
            /// `dst = a * imm`, wrapping
            mul_i32_imm = MulI32Imm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 2, Arithmetic;
            /// `dst = a & imm`, `imm` sign-extended
            and_i32_imm = AndI32Imm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 1, Arithmetic;
            /// `dst = a << (imm mod 64)`
            shl_i32_imm = ShlI32Imm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 1, Arithmetic;
            /// `dst = a >> (imm mod 64)`, arithmetic
            shr_i32_s_imm = ShrI32SImm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 1, Arithmetic;
            /// `dst = a >> (imm mod 64)`, logical
            shr_i32_u_imm = ShrI32UImm { dst: RegI32, a: RegI32, imm: Imm16 }, cost 1, Arithmetic;
            /// `dst = low 8 bits of src`, sign-extended
            ext8_s = Ext8S { dst: RegI32, src: RegI32 }, cost 1, Arithmetic;
            /// `dst = low 8 bits of src`, zero-extended
            ext8_u = Ext8U { dst: RegI32, src: RegI32 }, cost 1, Arithmetic;
            /// `dst = low 16 bits of src`, sign-extended
            ext16_s = Ext16S { dst: RegI32, src: RegI32 }, cost 1, Arithmetic;
            /// `dst = low 16 bits of src`, zero-extended
            ext16_u = Ext16U { dst: RegI32, src: RegI32 }, cost 1, Arithmetic;
            /// `dst = a == b`
            eq_i32 = EqI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a != b`
            ne_i32 = NeI32 { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a < b`, signed
            lt_i32_s = LtI32S { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a <= b`, signed
            le_i32_s = LeI32S { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a < b`, unsigned
            lt_i32_u = LtI32U { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;
            /// `dst = a <= b`, unsigned
            le_i32_u = LeI32U { dst: RegI32, a: RegI32, b: RegI32 }, cost 1, Arithmetic;

            // ---- 64-bit integers ------------------------------------------------------------
            /// `dst = a + b`, wrapping
            add_i64 = AddI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a - b`, wrapping
            sub_i64 = SubI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a * b`, wrapping
            mul_i64 = MulI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 6, Arithmetic;
            /// `dst = a / b`, toward zero; traps for `b == 0`; `MIN / -1 == MIN`
            div_i64_s = DivI64S { dst: RegI64, a: RegI64, b: RegI64 }, cost 40, Arithmetic;
            /// `dst = a / b`, unsigned; traps for `b == 0`
            div_i64_u = DivI64U { dst: RegI64, a: RegI64, b: RegI64 }, cost 40, Arithmetic;
            /// `dst = a % b` with the sign of `a`; traps for `b == 0`; `MIN % -1 == 0`
            rem_i64_s = RemI64S { dst: RegI64, a: RegI64, b: RegI64 }, cost 40, Arithmetic;
            /// `dst = a % b`, unsigned; traps for `b == 0`
            rem_i64_u = RemI64U { dst: RegI64, a: RegI64, b: RegI64 }, cost 40, Arithmetic;
            /// `dst = a & b`
            and_i64 = AndI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a | b`
            or_i64 = OrI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a ^ b`
            xor_i64 = XorI64 { dst: RegI64, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a << (b mod 64)`
            shl_i64 = ShlI64 { dst: RegI64, a: RegI64, b: RegI32 }, cost 2, Arithmetic;
            /// `dst = a >> (b mod 64)`, arithmetic
            shr_i64_s = ShrI64S { dst: RegI64, a: RegI64, b: RegI32 }, cost 2, Arithmetic;
            /// `dst = a >> (b mod 64)`, logical
            shr_i64_u = ShrI64U { dst: RegI64, a: RegI64, b: RegI32 }, cost 2, Arithmetic;
            /// `dst = a == b`
            eq_i64 = EqI64 { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a != b`
            ne_i64 = NeI64 { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a < b`, signed
            lt_i64_s = LtI64S { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a <= b`, signed
            le_i64_s = LeI64S { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a < b`, unsigned
            lt_i64_u = LtI64U { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;
            /// `dst = a <= b`, unsigned
            le_i64_u = LeI64U { dst: RegI32, a: RegI64, b: RegI64 }, cost 2, Arithmetic;

            // ---- singles ----------------------------------------------------------------------
            /// `dst = a + b`
            add_f32 = AddF32 { dst: RegF32, a: RegF32, b: RegF32 }, cost 2, Arithmetic;
            /// `dst = a - b`
            sub_f32 = SubF32 { dst: RegF32, a: RegF32, b: RegF32 }, cost 2, Arithmetic;
            /// `dst = a * b`
            mul_f32 = MulF32 { dst: RegF32, a: RegF32, b: RegF32 }, cost 2, Arithmetic;
            /// `dst = a / b`, IEEE
            div_f32 = DivF32 { dst: RegF32, a: RegF32, b: RegF32 }, cost 16, Arithmetic;
            /// `dst = -src`
            neg_f32 = NegF32 { dst: RegF32, src: RegF32 }, cost 1, Negation;
            /// `dst = a == b`, false for a NaN
            eq_f32 = EqF32 { dst: RegI32, a: RegF32, b: RegF32 }, cost 1, Arithmetic;
            /// `dst = a != b`, true for a NaN
            ne_f32 = NeF32 { dst: RegI32, a: RegF32, b: RegF32 }, cost 1, Arithmetic;
            /// `dst = a < b`, false for a NaN
            lt_f32 = LtF32 { dst: RegI32, a: RegF32, b: RegF32 }, cost 1, Arithmetic;
            /// `dst = a <= b`, false for a NaN
            le_f32 = LeF32 { dst: RegI32, a: RegF32, b: RegF32 }, cost 1, Arithmetic;

            // ---- doubles ----------------------------------------------------------------------
            /// `dst = a + b`
            add_f64 = AddF64 { dst: RegF64, a: RegF64, b: RegF64 }, cost 3, Arithmetic;
            /// `dst = a - b`
            sub_f64 = SubF64 { dst: RegF64, a: RegF64, b: RegF64 }, cost 3, Arithmetic;
            /// `dst = a * b`
            mul_f64 = MulF64 { dst: RegF64, a: RegF64, b: RegF64 }, cost 4, Arithmetic;
            /// `dst = a / b`, IEEE
            div_f64 = DivF64 { dst: RegF64, a: RegF64, b: RegF64 }, cost 24, Arithmetic;
            /// `dst = -src`
            neg_f64 = NegF64 { dst: RegF64, src: RegF64 }, cost 1, Negation;
            /// `dst = a == b`, false for a NaN
            eq_f64 = EqF64 { dst: RegI32, a: RegF64, b: RegF64 }, cost 2, Arithmetic;
            /// `dst = a != b`, true for a NaN
            ne_f64 = NeF64 { dst: RegI32, a: RegF64, b: RegF64 }, cost 2, Arithmetic;
            /// `dst = a < b`, false for a NaN
            lt_f64 = LtF64 { dst: RegI32, a: RegF64, b: RegF64 }, cost 2, Arithmetic;
            /// `dst = a <= b`, false for a NaN
            le_f64 = LeF64 { dst: RegI32, a: RegF64, b: RegF64 }, cost 2, Arithmetic;

            // ---- conversions --------------------------------------------------------------------
            /// `dst = src`, sign-extended
            i64_from_i32_s = I64FromI32S { dst: RegI64, src: RegI32 }, cost 1, Conversion;
            /// `dst = src`, zero-extended
            i64_from_i32_u = I64FromI32U { dst: RegI64, src: RegI32 }, cost 1, Conversion;
            /// `dst = low 32 bits of src`
            i32_from_i64 = I32FromI64 { dst: RegI32, src: RegI64 }, cost 1, Conversion;
            /// `dst = src`, to nearest
            f32_from_i32_s = F32FromI32S { dst: RegF32, src: RegI32 }, cost 2, Conversion;
            /// `dst = src` as unsigned, to nearest
            f32_from_i32_u = F32FromI32U { dst: RegF32, src: RegI32 }, cost 2, Conversion;
            /// `dst = src`, to nearest
            f32_from_i64_s = F32FromI64S { dst: RegF32, src: RegI64 }, cost 8, Conversion;
            /// `dst = src` as unsigned, to nearest
            f32_from_i64_u = F32FromI64U { dst: RegF32, src: RegI64 }, cost 8, Conversion;
            /// `dst = src`
            f64_from_i32_s = F64FromI32S { dst: RegF64, src: RegI32 }, cost 2, Conversion;
            /// `dst = src` as unsigned
            f64_from_i32_u = F64FromI32U { dst: RegF64, src: RegI32 }, cost 2, Conversion;
            /// `dst = src`, to nearest
            f64_from_i64_s = F64FromI64S { dst: RegF64, src: RegI64 }, cost 8, Conversion;
            /// `dst = src` as unsigned, to nearest
            f64_from_i64_u = F64FromI64U { dst: RegF64, src: RegI64 }, cost 8, Conversion;
            /// `dst = src`
            f64_from_f32 = F64FromF32 { dst: RegF64, src: RegF32 }, cost 1, Conversion;
            /// `dst = src`, to nearest
            f32_from_f64 = F32FromF64 { dst: RegF32, src: RegF64 }, cost 2, Conversion;
            /// `dst = src` toward zero, saturating, NaN gives `i32::MAX`
            i32_from_f32_s = I32FromF32S { dst: RegI32, src: RegF32 }, cost 2, Conversion;
            /// `dst = src` toward zero, modulo 2³²
            i32_from_f32_u = I32FromF32U { dst: RegI32, src: RegF32 }, cost 2, Conversion;
            /// `dst = src` toward zero, saturating, NaN gives `i32::MAX`
            i32_from_f64_s = I32FromF64S { dst: RegI32, src: RegF64 }, cost 2, Conversion;
            /// `dst = src` toward zero, modulo 2³²
            i32_from_f64_u = I32FromF64U { dst: RegI32, src: RegF64 }, cost 2, Conversion;
            /// `dst = src` toward zero, saturating, NaN gives `i64::MAX`
            i64_from_f64_s = I64FromF64S { dst: RegI64, src: RegF64 }, cost 8, Conversion;
            /// `dst = src` toward zero, modulo 2⁶⁴
            i64_from_f64_u = I64FromF64U { dst: RegI64, src: RegF64 }, cost 8, Conversion;

            // ---- memory: address register and displacement ----------------------------------------
            /// `dst = i8 at base + off`, sign-extended
            load_i8_s = LoadI8S { dst: RegI32, base: RegI32, off: Off }, cost 1, Load(I8S);
            /// `dst = i8 at base + off`, zero-extended
            load_i8_u = LoadI8U { dst: RegI32, base: RegI32, off: Off }, cost 1, Load(I8U);
            /// `dst = i16 at base + off`, sign-extended
            load_i16_s = LoadI16S { dst: RegI32, base: RegI32, off: Off }, cost 1, Load(I16S);
            /// `dst = i16 at base + off`, zero-extended
            load_i16_u = LoadI16U { dst: RegI32, base: RegI32, off: Off }, cost 1, Load(I16U);
            /// `dst = i32 at base + off`
            load_i32 = LoadI32 { dst: RegI32, base: RegI32, off: Off }, cost 1, Load(I32);
            /// `dst = i64 at base + off`
            load_i64 = LoadI64 { dst: RegI64, base: RegI32, off: Off }, cost 1, Load(I64);
            /// `dst = f32 at base + off`
            load_f32 = LoadF32 { dst: RegF32, base: RegI32, off: Off }, cost 1, Load(F32);
            /// `dst = f64 at base + off`
            load_f64 = LoadF64 { dst: RegF64, base: RegI32, off: Off }, cost 1, Load(F64);
            /// `i8 at base + off = src`
            store_i8 = StoreI8 { src: RegI32, base: RegI32, off: Off }, cost 1, Store(I8U);
            /// `i16 at base + off = src`
            store_i16 = StoreI16 { src: RegI32, base: RegI32, off: Off }, cost 1, Store(I16U);
            /// `i32 at base + off = src`
            store_i32 = StoreI32 { src: RegI32, base: RegI32, off: Off }, cost 1, Store(I32);
            /// `i64 at base + off = src`
            store_i64 = StoreI64 { src: RegI64, base: RegI32, off: Off }, cost 1, Store(I64);
            /// `f32 at base + off = src`
            store_f32 = StoreF32 { src: RegF32, base: RegI32, off: Off }, cost 1, Store(F32);
            /// `f64 at base + off = src`; a multiple of 4 suffices, as on the DSP
            store_f64 = StoreF64 { src: RegF64, base: RegI32, off: Off }, cost 1, Store(F64);

            // ---- memory: absolute address -------------------------------------------------------------
            /// `dst = i8 at addr`, sign-extended
            load_i8_s_at = LoadI8SAt { dst: RegI32, addr: Addr }, cost 1, Load(I8S);
            /// `dst = i8 at addr`, zero-extended
            load_i8_u_at = LoadI8UAt { dst: RegI32, addr: Addr }, cost 1, Load(I8U);
            /// `dst = i16 at addr`, sign-extended
            load_i16_s_at = LoadI16SAt { dst: RegI32, addr: Addr }, cost 1, Load(I16S);
            /// `dst = i16 at addr`, zero-extended
            load_i16_u_at = LoadI16UAt { dst: RegI32, addr: Addr }, cost 1, Load(I16U);
            /// `dst = i32 at addr`
            load_i32_at = LoadI32At { dst: RegI32, addr: Addr }, cost 1, Load(I32);
            /// `dst = i64 at addr`
            load_i64_at = LoadI64At { dst: RegI64, addr: Addr }, cost 1, Load(I64);
            /// `dst = f32 at addr`
            load_f32_at = LoadF32At { dst: RegF32, addr: Addr }, cost 1, Load(F32);
            /// `dst = f64 at addr`
            load_f64_at = LoadF64At { dst: RegF64, addr: Addr }, cost 1, Load(F64);
            /// `i8 at addr = src`
            store_i8_at = StoreI8At { src: RegI32, addr: Addr }, cost 1, Store(I8U);
            /// `i16 at addr = src`
            store_i16_at = StoreI16At { src: RegI32, addr: Addr }, cost 1, Store(I16U);
            /// `i32 at addr = src`
            store_i32_at = StoreI32At { src: RegI32, addr: Addr }, cost 1, Store(I32);
            /// `i64 at addr = src`
            store_i64_at = StoreI64At { src: RegI64, addr: Addr }, cost 1, Store(I64);
            /// `f32 at addr = src`
            store_f32_at = StoreF32At { src: RegF32, addr: Addr }, cost 1, Store(F32);
            /// `f64 at addr = src`; a multiple of 4 suffices
            store_f64_at = StoreF64At { src: RegF64, addr: Addr }, cost 1, Store(F64);

            // ---- memory: blocks ---------------------------------------------------------------------------
            /// Copies `len` bytes from `src` to `to`, as `memmove`
            copy = Copy { to: RegI32, src: RegI32, len: Count }, cost 4 + len.to_bits() / 4, Block;
            /// Writes `len` zero bytes at `to`
            clear = Clear { to: RegI32, len: Count }, cost 4 + len.to_bits() / 8, Block;

            // ---- control -------------------------------------------------------------------------------------
            /// Goes to `to`
            br = Br { to: Label }, cost 1, Jump;
            /// Goes to `to` if `cond != 0`
            br_if = BrIf { cond: RegI32, to: Label }, cost 1, Branch;
            /// Goes to `to` if `cond == 0`
            br_unless = BrUnless { cond: RegI32, to: Label }, cost 1, Branch;
            /// Goes on at the `br` word number `min(index, n)` (unsigned) of the `n + 1` that follow
            br_table = BrTable { index: RegI32, n: Count }, cost 3, Table;
            /// Argument `index` of the call that follows; arguments stand directly before their call, ascending
            arg_i32 = ArgI32 { src: RegI32, index: Count }, cost 1, Argument(I32);
            /// Argument `index` of the call that follows
            arg_i64 = ArgI64 { src: RegI64, index: Count }, cost 1, Argument(I64);
            /// Argument `index` of the call that follows
            arg_f32 = ArgF32 { src: RegF32, index: Count }, cost 1, Argument(F32);
            /// Argument `index` of the call that follows
            arg_f64 = ArgF64 { src: RegF64, index: Count }, cost 1, Argument(F64);
            /// Calls a function of this program
            call = Call { func: FuncRef }, cost 4, Call;
            /// Calls the function, of this program or the firmware, whose address is in `target`
            call_ptr = CallPtr { target: RegI32, sig: SigRef }, cost 6, Call;
            /// Calls the firmware function at `addr`; its own cost is spent by the kernel
            call_fw = CallFw { sig: SigRef, addr: Addr }, cost 4, Call;
            /// Result of the call directly before
            result_i32 = ResultI32 { dst: RegI32 }, cost 1, Result(I32);
            /// Result of the call directly before
            result_i64 = ResultI64 { dst: RegI64 }, cost 1, Result(I64);
            /// Result of the call directly before
            result_f32 = ResultF32 { dst: RegF32 }, cost 1, Result(F32);
            /// Result of the call directly before
            result_f64 = ResultF64 { dst: RegF64 }, cost 1, Result(F64);
            /// Returns nothing
            ret = Ret {}, cost 2, Return(None);
            /// Returns `src`
            ret_i32 = RetI32 { src: RegI32 }, cost 2, Return(I32);
            /// Returns `src`
            ret_i64 = RetI64 { src: RegI64 }, cost 2, Return(I64);
            /// Returns `src`
            ret_f32 = RetF32 { src: RegF32 }, cost 2, Return(F32);
            /// Returns `src`
            ret_f64 = RetF64 { src: RegF64 }, cost 2, Return(F64);
            /// Cannot be reached in a correct program; traps
            unreachable = Unreachable {}, cost 1, Stop;
        }
    };
}

/// Bytes of one instruction word.
pub const WORD: usize = 8;

/// Version of the bytecode in the `program` word.
pub const VERSION: u16 = 1;

/// The kind that a row says.
macro_rules! row_kind {
    ($kind:ident) => {
        OpKind::$kind
    };
    (Load($width:ident)) => {
        OpKind::Load(Width::$width)
    };
    (Store($width:ident)) => {
        OpKind::Store(Width::$width)
    };
    (Argument($class:ident)) => {
        OpKind::Argument(Class::$class)
    };
    (Result($class:ident)) => {
        OpKind::Result(Class::$class)
    };
    (Return(None)) => {
        OpKind::Return(None)
    };
    (Return($class:ident)) => {
        OpKind::Return(Some(Class::$class))
    };
}

macro_rules! define_ops {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// An instruction.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u16)]
        pub enum Op {
            $($(#[$doc])* $variant {
                $(
                    #[doc = concat!("Operand of type `", stringify!($operand), "`.")]
                    $field: $operand
                ),*
            },)*
        }

        #[repr(u16)]
        #[derive(Clone, Copy)]
        enum Code {
            $($variant,)*
            /// One past the last opcode.
            End,
        }

        impl Op {
            /// Names in the order of the opcodes.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),*];

            /// The name that the disassembler prints.
            #[must_use]
            pub const fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => stringify!($name),)*
                }
            }

            /// The kind of instruction.
            #[must_use]
            #[inline]
            pub const fn kind(&self) -> OpKind {
                match self {
                    $(Self::$variant { .. } => row_kind!($kind $(($fact))?),)*
                }
            }

            /// The operand with the given name, if the row has one of that type.
            #[must_use]
            #[inline]
            pub fn operand<T: Copy + Any>(&self, name: Name) -> Option<T> {
                match self {
                    $(Self::$variant { $($field),* } => {
                        $(if stringify!($field) == name.text()
                            && let Some(operand) = ($field as &dyn Any).downcast_ref()
                        {
                            return Some(*operand);
                        })*
                        None
                    })*
                }
            }

            /// The cost of executing the instruction, in cycles.
            #[must_use]
            #[expect(unused_variables, reason = "most costs do not depend on operands")]
            pub fn cost(&self) -> u32 {
                match *self {
                    $(Self::$variant { $($field),* } => $cost,)*
                }
            }

            /// The instruction as a word of the image.
            #[must_use]
            pub fn encode(&self) -> [u8; WORD] {
                #[expect(unused_mut, reason = "a row may have no operands")]
                match *self {
                    $(Self::$variant { $($field),* } => {
                        let mut packer = Packer::new(Code::$variant as u16);
                        $(packer.push($field);)*
                        packer.word
                    })*
                }
            }

            /// The instruction in a word of an image; `None` for an unknown opcode or stray bits.
            #[must_use]
            pub fn decode(word: [u8; WORD]) -> Option<Self> {
                #[expect(unused_mut, reason = "a row may have no operands")]
                match u16::from_le_bytes([word[0], word[1]]) {
                    $(code if code == Code::$variant as u16 => {
                        let mut unpacker = Unpacker::new(word);
                        $(let $field: $operand = unpacker.pull();)*
                        unpacker.is_exhausted().then_some(Self::$variant { $($field),* })
                    })*
                    _ => None,
                }
            }
        }

        /// Number of opcodes.
        pub const OPCODES: u16 = Code::End as u16;
    };
}
for_each_op!(define_ops);

/// Packs operands after an opcode.
struct Packer {
    word: [u8; WORD],
    at: usize,
}

impl Packer {
    fn new(code: u16) -> Self {
        let mut word = [0; WORD];
        word[..2].copy_from_slice(&code.to_le_bytes());
        Self { word, at: 2 }
    }

    fn push<O: OperandType>(&mut self, operand: O) {
        let bytes = operand.to_bits().to_le_bytes();
        self.word[self.at..self.at + O::SIZE].copy_from_slice(&bytes[..O::SIZE]);
        self.at += O::SIZE;
    }
}

/// Reads the operands that follow an opcode.
struct Unpacker {
    word: [u8; WORD],
    at: usize,
}

impl Unpacker {
    fn new(word: [u8; WORD]) -> Self {
        Self { word, at: 2 }
    }

    fn pull<O: OperandType>(&mut self) -> O {
        let mut bytes = [0; 4];
        bytes[..O::SIZE].copy_from_slice(&self.word[self.at..self.at + O::SIZE]);
        self.at += O::SIZE;
        O::from_bits(u32::from_le_bytes(bytes))
    }

    /// Reports whether the bytes after the last operand are zero, as the encoder leaves them.
    fn is_exhausted(&self) -> bool {
        self.word[self.at..].iter().all(|byte| *byte == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_fits_one_word_in_memory_too() {
        assert_eq!(size_of::<Op>(), WORD);
    }

    #[test]
    fn encoding_keeps_signs() {
        let op = Op::AddI32Imm { dst: RegI32(3), a: RegI32(4), imm: Imm16(-5) };
        assert_eq!(Op::decode(op.encode()), Some(op));
    }

    #[test]
    fn stray_bits_and_unknown_opcodes_are_refused() {
        let mut word = Op::Ret {}.encode();
        word[7] = 1;
        assert_eq!(Op::decode(word), None);
        let unknown = OPCODES.to_le_bytes();
        assert_eq!(Op::decode([unknown[0], unknown[1], 0, 0, 0, 0, 0, 0]), None);
    }
}
