//! Charges for typical firmware calls, compared with their times on the board: `data/vectors/costs.jsonl`.
//!
//! The comparison uses the second setting, with the wait states of the bus as set by the firmware, for which the
//! functions are charged. The cost of a call is the amount that the profiling engine assigns to it, without waiting
//! time. Of a function's recorded calls, those closest to its typical time are compared.

use std::collections::BTreeMap;
use std::fs;

use cc67_host::{Session, Setup, UserProgram};
use compiler::passes::Level;
use harness::Scratch;
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_at};
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::{ThreadId, Ticks};
use runtime::Board;
use serde_json::Value as Json;
use vm::profile::ProfilingEngine;

/// The relative tolerance for a typical call.
const LIMIT: f64 = 0.1;

/// Functions that are not called here, each with the reason.
const NOT_CALLED: &[(&str, &str)] = &[
    ("AddKonnect", WORDS),
    ("AddKonnect_Aux0", WORDS),
    ("CheckDoneGather", WORDS),
    ("DefineCoordSystem8", WORDS),
    ("Delay_sec", WAITS),
    ("DisableAxis", WORDS),
    ("EnableAxis", WORDS),
    ("Jog", WORDS),
    ("MoveExp", WORDS),
    ("MoveXYZABC", WAITS),
    ("PauseThread", WORDS),
    ("PrintInt", WORDS),
    ("ProgramFlash", WAITS),
    ("ProgramFlashNoMessages", WAITS),
    ("RS232_PutChar", WORDS),
    ("ResumeThread", WORDS),
    ("SetupForMotionEnd", WORDS),
    ("SetupForMotionPause", WORDS),
    ("SetupForMove", WORDS),
    ("StartMove", WORDS),
    ("StartThread", WORDS),
    ("StopCoordinatedMotion", WAITS),
    ("StopMotion", WORDS),
    ("TestAndSet", WORDS),
    ("WaitNextTimeSlice", WAITS),
    ("WaitUntil", WAITS),
    ("Zero", WORDS),
    ("acos", PRICE),
    ("asin", PRICE),
    ("atexit", "not modelled"),
    ("ecvt", "not modelled"),
    ("fclose", FILES),
    ("fcvt", "not modelled"),
    ("feof", FILES),
    ("fgets", FILES),
    ("fopen", FILES),
    ("fprintf", FILES),
    ("fractionf", "its prototype in the header is not that of the firmware"),
    ("free", WORDS),
    ("fscanf", FILES),
    ("memccpy", WORDS),
    ("powf", PRICE),
    ("realloc", WORDS),
    ("vsnprintf", WORDS),
];

const WORDS: &str = "its calls are recorded in words";
const PRICE: &str =
    "it has one cost, that of the arguments that programs use; what is nearest to its mean are special ones";
const WAITS: &str = "it waits";
const FILES: &str = "it needs a file of the PC";

fn rows(kind: &str) -> Vec<Json> {
    let text =
        fs::read_to_string(harness::root().join("tests/data/vectors/costs.jsonl")).expect("it is there");
    let lines = text.lines().map(|line| serde_json::from_str::<Json>(line).expect("JSON"));
    lines.filter(|line| line["kind"] == kind).collect()
}

/// A recorded call: its description in the vectors, the call, and the cycles.
struct Case {
    words: String,
    call: String,
    recorded: f64,
}

/// The calls of a function that are closest to its typical time.
fn cases(row: &Json) -> Vec<Case> {
    let name = row["name"].as_str().expect("a name");
    let typical = row["io44"]["typical"].as_f64();
    let mut cases = Vec::new();
    for case in row["cases"].as_array().into_iter().flatten() {
        let cycles = case.get("work").unwrap_or(&case["cycles"]);
        let recorded = cycles[1].as_f64().expect("cycles");
        for words in case["args"].as_str().expect("arguments").split(" | ") {
            let Some(call) = call(name, words) else { continue };
            cases.push(Case { words: words.to_owned(), call, recorded });
        }
    }
    let distance = |case: &Case| typical.map_or(0.0, |typical| (case.recorded - typical).abs());
    let nearest = cases.iter().map(distance).fold(f64::INFINITY, f64::min);
    cases.retain(|case| distance(case) <= nearest);
    cases
}

