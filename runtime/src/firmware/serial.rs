//! The UART and its two rings in guest memory. Source: devices.md section 1.

use kmotiondef::firmware::Function;
use kmotiondef::limits::RS232BUFSZ;
use kmotiondef::variables::{
    DO_RS232_CMDS, P_RS232_REC_IN, P_RS232_REC_OUT, P_RS232_TX_IN, P_RS232_TX_OUT, RS232_REC_BUF,
    RS232_TX_BUF,
};
use kmotiondef::{Cycles, GuestAddr};
use vm::firmware::{Caller, Outcome, TickContext, Wake};
use vm::memory::GuestMemory;
use vm::trap::TrapKind;

use super::io::set_bit_direction;
use super::parts::Parts;
use crate::out::Message;
use crate::views::TypedAccess;

/// The time that setting up takes: 2 ms.
const SETUP: Cycles = Cycles::new(400_000);
/// The transmitter's pin.
const TRANSMIT_BIT: i32 = 45;

pub(crate) fn init_rs232(parts: &mut Parts, caller: &mut Caller<'_>, divisor: i32) -> Outcome<()> {
    if caller.woken.is_some() {
        return Outcome::Done(());
    }
    set_up(parts, caller, divisor);
    Outcome::Wait(Wake::At(caller.now() + SETUP))
}

fn set_up(parts: &mut Parts, caller: &mut Caller<'_>, divisor: i32) {
    set_bit_direction(parts, caller, TRANSMIT_BIT, 1);
    parts.io.fpga.enable_uart_pins();
    parts.io.uart.set_divisor(divisor as u8);
}

pub(crate) fn enable_rs232_cmds(parts: &mut Parts, caller: &mut Caller<'_>, divisor: i32) -> Outcome<()> {
    let outcome = init_rs232(parts, caller, divisor);
    if matches!(outcome, Outcome::Done(())) {
        start_service(parts, caller.memory);
    }
    outcome
}

/// `EnableRS232Cmds` as a script command, which does not wait.
pub(crate) fn connect(parts: &mut Parts, caller: &mut Caller<'_>, divisor: i32) {
    set_up(parts, caller, divisor);
    start_service(parts, caller.memory);
}

/// Empties both rings and starts the service.
fn start_service(parts: &mut Parts, memory: &mut GuestMemory) {
    memory.set(P_RS232_REC_IN, memory.locate(RS232_REC_BUF));
    memory.set(P_RS232_REC_OUT, memory.locate(RS232_REC_BUF));
    memory.set(P_RS232_TX_IN, memory.locate(RS232_TX_BUF));
    memory.set(P_RS232_TX_OUT, memory.locate(RS232_TX_BUF));
    memory.set(DO_RS232_CMDS, 1);
    parts.calls.serial.is_on = true;
}

/// Returns whether script commands are taken from the UART and answered there.
#[inline]
pub(crate) fn has_commands(parts: &Parts, memory: &GuestMemory) -> bool {
    parts.calls.serial.is_on && memory.get(DO_RS232_CMDS) != 0
}

/// Sends the bytes of a reply.
pub(crate) fn write(parts: &mut Parts, memory: &mut GuestMemory, bytes: &[u8]) {
    parts.calls.serial.replies.extend(bytes);
    fill(parts, memory);
}

/// Moves as much of the replies into the transmit ring as fits.
fn fill(parts: &mut Parts, memory: &mut GuestMemory) {
    while let Some(&byte) = parts.calls.serial.replies.front() {
        let place = memory.get(P_RS232_TX_IN);
        let after = next(place, memory.locate(RS232_TX_BUF));
        if after == memory.get(P_RS232_TX_OUT) {
            break;
        }
        memory.poke(place, byte);
        memory.set(P_RS232_TX_IN, after);
        parts.calls.serial.replies.pop_front();
    }
}

/// Returns whether the service that moves characters between the port and its rings was started.
fn check_service(parts: &mut Parts, caller: &Caller<'_>, function: Function) {
    if !parts.calls.serial.is_on {
        parts.out.diagnose(caller, Message::UartNotServed { function });
    }
}

pub(crate) fn rs232_get_char(parts: &mut Parts, caller: &mut Caller<'_>) -> Result<Outcome<i32>, TrapKind> {
    check_service(parts, caller, Function::RS232_GetChar);
    let out = caller.memory.get(P_RS232_REC_OUT);
    if out == caller.memory.get(P_RS232_REC_IN) {
        return Ok(Outcome::Wait(Wake::Retry));
    }
    let byte: i8 = caller.memory.load(out)?;
    let after = next(out, caller.memory.locate(RS232_REC_BUF));
    caller.memory.set(P_RS232_REC_OUT, after);
    Ok(Outcome::Done(byte.into()))
}

pub(crate) fn rs232_put_char(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    byte: u8,
) -> Result<Outcome<()>, TrapKind> {
    check_service(parts, caller, Function::RS232_PutChar);
    let place = caller.memory.get(P_RS232_TX_IN);
    let after = next(place, caller.memory.locate(RS232_TX_BUF));
    if after == caller.memory.get(P_RS232_TX_OUT) {
        return Ok(Outcome::Wait(Wake::Retry));
    }
    caller.memory.store(place, byte)?;
    caller.memory.set(P_RS232_TX_IN, after);
    Ok(Outcome::Done(()))
}

