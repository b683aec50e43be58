//! Alignments that a declaration requests: `_Alignas`, `__attribute__((aligned))`.

use super::Sema;
use crate::ast::{Alignment, Expression};
use crate::diag::Diagnostic;
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{ExprId, PlaceKind};

/// The largest alignment of an object: the distance of two program slots is a multiple of it.
const MAX_ALIGNMENT: i64 = 0x1000;

impl Sema<'_> {
    /// The strictest of several alignments; 1 if there are none.
    pub(super) fn alignment(&mut self, alignments: &[Alignment]) -> u32 {
        alignments.iter().filter_map(|alignment| self.one_alignment(alignment)).max().unwrap_or(1)
    }

    fn one_alignment(&mut self, alignment: &Alignment) -> Option<u32> {
        match alignment {
            Alignment::Largest => Some(self.types.align_of(Types::DOUBLE)),
            Alignment::Type(name) => {
                let ty = self.type_name(name)?.ty;
                Some(self.types.align_of(ty))
            }
            Alignment::Value(value) => self.alignment_value(value),
        }
    }

    fn alignment_value(&mut self, expression: &Expression) -> Option<u32> {
        let value = self.constant_integer(expression, "an alignment")?;
        let is_possible = (0..=MAX_ALIGNMENT).contains(&value) && (value & (value - 1)) == 0;
        if !is_possible {
            self.report(
                Diagnostic::error(expression.span, format!("an alignment of {value} is not possible"))
                    .help(format!("use a power of two up to {MAX_ALIGNMENT}")),
            );
            return None;
        }
        // `_Alignas(0)` has no effect.
        u32::try_from(value.max(1)).ok()
    }

    /// `__alignof__ a`: for a variable the alignment of its declaration, otherwise that of its type.
    pub(super) fn alignof_expression(&mut self, operand: &Expression, span: Span) -> Option<ExprId> {
        self.unevaluated += 1;
        let meaning = self.operand(operand);
        self.unevaluated -= 1;
        let meaning = meaning?;
        let mut align = self.types.align_of(self.operand_type(meaning).ty);
        if let super::operands::Operand::Place(located) = meaning {
            align = align.max(match self.body.places[located.place].kind {
                PlaceKind::Local(local, 0) if self.is_whole(self.body.locals[local].ty, located.ty.ty) => {
                    self.body.locals[local].align
                }
                PlaceKind::Symbol(symbol, 0) if self.is_whole(self.symbols.get(symbol).ty, located.ty.ty) => {
                    self.symbols.get(symbol).align
                }
                _ => 1,
            });
        }
        Some(self.body.int(i64::from(align), Types::INT, span))
    }

    /// Reports whether a place of type `part` at the start of an object is the whole object.
    fn is_whole(&self, object: TypeId, part: TypeId) -> bool {
        object == part || self.types.size_of(object) == self.types.size_of(part)
    }
}
