//! Hostile source text: the compiler always ends soon, with little memory, and with messages.
//!
//! The inputs are generated here, the same in each run. Most are compiled in this process; the heaviest are passed to
//! the command under a limit of memory and processor time.

use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use compiler::diag::Severity;
use compiler::pp::{Disk, MemoryFiles};
use compiler::render::Format;
use compiler::render::human::Color;
use compiler::{Options, render};
use harness::{Scratch, cc67};

use crate::inputs::{self, Input};

/// The time limit for one input, on a computer that may be busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// The limit of the command's processor time, in seconds.
const PROCESSOR_TIME: u32 = 60;

/// The number of diagnostics beyond which they are no longer helpful.
const MOST_ERRORS: usize = 25;

/// The maximum length of the diagnostics for one input.
const MOST_TEXT: usize = 1 << 20;

/// The address space of the command in KiB: 1 GiB, plus the 512 MiB to which the stack may grow.
const ADDRESS_SPACE: u32 = (1 << 20) + (1 << 19);

/// Returns a complaint about the compiler's behaviour for an input; `None` if it is correct.
fn complaint(input: &Input) -> Option<String> {
    #[expect(clippy::disallowed_methods, reason = "the test is about time")]
    let start = Instant::now();
    let files = MemoryFiles::new().with("hostile.c", input.text.clone());
    let options = Options::default();
    let mut compilation = compiler::compile(Path::new("hostile.c"), input.text.clone(), &options, &files);
    let thread = kmotiondef::ThreadId::new(1).expect("1 is a thread");
    let linked = compilation.link(thread, &options);
    let diagnostics: Vec<_> = compilation.diagnostics().into_iter().cloned().collect();
    let text = render::render(&diagnostics, &compilation.sources, Format::Human, Color::Never);
    let elapsed = start.elapsed();

    let errors: Vec<_> = diagnostics.iter().filter(|it| it.severity == Severity::Error).collect();
    let say = |what: String| {
        let shown: String = text.chars().take(600).collect();
        Some(format!("{}: {what}\n{shown}", input.name))
    };
    if elapsed > PATIENCE {
        return say(format!("took {elapsed:?}"));
    }
    if linked.is_none() && errors.is_empty() {
        return say("refused without a message".to_owned());
    }
    if errors.len() > MOST_ERRORS || text.len() > MOST_TEXT {
        return say(format!("{} errors in {} bytes", errors.len(), text.len()));
    }
    match input.says {
        Some(expect) if !errors.iter().any(|error| error.message.contains(expect)) => {
            say(format!("expected an error with {expect:?}"))
        }
        _ => None,
    }
}

#[test]
fn hostile_text_gets_an_answer() {
    let inputs = inputs::all();
    assert!(inputs.len() >= 200, "only {} inputs", inputs.len());
    let next = AtomicUsize::new(0);
    let work = || {
        let mut complaints = Vec::new();
        while let Some(input) = inputs.get(next.fetch_add(1, Ordering::Relaxed)) {
            complaints.extend(complaint(input));
        }
        complaints
    };
    let complaints: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> = (0..2).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("the compiler does not panic")).collect()
    });
    assert!(complaints.is_empty(), "{} inputs\n\n{}", complaints.len(), complaints.join("\n"));
}

#[test]
#[cfg(target_os = "linux")]
fn the_heaviest_sources_stay_below_a_gigabyte() {
    let scratch = Scratch::new("hostile-heavy");
    for input in inputs::heavy() {
        scratch.write("hostile.c", &input.text);
        let limits =
            format!("ulimit -v {ADDRESS_SPACE}; ulimit -t {PROCESSOR_TIME}; exec \"$0\" check hostile.c");
        let output = Command::new("sh")
            .args(["-c", &limits, harness::command()])
            .current_dir(scratch.path())
            .output()
            .expect("the shell starts");
        let text = String::from_utf8_lossy(&output.stderr);
        let shown: String = text.chars().take(600).collect();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}: {:?}\n{shown}", input.name, output.status);
        assert!(!text.contains("panicked"), "{}: {shown}", input.name);
    }
}

#[test]
#[cfg(unix)]
fn includes_that_are_not_regular_files_are_refused() {
    let scratch = Scratch::new("hostile-include");
    scratch.write("sub/x.h", "");
    std::os::unix::fs::symlink("loop.h", scratch.path().join("loop.h")).expect("links can be made");
    std::os::unix::fs::symlink("again.c", scratch.path().join("itself.h")).expect("links can be made");
    for name in ["sub", ".", "..", "/", "/dev/zero", "/dev/null/x", "loop.h", "itself.h", "sub/x.h/y"] {
        scratch.write("again.c", format!("#include \"{name}\"\nmain() {{ }}\n"));
        let output = cc67(&scratch, ["check", "again.c"]);
        assert_eq!(output.code, 1, "{name}: {output:?}");
        assert!(output.stderr.contains(":1:10"), "{name}: {}", output.stderr);
        assert!(!output.stderr.contains("os error"), "{name}: {}", output.stderr);
    }
    let files = Disk;
    let path = scratch.path().join("again.c");
    let compilation =
        compiler::compile(&path, b"#include \"sub/x.h\"\nmain() { }\n".to_vec(), &Options::default(), &files);
    assert!(compilation.object.is_some());
}
