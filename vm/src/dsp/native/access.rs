//! Loads and stores: RAM is accessed directly, everything else is left to the interpreter.

use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use kmotiondef::map::{IRAM, SDRAM};

use super::super::decode::{AFTER, MicroOp, NEGATIVE, UPDATES, ZERO};
use super::super::work::Work;
use super::packet::PacketState;
use super::region::{NoNextPacket, Translator, offset};
use crate::native::{Handover, MARK_BITS};

impl Translator<'_, '_> {
    /// The address of an access; the base changes. The sources are the base, the base with the constant, the offset.
    pub(super) fn address(
        &mut self,
        packet_state: &mut PacketState,
        m: &MicroOp,
        [base, constant, register]: [Value; 3],
    ) -> Result<Value, NoNextPacket> {
        let mut sum = constant;
        if m.b != ZERO {
            let scaled = self.builder.ins().ishl_imm_u(register, i64::from(m.extra));
            let ins = self.builder.ins();
            sum = if m.flags & NEGATIVE == 0 { ins.iadd(sum, scaled) } else { ins.isub(sum, scaled) };
        }
        if m.flags & UPDATES == 0 {
            return Ok(sum);
        }
        self.write_result(packet_state, m, m.a, sum)?;
        Ok(if m.flags & AFTER == 0 { sum } else { base })
    }

    /// Loads into a register or a pair.
    pub(super) fn load(
        &mut self,
        packet_state: &mut PacketState,
        m: &MicroOp,
        address: Value,
    ) -> Result<(), NoNextPacket> {
        let address = self.align(address, m.extra);
        let pointer = self.pointer(packet_state, address, false);
        let guest = self.guest;
        let ins = self.builder.ins();
        let value = match m.work {
            Work::Ldbu => ins.uload8(types::I32, guest, pointer, 0),
            Work::Ldb => ins.sload8(types::I32, guest, pointer, 0),
            Work::Ldhu => ins.uload16(types::I32, guest, pointer, 0),
            Work::Ldh => ins.sload16(types::I32, guest, pointer, 0),
            Work::Lddw => ins.load(types::I64, guest, pointer, 0),
            _ => ins.load(types::I32, guest, pointer, 0),
        };
        if m.work == Work::Lddw {
            return self.push_pair(packet_state, [5, 5], m.dst, value);
        }
        self.push(packet_state, 5, m.dst, value)
    }

    /// Stores a register, at the end of the packet.
    pub(super) fn store(&mut self, packet_state: &mut PacketState, m: &MicroOp, address: Value) {
        let value = self.read(packet_state, m.dst);
        let address = self.align(address, m.extra);
        let pointer = self.pointer(packet_state, address, true);
        packet_state.stores.push((pointer, value, 1 << m.extra));
    }

    /// The low bits of an address do not count.
    fn align(&mut self, address: Value, bits: u8) -> Value {
        if bits == 0 { address } else { self.builder.ins().band_imm_s(address, -1 << bits) }
    }

    /// Emits the host address of a guest address; for an access whose condition does not hold, the address of a scratch
    /// word.
    fn pointer(&mut self, packet_state: &mut PacketState, address: Value, is_store: bool) -> Value {
        let after = self.builder.create_block();
        self.builder.append_block_param(after, types::I64);
        if let Some(condition) = packet_state.condition {
            let place = i64::try_from(offset_of!(Handover, scratch)).unwrap_or(0);
            let scratch = self.builder.ins().iadd_imm_s(self.pointers.handover, place);
            let made = self.builder.create_block();
            self.builder.ins().brif(condition, made, &[], after, &[scratch.into()]);
            self.continue_in(made);
        }
        let (elsewhere, side) = (self.cold(), self.side(packet_state));
        self.in_region(
            address,
            [SDRAM.base.get(), SDRAM.size],
            0,
            self.pointers.sdram,
            is_store,
            [elsewhere, side, after],
        );
        self.continue_in(elsewhere);
        let lines = SDRAM.size >> MARK_BITS;
        self.in_region(
            address,
            [IRAM.base.get(), IRAM.size],
            lines,
            self.pointers.iram,
            is_store,
            [side, side, after],
        );
        self.continue_in(after);
        self.builder.block_params(after)[0]
    }

    /// Continues with the pointer to an address if it is in this RAM. The blocks are for an address outside, for a
    /// store that must not be made, and for the access.
    fn in_region(
        &mut self,
        address: Value,
        [base, size]: [u32; 2],
        first_mark: u32,
        ram: Value,
        is_store: bool,
        [outside, marked, after]: [Block; 3],
    ) {
        let place = self.builder.ins().iadd_imm_s(address, -i64::from(base.cast_signed()));
        let is_inside = self.builder.ins().icmp_imm_u(IntCC::UnsignedLessThan, place, i64::from(size));
        let wide = self.builder.ins().uextend(types::I64, place);
        let pointer = self.builder.ins().iadd(ram, wide);
        if !is_store {
            self.builder.ins().brif(is_inside, after, &[pointer.into()], outside, &[]);
            return;
        }
        let inside = self.builder.create_block();
        self.builder.ins().brif(is_inside, inside, &[], outside, &[]);
        self.continue_in(inside);
        let line = self.builder.ins().ushr_imm_u(wide, i64::from(MARK_BITS));
        let line = self.builder.ins().iadd(self.pointers.marks, line);
        let mark = self.builder.ins().uload8(types::I32, self.own, line, first_mark.cast_signed());
        if base == IRAM.base.get() {
            let place = offset(offset_of!(Handover, touched));
            let touched = self.builder.ins().iconst(types::I32, 1);
            self.builder.ins().store(self.own, touched, self.pointers.handover, place);
        }
        self.builder.ins().brif(mark, marked, &[], after, &[pointer.into()]);
    }
}
