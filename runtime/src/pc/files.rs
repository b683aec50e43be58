//! Files of the PC: none, the files of a folder, or a folder below a private layer of written files.

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
    /// A part of the path is a link, which may lead anywhere.
    #[error("`{0}` is a link, and links are not followed")]
    Link(String),
    /// The file has further names, which may be outside the folder.
    #[error("`{0}` has a second name (a hard link), which may be outside the folder: it is only read")]
    HardLink(String),
    /// The path is a folder or a device, not a file.
    #[error("it is not a file")]
    NotAFile,
    /// It does not fit into the memory that is left.
    #[error("it is larger than {FILE_BYTES} bytes")]
    TooLarge,
    /// There is no such file.
    #[error("there is no such file")]
    Missing,
    /// The system refused the operation.
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
    /// The reason why it cannot be read.
    fn read(&mut self, name: &str) -> Result<Vec<u8>, FileError>;

    /// Creates a file or makes it empty; its contents are kept if `keep` is set.
    ///
    /// # Errors
    /// The reason why it cannot be created.
    fn create(&mut self, name: &str, keep: bool) -> Result<(), FileError>;

    /// Adds to the end of a file.
    ///
    /// # Errors
    /// Why it cannot grow.
    fn append(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError>;

    /// Returns the path at which the file of this name is searched for, if it has one.
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

/// Existing files below a private layer of the files that programs write.
#[derive(Clone, Debug)]
pub struct Overlay {
    below: Directory,
    /// The written files by their lower-case names; shared by all handles.
    written: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Overlay {
    /// An overlay with nothing written yet.
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
