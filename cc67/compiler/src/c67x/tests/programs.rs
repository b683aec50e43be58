//! The recorded programs of the specification: the same console and result, and the cycles compared with the vendor's.

use serde_json::Value;

use super::{build, machine};
use crate::passes::Level;

const PROGRAMS: &str = include_str!("programs.jsonl");

/// Programs whose output differs from that with the vendor's compiler, whose division is not correctly rounded and
/// whose comparisons with a NaN are wrong. Others need time or `%g`, which the firmware of these tests lacks.
const OTHERWISE: &[&str] = &["specials", "convert", "printfmt", "timeslice", "delay"];

/// Runs every program; returns the table, and the geometric means of cycles and of bytes.
fn all(level: Level) -> (String, f64, f64) {
    let (mut table, mut cycles, mut bytes, mut count) = (String::new(), 0.0, 0.0, 0);
    let mut wrong = Vec::new();
    for line in PROGRAMS.lines() {
        let program: Value = serde_json::from_str(line).expect("a line of JSON");
        let id = program["id"].as_str().expect("a name");
        let linked = build(program["source"].as_str().expect("a source"), level);
        let run = machine::run(&linked);
        let expected = program["console"].as_str().expect("a text");
        let result = program["main_result"].as_i64().expect("a number");
        if (run.console != expected || i64::from(run.result) != result) && !OTHERWISE.contains(&id) {
            wrong.push(format!("{id}: {:?} {}, not {expected:?} {result}", run.console, run.result));
        }
        let vendor = program["user_cycles"].as_f64().expect("a number");
        let load = program["load"].as_array().expect("sections");
        let words: usize = load.iter().filter_map(|section| section["words"].as_array()).map(Vec::len).sum();
        if level != Level::None && run.cycles as f64 > vendor {
            wrong.push(format!("{id}: {} cycles, more than {vendor}", run.cycles));
        }
        let (speed, size) = (run.cycles as f64 / vendor, linked.text.bytes.len() as f64 / (4 * words) as f64);
        cycles += libm::log(speed);
        bytes += libm::log(size);
        count += 1;
        table += &format!(
            "{id:12} {:8} of {vendor:8} {speed:6.3}   {:5} bytes {size:6.3}\n",
            run.cycles,
            linked.text.bytes.len()
        );
    }
    let count = f64::from(count);
    let (cycles, bytes) = (libm::exp(cycles / count), libm::exp(bytes / count));
    table += &format!("geometric mean: cycles {cycles:.4}, bytes {bytes:.4}\n");
    assert!(wrong.is_empty(), "{table}\n{}", wrong.join("\n"));
    (table, cycles, bytes)
}

#[test]
fn recorded_programs_give_the_recorded_results() {
    let (table, cycles, bytes) = all(Level::Full);
    println!("{table}");
    assert!(cycles <= 0.172 && bytes <= 0.33, "slower or larger than it was:\n{table}");
}

#[test]
fn recorded_programs_are_faster_when_optimised_for_speed() {
    let (table, cycles, _) = all(Level::Fast);
    println!("{table}");
    assert!(cycles <= 0.066, "slower than it was:\n{table}");
}

#[test]
fn recorded_programs_are_smaller_when_optimised_for_size() {
    let (table, cycles, bytes) = all(Level::Small);
    let (_, _, full) = all(Level::Full);
    println!("{table}");
    assert!(cycles <= 0.083 && bytes < full, "not smaller, or slower than it was:\n{table}");
}

#[test]
fn recorded_programs_give_the_same_without_optimisation() {
    let (table, ..) = all(Level::None);
    println!("{table}");
}
