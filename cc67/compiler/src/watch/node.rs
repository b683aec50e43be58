//! The computation of an expression, made once: it is repeated every tick, where to find names again would cost more than
//! to compute.

use std::collections::BTreeMap;

use kmotiondef::GuestAddr;

use super::{CallRequest, ItemReader, Local, Meaning, Operation, bits, read, slot_of};
use crate::ir::operators as machine;
use crate::operators::{BinaryOp, CompareOp};
use crate::sema::constants::{self, Constant};
use crate::ty::{BitRange, TypeId, Types};
use crate::typed::{
    Call, Callee, ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, SymbolId, UnaryOp,
};

/// The computation of a value.
#[derive(Debug)]
pub(super) enum Node {
    Constant(Constant),
    /// An item of the board.
    Item(usize),
    /// The contents of a place.
    Read(Place, TypeId),
    /// A local as a whole, which may be in a register.
    Local(LocalId, TypeId),
    /// A bit-field of a word.
    Field(Box<Self>, BitRange, TypeId),
    Address(Place),
    Not(Box<Self>),
    Unary(UnaryOp, Box<Self>, TypeId),
    Binary(BinaryOp, Box<[Self; 2]>, TypeId),
    /// A comparison of two values of a type.
    Compare(CompareOp, Box<[Self; 2]>, TypeId),
    And(Box<[Self; 2]>),
    Or(Box<[Self; 2]>),
    Conditional(Box<[Self; 3]>),
    /// A conversion from a type to another one.
    Convert(Box<Self>, [TypeId; 2]),
    /// A function that is computed without the board.
    Computed(Operation, Box<Self>),
    /// A function that the board executes; its arguments and result with their types.
    Executed(ExprId, GuestAddr, Vec<(Self, TypeId)>, TypeId),
    /// Something without a value.
    Nothing,
}

/// A place in memory.
#[derive(Debug)]
pub(super) enum Place {
    Fixed(GuestAddr),
    /// At a distance from the address that a pointer variable holds, as of most pointers.
    Variable(GuestAddr, i32),
    /// At a distance from the address that a pointer has.
    Pointed(Box<Node>, i32),
    /// At a distance from the beginning of a local that is in memory.
    Local(LocalId, u32),
    /// Something that is not in memory.
    Nowhere,
}

impl Place {
    #[inline]
    pub(super) fn address<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<GuestAddr> {
        match self {
            Self::Fixed(address) => Some(*address),
            Self::Variable(variable, distance) => {
                let [b0, b1, b2, b3, ..] = reader.bytes(*variable);
                let address = u32::from_le_bytes([b0, b1, b2, b3]);
                Some(GuestAddr::new(address.wrapping_add_signed(*distance)))
            }
            Self::Pointed(pointer, distance) => match pointer.value(reader)? {
                Constant::Int(address) => {
                    Some(GuestAddr::new((address as u32).wrapping_add_signed(*distance)))
                }
                Constant::Float(_) => None,
            },
            Self::Local(local, distance) => match reader.local(*local)? {
                Local::Memory(address) => Some(GuestAddr::new(address.get().wrapping_add(*distance))),
                Local::Slot(_) => None,
            },
            Self::Nowhere => None,
        }
    }
}

