//! Traces of whole runs, read by readers that are not ours.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use harness::{Scratch, run_in};
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
    let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), scratch.path(), arguments);
    assert_eq!(output.code, 0, "{}", output.stderr);
    names.iter().map(|name| read(&scratch.path().join(name))).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn another_reader_accepts_the_dump() {
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
                assert!(time > now || time == 0, "{time} behind {now}");
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

#[test]
fn the_events_have_the_shape_of_their_format() {
    let text = traces(&["--trace", "a.json", "--trace-items", "dest0,iopwm0"], &["a.json"]).remove(0);
    let trace: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let events = trace["traceEvents"].as_array().expect("a list of events");
    for event in events {
        let phase = event["ph"].as_str().expect("a phase");
        assert!(["M", "X", "C", "i"].contains(&phase), "{event}");
        assert!(event["name"].is_string() && event["pid"].is_u64() && event["tid"].is_u64(), "{event}");
        assert!(event["ts"].as_f64().is_some_and(|time| time >= 0.0), "{event}");
        assert!(phase != "X" || event["dur"].as_f64().is_some_and(|time| time > 0.0), "{event}");
    }
    let marks: Vec<_> = events.iter().filter(|event| event["ph"] == "i").collect();
    assert_eq!(marks.len(), 3);
    assert_eq!(marks[2]["name"], "edge 2 of \"three\"");
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
    assert!(short[1].lines().count() == 8, "{}", short[1]);
}

#[test]
fn items_that_do_not_exist_are_refused_and_nothing_is_left_behind() {
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
        let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), scratch.path(), all);
        assert_eq!(output.code, 2, "{arguments:?}");
        assert!(output.stderr.contains(expect), "{}", output.stderr);
    }
    let left: Vec<_> = fs::read_dir(scratch.path()).expect("it exists").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}
