//! The requests of compiled code to the engine.
//!
//! Compiled code executes instructions that need only registers and RAM. For everything else it suspends its fiber with
//! a [`Request`]: two numbers give the kind and the position, two the operands. The engine answers it on the host's
//! stack, in safe code, and resumes the fiber.

use kmotiondef::map::SDRAM;

use crate::arith::WordDivision;
use crate::kind::Width;

/// A request from compiled code. The layout is that of C, because compiled code writes the fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub(super) struct Request {
    /// The kind of request, from [`Reason::with_width`].
    pub(super) code: u32,
    /// The instruction at which the context waits for the answer.
    pub(super) at: u32,
    /// Address of the current call's frame.
    pub(super) stack_pointer: u32,
    /// First operand.
    pub(super) a: u64,
    /// Second operand.
    pub(super) b: u64,
}

/// The handle that suspends a fiber with a request, and returns the answer.
pub(super) type Yielder = corosensei::Yielder<u64, Request>;

macro_rules! codes {
    ($(#[$doc:meta])* $name:ident { $($(#[$row:meta])* $variant:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub(super) enum $name {
            $($(#[$row])* $variant,)*
        }

        impl $name {
            const ALL: &'static [Self] = &[$(Self::$variant),*];

            fn from_code(code: u32) -> Option<Self> {
                Self::ALL.get(usize::try_from(code).ok()?).copied()
            }
        }
    };
}

codes! {
    /// The kind of a request.
    Reason {
        /// The budget is used up.
        Preempted,
        /// Load from the address `a`; the answer is the register slot.
        Load,
        /// Store the register slot `b` to the address `a`.
        Store,
        /// Store the low word of the register slot `b` to the address `a`, end the slice, and store the high word in the
        /// next.
        StoreLowWord,
        /// Report the access to the address `a`, which was made with the register slot `b`.
        Accessed,
        /// Copy: `a` is the destination, with the source in its upper half; `b` the length.
        Copy,
        /// Clear `b` bytes at `a`.
        Clear,
        /// Call the firmware function at `a` with the arguments in the state and signature `b`; the answer is
        /// the result as a slot.
        CallFirmware,
        /// Resolve the function pointer `a` for a call with signature `b`; the answer is the function, none
        /// for one of the firmware.
        CallPointer,
        /// Skip iterations of a waiting loop that equal the one that has ended, which began with `a` cycles left in the
        /// slice of tick `b`. The state holds its use of the time.
        PassIterations,
        /// End the slice if it is a long one.
        NeedsBoard,
        /// The stack has no room for the `a` bytes of a call; `stack_pointer` is the caller's.
        StackOverflow,
        /// An integer division of the slot `a` by zero, encoded by [`Request::of_division`]; the answer is its result.
        DivisionByZero,
        /// An `unreachable` was reached.
        Unreachable,
    }
}

impl Reason {
    /// The code of the request.
    pub(super) const fn code(self) -> u32 {
        self as u32
    }

    /// The code of the request for an access of `width`.
    pub(super) const fn with_width(self, width: Width) -> u32 {
        self as u32 | (width as u32) << 8
    }
}

impl Request {
    /// The kind of request; `None` for a code that no compiled code uses.
    pub(super) fn reason(&self) -> Option<Reason> {
        Reason::from_code(self.code & 0xff)
    }

    /// Reports whether the answer may depend on more than the context and SDRAM, or change more.
    pub(super) fn involves_board(&self) -> bool {
        let is_in_sdram = |address: u64| {
            let place = (address as u32).wrapping_sub(SDRAM.base.get());
            u64::from(place) + self.b <= u64::from(SDRAM.size)
        };
        match self.reason() {
            Some(
                Reason::Load
                | Reason::Store
                | Reason::StoreLowWord
                | Reason::Accessed
                | Reason::CallFirmware
                | Reason::NeedsBoard,
            ) => true,
            Some(Reason::Copy) => !is_in_sdram(self.a) || !is_in_sdram(self.a >> 32),
            Some(Reason::Clear) => !is_in_sdram(self.a),
            Some(
                Reason::Preempted
                | Reason::PassIterations
                | Reason::CallPointer
                | Reason::StackOverflow
                | Reason::DivisionByZero
                | Reason::Unreachable,
            )
            | None => false,
        }
    }

    /// The operand that names a division; `None` for one of 64 bits, which no board has.
    pub(super) fn of_division(op: Option<WordDivision>) -> i64 {
        op.map_or(0, |op| op as i64 + 1)
    }

    /// The division of a request.
    pub(super) fn division(&self) -> Option<WordDivision> {
        WordDivision::ALL.get(usize::try_from(self.b).ok()?.checked_sub(1)?).copied()
    }

    /// The width of the load or store.
    pub(super) fn width(&self) -> Option<Width> {
        Width::ALL.get(usize::try_from(self.code >> 8).ok()?).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_read_as_they_were_written() {
        for reason in Reason::ALL {
            for width in Width::ALL {
                let request = Request { code: reason.with_width(width), at: 0, stack_pointer: 0, a: 0, b: 0 };
                assert_eq!((request.reason(), request.width()), (Some(*reason), Some(width)));
            }
            assert_eq!(Reason::from_code(reason.code()), Some(*reason));
        }
    }
}
