//! Test programs that state their expected results in directives.
//!
//! A directive is a line `//@ name: value`:
//!
//! | directive | meaning |
//! |---|---|
//! | `args: …` | arguments before the file's name (`check` instead of `run` as the first word is possible) |
//! | `prints: …` | the next line of stdout; together these lines are all of stdout |
//! | `exit: n` | exit code, 0 if not stated |
//! | `cycles: n` | the exact number of cycles that the program spends, on every engine; its last line, which `--bless` writes |
//! | `says: …` | stderr contains this text |
//! | `snapshot` | stderr as a whole is the snapshot with the file's name, next to the file |
//! | `byte: c 0d 0a` | the character `c` in the text is replaced by these bytes (hexadecimal, possibly none) |
//! | `scratch` | it is executed in its own folder, as it writes files |
//! | `no-final-newline` | the newline at the end of the file is removed |
//! | `processor: WHY` | as code for the real processor the program behaves differently, for this reason |
//! | `uses: FILE` | the annotations in this included file are also checked |
//!
//! An annotation `//~ what` after a line is a diagnostic expected there: the name of a warning's switch, or `error`;
//! `what: text` requires that text in its message. `//~^` refers to the line above, `//~^^` to the one before that.
//! With `-if-case-matters` after `what` it is expected only if file names are case-sensitive. A file with annotations
//! must have no other diagnostics than these. Without `says`, `snapshot` or annotations, stderr must be empty.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Output, Scratch, cc67, measure};

/// A diagnostic at a line, expected or found.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Remark {
    file: String,
    line: usize,
    /// The switch of a warning, or otherwise the severity.
    what: String,
    /// The message, or a part of it.
    text: String,
}

impl Remark {
    fn is_met_by(&self, found: &Self) -> bool {
        (&self.file, self.line, &self.what) == (&found.file, found.line, &found.what)
            && found.text.contains(&self.text)
    }

    fn render(&self) -> String {
        format!("{}:{}: {}: {}\n", self.file, self.line, self.what, self.text)
    }
}

/// A test program and its requirements.
#[derive(Debug, Default)]
pub struct FileTest {
    path: PathBuf,
    arguments: Vec<String>,
    stdout: String,
    exit: i32,
    cycles: Option<i64>,
    says: Vec<String>,
    is_snapshot: bool,
    bytes: Vec<(String, Vec<u8>)>,
    cuts_final_newline: bool,
    is_apart: bool,
    differs_on_processor: bool,
    remarks: Vec<Remark>,
}

impl FileTest {
    /// Reads the directives of the program at `path`.
    #[must_use]
    pub fn read(path: &Path) -> Self {
        let text = text_of(path);
        let mut test =
            Self { path: path.to_owned(), remarks: annotations(&name_of(path), &text), ..Self::default() };
        for line in text.lines() {
            let Some(directive) = line.trim_start().strip_prefix("//@ ") else { continue };
            let (name, value) = directive.split_once(':').unwrap_or((directive, ""));
            test.obey(name.trim(), value.strip_prefix(' ').unwrap_or(value));
        }
        test
    }

    fn obey(&mut self, name: &str, value: &str) {
        match name {
            "args" => self.arguments = value.split_whitespace().map(str::to_owned).collect(),
            "prints" => self.stdout.push_str(&format!("{value}\n")),
            "exit" => self.exit = value.trim().parse().expect("`exit` takes a number"),
            "cycles" => self.cycles = Some(value.trim().parse().expect("`cycles` takes a number")),
            "says" => self.says.push(value.to_owned()),
            "snapshot" => self.is_snapshot = true,
            "byte" => self.bytes.push(stand_in(value)),
            "processor" => self.differs_on_processor = true,
            "scratch" => self.is_apart = true,
            "no-final-newline" => self.cuts_final_newline = true,
            "uses" => {
                let used = self.folder().join(value);
                self.remarks.extend(annotations(value, &text_of(&used)));
            }
            other => panic!("{}: no directive `{other}`", self.path.display()),
        }
    }

