//! Typed places in guest memory: where a variable or a field is, and what type it has.
//!
//! A place is a claim, as [`GuestAddr`] is: only guest memory turns it into a value. From
//! the place of a variable one walks to elements and fields without a cast and without an
//! offset in sight: `variables::CHAN.element(2).field(Chan::DEST)` is a `Place<f64>`.

use std::fmt;
use std::marker::PhantomData;

use crate::GuestAddr;
use crate::ctype::GuestType;

/// A field of a structure: its offset and type.
pub struct Field<T> {
    offset: u32,
    ty: PhantomData<fn() -> T>,
}

/// An object in guest memory: its address and type.
pub struct Place<T> {
    address: GuestAddr,
    ty: PhantomData<fn() -> T>,
}

impl<T> Field<T> {
    /// The field at `offset` bytes.
    #[must_use]
    #[inline]
    pub const fn new(offset: u32) -> Self {
        Self { offset, ty: PhantomData }
    }

    /// Bytes from the start of the structure.
    #[must_use]
    #[inline]
    pub const fn offset(self) -> u32 {
        self.offset
    }

    /// A field of this field, itself a structure.
    #[must_use]
    #[inline]
    pub const fn field<U>(self, inner: Field<U>) -> Field<U> {
        Field::new(self.offset + inner.offset)
    }
}

impl<T: GuestType, const N: usize> Field<[T; N]> {
    /// One element of an array. The caller has checked the index: the array does not.
    #[must_use]
    #[inline]
    pub const fn element(self, index: usize) -> Field<T> {
        debug_assert!(index < N);
        Field::new(self.offset + T::SIZE * index as u32)
    }
}

impl<T> Place<T> {
    /// The object at `address`.
    #[must_use]
    #[inline]
    pub const fn new(address: GuestAddr) -> Self {
        Self { address, ty: PhantomData }
    }

    /// The address.
    #[must_use]
    #[inline]
    pub const fn address(self) -> GuestAddr {
        self.address
    }

    /// A field of it, a structure.
    #[must_use]
    #[inline]
    pub const fn field<U>(self, field: Field<U>) -> Place<U> {
        Place::new(self.address.offset(field.offset))
    }
}

impl<T: GuestType, const N: usize> Place<[T; N]> {
    /// One element of an array. The caller has checked the index: the array does not.
    #[must_use]
    #[inline]
    pub const fn element(self, index: usize) -> Place<T> {
        debug_assert!(index < N);
        Place::new(self.address.offset(T::SIZE.wrapping_mul(index as u32)))
    }
}

// Derived implementations would require the same traits of the type parameter, which is only a marker.
impl<T> Clone for Field<T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Field<T> {}

impl<T> fmt::Debug for Field<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "+{}", self.offset)
    }
}

impl<T> Clone for Place<T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Place<T> {}

impl<T> fmt::Debug for Place<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.address, f)
    }
}
