//! Conversions between scalar types.

use super::{Lowering, types};
use crate::ir::inst::{Class, Operand, ValueId};
use crate::ir::operators::{CompareOp, ConvertOp, Width};
use crate::ty::{TypeId, Types};

impl Lowering<'_> {
    /// Converts a value of type `from` to type `to`.
    pub(super) fn convert(
        &mut self,
        operand: Operand,
        from: TypeId,
        to: TypeId,
        into: Option<ValueId>,
    ) -> Operand {
        if to == Types::BOOL && from != Types::BOOL {
            let dst = self.destination(Class::I32, into);
            let zero = self.builder.function.class(operand).zero();
            self.builder.compare(CompareOp::NotEqual, dst, operand, zero.into());
            return dst.into();
        }
        let steps = self.steps(from, to);
        let mut operand = operand;
        let last = steps.iter().flatten().count();
        for (index, op) in steps.into_iter().flatten().enumerate() {
            let into = if index + 1 == last { into } else { None };
            let dst = self.destination(op.to(), into);
            self.builder.convert(op, dst, operand);
            operand = dst.into();
        }
        self.place_in(operand, into)
    }

    /// The instructions of a conversion: to the class of the result, possibly through another class, then to its width.
    fn steps(&self, from: TypeId, to: TypeId) -> [Option<ConvertOp>; 3] {
        let types = &self.unit.types;
        let (Some(from_width), Some(to_width)) = (types::width(types, from), types::width(types, to)) else {
            return [None; 3];
        };
        let [first, second] = match (from_width.class(), to_width.class()) {
            (Class::F32, Class::I64) => [
                Some(ConvertOp::F64FromF32),
                float_to_int(Class::F64, Class::I64, types::is_unsigned(types, to)),
            ],
            (source @ (Class::F32 | Class::F64), target @ (Class::I32 | Class::I64)) => {
                // To `char` and `short` through `int` (specification, dialect.md 1.4).
                let is_unsigned = types::is_unsigned(types, to) && to_width.normalize().is_none();
                [float_to_int(source, target, is_unsigned), None]
            }
            (source, target) => [number_to_number(source, target, types::is_unsigned(types, from)), None],
        };
        let fits = first.is_none() && is_inside(from_width, to_width);
        [first, second, if fits { None } else { to_width.normalize() }]
    }

    /// Makes the class of an argument or result the expected one, where a call and a definition disagree.
    pub(super) fn adapt_class(&mut self, operand: Operand, to: Class) -> Operand {
        let type_of = |class| match class {
            Class::I32 => Types::INT,
            Class::I64 => Types::LONG_LONG,
            Class::F32 => Types::FLOAT,
            Class::F64 => Types::DOUBLE,
        };
        let from = self.builder.function.class(operand);
        self.convert(operand, type_of(from), type_of(to), None)
    }
}

/// Reports whether every value of the width `from` is one of the width `to`.
fn is_inside(from: Width, to: Width) -> bool {
    match to {
        Width::I8 => from == Width::I8,
        Width::U8 => from == Width::U8,
        Width::I16 => matches!(from, Width::I8 | Width::U8 | Width::I16),
        Width::U16 => matches!(from, Width::U8 | Width::U16),
        Width::I32 | Width::I64 | Width::F32 | Width::F64 => true,
    }
}

fn float_to_int(from: Class, to: Class, is_unsigned: bool) -> Option<ConvertOp> {
    match (from, to, is_unsigned) {
        (Class::F32, Class::I32, false) => Some(ConvertOp::I32FromF32),
        (Class::F32, Class::I32, true) => Some(ConvertOp::U32FromF32),
        (Class::F64, Class::I32, false) => Some(ConvertOp::I32FromF64),
        (Class::F64, Class::I32, true) => Some(ConvertOp::U32FromF64),
        (Class::F64, Class::I64, false) => Some(ConvertOp::I64FromF64),
        (Class::F64, Class::I64, true) => Some(ConvertOp::U64FromF64),
        _ => None,
    }
}

/// Conversions that depend only on the signedness of the source.
fn number_to_number(from: Class, to: Class, is_unsigned: bool) -> Option<ConvertOp> {
    match (from, to, is_unsigned) {
        (Class::I32, Class::I64, false) => Some(ConvertOp::I64FromI32),
        (Class::I32, Class::I64, true) => Some(ConvertOp::I64FromU32),
        (Class::I64, Class::I32, _) => Some(ConvertOp::I32FromI64),
        (Class::I32, Class::F32, false) => Some(ConvertOp::F32FromI32),
        (Class::I32, Class::F32, true) => Some(ConvertOp::F32FromU32),
        (Class::I64, Class::F32, false) => Some(ConvertOp::F32FromI64),
        (Class::I64, Class::F32, true) => Some(ConvertOp::F32FromU64),
        (Class::I32, Class::F64, false) => Some(ConvertOp::F64FromI32),
        (Class::I32, Class::F64, true) => Some(ConvertOp::F64FromU32),
        (Class::I64, Class::F64, false) => Some(ConvertOp::F64FromI64),
        (Class::I64, Class::F64, true) => Some(ConvertOp::F64FromU64),
        (Class::F32, Class::F64, _) => Some(ConvertOp::F64FromF32),
        (Class::F64, Class::F32, _) => Some(ConvertOp::F32FromF64),
        _ => None,
    }
}
