//! A trace as the events of trace viewers: threads as tracks, bits and items as counters, prints as marks.

use anyhow::Result;
use kmotiondef::{Cycles, ThreadId};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::{Log, nanoseconds};

/// The board as the viewer's process, and its tracks beside the threads, which have their own numbers.
const BOARD: u32 = 1;
const CONSOLE: u32 = 8;
const UART: u32 = 9;

/// One event. Times are microseconds.
#[derive(Serialize)]
struct Event {
    name: String,
    ph: &'static str,
    pid: u32,
    tid: u32,
    ts: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<f64>,
    /// How far a mark reaches.
    #[serde(skip_serializing_if = "Option::is_none")]
    s: Option<&'static str>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    args: Map<String, Value>,
}

impl Event {
    fn new(ph: &'static str, name: String, tid: u32, at: Cycles) -> Self {
        Self { name, ph, pid: BOARD, tid, ts: microseconds(at), dur: None, s: None, args: Map::new() }
    }

    fn with(mut self, key: &str, value: Value) -> Self {
        self.args.insert(key.to_owned(), value);
        self
    }

    /// Gives a track its name.
    fn track(tid: u32, name: &str) -> Self {
        Self::new("M", "thread_name".to_owned(), tid, Cycles::default()).with("name", json!(name))
    }

    fn mark(name: String, tid: u32, at: Cycles) -> Self {
        Self { s: Some("t"), ..Self::new("i", name, tid, at) }
    }
}

fn microseconds(at: Cycles) -> f64 {
    nanoseconds(at) as f64 / 1000.0
}

/// The events as JSON.
pub(super) fn text(log: &Log) -> Result<String> {
    let mut events = vec![
        Event::new("M", "process_name".to_owned(), 0, Cycles::default()).with("name", json!("board")),
        Event::track(CONSOLE, "console"),
    ];
    for thread in ThreadId::all().filter(|thread| log.slices.iter().any(|(other, ..)| other == thread)) {
        events.push(Event::track(thread.get().into(), &format!("thread {thread}")));
    }
    for (thread, start, end) in &log.slices {
        let slice = Event::new("X", format!("thread {thread}"), thread.get().into(), *start);
        events.push(Event { dur: Some(microseconds(*end - *start)), ..slice });
    }
    for (bit, level) in log.bits() {
        let counter = |at, level: bool| {
            Event::new("C", format!("bit {bit}"), 0, at).with("level", json!(u8::from(level)))
        };
        events.push(counter(Cycles::default(), level));
        let changes = log.changes.iter().filter(|change| change.bit == bit);
        events.extend(changes.map(|change| counter(change.at, change.level)));
    }
    for (index, item) in log.columns() {
        for (at, values) in &log.samples {
            // JSON has no infinity; viewers take nothing for a gap.
            let value = values.get(index).copied().filter(|value| value.is_finite());
            events.push(
                Event::new("C", item.to_string(), 0, *at).with("value", json!(value.unwrap_or_default())),
            );
        }
    }
    events.extend(log.lines.iter().map(|(at, line)| Event::mark(line.clone(), CONSOLE, *at)));
    if !log.sent.is_empty() {
        events.push(Event::track(UART, "serial port"));
    }
    events.extend(log.sent.iter().map(|(at, byte)| Event::mark(byte.escape_ascii().to_string(), UART, *at)));
    Ok(serde_json::to_string(&json!({ "displayTimeUnit": "ns", "traceEvents": events }))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_has_what_viewers_ask_for() {
        let text = text(&super::super::testing::log()).expect("it can be written");
        let trace: Value = serde_json::from_str(&text).expect("it is JSON");
        let events = trace["traceEvents"].as_array().expect("a list");
        for event in events {
            assert!(event["name"].is_string() && event["pid"].is_u64() && event["tid"].is_u64(), "{event}");
            assert!(event["ts"].is_f64() || event["ts"].is_u64(), "{event}");
            let fits = match event["ph"].as_str() {
                Some("M") => event["args"]["name"].is_string(),
                Some("X") => event["dur"].is_f64(),
                Some("C") => {
                    event["args"].as_object().is_some_and(|args| args.values().all(Value::is_number))
                }
                Some("i") => event["s"] == "t",
                _ => false,
            };
            assert!(fits, "{event}");
        }
        let of = |ph: &str| events.iter().filter(|event| event["ph"] == ph).count();
        assert_eq!((of("M"), of("X"), of("C"), of("i")), (4, 1, 6, 2));
    }
}
