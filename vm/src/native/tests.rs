//! The native engine compared with the bytecode engine: there must be no difference.

mod generate;
mod long_slices;
mod loops;
mod shortcuts;
mod snapshots;
mod split;

use std::sync::Arc;

use kmotiondef::{CodeAddr, Cycles, GuestAddr, Ticks};
use proptest::prelude::*;

use super::NativeEngine;
use crate::engine::{ContextId, Engine, Executor, Polling, Preemption, Slice, Stop};
use crate::firmware::Wake;
use crate::interp::BytecodeEngine;
use crate::machine::{Config, Machine};
use crate::memory::GuestMemory;
use crate::program::Program;
use crate::testing::{CALLBACK, Fake, HEAD_WORDS, assert_same, machine_on, program, thread};
use crate::thread::Threads;

/// The address at which the harness stores the initial numbers of generated programs.
const NUMBERS: u32 = 0x80f0_0000;

/// The context that all tests run.
fn id() -> ContextId {
    ContextId::of(thread(1))
}

/// Everything on which a context works, with its own engine.
struct World<E> {
    engine: E,
    program: Arc<Program>,
    memory: GuestMemory,
    threads: Threads,
    firmware: Fake,
}

/// The observable state of a context when it has stopped.
#[derive(Debug, PartialEq)]
struct Seen {
    stop: Stop,
    left: i64,
    stack_used: u32,
    backtrace: Vec<CodeAddr>,
}

impl<E: Engine> World<E> {
    fn new(program: &Arc<Program>) -> Self {
        let mut world = Self {
            engine: E::default(),
            program: Arc::clone(program),
            memory: GuestMemory::new(),
            threads: Threads::new(),
            firmware: Fake::new(),
        };
        world.memory.protect(thread(1), program.text());
        for (place, bits) in (0..).step_by(8).zip(generate::NUMBERS) {
            world.memory.poke(GuestAddr::new(NUMBERS + place), *bits);
        }
        world
    }

    fn start(&mut self) {
        let main = self.program.functions().last().expect("there is `main`").at;
        let entry = self.program.address_of(main.0 as usize).as_guest_addr();
        let started = self.engine.start(id(), &self.program, entry, id().stack(false), &self.firmware);
        assert_eq!(started, Ok(()));
    }

    fn resume(&mut self, budget: i64, woken: Option<Wake>) -> Seen {
        self.resume_part(budget, budget, woken)
    }

    /// Continues in a slice of `length`, of which `budget` is left.
    fn resume_within(&mut self, length: i64, budget: i64) -> Seen {
        self.resume_part(length, budget, None)
    }

    fn resume_part(&mut self, length: i64, budget: i64, woken: Option<Wake>) -> Seen {
        let mut slice = Slice {
            memory: &mut self.memory,
            threads: &mut self.threads,
            firmware: &mut self.firmware,
            tick: Ticks::new(1),
            start: Cycles::new(0),
            length: Cycles::new(length),
            budget: Cycles::new(budget),
            woken,
            is_long: false,
            polling: Polling::OFF,
        };
        let stop = self.engine.resume(id(), &mut slice);
        Seen {
            stop,
            left: slice.budget.get(),
            stack_used: self.engine.stack_used(id()),
            backtrace: self.engine.backtrace(id()),
        }
    }
}

impl World<NativeEngine> {
    /// Reports whether the context runs as machine code.
    fn is_compiled(&self) -> bool {
        self.engine.contexts[id().index()].is_some()
    }
}

/// Runs the last of `functions` on both engines, in slices with these budgets, and returns how it finally stopped.
fn lockstep(functions: &str, budgets: &[i64]) -> Stop {
    lockstep_with(Preemption::Segments, functions, budgets)
}

