//! Macro expansion: replaces a macro's name by its tokens.
//!
//! The replacement of a name is pushed on a stack of frames and read from there, so that the text after the call in the
//! file can complete a macro call that the replacement starts. While a frame is on the stack its macro is active: its
//! name, found inside, is marked `NO_EXPAND` and never expanded. The active macros are the hide set of the C
//! literature, kept per frame instead of per token.
//!
//! Arguments are expanded separately before they replace a parameter, in a closed frame.

use crate::diag::Diagnostic;
use crate::source::{Expansion, ExpansionId, Span};

use super::engine::Preprocessor;
use super::limits;
use super::macros::{Builtin, MacroId};
use super::token::{Flags, Token, TokenKind};

/// Tokens that replace a macro call, being read.
pub(super) struct Frame {
    tokens: Tokens,
    /// Index of the next token.
    at: usize,
    /// Index after the last.
    end: usize,
    /// The macro that is active as long as the frame is on the stack.
    active: Option<MacroId>,
    /// True for a macro argument: nothing is read beyond this frame.
    is_closed: bool,
}

enum Tokens {
    /// Tokens of a macro's body, with the span and spacing that each gets.
    Body { expansion: ExpansionId, start: usize, spacing: Flags },
    /// Tokens of a separate list.
    List(Vec<Token>),
}

