//! Loads and stores: RAM directly, everything else by a request.
//!
//! Whether an access stays in a region is one comparison: the offset in the region, rotated right
//! by as many bits as an aligned offset has zeros, is below the number of places only if it is
//! inside and aligned. SDRAM is tried first, out of line then on-chip RAM. A store to SDRAM also
//! looks at the map of protected blocks. Where the address is a constant, all that is decided here.

use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use kmotiondef::map::{IRAM, PROGRAM_BASE, PROGRAM_LIMIT, Region, SDRAM};

use super::super::protected::BLOCK_BITS;
use super::super::request::{Reason, Width};
use super::super::state::State;
use super::{Register, Translator, offset, type_of};
use crate::operand::{Addr, Class, Count, Imm, Off, RegF32, RegF64, RegI32, RegI64};

/// Loads and stores in both address modes: what they move, and the register's class.
macro_rules! accesses {
    (loads { $($load:ident, $load_at:ident: $dst:ident = $load_width:ident;)* }
     stores { $($store:ident, $store_at:ident: $src:ident = $store_width:ident;)* }) => {
        impl Translator<'_, '_> {
            $(pub(super) fn $load(&mut self, dst: $dst, base: RegI32, off: Off) {
                let address = self.address(base, off);
                self.load(dst, address, Width::$load_width);
            }

            pub(super) fn $load_at(&mut self, dst: $dst, addr: Addr) {
                self.load_at(dst, addr, Width::$load_width);
            })*

            $(pub(super) fn $store(&mut self, src: $src, base: RegI32, off: Off) {
                let address = self.address(base, off);
                self.store(src, address, Width::$store_width);
            }

            pub(super) fn $store_at(&mut self, src: $src, addr: Addr) {
                self.store_at(src, addr, Width::$store_width);
            })*
        }
    };
}
accesses! {
    loads {
        load_i8_s, load_i8_s_at: RegI32 = I8S;
        load_i8_u, load_i8_u_at: RegI32 = I8U;
        load_i16_s, load_i16_s_at: RegI32 = I16S;
        load_i16_u, load_i16_u_at: RegI32 = I16U;
        load_i32, load_i32_at: RegI32 = I32;
        load_i64, load_i64_at: RegI64 = I64;
        load_f32, load_f32_at: RegF32 = F32;
        load_f64, load_f64_at: RegF64 = F64;
    }
    stores {
        store_i8, store_i8_at: RegI32 = I8U;
        store_i16, store_i16_at: RegI32 = I16U;
        store_i32, store_i32_at: RegI32 = I32;
        store_i64, store_i64_at: RegI64 = I64;
        store_f32, store_f32_at: RegF32 = F32;
        store_f64, store_f64_at: RegF64 = F64;
    }
}

/// The ways of an access: in SDRAM, in on-chip RAM when it is not there, and by a request.
struct AccessBlocks {
    fast: Block,
    elsewhere: Block,
    iram: Block,
    slow: Block,
}

impl Translator<'_, '_> {
    pub(super) fn frame_addr(&mut self, dst: RegI32, offset: Imm) {
        let address = self.builder.ins().iadd_imm_s(self.stack_pointer, i64::from(offset.0));
        self.set(dst, address);
    }

    pub(super) fn copy(&mut self, to: RegI32, src: RegI32, len: Count) {
        let (to, src) = (self.get(to), self.get(src));
        let to = self.builder.ins().uextend(types::I64, to);
        let src = self.builder.ins().uextend(types::I64, src);
        let upper = self.builder.ins().ishl_imm_u(src, 32);
        let addresses = self.builder.ins().bor(to, upper);
        let len = self.builder.ins().iconst(types::I64, i64::from(len.0));
        self.usual_request(Reason::Copy.code(), self.at, addresses, len);
    }

    pub(super) fn clear(&mut self, to: RegI32, len: Count) {
        let to = self.get(to);
        let to = self.builder.ins().uextend(types::I64, to);
        let len = self.builder.ins().iconst(types::I64, i64::from(len.0));
        self.usual_request(Reason::Clear.code(), self.at, to, len);
    }

    fn address(&mut self, base: RegI32, off: Off) -> Value {
        let base = self.get(base);
        self.builder.ins().iadd_imm_s(base, i64::from(off.0))
    }

