//! Stops, and counting of packets: execution and timing stay the same.

use c67x::{Reg, assemble};

use super::flat::Flat;
use crate::dsp::{Core, Halt};

const BASE: u32 = 0x8005_0000;
/// A loop that counts A3 up and A1 down: five packets, the last of which goes back to the first.
const LOOP: &str = "MVK .S1 100,A1\nADD .L1 1,A3,A3\nADD .L1 -1,A1,A1\n[A1] B .S1 0x80050004\nNOP 5\nNOP 9";
const ADD: u32 = BASE + 4;
const SUB: u32 = BASE + 8;

fn at_begin() -> (Core, Flat) {
    let mut memory = Flat::default();
    let words = LOOP.lines().zip((BASE..).step_by(4)).map(|(line, at)| {
        assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}")).inst.encode(false)
    });
    memory.words(BASE, words.collect::<Vec<_>>());
    (Core::new(BASE), memory)
}

fn state(core: &Core) -> (u32, u64, u64, Vec<(String, u32)>) {
    (core.state.pc(), core.state.cycle(), core.packets(), core.registers())
}

/// The state after 500 cycles, with any number of stops.
fn run(stops: &[u32], until: u64) -> (Core, Vec<(u32, u32)>) {
    let (mut core, mut memory) = at_begin();
    core.skip_waits(true);
    core.set_stops(stops.iter().copied());
    let mut seen = Vec::new();
    loop {
        match core.run_until(&mut memory, until) {
            Halt::Stopped => seen.push((core.state.pc(), core.state.reg(Reg::a(3)))),
            Halt::Preempted => return (core, seen),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn stopping_everywhere_does_not_change_a_run() {
    for until in [3, 17, 100, 500] {
        let plain = state(&run(&[], until).0);
        for stops in [&[ADD][..], &[SUB], &[ADD, SUB], &[BASE, ADD, SUB, BASE + 12, BASE + 16]] {
            assert_eq!(state(&run(stops, until).0), plain, "{stops:X?}");
        }
    }
    let (_, seen) = run(&[SUB], 40);
    let counts: Vec<_> = seen.iter().map(|(_, count)| *count).collect();
    assert_eq!(counts, [1, 2, 3, 4, 5], "before the packet, once an iteration");
    assert!(seen.iter().all(|(pc, _)| *pc == SUB));
}

#[test]
fn a_copy_stops_where_the_first_one_does() {
    let (mut core, mut memory) = at_begin();
    core.set_stops([SUB]);
    assert_eq!(core.run_until(&mut memory, 500), Halt::Stopped);
    let mut copy = core.clone();
    for core in [&mut core, &mut copy] {
        assert_eq!(core.run_until(&mut memory, 500), Halt::Stopped);
        assert_eq!((core.state.pc(), core.state.reg(Reg::a(3))), (SUB, 2));
        core.set_stops([]);
        assert_eq!(core.run_until(&mut memory, 500), Halt::Preempted);
    }
    assert_eq!(state(&core), state(&copy));
}

#[test]
fn packets_are_counted_as_they_are_executed() {
    let (plain, _) = run(&[], 500);
    let (mut core, mut memory) = at_begin();
    let mut packets = Vec::new();
    let halt = core.count_until(&mut memory, 500, &mut |_, pc, cycles, _| packets.push((pc, cycles)));
    assert_eq!(halt, Halt::Preempted);
    assert_eq!(state(&core), state(&plain));
    assert_eq!(packets.len() as u64, core.packets());
    assert_eq!(packets.iter().map(|(_, cycles)| cycles).sum::<i64>(), core.state.cycle() as i64);
    assert_eq!(packets[..3], [(BASE, 1), (ADD, 1), (SUB, 1)]);
}

#[test]
fn a_run_continues_from_a_stop_with_other_stops() {
    let (mut core, mut memory) = at_begin();
    for (stops, at, count) in [
        (&[SUB][..], SUB, 1),
        (&[ADD, SUB], ADD, 1),
        (&[SUB], SUB, 2),
        (&[ADD], ADD, 2),
        (&[ADD, SUB], SUB, 3),
    ] {
        core.set_stops(stops.iter().copied());
        assert_eq!(core.run_until(&mut memory, 500), Halt::Stopped);
        assert_eq!((core.state.pc(), core.state.reg(Reg::a(3))), (at, count));
    }
}
