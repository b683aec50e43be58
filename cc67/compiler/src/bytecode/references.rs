//! The references of a program's instructions: functions, the firmware, constants.

use vm::op::{Op, WORD};
use vm::operand::SigRef;
use vm::program::Program;

/// A reference of an instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reference {
    /// A call of the program's function at this address.
    Call(u32),
    /// A call of the firmware's function at this address.
    Firmware(u32),
    /// A call through a pointer, with this signature.
    Pointer(SigRef),
    /// A number, or an address that is used as a value.
    Number(u32),
    /// A floating-point constant.
    Float(f64),
    /// A number in single precision.
    Single(f32),
    /// Anything else.
    Nothing,
}

/// Returns the reference of the instruction with number `word`.
pub(crate) fn reference(program: &Program, word: usize) -> Reference {
    let Some(op) = program.ops().get(word) else { return Reference::Nothing };
    if let Op::Call { func } = op {
        Reference::Call(program.base().get() + func.0 * WORD as u32)
    } else if let Op::CallFw { addr, .. } = op {
        Reference::Firmware(addr.0)
    } else if let Op::CallPtr { sig, .. } = op {
        Reference::Pointer(*sig)
    } else if let Op::ConstI32 { imm, .. } = op {
        Reference::Number(imm.0.cast_unsigned())
    } else if let Op::ConstF64 { pool, .. } = op {
        let bits = program.pool().get(pool.0 as usize);
        bits.map_or(Reference::Nothing, |bits| Reference::Float(f64::from_bits(*bits)))
    } else if let Op::ConstF32 { bits, .. } = op {
        Reference::Single(f32::from_bits(bits.0))
    } else {
        Reference::Nothing
    }
}