    fn load<R: Register>(&mut self, dst: R, address: Value, width: Width) {
        let behind = self.builder.create_block();
        let result = self.builder.append_block_param(behind, type_of(R::CLASS));
        let blocks = self.access_blocks();
        let place = self.branch_if_inside(SDRAM, address, width, blocks.fast, blocks.elsewhere);

        self.enter(blocks.fast);
        let pointer = self.pointer(place, offset_of!(State, sdram));
        let value = self.load_guest(pointer, 0, width);
        self.builder.ins().jump(behind, &[value.into()]);

        self.enter_cold(blocks.elsewhere);
        let place = self.branch_if_inside(IRAM, address, width, blocks.iram, blocks.slow);

        self.enter_cold(blocks.iram);
        let pointer = self.pointer(place, offset_of!(State, iram));
        let value = self.load_guest(pointer, 0, width);
        self.builder.ins().jump(behind, &[value.into()]);

        self.enter_cold(blocks.slow);
        let value = self.request_load(R::CLASS, address, width);
        self.builder.ins().jump(behind, &[value.into()]);

        self.enter(behind);
        self.set(dst, result);
    }

    fn load_at<R: Register>(&mut self, dst: R, addr: Addr, width: Width) {
        let value = match ram_field(addr, width) {
            Some((field, place)) => {
                let base = self.load_pointer(field);
                self.load_guest(base, place, width)
            }
            None => {
                let address = self.builder.ins().iconst(types::I32, i64::from(addr.0));
                self.request_load(R::CLASS, address, width)
            }
        };
        self.set(dst, value);
    }

    fn store<R: Register>(&mut self, src: R, address: Value, width: Width) {
        let value = self.get(src);
        let (inside, behind) = (self.builder.create_block(), self.builder.create_block());
        let blocks = self.access_blocks();
        let place = self.branch_if_inside(SDRAM, address, width, inside, blocks.elsewhere);

        self.enter(inside);
        let block = self.builder.ins().ushr_imm_u(place, i64::from(BLOCK_BITS));
        let mark = self.pointer(block, offset_of!(State, protected));
        self.branch_if_protected(mark, 0, blocks.slow, blocks.fast);

        self.enter(blocks.fast);
        let pointer = self.pointer(place, offset_of!(State, sdram));
        self.store_guest(value, pointer, 0, width);
        self.builder.ins().jump(behind, &[]);

        self.enter_cold(blocks.elsewhere);
        let place = self.branch_if_inside(IRAM, address, width, blocks.iram, blocks.slow);

        self.enter_cold(blocks.iram);
        let pointer = self.pointer(place, offset_of!(State, iram));
        self.store_guest(value, pointer, 0, width);
        self.builder.ins().jump(behind, &[]);

        self.enter_cold(blocks.slow);
        self.request_store(R::CLASS, value, address, width);
        self.builder.ins().jump(behind, &[]);

        self.enter(behind);
    }

    fn store_at<R: Register>(&mut self, src: R, addr: Addr, width: Width) {
        let value = self.get(src);
        let address = self.builder.ins().iconst(types::I32, i64::from(addr.0));
        let Some((field, place)) = ram_field(addr, width) else {
            return self.request_store(R::CLASS, value, address, width);
        };
        if !(PROGRAM_BASE..PROGRAM_LIMIT).contains(&addr.0) {
            let base = self.load_pointer(field);
            return self.store_guest(value, base, place, width);
        }
        let (fast, slow, behind) =
            (self.builder.create_block(), self.builder.create_block(), self.builder.create_block());
        let marks = self.load_pointer(offset_of!(State, protected));
        self.branch_if_protected(marks, place >> BLOCK_BITS, slow, fast);

        self.enter(fast);
        let base = self.load_pointer(field);
        self.store_guest(value, base, place, width);
        self.builder.ins().jump(behind, &[]);

        self.enter_cold(slow);
        self.request_store(R::CLASS, value, address, width);
        self.builder.ins().jump(behind, &[]);

        self.enter(behind);
    }

