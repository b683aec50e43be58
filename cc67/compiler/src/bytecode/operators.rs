//! The instruction for an operator, for each class of operands.

use vm::op::Op;
use vm::operand::{Imm16, RegF32, RegF64, RegI32, RegI64};

use crate::ir::operators::{BinaryOp, CompareOp};

/// The instruction for operators that legal IR does not have: the program stops there, as a wrong instruction would
/// continue with a wrong result.
pub(super) fn illegal() -> Op {
    debug_assert!(false, "the IR is verified and legal");
    Op::Unreachable {}
}

/// The instruction with a constant of 16 bits as its second operand.
pub(super) type Immediate = fn(RegI32, RegI32, Imm16) -> Op;

/// The immediate form of an operator on 32 bits, if there is one; of `x - c` that is `x + -c`.
pub(super) fn immediate(op: BinaryOp) -> Option<Immediate> {
    match op {
        BinaryOp::Add => Some(|dst, a, imm| Op::AddI32Imm { dst, a, imm }),
        BinaryOp::Multiply => Some(|dst, a, imm| Op::MulI32Imm { dst, a, imm }),
        BinaryOp::And => Some(|dst, a, imm| Op::AndI32Imm { dst, a, imm }),
        BinaryOp::ShiftLeft => Some(|dst, a, imm| Op::ShlI32Imm { dst, a, imm }),
        BinaryOp::ShiftRight => Some(|dst, a, imm| Op::ShrI32SImm { dst, a, imm }),
        BinaryOp::ShiftRightUnsigned => Some(|dst, a, imm| Op::ShrI32UImm { dst, a, imm }),
        BinaryOp::Subtract
        | BinaryOp::Divide
        | BinaryOp::DivideUnsigned
        | BinaryOp::Remainder
        | BinaryOp::RemainderUnsigned
        | BinaryOp::Or
        | BinaryOp::Xor => None,
    }
}

pub(super) fn binary_i32(op: BinaryOp, dst: RegI32, a: RegI32, b: RegI32) -> Op {
    match op {
        BinaryOp::Add => Op::AddI32 { dst, a, b },
        BinaryOp::Subtract => Op::SubI32 { dst, a, b },
        BinaryOp::Multiply => Op::MulI32 { dst, a, b },
        BinaryOp::Divide => Op::DivI32S { dst, a, b },
        BinaryOp::DivideUnsigned => Op::DivI32U { dst, a, b },
        BinaryOp::Remainder => Op::RemI32S { dst, a, b },
        BinaryOp::RemainderUnsigned => Op::RemI32U { dst, a, b },
        BinaryOp::And => Op::AndI32 { dst, a, b },
        BinaryOp::Or => Op::OrI32 { dst, a, b },
        BinaryOp::Xor => Op::XorI32 { dst, a, b },
        BinaryOp::ShiftLeft => Op::ShlI32 { dst, a, b },
        BinaryOp::ShiftRight => Op::ShrI32S { dst, a, b },
        BinaryOp::ShiftRightUnsigned => Op::ShrI32U { dst, a, b },
    }
}

/// Every operator but the shifts.
pub(super) fn binary_i64(op: BinaryOp, dst: RegI64, a: RegI64, b: RegI64) -> Op {
    match op {
        BinaryOp::Add => Op::AddI64 { dst, a, b },
        BinaryOp::Subtract => Op::SubI64 { dst, a, b },
        BinaryOp::Multiply => Op::MulI64 { dst, a, b },
        BinaryOp::Divide => Op::DivI64S { dst, a, b },
        BinaryOp::DivideUnsigned => Op::DivI64U { dst, a, b },
        BinaryOp::Remainder => Op::RemI64S { dst, a, b },
        BinaryOp::RemainderUnsigned => Op::RemI64U { dst, a, b },
        BinaryOp::And => Op::AndI64 { dst, a, b },
        BinaryOp::Or => Op::OrI64 { dst, a, b },
        BinaryOp::Xor => Op::XorI64 { dst, a, b },
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight | BinaryOp::ShiftRightUnsigned => illegal(),
    }
}

