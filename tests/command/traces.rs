//! Traces of whole runs, read by readers that are not ours.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};

use harness::{Scratch, cc67};
use serde::Deserialize;
use vcd::{Command, IdCode, ScopeItem, Value, VarType};

/// A program with two threads' worth of edges, prints and motion.
const PROGRAM: &str = "#include \"KMotionDef.h\"
main()
{
    int i;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    EnableAxisDest(0, 0.0);
    Move(0, 100.0);
    for (i = 0; i < 3; i++)
    {
        WaitNextTimeSlice();
        ClearBit(46);
        Delay_sec(5e-6);
        SetBit(46);
        printf(\"edge %d of \\\"three\\\"\\n\", i);
    }
    while (!CheckDone(0)) ;
    SetBit(1030);
    Delay_sec(0.001);
}
";

/// Runs it with options and returns the files of these names.
fn traces(options: &[&str], names: &[&str]) -> Vec<String> {
    let scratch = Scratch::new(&format!("traces-{}", names.join("-")));
    fs::write(scratch.path().join("a.c"), PROGRAM).expect("it is ours");
    let arguments = ["run"].iter().chain(options).chain(&["a.c"]);
    let output = cc67(&scratch, arguments);
    assert_eq!(output.code, 0, "{}", output.stderr);
    names.iter().map(|name| read(&scratch.path().join(name))).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn an_independent_reader_accepts_the_dump() {
    let dump = traces(&["--trace", "a.vcd", "--stim", "at 1ms bit 136 = 1"], &["a.vcd"]).remove(0);
    let mut parser = vcd::Parser::new(dump.as_bytes());
    let header = parser.parse_header().expect("the head is right");
    assert_eq!(header.timescale, Some((1, vcd::TimescaleUnit::NS)));
    let Some(ScopeItem::Scope(scope)) = header.items.first() else { panic!("no scope") };
    let mut names: BTreeMap<IdCode, (&str, VarType)> = BTreeMap::new();
    for item in &scope.items {
        let ScopeItem::Var(var) = item else { panic!("{item:?}") };
        names.insert(var.code, (&var.reference, var.var_type));
    }
    let found: Vec<_> = names.values().map(|(name, _)| *name).collect();
    for name in ["bit46", "bit136", "bit1030", "thread1", "dest0", "pos0", "console"] {
        assert!(found.contains(&name), "{name} in {found:?}");
    }

    let (mut now, mut edges, mut lines) = (0, Vec::new(), 0);
    for command in parser {
        match command.expect("the body is right") {
            Command::Timestamp(time) => {
                assert!(time > now || time == 0, "{time} after {now}");
                now = time;
            }
            Command::ChangeScalar(id, value) if names[&id].0 == "bit46" && now > 0 => {
                edges.push((now, value));
            }
            Command::ChangeString(id, text) if names[&id].0 == "console" && now > 0 => {
                assert!(text.starts_with("edge\\x20"), "{text}");
                lines += 1;
            }
            _ => {}
        }
    }
    assert_eq!((edges.len(), lines), (6, 3));
    for pair in edges.chunks(2) {
        assert_eq!((pair[0].1, pair[1].1), (Value::V0, Value::V1));
        // 5 µs, and what the calls cost.
        assert!((5_000..7_000).contains(&(pair[1].0 - pair[0].0)), "{pair:?}");
    }
}

/// GTKWave's converter; without it the test says so.
fn converter() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let found =
        std::env::split_paths(&folders).map(|folder| folder.join("vcd2fst")).find(|path| path.exists());
    if found.is_none() {
        eprintln!("no vcd2fst here: GTKWave does not read the dump");
    }
    found
}

#[test]
fn gtkwave_accepts_the_dump() {
    let Some(converter) = converter() else { return };
    let options =
        ["--trace", "wave.vcd", "--trace-items", "dest0,bit8,kstep_analog", "--stim", "at 1ms bit 136 = 1"];
    let dump = traces(&options, &["wave.vcd"]).remove(0);
    let scratch = Scratch::new("traces-gtkwave");
    scratch.write("a.vcd", &dump);
    let output = Process::new(converter).args(["a.vcd", "a.fst"]).current_dir(scratch.path()).output();
    let output = output.expect("it starts");
    let said =
        String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}");
    for word in ["error", "warning", "unknown", "not found"] {
        assert!(!said.to_lowercase().contains(word), "{said}");
    }
    let converted = fs::metadata(scratch.path().join("a.fst")).expect("it is converted").len();
    assert!(converted > 300, "{converted} bytes");
}

