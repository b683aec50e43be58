//! The words with which a row of the table of firmware functions states more than its signature and its cost.
//!
//! A parameter's type names the role of the argument: `AxisNumber` is an `int` in C, and the number of an axis. The
//! attributes after the origin of a row are the methods of [`Attributes`] below, so that a word the table does not
//! have is a compile error.

use std::marker::PhantomData;

use crate::ctype::{CType, Char, GuestType, Role, Scalar};
use crate::ids::Cycles;

macro_rules! roles {
    ($($(#[doc = $doc:literal])+ $name:ident = $role:ident;)*) => {$(
        $(#[doc = $doc])+
        #[derive(Debug)]
        pub enum $name {}

        impl GuestType for $name {
            const C_TYPE: CType = CType::Int;
            const SIZE: u32 = 4;
            const ALIGN: u32 = 4;
            const ROLE: Role = Role::$role;
        }
    )*};
}

roles! {
    /// `int`, the number of an axis.
    AxisNumber = Axis;
    /// `int`, the number of an input or output bit.
    BitNumber = Bit;
    /// `int`, the number of a user thread.
    ThreadNumber = Thread;
}

/// `int`, from `-MOST` to `MOST`.
#[derive(Debug)]
pub enum BoundedInt<const MOST: i32> {}

impl<const MOST: i32> GuestType for BoundedInt<MOST> {
    const C_TYPE: CType = CType::Int;
    const SIZE: u32 = 4;
    const ALIGN: u32 = 4;
    const ROLE: Role = Role::Within(MOST);
}

macro_rules! texts {
    ($($(#[doc = $doc:literal])+ $name:ident = $role:ident;)*) => {$(
        $(#[doc = $doc])+
        #[derive(Debug)]
        pub struct $name<T = *const Char>(PhantomData<T>);

        impl<T: Scalar> GuestType for $name<T> {
            const C_TYPE: CType = T::C_TYPE;
            const SIZE: u32 = T::SIZE;
            const ALIGN: u32 = T::ALIGN;
            const ROLE: Role = Role::$role;
        }
    )*};
}

texts! {
    /// `const char *`, the format of a function that prints.
    PrintFormat = PrintFormat;
    /// `const char *`, the format of a function that scans.
    ScanFormat = ScanFormat;
    /// `const char *`, the name of a file on the PC.
    FileName = FileName;
}

/// The state that a program polls when it calls a function again and again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolledState {
    /// The time.
    Time,
    /// The bit that the first argument names.
    Bit,
    /// The motion of the axis that the first argument names.
    Motion,
    /// Motion of the coordinate system.
    Path,
    /// The data recorder.
    Recording,
    /// A lock.
    Lock,
}

/// The effect of a function on the bit that its first argument names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitAccess {
    /// Reads the level.
    Read,
    /// Drives the bit, or makes it an output.
    Write,
}

/// The event that ends a wait, and what a function does after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resumption {
    /// The event.
    pub event: WaitEnd,
    /// The time until the function returns, without its accesses to registers.
    pub cycles: Cycles,
    /// Accesses to registers of the board in this time.
    pub register_accesses: u32,
}

/// The end of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitEnd {
    /// The next slice of the thread.
    Slice,
    /// A time.
    Time,
}

/// A0 to A9, or B0 to B9.
pub(crate) const ALL: &[u32] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
/// All but B3, which holds the return address.
pub(crate) const NOT_B3: &[u32] = &[0, 1, 2, 4, 5, 6, 7, 8, 9];

/// The attributes of a row.
#[derive(Clone, Copy, Debug)]
pub struct Attributes {
    /// The condition that ends its wait, as "until …" or "while …", if it may wait. Others return in the time that
    /// their row states.
    pub waits: Option<&'static str>,
    /// The state that a program polls with it.
    pub polls: Option<PolledState>,
    /// True if it makes the axis of its first argument work.
    pub drives_axis: bool,
    /// The effect on the bit of its first argument.
    pub bit_access: Option<BitAccess>,
    /// True if it computes its result from its arguments and has no effect.
    pub is_pure: bool,
    /// Bytes of the thread's stack that it was measured to need at most, with the caller's part (`c67x.md` section 6.3).
    pub stack: Option<u32>,
    /// The registers of the processor that a call changes, A0 in bit 0, B0 in bit 32 (`c67-subset.md` section 7,
    /// `c67x.md` section 5.2). A compiler keeps values in the others across a call.
    pub changed_registers: u64,
    /// True if its last result is written in the cycle after its return.
    pub returns_early: bool,
    /// The work after a wait (`costs.md` sections 3 and 5).
    pub resumption: Option<Resumption>,
}

impl Attributes {
    /// The attributes of a function whose row has none.
    pub(crate) const NONE: Self = Self {
        waits: None,
        polls: None,
        drives_axis: false,
        bit_access: None,
        is_pure: false,
        stack: None,
        changed_registers: bits(ALL) | bits(ALL) << 32,
        returns_early: false,
        resumption: None,
    };

    /// May wait, while other threads run. The call-back must not call it.
    pub(crate) const fn waits(self, until: &'static str) -> Self {
        Self { waits: Some(until), ..self }
    }

    /// Is called again and again by a program that waits for a state.
    pub(crate) const fn polls(self, state: PolledState) -> Self {
        Self { polls: Some(state), ..self }
    }

    /// Sets the axis of its first argument to work.
    pub(crate) const fn drives_axis(self) -> Self {
        Self { drives_axis: true, ..self }
    }

    /// Reads the bit of its first argument.
    pub(crate) const fn reads_bit(self) -> Self {
        Self { bit_access: Some(BitAccess::Read), ..self }
    }

    /// Drives the bit of its first argument.
    pub(crate) const fn writes_bit(self) -> Self {
        Self { bit_access: Some(BitAccess::Write), ..self }
    }

    /// Computes its result from its arguments and does nothing else.
    pub(crate) const fn pure(self) -> Self {
        Self { is_pure: true, ..self }
    }

    /// Needs this much of the thread's stack in bytes, the caller's part included.
    pub(crate) const fn stack(self, bytes: u32) -> Self {
        Self { stack: Some(bytes), ..self }
    }

    /// Changes these registers of files A and B at most; others change A0 to A9 and B0 to B9.
    pub(crate) const fn changes(self, a: &[u32], b: &[u32]) -> Self {
        Self { changed_registers: bits(a) | bits(b) << 32, ..self }
    }

    /// Returns one cycle before its last register is written.
    pub(crate) const fn returns_early(self) -> Self {
        Self { returns_early: true, ..self }
    }

    /// Continues for some time after a wait for the next slice.
    pub(crate) const fn after_slice(self, cycles: i64, register_accesses: u32) -> Self {
        self.after(WaitEnd::Slice, cycles, register_accesses)
    }

    /// Continues for some time after a wait for a time.
    pub(crate) const fn after_time(self, cycles: i64, register_accesses: u32) -> Self {
        self.after(WaitEnd::Time, cycles, register_accesses)
    }

    const fn after(self, event: WaitEnd, cycles: i64, register_accesses: u32) -> Self {
        let cycles = Cycles::new(cycles);
        Self { resumption: Some(Resumption { event, cycles, register_accesses }), ..self }
    }
}

/// The numbers of registers as a set: register `n` in bit `n`.
const fn bits(mut numbers: &[u32]) -> u64 {
    let mut bits = 0;
    while let [number, rest @ ..] = numbers {
        bits |= 1 << *number;
        numbers = rest;
    }
    bits
}
