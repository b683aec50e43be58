//! The terminal of the debugger, on small programs.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use cc67_debug::{CommandOutput, Debugger, Shell};
use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use kmotiondef::{ThreadId, Ticks};
use runtime::Board;

/// A folder for the sources of a test, which is deleted at the end of the test.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("cc67-debug-commands-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // The operating system cleans up a folder that remains.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A shell for programs in threads 1, 2, …, named `a.c`, `b.c`, ….
pub(crate) fn shell(folder: &Folder, level: Level, programs: &[&str]) -> Shell<Board> {
    let mut setup = Setup::default();
    setup.options.level = level;
    for (index, text) in programs.iter().enumerate() {
        let letter = char::from(b'a' + index as u8);
        let path = folder.0.join(format!("{letter}.c"));
        fs::write(&path, format!("#include \"KMotionDef.h\"\n{text}")).expect("a file");
        let thread = ThreadId::new(index as i32 + 1).expect("there are 7");
        let program = UserProgram::compile(&path, thread, &setup.options).expect("it compiles");
        setup.programs.push(program.started());
    }
    let debugger = Debugger::new(setup.session().expect("a board"), Ticks::new(1_000_000));
    Shell::new(debugger)
}

/// Returns the output of commands without board times; a rejected command has its error message.
pub(crate) fn session(level: Level, programs: &[&str], commands: &str) -> String {
    let folder = Folder::new();
    let mut shell = shell(&folder, level, programs);
    let mut out = String::new();
    for command in commands.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let mut said = String::new();
        let answer = shell.command(command, &mut |text| said.push_str(text));
        out.push_str(&said);
        match answer {
            Ok(CommandOutput::Text(text)) => out.push_str(&text),
            Ok(CommandOutput::Quit) => break,
            Err(error) => out.push_str(&format!("{error}\n")),
        }
    }
    let lines = out.lines().map(|line| match line.split_once(" [thread ") {
        Some((before, _)) => before,
        None => line,
    });
    lines.fold(String::new(), |text, line| text + &without_addresses(line) + "\n")
}

/// A line with the addresses of programs replaced by a word, as they depend on the code before them.
fn without_addresses(line: &str) -> String {
    let mut parts = line.split("0x800");
    let first = parts.next().unwrap_or_default().to_owned();
    parts
        .fold(first, |text, part| text + "ADDRESS" + part.trim_start_matches(|c: char| c.is_ascii_hexdigit()))
}

/// Checks the output of commands; blanks at the beginning of lines are ignored.
#[track_caller]
pub(crate) fn check(level: Level, programs: &[&str], commands: &str, expect: &str) {
    let found = session(level, programs, commands);
    let expect: String = expect.lines().map(|line| line.trim_start().to_owned() + "\n").collect();
    let found: String = found.lines().map(|line| line.trim_start().to_owned() + "\n").collect();
    assert_eq!(found, expect, "\n{found}");
}
