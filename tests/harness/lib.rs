//! Shared code of the whole-system tests: running the command, scratch folders, program files.

pub mod choices;
pub mod csv;
pub mod filetest;
pub mod generate;
pub mod kinds;
mod measure;
pub mod motions;
pub mod oracles;
pub mod polling;
pub mod promptness;
pub mod random;
pub mod stages;
pub mod tokens;
pub mod usage;
pub mod vendor;
pub mod views;

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// The root of the workspace.
#[must_use]
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace")
}

/// Returns a path relative to the root of the workspace, with `/` as separator.
#[must_use]
pub fn relative(path: &Path) -> String {
    path.strip_prefix(root()).expect("the path lies in the workspace").to_string_lossy().replace('\\', "/")
}

/// Returns whether tests should take their long form: if `CC67_LONG` is set in the environment.
#[must_use]
pub fn is_long() -> bool {
    std::env::var_os("CC67_LONG").is_some()
}

/// The folder of npm packages, if it contains one with this name. A test that needs it is skipped with a message if
/// this is `None`. `.ci/node/install` fills `target/node`.
#[must_use]
pub fn node_modules(package: &str) -> Option<PathBuf> {
    let modules = root().join("target/node/node_modules");
    let has_node =
        || Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    if modules.join(package).is_dir() && has_node() {
        return Some(modules);
    }
    println!("not run: npm's `{package}` is not there; `.ci/node/install` fetches it");
    None
}

/// The result of a run of the command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// The exit code; -1 if a signal ended it.
    pub code: i32,
    /// The output of the programs.
    pub stdout: String,
    /// Everything else.
    pub stderr: String,
}

impl Output {
    /// The three parts as one text for snapshots.
    #[must_use]
    pub fn render(&self) -> String {
        let mut text = self.stdout.clone();
        if !self.stderr.is_empty() {
            text.push_str("---- stderr\n");
            text.push_str(&self.stderr);
        }
        text.push_str(&format!("---- exit {}\n", self.code));
        text
    }
}

/// The path of the command under test.
///
/// # Panics
/// The command has not been built; `cargo test` builds it before the tests of this package.
#[must_use]
pub fn command() -> &'static str {
    static COMMAND: LazyLock<String> = LazyLock::new(|| {
        let named = std::env::var("CARGO_BIN_EXE_cc67-under-test");
        let found = named.map_or_else(|_| beside_this_process(), PathBuf::from);
        assert!(found.is_file(), "{} has not been built", found.display());
        found.into_os_string().into_string().expect("the target folder has a name in UTF-8")
    });
    &COMMAND
}

/// Returns the folder to which Cargo writes commands: the parent of the tests' folder.
fn beside_this_process() -> PathBuf {
    let test = std::env::current_exe().expect("a running process has a file");
    let folder = test.parent().and_then(Path::parent).expect("tests are two folders below the target folder");
    folder.join(format!("cc67-under-test{}", std::env::consts::EXE_SUFFIX))
}

/// Makes the command under test available under another path: by a hard link, or by a copy on another file system.
///
/// The copy is written by a separate process. A file written by this process cannot be executed while a child that
/// another test starts at the same time still holds the writer's descriptor ("text file busy").
///
/// # Panics
/// The file cannot be created.
pub fn place_command(at: &Path) {
    if std::fs::hard_link(command(), at).is_ok() {
        return;
    }
    if cfg!(unix) {
        let copied = std::process::Command::new("cp").arg(command()).arg(at).status();
        assert!(copied.is_ok_and(|status| status.success()), "{} cannot be written", at.display());
    } else {
        std::fs::copy(command(), at).expect("the command can be copied");
    }
}

/// Returns the operating system's message for a missing file.
///
/// # Panics
/// There is a file with an impossible name.
#[must_use]
pub fn no_such_file() -> String {
    let error = std::fs::read("a file that is missing").expect_err("there is none").to_string();
    error.split(" (os error").next().unwrap_or(&error).to_owned()
}

/// Runs cc67 in a folder.
///
/// # Panics
/// The command does not start.
#[must_use]
pub fn cc67<A: AsRef<OsStr>>(folder: impl AsRef<Path>, arguments: impl IntoIterator<Item = A>) -> Output {
    cc67_with_input(folder, arguments, "")
}

/// Runs cc67 in a folder, with a text on its standard input.
///
/// # Panics
/// The command does not start.
#[must_use]
pub fn cc67_with_input<A: AsRef<OsStr>>(
    folder: impl AsRef<Path>,
    arguments: impl IntoIterator<Item = A>,
    input: &str,
) -> Output {
    execute(command(), folder.as_ref(), arguments, input)
}

/// Runs a command other than cc67 in a folder.
///
/// # Panics
/// The command does not start.
#[must_use]
pub fn run_in<A: AsRef<OsStr>>(
    binary: &str,
    folder: &Path,
    arguments: impl IntoIterator<Item = A>,
) -> Output {
    execute(binary, folder, arguments, "")
}

fn execute<A: AsRef<OsStr>>(
    binary: &str,
    folder: &Path,
    arguments: impl IntoIterator<Item = A>,
    input: &str,
) -> Output {
    let mut child = Command::new(binary)
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command under test starts");
    // A command that does not read its input is not a failure of the test.
    let _ = child.stdin.take().expect("it is piped").write_all(input.as_bytes());
    let output = child.wait_with_output().expect("the command under test ends");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).replace("\r\n", "\n");
    Output {
        code: output.status.code().unwrap_or(-1),
        stdout: text(&output.stdout),
        stderr: text(&output.stderr),
    }
}

/// Converts a path with slashes to this system's notation.
#[must_use]
pub fn native(path: &str) -> String {
    path.replace('/', std::path::MAIN_SEPARATOR_STR)
}

/// A folder for one test, removed on drop.
#[derive(Debug)]
pub struct Scratch(PathBuf);

impl Scratch {
    /// Creates the folder; `name` shows which test it belongs to.
    ///
    /// # Panics
    /// There is no space for temporary files.
    #[must_use]
    pub fn new(name: &str) -> Self {
        static MADE: AtomicU32 = AtomicU32::new(0);
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("cc67-{}-{number}-{name}", std::process::id()));
        fs::create_dir_all(&path).expect("the temporary folder is writable");
        Self(path)
    }

    /// Returns its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file into it.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().expect("a file has a folder")).expect("the folder is writable");
        fs::write(path, content).expect("the file is writable");
        self
    }
}

impl AsRef<Path> for Scratch {
    fn as_ref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder that remains does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Returns all files with the extension in a folder and its subfolders, sorted, except in hidden folders and `target`.
#[must_use]
pub fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("the folder is readable") {
            let path = entry.expect("the entry is readable").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && name != "target" && !name.starts_with('.') {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
