//! Randomly generated and reduced scenarios, compared with the recorded behaviour of the released firmware:
//! `data/vectors/fidelity-2.jsonl` and `fidelity-3.jsonl`.
//!
//! The rows are compared with the model in every run, and with the firmware itself if `CC67_FIRMWARE` names its file.
//! There are four kinds of rows:
//!
//! | row | holds |
//! |---|---|
//! | `session` | lines from the PC, each with the bytes that come back; `(run S)`: S seconds pass |
//! | `printf` | the arguments of a call, and the text it makes |
//! | `console` | a program, and all that it prints |
//! | `rows`, `at_end`, `gather_words_hex` | a program that stores what it sees in the gather buffer; the [`record`] says where |
//!
//! The model reproduces all of them. A row that the firmware itself does not reproduce here is in [`DIFFERENT`].

mod record;

use std::fs;

use cc67_host::target::{BootedFirmware, Target};
use cc67_host::{Session, Setup, UserProgram};
use compiler::Division;
use harness::Scratch;
use kmotiondef::timing::Timing;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Event, EventKind};
use serde_json::Value as Json;

use record::Record;

/// The files, and the number of rows in each. Those of the second are random scenarios in which the model once
/// differed, reduced by `cc67 compare`.
const FILES: [(&str, usize); 2] = [("fidelity-2.jsonl", 112), ("fidelity-3.jsonl", FOUND)];
const FOUND: usize = 62;
/// The maximum number of ticks for the longest program; a program that has stopped the board never ends.
const LONGEST: u64 = 12_000;
/// The number of ticks in which printed texts reach the PC.
const TO_THE_END: u64 = 300;

/// Rows that a board does not reproduce, with the reason.
struct Exception {
    reason: &'static str,
    rows: &'static [usize],
}

const fn rows_of(reason: &'static str, rows: &'static [usize]) -> Exception {
    Exception { reason, rows }
}

/// Rows that the firmware itself does not reproduce here.
const DIFFERENT: &[Exception] = &[
    rows_of(
        "cc67's code between the printed numbers is faster than the vendor's: the last one is a slice earlier",
        &[29],
    ),
    rows_of("the memory after the axes is overwritten", &[34, 36]),
    rows_of("the firmware reads outside the memory for the axis of an unused letter", &[54, 100, 101]),
];

/// A board on which rows are replayed.
#[derive(Clone, Copy)]
enum Subject<'f> {
    Model,
    Firmware(&'f BootedFirmware),
}

impl Subject<'_> {
    /// Returns the differences of a row on this board.
    fn differences(self, index: usize, row: &Json) -> Vec<String> {
        let scratch = Scratch::new(&format!("measured-{index}"));
        let mut setup = Setup::default();
        setup.options.timing = Timing::VENDOR;
        // Like the vendor's code, which was recorded; no PC requested the status meanwhile.
        setup.options.division = Division::Firmware;
        setup.config.machine_file.cpu.board_faults = true;
        setup.config.host = false;
        if let Self::Firmware(firmware) = self {
            setup.options = firmware.options(setup.options);
        }
        if let Some(source) = source(row) {
            scratch.write("program.c", format!("#include \"KMotionDef.h\"\n{source}"));
            let thread = ThreadId::new(1).expect("there is a first thread");
            let program = UserProgram::compile(&scratch.path().join("program.c"), thread, &setup.options);
            setup.programs.push(program.unwrap_or_else(|error| panic!("row {index}: {error}")).started());
        }
        match self {
            Self::Model => differences(&mut setup.session().expect("it fits"), row),
            Self::Firmware(firmware) => {
                differences(&mut setup.session_on_firmware(firmware).expect("it fits"), row)
            }
        }
    }

    /// Replays all rows; fails if the set of differing rows is not the known one.
    fn try_all(self, known: &[Exception]) {
        let rows = rows();
        let mut report = String::new();
        let mut held = 0;
        for (index, row) in rows.iter().enumerate() {
            let found = self.differences(index, row);
            held += usize::from(found.is_empty());
            let exception = known.iter().find(|exception| exception.rows.contains(&index));
            let reason = exception.map(|exception| exception.reason);
            let shown: Vec<_> = found.iter().take(4).map(|text| format!("    {text}\n")).collect();
            let text =
                format!("{index} {}: {} differences, {reason:?}\n{}", name(row), found.len(), shown.concat());
            if found.is_empty() == reason.is_some() {
                report += &text;
            } else if reason.is_some() {
                println!("{text}");
            }
        }
        println!("{held} of {} rows hold", rows.len());
        assert!(report.is_empty(), "{held} of {} rows hold:\n{report}", rows.len());
    }
}