impl Preprocessor<'_> {
    /// Expands everything up to the end of the innermost file, directive or argument.
    pub(super) fn expand_all(&mut self, output: &mut Vec<Token>) {
        loop {
            let token = self.next_token();
            match token.kind {
                TokenKind::Identifier => {
                    if let Some(token) = self.expand(token) {
                        output.push(token);
                    }
                }
                TokenKind::End => return,
                _ => output.push(token),
            }
            if output.len() > limits::TOKENS {
                return;
            }
        }
    }

    /// Expands a list of tokens separately.
    pub(super) fn expand_list(&mut self, tokens: Vec<Token>) -> Vec<Token> {
        let end = tokens.len();
        let depth = self.frames.len();
        self.frames.push(Frame { tokens: Tokens::List(tokens), at: 0, end, active: None, is_closed: true });
        let mut output = Vec::new();
        self.work.nesting += 1;
        self.expand_all(&mut output);
        self.work.nesting -= 1;
        self.frames.truncate(depth);
        output
    }

    /// The next token of the innermost frame, or of the file.
    pub(super) fn next_token(&mut self) -> Token {
        while let Some(frame) = self.frames.last_mut() {
            if frame.at < frame.end && !self.work.is_stopped {
                let at = frame.at;
                frame.at += 1;
                match &frame.tokens {
                    Tokens::List(tokens) => {
                        if let Some(token) = tokens.get(at) {
                            return *token;
                        }
                    }
                    Tokens::Body { expansion, start, spacing } => {
                        if let Some(mut token) = self.macros.body_token(at) {
                            token.span.expansion = *expansion;
                            if at == *start {
                                token.flags = token.flags.without(Flags::SPACE).with(*spacing);
                            }
                            return token;
                        }
                    }
                }
            } else if frame.is_closed {
                return Token::new(TokenKind::End, Flags::NONE, Span::new(0, 0));
            } else {
                if let Some(id) = frame.active {
                    self.macros.set_active(id, false);
                }
                self.frames.pop();
            }
        }
        self.next_of_file()
    }

    /// Reports whether `(` follows.
    fn is_before_paren(&self) -> bool {
        for frame in self.frames.iter().rev() {
            if frame.at < frame.end {
                let next = match &frame.tokens {
                    Tokens::List(tokens) => tokens.get(frame.at).copied(),
                    Tokens::Body { .. } => self.macros.body_token(frame.at),
                };
                return next.is_some_and(|token| token.kind == TokenKind::LeftParen);
            }
            if frame.is_closed {
                return false;
            }
        }
        self.open.last().is_some_and(|file| file.lexer.is_before_paren())
    }

    /// Expands a name if it is a macro; otherwise returns it.
    fn expand(&mut self, mut token: Token) -> Option<Token> {
        let Some(id) = self.find_macro(token.name) else { return Some(token) };
        if token.flags.has(Flags::NO_EXPAND) {
            return Some(token);
        }
        let definition = self.macros.get(id)?;
        if definition.is_active {
            token.flags = token.flags.with(Flags::NO_EXPAND);
            return Some(token);
        }
        if let Some(builtin) = definition.builtin {
            return Some(self.builtin(builtin, token, id));
        }
        if definition.parameters.is_some() {
            if !self.is_before_paren() {
                return Some(token);
            }
            return self.expand_call(id, token);
        }
        let (start, end, is_plain) = (definition.body.start, definition.body.end, definition.is_plain);
        if self.count(end - start, token.span) {
            let expansion = self.add_expansion(id, token.span);
            if is_plain {
                let tokens = Tokens::Body { expansion, start, spacing: spacing(token) };
                self.push_frame(id, tokens, start, end);
            } else {
                let list = self.substitute(id, &[], &[], expansion, spacing(token));
                self.push_list(id, list);
            }
        }
        None
    }

    fn push_frame(&mut self, id: MacroId, tokens: Tokens, at: usize, end: usize) {
        self.macros.set_active(id, true);
        self.frames.push(Frame { tokens, at, end, active: Some(id), is_closed: false });
    }

    /// Puts the finished replacement of a call on the stack.
    pub(super) fn push_list(&mut self, id: MacroId, list: Vec<Token>) {
        let end = list.len();
        self.push_frame(id, Tokens::List(list), 0, end);
    }

    /// Records an expansion.
    pub(super) fn add_expansion(&mut self, id: MacroId, call: Span) -> ExpansionId {
        let definition = self.macros.get(id).map_or(call, |definition| definition.definition);
        self.sources.add_expansion(Expansion { definition, call })
    }

    /// Counts tokens made by macros; false, with an error, if there are too many.
    pub(super) fn count(&mut self, tokens: usize, call: Span) -> bool {
        self.work.expanded = self.work.expanded.saturating_add(tokens).saturating_add(1);
        if self.work.expanded > limits::EXPANDED_TOKENS {
            let message = format!("macros expand to more than {} tokens", limits::EXPANDED_TOKENS);
            self.stop(call, message);
        }
        !self.work.is_stopped
    }

    /// The token in place of `__LINE__` and similar macros.
    fn builtin(&mut self, builtin: Builtin, token: Token, id: MacroId) -> Token {
        let place = self.sources.place(token.span);
        let file = self.open.last();
        let (text, kind) = match builtin {
            Builtin::Line => {
                let line = place.map_or(0, |place| i64::from(place.line));
                ((line + file.map_or(0, |file| file.line_shift)).to_string(), TokenKind::Number)
            }
            Builtin::File => {
                let presumed = file.and_then(|file| file.presumed_name.clone());
                let name = presumed
                    .or_else(|| place.map(|place| self.sources.file(place.file).name.clone()))
                    .unwrap_or_default();
                (format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\"")), TokenKind::String)
            }
            Builtin::Counter => {
                self.counter += 1;
                ((self.counter - 1).to_string(), TokenKind::Number)
            }
        };
        let expansion = self.add_expansion(id, token.span);
        let span = Span { expansion, ..self.sources.add_scratch(text.as_bytes()) };
        Token::new(kind, spacing(token), span)
    }
}

/// The facts about a macro's name that hold for the first token in its place.
pub(super) fn spacing(token: Token) -> Flags {
    token.flags.only(Flags::SPACE.with(Flags::LINE_START))
}

