//! Operators, comparisons, conversions and widths of memory accesses.
//!
//! Operators name signedness where it matters, as the machine's instructions do. `>` and `>=`
//! do not exist: whoever builds a comparison swaps its operands.

use std::fmt;

use super::inst::Class;

macro_rules! operators {
    ($(#[$doc:meta])* $type:ident { $($(#[$variant_doc:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $($(#[$variant_doc])* $variant,)*
        }

        impl $type {
            /// The name in the text form.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

operators! {
    /// Operators on one value.
    UnaryOp {
        /// `-a`, wrapping for integers
        Negate = "neg",
        /// `~a`, integers
        Complement = "not",
    }
}

operators! {
    /// Operators on two values of one class; a shift count is always `I32`.
    BinaryOp {
        /// `a + b`
        Add = "add",
        /// `a - b`
        Subtract = "sub",
        /// `a * b`
        Multiply = "mul",
        /// `a / b`, floating or signed toward zero
        Divide = "div",
        /// `a / b`, unsigned
        DivideUnsigned = "div_u",
        /// `a % b` with the sign of `a`
        Remainder = "rem",
        /// `a % b`, unsigned
        RemainderUnsigned = "rem_u",
        /// `a & b`
        And = "and",
        /// `a | b`
        Or = "or",
        /// `a ^ b`
        Xor = "xor",
        /// `a << b`, the count modulo 64
        ShiftLeft = "shl",
        /// `a >> b`, arithmetic, the count modulo 64
        ShiftRight = "shr",
        /// `a >> b`, logical, the count modulo 64
        ShiftRightUnsigned = "shr_u",
    }
}

impl BinaryOp {
    /// Whether the second operand is a shift count.
    #[must_use]
    pub const fn is_shift(self) -> bool {
        matches!(self, Self::ShiftLeft | Self::ShiftRight | Self::ShiftRightUnsigned)
    }

    /// Whether the operands can change places.
    #[must_use]
    pub const fn is_commutative(self) -> bool {
        matches!(self, Self::Add | Self::Multiply | Self::And | Self::Or | Self::Xor)
    }

    /// Whether a zero divisor traps, so that the instruction must stay; floating division never does.
    #[must_use]
    pub const fn may_trap(self, class: Class) -> bool {
        class.is_integer()
            && matches!(self, Self::Divide | Self::DivideUnsigned | Self::Remainder | Self::RemainderUnsigned)
    }
}

operators! {
    /// Comparisons; the result is `I32` 0 or 1, false for a NaN except `NotEqual`.
    CompareOp {
        /// `a == b`
        Equal = "eq",
        /// `a != b`
        NotEqual = "ne",
        /// `a < b`, floating or signed
        Less = "lt",
        /// `a <= b`, floating or signed
        LessEqual = "le",
        /// `a < b`, unsigned
        LessUnsigned = "lt_u",
        /// `a <= b`, unsigned
        LessEqualUnsigned = "le_u",
    }
}

macro_rules! conversions {
    ($($(#[$doc:meta])* $variant:ident = $name:literal: $from:ident -> $to:ident;)*) => {
        /// Conversions between classes, and the narrowing of integers within `I32`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum ConvertOp {
            $($(#[$doc])* $variant,)*
        }

        impl ConvertOp {
            /// The name in the text form.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// The class that is read.
            #[must_use]
            pub const fn from(self) -> Class {
                match self {
                    $(Self::$variant => Class::$from,)*
                }
            }

            /// The class that is written.
            #[must_use]
            pub const fn to(self) -> Class {
                match self {
                    $(Self::$variant => Class::$to,)*
                }
            }
        }
    };
}

conversions! {
    /// Low 8 bits, sign-extended
    SignExtend8 = "ext8_s": I32 -> I32;
    /// Low 8 bits, zero-extended
    ZeroExtend8 = "ext8_u": I32 -> I32;
    /// Low 16 bits, sign-extended
    SignExtend16 = "ext16_s": I32 -> I32;
    /// Low 16 bits, zero-extended
    ZeroExtend16 = "ext16_u": I32 -> I32;
    /// Sign-extended
    I64FromI32 = "i64_from_i32_s": I32 -> I64;
    /// Zero-extended
    I64FromU32 = "i64_from_i32_u": I32 -> I64;
    /// Low 32 bits
    I32FromI64 = "i32_from_i64": I64 -> I32;
    /// To nearest
    F32FromI32 = "f32_from_i32_s": I32 -> F32;
    /// To nearest, from unsigned
    F32FromU32 = "f32_from_i32_u": I32 -> F32;
    /// To nearest
    F32FromI64 = "f32_from_i64_s": I64 -> F32;
    /// To nearest, from unsigned
    F32FromU64 = "f32_from_i64_u": I64 -> F32;
    /// Exact
    F64FromI32 = "f64_from_i32_s": I32 -> F64;
    /// Exact, from unsigned
    F64FromU32 = "f64_from_i32_u": I32 -> F64;
    /// To nearest
    F64FromI64 = "f64_from_i64_s": I64 -> F64;
    /// To nearest, from unsigned
    F64FromU64 = "f64_from_i64_u": I64 -> F64;
    /// Exact
    F64FromF32 = "f64_from_f32": F32 -> F64;
    /// To nearest
    F32FromF64 = "f32_from_f64": F64 -> F32;
    /// Toward zero, saturating
    I32FromF32 = "i32_from_f32_s": F32 -> I32;
    /// Toward zero, modulo 2³²
    U32FromF32 = "i32_from_f32_u": F32 -> I32;
    /// Toward zero, saturating
    I32FromF64 = "i32_from_f64_s": F64 -> I32;
    /// Toward zero, modulo 2³²
    U32FromF64 = "i32_from_f64_u": F64 -> I32;
    /// Toward zero, saturating
    I64FromF64 = "i64_from_f64_s": F64 -> I64;
    /// Toward zero, modulo 2⁶⁴
    U64FromF64 = "i64_from_f64_u": F64 -> I64;
}

/// How many bytes a load or store moves and how a load widens them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// A byte, sign-extended by a load.
    I8,
    /// A byte, zero-extended by a load.
    U8,
    /// Two bytes, sign-extended by a load.
    I16,
    /// Two bytes, zero-extended by a load.
    U16,
    /// A 32-bit integer.
    I32,
    /// A 64-bit integer.
    I64,
    /// A single.
    F32,
    /// A double.
    F64,
}

impl Width {
    /// The class of the value in a register.
    #[must_use]
    pub const fn class(self) -> Class {
        match self {
            Self::I8 | Self::U8 | Self::I16 | Self::U16 | Self::I32 => Class::I32,
            Self::I64 => Class::I64,
            Self::F32 => Class::F32,
            Self::F64 => Class::F64,
        }
    }

    /// Bytes in memory.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::F32 => 4,
            Self::I64 | Self::F64 => 8,
        }
    }

    /// The conversion that makes an `I32` value what a load of this width would give; `None` for full widths.
    #[must_use]
    pub const fn normalize(self) -> Option<ConvertOp> {
        match self {
            Self::I8 => Some(ConvertOp::SignExtend8),
            Self::U8 => Some(ConvertOp::ZeroExtend8),
            Self::I16 => Some(ConvertOp::SignExtend16),
            Self::U16 => Some(ConvertOp::ZeroExtend16),
            Self::I32 | Self::I64 | Self::F32 | Self::F64 => None,
        }
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::I8 => "i8",
            Self::U8 => "u8",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}
