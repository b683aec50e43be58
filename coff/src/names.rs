//! Flags, classes and types: value and printed name in one row.

use std::fmt;

/// A newtype of an integer, with names for some values.
///
/// `flags` types print as the names of their bits, `values` types as the name of the whole value; unnamed bits or
/// values print as a number.
macro_rules! newtype_names {
    ($(#[$doc:meta])+ flags $name:ident($repr:ty) { $($rows:tt)* }) => {
        newtype_names!(@type [$(#[$doc])+] $name($repr) { $($rows)* });

        impl $name {
            /// Reports whether all bits of `other` are set.
            #[must_use]
            pub const fn contains(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }
        }

        impl std::ops::BitOr for $name {
            type Output = Self;
            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }
    };
    ($(#[$doc:meta])+ values $name:ident($repr:ty) { $($rows:tt)* }) => {
        newtype_names!(@type [$(#[$doc])+] $name($repr) { $($rows)* });

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match Self::NAMES.iter().find(|(value, _)| value == self) {
                    Some((_, name)) => f.pad(name),
                    None => f.pad(&self.0.to_string()),
                }
            }
        }
    };
    (@type [$($doc:tt)+] $name:ident($repr:ty) {
        $($(#[$row_doc:meta])+ $constant:ident = $value:literal $printed:literal;)*
    }) => {
        $($doc)+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        pub struct $name(pub $repr);

        impl $name {
            $($(#[$row_doc])+ pub const $constant: Self = Self($value);)*

            /// The named values and their names.
            const NAMES: &'static [(Self, &'static str)] = &[$((Self::$constant, $printed)),*];
        }
    };
}

newtype_names! {
    /// The processor for which an image was made.
    values Target(u16) {
        /// TMS320C6000: machine code that a board executes.
        C6000 = 0x0099 "C6000";
        /// cc67's bytecode. TI has not given this number to any processor, so no loader takes the bytecode for machine
        /// code.
        CC67 = 0x6701 "cc67";
    }
}

newtype_names! {
    /// Flags of a file (section 2).
    flags FileFlags(u16) {
        /// Relocations have been stripped.
        RELOCATIONS_STRIPPED = 0x0001 "RELFLG";
        /// There are no unresolved references.
        EXECUTABLE = 0x0002 "EXEC";
        /// Line numbers have been stripped.
        LINES_STRIPPED = 0x0004 "LNNO";
        /// Local symbols have been stripped.
        LOCALS_STRIPPED = 0x0008 "LSYMS";
        /// The target is little endian.
        LITTLE_ENDIAN = 0x0100 "LITTLE";
        /// The target is big endian.
        BIG_ENDIAN = 0x0200 "BIG";
        /// The flags that the vendor's tools write into every linked image.
        LINKED = 0x1143 "LINKED";
    }
}

newtype_names! {
    /// Flags of a section, and in bits 8 to 11 its alignment (section 4).
    flags SectionFlags(u32) {
        /// Not to be loaded: a dummy.
        DSECT = 0x01 "DSECT";
        /// Not to be loaded.
        NOLOAD = 0x02 "NOLOAD";
        /// Combined from other sections.
        GROUP = 0x04 "GROUP";
        /// Padding.
        PAD = 0x08 "PAD";
        /// Debug information or C initialisation records.
        COPY = 0x10 "COPY";
        /// Code.
        TEXT = 0x20 "TEXT";
        /// Initialised data.
        DATA = 0x40 "DATA";
        /// Uninitialised data.
        BSS = 0x80 "BSS";
    }
}

impl SectionFlags {
    /// Position of the logarithm of the alignment, in bits.
    const ALIGN_SHIFT: u32 = 8;

    /// The alignment in bytes.
    #[must_use]
    pub const fn align(self) -> u32 {
        1 << (self.0 >> Self::ALIGN_SHIFT & 0xF)
    }

    /// Returns the flags with the alignment `align`, a power of two of at most 32768.
    #[must_use]
    pub const fn with_align(self, align: u32) -> Self {
        Self(self.0 & !0xF00 | (align.trailing_zeros() & 0xF) << Self::ALIGN_SHIFT)
    }
}

impl fmt::Display for SectionFlags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_flags(f, self.0 & !0xF00, Self::NAMES.iter().map(|(flag, name)| (flag.0, *name)))?;
        write!(f, " align {}", self.align())
    }
}

impl fmt::Display for FileFlags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::LINKED {
            return f.write_str("LINKED");
        }
        let single = Self::NAMES.iter().filter(|(flag, _)| flag.0.is_power_of_two());
        write_flags(f, u32::from(self.0), single.map(|(flag, name)| (u32::from(flag.0), *name)))
    }
}

/// Writes the names of the set bits, and the unnamed bits as a number.
fn write_flags<'a>(
    f: &mut fmt::Formatter<'_>,
    bits: u32,
    names: impl Iterator<Item = (u32, &'a str)>,
) -> fmt::Result {
    let mut rest = bits;
    let mut separator = "";
    for (bit, name) in names.filter(|(bit, _)| bits & bit != 0) {
        write!(f, "{separator}{name}")?;
        separator = "|";
        rest &= !bit;
    }
    if rest != 0 || bits == 0 {
        write!(f, "{separator}{rest:#x}")?;
    }
    Ok(())
}

newtype_names! {
    /// The section that contains the value of a symbol: a number from 1, or one of these (section 6.1).
    values SectionNumber(i16) {
        /// None: the symbol is not defined.
        UNDEFINED = 0 "UNDEF";
        /// None: the value is absolute.
        ABSOLUTE = -1 "ABS";
        /// None: the symbol is for debuggers.
        DEBUG = -2 "DEBUG";
    }
}

newtype_names! {
    /// The storage class of a symbol (section 6.1).
    values StorageClass(u8) {
        /// None.
        NULL = 0 "NULL";
        /// Automatic variable.
        AUTO = 1 "AUTO";
        /// External symbol.
        EXTERNAL = 2 "EXT";
        /// Static symbol.
        STATIC = 3 "STAT";
        /// Register variable.
        REGISTER = 4 "REG";
        /// External definition.
        EXTERNAL_DEFINITION = 5 "EXTDEF";
        /// Label.
        LABEL = 6 "LABEL";
        /// Undefined label.
        UNDEFINED_LABEL = 7 "ULABEL";
        /// Member of a structure.
        MEMBER_OF_STRUCT = 8 "MOS";
        /// Argument of a function.
        ARGUMENT = 9 "ARG";
        /// Tag of a structure.
        STRUCT_TAG = 10 "STRTAG";
        /// Member of a union.
        MEMBER_OF_UNION = 11 "MOU";
        /// Tag of a union.
        UNION_TAG = 12 "UNTAG";
        /// Type definition.
        TYPEDEF = 13 "TPDEF";
        /// Undefined static symbol.
        UNDEFINED_STATIC = 14 "USTATIC";
        /// Tag of an enumeration.
        ENUM_TAG = 15 "ENTAG";
        /// Member of an enumeration.
        MEMBER_OF_ENUM = 16 "MOE";
        /// Argument in a register.
        REGISTER_ARGUMENT = 17 "REGPARM";
        /// Bit-field.
        FIELD = 18 "FIELD";
        /// Beginning or end of a block.
        BLOCK = 100 "BLOCK";
        /// Beginning or end of a function.
        FUNCTION = 101 "FCN";
        /// End of a structure.
        END_OF_STRUCT = 102 "EOS";
        /// Source file.
        FILE = 103 "FILE";
        /// Line number.
        LINE = 104 "LINE";
        /// Alias.
        ALIAS = 105 "ALIAS";
        /// Hidden external symbol.
        HIDDEN = 106 "HIDDEN";
        /// Physical end of a function.
        END_OF_FUNCTION = 255 "EFCN";
    }
}

newtype_names! {
    /// The type from which others are derived (section 6.1).
    values BaseType(u16) {
        /// None.
        NONE = 0 "none";
        /// Argument of a function.
        ARGUMENT = 1 "argument";
        /// `char`
        CHAR = 2 "char";
        /// `short`
        SHORT = 3 "short";
        /// `int`
        INT = 4 "int";
        /// `long`
        LONG = 5 "long";
        /// `float`
        FLOAT = 6 "float";
        /// `double`
        DOUBLE = 7 "double";
        /// Structure.
        STRUCT = 8 "struct";
        /// Union.
        UNION = 9 "union";
        /// Enumeration.
        ENUM = 10 "enum";
        /// Member of an enumeration.
        MEMBER_OF_ENUM = 11 "enumerator";
        /// `unsigned char`
        UNSIGNED_CHAR = 12 "unsigned char";
        /// `unsigned short`
        UNSIGNED_SHORT = 13 "unsigned short";
        /// `unsigned int`
        UNSIGNED_INT = 14 "unsigned int";
        /// `unsigned long`
        UNSIGNED_LONG = 15 "unsigned long";
    }
}

/// A step of deriving a type from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivation {
    /// A pointer to the other type.
    Pointer,
    /// A function that returns the other type.
    Function,
    /// An array of the other type.
    Array,
}

/// The type of a symbol: a base type and up to six derivations, the outermost in the lowest bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SymbolType(pub u16);

impl SymbolType {
    /// A base type without derivations.
    #[must_use]
    pub const fn new(base: BaseType) -> Self {
        Self(base.0 & 0xF)
    }

    /// The type derived from this one.
    #[must_use]
    pub const fn derived(self, derivation: Derivation) -> Self {
        let code = match derivation {
            Derivation::Pointer => 1,
            Derivation::Function => 2,
            Derivation::Array => 3,
        };
        Self((self.0 & !0xF) << 2 | code << 4 | self.0 & 0xF)
    }

    /// The base type of all derivations.
    #[must_use]
    pub const fn base(self) -> BaseType {
        BaseType(self.0 & 0xF)
    }

    /// The outermost derivation: the kind of the symbol itself.
    #[must_use]
    pub const fn outermost(self) -> Option<Derivation> {
        match self.0 >> 4 & 3 {
            0 => None,
            1 => Some(Derivation::Pointer),
            2 => Some(Derivation::Function),
            _ => Some(Derivation::Array),
        }
    }
}

impl fmt::Display for SymbolType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rest = *self;
        while let Some(derivation) = rest.outermost() {
            f.write_str(match derivation {
                Derivation::Pointer => "pointer to ",
                Derivation::Function => "function returning ",
                Derivation::Array => "array of ",
            })?;
            rest = Self(rest.0 >> 2 & !0xF | rest.0 & 0xF);
        }
        self.base().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_encoded_as_the_specification_says() {
        let int = SymbolType::new(BaseType::INT);
        let check = |ty: SymbolType, code, printed: &str| {
            assert_eq!(ty.0, code);
            assert_eq!(ty.to_string(), printed);
        };
        check(int.derived(Derivation::Function), 0x24, "function returning int");
        check(SymbolType::new(BaseType::STRUCT).derived(Derivation::Pointer), 0x18, "pointer to struct");
        check(
            int.derived(Derivation::Pointer).derived(Derivation::Function),
            0x64,
            "function returning pointer to int",
        );
    }

    #[test]
    fn flags_print_as_names_and_the_rest_as_a_number() {
        assert_eq!(SectionFlags(0x560).to_string(), "TEXT|DATA align 32");
        assert_eq!(SectionFlags(0x1080).to_string(), "BSS|0x1000 align 1");
        assert_eq!(SectionFlags::default().to_string(), "0x0 align 1");
        assert_eq!(FileFlags(0x1143).to_string(), "LINKED");
        assert_eq!(FileFlags(0x0106).to_string(), "EXEC|LNNO|LITTLE");
    }

    #[test]
    fn values_without_a_name_print_as_numbers() {
        assert_eq!(StorageClass(101).to_string(), "FCN");
        assert_eq!(StorageClass(99).to_string(), "99");
        assert_eq!(SectionNumber(3).to_string(), "3");
    }

    #[test]
    fn the_alignment_is_a_part_of_the_flags() {
        let flags = SectionFlags::TEXT | SectionFlags::DATA;
        assert_eq!(flags.with_align(32), SectionFlags(0x560));
        assert_eq!(flags.with_align(32).align(), 32);
        assert_eq!(flags.with_align(32).with_align(1), flags);
    }
}
