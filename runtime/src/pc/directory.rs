//! A folder of the system as the PC's disk: programs can access the files in it, and nothing outside.
//!
//! The folder is a capability. Each part of a name is opened relative to the handle of its parent folder, by a system
//! call that does not follow links. No path is checked first and opened later, so another process gains nothing by
//! exchanging folders and links while a program runs. The opened file is then checked by its handle: it must be a
//! regular file, and a file with a second name (a hard link), which may be outside the folder, is not written.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use cap_fs_ext::{DirExt as _, FollowSymlinks, MetadataExt as _};
use cap_fs_ext::{OpenOptionsFollowExt as _, OpenOptionsSyncExt as _};
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, OpenOptions};

use crate::pc::files::{FILE_BYTES, FileError, HostFiles};

/// Files below one folder, whatever path the program names.
///
/// Names are those of a PC: drive letters are dropped, backslashes become slashes, letter case does not matter. A name
/// with `..` is refused, and so is a name that passes through a link or ends at one, so that programs cannot access
/// anything outside. A file with several names (hard links) is read, but not written.
#[derive(Clone, Debug)]
pub struct Directory {
    root: PathBuf,
    /// Names that programs use, and the files meant instead.
    names: Vec<(String, String)>,
}

/// The purpose for which a file is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OpenMode {
    Read,
    /// The file is created, together with missing folders.
    Create,
    Append,
}

impl OpenMode {
    /// Options that do not follow links, do not block, and do not truncate the file before it is checked.
    fn options(self) -> OpenOptions {
        let mut options = OpenOptions::new();
        match self {
            Self::Read => options.read(true),
            Self::Create => options.write(true).create(true),
            Self::Append => options.append(true),
        };
        options.follow(FollowSymlinks::No).nonblock(true);
        options
    }
}

impl Directory {
    /// Files below `root`, which is created at the first write.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into(), names: Vec::new() }
    }

    /// Returns it with other names for some files: the name in programs, and the path below the root.
    #[must_use]
    pub fn with_names(self, names: Vec<(String, String)>) -> Self {
        Self { names, ..self }
    }

    /// The parts of a PC's path below the root.
    fn parts(&self, name: &str) -> Result<Vec<String>, FileError> {
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
        Ok(parts.into_iter().map(str::to_owned).collect())
    }

    /// Opens the root. It may be a link, because the user chooses it, not the program.
    fn open_root(&self) -> io::Result<Dir> {
        // A relative root may be empty: the current folder.
        let root = if self.root.as_os_str().is_empty() { Path::new(".") } else { &self.root };
        Dir::open_ambient_dir(root, ambient_authority())
    }

    /// Opens a file.
    fn open(&self, name: &str, purpose: OpenMode) -> Result<File, FileError> {
        let parts = self.parts(name)?;
        let Some((last, folders)) = parts.split_last() else { return Err(FileError::Outside) };
        if purpose == OpenMode::Create {
            fs::create_dir_all(&self.root)?;
        }
        let mut folder = self.open_root()?;
        for part in folders {
            folder = open_folder(&folder, part, purpose)?;
        }
        let name = spelling(&folder, last);
        let file = folder
            .open_with(&name, &purpose.options())
            .map_err(|error| reason(&folder, &name, last, error, EntryKind::File))?;
        let known = file.metadata()?;
        if !known.is_file() {
            return Err(FileError::NotAFile);
        }
        if purpose != OpenMode::Read && known.nlink() > 1 {
            return Err(FileError::HardLink(last.clone()));
        }
        Ok(file)
    }

    /// Checks that a file of this name can be read or created.
    ///
    /// # Errors
    /// The name does not exist, passes through a link, or is not a file.
    pub(crate) fn check(&self, name: &str) -> Result<(), FileError> {
        match self.open(name, OpenMode::Read) {
            Ok(_) | Err(FileError::Missing) => Ok(()),
            Err(error) => Err(error),
        }
    }
}

/// The kind of entry that is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EntryKind {
    Folder,
    File,
}

