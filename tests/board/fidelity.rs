//! Complete programs, compared with the recorded behaviour of the released firmware: `data/vectors/fidelity.jsonl`.
//!
//! A recorded row contains the state of memory at the end of the servo interrupt of its tick, where a trace of the
//! board also samples. Tick 0 is the tick in whose slice the program stored 1 in `persist.UserData[0]`. Rows are
//! compared in every column. The last line is not a program: it describes the contents of the gather buffer at
//! power-up, 72,668 bytes of the vendor's data for the FPGA, which cc67 does not have; here the buffer contains zeros.

use std::collections::BTreeMap;
use std::fs;

use cc67_host::{Session, Setup, UserProgram};
use harness::Scratch;
use kmotiondef::timing::Timing;
use kmotiondef::{Cycles, ThreadId, Ticks};
use runtime::trace::{Record, TraceRequest};
use runtime::{Event, EventKind};
use serde_json::Value as Json;

/// The length in ticks of a run without rows.
const SHORT_RUN: u64 = 1500;

/// The number of ticks after the last row in which programs print their results.
const TO_THE_END: u64 = 3000;

/// The number of ticks in which a program must begin.
const MOST_BEFORE: u64 = 2000;

/// The tolerance of a position, relative to its size but at least absolute.
const PRECISION: f64 = 1e-8;

/// Prefixes of the names of recordings that cc67 does not reproduce, each with the reason.
const DIFFERENT: &[(&str, &str)] = &[
    ("address of a parameter: store through &first", VENDOR),
    ("address of a parameter: read through &first", VENDOR),
    ("address of a parameter: double", VENDOR),
    ("address of a parameter: store into a local of the caller", VENDOR),
    ("address of a parameter: a frame destroyed", VENDOR),
    (
        "commands: DisableAxis0 and EnableAxisDest0 before ExecBuf",
        "commands of one line take no time between them",
    ),
    (
        "soft limit: axis at 6, limit 5, Jog(0, -1000)",
        "how long the run continued after its rows is not recorded",
    ),
];

/// An error of the vendor's compiler; cc67 compiles standard C.
const VENDOR: &str = "the vendor's compiler takes a wrong address";

/// Returns a column as an expression of a program; `None` for values that are not visible to programs.
fn expression(column: &str, name: &str, checks: &mut usize) -> Option<String> {
    Some(match column {
        "CS0_t" => "CS0_t".to_owned(),
        "TimeExecuted" => "CS0_TimeExecuted".to_owned(),
        "CoordSystem0 set" => "CoordSystem0 != 0".to_owned(),
        "LastCoordSystem0 set" => "LastCoordSystem0 != 0".to_owned(),
        "StoppingState" => "CS0_StoppingState".to_owned(),
        // The address of the servo's message is private to the board.
        "message pending" | "its axis" => return None,
        "mark set by the program" => "persist.UserData[2]".to_owned(),
        _ if column.starts_with("CheckDone") => {
            *checks += 1;
            format!("persist.UserData[{checks}]")
        }
        _ => {
            let at = column.find(|c: char| c.is_ascii_digit()).unwrap_or_else(|| panic!("{name}: {column}"));
            let (field, axis) = (&column[..at], &column[at..=at]);
            if field == "pcoeff" {
                format!("chan[{axis}].pcoeff != 0")
            } else {
                format!("chan[{axis}].{field}")
            }
        }
    })
}

/// The programs of a line by their threads.
fn programs(line: &Json) -> BTreeMap<i32, String> {
    match &line["program"] {
        Json::String(text) => BTreeMap::from([(1, text.clone())]),
        Json::Object(map) => map
            .iter()
            .map(|(number, text)| {
                (number.parse().expect("a number"), text.as_str().expect("text").to_owned())
            })
            .collect(),
        other => panic!("not a program: {other}"),
    }
}

/// The observations of a run.
#[derive(Default)]
struct Shown {
    console: String,
    /// The values of each tick in which any of them changed.
    samples: BTreeMap<u64, Vec<f64>>,
}

