//! Traps: the running program did something impossible.
//!
//! A trap stops one thread; the machine continues. Firmware functions return a [`TrapKind`]; the engine adds the place
//! and the thread.

mod processor;
mod scene;

use std::fmt;

use kmotiondef::{CodeAddr, GuestAddr, ThreadId};

pub use self::processor::Fault;
pub use self::scene::Scene;

/// Direction of a memory access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A load.
    Read,
    /// A store.
    Write,
}

impl fmt::Display for Access {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "read",
            Self::Write => "write",
        })
    }
}

/// The kind of trap.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TrapKind {
    /// An access outside the memory map.
    #[error("{access} of the unmapped address {addr}")]
    Unmapped {
        /// First byte that is not mapped.
        addr: GuestAddr,
        /// The kind of access.
        access: Access,
    },
    /// A store into program text.
    #[error("write to {addr}, which holds program text")]
    WriteProtected {
        /// The address written to.
        addr: GuestAddr,
    },
    /// An address that is not a multiple of the size of the access.
    #[error("{access} of {size} bytes at {addr}, which is not aligned")]
    Misaligned {
        /// The address.
        addr: GuestAddr,
        /// Bytes of the access.
        size: u32,
        /// The kind of access.
        access: Access,
    },
    /// An integer division or remainder by zero.
    #[error("integer division by zero")]
    DivisionByZero,
    /// A call whose frame does not fit the thread's stack.
    #[error("stack overflow: {used} bytes used, {size} available")]
    StackOverflow {
        /// Bytes that the stack would hold with the call.
        used: u32,
        /// Bytes of the stack.
        size: u32,
    },
    /// A call of an address where the thread has no function.
    #[error("call of {addr}, where no function of this program starts")]
    BadCallTarget {
        /// The address called.
        addr: GuestAddr,
    },
    /// A call through a pointer whose type differs from the function's.
    #[error("call of {addr} with parameters that do not match the function")]
    SignatureMismatch {
        /// The address called.
        addr: GuestAddr,
    },
    /// A call of a firmware address where the board has no function.
    #[error("call of {addr}, where the firmware has no function")]
    UnknownFirmwareFunction {
        /// The address called.
        addr: GuestAddr,
    },
    /// `longjmp` to a place that no `setjmp` has filled.
    #[error("`longjmp` to the buffer at {addr}, which no `setjmp` has set")]
    NoJumpPlace {
        /// Address of the `jmp_buf`.
        addr: GuestAddr,
    },
    /// `longjmp` to a place that another thread has filled.
    #[error("`longjmp` to the buffer at {addr}, which another thread has set: each thread has its own stack")]
    ForeignJumpPlace {
        /// Address of the `jmp_buf`.
        addr: GuestAddr,
    },
    /// `longjmp` into a call that is over.
    #[error("`longjmp` to the buffer at {addr}, but the function that called `setjmp` there has returned")]
    JumpAfterReturn {
        /// Address of the `jmp_buf`.
        addr: GuestAddr,
    },
    /// There are too many jump points.
    #[error("`setjmp` has set more than {most} buffers in functions that have not returned")]
    TooManyJumpPlaces {
        /// The largest number of places.
        most: usize,
    },
    /// A firmware function that is not simulated.
    #[error("calls `{name}`, whose behaviour the simulated board does not model yet")]
    NotModelled {
        /// Name of the function.
        name: &'static str,
    },
    /// The call-back called a function that waits, pauses or ends a thread.
    #[error("the call-back called a function that waits")]
    CallbackWaits,
    /// The call-back did not return.
    #[error("the call-back did not return within {limit} ticks")]
    CallbackEndless {
        /// The limit.
        limit: i64,
    },
    /// The compiler took this place to be unreachable; a `goto *` to an invalid label leads to such a place.
    #[error(
        "execution reached an address without code, for example by `goto *` to something other than a label"
    )]
    Unreachable,
    /// Code of the real processor that compilers do not generate.
    #[error(transparent)]
    Processor(#[from] Fault),
}

/// A trap with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trap {
    /// The kind of trap.
    pub kind: TrapKind,
    /// The instruction that did it.
    pub at: CodeAddr,
    /// The thread it stops; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// Registers and code around the place, of code of the real processor.
    pub scene: Option<Box<Scene>>,
}

impl Trap {
    /// A trap of which only the place is known.
    #[must_use]
    pub const fn new(kind: TrapKind, at: CodeAddr, thread: Option<ThreadId>) -> Self {
        Self { kind, at, thread, scene: None }
    }
}

impl fmt::Display for Trap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.thread {
            Some(thread) => write!(f, "thread {thread}")?,
            None => f.write_str("call-back")?,
        }
        write!(f, " at {}: {}", self.at, self.kind)
    }
}

impl std::error::Error for Trap {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trap_names_thread_place_and_cause() {
        let kind = TrapKind::Unmapped { addr: GuestAddr::new(0x1234), access: Access::Write };
        let at = CodeAddr::new(0x8005_0010).expect("a multiple of 8");
        let trap = Trap::new(kind, at, ThreadId::new(1));
        assert_eq!(trap.to_string(), "thread 1 at 0x80050010: write of the unmapped address 0x00001234");
    }
}
