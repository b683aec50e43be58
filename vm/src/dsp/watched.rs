//! Memory, with an eye on stores among decoded packets.

use super::cache::Cache;
use super::idle::IdleDetector;
use super::memory::{Clock, Memory};
use crate::trap::TrapKind;

/// Memory, with an eye on stores among decoded packets.
pub(super) struct WatchedMemory<'a, M> {
    pub(super) inner: &'a mut M,
    cache: &'a Cache,
    idle: &'a mut IdleDetector,
    /// Addresses of decoded words that the packet has changed: a packet has at most two stores.
    pub(super) hits: [Option<u32>; 2],
}

impl<'a, M: Memory> WatchedMemory<'a, M> {
    #[inline(always)]
    pub(super) const fn new(inner: &'a mut M, cache: &'a Cache, idle: &'a mut IdleDetector) -> Self {
        Self { inner, cache, idle, hits: [None; 2] }
    }

    #[inline(always)]
    fn notice(&mut self, addr: u32) {
        if self.idle.is_watching {
            self.idle.store(addr & !3, self.inner.fetch(addr & !3));
        }
        if self.cache.is_code(addr) {
            self.hits = [Some(addr), self.hits[0]];
        }
    }
}

impl<M: Memory> Memory for WatchedMemory<'_, M> {
    fn fetch(&self, addr: u32) -> Option<u32> {
        self.inner.fetch(addr)
    }

    #[inline(always)]
    fn load8(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.inner.load8(addr, clock)
    }

    #[inline(always)]
    fn load16(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.inner.load16(addr, clock)
    }

    #[inline(always)]
    fn load32(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.inner.load32(addr, clock)
    }

    #[inline(always)]
    fn load64(&mut self, addr: u32, clock: &mut Clock) -> Result<u64, TrapKind> {
        self.inner.load64(addr, clock)
    }

    #[inline(always)]
    fn store8(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.notice(addr);
        self.inner.store8(addr, value, clock)
    }

    #[inline(always)]
    fn store16(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.notice(addr);
        self.inner.store16(addr, value, clock)
    }

    #[inline(always)]
    fn store32(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.notice(addr);
        self.inner.store32(addr, value, clock)
    }
}
