//! The instruction for an operator, for each class of operands.

use vm::op::Op;
use vm::operand::{Imm16, RegF32, RegF64, RegI32, RegI64};

use crate::ir::operators::{BinaryOp, CompareOp};

/// The instruction for operators that legal IR does not have: the program stops there, as a wrong instruction would
/// continue with a wrong result.
pub(super) fn illegal_op() -> Op {
    debug_assert!(false, "the IR is verified and legal");
    Op::Unreachable {}
}

/// The instruction with a constant of 16 bits as its second operand.
pub(super) type Immediate = fn(RegI32, RegI32, Imm16) -> Op;

/// Expands a column of a table: the instruction with this name, or the illegal one for `-`.
macro_rules! instruction {
    (-, $dst:ident, $a:ident, $b:ident) => {
        illegal_op()
    };
    ($op:ident, $dst:ident, $a:ident, $b:ident) => {
        Op::$op { $dst, $a, $b }
    };
}

/// Expands the column of instructions with a constant.
macro_rules! immediate {
    (-) => {
        None
    };
    ($op:ident) => {
        Some(|dst, a, imm| Op::$op { dst, a, imm })
    };
}

/// Expands the table of binary operators into a function for each column.
macro_rules! binary_operators {
    ($($op:ident: $i32:tt $immediate:tt $i64:tt $shift:tt $f32:tt $f64:tt;)*) => {
        /// The immediate form of an operator on 32 bits, if there is one; for `x - c` it is `x + -c`.
        pub(super) fn immediate(op: BinaryOp) -> Option<Immediate> {
            match op { $(BinaryOp::$op => immediate!($immediate),)* }
        }

        pub(super) fn binary_i32(op: BinaryOp, dst: RegI32, a: RegI32, b: RegI32) -> Op {
            match op { $(BinaryOp::$op => instruction!($i32, dst, a, b),)* }
        }

        /// Every operator but the shifts.
        pub(super) fn binary_i64(op: BinaryOp, dst: RegI64, a: RegI64, b: RegI64) -> Op {
            match op { $(BinaryOp::$op => instruction!($i64, dst, a, b),)* }
        }

        pub(super) fn shift_i64(op: BinaryOp, dst: RegI64, a: RegI64, b: RegI32) -> Op {
            match op { $(BinaryOp::$op => instruction!($shift, dst, a, b),)* }
        }

        pub(super) fn binary_f32(op: BinaryOp, dst: RegF32, a: RegF32, b: RegF32) -> Op {
            match op { $(BinaryOp::$op => instruction!($f32, dst, a, b),)* }
        }

        pub(super) fn binary_f64(op: BinaryOp, dst: RegF64, a: RegF64, b: RegF64) -> Op {
            match op { $(BinaryOp::$op => instruction!($f64, dst, a, b),)* }
        }
    };
}

// On 32 bits, with a constant, on 64 bits, on 64 bits by a count of 32 bits, on singles, on doubles.
binary_operators! {
    Add: AddI32 AddI32Imm AddI64 - AddF32 AddF64;
    Subtract: SubI32 - SubI64 - SubF32 SubF64;
    Multiply: MulI32 MulI32Imm MulI64 - MulF32 MulF64;
    Divide: DivI32S - DivI64S - DivF32 DivF64;
    DivideUnsigned: DivI32U - DivI64U - - -;
    Remainder: RemI32S - RemI64S - - -;
    RemainderUnsigned: RemI32U - RemI64U - - -;
    And: AndI32 AndI32Imm AndI64 - - -;
    Or: OrI32 - OrI64 - - -;
    Xor: XorI32 - XorI64 - - -;
    ShiftLeft: ShlI32 ShlI32Imm - ShlI64 - -;
    ShiftRight: ShrI32S ShrI32SImm - ShrI64S - -;
    ShiftRightUnsigned: ShrI32U ShrI32UImm - ShrI64U - -;
}

/// Expands the table of comparisons into a function for each column.
macro_rules! comparisons {
    ($($op:ident: $i32:ident $i64:ident $f32:ident $f64:ident;)*) => {
        pub(super) fn compare_i32(op: CompareOp, dst: RegI32, a: RegI32, b: RegI32) -> Op {
            match op { $(CompareOp::$op => Op::$i32 { dst, a, b },)* }
        }

        pub(super) fn compare_i64(op: CompareOp, dst: RegI32, a: RegI64, b: RegI64) -> Op {
            match op { $(CompareOp::$op => Op::$i64 { dst, a, b },)* }
        }

        pub(super) fn compare_f32(op: CompareOp, dst: RegI32, a: RegF32, b: RegF32) -> Op {
            match op { $(CompareOp::$op => Op::$f32 { dst, a, b },)* }
        }

        pub(super) fn compare_f64(op: CompareOp, dst: RegI32, a: RegF64, b: RegF64) -> Op {
            match op { $(CompareOp::$op => Op::$f64 { dst, a, b },)* }
        }
    };
}

comparisons! {
    Equal: EqI32 EqI64 EqF32 EqF64;
    NotEqual: NeI32 NeI64 NeF32 NeF64;
    Less: LtI32S LtI64S LtF32 LtF64;
    LessEqual: LeI32S LeI64S LeF32 LeF64;
    LessUnsigned: LtI32U LtI64U LtF32 LtF64;
    LessEqualUnsigned: LeI32U LeI64U LeF32 LeF64;
}
