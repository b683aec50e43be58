//! Text to the console of the PC, and text formatted or converted in memory.
//!
//! Source: gather-persist-console.md section 4. Files on the PC are in [`super::files`].

use kmotiondef::firmware::Function;
use kmotiondef::limits::MAX_STRING;
use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::{Caller, Outcome, Wake};
use vm::memory::GuestMemory;
use vm::trap::TrapKind;

use super::calls::Continuation;
use super::costs;
pub(crate) use super::files::{fclose, feof, fgets, fopen, fprintf, fscanf};
use super::float_bits;
use super::parts::Parts;
use super::string::text;
use crate::firmware::dispatch::Varargs;
use crate::out::{LINE_LIMIT, Message};
use crate::text::{Arguments, ScannedValue, Sink, format_counted, scan};

/// Longest string a `%s` reads.
const LONGEST: u32 = 0x10_0000;

/// The values after `...` in guest memory, each aligned to its own size.
pub(crate) struct GuestArguments<'a> {
    memory: &'a mut GuestMemory,
    at: u32,
}

impl GuestArguments<'_> {
    /// The address of the next value of `size` bytes.
    fn next(&mut self, size: u32) -> GuestAddr {
        let address = self.at.wrapping_add(size - 1) & !(size - 1);
        self.at = address.wrapping_add(size);
        GuestAddr::new(address)
    }

    /// The next value, an address.
    fn address(&mut self) -> Result<GuestAddr, TrapKind> {
        let place = self.next(4);
        self.memory.load(place).map(GuestAddr::new)
    }
}

impl Arguments for GuestArguments<'_> {
    type Error = TrapKind;

    fn word(&mut self) -> Result<u32, TrapKind> {
        let place = self.next(4);
        self.memory.load(place)
    }

    fn long_long(&mut self) -> Result<u64, TrapKind> {
        let place = self.next(8);
        self.memory.load(place)
    }

    fn double(&mut self) -> Result<f64, TrapKind> {
        let place = self.next(8);
        self.memory.load(place)
    }

    fn text(&mut self, limit: usize) -> Result<Option<Vec<u8>>, TrapKind> {
        let address = self.address()?;
        if address.is_null() {
            return Ok(None);
        }
        let limit = u32::try_from(limit).unwrap_or(LONGEST).min(LONGEST);
        self.memory.read_c_string(address, limit).map(Some)
    }
}

impl Sink for GuestArguments<'_> {
    type Error = TrapKind;

    fn store(&mut self, value: ScannedValue<'_>) -> Result<(), TrapKind> {
        let place = self.address()?;
        match value {
            ScannedValue::Byte(value) => self.memory.store(place, value),
            ScannedValue::Short(value) => self.memory.store(place, value),
            ScannedValue::Int(value) => self.memory.store(place, value),
            ScannedValue::Long(value) => {
                self.memory.store(place, value as u32)?;
                self.memory.store(place.offset(4), (value >> 32) as u32)
            }
            ScannedValue::Float(value) => self.memory.store(place, value),
            ScannedValue::Double(value) => self.memory.store(place, value),
            ScannedValue::Chars(text) => self.memory.write_bytes(place, text),
            ScannedValue::Text(text) => {
                let mut text = text.to_vec();
                text.push(0);
                self.memory.write_bytes(place, &text)
            }
        }
    }
}

