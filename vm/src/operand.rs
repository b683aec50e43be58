//! The operands of an instruction: registers, immediates, labels.
//!
//! Every instruction is one word of eight bytes: two of opcode and six of operands, packed
//! in the order of the table row, little endian, the rest zero. An operand type says how it
//! is encoded and decoded ([`OperandType`]); its `Display` says how it is printed.
//!
//! A register is one slot of a function's frame and holds one type of value for the whole
//! function. The four register types of Rust make that visible in the table, so that the
//! verifier, the printer and the native engine need no table of their own.
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::as_conversions
    )
)]

use std::fmt;

/// The type of value a register holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Class {
    /// 32-bit integer or guest address.
    I32 = 0,
    /// 64-bit integer.
    I64 = 1,
    /// IEEE single.
    F32 = 2,
    /// IEEE double.
    F64 = 3,
}

impl Class {
    /// All classes in the order of their codes.
    pub const ALL: [Self; 4] = [Self::I32, Self::I64, Self::F32, Self::F64];

    /// The class with the given two-bit code.
    #[must_use]
    pub const fn from_code(code: u8) -> Self {
        match code & 3 {
            0 => Self::I32,
            1 => Self::I64,
            2 => Self::F32,
            _ => Self::F64,
        }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

/// An operand of an instruction.
pub trait OperandType: Copy + fmt::Display {
    /// Bytes it takes in the instruction word.
    const SIZE: usize;
    /// The register class, if the operand is a register.
    const CLASS: Option<Class> = None;

    /// The operand as a number of `SIZE` bytes, zero-extended.
    fn to_bits(self) -> u32;
    /// The operand from such a number; every bit pattern is an operand.
    fn from_bits(bits: u32) -> Self;
    /// Parses an operand from the text that `Display` prints; numbers may be decimal or `0x` hexadecimal.
    fn parse(text: &str) -> Option<Self>;
}

macro_rules! register {
    ($(#[$doc:meta])* $name:ident, $class:ident, $prefix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u16);

        impl $name {
            /// The slot in the frame.
            #[must_use]
            pub fn index(self) -> usize {
                usize::from(self.0)
            }
        }

        impl OperandType for $name {
            const SIZE: usize = 2;
            const CLASS: Option<Class> = Some(Class::$class);

            fn to_bits(self) -> u32 {
                u32::from(self.0)
            }

            #[inline]
            fn from_bits(bits: u32) -> Self {
                Self(u16::from_low_bytes(bits.to_le_bytes()))
            }

            fn parse(text: &str) -> Option<Self> {
                text.strip_prefix($prefix)?.parse().ok().map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }
    };
}

register! {
    /// A register that holds a 32-bit integer or an address.
    RegI32, I32, "r"
}
register! {
    /// A register that holds a 64-bit integer.
    RegI64, I64, "l"
}
register! {
    /// A register that holds a single.
    RegF32, F32, "f"
}
register! {
    /// A register that holds a double.
    RegF64, F64, "d"
}

macro_rules! number {
    ($(#[$doc:meta])* $name:ident($repr:ty), $size:literal, $prefix:literal $format:literal $suffix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub $repr);

        impl OperandType for $name {
            const SIZE: usize = $size;

            fn to_bits(self) -> u32 {
                // Through the unsigned type of the same width, so that a sign is not spread.
                u32::from_le_bytes(self.0.to_le_bytes_padded())
            }

            #[inline]
            fn from_bits(bits: u32) -> Self {
                Self(<$repr>::from_low_bytes(bits.to_le_bytes()))
            }

            fn parse(text: &str) -> Option<Self> {
                <$repr>::parse_number(text.strip_prefix($prefix)?.strip_suffix($suffix)?).map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($prefix, $format, $suffix), self.0)
            }
        }
    };
}

/// The operations on integers that number operands need.
trait Number: Sized {
    /// Little-endian bytes, zero-padded.
    fn to_le_bytes_padded(self) -> [u8; 4];
    /// The number from its little-endian bytes; bytes beyond its size are dropped.
    fn from_low_bytes(bytes: [u8; 4]) -> Self;
    /// The number in decimal, or in hexadecimal as its bit pattern.
    fn parse_number(text: &str) -> Option<Self>;
}

macro_rules! numbers {
    ($($ty:ty as $unsigned:ty),*) => {$(
        impl Number for $ty {
            fn to_le_bytes_padded(self) -> [u8; 4] {
                let mut padded = [0; 4];
                for (to, from) in padded.iter_mut().zip(self.to_le_bytes()) {
                    *to = from;
                }
                padded
            }

            #[inline]
            fn from_low_bytes(bytes: [u8; 4]) -> Self {
                let mut own = [0; size_of::<$ty>()];
                for (to, from) in own.iter_mut().zip(bytes) {
                    *to = from;
                }
                Self::from_le_bytes(own)
            }

            fn parse_number(text: &str) -> Option<Self> {
                match text.strip_prefix("0x") {
                    Some(digits) => {
                        let bits = <$unsigned>::from_str_radix(digits, 16).ok()?;
                        Some(Self::from_le_bytes(bits.to_le_bytes()))
                    }
                    None => text.parse().ok(),
                }
            }
        }
    )*};
}
numbers!(i16 as u16, u16 as u16, i32 as u32, u32 as u32);

number! {
    /// A 32-bit constant.
    Imm(i32), 4, "" "{}" ""
}
number! {
    /// A 16-bit constant, sign-extended.
    Imm16(i16), 2, "" "{}" ""
}
number! {
    /// The bit pattern of a single.
    Bits32(u32), 4, "" "{:#010x}" ""
}
number! {
    /// A displacement in bytes, added to an address register.
    Off(i16), 2, "" "{:+}" ""
}
number! {
    /// An absolute guest address.
    Addr(u32), 4, "" "{:#010x}" ""
}
number! {
    /// A place in the code: index of an instruction word, counted from the start of the text.
    Label(u32), 4, "@" "{}" ""
}
number! {
    /// A function: index of its `func` word, counted from the start of the text.
    FuncRef(u32), 4, "fn@" "{}" ""
}
number! {
    /// A constant of eight bytes in the program's pool.
    Pool(u32), 4, "pool[" "{}" "]"
}
number! {
    /// A signature of the program, counted from zero in the order of the `sig` words.
    SigRef(u16), 2, "sig" "{}" ""
}
number! {
    /// A small count.
    Count(u16), 2, "" "{}" ""
}
number! {
    /// A large count.
    Count32(u32), 4, "" "{}" ""
}
number! {
    /// Sixteen register classes of two bits each, lowest bits first.
    Classes(u32), 4, "" "{:#010x}" ""
}
