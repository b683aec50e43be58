//! Text files on the PC. Source: gather-persist-console.md section 6.
//!
//! `FILE` is an int and the board keeps no table: one handle stands for the file open for reading, one for the file
//! open for writing.

use kmotiondef::GuestAddr;
use kmotiondef::limits::MAX_READ_DISK_LENGTH;
use kmotiondef::variables::{READ_DISK_BUFFER, READ_DISK_BUFFER_STATUS};
use vm::firmware::{Caller, Outcome, Wake};
use vm::trap::TrapKind;

use super::console::{converted, cut, formatted};
use super::string::text;
use crate::dispatch::Varargs;
use crate::kernel::Kernel;
use crate::text::{Arguments, format};
use crate::views::Typed;

/// The handle of the file open for reading.
const READING: GuestAddr = GuestAddr::new(0x1001_A818);
/// The handle of the file open for writing.
const WRITING: GuestAddr = GuestAddr::new(0x1001_A81C);
/// States of the line buffer.
const LINE_ARRIVED: i32 = 1;
const FAILED: i32 = 2;
const NO_MORE: i32 = 3;

/// Waits for the PC's answer, once.
fn round_trip(kernel: &Kernel, caller: &Caller<'_>) -> Option<Wake> {
    caller.woken.is_none().then(|| Wake::At(caller.now() + kernel.files_latency))
}

pub(crate) fn fopen(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    path: GuestAddr,
    mode: GuestAddr,
) -> Result<Outcome<GuestAddr>, TrapKind> {
    let (path, mode) = (text(caller, path)?, text(caller, mode)?);
    let name = String::from_utf8_lossy(&path).into_owned();
    if mode.first() != Some(&b'r') {
        if !kernel.files.open_for_writing(&name, mode.first() == Some(&b'a')) {
            kernel.diagnose(caller, format!("fopen: {name} cannot be written"));
        }
        return Ok(Outcome::Done(WRITING));
    }
    if let Some(wake) = round_trip(kernel, caller) {
        return Ok(Outcome::Wait(wake));
    }
    if kernel.files.open_for_reading(&name) {
        caller.memory.set(READ_DISK_BUFFER_STATUS, LINE_ARRIVED);
        return Ok(Outcome::Done(READING));
    }
    caller.memory.set(READ_DISK_BUFFER_STATUS, FAILED);
    kernel.diagnose(caller, format!("fopen: {name} cannot be read or is empty"));
    Ok(Outcome::Done(GuestAddr::NULL))
}

pub(crate) fn fclose(kernel: &mut Kernel, _: &mut Caller<'_>, file: GuestAddr) -> i32 {
    match file {
        READING => kernel.files.close_reading(),
        _ => kernel.files.close_writing(),
    }
    0
}

/// Values for a text that is taken as a format once more: there are none.
struct Nothing;

impl Arguments for Nothing {
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

/// Writes formatted text. Odd and kept: the text is taken as a format a second time.
pub(crate) fn fprintf(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    _file: GuestAddr,
    pattern: GuestAddr,
    arguments: Varargs,
) -> Result<i32, TrapKind> {
    let text = formatted(caller, pattern, arguments)?;
    let text = format(cut(&text), &mut Nothing)?;
    if !kernel.files.write(cut(&text)) {
        kernel.diagnose(caller, "fprintf: no file is open for writing".to_owned());
    }
    Ok(0)
}

/// Fetches the next line into the line buffer; `false` at the end of the file.
fn fetch(kernel: &mut Kernel, caller: &mut Caller<'_>) -> Result<Option<Vec<u8>>, TrapKind> {
    let Some(line) = kernel.files.next_line() else {
        caller.memory.set(READ_DISK_BUFFER_STATUS, NO_MORE);
        return Ok(None);
    };
    let mut stored = line.clone();
    stored.push(0);
    caller.memory.poke_bytes(READ_DISK_BUFFER.address(), &stored)?;
    caller.memory.set(READ_DISK_BUFFER_STATUS, LINE_ARRIVED);
    Ok(Some(line))
}

/// The next line, up to `limit` characters; without a terminator when the line has as many or more.
pub(crate) fn fgets(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    to: GuestAddr,
    limit: i32,
    file: GuestAddr,
) -> Result<Outcome<GuestAddr>, TrapKind> {
    if file != READING {
        return Ok(Outcome::Done(GuestAddr::NULL));
    }
    if let Some(wake) = round_trip(kernel, caller) {
        return Ok(Outcome::Wait(wake));
    }
    let Some(mut line) = fetch(kernel, caller)? else {
        return Ok(Outcome::Done(GuestAddr::NULL));
    };
    line.push(0);
    line.truncate(usize::try_from(limit).unwrap_or(0));
    caller.memory.write_bytes(to, &line)?;
    Ok(Outcome::Done(to))
}

/// Converts the next line, at most 128 characters of it. At the end of the file the last line is converted again.
pub(crate) fn fscanf(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    file: GuestAddr,
    pattern: GuestAddr,
    places: Varargs,
) -> Result<Outcome<i32>, TrapKind> {
    if file != READING {
        return Ok(Outcome::Done(0));
    }
    if let Some(wake) = round_trip(kernel, caller) {
        return Ok(Outcome::Wait(wake));
    }
    let pattern = text(caller, pattern)?;
    let line = match fetch(kernel, caller)? {
        Some(line) => line,
        None => caller.memory.read_c_string(READ_DISK_BUFFER.address(), MAX_READ_DISK_LENGTH as u32)?,
    };
    converted(caller, cut(&line), &pattern, places).map(Outcome::Done)
}

/// 1 after a failed read or opening.
pub(crate) fn feof(_: &mut Kernel, caller: &mut Caller<'_>, _file: GuestAddr) -> i32 {
    i32::from(matches!(caller.memory.get(READ_DISK_BUFFER_STATUS), FAILED | NO_MORE))
}
