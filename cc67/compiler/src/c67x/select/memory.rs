//! Loads, stores, addresses, blocks of memory.

use kmotiondef::firmware::Function;

use super::Selector;
use crate::c67x::code::{Arg, Base, Inst, MemoryPlace, VReg, Value};
use crate::c67x::forms::Kind;
use crate::ir::inst::{self, Address, Class, Operand, SlotId, ValueId};
use crate::ir::operators::Width;

/// The maximum number of bytes that are copied or cleared word by word.
const INLINE: u32 = 64;

impl Selector<'_> {
    pub(super) fn load(&mut self, dst: ValueId, width: Width, address: Address) {
        let reg = self.value(dst);
        let kind = match width {
            Width::I8 => Kind::LoadI8,
            Width::U8 => Kind::LoadU8,
            Width::I16 => Kind::LoadI16,
            Width::U16 => Kind::LoadU16,
            Width::I32 | Width::F32 => Kind::LoadWord,
            Width::I64 | Width::F64 => Kind::LoadPair,
        };
        let place = self.place(address, width.bytes());
        self.access(kind, reg.into(), Arg::None, place);
    }

    pub(super) fn store(&mut self, src: Operand, width: Width, address: Address) {
        let src = self.operand(src);
        match width {
            Width::I8 | Width::U8 => {
                let place = self.place(address, 1);
                self.access(Kind::StoreByte, Arg::None, src.into(), place);
            }
            Width::I16 | Width::U16 => {
                let place = self.place(address, 2);
                self.access(Kind::StoreHalf, Arg::None, src.into(), place);
            }
            Width::I32 | Width::F32 => {
                let place = self.place(address, 4);
                self.access(Kind::StoreWord, Arg::None, src.into(), place);
            }
            // The processor has no store for pairs.
            Width::I64 | Width::F64 => {
                let place = self.place_of_two(address);
                let next = MemoryPlace { offset: place.offset + 4, ..place };
                self.access(Kind::StoreWord, Arg::None, Arg::Low(src), place);
                self.access(Kind::StoreWord, Arg::None, Arg::High(src), next);
            }
        }
    }

    pub(super) fn access(&mut self, kind: Kind, dst: Arg, src: Arg, place: MemoryPlace) {
        let mut inst = Inst::new(kind, dst, Arg::None, src, self.span);
        inst.place = Some(place);
        self.out.push(inst);
    }

    /// Loads a value of a class.
    pub(super) fn load_value(&mut self, dst: VReg, class: Class, place: MemoryPlace) {
        let kind = if super::is_pair(class) { Kind::LoadPair } else { Kind::LoadWord };
        self.access(kind, dst.into(), Arg::None, place);
    }

    /// An address in a form that an access of `bytes` bytes can use.
    fn place(&mut self, address: Address, bytes: u32) -> MemoryPlace {
        let step = bytes.cast_signed();
        let (base, offset) = match address.base {
            inst::Base::Slot(slot) => return MemoryPlace::new(Base::Slot(slot), address.offset),
            inst::Base::Absolute => (self.constant_register(Value::Number(address.offset)), 0),
            inst::Base::Symbol(symbol) => (self.constant_register(Value::Symbol(symbol, address.offset)), 0),
            inst::Base::Value(value) => (self.value(value), address.offset),
        };
        let fits = offset % step == 0 && (-31..=31).contains(&(offset / step));
        if fits {
            return MemoryPlace::new(Base::Reg(base), offset);
        }
        let sum = self.word();
        self.add_number(sum, base, offset);
        MemoryPlace::new(Base::Reg(sum), 0)
    }

    /// An address of a word or pair at an offset, a multiple of 8, from the address in a register.
    pub(super) fn offset_address(&mut self, base: VReg, offset: i32) -> MemoryPlace {
        if offset / 4 <= 31 {
            return MemoryPlace::new(Base::Reg(base), offset);
        }
        let sum = self.word();
        self.add_number(sum, base, offset);
        MemoryPlace::new(Base::Reg(sum), 0)
    }

    /// An address of two consecutive words.
    fn place_of_two(&mut self, address: Address) -> MemoryPlace {
        let place = self.place(address, 4);
        if place.offset / 4 < 31 || !matches!(place.base, Base::Reg(_)) {
            return place;
        }
        let Base::Reg(base) = place.base else { return place };
        let sum = self.word();
        self.add_number(sum, base, place.offset);
        MemoryPlace::new(Base::Reg(sum), 0)
    }

    fn add_number(&mut self, dst: VReg, base: VReg, offset: i32) {
        if (-16..=15).contains(&offset) {
            return self.push(Kind::Add, dst, Arg::number(offset), base);
        }
        let offset = self.constant_register(Value::Number(offset));
        self.push(Kind::Add, dst, offset, base);
    }

    /// `dst = address`
    pub(super) fn address(&mut self, address: Address) -> VReg {
        match address.base {
            inst::Base::Absolute => self.constant_register(Value::Number(address.offset)),
            inst::Base::Symbol(symbol) => self.constant_register(Value::Symbol(symbol, address.offset)),
            inst::Base::Value(value) if address.offset == 0 => self.value(value),
            inst::Base::Value(value) => {
                let (dst, base) = (self.word(), self.value(value));
                self.add_number(dst, base, address.offset);
                dst
            }
            inst::Base::Slot(slot) => {
                let dst = self.word();
                self.frame_address(dst, slot, address.offset);
                dst
            }
        }
    }

    /// The address of an object in the frame.
    pub(super) fn frame_address(&mut self, dst: VReg, slot: SlotId, offset: i32) {
        let mut inst = Inst::new(Kind::FrameAddress, dst.into(), Arg::None, Arg::None, self.span);
        inst.place = Some(MemoryPlace::new(Base::Slot(slot), offset));
        self.out.push(inst);
    }

    /// Reports whether an address is certainly aligned to a word.
    fn is_aligned(&self, address: Address) -> bool {
        let base = match address.base {
            inst::Base::Absolute => true,
            inst::Base::Slot(slot) => self.function.slots[slot].align >= 4,
            inst::Base::Symbol(symbol) => self.externs.align(symbol) >= 4,
            inst::Base::Value(_) => false,
        };
        base && address.offset % 4 == 0
    }

    pub(super) fn copy_memory(&mut self, to: Address, from: Address, len: u32) {
        if len <= INLINE && len.is_multiple_of(4) && self.is_aligned(to) && self.is_aligned(from) {
            for offset in (0..len.cast_signed()).step_by(4) {
                let word = self.word();
                let place = self.place(from.plus(offset), 4);
                self.access(Kind::LoadWord, word.into(), Arg::None, place);
                let place = self.place(to.plus(offset), 4);
                self.access(Kind::StoreWord, Arg::None, word.into(), place);
            }
            return;
        }
        let (to, from) = (self.address(to), self.address(from));
        let len = self.constant_register(Value::Number(len.cast_signed()));
        let result = self.word();
        self.helper(Function::memcpy.name(), &[to, from, len], result);
    }

    pub(super) fn clear_memory(&mut self, to: Address, len: u32) {
        let zero = self.constant_register(Value::Number(0));
        if len <= INLINE && len.is_multiple_of(4) && self.is_aligned(to) {
            for offset in (0..len.cast_signed()).step_by(4) {
                let place = self.place(to.plus(offset), 4);
                self.access(Kind::StoreWord, Arg::None, zero.into(), place);
            }
            return;
        }
        let to = self.address(to);
        let len = self.constant_register(Value::Number(len.cast_signed()));
        let result = self.word();
        self.helper(Function::memset.name(), &[to, zero, len], result);
    }
}
