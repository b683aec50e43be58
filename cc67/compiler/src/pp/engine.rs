//! The preprocessor's state and its main loop.
//!
//! Tokens come from two stacks: the expansions being read ([`super::expand`]) and, if there are none, the files being
//! read. A line that begins with `#` is executed as soon as its first token is read, and never passed on.

use std::path::PathBuf;

use crate::diag::{Diagnostic, Sink, TOO_MANY_ERRORS};
use crate::names::Names;
use crate::source::{FileId, SourceMap, Span};

use super::conditional::Conditional;
use super::expand::Frame;
use super::guard::Guard;
use super::lexer::{Lexer, LexerContext};
use super::macros::Macros;
use super::prepared::state::PreparedState;
use super::search::FileReader;
use super::token::{Flags, Token, TokenKind};
use super::{Files, Headers, HeadersRead, Options, limits};

/// Room for the tokens of a usual program and its headers; unused room is never touched.
const USUAL_TOKENS: usize = 1 << 16;

/// A file being read.
pub(super) struct OpenFile {
    pub(super) lexer: Lexer,
    /// Its path, to recognise repeated inclusion; `None` for text without a file.
    pub(super) path: Option<PathBuf>,
    /// The directory that its includes are searched in first.
    pub(super) directory: PathBuf,
    /// The open `#if`s.
    pub(super) conditionals: Vec<Conditional>,
    /// The include guard: whether a second inclusion would be empty.
    pub(super) guard: Guard,
    /// The offset that `#line` adds to line numbers.
    pub(super) line_shift: i64,
    /// The file name that `#line` gave.
    pub(super) presumed_name: Option<String>,
}

impl OpenFile {
    /// A file at the start of what `lexer` reads.
    pub(super) fn new(lexer: Lexer, path: Option<PathBuf>, directory: PathBuf) -> Self {
        Self {
            lexer,
            path,
            directory,
            conditionals: Vec::new(),
            guard: Guard::default(),
            line_shift: 0,
            presumed_name: None,
        }
    }
}

/// A preprocessor at work.
pub(super) struct Preprocessor<'a> {
    pub(super) options: &'a Options,
    pub(super) sources: &'a mut SourceMap,
    pub(super) names: &'a mut Names,
    pub(super) sink: &'a mut Sink,
    pub(super) reader: FileReader<'a>,
    pub(super) macros: Macros,
    pub(super) prepared: PreparedState,
    /// Expansions being read, the innermost last.
    pub(super) frames: Vec<Frame>,
    /// Files being read, the innermost last.
    pub(super) open: Vec<OpenFile>,
    /// The directory of the main file.
    pub(super) main_directory: PathBuf,
    /// The next value of `__COUNTER__`.
    pub(super) counter: u32,
    pub(super) work: WorkCounters,
}

/// The work done so far, and the state of the limits.
#[derive(Debug, Default)]
pub(super) struct WorkCounters {
    /// The number of tokens made by macros.
    pub(super) expanded: usize,
    /// Macro calls within arguments being expanded.
    pub(super) nesting: usize,
    /// The macro call whose arguments are being collected.
    pub(super) collecting: Option<Span>,
    /// A limit was exceeded: every source of tokens is at its end.
    pub(super) is_stopped: bool,
}

impl<'a> Preprocessor<'a> {
    pub(super) fn new(
        options: &'a Options,
        files: &'a dyn Files,
        sources: &'a mut SourceMap,
        names: &'a mut Names,
        sink: &'a mut Sink,
        headers: Headers,
    ) -> Self {
        Self {
            options,
            sources,
            names,
            sink,
            reader: FileReader::new(files),
            macros: Macros::default(),
            prepared: PreparedState::new(headers),
            frames: Vec::new(),
            open: Vec::new(),
            main_directory: PathBuf::new(),
            counter: 0,
            work: WorkCounters::default(),
        }
    }

    /// All tokens of the main file and its includes, and how much of the headers they contain.
    pub(super) fn run(mut self, main: FileId) -> (Vec<Token>, HeadersRead) {
        self.define_predefined();
        let mut output = Vec::with_capacity(USUAL_TOKENS);
        self.open_main(main);
        let mut end = Span::new(0, 0);
        while let Some(file) = self.open.last() {
            end = file.lexer.end_span();
            self.expand_all(&mut output);
            if output.len() > limits::TOKENS && !self.work.is_stopped {
                self.stop(end, format!("more than {} tokens after preprocessing", limits::TOKENS));
            }
            self.prepared.take_place(output.len());
            self.close_file();
        }
        self.add_declarations(&mut output);
        let is_cut = self.work.is_stopped || self.sink.lacks_text();
        let broken = if is_cut { Flags::BROKEN } else { Flags::NONE };
        output.push(Token::new(TokenKind::End, Flags::LINE_START.with(broken), end));
        (output, self.prepared.read())
    }

    /// The next token of the innermost file; directives before it are executed.
    pub(super) fn next_of_file(&mut self) -> Token {
        loop {
            let Some(file) = self.open.last_mut() else {
                return Token::new(TokenKind::End, Flags::LINE_START, Span::new(0, 0));
            };
            if self.sink.is_full() && !self.work.is_stopped {
                self.sink.report(Diagnostic::global_error(TOO_MANY_ERRORS));
                self.work.is_stopped = true;
            }
            if self.work.is_stopped {
                return Token::new(TokenKind::End, Flags::LINE_START, file.lexer.end_span());
            }
            let token = file.lexer.next(&mut LexerContext { names: self.names, sink: self.sink });
            if token.kind == TokenKind::Hash && token.flags.has(Flags::LINE_START) && !file.lexer.in_directive
            {
                self.directive(token);
                continue;
            }
            if token.kind != TokenKind::End {
                file.guard.meet_text();
            }
            return token;
        }
    }

    /// The innermost file with its lexer's context.
    pub(super) fn lexer(&mut self) -> Option<(&mut Lexer, LexerContext<'_>)> {
        let file = self.open.last_mut()?;
        Some((&mut file.lexer, LexerContext { names: self.names, sink: self.sink }))
    }

    /// Reports an exceeded limit and ends all sources of tokens.
    pub(super) fn stop(&mut self, span: Span, message: String) {
        if !self.work.is_stopped {
            self.sink.report(Diagnostic::error(span, message).note("the rest of the program was not read"));
        }
        self.work.is_stopped = true;
    }

    fn close_file(&mut self) {
        let Some(file) = self.open.pop() else { return };
        self.report_open_conditionals(&file);
        if let (Some(path), Some(guard)) = (file.path, file.guard.finish()) {
            self.reader.set_guard(path, guard);
        }
    }
}
