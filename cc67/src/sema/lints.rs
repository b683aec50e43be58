//! Lints that sema sees in passing, where no other file is their place.

use kmotiondef::firmware::Origin;

use super::Sema;
use super::formats;
use super::operands::Operand;
use crate::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator};
use crate::diag::Diagnostic;
use crate::lints::Lint;
use crate::source::Span;
use crate::typed::{Definition, ExprId, Linkage, SymbolId};

/// Where `UserData` begins in `persist`; at a multiple of 8, as `persist` does.
pub(super) const USER_DATA_OFFSET: i32 = 32;

impl Sema<'_> {
    /// Warns about a statement that computes a value and drops it.
    pub(super) fn lint_unused(&mut self, expression: &Expression, operand: Operand) {
        let ty = self.operand_type(operand);
        if ty.ty.is_void() || ty.is_volatile || has_effect(expression) {
            return;
        }
        let mut diagnostic =
            Diagnostic::warning(Lint::UnusedValue, expression.span, "this statement has no effect");
        diagnostic = match &expression.kind {
            ExpressionKind::Binary(BinaryOperator::Equal, ..) => {
                diagnostic.help("`=` assigns, `==` compares")
            }
            ExpressionKind::Identifier(_) if matches!(operand, Operand::Function(..)) => {
                diagnostic.help("write `()` behind the name to call the function")
            }
            _ => diagnostic.at("the value is dropped"),
        };
        self.report(diagnostic);
    }

    /// Warns about `if (a = b)`, but not about `if ((a = b))`.
    pub(super) fn lint_assignment_condition(&mut self, condition: &Expression) {
        let ExpressionKind::Assign(to, from) = &condition.kind else { return };
        // The span of a parenthesised expression holds its parentheses.
        if condition.span.lo != to.span.lo {
            return;
        }
        let mut diagnostic = Diagnostic::warning(
            Lint::AssignmentCondition,
            condition.span,
            "an assignment is used as a condition",
        )
        .help("write `==` to compare, or a second pair of parentheses if this is meant");
        if let ExpressionKind::Binary(operator, ..) = &from.kind
            && is_comparison(*operator)
        {
            let operator = operator.spelling();
            diagnostic = diagnostic.note(format!("`{operator}` is computed first: its result is assigned"));
        }
        self.report(diagnostic);
    }

    /// Warns about an index of `persist.UserData` that it does not have.
    pub(super) fn lint_index(&mut self, base: &Expression, length: Option<u32>, index: ExprId, span: Span) {
        let ExpressionKind::Member { member, .. } = &base.kind else { return };
        if *member != self.known.user_data {
            return;
        }
        let (Some(length), Some(index)) = (length, self.body.as_int(index)) else { return };
        if !(0..i64::from(length)).contains(&index) {
            self.report(
                Diagnostic::warning(
                    Lint::UserDataIndex,
                    span,
                    format!("`persist.UserData` has no element {index}"),
                )
                .at(format!("it has 0 to {}", length.saturating_sub(1))),
            );
        }
    }

    /// Says once that a function is not in the board's firmware.
    pub(super) fn lint_portability(&mut self, symbol: SymbolId, span: Span) {
        if std::mem::replace(&mut self.symbols.facts_mut(symbol).is_called, true) {
            return;
        }
        let name = &self.symbols.get(symbol).name;
        if self.firmware.origin(name) == Some(Origin::Library) {
            let message = format!("`{name}` is not in firmware 4.34");
            self.report(
                Diagnostic::warning(Lint::Portability, span, message)
                    .at("supplied by the simulation only")
                    .help("define it in the program"),
            );
        }
    }

    /// Warns about functions and variables of the program that have a firmware name: the program's own are used.
    pub(super) fn lint_taken_names(&mut self) {
        let mut taken = Vec::new();
        for (_, symbol) in self.symbols.iter() {
            if matches!(symbol.definition, Definition::None) || symbol.linkage == Linkage::Internal {
                continue;
            }
            let name = &symbol.name;
            let is_variable = self.firmware.is_variable(name);
            let lint = match self.firmware.origin(name) {
                Some(Origin::Header) => Lint::Redeclared,
                None if is_variable => Lint::Redeclared,
                Some(Origin::Firmware) => Lint::Portability,
                Some(Origin::Library) | None => continue,
            };
            let message = format!("the firmware has a `{name}` of its own");
            taken.push(
                Diagnostic::warning(lint, symbol.span, message)
                    .at("this one is used in the program")
                    .note("the vendor's linker refuses it: `defined twice`")
                    .help("choose another name, or make it `static`"),
            );
        }
        taken.into_iter().for_each(|diagnostic| self.report(diagnostic));
    }

    /// Compares the format of `printf` and its kin with the arguments.
    pub(super) fn lint_format(
        &mut self,
        symbol: SymbolId,
        arguments: &[Expression],
        values: &[(Operand, Span)],
    ) {
        let Some(function) = formats::Function::by_name(&self.symbols.get(symbol).name) else { return };
        if self.symbols.facts(symbol).definer.is_some() {
            return;
        }
        let Some(ExpressionKind::String(literal)) = arguments.get(function.format).map(|format| &format.kind)
        else {
            return;
        };
        let span = arguments.get(function.format).map(|format| format.span);
        let types: Vec<_> = values
            .iter()
            .skip(function.format + 1)
            .map(|(operand, span)| (self.types.decayed(self.operand_type(*operand)).ty, *span))
            .collect();
        for finding in formats::check(&self.types, function, &literal.elements, &types) {
            let mut diagnostic = match (finding.argument, span) {
                (Some(argument), _) => Diagnostic::warning(Lint::Format, argument.1, finding.message)
                    .at(format!("this is `{}`", self.spell(argument.0))),
                (None, Some(span)) => Diagnostic::warning(Lint::Format, span, finding.message),
                (None, None) => return,
            };
            if let Some(help) = finding.help {
                diagnostic = diagnostic.help(help);
            }
            self.report(diagnostic);
        }
    }
}

/// Whether evaluating an expression does something, as far as its form tells.
fn has_effect(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Call(..)
        | ExpressionKind::Assign(..)
        | ExpressionKind::AssignWith(..)
        | ExpressionKind::Increment { .. }
        | ExpressionKind::VaStart(..)
        | ExpressionKind::VaArg(..)
        | ExpressionKind::VaEnd(_)
        | ExpressionKind::VaCopy(..)
        | ExpressionKind::StatementExpression(_)
        | ExpressionKind::Error => true,
        ExpressionKind::Comma(_, last) | ExpressionKind::Member { base: last, .. } => has_effect(last),
        ExpressionKind::Binary(BinaryOperator::LogicalAnd | BinaryOperator::LogicalOr, _, last) => {
            has_effect(last)
        }
        ExpressionKind::Conditional { then, otherwise, .. } => {
            then.as_deref().is_some_and(has_effect) || has_effect(otherwise)
        }
        // `*p++;` is how some people write `p++;`.
        ExpressionKind::Cast(_, inner) | ExpressionKind::Unary(UnaryOperator::Dereference, inner) => {
            has_effect(inner)
        }
        _ => false,
    }
}

const fn is_comparison(operator: BinaryOperator) -> bool {
    matches!(
        operator,
        BinaryOperator::Less
            | BinaryOperator::Greater
            | BinaryOperator::LessEqual
            | BinaryOperator::GreaterEqual
            | BinaryOperator::Equal
            | BinaryOperator::NotEqual
    )
}
