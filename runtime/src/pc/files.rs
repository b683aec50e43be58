//! Where files of the PC live: a folder that the user names, and nothing outside of it.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

/// Bytes of a file that a program may read.
pub const FILE_BYTES: u64 = 32 << 20;

/// Why the PC does not open a file.
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
    /// What is there is no file: a folder, a device.
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

/// Where the PC's files are kept.
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

    /// Where the file of this name is looked for, if that can be said.
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
    /// What was written, by the name in small letters; shared by all handles.
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
        self.below.place(name)?;
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

/// Files below one folder, whatever path the program names.
///
/// Names are those of a PC: a drive letter goes, backslashes become slashes, letter case does not matter. A name with
/// `..` is refused, and so is one that passes through a link or ends at one, so that a program reaches nothing outside.
#[derive(Clone, Debug)]
pub struct Directory {
    root: PathBuf,
    /// Names that programs use, and the files meant instead.
    names: Vec<(String, String)>,
}

impl Directory {
    /// Files below `root`, which is made at the first write.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into(), names: Vec::new() }
    }

    /// The same with other names for some files: what programs say, and what is meant below the root.
    #[must_use]
    pub fn with_names(self, names: Vec<(String, String)>) -> Self {
        Self { names, ..self }
    }

    /// The place of a PC's path. The root itself may be a link: the user names it, not the program.
    fn place(&self, name: &str) -> Result<PathBuf, FileError> {
        let other = self.names.iter().find(|(said, _)| said.eq_ignore_ascii_case(name));
        let name = other.map_or(name, |(_, meant)| meant).replace('\\', "/");
        let name = match name.split_once(':') {
            Some((drive, rest)) if drive.len() == 1 => rest,
            _ => &name,
        };
        let parts: Vec<&str> = name.split('/').filter(|part| !matches!(*part, "" | ".")).collect();
        if parts.is_empty() || name.ends_with('/') || !parts.iter().all(|part| is_name(part)) {
            return Err(FileError::Outside);
        }
        let mut place = self.root.clone();
        for part in parts {
            place = entry(&place, OsStr::new(part));
            if fs::symlink_metadata(&place).is_ok_and(|known| is_link(&known)) {
                return Err(FileError::Link(part.to_owned()));
            }
        }
        match fs::metadata(&place) {
            Ok(known) if !known.is_file() => Err(FileError::NotAFile),
            _ => Ok(place),
        }
    }
}

/// Whether a part of a path is an ordinary name. What names a device on some PC is none on any.
fn is_name(part: &str) -> bool {
    const DEVICES: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];
    let stem = part.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let is_port = |kind: &str| stem.strip_prefix(kind).is_some_and(|number| number.len() == 1);
    let is_device = DEVICES.contains(&stem.as_str()) || is_port("COM") || is_port("LPT");
    let is_plain = part != ".." && !part.chars().any(|character| character == ':' || character.is_control());
    is_plain && !is_device
}

#[cfg(not(windows))]
fn is_link(known: &fs::Metadata) -> bool {
    known.is_symlink()
}

/// Junctions lead elsewhere as links do; both are reparse points.
#[cfg(windows)]
fn is_link(known: &fs::Metadata) -> bool {
    use std::os::windows::fs::MetadataExt;
    const REPARSE_POINT: u32 = 0x400;
    known.file_attributes() & REPARSE_POINT != 0
}

/// The entry of `folder` called `name`: with exactly this spelling, else the first in another letter case.
fn entry(folder: &Path, name: &OsStr) -> PathBuf {
    let exact = folder.join(name);
    if fs::symlink_metadata(&exact).is_ok() {
        return exact;
    }
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let same = entries.filter(|found| found.eq_ignore_ascii_case(name)).min();
    same.map_or(exact, |found| folder.join(found))
}

