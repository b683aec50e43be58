//! `#define`.

use cranelift_entity::EntityRef;

use crate::diag::{Diagnostic, Lint};
use crate::names::{Name, word};

use super::engine::Preprocessor;
use super::limits;
use super::macros::{Macro, MacroId, Parameters};
use super::token::{Flags, Token, TokenKind};

impl Preprocessor<'_> {
    /// Defines a macro from the rest of the line; returns its name.
    pub(super) fn define(&mut self) -> Option<Name> {
        let name = self.macro_name("define")?;
        let is_function_like = self.lexer().is_some_and(|(lexer, _)| lexer.is_at_paren());
        let parameters = if is_function_like { Some(self.parameters()?) } else { None };
        let body = self.body(parameters.as_ref())?;
        let is_operator = |token: &Token| {
            matches!(token.kind, TokenKind::Parameter | TokenKind::Stringize | TokenKind::Paste)
                || token.kind == TokenKind::Identifier && token.name == word::VA_OPT
        };
        let is_plain = !body.iter().any(is_operator);
        if let Some(old) = self.find_macro(name.name) {
            self.check_redefinition(old, name, parameters.as_ref(), &body);
        }
        if parameters.is_some() {
            self.names.mark_function_macro(name.name);
        }
        let body = self.macros.add_body(&body);
        let definition =
            Macro { definition: name.span, parameters, body, is_plain, builtin: None, is_active: false };
        self.macros.define(name.name, definition);
        Some(name.name)
    }

    /// Reads `(a, b, ...)`.
    fn parameters(&mut self) -> Option<Parameters> {
        let open = self.directive_token();
        let mut parameters = Parameters::default();
        let mut token = self.directive_token();
        if token.kind == TokenKind::RightParen {
            return Some(parameters);
        }
        loop {
            match token.kind {
                TokenKind::Identifier => {
                    if parameters.names.contains(&token.name) {
                        let message = format!("parameter `{}` appears twice", self.names.get(token.name));
                        self.sink.report(Diagnostic::error(token.span, message));
                    }
                    parameters.names.push(token.name);
                }
                TokenKind::Ellipsis => {
                    parameters.names.push(word::VA_ARGS);
                    parameters.is_variadic = true;
                }
                _ => return self.bad_parameters(token, "expected the name of a parameter"),
            }
            if parameters.names.len() > limits::PARAMETERS {
                return self.bad_parameters(token, &format!("more than {} parameters", limits::PARAMETERS));
            }
            let mut next = self.directive_token();
            if next.kind == TokenKind::Ellipsis && token.kind == TokenKind::Identifier {
                // GNU: `args...` names the rest.
                parameters.is_variadic = true;
                next = self.directive_token();
            }
            match next.kind {
                TokenKind::RightParen => return Some(parameters),
                TokenKind::Comma if !parameters.is_variadic => token = self.directive_token(),
                TokenKind::Comma => return self.bad_parameters(next, "`...` must be the last parameter"),
                TokenKind::End => return self.bad_parameters(open, "parameter list is never closed"),
                _ => return self.bad_parameters(next, "expected `,` or `)`"),
            }
        }
    }

    fn bad_parameters(&mut self, token: Token, message: &str) -> Option<Parameters> {
        self.sink.report(
            Diagnostic::error(token.span, message)
                .at("in the parameters of a macro")
                .note("`(` directly after its name gives a macro parameters; for a body in parentheses, put a space between"),
        );
        None
    }

    /// Reads the body; names of parameters become operands, `#` and `##` operators.
    fn body(&mut self, parameters: Option<&Parameters>) -> Option<Vec<Token>> {
        let mut body: Vec<Token> = Vec::new();
        let mut is_first = true;
        loop {
            let mut token = self.directive_token();
            match token.kind {
                TokenKind::End => break,
                TokenKind::Identifier => make_operand(&mut token, TokenKind::Parameter, parameters),
                TokenKind::HashHash => token.kind = TokenKind::Paste,
                TokenKind::Hash if parameters.is_some() => {
                    let mut operand = self.directive_token();
                    let flags = token.flags;
                    make_operand(&mut operand, TokenKind::Stringize, parameters);
                    if operand.kind != TokenKind::Stringize {
                        self.sink.report(
                            Diagnostic::error(token.span, "`#` is not followed by a parameter")
                                .note("in a macro with parameters `#` makes a string of the following one"),
                        );
                        return None;
                    }
                    token = Token { flags, span: token.span.to(operand.span), ..operand };
                }
                _ => {}
            }
            // Blanks before the body are ignored.
            if is_first {
                token.flags = token.flags.without(Flags::SPACE);
                is_first = false;
            }
            body.push(token);
        }
        let is_paste = |token: &&Token| token.kind == TokenKind::Paste;
        if let Some(paste) = body.first().filter(is_paste).or(body.last().filter(is_paste)) {
            let message = "`##` at the start or end of a macro has nothing to join";
            self.sink.report(Diagnostic::error(paste.span, message));
            return None;
        }
        if parameters.is_some_and(|list| list.is_variadic) {
            self.check_optional(&body)?;
        }
        Some(body)
    }

    /// Checks that each `__VA_OPT__` has its parentheses and is not in another one.
    fn check_optional(&mut self, body: &[Token]) -> Option<()> {
        let is_optional = |token: &Token| token.kind == TokenKind::Identifier && token.name == word::VA_OPT;
        let mut depth = None;
        for (index, token) in body.iter().enumerate() {
            let is_opened = body.get(index + 1).is_some_and(|next| next.kind == TokenKind::LeftParen);
            let problem = match (token.kind, depth) {
                _ if is_optional(token) && depth.is_some() => Some("`__VA_OPT__` is inside another one"),
                _ if is_optional(token) && !is_opened => Some("`__VA_OPT__` is not followed by `(`"),
                _ if is_optional(token) => {
                    depth = Some(0_usize);
                    None
                }
                (TokenKind::LeftParen, Some(open)) => {
                    depth = Some(open + 1);
                    None
                }
                (TokenKind::RightParen, Some(open)) => {
                    depth = (open > 1).then(|| open - 1);
                    None
                }
                _ => None,
            };
            if let Some(message) = problem {
                self.sink.report(Diagnostic::error(token.span, message));
                return None;
            }
        }
        if depth.is_some()
            && let Some(open) = body.iter().rev().find(|token| is_optional(token))
        {
            self.sink.report(Diagnostic::error(open.span, "the `(` of `__VA_OPT__` is never closed"));
            return None;
        }
        Some(())
    }

    /// Warns if the new definition differs from the old one.
    fn check_redefinition(
        &mut self,
        old: MacroId,
        name: Token,
        parameters: Option<&Parameters>,
        body: &[Token],
    ) {
        let Some(definition) = self.macros.get(old) else { return };
        let old_body = self.macros.body(definition.body.clone());
        let is_same = definition.builtin.is_none()
            && definition.parameters.as_ref() == parameters
            && old_body.len() == body.len()
            && old_body.iter().zip(body).all(|(old, new)| {
                old.kind == new.kind
                    && old.flags.is_separated() == new.flags.is_separated()
                    && self.sources.text(old.span) == self.sources.text(new.span)
            });
        if is_same {
            return;
        }
        let before = definition.definition;
        let message = format!("macro `{}` is redefined with a different body", self.names.get(name.name));
        self.sink.report(
            Diagnostic::warning(Lint::MacroRedefined, name.span, message)
                .at("this definition is used from here on")
                .label(before, "first defined here"),
        );
    }
}

/// Converts the name of a parameter to an operand.
fn make_operand(token: &mut Token, kind: TokenKind, parameters: Option<&Parameters>) {
    if token.kind == TokenKind::Identifier
        && let Some(number) =
            parameters.and_then(|list| list.names.iter().position(|name| *name == token.name))
    {
        token.kind = kind;
        token.name = Name::new(number);
    }
}
