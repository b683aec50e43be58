//! Flash memory. Source: devices.md section 7.

use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::{Caller, Outcome, Wake};
use vm::trap::TrapKind;

use super::calls::Continuation;
use super::parts::Parts;
use super::string::text;
use crate::io::flash::{self, BankRefused};
use crate::out::Message;

/// The time that erasing and programming a block takes; other threads and the servo continue.
const PROGRAMMING: Cycles = Cycles::PER_SECOND;
/// A block that is none, or words that are too many.
const REFUSED: i32 = 1;

/// Erases a block of the user flash and programs it with 16-bit words; then prints a message, if there is one.
pub(crate) fn program_flash(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    from: GuestAddr,
    words: i32,
    to: GuestAddr,
    message: GuestAddr,
) -> Result<Outcome<i32>, TrapKind> {
    if let Some(Continuation::Print { rest, result }) = parts.calls.take(caller) {
        return Ok(print(parts, caller, &rest, result));
    }
    let message = if message.is_null() { Vec::new() } else { text(caller, message)? };
    match program(parts, caller, (from, words, to))? {
        Outcome::Done(result) => Ok(print(parts, caller, &message, result)),
        waiting => Ok(waiting),
    }
}

/// Prints as much as the console has room for, and the rest when there is room again.
fn print(parts: &mut Parts, caller: &mut Caller<'_>, message: &[u8], result: i32) -> Outcome<i32> {
    let rest = parts.out.console.put(message).to_vec();
    if rest.is_empty() || caller.thread.is_none() {
        return Outcome::Done(result);
    }
    parts.calls.store(caller, Continuation::Print { rest, result });
    Outcome::Wait(Wake::Retry)
}

/// `ProgramFlashNoMessages`: programs user flash without a message.
pub(crate) fn program_flash_no_messages(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    from: GuestAddr,
    words: i32,
    to: GuestAddr,
) -> Result<Outcome<i32>, TrapKind> {
    program(parts, caller, (from, words, to))
}

fn program(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    (from, words, to): (GuestAddr, i32, GuestAddr),
) -> Result<Outcome<i32>, TrapKind> {
    if caller.woken.is_none() {
        return Ok(Outcome::Wait(Wake::At(caller.now() + PROGRAMMING)));
    }
    let done = match flash::length(words) {
        Some(length) => {
            let bytes = caller.memory.read_bytes(from, length)?.to_vec();
            parts.io.flash.with_chip(caller.memory, |memory| flash::program(memory, to, &bytes))
        }
        None => false,
    };
    if !done {
        parts.out.diagnose(caller, Message::NotABlock { words, to });
    }
    Ok(Outcome::Done(if done { 0 } else { REFUSED }))
}

/// Selects the bank for reads, on a board with strict flash; others show all of flash at its address. The board refuses
/// its boot sector (devices.md section 7).
pub(crate) fn set_flash_bank(parts: &mut Parts, caller: &mut Caller<'_>, address: GuestAddr) {
    if parts.io.flash.select(address, caller.memory) == Err(BankRefused) {
        parts.out.console.message(&format!("Attempted boot sector write : addr={:x}", address.get()));
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::TestBench;

    const USER: u64 = 0x9010_0000;

    #[test]
    fn a_block_is_programmed_after_a_second() {
        let mut bench = TestBench::new();
        let from = bench.put_words(0, &[0x0403_0201, 0x0807_0605]);
        let message = bench.put_text(100, b"done\n");
        let arguments = [from, 4, USER, message];
        assert!(!bench.is_done("ProgramFlash", &arguments));
        assert_eq!(bench.wake_i32("ProgramFlash", &arguments), 0);
        assert_eq!(bench.bytes_at(USER as u32, 9), [1, 2, 3, 4, 5, 6, 7, 8, 0xff]);
        assert_eq!(bench.printed(), ["done"]);
        bench.call("SetFlashBank", &[USER]);
        for (words, to) in [(40_000, USER), (4, USER + 2), (4, 0x9000_0000)] {
            let arguments = [from, words, to];
            assert_eq!(bench.wake_i32("ProgramFlashNoMessages", &arguments), 1, "{to:#x}");
        }
    }

    #[test]
    fn a_strict_board_shows_the_selected_bank() {
        let mut bench = TestBench::new();
        bench.kernel.parts.io.flash.be_strict(&mut bench.memory);
        let from = bench.put_words(0, &[0x0403_0201]);
        assert_eq!(bench.wake_i32("ProgramFlashNoMessages", &[from, 2, USER]), 0);
        assert_eq!(bench.bytes_at(USER as u32, 2), [0xff, 0xff]);
        bench.call("SetFlashBank", &[USER]);
        assert_eq!(bench.bytes_at(USER as u32, 5), [1, 2, 3, 4, 0xff]);
        bench.call("SetFlashBank", &[USER + 0x8000]);
        assert_eq!(bench.bytes_at(USER as u32, 2), [0xff, 0xff]);
        bench.call("SetFlashBank", &[0x9000_0000]);
        assert_eq!(bench.bytes_at(USER as u32, 2), [1, 2]);
        assert_eq!(bench.printed(), ["Attempted boot sector write : addr=90000000"]);
    }
}
