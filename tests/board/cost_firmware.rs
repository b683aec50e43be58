//! The cost of calls in cycles: the model compared with the released firmware.
//!
//! `data/vectors/call-costs.jsonl` is the only table: a call, the statements before it, and the cycles that the
//! firmware took. The same image measures both boards: it reads `TIMER0` around the calls at the beginning of a
//! separate slice, and subtracts the measurement without a call. A booted firmware never waits for the bus, but the
//! model does, so a row also has the number of a call's FPGA accesses: a ninth of the calls has some, recorded in
//! `costs.jsonl` as the difference between its first two settings. The model needs no firmware; if `CC67_FIRMWARE`
//! names one, it is measured again and must agree. `CC67_WRITE_CALL_COSTS=1` writes the measured cycles.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use cc67_host::target::{BootedFirmware, Target};
use cc67_host::{Session, Setup, UserProgram};
use compiler::target::Target as CodeTarget;
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::variables::GATHER_BUFFER;
use kmotiondef::{GuestAddr, ThreadId, Ticks};
use serde_json::Value as Json;

/// The longest run: 20 s of board time.
const LONGEST: Ticks = Ticks::new(222_223);
/// The number of measurements of each call; the minimum counts.
const TIMES: usize = 3;
/// Cycles per count of `TIMER0`.
const CYCLES_PER_COUNT: f64 = 4.0;
/// The tolerances for a call, one of which must be met: relative, and in cycles.
const RELATIVE: f64 = 0.1;
const CYCLES: f64 = 12.0;
/// The number of calls, and of those that must be within the tolerances.
const CALLS: usize = 83;
const WITHIN: usize = 81;

/// The declarations before the calls. Arguments are volatile, so that no compiler evaluates a call at compile time.
const HEAD: &str = "#include \"KMotionDef.h\"
#include <stdlib.h>
#include <string.h>
double exp2(double), exp10(double), log2(double); float exp2f(float), exp10f(float), log2f(float);
float Sine3PH(float, float *);
volatile double x = 0.7, y = 3.3, big = 12345.678, d; volatile float u = 0.7f, v = 3.3f, f;
volatile int i, n = 12345, seven = 7; int mutex, *g; char text[400], other[400]; float f0; double d0; int i0;
void rest(void) { Zero(0); EnableAxisDest(0, 0); Delay_sec(0.005); }
";

fn path() -> PathBuf {
    harness::root().join("tests/data/vectors/call-costs.jsonl")
}

/// A row of the table.
struct Row {
    /// Statements before the calls.
    before: String,
    call: String,
    /// The number of copies of the call in a measurement.
    copies: usize,
    /// The number of FPGA accesses of a call.
    accesses: u32,
    /// The cycles that the firmware took, without waits for the bus.
    cycles: Option<f64>,
}

impl Row {
    fn new(line: &str) -> Self {
        let row: Json = serde_json::from_str(line).expect("JSON");
        let text = |key: &str| row[key].as_str().unwrap_or_default().to_owned();
        let copies = row["copies"].as_u64().expect("a number") as usize;
        let accesses = row["accesses"].as_u64().expect("a number") as u32;
        Self { before: text("before"), call: text("call"), copies, accesses, cycles: row["cycles"].as_f64() }
    }

    fn line(&self, cycles: f64) -> String {
        let Self { before, call, copies, accesses, .. } = self;
        let row = serde_json::json!({
            "call": call, "before": before, "copies": copies, "accesses": accesses, "cycles": cycles
        });
        row.to_string()
    }

    /// The code of the measurement with this number, which stores its counts.
    fn code(&self, number: usize) -> String {
        let calls = format!("{}; ", self.call).repeat(self.copies);
        format!(
            "void c{number}(int k)\n{{\n    int b, e;\n    {before}\n    WaitNextTimeSlice(); WaitNextTimeSlice();\n    \
             b = TIMER0; {calls}e = TIMER0;\n    g[{TIMES} * {number} + k] = e - b;\n}}\n",
            before = self.before
        )
    }

    /// The cycles of a call on the board, with the wait states of the bus as set by the firmware.
    fn on_board(&self) -> f64 {
        let cycles = self.cycles.expect("the firmware was measured");
        cycles + f64::from(self.accesses * WaitStates::REGISTERS.register)
    }

    fn is_met(&self, found: f64) -> bool {
        let recorded = self.on_board();
        (found - recorded).abs() <= (RELATIVE * recorded).max(CYCLES)
    }
}

fn rows() -> Vec<Row> {
    let text = fs::read_to_string(path()).expect("it is there");
    text.lines().map(Row::new).collect()
}

