//! Source files, positions, and the macro expansions that tokens come from.
//!
//! Every byte of every file in a compilation has a unique number: files are consecutive in a single position space. A
//! [`Span`] is a range in it, together with the macro expansion that inserted the text, if there is one. Spans are
//! small and `Copy`; the [`SourceMap`] turns them back into file, line and column.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use cranelift_entity::{PrimaryMap, entity_impl};

/// A file that was read, or the text of a command-line macro.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(u32);
entity_impl!(FileId, "file");

/// An expansion of a macro; `Option<ExpansionId>` would double the size of a span.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ExpansionId(u32);
entity_impl!(ExpansionId, "expansion");

impl ExpansionId {
    /// Text that is directly in a file.
    pub const NONE: Self = Self(u32::MAX);
}

/// A range of source text and its origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// Position of the first byte.
    pub lo: u32,
    /// Position after the last byte.
    pub hi: u32,
    /// The innermost macro expansion of the text; its call site is the position to show.
    pub expansion: ExpansionId,
}

impl Span {
    /// A span of text that is directly in a file.
    #[must_use]
    pub const fn new(lo: u32, hi: u32) -> Self {
        Self { lo, hi, expansion: ExpansionId::NONE }
    }

    /// The span from the start of `self` to the end of `end`, if both are in the same expansion; otherwise `self`.
    #[must_use]
    pub fn to(self, end: Self) -> Self {
        if self.expansion == end.expansion && end.hi >= self.lo { Self { hi: end.hi, ..self } } else { self }
    }
}

/// A file's text and its place in the position space.
#[derive(Debug)]
pub struct SourceFile {
    /// The name given by the user or found by the include search.
    pub name: String,
    /// The path from which it was read; `None` for embedded headers and command-line text.
    pub path: Option<PathBuf>,
    /// The bytes; not necessarily UTF-8. Shared with other inclusions of the same file.
    pub text: Arc<Vec<u8>>,
    /// Position of the first byte.
    pub start: u32,
    /// The `#include` that included it; `None` for the main file.
    pub included_at: Option<Span>,
    /// True if it holds text made by the preprocessor.
    is_scratch: bool,
    /// Offsets of the line starts, computed when first requested.
    lines: OnceLock<Vec<u32>>,
}

impl SourceFile {
    /// Offsets of the line starts; a line ends after its line feed.
    #[must_use]
    pub fn lines(&self) -> &[u32] {
        self.lines.get_or_init(|| {
            std::iter::once(0).chain(memchr::memchr_iter(b'\n', &self.text).map(|at| at as u32 + 1)).collect()
        })
    }

    /// The position after the last byte.
    #[must_use]
    pub fn end(&self) -> u32 {
        self.start + self.text.len() as u32
    }
}

/// A macro expansion.
#[derive(Clone, Copy, Debug)]
pub struct Expansion {
    /// The macro's name at its definition; the text of the span is the name.
    pub definition: Span,
    /// The position of the macro call.
    pub call: Span,
}

/// A place as people name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub file: FileId,
    /// Line, counted from 1.
    pub line: u32,
    /// Column in bytes, counted from 1.
    pub column: u32,
}

/// All files and expansions of one compilation.
#[derive(Debug, Default)]
pub struct SourceMap {
    files: PrimaryMap<FileId, SourceFile>,
    expansions: PrimaryMap<ExpansionId, Expansion>,
    /// The file at the end of the position space that holds text made by the preprocessor.
    scratch: Option<FileId>,
}

impl SourceMap {
    /// Makes an empty map.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file after the existing ones.
    pub fn add_file(
        &mut self,
        name: impl Into<String>,
        path: Option<&Path>,
        text: impl Into<Arc<Vec<u8>>>,
        included_at: Option<Span>,
    ) -> FileId {
        // One position between two files belongs to the end of the first.
        let start = self.files.values().next_back().map_or(0, |file| file.end() + 1);
        self.scratch = None;
        self.files.push(SourceFile {
            name: name.into(),
            path: path.map(Path::to_owned),
            text: text.into(),
            start,
            included_at,
            is_scratch: false,
            lines: OnceLock::new(),
        })
    }

    /// Adds text that is in no file: a joined or quoted token. The caller gives its span an expansion.
    pub fn add_scratch(&mut self, text: &[u8]) -> Span {
        let scratch = match self.scratch {
            Some(file) => file,
            None => self.add_file("<scratch space>", None, Vec::new(), None),
        };
        self.scratch = Some(scratch);
        let file = &mut self.files[scratch];
        file.is_scratch = true;
        let lo = file.end();
        Arc::make_mut(&mut file.text).extend_from_slice(text);
        Span::new(lo, file.end())
    }

    /// Reports whether a span is in text made by the preprocessor.
    #[must_use]
    pub fn is_scratch(&self, span: Span) -> bool {
        self.file_at(span.lo).is_some_and(|file| self.files[file].is_scratch)
    }

