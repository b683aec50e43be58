//! The replacement of a macro call: its body with the arguments in place of the parameters.

use std::ops::Range;

use crate::names::word;
use crate::source::ExpansionId;

use super::engine::Preprocessor;
use super::limits;
use super::macros::MacroId;
use super::token::{Flags, Token, TokenKind};

/// The arguments of one call.
struct MacroArguments<'a> {
    raw: &'a [Token],
    ranges: &'a [Range<usize>],
    /// The arguments with their macros expanded, once needed.
    expanded: Vec<Option<Vec<Token>>>,
}

impl MacroArguments<'_> {
    fn raw(&self, parameter: usize) -> &[Token] {
        self.ranges.get(parameter).and_then(|range| self.raw.get(range.clone())).unwrap_or(&[])
    }
}

/// Replaces an empty operand of `##` until the replacement is finished.
const PLACEMARKER: TokenKind = TokenKind::End;

impl Preprocessor<'_> {
    /// The tokens in place of a call; the first one gets the spacing of the macro's name.
    pub(super) fn substitute(
        &mut self,
        id: MacroId,
        raw: &[Token],
        ranges: &[Range<usize>],
        expansion: ExpansionId,
        spacing: Flags,
    ) -> Vec<Token> {
        let Some(definition) = self.macros.get(id) else { return Vec::new() };
        let body = definition.body.clone();
        let variadic =
            definition.parameters.as_ref().filter(|list| list.is_variadic).map(|list| list.names.len() - 1);
        let mut arguments = MacroArguments { raw, ranges, expanded: vec![None; ranges.len()] };
        let mut output = Vec::with_capacity(body.len());
        self.replace(&mut output, body, variadic, &mut arguments, expansion);
        output.retain(|token| token.kind != PLACEMARKER);
        if let Some(first) = output.first_mut() {
            first.flags = first.flags.without(Flags::SPACE).with(spacing);
        }
        output
    }

    /// Appends the expansion of a part of the body; `variadic` is the parameter for the rest of the arguments.
    fn replace(
        &mut self,
        output: &mut Vec<Token>,
        body: Range<usize>,
        variadic: Option<usize>,
        arguments: &mut MacroArguments<'_>,
        expansion: ExpansionId,
    ) {
        let mut at = body.start;
        while at < body.end && !self.work.is_stopped {
            let Some(token) = self.macros.body_token(at) else { break };
            let next = self.macros.body_token(at + 1).filter(|_| at + 1 < body.end);
            let after = at + usize::from(token.kind == TokenKind::Paste);
            if let Some(rest) = variadic
                && let Some(inner) = self.va_opt_range(after, body.end)
            {
                at = inner.end + 1;
                let mut part = Vec::new();
                if self.has_rest(rest, arguments) {
                    self.replace(&mut part, inner, variadic, arguments, expansion);
                }
                if part.is_empty() {
                    part.push(Token { kind: PLACEMARKER, ..token });
                }
                if token.kind == TokenKind::Paste {
                    self.join(output, part, expansion);
                } else {
                    if let Some(first) = part.first_mut() {
                        first.flags = first.flags.without(Flags::SPACE).with(token.flags);
                    }
                    output.append(&mut part);
                }
                continue;
            }
            if token.kind == TokenKind::Paste {
                if let Some(operand) = next {
                    let is_rest =
                        operand.kind == TokenKind::Parameter && Some(operand.parameter()) == variadic;
                    self.paste_operand(output, operand, is_rest, arguments, expansion);
                }
                at += 2;
                continue;
            }
            let is_pasted = next.is_some_and(|next| next.kind == TokenKind::Paste);
            self.append(output, token, is_pasted, arguments, expansion);
            at += 1;
            if self.work.expanded + output.len() > limits::EXPANDED_TOKENS {
                self.count(output.len(), self.sources.expansion(expansion).map_or(token.span, |it| it.call));
            }
        }
    }

    /// The tokens between the parentheses of `__VA_OPT__(…)`, if that is at this place of a body.
    fn va_opt_range(&self, at: usize, end: usize) -> Option<Range<usize>> {
        let token = self.macros.body_token(at).filter(|_| at < end)?;
        if token.kind != TokenKind::Identifier || token.name != word::VA_OPT {
            return None;
        }
        let mut depth = 0_usize;
        for index in at + 1..end {
            match self.macros.body_token(index)?.kind {
                TokenKind::LeftParen => depth += 1,
                TokenKind::RightParen if depth == 1 => return Some(at + 2..index),
                TokenKind::RightParen => depth = depth.checked_sub(1)?,
                _ if depth == 0 => return None,
                _ => {}
            }
        }
        None
    }

    /// Reports whether the variable arguments have tokens after macro expansion.
    fn has_rest(&mut self, rest: usize, arguments: &mut MacroArguments<'_>) -> bool {
        let mut tokens = Vec::new();
        self.append_expanded(&mut tokens, rest, arguments);
        !tokens.is_empty()
    }

    /// Appends the expansion of a token of the body.
    fn append(
        &mut self,
        output: &mut Vec<Token>,
        token: Token,
        is_pasted: bool,
        arguments: &mut MacroArguments<'_>,
        expansion: ExpansionId,
    ) {
        match token.kind {
            TokenKind::Parameter => {
                let start = output.len();
                let parameter = token.parameter();
                if is_pasted {
                    output.extend_from_slice(arguments.raw(parameter));
                    if output.len() == start {
                        output.push(Token { kind: PLACEMARKER, ..token });
                    }
                } else {
                    self.append_expanded(output, parameter, arguments);
                }
                if let Some(first) = output.get_mut(start) {
                    first.flags = first.flags.without(Flags::SPACE).with(token.flags);
                }
            }
            TokenKind::Stringize => {
                let mut string = self.stringize(arguments.raw(token.parameter()), expansion);
                string.flags = string.flags.with(token.flags);
                output.push(string);
            }
            _ => {
                let mut token = token;
                token.span.expansion = expansion;
                output.push(token);
            }
        }
    }

    fn append_expanded(
        &mut self,
        output: &mut Vec<Token>,
        parameter: usize,
        arguments: &mut MacroArguments<'_>,
    ) {
        let raw = arguments.raw(parameter);
        let mut is_macro =
            |token: &Token| token.kind == TokenKind::Identifier && self.find_macro(token.name).is_some();
        let start = output.len();
        if raw.iter().any(&mut is_macro) {
            let list = raw.to_vec();
            let Some(slot) = arguments.expanded.get_mut(parameter) else { return };
            output.extend_from_slice(slot.get_or_insert_with(|| self.expand_list(list)));
        } else {
            output.extend_from_slice(raw);
        }
        for token in output.iter_mut().skip(start) {
            // The start of a line in the file is a blank in the replacement.
            if token.flags.has(Flags::LINE_START) {
                token.flags = token.flags.without(Flags::LINE_START).with(Flags::SPACE);
            }
        }
    }

    /// Joins the last token of `output` with the operand after `##`.
    fn paste_operand(
        &mut self,
        output: &mut Vec<Token>,
        operand: Token,
        is_rest: bool,
        arguments: &mut MacroArguments<'_>,
        expansion: ExpansionId,
    ) {
        let is_comma = output.last().is_some_and(|token| token.kind == TokenKind::Comma);
        if is_rest && is_comma {
            // GNU: the comma before empty variable arguments is dropped; otherwise nothing is joined.
            if arguments.raw(operand.parameter()).is_empty() {
                output.pop();
            } else {
                self.append(output, operand, false, arguments, expansion);
            }
            return;
        }
        let mut right = Vec::new();
        self.append(&mut right, operand, true, arguments, expansion);
        self.join(output, right, expansion);
    }

    /// Joins the last token of `output` with the first of the list, and appends the others.
    fn join(&mut self, output: &mut Vec<Token>, right: Vec<Token>, expansion: ExpansionId) {
        let mut right = right.into_iter();
        let Some(second) = right.next() else { return };
        match output.last().copied() {
            Some(first) if first.kind == PLACEMARKER => {
                output.pop();
                output.push(second);
            }
            Some(first) if second.kind != PLACEMARKER => {
                output.pop();
                self.paste(output, first, second, expansion);
            }
            Some(_) => {}
            None => output.push(second),
        }
        output.extend(right);
    }
}