/// The place after one of a ring; a wild pointer continues at the ring's beginning.
fn next(place: GuestAddr, ring: GuestAddr) -> GuestAddr {
    let index = place.get().wrapping_sub(ring.get()).wrapping_add(1);
    if (index as usize) < RS232BUFSZ { ring.offset(index) } else { ring }
}

/// The service of one tick: a character in each direction; returns whether there was any.
pub(crate) fn tick(parts: &mut Parts, context: &mut TickContext<'_>) -> bool {
    if !parts.calls.serial.is_busy(context.memory, &parts.io.uart) {
        return false;
    }
    receive(parts, context);
    let memory = &mut *context.memory;
    let out = memory.get(P_RS232_TX_OUT);
    if out != memory.get(P_RS232_TX_IN) && parts.io.uart.is_free(context.now) {
        parts.io.uart.send(memory.peek(out), context.now);
        memory.set(P_RS232_TX_OUT, next(out, memory.locate(RS232_TX_BUF)));
    }
    true
}

/// Puts a received character into its ring; a full ring becomes empty, because its two pointers are equal then.
fn receive(parts: &mut Parts, context: &mut TickContext<'_>) {
    let Some(byte) = parts.io.uart.receive(context.now) else { return };
    let place = context.memory.get(P_RS232_REC_IN);
    let after = next(place, context.memory.locate(RS232_REC_BUF));
    context.memory.poke(place, byte);
    context.memory.set(P_RS232_REC_IN, after);
    if after == context.memory.get(P_RS232_REC_OUT) {
        parts.out.remark(context.now, Message::UartOverrun { size: RS232BUFSZ });
    }
}

/// Executes the received script commands in the primary thread's slice.
#[inline]
pub(crate) fn slice(parts: &mut Parts, context: &mut TickContext<'_>) {
    if !has_commands(parts, context.memory) {
        return;
    }
    fill(parts, context.memory);
    let received = context.memory.get(P_RS232_REC_IN);
    let mut out = context.memory.get(P_RS232_REC_OUT);
    if out == received {
        return;
    }
    let mut bytes = Vec::new();
    while out != received && bytes.len() < RS232BUFSZ {
        bytes.push(context.memory.peek(out));
        out = next(out, context.memory.locate(RS232_REC_BUF));
    }
    context.memory.set(P_RS232_REC_OUT, received);
    parts.pc.uart.receive(&bytes);
    parts.out.remark(context.now, Message::UartCommands {});
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::out::EventKind;
    use crate::testing::TestBench;

    /// A board whose serial service runs at 38400 baud for a program only.
    fn bench() -> TestBench {
        let mut bench = TestBench::new();
        assert!(!bench.is_done("EnableRS232Cmds", &[26]));
        bench.wake("EnableRS232Cmds", &[26]);
        assert_eq!(bench.memory.get(DO_RS232_CMDS), 1);
        bench.memory.set(DO_RS232_CMDS, 0);
        bench
    }

    #[test]
    fn the_ring_takes_999_characters_and_is_sent_at_the_rate_of_the_line() {
        let mut bench = bench();
        for _ in 0..999 {
            assert!(bench.is_done("RS232_PutChar", &[65]));
        }
        assert!(!bench.is_done("RS232_PutChar", &[65]));
        // 100 characters of 259.2 µs are 288 ticks; the shift register and the buffer hold two more.
        bench.run(288);
        let sent = bench.memory.get(P_RS232_TX_OUT).get() - RS232_TX_BUF.address().get();
        assert!((100..=102).contains(&sent), "{sent}");
        assert!(bench.is_done("RS232_PutChar", &[65]));
    }

    #[test]
    fn received_characters_wait_in_their_ring() {
        let mut bench = bench();
        assert!(!bench.is_done("RS232_GetChar", &[]));
        bench.kernel.parts.io.uart.queue_bytes(b"A\xff", Cycles::default());
        bench.run(10);
        assert_eq!(bench.call_i32("RS232_GetChar", &[]), 65);
        assert_eq!(bench.call_i32("RS232_GetChar", &[]), -1);
        assert!(!bench.is_done("RS232_GetChar", &[]));
        assert!(!bench.kernel.parts.calls.serial.is_busy(&bench.memory, &bench.kernel.parts.io.uart));
    }

    #[test]
    fn an_overrun_and_unread_commands_are_reported_once() {
        for (commands, word) in [(0, "lost"), (1, "DoRS232Cmds")] {
            let mut bench = bench();
            bench.memory.set(DO_RS232_CMDS, commands);
            bench.kernel.parts.io.uart.queue_bytes(&[b'x'; 2100], Cycles::default());
            bench.run(6100);
            let told: Vec<_> = bench.kernel.parts.out.take_events();
            let [event] = &told[..] else { panic!("{told:?}") };
            assert!(
                matches!(&event.kind, EventKind::Remark(remark) if remark.to_string().contains(word)),
                "{event:?}"
            );
        }
    }

    #[test]
    fn pointers_stay_in_their_ring() {
        let ring = RS232_TX_BUF.address();
        for (offset, expect) in [(0, 1), (998, 999), (999, 0), (5000, 0), (u32::MAX, 0)] {
            assert_eq!(next(ring.offset(offset), ring), ring.offset(expect), "{offset}");
        }
    }
}