/// A file of the "Trace Event Format", which Chrome defines and Perfetto reads: what each phase must and may have.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
struct TraceFile {
    trace_events: Vec<TraceEvent>,
    display_time_unit: TimeUnit,
}

#[derive(Debug, Deserialize)]
enum TimeUnit {
    #[serde(rename = "ms")]
    Milliseconds,
    #[serde(rename = "ns")]
    Nanoseconds,
}

#[derive(Debug, Deserialize)]
#[serde(tag = "ph", deny_unknown_fields)]
enum TraceEvent {
    /// Metadata.
    #[serde(rename = "M")]
    Metadata { name: MetadataName, pid: u32, tid: u32, ts: f64, args: Name },
    /// A complete event: a span of a track.
    #[serde(rename = "X")]
    Complete { name: String, pid: u32, tid: u32, ts: f64, dur: f64 },
    /// A counter, with a number for each of its series.
    #[serde(rename = "C")]
    Counter { name: String, pid: u32, tid: u32, ts: f64, args: BTreeMap<String, f64> },
    /// An instant, with its reach.
    #[serde(rename = "i")]
    Instant { name: String, pid: u32, tid: u32, ts: f64, s: Reach },
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum MetadataName {
    ProcessName,
    ThreadName,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Name {
    name: String,
}

#[derive(Debug, Deserialize)]
enum Reach {
    #[serde(rename = "t")]
    Track,
}

#[test]
fn the_events_have_the_schema_of_their_format() {
    let text = traces(&["--trace", "a.json", "--trace-items", "dest0,iopwm0,bit8"], &["a.json"]).remove(0);
    let file: TraceFile = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert!(matches!(file.display_time_unit, TimeUnit::Nanoseconds));
    let (mut tracks, mut marks, mut busy, mut last) = (Vec::new(), Vec::new(), 0.0, BTreeMap::new());
    for event in &file.trace_events {
        let (pid, ts) = match event {
            TraceEvent::Metadata { name, pid, tid, ts, args } => {
                assert!(!args.name.is_empty());
                if *name == MetadataName::ThreadName {
                    tracks.push(*tid);
                }
                (pid, ts)
            }
            TraceEvent::Complete { name, pid, tid, ts, dur } => {
                assert!(name.starts_with("thread") && tracks.contains(tid) && *dur > 0.0);
                assert!(*ts >= busy, "{name} at {ts} before the one before is over");
                busy = ts + dur;
                (pid, ts)
            }
            TraceEvent::Counter { name, pid, tid, ts, args } => {
                assert_eq!(*tid, 0, "a counter belongs to the whole board");
                assert!(args.len() == 1 && *ts >= last.insert(name, *ts).unwrap_or(0.0), "{name} at {ts}");
                (pid, ts)
            }
            TraceEvent::Instant { name, pid, tid, ts, s: Reach::Track } => {
                assert!(tracks.contains(tid));
                marks.push(name.as_str());
                (pid, ts)
            }
        };
        assert!(*pid == 1 && *ts >= 0.0, "{event:?}");
    }
    assert_eq!(marks, [0, 1, 2].map(|index| format!("edge {index} of \"three\"")));
    assert!(last.len() >= 4, "{last:?}");
}

/// A dump's changes of a signal: the instant in nanoseconds and the level.
fn edges(dump: &str, name: &str) -> Vec<(u64, bool)> {
    let head = dump.lines().find(|line| line.ends_with(&format!(" {name} $end"))).expect(name);
    let id = head.split(' ').nth(3).expect("an id");
    let (mut now, mut edges) = (0, Vec::new());
    for line in dump.lines().skip_while(|line| *line != "$end") {
        if let Some(time) = line.strip_prefix('#') {
            now = time.parse().expect("a time");
        } else if line.strip_prefix(['0', '1']) == Some(id) {
            edges.push((now, line.starts_with('1')));
        }
    }
    edges
}

#[test]
fn pulses_show_all_edges_when_their_pin_is_traced() {
    let program = "#include \"KMotionDef.h\"
main()
{
    FPGA(IO_PWMS_PRESCALE) = 65;
    FPGA(IO_PWMS) = 64;
    FPGA(IO_PWMS + 1) = 1;
    Delay_sec(0.1);
    FPGA(IO_PWMS + 1) = 0;
    Delay_sec(0.01);
}
";
    let scratch = Scratch::new("traces-pulses");
    scratch.write("a.c", program);
    let run = |arguments: &[&str]| {
        let all = ["run", "--trace", "a.vcd"].iter().chain(arguments).chain(&["a.c"]);
        let output = cc67(&scratch, all);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""));
        read(&scratch.path().join("a.vcd"))
    };
    let dump = run(&["--trace-items", "bit26"]);
    assert_eq!(dump, run(&["--trace-items", "bit26", "--no-shortcuts"]));
    let edges = edges(&dump, "bit26");
    // 986.4 Hz for 0.1 s; a quarter of 1.0138 ms is high.
    assert!((197..=199).contains(&edges.len()), "{}", edges.len());
    for pulse in edges[1..].windows(3).filter(|pulse| pulse[0].1 && pulse[2].0 < 100_000_000) {
        assert_eq!((pulse[1].0 - pulse[0].0, pulse[2].0 - pulse[0].0), (254_435, 1_013_760), "{pulse:?}");
    }
    assert!(!run(&[]).contains("bit26"), "below half the duty the pin reads 0 all the time");
}

