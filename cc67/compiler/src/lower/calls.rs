//! Calls: arguments, variable arguments, results.

use super::{Lowering, types};
use crate::ir::function::Signature;
use crate::ir::inst::{Address, Base, Callee, Class, Operand, SlotId, ValueId};
use crate::ir::operators::{BinaryOp, Width};
use crate::ty::TypeId;
use crate::typed::{self, Call, Expr, PlaceId};

impl Lowering<'_> {
    /// Lowers a call expression. The code is attributed to the expression, not to its statement.
    pub(super) fn call(&mut self, call: &Call, expr: &Expr, into: Option<ValueId>) -> Operand {
        let target = match call.callee {
            typed::Callee::Symbol(_) => None,
            typed::Callee::Pointer(pointer) => {
                let target = self.value(pointer);
                Some(self.hold_operand(target))
            }
        };
        let arguments = self.arguments(call);
        let callee = match (call.callee, target) {
            (typed::Callee::Symbol(symbol), _) => Callee::Symbol(symbol),
            (typed::Callee::Pointer(_), Some(held)) => Callee::Pointer(self.release(held)),
            (typed::Callee::Pointer(_), None) => return Operand::int(0),
        };
        self.charge_call(call);
        let wanted = types::class(&self.unit.types, expr.ty);
        let declared = Signature {
            params: arguments.iter().map(|argument| self.builder.function.class(*argument)).collect(),
            result: types::class(&self.unit.types, call.ty.result),
        };
        let (signature, arguments) = match callee {
            Callee::Symbol(symbol) if self.definitions.get(symbol).is_some() => {
                self.adapt_arguments(symbol, &declared, arguments)
            }
            _ => (self.signatures.intern(&declared), arguments),
        };
        let result = self.signatures.get(signature).result;
        let dst = match (result, wanted) {
            (Some(class), Some(wanted)) if class == wanted => Some(self.destination(class, into)),
            (Some(class), Some(_)) => Some(self.builder.value(class)),
            _ => None,
        };
        let statement = self.builder.span();
        self.builder.set_span(expr.span);
        self.builder.call(callee, signature, arguments, dst);
        self.builder.set_span(statement);
        self.charge_result(wanted);
        match (dst, wanted) {
            (Some(dst), Some(wanted)) if result != Some(wanted) => {
                let adapted = self.adapt_class(dst.into(), wanted);
                self.place_in(adapted, into)
            }
            (Some(dst), _) => dst.into(),
            (None, Some(wanted)) => self.place_in(wanted.zero().into(), into),
            (None, None) => Operand::int(0),
        }
    }

    /// Evaluates the arguments from left to right; variable arguments are stored in the frame, and their address
    /// becomes the last argument.
    fn arguments(&mut self, call: &Call) -> Vec<Operand> {
        let bottom = self.held.len();
        let variable = call.variable.as_deref();
        for argument in call.arguments.iter().chain(variable.unwrap_or(&[])) {
            let value = self.value(*argument);
            let held = self.hold_operand(value);
            self.held.push(held);
        }
        let mut operands: Vec<Operand> = Vec::with_capacity(self.held.len() - bottom);
        while self.held.len() > bottom {
            let Some(held) = self.held.pop() else { break };
            let operand = self.release(held);
            operands.push(operand);
        }
        operands.reverse();
        if variable.is_some() {
            let rest = operands.split_off(call.arguments.len());
            let area = self.store_variable(&rest);
            operands.push(area);
        }
        operands
    }

    /// Stores variable arguments one after another, each aligned to its size; returns where they start.
    fn store_variable(&mut self, arguments: &[Operand]) -> Operand {
        if arguments.is_empty() {
            return Operand::int(0);
        }
        let slot = self.outgoing_area();
        let mut offset = 0_u32;
        for argument in arguments {
            let width = match self.builder.function.class(*argument) {
                Class::I32 => Width::I32,
                Class::I64 => Width::I64,
                Class::F32 => Width::F32,
                Class::F64 => Width::F64,
            };
            offset = offset.next_multiple_of(width.bytes());
            let address = Address::new(Base::Slot(slot)).plus(offset.cast_signed());
            self.builder.store(*argument, width, address);
            offset += width.bytes();
        }
        let area = &mut self.builder.function.slots[slot];
        area.size = area.size.max(offset);
        self.address_value(Address::new(Base::Slot(slot)), None)
    }

    /// The frame object for the variable arguments of the current call; all arguments are evaluated before the first is
    /// stored, so one object is enough even for nested calls.
    fn outgoing_area(&mut self) -> SlotId {
        if let Some(slot) = self.outgoing {
            return slot;
        }
        let slot = self.builder.slot(0, 8);
        self.outgoing = Some(slot);
        self.builder.function.outgoing = Some(slot);
        slot
    }

    /// Adapts the arguments to the definition of a function of this unit: a call through an old-style declaration may
    /// pass other types, too many or too few.
    fn adapt_arguments(
        &mut self,
        symbol: typed::SymbolId,
        declared: &Signature,
        mut arguments: Vec<Operand>,
    ) -> (crate::ir::inst::SignatureId, Vec<Operand>) {
        let signature = match self.definitions.get(symbol) {
            Some(signature) => signature,
            None => self.signatures.intern(declared),
        };
        if self.signatures.get(signature).params == declared.params {
            return (signature, arguments);
        }
        let params = self.signatures.get(signature).params.clone();
        arguments.truncate(params.len());
        for (index, class) in params.into_iter().enumerate() {
            match arguments.get(index).copied() {
                Some(argument) => arguments[index] = self.adapt_class(argument, class),
                None => arguments.push(class.zero().into()),
            }
        }
        (signature, arguments)
    }

    /// `va_arg`: loads the next variable argument and steps over it.
    pub(super) fn variable_argument(&mut self, list: PlaceId, ty: TypeId, into: Option<ValueId>) -> Operand {
        let width = types::width(&self.unit.types, ty).unwrap_or(Width::I32);
        let size = width.bytes().max(4).cast_signed();
        let storage = self.place(list);
        self.charge_load(list);
        self.cost(20);
        let mut at = self.read(storage, None);
        if size == 8 {
            let raised = self.binary_value(BinaryOp::Add, Class::I32, at, Operand::int(7));
            at = self.binary_value(BinaryOp::And, Class::I32, raised, Operand::int(-8));
        }
        let dst = self.builder.value(width.class());
        self.builder.load(dst, width, Address::of(at));
        let next = self.binary_value(BinaryOp::Add, Class::I32, at, Operand::int(size));
        self.write(storage, next);
        self.place_in(dst.into(), into)
    }
}
