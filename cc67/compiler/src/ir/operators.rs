//! Operators, comparisons, conversions and widths of memory accesses.
//!
//! Operators include signedness where it matters, as the machine's instructions do. `>` and `>=` do not exist: their
//! operands are swapped when the comparison is built. The properties of an operator that passes and back ends need are
//! in its row.

use super::inst::Class;
use crate::operators::{self, for_each_binary_op};

/// An enum whose variants have names in the text form.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident { $($(#[$variant_doc:meta])* $variant:ident = $name:literal;)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $type {
            $($(#[$variant_doc])* $variant,)*
        }

        impl $type {
            /// Every one, in the order of the table.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The name in the text form.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// The one with this name in the text form.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}
pub(super) use named;

named! {
    /// Operators on one value.
    UnaryOp {
        /// `-a`, wrapping for integers
        Negate = "neg";
        /// `~a`, integers
        Complement = "not";
    }
}

impl UnaryOp {
    /// Reports whether the operator exists on values of a class.
    #[must_use]
    pub const fn works_on(self, class: Class) -> bool {
        match self {
            Self::Negate => true,
            Self::Complement => class.is_integer(),
        }
    }
}

/// The classes of an operator's operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Domain {
    /// Both of the class of the result.
    Any,
    /// Both of the class of the result, which is an integer one.
    Integer,
    /// An integer of the class of the result, and a count of class `I32`.
    Shift,
}

/// The properties of an operator, from its row.
#[derive(Clone, Copy, Debug)]
struct Facts {
    domain: Domain,
    /// The operands can change places.
    commutative: bool,
    /// The second operand divides the first.
    divides: bool,
}

macro_rules! binary_operators {
    ($($(#[$doc:meta])* $variant:ident = $name:literal: $domain:ident $($fact:ident)*;)*) => {
        named! {
            /// Operators on two values of one class; a shift count is always `I32`.
            BinaryOp { $($(#[$doc])* $variant = $name;)* }
        }

        impl BinaryOp {
            const fn facts(self) -> Facts {
                match self {
                    $(Self::$variant => Facts {
                        $($fact: true,)*
                        ..Facts { domain: Domain::$domain, commutative: false, divides: false }
                    },)*
                }
            }
        }
    };
}

binary_operators! {
    /// `a + b`
    Add = "add": Any commutative;
    /// `a - b`
    Subtract = "sub": Any;
    /// `a * b`
    Multiply = "mul": Any commutative;
    /// `a / b`, floating or signed toward zero
    Divide = "div": Any divides;
    /// `a / b`, unsigned
    DivideUnsigned = "div_u": Integer divides;
    /// `a % b` with the sign of `a`
    Remainder = "rem": Integer divides;
    /// `a % b`, unsigned
    RemainderUnsigned = "rem_u": Integer divides;
    /// `a & b`
    And = "and": Integer commutative;
    /// `a | b`
    Or = "or": Integer commutative;
    /// `a ^ b`
    Xor = "xor": Integer commutative;
    /// `a << b`, the count modulo 64
    ShiftLeft = "shl": Shift;
    /// `a >> b`, arithmetic, the count modulo 64
    ShiftRight = "shr": Shift;
    /// `a >> b`, logical, the count modulo 64
    ShiftRightUnsigned = "shr_u": Shift;
}

macro_rules! machine_operators {
    ($(
        #[doc = $doc:literal]
        $op:ident $text:literal = $machine:ident $signed:expr
            $(, unsigned $machine_unsigned:ident $unsigned:expr)? $(, exact $exact:expr)?;
    )*) => {
        impl BinaryOp {
            /// The machine's operator for an operation of C.
            #[must_use]
            pub(crate) const fn of(op: operators::BinaryOp, is_unsigned: bool) -> Self {
                match op {
                    $($(operators::BinaryOp::$op if is_unsigned => Self::$machine_unsigned,)?
                    operators::BinaryOp::$op => Self::$machine,)*
                }
            }
        }
    };
}

for_each_binary_op!(machine_operators);

impl BinaryOp {
    /// Reports whether the operator exists on values of a class.
    #[must_use]
    pub const fn works_on(self, class: Class) -> bool {
        match self.facts().domain {
            Domain::Any => true,
            Domain::Integer | Domain::Shift => class.is_integer(),
        }
    }

    /// Reports whether the second operand is a shift count.
    #[must_use]
    pub const fn is_shift(self) -> bool {
        match self.facts().domain {
            Domain::Any | Domain::Integer => false,
            Domain::Shift => true,
        }
    }

    /// Reports whether the operands can be swapped.
    #[must_use]
    pub const fn is_commutative(self) -> bool {
        self.facts().commutative
    }

    /// Reports whether a zero divisor traps, so that the instruction must stay; floating division never does.
    #[must_use]
    pub const fn may_trap(self, class: Class) -> bool {
        class.is_integer() && self.facts().divides
    }
}

named! {
    /// Comparisons; the result is `I32` 0 or 1, false for a NaN except `NotEqual`.
    CompareOp {
        /// `a == b`
        Equal = "eq";
        /// `a != b`
        NotEqual = "ne";
        /// `a < b`, floating or signed
        Less = "lt";
        /// `a <= b`, floating or signed
        LessEqual = "le";
        /// `a < b`, unsigned
        LessUnsigned = "lt_u";
        /// `a <= b`, unsigned
        LessEqualUnsigned = "le_u";
    }
}

impl CompareOp {
    /// Reports whether the operands can be swapped.
    #[must_use]
    pub const fn is_symmetric(self) -> bool {
        match self {
            Self::Equal | Self::NotEqual => true,
            Self::Less | Self::LessEqual | Self::LessUnsigned | Self::LessEqualUnsigned => false,
        }
    }
}

macro_rules! conversions {
    ($($(#[$doc:meta])* $variant:ident = $name:literal: $from:ident -> $to:ident;)*) => {
        named! {
            /// Conversions between classes, and the narrowing of integers within `I32`.
            ConvertOp { $($(#[$doc])* $variant = $name;)* }
        }

        impl ConvertOp {
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

named! {
    /// The width of a load or store, and the extension by a load.
    Width {
        /// A byte, sign-extended by a load.
        I8 = "i8";
        /// A byte, zero-extended by a load.
        U8 = "u8";
        /// Two bytes, sign-extended by a load.
        I16 = "i16";
        /// Two bytes, zero-extended by a load.
        U16 = "u16";
        /// A 32-bit integer.
        I32 = "i32";
        /// A 64-bit integer.
        I64 = "i64";
        /// A single.
        F32 = "f32";
        /// A double.
        F64 = "f64";
    }
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

    /// The conversion from an `I32` value to the result of a load of this width; `None` for full widths.
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
