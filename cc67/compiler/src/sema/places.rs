//! Places: taking addresses, following pointers, stepping to members and elements.
//!
//! A place is kept in its simplest form, so that `persist.UserData[5]` is a symbol and an offset, and `*&x` is `x`. A
//! place of a local is always inside of it; accesses beyond it use arithmetic on its address.

use super::Sema;
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::{Member, QualifiedType, TypeId, Types};
use crate::typed::{ExprId, ExprKind, LocalId, PlaceId, PlaceKind, SymbolId};

/// A place with its C type.
#[derive(Clone, Copy, Debug)]
pub(super) struct TypedPlace {
    /// The place.
    pub(super) place: PlaceId,
    /// The type of the stored value, with qualifiers.
    pub(super) ty: QualifiedType,
    /// True if it can be assigned to or its address taken; false for a structure result.
    pub(super) is_lvalue: bool,
}

impl Sema<'_> {
    /// The place of a local.
    pub(super) fn local_place(&mut self, local: LocalId, ty: QualifiedType, span: Span) -> TypedPlace {
        let place = self.body.place(PlaceKind::Local(local, 0), ty.ty, span);
        TypedPlace { place, ty, is_lvalue: true }
    }

    /// The place of a symbol, which is used by this.
    pub(super) fn symbol_place(&mut self, symbol: SymbolId, ty: QualifiedType, span: Span) -> TypedPlace {
        if self.unevaluated == 0 {
            self.symbols.mark_used(symbol, span);
        }
        let place = self.body.place(PlaceKind::Symbol(symbol, 0), ty.ty, span);
        TypedPlace { place, ty, is_lvalue: true }
    }

    /// The address of a symbol, as a value of pointer type `ty`.
    pub(super) fn symbol_address(&mut self, symbol: SymbolId, ty: TypeId, span: Span) -> ExprId {
        let target = self.types.pointee(ty).map_or(Types::VOID, |to| to.ty);
        let place = self.symbol_place(symbol, QualifiedType::plain(target), span).place;
        self.body.expr(ExprKind::Address(place), ty, span)
    }

    /// The address of a place as a value of pointer type `ty`.
    pub(super) fn address(&mut self, place: PlaceId, ty: TypeId, span: Span) -> ExprId {
        match self.body.places[place].kind {
            PlaceKind::Pointer(pointer, offset) => {
                let offset = self.body.int(i64::from(offset), Types::INT, span);
                let moved = self.step(pointer, offset, span);
                self.cast_pointer(moved, ty, span)
            }
            PlaceKind::Local(local, _) => {
                self.body.locals[local].in_memory = true;
                self.body.expr(ExprKind::Address(place), ty, span)
            }
            PlaceKind::Symbol(..) | PlaceKind::Bits(..) => self.body.expr(ExprKind::Address(place), ty, span),
        }
    }

    /// A pointer with another pointer type: the same address.
    pub(super) fn cast_pointer(&mut self, pointer: ExprId, ty: TypeId, span: Span) -> ExprId {
        match self.body.exprs[pointer].kind {
            _ if self.body.ty(pointer) == ty => pointer,
            ExprKind::Address(place) => self.body.expr(ExprKind::Address(place), ty, span),
            _ => self.body.convert(pointer, ty, span),
        }
    }

    /// The place to which a pointer points.
    pub(super) fn pointee_place(&mut self, pointer: ExprId, ty: QualifiedType, span: Span) -> TypedPlace {
        let size = self.types.size_of(ty.ty).unwrap_or(0);
        let (base, offset) = self.split_base(pointer);
        let kind = match self.body.exprs[base].kind {
            ExprKind::Address(place) if offset == 0 && self.holds(place, size) => {
                self.body.places[place].kind
            }
            _ => PlaceKind::Pointer(base, offset),
        };
        let place = self.body.place(kind, ty.ty, span);
        TypedPlace { place, ty, is_lvalue: true }
    }

    /// A pointer as another one plus a constant number of bytes; casts from pointer to pointer are left out.
    fn split_base(&self, mut pointer: ExprId) -> (ExprId, i32) {
        let mut offset = 0_i32;
        loop {
            match self.body.exprs[pointer].kind {
                ExprKind::Convert(inner) if self.types.is_pointer(self.body.ty(inner)) => pointer = inner,
                ExprKind::Binary(BinaryOp::Add, base, bytes)
                    if let Some(sum) = self.small_int(bytes).and_then(|bytes| offset.checked_add(bytes)) =>
                {
                    (pointer, offset) = (base, sum);
                }
                _ => return (pointer, offset),
            }
        }
    }

    /// Reports whether `size` bytes at a place are inside its local; true for places not in locals.
    fn holds(&self, place: PlaceId, size: u32) -> bool {
        match self.body.places[place].kind {
            PlaceKind::Local(local, offset) => offset.saturating_add(size) <= self.local_size(local),
            PlaceKind::Symbol(..) | PlaceKind::Pointer(..) => true,
            PlaceKind::Bits(..) => false,
        }
    }

    fn local_size(&self, local: LocalId) -> u32 {
        self.types.size_of(self.body.locals[local].ty).unwrap_or(0)
    }

    fn small_int(&self, expr: ExprId) -> Option<i32> {
        self.body.as_int(expr).and_then(|value| i32::try_from(value).ok())
    }

    /// A pointer moved by an `int` number of bytes.
    pub(super) fn step(&mut self, pointer: ExprId, bytes: ExprId, span: Span) -> ExprId {
        let ty = self.body.ty(pointer);
        let Some(offset) = self.small_int(bytes) else {
            return self.body.expr(ExprKind::Binary(BinaryOp::Add, pointer, bytes), ty, span);
        };
        if offset == 0 {
            return pointer;
        }
        match self.body.exprs[pointer].kind {
            ExprKind::Int(address) => self.body.int(address.wrapping_add(i64::from(offset)), ty, span),
            ExprKind::Address(place)
                if let Some(kind) = self.offset_place(self.body.places[place].kind, offset) =>
            {
                let moved = self.body.place(kind, self.body.places[place].ty, span);
                self.body.expr(ExprKind::Address(moved), ty, span)
            }
            ExprKind::Binary(BinaryOp::Add, base, inner) if let Some(inner) = self.small_int(inner) => {
                let base = self.cast_pointer(base, ty, span);
                let bytes = self.body.int(i64::from(inner) + i64::from(offset), Types::INT, span);
                self.body.expr(ExprKind::Binary(BinaryOp::Add, base, bytes), ty, span)
            }
            _ => self.body.expr(ExprKind::Binary(BinaryOp::Add, pointer, bytes), ty, span),
        }
    }

    /// A place moved by `offset` bytes, if that needs no arithmetic.
    fn offset_place(&self, kind: PlaceKind, offset: i32) -> Option<PlaceKind> {
        Some(match kind {
            PlaceKind::Local(local, own) => {
                let offset = own.checked_add_signed(offset)?;
                (offset <= self.local_size(local)).then_some(PlaceKind::Local(local, offset))?
            }
            PlaceKind::Symbol(symbol, own) => PlaceKind::Symbol(symbol, own.checked_add(offset)?),
            PlaceKind::Pointer(pointer, own) => PlaceKind::Pointer(pointer, own.checked_add(offset)?),
            PlaceKind::Bits(..) => return None,
        })
    }

    /// A part of an object: a member of a structure or an element of an array.
    pub(super) fn part(
        &mut self,
        whole: TypedPlace,
        offset: u32,
        ty: QualifiedType,
        span: Span,
    ) -> TypedPlace {
        let kind = self.body.places[whole.place].kind;
        let moved = i32::try_from(offset).ok().and_then(|offset| self.offset_place(kind, offset));
        let place = self.body.place(moved.unwrap_or(kind), ty.ty, span);
        let ty = QualifiedType {
            ty: ty.ty,
            is_const: ty.is_const || whole.ty.is_const,
            is_volatile: ty.is_volatile || whole.ty.is_volatile,
        };
        TypedPlace { place, ty, is_lvalue: whole.is_lvalue }
    }

    /// A member of a structure or union.
    pub(super) fn member_of(&mut self, whole: TypedPlace, member: &Member, span: Span) -> TypedPlace {
        let part = self.part(whole, member.offset, member.ty, span);
        match member.bits {
            None => part,
            Some(bits) => {
                let place = self.body.place(PlaceKind::Bits(part.place, bits), member.ty.ty, span);
                TypedPlace { place, ..part }
            }
        }
    }
}
