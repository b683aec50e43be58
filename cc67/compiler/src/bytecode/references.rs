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
    /// Any other instruction.
    Nothing,
}

/// Returns the reference of the instruction with number `word`.
pub(crate) fn reference(program: &Program, word: usize) -> Reference {
    let Some(op) = program.ops().get(word) else { return Reference::Nothing };
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "other instructions name nothing outside their operands"
    )]
    match op {
        Op::Call { func } => Reference::Call(program.base().get() + func.0 * WORD as u32),
        Op::CallFw { addr, .. } => Reference::Firmware(addr.0),
        Op::CallPtr { sig, .. } => Reference::Pointer(*sig),
        Op::ConstI32 { imm, .. } => Reference::Number(imm.0.cast_unsigned()),
        Op::ConstF64 { pool, .. } => {
            let bits = program.pool().get(pool.0 as usize);
            bits.map_or(Reference::Nothing, |bits| Reference::Float(f64::from_bits(*bits)))
        }
        Op::ConstF32 { bits, .. } => Reference::Single(f32::from_bits(bits.0)),
        _ => Reference::Nothing,
    }
}