/// Runs functions on both engines in lockstep, with the given preemption.
fn lockstep_with(preemption: Preemption, functions: &str, budgets: &[i64]) -> Stop {
    let program = Arc::new(program(1, functions));
    let mut bytecode = World::<BytecodeEngine>::new(&program);
    let mut native = World::<NativeEngine>::new(&program);
    bytecode.engine.set_preemption(preemption);
    native.engine.set_preemption(preemption);
    bytecode.start();
    native.start();
    assert!(native.is_compiled());
    let mut woken = None;
    let mut last = Stop::Ended;
    for budget in budgets {
        let seen = bytecode.resume(*budget, woken);
        assert_eq!(native.resume(*budget, woken), seen, "{functions}");
        assert_eq!(native.memory.take_touched(), bytecode.memory.take_touched(), "{functions}");
        woken = if let Stop::Waiting(wake) = seen.stop { Some(wake) } else { None };
        last = seen.stop;
        if matches!(last, Stop::Ended | Stop::Trapped(_)) {
            break;
        }
    }
    assert_eq!(native.firmware.seen(), bytecode.firmware.seen(), "{functions}");
    assert!(native.memory == bytecode.memory, "memory differs after\n{functions}");
    last
}

/// Calls itself as deep as the stack allows, or as deep as the argument requires.
const RECURSION: &str = "@f: func sig3, 2, 3\ntypes 0\ncharge 9\nadd_i32_imm r1, r0, -1\nbr_unless r0, @end\n\
     charge 9\narg_i32 r1, 0\ncall fn@f\nresult_i32 r1\ncharge 9\nadd_i32 r0, r0, r1\n@end: charge 9\nret_i32 r0\n";

#[test]
fn recursion_that_overflows_the_stack_traps_in_the_same_place() {
    for depth in [0, 10, 816, 817, 818, 819, 100_000] {
        let main = format!(
            "{RECURSION}@main: func sig0, 1, 0\ntypes 0\ncharge 99\nconst_i32 r0, {depth}\narg_i32 r0, 0\n\
             call fn@f\nresult_i32 r0\ncharge 99\nstore_i32_at r0, 0x10000000\nret"
        );
        for budgets in [&[1_000_000][..], &[100; 1000]] {
            let trapped = matches!(lockstep(&main, budgets), Stop::Trapped(_));
            assert_eq!(trapped, depth > 817, "{depth}");
        }
    }
}

#[test]
fn a_loop_is_preempted_at_the_same_instruction_with_the_same_budget() {
    let main = "@main: func sig0, 2, 0\ntypes 0\n@up: charge 7\nadd_i32_imm r0, r0, 1\nstore_i32_at r0, 0x80f00100\n\
                br @up";
    let budgets: Vec<i64> = (-3..60).collect();
    assert_eq!(lockstep(main, &budgets), Stop::Preempted);
}

#[test]
fn a_restarted_context_forgets_its_fiber() {
    let main = "@main: func sig0, 2, 0\ntypes 0\n@up: charge 7\nadd_i32_imm r0, r0, 1\nstore_i32_at r0, 0x10000000\n\
                br @up";
    let program = Arc::new(program(1, &format!("{RECURSION}{main}")));
    let mut world = World::<NativeEngine>::new(&program);
    for _ in 0..50 {
        world.start();
        assert_eq!(world.resume(69, None).stop, Stop::Preempted);
        assert_eq!(world.memory.peek::<i32>(GuestAddr::new(0x1000_0000)), 9);
    }
}

#[test]
fn stores_into_on_chip_ram_are_noticed_whatever_the_address_mode() {
    let stores = ["store_i32_at r0, ADDRESS", "store_i32 r0, r1, +0", "clear r1, 4", "copy r1, r2, 4"];
    for (address, is_noticed) in [("0x10000040", true), ("0x80f00040", false)] {
        for store in stores.map(|store| store.replace("ADDRESS", address)) {
            let body = format!("const_i32 r1, {address}\nconst_i32 r2, 0x80f00000\n{store}");
            let main = format!("@main: func sig0, 3, 0\ntypes 0\ncharge 99\n{body}\nret");
            let program = Arc::new(program(1, &main));
            let mut world = World::<NativeEngine>::new(&program);
            world.memory.take_touched();
            world.start();
            assert_eq!(world.resume(999, None).stop, Stop::Ended);
            assert_eq!(world.memory.take_touched(), is_noticed, "{store} at {address}");
        }
    }
}

