//! `switch`, `case` and `default`.

use super::Sema;
use super::constants;
use crate::ast::{Expression, Statement};
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{Case, Stmt, StmtKind};

/// A switch whose body is being analysed.
#[derive(Debug)]
pub(super) struct Switch {
    /// The type that its value and its cases have.
    ty: TypeId,
    /// True if the value was rejected: errors of its cases are then not reported.
    is_broken: bool,
    cases: Vec<(Case, Span)>,
    default: Option<Span>,
}

impl Sema<'_> {
    pub(super) fn switch_statement(
        &mut self,
        value: &Expression,
        body: &Statement,
        span: Span,
        out: &mut Vec<Stmt>,
    ) {
        let chosen = self.value(value).unwrap_or_else(|| self.placeholder(value.span));
        let mut is_broken = false;
        let mut ty = self.body.ty(chosen);
        let chosen = if ty.is_integer() {
            self.promote(chosen, value.span)
        } else if ty.is_floating() {
            self.report(
                Diagnostic::warning(Lint::Extension, value.span, "`switch` on a floating-point value")
                    .at("converted to `int`")
                    .help("write `(int)` if this is meant"),
            );
            self.body.convert(chosen, Types::INT, value.span)
        } else {
            let spelled = self.spell(ty);
            let message = format!("`switch` needs an integer, not `{spelled}`");
            let diagnostic = Diagnostic::error(value.span, message);
            let is_text = self.types.pointee(ty).is_some_and(|to| to.ty.is_character());
            self.report(if is_text {
                diagnostic.help("compare texts with `if (strcmp(a, b) == 0)`")
            } else {
                diagnostic
            });
            is_broken = true;
            self.placeholder(value.span)
        };
        ty = self.body.ty(chosen);
        self.body.jumps.switches.push(Switch { ty, is_broken, cases: Vec::new(), default: None });
        let mut inner = Vec::new();
        self.scopes.enter();
        self.statement(body, &mut inner);
        self.scopes.leave();
        let Some(Switch { cases, default, .. }) = self.body.jumps.switches.pop() else { return };
        self.check_cases(&cases, ty.is_unsigned());
        let cases = cases.into_iter().map(|(case, _)| case).collect();
        let kind = StmtKind::Switch { value: chosen, cases, has_default: default.is_some(), body: inner };
        out.push(Stmt { kind, span });
    }

    /// `case first ... last:`
    pub(super) fn case_label(
        &mut self,
        first: &Expression,
        last: Option<&Expression>,
        span: Span,
        out: &mut Vec<Stmt>,
    ) {
        let Some(ty) = self.body.jumps.switches.last().map(|switch| switch.ty) else {
            self.body.jumps.has_lost_case = true;
            self.report(
                Diagnostic::error(span, "`case` outside a `switch`").help("is there an extra `}` before it?"),
            );
            return;
        };
        if self.body.jumps.switches.last().is_some_and(|switch| switch.is_broken) {
            return;
        }
        let low = self.constant_integer(first, "the value of a `case`");
        let high = match last {
            Some(last) => self.constant_integer(last, "the value of a `case`"),
            None => low,
        };
        let (Some(low), Some(high)) = (low, high) else { return };
        let case =
            Case { first: constants::truncate_to_type(low, ty), last: constants::truncate_to_type(high, ty) };
        let label = last.map_or(first.span, |last| first.span.to(last.span));
        let (low, high) = case.values(ty.is_unsigned());
        if low > high {
            self.report(Diagnostic::error(label, "this range of cases is empty"));
            return;
        }
        let Some(switch) = self.body.jumps.switches.last_mut() else { return };
        let number = switch.cases.len() as u32;
        switch.cases.push((case, label));
        out.push(Stmt { kind: StmtKind::Case(number), span });
    }

    /// `default:`
    pub(super) fn default_label(&mut self, span: Span, out: &mut Vec<Stmt>) {
        let Some(switch) = self.body.jumps.switches.last_mut() else {
            self.report(Diagnostic::error(span, "`default` outside a `switch`"));
            return;
        };
        match switch.default {
            None => {
                switch.default = Some(span);
                out.push(Stmt { kind: StmtKind::DefaultCase, span });
            }
            Some(first) => {
                self.report(
                    Diagnostic::error(span, "a second `default` in one `switch`").label(first, "first"),
                );
            }
        }
    }

    /// No value may have two cases.
    fn check_cases(&mut self, cases: &[(Case, Span)], is_unsigned: bool) {
        let mut sorted: Vec<_> = cases.iter().map(|(case, span)| (case.values(is_unsigned), *span)).collect();
        sorted.sort_by_key(|((low, _), _)| *low);
        let mut reach: Option<(i128, Span)> = None;
        for ((low, high), span) in sorted {
            match reach {
                Some((end, first)) if low <= end => {
                    // The one later in the text is the mistake.
                    let (early, late) = if span.lo >= first.lo { (first, span) } else { (span, first) };
                    let message = format!("`case {low}` appears twice in one `switch`");
                    self.report(Diagnostic::error(late, message).label(early, "first"));
                    reach = reach.filter(|(end, _)| *end >= high).or(Some((high, span)));
                }
                _ => reach = Some((high, span)),
            }
        }
    }
}