/// Opens a folder of a folder; it is created first if a file is created.
fn open_folder(folder: &Dir, part: &str, purpose: OpenMode) -> Result<Dir, FileError> {
    let name = spelling(folder, part);
    if purpose == OpenMode::Create
        && let Err(error) = folder.create_dir(&name)
        && error.kind() != io::ErrorKind::AlreadyExists
    {
        return Err(error.into());
    }
    folder.open_dir_nofollow(&name).map_err(|error| reason(folder, &name, part, error, EntryKind::Folder))
}

/// The reason why an entry is not opened. Systems report a link in several ways; this only determines the message,
/// after the entry has been refused.
fn reason(folder: &Dir, name: &OsStr, part: &str, error: io::Error, wanted: EntryKind) -> FileError {
    match folder.symlink_metadata(name) {
        Ok(known) if known.is_symlink() => FileError::Link(part.to_owned()),
        Ok(known) if wanted == EntryKind::File && !known.is_file() => FileError::NotAFile,
        _ => error.into(),
    }
}

/// The name of an entry of `folder`: with exactly this spelling, otherwise the first with another letter case.
fn spelling(folder: &Dir, name: &str) -> OsString {
    if folder.symlink_metadata(name).is_ok() {
        return name.into();
    }
    let entries = folder.entries().into_iter().flatten().flatten().map(|entry| entry.file_name());
    entries.filter(|found| found.eq_ignore_ascii_case(name)).min().unwrap_or_else(|| name.into())
}

/// Returns true for an ordinary name. A name that is a device on some PC is refused on all of them.
fn is_name(part: &str) -> bool {
    const DEVICES: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];
    let stem = part.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let is_port = |kind: &str| stem.strip_prefix(kind).is_some_and(|number| number.chars().count() == 1);
    let is_device = DEVICES.contains(&stem.as_str()) || is_port("COM") || is_port("LPT");
    let is_plain = part != ".." && !part.chars().any(|character| character == ':' || character.is_control());
    is_plain && !is_device
}

impl HostFiles for Directory {
    fn read(&mut self, name: &str) -> Result<Vec<u8>, FileError> {
        let mut bytes = Vec::new();
        self.open(name, OpenMode::Read)?.take(FILE_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > FILE_BYTES { Err(FileError::TooLarge) } else { Ok(bytes) }
    }

    fn create(&mut self, name: &str, keep: bool) -> Result<(), FileError> {
        let file = self.open(name, OpenMode::Create)?;
        if !keep {
            file.set_len(0)?;
        }
        Ok(())
    }

    fn append(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        Ok(self.open(name, OpenMode::Append)?.write_all(bytes)?)
    }

    fn place_of(&self, name: &str) -> Option<String> {
        let mut place = self.root.clone();
        let mut folder = self.open_root().ok();
        for part in self.parts(name).ok()? {
            let name = folder.as_ref().map_or_else(|| part.clone().into(), |folder| spelling(folder, &part));
            folder = folder.and_then(|folder| folder.open_dir_nofollow(&name).ok());
            place.push(name);
        }
        Some(place.to_string_lossy().replace('\\', "/"))
    }

    fn handle(&self) -> Box<dyn HostFiles> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A temporary folder with a file inside and a file outside; removed at the end.
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
            assert_eq!(directory.place_of(name).as_deref(), expect, "{name}");
        }
        let names = [("C:\\Log.txt", "logs/today.txt"), ("c:\\x", "../x")];
        let directory =
            directory.with_names(names.map(|(said, meant)| (said.to_owned(), meant.to_owned())).to_vec());
        assert_eq!(directory.place_of("c:\\log.txt").as_deref(), Some("root/logs/today.txt"));
        assert_eq!(directory.place_of("c:\\x"), None);
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
    fn a_file_with_a_second_name_is_read_and_not_written() {
        let scratch = Scratch::new("hard-link");
        fs::hard_link(scratch.0.join("secret.txt"), scratch.0.join("disk/log.txt")).expect("a link");
        let mut directory = scratch.directory();
        assert_eq!(directory.read("c:\\log.txt"), Ok(b"outside".to_vec()));
        let refused = || Err(FileError::HardLink("Log.txt".to_owned()));
        assert_eq!(directory.create("Log.txt", false), refused());
        assert_eq!(directory.create("Log.txt", true), refused());
        assert_eq!(directory.append("Log.txt", b"changed"), refused());
        assert_eq!(fs::read(scratch.0.join("secret.txt")).expect("it is there"), b"outside");
    }

