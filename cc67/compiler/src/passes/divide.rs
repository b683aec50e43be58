//! Signed division and remainder by a power of two, without a division.
//!
//! A shift to the right rounds down, but C's division rounds toward zero: first the divisor minus one is added to a
//! negative dividend; the dividend's sign bits provide that number.

use crate::ir::function::Function;
use crate::ir::inst::{BlockId, Class, Inst, InstKind, Operand, ValueId};
use crate::ir::operators::BinaryOp;

/// Replaces such divisions.
pub fn run(function: &mut Function) {
    for index in 0..function.layout.len() {
        let id = function.layout[index];
        if function.blocks[id].insts.iter().any(|inst| division(&inst.kind).is_some()) {
            block(function, id);
        }
    }
}

/// A division that can be replaced.
struct Division {
    op: BinaryOp,
    dst: ValueId,
    dividend: Operand,
    /// Binary logarithm of the divisor, 1 to 30.
    log: u32,
}

fn division(kind: &InstKind) -> Option<Division> {
    let InstKind::Binary { op: op @ (BinaryOp::Divide | BinaryOp::Remainder), dst, a: dividend, b } = *kind
    else {
        return None;
    };
    let divisor = b.as_int().filter(|divisor| *divisor > 1)?.cast_unsigned();
    divisor.is_power_of_two().then(|| Division { op, dst, dividend, log: divisor.trailing_zeros() })
}

fn block(function: &mut Function, id: BlockId) {
    let insts = std::mem::take(&mut function.blocks[id].insts);
    let mut out = Vec::with_capacity(insts.len() + 8);
    for inst in insts {
        match division(&inst.kind) {
            Some(division) => expand(function, &inst, &division, &mut out),
            None => out.push(inst),
        }
    }
    function.blocks[id].insts = out;
}

fn expand(function: &mut Function, inst: &Inst, division: &Division, out: &mut Vec<Inst>) {
    let mut emit = |op, dst: Option<ValueId>, a: Operand, b: Operand| {
        let dst = dst.unwrap_or_else(|| function.values.push(Class::I32));
        out.push(Inst { kind: InstKind::Binary { op, dst, a, b }, origin: inst.origin });
        Operand::Value(dst)
    };
    let log = Operand::int(division.log.cast_signed());
    // All sign bits, of which as many are kept as the divisor minus one has bits.
    let sign = if division.log == 1 {
        division.dividend
    } else {
        emit(BinaryOp::ShiftRight, None, division.dividend, Operand::int(31))
    };
    let up = Operand::int(32 - division.log.cast_signed());
    let bias = emit(BinaryOp::ShiftRightUnsigned, None, sign, up);
    let biased = emit(BinaryOp::Add, None, division.dividend, bias);
    if division.op == BinaryOp::Divide {
        emit(BinaryOp::ShiftRight, Some(division.dst), biased, log);
    } else {
        let mask = Operand::int(-(1 << division.log));
        let multiple = emit(BinaryOp::And, None, biased, mask);
        emit(BinaryOp::Subtract, Some(division.dst), division.dividend, multiple);
    }
}