    /// The folder of the program.
    ///
    /// # Panics
    /// Never: a file that was read is in a folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.path.parent().expect("a file has a folder")
    }

    /// Returns whether the caller should compare stderr as a whole with a snapshot.
    #[must_use]
    pub fn is_snapshot(&self) -> bool {
        self.is_snapshot
    }

    /// Returns its expected output as code for the real processor; `None` if it behaves differently there, or ends in a
    /// trap, which does not exist there.
    #[must_use]
    pub fn stdout_of_code(&self) -> Option<&str> {
        let is_same = self.is_executed() && self.exit == 0 && !self.differs_on_processor;
        is_same.then_some(&self.stdout)
    }

    /// Returns whether the program is executed, not only checked.
    #[must_use]
    pub fn is_executed(&self) -> bool {
        self.arguments.first().is_none_or(|word| word != "check")
    }

    /// The cycles stated in the file.
    #[must_use]
    pub fn cycles(&self) -> Option<i64> {
        self.cycles
    }

    /// Returns the cycles that the program spends on every engine, which must agree; `None` for programs that do not
    /// compile, or whose run depends on arguments.
    ///
    /// # Panics
    /// If the engines differ.
    #[must_use]
    pub fn measured_cycles(&self) -> Option<i64> {
        if !self.arguments.is_empty() {
            return None;
        }
        let source = self.rewritten().unwrap_or_else(|| text_of(&self.path).into_bytes());
        measure::cycles(&self.path, source)
    }

    /// Writes the directive `cycles` as the last line of the file, so that no other line moves.
    ///
    /// # Panics
    /// If the file cannot be written.
    pub fn state_cycles(&self, cycles: i64) {
        let text = text_of(&self.path);
        let line = format!("//@ cycles: {cycles}\n");
        let mut is_stated = false;
        let mut text: String = (text.split_inclusive('\n'))
            .map(|old| {
                if old.starts_with("//@ cycles:") {
                    is_stated = true;
                    line.as_str()
                } else {
                    old
                }
            })
            .collect();
        if !is_stated {
            text = format!("{}\n{line}", text.trim_end_matches('\n'));
        }
        fs::write(&self.path, text).expect("the test is writable");
    }

    /// Runs the program in its folder, so that messages name it without a path; `more` follows its own arguments.
    #[must_use]
    pub fn run(&self, more: &[&str]) -> Output {
        let mut arguments = self.arguments.clone();
        if !matches!(arguments.first().map(String::as_str), Some("run" | "check")) {
            arguments.insert(0, "run".to_owned());
        }
        arguments.extend(more.iter().map(ToString::to_string));
        arguments.push(name_of(&self.path));
        match self.rewritten() {
            None => cc67(self.folder(), arguments),
            Some(source) => {
                let name = self.path.to_string_lossy().replace(|c: char| !c.is_ascii_alphanumeric(), "-");
                let scratch = Scratch::new(&format!("{name}{}", more.concat()));
                scratch.write(&name_of(&self.path), source);
                cc67(&scratch, arguments)
            }
        }
    }

    /// The source with its `byte` characters replaced; `None` if there are none.
    fn rewritten(&self) -> Option<Vec<u8>> {
        if self.bytes.is_empty() && !self.cuts_final_newline && !self.is_apart {
            return None;
        }
        let text = text_of(&self.path);
        let text = if self.cuts_final_newline { text.trim_end_matches('\n') } else { &text };
        let is_byte_directive = |line: &str| line.starts_with("//@ byte");
        let mut source = Vec::new();
        for line in text.split_inclusive('\n') {
            match is_byte_directive(line) {
                true => source.extend_from_slice(b"//\n"),
                false => source.extend(line.chars().flat_map(|c| self.bytes_of(c).into_owned())),
            }
        }
        Some(source)
    }

    fn bytes_of(&self, character: char) -> Cow<'_, [u8]> {
        let name = character.to_string();
        match self.bytes.iter().find(|(stand_in, _)| *stand_in == name) {
            Some((_, bytes)) => Cow::Borrowed(bytes),
            None => Cow::Owned(name.into_bytes()),
        }
    }

    /// Returns the failure of a run, except for snapshots; `None` if there is none.
    #[must_use]
    pub fn complaint(&self, output: &Output) -> Option<String> {
        let complain = |what: &str| Some(format!("{}: {what}\n{}", self.path.display(), output.render()));
        if output.stdout != self.stdout {
            return complain(&format!("expected to print\n{}", self.stdout));
        }
        if output.code != self.exit {
            return complain(&format!("expected exit code {}", self.exit));
        }
        if let Some(missing) = self.says.iter().find(|text| !output.stderr.contains(*text)) {
            return complain(&format!("expected to say {missing:?}"));
        }
        if !self.remarks.is_empty() {
            return self.difference(output).and_then(|difference| complain(&difference));
        }
        if self.says.is_empty() && !self.is_snapshot && !output.stderr.is_empty() {
            return complain("expected to say nothing");
        }
        None
    }

    /// Returns the differences between the diagnostics of a run and the annotations.
    fn difference(&self, output: &Output) -> Option<String> {
        let found = diagnostics(&output.stderr);
        let missing = self.remarks.iter().filter(|remark| !found.iter().any(|found| remark.is_met_by(found)));
        let missing: String = missing.map(Remark::render).collect();
        let surplus = found.iter().filter(|found| !self.remarks.iter().any(|remark| remark.is_met_by(found)));
        let surplus: String = surplus.map(Remark::render).collect();
        if !missing.is_empty() {
            return Some(format!("annotated, but not said:\n{missing}but instead:\n{surplus}"));
        }
        (!surplus.is_empty()).then(|| format!("said, but not annotated:\n{surplus}"))
    }
}

