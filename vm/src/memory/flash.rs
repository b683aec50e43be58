//! The bytes of flash memory, which take no host memory until something is written.

use std::sync::LazyLock;

use super::filled;

/// Bytes of flash memory.
pub(super) const SIZE: usize = 0x20_0000;

/// The value of an erased byte.
pub(super) const ERASED_BYTE: u8 = 0xff;

/// Erased flash, shared by all boards; filled on first use.
static ERASED: LazyLock<Box<[u8; SIZE]>> = LazyLock::new(|| filled(ERASED_BYTE));

/// Flash memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Flash(Option<Box<[u8; SIZE]>>);

impl Flash {
    /// All bytes.
    pub(super) fn bytes(&self) -> &[u8; SIZE] {
        self.0.as_deref().unwrap_or(&ERASED)
    }

    /// Reports whether nothing was ever written.
    pub(super) const fn is_erased(&self) -> bool {
        self.0.is_none()
    }

    /// All bytes, to be changed.
    pub(super) fn bytes_mut(&mut self) -> &mut [u8; SIZE] {
        self.0.get_or_insert_with(|| filled(ERASED_BYTE))
    }
}

impl PartialEq for Flash {
    fn eq(&self, other: &Self) -> bool {
        (self.0.is_none() && other.0.is_none()) || self.bytes() == other.bytes()
    }
}

impl Eq for Flash {}