fn rows() -> Vec<Json> {
    let mut all = Vec::new();
    for (file, count) in FILES {
        let path = harness::root().join("tests/data/vectors").join(file);
        let lines = fs::read_to_string(path).expect("the measurements are there");
        let rows = lines.lines().map(|line| serde_json::from_str(line).expect("each line is JSON"));
        let before = all.len();
        all.extend(rows);
        assert_eq!(all.len() - before, count, "{file}");
    }
    all
}

fn name(row: &Json) -> &str {
    ["name", "session", "printf"].iter().find_map(|key| row[*key].as_str()).expect("it has a name")
}

/// The program of a row that has one.
fn source(row: &Json) -> Option<String> {
    let of_call = || row["printf"].as_str().map(|call| format!("main() {{ printf({call}); }}"));
    row["program"].as_str().map(str::to_owned).or_else(of_call)
}

fn differences<T: Target>(session: &mut Session<T>, row: &Json) -> Vec<String> {
    if let Some(exchange) = row["exchange"].as_array() {
        return exchange.iter().filter_map(|exchange| unlike(session, exchange)).collect();
    }
    let console = run(session);
    let mut found = Vec::new();
    for expect in [&row["console"], &row["out"]].into_iter().filter_map(Json::as_str) {
        if console != expect {
            found.push(format!("console {console:?}, recorded {expect:?}"));
        }
    }
    Record::new(session).compare(row, &mut found);
    found
}

/// Sends a line, or lets time pass; returns the reply if it differs from the recorded one.
fn unlike<T: Target>(session: &mut Session<T>, exchange: &Json) -> Option<String> {
    let [line, expect] = [0, 1].map(|part| exchange[part].as_str().expect("text"));
    session.tap_wire();
    session.take_wire();
    if let Some(seconds) = line.strip_prefix("(run ").and_then(|rest| rest.strip_suffix(')')) {
        let limit = session.tick_after(seconds.parse().expect("seconds"));
        session.advance(limit, &mut |_| {});
    } else {
        session.exchange(line.as_bytes(), &mut |_| {});
    }
    let found = String::from_utf8_lossy(&session.take_wire()).into_owned();
    (found != expect).then(|| format!("{line}: {found:?}, recorded {expect:?}"))
}

/// Runs a program to its end; returns its console.
fn run<T: Target>(session: &mut Session<T>) -> String {
    let mut console = String::new();
    let mut hear = |event: Event| {
        if let EventKind::ConsoleLine(line) = event.kind {
            console.push_str(&String::from_utf8_lossy(&line));
            console.push('\n');
        }
    };
    let _ = session.run(Ticks::new(LONGEST), &mut hear);
    session.advance(Ticks::new(session.tick().get() + TO_THE_END), &mut hear);
    console
}

#[test]
fn the_model_does_what_was_measured() {
    Subject::Model.try_all(&[]);
}

#[test]
fn the_firmware_does_what_was_measured() {
    let Some(path) = std::env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return;
    };
    let firmware = BootedFirmware::open(path.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    Subject::Firmware(&firmware).try_all(DIFFERENT);
}
