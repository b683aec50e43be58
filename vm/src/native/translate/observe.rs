//! Reports of accesses to memory that threads can share.
//!
//! After the access, machine code looks it up in the table of redundant accesses; if it is not there, it requests the
//! report. For memory that only the program itself can reach, this costs one comparison if the address is in a
//! register, and nothing if it is a constant.

use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use kmotiondef::map::{CALLBACK_STACK_BASE, PROGRAM_BASE, PROGRAM_LIMIT, SDRAM, STACK_BASE, STACK_SIZE};

use super::super::request::Reason;
use super::super::state::State;
use super::{Translator, offset};
use crate::filter::{AccessFilter, ENTRIES, PAGE_BITS, key, place_of_word};
use crate::kind::{Name, Width};
use crate::op::Op;
use crate::operand::{Addr, Class, Off, RegI32};
use crate::shared::is_noticed;

/// The programs whose accesses are reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct ObservedProgram {
    /// True if it sets the call-back, which accesses the program's own data in parallel to the thread.
    pub(in super::super) has_call_back: bool,
}

/// The address of an access that is reported.
#[derive(Clone, Copy)]
pub(super) enum ObservedAddress {
    Constant(u32),
    Computed(Value),
}

impl Translator<'_, '_> {
    /// Returns whether an access through a constant address is reported.
    pub(super) fn notices(&self, addr: Addr) -> bool {
        let observed = self.translation.observed;
        observed.is_some_and(|observed| is_noticed(addr.0, observed.has_call_back))
    }

    /// Returns whether an instruction cannot be part of fast iterations because its access may be reported; accesses
    /// through registers are checked there.
    pub(super) fn is_always_observed(&self, op: &Op) -> bool {
        let Some(observed) = self.translation.observed else { return false };
        let through_register = op.operand::<RegI32>(Name::Base).is_some() && op.kind().width().is_some();
        op.operand(Name::Addr).is_some_and(|addr| op.kind().width().is_some() && self.notices(addr))
            || observed.has_call_back && through_register
    }

    /// The address of an access through a register, if it may be reported.
    pub(super) fn observed_address(&mut self, base: RegI32, off: Off) -> Option<ObservedAddress> {
        self.translation.observed?;
        let base = self.get(base);
        Some(ObservedAddress::Computed(self.builder.ins().iadd_imm_s(base, i64::from(off.0))))
    }

    /// Reports an access that has been made.
    pub(super) fn observe(
        &mut self,
        address: Option<ObservedAddress>,
        class: Class,
        value: Value,
        width: Width,
    ) {
        let (Some(address), Some(observed)) = (address, self.translation.observed) else { return };
        let [report, behind] = [(); 2].map(|()| self.builder.create_block());
        let address = match address {
            ObservedAddress::Constant(address) => {
                let place = (address >> 2 ^ place_of_word(self.at)) as usize % ENTRIES;
                let entry = self.load_state(types::I64, entry_at(place));
                let key = self.key_in_slice(key(self.at, address));
                let address = self.builder.ins().iconst(types::I64, i64::from(address));
                let is_known = self.builder.ins().icmp(IntCC::Equal, entry, key);
                self.builder.ins().brif(is_known, behind, &[], report, &[]);
                address
            }
            ObservedAddress::Computed(address) => {
                self.branch_if_own(address, CALLBACK_STACK_BASE + STACK_SIZE, STACK_BASE, behind);
                if !observed.has_call_back {
                    self.branch_if_own(address, PROGRAM_LIMIT, PROGRAM_BASE, behind);
                }
                self.branch_if_owner(address, behind);
                let entry = self.entry_of(address);
                let address = self.builder.ins().uextend(types::I64, address);
                let key = self.key_in_slice(key(self.at, 0));
                let key = self.builder.ins().iadd(key, address);
                let is_known = self.builder.ins().icmp(IntCC::Equal, entry, key);
                self.builder.ins().brif(is_known, behind, &[], report, &[]);
                address
            }
        };
        self.enter_cold(report);
        let slot = self.slot(class, value);
        self.request(Reason::Accessed.with_width(width), self.at, address, slot);
        self.builder.ins().jump(behind, &[]);
        self.enter(behind);
    }

    /// Branches to `behind` if an address is at least `base` and below `limit`.
    fn branch_if_own(&mut self, address: Value, limit: u32, base: u32, behind: Block) {
        let next = self.builder.create_block();
        let from = self.builder.ins().iadd_imm_s(address, -i64::from(base.cast_signed()));
        let is_own = self.builder.ins().icmp_imm_u(IntCC::UnsignedLessThan, from, i64::from(limit - base));
        self.builder.ins().brif(is_own, behind, &[], next, &[]);
        self.enter(next);
    }

    /// Branches to `behind` if only this context has accessed the page of an address.
    fn branch_if_owner(&mut self, address: Value, behind: Block) {
        let next = self.builder.create_block();
        let page = self.builder.ins().ushr_imm_u(address, i64::from(PAGE_BITS));
        // SDRAM starts at a multiple of its size.
        let page = self.builder.ins().band_imm_u(page, i64::from((SDRAM.size >> PAGE_BITS) - 1));
        let page = self.builder.ins().uextend(types::I64, page);
        let owners = self.load_state(types::I64, offset_of!(State, ram.owners));
        let mark = self.builder.ins().iadd(owners, page);
        let mark = self.builder.ins().uload8(types::I32, self.flags.state, mark, 0);
        let own = self.load_state(types::I32, offset_of!(State, signs.owner));
        let is_own = self.builder.ins().icmp(IntCC::Equal, mark, own);
        self.builder.ins().brif(is_own, behind, &[], next, &[]);
        self.enter(next);
    }

    /// A key with the number of the slice.
    fn key_in_slice(&mut self, key: u64) -> Value {
        let slice = self.load_state(types::I64, offset_of!(State, filter) + offset_of!(AccessFilter, slice));
        self.builder.ins().iadd_imm_s(slice, key.cast_signed())
    }

    /// The entry for the present instruction and a computed address.
    fn entry_of(&mut self, address: Value) -> Value {
        let word = self.builder.ins().ushr_imm_u(address, 2);
        let place = self.builder.ins().bxor_imm_s(word, i64::from(place_of_word(self.at) % ENTRIES as u32));
        let place = self.builder.ins().band_imm_u(place, ENTRIES as i64 - 1);
        let place = self.builder.ins().uextend(types::I64, place);
        let place = self.builder.ins().ishl_imm_u(place, i64::from(size_of::<u64>().ilog2()));
        let pointer = self.builder.ins().iadd(self.frame.state, place);
        self.builder.ins().load(types::I64, self.flags.state, pointer, offset(entry_at(0)))
    }
}

/// The place of an entry of the filter in the state.
fn entry_at(place: usize) -> usize {
    offset_of!(State, filter) + offset_of!(AccessFilter, entries) + place * size_of::<u64>()
}
