//! The profile as a table: for each thread its functions and its lines, the longest first.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use kmotiondef::Cycles;
use vm::profile::SpentTime;

use super::{Account, ProfilePlace, TimeConsumer};

/// The number of rows in a table; the others took less time.
const ROWS: usize = 15;

/// The time of a function itself, and including the functions that it called.
#[derive(Clone, Copy, Default)]
struct FunctionTimes {
    own: SpentTime,
    total: SpentTime,
}

/// The tables of all threads.
pub(super) fn table(account: &Account, end: Cycles) -> String {
    let mut text = format!("Where {} of board time went\n", time(end));
    let all: BTreeSet<TimeConsumer> = account.keys().map(|place| place.whose).collect();
    for whose in all {
        let places: Vec<_> = account.iter().filter(|(place, _)| place.whose == whose).collect();
        of_one(&mut text, whose, &places, end);
    }
    text
}

fn of_one(text: &mut String, whose: TimeConsumer, places: &[(&ProfilePlace, &SpentTime)], end: Cycles) {
    let all = places.iter().fold(SpentTime::default(), |sum, (_, spent)| add_times(sum, **spent));
    let _ = writeln!(
        text,
        "\n{}: computing {} ({}), waiting {} ({}), the rest went to the servo and to others",
        whose,
        time(all.computing),
        percent(all.computing, end),
        time(all.waiting),
        percent(all.waiting, end),
    );
    let _ = writeln!(text, "  {:>11} {:>11} {:>11}  function", "computing", "waiting", "with calls");
    for (name, function) in functions(places).into_iter().take(ROWS) {
        let (own, total) = (function.own, function.total);
        let _ = writeln!(
            text,
            "  {:>11} {:>11} {:>11}  {name}",
            time(own.computing),
            time(own.waiting),
            time(total.computing + total.waiting),
        );
    }
    let _ = writeln!(text, "  {:>11} {:>11} {:>11}  line", "computing", "waiting", "");
    for (line, spent) in lines(places).into_iter().take(ROWS) {
        let _ =
            writeln!(text, "  {:>11} {:>11} {:>11}  {line}", time(spent.computing), time(spent.waiting), "");
    }
}

/// The functions of the program and of the firmware, the longest first.
fn functions(places: &[(&ProfilePlace, &SpentTime)]) -> Vec<(String, FunctionTimes)> {
    let mut functions: BTreeMap<String, FunctionTimes> = BTreeMap::new();
    for (place, spent) in places {
        let mut names: Vec<String> = place.frames.iter().map(|frame| frame.function.clone()).collect();
        names.extend(place.firmware.as_ref().map(|name| format!("{name} (firmware)")));
        if let Some(innermost) = names.last() {
            let function = functions.entry(innermost.clone()).or_default();
            function.own = add_times(function.own, **spent);
        }
        // A recursive function is counted once.
        for name in names.into_iter().collect::<BTreeSet<_>>() {
            let function = functions.entry(name).or_default();
            function.total = add_times(function.total, **spent);
        }
    }
    longest_first(functions, |function| function.total)
}

/// The lines, including the time of firmware functions called from them.
fn lines(places: &[(&ProfilePlace, &SpentTime)]) -> Vec<(String, SpentTime)> {
    let mut lines: BTreeMap<String, SpentTime> = BTreeMap::new();
    for (place, spent) in places {
        let Some(frame) = place.frames.last() else { continue };
        let name = match frame.line {
            Some(line) => format!("{}:{line} in {}", frame.file, frame.function),
            None => frame.function.clone(),
        };
        let sum = lines.entry(name).or_default();
        *sum = add_times(*sum, **spent);
    }
    longest_first(lines, |spent| *spent)
}

fn longest_first<T>(rows: BTreeMap<String, T>, spent: impl Fn(&T) -> SpentTime) -> Vec<(String, T)> {
    let mut rows: Vec<_> = rows.into_iter().collect();
    rows.sort_by_key(|(_, row)| std::cmp::Reverse((spent(row).computing + spent(row).waiting).get()));
    rows
}

fn add_times(a: SpentTime, b: SpentTime) -> SpentTime {
    SpentTime { computing: a.computing + b.computing, waiting: a.waiting + b.waiting }
}

/// A time in a unit that suits its size.
fn time(span: Cycles) -> String {
    let seconds = span.get() as f64 / Cycles::PER_SECOND.get() as f64;
    match span.get() {
        0 => "-".to_owned(),
        _ if seconds < 1e-3 => format!("{:.2} µs", seconds * 1e6),
        _ if seconds < 1.0 => format!("{:.3} ms", seconds * 1e3),
        _ => format!("{seconds:.3} s"),
    }
}

fn percent(part: Cycles, whole: Cycles) -> String {
    format!("{:.1} %", 100.0 * part.get() as f64 / whole.get().max(1) as f64)
}
