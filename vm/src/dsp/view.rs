//! The memory and devices of a slice, as accessed by the processor.

use kmotiondef::{Cycles, GuestAddr};

use super::memory::{Clock, Memory};
use crate::engine::Slice;
use crate::firmware::Firmware;
use crate::kind::Width;
use crate::loaded::Image;
#[cfg(feature = "native")]
use crate::memory::GuestMemory;
use crate::trap::TrapKind;

/// The memory of a slice.
pub(super) struct View<'s, 'a, F: ?Sized>(pub(super) &'s mut Slice<'a, F>);

impl<F: Firmware + ?Sized> View<'_, '_, F> {
    /// A load outside RAM: from a device, or a trap. The processor waits while a device works.
    #[cold]
    fn load_elsewhere(&mut self, addr: u32, width: Width, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.0.budget = Cycles::new(clock.left());
        let value = self.0.load_slot(GuestAddr::new(addr), width)?;
        clock.set_left(self.0.budget.get());
        Ok(value as u32)
    }

    /// A store outside RAM.
    #[cold]
    fn store_elsewhere(
        &mut self,
        addr: u32,
        width: Width,
        value: u32,
        clock: &mut Clock,
    ) -> Result<(), TrapKind> {
        self.0.budget = Cycles::new(clock.left());
        self.0.store_slot(GuestAddr::new(addr), width, u64::from(value))?;
        clock.set_left(self.0.budget.get());
        Ok(())
    }
}

impl<F: Firmware + ?Sized> Memory for View<'_, '_, F> {
    #[cfg(feature = "native")]
    fn ram(&mut self) -> Option<&mut GuestMemory> {
        Some(self.0.memory)
    }

    fn fetch(&self, addr: u32) -> Option<u32> {
        Image::is_code(addr).then(|| self.0.memory.peek(GuestAddr::new(addr)))
    }

    #[inline(always)]
    fn load8(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.0.memory.load_ram::<u8>(GuestAddr::new(addr)) {
            Some(value) => Ok(u32::from(value)),
            None => self.load_elsewhere(addr, Width::I8U, clock),
        }
    }

    #[inline(always)]
    fn load16(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.0.memory.load_ram::<u16>(GuestAddr::new(addr)) {
            Some(value) => Ok(u32::from(value)),
            None => self.load_elsewhere(addr, Width::I16U, clock),
        }
    }

    #[inline(always)]
    fn load32(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        match self.0.memory.load_ram(GuestAddr::new(addr)) {
            Some(value) => Ok(value),
            None => self.load_elsewhere(addr, Width::I32, clock),
        }
    }

    #[inline(always)]
    fn load64(&mut self, addr: u32, clock: &mut Clock) -> Result<u64, TrapKind> {
        if let Some(value) = self.0.memory.load_ram(GuestAddr::new(addr)) {
            return Ok(value);
        }
        let low = self.load32(addr, clock)?;
        let high = self.load32(addr.wrapping_add(4), clock)?;
        Ok(u64::from(low) | u64::from(high) << 32)
    }

    #[inline(always)]
    fn store8(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.0.memory.store_ram(GuestAddr::new(addr), value as u8) {
            Some(()) => Ok(()),
            None => self.store_elsewhere(addr, Width::I8U, value, clock),
        }
    }

    #[inline(always)]
    fn store16(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.0.memory.store_ram(GuestAddr::new(addr), value as u16) {
            Some(()) => Ok(()),
            None => self.store_elsewhere(addr, Width::I16U, value, clock),
        }
    }

    #[inline(always)]
    fn store32(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        match self.0.memory.store_ram(GuestAddr::new(addr), value) {
            Some(()) => Ok(()),
            None => self.store_elsewhere(addr, Width::I32, value, clock),
        }
    }
}