impl HostFiles for Directory {
    fn read(&mut self, name: &str) -> Result<Vec<u8>, FileError> {
        let mut bytes = Vec::new();
        fs::File::open(self.place(name)?)?.take(FILE_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > FILE_BYTES { Err(FileError::TooLarge) } else { Ok(bytes) }
    }

    fn create(&mut self, name: &str, keep: bool) -> Result<(), FileError> {
        let place = self.place(name)?;
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder)?;
        }
        OpenOptions::new().create(true).write(true).truncate(!keep).open(place)?;
        Ok(())
    }

    fn append(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        let mut file = OpenOptions::new().append(true).open(self.place(name)?)?;
        Ok(file.write_all(bytes)?)
    }

    fn place_of(&self, name: &str) -> Option<String> {
        Some(self.place(name).ok()?.to_string_lossy().replace('\\', "/"))
    }

    fn handle(&self) -> Box<dyn HostFiles> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with a file inside and one beside it; removed at the end.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("cc67-files-{}-{name}", std::process::id()));
            fs::create_dir_all(path.join("disk/Temp")).expect("the temporary folder is writable");
            fs::write(path.join("disk/Temp/Data.txt"), "inside").expect("it is writable");
            fs::write(path.join("secret.txt"), "outside").expect("it is writable");
            Self(path)
        }

        fn directory(&self) -> Directory {
            Directory::new(self.0.join("disk"))
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            // A leftover folder is untidy, not wrong.
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn paths_stay_inside_the_root() {
        let directory = Directory::new("root");
        for (name, expect) in [
            ("c:\\Temp\\Data.txt", Some("root/Temp/Data.txt")),
            ("C:Data.txt", Some("root/Data.txt")),
            ("/etc/passwd", Some("root/etc/passwd")),
            ("\\\\server\\share\\x.txt", Some("root/server/share/x.txt")),
            ("data.txt", Some("root/data.txt")),
            (".\\a\\.\\b.txt", Some("root/a/b.txt")),
            ("..data..txt", Some("root/..data..txt")),
            ("..\\data.txt", None),
            ("c:..\\data.txt", None),
            ("a/../../data.txt", None),
            ("a\\..", None),
            ("c:\\", None),
            ("folder\\", None),
            ("", None),
            (".", None),
            ("c:\\a:stream", None),
            ("d:\\c:\\x", None),
            ("nul", None),
            ("c:\\Temp\\Con.txt", None),
            ("lpt1", None),
            ("a\tb", None),
        ] {
            let found = directory.place(name);
            assert_eq!(found, expect.map(PathBuf::from).ok_or(FileError::Outside), "{name}");
        }
        let names = [("C:\\Log.txt", "logs/today.txt"), ("c:\\x", "../x")];
        let directory =
            directory.with_names(names.map(|(said, meant)| (said.to_owned(), meant.to_owned())).to_vec());
        assert_eq!(directory.place("c:\\log.txt"), Ok(PathBuf::from("root/logs/today.txt")));
        assert_eq!(directory.place("c:\\x"), Err(FileError::Outside));
    }

    #[test]
    fn a_file_is_found_in_any_letter_case() {
        let scratch = Scratch::new("case");
        assert_eq!(scratch.directory().read("C:\\TEMP\\data.TXT"), Ok(b"inside".to_vec()));
        assert_eq!(scratch.directory().read("c:\\Temp\\nosuch.txt"), Err(FileError::Missing));
        assert_eq!(scratch.directory().read("c:\\Temp"), Err(FileError::NotAFile));
        assert_eq!(scratch.directory().create("c:\\Temp", false), Err(FileError::NotAFile));
    }

    #[test]
    fn nothing_outside_the_folder_is_reached_by_name() {
        let scratch = Scratch::new("beside");
        let secret = scratch.0.join("secret.txt");
        let absolute = secret.to_string_lossy().into_owned();
        for name in
            ["../secret.txt", "..\\secret.txt", "Temp/../../secret.txt", "c:..\\secret.txt", &absolute]
        {
            let mut directory = scratch.directory();
            assert!(directory.read(name).is_err(), "{name} is read");
            // An absolute path is one inside the folder.
            let _ = directory.create(name, false);
            let _ = directory.append(name, b"changed");
        }
        assert_eq!(fs::read(secret).expect("it is there"), b"outside");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        use std::os::unix::fs::symlink;

        let scratch = Scratch::new("links");
        let disk = scratch.0.join("disk");
        symlink(scratch.0.join("secret.txt"), disk.join("file")).expect("a link");
        symlink(&scratch.0, disk.join("folder")).expect("a link");
        symlink(scratch.0.join("made.txt"), disk.join("dangling")).expect("a link");
        symlink("Temp", disk.join("inside")).expect("a link");
        let link = |name: &str| Err::<(), _>(FileError::Link(name.to_owned()));
        for (name, part) in [
            ("file", "file"),
            ("FILE", "FILE"),
            ("folder/secret.txt", "folder"),
            ("c:\\folder\\new.txt", "folder"),
            ("dangling", "dangling"),
            ("inside\\Data.txt", "inside"),
        ] {
            let mut directory = scratch.directory();
            assert_eq!(directory.read(name).map(drop), link(part), "{name} is read");
            assert_eq!(directory.create(name, false), link(part), "{name} is made");
            assert_eq!(directory.create(name, true), link(part), "{name} is opened");
            assert_eq!(directory.append(name, b"changed"), link(part), "{name} grows");
        }
        assert_eq!(fs::read(scratch.0.join("secret.txt")).expect("it is there"), b"outside");
        assert!(!scratch.0.join("made.txt").exists() && !scratch.0.join("new.txt").exists());
        // The folder itself is the user's choice.
        symlink(&disk, scratch.0.join("way")).expect("a link");
        let mut directory = Directory::new(scratch.0.join("way"));
        assert_eq!(directory.read("Temp/Data.txt"), Ok(b"inside".to_vec()));
    }

    #[test]
    fn a_file_is_created_kept_and_appended_to() {
        let scratch = Scratch::new("grows");
        let mut directory = scratch.directory();
        assert_eq!(directory.create("c:\\new\\a.txt", false), Ok(()));
        assert_eq!(directory.append("new/a.txt", b"one\n"), Ok(()));
        assert_eq!(directory.create("new/a.txt", true), Ok(()));
        assert_eq!(directory.append("new/a.txt", b"two\n"), Ok(()));
        assert_eq!(directory.read("new/a.txt"), Ok(b"one\ntwo\n".to_vec()));
        assert_eq!(directory.create("new/a.txt", false), Ok(()));
        assert_eq!(directory.read("new/a.txt"), Ok(Vec::new()));
        assert_eq!(directory.append("nosuch.txt", b""), Err(FileError::Missing));
    }
}
