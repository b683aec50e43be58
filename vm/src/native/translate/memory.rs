//! Loads and stores: RAM directly, everything else by a request.
//!
//! One test decides whether an access is in a region: the offset in the region must have none of the bits that are 0 in
//! every aligned offset inside. SDRAM is tried first, then, out of line, on-chip RAM. A store to SDRAM also tests the
//! map of protected blocks. For a constant address, all of this is decided at translation.

use std::mem::offset_of;

use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use kmotiondef::map::{IRAM, PROGRAM_BASE, PROGRAM_LIMIT, Region, SDRAM};

use super::super::protected::BLOCK_BITS;
use super::super::request::Reason;
use super::super::state::State;
use super::observe::ObservedAddress;
use super::{Register, Translator, offset};
use crate::kind::{Name, Width};
use crate::op::Op;
use crate::operand::{Addr, Class, Count, Imm, Off, RegF32, RegF64, RegI32, RegI64};

/// Loads and stores in both address modes: the type in memory, and the register's class.
macro_rules! accesses {
    (loads { $($load:ident, $load_at:ident: $dst:ident = $load_width:ident;)* }
     stores { $($store:ident, $store_at:ident: $src:ident = $store_width:ident;)* }) => {
        impl Translator<'_, '_> {
            $(pub(super) fn $load(&mut self, dst: $dst, base: RegI32, off: Off) {
                self.load(dst, base, off, Width::$load_width);
            }

            pub(super) fn $load_at(&mut self, dst: $dst, addr: Addr) {
                self.load_at(dst, addr, Width::$load_width);
            })*

            $(pub(super) fn $store(&mut self, src: $src, base: RegI32, off: Off) {
                self.store(src, base, off, Width::$store_width);
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

const _: () = assert!(SDRAM.size.is_power_of_two() && SDRAM.base.get().is_multiple_of(SDRAM.size));
const _: () = assert!(IRAM.size.is_power_of_two() && IRAM.base.get().is_multiple_of(IRAM.size));

impl Translator<'_, '_> {
    pub(super) fn frame_addr(&mut self, dst: RegI32, offset: Imm) {
        let address = self.builder.ins().iadd_imm_s(self.frame.stack_pointer, i64::from(offset.0));
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

    /// The offset in SDRAM of the address `base + off`.
    pub(super) fn place(&mut self, base: RegI32, off: Off) -> Value {
        let base = self.get(base);
        let sdram = SDRAM.base.get().cast_signed();
        self.builder.ins().iadd_imm_s(base, i64::from(i32::from(off.0).wrapping_sub(sdram)))
    }

    fn load<R: Register>(&mut self, dst: R, base: RegI32, off: Off, width: Width) {
        if let Some((pointer, place)) = self.checked_place(base, width, false) {
            let value = self.load_guest(pointer, place, width);
            return self.set(dst, value);
        }
        if let Some(attempt) = self.calls.attempt {
            let value = self.load_in_attempt(attempt, base, off, width);
            return self.set(dst, value);
        }
        let observed = self.observed_address(base, off);
        let place = self.place(base, off);
        let [elsewhere, slow, behind] = self.access_blocks();
        let offset_in_sdram = self.builder.ins().uextend(types::I64, place);
        let bits = self.wrong_bits(SDRAM, place, width);
        self.builder.ins().brif(bits, elsewhere, &[], behind, &[offset_in_sdram.into()]);

        let address = self.elsewhere(place, width, false, [elsewhere, slow, behind]);

        self.enter_cold(slow);
        let address = self.builder.ins().uextend(types::I64, address);
        let none = self.builder.ins().iconst(types::I64, 0);
        self.request(Reason::Load.with_width(width), self.at, address, none);
        self.go_on_in_state(offset_of!(State, exchange.answer), behind);

        let pointer = self.enter_access(behind);
        let value = self.load_guest(pointer, 0, width);
        self.set(dst, value);
        self.observe(observed, R::CLASS, value, width);
    }

    fn load_at<R: Register>(&mut self, dst: R, addr: Addr, width: Width) {
        let value = match ram_field(addr, width) {
            Some((field, place)) => {
                if field == offset_of!(State, ram.iram) {
                    self.end_long_slice();
                }
                let base = self.load_pointer(field);
                self.load_guest(base, place, width)
            }
            None => {
                let address = self.builder.ins().iconst(types::I32, i64::from(addr.0));
                self.request_load(R::CLASS, address, width)
            }
        };
        self.set(dst, value);
        let observed = self.notices(addr).then_some(ObservedAddress::Constant(addr.0));
        self.observe(observed, R::CLASS, value, width);
    }

    fn store<R: Register>(&mut self, src: R, base: RegI32, off: Off, width: Width) {
        if let Some((pointer, place)) = self.checked_place(base, width, true) {
            let value = self.get(src);
            return self.store_guest(value, pointer, place, width);
        }
        let value = self.get(src);
        let observed = self.observed_address(base, off);
        let place = self.place(base, off);
        let inside = self.builder.create_block();
        let [elsewhere, slow, behind] = self.access_blocks();
        let bits = self.wrong_bits(SDRAM, place, width);
        self.builder.ins().brif(bits, elsewhere, &[], inside, &[]);

        self.enter(inside);
        let offset_in_sdram = self.builder.ins().uextend(types::I64, place);
        let block = self.builder.ins().ushr_imm_u(place, i64::from(BLOCK_BITS));
        let block = self.builder.ins().uextend(types::I64, block);
        let marks = self.load_marks();
        let mark = self.builder.ins().iadd(marks, block);
        let mark = self.builder.ins().uload8(types::I32, self.flags.state, mark, 0);
        self.builder.ins().brif(mark, slow, &[], behind, &[offset_in_sdram.into()]);

        self.elsewhere(place, width, true, [elsewhere, slow, behind]);

        self.enter_cold(slow);
        let address = self.toggle_base(SDRAM, place);
        self.request_store(R::CLASS, value, address, width);
        self.go_on_in_state(offset_of!(State, exchange.scratch), behind);

        let pointer = self.enter_access(behind);
        self.store_guest(value, pointer, 0, width);
        self.observe(observed, R::CLASS, value, width);
    }

    /// Loads the pointer to the marks of protected blocks.
    ///
    /// The pointer is loaded where it is used, even in rare cases: if it were moved out of a loop, it would occupy a
    /// register for the whole loop.
    fn load_marks(&mut self) -> Value {
        let field = offset_of!(State, ram.protected);
        if self.unroll.is_rare { self.load_state(types::I64, field) } else { self.load_pointer(field) }
    }

    fn store_at<R: Register>(&mut self, src: R, addr: Addr, width: Width) {
        let value = self.get(src);
        self.store_value_at::<R>(value, addr, width);
        let observed = self.notices(addr).then_some(ObservedAddress::Constant(addr.0));
        self.observe(observed, R::CLASS, value, width);
    }

    fn store_value_at<R: Register>(&mut self, value: Value, addr: Addr, width: Width) {
        let address = self.builder.ins().iconst(types::I32, i64::from(addr.0));
        let Some((field, place)) = ram_field(addr, width) else {
            return self.request_store(R::CLASS, value, address, width);
        };
        if !(PROGRAM_BASE..PROGRAM_LIMIT).contains(&addr.0) {
            if field == offset_of!(State, ram.iram) {
                self.end_long_slice();
                self.mark_touched();
            }
            let base = self.load_pointer(field);
            return self.store_guest(value, base, place, width);
        }
        let marks = self.load_pointer(offset_of!(State, ram.protected));
        let mark = self.builder.ins().uload8(types::I32, self.flags.state, marks, place >> BLOCK_BITS);
        if self.unroll.fast.is_some() {
            self.bail_if(mark);
            let base = self.load_pointer(field);
            return self.store_guest(value, base, place, width);
        }
        let [_, slow, behind] = self.access_blocks();
        let place = self.builder.ins().iconst(types::I64, i64::from(place));
        self.builder.ins().brif(mark, slow, &[], behind, &[place.into()]);

        self.enter_cold(slow);
        self.request_store(R::CLASS, value, address, width);
        self.go_on_in_state(offset_of!(State, exchange.scratch), behind);

        let pointer = self.enter_access(behind);
        self.store_guest(value, pointer, 0, width);
    }

    /// The blocks of an access: for an address outside SDRAM, for an address outside any RAM, and for the access
    /// itself, whose parameter is the offset of the address from the beginning of SDRAM.
    ///
    /// All paths lead to a single block with the access: Cranelift computes a value where it is first used, and would
    /// compute it again after a join if only one of the paths had used it.
    fn access_blocks(&mut self) -> [Block; 3] {
        let behind = self.builder.create_block();
        self.builder.append_block_param(behind, types::I64);
        [self.builder.create_block(), self.builder.create_block(), behind]
    }

    /// Continues in the block `behind` of the access; returns the offset of the address.
    fn enter_access(&mut self, behind: Block) -> Value {
        self.enter(behind);
        let base = self.load_pointer(offset_of!(State, ram.sdram));
        let place = self.builder.block_params(behind)[0];
        self.builder.ins().iadd(base, place)
    }

    /// Emits an access outside SDRAM, which continues at the access if the address is in on-chip RAM, otherwise at
    /// `slow`; returns the address.
    fn elsewhere(
        &mut self,
        place: Value,
        width: Width,
        is_store: bool,
        [elsewhere, slow, behind]: [Block; 3],
    ) -> Value {
        self.enter_cold(elsewhere);
        let address = self.toggle_base(SDRAM, place);
        let place = self.toggle_base(IRAM, address);
        let bits = self.wrong_bits(IRAM, place, width);
        let iram = self.builder.create_block();
        self.builder.ins().brif(bits, slow, &[], iram, &[]);

        self.enter_cold(iram);
        self.end_long_slice();
        self.stay_cold();
        if is_store {
            self.mark_touched();
        }
        let base = self.load_state(types::I64, offset_of!(State, ram.iram));
        let place = self.builder.ins().uextend(types::I64, place);
        let pointer = self.builder.ins().iadd(base, place);
        self.go_on_at(pointer, behind);
        address
    }

    /// Says that on-chip RAM is written.
    fn mark_touched(&mut self) {
        let yes = self.builder.ins().iconst(types::I32, 1);
        self.store_state(yes, offset_of!(State, signs.touched));
    }

    /// Continues the access in a field of the state: the request has done the work.
    fn go_on_in_state(&mut self, field: usize, behind: Block) {
        let pointer = self.builder.ins().iadd_imm_s(self.frame.state, i64::from(offset(field)));
        self.go_on_at(pointer, behind);
    }

    fn go_on_at(&mut self, pointer: Value, behind: Block) {
        let base = self.load_state(types::I64, offset_of!(State, ram.sdram));
        let place = self.builder.ins().isub(pointer, base);
        self.builder.ins().jump(behind, &[place.into()]);
    }

    /// The bits of `place` that are 0 in the offset of every access that stays in `region` and is aligned.
    fn wrong_bits(&mut self, region: Region, place: Value, width: Width) -> Value {
        let never = !(region.size - 1) | (width.bytes() - 1);
        self.builder.ins().band_imm_s(place, i64::from(never.cast_signed()))
    }

    /// Returns the bits of an offset in SDRAM that an access of `width` must not have.
    pub(super) fn wrong_bits_in_sdram(&mut self, place: Value, width: Width) -> Value {
        self.wrong_bits(SDRAM, place, width)
    }

    /// Converts an address to the offset in `region`, or back, since regions start at multiples of their size.
    ///
    /// Not written as a sum: Cranelift would share it with the sum that made the address, and keep that over
    /// the access.
    fn toggle_base(&mut self, region: Region, value: Value) -> Value {
        self.builder.ins().bxor_imm_s(value, i64::from(region.base.get().cast_signed()))
    }

    pub(super) fn load_guest(&mut self, pointer: Value, place: i32, width: Width) -> Value {
        let flags = self.flags.guest;
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
        let flags = self.flags.guest;
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
        self.read_slot(class, slot)
    }

    fn request_store(&mut self, class: Class, value: Value, address: Value, width: Width) {
        let address = self.builder.ins().uextend(types::I64, address);
        let slot = self.slot(class, value);
        self.request(Reason::Store.with_width(width), self.at, address, slot);
    }
}

/// Reports whether an instruction either uses no constant address or one in SDRAM.
pub(super) fn is_in_sdram(op: &Op) -> bool {
    let (Some(width), Some(addr)) = (op.kind().width(), op.operand::<Addr>(Name::Addr)) else { return true };
    ram_field(addr, width).is_some_and(|(field, _)| field == offset_of!(State, ram.sdram))
}

/// The location of an aligned access to the constant address `addr`, if it is in RAM: the field of the state that
/// points to that RAM, and the offset in it.
fn ram_field(addr: Addr, width: Width) -> Option<(usize, i32)> {
    let place_in = |region: Region| {
        let place = addr.0.wrapping_sub(region.base.get());
        (place.is_multiple_of(width.bytes()) && place < region.size).then(|| offset(place as usize))
    };
    let sdram = place_in(SDRAM).map(|place| (offset_of!(State, ram.sdram), place));
    sdram.or_else(|| place_in(IRAM).map(|place| (offset_of!(State, ram.iram), place)))
}
