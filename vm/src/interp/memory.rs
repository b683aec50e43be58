//! Loads, stores, and operations on blocks of memory.

use kmotiondef::GuestAddr;

use super::activation::{Activation, Exit, Flow};
use crate::kind::Width;
use crate::operand::{Addr, Count, Imm, Off, RegF32, RegF64, RegI32, RegI64};
use crate::slot::Slot;

/// Loads and stores in both address modes: the type in memory, and the type of the register.
macro_rules! accesses {
    (loads { $($load:ident, $load_at:ident: $load_width:ident, $from:ty => $dst:ident as $value:ty;)* }
     stores { $($store:ident, $store_at:ident: $store_width:ident, $src:ident => $to:ty;)* }) => {
        impl Activation<'_, '_> {
            $(#[inline(always)]
            pub(super) fn $load(&mut self, dst: $dst, base: RegI32, off: Off) -> Flow {
                let address = self.address(base, off);
                match self.state.ram.load_ram::<$from>(self.sdram, address) {
                    Some(value) => {
                        self.set(dst, value as $value);
                        Flow::Next
                    }
                    None => Flow::Leave(Exit::Load(address, Width::$load_width, dst.0)),
                }
            }

            #[inline(always)]
            pub(super) fn $load_at(&mut self, dst: $dst, addr: Addr) -> Flow {
                let address = GuestAddr::new(addr.0);
                match self.state.ram.load_ram::<$from>(self.sdram, address) {
                    Some(value) => {
                        self.set(dst, value as $value);
                        Flow::Next
                    }
                    None => Flow::Leave(Exit::Load(address, Width::$load_width, dst.0)),
                }
            })*

            $(#[inline(always)]
            pub(super) fn $store(&mut self, src: $src, base: RegI32, off: Off) -> Flow {
                let (address, value) = (self.address(base, off), self.get(src));
                match self.state.ram.store_ram(self.sdram, address, value as $to) {
                    Some(()) => Flow::Next,
                    None => Flow::Leave(Exit::Store(address, Width::$store_width, value.into_slot())),
                }
            }

            #[inline(always)]
            pub(super) fn $store_at(&mut self, src: $src, addr: Addr) -> Flow {
                let (address, value) = (GuestAddr::new(addr.0), self.get(src));
                match self.state.ram.store_ram(self.sdram, address, value as $to) {
                    Some(()) => Flow::Next,
                    None => Flow::Leave(Exit::Store(address, Width::$store_width, value.into_slot())),
                }
            })*
        }
    };
}
accesses! {
    loads {
        load_i8_s, load_i8_s_at: I8S, i8 => RegI32 as i32;
        load_i8_u, load_i8_u_at: I8U, u8 => RegI32 as i32;
        load_i16_s, load_i16_s_at: I16S, i16 => RegI32 as i32;
        load_i16_u, load_i16_u_at: I16U, u16 => RegI32 as i32;
        load_i32, load_i32_at: I32, i32 => RegI32 as i32;
        load_i64, load_i64_at: I64, i64 => RegI64 as i64;
        load_f32, load_f32_at: F32, f32 => RegF32 as f32;
        load_f64, load_f64_at: F64, f64 => RegF64 as f64;
    }
    stores {
        store_i8, store_i8_at: I8U, RegI32 => u8;
        store_i16, store_i16_at: I16U, RegI32 => u16;
        store_i32, store_i32_at: I32, RegI32 => i32;
        store_i64, store_i64_at: I64, RegI64 => i64;
        store_f32, store_f32_at: F32, RegF32 => f32;
        store_f64, store_f64_at: F64, RegF64 => f64;
    }
}

impl Activation<'_, '_> {
    #[inline(always)]
    pub(super) fn frame_addr(&mut self, dst: RegI32, offset: Imm) {
        self.set(dst, self.state.calls.frame_address().wrapping_add_signed(offset.0).cast_signed());
    }

    #[inline(always)]
    pub(super) fn copy(&mut self, to: RegI32, src: RegI32, len: Count) -> Exit {
        Exit::Copy { to: self.pointer(to), from: self.pointer(src), len: len.0 }
    }

    #[inline(always)]
    pub(super) fn clear(&mut self, to: RegI32, len: Count) -> Exit {
        Exit::Clear { to: self.pointer(to), len: len.0 }
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