/// Formats the values after `...`.
pub(crate) fn formatted(
    parts: &Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<Vec<u8>, TrapKind> {
    let pattern = text(caller, pattern)?;
    let mut arguments = GuestArguments { memory: caller.memory, at: arguments.0.get() };
    let formatted = format_counted(parts.level.behaviour().text, &pattern, &mut arguments)?;
    caller.spend(Cycles::new(formatted.cycles.into()));
    Ok(formatted.text)
}

/// Converts `text` under a pattern into the places after `...`.
pub(crate) fn scan_into(
    parts: &Parts,
    caller: &mut Caller<'_>,
    text: &[u8],
    pattern: &[u8],
    places: Varargs,
) -> Result<i32, TrapKind> {
    let dialect = parts.level.behaviour().text;
    let mut places = GuestArguments { memory: caller.memory, at: places.0.get() };
    let found = scan(dialect, text, pattern, &mut places)?;
    caller.spend(Cycles::new(found.cycles.into()));
    Ok(found.result)
}

/// The cost of a character for the console's queue, in cycles (costs.md section 4).
const QUEUED_CHARACTER: i64 = 133;

/// Spends the cost of adding text to the console queue.
pub(crate) fn spend_queueing(caller: &mut Caller<'_>, text: &[u8]) {
    caller.spend(Cycles::new(QUEUED_CHARACTER * text.len() as i64));
}

/// Reports a text of which a call sends only a part.
pub(crate) fn note_cut(parts: &mut Parts, caller: &Caller<'_>, function: Function, text: &[u8]) {
    if text.len() > MAX_STRING {
        parts.calls.notices.has_cut_text = true;
        parts.out.diagnose(caller, Message::TextCut { function, size: text.len() });
    }
}

/// Returns the part of a text that one call may print: at most 128 characters, and nothing after a zero byte.
pub(crate) fn printable_part(text: &[u8]) -> &[u8] {
    let text = &text[..text.len().min(MAX_STRING)];
    &text[..text.iter().position(|&byte| byte == 0).unwrap_or(text.len())]
}

/// Puts text on the console in the slice in which its formatting ends; the call waits while the queue is full.
pub(crate) fn put_text(parts: &mut Parts, caller: &Caller<'_>, text: &[u8], result: i32) -> Outcome<i32> {
    if caller.thread.is_some() && caller.is_overdrawn() {
        parts.calls.store(caller, Continuation::Print { rest: text.to_vec(), result });
        return Outcome::Wait(Wake::Retry);
    }
    let begun = parts.calls.notices.record_print(caller.thread, caller.at, text);
    if let Some(other) = begun.filter(|_| caller.thread.is_some()) {
        parts.out.diagnose(caller, Message::LinesMixed { other });
    }
    let rest = parts.out.console.put(text).to_vec();
    if rest.is_empty() {
        return Outcome::Done(result);
    }
    parts.calls.store(caller, Continuation::Print { rest, result });
    Outcome::Wait(Wake::Retry)
}

/// Continues a call that waits for the queue.
pub(crate) fn resume_call(parts: &mut Parts, caller: &Caller<'_>) -> Option<Outcome<i32>> {
    caller.woken?;
    match parts.calls.take(caller) {
        Some(Continuation::Print { rest, result }) => Some(put_text(parts, caller, &rest, result)),
        _ => Some(Outcome::Done(0)),
    }
}

pub(crate) fn printf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(outcome) = resume_call(parts, caller) {
        return Ok(outcome);
    }
    let text = formatted(parts, caller, pattern, arguments)?;
    float_bits::notice_text(parts, caller, Function::printf, &text);
    note_cut(parts, caller, Function::printf, &text);
    let longest =
        printable_part(&text).split(|&byte| byte == b'\n').map(<[u8]>::len).max().unwrap_or_default();
    if longest > LINE_LIMIT && text.len() <= MAX_STRING {
        parts.out.diagnose(caller, Message::LongLine { size: longest });
    }
    if text.is_empty() {
        costs::spend(caller, costs::NOTHING_PRINTED);
    }
    spend_queueing(caller, printable_part(&text));
    Ok(put_text(parts, caller, printable_part(&text), text.len() as i32))
}

pub(crate) fn vprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    arguments: GuestAddr,
) -> Result<Outcome<i32>, TrapKind> {
    printf(parts, caller, pattern, Varargs(arguments))
}

/// Prints a string of any length.
pub(crate) fn print(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(outcome) = resume_call(parts, caller) {
        return Ok(outcome);
    }
    let text = text(caller, string)?;
    spend_queueing(caller, &text);
    Ok(put_text(parts, caller, &text, 0))
}

/// The one value of `PrintFloat` and `PrintInt`.
struct SingleArgument {
    word: u32,
    double: f64,
}

impl Arguments for SingleArgument {
    type Error = TrapKind;

    fn word(&mut self) -> Result<u32, TrapKind> {
        Ok(self.word)
    }

    fn long_long(&mut self) -> Result<u64, TrapKind> {
        Ok(self.word.into())
    }

    fn double(&mut self) -> Result<f64, TrapKind> {
        Ok(self.double)
    }

    fn text(&mut self, _: usize) -> Result<Option<Vec<u8>>, TrapKind> {
        Ok(None)
    }
}

fn print_one(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    mut value: SingleArgument,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(outcome) = resume_call(parts, caller) {
        return Ok(outcome);
    }
    let pattern = text(caller, pattern)?;
    let formatted = format_counted(parts.level.behaviour().text, &pattern, &mut value)?;
    caller.spend(Cycles::new(formatted.cycles.into()));
    spend_queueing(caller, printable_part(&formatted.text));
    Ok(put_text(parts, caller, printable_part(&formatted.text), 0))
}

pub(crate) fn print_float(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    value: f64,
) -> Result<Outcome<i32>, TrapKind> {
    print_one(parts, caller, pattern, SingleArgument { word: value as i32 as u32, double: value })
}

pub(crate) fn print_int(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    pattern: GuestAddr,
    value: i32,
) -> Result<Outcome<i32>, TrapKind> {
    print_one(parts, caller, pattern, SingleArgument { word: value as u32, double: f64::from(value) })
}

