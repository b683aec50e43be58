//! The chapter on mistakes is generated from the tests of mistakes: each program with its messages.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::book::check_list;

/// The text before the first mistake.
const HEAD: &str = "# Mistakes

These programs compile, but do not do what was meant. Each is shown with the messages of `cc67`, and each is a test.
No program in `c-programs/` gets any of these messages, and neither do correct programs like them, which are tests as well.
";

/// Mistakes that are detected in the servo interrupt or on the PC, where no line is known, or in another program.
const WITHOUT_LINE: &[&str] = &[
    "address_of_a_text_in_a_request",
    "analog_input_of_a_machine_in_volts",
    "analog_input_of_a_stimulus_in_volts",
    "analog_output_of_an_axis_written",
    "call_back_of_another_thread_replaced",
    "contact_closed_that_is_closed_already",
    "file_never_closed",
    "file_written_without_being_open",
    "float_expected_as_an_integer",
    "gantry_moved_on_one_side",
    "input_that_is_0_at_rest",
    "jog_that_nobody_stops",
    "limit_of_a_position_without_an_input",
    "limit_of_an_axis_that_is_not_used",
    "lines_of_two_threads_mixed",
    "moments_counted_from_the_statement_above",
    "path_smoothed_with_no_time_constant",
    "path_with_a_disabled_axis",
    "pulse_shorter_than_a_tick",
    "request_of_another_thread_overwritten",
    "running_program_replaced",
    "switch_beyond_the_end_of_the_travel",
    "text_forbidden_in_other_letters",
    "text_of_a_request_at_an_offset_in_bytes",
    "two_files_open_for_writing",
    "two_threads_move_one_axis",
    "user_data_beyond_its_end_in_a_loop",
    "yes_no_box_of_a_function_compared_with_1",
];

/// A mistake, as described in its file.
struct Mistake {
    name: String,
    /// The arguments before the name of the file.
    command: String,
    program: String,
    says: Vec<String>,
}

impl Mistake {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("programs are UTF-8");
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let (directives, lines): (Vec<_>, Vec<_>) = text.lines().partition(|line| line.starts_with("//@ "));
        let head = text.lines().take_while(|line| line.starts_with("//@ ")).count();
        assert_eq!(head, directives.len(), "{name}: directives are at its beginning");
        let all = |what: &str| {
            let values = directives.iter().filter_map(|line| line.strip_prefix("//@ ")?.strip_prefix(what));
            values.map(str::to_owned).collect::<Vec<_>>()
        };
        let arguments = all("args: ").pop().unwrap_or_default();
        let is_run = !arguments.starts_with("check");
        let words = ["cc67", if is_run { "run" } else { "" }, &arguments, &format!("{name}.c")];
        let command = words.iter().filter(|word| !word.is_empty()).copied().collect::<Vec<_>>().join(" ");
        let says = all("says: ").into_iter().map(|line| without_directives(&line, &name, head)).collect();
        let program = lines.join("\n").trim().to_owned();
        Self { name, command, program, says }
    }

    /// The mistake as a section of the chapter.
    fn section(&self) -> String {
        let words = self.name.replace('_', " ");
        let title: String =
            words.chars().take(1).flat_map(char::to_uppercase).chain(words.chars().skip(1)).collect();
        format!(
            "\n## {title}\n\n```c mistake\n{}\n```\n\n`{}`:\n\n```text\n{}\n```\n",
            self.program,
            self.command,
            self.says.join("\n")
        )
    }
}

/// The messages, with the line numbers of the program without its directives.
fn without_directives(said: &str, name: &str, directives: usize) -> String {
    let file = format!("{name}.c:");
    let mut parts = said.split(file.as_str());
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let line: usize = part[..digits].parse().expect("a line");
        let _ = write!(out, "{file}{}{}", line - directives, &part[digits..]);
    }
    out
}

#[test]
fn the_chapter_of_mistakes_lists_every_mistake() {
    let folder = harness::root().join("tests/filetests/mistakes");
    let files =
        fs::read_dir(&folder).expect("the folder is there").map(|entry| entry.expect("a file").path());
    let mut files: Vec<_> = files.filter(|path| path.extension().is_some_and(|kind| kind == "c")).collect();
    files.sort();
    let mistakes: Vec<_> = files.iter().map(|path| Mistake::read(path)).collect();
    assert!(mistakes.len() >= 120, "there are {}", mistakes.len());
    for mistake in &mistakes {
        let file = format!("{}.c:", mistake.name);
        let has_line = mistake.says.iter().any(|line| line.contains(&file));
        assert!(has_line != WITHOUT_LINE.contains(&mistake.name.as_str()), "{}: which line?", mistake.name);
    }
    let text: String = mistakes.iter().map(Mistake::section).collect();
    check_list("mistakes.md", &(HEAD.to_owned() + &text));
}
