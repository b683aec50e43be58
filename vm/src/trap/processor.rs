//! The faults of the processor: code that compilers do not generate.

use c67x::Reg;

/// The reason why a packet could not be executed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// A word that is not an instruction.
    #[error("the word {word:08X} at 0x{at:08X} is not an instruction of this processor")]
    BadWord {
        /// The address of the word.
        at: u32,
        /// The word.
        word: u32,
    },
    /// A packet that does not end after eight instructions.
    #[error("the packet at 0x{at:08X} has more than eight instructions")]
    LongPacket {
        /// Its address.
        at: u32,
    },
    /// A branch to where no instruction can be.
    #[error("branch to 0x{target:08X}, which is not a multiple of 4")]
    OddBranch {
        /// The target.
        target: u32,
    },
    /// Two branches are taken at the same time.
    #[error("two branches are taken in the same cycle, to 0x{first:08X} and 0x{second:08X}")]
    TwoBranches {
        /// The first target.
        first: u32,
        /// The second target.
        second: u32,
    },
    /// Two results for the same register land at the same time.
    #[error("two results are written to {reg} in the same cycle")]
    TwoWriters {
        /// The register.
        reg: Reg,
    },
    /// Code that blocks interrupts forever, which on the board stops servo, console and all threads.
    #[error("{cycles} cycles without a place where an interrupt is possible: the board's servo stops")]
    NoInterrupts {
        /// The duration, in cycles.
        cycles: u64,
    },
}
