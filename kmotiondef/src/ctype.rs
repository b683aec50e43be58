//! C types of the board's interface, as constants and as Rust types.
//!
//! The tables of this crate spell C types as Rust types: `i32` for `int`, `f64` for
//! `double`, `*const Char` for `const char *`, `Volatile<i32>`, `[Chan; 8]`. [`GuestType`]
//! turns such a type into a [`CType`] constant with its size and alignment, so that layouts
//! are checked while this crate compiles and a typed place needs no cast.

use std::fmt;
use std::marker::PhantomData;

use crate::GuestAddr;

/// A C type of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CType {
    /// `void`
    Void,
    /// `char`, which is signed.
    Char,
    /// `signed char`
    SignedChar,
    /// `unsigned char`
    UnsignedChar,
    /// `short`
    Short,
    /// `unsigned short`
    UnsignedShort,
    /// `int`
    Int,
    /// `unsigned int`
    UnsignedInt,
    /// `long`, 32 bits.
    Long,
    /// `unsigned long`, 32 bits.
    UnsignedLong,
    /// `float`
    Float,
    /// `double`
    Double,
    /// A structure or other type that the header names: `CHAN`, `FILE`, `BOOL`, `size_t`, …
    Named(&'static str),
    /// A pointer.
    Pointer(&'static CType),
    /// A `const` type.
    Const(&'static CType),
    /// A `volatile` type.
    Volatile(&'static CType),
    /// An array and its number of elements.
    Array(&'static CType, u32),
    /// A function.
    Function {
        /// The type of its result.
        result: &'static CType,
        /// The types of its parameters.
        params: &'static [CType],
    },
}

/// The names the header gives to types that are not structures.
pub const TYPEDEFS: &[(&str, CType)] = &[
    ("BOOL", CType::Int),
    ("FILE", CType::Int),
    ("size_t", CType::UnsignedInt),
    ("USERCALLBACK", CType::Function { result: &CType::Void, params: &[] }),
];

/// The kind of register that carries a value between a program and the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueClass {
    /// An integer of at most 32 bits, or an address.
    I32,
    /// A 64-bit integer.
    I64,
    /// A `float`.
    F32,
    /// A `double`.
    F64,
}

impl CType {
    /// The type without qualifiers and typedef names; a structure stays `Named`.
    #[must_use]
    pub fn resolved(self) -> Self {
        match self {
            Self::Const(inner) | Self::Volatile(inner) => inner.resolved(),
            Self::Named(name) => {
                TYPEDEFS.iter().find(|(typedef, _)| *typedef == name).map_or(self, |(_, ty)| *ty)
            }
            _ => self,
        }
    }

    /// The class in which a value of the type is passed; `None` for `void`, structures, arrays and functions.
    #[must_use]
    pub fn class(self) -> Option<ValueClass> {
        match self.resolved() {
            Self::Float => Some(ValueClass::F32),
            Self::Double => Some(ValueClass::F64),
            Self::Void | Self::Named(_) | Self::Array(..) | Self::Function { .. } => None,
            _ => Some(ValueClass::I32),
        }
    }

    /// A C declaration of `name` with this type; of the bare type if the name is empty.
    #[must_use]
    pub fn declare(&self, name: &str) -> String {
        match self {
            Self::Pointer(target) => target.declare(&match target {
                Self::Array(..) | Self::Function { .. } => format!("(*{name})"),
                _ => format!("*{name}"),
            }),
            Self::Const(Self::Pointer(target)) => target.declare(&format!("* const {name}")),
            Self::Volatile(Self::Pointer(target)) => target.declare(&format!("* volatile {name}")),
            Self::Const(inner) => format!("const {}", inner.declare(name)),
            Self::Volatile(inner) => format!("volatile {}", inner.declare(name)),
            Self::Array(element, count) => element.declare(&format!("{name}[{count}]")),
            Self::Function { result, params } => {
                let params: Vec<_> = params.iter().map(ToString::to_string).collect();
                let params = if params.is_empty() { "void".to_owned() } else { params.join(", ") };
                result.declare(&format!("{name}({params})"))
            }
            _ if name.is_empty() => self.word().to_owned(),
            _ => format!("{} {name}", self.word()),
        }
    }

    /// The spelling of a type that is not derived from another.
    const fn word(self) -> &'static str {
        match self {
            Self::Char => "char",
            Self::SignedChar => "signed char",
            Self::UnsignedChar => "unsigned char",
            Self::Short => "short",
            Self::UnsignedShort => "unsigned short",
            Self::Int => "int",
            Self::UnsignedInt => "unsigned int",
            Self::Long => "long",
            Self::UnsignedLong => "unsigned long",
            Self::Float => "float",
            Self::Double => "double",
            Self::Named(name) => name,
            _ => "void",
        }
    }
}

impl fmt::Display for CType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.declare(""))
    }
}

