//! A bench for tests of firmware functions: a kernel, memory and threads without a machine.

use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
use kmotiondef::limits::VERSION;
use kmotiondef::map::PROGRAM_BASE;
use kmotiondef::{Cycles, GuestAddr, ThreadId, Ticks};
use vm::call::CallArguments;
use vm::firmware::{Caller, Firmware, Outcome, TickContext, Value, Wake};
use vm::memory::GuestMemory;
use vm::scheduler::SliceOwner;
use vm::thread::Threads;

use crate::board::power_up;
use crate::kernel::Kernel;
use crate::out::{EventKind, Severity};
use crate::pc::files::NoFiles;

/// A board on which the test makes calls, from thread 1.
pub(crate) struct TestBench {
    pub(crate) kernel: Kernel,
    pub(crate) memory: GuestMemory,
    pub(crate) threads: Threads,
    now: Cycles,
    tick: Ticks,
}

/// Guest memory as a board has it at power-up.
pub(crate) fn powered_memory() -> GuestMemory {
    let mut memory = GuestMemory::new();
    power_up::fill(&mut memory, VERSION.trim_end(), power_up::InitialMemory::Zero);
    memory
}

impl TestBench {
    pub(crate) fn new() -> Self {
        let kernel = Kernel::new(Box::new(NoFiles));
        Self {
            kernel,
            memory: powered_memory(),
            threads: Threads::new(),
            now: Cycles::default(),
            tick: Ticks::default(),
        }
    }

    pub(crate) fn set_now(&mut self, now: Cycles) {
        self.now = now;
    }

    pub(crate) fn outcome(&mut self, name: &str, arguments: &[u64], woken: Option<Wake>) -> Outcome<Value> {
        self.outcome_within(Cycles::PER_TICK, name, arguments, woken)
    }

    /// Makes a call in a slice with this much left; the cost of its row is spent.
    pub(crate) fn outcome_within(
        &mut self,
        budget: Cycles,
        name: &str,
        arguments: &[u64],
        woken: Option<Wake>,
    ) -> Outcome<Value> {
        self.outcome_by(ThreadId::new(1), budget, name, arguments, woken)
    }

    /// Makes a call from another thread.
    pub(crate) fn call_by(&mut self, thread: Option<ThreadId>, name: &str, arguments: &[u64]) {
        let outcome = self.outcome_by(thread, Cycles::PER_TICK, name, arguments, None);
        assert!(matches!(outcome, Outcome::Done(_)), "{name}: {outcome:?}");
    }

    fn outcome_by(
        &mut self,
        thread: Option<ThreadId>,
        mut budget: Cycles,
        name: &str,
        arguments: &[u64],
        woken: Option<Wake>,
    ) -> Outcome<Value> {
        let number = function_named(name).unwrap_or_else(|| panic!("no function {name}"));
        let mut caller = Caller {
            thread,
            memory: &mut self.memory,
            threads: &mut self.threads,
            tick: self.tick,
            slice_start: self.now,
            slice: budget,
            budget: &mut budget,
            woken,
            arguments: CallArguments::from_slots(arguments),
            at: None,
        };
        let outcome = self.kernel.call(FIRMWARE_FUNCTIONS[number].address, &mut caller);
        outcome.unwrap_or_else(|trap| panic!("{name}: {trap}"))
    }

