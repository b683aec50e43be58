//! Threads in time: small programs, and the firmware's log, `time thread value`.
//!
//! A tick is 18 000 cycles, of which the servo takes the first 8000.

use kmotiondef::map::program_base;
use proptest::prelude::*;

use super::*;
use crate::testing::{CALLBACK, Fake, OUT, machine, run, thread};

/// Notes 1, 2, 3 and so on, once per slice.
const SLICES: &str = "@main: func sig0, 1, 0
types 0
@next: charge 10
call_fw sig0, 0x10008010
charge 20
add_i32_imm r0, r0, 1
arg_i32 r0, 0
call_fw sig1, 0x10008000
charge 1
br @next";

/// Counts forever at `OUT`, 10 cycles per iteration.
const COUNTS: &str = "@main: func sig0, 1, 0
types 0
@next: charge 10
load_i32_at r0, 0x10000000
add_i32_imm r0, r0, 1
store_i32_at r0, 0x10000000
br @next";

/// A `main` with registers r0, r1 that notes, delays and so on as given by `steps`, then notes 99 and returns.
fn steps(steps: &[(&str, i32)]) -> String {
    let mut text = "@main: func sig0, 2, 0\ntypes 0\n".to_owned();
    for (name, argument) in steps.iter().chain(&[("note", 99)]) {
        let address = match *name {
            "note" => 0x1000_8000,
            "delay" => 0x1000_8008,
            "start" => 0x1000_8028,
            "pause" => 0x1000_8030,
            "resume" => 0x1000_8038,
            _ => unreachable!("{name}"),
        };
        let sig = if *name == "resume" { "sig3" } else { "sig1" };
        text += &format!("charge 6\nconst_i32 r0, {argument}\narg_i32 r0, 0\ncall_fw {sig}, {address:#x}\n");
    }
    text + "charge 2\nret"
}

/// The log of `programs`, with thread 1 started.
fn check(programs: &[(i32, &str)], ticks: u64, expected: &[&str]) -> Machine<Fake> {
    let machine = run(programs, ticks);
    assert_eq!(machine.firmware().log, expected);
    machine
}

#[test]
fn a_single_thread_gets_a_slice_every_180_us() {
    // 20 cycles are charged between the beginning of the slice and the note.
    check(&[(1, SLICES)], 7, &["62020 1 1", "98020 1 2", "134020 1 3"]);
}

#[test]
fn every_active_thread_gets_its_turn_even_when_it_waits() {
    let slices = |main: &str| {
        let config = Config { shortcuts: false, ..Config::default() };
        let mut machine = machine(config, &[(1, main), (2, SLICES), (5, COUNTS)]);
        machine.run_until(Ticks::new(12));
        machine.firmware().slices.clone()
    };
    assert_eq!(slices(&steps(&[("start", 2), ("delay", i32::MAX)])), "120120120120");
    assert_eq!(slices(&steps(&[("start", 5), ("resume", 2)])), "125025025025");
    assert_eq!(slices(&steps(&[])), "100000000000");
}

#[test]
fn two_threads_have_a_period_of_270_us() {
    let main = steps(&[("start", 2)]);
    let starts = main.replace("charge 2\nret", "@next: charge 1\nbr @next");
    check(&[(1, &starts), (2, SLICES)], 9, &["26012 1 99", "98020 2 1", "152020 2 2"]);
}

#[test]
fn a_delay_ends_at_its_instant_inside_a_slice() {
    let main = steps(&[("note", 1), ("delay", 5000), ("note", 2)]);
    check(&[(1, &main)], 1, &["26006 1 1", "31018 1 2", "31024 1 99"]);
}

#[test]
fn a_delay_longer_than_the_slice_ends_in_a_later_one() {
    // Ends at 50 000, in the primary thread's tick: continues when the thread's next slice begins.
    let main = steps(&[("delay", 50_000 - 26_006)]);
    check(&[(1, &main)], 4, &["62006 1 99"]);
    // Ends at 65 000, in the middle of the thread's slice.
    let main = steps(&[("delay", 65_000 - 26_006)]);
    check(&[(1, &main)], 4, &["65006 1 99"]);
}

#[test]
fn an_endless_loop_loses_the_processor_and_its_debt_is_carried() {
    let machine = check(&[(1, COUNTS)], 1, &[]);
    // The 1001st charge exceeds the budget of 10 000; its iteration is executed in the next slice.
    assert_eq!(machine.memory().peek::<i32>(OUT), 1000);
    let machine = check(&[(1, COUNTS)], 3, &[]);
    assert_eq!(machine.memory().peek::<i32>(OUT), 2000);
}

#[test]
fn a_wait_condition_is_checked_again_each_slice() {
    let main = "@main: func sig0, 1, 0\ntypes 0\ncharge 20\ncall_fw sig2, 0x10008018\nresult_i32 r0\n\
                charge 5\narg_i32 r0, 0\ncall_fw sig1, 0x10008000\ncharge 2\nret";
    let mut machine = machine(Config::default(), &[(1, main)]);
    machine.run_until(Ticks::new(5));
    assert_eq!(machine.firmware().log, [""; 0]);
    machine.memory_mut().poke(OUT.offset(4), 42_i32);
    machine.run_until(Ticks::new(9));
    assert_eq!(machine.firmware().log, ["134005 1 42"]);
}

