//! Text files on the PC. Source: gather-persist-console.md section 6, host-protocol.md section 6.
//!
//! Everything goes through the console queue, as lines that begin with a code; so file output is in order with printed
//! text, and waits like it. Reading is one line ahead: `fopen` reads the first line into `read_disk_buffer`, and taking
//! a line requests the next one. `FILE` is an int and the board keeps no table: one handle stands for the file open for
//! reading, one for the file open for writing.

use kmotiondef::firmware::Function;
use kmotiondef::limits::MAX_READ_DISK_LENGTH;
use kmotiondef::variables::{READ_DISK_BUFFER, READ_DISK_BUFFER_STATUS};
use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::{Caller, Outcome, Wake};
use vm::trap::TrapKind;

use super::calls::Continuation;
use super::console::{formatted, note_cut, printable_part, put_text, resume_call, scan_into, spend_queueing};
use super::parts::Parts;
use super::string::text;
use crate::firmware::dispatch::Varargs;
use crate::out::Message;
use crate::pc::disk::{ARRIVED, ASKED, DiskRequest};
use crate::text::{Arguments, format};
use crate::views::TypedAccess;

/// The handle of the file open for reading.
const READING: GuestAddr = GuestAddr::new(0x1001_A418);
/// The handle of the file open for writing.
const WRITING: GuestAddr = GuestAddr::new(0x1001_A41C);

/// Values for a text that is taken as a format a second time: there are none.
struct NoArguments;

impl Arguments for NoArguments {
    type Error = TrapKind;

    fn word(&mut self) -> Result<u32, TrapKind> {
        Ok(0)
    }

    fn long_long(&mut self) -> Result<u64, TrapKind> {
        Ok(0)
    }

    fn double(&mut self) -> Result<f64, TrapKind> {
        Ok(0.0)
    }

    fn text(&mut self, _: usize) -> Result<Option<Vec<u8>>, TrapKind> {
        Ok(Some(Vec::new()))
    }
}

/// A request as it is printed. Board quirk: the text after the code is taken as a format a second time.
fn printed(request: DiskRequest, text: &[u8]) -> Result<Vec<u8>, TrapKind> {
    let text = format(&[&[request.code()], text].concat(), &mut NoArguments)?;
    Ok(printable_part(&text).to_vec())
}

/// Sends a request and returns `result` once the queue has taken it.
fn send(
    parts: &mut Parts,
    caller: &Caller<'_>,
    request: DiskRequest,
    result: GuestAddr,
) -> Outcome<GuestAddr> {
    let outcome = put_text(parts, caller, &[request.code(), b'\n'], result.get().cast_signed());
    address(outcome)
}

/// A result that is an address.
fn address(outcome: Outcome<i32>) -> Outcome<GuestAddr> {
    match outcome {
        Outcome::Done(value) => Outcome::Done(GuestAddr::new(value.cast_unsigned())),
        Outcome::Wait(wake) => Outcome::Wait(wake),
        Outcome::End => Outcome::End,
    }
}

/// Returns whether the last requested line has arrived; `None` while it is still expected.
fn line_arrived(parts: &mut Parts, caller: &Caller<'_>) -> Option<bool> {
    let status = caller.memory.get(READ_DISK_BUFFER_STATUS);
    if status == ASKED {
        return None;
    }
    parts.calls.reading.has_failed = status != ARRIVED;
    Some(status == ARRIVED)
}

pub(crate) fn fopen(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    path: GuestAddr,
    mode: GuestAddr,
) -> Result<Outcome<GuestAddr>, TrapKind> {
    if caller.woken.is_some() {
        return Ok(resume_open(parts, caller));
    }
    let (path, mode) = (text(caller, path)?, text(caller, mode)?);
    let (request, handle) = match mode.first() {
        Some(b'r') => (DiskRequest::Open, READING),
        Some(b'a') => (DiskRequest::Append, WRITING),
        _ => (DiskRequest::Create, WRITING),
    };
    let mut line = printed(request, &path)?;
    line.push(b'\n');
    if request == DiskRequest::Open {
        caller.memory.set(READ_DISK_BUFFER_STATUS, ASKED);
    }
    let outcome = put_text(parts, caller, &line, handle.get().cast_signed());
    // The answer comes after the request has been sent.
    let waits = request == DiskRequest::Open && matches!(outcome, Outcome::Done(_));
    Ok(if waits { Outcome::Wait(Wake::Retry) } else { address(outcome) })
}

/// Continues an opening: the request has not been sent, or its answer is still expected.
fn resume_open(parts: &mut Parts, caller: &Caller<'_>) -> Outcome<GuestAddr> {
    if let Some(Continuation::Print { rest, result }) = parts.calls.take(caller) {
        let outcome = address(put_text(parts, caller, &rest, result));
        let waits = outcome == Outcome::Done(READING);
        return if waits { Outcome::Wait(Wake::Retry) } else { outcome };
    }
    match line_arrived(parts, caller) {
        None => Outcome::Wait(Wake::Retry),
        Some(true) => Outcome::Done(READING),
        Some(false) => Outcome::Done(GuestAddr::NULL),
    }
}