    fn done(&mut self, name: &str, arguments: &[u64], woken: Option<Wake>) -> Value {
        match self.outcome(name, arguments, woken) {
            Outcome::Done(value) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    /// Returns whether a call made by a command is completed at once: after reading its line, a part of the slice is
    /// left.
    pub(crate) fn is_done(&mut self, name: &str, arguments: &[u64]) -> bool {
        let left = Cycles::new(4500);
        matches!(self.outcome_within(left, name, arguments, None), Outcome::Done(_))
    }

    pub(crate) fn call(&mut self, name: &str, arguments: &[u64]) {
        self.done(name, arguments, None);
    }

    /// Makes a call, and again in each slice of a single thread while it waits for the next one.
    pub(crate) fn call_in_slices(&mut self, name: &str, arguments: &[u64]) {
        let mut outcome = self.outcome(name, arguments, None);
        while let Outcome::Wait(wake) = outcome {
            self.run(2);
            outcome = self.outcome(name, arguments, Some(wake));
        }
    }

    pub(crate) fn call_i32(&mut self, name: &str, arguments: &[u64]) -> i32 {
        match self.done(name, arguments, None) {
            Value::I32(value) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    /// Repeats a call after its wake event; returns whether it is then completed.
    pub(crate) fn wake(&mut self, name: &str, arguments: &[u64]) -> bool {
        matches!(self.outcome(name, arguments, Some(Wake::Retry)), Outcome::Done(_))
    }

    pub(crate) fn wake_i32(&mut self, name: &str, arguments: &[u64]) -> i32 {
        match self.done(name, arguments, Some(Wake::Retry)) {
            Value::I32(value) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    pub(crate) fn call_f64(&mut self, name: &str, arguments: &[u64]) -> f64 {
        match self.done(name, arguments, None) {
            Value::F64(value) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    pub(crate) fn call_f32(&mut self, name: &str, arguments: &[u64]) -> f32 {
        match self.done(name, arguments, None) {
            Value::F32(value) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    /// Runs this many ticks; every other one is the primary thread's.
    pub(crate) fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick = self.tick.next();
            self.now = Cycles::new(self.tick.get() as i64 * Cycles::PER_TICK.get());
            let turn = if self.tick.get().is_multiple_of(2) {
                SliceOwner::Primary
            } else {
                SliceOwner::User(ThreadId::all().next().expect("1"))
            };
            let mut context = TickContext {
                memory: &mut self.memory,
                threads: &mut self.threads,
                tick: self.tick,
                now: self.now,
            };
            self.kernel.tick(&mut context);
            self.kernel.switch_to(turn, &mut context);
            if turn == SliceOwner::Primary {
                self.kernel.primary_slice(&mut context);
            }
        }
    }

    /// An address in the program space of thread 1.
    pub(crate) fn scratch(&self, offset: u32) -> u32 {
        PROGRAM_BASE + offset
    }

    /// Puts a string there and returns its address as an argument.
    pub(crate) fn put_text(&mut self, offset: u32, text: &[u8]) -> u64 {
        let address = self.scratch(offset);
        let mut text = text.to_vec();
        text.push(0);
        self.memory.write_bytes(GuestAddr::new(address), &text).expect("mapped");
        address.into()
    }

    /// Puts words there and returns their address as an argument.
    pub(crate) fn put_words(&mut self, offset: u32, words: &[u32]) -> u64 {
        for (index, word) in (0..).zip(words) {
            self.memory.poke(GuestAddr::new(self.scratch(offset + 4 * index)), *word);
        }
        self.scratch(offset).into()
    }

    pub(crate) fn bytes_at(&self, address: u32, length: u32) -> Vec<u8> {
        self.memory.read_bytes(GuestAddr::new(address), length).expect("mapped").to_vec()
    }

    pub(crate) fn text_at(&self, address: u32) -> String {
        let text = self.memory.read_c_string(GuestAddr::new(address), 1000).expect("mapped");
        String::from_utf8(text).expect("text")
    }

    /// The remarks of the simulation since the last call.
    pub(crate) fn diagnostics(&mut self) -> Vec<String> {
        let texts = self.kernel.parts.out.take_events().into_iter().filter_map(|event| match event.kind {
            EventKind::Remark(remark) if remark.message.severity() > Severity::Detail => {
                Some(remark.to_string())
            }
            _ => None,
        });
        texts.collect()
    }

    /// All console lines so far, including the unfinished one.
    pub(crate) fn printed(&mut self) -> Vec<String> {
        self.kernel.parts.flush_console(self.now);
        let lines = self.kernel.parts.out.take_events().into_iter().filter_map(|event| match event.kind {
            EventKind::ConsoleLine(line) => Some(String::from_utf8(line).expect("text")),
            _ => None,
        });
        let mut lines: Vec<String> = lines.collect();
        let held = self.kernel.parts.out.console.held();
        if !held.is_empty() {
            lines.push(String::from_utf8(held.to_vec()).expect("text"));
        }
        lines
    }
}