/// A program that measures all rows, after a measurement without a call.
fn program(rows: &[Row]) -> String {
    let none = Row { before: String::new(), call: String::new(), copies: 0, accesses: 0, cycles: None };
    let mut text = HEAD.to_owned();
    for (number, row) in std::iter::once(&none).chain(rows).enumerate() {
        text += &row.code(number);
    }
    text += "int main()\n{\n    int k;\n    g = (int *)gather_buffer; persist.UserData[0] = 0;\n    \
             ch0->InputMode = 0; ch0->OutputMode = 0; ch0->MaxFollowingError = 1e30; ch0->Vel = 40000; \
             ch0->Accel = 4e5; ch0->Jerk = 4e6;\n    DefineCoordSystem(0, -1, -1, -1); EnableAxisDest(0, 0); \
             strcpy(text, \"the text of a call\");\n";
    for number in 0..=rows.len() {
        writeln!(text, "    for (k = 0; k < {TIMES}; k++) c{number}(k);").expect("a string");
    }
    text + "    persist.UserData[0] = 1;\n    return 0;\n}\n"
}

/// The cycles of each row on a board.
fn measured<T: Target>(session: &mut Session<T>, rows: &[Row]) -> Vec<f64> {
    while session.user_data(0) != Some(1) && session.tick() < LONGEST {
        session.step(LONGEST, &mut |_| {});
    }
    assert_eq!(session.user_data(0), Some(1), "the program has ended");
    let begin = GuestAddr::new(session.peek_object(GATHER_BUFFER.address()));
    let counts = |number: usize| {
        let count = |time| session.peek_object::<i32>(begin.offset((4 * (TIMES * number + time)) as u32));
        (0..TIMES).map(count).min().expect("it was measured")
    };
    let cycles = |(number, row): (usize, &Row)| {
        f64::from(counts(number + 1) - counts(0)) * CYCLES_PER_COUNT / row.copies as f64
    };
    rows.iter().enumerate().map(cycles).collect()
}

fn setup(rows: &[Row], firmware: Option<&BootedFirmware>) -> Setup {
    let mut setup = Setup::default();
    setup.options.timing = Timing::VENDOR;
    setup.options.target = CodeTarget::C67x;
    if let Some(firmware) = firmware {
        setup.options = firmware.options(setup.options);
    }
    let thread = ThreadId::new(1).expect("there is a first thread");
    let program = UserProgram::compile_text("costs.c".as_ref(), program(rows).into(), thread, &setup.options);
    setup.programs.push(program.unwrap_or_else(|error| panic!("{error}")).started());
    setup
}

/// The cycles of the rows on the released firmware.
fn on_firmware(rows: &[Row]) -> Option<Vec<f64>> {
    let firmware =
        BootedFirmware::open(std::env::var_os("CC67_FIRMWARE")?.as_ref()).expect("a firmware file");
    let setup = setup(rows, Some(&firmware));
    Some(measured(&mut setup.session_on_firmware(&firmware).expect("it fits"), rows))
}

#[test]
fn a_call_takes_as_many_cycles_as_on_the_released_firmware() {
    let rows = rows();
    assert_eq!(rows.len(), CALLS);
    let found = measured(&mut setup(&rows, None).session().expect("it fits"), &rows);
    let pairs = rows.iter().zip(&found);
    let off: Vec<_> = pairs.filter(|(row, found)| !row.is_met(**found)).collect();
    let report: String = off
        .iter()
        .map(|(row, found)| format!("{}: {found}, on the board {}\n", row.call, row.on_board()))
        .collect();
    let within = rows.len() - off.len();
    println!("{within} of {} calls within the tolerances\n{report}", rows.len());
    assert!(within >= WITHIN, "{within} of {} calls within the tolerances:\n{report}", rows.len());
}

#[test]
fn the_released_firmware_takes_the_cycles_of_the_table() {
    let rows = rows();
    let Some(found) = on_firmware(&rows) else { return };
    if std::env::var_os("CC67_WRITE_CALL_COSTS").is_some() {
        let lines = rows.iter().zip(&found).map(|(row, cycles)| row.line(*cycles) + "\n");
        fs::write(path(), lines.collect::<String>()).expect("it can be written");
        return;
    }
    let differ = rows.iter().zip(&found).filter(|(row, found)| row.cycles != Some(**found));
    let report: String = differ
        .map(|(row, found)| format!("{}: {found}, in the table {:?}\n", row.call, row.cycles))
        .collect();
    assert!(report.is_empty(), "{report}");
}
