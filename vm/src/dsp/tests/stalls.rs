//! Memory for which the processor waits: time passes, without other changes.

use c67x::{Reg, assemble};

use super::flat::Flat;
use crate::dsp::{Clock, Core, Halt, Memory};
use crate::trap::TrapKind;

const BASE: u32 = 0x8005_0000;
/// Loads a word twice while a product is in flight, and uses all of them as soon as they land.
const CODE: &str = "MVK .S1 5,A1\nMVK .S1 64,A4\nLDW .D1T1 *A4,A5\nMPY .M1 A1,A1,A6\nADD .L1 A6,A6,A7\n\
                    LDW .D1T1 *A4,A8\nADD .L1 A6,A7,A7\nADD .L1 A5,A7,A7\nNOP 3\nADD .L1 A8,A7,A7\nNOP 9\nNOP 9";
/// The cycles of that code without its last two packets.
const CYCLES: u64 = 12;

/// A memory with one slow word.
#[derive(Default)]
struct Slow {
    inner: Flat,
    waits: u64,
    /// The times of the loads from it.
    loads: Vec<u64>,
}

impl Memory for Slow {
    fn fetch(&self, addr: u32) -> Option<u32> {
        self.inner.fetch(addr)
    }

    fn load8(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.inner.load8(addr, clock)
    }

    fn load16(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.inner.load16(addr, clock)
    }

    fn load32(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind> {
        self.loads.push(clock.cycle());
        clock.stall(self.waits);
        self.inner.load32(addr, clock)
    }

    fn load64(&mut self, addr: u32, clock: &mut Clock) -> Result<u64, TrapKind> {
        self.inner.load64(addr, clock)
    }

    fn store8(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.inner.store8(addr, value, clock)
    }

    fn store16(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.inner.store16(addr, value, clock)
    }

    fn store32(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind> {
        self.inner.store32(addr, value, clock)
    }
}

/// Runs the code to a time; returns the registers, the time, and the times at which the slow word was loaded.
fn run(waits: u64, until: u64) -> (Vec<(String, u32)>, u64, Vec<u64>) {
    let mut memory = Slow { waits, ..Slow::default() };
    let words = CODE.lines().zip((BASE..).step_by(4)).map(|(line, at)| {
        assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}")).inst.encode(false)
    });
    memory.inner.words(BASE, words.collect::<Vec<_>>());
    memory.inner.words(64, [1000]);
    let mut core = Core::new(BASE);
    assert_eq!(core.run_until(&mut memory, until), Halt::Preempted);
    (core.registers(), core.state.cycle(), memory.loads)
}

#[test]
fn what_is_in_flight_waits_with_the_processor() {
    let (plain, at, loads) = run(0, CYCLES + 1);
    assert!(plain.contains(&(Reg::a(7).to_string(), 2000 + 25)), "{plain:?}");
    for waits in [1, 16, 44, 1000] {
        let (slow, end, late) = run(waits, CYCLES + 1 + 2 * waits);
        assert_eq!(slow, plain, "{waits}");
        assert_eq!(end, at + 2 * waits);
        assert_eq!(late, [loads[0], loads[1] + waits]);
    }
}

#[test]
fn a_run_ends_on_time_while_the_processor_waits() {
    let (_, end, loads) = run(44, 10);
    assert_eq!(loads.len(), 1);
    assert_eq!(end, loads[0] + 44 + 1, "at the first packet after the wait");
}
