//! The registers of a call, by the convention of the board's firmware and compilers.

use crate::Reg;

/// Registers of the arguments, in order; a pair takes the register and the next one.
pub const ARGUMENTS: [Reg; 10] = [
    Reg::a(4),
    Reg::b(4),
    Reg::a(6),
    Reg::b(6),
    Reg::a(8),
    Reg::b(8),
    Reg::a(10),
    Reg::b(10),
    Reg::a(12),
    Reg::b(12),
];

/// The register of the result; for a pair, the even one.
pub const RESULT: Reg = Reg::a(4);

/// The return address.
pub const LINK: Reg = Reg::b(3);

/// The stack pointer.
pub const STACK: Reg = Reg::b(15);
