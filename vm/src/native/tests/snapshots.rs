//! A machine continues from each of its snapshots as it did when the snapshot was taken, on every engine.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use kmotiondef::map::SDRAM;

use super::*;
use crate::engine::ForeignSnapshot;
use crate::machine::Snapshot;
use crate::profile::ProfilingEngine;

/// Calls itself to varying depths, notes, and calls a function that waits.
fn deep(delay: u32) -> String {
    format!(
        "@main: func sig0, 2, 0\ntypes 0\n@up: charge 99\nadd_i32_imm r1, r1, 37\nand_i32_imm r1, r1, 511\n\
         add_i32_imm r0, r1, 3\narg_i32 r0, 0\ncall fn@f\nresult_i32 r0\ncharge 99\narg_i32 r0, 0\n\
         call_fw sig1, 0x10008000\ncharge 99\nconst_i32 r0, {delay}\narg_i32 r0, 0\ncall_fw sig1, 0x10008008\n\
         charge 9\nbr @up\n{RECURSION}"
    )
}

/// Writes to more and more of SDRAM, occasionally through a pointer to a function.
const WRITES: &str = "@main: func sig0, 3, 2\ntypes 0\ncharge 9\nconst_i32 r0, 0x80200000\n@up: charge 60\n\
    store_i32 r1, r0, +0\nadd_i32_imm r0, r0, 260\nadd_i32_imm r1, r1, 1\nand_i32_imm r2, r1, 15\nbr_if r2, @up\n\
    charge 60\nconst_i32 r2, 0x80070000\nadd_i32_imm r2, r2, 0\ncall_fw sig0, 0x10008010\ncharge 9\nbr @up\n";

/// Counts only in registers, in long slices.
const COUNTS: &str = "@main: func sig0, 2, 0\ntypes 0\n@up: charge 60\nadd_i32_imm r0, r0, 1\nmul_i32_imm r1, r0, 7\n\
    and_i32_imm r1, r1, 4095\nbr_if r1, @up\ncharge 60\nstore_i32_at r0, 0x80f00400\nbr @up\n";

/// Waits, and has a call-back that counts.
const WAITS: &str = "@main: func sig0, 1, 0\ntypes 0\n@up: charge 99\ncall_fw sig0, 0x10008010\ncharge 9\nbr @up\n\
    @callback: func sig0, 1, 0\ntypes 0\ncharge 30\nload_i32_at r0, 0x10000000\nadd_i32_imm r0, r0, 1\n\
    store_i32_at r0, 0x10000000\nret";

/// A small random number generator (Marsaglia's xorshift).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % limit
    }
}

/// A machine with programs selected by `seed`, all started.
fn machine_of<E: Engine>(seed: u64) -> Machine<Fake, E> {
    let generated = generate::program(seed);
    let texts =
        [deep(900), deep(70_000), WRITES.to_owned(), COUNTS.to_owned(), WAITS.to_owned(), generated.clone()];
    let mut numbers = Numbers(seed | 1);
    let count = 1 + numbers.below(4) as i32;
    let mut chosen = |_| texts[numbers.below(texts.len() as u64) as usize].as_str();
    let programs: Vec<(i32, &str)> = (1..=count).map(|number| (number, chosen(number))).collect();
    let preemption = if seed.is_multiple_of(2) { Preemption::Instructions } else { Preemption::Segments };
    let config = Config { preemption, ..Config::default() };
    let mut machine = machine_on::<E>(config, &programs);
    for (number, text) in &programs {
        let loaded = machine.program(thread(*number)).expect("it is loaded");
        let main = if *text == generated { loaded.functions().last() } else { loaded.functions().first() };
        let main = loaded.address_of(main.map_or(0, |function| function.at.0 as usize));
        machine.load_program(thread(*number), program(*number, text), main.as_guest_addr());
        if *text == WAITS {
            machine.memory_mut().poke(CALLBACK, main.get() + 8 * 6);
        }
        let _ = machine.start(thread(*number));
    }
    machine
}

/// Causes one of the events that reach a board from outside.
fn disturb<E: Engine>(machine: &mut Machine<Fake, E>, kind: u64) {
    match kind {
        0 => machine.threads_mut().pause(thread(1)),
        1 => drop(machine.threads_mut().resume(thread(1))),
        2 => {
            let entry = machine.threads().entry(thread(2));
            machine.load_program(thread(2), program(2, &deep(500)), entry);
            let _ = machine.start(thread(2));
        }
        3 => machine.unload_program(thread(3)),
        4 => drop(machine.start(thread(1))),
        _ => {}
    }
}

/// A snapshot of a machine, with its firmware.
type Kept<E> = (Snapshot<<E as crate::engine::Executor>::Snapshot>, Fake);

fn keep<E: Engine>(machine: &mut Machine<Fake, E>) -> Kept<E> {
    (machine.snapshot(), machine.firmware().clone())
}

fn go_back<E: Engine>(machine: &mut Machine<Fake, E>, (snapshot, firmware): &Kept<E>) {
    assert_eq!(machine.restore(snapshot), Ok(()));
    *machine.firmware_mut().0 = firmware.clone();
}