pub(crate) fn fclose(parts: &mut Parts, caller: &mut Caller<'_>, file: GuestAddr) -> Outcome<i32> {
    if let Some(outcome) = resume_call(parts, caller) {
        return outcome;
    }
    let request = if file == READING { DiskRequest::CloseReading } else { DiskRequest::CloseWriting };
    put_text(parts, caller, &[request.code(), b'\n'], 0)
}

/// Returns whether there is a single percent sign.
fn has_conversion(text: &[u8]) -> bool {
    let mut rest = text;
    while let Some(at) = rest.iter().position(|byte| *byte == b'%') {
        if rest.get(at + 1) != Some(&b'%') {
            return true;
        }
        rest = &rest[at + 2..];
    }
    false
}

/// Makes remarks about the board's quirks in writing files, each once.
fn warn(parts: &mut Parts, caller: &Caller<'_>, text: &[u8]) {
    if parts.out.console.is_holding() {
        parts.out.diagnose(caller, Message::LineInParts {});
    }
    if has_conversion(text) {
        parts.out.diagnose(caller, Message::PercentTwice {});
    }
}

/// Writes formatted text: a line, or the part of one.
pub(crate) fn fprintf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    _file: GuestAddr,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(outcome) = resume_call(parts, caller) {
        return Ok(outcome);
    }
    let text = formatted(parts, caller, pattern, arguments)?;
    note_cut(parts, caller, Function::fprintf, &text);
    let line = printed(DiskRequest::Write, printable_part(&text))?;
    spend_queueing(caller, printable_part(&text));
    caller.spend(Cycles::new(55 * printable_part(&text).len() as i64));
    warn(parts, caller, &text);
    Ok(put_text(parts, caller, &line, 0))
}

/// The next line, up to `limit` characters; without a terminator when the line has as many or more.
pub(crate) fn fgets(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    limit: i32,
    file: GuestAddr,
) -> Result<Outcome<GuestAddr>, TrapKind> {
    if file != READING {
        return Ok(Outcome::Done(GuestAddr::NULL));
    }
    if let Some(outcome) = resume_send(parts, caller) {
        return Ok(address(outcome));
    }
    match line_arrived(parts, caller) {
        None => return Ok(Outcome::Wait(Wake::Retry)),
        Some(false) => return Ok(Outcome::Done(GuestAddr::NULL)),
        Some(true) => {}
    }
    let mut line = buffered(caller)?;
    line.push(0);
    line.truncate(usize::try_from(limit).unwrap_or(0));
    caller.memory.write_bytes(to, &line)?;
    caller.memory.set(READ_DISK_BUFFER_STATUS, ASKED);
    Ok(send(parts, caller, DiskRequest::NextLine, to))
}

/// Continues sending the request for the next line, if the call waits for that.
fn resume_send(parts: &mut Parts, caller: &Caller<'_>) -> Option<Outcome<i32>> {
    caller.woken?;
    match parts.calls.take(caller) {
        Some(Continuation::Print { rest, result }) => Some(put_text(parts, caller, &rest, result)),
        _ => None,
    }
}

/// The line in the board's buffer.
fn buffered(caller: &Caller<'_>) -> Result<Vec<u8>, TrapKind> {
    caller.memory.read_c_string(caller.memory.locate(READ_DISK_BUFFER), MAX_READ_DISK_LENGTH as u32)
}

/// Converts the next line, at most 128 characters of it. At the end of the file the last line is converted again.
pub(crate) fn fscanf(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    file: GuestAddr,
    pattern: GuestAddr,
    places: Varargs,
) -> Result<Outcome<i32>, TrapKind> {
    if file != READING {
        return Ok(Outcome::Done(0));
    }
    if let Some(outcome) = resume_send(parts, caller) {
        return Ok(outcome);
    }
    let Some(is_there) = line_arrived(parts, caller) else { return Ok(Outcome::Wait(Wake::Retry)) };
    let pattern = text(caller, pattern)?;
    let line = buffered(caller)?;
    let count = scan_into(parts, caller, printable_part(&line), &pattern, places)?;
    if !is_there {
        return Ok(Outcome::Done(count));
    }
    caller.memory.set(READ_DISK_BUFFER_STATUS, ASKED);
    Ok(put_text(parts, caller, &[DiskRequest::NextLine.code(), b'\n'], count))
}

/// 1 after a failed read or opening.
pub(crate) fn feof(parts: &mut Parts, _: &mut Caller<'_>, _file: GuestAddr) -> i32 {
    i32::from(parts.calls.reading.has_failed)
}
