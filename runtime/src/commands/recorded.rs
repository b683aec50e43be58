//! Replays recorded answers of the released firmware, byte for byte.

use std::collections::BTreeSet;

use kmotiondef::Bit;
use kmotiondef::limits::TIMEBASE;
use serde_json::Value as Json;

use super::COMMANDS;
use crate::testing::TestBench;
use crate::text::vectors::rows;

/// Answers that depend on timing or on connected hardware: only their form is compared.
const BY_FORM: &[(&str, &str, &str)] = &[
    ("ADC", "ADC", "the recorded board has nothing connected, which reads as the lowest value"),
    ("GETSTATUS", "GETSTATUS", "analog inputs, time stamp"),
    ("GETVIRTUALBITS", "GETVIRTUALBITS31 31", "a word after the array"),
    ("move and poll", "Dest0", "an axis that jogs while lines go back and forth"),
    ("buffer", "ExecTime", "time continues while lines go back and forth"),
    ("buffer", "Dest0", "time continues while lines go back and forth"),
    ("host-replies", "\u{1b}\u{1}ADC0", "as above"),
];

/// Returns whether an answer is the recorded one, or has its form where the values differ between runs.
fn agrees(name: &str, send: &str, found: &str, expect: &str) -> bool {
    let by_form = BY_FORM.iter().any(|(of, line, _)| *of == name && send.starts_with(line));
    found == expect
        || by_form && form(found) == form(expect) && (name != "GETSTATUS" || is_same_status(found, expect))
}

/// Returns whether two status records differ only in analog inputs and the time stamp.
fn is_same_status(found: &str, expect: &str) -> bool {
    let mut words = found.split_whitespace().zip(expect.split_whitespace()).enumerate();
    words.all(|(index, (found, expect))| matches!(index, 1..=8 | 104 | 105) || found == expect)
}

/// A text with `#` for each number; a word of eight hexadecimal digits is one.
fn form(text: &str) -> String {
    let number = |word: &str| {
        let is_number = word.parse::<f64>().is_ok() || u32::from_str_radix(word, 16).is_ok();
        if is_number { format!("#{}", if word.len() == 8 { "x" } else { "" }) } else { word.to_owned() }
    };
    text.split_inclusive([' ', '\n'])
        .map(|word| number(word.trim_end()) + &word[word.trim_end().len()..])
        .collect()
}

/// A board and its link, as bytes.
struct Wire {
    bench: TestBench,
}

impl Wire {
    fn new() -> Self {
        Self { bench: TestBench::new() }
    }

    /// Sends bytes and returns the reply.
    fn send(&mut self, bytes: &[u8]) -> String {
        self.bench.kernel.parts.pc.usb.receive(bytes);
        while self.bench.kernel.parts.pc.usb.is_busy() {
            self.bench.run(2);
        }
        self.bench.kernel.parts.out.take_events().into_iter().map(wire).collect()
    }

    /// Sends a recorded line, or carries out the action given in parentheses instead.
    fn exchange(&mut self, line: &str) -> String {
        let Some(action) = line.strip_prefix('(').and_then(|line| line.strip_suffix(')')) else {
            return self.send(format!("\x1b\x01{line}\r").as_bytes());
        };
        let words: Vec<&str> = action.split(' ').collect();
        match words[..] {
            ["run", seconds] => {
                let seconds: f64 = seconds.parse().expect("seconds");
                self.bench.run((seconds / TIMEBASE) as u64);
            }
            ["bit", bit, level] => {
                let bit = bit.parse().ok().and_then(Bit::new).expect("a bit");
                self.bench.kernel.parts.io.pins.drive(bit, level == "1", kmotiondef::Cycles::default());
            }
            _ => panic!("{line}"),
        }
        String::new()
    }
}

fn wire(event: crate::Event) -> String {
    String::from_utf8(event.kind.on_wire().unwrap_or_default()).expect("text")
}

fn text(json: &Json) -> &str {
    json.as_str().expect("a string")
}

#[test]
fn the_recorded_session_is_answered_byte_for_byte() {
    let mut wire = Wire::new();
    let mut wrong = Vec::new();
    let rows = rows("host-replies.jsonl");
    for row in &rows {
        let (send, expect) = (text(&row["send"]), text(&row["recv"]));
        let found = wire.send(send.as_bytes());
        if !agrees("host-replies", send, &found, expect) {
            wrong.push(format!("{send:?}\n  found  {found:?}\n  expect {expect:?}"));
        }
    }
    println!("{} of {} exchanges agree", rows.len() - wrong.len(), rows.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_recorded_command_is_answered_byte_for_byte() {
    let mut wrong = Vec::new();
    let (mut count, mut covered) = (0, BTreeSet::new());
    for row in rows("console.jsonl") {
        let name = row.get("command").or(row.get("session")).map(text).expect("a name");
        covered.insert(name.to_owned());
        let mut wire = Wire::new();
        for exchange in row["exchange"].as_array().expect("exchanges") {
            let (send, expect) = (text(&exchange[0]), text(&exchange[1]));
            let found = wire.exchange(send);
            count += 1;
            if !agrees(name, send, &found, expect) {
                wrong.push(format!("{name}: {send:?}\n  found  {found:?}\n  expect {expect:?}"));
            }
        }
    }
    let commands = COMMANDS.iter().filter(|command| covered.contains(&command.name.to_ascii_uppercase()));
    println!("{} commands, {} of {count} exchanges agree", commands.count(), count - wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
