//! Values with their types, and their parts.

use kmotiondef::GuestAddr;

use super::eval::{DebugReader, LocalPlace};
use crate::names::Names;
use crate::sema::constants::Constant;
use crate::ty::{BitRange, QualifiedType, Type, TypeId, Types};
use crate::watch;

/// A value of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebugValue {
    /// Its type.
    pub(super) ty: TypeId,
    /// Its location or its bits.
    pub(super) data: Data,
}

/// The location of a value, or its bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Data {
    /// In memory.
    Memory(GuestAddr),
    /// Some bits of a word in memory.
    Field(GuestAddr, BitRange),
    /// The bits of a register.
    Slot(u64),
    /// Computed.
    Constant(Constant),
}

impl DebugValue {
    /// A variable.
    pub(super) const fn of(ty: TypeId, place: LocalPlace) -> Self {
        let data = match place {
            LocalPlace::Memory(address) => Data::Memory(address),
            LocalPlace::Slot(bits) => Data::Slot(bits),
        };
        Self { ty, data }
    }

    /// Its address, if it is in memory.
    #[must_use]
    pub const fn address(&self) -> Option<GuestAddr> {
        match self.data {
            Data::Memory(address) | Data::Field(address, _) => Some(address),
            Data::Slot(_) | Data::Constant(_) => None,
        }
    }
}

/// A part of a value: a member, an element, the target of a pointer.
#[derive(Clone, Debug)]
pub struct Child {
    /// Its name within the whole: `x`, `[3]`, `*p`.
    pub name: String,
    /// The C expression that names it.
    pub expression: String,
    /// Its value.
    pub value: DebugValue,
}

/// The text for a value that cannot be read.
pub(super) fn unreadable_text(address: GuestAddr) -> String {
    format!("<error: Cannot access memory at address {:#x}>", address.get())
}

/// Types, their names, and the memory from which values are read.
#[derive(Clone, Copy)]
pub struct DisplayContext<'a> {
    pub(super) types: &'a Types,
    pub(super) names: &'a Names,
    pub(super) reader: &'a dyn DebugReader,
}

impl DisplayContext<'_> {
    /// The type as C spells it, with a blank before the size of an array as in gdb.
    #[must_use]
    pub fn type_of(&self, value: &DebugValue) -> String {
        let spelled = self.types.spell(self.names, value.ty);
        match spelled.find('[') {
            Some(at) if spelled[..at].ends_with(|letter: char| letter.is_ascii_alphanumeric()) => {
                format!("{} {}", &spelled[..at], &spelled[at..])
            }
            _ => spelled,
        }
    }

    /// Bytes of the value.
    #[must_use]
    pub fn size_of(&self, value: &DebugValue) -> u32 {
        self.types.size_of(value.ty).unwrap_or(4)
    }

    /// The number, for a numeric value.
    #[must_use]
    pub fn number(&self, value: &DebugValue) -> Option<f64> {
        match self.constant(value)? {
            Constant::Int(value) => Some(value as f64),
            Constant::Float(value) => Some(value),
        }
    }

    /// Number of parts of the value.
    #[must_use]
    pub fn count(&self, value: &DebugValue) -> u32 {
        match self.types.get(value.ty) {
            Type::Array(_, length) => length.unwrap_or(0),
            Type::Record(record) => {
                self.types.record(*record).layout.as_ref().map_or(0, |layout| layout.members.len() as u32)
            }
            Type::Pointer(to) => u32::from(self.types.size_of(to.ty).is_some()),
            _ => 0,
        }
    }

    /// The parts of the value from number `first` on; `expression` is the C expression for the whole.
    #[must_use]
    pub fn children(&self, value: &DebugValue, expression: &str, first: u32, count: u32) -> Vec<Child> {
        let total = self.count(value);
        let range = first.min(total)..first.saturating_add(count).min(total);
        range.filter_map(|index| self.child(value, expression, index)).collect()
    }

    fn child(&self, value: &DebugValue, expression: &str, index: u32) -> Option<Child> {
        match self.types.get(value.ty) {
            Type::Array(element, _) => {
                let name = format!("[{index}]");
                let value = self.element(value, *element, index)?;
                Some(Child { expression: format!("{expression}{name}"), name, value })
            }
            Type::Record(record) => {
                let member = *self.types.record(*record).layout.as_ref()?.members.get(index as usize)?;
                let base = value.address()?;
                let address = base.offset(member.offset);
                let data = member.bits.map_or(Data::Memory(address), |bits| Data::Field(address, bits));
                let name = member.name.map_or_else(String::new, |name| self.names.get(name).to_owned());
                let value = DebugValue { ty: member.ty.ty, data };
                Some(Child { expression: format!("({expression}).{name}"), name, value })
            }
            Type::Pointer(to) => {
                let Constant::Int(address) = self.constant(value)? else { return None };
                let value = DebugValue { ty: to.ty, data: Data::Memory(GuestAddr::new(address as u32)) };
                Some(Child { name: format!("*{expression}"), expression: format!("*({expression})"), value })
            }
            _ => None,
        }
    }

    pub(super) fn element(
        &self,
        value: &DebugValue,
        element: QualifiedType,
        index: u32,
    ) -> Option<DebugValue> {
        let size = self.types.size_of(element.ty)?;
        let address = value.address()?.offset(index.wrapping_mul(size));
        Some(DebugValue { ty: element.ty, data: Data::Memory(address) })
    }

    pub(super) fn constant(&self, value: &DebugValue) -> Option<Constant> {
        if matches!(
            self.types.get(value.ty),
            Type::Array(..) | Type::Record(_) | Type::Function(_) | Type::Void
        ) {
            return None;
        }
        Some(match value.data {
            Data::Memory(address) => watch::read(value.ty, self.reader.bytes(address)),
            Data::Slot(bits) => watch::read(value.ty, bits.to_le_bytes()),
            Data::Field(address, range) => {
                let word = i64::from_le_bytes(self.reader.bytes(address));
                Constant::Int(watch::bits(word, range, value.ty))
            }
            Data::Constant(constant) => constant,
        })
    }
}