pub(crate) fn puts(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(outcome) = resume_call(parts, caller) {
        return Ok(outcome);
    }
    let mut text = text(caller, string)?;
    text.push(b'\n');
    spend_queueing(caller, &text);
    Ok(put_text(parts, caller, &text, text.len() as i32))
}

pub(crate) fn putchar(parts: &mut Parts, caller: &mut Caller<'_>, character: i32) -> Outcome<i32> {
    if let Some(outcome) = resume_call(parts, caller) {
        return outcome;
    }
    put_text(parts, caller, &[character as u8], i32::from(character as u8))
}

/// Writes a formatted string to memory.
fn store(caller: &mut Caller<'_>, to: GuestAddr, mut text: Vec<u8>) -> Result<i32, TrapKind> {
    let length = text.len() as i32;
    text.push(0);
    caller.memory.write_bytes(to, &text)?;
    Ok(length)
}

pub(crate) fn sprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<i32, TrapKind> {
    let text = formatted(parts, caller, pattern, arguments)?;
    parts.check_room(caller, Function::sprintf, to, text.len() + 1);
    store(caller, to, text)
}

pub(crate) fn vsprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    pattern: GuestAddr,
    arguments: GuestAddr,
) -> Result<i32, TrapKind> {
    sprintf(parts, caller, to, pattern, Varargs(arguments))
}

/// At most `size` bytes with the terminator; returns the full length.
pub(crate) fn snprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    size: u32,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<i32, TrapKind> {
    let mut text = formatted(parts, caller, pattern, arguments)?;
    let length = text.len() as i32;
    if let Some(room) = (size as usize).checked_sub(1) {
        text.truncate(room);
        store(caller, to, text)?;
    }
    Ok(length)
}

pub(crate) fn vsnprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    size: u32,
    pattern: GuestAddr,
    arguments: GuestAddr,
) -> Result<i32, TrapKind> {
    snprintf(parts, caller, to, size, pattern, Varargs(arguments))
}

pub(crate) fn sscanf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    string: GuestAddr,
    pattern: GuestAddr,
    places: Varargs,
) -> Result<i32, TrapKind> {
    let (string, pattern) = (text(caller, string)?, text(caller, pattern)?);
    scan_into(parts, caller, &string, &pattern, places)
}

#[cfg(test)]
mod tests {
    use crate::testing::TestBench;

    #[test]
    fn printf_returns_the_full_length_and_prints_128_characters() {
        let mut bench = TestBench::new();
        let long = vec![b'x'; 200];
        let (pattern, string) = (bench.put_text(0, b"%s\n"), bench.put_text(64, &long));
        let values = bench.put_words(400, &[string as u32]);
        assert!(!bench.is_done("printf", &[pattern, values]), "formatting takes longer than the slice");
        assert!(bench.printed().is_empty());
        assert_eq!(bench.wake_i32("printf", &[pattern, values]), 201);
        assert_eq!(bench.printed(), ["x".repeat(125), "xxx".to_owned()]);
    }

    #[test]
    fn doubles_are_aligned_in_the_argument_list() {
        let mut bench = TestBench::new();
        let double = 1.5_f64.to_bits();
        let pattern = bench.put_text(0, b"%d %f %d\n");
        let values = bench.put_words(64, &[7, 0, double as u32, (double >> 32) as u32, 8]);
        bench.call_i32("printf", &[pattern, values]);
        assert_eq!(bench.printed(), ["7 1.500000 8"]);
    }

    #[test]
    fn a_full_queue_makes_the_caller_wait() {
        let mut bench = TestBench::new();
        let pattern = bench.put_text(0, b"x\n");
        for _ in 0..255 {
            bench.call_i32("printf", &[pattern, 0]);
        }
        assert!(!bench.is_done("printf", &[pattern, 0]));
        bench.kernel.parts.out.console.send();
        assert_eq!(bench.wake_i32("printf", &[pattern, 0]), 2);
        assert_eq!(bench.printed().len(), 255);
    }

    #[test]
    fn sscanf_stores_through_its_pointers() {
        let mut bench = TestBench::new();
        let (string, pattern) = (bench.put_text(0, b"12 2.5"), bench.put_text(32, b"%d %lf"));
        let places = bench.put_words(64, &[bench.scratch(128), bench.scratch(136)]);
        assert_eq!(bench.call_i32("sscanf", &[string, pattern, places]), 2);
        assert_eq!(bench.memory.peek::<i32>(kmotiondef::GuestAddr::new(bench.scratch(128))), 12);
        assert_eq!(bench.memory.peek::<f64>(kmotiondef::GuestAddr::new(bench.scratch(136))), 2.5);
    }
}