impl Shown {
    fn hear(&mut self, event: Event) {
        match event.kind {
            EventKind::ConsoleLine(text) => {
                self.console.push_str(&String::from_utf8_lossy(&text));
                self.console.push('\n');
            }
            EventKind::Trace(Record::Sample { values, .. }) => {
                let tick = event.at.get() / Cycles::PER_TICK.get();
                self.samples.insert(tick.unsigned_abs(), values);
            }
            EventKind::Trap(trap) => panic!("{trap}"),
            _ => {}
        }
    }

    /// The values at a tick.
    fn at(&self, tick: u64) -> &[f64] {
        self.samples.range(..=tick).next_back().map(|(_, values)| values.as_slice()).unwrap_or_default()
    }
}

/// Creates the board of a line with its programs running, after the initial commands.
fn begin(line: &Json, scratch: &Scratch, shown: &mut Shown) -> Session {
    let mut setup = Setup::default();
    setup.options.timing = Timing::VENDOR;
    for (number, text) in programs(line) {
        let file = format!("{number}.c");
        scratch.write(&file, format!("#include \"KMotionDef.h\"\n{text}"));
        let thread = ThreadId::new(number).expect("a thread");
        let program = UserProgram::compile(&scratch.path().join(file), thread, &setup.options);
        setup.programs.push(program.unwrap_or_else(|error| panic!("{error}")));
    }
    let threads: Vec<_> = setup.programs.iter().map(|program| program.thread).collect();
    let mut session = setup.session().expect("it fits");
    for command in line["before"].as_array().into_iter().flatten() {
        session.exchange(command.as_str().expect("text").as_bytes(), &mut |event| shown.hear(event));
    }
    for thread in threads {
        session.start(thread).expect("loaded");
    }
    session
}

fn rows(line: &Json) -> impl Iterator<Item = &Vec<Json>> {
    line["rows"].as_array().into_iter().flatten().map(|row| row.as_array().expect("a row"))
}

fn is_near(found: f64, recorded: &Json) -> bool {
    let Some(recorded) = recorded.as_f64() else { return found.is_nan() };
    (found - recorded).abs() <= PRECISION * recorded.abs().max(1.0)
}

/// A line that was run up to its last row.
struct Run<'l> {
    line: &'l Json,
    /// The columns after the tick, each with its expression in the program.
    columns: Vec<(&'l str, Option<String>)>,
    session: Session,
    /// The folder of the sources, with which expressions are compiled.
    _scratch: Scratch,
    shown: Shown,
    /// The tick in whose slice the program began.
    zero: u64,
}

impl<'l> Run<'l> {
    fn new(line: &'l Json, index: usize) -> Self {
        let name = line["name"].as_str().expect("a name");
        let scratch = Scratch::new(&format!("fidelity-{index}"));
        let mut shown = Shown::default();
        let mut session = begin(line, &scratch, &mut shown);
        let mut checks = 0;
        let named = line["columns"].as_array().into_iter().flatten().skip(1);
        let columns: Vec<_> = named
            .map(|column| column.as_str().expect("text"))
            .map(|column| (column, expression(column, name, &mut checks)))
            .collect();
        let list: Vec<_> = columns.iter().filter_map(|(_, expression)| expression.clone()).collect();
        if !list.is_empty() {
            let quantities = session.quantities(&list.join(", "));
            let quantities = quantities.unwrap_or_else(|error| panic!("{name}: {error}"));
            session.record(TraceRequest { quantities, every: 1, changes: false, packets: None });
        }
        let start = session.tick().get();
        while session.user_data(0) != Some(1) {
            assert!(session.tick().get() < start + MOST_BEFORE, "{name}: it does not begin");
            session.step_tick(&mut |event| shown.hear(event));
        }
        let zero = session.tick().get();
        let mut run = Self { line, columns, session, _scratch: scratch, shown, zero };
        run.play();
        run
    }

    fn advance(&mut self, tick: u64) {
        let Self { session, shown, .. } = self;
        session.advance(Ticks::new(self.zero + tick), &mut |event| shown.hear(event));
    }