impl Node {
    /// The value now; `None` where it divides an integer by 0 or reads what has no value.
    pub(super) fn value<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<Constant> {
        let boolean = |value: bool| Constant::Int(value.into());
        Some(match self {
            Self::Constant(constant) => *constant,
            Self::Item(index) => Constant::Float(reader.item(*index)),
            Self::Read(_, Types::DOUBLE) | Self::Binary(_, _, Types::DOUBLE) | Self::Computed(..) => {
                Constant::Float(self.double(reader)?)
            }
            Self::Read(place, ty) => read(*ty, reader.bytes(place.address(reader)?)),
            Self::Local(local, ty) => match reader.local(*local)? {
                Local::Slot(bits) => read(*ty, bits.to_le_bytes()),
                Local::Memory(address) => read(*ty, reader.bytes(address)),
            },
            Self::Field(word, range, ty) => match word.value(reader)? {
                Constant::Int(word) => Constant::Int(bits(word, *range, *ty)),
                Constant::Float(_) => return None,
            },
            Self::Address(place) => Constant::Int(place.address(reader)?.get().into()),
            Self::Not(_) | Self::And(_) | Self::Or(_) => boolean(self.truth(reader)?),
            Self::Unary(op, a, ty) => constants::unary(*op, a.value(reader)?, *ty)?,
            Self::Binary(op, sides, ty) => {
                let [a, b] = &**sides;
                constants::binary(*op, a.value(reader)?, b.value(reader)?, *ty)?
            }
            Self::Compare(_, _, Types::DOUBLE) => boolean(self.truth(reader)?),
            Self::Compare(op, sides, ty) => {
                let [a, b] = &**sides;
                boolean(constants::compare(*op, a.value(reader)?, b.value(reader)?, *ty)?)
            }
            Self::Conditional(parts) => {
                let [test, a, b] = &**parts;
                return if test.truth(reader)? { a } else { b }.value(reader);
            }
            Self::Convert(a, [from, to]) => constants::convert(a.value(reader)?, *from, *to),
            Self::Executed(id, function, arguments, ty) => {
                let slot = |(argument, ty): &(Self, TypeId)| Some(slot_of(argument.value(reader)?, *ty));
                let arguments = arguments.iter().map(slot).collect::<Option<Vec<_>>>()?;
                let slot = reader.result(CallRequest { id: *id, function: *function, arguments })?;
                read(*ty, slot.to_le_bytes())
            }
            Self::Nothing => return None,
        })
    }

    /// Returns whether the value now is not 0. Conditions are computed every tick: this and `double` are the short way of
    /// most of them.
    pub(super) fn truth<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<bool> {
        Some(match self {
            Self::Compare(op, sides, Types::DOUBLE) => {
                let [a, b] = &**sides;
                op.holds(a.double(reader)?.partial_cmp(&b.double(reader)?))
            }
            Self::Not(a) => !a.truth(reader)?,
            Self::And(sides) => sides[0].truth(reader)? && sides[1].truth(reader)?,
            Self::Or(sides) => sides[0].truth(reader)? || sides[1].truth(reader)?,
            other => other.value(reader)?.is_true(),
        })
    }

    /// The value now of an expression of type `double`.
    fn double<R: ItemReader + ?Sized>(&self, reader: &R) -> Option<f64> {
        match self {
            Self::Read(place, Types::DOUBLE) => {
                Some(f64::from_le_bytes(reader.bytes(place.address(reader)?)))
            }
            Self::Binary(op, sides, Types::DOUBLE) => {
                let [a, b] = &**sides;
                let (a, b) = (a.double(reader)?, b.double(reader)?);
                machine::BinaryOp::of(*op, false).on_floats(a, b)
            }
            Self::Computed(function, argument) => argument.double(reader).map(function),
            Self::Constant(Constant::Float(value)) => Some(*value),
            Self::Item(index) => Some(reader.item(*index)),
            other => match other.value(reader)? {
                Constant::Float(value) => Some(value),
                Constant::Int(_) => None,
            },
        }
    }
}

/// Makes the computation of an expression of a function.
pub(super) struct Builder<'a> {
    pub(super) function: &'a Function,
    pub(super) meanings: &'a BTreeMap<SymbolId, Meaning>,
}