#[test]
fn starting_an_active_thread_restarts_it_and_keeps_its_memory() {
    let main = steps(&[("start", 2), ("delay", 200_000), ("start", 2), ("delay", 200_000)]);
    let counter = "@main: func sig0, 1, 0\ntypes 0\ncharge 20\nload_i32_at r0, 0x10000000\n\
                   add_i32_imm r0, r0, 1\nstore_i32_at r0, 0x10000000\narg_i32 r0, 0\n\
                   call_fw sig1, 0x10008000\n@stay: charge 1\nbr @stay";
    let machine = check(&[(1, &main), (2, counter)], 40, &["44020 2 1", "260020 2 2", "458006 1 99"]);
    assert!(machine.threads().state(thread(2)).is_active());
    assert_eq!(*machine.threads().state(thread(1)), ThreadState::Ready);
}

#[test]
fn a_paused_thread_continues_where_it_was() {
    let main = steps(&[("start", 2), ("delay", 100_000), ("pause", 2), ("delay", 200_000), ("resume", 2)]);
    let machine = run(&[(1, &main), (2, SLICES)], 30);
    let others: Vec<_> = machine.firmware().log.iter().filter(|line| line.contains(" 2 ")).collect();
    assert_eq!(others[..3], ["98020 2 1", "368020 2 2", "404020 2 3"]);
}

#[test]
fn a_thread_that_pauses_itself_runs_on_to_the_end_of_its_slice() {
    let main = steps(&[("start", 2), ("delay", 100_000), ("resume", 2)]);
    let other = steps(&[("note", 1), ("pause", 2), ("note", 2)]);
    let machine = run(&[(1, &main), (2, &other)], 20);
    let expected = ["44006 2 1", "44018 2 2", "44024 2 99", "152012 1 99"];
    assert_eq!(machine.firmware().log, expected);
}

#[test]
fn resuming_a_thread_that_never_ran_makes_it_active_and_idle() {
    let machine = check(&[(1, &steps(&[("resume", 2), ("resume", 3)])), (2, SLICES)], 9, &["26018 1 99"]);
    assert_eq!(machine.threads().active().bits(), 0b100);
    assert_eq!(machine.turn, SliceOwner::Primary);
}

#[test]
fn thread_done_ends_the_caller() {
    let main = "@main: func sig0, 1, 0\ntypes 0\ncharge 20\ncall fn@inner\ncharge 2\nret\n\
                @inner: func sig0, 1, 0\ntypes 0\ncharge 20\ncall_fw sig0, 0x10008020\ncharge 9\n\
                arg_i32 r0, 0\ncall_fw sig1, 0x10008000\ncharge 2\nret";
    let machine = check(&[(1, main)], 5, &[]);
    assert_eq!(*machine.threads().state(thread(1)), ThreadState::Ready);
}

#[test]
fn a_trap_stops_its_thread_and_no_other() {
    let main = "@main: func sig0, 1, 0\ntypes 0\ncharge 30\nconst_i32 r0, 2\narg_i32 r0, 0\n\
                call_fw sig1, 0x10008028\ncharge 19\ndiv_i32_s r0, r0, r0\nload_i32 r0, r0, +0\nret";
    let machine = run(&[(1, main), (2, SLICES)], 8);
    assert_eq!(
        machine.firmware().log,
        [
            "26049 1 thread 1 at 0x80050098: read of the unmapped address 0x00000001",
            "80020 2 1",
            "116020 2 2",
            "152020 2 3",
        ]
    );
    assert!(matches!(machine.threads().state(thread(1)), ThreadState::Faulted(_)));
}

#[test]
fn endless_recursion_overflows_the_stack() {
    let main = "@main: func sig0, 1, 6\ntypes 0\ncharge 6\ncall fn@main\ncharge 2\nret";
    let machine = run(&[(1, main)], 9);
    assert_eq!(
        machine.firmware().log,
        [
            "thread 1 uses 32768 bytes of stack",
            "29072 1 thread 1 at 0x80050070: stack overflow: 32832 bytes used, 32768 available",
        ]
    );
    assert_eq!(machine.backtrace(thread(1)).len(), 512);
    let strict = Config { strict_stack: true, ..Config::default() };
    let mut machine = crate::testing::machine(strict, &[(1, main)]);
    machine.run_until(Ticks::new(1));
    assert!(machine.firmware().log[1].ends_with("2112 bytes used, 2048 available"));
}