fn text_of(path: &Path) -> String {
    String::from_utf8_lossy(&fs::read(path).expect("the file is readable")).into_owned()
}

fn name_of(path: &Path) -> String {
    path.file_name().expect("a file has a name").to_string_lossy().into_owned()
}

/// The value of a `byte` directive: a character and the bytes that replace it.
fn stand_in(value: &str) -> (String, Vec<u8>) {
    let mut words = value.split_whitespace();
    let character = words.next().expect("`byte` names a character").to_owned();
    let bytes = words.map(|word| u8::from_str_radix(word, 16).expect("bytes are hexadecimal"));
    (character, bytes.collect())
}

/// The diagnostics expected by a file's annotations.
fn annotations(file: &str, text: &str) -> Vec<Remark> {
    let mut remarks = Vec::new();
    for (index, line) in text.split('\n').enumerate() {
        for annotation in line.split("//~").skip(1) {
            let wanted = annotation.trim_start_matches('^');
            let up = annotation.len() - wanted.len();
            let (what, text) = wanted.split_once(": ").unwrap_or((wanted, ""));
            let what = match what.trim().strip_suffix("-if-case-matters") {
                Some(_) if !does_case_matter() => continue,
                Some(what) => what,
                None => what,
            };
            remarks.push(Remark {
                file: file.to_owned(),
                line: index + 1 - up,
                what: what.trim().to_owned(),
                text: text.trim().to_owned(),
            });
        }
    }
    remarks
}

/// Returns whether file names are case-sensitive here.
fn does_case_matter() -> bool {
    !crate::root().join("CARGO.TOML").exists()
}

/// The diagnostics with positions in rendered text.
fn diagnostics(stderr: &str) -> Vec<Remark> {
    let mut lines = stderr.lines().peekable();
    let mut found = Vec::new();
    while let Some(head) = lines.next() {
        // Further positions of the same diagnostic follow its text.
        if head.starts_with(' ') {
            continue;
        }
        let Some(place) = lines.peek().and_then(|line| line.trim_start().strip_prefix("┌─ ")) else {
            continue;
        };
        let (severity, text) = head.split_once(": ").unwrap_or((head, ""));
        let code = severity.split_once('[').map(|(_, code)| code.trim_end_matches(']'));
        let mut parts = place.rsplitn(3, ':');
        let line = parts.nth(1).and_then(|line| line.parse().ok()).expect("a place has a line");
        found.push(Remark {
            file: parts.next().unwrap_or_default().to_owned(),
            line,
            what: code.unwrap_or(severity).to_owned(),
            text: text.to_owned(),
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn annotations_refer_to_their_line_or_to_one_above() {
        let remarks = annotations("a.c", "x; //~ one: some text //~ two\ny;\n//~^ three\n");
        let rendered: Vec<_> = remarks.iter().map(Remark::render).collect();
        assert_eq!(rendered, ["a.c:1: one: some text\n", "a.c:1: two: \n", "a.c:2: three: \n"]);
    }

    #[test]
    fn diagnostics_are_found_by_their_place() {
        let text =
            "warning[format]: `%f` needs\n  ┌─ a.c:9:26\n  │\n9 │ x\n\nerror: bad\n   ┌─ parts/b.c:12:1\n";
        let rendered: Vec<_> = diagnostics(text).iter().map(Remark::render).collect();
        assert_eq!(rendered, ["a.c:9: format: `%f` needs\n", "parts/b.c:12: error: bad\n"]);
    }

    #[test]
    fn placeholders_become_bytes_and_directives_keep_their_lines() {
        let scratch = Scratch::new("stand-in");
        scratch.write("a.c", "//@ byte: ¶ 0d\n//@ no-final-newline\nmain¶\n");
        let test = FileTest::read(&scratch.path().join("a.c"));
        assert_eq!(test.rewritten().expect("it differs"), b"//\n//@ no-final-newline\nmain\r");
    }
}
