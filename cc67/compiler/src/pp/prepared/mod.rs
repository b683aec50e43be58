//! Texts of which a program only reads the parts it uses.
//!
//! The predefined macros and the headers of the board are the same for every program, and most of their definitions and
//! declarations are never used. So their text is among the sources, but a macro is only read on first use. Declarations
//! are read after everything else: those named by the other tokens, and those that these name in turn. [`index`] has
//! their positions.
//!
//! For the predefined macros there is no visible difference. For the headers the result would differ in some cases, in
//! which the headers must be read completely:
//! - A file in the folder has the name of one of them, or a macro defined earlier has one of their names: this is known
//!   when the program includes them.
//! - The program redefines a macro that a declaration uses, or may exceed a limit: this is known at the end, and
//!   everything must be read again. Other macros that are defined later do not affect the declarations.
//! - The program has errors, and a message could name any declaration: the caller handles this.

mod index;
pub(super) mod state;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cranelift_entity::EntitySet;
use kmotiondef::firmware::Function;

use crate::names::{Name, word};
use crate::source::{FileId, Span};

use super::engine::{OpenFile, Preprocessor};
use super::lexer::Lexer;
use super::limits;
use super::macros::{Builtin, MacroId, MacroState};
use super::token::{Token, TokenKind};

use index::{BOARD, INDEX, PREDEFINED, Piece, TEXTS, TextPosition};
use state::HeaderState;

/// The variable that the code of a call of `ThreadDone` uses without naming it: both ways to read the headers declare it.
const USED_BY_THREAD_DONE: &str = "CurrentThread";

