//! Threads that lose the processor in the middle of a segment: in the same cycle on every engine.

use super::*;
use crate::engine::HoldReason;

/// Repeatedly adds 1 to a cell in memory: the load takes effect in cycle 2 + 6 of 25, the store in cycle 18.
const COUNT: &str = "@main: func sig0, 1, 0\ntypes 0\n@up: charge 25\nload_i32_at r0, 0x80f00100\n\
     add_i32_imm r0, r0, 1\nstore_i32_at r0, 0x80f00100\nbr @up";

/// Adds 1 to the cell 20,000 times.
const COUNT_DOWN: &str = "@main: func sig0, 2, 0\ntypes 0\ncharge 9\nconst_i32 r1, 20000\n@up: charge 29\n\
     load_i32_at r0, 0x80f00100\nadd_i32_imm r0, r0, 1\nstore_i32_at r0, 0x80f00100\nadd_i32_imm r1, r1, -1\n\
     br_if r1, @up\ncharge 7\nret";

/// Stores two numbers of eight bytes alternately.
const DOUBLES: &str = "@main: func sig0, 2, 0\ntypes 15\ncharge 9\nconst_f64 d0, pool[0]\nconst_f64 d1, pool[1]\n\
     @up: charge 12\nstore_f64_at d0, 0x80f00100\nstore_f64_at d1, 0x80f00100\nbr @up";

/// The instruction before which a slice of `budget` has ended, and the rest of the budget.
fn stops_at(functions: &str, budget: i64) -> (usize, i64) {
    let program = Arc::new(program(1, functions));
    let mut world = World::<BytecodeEngine>::new(&program);
    world.engine.set_preemption(Preemption::Instructions);
    world.start();
    let seen = world.resume(budget, None);
    (program.word_at(seen.backtrace[0]).expect("it is in the program") - HEAD_WORDS - 2, seen.left)
}

#[test]
fn a_segment_is_split_in_the_cycle_in_which_the_slice_ends() {
    // Words: 0 charge, 1 load, 2 add, 3 store, 4 branch.
    for (budget, word, left) in [
        (0, 1, -8),
        (8, 1, 0),
        (9, 2, -4),
        (13, 2, 0),
        (14, 3, -4),
        (18, 3, 0),
        (19, 4, 0),
        (20, 1, -13),
        (25, 1, -8),
        (26, 1, -7),
        (34, 2, -4),
    ] {
        assert_eq!(stops_at(COUNT, budget), (word, left), "{budget}");
    }
    for start in 0..40 {
        let budgets: Vec<i64> = (start..start + 200).collect();
        let _ = lockstep_with(Preemption::Instructions, COUNT, &budgets);
    }
}

#[test]
fn a_store_of_eight_bytes_is_split_between_its_words() {
    let seen = |engine: &mut dyn FnMut(i64) -> u64| -> Vec<u64> { (8..60).map(engine).collect() };
    let program = Arc::new(program(1, DOUBLES));
    let after = |budget: i64| {
        let mut world = World::<BytecodeEngine>::new(&program);
        world.engine.set_preemption(Preemption::Instructions);
        world.start();
        let _ = world.resume(budget, None);
        world.memory.peek::<u64>(GuestAddr::new(0x80f0_0100))
    };
    let (one, other) = (0x4004_0000_0000_0000, 0x1234_5678_9abc_def0);
    let found = seen(&mut |budget| after(budget));
    let torn = |high: u64, low: u64| (high & 0xffff_ffff_0000_0000) | (low & 0xffff_ffff);
    for expected in [one, other, torn(one, other), torn(other, one)] {
        assert!(found.contains(&expected), "{expected:x} in {found:x?}");
    }
    for start in 0..40 {
        let budgets: Vec<i64> = (start..start + 100).collect();
        let _ = lockstep_with(Preemption::Instructions, DOUBLES, &budgets);
    }
}

/// The result of two threads that each count to 20,000 in the same cell.
fn race<E: Engine>(config: Config) -> (i32, Machine<Fake, E>) {
    let mut machine = machine_on::<E>(config, &[(1, COUNT_DOWN), (2, COUNT_DOWN)]);
    let _ = machine.start(thread(2));
    machine.run_until(Ticks::new(2000));
    assert!(machine.threads().active().is_empty());
    (machine.memory().peek(GuestAddr::new(0x80f0_0100)), machine)
}

#[test]
fn updates_of_two_threads_are_lost_as_on_the_board_only() {
    let (all, _) = race::<NativeEngine>(Config::default());
    assert_eq!(all, 40_000);
    let config = Config { preemption: Preemption::Instructions, ..Config::default() };
    let (count, native) = race::<NativeEngine>(config);
    assert!((20_000..39_000).contains(&count), "{count}");
    assert_same(&race::<BytecodeEngine>(config).1, &native);
    assert_same(&race::<NativeEngine>(Config { shortcuts: false, ..config }).1, &native);
}

#[test]
fn a_debugger_steps_through_a_split_segment_and_changes_nothing() {
    let program = Arc::new(program(1, &format!("{DOUBLES}\n{RECURSION}")));
    for budget in 9..70 {
        let mut worlds = [(); 2].map(|()| World::<BytecodeEngine>::new(&program));
        for world in &mut worlds {
            world.engine.set_preemption(Preemption::Instructions);
            let main = program.address_of(HEAD_WORDS).as_guest_addr();
            let started = world.engine.start(id(), &program, main, id().stack(false), &world.firmware);
            assert_eq!(started, Ok(()));
        }
        let [plain, stepped] = &mut worlds;
        stepped.engine.set_stepping(Some(id()));
        for slice in 0..5 {
            let seen = plain.resume(budget + slice, None);
            let mut left = budget + slice;
            loop {
                let found = stepped.resume_within(budget + slice, left);
                left = found.left;
                if found.stop != Stop::Held {
                    assert_eq!(found, seen, "{budget} {slice}");
                    break;
                }
                let hold = stepped.engine.take_hold().expect("it is held");
                assert_eq!(hold.reason, HoldReason::Step);
            }
            assert!(plain.memory == stepped.memory, "{budget} {slice}");
        }
    }
}

#[test]
fn a_debugger_steps_into_every_call() {
    let main = format!(
        "{RECURSION}@main: func sig0, 1, 0\ntypes 0\ncharge 99\nconst_i32 r0, 60\narg_i32 r0, 0\n\
         call fn@f\nresult_i32 r0\ncharge 99\nstore_i32_at r0, 0x10000000\nret"
    );
    let program = Arc::new(program(1, &main));
    for preemption in [Preemption::Segments, Preemption::Instructions] {
        let mut world = World::<BytecodeEngine>::new(&program);
        world.engine.set_preemption(preemption);
        world.start();
        world.engine.set_stepping(Some(id()));
        let mut left = 100_000;
        let stop = loop {
            let seen = world.resume_within(100_000, left);
            left = seen.left;
            if seen.stop != Stop::Held {
                break seen.stop;
            }
        };
        assert_eq!(stop, Stop::Ended);
        assert_eq!(world.memory.peek::<i32>(GuestAddr::new(0x1000_0000)), 60 * 61 / 2);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(60, 500)))]

    #[test]
    fn generated_programs_are_split_in_the_same_cycles(seed: u64, budget in 1..3_000_i64) {
        let budgets: Vec<i64> = (0..60).map(|slice| budget + slice * 7).collect();
        let _ = lockstep_with(Preemption::Instructions, &generate::program(seed), &budgets);
    }
}
