//! Macros that are there before the first line.

use std::path::PathBuf;
use std::sync::Arc;

use crate::names::word;
use crate::source::{FileId, Span};

use super::engine::{OpenFile, Preprocessor};
use super::guard::Guard;
use super::lexer::Lexer;
use super::macros::Builtin;

/// Date and time are fixed, so that the same source always gives the same program.
const PREDEFINED: &str = "\
#define __FILE__
#define __LINE__
#define __COUNTER__
#define __DATE__ \"Jan  1 2000\"
#define __TIME__ \"00:00:00\"
#define __TIMESTAMP__ \"Sat Jan  1 00:00:00 2000\"
#define __STDC__ 1
#define __TINYC__ 1
#define __CC67__ 1
#define __SIZE_TYPE__ unsigned int
#define __PTRDIFF_TYPE__ int
#define __WCHAR_TYPE__ int
#define _Pragma(text)
";

/// What GCC defines about its types, and its names for functions of the C library.
const GNU: &str = include_str!("predefined.h");

impl Preprocessor<'_> {
    /// Defines the predefined macros and those of the command line.
    pub(super) fn define_predefined(&mut self) {
        self.define_from("<predefined>", [PREDEFINED, GNU, self.options.standard.macros()].concat());
        let builtins = [
            (word::MACRO_FILE, Builtin::File),
            (word::MACRO_LINE, Builtin::Line),
            (word::MACRO_COUNTER, Builtin::Counter),
        ];
        for (name, builtin) in builtins {
            self.macros.set_builtin(name, builtin);
        }
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

    /// Puts a file on the stack of those being read.
    pub(super) fn open_file(&mut self, file: FileId, path: Option<PathBuf>, directory: PathBuf) {
        let source = self.sources.file(file);
        let lexer = Lexer::new(Arc::clone(&source.text), source.start);
        if lexer.is_utf16() {
            let span = Span::new(source.start, source.start);
            let name = source.name.clone();
            self.stop(span, format!("`{name}` is UTF-16 text; save it as UTF-8 or ANSI"));
        }
        self.open.push(OpenFile {
            lexer,
            path,
            directory,
            conditionals: Vec::new(),
            guard: Guard::default(),
            line_shift: 0,
            presumed_name: None,
        });
    }
}