impl Preprocessor<'_> {
    /// The current definition of a name; the prepared texts are searched on its first use.
    pub(super) fn find_macro(&mut self, name: Name) -> Option<MacroId> {
        match self.macros.state(name) {
            MacroState::Defined(id) => (!self.prepared.in_declaration || self.is_prepared(id)).then_some(id),
            MacroState::Free | MacroState::Undefined => None,
            MacroState::Unknown => self.find_prepared(name),
        }
    }

    /// Begins the text of the predefined macros, and defines further ones after it.
    pub(super) fn begin_predefined(&mut self, more: &str) {
        let predefined = TEXTS.get(PREDEFINED).copied().unwrap_or(&[]);
        let text = [predefined, more.as_bytes()].concat();
        let (start, end) = (predefined.len(), text.len());
        let file = self.sources.add_file(index::name(PREDEFINED), None, text, None);
        self.record_file(PREDEFINED, file);
        if start < end && self.open_range(PREDEFINED, start, end) {
            self.expand_all(&mut Vec::new());
            self.open.clear();
        }
    }

    fn record_file(&mut self, text: usize, file: FileId) {
        if let Some(slot) = self.prepared.files.get_mut(text) {
            *slot = Some(file);
        }
    }

    /// Notes that the program defines a macro, or takes a definition back.
    pub(super) fn note_macro(&mut self, name: Name) {
        let reading = self.prepared.headers;
        if matches!(reading, HeaderState::Whole | HeaderState::Wrong) {
            return;
        }
        let Some(word) = INDEX.find(self.names.get(name).as_bytes()) else { return };
        self.prepared.headers = match reading {
            HeaderState::AsNeeded if word.is_of_headers() => HeaderState::Whole,
            HeaderState::Begun | HeaderState::Included(_)
                if word.is_in_declaration && word.definition().is_some() =>
            {
                HeaderState::Wrong
            }
            _ => reading,
        };
    }

    /// Includes the headers of the board, if this is their text and they can be read as needed.
    pub(super) fn include_prepared(&mut self, text: &[u8], at: Span) -> bool {
        let is_board = TEXTS.get(BOARD).is_some_and(|board| std::ptr::eq(*board, text) || *board == text);
        if !is_board
            || self.prepared.headers != HeaderState::AsNeeded
            || self.is_near_limits()
            || self.has_own_copy()
        {
            return false;
        }
        self.prepared.headers = HeaderState::Begun;
        self.macros.forget_free();
        for (number, text) in TEXTS.iter().enumerate().skip(BOARD) {
            let head = INDEX.head(number);
            let (including, lo, hi) = head.included_at;
            let included_at = if number == BOARD { at } else { self.prepared_span(including, lo, hi) };
            let text = Arc::new(text.to_vec());
            let file = self.sources.add_file(index::name(number), None, Arc::clone(&text), Some(included_at));
            self.record_file(number, file);
            let (lo, hi) = head.guard;
            let guard = self.names.intern(&String::from_utf8_lossy(text.get(lo..hi).unwrap_or(&[])));
            self.reader.set_guard(super::include::embedded_path(index::name(number)), guard);
            self.reader.included += 1;
        }
        // The tokens belong at the end of this file.
        self.open_range(BOARD, 0, 0);
        true
    }

    /// Puts the declarations that the tokens need among them.
    pub(super) fn add_declarations(&mut self, output: &mut Vec<Token>) {
        let HeaderState::Included(place) = self.prepared.headers else { return };
        let bytes: usize = TEXTS.iter().map(|text| text.len()).sum();
        if output.len() + bytes > limits::TOKENS || self.work.expanded + bytes > limits::EXPANDED_TOKENS {
            self.prepared.headers = HeaderState::Wrong;
            return;
        }
        let mut declarations: Vec<Vec<Token>> = vec![Vec::new(); INDEX.pieces().len()];
        let mut seen = EntitySet::new();
        let mut needed = Vec::new();
        self.find_needed(output, &mut seen, &mut needed);
        while let Some(number) = needed.pop() {
            let Some(piece) = INDEX.pieces().get(number) else { continue };
            let tokens = self.read_piece(*piece);
            self.find_needed(&tokens, &mut seen, &mut needed);
            if let Some(slot) = declarations.get_mut(number) {
                *slot = tokens;
            }
        }
        output.splice(place..place, declarations.into_iter().flatten());
    }

    /// Adds the declarations of names that were not seen before to the needed ones.
    fn find_needed(&self, tokens: &[Token], seen: &mut EntitySet<Name>, needed: &mut Vec<usize>) {
        for token in tokens.iter().filter(|token| token.kind == TokenKind::Identifier) {
            if seen.insert(token.name) {
                let name = self.names.get(token.name).as_bytes();
                let ends_thread = name == Function::ThreadDone.name().as_bytes();
                let used = ends_thread.then_some(USED_BY_THREAD_DONE.as_bytes());
                let words = std::iter::once(name).chain(used).filter_map(|name| INDEX.find(name));
                needed.extend(words.filter_map(index::IndexedName::piece));
            }
        }
    }

    /// The tokens of a declaration.
    fn read_piece(&mut self, piece: Piece) -> Vec<Token> {
        let mut tokens = Vec::new();
        if self.open_range(piece.start.text(), piece.start.offset(), piece.end) {
            self.prepared.in_declaration = true;
            self.expand_all(&mut tokens);
            self.prepared.in_declaration = false;
            self.open.pop();
        }
        tokens
    }

    /// Reports whether a definition is one of the prepared texts.
    fn is_prepared(&self, id: MacroId) -> bool {
        let file = self.macros.get(id).and_then(|definition| self.sources.file_at(definition.definition.lo));
        file.is_some() && self.prepared.files.contains(&file)
    }

    /// Defines the macro that a prepared text has for a name.
    fn find_prepared(&mut self, name: Name) -> Option<MacroId> {
        self.macros.set_free(name);
        let at = INDEX.find(self.names.get(name).as_bytes())?.definition()?;
        self.define_at(at);
        let builtin = match name {
            word::MACRO_FILE => Some(Builtin::File),
            word::MACRO_LINE => Some(Builtin::Line),
            word::MACRO_COUNTER => Some(Builtin::Counter),
            _ => None,
        };
        if let Some(builtin) = builtin {
            self.macros.set_builtin(name, builtin);
        }
        self.macros.definition(name)
    }

    /// Reads the definition whose name is at a position, if its text was begun.
    fn define_at(&mut self, at: TextPosition) {
        let end = TEXTS.get(at.text()).map_or(0, |text| text.len());
        if self.open_range(at.text(), at.offset(), end) {
            if let Some((lexer, _)) = self.lexer() {
                lexer.in_directive = true;
            }
            self.define();
            self.open.pop();
        }
    }

    /// Opens a part of a text as if it were a file; false if the text was not opened before.
    fn open_range(&mut self, text: usize, lo: usize, hi: usize) -> bool {
        let Some(file) = self.prepared.files.get(text).copied().flatten() else { return false };
        let source = self.sources.file(file);
        let lexer = Lexer::new(Arc::clone(&source.text), source.start).restrict(lo, hi);
        self.open.push(OpenFile::new(lexer, None, PathBuf::new()));
        true
    }

    /// The span of a range of an opened text.
    fn prepared_span(&self, text: usize, lo: usize, hi: usize) -> Span {
        let file = self.prepared.files.get(text).copied().flatten();
        let start = file.map_or(0, |file| self.sources.file(file).start);
        let position = |offset: usize| start.saturating_add(u32::try_from(offset).unwrap_or(u32::MAX));
        Span::new(position(lo), position(hi))
    }

    /// Reports whether a limit on files could be exceeded within the headers.
    fn is_near_limits(&self) -> bool {
        let bytes: usize = TEXTS.iter().map(|text| text.len() + 1).sum();
        let total = self.sources.end().saturating_add(u32::try_from(bytes).unwrap_or(u32::MAX));
        self.open.len() + TEXTS.len() > limits::INCLUDE_DEPTH
            || self.reader.included + TEXTS.len() > limits::INCLUDES
            || total > limits::TOTAL_BYTES
    }

    /// Reports whether the first header would find another text for one that it includes.
    fn has_own_copy(&mut self) -> bool {
        let own = [PathBuf::new(), self.main_directory.clone()];
        let directories: Vec<_> = own.into_iter().chain(self.options.include_dirs.iter().cloned()).collect();
        let mut names = (BOARD + 1..TEXTS.len()).map(index::name);
        names.any(|name| directories.iter().any(|directory: &PathBuf| self.has_file(directory, name)))
    }

    fn has_file(&mut self, directory: &Path, name: &str) -> bool {
        self.reader.find_in(directory, name).is_some()
    }
}
