//! Files of the PC: none, those of a folder, or a folder under a layer of written files that nobody else sees.

use std::collections::BTreeMap;
use std::fmt;
use std::io::ErrorKind;
use std::sync::{Arc, Mutex, MutexGuard};

use crate::pc::directory::Directory;

/// Bytes of a file that a program may read.
pub const FILE_BYTES: u64 = 32 << 20;

/// The reason for which the PC does not open a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// There are no files at all.
    #[error("this PC has no files")]
    NoFiles,
    /// The name leads out of the folder, or is none.
    #[error("the name is outside the folder of the PC's files")]
    Outside,
    /// Something on the way is a link, which may lead anywhere.
    #[error("`{0}` is a link, and links are not followed")]
    Link(String),
    /// The file has more names than this one, and may lie outside under another.
    #[error("`{0}` has a second name (a hard link), which may be outside the folder: it is only read")]
    HardLink(String),
    /// The path is a folder or a device, not a file.
    #[error("it is not a file")]
    NotAFile,
    /// It does not fit into memory beside everything else.
    #[error("it is larger than {FILE_BYTES} bytes")]
    TooLarge,
    /// There is no such file.
    #[error("there is no such file")]
    Missing,
    /// The system does not let us.
    #[error("{0}")]
    System(ErrorKind),
}

impl From<std::io::Error> for FileError {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == ErrorKind::NotFound { Self::Missing } else { Self::System(error.kind()) }
    }
}

/// The storage of the PC's files.
pub trait HostFiles: fmt::Debug + Send {
    /// The contents of a file.
    ///
    /// # Errors
    /// Why it is not read.
    fn read(&mut self, name: &str) -> Result<Vec<u8>, FileError>;

    /// Makes a file empty, or leaves what it holds if `keep` is set.
    ///
    /// # Errors
    /// Why it is not made.
    fn create(&mut self, name: &str, keep: bool) -> Result<(), FileError>;

    /// Adds to the end of a file.
    ///
    /// # Errors
    /// Why it cannot grow.
    fn append(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError>;

    /// Returns the path at which the file of this name is looked for, if it has one.
    fn place_of(&self, name: &str) -> Option<String> {
        let _ = name;
        None
    }

    /// Another handle of the same files.
    fn handle(&self) -> Box<dyn HostFiles>;
}

impl Clone for Box<dyn HostFiles> {
    fn clone(&self) -> Self {
        self.handle()
    }
}

/// A PC without files.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl HostFiles for NoFiles {
    fn read(&mut self, _: &str) -> Result<Vec<u8>, FileError> {
        Err(FileError::NoFiles)
    }

    fn create(&mut self, _: &str, _: bool) -> Result<(), FileError> {
        Err(FileError::NoFiles)
    }

    fn append(&mut self, _: &str, _: &[u8]) -> Result<(), FileError> {
        Err(FileError::NoFiles)
    }

    fn handle(&self) -> Box<dyn HostFiles> {
        Box::new(*self)
    }
}

/// Files as they are, and over them what programs write, which nobody else sees.
#[derive(Clone, Debug)]
pub struct Overlay {
    below: Directory,
    /// The written files by their lower-case names; shared by all handles.
    written: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Overlay {
    /// Nothing is written yet.
    #[must_use]
    pub fn new(below: Directory) -> Self {
        Self { below, written: Arc::default() }
    }

    fn written(&self) -> Result<MutexGuard<'_, BTreeMap<String, Vec<u8>>>, FileError> {
        self.written.lock().map_err(|_| FileError::NoFiles)
    }
}

impl HostFiles for Overlay {
    fn read(&mut self, name: &str) -> Result<Vec<u8>, FileError> {
        let written = self.written()?.get(&name.to_lowercase()).cloned();
        written.map_or_else(|| self.below.read(name), Ok)
    }

    fn create(&mut self, name: &str, keep: bool) -> Result<(), FileError> {
        self.below.check(name)?;
        let before = if keep { self.read(name).unwrap_or_default() } else { Vec::new() };
        self.written()?.insert(name.to_lowercase(), before);
        Ok(())
    }

    fn append(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        self.written()?.entry(name.to_lowercase()).or_default().extend(bytes);
        Ok(())
    }

    fn place_of(&self, name: &str) -> Option<String> {
        self.below.place_of(name)
    }

    fn handle(&self) -> Box<dyn HostFiles> {
        Box::new(self.clone())
    }
}
