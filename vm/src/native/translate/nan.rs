//! The floating-point registers that may hold NaNs as the host processor makes them.
//!
//! Every operation that makes a NaN makes the canonical one ([`crate::arith`]), which costs a comparison and a
//! selection. This only matters where the rest of the machine sees the value, so a register may hold the processor's
//! NaN as long as only arithmetic reads it: a sum that is built in a loop pays when it is stored, not in each
//! iteration.
//!
//! That works for a register that is only ever assigned results of arithmetic, constants and other such registers: any
//! NaN in it then stands for the canonical NaN. A register that is also loaded from memory may hold a NaN whose bits
//! belong to the program, and keeps it.

use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Bits32, Class, Pool, RegF32, RegF64};
use crate::program::{Function, Program};

/// For each register of a function: true if any NaN in it stands for the canonical NaN.
pub(super) fn lax_registers(program: &Program, function: &Function, parameters: usize) -> Vec<bool> {
    let mut lax: Vec<_> =
        function.classes.iter().map(|class| matches!(class, Class::F32 | Class::F64)).collect();
    lax.iter_mut().take(parameters).for_each(|parameter| *parameter = false);
    let mut moves = Vec::new();
    for op in &program.ops()[function.body.clone()] {
        let Some(destination) = register(op, Name::Dst) else { continue };
        match source(op, program) {
            Source::Arithmetic => {}
            Source::Register(source) => moves.push((destination, source)),
            Source::Bits => lax[destination] = false,
        }
    }
    // A register that receives a copy of another is as strict as that one; repeated until nothing changes.
    while moves.iter().any(|(to, from)| {
        let spreads = lax[*to] && !lax[*from];
        lax[*to] &= lax[*from];
        spreads
    }) {}
    lax
}

/// The source of the value that an instruction assigns to its floating register.
enum Source {
    /// A result of arithmetic, or a number.
    Arithmetic,
    /// The value of another register.
    Register(usize),
    /// Bits that must be preserved.
    Bits,
}

fn source(op: &Op, program: &Program) -> Source {
    match op.kind() {
        OpKind::Arithmetic | OpKind::Conversion => Source::Arithmetic,
        OpKind::Constant if !is_nan(op, program) => Source::Arithmetic,
        OpKind::Move => register(op, Name::Src).map_or(Source::Bits, Source::Register),
        OpKind::Structure
        | OpKind::Charge
        | OpKind::Constant
        | OpKind::Address
        | OpKind::Negation
        | OpKind::Load(_)
        | OpKind::Store(_)
        | OpKind::Block
        | OpKind::Jump
        | OpKind::Branch
        | OpKind::Table
        | OpKind::Argument(_)
        | OpKind::Call
        | OpKind::Result(_)
        | OpKind::Return(_)
        | OpKind::Stop => Source::Bits,
    }
}

/// Reports whether a constant is not a number.
fn is_nan(op: &Op, program: &Program) -> bool {
    let single = op.operand(Name::Bits).is_some_and(|Bits32(bits)| f32::from_bits(bits).is_nan());
    single
        || op.operand(Name::Pool).is_some_and(|Pool(at)| f64::from_bits(program.pool()[at as usize]).is_nan())
}

/// The number of the floating register that an operand is.
fn register(op: &Op, name: Name) -> Option<usize> {
    let double = || op.operand::<RegF64>(name).map(RegF64::index);
    op.operand::<RegF32>(name).map(RegF32::index).or_else(double)
}