impl Preprocessor<'_> {
    /// Expands the call of a function-like macro before its `(`.
    fn expand_call(&mut self, id: MacroId, name: Token) -> Option<Token> {
        if self.work.nesting >= limits::NESTING {
            let message = format!("macro calls nested deeper than {}", limits::NESTING);
            self.stop(name.span, message);
            return None;
        }
        let (raw, arguments, close) = self.collect_arguments(name)?;
        let call = name.span.to(close);
        let Some(arguments) = self.fit_arguments(id, name, call, &raw, arguments) else {
            // The call was probably meant to be an operand.
            return Some(Token::new(TokenKind::Number, spacing(name).with(Flags::BROKEN), call));
        };
        let expansion = self.add_expansion(id, call);
        let list = self.substitute(id, &raw, &arguments, expansion, spacing(name));
        if self.count(list.len(), call) {
            self.push_list(id, list);
        }
        None
    }

    /// Reads `( … )`: the tokens, the range of each argument, and the closing parenthesis.
    fn collect_arguments(&mut self, name: Token) -> Option<(Vec<Token>, Vec<std::ops::Range<usize>>, Span)> {
        let outer = self.work.collecting.replace(name.span);
        let open = self.next_token();
        let mut tokens = Vec::new();
        let mut arguments = Vec::new();
        let (mut start, mut depth) = (0, 0_usize);
        let close = loop {
            let mut token = self.next_token();
            match token.kind {
                TokenKind::End => break None,
                TokenKind::RightParen if depth == 0 => break Some(token.span),
                TokenKind::RightParen => depth -= 1,
                TokenKind::LeftParen => depth += 1,
                TokenKind::Comma if depth == 0 => {
                    // The comma remains in the list, between the arguments, for variadic macros.
                    arguments.push(start..tokens.len());
                    start = tokens.len() + 1;
                }
                TokenKind::Identifier => self.mark_active(&mut token),
                _ => {}
            }
            tokens.push(token);
            if tokens.len() > limits::EXPANDED_TOKENS {
                self.stop(name.span, format!("macro call longer than {} tokens", limits::EXPANDED_TOKENS));
            }
        };
        self.work.collecting = outer;
        arguments.push(start..tokens.len());
        match close {
            Some(close) => Some((tokens, arguments, close)),
            None => {
                self.unclosed_call(name, open, tokens);
                None
            }
        }
    }

    /// Reports a call without `)`. Its tokens are read again as if there were no macro, so that the parser can report
    /// the position of the missing parenthesis.
    fn unclosed_call(&mut self, name: Token, open: Token, tokens: Vec<Token>) {
        if self.work.is_stopped {
            return;
        }
        let message = format!("macro call of `{}` is never closed", self.names.get(name.name));
        self.sink.report(Diagnostic::error(name.span, message).label(open.span, "no `)` for this"));
        let name = Token { flags: name.flags.with(Flags::NO_EXPAND), ..name };
        let list: Vec<_> = [name, open].into_iter().chain(tokens).collect();
        let end = list.len();
        self.frames.push(Frame { tokens: Tokens::List(list), at: 0, end, active: None, is_closed: false });
    }

    /// Marks a name inside the expansion of its own macro, which is never expanded, even if it is moved out as an
    /// argument.
    fn mark_active(&self, token: &mut Token) {
        let definition = self.macros.definition(token.name).and_then(|id| self.macros.get(id));
        if definition.is_some_and(|definition| definition.is_active) {
            token.flags = token.flags.with(Flags::NO_EXPAND);
        }
    }

    /// Matches arguments with parameters; reports a wrong number.
    fn fit_arguments(
        &mut self,
        id: MacroId,
        name: Token,
        call: Span,
        raw: &[Token],
        mut arguments: Vec<std::ops::Range<usize>>,
    ) -> Option<Vec<std::ops::Range<usize>>> {
        let definition = self.macros.get(id)?;
        let parameters = definition.parameters.as_ref()?;
        let expected = parameters.names.len();
        if raw.is_empty() && expected == 0 {
            return Some(Vec::new());
        }
        if parameters.is_variadic {
            if arguments.len() + 1 == expected {
                arguments.push(raw.len()..raw.len());
            }
            if arguments.len() > expected
                && let Some(last) = expected.checked_sub(1).and_then(|last| arguments.get_mut(last))
            {
                last.end = raw.len();
                arguments.truncate(expected);
            }
        }
        if arguments.len() == expected {
            return Some(arguments);
        }
        let given = if raw.is_empty() { 0 } else { arguments.len() };
        let at_least = if parameters.is_variadic { "at least " } else { "" };
        let least = if parameters.is_variadic { expected - 1 } else { expected };
        let plural = if least == 1 { "" } else { "s" };
        let spelling = self.names.get(name.name);
        let message = format!("macro `{spelling}` takes {at_least}{least} argument{plural}, {given} given");
        let defined = definition.definition;
        self.sink.report(Diagnostic::error(call, message).label(defined, "defined here"));
        None
    }
}
