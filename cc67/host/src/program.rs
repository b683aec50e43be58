//! From a source file to an image, with the compiler's answer as the vendor's tools show it.

use std::fmt;
use std::path::Path;

use kmotiondef::ThreadId;

use crate::HostError;
use compiler::diag::Severity;
use compiler::diag::levels::Levels;
use compiler::pp::Disk;
use compiler::render::vendor;
use compiler::{Options, files, image};

/// What the compiler says of a source with errors: lines of `file:line: message`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileError(String);

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.trim_end())
    }
}

/// The bytes of a file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, HostError> {
    files::read(path).map_err(|error| HostError::Read { path: path.to_owned(), error })
}

/// Compiles and links a source for a thread.
pub(super) fn build(path: &Path, thread: ThreadId, options: &Options) -> Result<Vec<u8>, HostError> {
    let failed = |text: String| HostError::Compile(CompileError(text));
    let mut compilation = compiler::compile(path, read(path)?, options, &Disk);
    let linked = compilation.link(thread, options);
    let levels = Levels::default();
    let found = compilation.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic));
    let errors: Vec<_> = found.filter(|diagnostic| diagnostic.severity == Severity::Error).collect();
    if !errors.is_empty() {
        return Err(failed(vendor::render(&errors, &compilation.sources)));
    }
    let linked = linked.ok_or_else(|| failed(format!("{} cannot be linked", path.display())))?;
    image::write(&linked).map_err(|error| failed(format!("{}: {error}", path.display())))
}
