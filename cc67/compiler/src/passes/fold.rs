//! Folds constants and propagates copies and sums, within a block and into the block after it if that has no other
//! predecessor.
//!
//! A fact about a value holds until that value, or the value to which the fact refers, is written again, which a
//! counter of writes for each value shows. Facts are never cleared, so the pass is linear.

use cranelift_entity::SecondaryMap;

use super::strength::{self, Simplification};
use crate::ir::function::{Function, table};
use crate::ir::inst::{Address, Base, Constant, Inst, InstKind, Operand, Terminator, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp};

/// The fact known about a value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum KnownValue {
    /// Nothing.
    Nothing,
    /// Equal to an operand.
    Operand(Operand),
    /// Equal to this address.
    Address(Address),
    /// 1 if the operand is 0, otherwise 0.
    IsZero(Operand),
}

/// A fact and the state in which it was found.
#[derive(Clone, Copy, Debug)]
struct Fact {
    known: KnownValue,
    /// The region of code in which it holds.
    region: u32,
    /// The number of writes of the value to which the fact refers.
    writes: u32,
}

impl Default for Fact {
    fn default() -> Self {
        Self { known: KnownValue::Nothing, region: u32::MAX, writes: 0 }
    }
}

/// Folds constants and copies; returns whether a branch was decided.
pub fn run(function: &mut Function) -> bool {
    let mut folder =
        Folder { facts: table(function.values.len()), writes: table(function.values.len()), region: 0 };
    let predecessors = function.predecessors();
    let mut is_decided = false;
    let mut previous = None;
    for index in 0..function.layout.len() {
        let id = function.layout[index];
        // A block whose only predecessor is the previous block inherits the facts at its end.
        if !function.is_only_way(previous, id, &predecessors) {
            folder.region += 1;
        }
        let mut insts = std::mem::take(&mut function.blocks[id].insts);
        for inst in &mut insts {
            folder.inst(function, inst);
        }
        let block = &mut function.blocks[id];
        block.insts = insts;
        is_decided |= folder.terminator(&mut block.terminator);
        previous = Some(id);
    }
    is_decided
}

struct Folder {
    facts: SecondaryMap<ValueId, Fact>,
    writes: SecondaryMap<ValueId, u32>,
    region: u32,
}

impl Folder {
    fn inst(&mut self, function: &mut Function, inst: &mut Inst) {
        inst.kind.visit_operands(|operand| *operand = self.resolve(*operand));
        if let Some(arguments) = inst.kind.arguments() {
            for argument in &mut function.arguments[arguments.range()] {
                *argument = self.resolve(*argument);
            }
        }
        self.simplify(function, inst);
        self.addresses(&mut inst.kind);
        if let Some(dst) = inst.kind.dst() {
            self.writes[dst] += 1;
            self.record_facts(dst, &inst.kind);
        }
    }

    /// The replacement of an operand: the constant or the older value to which it is known to be equal.
    fn resolve(&self, operand: Operand) -> Operand {
        match operand.as_value().map(|value| self.known_value(value)) {
            Some(KnownValue::Operand(known)) => known,
            _ => operand,
        }
    }

    /// The fact known about a value at this point.
    fn known_value(&self, value: ValueId) -> KnownValue {
        let fact = self.facts[value];
        let is_current = fact.region == self.region
            && refers_to(fact.known).is_none_or(|of| self.writes[of] == fact.writes);
        if is_current { fact.known } else { KnownValue::Nothing }
    }

