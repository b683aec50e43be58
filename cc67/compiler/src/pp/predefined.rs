//! Macros that are defined before the first line.
//!
//! Most of them are in `predefined.h`, which are read on first use ([`super::prepared`]): first macros that make
//! programs for other compilers compile, then GCC's definitions about its types, and its names for functions of the C
//! library. Date and time are fixed, so that the same source always yields the same program.

use std::path::PathBuf;
use std::sync::Arc;

use crate::source::{FileId, Span};

use super::engine::{OpenFile, Preprocessor};
use super::lexer::Lexer;

impl Preprocessor<'_> {
    /// Makes the predefined macros available and defines those of the command line.
    pub(super) fn define_predefined(&mut self) {
        self.begin_predefined(self.options.standard.macros());
        let one_line = |text: &String| text.replace(['\n', '\r'], " ");
        let defines = self.options.defines.iter();
        let mut text: String =
            defines.map(|(name, body)| format!("#define {} {}\n", one_line(name), one_line(body))).collect();
        text.extend(self.options.undefines.iter().map(|name| format!("#undef {}\n", one_line(name))));
        if !text.is_empty() {
            self.define_from("<command line>", text);
        }
    }

    fn define_from(&mut self, name: &str, text: String) {
        let file = self.sources.add_file(name, None, text.into_bytes(), None);
        self.open_file(file, None, PathBuf::new());
        self.expand_all(&mut Vec::new());
        self.open.clear();
    }

    /// Pushes a file on the stack of files being read.
    pub(super) fn open_file(&mut self, file: FileId, path: Option<PathBuf>, directory: PathBuf) {
        let source = self.sources.file(file);
        let lexer = Lexer::new(Arc::clone(&source.text), source.start);
        if lexer.is_utf16() {
            let span = Span::new(source.start, source.start);
            let name = source.name.clone();
            self.stop(span, format!("`{name}` is UTF-16 text; save it as UTF-8 or ANSI"));
        }
        self.open.push(OpenFile::new(lexer, path, directory));
    }
}
