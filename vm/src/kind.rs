//! The kind of an instruction: one word of its row, from which every predicate over instructions follows.
//!
//! A predicate over instructions is a method of [`OpKind`] or an exhaustive match over it: a new kind is then a compile
//! error wherever a decision is needed.

use crate::operand::Class;

/// The access of a load or store: width and extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Width {
    /// 8 bits, sign-extended.
    I8S,
    /// 8 bits, zero-extended.
    I8U,
    /// 16 bits, sign-extended.
    I16S,
    /// 16 bits, zero-extended.
    I16U,
    /// 32 bits of an integer.
    I32,
    /// 64 bits of an integer.
    I64,
    /// A single.
    F32,
    /// A double.
    F64,
}

impl Width {
    /// All widths in the order of their numbers.
    pub const ALL: [Self; 8] =
        [Self::I8S, Self::I8U, Self::I16S, Self::I16U, Self::I32, Self::I64, Self::F32, Self::F64];

    /// Number of bytes.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::I8S | Self::I8U => 1,
            Self::I16S | Self::I16U => 2,
            Self::I32 | Self::F32 => 4,
            Self::I64 | Self::F64 => 8,
        }
    }
}

/// Defines the names of operands that are requested by name.
macro_rules! operand_names {
    ($($(#[doc = $doc:literal])+ $name:ident = $text:literal,)*) => {
        /// A name of operands in the rows, for operands that are looked up by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Name {
            $($(#[doc = $doc])+ $name,)*
        }

        impl Name {
            /// All names.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The name as the rows spell it.
            #[must_use]
            pub const fn text(self) -> &'static str {
                match self {
                    $(Self::$name => $text,)*
                }
            }
        }
    };
}

operand_names! {
    /// A constant address.
    Addr = "addr",
    /// The register with the address of an access.
    Base = "base",
    /// The bits of a single.
    Bits = "bits",
    /// The register that is assigned.
    Dst = "dst",
    /// The function that is called.
    Func = "func",
    /// The number of an argument.
    Index = "index",
    /// The number of branches of a table, less one.
    Count = "n",
    /// The number of bytes of a block.
    Len = "len",
    /// The displacement of an access.
    Off = "off",
    /// The place of a double in the pool.
    Pool = "pool",
    /// The signature of a call.
    Sig = "sig",
    /// The register that is copied.
    Src = "src",
    /// The target of a branch, or the destination of a block.
    To = "to",
}

/// The kinds of instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpKind {
    /// Describes the program; never executed.
    Structure,
    /// Spends cycles, and is where the processor can be lost.
    Charge,
    /// Assigns a constant.
    Constant,
    /// Assigns the bits of another register.
    Move,
    /// Assigns the address of a local.
    Address,
    /// Computes; a NaN result is the canonical NaN of arithmetic.
    Arithmetic,
    /// Changes only the sign.
    Negation,
    /// Computes a value of another class; a NaN result is the canonical NaN of arithmetic.
    Conversion,
    /// Loads: from `base + off`, or from `addr`.
    Load(Width),
    /// Stores: to `base + off`, or to `addr`.
    Store(Width),
    /// Writes to many bytes of memory.
    Block,
    /// Goes to `to`.
    Jump,
    /// Goes to `to` or on with the next word.
    Branch,
    /// Goes on at one of the jumps that follow.
    Table,
    /// Passes an argument to the call that follows.
    Argument(Class),
    /// Calls a function.
    Call,
    /// Takes the result of the previous call.
    Result(Class),
    /// Returns, possibly with a value of this class.
    Return(Option<Class>),
    /// Stops the program.
    Stop,
}

impl OpKind {
    /// Reports whether execution never continues with the next word.
    #[must_use]
    pub const fn ends_path(self) -> bool {
        match self {
            Self::Jump | Self::Return(_) | Self::Stop => true,
            Self::Structure
            | Self::Charge
            | Self::Constant
            | Self::Move
            | Self::Address
            | Self::Arithmetic
            | Self::Negation
            | Self::Conversion
            | Self::Load(_)
            | Self::Store(_)
            | Self::Block
            | Self::Branch
            | Self::Table
            | Self::Argument(_)
            | Self::Call
            | Self::Result(_) => false,
        }
    }

    /// Reports whether execution simply continues with the next word, and the word does not belong to a call.
    #[must_use]
    pub const fn is_straight(self) -> bool {
        match self {
            Self::Structure
            | Self::Constant
            | Self::Move
            | Self::Address
            | Self::Arithmetic
            | Self::Negation
            | Self::Conversion
            | Self::Load(_)
            | Self::Store(_)
            | Self::Block => true,
            Self::Charge
            | Self::Jump
            | Self::Branch
            | Self::Table
            | Self::Argument(_)
            | Self::Call
            | Self::Result(_)
            | Self::Return(_)
            | Self::Stop => false,
        }
    }

    /// The width of the access between memory and a register.
    #[must_use]
    pub const fn width(self) -> Option<Width> {
        match self {
            Self::Load(width) | Self::Store(width) => Some(width),
            Self::Structure
            | Self::Charge
            | Self::Constant
            | Self::Move
            | Self::Address
            | Self::Arithmetic
            | Self::Negation
            | Self::Conversion
            | Self::Block
            | Self::Jump
            | Self::Branch
            | Self::Table
            | Self::Argument(_)
            | Self::Call
            | Self::Result(_)
            | Self::Return(_)
            | Self::Stop => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::for_each_op;

    macro_rules! define_fields {
        ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
            const FIELDS: &[&str] = &[$($(stringify!($field),)*)*];
        };
    }

    for_each_op!(define_fields);

    #[test]
    fn each_name_is_that_of_an_operand() {
        for name in Name::ALL {
            assert!(FIELDS.contains(&name.text()), "{name:?}");
        }
    }
}
