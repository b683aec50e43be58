//! Types of the target: kinds, sizes, conversions.
//!
//! Types are interned in [`Types`]; a [`TypeId`] is a number, equal numbers are equal types. `long` is `int`, an
//! enumeration is `int`, `long double` is `double` (specification, `dialect.md` 1.1); they are not separate types.
//! Qualifiers are kept next to the type.

pub mod class;
pub mod convert;
pub mod layout;
pub mod print;

use std::collections::BTreeMap;

use cranelift_entity::packed_option::PackedOption;
use cranelift_entity::{PrimaryMap, SecondaryMap, entity_impl};

use crate::ast::{Qualifiers, RecordKind};
use crate::names::Name;

/// A type.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeId(u32);
entity_impl!(TypeId, "type");

/// A structure or union; every definition is a distinct type.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RecordId(u32);
entity_impl!(RecordId, "record");

/// A type with its qualifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct QualifiedType {
    /// The type.
    pub ty: TypeId,
    /// `const`
    pub is_const: bool,
    /// `volatile`
    pub is_volatile: bool,
}

impl QualifiedType {
    /// A type without qualifiers.
    #[must_use]
    pub const fn plain(ty: TypeId) -> Self {
        Self { ty, is_const: false, is_volatile: false }
    }

    /// Returns the type with further qualifiers.
    #[must_use]
    pub const fn with(self, qualifiers: Qualifiers) -> Self {
        Self {
            ty: self.ty,
            is_const: self.is_const || qualifiers.is_const,
            is_volatile: self.is_volatile || qualifiers.is_volatile,
        }
    }
}

/// A type.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Type {
    /// `void`
    Void,
    /// `_Bool`
    Bool,
    /// `char`, signed
    Char,
    /// `signed char`
    SignedChar,
    /// `unsigned char`
    UnsignedChar,
    /// `short`
    Short,
    /// `unsigned short`
    UnsignedShort,
    /// `int`, `long`, enumerations
    Int,
    /// `unsigned`, `unsigned long`
    Unsigned,
    /// `long long`
    LongLong,
    /// `unsigned long long`
    UnsignedLongLong,
    /// `float`
    Float,
    /// `double`, `long double`
    Double,
    /// `T *`
    Pointer(QualifiedType),
    /// `T[n]`; `None` for `T[]`
    Array(QualifiedType, Option<u32>),
    /// A function.
    Function(FunctionType),
    /// `struct` or `union`
    Record(RecordId),
}

/// The type of a function.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FunctionType {
    /// The result.
    pub result: TypeId,
    /// The types of the parameters.
    pub parameters: ParameterTypes,
}

/// The parameters of a function type.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ParameterTypes {
    /// `()`: arguments are passed with the default promotions.
    Unspecified,
    /// A prototype.
    Prototype {
        /// The types, arrays and functions already turned into pointers.
        types: Vec<QualifiedType>,
        /// `...` ends the list.
        is_variadic: bool,
    },
}

/// A structure or union.
#[derive(Clone, Debug)]
pub struct Record {
    /// The kind: structure or union.
    pub kind: RecordKind,
    /// The tag, or the `typedef` name of an untagged one; for messages.
    pub name: Option<Name>,
    /// True if `name` is a tag.
    pub is_tagged: bool,
    /// Members and layout; `None` while only declared.
    pub layout: Option<Layout>,
}

/// The layout of a structure or union.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The members in order; members of anonymous members appear inside theirs.
    pub members: Vec<Member>,
    /// Size in bytes, a multiple of the alignment.
    pub size: u32,
    /// Alignment in bytes.
    pub align: u32,
}

/// A member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// The name; `None` for an anonymous structure or union.
    pub name: Option<Name>,
    /// Its type.
    pub ty: QualifiedType,
    /// Byte offset (of the storage unit, for a bit-field).
    pub offset: u32,
    /// Position and width of a bit-field in its unit.
    pub bits: Option<BitRange>,
}

/// The bits of a bit-field in its storage unit, which has the declared type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitRange {
    /// Lowest bit.
    pub shift: u8,
    /// Number of bits.
    pub width: u8,
}

/// Every type of a compilation.
#[derive(Debug)]
pub struct Types {
    types: PrimaryMap<TypeId, Type>,
    numbers: BTreeMap<Type, TypeId>,
    /// The plain pointer to a type: by far the most frequent question.
    pointers: SecondaryMap<TypeId, PackedOption<TypeId>>,
    records: PrimaryMap<RecordId, Record>,
}

macro_rules! basic_types {
    ($($name:ident = $variant:ident),* $(,)?) => {
        /// The types that are always there, as constants.
        impl Types {
            basic_types!(@constants 0; $($name = $variant,)*);

            /// The table with the predefined types.
            #[must_use]
            pub fn new() -> Self {
                let mut types = Self {
                    types: PrimaryMap::new(),
                    numbers: BTreeMap::new(),
                    pointers: SecondaryMap::new(),
                    records: PrimaryMap::new(),
                };
                $(
                    let id = types.intern(Type::$variant);
                    debug_assert_eq!(id, Self::$name);
                )*
                types
            }
        }
    };
    (@constants $n:expr; $name:ident = $variant:ident, $($rest:tt)*) => {
        #[doc = concat!("The type `", stringify!($variant), "`.")]
        pub const $name: TypeId = TypeId($n);
        basic_types!(@constants $n + 1; $($rest)*);
    };
    (@constants $n:expr;) => {};
}

basic_types! {
    VOID = Void,
    BOOL = Bool,
    CHAR = Char,
    SIGNED_CHAR = SignedChar,
    UNSIGNED_CHAR = UnsignedChar,
    SHORT = Short,
    UNSIGNED_SHORT = UnsignedShort,
    INT = Int,
    UNSIGNED = Unsigned,
    LONG_LONG = LongLong,
    UNSIGNED_LONG_LONG = UnsignedLongLong,
    FLOAT = Float,
    DOUBLE = Double,
}

impl Default for Types {
    fn default() -> Self {
        Self::new()
    }
}

impl Types {
    /// The number of a type, new if it was not seen before.
    pub fn intern(&mut self, ty: Type) -> TypeId {
        if let Some(id) = self.numbers.get(&ty) {
            return *id;
        }
        let id = self.types.push(ty.clone());
        self.numbers.insert(ty, id);
        id
    }

    /// Returns the type with this id.
    #[must_use]
    pub fn get(&self, id: TypeId) -> &Type {
        &self.types[id]
    }

    /// `T *` without qualifiers on `T`.
    pub fn pointer_to(&mut self, ty: TypeId) -> TypeId {
        if let Some(id) = self.pointers[ty].expand() {
            return id;
        }
        let id = self.intern(Type::Pointer(QualifiedType::plain(ty)));
        self.pointers[ty] = id.into();
        id
    }

    /// Adds a structure or union whose members follow later.
    pub fn add_record(&mut self, kind: RecordKind, name: Option<Name>) -> (RecordId, TypeId) {
        let record = self.records.push(Record { kind, name, is_tagged: name.is_some(), layout: None });
        (record, self.intern(Type::Record(record)))
    }

    /// Every structure and union.
    pub fn records(&self) -> impl Iterator<Item = (RecordId, &Record)> {
        self.records.iter()
    }

    /// A structure or union.
    #[must_use]
    pub fn record(&self, id: RecordId) -> &Record {
        &self.records[id]
    }

    /// A structure or union, to complete it.
    pub fn record_mut(&mut self, id: RecordId) -> &mut Record {
        &mut self.records[id]
    }
}
