//! Sizes, alignments and the layout of structures.
//!
//! Natural alignment, members in order, `double` on 8 (`dialect.md` 1.2). A bit-field follows the previous bit, from
//! bit 0 upwards, unless it would straddle a unit of its declared type, in which case it begins a new one; width 0 ends
//! the unit. That is the layout of `gcc -m32 -malign-double`. The vendor's layout differs where types are mixed, and
//! lets such fields overlap.

use super::{BitRange, Layout, Member, QualifiedType, RecordId, Type, TypeId, Types};
use crate::ast::RecordKind;
use crate::names::Name;

/// The size limit of an object: all of the board's SDRAM.
pub const MAX_OBJECT_SIZE: u32 = 0x100_0000;
/// Bytes of the largest structure.
const LARGEST: u32 = i32::MAX as u32 - 8;

impl Types {
    /// Size in bytes; `None` for incomplete types. `void` and functions count 1, as in pointer steps.
    #[must_use]
    pub fn size_of(&self, ty: TypeId) -> Option<u32> {
        Some(match self.get(ty) {
            Type::Void
            | Type::Function(_)
            | Type::Bool
            | Type::Char
            | Type::SignedChar
            | Type::UnsignedChar => 1,
            Type::Short | Type::UnsignedShort => 2,
            Type::Int | Type::Unsigned | Type::Float | Type::Pointer(_) => 4,
            Type::LongLong | Type::UnsignedLongLong | Type::Double => 8,
            Type::Array(element, length) => self.size_of(element.ty)?.checked_mul((*length)?)?,
            Type::Record(record) => self.record(*record).layout.as_ref()?.size,
        })
    }

    /// Alignment in bytes; 1 for incomplete types.
    #[must_use]
    pub fn align_of(&self, ty: TypeId) -> u32 {
        match self.get(ty) {
            Type::Array(element, _) => self.align_of(element.ty),
            Type::Record(record) => self.record(*record).layout.as_ref().map_or(1, |layout| layout.align),
            _ => self.size_of(ty).unwrap_or(1),
        }
    }

    /// Reports whether objects of the type can exist.
    #[must_use]
    pub fn is_object(&self, ty: TypeId) -> bool {
        !ty.is_void() && !self.is_function(ty) && self.size_of(ty).is_some()
    }

    /// Finds a member by name, through anonymous structures and unions; its offset is from the start of `record`.
    #[must_use]
    pub fn find_member(&self, record: RecordId, name: Name) -> Option<Member> {
        let layout = self.record(record).layout.as_ref()?;
        layout.members.iter().find_map(|member| match member.name {
            Some(own) => (own == name).then_some(*member),
            None => {
                let inner = self.find_member(self.record_of(member.ty.ty)?, name)?;
                Some(Member { offset: member.offset + inner.offset, ..inner })
            }
        })
    }
}

/// Places members one after another.
#[derive(Debug)]
pub struct LayoutBuilder {
    kind: RecordKind,
    members: Vec<Member>,
    /// The first byte after the members so far; for a union, the size of the largest.
    end: u32,
    align: u32,
    /// The bit after the last member, if that is a bit-field.
    end_bit: Option<u64>,
}

impl LayoutBuilder {
    /// Begins a structure or union.
    #[must_use]
    pub fn new(kind: RecordKind) -> Self {
        Self { kind, members: Vec::new(), end: 0, align: 1, end_bit: None }
    }

    /// The members so far.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Adds a member, aligned to at least `align`; an incomplete array takes no room. `None` if the structure becomes
    /// too large.
    pub fn member(&mut self, types: &Types, name: Option<Name>, ty: QualifiedType, align: u32) -> Option<()> {
        self.end_bit = None;
        let offset = self.reserve(types.size_of(ty.ty).unwrap_or(0), types.align_of(ty.ty).max(align))?;
        self.members.push(Member { name, ty, offset, bits: None });
        Some(())
    }

