//! `#include`.
//!
//! The order of the search, for a name in quotes: the directory of the including file, each directory of `-I`, the
//! directory of the main file, the current one; in angle brackets only `-I`. Then come the embedded headers, then the C
//! library's, which are effectively empty. Backslashes are slashes, letter case does not matter, and a name that begins
//! with a slash is also searched for below each directory.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::diag::Diagnostic;
use crate::files::reason;
use crate::source::{FileId, Span};
use crate::words::suggest;

use super::engine::Preprocessor;
use super::lexer::header::HeaderName;
use super::search::SearchResult;
use super::token::TokenKind;
use super::{LAX, limits, standard};

impl Preprocessor<'_> {
    /// Obeys `#include` with the rest of the line, and opens the file.
    pub(super) fn include(&mut self, span: Span) {
        if let Some(call) = self.work.collecting {
            self.sink.report(
                Diagnostic::error(span, "`#include` within the arguments of a macro")
                    .label(call, "of this macro"),
            );
            return;
        }
        let written = match self.lexer() {
            Some((lexer, mut cx)) => lexer.header_name(&mut cx),
            None => None,
        };
        let Some(header) = written.or_else(|| self.computed_header(span)) else { return };
        if !header.is_closed {
            let (missing, other) = if header.is_angled { ('>', '<') } else { ('"', '"') };
            self.sink.report(
                Diagnostic::warning(LAX, header.span, format!("missing `{missing}` after the file name"))
                    .at(format!("the rest of the line after `{other}` is taken for the name")),
            );
        }
        self.finish_line();
        self.find_and_open(&header);
    }

    /// Puts the main file on the stack.
    pub(super) fn open_main(&mut self, main: FileId) {
        let source = self.sources.file(main);
        let path = source.path.clone().unwrap_or_else(|| PathBuf::from(&source.name));
        let directory = directory_of(&path);
        self.main_directory.clone_from(&directory);
        if self.check_size(source.text.len(), Span::new(source.start, source.start)) {
            self.open_file(main, Some(path), directory);
        }
    }

    /// The name that the macros after `#include` give.
    fn computed_header(&mut self, directive: Span) -> Option<HeaderName> {
        let tokens = self.directive_tokens();
        let Some((first, rest)) = tokens.split_first() else {
            self.sink.report(Diagnostic::error(directive, "file name missing").at("expected `\"name\"`"));
            return None;
        };
        let span = self.sources.call_site(first.span);
        match first.kind {
            TokenKind::String => {
                let text = self.spelling(*first);
                let quotes = ['"', '\u{201C}', '\u{201D}', '\u{201E}'];
                let name = String::from_utf8_lossy(&text).trim_matches(quotes).replace("\\\\", "\\");
                Some(HeaderName { name, is_angled: false, is_closed: true, span })
            }
            TokenKind::Less => {
                let end = rest.iter().position(|token| token.kind == TokenKind::Greater);
                let mut name = Vec::new();
                for (index, token) in rest.iter().take(end.unwrap_or(rest.len())).enumerate() {
                    if index > 0 && token.flags.is_separated() {
                        name.push(b' ');
                    }
                    name.extend(self.spelling(*token));
                }
                let name = String::from_utf8_lossy(&name).into_owned();
                Some(HeaderName { name, is_angled: true, is_closed: end.is_some(), span })
            }
            _ => {
                let message = "expected a file name after `#include`";
                self.sink
                    .report_lost_names(Diagnostic::error(span, message).help("write `#include \"name\"`"));
                None
            }
        }
    }

    fn find_and_open(&mut self, header: &HeaderName) {
        let name = header.name.replace('\\', "/");
        if name.trim().is_empty() {
            self.sink.report(Diagnostic::error(header.span, "file name missing"));
            return;
        }
        let directories = self.directories(header.is_angled);
        match self.find(&directories, &name) {
            Some(SearchResult::File { path, text, is_respelled }) => {
                if is_respelled {
                    let message = format!("`{}` is `{}` on disk", header.name, path.display());
                    self.sink.report(
                        Diagnostic::remark(header.span, message)
                            .note("file names are case-sensitive on systems other than Windows"),
                    );
                }
                self.open_found(path, text, header.span);
            }
            Some(SearchResult::Ambiguous(paths)) => {
                let message = format!("`{}` matches several files", header.name);
                let diagnostic =
                    Diagnostic::error(header.span, message).help("write the name in the same case");
                self.sink.report_lost_names(
                    paths.iter().fold(diagnostic, |it, path| it.note(format!("`{}`", path.display()))),
                );
            }
            Some(SearchResult::Unreadable(path, error)) => {
                let message = format!("cannot read `{}`: {}", path.display(), reason(&error));
                self.sink.report_lost_names(Diagnostic::error(header.span, message));
            }
            None => self.open_embedded(header, &name, &directories),
        }
    }

    /// The directories to search, each once.
    fn directories(&self, is_angled: bool) -> Vec<PathBuf> {
        let including = self.open.last().map(|file| file.directory.clone());
        let before = including.into_iter().filter(|_| !is_angled);
        let behind = [self.main_directory.clone(), PathBuf::new()].into_iter().filter(|_| !is_angled);
        let mut directories: Vec<PathBuf> = Vec::new();
        for directory in before.chain(self.options.include_dirs.iter().cloned()).chain(behind) {
            if !directories.contains(&directory) {
                directories.push(directory);
            }
        }
        directories
    }

    fn find(&mut self, directories: &[PathBuf], name: &str) -> Option<SearchResult> {
        if name.starts_with('/')
            && let Some(found) = self.reader.find_in(Path::new("/"), name)
        {
            return Some(found);
        }
        if Path::new(name).is_absolute() && !name.starts_with('/') {
            return self.reader.find_in(Path::new(""), name);
        }
        let relative = name.trim_start_matches('/');
        directories.iter().find_map(|directory| self.reader.find_in(directory, relative))
    }

    /// Reports whether including a file again yields nothing.
    fn is_spent(&mut self, path: &Path) -> bool {
        self.reader.is_once(path)
            || self.reader.guard(path).is_some_and(|guard| self.find_macro(guard).is_some())
    }

    fn open_found(&mut self, path: PathBuf, text: Arc<Vec<u8>>, at: Span) {
        if self.is_spent(&path) {
            return;
        }
        let name = path.display().to_string();
        let directory = directory_of(&path);
        self.open_text(name, Some(path), text, directory, at);
    }

    /// Opens a header that comes with the compiler, or reports that there is none.
    fn open_embedded(&mut self, header: &HeaderName, name: &str, directories: &[PathBuf]) {
        let file_name = name.rsplit('/').next().unwrap_or(name);
        let embedded = self.options.embedded.iter().find(|(known, _)| known.eq_ignore_ascii_case(file_name));
        let (known, text) = match (embedded, standard::header(name)) {
            (Some((known, text)), _) => (*known, *text),
            (None, Some(text)) => (file_name, text.as_bytes()),
            (None, None) => return self.report_missing(header, file_name, directories),
        };
        let path = embedded_path(known);
        if text.is_empty() || self.is_spent(&path) {
            return;
        }
        if self.include_prepared(text, header.span) {
            return;
        }
        let text = Arc::new(text.to_vec());
        self.open_text(known.to_owned(), Some(path), text, PathBuf::new(), header.span);
    }

    fn open_text(
        &mut self,
        name: String,
        path: Option<PathBuf>,
        text: Arc<Vec<u8>>,
        directory: PathBuf,
        at: Span,
    ) {
        self.reader.included += 1;
        if self.open.len() > limits::INCLUDE_DEPTH {
            let message = format!("files included deeper than {}", limits::INCLUDE_DEPTH);
            return self.stop(at, format!("{message}; does `{name}` include itself?"));
        }
        if self.reader.included > limits::INCLUDES {
            return self.stop(at, format!("more than {} files included", limits::INCLUDES));
        }
        if !self.check_size(text.len(), at) {
            return;
        }
        let on_disk = path.as_deref().filter(|path| !path.to_string_lossy().starts_with('\0'));
        let file = self.sources.add_file(name, on_disk, text, Some(at));
        self.open_file(file, path, directory);
    }

    /// Reports whether a file is small enough for the position space.
    fn check_size(&mut self, length: usize, at: Span) -> bool {
        let length = u32::try_from(length).unwrap_or(u32::MAX);
        if length > limits::FILE_BYTES {
            self.stop(at, format!("file is larger than {} bytes", limits::FILE_BYTES));
            return false;
        }
        let total = self.sources.end().saturating_add(length);
        if total > limits::TOTAL_BYTES {
            self.stop(at, format!("included files exceed {} bytes in total", limits::TOTAL_BYTES));
            return false;
        }
        true
    }

    fn report_missing(&mut self, header: &HeaderName, file_name: &str, directories: &[PathBuf]) {
        let mut near: Vec<String> =
            self.options.embedded.iter().map(|(name, _)| (*name).to_owned()).collect();
        for directory in directories {
            near.extend_from_slice(self.reader.list(directory));
        }
        let mut diagnostic = Diagnostic::error(header.span, format!("file `{}` not found", header.name));
        for directory in directories {
            let shown = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
            diagnostic = diagnostic.note(format!("looked in `{}`", shown.display()));
        }
        if header.is_angled && directories.is_empty() {
            diagnostic = diagnostic.note("names in `<>` are searched for only in the directories of `-I`");
        }
        // Names from C++ headers get their own messages.
        if header.is_angled && !file_name.contains('.') {
            self.sink.report(diagnostic.help("headers of C++ do not exist here; leave it out"));
            return;
        }
        if VENDOR_HELPERS.iter().any(|name| name.eq_ignore_ascii_case(file_name)) {
            let help = "it belongs to the vendor's software: copy it from there beside the program, or name its folder with `-I DIR`";
            self.sink.report_lost_names(diagnostic.help(help));
            return;
        }
        self.sink.report_lost_names(match suggest(file_name, near.iter().map(String::as_str)) {
            Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
            None => diagnostic,
        });
    }
}

/// Files with functions that the vendor's software brings and many programs include.
const VENDOR_HELPERS: &[&str] = &["KflopToKMotionCNCFunctions.c", "KflopToMach3Functions.c"];

/// The pseudo path of a built-in header: it contains a NUL, so it never equals the path of a real file.
pub(super) fn embedded_path(name: &str) -> PathBuf {
    PathBuf::from(format!("\0{}", name.to_ascii_lowercase()))
}

fn directory_of(path: &Path) -> PathBuf {
    path.parent().map(Path::to_owned).unwrap_or_default()
}