#[test]
fn a_killed_run_leaves_no_file_under_its_final_name() {
    let scratch = Scratch::new("traces-killed");
    let program = "#include \"KMotionDef.h\"
main() { int axis = 9; EnableAxis(axis); for (;;) { SetStateBit(46, ReadBit(136)); Delay_sec(0.01); } }";
    scratch.write("a.c", program);
    let mut child = Process::new(harness::command())
        .args(["run", "--for", "1e9", "--trace", "a.vcd", "--trace", "a.json", "--trace", "a.csv", "a.c"])
        .current_dir(scratch.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut line = String::new();
    let mut errors = BufReader::new(child.stderr.take().expect("it is piped"));
    errors.read_line(&mut line).expect("it says that there is no such axis");
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    for name in ["a.vcd", "a.json", "a.csv"] {
        assert!(!scratch.path().join(name).exists(), "{name}");
    }
}

#[test]
fn tables_are_the_same_with_and_without_shortcuts() {
    let options = ["--trace", "a.csv", "--trace-every", "4", "--trace-bits", "b.csv"];
    let names = ["a.csv", "b.csv"];
    let short = traces(&options, &names);
    let full = traces(&[options.as_slice(), &["--no-shortcuts"]].concat(), &names);
    assert_eq!(short, full);
    let lines: Vec<_> = short[0].lines().collect();
    assert_eq!(lines[0], "time,dest0,pos0,out0");
    assert!(lines[1].starts_with("0.000360,"), "{}", lines[1]);
    let step = |line: &str| line.split(',').next().and_then(|time| time.parse::<f64>().ok()).expect("a time");
    assert!(lines[1..].windows(2).all(|pair| (step(pair[1]) - step(pair[0]) - 0.00036).abs() < 1e-9));
    // The head, three pulses and the bit at the end; not the steps, which nobody has named.
    assert!(short[1].lines().count() == 8, "{}", short[1]);
}

#[test]
fn unknown_items_are_refused_and_no_file_is_left_behind() {
    let scratch = Scratch::new("traces-refused");
    fs::write(scratch.path().join("a.c"), "main() { }").expect("it is ours");
    for (arguments, expect) in [
        (
            vec!["--trace", "a.csv", "--trace-items", "dest0,speed9"],
            "`speed9` is not declared, nor is it an item of the board, such as axis0",
        ),
        (vec!["--trace", "missing/a.vcd"], "cannot write missing/a.vcd"),
        (vec!["--trace", "a.csv", "--trace-every", "0"], "0 is not in"),
    ] {
        let all = ["run"].iter().chain(&arguments).chain(&["a.c"]);
        let output = cc67(&scratch, all);
        assert_eq!(output.code, 2, "{arguments:?}");
        assert!(output.stderr.contains(expect), "{}", output.stderr);
    }
    let left: Vec<_> = fs::read_dir(scratch.path()).expect("it exists").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}
