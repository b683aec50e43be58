//! Which floating registers may hold NaNs as the processor makes them.
//!
//! An operation that makes a NaN makes the same one everywhere ([`crate::arith`]), which costs a
//! comparison and a selection. What counts is only what the rest of the machine sees, so a
//! register may hold the processor's NaN as long as arithmetic alone reads it: a sum that is
//! built in a loop pays when it is stored, not in each round.
//!
//! That works for a register to which nothing but arithmetic, numbers and such registers are
//! ever assigned: any NaN in it then stands for the one NaN of arithmetic. A register that is
//! also loaded from memory may hold a NaN whose bits belong to the program, and keeps it.

use crate::for_each_op;
use crate::op::Op;
use crate::operand::{Class, Operand, RegF32, RegF64};
use crate::program::{Function, Program};

/// For each register of a function, whether a NaN in it stands for the one that arithmetic makes.
pub(super) fn lax_registers(program: &Program, function: &Function, parameters: usize) -> Vec<bool> {
    let mut lax: Vec<_> =
        function.classes.iter().map(|class| matches!(class, Class::F32 | Class::F64)).collect();
    lax.iter_mut().take(parameters).for_each(|parameter| *parameter = false);
    let mut moves = Vec::new();
    for op in &program.ops()[function.body.clone()] {
        let Some(destination) = float_destination(op) else { continue };
        match source(op, program) {
            Source::Arithmetic => {}
            Source::Register(source) => moves.push((destination, source)),
            Source::Bits => lax[destination] = false,
        }
    }
    // A register that takes over the bits of another is as strict; until nothing changes.
    while moves.iter().any(|(to, from)| {
        let spreads = lax[*to] && !lax[*from];
        lax[*to] &= lax[*from];
        spreads
    }) {}
    lax
}

/// What an instruction assigns to its floating register.
enum Source {
    /// A result of arithmetic, or a number.
    Arithmetic,
    /// The value of another register.
    Register(usize),
    /// Bits that must stay as they are.
    Bits,
}

fn source(op: &Op, program: &Program) -> Source {
    match op {
        Op::ConstF32 { bits, .. } if !f32::from_bits(bits.0).is_nan() => Source::Arithmetic,
        Op::ConstF64 { pool, .. } if !f64::from_bits(program.pool()[pool.0 as usize]).is_nan() => {
            Source::Arithmetic
        }
        Op::AddF32 { .. }
        | Op::SubF32 { .. }
        | Op::MulF32 { .. }
        | Op::DivF32 { .. }
        | Op::AddF64 { .. }
        | Op::SubF64 { .. }
        | Op::MulF64 { .. }
        | Op::DivF64 { .. }
        | Op::F32FromF64 { .. }
        | Op::F64FromF32 { .. }
        | Op::F32FromI32S { .. }
        | Op::F32FromI32U { .. }
        | Op::F32FromI64S { .. }
        | Op::F32FromI64U { .. }
        | Op::F64FromI32S { .. }
        | Op::F64FromI32U { .. }
        | Op::F64FromI64S { .. }
        | Op::F64FromI64U { .. } => Source::Arithmetic,
        Op::MovF32 { src, .. } => Source::Register(src.index()),
        Op::MovF64 { src, .. } => Source::Register(src.index()),
        _ => Source::Bits,
    }
}

macro_rules! define_destination {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr;)*) => {
        /// The floating register to which an instruction assigns.
        fn float_destination(op: &Op) -> Option<usize> {
            match *op {
                $(Op::$variant { $($field),* } => {
                    let destinations: &[Option<usize>] = &[$(destination(stringify!($field), $field)),*];
                    destinations.iter().copied().flatten().next()
                })*
            }
        }
    };
}
for_each_op!(define_destination);

/// The number of the register that an operand is, if it is a floating one that receives a value.
fn destination<O: Operand>(field: &str, operand: O) -> Option<usize> {
    let is_float = O::CLASS == RegF32::CLASS || O::CLASS == RegF64::CLASS;
    (field == "dst" && is_float).then(|| operand.to_bits() as usize)
}