    /// The position after everything added so far.
    #[must_use]
    pub fn end(&self) -> u32 {
        self.files.values().next_back().map_or(0, SourceFile::end)
    }

    /// Records an expansion.
    pub fn add_expansion(&mut self, expansion: Expansion) -> ExpansionId {
        self.expansions.push(expansion)
    }

    /// The file with this number.
    #[must_use]
    pub fn file(&self, file: FileId) -> &SourceFile {
        &self.files[file]
    }

    /// Every file in the order of reading.
    pub fn files(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter()
    }

    /// The name of the macro that was expanded.
    #[must_use]
    pub fn macro_name(&self, expansion: &Expansion) -> Cow<'_, str> {
        String::from_utf8_lossy(self.text(expansion.definition))
    }

    /// The expansion with this number; `None` for [`ExpansionId::NONE`].
    #[must_use]
    pub fn expansion(&self, id: ExpansionId) -> Option<&Expansion> {
        self.expansions.get(id)
    }

    /// The span in a file to show first: the outermost macro call, or the text itself.
    #[must_use]
    pub fn call_site(&self, mut span: Span) -> Span {
        while let Some(expansion) = self.expansion(span.expansion) {
            span = expansion.call;
        }
        span
    }

    /// The position at which a reader of the main file reaches `span`, then the position of the span itself.
    ///
    /// Text of an included file is reached at its `#include`, so diagnostics in this order are in the order of the
    /// program.
    #[must_use]
    pub fn reading_order(&self, span: Span) -> (u32, u32) {
        let own = self.call_site(span).lo;
        let mut at = own;
        while let Some(include) = self.file_at(at).and_then(|file| self.files[file].included_at) {
            at = self.call_site(include).lo;
        }
        (at, own)
    }

    /// The file that holds position `at`.
    #[must_use]
    pub fn file_at(&self, at: u32) -> Option<FileId> {
        let after = self.files.values().as_slice().partition_point(|file| file.start <= at);
        after.checked_sub(1).map(|index| FileId::from_u32(index as u32))
    }

    /// File, line and column of the start of `span`, seen from the outermost macro call.
    #[must_use]
    pub fn place(&self, span: Span) -> Option<Place> {
        let at = self.call_site(span).lo;
        let file = self.file_at(at)?;
        let source = &self.files[file];
        let offset = at - source.start;
        let line = source.lines().partition_point(|start| *start <= offset);
        let line_start = source.lines().get(line.checked_sub(1)?)?;
        Some(Place { file, line: line as u32, column: offset - line_start + 1 })
    }

    /// The line number of a span and the blanks before it; `None` if the line contains anything else before it.
    #[must_use]
    pub fn indentation(&self, span: Span) -> Option<(u32, &[u8])> {
        let place = self.place(span)?;
        let file = &self.files[place.file];
        let end = span.lo.checked_sub(file.start)?;
        let start = end.checked_sub(place.column.checked_sub(1)?)?;
        let before = file.text.get(start as usize..end as usize)?;
        before.iter().all(u8::is_ascii_whitespace).then_some((place.line, before))
    }

    /// The byte before a span, in the same file.
    #[must_use]
    pub fn byte_before(&self, span: Span) -> Option<u8> {
        let file = &self.files[self.file_at(span.lo)?];
        file.text.get((span.lo - file.start).checked_sub(1)? as usize).copied()
    }

    /// The bytes of a span.
    #[must_use]
    pub fn text(&self, span: Span) -> &[u8] {
        let Some(file) = self.file_at(span.lo) else { return &[] };
        let source = &self.files[file];
        let (lo, hi) = ((span.lo - source.start) as usize, (span.hi.max(span.lo) - source.start) as usize);
        source.text.get(lo..hi.min(source.text.len())).unwrap_or(&[])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_columns_from_one() {
        let mut map = SourceMap::new();
        map.add_file("a.c", None, b"int a;\nint b;\n".to_vec(), None);
        let second = map.add_file("b.h", None, b"x\ny".to_vec(), None);
        let start = map.file(second).start;
        assert_eq!(
            map.place(Span::new(start + 2, start + 3)),
            Some(Place { file: second, line: 2, column: 1 })
        );
        assert_eq!(map.text(Span::new(7, 10)), b"int");
    }

    #[test]
    fn scratch_text_comes_after_the_files_and_moves_none() {
        let mut map = SourceMap::new();
        map.add_file("a.c", None, b"int".to_vec(), None);
        let joined = map.add_scratch(b"ab");
        let quoted = map.add_scratch(b"\"c\"");
        let later = map.add_file("b.h", None, b"x".to_vec(), None);
        let more = map.add_scratch(b"d");
        let start = map.file(later).start;
        let texts = [joined, quoted, Span::new(start, start + 1), more].map(|span| map.text(span));
        assert_eq!(texts, [b"ab".as_slice(), b"\"c\"", b"x", b"d"]);
    }
}
