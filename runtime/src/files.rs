//! Files on the PC: where they live and what the board knows of them.

use std::ffi::OsStr;
use std::fmt;
use std::io::Write as _;
use std::path::{Component, Path, PathBuf};

/// Where the PC's files are kept.
pub trait HostFiles: fmt::Debug + Send {
    /// The contents of a file; `None` if it cannot be read.
    fn read(&mut self, name: &str) -> Option<Vec<u8>>;
    /// Makes an empty file, or the directory it goes to if `keep` is set and the file exists.
    fn create(&mut self, name: &str, keep: bool) -> bool;
    /// Adds to the end of a file.
    fn append(&mut self, name: &str, bytes: &[u8]) -> bool;
}

/// A PC without files.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl HostFiles for NoFiles {
    fn read(&mut self, _: &str) -> Option<Vec<u8>> {
        None
    }

    fn create(&mut self, _: &str, _: bool) -> bool {
        false
    }

    fn append(&mut self, _: &str, _: &[u8]) -> bool {
        false
    }
}

/// Files below one directory, whatever path the program names.
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

    /// The place of a PC path: drive letters go, backslashes become slashes, and a name that exists in
    /// other letter case is that file; `None` outside the root.
    fn place(&self, name: &str) -> Option<PathBuf> {
        let other = self.names.iter().find(|(said, _)| said.eq_ignore_ascii_case(name));
        let name = other.map_or(name, |(_, meant)| meant).replace('\\', "/");
        let name = match name.split_once(':') {
            Some((drive, rest)) if drive.len() == 1 => rest,
            _ => &name,
        };
        let name = Path::new(name.trim_start_matches('/'));
        let inside = name.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        (inside && name.file_name().is_some()).then(|| {
            name.components().fold(self.root.clone(), |folder, part| entry(&folder, part.as_os_str()))
        })
    }
}

/// The entry of `folder` called `name`: with exactly this spelling, else the first in another letter case.
fn entry(folder: &Path, name: &OsStr) -> PathBuf {
    let exact = folder.join(name);
    if exact.exists() {
        return exact;
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let same = entries.filter(|found| found.eq_ignore_ascii_case(name)).min();
    same.map_or(exact, |found| folder.join(found))
}

impl HostFiles for Directory {
    fn read(&mut self, name: &str) -> Option<Vec<u8>> {
        std::fs::read(self.place(name)?).ok()
    }

    fn create(&mut self, name: &str, keep: bool) -> bool {
        let Some(place) = self.place(name) else { return false };
        let made = place.parent().is_none_or(|folder| std::fs::create_dir_all(folder).is_ok());
        made && (keep && place.exists() || std::fs::write(place, b"").is_ok())
    }

    fn append(&mut self, name: &str, bytes: &[u8]) -> bool {
        let file =
            self.place(name).and_then(|place| std::fs::OpenOptions::new().append(true).open(place).ok());
        file.is_some_and(|mut file| file.write_all(bytes).is_ok())
    }
}

/// What the PC has open for the board: at most one file for reading and one for writing.
#[derive(Debug)]
pub(crate) struct OpenFiles {
    files: Box<dyn HostFiles>,
    /// Lines still to be read.
    lines: Option<std::vec::IntoIter<Vec<u8>>>,
    writing: Option<String>,
}

/// Longest line the PC delivers.
const LINE_LIMIT: usize = 1024;

impl OpenFiles {
    /// No file is open.
    pub(crate) fn new(files: Box<dyn HostFiles>) -> Self {
        Self { files, lines: None, writing: None }
    }

    /// Opens a file for reading in place of the one before; `false` if it cannot be read or is empty.
    pub(crate) fn open_for_reading(&mut self, name: &str) -> bool {
        let text = self.files.read(name).filter(|text| !text.is_empty());
        self.lines = text.map(|text| lines(&text).into_iter());
        self.lines.is_some()
    }

    /// Opens a file for writing in place of the one before; `false` if it cannot be made.
    pub(crate) fn open_for_writing(&mut self, name: &str, append: bool) -> bool {
        let made = self.files.create(name, append);
        self.writing = made.then(|| name.to_owned());
        made
    }

    /// The next line.
    pub(crate) fn next_line(&mut self) -> Option<Vec<u8>> {
        self.lines.as_mut()?.next()
    }

    /// Adds to the file open for writing; `false` if there is none.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> bool {
        self.writing.as_ref().is_some_and(|name| self.files.append(name, bytes))
    }

    /// Closes the file open for reading.
    pub(crate) fn close_reading(&mut self) {
        self.lines = None;
    }

    /// Closes the file open for writing.
    pub(crate) fn close_writing(&mut self) {
        self.writing = None;
    }
}

/// The lines of a text without their ends; a last line without an end counts.
fn lines(text: &[u8]) -> Vec<Vec<u8>> {
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    let line = |line: &[u8]| {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        line[..line.len().min(LINE_LIMIT)].to_vec()
    };
    text.split(|&byte| byte == b'\n').map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_inside_the_root() {
        let directory = Directory::new("root");
        let check =
            |name: &str, expect: Option<&str>| assert_eq!(directory.place(name), expect.map(PathBuf::from));
        check("c:\\Temp\\Data.txt", Some("root/Temp/Data.txt"));
        check("data.txt", Some("root/data.txt"));
        check("..\\data.txt", None);
        check("c:\\", None);
        let directory = directory.with_names(vec![("C:\\Log.txt".to_owned(), "logs/today.txt".to_owned())]);
        assert_eq!(directory.place("c:\\log.txt"), Some(PathBuf::from("root/logs/today.txt")));
    }

    #[test]
    fn a_last_line_without_end_is_a_line() {
        assert_eq!(lines(b"a\r\n\r\nb"), [&b"a"[..], b"", b"b"]);
        assert_eq!(lines(b"a\n"), [b"a"]);
    }
}