    /// Opening a pipe without a writer would never end.
    #[cfg(unix)]
    #[test]
    fn what_waits_is_not_a_file() {
        let scratch = Scratch::new("pipe");
        let socket = scratch.0.join("disk/socket");
        let _open = std::os::unix::net::UnixListener::bind(socket).expect("a socket");
        let pipe = std::process::Command::new("mkfifo").arg(scratch.0.join("disk/pipe")).status();
        assert!(pipe.expect("there is mkfifo").success());
        for name in ["pipe", "socket"] {
            let mut directory = scratch.directory();
            assert_eq!(directory.read(name), Err(FileError::NotAFile), "{name}");
            assert_eq!(directory.create(name, false), Err(FileError::NotAFile), "{name}");
            assert_eq!(directory.append(name, b"x"), Err(FileError::NotAFile), "{name}");
        }
    }

    /// Another process exchanges the folder and a link to outside while files are read and written: a million times in
    /// long runs.
    #[cfg(target_os = "linux")]
    #[test]
    fn no_exchange_of_folders_and_links_leads_outside() {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        use std::sync::atomic::{AtomicBool, Ordering};

        let swaps = if std::env::var_os("CC67_LONG").is_some() { 1_000_000 } else { 2_000 };
        let scratch = Scratch::new("swaps");
        let (folder, link) = (scratch.0.join("disk/Temp"), scratch.0.join("disk/link"));
        let outside = scratch.0.join("outside");
        fs::create_dir(&outside).expect("it is writable");
        for file in ["Data.txt", "Log.txt"] {
            fs::write(outside.join(file), "outside").expect("it is writable");
        }
        std::os::unix::fs::symlink(&outside, &link).expect("a link");
        let mut directory = scratch.directory();
        let has_ended = AtomicBool::new(false);
        let (mut inside, mut refused, mut escaped) = (0_u64, 0_u64, 0_u64);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for swap in 0..swaps {
                    // An error here is detected below, because nothing is refused then.
                    let _ = renameat_with(CWD, &folder, CWD, &link, RenameFlags::EXCHANGE);
                    // The system refuses every read during which names change, so the folder and the link stay now and
                    // then for a moment.
                    if swap % 17 == 0 {
                        std::thread::sleep(std::time::Duration::from_micros(20));
                    }
                }
                has_ended.store(true, Ordering::Relaxed);
            });
            while !has_ended.load(Ordering::Relaxed) {
                match directory.read("Temp/Data.txt") {
                    Ok(bytes) if bytes == b"inside" => inside += 1,
                    Ok(_) => escaped += 1,
                    Err(_) => refused += 1,
                }
                // It may succeed or be refused; only files outside matter.
                let _ = directory.create("Temp/Log.txt", false);
                let _ = directory.append("Temp/Log.txt", b"x");
                let _ = directory.create("Temp/made.txt", false);
            }
        });
        assert_eq!(escaped, 0, "{inside} read, {refused} refused");
        assert!(inside > 0 && refused > 0, "{inside} read, {refused} refused");
        let there = fs::read_dir(&outside).expect("it is there").map(|entry| entry.expect("one").file_name());
        let mut names: Vec<_> = there.collect();
        names.sort();
        assert_eq!(names, ["Data.txt", "Log.txt"]);
        for name in names {
            assert_eq!(fs::read(outside.join(name)).expect("it is there"), b"outside");
        }
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