    fn access_blocks(&mut self) -> AccessBlocks {
        AccessBlocks {
            fast: self.builder.create_block(),
            elsewhere: self.builder.create_block(),
            iram: self.builder.create_block(),
            slow: self.builder.create_block(),
        }
    }

    /// Goes to `inside` if an access of `address` stays in `region` and is aligned, else to `outside`;
    /// yields the offset in the region.
    fn branch_if_inside(
        &mut self,
        region: Region,
        address: Value,
        width: Width,
        inside: Block,
        outside: Block,
    ) -> Value {
        let base = i64::from(region.base.get().cast_signed());
        let place = self.builder.ins().iadd_imm_s(address, base.wrapping_neg());
        let zeros = width.bytes().ilog2();
        let rotated = match zeros {
            0 => place,
            _ => self.builder.ins().rotr_imm_u(place, i64::from(zeros)),
        };
        let places = i64::from(region.size >> zeros);
        let fits = self.builder.ins().icmp_imm_u(IntCC::UnsignedLessThan, rotated, places);
        self.builder.ins().brif(fits, inside, &[], outside, &[]);
        place
    }

    /// Goes to `slow` if the mark at `marks + place` is set, else to `fast`.
    fn branch_if_protected(&mut self, marks: Value, place: i32, slow: Block, fast: Block) {
        let mark = self.builder.ins().uload8(types::I32, self.state_flags, marks, place);
        self.builder.ins().brif(mark, slow, &[], fast, &[]);
    }

    /// `place` behind the pointer in a field of the state.
    fn pointer(&mut self, place: Value, field: usize) -> Value {
        let base = self.load_pointer(field);
        let place = self.builder.ins().uextend(types::I64, place);
        self.builder.ins().iadd(base, place)
    }

    fn load_guest(&mut self, pointer: Value, place: i32, width: Width) -> Value {
        let flags = self.guest_flags;
        match width {
            Width::I8S => self.builder.ins().sload8(types::I32, flags, pointer, place),
            Width::I8U => self.builder.ins().uload8(types::I32, flags, pointer, place),
            Width::I16S => self.builder.ins().sload16(types::I32, flags, pointer, place),
            Width::I16U => self.builder.ins().uload16(types::I32, flags, pointer, place),
            Width::I32 => self.builder.ins().load(types::I32, flags, pointer, place),
            Width::I64 => self.builder.ins().load(types::I64, flags, pointer, place),
            Width::F32 => self.builder.ins().load(types::F32, flags, pointer, place),
            Width::F64 => self.builder.ins().load(types::F64, flags, pointer, place),
        }
    }

    fn store_guest(&mut self, value: Value, pointer: Value, place: i32, width: Width) {
        let flags = self.guest_flags;
        match width {
            Width::I8S | Width::I8U => self.builder.ins().istore8(flags, value, pointer, place),
            Width::I16S | Width::I16U => self.builder.ins().istore16(flags, value, pointer, place),
            Width::I32 | Width::I64 | Width::F32 | Width::F64 => {
                self.builder.ins().store(flags, value, pointer, place)
            }
        };
    }

    fn request_load(&mut self, class: Class, address: Value, width: Width) -> Value {
        let address = self.builder.ins().uextend(types::I64, address);
        let none = self.builder.ins().iconst(types::I64, 0);
        let slot = self.request(Reason::Load.with_width(width), self.at, address, none);
        self.unslot(class, slot)
    }

    fn request_store(&mut self, class: Class, value: Value, address: Value, width: Width) {
        let address = self.builder.ins().uextend(types::I64, address);
        let slot = self.slot(class, value);
        self.request(Reason::Store.with_width(width), self.at, address, slot);
    }
}

/// Where an aligned access of the constant address `addr` goes, if that is RAM: the field of the
/// state that points to it, and the offset from there.
fn ram_field(addr: Addr, width: Width) -> Option<(usize, i32)> {
    let place_in = |region: Region| {
        let place = addr.0.wrapping_sub(region.base.get());
        (place.is_multiple_of(width.bytes()) && place < region.size).then(|| offset(place as usize))
    };
    let sdram = place_in(SDRAM).map(|place| (offset_of!(State, sdram), place));
    sdram.or_else(|| place_in(IRAM).map(|place| (offset_of!(State, iram), place)))
}