/// The meaning of an argument beyond its C type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A value that the C type describes.
    Value,
    /// The number of an axis.
    Axis,
    /// The number of an input or output bit.
    Bit,
    /// The number of a user thread.
    Thread,
    /// The format of a function that prints.
    PrintFormat,
    /// The format of a function that scans.
    ScanFormat,
    /// The name of a file on the PC.
    FileName,
    /// A number from minus this to this.
    Within(i32),
}

/// A Rust type that represents a C type of the interface.
pub trait GuestType {
    /// The C type.
    const C_TYPE: CType;
    /// Its size in bytes.
    const SIZE: u32;
    /// Its alignment in bytes.
    const ALIGN: u32;
    /// The meaning of an argument of this type.
    const ROLE: Role = Role::Value;
}

/// A [`GuestType`] that is loaded and stored as one value.
pub trait Scalar: GuestType {
    /// The value in Rust.
    type Value: Plain;
}

/// A value as the bytes of guest memory hold it, in the low bytes of a word.
pub trait Plain: Copy {
    /// The value from its bytes; those above its size do not matter.
    fn from_bits(bits: u64) -> Self;
    /// The bytes of the value, zero above its size.
    fn into_bits(self) -> u64;
}

macro_rules! plain_integers {
    ($($ty:ty as $unsigned:ty),*) => {$(
        impl Plain for $ty {
            #[inline]
            fn from_bits(bits: u64) -> Self {
                bits as Self
            }

            #[inline]
            fn into_bits(self) -> u64 {
                u64::from(self as $unsigned)
            }
        }
    )*};
}
plain_integers!(i8 as u8, u8 as u8, i16 as u16, u16 as u16, i32 as u32, u32 as u32);

impl Plain for f32 {
    #[inline]
    fn from_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }

    #[inline]
    fn into_bits(self) -> u64 {
        u64::from(self.to_bits())
    }
}

impl Plain for f64 {
    #[inline]
    fn from_bits(bits: u64) -> Self {
        Self::from_bits(bits)
    }

    #[inline]
    fn into_bits(self) -> u64 {
        self.to_bits()
    }
}

impl Plain for GuestAddr {
    #[inline]
    fn from_bits(bits: u64) -> Self {
        Self::new(bits as u32)
    }

    #[inline]
    fn into_bits(self) -> u64 {
        u64::from(self.get())
    }
}

macro_rules! scalars {
    ($($ty:ty as $value:ty = $c_type:expr, $size:literal;)*) => {$(
        impl GuestType for $ty {
            const C_TYPE: CType = $c_type;
            const SIZE: u32 = $size;
            const ALIGN: u32 = $size;
        }

        impl Scalar for $ty {
            type Value = $value;
        }
    )*};
}

/// `char`
#[derive(Debug)]
pub enum Char {}
/// `long`
#[derive(Debug)]
pub enum Long {}
/// `unsigned long`
#[derive(Debug)]
pub enum UnsignedLong {}
/// `BOOL`, an int.
#[derive(Debug)]
pub enum Bool {}
/// `FILE`, an int.
#[derive(Debug)]
pub enum File {}
/// `size_t`, an unsigned int.
#[derive(Debug)]
pub enum SizeT {}

scalars! {
    i8 as i8 = CType::SignedChar, 1;
    u8 as u8 = CType::UnsignedChar, 1;
    i16 as i16 = CType::Short, 2;
    u16 as u16 = CType::UnsignedShort, 2;
    i32 as i32 = CType::Int, 4;
    u32 as u32 = CType::UnsignedInt, 4;
    f32 as f32 = CType::Float, 4;
    f64 as f64 = CType::Double, 8;
    Char as i8 = CType::Char, 1;
    Long as i32 = CType::Long, 4;
    UnsignedLong as u32 = CType::UnsignedLong, 4;
    Bool as i32 = CType::Named("BOOL"), 4;
    File as i32 = CType::Named("FILE"), 4;
    SizeT as u32 = CType::Named("size_t"), 4;
}

/// `void`
#[derive(Debug)]
pub enum Void {}

