//! `#if` and its relatives: which lines count.

use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::source::Span;

use super::LAX;
use super::engine::{OpenFile, Preprocessor};
use super::limits;

/// An open `#if`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conditional {
    /// The `#if`, `#ifdef` or `#ifndef`.
    opener: Span,
    /// A branch was taken; the rest are skipped.
    is_taken: bool,
    /// The position of `#else`, after which only `#endif` may follow.
    else_at: Option<Span>,
}

impl Preprocessor<'_> {
    /// `#if expression`
    pub(super) fn open_if(&mut self, span: Span) {
        let condition = self.condition(span);
        self.open_conditional(span, condition);
    }

    /// `#ifdef name` or, if `wanted` is false, `#ifndef name`
    pub(super) fn open_ifdef(&mut self, span: Span, wanted: bool) {
        let Some(name) = self.macro_name(if wanted { "ifdef" } else { "ifndef" }) else {
            return self.open_conditional(span, false);
        };
        if let Some(file) = self.open.last_mut()
            && file.conditionals.is_empty()
            && !wanted
        {
            file.guard.meet_ifndef(name.name);
        }
        let is_defined = self.is_defined(name.name);
        self.open_conditional(span, is_defined == wanted);
    }

    fn open_conditional(&mut self, opener: Span, condition: bool) {
        let Some(file) = self.open.last_mut() else { return };
        file.conditionals.push(Conditional { opener, is_taken: condition, else_at: None });
        if file.conditionals.len() > limits::CONDITIONALS {
            self.stop(opener, format!("`#if`s nested deeper than {}", limits::CONDITIONALS));
        } else if !condition {
            self.skip_branch();
        }
    }

    /// `#elif` after a branch that was taken.
    pub(super) fn elif(&mut self, span: Span) {
        if self.check_branch(span, "#elif").is_some() {
            self.note_branch(span, false);
            self.skip_branch();
        }
    }

    /// `#else` after a branch that was taken.
    pub(super) fn else_(&mut self, span: Span) {
        if self.check_branch(span, "#else").is_some() {
            self.note_branch(span, true);
            self.skip_branch();
        }
    }

    /// `#endif`
    pub(super) fn endif(&mut self, span: Span) {
        let Some(file) = self.open.last_mut() else { return };
        if file.conditionals.pop().is_none() {
            self.sink.report(Diagnostic::error(span, "`#endif` without `#if`"));
        } else if file.conditionals.is_empty() {
            file.guard.meet_endif();
        }
    }

    /// Says which `#if`s a file leaves open; the vendor's compiler does not mind.
    pub(super) fn report_open_conditionals(&mut self, file: &OpenFile) {
        if self.work.is_stopped {
            return;
        }
        for conditional in &file.conditionals {
            self.sink.report(
                Diagnostic::warning(LAX, conditional.opener, "`#if` without `#endif`")
                    .at("continues to the end of the file"),
            );
        }
    }

    /// The innermost `#if` for a further branch; reports a branch that is not allowed here.
    fn check_branch(&mut self, span: Span, directive: &str) -> Option<Conditional> {
        let conditional = self.open.last().and_then(|file| file.conditionals.last()).copied();
        let Some(conditional) = conditional else {
            self.sink.report(Diagnostic::error(span, format!("`{directive}` without `#if`")));
            return None;
        };
        if let Some(else_at) = conditional.else_at {
            self.sink.report(
                Diagnostic::error(span, format!("`{directive}` after `#else`"))
                    .label(else_at, "the `#else`")
                    .label(conditional.opener, "of this `#if`"),
            );
        }
        Some(conditional)
    }

    /// Records a further branch for the branches after it.
    fn note_branch(&mut self, span: Span, is_else: bool) {
        let Some(file) = self.open.last_mut() else { return };
        if file.conditionals.len() == 1 {
            file.guard.meet_alternative();
        }
        if let Some(conditional) = file.conditionals.last_mut()
            && is_else
        {
            conditional.else_at = Some(span);
        }
    }

    /// Skips to the branch that counts, or past the `#endif`.
    fn skip_branch(&mut self) {
        self.finish_line();
        let mut depth = 0_usize;
        while let Some((lexer, mut cx)) = self.lexer() {
            let Some(hash) = lexer.skip_to_directive(&mut cx) else { return };
            lexer.in_directive = true;
            let name = lexer.directive_name(&mut cx);
            let span = hash.to(lexer.position());
            match name {
                Some(word::IF | word::IFDEF | word::IFNDEF) => depth += 1,
                Some(word::ENDIF) if depth > 0 => depth -= 1,
                Some(word::ENDIF) => return self.endif(span),
                Some(word::ELSE | word::ELIF) if depth == 0 && self.enters_branch(name, span) => return,
                _ => {}
            }
            self.finish_line();
        }
    }

    /// Reports whether the text after this `#else` or `#elif` is compiled.
    fn enters_branch(&mut self, name: Option<Name>, span: Span) -> bool {
        let is_else = name == Some(word::ELSE);
        let directive = if is_else { "#else" } else { "#elif" };
        let Some(conditional) = self.check_branch(span, directive) else { return false };
        self.note_branch(span, is_else);
        let enters = !conditional.is_taken && (is_else || self.condition(span));
        if enters
            && let Some(conditional) = self.open.last_mut().and_then(|file| file.conditionals.last_mut())
        {
            conditional.is_taken = true;
        }
        enters
    }
}