    /// Adds a bit-field; without a name it is only padding, and with width 0 it ends the unit.
    pub fn bit_field(
        &mut self,
        types: &Types,
        name: Option<Name>,
        ty: QualifiedType,
        width: u32,
    ) -> Option<()> {
        let name = name.filter(|_| width > 0);
        let size = types.size_of(ty.ty)?;
        let (unit, width_in_bits) = (u64::from(size) * 8, u64::from(width));
        if name.is_some() {
            self.align = self.align.max(types.align_of(ty.ty));
        }
        if self.kind == RecordKind::Union {
            self.end = self.end.max(width.div_ceil(8));
            let bits = BitRange { shift: 0, width: width as u8 };
            self.members.extend(name.map(|_| Member { name, ty, offset: 0, bits: Some(bits) }));
            return Some(());
        }
        let next = self.end_bit.unwrap_or(u64::from(self.end) * 8);
        let straddles = next % unit + width_in_bits > unit;
        let start = if straddles || width == 0 { next.next_multiple_of(unit) } else { next };
        let end = start + width_in_bits;
        self.end_bit = Some(end);
        self.end = u32::try_from(end.div_ceil(8)).ok().filter(|end| *end <= LARGEST)?;
        if name.is_some() {
            let bits = BitRange { shift: (start % unit) as u8, width: width as u8 };
            let offset = u32::try_from(start / unit).ok()? * size;
            self.members.push(Member { name, ty, offset, bits: Some(bits) });
        }
        Some(())
    }

    /// Demands an alignment of the whole.
    pub fn align(&mut self, align: u32) {
        self.align = self.align.max(align);
    }

    /// The finished layout.
    #[must_use]
    pub fn finish(self) -> Layout {
        let size = self.end.next_multiple_of(self.align);
        Layout { members: self.members, size, align: self.align }
    }

    /// Allocates space and returns its offset.
    fn reserve(&mut self, size: u32, align: u32) -> Option<u32> {
        self.align = self.align.max(align);
        if self.kind == RecordKind::Union {
            self.end = self.end.max(size);
            return Some(0);
        }
        let offset = self.end.next_multiple_of(align);
        let end = offset.checked_add(size)?;
        if end > LARGEST {
            return None;
        }
        self.end = end;
        Some(offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offsets(kind: RecordKind, members: &[TypeId]) -> (Vec<u32>, u32, u32) {
        let types = Types::new();
        let mut builder = LayoutBuilder::new(kind);
        for ty in members {
            builder.member(&types, None, QualifiedType::plain(*ty), 1).expect("small");
        }
        let layout = builder.finish();
        (layout.members.iter().map(|member| member.offset).collect(), layout.size, layout.align)
    }

    #[test]
    fn members_are_aligned_naturally_and_doubles_to_8_bytes() {
        let (ch, short, double) = (Types::CHAR, Types::SHORT, Types::DOUBLE);
        assert_eq!(offsets(RecordKind::Struct, &[ch, double, ch]), (vec![0, 8, 16], 24, 8));
        assert_eq!(offsets(RecordKind::Struct, &[ch, ch, ch, short, ch]), (vec![0, 1, 2, 4, 6], 8, 2));
        assert_eq!(offsets(RecordKind::Union, &[ch, double]), (vec![0, 0], 8, 8));
        assert_eq!(offsets(RecordKind::Struct, &[]), (vec![], 0, 1));
    }

    #[test]
    fn bit_fields_follow_each_other_and_never_straddle_a_unit_of_their_type() {
        let types = Types::new();
        let mut names = crate::names::Names::new();
        let name = Some(names.intern("x"));
        let mut builder = LayoutBuilder::new(RecordKind::Struct);
        for (ty, width) in [
            (Types::INT, 3),
            (Types::INT, 5),
            (Types::INT, 24),
            (Types::CHAR, 4),
            (Types::CHAR, 0),
            (Types::CHAR, 1),
        ] {
            builder.bit_field(&types, name, QualifiedType::plain(ty), width).expect("small");
        }
        let layout = builder.finish();
        let found: Vec<_> =
            layout.members.iter().map(|m| (m.offset, m.bits.map(|b| (b.shift, b.width)))).collect();
        let bits = |shift, width| Some((shift, width));
        assert_eq!(
            found,
            [(0, bits(0, 3)), (0, bits(3, 5)), (0, bits(8, 24)), (4, bits(0, 4)), (5, bits(0, 1))]
        );
        assert_eq!(layout.size, 8);
    }
}