impl GuestType for Void {
    const C_TYPE: CType = CType::Void;
    const SIZE: u32 = 1;
    const ALIGN: u32 = 1;
}

/// `USERCALLBACK`, a function without parameters and result.
#[derive(Debug)]
pub enum UserCallback {}

impl GuestType for UserCallback {
    const C_TYPE: CType = CType::Named("USERCALLBACK");
    const SIZE: u32 = 1;
    const ALIGN: u32 = 1;
}

/// A `const` type.
#[derive(Debug)]
pub struct Const<T>(PhantomData<T>);

impl<T: GuestType> GuestType for Const<T> {
    const C_TYPE: CType = CType::Const(&T::C_TYPE);
    const SIZE: u32 = T::SIZE;
    const ALIGN: u32 = T::ALIGN;
}

impl<T: Scalar> Scalar for Const<T> {
    type Value = T::Value;
}

/// A `volatile` type.
#[derive(Debug)]
pub struct Volatile<T>(PhantomData<T>);

impl<T: GuestType> GuestType for Volatile<T> {
    const C_TYPE: CType = CType::Volatile(&T::C_TYPE);
    const SIZE: u32 = T::SIZE;
    const ALIGN: u32 = T::ALIGN;
}

impl<T: Scalar> Scalar for Volatile<T> {
    type Value = T::Value;
}

impl<T: GuestType> GuestType for *mut T {
    const C_TYPE: CType = CType::Pointer(&T::C_TYPE);
    const SIZE: u32 = 4;
    const ALIGN: u32 = 4;
}

impl<T: GuestType> Scalar for *mut T {
    type Value = GuestAddr;
}

impl<T: GuestType> GuestType for *const T {
    const C_TYPE: CType = CType::Pointer(&CType::Const(&T::C_TYPE));
    const SIZE: u32 = 4;
    const ALIGN: u32 = 4;
}

impl<T: GuestType> Scalar for *const T {
    type Value = GuestAddr;
}

impl<T: GuestType, const N: usize> GuestType for [T; N] {
    const C_TYPE: CType = CType::Array(&T::C_TYPE, N as u32);
    const SIZE: u32 = T::SIZE * N as u32;
    const ALIGN: u32 = T::ALIGN;
}

macro_rules! function_pointers {
    ($(fn($($param:ident),*);)*) => {$(
        impl<$($param: GuestType,)* R: GuestType> GuestType for fn($($param),*) -> R {
            const C_TYPE: CType =
                CType::Pointer(&CType::Function { result: &R::C_TYPE, params: &[$($param::C_TYPE),*] });
            const SIZE: u32 = 4;
            const ALIGN: u32 = 4;
        }

        impl<$($param: GuestType,)* R: GuestType> Scalar for fn($($param),*) -> R {
            type Value = GuestAddr;
        }
    )*};
}

function_pointers! {
    fn();
    fn(A, B);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_read_as_c() {
        let check = |ty: CType, name: &str, expect: &str| assert_eq!(ty.declare(name), expect);
        check(<*const Char>::C_TYPE, "format", "const char *format");
        check(<*mut *mut Char>::C_TYPE, "end", "char **end");
        check(<*mut Volatile<u16>>::C_TYPE, "add", "volatile unsigned short *add");
        check(Volatile::<*mut Char>::C_TYPE, "p", "char * volatile p");
        check(<[[f32; 20]; 8]>::C_TYPE, "table", "float table[8][20]");
        check(<fn() -> Void>::C_TYPE, "fun", "void (*fun)(void)");
        check(<fn(*const Void, *const Void) -> i32>::C_TYPE, "", "int (*)(const void *, const void *)");
        check(<*mut File>::C_TYPE, "", "FILE *");
    }

    #[test]
    fn classes_see_through_names_and_qualifiers() {
        let check = |ty: CType, expect| assert_eq!(ty.class(), expect, "{ty}");
        check(Volatile::<f64>::C_TYPE, Some(ValueClass::F64));
        check(Bool::C_TYPE, Some(ValueClass::I32));
        check(<*mut f32>::C_TYPE, Some(ValueClass::I32));
        check(CType::Named("CHAN"), None);
        check(Void::C_TYPE, None);
    }

    #[test]
    fn values_round_trip_through_their_bytes() {
        assert_eq!(<i8 as Plain>::from_bits(0xff), -1);
        assert_eq!((-2i16).into_bits(), 0xfffe);
        assert_eq!(<f32 as Plain>::from_bits(1.5f32.into_bits()), 1.5);
    }
}
