//! Expressions to instructions.
//!
//! [`Lowering::value_in`] takes the value that should receive the result, if any; that value is only written by the
//! last instruction, so that the expression may still read it.

use super::conditions::Sense;
use super::places::Storage;
use super::{Lowering, cost_table, types};
use crate::ir::function::Signature;
use crate::ir::inst::{Address, Callee, Class, Constant, InstKind, Operand, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp, UnaryOp, Width};
use crate::operators;
use crate::ty::TypeId;
use crate::typed::{self, ExprId, ExprKind, PlaceId, Update, UpdateResult};

impl Lowering<'_> {
    /// Evaluates an expression.
    pub(super) fn value(&mut self, id: ExprId) -> Operand {
        self.value_in(id, None)
    }

    /// Evaluates an expression into `into`, if given; returns the operand that holds the result. An expression without
    /// a value yields an operand that is never read.
    pub(super) fn value_in(&mut self, id: ExprId, into: Option<ValueId>) -> Operand {
        let expr = &self.function.exprs[id];
        match expr.kind {
            ExprKind::Int(value) => {
                self.charge_constant(self.class_or_int(expr.ty));
                let constant = Constant::number(self.class_or_int(expr.ty), value);
                self.place_in(constant.into(), into)
            }
            ExprKind::Float(value) => {
                self.charge_constant(self.class_or_int(expr.ty));
                let constant = match self.class_or_int(expr.ty) {
                    Class::F32 => Constant::F32((value as f32).to_bits()),
                    Class::F64 | Class::I32 | Class::I64 => Constant::F64(value.to_bits()),
                };
                self.place_in(constant.into(), into)
            }
            ExprKind::Load(place) => {
                let storage = self.place(place);
                self.charge_load(place);
                self.read(storage, into)
            }
            ExprKind::Address(place) => {
                let address = self.address(place);
                self.charge_address(place);
                self.address_value(address, into)
            }
            ExprKind::Assign(place, value) => self.assign(place, value, into),
            ExprKind::Update(ref update) => self.update(update, into),
            ExprKind::Copy { to, from } => self.copy(to, from),
            ExprKind::Clear(place) => self.clear(place),
            ExprKind::Unary(op, operand) => self.unary(op, operand, into),
            ExprKind::Binary(..) => self.binary(id, into),
            ExprKind::Compare(op, a, b) => self.compare(op, a, b, into),
            ExprKind::And(..) | ExprKind::Or(..) => self.lower_truth(id, into),
            ExprKind::Conditional(condition, a, b) => self.conditional(condition, a, b, expr.ty, into),
            ExprKind::Comma(first, second) => {
                self.lower_effect(first);
                self.value_in(second, into)
            }
            ExprKind::Convert(operand) => {
                if types::class(&self.unit.types, expr.ty).is_none() {
                    self.lower_effect(operand);
                    return Operand::int(0);
                }
                let from = self.function.exprs[operand].ty;
                let value = self.value(operand);
                self.charge_conversion(operand, self.class_or_int(expr.ty));
                self.convert(value, from, expr.ty, into)
            }
            ExprKind::Call(ref call) => self.call(call, expr, into),
            ExprKind::VaArg(list) => self.variable_argument(list, expr.ty, into),
            ExprKind::Statements(ref statements, value) => {
                self.statements(statements);
                value.map_or(Operand::int(0), |value| self.value_in(value, into))
            }
        }
    }

    /// Evaluates an expression whose value is not needed.
    pub(super) fn lower_effect(&mut self, id: ExprId) {
        let expr = &self.function.exprs[id];
        match expr.kind {
            ExprKind::Update(ref update) => {
                self.step(update);
            }
            ExprKind::Comma(first, second) => {
                self.lower_effect(first);
                self.lower_effect(second);
            }
            ExprKind::Convert(operand) => self.lower_effect(operand),
            ExprKind::Call(_) => {
                self.value(id);
                if let Some(class) = types::class(&self.unit.types, expr.ty) {
                    self.cost(-cost_table::result(class));
                }
            }
            ExprKind::And(..) | ExprKind::Or(..) => {
                let end = self.builder.block();
                self.branch(id, Sense::JumpIfFalse, end, end);
                self.builder.open(end);
            }
            ExprKind::Conditional(condition, a, b) => {
                let (then, otherwise, end) =
                    (self.builder.block(), self.builder.block(), self.builder.block());
                self.branch(condition, Sense::JumpIfFalse, then, otherwise);
                self.builder.open(then);
                self.lower_effect(a);
                self.cost(cost_table::BRANCH);
                self.builder.jump(end);
                self.builder.open(otherwise);
                self.lower_effect(b);
                self.builder.open(end);
            }
            ExprKind::Statements(ref statements, value) => {
                self.statements(statements);
                if let Some(value) = value {
                    self.lower_effect(value);
                }
            }
            _ => {
                self.value(id);
            }
        }
    }

    /// The value that an instruction should write: the requested one or a new one.
    pub(super) fn destination(&mut self, class: Class, into: Option<ValueId>) -> ValueId {
        into.unwrap_or_else(|| self.builder.value(class))
    }

    /// Moves an operand to the requested value, if there is one.
    pub(super) fn place_in(&mut self, operand: Operand, into: Option<ValueId>) -> Operand {
        let Some(dst) = into else { return operand };
        self.builder.copy(dst, operand);
        dst.into()
    }

    fn assign(&mut self, place: PlaceId, value: ExprId, into: Option<ValueId>) -> Operand {
        let storage = self.place(place);
        if let Storage::Value(dst) = storage {
            self.value_in(value, Some(dst));
            self.charge_assignment(place, value);
            self.record_write(dst);
            return self.place_in(dst.into(), into);
        }
        let held = self.hold_storage(storage);
        let source = value;
        let value = self.value(source);
        self.charge_assignment(place, source);
        let storage = self.release_storage(held);
        let stored = self.write(storage, value);
        self.place_in(stored, into)
    }

    fn update(&mut self, update: &Update, into: Option<ValueId>) -> Operand {
        let (old, new) = match update.result {
            UpdateResult::New => (None, self.step(update)),
            UpdateResult::Old => self.step_keeping_old(update),
        };
        self.place_in(old.unwrap_or(new), into)
    }

    /// `place = place op operand`; returns the new value.
    fn step(&mut self, update: &Update) -> Operand {
        let storage = self.place(update.place);
        let held = self.hold_storage(storage);
        let operand = self.value(update.operand);
        self.charge_update(update);
        let storage = self.release_storage(held);
        let old = self.read(storage, None);
        let into = match storage {
            Storage::Value(value) => Some(value),
            _ => None,
        };
        let new = self.updated(update, old, operand, into);
        self.write(storage, new)
    }

    /// `place = place op operand`; returns the old and the new value.
    fn step_keeping_old(&mut self, update: &Update) -> (Option<Operand>, Operand) {
        let storage = self.place(update.place);
        let held = self.hold_storage(storage);
        let operand = self.value(update.operand);
        self.charge_update(update);
        let storage = self.release_storage(held);
        let mut old = self.read(storage, None);
        if let Storage::Value(value) = storage {
            let class = self.builder.function.values[value];
            let saved = self.builder.value(class);
            self.builder.copy(saved, old);
            old = saved.into();
        }
        let into = match storage {
            Storage::Value(value) => Some(value),
            _ => None,
        };
        let new = self.updated(update, old, operand, into);
        (Some(old), self.write(storage, new))
    }

    /// `(type of place)((computed)old op operand)`
    fn updated(&mut self, update: &Update, old: Operand, operand: Operand, into: Option<ValueId>) -> Operand {
        let ty = self.function.places[update.place].ty;
        let old = self.convert(old, ty, update.computed, None);
        let class = self.class_or_int(update.computed);
        let op = self.binary_op(update.op, update.computed);
        let same = ty == update.computed;
        let dst = self.destination(class, if same { into } else { None });
        self.emit_binary(op, dst, old, operand);
        self.convert(dst.into(), update.computed, ty, if same { None } else { into })
    }

    fn copy(&mut self, to: PlaceId, from: PlaceId) -> Operand {
        let (len, _) = types::layout(&self.unit.types, self.function.places[to].ty);
        let (to_place, from_place) = (to, from);
        let to = self.address(to);
        let held = self.hold_storage(Storage::Memory(to, Width::I32));
        let from = self.address(from);
        self.charge_address(to_place);
        self.charge_address(from_place);
        self.charge_block(len, true);
        if let Storage::Memory(to, _) = self.release_storage(held) {
            self.builder.push(InstKind::CopyMemory { to, from, len });
        }
        Operand::int(0)
    }

    fn clear(&mut self, place: PlaceId) -> Operand {
        let (len, _) = types::layout(&self.unit.types, self.function.places[place].ty);
        let to: Address = self.address(place);
        self.charge_address(place);
        self.charge_block(len, false);
        self.builder.push(InstKind::ClearMemory { to, len });
        Operand::int(0)
    }

    fn unary(&mut self, op: typed::UnaryOp, operand: ExprId, into: Option<ValueId>) -> Operand {
        let value = self.value(operand);
        self.charge_unary(operand, op);
        let class = self.builder.function.class(value);
        match op {
            typed::UnaryOp::Negate | typed::UnaryOp::Complement => {
                let op = if op == typed::UnaryOp::Negate { UnaryOp::Negate } else { UnaryOp::Complement };
                let dst = self.destination(class, into);
                self.builder.unary(op, dst, value);
                dst.into()
            }
            typed::UnaryOp::Not => {
                let dst = self.destination(Class::I32, into);
                self.builder.compare(CompareOp::Equal, dst, value, class.zero().into());
                dst.into()
            }
        }
    }

    /// A binary operator; long chains such as `a + b + c + …` are nested on the left and walked iteratively.
    fn binary(&mut self, id: ExprId, into: Option<ValueId>) -> Operand {
        let bottom = self.spine.len();
        let mut first = id;
        while let ExprKind::Binary(_, a, _) = self.function.exprs[first].kind {
            self.spine.push(first);
            first = a;
        }
        let mut left = self.value(first);
        while self.spine.len() > bottom {
            let Some(node) = self.spine.pop() else { break };
            let expr = &self.function.exprs[node];
            let ExprKind::Binary(op, a_expr, b) = expr.kind else { break };
            let held = self.hold_operand(left);
            let right = self.value(b);
            self.charge_kept(a_expr, b);
            self.charge_binary(node);
            let a = self.release(held);
            let dst = self.destination(self.class_or_int(expr.ty), if node == id { into } else { None });
            let op = self.binary_op(op, expr.ty);
            self.emit_binary(op, dst, a, right);
            left = dst.into();
        }
        left
    }

    /// `dst = a op b`, where the firmware may divide. Quotients of constants have been folded before.
    fn emit_binary(&mut self, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) {
        let are_constant = a.as_value().is_none() && b.as_value().is_none();
        let class = self.builder.function.class(dst.into());
        let function = match (op, class, self.unit.divisions) {
            (BinaryOp::Divide, Class::F32, Some(divisions)) => divisions.single,
            (BinaryOp::Divide, Class::F64, Some(divisions)) => divisions.double,
            _ => return self.builder.binary(op, dst, a, b),
        };
        if are_constant {
            return self.builder.binary(op, dst, a, b);
        }
        // The call is charged for itself.
        self.cost(-cost_table::division(class));
        let signature = self.signatures.intern(&Signature { params: vec![class; 2], result: Some(class) });
        self.builder.call(Callee::Symbol(function), signature, [a, b], Some(dst));
    }

    fn compare(&mut self, op: operators::CompareOp, a: ExprId, b: ExprId, into: Option<ValueId>) -> Operand {
        let is_unsigned = types::is_unsigned(&self.unit.types, self.function.exprs[a].ty);
        let first = self.value(a);
        let held = self.hold_operand(first);
        let second = self.value(b);
        self.charge_kept(a, b);
        self.charge_compare(a, b);
        // A comparison as a value; a test takes it back.
        self.cost(cost_table::MOVE);
        let first = self.release(held);
        let (op, is_swapped) = compare_op(op, is_unsigned);
        let dst = self.destination(Class::I32, into);
        let (a, b) = if is_swapped { (second, first) } else { (first, second) };
        self.builder.compare(op, dst, a, b);
        dst.into()
    }

    /// The value 0 or 1 of a condition.
    fn lower_truth(&mut self, id: ExprId, into: Option<ValueId>) -> Operand {
        let (yes, no, end) = (self.builder.block(), self.builder.block(), self.builder.block());
        let is_and = matches!(self.function.exprs[id].kind, ExprKind::And(..));
        let [by_way, by_jump] = cost_table::TRUTH;
        self.branch(id, Sense::of(is_and), yes, no);
        let dst = self.destination(Class::I32, into);
        self.builder.open(yes);
        self.cost(if is_and { by_way } else { by_jump });
        self.builder.copy(dst, Operand::int(1));
        self.builder.jump(end);
        self.builder.open(no);
        self.cost(if is_and { by_jump } else { by_way });
        self.builder.copy(dst, Operand::int(0));
        self.builder.open(end);
        dst.into()
    }

    fn conditional(
        &mut self,
        condition: ExprId,
        a: ExprId,
        b: ExprId,
        ty: TypeId,
        into: Option<ValueId>,
    ) -> Operand {
        let Some(class) = types::class(&self.unit.types, ty) else {
            let (then, otherwise, end) = (self.builder.block(), self.builder.block(), self.builder.block());
            self.branch(condition, Sense::JumpIfFalse, then, otherwise);
            self.builder.open(then);
            self.lower_effect(a);
            self.cost(cost_table::BRANCH);
            self.builder.jump(end);
            self.builder.open(otherwise);
            self.lower_effect(b);
            self.builder.open(end);
            return Operand::int(0);
        };
        let (then, otherwise, end) = (self.builder.block(), self.builder.block(), self.builder.block());
        self.branch(condition, Sense::JumpIfFalse, then, otherwise);
        let dst = self.destination(class, into);
        self.builder.open(then);
        self.value_in(a, Some(dst));
        self.cost(cost_table::BRANCH);
        self.builder.jump(end);
        self.builder.open(otherwise);
        self.value_in(b, Some(dst));
        self.builder.open(end);
        dst.into()
    }

    /// The machine's operator for operands of type `ty`.
    fn binary_op(&self, op: operators::BinaryOp, ty: TypeId) -> BinaryOp {
        let is_unsigned = types::is_unsigned(&self.unit.types, ty);
        BinaryOp::of(op, is_unsigned)
    }
}

/// The machine's comparison, and whether the operands change places.
const fn compare_op(op: operators::CompareOp, is_unsigned: bool) -> (CompareOp, bool) {
    let (op, is_swapped) = match op {
        operators::CompareOp::Equal => return (CompareOp::Equal, false),
        operators::CompareOp::NotEqual => return (CompareOp::NotEqual, false),
        operators::CompareOp::Less => (CompareOp::Less, false),
        operators::CompareOp::LessEqual => (CompareOp::LessEqual, false),
        operators::CompareOp::Greater => (CompareOp::Less, true),
        operators::CompareOp::GreaterEqual => (CompareOp::LessEqual, true),
    };
    match (op, is_unsigned) {
        (CompareOp::Less, true) => (CompareOp::LessUnsigned, is_swapped),
        (CompareOp::LessEqual, true) => (CompareOp::LessEqualUnsigned, is_swapped),
        _ => (op, is_swapped),
    }
}