#[test]
fn deep_calls_of_large_functions_keep_their_registers() {
    // Sums 1 to 1000 by recursion; each call keeps its own number in its last register.
    let types = "types 0\n".repeat(13);
    let main = format!(
        "@main: func sig0, 1, 0\ntypes 0\ncharge 9\nconst_i32 r0, 1000\narg_i32 r0, 0\ncall fn@sum\n\
         result_i32 r0\ncharge 3\nstore_i32_at r0, 0x10000000\nret\n\
         @sum: func sig3, 200, 0\n{types}charge 1\nbr_unless r0, @end\ncharge 9\nmov_i32 r199, r0\n\
         add_i32_imm r1, r0, -1\narg_i32 r1, 0\ncall fn@sum\nresult_i32 r1\ncharge 9\n\
         add_i32 r0, r1, r199\n@end: charge 2\nret_i32 r0"
    );
    let machine = run(&[(1, &main)], 9);
    assert_eq!(machine.memory().peek::<i32>(OUT), 500_500);
}

#[test]
fn a_program_takes_the_place_of_another() {
    let mut machine = machine(Config::default(), &[(1, SLICES)]);
    machine.run_until(Ticks::new(3));
    let program = crate::testing::program(1, COUNTS);
    let entry = program_base(thread(1)).offset(88);
    machine.load_program(thread(1), program, entry);
    assert_eq!(*machine.threads().state(thread(1)), ThreadState::Ready);
    machine.start(thread(1)).expect("a program is loaded");
    machine.run_until(Ticks::new(5));
    assert_eq!(machine.memory().peek::<i32>(OUT), 1000);
    machine.unload_program(thread(1));
    assert_eq!(machine.start(thread(1)), Err(NotLoaded));
}

#[test]
fn an_entry_that_is_not_a_function_traps() {
    let mut machine = machine(Config::default(), &[(1, SLICES)]);
    machine.threads_mut().set_entry(thread(1), program_base(thread(1)));
    machine.start(thread(1)).expect("a program is loaded");
    machine.run_until(Ticks::new(1));
    let message =
        "26000 1 thread 1 at 0x80050000: call of 0x80050000, where no function of this program starts";
    assert_eq!(machine.firmware().log, [message]);
}

/// Runs a call-back with `body` for three ticks while a thread counts.
fn check_callback(body: &str, expected: &[&str]) -> i32 {
    let callback = format!("{COUNTS}\n@callback: func sig0, 2, 0\ntypes 0\n{body}");
    let mut machine = machine(Config::default(), &[(1, &callback)]);
    machine.memory_mut().poke(CALLBACK, program_base(thread(1)).offset(18 * 8).get());
    machine.run_until(Ticks::new(3));
    assert_eq!(machine.firmware().log, expected);
    machine.memory().peek(OUT)
}

#[test]
fn the_callback_runs_each_tick_on_the_threads_time() {
    let log =
        ["18000 - call-back spent 1000", "36000 - call-back spent 1000", "54000 - call-back spent 1000"];
    assert_eq!(check_callback("charge 1000\nret", &log), 1800);
}

#[test]
fn a_callback_that_waits_is_stopped() {
    let message = "18000 - call-back at 0x800500a8: the call-back called a function that waits";
    assert_eq!(check_callback("charge 10\ncall_fw sig0, 0x10008010\ncharge 2\nret", &[message]), 1999);
}

#[test]
fn a_callback_that_does_not_return_is_stopped() {
    let message = "18000 - call-back at 0x800500a8: the call-back did not return within 100 ticks";
    assert_eq!(check_callback("@up: charge 1000\nbr @up", &[message]), 1000);
}

#[test]
fn waiting_costs_nothing_when_nothing_else_happens() {
    let machine = run(&[(1, &steps(&[("delay", 200_000_000)]))], 20_000);
    assert_eq!(machine.firmware().ticks, 20_000);
    assert!(machine.firmware().skipped > 19_990);
}

/// The observable state of a run.
fn observe(machine: &Machine<Fake>) -> (Vec<String>, u64, ThreadSet, i32, SliceOwner) {
    let firmware = machine.firmware();
    let count = machine.memory().peek(OUT);
    (firmware.log.clone(), firmware.ticks, machine.threads().active(), count, machine.turn)
}

proptest! {
    #[test]
    fn shortcuts_change_no_result(
        first in prop::collection::vec((0..5_usize, 1..400_000_i32), 1..8),
        second in prop::collection::vec((0..5_usize, 1..400_000_i32), 1..8),
        third in prop::sample::select(vec![SLICES, COUNTS]),
    ) {
        let program = |list: &[(usize, i32)]| {
            let names = ["delay", "note", "start", "pause", "resume"];
            let step = |(kind, number): &(usize, i32)| match *kind {
                kind @ (0 | 1) => (names[kind], *number),
                kind => (names[kind], number % 3 + 1),
            };
            steps(&list.iter().map(step).collect::<Vec<_>>())
        };
        let (first, second) = (program(&first), program(&second));
        let run = |shortcuts| {
            let config = Config { shortcuts, ..Config::default() };
            let mut machine = machine(config, &[(1, &first), (2, &second), (3, third)]);
            machine.run_until(Ticks::new(300));
            machine
        };
        prop_assert_eq!(observe(&run(true)), observe(&run(false)));
    }
}