/// Runs from one time to the next, taking snapshots, then restores them in another order and runs to the end.
fn check<E: Engine>(seed: u64) {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut instants: Vec<(u64, u64)> = (0..8).map(|_| (1 + numbers.below(150), numbers.below(9))).collect();
    instants.sort_unstable();
    let end = Ticks::new(160);
    let mut machine = machine_of::<E>(seed);
    let mut straight = machine_of::<E>(seed);
    let mut kept = Vec::new();
    for (tick, kind) in &instants {
        machine.run_until(Ticks::new(*tick));
        kept.push(keep(&mut machine));
        disturb(&mut machine, *kind);
        straight.run_until(Ticks::new(*tick));
        disturb(&mut straight, *kind);
    }
    machine.run_until(end);
    straight.run_until(end);
    assert_same(&machine, &straight);
    for _ in 0..6 {
        let first = numbers.below(instants.len() as u64) as usize;
        go_back(&mut machine, &kept[first]);
        assert_eq!(machine.tick(), Ticks::new(instants[first].0));
        // Runs for some ticks, and again from the same snapshot.
        machine.run_until(Ticks::new(instants[first].0 + numbers.below(9)));
        go_back(&mut machine, &kept[first]);
        for (tick, kind) in &instants[first..] {
            machine.run_until(Ticks::new(*tick));
            disturb(&mut machine, *kind);
        }
        machine.run_until(end);
        assert_same(&machine, &straight);
    }
}

#[test]
fn a_machine_resumes_from_any_of_its_snapshots() {
    for seed in 1..cases(11, 100).into() {
        check::<NativeEngine>(seed);
        check::<BytecodeEngine>(seed);
        check::<ProfilingEngine>(seed);
    }
}

#[test]
fn native_threads_resume_only_in_their_own_machine() {
    let mut machine = machine_of::<NativeEngine>(1);
    machine.run_until(Ticks::new(20));
    let kept = machine.snapshot();
    assert_eq!(machine_of::<NativeEngine>(1).restore(&kept), Err(ForeignSnapshot));
    let mut machine = machine_of::<BytecodeEngine>(1);
    machine.run_until(Ticks::new(20));
    let (kept, firmware) = keep(&mut machine);
    let mut other = machine_of::<BytecodeEngine>(1);
    assert_eq!(other.restore(&kept), Ok(()));
    *other.firmware_mut().0 = firmware;
    for machine in [&mut machine, &mut other] {
        machine.run_until(Ticks::new(90));
    }
    assert_same(&machine, &other);
}

#[test]
#[expect(clippy::disallowed_methods, reason = "measures what the host takes")]
fn a_snapshot_takes_little_time_and_memory() {
    let mut machine = machine_of::<NativeEngine>(3);
    let fill = (0..SDRAM.size / 4).step_by(64);
    fill.for_each(|offset| machine.memory_mut().poke(SDRAM.base.offset(offset), offset));
    machine.run_until(Ticks::new(20));
    let first = machine.snapshot();
    machine.run_until(Ticks::new(21));
    let begin = Instant::now();
    let second = machine.snapshot();
    let taken = begin.elapsed();
    let begin = Instant::now();
    assert_eq!(machine.restore(&first), Ok(()));
    println!(
        "snapshot {taken:?}, back {:?}, {} bytes of memory",
        begin.elapsed(),
        second.memory().bytes_beyond(first.memory())
    );
    // Many times the expected duration, for a busy computer.
    assert!(taken < Duration::from_millis(200), "{taken:?}");
    assert!(second.memory().bytes_beyond(first.memory()) < 0x10_0000);
}

#[test]
fn a_machine_and_its_snapshots_continue_in_other_threads() {
    let elsewhere = |work: Box<dyn FnOnce() + Send>| std::thread::spawn(work).join().expect("nothing panics");
    for seed in 0..8 {
        let mut straight = machine_of::<NativeEngine>(seed);
        straight.run_until(Ticks::new(160));
        let mut rig = Arc::new(Mutex::new((machine_of::<NativeEngine>(seed), None)));
        for tick in (10..=160).step_by(10) {
            let moved = Arc::clone(&rig);
            elsewhere(Box::new(move || {
                let (machine, kept) = &mut *moved.lock().expect("nothing panics");
                machine.run_until(Ticks::new(tick));
                if tick == 80 {
                    *kept = Some(keep(machine));
                }
            }));
        }
        assert_same(&rig.lock().expect("nothing panics").0, &straight);
        let moved = Arc::clone(&rig);
        elsewhere(Box::new(move || {
            let (machine, kept) = &mut *moved.lock().expect("nothing panics");
            go_back(machine, kept.as_ref().expect("it was kept"));
            machine.run_until(Ticks::new(160));
        }));
        let (machine, _) =
            &*Arc::get_mut(&mut rig).expect("the threads are gone").get_mut().expect("nothing panics");
        assert_same(machine, &straight);
    }
}
