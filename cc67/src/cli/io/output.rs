//! Files that commands write: under a temporary name first, so that there is never an incomplete file.
//!
//! A killed process leaves the old file or the new one, and perhaps a temporary one, which is
//! [removed](super::leftovers) when the same file is written again. As in any compiler, writing does not wait for the
//! disk: that would take longer than the compilation. Only data that a board has confirmed as stored are on the disk.

use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};

use compiler::files::reason;

use super::leftovers;

/// Writes a file, replacing an existing one.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut draft = Draft::new(path)?;
    draft.write_all(bytes).map_err(|error| cannot_write(path, &error))?;
    draft.commit()
}

/// Writes a file, and returns only when it is stored on the disk.
pub(crate) fn write_durably(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut draft = Draft::new(path)?;
    let written = draft.write_all(bytes).and_then(|()| draft.writer.flush());
    written.and_then(|()| draft.writer.get_ref().sync_all()).map_err(|error| cannot_write(path, &error))?;
    draft.commit()?;
    // A new name belongs to the folder; if a folder cannot be opened as a file, the operating system itself stores it.
    #[cfg(unix)]
    {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let synced = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
        synced.map_err(|error| cannot_write(path, &error))?;
    }
    Ok(())
}

/// Writes several files.
pub(crate) fn write_all(files: &[(PathBuf, Vec<u8>)]) -> Result<()> {
    files.iter().try_for_each(|(path, bytes)| write(path, bytes))
}

/// The message about a file that cannot be written.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> anyhow::Error {
    anyhow!("cannot write {}: {}", path.display(), reason(error))
}

/// A file being written. It gets its name when it is complete; a file that is abandoned leaves nothing.
#[derive(Debug)]
pub(crate) struct Draft {
    writer: BufWriter<File>,
    path: PathBuf,
    /// Its temporary name; devices such as /dev/null are written directly, as no file may replace them.
    temporary: Option<TemporaryPath>,
}

impl Draft {
    /// Begins a file.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let is_device = fs::metadata(path).is_ok_and(|known| !known.is_file() && !known.is_dir());
        let temporary = (!is_device).then(|| TemporaryPath(leftovers::clean(path, "tmp")));
        let name = temporary.as_ref().map_or(path, |temporary| &temporary.0);
        let file = File::create(name).map_err(|error| cannot_write(path, &error))?;
        if temporary.is_some() {
            leftovers::mark(&file);
        }
        Ok(Self { writer: BufWriter::new(file), path: path.to_owned(), temporary })
    }

    /// Completes the file.
    pub(crate) fn commit(mut self) -> Result<()> {
        let flushed = self.writer.flush();
        let placed = flushed.and_then(|()| match &self.temporary {
            Some(temporary) => fs::rename(&temporary.0, &self.path),
            None => Ok(()),
        });
        placed.map_err(|error| cannot_write(&self.path, &error))
    }

    /// Its final name.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// A temporary file that is written first and read once, for a file whose head is known only at the end.
#[derive(Debug)]
pub(crate) struct Scratch {
    writer: BufWriter<File>,
    name: TemporaryPath,
}

impl Scratch {
    /// Creates it in the folder of the file for which it is needed.
    pub(crate) fn beside(path: &Path) -> Result<Self> {
        let name = TemporaryPath(leftovers::clean(path, "body.tmp"));
        let file = File::options().read(true).write(true).create(true).truncate(true).open(&name.0);
        let file = file.map_err(|error| cannot_write(path, &error))?;
        leftovers::mark(&file);
        Ok(Self { writer: BufWriter::new(file), name })
    }

    /// Passes it to `read` from its beginning, and then removes it.
    pub(crate) fn read(self, read: impl FnOnce(BufReader<File>) -> io::Result<()>) -> io::Result<()> {
        let Self { writer, name } = self;
        let mut file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.rewind()?;
        let result = read(BufReader::new(file));
        drop(name);
        result
    }
}

impl Write for Scratch {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// A temporary name, whose file is removed on drop.
#[derive(Debug)]
struct TemporaryPath(PathBuf);

impl Drop for TemporaryPath {
    fn drop(&mut self) {
        // An incomplete file is useless.
        let _ = fs::remove_file(&self.0);
    }
}

/// Prints a command's output.
pub(crate) fn print(text: &str) -> Result<()> {
    match io::stdout().write_all(text.as_bytes()) {
        // A reader that closes early, such as `head`, is not an error.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(lost_output(&error)),
        _ => Ok(()),
    }
}

/// The message when standard output accepts no more.
pub(crate) fn lost_output(error: &io::Error) -> anyhow::Error {
    anyhow!("cannot write to standard output: {}", reason(error))
}
