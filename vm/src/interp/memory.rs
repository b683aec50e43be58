//! Loads, stores, and operations on blocks of memory.

use kmotiondef::GuestAddr;

use super::activation::Activation;
use crate::firmware::Firmware;
use crate::operand::{Addr, Count, Imm, Off, RegF32, RegF64, RegI32, RegI64};
use crate::trap::TrapKind;

/// Loads and stores in both address modes: what lies in memory, and the value of the register.
macro_rules! accesses {
    (loads { $($load:ident, $load_at:ident: $from:ty => $dst:ident as $value:ty;)* }
     stores { $($store:ident, $store_at:ident: $src:ident => $to:ty;)* }) => {
        impl<F: Firmware + ?Sized> Activation<'_, '_, F> {
            $(#[inline(always)]
            pub(super) fn $load(&mut self, dst: $dst, base: RegI32, off: Off) -> Result<(), TrapKind> {
                let value: $from = self.slice.load(self.address(base, off))?;
                self.set(dst, value as $value);
                Ok(())
            }

            #[inline(always)]
            pub(super) fn $load_at(&mut self, dst: $dst, addr: Addr) -> Result<(), TrapKind> {
                let value: $from = self.slice.load(GuestAddr::new(addr.0))?;
                self.set(dst, value as $value);
                Ok(())
            })*

            $(#[inline(always)]
            pub(super) fn $store(&mut self, src: $src, base: RegI32, off: Off) -> Result<(), TrapKind> {
                let value = self.get(src) as $to;
                self.slice.store(self.address(base, off), value)
            }

            #[inline(always)]
            pub(super) fn $store_at(&mut self, src: $src, addr: Addr) -> Result<(), TrapKind> {
                let value = self.get(src) as $to;
                self.slice.store(GuestAddr::new(addr.0), value)
            })*
        }
    };
}
accesses! {
    loads {
        load_i8_s, load_i8_s_at: i8 => RegI32 as i32;
        load_i8_u, load_i8_u_at: u8 => RegI32 as i32;
        load_i16_s, load_i16_s_at: i16 => RegI32 as i32;
        load_i16_u, load_i16_u_at: u16 => RegI32 as i32;
        load_i32, load_i32_at: i32 => RegI32 as i32;
        load_i64, load_i64_at: i64 => RegI64 as i64;
        load_f32, load_f32_at: f32 => RegF32 as f32;
        load_f64, load_f64_at: f64 => RegF64 as f64;
    }
    stores {
        store_i8, store_i8_at: RegI32 => u8;
        store_i16, store_i16_at: RegI32 => u16;
        store_i32, store_i32_at: RegI32 => i32;
        store_i64, store_i64_at: RegI64 => i64;
        store_f32, store_f32_at: RegF32 => f32;
        store_f64, store_f64_at: RegF64 => f64;
    }
}

impl<F: Firmware + ?Sized> Activation<'_, '_, F> {
    #[inline(always)]
    pub(super) fn frame_addr(&mut self, dst: RegI32, offset: Imm) {
        self.set(dst, self.frame_address.wrapping_add_signed(offset.0).cast_signed());
    }

    #[inline(always)]
    pub(super) fn copy(&mut self, to: RegI32, src: RegI32, len: Count) -> Result<(), TrapKind> {
        let (to, from) = (self.pointer(to), self.pointer(src));
        self.slice.memory.copy(to, from, u32::from(len.0))
    }

    #[inline(always)]
    pub(super) fn clear(&mut self, to: RegI32, len: Count) -> Result<(), TrapKind> {
        let to = self.pointer(to);
        self.slice.memory.fill(to, 0, u32::from(len.0))
    }

    #[inline(always)]
    fn pointer(&self, register: RegI32) -> GuestAddr {
        GuestAddr::new(self.get(register).cast_unsigned())
    }

    #[inline(always)]
    fn address(&self, base: RegI32, off: Off) -> GuestAddr {
        GuestAddr::new(self.get(base).wrapping_add(i32::from(off.0)).cast_unsigned())
    }
}
