//! Files on the PC: the data on the link, as recorded from the released firmware, and the resulting files on the disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use compiler::{Options, image, pp};
use harness::{Scratch, cc67, root};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, Directory, EventKind};
use serde_json::Value as Json;

/// The maximum number of ticks for a program of a few lines.
const LIMIT: u64 = 20_000;

/// The text from uninitialised memory on the recorded board, and the one here: at the end of a file `fscanf` converts
/// the contents of its buffer, which on the board is no longer the last line.
const LEFT_OVER: (&str, &str) = ("\u{1b}2 6 0 1\r\n", "\u{1b}2 5 6 1\r\n");

/// A board with a program, recorded without a PC.
fn board(source: &str, config: Config) -> Board {
    let source = format!("#include \"KMotionDef.h\"\nchar zbuf[1000];\n{source}\n").into_bytes();
    let options = Options::default();
    let thread = ThreadId::new(1).expect("1 is a thread");
    let mut compilation = compiler::compile(Path::new("program.c"), source, &options, &pp::Disk);
    let linked = compilation.link(thread, &options).expect("the program is right");
    let mut board = Board::new(config);
    board.load(thread, &image::write(&linked).expect("it fits")).expect("it loads");
    board.start(thread).expect("it is loaded");
    board
}

/// A PC that acts like the recorded one: it answers requests for files from texts.
#[derive(Default)]
struct Pc {
    files: BTreeMap<String, String>,
    lines: Option<Vec<String>>,
}

impl Pc {
    /// The answer to a request, if it has one.
    fn answer(&mut self, line: &str) -> Option<String> {
        let text = |code: char| line.strip_prefix(code);
        if let Some(name) = text('\u{4}') {
            let lines = self.files.get(name).map(|text| text.lines().rev().map(str::to_owned).collect());
            self.lines = lines;
        } else {
            text('\u{5}')?;
        }
        Some(match self.lines.as_mut().map(Vec::pop) {
            None => "\x1b\x01ReadDiskData 2 0\r".to_owned(),
            Some(None) => "\x1b\x01ReadDiskData 3 0\r".to_owned(),
            Some(Some(line)) => {
                let bytes: Vec<String> = line.bytes().map(|byte| format!("{byte:02X}")).collect();
                let data: String =
                    bytes.chunks(80).map(|part| format!("\x1b\x01{}\r", part.join(" "))).collect();
                format!("\x1b\x01ReadDiskData 1 {}\r{data}", bytes.len())
            }
        })
    }
}

fn strings(json: &Json) -> Vec<&str> {
    json.as_array().expect("a list").iter().map(|item| item.as_str().expect("text")).collect()
}

#[test]
fn file_requests_match_the_released_firmware() {
    let text = fs::read_to_string(root().join("tests/data/vectors/files.jsonl")).expect("it is there");
    for row in text.lines() {
        let row: Json = serde_json::from_str(row).expect("each line is JSON");
        let files = row["host_files"].as_object().expect("files").iter();
        let files = files.map(|(name, text)| (name.clone(), text.as_str().expect("text").to_owned()));
        let mut pc = Pc { files: files.collect(), lines: None };
        let mut board =
            board(row["program"].as_str().expect("a program"), Config { host: false, ..Config::default() });
        let mut found = Vec::new();
        while !board.has_ended() && board.tick().get() < LIMIT {
            let mut answers = String::new();
            let limit = board.tick().next();
            board.advance(limit, &mut |event| {
                if let EventKind::ConsoleLine(line) = event.kind {
                    let line = String::from_utf8(line).expect("text");
                    answers += &pc.answer(&line).unwrap_or_default();
                    found.push(format!("\u{1b}{line}\r\n"));
                }
            });
            board.receive(answers.as_bytes());
        }
        assert!(board.has_ended(), "{}", row["program"]);
        let expect = strings(&row["stream"]).concat().replace(LEFT_OVER.0, LEFT_OVER.1);
        assert_eq!(found.concat(), expect, "{}", row["program"]);
        for (index, value) in row["UserData"].as_array().expect("a list").iter().enumerate() {
            assert_eq!(board.user_data(index).map(i64::from), value.as_i64(), "UserData[{index}]");
        }
    }
}

/// Runs a program on a board whose PC has a disk; returns the console, and the remarks.
fn run(scratch: &Scratch, source: &str) -> (Vec<String>, Vec<String>) {
    let files = Box::new(Directory::new(scratch.path().join("disk")));
    let mut board = board(source, Config { files, ..Config::default() });
    let (mut lines, mut remarks) = (Vec::new(), Vec::new());
    board.run(Ticks::new(10 * LIMIT), &mut |event| match event.kind {
        EventKind::ConsoleLine(line) => lines.push(String::from_utf8(line).expect("text")),
        EventKind::Remark(remark) => remarks.push(remark.to_string()),
        _ => {}
    });
    assert!(board.has_ended(), "{source}");
    (lines, remarks)
}

#[test]
fn lines_are_read_one_by_one_until_the_end() {
    let scratch = Scratch::new("disk-read");
    scratch.write("disk/Temp/in.txt", "one\r\n\r\nthree");
    let source = "main() { FILE *f = fopen(\"c:\\\\temp\\\\IN.TXT\", \"rt\"); int n = 0;\n\
                  while (fgets(zbuf, 100, f)) printf(\"%d <%s> %d\\n\", n++, zbuf, feof(f));\n\
                  printf(\"end %d\\n\", feof(f)); fclose(f); }";
    let (lines, remarks) = run(&scratch, source);
    assert_eq!(lines, ["0 <one> 0", "1 <> 0", "2 <three> 0", "end 1"]);
    assert!(remarks.is_empty(), "{remarks:?}");
}