pub(super) fn shift_i64(op: BinaryOp, dst: RegI64, a: RegI64, b: RegI32) -> Op {
    match op {
        BinaryOp::ShiftLeft => Op::ShlI64 { dst, a, b },
        BinaryOp::ShiftRight => Op::ShrI64S { dst, a, b },
        BinaryOp::ShiftRightUnsigned => Op::ShrI64U { dst, a, b },
        BinaryOp::Add
        | BinaryOp::Subtract
        | BinaryOp::Multiply
        | BinaryOp::Divide
        | BinaryOp::DivideUnsigned
        | BinaryOp::Remainder
        | BinaryOp::RemainderUnsigned
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Xor => illegal(),
    }
}

/// The operators that floats have.
pub(super) fn binary_f32(op: BinaryOp, dst: RegF32, a: RegF32, b: RegF32) -> Op {
    match op {
        BinaryOp::Add => Op::AddF32 { dst, a, b },
        BinaryOp::Subtract => Op::SubF32 { dst, a, b },
        BinaryOp::Multiply => Op::MulF32 { dst, a, b },
        BinaryOp::Divide => Op::DivF32 { dst, a, b },
        BinaryOp::DivideUnsigned
        | BinaryOp::Remainder
        | BinaryOp::RemainderUnsigned
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Xor
        | BinaryOp::ShiftLeft
        | BinaryOp::ShiftRight
        | BinaryOp::ShiftRightUnsigned => illegal(),
    }
}

/// The operators that floats have.
pub(super) fn binary_f64(op: BinaryOp, dst: RegF64, a: RegF64, b: RegF64) -> Op {
    match op {
        BinaryOp::Add => Op::AddF64 { dst, a, b },
        BinaryOp::Subtract => Op::SubF64 { dst, a, b },
        BinaryOp::Multiply => Op::MulF64 { dst, a, b },
        BinaryOp::Divide => Op::DivF64 { dst, a, b },
        BinaryOp::DivideUnsigned
        | BinaryOp::Remainder
        | BinaryOp::RemainderUnsigned
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Xor
        | BinaryOp::ShiftLeft
        | BinaryOp::ShiftRight
        | BinaryOp::ShiftRightUnsigned => illegal(),
    }
}

pub(super) fn compare_i32(op: CompareOp, dst: RegI32, a: RegI32, b: RegI32) -> Op {
    match op {
        CompareOp::Equal => Op::EqI32 { dst, a, b },
        CompareOp::NotEqual => Op::NeI32 { dst, a, b },
        CompareOp::Less => Op::LtI32S { dst, a, b },
        CompareOp::LessEqual => Op::LeI32S { dst, a, b },
        CompareOp::LessUnsigned => Op::LtI32U { dst, a, b },
        CompareOp::LessEqualUnsigned => Op::LeI32U { dst, a, b },
    }
}

pub(super) fn compare_i64(op: CompareOp, dst: RegI32, a: RegI64, b: RegI64) -> Op {
    match op {
        CompareOp::Equal => Op::EqI64 { dst, a, b },
        CompareOp::NotEqual => Op::NeI64 { dst, a, b },
        CompareOp::Less => Op::LtI64S { dst, a, b },
        CompareOp::LessEqual => Op::LeI64S { dst, a, b },
        CompareOp::LessUnsigned => Op::LtI64U { dst, a, b },
        CompareOp::LessEqualUnsigned => Op::LeI64U { dst, a, b },
    }
}

pub(super) fn compare_f32(op: CompareOp, dst: RegI32, a: RegF32, b: RegF32) -> Op {
    match op {
        CompareOp::Equal => Op::EqF32 { dst, a, b },
        CompareOp::NotEqual => Op::NeF32 { dst, a, b },
        CompareOp::Less | CompareOp::LessUnsigned => Op::LtF32 { dst, a, b },
        CompareOp::LessEqual | CompareOp::LessEqualUnsigned => Op::LeF32 { dst, a, b },
    }
}

pub(super) fn compare_f64(op: CompareOp, dst: RegI32, a: RegF64, b: RegF64) -> Op {
    match op {
        CompareOp::Equal => Op::EqF64 { dst, a, b },
        CompareOp::NotEqual => Op::NeF64 { dst, a, b },
        CompareOp::Less | CompareOp::LessUnsigned => Op::LtF64 { dst, a, b },
        CompareOp::LessEqual | CompareOp::LessEqualUnsigned => Op::LeF64 { dst, a, b },
    }
}