/// The call of a case; `None` if its description contains more than arguments.
fn call(name: &str, words: &str) -> Option<String> {
    let escaped = |text: &str| text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
    let bytes = || words.split_once(" bytes, ");
    Some(match name {
        "printf" if words.contains("(ends") || words == "no newline" => return None,
        "printf" | "sprintf" => {
            let (format, values) = words.split_once('|').unwrap_or((words, ""));
            let to = if name == "sprintf" { "buf, " } else { "" };
            let comma = if values.is_empty() { "" } else { ", " };
            format!("{name}({to}\"{}\"{comma}{values})", escaped(format))
        }
        "sscanf" => {
            let (text, format) = words.split_once('|')?;
            let places = scanned(format);
            format!("sscanf(\"{}\", \"{}\"{places})", escaped(text), escaped(format))
        }
        "strlen" => format!("strlen(\"{}\")", "a".repeat(words.strip_suffix(" chars")?.parse().ok()?)),
        "memcpy" => {
            let (count, how) = bytes()?;
            let (to, from) = match how {
                "aligned" => (0, 0),
                "source + 1" => (0, 1),
                _ => (1, 1),
            };
            format!("memcpy(big + {to}, other + {from}, {count})")
        }
        "memset" => {
            let (count, how) = bytes()?;
            format!("memset(big + {}, 5, {count})", i32::from(how == "+ 1"))
        }
        "modf" => format!("modf({words}, &d0)"),
        "modff" => format!("modff({words}, &f0)"),
        "frexp" | "frexpf" => format!("{name}({words}, &i0)"),
        "ecvt" | "fcvt" => format!("{name}({words}, &i0, &i1)"),
        "strtod" | "strtold" => format!("{name}({words}, 0)"),
        "strtol" | "strtoul" if words.contains("\",") => {
            format!("{name}({}, 0,{}", words.split_once(',')?.0, words.split_once(',')?.1) + ")"
        }
        "strtol" | "strtoul" => format!("{name}({words}, 0, 10)"),
        "ltoa" => format!("ltoa({words}, buf)"),
        "Sine3PH" => format!("Sine3PH({words}, &f0)"),
        "atexit" => "atexit(nothing)".to_owned(),
        "MutexLock" | "MutexUnlock" if matches!(words, "" | "free") => format!("{name}(&i0)"),
        "AtomicSet" | "AtomicClear" => format!("{name}(&i1, 4)"),
        "TestAndSet" => format!("TestAndSet(&i{})", u8::from(words == "taken")),
        "SetFRO" => format!("SetFRO({})", words.trim_end_matches(" at once")),
        _ => {
            let is_moved = [
                "Move",
                "MoveAtVel",
                "MoveRel",
                "MoveRelAtVel",
                "Jog",
                "MoveExp",
                "Zero",
                "StartThread",
                "ResumeThread",
                "PauseThread",
                "CheckDone",
                "DisableAxis",
                "StopMotion",
                "EnableAxis",
            ];
            if is_moved.contains(&name) && !words.ends_with(" at rest") {
                return None;
            }
            let state = [" at rest", " first", " again", " disabled"];
            let plain = state.iter().fold(words, |words, state| words.strip_suffix(state).unwrap_or(words));
            let plain = if plain == "idle" { "" } else { plain };
            if plain.contains(' ') && !plain.starts_with('"') || plain.contains("..") {
                return None;
            }
            let known = ["ch0", "SNAP0", "SNAP1+3"];
            let is_plain = |word: &str| {
                word.is_empty()
                    || known.contains(&word)
                    || word.starts_with(|c: char| c.is_ascii_digit() || "-'\"".contains(c))
            };
            if !plain.starts_with('"') && !plain.split(',').all(is_plain) {
                return None;
            }
            format!("{name}({plain})")
        }
    })
}

/// Pointers for the conversions of a format.
fn scanned(format: &str) -> String {
    let mut places = String::new();
    for part in format.split('%').skip(1) {
        places += match part.as_bytes().first() {
            Some(b'd' | b'x') => ", &i0",
            Some(b'f') => ", &f0",
            Some(b'l') => ", &d0",
            _ => ", buf",
        };
    }
    places
}

