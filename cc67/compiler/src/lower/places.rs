//! Places: storage locations, and their reads and writes.

use super::{HeldOperand, Home, Lowering, types};
use crate::ir::inst::{Address, Base, Class, Constant, InstKind, Operand, ValueId};
use crate::ir::operators::{BinaryOp, Width};
use crate::operators;
use crate::ty::{BitRange, TypeId};
use crate::typed::{ExprId, ExprKind, PlaceId, PlaceKind};

/// Storage that has been worked out.
#[derive(Clone, Copy, Debug)]
pub(super) enum Storage {
    /// The value of a local.
    Value(ValueId),
    /// Memory.
    Memory(Address, Width),
    /// Some bits of a unit in memory.
    Bits(Address, Field),
}

/// A bit-field in its unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    unit: Width,
    bits: BitRange,
    is_unsigned: bool,
}

impl Lowering<'_> {
    /// Computes a place: evaluates the pointer in it, if there is one.
    pub(super) fn place(&mut self, id: PlaceId) -> Storage {
        let place = &self.function.places[id];
        let width = types::width(&self.unit.types, place.ty).unwrap_or(Width::I32);
        if let PlaceKind::Local(local, _) = place.kind
            && let Home::Value(value) = self.homes[local]
        {
            return Storage::Value(value);
        }
        match place.kind {
            PlaceKind::Bits(unit, bits) => {
                let ty = self.function.places[unit].ty;
                let is_unsigned = types::is_unsigned(&self.unit.types, ty);
                let unit_width = types::width(&self.unit.types, ty).unwrap_or(Width::I32);
                let field = Field { unit: unit_width, bits, is_unsigned };
                Storage::Bits(self.address(unit), field)
            }
            _ => Storage::Memory(self.address(id), width),
        }
    }

    /// The address of a place in memory.
    pub(super) fn address(&mut self, id: PlaceId) -> Address {
        match self.function.places[id].kind {
            PlaceKind::Local(local, offset) => {
                let base = match self.homes[local] {
                    Home::Value(value) | Home::Pointer(value) => Base::Value(value),
                    Home::Slot(slot) => Base::Slot(slot),
                };
                Address::new(base).plus(offset.cast_signed())
            }
            PlaceKind::Symbol(symbol, offset) => Address { base: Base::Symbol(symbol), offset },
            PlaceKind::Pointer(pointer, offset) => self.pointee(pointer).plus(offset),
            PlaceKind::Bits(unit, _) => self.address(unit),
        }
    }

    /// The address in a pointer; constant steps and known places need no arithmetic.
    fn pointee(&mut self, pointer: ExprId) -> Address {
        let mut pointer = pointer;
        let mut offset = 0_i32;
        loop {
            let expr = &self.function.exprs[pointer];
            match expr.kind {
                ExprKind::Address(place) => return self.address(place).plus(offset),
                ExprKind::Binary(operators::BinaryOp::Add, base, step) => {
                    let ExprKind::Int(step) = self.function.exprs[step].kind else { break };
                    offset = offset.wrapping_add(step as i32);
                    pointer = base;
                }
                ExprKind::Convert(inner) if self.is_same_word(self.function.exprs[inner].ty) => {
                    pointer = inner;
                }
                ExprKind::Int(address) => {
                    return Address::of(Operand::int(address as i32)).plus(offset);
                }
                _ => break,
            }
        }
        Address::of(self.value(pointer)).plus(offset)
    }

    /// Reports whether values of the type are 32-bit words that a pointer conversion does not change.
    pub(super) fn is_same_word(&self, ty: TypeId) -> bool {
        types::width(&self.unit.types, ty) == Some(Width::I32)
    }

    /// The address as a value.
    pub(super) fn address_value(&mut self, address: Address, into: Option<ValueId>) -> Operand {
        match address.base {
            Base::Absolute => self.place_in(Operand::int(address.offset), into),
            Base::Value(value) if address.offset == 0 => self.place_in(value.into(), into),
            Base::Value(value) => {
                let dst = self.destination(Class::I32, into);
                self.builder.binary(BinaryOp::Add, dst, value.into(), Operand::int(address.offset));
                dst.into()
            }
            Base::Symbol(symbol) => self.place_in(Constant::Symbol(symbol, address.offset).into(), into),
            Base::Slot(slot) => {
                let dst = self.destination(Class::I32, into);
                self.builder.push(InstKind::FrameAddress { dst, slot, offset: address.offset });
                dst.into()
            }
        }
    }

    /// Remembers storage while other operands are evaluated.
    pub(super) fn hold_storage(&self, storage: Storage) -> (Storage, Option<HeldOperand>) {
        let held = match storage {
            Storage::Memory(address, _) | Storage::Bits(address, _) => match address.base {
                Base::Value(value) => Some(self.hold_operand(value.into())),
                _ => None,
            },
            Storage::Value(_) => None,
        };
        (storage, held)
    }

    /// The storage as it was when it was held.
    pub(super) fn release_storage(&mut self, (storage, held): (Storage, Option<HeldOperand>)) -> Storage {
        let Some(held) = held else { return storage };
        let base = self.release(held);
        let at = |address: Address| Address::of(base).plus(address.offset);
        match storage {
            Storage::Memory(address, width) => Storage::Memory(at(address), width),
            Storage::Bits(address, field) => Storage::Bits(at(address), field),
            Storage::Value(_) => storage,
        }
    }

    /// Reads the stored value.
    pub(super) fn read(&mut self, storage: Storage, into: Option<ValueId>) -> Operand {
        match storage {
            Storage::Value(value) => self.place_in(value.into(), into),
            Storage::Memory(address, width) => {
                let dst = self.destination(width.class(), into);
                self.builder.load(dst, width, address);
                dst.into()
            }
            Storage::Bits(address, field) => {
                let unit = self.builder.value(field.unit.class());
                self.builder.load(unit, field.unit, address);
                self.extract(unit.into(), field, into)
            }
        }
    }

    /// Writes a value of the place's type; returns the value that reading would give.
    pub(super) fn write(&mut self, storage: Storage, value: Operand) -> Operand {
        match storage {
            Storage::Value(dst) => {
                self.builder.copy(dst, value);
                self.record_write(dst);
                dst.into()
            }
            Storage::Memory(address, width) => {
                self.builder.store(value, width, address);
                value
            }
            Storage::Bits(address, field) => {
                self.insert(address, value, field);
                self.extract_low(value, field)
            }
        }
    }

    /// The field in a unit.
    fn extract(&mut self, unit: Operand, field: Field, into: Option<ValueId>) -> Operand {
        let class = field.unit.class();
        let (total, shift, width) =
            (total_bits(class), i32::from(field.bits.shift), i32::from(field.bits.width));
        let up = self.binary_value(BinaryOp::ShiftLeft, class, unit, Operand::int(total - shift - width));
        let down = if field.is_unsigned { BinaryOp::ShiftRightUnsigned } else { BinaryOp::ShiftRight };
        let dst = self.destination(class, into);
        self.builder.binary(down, dst, up, Operand::int(total - width));
        dst.into()
    }

    /// A value cut down to the field's width.
    fn extract_low(&mut self, value: Operand, field: Field) -> Operand {
        let bits = BitRange { shift: 0, ..field.bits };
        self.extract(value, Field { bits, ..field }, None)
    }

    /// Replaces the field in its unit in memory.
    fn insert(&mut self, address: Address, value: Operand, field: Field) {
        let class = field.unit.class();
        let ones = u64::MAX.checked_shr(64 - u32::from(field.bits.width)).unwrap_or(0);
        let constant = |bits: u64| Operand::from(Constant::number(class, bits.cast_signed()));
        let unit = self.builder.value(class);
        self.builder.load(unit, field.unit, address);
        let rest = constant(!(ones << field.bits.shift));
        let rest = self.binary_value(BinaryOp::And, class, unit.into(), rest);
        let low = self.binary_value(BinaryOp::And, class, value, constant(ones));
        let shift = Operand::int(i32::from(field.bits.shift));
        let moved = self.binary_value(BinaryOp::ShiftLeft, class, low, shift);
        let whole = self.binary_value(BinaryOp::Or, class, rest, moved);
        self.builder.store(whole, field.unit, address);
    }

    /// `a op b` in a new value.
    pub(super) fn binary_value(&mut self, op: BinaryOp, class: Class, a: Operand, b: Operand) -> Operand {
        let dst = self.builder.value(class);
        self.builder.binary(op, dst, a, b);
        dst.into()
    }
}

/// Bits of an integer class.
const fn total_bits(class: Class) -> i32 {
    match class {
        Class::I64 | Class::F64 => 64,
        Class::I32 | Class::F32 => 32,
    }
}
