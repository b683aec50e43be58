//! The sessions in the book's chapter on debugging have the output shown there.
//!
//! `CC67_WRITE_BOOK=1` writes the output of the commands into the chapter.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use cc67_debug::{CommandOutput, Debugger, Shell};
use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use kmotiondef::{ThreadId, Ticks};

const BEGIN: &str = "```text session";

/// Returns the transcript of a session with these commands.
fn transcript(program: &Path, level: Level, session: &str) -> String {
    let mut setup = Setup::default();
    setup.options.level = level;
    setup.options.gc_sections = level == Level::Full;
    let thread = ThreadId::new(1).expect("there are 7");
    let program = UserProgram::compile(program, thread, &setup.options).expect("it compiles");
    setup.programs.push(program.started());
    let debugger = Debugger::new(setup.session().expect("a board"), Ticks::new(1_000_000));
    let mut shell = Shell::new(debugger);
    let mut out = String::new();
    for command in session.lines().filter_map(|line| line.strip_prefix("(cc67) ")) {
        let mut said = String::new();
        let answer = shell.command(command, &mut |text| said.push_str(text)).expect(command);
        let CommandOutput::Text(text) = answer else { break };
        // Writing to a string cannot fail.
        let _ = write!(out, "(cc67) {command}\n{said}{text}");
    }
    out
}

#[test]
fn sessions_run_as_the_book_shows() {
    let chapter = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../book/src/debugging.md");
    let text = fs::read_to_string(&chapter).expect("the chapter");
    let source = text.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a program");
    let folder = std::env::temp_dir().join(format!("cc67-debug-book-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let program = folder.join("count.c");
    fs::write(&program, source).expect("a file");
    let mut whole = String::new();
    let mut rest = text.as_str();
    let mut count = 0;
    while let Some((before, more)) = rest.split_once(BEGIN) {
        let (options, more) = more.split_once('\n').expect("a line");
        let (session, behind) = more.split_once("```").expect("an end");
        let level = if options.contains("-O0") { Level::None } else { Level::Full };
        let expect = transcript(&program, level, session);
        let _ = write!(whole, "{before}{BEGIN}{options}\n{expect}```");
        rest = behind;
        count += 1;
    }
    whole.push_str(rest);
    fs::remove_dir_all(&folder).expect("the folder is ours");
    if std::env::var_os("CC67_WRITE_BOOK").is_some() {
        fs::write(&chapter, whole).expect("the chapter can be written");
        return;
    }
    assert!(count >= 3);
    assert_eq!(text, whole);
}