/// The text before the calls.
const HEAD: &str = "#include \"KMotionDef.h\"
#include <stdlib.h>
#include <string.h>
char buf[4000], big[4000], other[4000];
int i0, i1; float f0; double d0, T;
char *ecvt(double, int, int *, int *); char *fcvt(double, int, int *, int *);
char *ltoa(long, char *); long double strtold(const char *, char **); void *memalign(unsigned, unsigned);
double exp2(double), exp10(double), log2(double), frexp(double, int *), ldexp(double, int), modf(double, double *);
float exp2f(float), exp10f(float), log2f(float), frexpf(float, int *), ldexpf(float, int), modff(float, float *);
double fractionf(double); float Sine3PH(float, float *); int isspace(int);
void nothing(void) { }
main()
{
";

fn run(scratch: &Scratch, body: &str) -> Result<Session<Board<ProfilingEngine>>, String> {
    scratch.write("work.c", format!("{HEAD}{body}}}\n"));
    let mut setup = Setup::default();
    setup.options.timing = Timing::Vendor(WaitStates::REGISTERS);
    setup.options.level = Level::None;
    let thread = ThreadId::new(1).expect("a thread");
    let program = UserProgram::compile(&scratch.path().join("work.c"), thread, &setup.options);
    setup.programs.push(program.map_err(|error| error.to_string())?.started());
    let mut session = setup.session_on(ProfilingEngine::default()).expect("it fits");
    let _ = session.run(Ticks::new(50_000), &mut |_| ());
    if session.has_ended() { Ok(session) } else { Err("it does not end".to_owned()) }
}

/// The cycles of the calls of a function in `main`, in order.
fn calls_of(session: &Session<Board<ProfilingEngine>>, name: &str) -> Vec<f64> {
    let mut calls = BTreeMap::new();
    for (site, spent) in session.target().machine().engine().profile().sites() {
        let function = site.firmware.and_then(function_at).map(|index| FIRMWARE_FUNCTIONS[index].name);
        if function == Some(name) {
            calls.insert(site.calls.clone(), spent.computing.get() as f64);
        }
    }
    calls.into_values().collect()
}

/// Returns the code that a case needs before it. With these limits, a move of 20,000 reaches its full speed and one of
/// 1000 does not, as in the recording. The functions of the coordinate system were recorded with five axes.
fn before(case: &Case) -> &'static str {
    let of_axes = ["CheckDone", "GetNominal", "SetFRO", "SetRapidFRO"];
    if of_axes.iter().any(|name| case.call.starts_with(name)) {
        return "DefineCoordSystem6(0, 1, 2, 3, 4, -1); for (i1 = 0; i1 < 5; i1++) chan[i1].Enable = 1;\n";
    }
    match case.words.ends_with("at rest") {
        true => "ch0->Vel = 40000; ch0->Accel = 4e5; ch0->Jerk = 4e6; EnableAxisDest(0, 0);\n",
        false => "",
    }
}

#[test]
fn a_typical_call_is_charged_what_it_takes_on_the_board() {
    let scratch = Scratch::new("cost-calls");
    let (mut report, mut worst, mut count) = (String::new(), Vec::new(), 0);
    for row in rows("function") {
        let name = row["name"].as_str().expect("a name");
        let cases = cases(&row);
        let is_left_out = NOT_CALLED.iter().any(|(known, _)| *known == name);
        if is_left_out || row.get("skipped").is_some() {
            continue;
        }
        if cases.is_empty() {
            report += &format!("{name}: nothing is called\n");
            continue;
        }
        let body: String = cases.iter().map(|case| format!("{}{};\n", before(case), case.call)).collect();
        let found = match run(&scratch, &body) {
            Ok(session) => calls_of(&session, name),
            Err(error) => {
                report += &format!("{name}: {error}\n");
                continue;
            }
        };
        if found.len() != cases.len() {
            report += &format!("{name}: {} calls found of {}\n{body}", found.len(), cases.len());
            continue;
        }
        for (case, found) in cases.iter().zip(found) {
            count += 1;
            let error = (found - case.recorded) / case.recorded;
            worst.push((
                error.abs(),
                format!("{}: {found}, recorded {} ({:+.1} %)", case.call, case.recorded, 100.0 * error),
            ));
        }
    }
    worst.sort_by(|a, b| b.0.total_cmp(&a.0));
    let off: Vec<_> = worst.iter().filter(|(error, _)| *error > LIMIT).collect();
    eprintln!("{count} calls, {} further off than 10 %", off.len());
    for (_, text) in &off {
        report += &format!("{text}\n");
    }
    assert!(report.is_empty(), "{report}");
}