    /// Sends the commands at their ticks, and runs to the last row.
    fn play(&mut self) {
        for input in self.line["inputs"].as_array().into_iter().flatten() {
            self.advance(input[0].as_u64().expect("a tick"));
            let command = input[1].as_str().and_then(|text| text.strip_prefix("cmd ")).expect("a command");
            self.session.command(command.as_bytes());
        }
        let last = rows(self.line).filter_map(|row| row[0].as_u64()).max();
        self.advance(last.unwrap_or(SHORT_RUN));
    }

    fn value(&self, expression: &str) -> f64 {
        self.session.read(expression).unwrap_or_else(|error| panic!("{}: {error}", self.line["name"]))
    }

    /// Adds the differences of the rows.
    fn check_rows(&self, found: &mut Vec<String>) {
        for row in rows(self.line) {
            let tick = row[0].as_u64().expect("a tick");
            let mut values = self.shown.at(self.zero + tick).iter();
            for ((column, expression), recorded) in self.columns.iter().zip(&row[1..]) {
                if expression.is_some() {
                    let value = *values.next().expect("it was sampled");
                    if !is_near(value, recorded) {
                        found.push(format!("tick {tick} {column}: {value}, recorded {recorded}"));
                    }
                }
            }
        }
    }

    /// Adds the differences at the end of the run.
    fn check_end(&self, found: &mut Vec<String>) {
        for (what, recorded) in self.line["at_end"].as_object().into_iter().flatten() {
            let value = self.value(&match what.as_str() {
                "StoppingState" => "CS0_StoppingState".to_owned(),
                "CoordSystem0" => "CoordSystem0 != 0".to_owned(),
                "TauKLP" => what.clone(),
                "LastMotionType" | "LastMotionDest" => format!("chan[0].{what}"),
                _ => expression(what, what, &mut 0).expect("a place"),
            });
            if !is_near(value, recorded) {
                found.push(format!("at the end {what}: {value}, recorded {recorded}"));
            }
        }
        for (index, state) in self.line["state_list"].as_array().into_iter().flatten().enumerate() {
            let fields = ["trajectory_mode", "t", "a", "b", "c", "d"];
            for (field, recorded) in fields.iter().zip(state.as_array().expect("a state")) {
                let value = self.value(&format!("chan[2].c[{index}].{field}"));
                if !is_near(value, recorded) {
                    found.push(format!("state {index} {field}: {value}, recorded {recorded}"));
                }
            }
        }
    }
}

/// Runs a line; returns the differences.
fn differences(line: &Json, index: usize) -> Vec<String> {
    let mut run = Run::new(line, index);
    let mut found = Vec::new();
    run.check_rows(&mut found);
    run.check_end(&mut found);
    let end = run.session.tick().get() - run.zero;
    run.advance(end + TO_THE_END);
    let Run { session, shown, .. } = &mut run;
    session.finish(&mut |event| shown.hear(event));
    let console = line["console"].as_str().expect("text");
    if shown.console != console {
        found.push(format!("console {:?}, recorded {console:?}", shown.console));
    }
    found
}

#[test]
fn whole_programs_do_what_was_recorded() {
    let path = harness::root().join("tests/data/vectors/fidelity.jsonl");
    let text = fs::read_to_string(path).expect("it is there");
    let lines: Vec<Json> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(lines.len(), 147);
    let mut report = String::new();
    for (index, line) in lines.iter().enumerate().filter(|(_, line)| !line["program"].is_null()) {
        let name = line["name"].as_str().expect("a name");
        let found = differences(line, index);
        let reason = DIFFERENT.iter().find(|(known, _)| name.starts_with(known));
        if found.is_empty() == reason.is_some() {
            let shown: Vec<_> = found.iter().take(4).map(|text| format!("    {text}\n")).collect();
            report += &format!("{index} {name}: {} differences, {reason:?}\n{}", found.len(), shown.concat());
        }
    }
    assert!(report.is_empty(), "{report}");
}