    /// Records the facts about the value that an instruction writes.
    fn record_facts(&mut self, dst: ValueId, kind: &InstKind) {
        let known = match *kind {
            InstKind::Copy { src, .. } => KnownValue::Operand(src),
            InstKind::FrameAddress { slot, offset, .. } => {
                KnownValue::Address(Address { base: Base::Slot(slot), offset })
            }
            InstKind::Binary { op: BinaryOp::Add, a: Operand::Value(base), b, .. } => match b.as_int() {
                Some(offset) => KnownValue::Address(Address { base: Base::Value(base), offset }),
                None => KnownValue::Nothing,
            },
            InstKind::Compare { op: CompareOp::Equal, a, b, .. } if b.as_int() == Some(0) => {
                KnownValue::IsZero(a)
            }
            InstKind::Unary { .. }
            | InstKind::Binary { .. }
            | InstKind::Compare { .. }
            | InstKind::Convert { .. }
            | InstKind::Load { .. }
            | InstKind::Store { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Call { .. }
            | InstKind::Cost { .. } => KnownValue::Nothing,
        };
        let of = refers_to(known);
        // `i = i + 1` yields no fact about the new `i`.
        let known = if of == Some(dst) { KnownValue::Nothing } else { known };
        self.facts[dst] = Fact { known, region: self.region, writes: of.map_or(0, |of| self.writes[of]) };
    }

    /// Simplifies addresses: a known sum becomes base and offset.
    fn addresses(&self, kind: &mut InstKind) {
        match kind {
            InstKind::Load { address, .. }
            | InstKind::Store { address, .. }
            | InstKind::ClearMemory { to: address, .. } => *address = self.fold_address(*address),
            InstKind::CopyMemory { to, from, .. } => {
                *to = self.fold_address(*to);
                *from = self.fold_address(*from);
            }
            InstKind::Binary { op: BinaryOp::Add, dst, a: Operand::Value(base), b } => {
                let Some(offset) = b.as_int() else { return };
                let (dst, short) = (*dst, self.fold_address(Address { base: Base::Value(*base), offset }));
                match short.base {
                    Base::Value(base) if short.offset == 0 => {
                        *kind = InstKind::Copy { dst, src: base.into() };
                    }
                    Base::Value(base) => {
                        *kind = InstKind::Binary {
                            op: BinaryOp::Add,
                            dst,
                            a: base.into(),
                            b: Operand::int(short.offset),
                        };
                    }
                    Base::Slot(slot) => *kind = InstKind::FrameAddress { dst, slot, offset: short.offset },
                    Base::Absolute | Base::Symbol(_) => {}
                }
            }
            InstKind::Copy { .. }
            | InstKind::Unary { .. }
            | InstKind::Binary { .. }
            | InstKind::Compare { .. }
            | InstKind::Convert { .. }
            | InstKind::FrameAddress { .. }
            | InstKind::Call { .. }
            | InstKind::Cost { .. } => {}
        }
    }

    fn fold_address(&self, address: Address) -> Address {
        match address.base {
            Base::Value(value) => match self.known_value(value) {
                KnownValue::Address(known) => known.plus(address.offset),
                KnownValue::Nothing | KnownValue::Operand(_) | KnownValue::IsZero(_) => address,
            },
            Base::Absolute | Base::Slot(_) | Base::Symbol(_) => address,
        }
    }

    /// Replaces an instruction by a cheaper one with the same result.
    fn simplify(&self, function: &Function, inst: &mut Inst) {
        let Some(dst) = inst.kind.dst() else { return };
        let simplified = match inst.kind {
            InstKind::Unary { op, src, .. } => strength::unary(op, src),
            InstKind::Binary { op, a, b, .. } => strength::binary(op, a, b, function.values[dst]),
            InstKind::Compare { op, a, b, .. } => self.compare(op, a, b),
            InstKind::Convert { op, src, .. } => strength::convert(op, src),
            InstKind::Copy { .. }
            | InstKind::Load { .. }
            | InstKind::Store { .. }
            | InstKind::FrameAddress { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Call { .. }
            | InstKind::Cost { .. } => return,
        };
        match simplified {
            Simplification::No => {}
            Simplification::Operand(src) => inst.kind = InstKind::Copy { dst, src },
            Simplification::Binary(op, a, b) => inst.kind = InstKind::Binary { op, dst, a, b },
            Simplification::Compare(op, a, b) => inst.kind = InstKind::Compare { op, dst, a, b },
        }
    }

    /// A comparison; `(x == 0) == 0` and `(x == 0) != 0` are reduced to `x`.
    fn compare(&self, op: CompareOp, a: Operand, b: Operand) -> Simplification {
        if let (Operand::Value(value), Some(0)) = (a, b.as_int())
            && let KnownValue::IsZero(inner) = self.known_value(value)
        {
            match op {
                CompareOp::Equal => {
                    return Simplification::Compare(CompareOp::NotEqual, inner, Operand::int(0));
                }
                CompareOp::NotEqual => return Simplification::Operand(a),
                CompareOp::Less
                | CompareOp::LessEqual
                | CompareOp::LessUnsigned
                | CompareOp::LessEqualUnsigned => {}
            }
        }
        strength::compare(op, a, b)
    }

    /// Resolves the operand of a terminator; returns whether that decided its target.
    fn terminator(&self, terminator: &mut Terminator) -> bool {
        if let Some(operand) = terminator.operand_mut() {
            *operand = self.resolve(*operand);
        }
        match terminator {
            Terminator::Branch { condition, then, otherwise } => {
                if let Operand::Constant(Constant::I32(value)) = *condition {
                    *terminator = Terminator::Jump(if value == 0 { *otherwise } else { *then });
                    return true;
                }
                if let Some(value) = condition.as_value()
                    && let KnownValue::IsZero(inner) = self.known_value(value)
                {
                    *terminator = Terminator::Branch { condition: inner, then: *otherwise, otherwise: *then };
                }
                false
            }
            Terminator::Table { index, targets, default } => {
                let Some(index) = index.as_int() else { return false };
                let target = targets.get(index.cast_unsigned() as usize).copied();
                *terminator = Terminator::Jump(target.unwrap_or(*default));
                true
            }
            Terminator::Jump(_) | Terminator::Return(_) | Terminator::Unreachable => false,
        }
    }
}

/// The other value on which a fact depends.
const fn refers_to(known: KnownValue) -> Option<ValueId> {
    match known {
        KnownValue::Operand(operand) | KnownValue::IsZero(operand) => operand.as_value(),
        KnownValue::Address(Address { base: Base::Value(value), .. }) => Some(value),
        KnownValue::Nothing | KnownValue::Address(_) => None,
    }
}
