//! Programs of `data/firmware` print on the modelled board the same as on the released firmware.
//!
//! Each of them showed a difference found by `cc67 compare`. `NAME.console` is the output of `cc67 run --boot`, and is
//! regenerated only with it: no firmware is needed here.

use std::fs;
use std::path::{Path, PathBuf};

use compiler::{Options, image, pp};
use kmotiondef::timing::Timing;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, Event, EventKind};

/// The longest run: 10 s of board time.
const LIMIT: Ticks = Ticks::new(111_111);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/firmware")
}

/// Returns the console output of a program on the modelled board.
fn console(path: &Path) -> String {
    let text = fs::read(path).expect("a program");
    let options = Options { timing: Timing::VENDOR, ..Options::default() };
    let thread = ThreadId::new(1).expect("there is a first thread");
    let mut compilation = compiler::compile(path, text, &options, &pp::Disk);
    let linked = compilation.link(thread, &options);
    let linked = linked.unwrap_or_else(|| panic!("{} does not compile", path.display()));
    let mut board: Board = Board::new(Config { timing: options.timing, ..Config::default() });
    board.load(thread, &image::write(&linked).expect("an image")).expect("it can be loaded");
    board.start(thread).expect("it is loaded");
    let mut printed = String::new();
    let mut sink = |event: Event| {
        if let EventKind::ConsoleLine(line) = event.kind {
            printed.push_str(&String::from_utf8_lossy(&line));
            printed.push('\n');
        }
    };
    let _ = board.run(LIMIT, &mut sink);
    printed
}

#[test]
fn programs_print_what_the_released_firmware_printed() {
    let mut wrong = Vec::new();
    let mut programs: Vec<_> =
        fs::read_dir(folder()).expect("the folder").map(|entry| entry.expect("an entry").path()).collect();
    programs.retain(|path| path.extension().is_some_and(|suffix| suffix == "c"));
    programs.sort();
    assert!(programs.len() > 2, "{programs:?}");
    for path in programs {
        let expect = fs::read_to_string(path.with_extension("console")).expect("what the firmware printed");
        let found = console(&path);
        if let Some((line, (found, expect))) =
            found.lines().zip(expect.lines()).enumerate().find(|(_, (found, expect))| found != expect)
        {
            wrong.push(format!("{}:{}: {found}, not {expect}", path.display(), line + 1));
        } else if found.lines().count() != expect.lines().count() {
            wrong.push(format!("{}: {} lines", path.display(), found.lines().count()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
