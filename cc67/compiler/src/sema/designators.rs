//! Designators: `.member` and `[index]` in initialisers select the next part.

use super::Sema;
use super::initializers::{AggregateLevel, Shape};
use crate::ast::{Designator, Expression};
use crate::diag::Diagnostic;
use crate::names::Name;
use crate::source::Span;

impl Sema<'_> {
    /// Follows designators from the outermost level; returns the number of elements of a range.
    pub(super) fn follow_designators(
        &mut self,
        stack: &mut Vec<AggregateLevel>,
        designators: &[Designator],
    ) -> Option<u32> {
        let mut times = 1;
        for (index, designator) in designators.iter().enumerate() {
            if index > 0 {
                self.open_current(stack, designator_span(designator))?;
            }
            match designator {
                Designator::Member(name, span) => self.designate_member(stack, *name, *span)?,
                Designator::Index(position) => {
                    let position_value = self.designated_index(stack, position)?;
                    set_next(stack, position_value);
                }
                Designator::Range(first, last) => {
                    let (low, high) =
                        (self.designated_index(stack, first)?, self.designated_index(stack, last)?);
                    if low > high || index + 1 < designators.len() {
                        self.report(Diagnostic::error(
                            first.span.to(last.span),
                            "this range cannot be used here",
                        ));
                        return None;
                    }
                    set_next(stack, low);
                    times = high - low + 1;
                }
            }
        }
        Some(times)
    }

    /// Opens a level for the current part of the innermost level.
    fn open_current(&mut self, stack: &mut Vec<AggregateLevel>, span: Span) -> Option<()> {
        let slot = self.next_slot(stack, span)?;
        let Some(level) = self.aggregate_level(slot) else {
            let message = format!("`{}` has no parts", self.spell(slot.ty.ty));
            self.report(Diagnostic::error(span, message));
            return None;
        };
        if let Some(outer) = stack.last_mut() {
            outer.advance();
        }
        stack.push(level);
        Some(())
    }

    fn designate_member(&mut self, stack: &mut Vec<AggregateLevel>, name: Name, span: Span) -> Option<()> {
        loop {
            let level = *stack.last()?;
            let Shape::Record { record, .. } = level.shape else {
                let message = format!("`{}` has no members", self.spell(level.slot.ty.ty));
                self.report(Diagnostic::error(span, message));
                return None;
            };
            let layout = self.types.record(record).layout.as_ref();
            let members = layout.map_or(&[][..], |layout| &layout.members);
            let found = members.iter().position(|member| match member.name {
                Some(own) => own == name,
                None => self
                    .types
                    .record_of(member.ty.ty)
                    .is_some_and(|inner| self.types.find_member(inner, name).is_some()),
            });
            let Some(index) = found else {
                self.no_member(record, level.slot.ty.ty, name, span);
                return None;
            };
            let is_own = members.get(index).is_some_and(|member| member.name.is_some());
            set_next(stack, index as u32);
            if is_own {
                return Some(());
            }
            self.open_current(stack, span)?;
        }
    }

    fn designated_index(&mut self, stack: &[AggregateLevel], index: &Expression) -> Option<u32> {
        let level = stack.last()?;
        let Shape::Array { length, .. } = level.shape else {
            let message = format!("`{}` is not an array", self.spell(level.slot.ty.ty));
            self.report(Diagnostic::error(index.span, message));
            return None;
        };
        let value = self.constant_integer(index, "an index in an initialiser")?;
        let limit = length.map_or(i64::from(crate::ty::layout::MAX_OBJECT_SIZE), i64::from);
        if !(0..limit).contains(&value) {
            let message = format!("the array has no element {value}");
            self.report(Diagnostic::error(index.span, message));
            return None;
        }
        u32::try_from(value).ok()
    }
}

fn set_next(stack: &mut [AggregateLevel], next: u32) {
    if let Some(level) = stack.last_mut() {
        level.next = next;
    }
}

fn designator_span(designator: &Designator) -> Span {
    match designator {
        Designator::Member(_, span) => *span,
        Designator::Index(index) | Designator::Range(index, _) => index.span,
    }
}