impl Builder<'_> {
    pub(super) fn node(&self, id: ExprId) -> Node {
        let expr = &self.function.exprs[id];
        let ty_of = |id: ExprId| self.function.exprs[id].ty;
        let boxed = |id: ExprId| Box::new(self.node(id));
        let pair = |a: ExprId, b: ExprId| Box::new([self.node(a), self.node(b)]);
        match &expr.kind {
            ExprKind::Int(value) => Node::Constant(Constant::Int(*value)),
            ExprKind::Float(value) => Node::Constant(Constant::Float(*value)),
            ExprKind::Load(place) => self.load(*place),
            ExprKind::Address(place) => Node::Address(self.place(*place)),
            ExprKind::Unary(UnaryOp::Not, a) => Node::Not(boxed(*a)),
            ExprKind::Unary(op, a) => Node::Unary(*op, boxed(*a), expr.ty),
            ExprKind::Binary(op, a, b) => Node::Binary(*op, pair(*a, *b), expr.ty),
            ExprKind::Compare(op, a, b) => Node::Compare(*op, pair(*a, *b), ty_of(*a)),
            ExprKind::And(a, b) => Node::And(pair(*a, *b)),
            ExprKind::Or(a, b) => Node::Or(pair(*a, *b)),
            ExprKind::Conditional(test, a, b) => {
                Node::Conditional(Box::new([self.node(*test), self.node(*a), self.node(*b)]))
            }
            ExprKind::Comma(_, b) => self.node(*b),
            ExprKind::Convert(a) => Node::Convert(boxed(*a), [ty_of(*a), expr.ty]),
            ExprKind::Call(call) => self.call(id, call),
            ExprKind::Assign(..)
            | ExprKind::Update(_)
            | ExprKind::Copy { .. }
            | ExprKind::Clear(_)
            | ExprKind::VaArg(_)
            | ExprKind::Statements(..) => Node::Nothing,
        }
    }

    fn call(&self, id: ExprId, call: &Call) -> Node {
        let Callee::Symbol(symbol) = call.callee else { return Node::Nothing };
        let ty_of = |id: ExprId| self.function.exprs[id].ty;
        match (self.meanings.get(&symbol), call.arguments.as_slice()) {
            (Some(Meaning::Function(function)), [argument]) => {
                Node::Computed(*function, Box::new(self.node(*argument)))
            }
            (Some(Meaning::Code(address)), arguments) => {
                let arguments = arguments.iter().map(|id| (self.node(*id), ty_of(*id)));
                Node::Executed(id, *address, arguments.collect(), ty_of(id))
            }
            (Some(Meaning::Function(_) | Meaning::Variable(_) | Meaning::Item(_)) | None, _) => Node::Nothing,
        }
    }

    fn load(&self, id: PlaceId) -> Node {
        let place = &self.function.places[id];
        match place.kind {
            PlaceKind::Symbol(symbol, _) if let Some(Meaning::Item(index)) = self.meanings.get(&symbol) => {
                Node::Item(*index)
            }
            PlaceKind::Bits(unit, range) => Node::Field(Box::new(self.load(unit)), range, place.ty),
            PlaceKind::Local(local, 0) => Node::Local(local, place.ty),
            PlaceKind::Symbol(..) | PlaceKind::Pointer(..) | PlaceKind::Local(..) => {
                Node::Read(self.place(id), place.ty)
            }
        }
    }

    pub(super) fn place(&self, id: PlaceId) -> Place {
        match self.function.places[id].kind {
            PlaceKind::Symbol(symbol, offset) => match self.meanings.get(&symbol) {
                Some(Meaning::Variable(address)) => {
                    Place::Fixed(GuestAddr::new(address.get().wrapping_add_signed(offset)))
                }
                Some(Meaning::Item(_) | Meaning::Function(_) | Meaning::Code(_)) | None => Place::Nowhere,
            },
            PlaceKind::Pointer(pointer, offset) => match self.node(pointer) {
                Node::Read(Place::Fixed(variable), _) => Place::Variable(variable, offset),
                pointer => Place::Pointed(Box::new(pointer), offset),
            },
            PlaceKind::Local(local, offset) => Place::Local(local, offset),
            PlaceKind::Bits(..) => Place::Nowhere,
        }
    }
}