#[test]
fn a_program_that_tests_feof_before_reading_sees_each_line_once() {
    let scratch = Scratch::new("disk-feof");
    scratch.write("disk/in.txt", "a\nb\n");
    let source = "main() { FILE *f = fopen(\"in.txt\", \"rt\"); while (!feof(f)) { fgets(zbuf, 100, f); if (!feof(f)) printf(\"<%s>\\n\", zbuf); } }";
    assert_eq!(run(&scratch, source).0, ["<a>", "<b>"]);
}

#[test]
fn written_lines_are_saved_on_the_disk() {
    let scratch = Scratch::new("disk-write");
    let source = "main() { FILE *f = fopen(\"c:\\\\out\\\\a.txt\", \"wt\"); int i;\n\
                  printf(\"begin\\n\"); for (i = 0; i < 400; i++) fprintf(f, \"line %d\\n\", i); fclose(f);\n\
                  f = fopen(\"c:\\\\out\\\\a.txt\", \"at\"); fprintf(f, \"last\\n\"); fclose(f); printf(\"end\\n\"); }";
    let (lines, remarks) = run(&scratch, source);
    assert_eq!((lines, remarks), (vec!["begin".to_owned(), "end".to_owned()], Vec::new()));
    let text = fs::read_to_string(scratch.path().join("disk/out/a.txt")).expect("it is there");
    let expect: String = (0..400).map(|i| format!("line {i}\n")).chain(["last\n".to_owned()]).collect();
    assert_eq!(text, expect);
}

#[test]
fn a_line_written_in_parts_has_stray_characters_as_on_the_board() {
    let scratch = Scratch::new("disk-parts");
    let source = "main() { FILE *f = fopen(\"a.txt\", \"wt\"); fprintf(f, \"%d,\", 1); fprintf(f, \"%d\\n\", 2); fclose(f); }";
    let (_, remarks) = run(&scratch, source);
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    assert!(remarks[0].contains("Write each line with one call"), "{remarks:?}");
    assert_eq!(fs::read_to_string(scratch.path().join("disk/a.txt")).expect("it is there"), "1,\u{2}2\n");
}

#[test]
fn percent_signs_are_interpreted_twice_as_on_the_board() {
    let scratch = Scratch::new("disk-percent");
    let source = "main() { FILE *f = fopen(\"a.txt\", \"wt\"); fprintf(f, \"50%%%%\\n\"); fprintf(f, \"50%%d\\n\"); fclose(f); }";
    let (_, remarks) = run(&scratch, source);
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    assert!(remarks[0].contains("Write %%%% for it"), "{remarks:?}");
    assert_eq!(fs::read_to_string(scratch.path().join("disk/a.txt")).expect("it is there"), "50%\n500\n");
}

#[test]
fn names_that_lead_outside_the_folder_are_refused_with_a_reason() {
    let scratch = Scratch::new("disk-outside");
    scratch.write("secret.txt", "secret");
    let source = "main() { FILE *f = fopen(\"..\\\\secret.txt\", \"rt\"); printf(\"%d\\n\", (int)f);\n\
                  f = fopen(\"..\\\\secret.txt\", \"wt\"); fprintf(f, \"changed\\n\"); fprintf(f, \"again\\n\"); fclose(f); }";
    let (lines, remarks) = run(&scratch, source);
    assert_eq!(lines, ["0"]);
    let expect = [
        "the PC cannot read ..\\secret.txt: the name is outside the folder of the PC's files",
        "the PC cannot write ..\\secret.txt: the name is outside the folder of the PC's files",
        "a line is written, but no file is open for writing on the PC",
    ];
    assert_eq!(remarks, expect);
    assert_eq!(fs::read_to_string(scratch.path().join("secret.txt")).expect("it is there"), "secret");
}

#[cfg(unix)]
#[test]
fn the_command_does_not_follow_links() {
    let scratch = Scratch::new("disk-links");
    scratch.write("secret.txt", "secret").write("disk/x", "");
    std::os::unix::fs::symlink("../secret.txt", scratch.path().join("disk/link.txt")).expect("a link");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { FILE *f = fopen(\"c:\\\\link.txt\", \"at\"); fprintf(f, \"changed\\n\"); fclose(f); printf(\"%d\\n\", (int)fopen(\"link.txt\", \"rt\")); }\n");
    let output = cc67(&scratch, ["run", "--files", "disk", "a.c"]);
    assert_eq!((output.stdout.as_str(), output.code), ("0\n", 0));
    assert!(output.stderr.contains("`link.txt` is a link, and links are not followed"), "{}", output.stderr);
    assert_eq!(fs::read_to_string(scratch.path().join("secret.txt")).expect("it is there"), "secret");
}

/// Each line that is read requests the next one. If the file is closed before the answer arrives, the next `fopen`
/// takes the answer for its own, as on the board.
#[test]
fn an_answer_about_the_file_before_is_remarked_when_the_next_is_opened() {
    let scratch = Scratch::new("old-file-answer");
    scratch.write("here.txt", "text\n").write(
        "a.c",
        "#include \"KMotionDef.h\"\nmain()\n{\n    char s[100];\n    FILE *f = fopen(\"here.txt\", \"rt\");\n    fgets(s, 90, f);\n    fclose(f);\n    f = fopen(\"here.txt\", \"rt\");\n    printf(\"%d\\n\", f != 0);\n}\n",
    );
    let output = cc67(&scratch, ["run", "-w", "--files", ".", "a.c"]);
    assert_eq!(output.stdout, "0\n");
    let remark = "fopen here.txt: an answer about the file before is still on its way";
    assert!(output.stderr.contains(remark), "{}", output.stderr);
}