#[test]
fn stores_into_program_text_are_found_whatever_the_address_mode() {
    for store in ["store_i32_at r0, 0x80050040", "store_i32 r0, r1, +0", "clear r1, 4", "copy r1, r1, 4"] {
        let body = format!("const_i32 r1, 0x80050040\n{store}");
        let main = format!("@main: func sig0, 2, 0\ntypes 0\ncharge 99\n{body}\nret");
        assert!(matches!(lockstep(&main, &[999]), Stop::Trapped(_)), "{store}");
    }
}

#[test]
fn a_program_beyond_the_limits_of_compilation_runs_as_bytecode() {
    let types = "types 0\n".repeat(313);
    let wide = format!(
        "@main: func sig0, 5000, 0\n{types}charge 9\nconst_i32 r4999, 7\nstore_i32_at r4999, 0x10000000\nret"
    );
    let steps = "add_i32_imm r0, r0, 1\n".repeat(0x4000);
    let long = format!(
        "@main: func sig0, 1, 0\ntypes 0\ncharge 99999\nconst_i32 r0, -16377\n{steps}store_i32_at r0, 0x10000000\nret"
    );
    for main in [wide, long] {
        let program = Arc::new(program(1, &main));
        let mut world = World::<NativeEngine>::new(&program);
        world.start();
        assert!(!world.is_compiled());
        assert_eq!(world.resume(100_000, None).stop, Stop::Ended);
        assert_eq!(world.memory.peek::<i32>(GuestAddr::new(0x1000_0000)), 7);
    }
}

/// Two programs with a call-back, one of them replaced while it waits, on stacks as small as the board's.
fn eventful_run<E: Engine>() -> Machine<Fake, E> {
    let deep = format!(
        "@main: func sig0, 1, 0\ntypes 0\n@up: charge 99\nconst_i32 r0, 12\narg_i32 r0, 0\ncall fn@f\nresult_i32 r0\n\
         charge 99\narg_i32 r0, 0\ncall_fw sig1, 0x10008000\ncharge 9\nbr @up\n{RECURSION}"
    );
    let waits = "@main: func sig0, 1, 0\ntypes 0\n@up: charge 99\ncall_fw sig0, 0x10008010\ncharge 9\nbr @up\n\
                 @callback: func sig0, 1, 0\ntypes 0\ncharge 30\nload_i32_at r0, 0x10000000\n\
                 add_i32_imm r0, r0, 1\nstore_i32_at r0, 0x10000000\nret";
    let config = Config { strict_stack: true, ..Config::default() };
    let mut machine = machine_on::<E>(config, &[(1, &deep), (2, waits)]);
    let _ = machine.start(thread(2));
    let callback = machine.program(thread(2)).map(|program| program.address_of(HEAD_WORDS + 6));
    machine.memory_mut().poke(CALLBACK, callback.map_or(0, CodeAddr::get));
    machine.run_until(Ticks::new(20));
    machine.threads_mut().pause(thread(1));
    machine.run_until(Ticks::new(25));
    machine.load_program(thread(2), program(2, waits), machine.threads().entry(thread(2)));
    machine.run_until(Ticks::new(30));
    let _ = machine.threads_mut().resume(thread(1));
    let _ = machine.start(thread(2));
    machine.run_until(Ticks::new(50));
    machine.unload_program(thread(1));
    machine.run_until(Ticks::new(60));
    machine
}

#[test]
fn threads_can_be_paused_replaced_and_removed_at_any_moment() {
    let native = eventful_run::<NativeEngine>();
    assert_same(&eventful_run::<BytecodeEngine>(), &native);
    assert_eq!(native.memory().peek::<i32>(GuestAddr::new(0x1000_0000)), 60);
    assert!(native.firmware().log.iter().any(|line| line.ends_with(" 1 78")), "{:?}", native.firmware().log);
}

/// The number of generated programs in a test: `many` if `CC67_LONG` is in the environment.
fn cases(few: u32, many: u32) -> u32 {
    if std::env::var_os("CC67_LONG").is_some() { many } else { few }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(100, 500)))]

    #[test]
    fn generated_programs_do_the_same_on_both_engines(seed: u64, budget in 500..30_000_i64) {
        let budgets: Vec<i64> = (0..40).map(|slice| budget + slice * 77).collect();
        let _ = lockstep(&generate::program(seed), &budgets);
    }
}
