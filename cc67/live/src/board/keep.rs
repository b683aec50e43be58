//! "Save as test": the manual actions become a stimulus, and the console becomes the output that `cc67 test` expects.
//!
//! A test `NAME` consists of a program `NAME.c` that includes the shown one, `NAME.stim` with the actions, and
//! `NAME.expected`, which the command itself writes by running the test. The output of that run is then compared with
//! the page's console, including the board times.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

use serde_json::json;

use crate::hub::Mailbox;
use crate::{Show, TestOption};

/// The maximum length of a name.
const LONGEST: usize = 64;

/// A test to be written.
#[derive(Debug)]
pub(super) struct TestFiles {
    /// The path, without an extension.
    path: PathBuf,
    source: String,
    stimulus: String,
    /// The page's console, with board times; `None` if some of it was dropped.
    console: Option<String>,
    command: PathBuf,
}

/// The parts of a test.
#[derive(Debug)]
pub(super) struct Run<'a> {
    /// The manual actions.
    pub(super) stimulus: &'a str,
    /// The duration, in seconds of board time.
    pub(super) seconds: f64,
    /// The console of the page.
    pub(super) console: Option<String>,
}

impl TestFiles {
    /// Creates a test with this name in the folder of the first program.
    pub(super) fn new(name: &str, show: &Show, run: Run<'_>) -> Result<Self, String> {
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || name.len() > LONGEST || !name.chars().all(is_name) {
            return Err("the name of a test has letters, digits, `_` and `-`".to_owned());
        }
        let Some((first, others)) = show.programs.split_first() else {
            return Err("a test needs a program".to_owned());
        };
        if show.programs.iter().any(|program| program.is_image) {
            return Err("a test is made of sources, not of images".to_owned());
        }
        let taken: Vec<_> = others.iter().map(|program| program.thread).collect();
        let lowest = kmotiondef::ThreadId::all().find(|thread| !taken.contains(thread));
        if lowest != Some(first.thread) {
            return Err("the first program of a test is in the lowest thread that is free".to_owned());
        }
        let folder = first.path.parent().unwrap_or(Path::new("")).to_owned();
        let path = folder.join(name);
        for ending in ["c", "stim", "expected"] {
            let file = path.with_extension(ending);
            if file.exists() {
                return Err(format!("there is {} already", file.display()));
            }
        }
        let mut words = vec![format!("--time --for {:.5} --stim {name}.stim", run.seconds)];
        for option in &show.test_options {
            words.push(match option {
                TestOption::Text(text) if text.contains(char::is_whitespace) => {
                    return Err(format!(
                        "`{text}` has a blank in it, which the first line of a test cannot hold"
                    ));
                }
                TestOption::Text(text) => text.clone(),
                TestOption::File(option, file) => format!("{option} {}", beside(&folder, file)?),
            });
        }
        for other in others {
            words.push(format!("also {}:{}", other.thread, beside(&folder, &other.path)?));
        }
        let included = first.path.file_name().unwrap_or_default().to_string_lossy();
        let source = format!(
            "// cc67: run {}\n//\n// {name}.c - {included} with what was done by hand on the page of `cc67 live`.\n\n#include \"{included}\"\n",
            words.join(" ")
        );
        let (stimulus, command) = (run.stimulus.to_owned(), show.command.clone());
        Ok(Self { path, source, stimulus, console: run.console, command })
    }

    /// Writes and runs the test on a separate thread, and posts the result.
    pub(super) fn write(self, mailbox: std::sync::Arc<Mailbox>) {
        thread::spawn(move || {
            let message = match self.make() {
                Ok(text) => json!({ "kind": "saved", "text": text }),
                Err(text) => json!({ "kind": "problem", "text": text }),
            };
            mailbox.post(&message.to_string().into());
        });
    }

    fn make(&self) -> Result<String, String> {
        let source = self.path.with_extension("c");
        for (file, text) in [(&source, &self.source), (&self.path.with_extension("stim"), &self.stimulus)] {
            fs::write(file, text).map_err(|error| format!("cannot write {}: {error}", file.display()))?;
        }
        let output = Command::new(&self.command)
            .args(["test", "--bless", "--force"])
            .arg(&source)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("cannot run the test: {error}"))?;
        let golden = fs::read_to_string(self.path.with_extension("expected"));
        let Ok(golden) = golden else {
            return Err(format!(
                "the test cannot be run: {}",
                String::from_utf8_lossy(&output.stderr).trim()
            ));
        };
        let name = source.display();
        match &self.console {
            Some(console) if !golden.starts_with(console.as_str()) => {
                Err(format!("{name} is saved, but its run prints something else than this page has shown"))
            }
            Some(_) => Ok(format!(
                "{name} is saved; its run prints what this page has shown, at the same board times"
            )),
            None => Ok(format!("{name} is saved")),
        }
    }
}

/// The path of a file relative to `folder`.
fn beside(folder: &Path, file: &Path) -> Result<String, String> {
    let absolute = |path: &Path| {
        let path = if path == Path::new("") { Path::new(".") } else { path };
        fs::canonicalize(path).map_err(|error| format!("cannot find {}: {error}", path.display()))
    };
    let (folder, file) = (absolute(folder)?, absolute(file)?);
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(one, other)| one == other).count();
    let up = from.iter().skip(common).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(to.into_iter().skip(common)).collect();
    let text = path.to_string_lossy().replace('\\', "/");
    if text.contains(char::is_whitespace) {
        return Err(format!("`{text}` has a blank in its name, which the first line of a test cannot hold"));
    }
    Ok(text)
}
