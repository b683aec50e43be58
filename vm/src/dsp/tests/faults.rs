//! Code that no compiler generates ends in a fault with a clear message.

use c67x::{PARALLEL, Reg, assemble};

use super::flat::Flat;
use crate::dsp::{Core, Halt};
use crate::trap::{Fault, TrapKind};

const BASE: u32 = 0x8005_0000;

/// A core at the beginning of the lines, one word each.
fn code(text: &str) -> (Core, Flat) {
    let lines: Vec<_> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let mut words: Vec<u32> = Vec::new();
    for (at, line) in (BASE..).step_by(4).zip(lines) {
        let line = assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}"));
        if line.joins_previous {
            *words.last_mut().expect("an instruction before") |= PARALLEL;
        }
        words.push(line.inst.encode(false));
    }
    let mut memory = Flat::default();
    memory.words(BASE, words);
    (Core::new(BASE), memory)
}

/// Runs until this many cycles have passed since the start.
fn run(core: &mut Core, memory: &mut Flat, until: i64) -> Halt {
    core.state.clock.set_left(until - core.state.cycle().cast_signed());
    core.run(memory)
}

fn fault(text: &str) -> String {
    let (mut core, mut memory) = code(text);
    match run(&mut core, &mut memory, 10_000) {
        Halt::Faulted(fault) => fault.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_word_that_is_not_an_instruction_is_named() {
    let (mut core, mut memory) = code("NOP");
    memory.words(BASE + 4, [0x1000_0000]);
    let halt = run(&mut core, &mut memory, 100);
    assert_eq!(halt, Halt::Faulted(Fault::BadWord { at: BASE + 4, word: 0x1000_0000 }.into()));
}

#[test]
fn a_branch_to_an_invalid_address_faults_when_it_is_taken() {
    assert_eq!(fault("MVK .S2 6,B4\nB .S2 B4\nNOP 5"), "branch to 0x00000006, which is not a multiple of 4");
}

#[test]
fn two_results_for_one_register_are_found_whatever_produces_them() {
    let same = "two results are written to A3 in the same cycle";
    assert_eq!(fault("ADD .L1 A1,A2,A3\n|| SUB .S1 A4,A5,A3"), same);
    assert_eq!(fault("MPYSP .M1 A1,A2,A3\nNOP 2\nADD .L1 A4,A5,A3"), same);
    assert_eq!(fault("MPYSP .M1 A1,A2,A3\nNOP 1\nMPY .M1 A4,A5,A3"), same);
    assert_eq!(fault("MVK .S1 1,A1\n[A1] ADD .L1 A1,A2,A3\n|| [!A2] SUB .S1 A4,A5,A3"), same);
}

#[test]
fn exclusive_conditions_write_one_register() {
    let (mut core, mut memory) = code("MVK .S1 1,A1\n[A1] ADD .L1 A1,A1,A3\n|| [!A1] SUB .S1 A4,A5,A3");
    for _ in 0..2 {
        core.step(&mut memory).expect("legal packets");
    }
    assert_eq!(core.state.reg(Reg::a(3)), 2);
}

#[test]
fn an_endless_loop_that_blocks_interrupts_is_found() {
    let text = "B .S1 pc+0\nNOP\nNOP\nNOP\nNOP\nB .S1 pc+0";
    let words = "200000 cycles without a place where an interrupt is possible: the board's servo stops";
    // Two branches, five cycles apart, keep each other's shadow alive.
    assert_eq!(fault(&format!("{text}\nNOP 4")), words);
}

#[test]
fn an_ordinary_endless_loop_is_preempted() {
    let (mut core, mut memory) = code("B .S1 pc+0\nNOP 5");
    assert_eq!(run(&mut core, &mut memory, 600), Halt::Preempted);
    assert_eq!(core.state.cycle(), 600);
    assert_eq!(run(&mut core, &mut memory, 601), Halt::Preempted);
    assert_eq!(core.state.cycle(), 606);
}

#[test]
fn results_in_flight_land_at_an_interrupt() {
    let (mut core, mut memory) = code("LDW .D1T1 *A4,A5\nNOP");
    memory.words(0, [77]);
    assert_eq!(run(&mut core, &mut memory, 1), Halt::Preempted);
    assert_eq!(core.state.reg(Reg::a(5)), 0);
    core.state.land_all();
    assert_eq!(core.state.reg(Reg::a(5)), 77);
}

#[test]
fn code_that_is_written_is_decoded_again() {
    // The store replaces the constant before the next iteration.
    let text = "MVK .S1 1,A1\nSTW .D1T1 A6,*A4\nB .S1 pc+0\nNOP 5";
    let (mut core, mut memory) = code(text);
    let new = assemble("MVK .S1 2,A1", BASE).expect("an instruction").inst.encode(false);
    core.state.set_reg(Reg::a(4), BASE);
    core.state.set_reg(Reg::a(6), new);
    let _ = run(&mut core, &mut memory, 12);
    assert_eq!(core.state.reg(Reg::a(1)), 2);
}

#[test]
fn the_stack_pointer_stays_in_the_stack() {
    let (mut core, mut memory) = code("ADDK .S2 -104,B15\nADDK .S2 -8,B15\nNOP");
    core.state.set_reg(Reg::b(15), 0x1000);
    core.watch_stack(0x1000 - 104, 0x1000);
    let halt = run(&mut core, &mut memory, 100);
    assert_eq!(halt, Halt::Faulted(TrapKind::StackOverflow { used: 112, size: 104 }));
    assert_eq!(core.state.pc(), BASE + 4);
}
