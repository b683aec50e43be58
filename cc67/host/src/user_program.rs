//! User programs: from a file to an image for a thread, with compiler messages in the form of the vendor's tools.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use compiler::diag::levels::Levels;
use compiler::diag::{Diagnostic, Severity};
use compiler::inspect::{EntryKind, Inspection};
use compiler::link::{LinkedLine, LinkedProgram};
use compiler::pp::Disk;
use compiler::render::human::{Color, Renderer};
use compiler::render::vendor;
use compiler::source::SourceMap;
use compiler::{Options, files, image};
use kmotiondef::ThreadId;
use runtime::debug::{CodeDetail, DebugInfo};
use runtime::loader::{LoadError, board_of, prepare};

use crate::error::{CompileError, CompileMessage, HostError};

/// A program for a thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UserProgram {
    /// The thread for which it is linked.
    pub thread: ThreadId,
    /// The file from which it was made: a source, or the image itself.
    pub path: PathBuf,
    /// True if the file is an image rather than a source.
    pub is_image: bool,
    /// The linked program.
    pub image: Vec<u8>,
    /// Further details of its code from the compiler; empty for an image that comes from a file.
    pub details: Arc<[CodeDetail]>,
    /// True if it runs as soon as it is loaded.
    pub starts: bool,
}

impl UserProgram {
    /// Compiles a source and links it for a thread.
    ///
    /// # Errors
    /// The file cannot be read, or the source does not compile.
    pub fn compile(path: &Path, thread: ThreadId, options: &Options) -> Result<Self, HostError> {
        Self::compile_text(path, read(path)?, thread, options)
    }

    /// Compiles a source in memory and links it for a thread; `path` is its name in messages.
    ///
    /// # Errors
    /// The source has errors, or it cannot be linked.
    pub fn compile_text(
        path: &Path,
        text: Vec<u8>,
        thread: ThreadId,
        options: &Options,
    ) -> Result<Self, HostError> {
        let failed = |error| HostError::Compile(CompileError::new(format!("{}: {error}", path.display())));
        Self::of_linked(path, &build(path, text, thread, options)?).map_err(failed)
    }

    /// A program that was compiled from `path` and linked.
    ///
    /// # Errors
    /// The program exceeds the limits of an image.
    pub fn of_linked(path: &Path, linked: &LinkedProgram) -> Result<Self, image::WriteError> {
        let image = image::write(linked)?;
        let detail = |line: &LinkedLine| CodeDetail {
            address: line.address.get(),
            column: line.column,
            inlined: line.inlined.clone(),
        };
        let details = linked.lines.iter().map(detail).collect();
        let (thread, path) = (linked.thread, path.to_owned());
        Ok(Self { thread, path, is_image: false, image, details, starts: false })
    }

    /// A program for `thread` from the bytes of an image.
    #[must_use]
    pub fn of_bytes(path: &Path, thread: ThreadId, image: Vec<u8>) -> Self {
        Self { thread, path: path.to_owned(), is_image: true, image, details: Arc::default(), starts: false }
    }

    /// Reads an image, as `cc67 build` writes it.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn from_image(path: &Path, thread: ThreadId) -> Result<Self, HostError> {
        Ok(Self::of_bytes(path, thread, read(path)?))
    }

    /// Marks the program as started when it is loaded.
    #[must_use]
    pub fn started(self) -> Self {
        Self { starts: true, ..self }
    }

    /// The names and lines of its code; empty for an image that cannot be loaded.
    #[must_use]
    pub fn debug_info(&self) -> DebugInfo {
        let prepared = prepare(&self.image, self.thread, &board_of(&self.image), |_| false);
        prepared.map(|prepared| prepared.debug.with_details(self.details.clone())).unwrap_or_default()
    }

    /// Returns the start and end addresses of its functions.
    pub(crate) fn functions(&self) -> BTreeMap<u32, u32> {
        let Ok(image) = Inspection::read(&self.image) else { return BTreeMap::new() };
        let functions = image.symbols.iter().filter(|entry| entry.kind == EntryKind::Function);
        functions.map(|entry| (entry.address, entry.address + entry.size.unwrap_or(0).max(4))).collect()
    }

    /// The file's name, as used in messages and by a stimulus that loads it.
    #[must_use]
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Returns the error for rejecting it; for another tool's file, it names the kind.
    pub(crate) fn refused(&self, error: LoadError) -> HostError {
        match (&error, files::describe(&self.image)) {
            (LoadError::NotAnImage(_), Some(what)) => HostError::Foreign { program: self.name(), what },
            _ => HostError::Refused { program: self.name(), error },
        }
    }
}

/// The bytes of a file.
fn read(path: &Path) -> Result<Vec<u8>, HostError> {
    files::read(path).map_err(|error| HostError::Read { path: path.to_owned(), error })
}

/// Compiles and links a source for a thread.
fn build(
    path: &Path,
    text: Vec<u8>,
    thread: ThreadId,
    options: &Options,
) -> Result<LinkedProgram, HostError> {
    let failed = |text: String| HostError::Compile(CompileError::new(text));
    let mut compilation = compiler::compile(path, text, options, &Disk);
    let linked = compilation.link(thread, options);
    let levels = Levels::default();
    let found = compilation.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic));
    let errors: Vec<_> = found.filter(|diagnostic| diagnostic.severity == Severity::Error).collect();
    if !errors.is_empty() {
        let text = vendor::render(&errors, &compilation.sources);
        let messages = messages(&errors, &compilation.sources);
        return Err(HostError::Compile(CompileError::of_messages(text, messages)));
    }
    linked.ok_or_else(|| failed(format!("{} cannot be linked", path.display())))
}

/// Diagnostics with their places, as a terminal shows them.
fn messages(errors: &[Diagnostic], sources: &SourceMap) -> Vec<CompileMessage> {
    let mut renderer = Renderer::new(sources, Color::Never);
    let mut message = |error: &Diagnostic| {
        let place = error.span.and_then(|span| sources.place(span));
        CompileMessage {
            file: place.as_ref().map(|place| sources.file(place.file).name.to_string()),
            line: place.as_ref().map(|place| place.line),
            column: place.map(|place| place.column),
            message: error.message.to_string(),
            report: renderer.render(error).trim_end().to_owned(),
        }
    };
    errors.iter().map(&mut message).collect()
}
