//! A memory for tests: bytes by address, 0 where nothing was written.

use std::collections::BTreeMap;

use crate::dsp::{Clock, Memory};
use crate::trap::TrapKind;

/// Bytes of the whole address space.
#[derive(Clone, Debug, Default)]
pub(super) struct Flat(pub(super) BTreeMap<u32, u8>);

impl Flat {
    /// Writes words at `at` and the following addresses.
    pub(super) fn words(&mut self, at: u32, words: impl IntoIterator<Item = u32>) {
        for (address, word) in (at..).step_by(4).zip(words) {
            self.put::<4>(address, word);
        }
    }

    /// Writes bytes given as hexadecimal text.
    pub(super) fn hex(&mut self, at: u32, text: &str) {
        for (index, address) in (0..text.len()).step_by(2).zip(at..) {
            self.0.insert(address, u8::from_str_radix(&text[index..index + 2], 16).expect("a byte"));
        }
    }

    /// `len` bytes as hexadecimal text.
    pub(super) fn text(&self, at: u32, len: u32) -> String {
        (at..at + len).map(|address| format!("{:02x}", self.byte(address))).collect()
    }

    fn byte(&self, at: u32) -> u8 {
        self.0.get(&at).copied().unwrap_or(0)
    }

    fn get<const N: u32>(&self, at: u32) -> u64 {
        (0..N).rev().fold(0, |value, index| value << 8 | u64::from(self.byte(at + index)))
    }

    fn put<const N: usize>(&mut self, at: u32, value: u32) {
        for (address, byte) in (at..).zip(&value.to_le_bytes()[..N]) {
            self.0.insert(address, *byte);
        }
    }
}

impl Memory for Flat {
    fn fetch(&self, addr: u32) -> Option<u32> {
        Some(self.get::<4>(addr) as u32)
    }

    fn load8(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.get::<1>(addr) as u32)
    }

    fn load16(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.get::<2>(addr) as u32)
    }

    fn load32(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.get::<4>(addr) as u32)
    }

    fn load64(&mut self, addr: u32, _: &mut Clock) -> Result<u64, TrapKind> {
        Ok(self.get::<8>(addr))
    }

    fn store8(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.put::<1>(addr, value);
        Ok(())
    }

    fn store16(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.put::<2>(addr, value);
        Ok(())
    }

    fn store32(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.put::<4>(addr, value);
        Ok(())
    }
}
